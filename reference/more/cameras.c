/* more/cameras.c: the other projections, and lenses that distort (docs/cameras.md, with the sources of the formulas). A
 * projection turns a point (u, v) of its plane into a direction: x right, y down, z forward. */
#include "more.h"

/* Brown's and OpenCV's model: from the ideal point to where the lens puts it. Aria's has the radial part first. */
static square_point distorted(const vlDistortionMap *d, square_point p) {
  const double *n = d->numerator, *e = d->denominator, *t = d->tangential, *prism = d->prism;
  double s = p.x * p.x + p.y * p.y, below = 1 + s * (e[0] + s * (e[1] + s * e[2]));
  double q = (1 + s * (n[0] + s * (n[1] + s * (n[2] + s * (n[3] + s * (n[4] + s * n[5])))))) / below;
  square_point radial = {p.x * q, p.y * q}, at = d->radial_first ? radial : p;
  double x = at.x, y = at.y, r2 = x * x + y * y;
  return (square_point){radial.x + 2 * t[0] * x * y + t[1] * (r2 + 2 * x * x) + r2 * (prism[0] + r2 * prism[1]),
                        radial.y + t[0] * (r2 + 2 * y * y) + 2 * t[1] * x * y + r2 * (prism[2] + r2 * prism[3])};
}

/* The sensor is untilted, and the distortion inverted by Newton's method, with differences for derivatives. */
bool without_distortion(const vlCamera *c, double *x, double *y) {
  const vlDistortionMap *d = &c->distortion;
  const double *m = d->untilt;
  double z = m[6] * *x + m[7] * *y + m[8];
  square_point goal = {(m[0] * *x + m[1] * *y + m[2]) / z, (m[3] * *x + m[4] * *y + m[5]) / z}, p = goal;
  double error = 1;
  for (int step = 0; step < 50; step++) {
    const double h = 1e-7;
    square_point f = distorted(d, p);
    square_point fx = distorted(d, (square_point){p.x + h, p.y}), fy = distorted(d, (square_point){p.x, p.y + h});
    double a = (fx.x - f.x) / h, b = (fy.x - f.x) / h, g = (fx.y - f.y) / h, k = (fy.y - f.y) / h;
    double ex = goal.x - f.x, ey = goal.y - f.y;
    error = hypot(ex, ey);
    p.x += (k * ex - b * ey) / (a * k - b * g);
    p.y += (a * ey - g * ex) / (a * k - b * g);
    double r = hypot(p.x, p.y); /* stay where the map is one to one */
    if (r > d->radius) p = (square_point){p.x * d->radius / r, p.y * d->radius / r};
  }
  *x = p.x;
  *y = p.y;
  return error < 1e-9;
}

static vector by_angle(double u, double v, double theta) {
  double r = hypot(u, v), share = r > 0 ? sin(theta) / r : 1;
  return make_vector(share * u, share * v, cos(theta));
}

/* u = S sin(longitude), v = S tan(latitude), S = (d + 1) / (d + cos(longitude)): a quadratic for the cosine. */
static bool panini(double d, double u, double v, vector *direction) {
  double k = square(u / (d + 1)), root = k * k * d * d - (k + 1) * (k * d * d - 1);
  if (root < 0) return false;
  double cosine = (sqrt(root) - k * d) / (k + 1), s = (d + 1) / (d + cosine);
  *direction = make_vector(u / s, v / s, cosine);
  return s > 0;
}

/* Mei's model: the sphere around the eye seen from the distance xi behind it. */
static vector from_sphere(double xi, double u, double v, double z) {
  double r2 = u * u + v * v, k = (xi * z + sqrt(z * z + (1 - xi * xi) * r2)) / (z * z + r2);
  return make_vector(k * u, k * v, k * z - xi);
}

/* z of the direction (u, v, z) of the enhanced unified model; the double sphere's lies behind a second sphere. */
static double enhanced(double alpha, double beta, double r2) {
  return (1 - beta * alpha * alpha * r2) / (alpha * sqrt(1 - (2 * alpha - 1) * beta * r2) + 1 - alpha);
}

bool more_direction(const vlCamera *c, double u, double v, vector *direction) {
  double r = hypot(u, v), first = c->shape[0], second = c->shape[1];
  bool half_turn = c->projection == VL_PROJECTION_FOV && r * first >= PI / 2; /* it sees what is in front */
  if (r > c->limit || half_turn) return false;
  switch (c->projection) {
    case VL_PROJECTION_STEREOGRAPHIC: *direction = by_angle(u, v, 2 * atan(r / 2)); break;
    case VL_PROJECTION_SINE: *direction = make_vector(u, v, sqrt(1 - r * r)); break;
    case VL_PROJECTION_EQUIRECTANGULAR: *direction = make_vector(sin(u) * cos(v), sin(v), cos(u) * cos(v)); break;
    case VL_PROJECTION_CYLINDRICAL: *direction = make_vector(sin(u), v, cos(u)); break;
    case VL_PROJECTION_PANINI: return panini(first, u, v, direction);
    case VL_PROJECTION_FOV: *direction = by_angle(u, v, atan(tan(r * first) / (2 * tan(first / 2)))); break;
    case VL_PROJECTION_DIVISION: *direction = make_vector(u, v, 1 + first * r * r); break;
    case VL_PROJECTION_UNIFIED: *direction = from_sphere(first, u, v, 1); break;
    case VL_PROJECTION_EUCM: *direction = make_vector(u, v, enhanced(first, second, r * r)); break;
    default: *direction = from_sphere(first, u, v, enhanced(second, 1, r * r)); break; /* double sphere */
  }
  *direction = normalize(*direction);
  return !isnan(direction->z);
}
