/* render/autofocus.c: autofocus. One exact ray per pixel gives the distance of the visible
 * surface; the focus distance is chosen from these distances. */
#include "velo/focus.h"

#include <math.h>

#include "base/error.h"
#include "camera/parts.h"
#include "camera/rays.h"
#include "math/double3.h"
#include "render/camera_view.h"

/* The part of the ray between the near and far planes (t_min, t_max), from the kernel that
 * makes the image's camera rays. */
static void find_ends(const vlCamera *camera, vlIsa isa, double x, double y, float *t_min,
                      float *t_max) {
  float rows[12][VL_LANES];
  int32_t px[VL_LANES], py[VL_LANES];
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  double fx = floor(x), fy = floor(y);
  for (int i = 0; i < VL_LANES; i++) {
    px[i] = (int32_t)fx;
    py[i] = (int32_t)fy;
    rows[0][i] = (float)(x - fx);
    rows[1][i] = (float)(y - fy);
    rows[2][i] = 0.5f;
  }
  vlCameraSamples samples = {rows[0], rows[1], px, py, rows[2], rows[2], rows[2]};
  vlCameraRays rays = {.ox = rows[3],
                       .oy = rows[4],
                       .oz = rows[5],
                       .dx = rows[6],
                       .dy = rows[7],
                       .dz = rows[8],
                       .t_min = rows[9],
                       .t_max = rows[10],
                       .time = rows[11]};
  vl_camera_kernels(isa)->rays(&c, 1, &samples, &rays);
  *t_min = rows[9][0];
  *t_max = rows[10][0];
}

static vlResult look(const vlWorld *world, const vlCamera *camera, double x, double y,
                     double point[3], vlError *error) {
  vlIsa isa = vl_context_isa(world->context);
  vlCamera pinhole = vl_opening_pinhole(camera);
  double o[3], d[3];
  if (!vl_camera_unproject(&pinhole, x, y, o, d))
    return vl_fail_argument(
        error, "camera: focus on pixel %g, %g: the camera sees nothing there", x, y);
  vlGroundTruthBatch *batch = vl_alloc_zero(world->context, 1, sizeof *batch);
  vlResult result = batch ? VL_OK : vl_fail_memory(error);
  if (result == VL_OK) {
    batch->n = 1;
    for (int i = 0; i < 3; i++) {
      batch->o[i][0] = o[i];
      batch->d[i][0] = d[i];
    }
    find_ends(&pinhole, isa, x, y, &batch->t_min[0], &batch->t_max[0]);
    result = vl_first_hits(world, isa, batch, error);
  }
  if (result == VL_OK) {
    double t = batch->distance[0];
    vl_along3(o, t, d, point);
    if (batch->object[0] == 0 || !isfinite(t))
      result =
          vl_fail_argument(error, "camera: focus on pixel %g, %g: nothing is seen there", x, y);
  }
  vl_free(world->context, batch);
  return result;
}

vlResult vl_autofocus(const vlWorld *world, const vlCamera *camera, double x, double y,
                      double *distance, vlError *error) {
  vl_error_clear(error);
  if (!world || !camera || !distance)
    return vl_fail_argument(error, "autofocus: world, camera or distance is null");
  if (!(x >= 0 && y >= 0 && x <= camera->width && y <= camera->height))
    return vl_fail_argument(error,
                            "camera: focus on pixel %g, %g: outside the image of %u x %u", x, y,
                            camera->width, camera->height);
  double point[3], f;
  VL_TRY(look(world, camera, x, y, point, error));
  if (!vl_camera_focus_at(camera, point, &f))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: focus on pixel %g, %g: no plane with the lens's tilt goes through what "
        "is seen there",
        x, y);
  *distance = f;
  return VL_OK;
}

vlResult vl_camera_autofocus(const vlWorld *world, vlCamera *camera, vlError *error) {
  vl_error_clear(error);
  if (!world || !camera)
    return vl_fail_argument(error, "camera autofocus: world or camera is null");
  double *pixel = camera->lens.focus_pixel;
  double distance = 0;
  if (vl_is_unset(pixel[0]) || vl_is_unset(pixel[1]))
    return VL_OK;
  VL_TRY(vl_autofocus(world, camera, pixel[0], pixel[1], &distance, error));
  camera->focus_distance = distance;
  pixel[0] = pixel[1] = VL_UNSET;
  return VL_OK;
}
