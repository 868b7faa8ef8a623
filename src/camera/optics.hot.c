/* camera/optics.hot.c: traces film samples through a lens of many elements, one chunk and one
 * surface at a time. Compiled once per instruction set. */
#include "camera/optics.h"
#include "camera/lens.h"
#include "camera/stages.h"

typedef struct {
  double x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK], z[VL_CAMERA_CHUNK];
  double dx[VL_CAMERA_CHUNK], dy[VL_CAMERA_CHUNK], dz[VL_CAMERA_CHUNK];
  double alive[VL_CAMERA_CHUNK], weight[VL_CAMERA_CHUNK];
} Bundle;

static inline vlOpticsRay load(const Bundle *b, uint32_t i) {
  return (vlOpticsRay){b->x[i], b->y[i], b->z[i], b->dx[i], b->dy[i], b->dz[i], b->alive[i]};
}
static inline void store(Bundle *b, uint32_t i, vlOpticsRay r) {
  b->x[i] = r.x;
  b->y[i] = r.y;
  b->z[i] = r.z;
  b->dx[i] = r.dx;
  b->dy[i] = r.dy;
  b->dz[i] = r.dz;
  b->alive[i] = r.alive;
}

/* Rays from the film to points of the exit pupil, sampled for the film point. The weight is
 * cos^4 of the angle times the pupil's area over the square of its distance (pbrt book
 * 5.4.6). */
static void start(const vlCameraCompiled *c, uint32_t count, const vlDirections *d,
                  const float *lens_u, const float *lens_v, Bundle *b) {
  const vlOptics *o = c->optics;
  const double rings = VL_PUPILS / o->half, rear = o->rear;
  for (uint32_t i = 0; i < count; i++) {
    double x = -c->pitch * d->x[i], y = -c->pitch * d->y[i],
           radius = __builtin_sqrt(x * x + y * y);
    double ring = radius * rings, inv = radius > 0.0 ? 1.0 / radius : 0.0;
    const vlPupil *p = &o->pupils[ring < VL_PUPILS ? (uint32_t)ring : VL_PUPILS - 1];
    vlLensPoint round = vl_lens_disk(lens_u[i], lens_v[i]);
    double u = p->fill > 0.0 ? p->fill * (double)round.x : 2.0 * (double)lens_u[i] - 1.0;
    double v = p->fill > 0.0 ? p->fill * (double)round.y : 2.0 * (double)lens_v[i] - 1.0;
    double along = 0.5 * (p->x0 + p->x1) + 0.5 * (p->x1 - p->x0) * u, across = p->y1 * v;
    double cosine = radius > 0.0 ? x * inv : 1.0, sine = y * inv;
    vlOpticsRay r = vl_optics_start(x, y, cosine * along - sine * across,
                                    sine * along + cosine * across, rear);
    double square = r.dz * r.dz;
    r.alive = p->area > 0.0 ? 1.0 : 0.0;
    store(b, i, r);
    b->weight[i] = square * square * p->area / (rear * rear);
  }
}

static void refract(const vlOpticsSurface *surface, uint32_t count, Bundle *b) {
  const vlOpticsSurface copy = *surface, *s = &copy;
  VL_SIMD for (uint32_t i = 0; i < count; i++) store(b, i, vl_optics_refract(s, 1, load(b, i)));
}

static void stop(const vlOptics *o, const vlOpticsSurface *surface, uint32_t count, Bundle *b) {
  const vlOpticsSurface copy = *surface, *s = &copy;
  if (!o->def.aperture) {
    VL_SIMD for (uint32_t i = 0; i < count; i++) store(b, i, vl_optics_stop(s, 1, load(b, i)));
    return;
  }
  double inv = 1.0 / __builtin_sqrt(s->aperture2);
  for (uint32_t i = 0; i < count; i++) {
    vlOpticsRay r = vl_optics_stop(s, 0, load(b, i));
    /* the image is upright as seen from behind the lens; y points down in both */
    double open =
        r.alive > 0.0 ? vl_aperture_value(o->def.aperture, r.x * inv, r.y * inv) : 0.0;
    r.alive = open > 0.0 ? r.alive : 0.0;
    b->weight[i] *= open;
    store(b, i, r);
  }
}

static void chief_rays(const vlCameraCompiled *c, uint32_t count, vlDirections *d,
                       double *seen) {
  for (uint32_t i = 0; i < count; i++) {
    vlCameraLocal l = {0.0, 0.0, 0.0, 0.0, 1.0};
    bool valid = vl_optics_unproject(c->optics, c->pitch * d->x[i], c->pitch * d->y[i], &l);
    d->x[i] = l.ox;
    d->y[i] = l.oy;
    d->dx[i] = l.dx;
    d->dy[i] = l.dy;
    d->dz[i] = l.dz;
    d->valid[i] = seen[i] = valid ? 1.0 : 0.0;
  }
}

void vl_camera_optics(const vlCameraCompiled *c, uint32_t count, const float *lens_u,
                      const float *lens_v, vlDirections *d, double *seen, float *weight) {
  const vlOptics *o = c->optics;
  Bundle b;
  if (!c->has_lens) {
    chief_rays(c, count, d, seen);
    for (uint32_t i = 0; weight && i < count; i++)
      weight[i] = (float)seen[i];
    return;
  }
  start(c, count, d, lens_u, lens_v, &b);
  for (uint32_t i = 0; i < count; i++)
    seen[i] = b.alive[i];
  for (uint32_t k = 0; k < o->count; k++) {
    if (o->surfaces[k].radius == 0.0)
      stop(o, &o->surfaces[k], count, &b);
    else
      refract(&o->surfaces[k], count, &b);
  }
  for (uint32_t i = 0; i < count; i++) {
    int good = b.alive[i] > 0.0 && b.dz[i] > vl_optics_grazing;
    double back = good ? b.z[i] / b.dz[i] : 0.0; /* moves the origin to the film's plane */
    d->x[i] = good ? b.x[i] - back * b.dx[i] : 0.0;
    d->y[i] = good ? b.y[i] - back * b.dy[i] : 0.0;
    d->dx[i] = good ? b.dx[i] : 0.0;
    d->dy[i] = good ? b.dy[i] : 0.0;
    d->dz[i] = good ? b.dz[i] : 1.0;
    d->valid[i] = good ? 1.0 : 0.0;
    if (weight)
      weight[i] = good ? (float)b.weight[i] : 0.0f;
  }
}
