/* camera/points.hot.c: pixels to directions and points to pixels in chunks of doubles, in
 * stages: affine map, distortion, projection. Each stage is a separate loop, so that any
 * projection combines with any lens without a loop per combination. Compiled once per
 * instruction set. */
#include "camera/optics_chunk.h"
#include "camera/stages.h"

#include "camera/own.h"
#include "camera/points.h"
#include "camera/pose.h"
#include "projection/orthographic.h"
#include "projection/perspective.h"
#include "velo/projection.h"

/* Removes the distortion of plane points in place, with a fixed number of Newton steps; the few
 * points that these do not reach follow one by one. radial_first: a constant, that of the map.
 */
VL_INLINE void undistort_loops(const bool radial_first, const vlDistortionMap *map,
                               uint32_t count, double *x, double *y, double *valid) {
  const vlDistortionMap copy = *map, *m = &copy;
  double u[VL_CAMERA_CHUNK], v[VL_CAMERA_CHUNK], flat_valid[VL_CAMERA_CHUNK];
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlPlanePoint flat = vl_tilt(m->untilt, x[i], y[i]);
    vlPlanePoint start = vl_distortion_start(m, flat.x, flat.y);
    u[i] = flat.x;
    v[i] = flat.y;
    x[i] = start.x;
    y[i] = start.y;
    flat_valid[i] = flat.valid;
  }
  for (uint32_t step = 0; step < m->steps; step++) {
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < count; i++) {
      vlPlanePoint p = vl_distortion_step(radial_first, m, x[i], y[i], u[i], v[i]);
      x[i] = p.x;
      y[i] = p.y;
    }
  }
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) valid[i] =
      flat_valid[i] * vl_distortion_check(radial_first, m, x[i], y[i], u[i], v[i]);
  for (uint32_t i = 0; i < count; i++) {
    if (valid[i] > 0.0 || !(flat_valid[i] > 0.0))
      continue;
    vlPlanePoint p = vl_distortion_invert(m, u[i], v[i]);
    x[i] = p.x;
    y[i] = p.y;
    valid[i] = p.valid;
  }
}

static void undistort(const vlDistortionMap *map, uint32_t count, double *x, double *y,
                      double *valid) {
  if (map->radial_first)
    undistort_loops(true, map, count, x, y, valid);
  else
    undistort_loops(false, map, count, x, y, valid);
}

VL_INLINE void distort_loop(const bool radial_first, const vlDistortionMap *map, uint32_t count,
                            double *x, double *y, double *valid) {
  const vlDistortionMap copy = *map, *m = &copy;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlPlanePoint p = vl_distortion_apply(radial_first, m, x[i], y[i]);
    x[i] = p.x;
    y[i] = p.y;
    valid[i] *= p.valid;
  }
}

static void distort(const vlDistortionMap *map, uint32_t count, double *x, double *y,
                    double *valid) {
  if (map->radial_first)
    distort_loop(true, map, count, x, y, valid);
  else
    distort_loop(false, map, count, x, y, valid);
}

VL_INLINE void plane_loop(vlProjection kind, const vlCameraCompiled *camera, uint32_t count,
                          vlDirections *d) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  const int inclined = kind == VL_PROJECTION_PERSPECTIVE;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlDirection r = vl_plane_unproject(kind, c, d->face[i], d->x[i], d->y[i]);
    r = vl_direction_finish(inclined, r, d->valid[i]);
    d->dx[i] = r.x;
    d->dy[i] = r.y;
    d->dz[i] = r.z;
    d->valid[i] = r.valid;
  }
}

void vl_camera_directions(const vlCameraCompiled *c, uint32_t count, vlDirections *d) {
  const double skew_ratio = c->skew_ratio, inv_fx = c->inv_fx, inv_fy = c->inv_fy;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    d->x[i] = (d->x[i] - skew_ratio * d->y[i]) * inv_fx;
    d->y[i] = d->y[i] * inv_fy;
    d->valid[i] = 1.0;
  }
  if (c->distortion.steps > 0)
    undistort(&c->distortion, count, d->x, d->y, d->valid);
  switch (c->projection) {
#define PLANE_LOOP(kind, name, row) \
  case kind:                        \
    plane_loop(kind, c, count, d);  \
    break;
    VL_PROJECTION_KINDS(PLANE_LOOP)
#undef PLANE_LOOP
    case VL_PROJECTION_OWN:
      break;
  }
}

VL_INLINE void to_world_loop(const int eyes, const vlCameraCompiled *camera, uint32_t count,
                             const double *dx, const double *dy, const double *dz,
                             const double *valid, vlCameraPoints *out) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlWorldRay w = vl_camera_to_world(c, (vlCameraLocal){0.0, 0.0, dx[i], dy[i], dz[i]});
    if (eyes)
      w = vl_camera_offset_eye(c, vl_eye_offset(c->eye_circle, dx[i], dz[i]), w);
    int good = valid[i] > 0.0;
    vl_store_world_ray(out, i, good, w);
    out->valid[i] = valid[i];
  }
}

/* Only film points that are not finite are invalid. */
VL_INLINE void plain_loop(const int orthographic, const vlCameraCompiled *camera,
                          uint32_t count, const vlCameraPixels *in, vlCameraPoints *out) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    double x = in->x[i] - c->cx, y = in->y[i] - c->cy;
    vlCameraLocal r =
        orthographic ? vl_orthographic_unproject(c, x, y) : vl_perspective_unproject(c, x, y);
    vlWorldRay w = vl_camera_to_world(c, r);
    double sum = w.dx * w.inv_length + w.dy * w.inv_length + w.dz * w.inv_length;
    int good = sum - sum == 0.0 && x - x == 0.0 && y - y == 0.0;
    vl_store_world_ray(out, i, good, w);
    out->valid[i] = good ? 1.0 : 0.0;
  }
}

