/* more/curve.c: hairs and blades of grass: cubic Bezier curves with a width (pbrt book 6.7). A curve is a strip that
 * turns to face each ray: the ray meets it where, in the plane across the ray, the foot of the perpendicular to the
 * curve lies within half of the width. All of this happens in the space of the shape. */
#include "more.h"

enum { DEGREE = 5 };

typedef struct curve {
  vector p[4];
  double width[2]; /* at both ends; linear between them */
  vector normal[2];
  vlCurveKind kind;
} curve;

static curve curve_of(const world *w, const primitive *p) {
  const vlShapeDef *def = w->placements[p->placement].def;
  curve c = {.kind = def->curve};
  for (size_t k = 0; k < 4; k++) c.p[k] = from_floats(def->positions + 3 * (4 * (size_t)p->face + k));
  for (size_t k = 0; k < 2; k++) {
    c.width[k] = (double)def->widths[2 * (size_t)p->face + k];
    if (c.kind == VL_CURVE_RIBBON) c.normal[k] = normalize(from_floats(def->normals + 3 * (2 * (size_t)p->face + k)));
  }
  return c;
}

/* The powers' coefficients of a cubic Bezier polynomial with these four control values. */
static void to_powers(double a, double b, double c, double d, double power[4]) {
  power[0] = a;
  power[1] = 3 * (b - a);
  power[2] = 3 * (a - 2 * b + c);
  power[3] = d - a + 3 * (b - c);
}

static double polynomial(const double *c, int degree, double u) {
  double sum = c[degree];
  for (int i = degree - 1; i >= 0; i--) sum = sum * u + c[i];
  return sum;
}

/* The roots in [0, 1] at which a polynomial changes its sign, or only those at which it rises: between two of its
 * turning points, which are the roots of its derivative, there is at most one. */
static int roots_of(const double *c, int degree, bool rising, double *roots) {
  double derivative[DEGREE], turning[DEGREE] = {0};
  if (degree == 0) return 0;
  for (int i = 0; i < degree; i++) derivative[i] = (i + 1) * c[i + 1];
  int parts = roots_of(derivative, degree - 1, false, turning);
  int count = 0;
  for (int i = 0; i <= parts; i++) {
    double low = i == 0 ? 0 : turning[i - 1];
    double high = i == parts ? 1 : turning[i];
    bool rises = polynomial(c, degree, low) < 0;
    if (rises == (polynomial(c, degree, high) < 0) || (rising && !rises)) continue;
    for (int step = 0; step < 52; step++) {
      double middle = (low + high) / 2;
      bool before = (polynomial(c, degree, middle) < 0) == rises;
      if (before) low = middle;
      if (!before) high = middle;
    }
    roots[count++] = low;
  }
  return count;
}

/* De Casteljau: between the four points at u lie three, between these two, and between these the curve's point. */
static vector curve_point(const curve *c, double u, vector *tangent) {
  vector low = mix(c->p[0], c->p[1], u), middle = mix(c->p[1], c->p[2], u), high = mix(c->p[2], c->p[3], u);
  vector before = mix(low, middle, u), after = mix(middle, high, u);
  *tangent = scale(3, subtract(after, before));
  return mix(before, after, u);
}

/* A ribbon's normal turns at a constant rate between its ends (slerp). */
static vector ribbon_normal(const curve *c, double u) {
  double angle = acos(clamp(dot(c->normal[0], c->normal[1]), -1, 1));
  if (angle < 1e-9) return c->normal[0];
  return scale(1 / sin(angle), add(scale(sin((1 - u) * angle), c->normal[0]), scale(sin(u * angle), c->normal[1])));
}

/* How wide the strip looks along a direction of length 1: ribbons are foreshortened. */
static double width_at(const curve *c, double u, vector direction) {
  double width = (1 - u) * c->width[0] + u * c->width[1];
  return c->kind == VL_CURVE_RIBBON ? width * fabs(dot(ribbon_normal(c, u), direction)) : width;
}

