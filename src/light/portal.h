/* light/portal.h: a portal through which an environment image is visible: the rectified
 * image, and light sampling in its part that is visible from a point. See the pbrt book (4th
 * ed.), 12.5.3, and A.5.6 for summed-area tables. portal.c builds it; the lookups are inline,
 * for the hot loops.
 *
 * In the portal's frame (x, y along its sides, z towards the environment) a direction w has the
 * angles alpha = atan(w.x / w.z), beta = atan(w.y / w.z). (u, v) are these angles, mapped from
 * [-90, 90] degrees to [0, 1]. Lines parallel to the sides stay straight, so that the visible
 * part of the environment is a rectangle of the square. */
#ifndef LIGHT_PORTAL_H
#define LIGHT_PORTAL_H

#include "math/approx.h"
#include "math/vec.h"

typedef struct vlPortal {
  float frame[9];  /* portal from world: the rows are the axes x, y, z of the portal */
  float corner[3]; /* corner of the portal with the smallest u and v, world space */
  float width, height;
  uint32_t size; /* the (u, v) square has size x size cells */
  double *sums;  /* summed-area table of (size + 1)^2 values: light of all cells below and left
                    of a cell corner, in rows from v = 0 */
} vlPortal;

/* The part of the (u, v) square that is visible from a point: a rectangle, in units of
 * cells. */
typedef struct vlPortalWindow {
  double x0, y0, x1, y1;
} vlPortalWindow;

static inline vlVec3 vl_portal_local(const vlPortal *portal, vlVec3 d) {
  return vl_turn(portal->frame, d);
}
static inline vlVec3 vl_portal_world(const vlPortal *portal, vlVec3 d) {
  return vl_turn_back(portal->frame, d);
}
static inline vlVec3 vl_portal_corner_from(const vlPortal *portal, vlVec3 o) {
  return vl_portal_local(portal, vl_sub(vl_load3(portal->corner), o));
}

/* Whether a ray from o along d passes through the portal from its inner side. */
static inline bool vl_portal_shows(const vlPortal *portal, vlVec3 o, vlVec3 d) {
  vlVec3 c = vl_portal_corner_from(portal, o), w = vl_portal_local(portal, d);
  float x = w.x * c.z, y = w.y * c.z;
  return c.z > 0.0f && w.z > 0.0f && x >= c.x * w.z && x <= (c.x + portal->width) * w.z &&
         y >= c.y * w.z && y <= (c.y + portal->height) * w.z;
}

static inline double vl_portal_cell(const vlPortal *portal, float tangent) {
  return ((double)(vl_atan(tangent) * VL_INV_PI) + 0.5) * portal->size;
}

/* Computes the window that is visible from o. False if nothing is visible: o is behind the
 * portal or in its plane. */
static inline bool vl_portal_window(const vlPortal *portal, vlVec3 o, vlPortalWindow *window) {
  vlVec3 c = vl_portal_corner_from(portal, o);
  if (!(c.z > 0.0f))
    return false;
  float inv = 1.0f / c.z;
  window->x0 = vl_portal_cell(portal, c.x * inv);
  window->x1 = vl_portal_cell(portal, (c.x + portal->width) * inv);
  window->y0 = vl_portal_cell(portal, c.y * inv);
  window->y1 = vl_portal_cell(portal, (c.y + portal->height) * inv);
  return window->x1 > window->x0 && window->y1 > window->y0;
}
static inline vlPortalWindow vl_portal_whole(const vlPortal *portal) {
  return (vlPortalWindow){0, 0, portal->size, portal->size};
}

/* ---- the light of windows ---------------------------------------------------------------- */

static inline uint32_t vl_portal_index(const vlPortal *portal, double x) {
  uint32_t i = x > 0 ? (uint32_t)x : 0;
  return i < portal->size ? i : portal->size - 1;
}
/* Light of the cells left of column i and below row y. */
static inline double vl_portal_below(const vlPortal *portal, uint32_t i, double y) {
  uint32_t j = vl_portal_index(portal, y);
  const double *at = portal->sums + (size_t)j * (portal->size + 1) + i;
  return at[0] + (at[portal->size + 1] - at[0]) * (y - j);
}
/* Light of the cells left of column i, between the lower and the upper edge of the window. */
static inline double vl_portal_left(const vlPortal *portal, uint32_t i,
                                    const vlPortalWindow *w) {
  return vl_portal_below(portal, i, w->y1) - vl_portal_below(portal, i, w->y0);
}
static inline double vl_portal_left_of(const vlPortal *portal, double x,
                                       const vlPortalWindow *w) {
  uint32_t i = vl_portal_index(portal, x);
  double a = vl_portal_left(portal, i, w), b = vl_portal_left(portal, i + 1, w);
  return a + (b - a) * (x - i);
}
static inline double vl_portal_light(const vlPortal *portal, uint32_t x, uint32_t y) {
  const double *low = portal->sums + (size_t)y * (portal->size + 1) + x,
               *high = low + portal->size + 1;
  return (high[1] - high[0]) - (low[1] - low[0]);
}

