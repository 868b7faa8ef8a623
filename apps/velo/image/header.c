/* image/header.c: see header.h. */
#include "image/header.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "velo/distortion.h"
#include "velo/projection.h"

/* Whether the image has an attribute of that name and type. */
static bool find(const vlImage *image, const char *name, vlAttributeType type, vlAttribute *a) {
  return vl_image_find_attribute(image, name, a) == VL_OK && a->type == type &&
         (type != VL_ATTRIBUTE_STRING || a->string);
}

/* Takes numbers of an attribute; where there is none, *values stay. */
static bool take(const vlImage *image, const char *name, vlAttributeType type, double *values,
                 size_t count) {
  vlAttribute a;
  if (!find(image, name, type, &a))
    return false;
  memcpy(values, a.numbers, count * sizeof *values);
  return true;
}

static bool number(const vlImage *image, const char *name, double *value) {
  return take(image, name, VL_ATTRIBUTE_DOUBLE, value, 1);
}

/* Reads corner pixels, inclusive. False when the attribute is missing or impossible. */
static bool window(const vlImage *image, const char *name, double box[4]) {
  return take(image, name, VL_ATTRIBUTE_BOX2I, box, 4) && box[2] >= box[0] && box[3] >= box[1];
}

/* Reads a matrix. OpenEXR's act on row vectors. */
static bool matrix(const vlImage *image, const char *name, double m[16]) {
  vlAttribute a;
  if (!find(image, name, VL_ATTRIBUTE_M44D, &a))
    return false;
  for (int i = 0; i < 16; i++)
    m[i] = a.numbers[i % 4 * 4 + i / 4];
  return true;
}

const char *header_text(const vlImage *image, const char *name) {
  vlAttribute a;
  return find(image, name, VL_ATTRIBUTE_STRING, &a) ? a.string : NULL;
}

#define COUNT_ONE(kind, name, row) +1
enum { PROJECTIONS = 0 VL_PROJECTION_KINDS(COUNT_ONE) };

/* Reads a list of numbers. Returns how many there are; -1: one is no number, or there is no
 * room for it. */
static int read_numbers(const char *text, double *numbers, int room) {
  int count = 0;
  while (*text) {
    char *end;
    const double value = strtod(text, &end);
    if (end == text || count == room)
      return -1;
    numbers[count++] = value;
    text = end;
  }
  return count;
}

/* Reads projection and lens. Returns false for an unknown name or coefficient. */
static bool read_model(const vlImage *image, const char *projection, vlCameraDef *def) {
  int kind = 0;
  while (kind < PROJECTIONS && strcmp(vl_projection_name((vlProjection)kind), projection) != 0)
    kind++;
  if (kind == PROJECTIONS)
    return false;
  def->projection = (vlProjection)kind;
  number(image, "velo.shape0", &def->shape[0]);
  number(image, "velo.shape1", &def->shape[1]);
  const char *distortion = header_text(image, "velo.distortion"),
             *at = header_text(image, "velo.distortionCoefficients");
  if (!distortion)
    return true;
  for (int i = 0; i < VL_DISTORTION_KIND_COUNT; i++)
    if (strcmp(vl_distortion_name((vlDistortion)i), distortion) == 0)
      def->distortion = (vlDistortion)i;
  if (def->distortion == VL_DISTORTION_NONE || !at)
    return false;
  const int count =
      read_numbers(at, def->distortion_coefficients, LENGTH(def->distortion_coefficients));
  def->distortion_count = count > 0 ? (uint32_t)count : 0;
  return count >= 0;
}

/* Reads the size of the whole image and the file's window in it. */
static int windows(const vlImage *image, const char *path, double whole[4], double data[4]) {
  const double all[4] = {0, 0, vl_image_width(image) - 1.0, vl_image_height(image) - 1.0};
  memcpy(whole, all, sizeof all);
  memcpy(data, all, sizeof all);
  if (!window(image, "originalDataWindow", whole))
    window(image, "displayWindow", whole);
  window(image, "dataWindow", data);
  if (whole[0] != 0 || whole[1] != 0 || data[0] < 0 || data[1] < 0 || data[2] > whole[2] ||
      data[3] > whole[3])
    return report_failure(STATUS_SCENE,
                          "%s: its windows are not those of an image that velo rendered", path);
  return -1;
}

/* Reads projection and pose. */
static int read_def(const vlImage *image, const char *path, const double whole[4],
                    vlCameraDef *def) {
  *def = vl_default_camera_def((uint32_t)whole[2] + 1, (uint32_t)whole[3] + 1);
  const char *projection = header_text(image, "velo.projection");
  bool found = number(image, "velo.fx", &def->fx) && number(image, "velo.fy", &def->fy) &&
               number(image, "velo.skew", &def->skew) && number(image, "velo.cx", &def->cx) &&
               number(image, "velo.cy", &def->cy) &&
               matrix(image, "velo.worldFromCamera", def->world_from_camera) && projection;
  if (!found)
    return report_failure(STATUS_SCENE, "%s: has no camera in its header", path);
  if (!read_model(image, projection, def))
    return report_failure(STATUS_SCENE,
                          "%s: the camera in its header is of a kind that is not known", path);
  def->has_matrix = true;
  return -1;
}

/* Reads a lens of many elements, which determines the focal length: four numbers per surface.
 * An image as aperture stop is not in headers; it does not change ray directions. */