/* The roots of C . C' for the curve C(u) in the plane across the ray, where it rises: the distance is least there. */
static int feet(const curve *across, double reach, double u[DEGREE]) {
  const vector *p = across->p;
  double x[4], y[4], foot[DEGREE + 1] = {0};
  for (int k = 0; k < 3; k++) reach += length(subtract(p[k + 1], p[k])); /* the curve is shorter than its polygon */
  if (hypot(p[0].x, p[0].y) > reach) return 0;
  to_powers(p[0].x, p[1].x, p[2].x, p[3].x, x);
  to_powers(p[0].y, p[1].y, p[2].y, p[3].y, y);
  for (int i = 0; i < 4; i++) {
    for (int k = 1; k < 4; k++) foot[i + k - 1] += k * (x[i] * x[k] + y[i] * y[k]);
  }
  return roots_of(foot, DEGREE, true, u);
}

bool meet_curve(const world *w, const primitive *p, ray r, meeting *m) {
  const placement *where = &w->placements[p->placement];
  curve c = curve_of(w, p), across = c;
  vector origin = transform_point(&where->shape_from_world, r.origin);
  vector direction = transform_vector(&where->shape_from_world, r.direction);
  double unit = length(direction);
  direction = scale(1 / unit, direction);
  frame f = make_frame(direction, subtract(c.p[3], c.p[0]));
  for (int k = 0; k < 4; k++) across.p[k] = to_local(f, subtract(c.p[k], origin));
  double u[DEGREE];
  int count = feet(&across, fmax(c.width[0], c.width[1]) / 2, u);
  bool found = false;
  for (int i = 0; i < count; i++) {
    vector tangent;
    vector foot = curve_point(&across, u[i], &tangent);
    double distance = hypot(foot.x, foot.y), width = width_at(&c, u[i], direction), t = foot.z / unit;
    if (distance > width / 2 || t <= r.t_min || t >= r.t_max) continue;
    bool left = tangent.y * foot.x - tangent.x * foot.y > 0;
    *m = (meeting){t, u[i], 0.5 + (left ? distance : -distance) / width};
    r.t_max = t;
    found = true;
  }
  return found;
}

/* The strip at (u, v) as the ray sees it that met it, record->arrival. The normal is dp/du x dp/dv: it points away from
 * where the ray comes from; over a cylinder it turns from one side to the other. */
void curve_surface(const world *w, const primitive *p, double u, double v, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  curve c = curve_of(w, p);
  vector arrival = seen_at_rest(where, (ray){.direction = record->arrival, .time = record->time}).direction;
  vector direction = normalize(transform_vector(&where->shape_from_world, arrival)), tangent;
  vector point = curve_point(&c, u, &tangent);
  vector along = normalize(tangent);
  vector side = normalize(cross(direction, tangent)); /* to the left, as the ray looks */
  vector n = cross(along, side);
  double angle = (v - 0.5) * PI;
  if (c.kind == VL_CURVE_CYLINDER) n = add(scale(cos(angle), n), scale(sin(angle), side));
  if (c.kind == VL_CURVE_RIBBON) {
    vector given = ribbon_normal(&c, u);
    n = normalize(subtract(given, scale(dot(given, along), along)));
  }
  double width = (1 - u) * c.width[0] + u * c.width[1],
         reach = width * (fabs(n.x) + fabs(n.y) + fabs(n.z)); /* pbrt's */
  n = transform_normal(&where->shape_from_world, n);
  record->thickness = reach / length(n); /* along the normal, in the world */
  n = normalize(n);
  vector offset = scale((v - 0.5) * width_at(&c, u, direction), side);
  record->point = transform_point(&where->world_from_shape, add(point, offset));
  record->normal = where->flip ? negate(n) : n;
  record->shading_normal = record->normal;
  record->tangent = transform_vector(&where->world_from_shape, tangent);
  record->u = u;
  record->v = v;
  record->area_density = 0; /* curves do not emit */
}
