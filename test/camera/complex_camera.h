/* camera/complex_camera.h: projection and distortion once more, from the equations of
 * docs/cameras.md, for complex numbers of long double. With a step of i 1e-40 in one number,
 * the imaginary part of the result is 1e-40 times the exact derivative: nothing cancels (Squire
 * and Trapp, "Using Complex Variables to Estimate Derivatives of Real Functions", 1998). It
 * shares nothing with the library but the numbers of vlCamera. */
#ifndef TEST_CAMERA_COMPLEX_CAMERA_H
#define TEST_CAMERA_COMPLEX_CAMERA_H

#include <complex.h>
#include <math.h>
#include <stdbool.h>

#include "velo/camera.h"
#include "velo/jacobian.h"

#undef I
typedef long double complex Number;
#define COMPLEX_STEP 1e-40L
static const long double COMPLEX_PI = 3.14159265358979323846264338327950288L;

static inline Number imaginary(long double size) {
  return CMPLXL(0.0L, size);
}

/* A camera of complex numbers; columns as in a Jacobian, the point's and the pose's are apart.
 */
typedef struct ComplexCamera {
  const vlCamera *of;
  Number fx, fy, skew, cx, cy, shape[2];
  Number numerator[6], denominator[3], tangential[2], prism[4], tau[2];
} ComplexCamera;

static inline ComplexCamera complex_camera(const vlCamera *c, const double tau[2]) {
  ComplexCamera z = {
      .of = c, .fx = c->fx, .fy = c->fy, .skew = c->skew, .cx = c->cx, .cy = c->cy};
  for (int i = 0; i < 2; i++) {
    z.shape[i] = c->shape[i];
    z.tangential[i] = c->distortion.tangential[i];
    z.tau[i] = tau[i];
  }
  for (int i = 0; i < 6; i++)
    z.numerator[i] = c->distortion.numerator[i];
  for (int i = 0; i < 3; i++)
    z.denominator[i] = c->distortion.denominator[i];
  for (int i = 0; i < 4; i++)
    z.prism[i] = c->distortion.prism[i];
  return z;
}

/* The number of a column from VL_JACOBIAN_INTRINSICS on. */
static inline Number *complex_column(ComplexCamera *z, int column) {
  Number *intrinsics[5] = {&z->fx, &z->fy, &z->skew, &z->cx, &z->cy};
  if (column < VL_JACOBIAN_SHAPE)
    return intrinsics[column - VL_JACOBIAN_INTRINSICS];
  if (column < VL_JACOBIAN_DISTORTION)
    return &z->shape[column - VL_JACOBIAN_SHAPE];
  int k = column - VL_JACOBIAN_DISTORTION;
  return k < 6    ? &z->numerator[k]
         : k < 9  ? &z->denominator[k - 6]
         : k < 11 ? &z->tangential[k - 9]
         : k < 15 ? &z->prism[k - 11]
                  : &z->tau[k - 15];
}

/* ---- functions --------------------------------------------------------------------------- */

/* The angle of (x, y) as atan2 has it. */
static inline Number complex_angle(Number y, Number x) {
  long double a = creall(x), b = creall(y);
  if (fabsl(a) >= fabsl(b))
    return catanl(y / x) + (a > 0 ? 0 : b >= 0 ? COMPLEX_PI : -COMPLEX_PI);
  return (b > 0 ? COMPLEX_PI / 2 : -COMPLEX_PI / 2) - catanl(x / y);
}

static inline Number complex_length(Number x, Number y, Number z) {
  return csqrtl(x * x + y * y + z * z);
}

/* x, or -x where its real part is negative. */
static inline Number complex_size(Number x) {
  return creall(x) < 0 ? -x : x;
}

/* ---- projections ------------------------------------------------------------------------- */

/* Direction to the plane: u and v. */
static void fisheye_plane(Number scale, const Number d[3], Number plane[2]) {
  Number across = csqrtl(d[0] * d[0] + d[1] * d[1]);
  plane[0] = scale * d[0] / across;
  plane[1] = scale * d[1] / across;
}

static void quotient_plane(Number under, const Number d[3], Number plane[2]) {
  plane[0] = d[0] / under;
  plane[1] = d[1] / under;
}

static void equal_area_plane(const Number d[3], Number plane[2]) {
  Number l = complex_length(d[0], d[1], d[2]);
  Number x = complex_size(d[0]) / l, y = complex_size(d[1]) / l, z = complex_size(d[2]) / l;
  Number r = csqrtl(1 - z), v = complex_angle(y, x) * 2 / COMPLEX_PI * r, u = r - v;
  Number across = creall(d[2]) < 0 ? 1 - v : u, down = creall(d[2]) < 0 ? 1 - u : v;
  plane[0] = creall(d[0]) < 0 ? -across : across;
  plane[1] = creall(d[1]) < 0 ? -down : down;
}

/* The faces right, left, up, down, front, back in a row. */
static void cube_plane(const Number d[3], Number plane[2]) {
  long double size[3];
  for (int i = 0; i < 3; i++)
    size[i] = fabsl(creall(d[i]));
  int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  bool ahead = creall(d[axis]) > 0;
  /* y of the plane points down, as the camera's does */
  int face = axis == 0 ? (ahead ? 0 : 1) : axis == 1 ? (ahead ? 3 : 2) : ahead ? 4 : 5;
  static const int right[6][2] = {{2, -1}, {2, 1}, {0, 1}, {0, 1}, {0, 1}, {0, -1}};
  static const int down[6][2] = {{1, 1}, {1, 1}, {2, 1}, {2, -1}, {1, 1}, {1, 1}};
  Number major = complex_size(d[axis]);
  Number a = right[face][1] * d[right[face][0]] / major;
  Number b = down[face][1] * d[down[face][0]] / major;
  plane[0] = face + (a + 1) / 2;
  plane[1] = (b + 1) / 2;
}