static int read_optics(vlContext *context, const vlImage *image, const char *path,
                       vlCameraDef *def, vlOptics **optics) {
  vlOpticsDef lens = vl_default_optics_def();
  enum { MAX_SURFACES = 64 };
  double numbers[4 * MAX_SURFACES];
  vlLensSurface surfaces[MAX_SURFACES];
  const char *at = header_text(image, "velo.optics");
  lens.focus_distance = INFINITY;
  lens.surfaces = surfaces;
  number(image, "velo.opticsAperture", &lens.aperture_diameter);
  number(image, "velo.opticsFocus", &lens.focus_distance);
  number(image, "velo.opticsDiagonal", &lens.film_diagonal);
  number(image, "velo.opticsUnit", &lens.unit_mm);
  const int count = at ? read_numbers(at, numbers, 4 * MAX_SURFACES) : -1;
  if (count < 0 || count % 4)
    return report_failure(STATUS_SCENE, "%s: the lens in its header is not understood", path);
  for (const double *n = numbers; n < numbers + count; n += 4)
    surfaces[lens.count++] =
        (vlLensSurface){.radius = n[0], .thickness = n[1], .ior = n[2], .aperture = n[3]};
  vlError error = {0};
  vlResult result = vl_optics_create(context, &lens, optics, &error);
  if (result == VL_ERROR_MEMORY)
    return report_error(NULL, result, NULL);
  if (result != VL_OK)
    return report_failure(STATUS_SCENE, "%s: the lens in its header is wrong: %s", path,
                          error.message);
  def->lens.optics = *optics;
  def->fx = def->fy = def->skew = VL_UNSET;
  return -1;
}

int header_camera(vlContext *context, const vlImage *image, const char *path, vlCamera *camera,
                  vlOptics **optics, uint32_t *x0, uint32_t *y0) {
  double whole[4], data[4], limit;
  vlCameraDef def;
  *optics = NULL;
  TRY(windows(image, path, whole, data));
  TRY(read_def(image, path, whole, &def));
  if (def.projection == VL_PROJECTION_OPTICS)
    TRY(read_optics(context, image, path, &def, optics));
  vlError error = {0};
  vlResult result = vl_camera_make(&def, camera, NULL, &error);
  if (result != VL_OK)
    return report_failure(STATUS_SCENE, "%s: the camera in its header is wrong: %s", path,
                          error.message);
  if (number(image, "velo.limit", &limit))
    camera->limit = limit;
  number(image, "velo.eyeCircle", &camera->eye_circle);
  *x0 = (uint32_t)data[0];
  *y0 = (uint32_t)data[1];
  return -1;
}

/* Reads the poses at both ends, and their times. */
static bool read_motion(const vlImage *image, double poses[2][16], double times[2]) {
  if (!matrix(image, "velo.worldFromCameraOpen", poses[0]) ||
      !matrix(image, "velo.worldFromCameraClose", poses[1]) ||
      !take(image, "velo.poseTimes", VL_ATTRIBUTE_V2F, times, 2))
    return false;
  number(image, "velo.poseOpen", &times[0]);
  number(image, "velo.poseClose", &times[1]);
  return true;
}

HeaderRows header_rows(const vlImage *image, const vlCamera *camera, vlCamera *rolling) {
  static const char *const directions[] = {"down", "up", "right", "left"};
  double readout = 0.0, first, shutter[2]; /* seconds */
  double poses[2][16], times[2];
  const char *direction = header_text(image, "velo.readoutDirection"),
             *given = header_text(image, "velo.channelsTime");
  if (!number(image, "velo.readout", &readout) || !(readout > 0.0) || !direction ||
      !read_motion(image, poses, times) ||
      vl_camera_travel(camera, poses[0], poses[1], times, rolling, NULL) != VL_OK)
    return ROWS_NONE;
  rolling->readout = readout;
  for (int i = 0; i < 4; i++)
    if (strcmp(direction, directions[i]) == 0)
      rolling->readout_direction = (vlReadout)i;
  if (take(image, "velo.shutter", VL_ATTRIBUTE_V2F, shutter, 2))
    rolling->shutter_open = rolling->shutter_close = 0.5 * (shutter[0] + shutter[1]);
  if (number(image, "velo.firstRowTime", &first))
    rolling->shutter_open = rolling->shutter_close = first;
  if (!given)
    return ROWS_UNKNOWN;
  return strcmp(given, "row") == 0 ? ROWS_EACH : ROWS_ONE;
}

void header_row_camera(const vlCamera *rolling, uint32_t x, uint32_t y, vlCamera *camera) {
  double seconds = vl_camera_time(rolling, x + 0.5, y + 0.5, 0.5);
  if (vl_camera_at(rolling, seconds, camera) != VL_OK)
    *camera = *rolling;
}

int header_camera_def(const vlImage *image, const char *path, vlCameraDef *def) {
  double whole[4], data[4], shutter[2], circle = 0.0;
  TRY(windows(image, path, whole, data));
  TRY(read_def(image, path, whole, def));
  if (def->projection == VL_PROJECTION_OPTICS)
    return report_failure(
        STATUS_SCENE,
        "%s: a lens of many elements is not taken from an image; its scene has it", path);
  if (number(image, "velo.eyeCircle", &circle) && circle != 0.0)
    return report_failure(
        STATUS_SCENE, "%s: one eye of an omnidirectional image is no camera of its own", path);
  shutter[0] = def->shutter_open;
  shutter[1] = def->shutter_close;
  take(image, "velo.lensRadius", VL_ATTRIBUTE_FLOAT, &def->lens_radius, 1);
  take(image, "focus", VL_ATTRIBUTE_FLOAT, &def->focus_distance, 1);
  take(image, "velo.shutter", VL_ATTRIBUTE_V2F, shutter, 2);
  take(image, "velo.exposureTime", VL_ATTRIBUTE_FLOAT, &def->exposure_time, 1);
  def->shutter_open = shutter[0];
  def->shutter_close = shutter[1];
  return -1;
}
