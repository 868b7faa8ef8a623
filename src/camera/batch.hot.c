/* camera/batch.hot.c: film samples to rays, in batches. Compiled once per instruction set. */
#include "camera/eyes.h"
#include "camera/lens.h"
#include "camera/own.h"
#include "camera/pose.h"
#include "camera/rays.h"
#include "camera/stages.h"
#include "projection/cube.h"
#include "projection/orthographic.h"
#include "projection/perspective.h"

/* The kinds of lens. lens_u and lens_v are random numbers for DISC, and points of the aperture
 * for POINTS. For OPTICS, rays start at d->x, d->y. */
enum { NO_LENS, DISC, POINTS, OPTICS };

/* The loop is inlined once for each projection and kind of lens; the caller passes both as
 * constants. */
VL_INLINE void ray_loop(const int orthographic, const int lens, const vlCameraCompiled *camera,
                        uint32_t count, const vlCameraSamples *s, const vlCameraRays *r) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  /* the planes z = near, far as multiples of the unnormalised direction, whose depth is the
   * same for all rays */
  double depth = orthographic ? 1.0 : c->focal, near_t = c->near_plane / depth,
         far_t = c->far_plane / depth;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    double x = (double)s->pixel_x[i] - c->cx + (double)s->film_x[i];
    double y = (double)s->pixel_y[i] - c->cy + (double)s->film_y[i];
    vlCameraLocal local =
        orthographic ? vl_orthographic_unproject(c, x, y) : vl_perspective_unproject(c, x, y);
    if (lens == DISC)
      local = vl_lens_apply(c, local, vl_lens_disk(s->lens_u[i], s->lens_v[i]));
    if (lens == POINTS)
      local = vl_lens_refract(c, local, (vlLensPoint){s->lens_u[i], s->lens_v[i]});
    vlWorldRay w = vl_camera_to_world(c, local);
    r->ox[i] = (float)w.ox;
    r->oy[i] = (float)w.oy;
    r->oz[i] = (float)w.oz;
    r->dx[i] = (float)(w.dx * w.inv_length);
    r->dy[i] = (float)(w.dy * w.inv_length);
    r->dz[i] = (float)(w.dz * w.inv_length);
    r->t_min[i] = (float)(near_t * w.length);
    r->t_max[i] = (float)(far_t * w.length);
    r->time[i] = (float)(c->shutter_open + c->shutter_time * (double)s->time[i]);
  }
}

/* Finishes the rays of a chunk from known directions, for samples from `first` on. */
VL_INLINE void world_loop(const int lens, const int eyes, const vlCameraCompiled *camera,
                          uint32_t first, uint32_t count, const vlDirections *d,
                          const vlCameraSamples *s, const vlCameraRays *all) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  const float *lens_u = s->lens_u + (lens == DISC ? first : 0),
              *lens_v = s->lens_v + (lens == DISC ? first : 0);
  const float *time = s->time + first;
  const vlCameraRays r = vl_camera_rays_from(all, first);
  const double near_z = c->near_plane, far_z = c->far_plane;
  const double flat = c->ahead && !c->inclined ? 1.0 : 0.0;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlCameraLocal local = {0.0, 0.0, d->dx[i], d->dy[i], d->dz[i]};
    /* Depth: dz for cameras with `ahead`, else 1 (perspective directions have z = 1, others
     * unit length). */
    double ahead = local.dz > VL_TINY ? local.dz : VL_TINY;
    double depth = flat * ahead + (1.0 - flat);
    if (lens == DISC)
      local = vl_lens_apply_at(c, local, vl_lens_disk(lens_u[i], lens_v[i]), depth);
    if (lens == POINTS)
      local = vl_lens_refract(c, local, (vlLensPoint){lens_u[i], lens_v[i]});
    if (lens == OPTICS) {
      local.ox = d->x[i];
      local.oy = d->y[i];
    }
    vlWorldRay w = vl_camera_to_world(c, local);
    if (eyes)
      w = vl_camera_offset_eye(c, vl_eye_offset(c->eye_circle, d->dx[i], d->dz[i]), w);
    int good = d->valid[i] > 0.0;
    r.ox[i] = (float)w.ox;
    r.oy[i] = (float)w.oy;
    r.oz[i] = (float)w.oz;
    r.dx[i] = (float)(w.dx * w.inv_length);
    r.dy[i] = (float)(w.dy * w.inv_length);
    r.dz[i] = (float)(w.dz * w.inv_length);
    r.t_min[i] = (float)(good ? near_z / depth * w.length : 0.0);
    r.t_max[i] = (float)(good ? far_z / depth * w.length : -1.0);
    r.time[i] = (float)(c->shutter_open + c->shutter_time * (double)time[i]);
  }
}

/* Computes the natural vignetting of a chunk: cos^4 of the angle between the axis and the
 * direction of the film point, seen from the lens's centre. */