/* Between a direction and the view axis. */
static Number angle_of(const Number d[3]) {
  return complex_angle(csqrtl(d[0] * d[0] + d[1] * d[1]), d[2]);
}

/* False: a projection without a formula here. */
static bool complex_plane(const ComplexCamera *c, const Number d[3], Number plane[2]) {
  Number across2 = d[0] * d[0] + d[1] * d[1], across = csqrtl(across2);
  Number length = complex_length(d[0], d[1], d[2]), level = complex_length(d[0], 0, d[2]);
  Number p = c->shape[0], q = c->shape[1];
  switch (c->of->projection) {
    case VL_PROJECTION_PERSPECTIVE:
      quotient_plane(d[2], d, plane);
      return true;
    case VL_PROJECTION_ORTHOGRAPHIC:
      quotient_plane(1, d, plane);
      return true;
    case VL_PROJECTION_EQUIDISTANT:
      fisheye_plane(angle_of(d), d, plane);
      return true;
    case VL_PROJECTION_EQUISOLID:
      fisheye_plane(2 * csinl(angle_of(d) / 2), d, plane);
      return true;
    case VL_PROJECTION_STEREOGRAPHIC:
      fisheye_plane(2 * csinl(angle_of(d) / 2) / ccosl(angle_of(d) / 2), d, plane);
      return true;
    case VL_PROJECTION_SINE:
      fisheye_plane(csinl(angle_of(d)), d, plane);
      return true;
    case VL_PROJECTION_EQUIRECTANGULAR:
      plane[0] = complex_angle(d[0], d[2]);
      plane[1] = complex_angle(d[1], level);
      return true;
    case VL_PROJECTION_EQUAL_AREA:
      equal_area_plane(d, plane);
      return true;
    case VL_PROJECTION_CYLINDRICAL:
      plane[0] = complex_angle(d[0], d[2]);
      plane[1] = d[1] / level;
      return true;
    case VL_PROJECTION_CUBE:
      cube_plane(d, plane);
      return true;
    case VL_PROJECTION_PANINI: /* S = (p + 1) / (p + cos lambda), over the level radius */
      quotient_plane((p * level + d[2]) / (p + 1), d, plane);
      return true;
    case VL_PROJECTION_FOV:
      fisheye_plane(complex_angle(2 * across * csinl(p / 2), d[2] * ccosl(p / 2)) / p, d,
                    plane);
      return true;
    case VL_PROJECTION_DIVISION: /* r of  r / (1 + p r^2) = tan theta */
      quotient_plane((d[2] + csqrtl(d[2] * d[2] - 4 * p * across2)) / 2, d, plane);
      return true;
    case VL_PROJECTION_UNIFIED:
      quotient_plane(d[2] + p * length, d, plane);
      return true;
    case VL_PROJECTION_EUCM:
      quotient_plane(p * csqrtl(q * across2 + d[2] * d[2]) + (1 - p) * d[2], d, plane);
      return true;
    case VL_PROJECTION_DOUBLE_SPHERE: {
      Number second = p * length + d[2];
      quotient_plane(q * csqrtl(across2 + second * second) + (1 - q) * second, d, plane);
      return true;
    }
    default:
      return false;
  }
}

/* ---- distortion -------------------------------------------------------------------------- */

/* OpenCV's tilted sensor: rotations about x, then y, and the projection along the axis. */
static void complex_tilt(const Number tau[2], Number plane[2]) {
  Number cx = ccosl(tau[0]), sx = csinl(tau[0]), cy = ccosl(tau[1]), sy = csinl(tau[1]);
  const Number in[3] = {plane[0], cx * plane[1] + sx, cx - sx * plane[1]};
  const Number turned[3] = {cy * in[0] - sy * in[2], in[1], sy * in[0] + cy * in[2]};
  /* the third column of both rotations together */
  const Number axis[3] = {-sy * cx, sx, cy * cx};
  plane[0] = (axis[2] * turned[0] - axis[0] * turned[2]) / turned[2];
  plane[1] = (axis[2] * turned[1] - axis[1] * turned[2]) / turned[2];
}

static void complex_distort(const ComplexCamera *c, Number plane[2]) {
  Number a = plane[0], b = plane[1], s = a * a + b * b, above = 0, below = 0;
  for (int i = 5; i >= 0; i--)
    above = (above + c->numerator[i]) * s;
  for (int i = 2; i >= 0; i--)
    below = (below + c->denominator[i]) * s;
  Number q = (1 + above) / (1 + below), u = a * q, v = b * q;
  if (c->of->distortion.radial_first) {
    a = u;
    b = v;
    s = a * a + b * b;
  }
  const Number *p = c->tangential, *prism = c->prism;
  plane[0] = u + 2 * p[0] * a * b + p[1] * (s + 2 * a * a) + prism[0] * s + prism[1] * s * s;
  plane[1] = v + p[0] * (s + 2 * b * b) + 2 * p[1] * a * b + prism[2] * s + prism[3] * s * s;
  complex_tilt(c->tau, plane);
}

/* ---- the camera -------------------------------------------------------------------------- */

/* A point or direction in camera space to the film point, pixels. distorted: the camera has a
 * distortion, if only of zeros. */
static bool complex_film(const ComplexCamera *c, bool distorted, const Number d[3],
                         Number film[2]) {
  Number plane[2];
  if (!complex_plane(c, d, plane))
    return false;
  if (distorted)
    complex_distort(c, plane);
  film[0] = c->fx * plane[0] + c->skew * plane[1] + c->cx;
  film[1] = c->fy * plane[1] + c->cy;
  return true;
}

#endif
