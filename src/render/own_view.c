/* render/own_view.c: see own_view.h. */
#include "render/own_view.h"

#include <math.h>
#include <string.h>

#include "camera/own_rays.h"
#include "math/double3.h"

/* Points at a time, and rays for each: of the film point itself (MIDDLE), and from SIDES on
 * those STEP pixels to its left and right, above and below. The error of a derivative is STEP^2
 * / 6 of the third derivative, 1e-7 where the map changes over 40 pixels. */
enum { CHUNK = 128, MIDDLE = 0, SIDES = 1, RAYS = 5 };
static const double STEP = 1.0 / 32;
_Static_assert(CHUNK *RAYS <= VL_OWN_BATCH, "one call");

static double square(double x) {
  return x * x;
}

/* The squared distance of two rays: of their origins plus of their directions. */
static double change(const vlOwnRay *a, const vlOwnRay *b) {
  double sum = 0;
  for (int k = 0; k < 3; k++)
    sum += square(b->d[k] - a->d[k]) + square(b->o[k] - a->o[k]);
  return sum;
}

/* Derivatives by one axis of the film. Beside a film point without a ray, and at a seam, where
 * the rays of one side are far from those of the other, they are one-sided. False: there are
 * none. */
static bool derivatives(const vlOwnRay *before, const vlOwnRay *at, const vlOwnRay *after,
                        double o[3], double d[3]) {
  double back = before->good ? change(before, at) : (double)INFINITY;
  double ahead = after->good ? change(at, after) : (double)INFINITY;
  bool uses_before = back < (double)INFINITY && back <= 4 * ahead;
  bool uses_after = ahead < (double)INFINITY && ahead <= 4 * back;
  if (!uses_before && !uses_after)
    return false;
  const vlOwnRay *a = uses_before ? before : at, *b = uses_after ? after : at;
  double inv = 1 / (STEP * (uses_before + uses_after));
  for (int k = 0; k < 3; k++) {
    o[k] = (b->o[k] - a->o[k]) * inv;
    d[k] = (b->d[k] - a->d[k]) * inv;
  }
  return true;
}

/* Connects the point p, in world space, with the camera. rays: RAYS of its film point. A pixel
 * sees at distance t the area |vl_triple3(d, ox + t dx, oy + t dy)|, where ox, dx and oy, dy
 * are the derivatives of the ray's origin and direction by the film's axes: a polynomial in t.
 * The point must lie on the ray of its film point, up to 1/16 of a pixel. */
static void connect(const vlCameraCompiled *c, const vlOwnRay *rays, const float p[3],
                    vlCameraSample *s) {
  const vlOwnRay *at = &rays[MIDDLE];
  double ox[3], oy[3], dx[3], dy[3], to[3], off2 = 0;
  if (!at->good || !(at->weight >= 0) || !(at->weight < (double)INFINITY))
    return;
  if (!derivatives(&rays[SIDES], at, &rays[SIDES + 1], ox, dx))
    return;
  if (!derivatives(&rays[SIDES + 2], at, &rays[SIDES + 3], oy, dy))
    return;
  for (int k = 0; k < 3; k++)
    to[k] = (double)p[k] - at->o[k];
  double t = vl_dot3(to, at->d);
  double near = c->near_plane * at->stretch, far = c->far_plane * at->stretch;
  double area[3] = {vl_triple3(at->d, ox, oy),
                    vl_triple3(at->d, ox, dy) + vl_triple3(at->d, dx, oy),
                    vl_triple3(at->d, dx, dy)};
  double pixel = fabs(area[0] + t * (area[1] + t * area[2]));
  for (int k = 0; k < 3; k++)
    off2 += square(to[k] - t * at->d[k]);
  if (!(t > near) || !(t < far) || !(off2 <= pixel / 256) || !(pixel > 0))
    return;
  s->seen = true;
  s->from = (vlVec3){(float)at->o[0], (float)at->o[1], (float)at->o[2]};
  s->w = (vlVec3){(float)-at->d[0], (float)-at->d[1], (float)-at->d[2]};
  s->end = (float)(1 - near / t);
  s->per_square = (float)(1 / pixel);
  s->weight = (float)at->weight;
  for (int k = 0; k < 3; k++)
    s->area[k] = (float)area[k];
}

static void look_at(const vlCameraView *view, uint32_t n, const float *x, const float *y,
                    const float *z, vlCameraSample *samples) {
  static const double side[RAYS][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  const vlCameraCompiled *c = view->camera;
  const double *m = c->camera_from_world;
  double at[3][CHUNK], film_x[CHUNK], film_y[CHUNK];
  double points_x[CHUNK * RAYS], points_y[CHUNK * RAYS];
  vlOwnRay rays[CHUNK * RAYS];
  if (n == 0)
    return;
  for (uint32_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++)
      at[k][i] = m[4 * k] * (double)x[i] + m[4 * k + 1] * (double)y[i] +
                 m[4 * k + 2] * (double)z[i] + m[4 * k + 3];
  vl_own_pixels(c, n, at[0], at[1], at[2], film_x, film_y);
  for (uint32_t i = 0; i < n; i++) {
    vlCameraSample *s = &samples[i];
    memset(s, 0, sizeof *s);
    s->x = (float)film_x[i];
    s->y = (float)film_y[i];
    s->seen =
        s->x > view->low_x && s->x < view->high_x && s->y > view->low_y && s->y < view->high_y;
    /* rays of a point that is not seen are not used */
    const double middle_x = s->seen ? film_x[i] : (double)view->low_x;
    const double middle_y = s->seen ? film_y[i] : (double)view->low_y;
    for (uint32_t k = 0; k < RAYS; k++) {
      points_x[RAYS * i + k] = middle_x + STEP * side[k][0];
      points_y[RAYS * i + k] = middle_y + STEP * side[k][1];
    }
  }
  vl_own_world_rays(c, RAYS * n, points_x, points_y, rays);
  for (uint32_t i = 0; i < n; i++) {
    const float p[3] = {x[i], y[i], z[i]};
    bool inside = samples[i].seen;
    samples[i].seen = false;
    if (inside)
      connect(c, rays + RAYS * i, p, &samples[i]);
  }
}

static void look(const vlCameraView *view, uint32_t n, const float *x, const float *y,
                 const float *z, vlCameraSample *samples) {
  for (uint32_t first = 0; first < n; first += CHUNK)
    look_at(view, n - first < CHUNK ? n - first : CHUNK, x + first, y + first, z + first,
            samples + first);
}

void vl_own_view(const vlCameraCompiled *c, const vlFilmDef *film, vlCameraView *view) {
  if (!c->own)
    return;
  view->sees = c->own->pixels && !c->own->lens && !c->when.moves;
  if (!view->sees)
    return;
  view->look = look;
  view->reach_x = film->filter.radius_x + 1.0f;
  view->reach_y = film->filter.radius_y + 1.0f;
}
