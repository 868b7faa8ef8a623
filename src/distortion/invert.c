/* distortion/invert.c: the inverse of a distortion where the few Newton steps that suffice for
 * the image do not: far outside it and close to a fold. */
#include "distortion/distortion.h"

enum { BISECTIONS = 100, NEWTON_STEPS = 60, HALVINGS = 40 };

/* The distorted radius of an ideal radius, of the radial terms alone. */
static double radial(const vlDistortionMap *m, double r) {
  const double *n = m->numerator, *d = m->denominator;
  double s = r * r;
  return r * (1.0 + s * (n[0] + s * (n[1] + s * (n[2] + s * (n[3] + s * (n[4] + s * n[5])))))) /
         (1.0 + s * (d[0] + s * (d[1] + s * d[2])));
}

static double error_at(vlDistorted d, double u, double v) {
  return __builtin_fabs(d.u - u) + __builtin_fabs(d.v - v);
}

/* An upper bound of the distorted radius in the disc. The map does not fold there, so that the
 * edge of what it reaches comes from the disc's edge, where s = r^2: with p = (p1, p0) the
 * tangential terms are s p + 2 x (x . p), at most 3 s |p|, s being the square of the radius
 * that they act on. */
static double farthest(const vlDistortionMap *m) {
  const double *p = m->tangential, *t = m->prism;
  double bent = radial(m, m->radius);
  double r = m->radial_first ? bent : m->radius;
  double s = r * r;
  double prism = vl_length_2d(__builtin_fabs(t[0]) + s * __builtin_fabs(t[1]),
                              __builtin_fabs(t[2]) + s * __builtin_fabs(t[3]));
  return (__builtin_fabs(bent) + s * (3.0 * vl_length_2d(p[0], p[1]) + prism)) * (1.0 + 1e-9);
}

/* The start has the right radius but for the tangential and prism terms, which are small beside
 * the radial ones. Each Newton step is halved until the error decreases (Press et al.,
 * Numerical Recipes, "Globally Convergent Methods for Nonlinear Systems"). */
vlPlanePoint vl_distortion_invert(const vlDistortionMap *m, double u, double v) {
  const double wanted = vl_length_2d(u, v), size = 1.0 + __builtin_fabs(u) + __builtin_fabs(v);
  double low = 0.0, high = m->radius;
  if (!(wanted > 0.0) || wanted - wanted != 0.0) /* 0, or not finite */
    return (vlPlanePoint){0.0, 0.0, wanted == 0.0 ? 1.0 : 0.0};
  if (wanted > farthest(m))
    return (vlPlanePoint){0.0, 0.0, 0.0};
  for (int i = 0; i < BISECTIONS && low < high; i++) {
    double middle = 0.5 * (low + high);
    if (middle == low || middle == high)
      break;
    if (radial(m, middle) < wanted)
      low = middle;
    else
      high = middle;
  }
  double x = low * (u / wanted), y = low * (v / wanted);
  double error = error_at(vl_distort(m, x, y), u, v);
  for (int step = 0; step < NEWTON_STEPS && error > 1e-15 * size; step++) {
    vlPlanePoint next = vl_distortion_step(m->radial_first, m, x, y, u, v);
    double dx = next.x - x, dy = next.y - y, share = 1.0, better = error;
    for (int i = 0; i < HALVINGS; i++, share *= 0.5) {
      better = error_at(vl_distort(m, x + share * dx, y + share * dy), u, v);
      if (better < error)
        break;
    }
    if (!(better < error))
      break;
    x += share * dx;
    y += share * dy;
    error = better;
  }
  return (vlPlanePoint){x, y, vl_distortion_check(m->radial_first, m, x, y, u, v)};
}
