/* camera/optics_find.c: the exit pupil bounds of a lens of many elements for each film ring,
 * and its chief rays (pbrt book 5.4.5). Computed once, when the lens is made. */
#include <math.h>

#include "camera/optics.h"

/* Size of the grid of rays over a window of the rear plane. It covers the upper half only,
 * since the lens is rotationally symmetric. */
enum { ACROSS = 40, DOWN = 20, ZOOMS = 24 };

static bool passes(const vlOptics *o, double radius, double px, double py) {
  vlOpticsRay r = vl_optics_start(radius, 0.0, px, py, o->rear);
  for (uint32_t k = 0; k < o->count; k++) {
    const vlOpticsSurface *s = &o->surfaces[k];
    if (s->radius == 0.0) {
      r = vl_optics_stop(s, o->def.aperture == NULL, r);
      /* Pupils rotate with the film point's direction, but an aperture image does not. The
       * bounds must therefore contain the circle around the image's non-black part. */
      if (o->def.aperture &&
          r.x * r.x + r.y * r.y > vl_aperture_reach2(o->def.aperture) * s->aperture2)
        return false;
    } else {
      r = vl_optics_refract(s, 1, r);
    }
    if (r.alive == 0.0)
      return false;
  }
  return r.dz > vl_optics_grazing;
}

typedef struct {
  double x0, x1, y1;
} Box;

/* Extends the box by all points of the window through which rays from this film radius pass. */
static bool search(const vlOptics *o, double radius, Box window, Box *found) {
  bool any = false;
  for (int i = 0; i <= ACROSS; i++)
    for (int k = 0; k <= DOWN; k++) {
      double x = window.x0 + (window.x1 - window.x0) * i / ACROSS, y = window.y1 * k / DOWN;
      if (!passes(o, radius, x, y))
        continue;
      found->x0 = fmin(found->x0, x);
      found->x1 = fmax(found->x1, x);
      found->y1 = fmax(found->y1, y);
      any = true;
    }
  return any;
}

static Box grown(Box b, Box window) {
  double dx = (window.x1 - window.x0) / ACROSS, dy = window.y1 / DOWN;
  return (Box){b.x0 - dx, b.x1 + dx, b.y1 + dy};
}

/* Shrinks the window towards the pupil until it hardly changes. The chief ray is also tried,
 * because it finds pupils that are smaller than the first grid's spacing. */
static Box find_box(const vlOptics *o, double r0, double r1, bool *any) {
  double reach = 1.5 * sqrt(o->surfaces[0].aperture2);
  const double radii[3] = {r0, 0.5 * (r0 + r1), r1};
  Box window = {-reach, reach, reach}, box = window;
  for (int zoom = 0; zoom < ZOOMS; zoom++) {
    box = (Box){INFINITY, -INFINITY, 0.0};
    *any = false;
    for (int i = 0; i < 3; i++) {
      vlChief chief = o->chiefs[(int)(radii[i] / o->chief_step + 0.5)];
      if (passes(o, radii[i], chief.pupil, 0.0)) {
        box.x0 = fmin(box.x0, chief.pupil);
        box.x1 = fmax(box.x1, chief.pupil);
        *any = true;
      }
      *any = search(o, radii[i], window, &box) || *any;
    }
    if (!*any)
      return box;
    Box next = grown(box, window);
    double shrink = (next.x1 - next.x0) * next.y1 / ((window.x1 - window.x0) * window.y1);
    window = next;
    if (shrink > 0.8)
      break;
  }
  return window;
}

/* The smallest scale of the box's ellipse that contains all passing rays, with a margin of two
 * steps of the search. */
