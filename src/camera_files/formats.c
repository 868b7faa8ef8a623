/* camera_files/formats.c: the table of camera file formats (dialects). Each dialect's own file
 * defines its row. */
#include "camera_files/formats.h"
#include "base/text.h"

const vlCameraFormat *const vl_camera_formats[VL_CAMERA_DIALECT_COUNT] = {
    [VL_CAMERA_DIALECT_VELO] = &vl_format_velo,
    [VL_CAMERA_DIALECT_OPENCV] = &vl_format_opencv,
    [VL_CAMERA_DIALECT_ROS] = &vl_format_ros,
    [VL_CAMERA_DIALECT_COLMAP] = &vl_format_colmap,
    [VL_CAMERA_DIALECT_NERF] = &vl_format_nerf,
    [VL_CAMERA_DIALECT_KALIBR] = &vl_format_kalibr,
    [VL_CAMERA_DIALECT_BLENDER] = &vl_format_blender,
    [VL_CAMERA_DIALECT_PBRT] = &vl_format_pbrt,
    [VL_CAMERA_DIALECT_GLTF] = &vl_format_gltf,
    [VL_CAMERA_DIALECT_OPENGL] = &vl_format_opengl,
    [VL_CAMERA_DIALECT_VULKAN] = &vl_format_vulkan,
    [VL_CAMERA_DIALECT_D3D] = &vl_format_d3d,
    [VL_CAMERA_DIALECT_MITSUBA] = &vl_format_mitsuba,
    [VL_CAMERA_DIALECT_EXR] = &vl_format_exr,
    [VL_CAMERA_DIALECT_USD] = &vl_format_usd,
    [VL_CAMERA_DIALECT_EUROC] = &vl_format_euroc,
    [VL_CAMERA_DIALECT_CAMODOCAL] = &vl_format_camodocal,
    [VL_CAMERA_DIALECT_BASALT] = &vl_format_basalt,
    [VL_CAMERA_DIALECT_ORBSLAM] = &vl_format_orbslam,
    [VL_CAMERA_DIALECT_OKVIS] = &vl_format_okvis,
    [VL_CAMERA_DIALECT_SVO] = &vl_format_svo,
    [VL_CAMERA_DIALECT_KITTI] = &vl_format_kitti,
    [VL_CAMERA_DIALECT_BOP] = &vl_format_bop,
    [VL_CAMERA_DIALECT_GAUSSIANS] = &vl_format_gaussians,
    [VL_CAMERA_DIALECT_METASHAPE] = &vl_format_metashape,
    [VL_CAMERA_DIALECT_MESHROOM] = &vl_format_meshroom,
    [VL_CAMERA_DIALECT_OPENSFM] = &vl_format_opensfm,
    [VL_CAMERA_DIALECT_OPEN3D] = &vl_format_open3d,
    [VL_CAMERA_DIALECT_VISP] = &vl_format_visp,
    [VL_CAMERA_DIALECT_MIDDLEBURY] = &vl_format_middlebury,
    [VL_CAMERA_DIALECT_MVSNET] = &vl_format_mvsnet,
    [VL_CAMERA_DIALECT_BUNDLER] = &vl_format_bundler,
    [VL_CAMERA_DIALECT_OPENMVG] = &vl_format_openmvg,
    [VL_CAMERA_DIALECT_REALITYCAPTURE] = &vl_format_realitycapture,
    [VL_CAMERA_DIALECT_NERFSTUDIO] = &vl_format_nerfstudio,
    [VL_CAMERA_DIALECT_VISUALSFM] = &vl_format_visualsfm,
    [VL_CAMERA_DIALECT_ZED] = &vl_format_zed,
    [VL_CAMERA_DIALECT_COLLADA] = &vl_format_collada,
    [VL_CAMERA_DIALECT_DSO] = &vl_format_dso,
    [VL_CAMERA_DIALECT_LLFF] = &vl_format_llff,
    [VL_CAMERA_DIALECT_RECORD3D] = &vl_format_record3d,
    [VL_CAMERA_DIALECT_POLYCAM] = &vl_format_polycam,
    [VL_CAMERA_DIALECT_SCANNER3D] = &vl_format_scanner3d,
    [VL_CAMERA_DIALECT_DEPTHAI] = &vl_format_depthai,
    [VL_CAMERA_DIALECT_KINECT] = &vl_format_kinect,
    [VL_CAMERA_DIALECT_REALSENSE] = &vl_format_realsense,
    [VL_CAMERA_DIALECT_CALIBIO] = &vl_format_calibio,
    [VL_CAMERA_DIALECT_NUSCENES] = &vl_format_nuscenes,
    [VL_CAMERA_DIALECT_PANOPTIC] = &vl_format_panoptic,
    [VL_CAMERA_DIALECT_NERFIES] = &vl_format_nerfies,
    [VL_CAMERA_DIALECT_THREEJS] = &vl_format_threejs,
    [VL_CAMERA_DIALECT_MATRIX] = &vl_format_matrix,
    [VL_CAMERA_DIALECT_ARIA] = &vl_format_aria,
};

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
