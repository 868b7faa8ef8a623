/* test/camera_files/test_written.c: what is written reads back as the same camera. Random
 * cameras of every projection and distortion are written in every dialect: it is refused, or
 * what is read back projects to the same pixels. */
#include "camera_files/files.h"

#include <unistd.h>

#include "velo/distortion.h"
#include "velo/projection.h"

enum { CAMERAS = 80, POINTS = 8 };

static const char *const endings[VL_CAMERA_DIALECT_COUNT] = {
    [VL_CAMERA_DIALECT_OPENCV] = "yaml",        [VL_CAMERA_DIALECT_ROS] = "yaml",
    [VL_CAMERA_DIALECT_KALIBR] = "yaml",        [VL_CAMERA_DIALECT_GLTF] = "gltf",
    [VL_CAMERA_DIALECT_MITSUBA] = "xml",        [VL_CAMERA_DIALECT_USD] = "usda",
    [VL_CAMERA_DIALECT_EUROC] = "yaml",         [VL_CAMERA_DIALECT_CAMODOCAL] = "yaml",
    [VL_CAMERA_DIALECT_ORBSLAM] = "yaml",       [VL_CAMERA_DIALECT_OKVIS] = "yaml",
    [VL_CAMERA_DIALECT_SVO] = "yaml",           [VL_CAMERA_DIALECT_KITTI] = "txt",
    [VL_CAMERA_DIALECT_METASHAPE] = "xml",      [VL_CAMERA_DIALECT_MESHROOM] = "sfm",
    [VL_CAMERA_DIALECT_VISP] = "xml",           [VL_CAMERA_DIALECT_MIDDLEBURY] = "txt",
    [VL_CAMERA_DIALECT_MVSNET] = "txt",         [VL_CAMERA_DIALECT_BUNDLER] = "out",
    [VL_CAMERA_DIALECT_REALITYCAPTURE] = "xmp", [VL_CAMERA_DIALECT_VISUALSFM] = "nvm",
    [VL_CAMERA_DIALECT_COLLADA] = "dae",        [VL_CAMERA_DIALECT_DSO] = "txt",
    [VL_CAMERA_DIALECT_MATRIX] = "txt"};

static void set_shape(vlCameraDef *d, uint64_t *seed) {
  double *shape = d->shape;
  switch (d->projection) {
    case VL_PROJECTION_FOV:
      shape[0] = 0.9;
      break;
    case VL_PROJECTION_UNIFIED:
      shape[0] = next_between(seed, 0.3, 1.2);
      break;
    case VL_PROJECTION_DIVISION:
      shape[0] = next_between(seed, -0.3, 0.1);
      break;
    case VL_PROJECTION_EUCM:
      shape[0] = next_between(seed, 0.3, 0.7);
      shape[1] = next_between(seed, 0.8, 1.2);
      break;
    case VL_PROJECTION_DOUBLE_SPHERE:
      shape[0] = next_between(seed, -0.2, 0.3);
      shape[1] = next_between(seed, 0.4, 0.7);
      break;
    default:
      break;
  }
}

static void set_distortion(vlCameraDef *d, uint64_t *seed) {
  static const double sizes[14] = {0.1,  0.05, 0.002, 0.002, 0.01, 0.05, 0.02,
                                   5e-3, 1e-3, 1e-3,  1e-3,  1e-3, 0.02, 0.02};
  static const double radial[4] = {0.05, 0.02, 0.005, 0.001};
  static const uint32_t counts[5] = {4, 5, 8, 12, 14};
  const double which = next_unit(seed);
  if (which < 0.35) {
    d->distortion = VL_DISTORTION_OPENCV;
    d->distortion_count = counts[(int)(5 * next_unit(seed))];
  } else if (which < 0.6) {
    d->distortion = VL_DISTORTION_RADIAL;
    d->distortion_count = 1 + (uint32_t)(4 * next_unit(seed));
  } else if (which < 0.75) {
    bool aria = next_unit(seed) < 0.5;
    d->distortion = aria ? VL_DISTORTION_RAD_TAN_THIN_PRISM : VL_DISTORTION_THIN_PRISM;
    d->distortion_count = aria ? 12 : 8;
  }
  for (uint32_t i = 0; i < d->distortion_count; i++)
    d->distortion_coefficients[i] =
        next_between(seed, -1, 1) * (d->distortion == VL_DISTORTION_RADIAL ? radial : sizes)[i];
}

/* False: there is no such camera, for example of an image that shows all directions with a
 * distortion. */