static void own_unproject(const vlCameraCompiled *c, uint32_t n, const vlCameraPixels *in,
                          vlCameraPoints *out) {
  vlOwnRows rows;
  vl_own_chief_rays(c, n, in->x, in->y, &rows);
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    vlWorldRay w;
    int good = vl_own_ray_at(c, &rows, i, &w);
    vl_store_world_ray(out, i, good, w);
    out->valid[i] = good ? 1.0 : 0.0;
  }
}

void vl_camera_unproject_chunk(const vlCameraCompiled *c, uint32_t n, const vlCameraPixels *in,
                               vlCameraPoints *out) {
  uint32_t count = VL_PAD(n);
  if (c->own) {
    own_unproject(c, n, in, out);
  } else if (c->optics) {
    vl_optics_unproject_chunk(c, count, in, out);
  } else if (c->projection == VL_PROJECTION_ORTHOGRAPHIC) {
    plain_loop(1, c, count, in, out);
  } else if (c->plain) {
    plain_loop(0, c, count, in, out);
  } else {
    vlDirections d;
    for (uint32_t i = 0; i < count; i++) {
      d.x[i] = in->x[i] - c->cx;
      d.y[i] = in->y[i] - c->cy;
      vlPlanePoint p = vl_pixel_to_plane(c, d.x[i], d.y[i]);
      d.face[i] = vl_cube_cell(p.x, p.y);
    }
    vl_camera_directions(c, count, &d);
    if (c->eye_circle != 0.0)
      to_world_loop(1, c, count, d.dx, d.dy, d.dz, d.valid, out);
    else
      to_world_loop(0, c, count, d.dx, d.dy, d.dz, d.valid, out);
  }
}

VL_INLINE void project_loop(vlProjection kind, const int eyes, const vlCameraCompiled *camera,
                            uint32_t count, const vlCameraPoints *in, vlCameraPixels *out) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  const double *m = c->camera_from_world;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    double wx = in->x[i], wy = in->y[i], wz = in->z[i];
    double x = m[0] * wx + m[1] * wy + m[2] * wz + m[3],
           y = m[4] * wx + m[5] * wy + m[6] * wz + m[7];
    double z = m[8] * wx + m[9] * wy + m[10] * wz + m[11];
    vlDirection d = {x, y, z, 1.0};
    if (eyes)
      d = vl_eye_direction(c->eye_circle, x, y, z);
    vlPlanePoint p = vl_plane_project(kind, c, d.x, d.y, d.z);
    p.valid *= d.valid;
    out->x[i] = p.x;
    out->y[i] = p.y;
    out->z[i] = z;
    out->valid[i] = p.valid;
  }
}

static void own_project(const vlCameraCompiled *c, uint32_t n, const vlCameraPoints *in,
                        vlCameraPixels *out) {
  const double *m = c->camera_from_world;
  double x[VL_CAMERA_CHUNK] = {0}, y[VL_CAMERA_CHUNK] = {0}, z[VL_CAMERA_CHUNK] = {0};
  for (uint32_t i = 0; i < n; i++) {
    double wx = in->x[i], wy = in->y[i], wz = in->z[i];
    x[i] = m[0] * wx + m[1] * wy + m[2] * wz + m[3];
    y[i] = m[4] * wx + m[5] * wy + m[6] * wz + m[7];
    z[i] = m[8] * wx + m[9] * wy + m[10] * wz + m[11];
  }
  vl_own_pixels(c, n, x, y, z, out->x, out->y);
  for (uint32_t i = 0; i < n; i++) {
    int seen = out->x[i] == out->x[i];
    out->x[i] = seen ? out->x[i] : 0.0;
    out->y[i] = seen ? out->y[i] : 0.0;
    out->z[i] = seen ? z[i] : 0.0;
    out->valid[i] = seen ? 1.0 : 0.0;
  }
}

void vl_camera_project_chunk(const vlCameraCompiled *camera, uint32_t n,
                             const vlCameraPoints *in, vlCameraPixels *out) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  uint32_t count = VL_PAD(n);
  if (c->own) {
    own_project(c, n, in, out);
    return;
  }
  if (c->optics) {
    vl_optics_project_chunk(c, count, in, out);
    return;
  }
#define PROJECT_LOOP(kind, name, row)         \
  case kind:                                  \
    project_loop(kind, 0, c, count, in, out); \
    break;
#define EYES_LOOP(kind)      \
  if (c->projection == kind) \
    project_loop(kind, 1, c, count, in, out);
  if (c->eye_circle != 0.0) {
    VL_ROUND_PROJECTIONS(EYES_LOOP)
  } else {
    switch (c->projection) {
      VL_PROJECTION_KINDS(PROJECT_LOOP)
      case VL_PROJECTION_OWN:
        break;
    }
  }
#undef EYES_LOOP
#undef PROJECT_LOOP
  if (c->distortion.steps > 0)
    distort(&c->distortion, count, out->x, out->y, out->valid);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlPlanePoint p = vl_plane_to_pixel(c, (vlPlanePoint){out->x[i], out->y[i], out->valid[i]});
    out->x[i] = p.x;
    out->y[i] = p.y;
    out->valid[i] = p.valid;
    out->z[i] = p.valid > 0.0 ? out->z[i] : 0.0;
  }
}
