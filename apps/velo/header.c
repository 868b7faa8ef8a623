/* header.c: see header.h. */
#include "header.h"

#include <string.h>

#include "report.h"

static bool number(const vlImage *image, const char *name, double *value) {
  vlAttribute a;
  if (vl_image_find_attribute(image, name, &a) != VL_OK || a.type != VL_ATTRIBUTE_DOUBLE) return false;
  *value = a.numbers[0];
  return true;
}

/* Corner pixels, inclusive; false when the file has no such window or an impossible one. */
static bool window(const vlImage *image, const char *name, double box[4]) {
  vlAttribute a;
  if (vl_image_find_attribute(image, name, &a) != VL_OK || a.type != VL_ATTRIBUTE_BOX2I) return false;
  memcpy(box, a.numbers, 4 * sizeof *box);
  return box[2] >= box[0] && box[3] >= box[1];
}

int header_camera(const vlImage *image, const char *path, vlCamera *camera, uint32_t *x0, uint32_t *y0) {
  double whole[4] = {0, 0, vl_image_width(image) - 1.0, vl_image_height(image) - 1.0}, data[4];
  memcpy(data, whole, sizeof data);
  if (!window(image, "originalDataWindow", whole)) window(image, "displayWindow", whole);
  window(image, "dataWindow", data);
  if (whole[0] != 0 || whole[1] != 0 || data[0] < 0 || data[1] < 0 || data[2] > whole[2] || data[3] > whole[3])
    return report_failure(STATUS_SCENE, "%s: its windows are not those of a picture that velo rendered", path);
  vlCameraDef def = vl_default_camera_def((uint32_t)whole[2] + 1, (uint32_t)whole[3] + 1);
  vlAttribute matrix, projection;
  bool found =
      number(image, "velo.fx", &def.fx) && number(image, "velo.fy", &def.fy) && number(image, "velo.skew", &def.skew) &&
      number(image, "velo.cx", &def.cx) && number(image, "velo.cy", &def.cy) &&
      vl_image_find_attribute(image, "velo.worldFromCamera", &matrix) == VL_OK && matrix.type == VL_ATTRIBUTE_M44D &&
      vl_image_find_attribute(image, "velo.projection", &projection) == VL_OK &&
      projection.type == VL_ATTRIBUTE_STRING && projection.string;
  if (!found) return report_failure(STATUS_SCENE, "%s: has no camera in its header", path);
  if (strcmp(projection.string, "orthographic") == 0)
    def.projection = VL_PROJECTION_ORTHOGRAPHIC;
  else if (strcmp(projection.string, "perspective") != 0)
    return report_failure(STATUS_SCENE, "%s: cameras of the projection \"%s\" are not read from headers yet", path,
                          projection.string);
  def.has_matrix = true; /* OpenEXR's matrices act on rows */
  for (int row = 0; row < 4; row++)
    for (int column = 0; column < 4; column++)
      def.world_from_camera[4 * row + column] = matrix.numbers[4 * column + row];
  vlError error = {0};
  vlResult result = vl_camera_make(&def, camera, NULL, &error);
  if (result != VL_OK)
    return report_failure(STATUS_SCENE, "%s: the camera in its header is wrong: %s", path, error.message);
  *x0 = (uint32_t)data[0];
  *y0 = (uint32_t)data[1];
  return -1;
}