static void weigh_plain(const vlCameraCompiled *c, uint32_t count, const vlCameraSamples *s,
                        float *weight) {
  for (uint32_t i = 0; i < count; i++) {
    double x = (double)s->pixel_x[i] - c->cx + (double)s->film_x[i];
    double y = (double)s->pixel_y[i] - c->cy + (double)s->film_y[i];
    vlCameraLocal l = vl_perspective_unproject(c, x, y);
    double square = l.dz * l.dz / (l.dx * l.dx + l.dy * l.dy + l.dz * l.dz);
    weight[i] = (float)(square * square);
  }
}
static void weigh_staged(uint32_t count, const vlDirections *d, float *weight) {
  for (uint32_t i = 0; i < count; i++) {
    double square = 1.0 / (d->dx[i] * d->dx[i] + d->dy[i] * d->dy[i] + 1.0); /* z = 1 */
    weight[i] = (float)(square * square);
  }
}

/* Rays of all cameras that are neither plain perspective nor orthographic. */
static void staged_rays(const vlCameraCompiled *c, uint32_t count, const vlCameraSamples *s,
                        const vlCameraRays *r) {
  const double cx = c->cx, cy = c->cy, inv_fx = c->inv_fx, inv_fy = c->inv_fy;
  vlDirections d;
  for (uint32_t first = 0; first < count; first += VL_CAMERA_CHUNK) {
    uint32_t n = count - first < VL_CAMERA_CHUNK ? count - first : VL_CAMERA_CHUNK;
    const float *film_x = s->film_x + first, *film_y = s->film_y + first;
    const int32_t *pixel_x = s->pixel_x + first, *pixel_y = s->pixel_y + first;
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < n; i++) {
      double x = (double)pixel_x[i] - cx, y = (double)pixel_y[i] - cy;
      d.face[i] = vl_cube_cell((x + 0.5) * inv_fx, (y + 0.5) * inv_fy);
      d.x[i] = x + (double)film_x[i];
      d.y[i] = y + (double)film_y[i];
    }
    vl_camera_directions(c, n, &d);
    if (c->shaped) {
      float x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK];
      vl_lens_points(c, n, s->lens_u + first, s->lens_v + first, x, y);
      vlCameraSamples points = *s;
      points.lens_u = x;
      points.lens_v = y;
      world_loop(POINTS, 1, c, first, n, &d, &points, r);
    } else if (c->has_lens && c->eye_circle != 0.0) {
      world_loop(DISC, 1, c, first, n, &d, s, r);
    } else if (c->has_lens) {
      world_loop(DISC, 0, c, first, n, &d, s, r);
    } else if (c->eye_circle != 0.0) {
      world_loop(NO_LENS, 1, c, first, n, &d, s, r);
    } else {
      world_loop(NO_LENS, 0, c, first, n, &d, s, r);
    }
    if (r->weight && c->vignetting)
      weigh_staged(n, &d, r->weight + first);
    for (uint32_t i = 0; r->valid && i < n; i++)
      r->valid[first + i] = (float)d.valid[i];
  }
}

/* Rays of a plain camera with a shaped lens. */
static void shaped_rays(const vlCameraCompiled *c, uint32_t count, const vlCameraSamples *s,
                        const vlCameraRays *r) {
  float x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK];
  for (uint32_t first = 0; first < count; first += VL_CAMERA_CHUNK) {
    uint32_t n = count - first < VL_CAMERA_CHUNK ? count - first : VL_CAMERA_CHUNK, k = first;
    vl_lens_points(c, n, s->lens_u + k, s->lens_v + k, x, y);
    vlCameraSamples samples = {
        s->film_x + k, s->film_y + k, s->pixel_x + k, s->pixel_y + k, x, y, s->time + k};
    const vlCameraRays out = vl_camera_rays_from(r, k);
    if (c->projection == VL_PROJECTION_ORTHOGRAPHIC)
      ray_loop(1, POINTS, c, n, &samples, &out);
    else
      ray_loop(0, POINTS, c, n, &samples, &out);
  }
}

static void optics_rays(const vlCameraCompiled *c, uint32_t count, const vlCameraSamples *s,
                        const vlCameraRays *r) {
  vlDirections d;
  double seen[VL_CAMERA_CHUNK];
  for (uint32_t first = 0; first < count; first += VL_CAMERA_CHUNK) {
    uint32_t n = count - first < VL_CAMERA_CHUNK ? count - first : VL_CAMERA_CHUNK;
    for (uint32_t i = 0, k = first; i < n; i++, k++) {
      d.x[i] = (double)s->pixel_x[k] - c->cx + (double)s->film_x[k];
      d.y[i] = (double)s->pixel_y[k] - c->cy + (double)s->film_y[k];
    }
    vl_camera_optics(c, n, s->lens_u + first, s->lens_v + first, &d, seen,
                     r->weight ? r->weight + first : NULL);
    world_loop(OPTICS, 0, c, first, n, &d, s, r);
    for (uint32_t i = 0; r->valid && i < n; i++)
      r->valid[first + i] = (float)seen[i];
  }
}

/* A ray that is not finite, or whose weight is negative, stands for a sample that is left out:
 * weight NaN. */