static double fill_of(const vlOptics *o, double r0, double r1, Box b) {
  double cx = 0.5 * (b.x0 + b.x1), hx = 0.5 * (b.x1 - b.x0), max = 0.0;
  const double radii[3] = {r0, 0.5 * (r0 + r1), r1};
  for (int n = 0; n < 3; n++)
    for (int i = 0; i <= ACROSS; i++)
      for (int k = 0; k <= DOWN; k++) {
        double x = b.x0 + 2.0 * hx * i / ACROSS, y = b.y1 * k / DOWN, ex = (x - cx) / hx,
               ey = y / b.y1;
        double e = sqrt(ex * ex + ey * ey);
        if (e > max && passes(o, radii[n], x, y))
          max = e;
      }
  return max + 4.0 / ACROSS;
}

void vl_optics_find_pupils(vlOptics *o) {
  const double quarter = 0.78539816339744831;
  for (int i = 0; i < VL_PUPILS; i++) {
    double r0 = o->half * i / VL_PUPILS, r1 = o->half * (i + 1) / VL_PUPILS;
    bool any;
    Box b = find_box(o, r0, r1, &any);
    vlPupil *p = &o->pupils[i];
    *p = (vlPupil){0};
    if (!any)
      continue;
    double fill = fill_of(o, r0, r1, b), box = 2.0 * (b.x1 - b.x0) * b.y1;
    bool ellipse = fill * fill * quarter < 1.0;
    *p = (vlPupil){b.x0, b.x1, b.y1, ellipse ? fill : 0.0,
                   ellipse ? fill * fill * quarter * box : box};
  }
}

/* ---- chief rays -------------------------------------------------------------------------- */

/* Computes x at the stop for the ray from the film radius to x = p at the rear surface. It
 * ignores apertures; they are tested once the chief ray is found. */
static bool at_stop(const vlOptics *o, double radius, double p, double *x) {
  vlOpticsRay r = vl_optics_start(radius, 0.0, p, 0.0, o->rear);
  for (uint32_t k = 0; k <= o->stop; k++) {
    const vlOpticsSurface *s = &o->surfaces[k];
    r = s->radius == 0.0 ? vl_optics_stop(s, 0, r) : vl_optics_refract(s, 0, r);
  }
  *x = r.x;
  return r.alive > 0.0;
}

bool vl_optics_chief(const vlOptics *o, double radius, double guess, vlChief *chief) {
  /* large compared with rounding errors, small compared with the lens */
  double size = sqrt(o->surfaces[o->stop].aperture2), step = 1e-4 * size;
  double a = guess, b = guess + step, fa, fb;
  *chief = (vlChief){.pupil = guess};
  if (!at_stop(o, radius, a, &fa) || !at_stop(o, radius, b, &fb))
    return false;
  /* secant method: the height at the stop is nearly linear in the height at the pupil */
  for (int i = 0; i < 40 && fabs(fb) > 1e-15 * size && fb != fa; i++) {
    double next = b - fb * (b - a) / (fb - fa);
    a = b;
    fa = fb;
    b = next;
    if (!at_stop(o, radius, b, &fb))
      return false;
  }
  if (!(fabs(fb) < 1e-9 * size))
    return false; /* no root: the secant method did not converge */
  chief->pupil = b;
  vlOpticsRay r = vl_optics_start(radius, 0.0, b, 0.0, o->rear);
  for (uint32_t k = 0; k < o->count; k++) {
    const vlOpticsSurface *s = &o->surfaces[k];
    r = s->radius == 0.0 ? vl_optics_stop(s, 0, r) : vl_optics_refract(s, 1, r);
  }
  chief->slope = r.dx / r.dz;
  chief->x0 = r.x - r.z * chief->slope;
  chief->valid = r.alive > 0.0 && r.dz > vl_optics_grazing;
  return chief->valid;
}

void vl_optics_find_chiefs(vlOptics *o) {
  double guess = 0.0, before = 0.0;
  o->chief_step = 1.05 * o->half / VL_CHIEFS;
  for (int i = 0; i <= VL_CHIEFS; i++) {
    double ahead = i > 1 ? 2.0 * guess - before : guess; /* linear extrapolation */
    vl_optics_chief(o, o->chief_step * i, ahead, &o->chiefs[i]);
    before = guess;
    guess = o->chiefs[i].pupil;
  }
}
