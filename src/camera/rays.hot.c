/* camera/rays.hot.c: film samples to rays, in batches. Compiled once per instruction set. */
#include "camera/rays.h"
#include "camera/lens.h"
#include "camera/orthographic.h"
#include "camera/perspective.h"

/* A world-space ray in double, not yet normalised, with what turns camera-space depth into distance along it. */
typedef struct {
  double ox, oy, oz, dx, dy, dz;
  double inv_length; /* 1 / |d| */
  double t_per_z;    /* |d| / d's depth in camera space */
} WorldRay;

static inline WorldRay place(const vlCameraCompiled *c, vlCameraLocal r) {
  const double *m = c->rotation;
  WorldRay w;
  w.ox = c->position[0] + (m[0] * r.ox + m[1] * r.oy);
  w.oy = c->position[1] + (m[3] * r.ox + m[4] * r.oy);
  w.oz = c->position[2] + (m[6] * r.ox + m[7] * r.oy);
  w.dx = m[0] * r.dx + m[1] * r.dy + m[2] * r.dz;
  w.dy = m[3] * r.dx + m[4] * r.dy + m[5] * r.dz;
  w.dz = m[6] * r.dx + m[7] * r.dy + m[8] * r.dz;
  double length = __builtin_sqrt(w.dx * w.dx + w.dy * w.dy + w.dz * w.dz);
  w.inv_length = 1.0 / length;
  w.t_per_z = length / r.dz;
  return w;
}

/* One loop, inlined once for each projection with and without a lens: the two constants are decided before it. */
static inline __attribute__((always_inline)) void ray_loop(const int orthographic, const int lens,
                                                           const vlCameraCompiled *camera, uint32_t count,
                                                           const vlCameraSamples *s, const vlCameraRays *r) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  const float *film_x = s->film_x, *film_y = s->film_y, *lens_u = s->lens_u, *lens_v = s->lens_v, *time = s->time;
  const int32_t *pixel_x = s->pixel_x, *pixel_y = s->pixel_y;
  float *ox = r->ox, *oy = r->oy, *oz = r->oz, *dx = r->dx, *dy = r->dy, *dz = r->dz;
  float *t_min = r->t_min, *t_max = r->t_max, *seconds = r->time;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    double x = (double)pixel_x[i] - c->cx + (double)film_x[i];
    double y = (double)pixel_y[i] - c->cy + (double)film_y[i];
    vlCameraLocal local = orthographic ? vl_orthographic_unproject(c, x, y) : vl_perspective_unproject(c, x, y);
    if (lens) local = vl_lens_apply(c, local, vl_lens_disk(lens_u[i], lens_v[i]));
    WorldRay w = place(c, local);
    ox[i] = (float)w.ox;
    oy[i] = (float)w.oy;
    oz[i] = (float)w.oz;
    dx[i] = (float)(w.dx * w.inv_length);
    dy[i] = (float)(w.dy * w.inv_length);
    dz[i] = (float)(w.dz * w.inv_length);
    t_min[i] = (float)(c->near_plane * w.t_per_z);
    t_max[i] = (float)(c->far_plane * w.t_per_z);
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
