/* camera_files/formats.c: the table of camera file formats (dialects). Each dialect's own file
 * defines its row. */
#include "camera_files/formats.h"
#include "base/text.h"

#define FORMAT(dialect, format) [dialect] = &format,
const vlCameraFormat *const vl_camera_formats[VL_CAMERA_DIALECT_COUNT] = {
    VL_CAMERA_FORMATS(FORMAT)};

/* The order in which dialects are tried on a parsed file (JSON, YAML or XML): a dialect that is
 * recognised by fields of its own comes before one that is recognised by fields that several
 * tools use. */
static const vlCameraDialect order[] = {VL_CAMERA_DIALECT_REALITYCAPTURE,
                                        VL_CAMERA_DIALECT_ARIA,
                                        VL_CAMERA_DIALECT_COLLADA,
                                        VL_CAMERA_DIALECT_NERFSTUDIO,
                                        VL_CAMERA_DIALECT_CALIBIO,
                                        VL_CAMERA_DIALECT_DEPTHAI,
                                        VL_CAMERA_DIALECT_KINECT,
                                        VL_CAMERA_DIALECT_PANOPTIC,
                                        VL_CAMERA_DIALECT_NUSCENES,
                                        VL_CAMERA_DIALECT_NERFIES,
                                        VL_CAMERA_DIALECT_THREEJS,
                                        VL_CAMERA_DIALECT_POLYCAM,
                                        VL_CAMERA_DIALECT_RECORD3D,
                                        VL_CAMERA_DIALECT_SCANNER3D,
                                        VL_CAMERA_DIALECT_REALSENSE,
                                        VL_CAMERA_DIALECT_OPENMVG,
                                        VL_CAMERA_DIALECT_METASHAPE,
                                        VL_CAMERA_DIALECT_VISP,
                                        VL_CAMERA_DIALECT_VELO,
                                        VL_CAMERA_DIALECT_GLTF,
                                        VL_CAMERA_DIALECT_OPENGL,
                                        VL_CAMERA_DIALECT_VULKAN,
                                        VL_CAMERA_DIALECT_D3D,
                                        VL_CAMERA_DIALECT_BASALT,
                                        VL_CAMERA_DIALECT_MESHROOM,
                                        VL_CAMERA_DIALECT_GAUSSIANS,
                                        VL_CAMERA_DIALECT_OPENSFM,
                                        VL_CAMERA_DIALECT_OPEN3D,
                                        VL_CAMERA_DIALECT_BOP,
                                        VL_CAMERA_DIALECT_NERF,
                                        VL_CAMERA_DIALECT_CAMODOCAL,
                                        VL_CAMERA_DIALECT_ORBSLAM,
                                        VL_CAMERA_DIALECT_OKVIS,
                                        VL_CAMERA_DIALECT_SVO,
                                        VL_CAMERA_DIALECT_EUROC,
                                        VL_CAMERA_DIALECT_KALIBR,
                                        VL_CAMERA_DIALECT_ROS,
                                        VL_CAMERA_DIALECT_BLENDER,
                                        VL_CAMERA_DIALECT_OPENCV};

static bool has_marks(const vlCameraFormat *format, const json_t *tree) {
  const json_t *object = format->marks_in ? json_object_get(tree, format->marks_in) : tree;
  if (format->marks_in && json_is_array(object))
    object = json_array_get(object, 0);
  size_t count = 0, found = 0;
  while (count < VL_LENGTH(format->marks) && format->marks[count])
    found += vl_camera_has(object, format->marks[count++]);
  return format->one_mark ? found > 0 : count > 0 && found == count;
}

vlCameraDialect vl_camera_dialect_of_tree(const json_t *tree) {
  for (size_t i = 0; i < VL_LENGTH(order); i++) {
    const vlCameraFormat *format = vl_camera_formats[order[i]];
    if (format->is_tree ? format->is_tree(tree) : has_marks(format, tree))
      return order[i];
  }
  return VL_CAMERA_DIALECT_AUTO;
}

vlCameraDialect vl_camera_dialect_of_text(const char *text, size_t size) {
  for (int i = 1; i < VL_CAMERA_DIALECT_COUNT; i++)
    if (vl_camera_formats[i]->is_text && vl_camera_formats[i]->is_text(text, size))
      return (vlCameraDialect)i;
  return VL_CAMERA_DIALECT_AUTO;
}
