/* conformance/vignetting.h: the law of natural vignetting: each ray of an image has the weight
 * cos^4 of its angle from the axis, of straight and of distorted cameras. */
#ifndef TEST_CONFORMANCE_VIGNETTING_H
#define TEST_CONFORMANCE_VIGNETTING_H

#include "camera/rays.h"
#include "camera_rays.h"
#include "cameras.h"
#include "conformance.h"
#include "unit.h"

static void check_vignetting(const char *name, vlCameraDef *def) {
  static CameraRays r;
  static float x[WAYS], weight[WAYS];
  static int32_t column[WAYS], row[WAYS];
  vlCamera camera;
  vlCameraCompiled c;
  uint32_t compared = 0;
  uint32_t wrong = 0;
  def->lens.vignetting = true;
  if (!make_camera("distortions", name, def, &camera))
    return;
  vl_camera_compile(&camera, &c);
  for (uint32_t i = 0; i < WAYS; i++) {
    column[i] = (int32_t)(i * 7 % camera.width);
    row[i] = (int32_t)(i * 11 % camera.height);
    x[i] = (float)(i % 5) / 5;
  }
  const vlCameraSamples samples = {x, x, column, row, x, x, x};
  const vlCameraRays rays = {r.o[0],  r.o[1],  r.o[2], r.d[0],  r.d[1], r.d[2],
                             r.t_min, r.t_max, r.time, r.valid, weight};
  vl_camera_kernels(VL_ISA_AUTO)->rays(&c, WAYS, &samples, &rays);
  for (uint32_t i = 0; i < WAYS; i++) {
    if (!(r.valid[i] > 0))
      continue;
    const double cosine = (double)r.d[2][i]; /* make_camera: z is forward */
    compared++;
    wrong += !(fabs((double)weight[i] - pow(cosine, 4)) < 1e-5);
  }
  if (wrong || compared < WAYS / 2)
    broken("distortions", name, "vignetting: %u of %u weights are not cos^4", wrong, compared);
}

static void vignetting_of_cameras(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(FILM_WIDTH, FILM_HEIGHT);
  def.fov = 1.2;
  check_vignetting("none", &def);
  def.distortion = VL_DISTORTION_OPENCV;
  def.distortion_count = 5;
  def.distortion_coefficients[0] = -0.05;
  def.distortion_coefficients[2] = 0.01;
  check_vignetting("opencv", &def);
  expect_no_failures();
}

#endif