static bool random_camera(uint64_t *seed, vlCameraRecord *record, vlCamera *made) {
  const double w = next_unit(seed) < 0.5 ? 640 : 101, h = next_unit(seed) < 0.5 ? 480 : 300;
  *record =
      (vlCameraRecord){.camera = vl_default_camera_def((uint32_t)w, (uint32_t)h), .frames = 1};
  vlCameraDef *d = &record->camera;
  if (next_unit(seed) < 0.7)
    d->projection = (vlProjection)(VL_PROJECTION_OWN * next_unit(seed));
  set_shape(d, seed);
  if (next_unit(seed) < 0.7) {
    d->fx = next_between(seed, 0.5, 1.5) * w;
    d->fy = next_unit(seed) < 0.5 ? d->fx : d->fx * next_between(seed, 0.9, 1.1);
  }
  if (next_unit(seed) < 0.5) {
    d->cx = 0.5 * w + next_between(seed, -20, 20);
    d->cy = 0.5 * h + next_between(seed, -20, 20);
  }
  if (next_unit(seed) < 0.15)
    d->skew = next_between(seed, -3, 3);
  set_distortion(d, seed);
  set3(d->lookat, 0, 0, 1);
  set3(d->up, 0, -1, 0);
  if (next_unit(seed) < 0.6) {
    set3(d->eye, next_between(seed, -5, 5), next_between(seed, -5, 5),
         next_between(seed, -5, 5));
    d->roll = next_between(seed, -3, 3);
  }
  return vl_camera_make(d, made, NULL, NULL) == VL_OK;
}

/* The largest difference of the projections of points that the first camera sees, pixels. */
static double difference(const vlCamera *a, const vlCamera *b, uint64_t *seed) {
  double worst = 0;
  for (int i = 0; i < POINTS; i++) {
    const double at[2] = {next_between(seed, 0.1, 0.9) * a->width,
                          next_between(seed, 0.1, 0.9) * a->height};
    double origin[3], direction[3], p[3], first[2], second[2], depth;
    if (!vl_camera_unproject(a, at[0], at[1], origin, direction))
      continue;
    for (int k = 0; k < 3; k++)
      p[k] = origin[k] + 3 * direction[k];
    if (!vl_camera_project(a, p, first, &depth))
      continue;
    if (!vl_camera_project(b, p, second, &depth))
      return INFINITY;
    for (int k = 0; k < 2; k++)
      worst = fmax(worst, fabs(first[k] - second[k]));
  }
  return worst;
}

/* Returns whether the dialect holds the camera. */
static bool there_and_back(const vlCameraRecord *record, const vlCamera *made,
                           vlCameraDialect dialect, uint64_t *seed) {
  const char *const name = vl_camera_dialect_name(dialect);
  vlCameraFileDef def = vl_default_camera_file_def();
  vlCameraRecord back;
  vlCamera again;
  vlError error;
  char file[64];
  snprintf(file, sizeof file, "%s.%s", name, endings[dialect] ? endings[dialect] : "json");
  const char *path = path_of(dialect == VL_CAMERA_DIALECT_COLMAP ? "model" : file);
  unlink(path);
  def.dialect = dialect;
  const vlResult result = vl_camera_write(context, path, &def, record, &error);
  if (result != VL_OK) {
    assert_int_equal(result, VL_ERROR_UNSUPPORTED);
    assert_true(strlen(error.message) > 0);
    return false;
  }
  def.width = made->width; /* of dialects without a size */
  def.height = made->height;
  if (vl_camera_read(context, path, &def, &back, &error) != VL_OK)
    fail_msg("%s: %s", name, error.message);
  if (vl_camera_make(&back.camera, &again, NULL, &error) != VL_OK)
    fail_msg("%s: %s", name, error.message);
  const double worst = difference(made, &again, seed);
  if (!(worst < 1e-6))
    fail_msg("%s, %s, distortion %d: %g pixels", name,
             vl_projection_name(record->camera.projection), (int)record->camera.distortion,
             worst);
  return true;
}

static void cameras_come_back(void **state) {
  (void)state;
  uint64_t seed = 38;
  uint32_t held[VL_CAMERA_DIALECT_COUNT] = {0}, cameras = 0;
  for (int i = 0; i < CAMERAS; i++) {
    vlCameraRecord record;
    vlCamera made;
    if (!random_camera(&seed, &record, &made))
      continue;
    cameras++;
    for (int dialect = 1; dialect < VL_CAMERA_DIALECT_COUNT; dialect++)
      if (dialect != VL_CAMERA_DIALECT_PBRT && dialect != VL_CAMERA_DIALECT_EXR)
        held[dialect] += there_and_back(&record, &made, (vlCameraDialect)dialect, &seed);
  }
  assert_int_equal(held[VL_CAMERA_DIALECT_VELO], cameras);
  assert_true(cameras >= CAMERAS / 3);
  static const vlCameraDialect common[] = {VL_CAMERA_DIALECT_OPENCV,  VL_CAMERA_DIALECT_COLMAP,
                                           VL_CAMERA_DIALECT_NERF,    VL_CAMERA_DIALECT_KALIBR,
                                           VL_CAMERA_DIALECT_BASALT,  VL_CAMERA_DIALECT_OPENSFM,
                                           VL_CAMERA_DIALECT_MESHROOM};
  for (size_t i = 0; i < sizeof common / sizeof *common; i++)
    assert_true(held[common[i]] > 5);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(cameras_come_back)};
  return cmocka_run_group_tests(tests, files_setup, files_teardown);
}
