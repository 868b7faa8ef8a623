/* camera/optics_derive.c: derivatives of the chief rays of a lens of many elements by the film
 * radius. The chief ray's height at the pupil is where its height at the stop is 0; its
 * derivative follows from that equation (implicit function theorem), and the derivatives of a
 * traced ray from dual numbers (Griewank and Walther, Evaluating Derivatives, ch. 3). */
#include <math.h>

#include "camera/optics.h"

/* A number, and its derivatives by the film radius and by the height at the pupil. */
typedef struct {
  double v, radius, pupil;
} Dual;

static Dual constant(double v) {
  return (Dual){v, 0.0, 0.0};
}

static Dual add(Dual a, Dual b) {
  return (Dual){a.v + b.v, a.radius + b.radius, a.pupil + b.pupil};
}

static Dual scale(double k, Dual a) {
  return (Dual){k * a.v, k * a.radius, k * a.pupil};
}

static Dual subtract(Dual a, Dual b) {
  return add(a, scale(-1.0, b));
}

static Dual multiply(Dual a, Dual b) {
  return (Dual){a.v * b.v, a.radius * b.v + a.v * b.radius, a.pupil * b.v + a.v * b.pupil};
}

static Dual divide(Dual a, Dual b) {
  double q = a.v / b.v;
  return (Dual){q, (a.radius - q * b.radius) / b.v, (a.pupil - q * b.pupil) / b.v};
}

static Dual root(Dual a) {
  double r = sqrt(a.v);
  return (Dual){r, 0.5 * a.radius / r, 0.5 * a.pupil / r};
}

/* A ray in the plane y = 0 of lens space; d is of unit length. */
typedef struct {
  Dual x, z, dx, dz;
} FlatRay;

static FlatRay travel(FlatRay r, Dual t) {
  r.x = add(r.x, multiply(t, r.dx));
  r.z = add(r.z, multiply(t, r.dz));
  return r;
}

/* The equations of vl_optics_refract. */
static FlatRay refract(const vlOpticsSurface *s, FlatRay r) {
  Dual centre = constant(s->z - s->radius);
  Dual cz = subtract(r.z, centre);
  Dual b = add(multiply(r.x, r.dx), multiply(cz, r.dz));
  Dual c = add(multiply(r.x, r.x), multiply(cz, cz));
  c = subtract(c, constant(s->radius * s->radius));
  Dual distance = root(subtract(multiply(b, b), c));
  r = travel(r, subtract(scale(s->radius > 0.0 ? 1.0 : -1.0, distance), b));
  Dual nx = scale(-1.0 / s->radius, r.x);
  Dual nz = scale(-1.0 / s->radius, subtract(r.z, centre));
  Dual cosine = scale(-1.0, add(multiply(nx, r.dx), multiply(nz, r.dz)));
  Dual sine2 = subtract(constant(1.0), multiply(cosine, cosine));
  Dual after = root(subtract(constant(1.0), scale(s->eta * s->eta, sine2)));
  Dual k = subtract(scale(s->eta, cosine), after);
  r.dx = add(scale(s->eta, r.dx), multiply(k, nx));
  r.dz = add(scale(s->eta, r.dz), multiply(k, nz));
  return r;
}

static FlatRay through(const vlOpticsSurface *s, FlatRay r) {
  if (s->radius != 0.0)
    return refract(s, r);
  return travel(r, divide(subtract(constant(s->z), r.z), r.dz));
}

bool vl_optics_chief_derivatives(const vlOptics *o, double radius, vlChief *chief,
                                 double *x0_by_radius, double *slope_by_radius) {
  if (!vl_optics_chief_at(o, radius, chief))
    return false;
  Dual across = {chief->pupil - radius, -1.0, 1.0};
  Dual length = root(add(multiply(across, across), constant(o->rear * o->rear)));
  FlatRay r = {{radius, 1.0, 0.0},
               constant(0.0),
               divide(across, length),
               divide(constant(o->rear), length)};
  Dual at_stop = constant(0.0);
  for (uint32_t k = 0; k < o->count; k++) {
    r = through(&o->surfaces[k], r);
    if (k == o->stop)
      at_stop = r.x;
  }
  double pupil_by_radius = -at_stop.radius / at_stop.pupil;
  Dual slope = divide(r.dx, r.dz);
  Dual x0 = subtract(r.x, multiply(r.z, slope));
  *x0_by_radius = x0.radius + x0.pupil * pupil_by_radius;
  *slope_by_radius = slope.radius + slope.pupil * pupil_by_radius;
  return isfinite(*x0_by_radius) && isfinite(*slope_by_radius);
}