/* Solid angle per unit area of the (u, v) square, for the direction with tan(alpha) = x and
 * tan(beta) = y: pi^2 (1 - w.x^2) (1 - w.y^2) / w.z, without cancellation. */
static inline double vl_portal_solid_angle(double x, double y) {
  double square = 1.0 + x * x + y * y;
  return 9.869604401089358 * (1.0 + x * x) * (1.0 + y * y) / (square * __builtin_sqrt(square));
}

/* Density per solid angle with which direction d (unit, in the portal's inner half space) is
 * sampled from a window. */
static inline float vl_portal_pdf(const vlPortal *portal, const vlPortalWindow *window,
                                  vlVec3 d) {
  vlVec3 w = vl_portal_local(portal, d);
  if (!(w.z > VL_MIN_FRACTION))
    return 0.0f;
  float tx = w.x / w.z, ty = w.y / w.z;
  double x = vl_portal_cell(portal, tx), y = vl_portal_cell(portal, ty);
  double light =
      vl_portal_light(portal, vl_portal_index(portal, x), vl_portal_index(portal, y));
  double all = vl_portal_left_of(portal, window->x1, window) -
               vl_portal_left_of(portal, window->x0, window);
  if (!(all > 0))
    return 0.0f;
  double n = portal->size;
  return (float)(light / all * n * n / vl_portal_solid_angle((double)tx, (double)ty));
}

/* Samples a direction of the window in proportion to its light. Returns the zero vector if the
 * window is black. */
static inline vlVec3 vl_portal_sample(const vlPortal *portal, const vlPortalWindow *w, float u,
                                      float v) {
  double from = vl_portal_left_of(portal, w->x0, w), to = vl_portal_left_of(portal, w->x1, w);
  if (!(to > from))
    return vl_vec3(0, 0, 0);
  double wanted = from + (double)u * (to - from);
  uint32_t low = vl_portal_index(portal, w->x0), high = vl_portal_index(portal, w->x1);
  while (low < high) {
    /* binary search for the first column whose right side is past the target */
    uint32_t middle = (low + high) / 2;
    if (vl_portal_left(portal, middle + 1, w) > wanted)
      high = middle;
    else
      low = middle + 1;
  }
  double a = vl_portal_left(portal, low, w), b = vl_portal_left(portal, low + 1, w);
  double x = low + (b > a ? (wanted - a) / (b - a) : 0.5);
  x = x < w->x0 ? w->x0 : x > w->x1 ? w->x1 : x;
  const double *column = portal->sums + low;
  size_t row = portal->size + 1;
  double f0 = vl_portal_below(portal, low + 1, w->y0) - vl_portal_below(portal, low, w->y0);
  double f1 = vl_portal_below(portal, low + 1, w->y1) - vl_portal_below(portal, low, w->y1);
  wanted = f0 + (double)v * (f1 - f0);
  uint32_t first = vl_portal_index(portal, w->y0), last = vl_portal_index(portal, w->y1);
  while (first < last) {
    uint32_t middle = (first + last) / 2;
    if (column[(middle + 1) * row + 1] - column[(middle + 1) * row] > wanted)
      last = middle;
    else
      first = middle + 1;
  }
  a = column[first * row + 1] - column[first * row];
  b = column[(first + 1) * row + 1] - column[(first + 1) * row];
  double y = first + (b > a ? (wanted - a) / (b - a) : 0.5);
  y = y < w->y0 ? w->y0 : y > w->y1 ? w->y1 : y;
  vlSinCos p = vl_sincos((float)((x / portal->size - 0.5) * 3.141592653589793));
  vlSinCos q = vl_sincos((float)((y / portal->size - 0.5) * 3.141592653589793));
  if (!(p.cos > VL_MIN_FRACTION && q.cos > VL_MIN_FRACTION))
    return vl_vec3(0, 0, 0);
  return vl_normalize(
      vl_portal_world(portal, vl_normalize(vl_vec3(p.sin / p.cos, q.sin / q.cos, 1.0f))));
}

#endif
