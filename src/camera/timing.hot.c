/* camera/timing.hot.c: times of rays for shutter curves, rolling shutters and moving cameras.
 * Runs after the rays are made in camera space. Compiled once per instruction set. */
#include "camera/rays.h"
#include "camera/stages.h"

typedef struct Moved {
  double ox, oy, oz, dx, dy, dz, length;
} Moved;

static inline Moved move_ray(vlAffine a, double ox, double oy, double oz, double dx, double dy,
                             double dz) {
  const double *m = a.m;
  Moved r;
  r.ox = a.p[0] + (m[0] * ox + m[1] * oy + m[2] * oz);
  r.oy = a.p[1] + (m[3] * ox + m[4] * oy + m[5] * oz);
  r.oz = a.p[2] + (m[6] * ox + m[7] * oy + m[8] * oz);
  r.dx = m[0] * dx + m[1] * dy + m[2] * dz;
  r.dy = m[3] * dx + m[4] * dy + m[5] * dz;
  r.dz = m[6] * dx + m[7] * dy + m[8] * dz;
  r.length = __builtin_sqrt(r.dx * r.dx + r.dy * r.dy + r.dz * r.dz);
  return r;
}

/* Transforms each ray from camera space to the world at the ray's own time. t_min and t_max are
 * rescaled so that they denote the same points. */
static void move_chunk(const vlCameraTime *time, uint32_t count, const double *when,
                       const vlCameraRays *all, uint32_t first) {
  const vlCameraTime copy = *time, *t = &copy;
  const vlCameraRays r = vl_camera_rays_from(all, first);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    double f = (when[i] - t->pose_open) * t->pose_rate;
    f = f > 0.0 ? f : 0.0;
    f = f < 1.0 ? f : 1.0;
    Moved w = move_ray(vl_motion_between(&t->motion, f), (double)r.ox[i], (double)r.oy[i],
                       (double)r.oz[i], (double)r.dx[i], (double)r.dy[i], (double)r.dz[i]);
    double inverse = 1.0 / w.length;
    r.ox[i] = (float)w.ox;
    r.oy[i] = (float)w.oy;
    r.oz[i] = (float)w.oz;
    r.dx[i] = (float)(w.dx * inverse);
    r.dy[i] = (float)(w.dy * inverse);
    r.dz[i] = (float)(w.dz * inverse);
    r.t_min[i] = (float)((double)r.t_min[i] * w.length);
    r.t_max[i] = (float)((double)r.t_max[i] * w.length);
  }
}

void vl_camera_time_rays(const vlCameraCompiled *c, uint32_t count, const vlCameraSamples *s,
                         const vlCameraRays *r) {
  const vlCameraTime *t = &c->when;
  double when[VL_CAMERA_CHUNK];
  for (uint32_t first = 0; first < count; first += VL_CAMERA_CHUNK) {
    uint32_t n = count - first < VL_CAMERA_CHUNK ? count - first : VL_CAMERA_CHUNK;
    for (uint32_t i = 0; i < n; i++) {
      uint32_t k = first + i;
      when[i] = vl_camera_seconds(c, s->pixel_x[k], s->pixel_y[k], s->time[k]);
      r->time[k] = (float)when[i];
    }
    if (t->moves)
      move_chunk(t, n, when, r, first);
  }
}