static void own_world_loop(const vlCameraCompiled *camera, uint32_t count,
                           const vlOwnRows *rows, const vlCameraRays *all, uint32_t first,
                           float *valid, float *weight) {
  const vlCameraCompiled copy = *camera, *c = &copy;
  const vlCameraRays r = vl_camera_rays_from(all, first);
  const double near_plane = c->near_plane, far_plane = c->far_plane;
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    double x = rows->dx[i], y = rows->dy[i], z = rows->dz[i], factor = rows->weight[i];
    double length = vl_length_3d(x, y, z);
    vlWorldRay w = vl_own_to_world(c, rows->ox[i], rows->oy[i], rows->oz[i], x, y, z);
    double sum = w.ox + w.oy + w.oz + length + factor;
    int none = length == 0.0, bad = !(sum - sum == 0.0) || !(factor >= 0.0);
    int good = !none && !bad;
    r.ox[i] = (float)(good ? w.ox : 0.0);
    r.oy[i] = (float)(good ? w.oy : 0.0);
    r.oz[i] = (float)(good ? w.oz : 0.0);
    r.dx[i] = (float)(good ? w.dx * w.inv_length : 0.0);
    r.dy[i] = (float)(good ? w.dy * w.inv_length : 0.0);
    r.dz[i] = (float)(good ? w.dz * w.inv_length : 1.0);
    r.t_min[i] = (float)(good ? near_plane / length * w.length : 0.0);
    r.t_max[i] = (float)(good && factor > 0.0 ? far_plane / length * w.length : -1.0);
    valid[i] = none ? 0.0f : 1.0f;
    weight[i] = (float)(bad ? (double)__builtin_nan("") : factor);
  }
}

/* Rays of a camera of one's own. n is not padded: its functions get the samples alone. */
static void own_rays(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s,
                     const vlCameraRays *r) {
  vlOwnRows rows;
  float valid[VL_OWN_BATCH], weight[VL_OWN_BATCH];
  for (uint32_t first = 0; first < n; first += VL_OWN_BATCH) {
    uint32_t m = n - first < VL_OWN_BATCH ? n - first : VL_OWN_BATCH, count = VL_PAD(m);
    const float *film_x = s->film_x + first, *film_y = s->film_y + first,
                *time = s->time + first;
    const int32_t *pixel_x = s->pixel_x + first, *pixel_y = s->pixel_y + first;
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < count; i++) {
      rows.x[i] = ((double)pixel_x[i] - c->cx + (double)film_x[i]) * c->inv_fx;
      rows.y[i] = ((double)pixel_y[i] - c->cy + (double)film_y[i]) * c->inv_fy;
      rows.lens_u[i] = (double)s->lens_u[first + i];
      rows.lens_v[i] = (double)s->lens_v[first + i];
    }
    for (uint32_t i = 0; i < count; i++) {
      double seconds = c->when.timed ? vl_camera_seconds(c, pixel_x[i], pixel_y[i], time[i])
                                     : c->shutter_open + c->shutter_time * (double)time[i];
      r->time[first + i] = (float)seconds;
      rows.time[i] = c->own_from + c->own_clock * seconds;
    }
    vl_own_rays(c, m, &rows);
    own_world_loop(c, count, &rows, r, first, valid, weight);
    for (uint32_t i = 0; r->valid && i < count; i++)
      r->valid[first + i] = valid[i];
    for (uint32_t i = 0; r->weight && i < count; i++)
      r->weight[first + i] = weight[i];
  }
}

static void still_rays(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s,
                       const vlCameraRays *r) {
  uint32_t count = VL_PAD(n);
  if (c->own) {
    own_rays(c, n, s, r);
    return;
  }
  if (c->optics) {
    optics_rays(c, count, s, r);
    return;
  }
  if (!c->plain) {
    staged_rays(c, count, s, r);
    return;
  }
  if (c->shaped) {
    shaped_rays(c, count, s, r);
  } else if (c->projection == VL_PROJECTION_ORTHOGRAPHIC) {
    if (c->has_lens)
      ray_loop(1, DISC, c, count, s, r);
    else
      ray_loop(1, NO_LENS, c, count, s, r);
  } else {
    if (c->has_lens)
      ray_loop(0, DISC, c, count, s, r);
    else
      ray_loop(0, NO_LENS, c, count, s, r);
  }
  if (r->weight && c->vignetting)
    weigh_plain(c, count, s, r->weight);
  for (uint32_t i = 0; r->valid && i < count; i++)
    r->valid[i] = 1.0f;
}

/* Time is applied last: a moving camera makes its rays in its own space. */
static void rays(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s,
                 const vlCameraRays *r) {
  if (c->when.moves) {
    vlCameraCompiled here = *c;
    for (int i = 0; i < 9; i++)
      here.rotation[i] = i % 4 ? 0.0 : 1.0;
    for (int i = 0; i < 3; i++)
      here.position[i] = 0.0;
    still_rays(&here, n, s, r);
  } else {
    still_rays(c, n, s, r);
  }
  if (c->when.timed)
    vl_camera_time_rays(c, VL_PAD(n), s, r);
}

const vlCameraKernels vl_camera_kernel_table = {rays, vl_camera_unproject_chunk,
                                                vl_camera_project_chunk};
