/* camera/rays.hot.c: film samples to rays, in batches. Compiled once per instruction set. */
#include "camera/rays.h"
#include "camera/lens.h"
#include "camera/orthographic.h"
#include "camera/perspective.h"
#include "camera/place.h"

/* One loop, inlined once for each projection with and without a lens: the two constants are decided before it. */
static inline __attribute__((always_inline)) void ray_loop(const int orthographic, const int lens,
                                                           const vlCameraCompiled *camera, uint32_t count,
                                                           const vlCameraSamples *s, const vlCameraRays *r) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  const float *film_x = s->film_x, *film_y = s->film_y, *lens_u = s->lens_u, *lens_v = s->lens_v, *time = s->time;
  const int32_t *pixel_x = s->pixel_x, *pixel_y = s->pixel_y;
  float *ox = r->ox, *oy = r->oy, *oz = r->oz, *dx = r->dx, *dy = r->dy, *dz = r->dz;
  float *t_min = r->t_min, *t_max = r->t_max, *seconds = r->time;
  /* planes z = near, far in distance along the ray, per length of its direction: its depth is the same for all */
  double depth = orthographic ? 1.0 : c->focal, near_t = c->near_plane / depth, far_t = c->far_plane / depth;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    double x = (double)pixel_x[i] - c->cx + (double)film_x[i];
    double y = (double)pixel_y[i] - c->cy + (double)film_y[i];
    vlCameraLocal local = orthographic ? vl_orthographic_unproject(c, x, y) : vl_perspective_unproject(c, x, y);
    if (lens) local = vl_lens_apply(c, local, vl_lens_disk(lens_u[i], lens_v[i]));
    vlWorldRay w = vl_camera_place(c, local);
    ox[i] = (float)w.ox;
    oy[i] = (float)w.oy;
    oz[i] = (float)w.oz;
    dx[i] = (float)(w.dx * w.inv_length);
    dy[i] = (float)(w.dy * w.inv_length);
    dz[i] = (float)(w.dz * w.inv_length);
    t_min[i] = (float)(near_t * w.length);
    t_max[i] = (float)(far_t * w.length);
    seconds[i] = (float)(c->shutter_open + c->shutter_time * (double)time[i]);
  }
}

static void rays(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s, const vlCameraRays *r) {
  uint32_t count = VL_PAD(n);
  switch (c->projection) {
    case VL_PROJECTION_PERSPECTIVE:
      if (c->has_lens)
        ray_loop(0, 1, c, count, s, r);
      else
        ray_loop(0, 0, c, count, s, r);
      break;
    case VL_PROJECTION_ORTHOGRAPHIC:
      if (c->has_lens)
        ray_loop(1, 1, c, count, s, r);
      else
        ray_loop(1, 0, c, count, s, r);
      break;
  }
}

extern const vlCameraKernels VL_HOT(vl_camera_kernels);
const vlCameraKernels VL_HOT(vl_camera_kernels) = {rays};
