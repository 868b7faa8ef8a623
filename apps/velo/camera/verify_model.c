/* camera/verify_model.c: projects world points, independently of the library. It follows the
 * equations of the sources named in docs/cameras.md, with functions of the C library, one point
 * at a time. `velo camera verify` checks the library's projections against it, so it calls none
 * of them. */
#include <math.h>
#include <string.h>

#include "camera/verify.h"
#include "cli/vector.h"
#include "velo/distortion.h"
#include "velo/projection.h"

/* Computes *r, the distance from the principal point in focal lengths, for a direction at
 * `angle` radians from the axis. Returns false outside the projection's domain. */
static bool fisheye(vlProjection projection, double angle, double *r) {
  switch (projection) {
    case VL_PROJECTION_EQUIDISTANT:
      *r = angle;
      return true;
    case VL_PROJECTION_EQUISOLID:
      *r = 2.0 * sin(0.5 * angle);
      return true;
    case VL_PROJECTION_STEREOGRAPHIC:
      *r = 2.0 * tan(0.5 * angle);
      return true;
    case VL_PROJECTION_SINE:
      *r = sin(angle);
      return angle <= 0.5 * M_PI;
    default:
      return false;
  }
}

/* pbrt book 3.8.3, EqualAreaSphereToSquare; here the square is [-1, 1]^2. */
static void equal_area(const double p[3], double plane[2]) {
  double length = vector_length(p);
  double x = fabs(p[0]) / length, y = fabs(p[1]) / length, z = fabs(p[2]) / length;
  double r = sqrt((x * x + y * y) / (1.0 + z)), phi = 2.0 / M_PI * atan2(y, x);
  double v = phi * r, u = r - v;
  if (p[2] < 0.0) {
    double swap = u;
    u = 1.0 - v;
    v = 1.0 - swap;
  }
  plane[0] = copysign(u, p[0]);
  plane[1] = copysign(v, p[1]);
}

/* Cube faces: right, left, up, down, front, back, either in a row, or as a cross four faces
 * wide and three high. */
static void cube(bool as_cross, const double p[3], double plane[2]) {
  static const double at[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
  static const double ahead[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, -1, 0},
                                     {0, 1, 0}, {0, 0, 1},  {0, 0, -1}};
  static const double right[6][3] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0},
                                     {1, 0, 0},  {1, 0, 0}, {-1, 0, 0}};
  static const double down[6][3] = {{0, 1, 0},  {0, 1, 0}, {0, 0, 1},
                                    {0, 0, -1}, {0, 1, 0}, {0, 1, 0}};
  double max = -1.0;
  for (int face = 0; face < 6; face++) {
    double z = vector_dot(ahead[face], p);
    double x = vector_dot(right[face], p);
    double y = vector_dot(down[face], p);
    if (z <= max)
      continue;
    max = z;
    plane[0] = (as_cross ? at[face][0] : face) + 0.5 * (x / z + 1.0);
    plane[1] = (as_cross ? at[face][1] : 0.0) + 0.5 * (y / z + 1.0);
  }
}

/* The factor k of the projections that are symmetric about the axis: the image's point is
 * k (x, y). False: outside of the domain, or another projection (*known is then false). */
static bool axial(const vlCamera *c, const double p[3], double *k, bool *known) {
  double z = p[2];
  double across = sqrt(p[0] * p[0] + p[1] * p[1]); /* distance from the axis */
  double length = sqrt(across * across + z * z);
  double a = c->shape[0], b = c->shape[1]; /* the projection's parameters */
  double r;                                /* k across */
  switch (c->projection) {
    case VL_PROJECTION_EQUIDISTANT:
    case VL_PROJECTION_EQUISOLID:
    case VL_PROJECTION_STEREOGRAPHIC:
    case VL_PROJECTION_SINE:
      if (!fisheye(c->projection, atan2(across, z), &r))
        return false;
      *k = across > 0.0 ? r / across : 1.0 / z;
      break;
    case VL_PROJECTION_FOV:
      if (!(z > 0.0))
        return false;
      r = atan(2.0 * across / z * tan(0.5 * a)) / a;
      *k = across > 0.0 ? r / across : 1.0 / z;
      break;
    case VL_PROJECTION_DIVISION: {
      /* with R = across: the solution r of r z = R (1 + a r^2) that is 0 at R = 0 */
      double root = z * z - 4.0 * a * across * across;
      if (root < 0.0 || !(z > 0.0 || a < 0.0))
        return false;
      *k = 2.0 / (z + sqrt(root));
      break;
    }
    case VL_PROJECTION_UNIFIED:
      *k = 1.0 / (z + a * length);
      break;
    case VL_PROJECTION_EUCM:
      *k = 1.0 / (a * sqrt(b * across * across + z * z) + (1.0 - a) * z);
      break;
    case VL_PROJECTION_DOUBLE_SPHERE: { /* shape: xi, alpha */
      double second = a * length + z;
      *k = 1.0 / (b * sqrt(across * across + second * second) + (1.0 - b) * second);
      break;
    }
    default:
      *known = false;
      return false;
  }
  return *k > 0.0 && isfinite(*k);
}

/* Projects a point in camera space to the image plane before distortion, in focal lengths from
 * the principal point. False: outside of the projection's domain, or there is no formula here
 * for this projection (*known is then false). */
static bool to_plane(const vlCamera *c, const double p[3], double plane[2], bool *known) {
  double x = p[0], y = p[1], z = p[2];
  double a = c->shape[0];
  double k;
  *known = true;
  switch (c->projection) {
    case VL_PROJECTION_PERSPECTIVE:
      plane[0] = x / z;
      plane[1] = y / z;
      return z > 0.0;
    case VL_PROJECTION_ORTHOGRAPHIC:
      plane[0] = x;
      plane[1] = y;
      return z >= 0.0;
    case VL_PROJECTION_EQUIRECTANGULAR:
      plane[0] = atan2(x, z);
      plane[1] = asin(y / vector_length(p));
      return vector_length(p) > 0.0;
    case VL_PROJECTION_EQUAL_AREA:
      equal_area(p, plane);
      return vector_length(p) > 0.0;
    case VL_PROJECTION_CYLINDRICAL:
      plane[0] = atan2(x, z);
      plane[1] = y / sqrt(x * x + z * z);
      return x * x + z * z > 0.0;
    case VL_PROJECTION_CUBE:
      cube(a > 0.0, p, plane);
      return vector_length(p) > 0.0;
    case VL_PROJECTION_PANINI: {
      double longitude = atan2(x, z), latitude = atan2(y, sqrt(x * x + z * z));
      double s = (a + 1.0) / (a + cos(longitude));
      plane[0] = s * sin(longitude);
      plane[1] = s * tan(latitude);
      return cos(longitude) > -a && (a <= 1.0 || cos(longitude) >= -1.0 / a);
    }
    default:
      if (!axial(c, p, &k, known))
        return false;
      plane[0] = k * x;
      plane[1] = k * y;
      return true;
  }
}

/* OpenCV, "Camera Calibration and 3D Reconstruction"; the 14 coefficients are k1 k2 p1 p2 k3 k4
 * k5 k6 s1 s2 s3 s4 tx ty. */
static void opencv(const double *k, double plane[2]) {
  double x = plane[0], y = plane[1], r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  double q =
      (1.0 + k[0] * r2 + k[1] * r4 + k[4] * r6) / (1.0 + k[5] * r2 + k[6] * r4 + k[7] * r6);
  double u = x * q + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x) + k[8] * r2 + k[9] * r4;
  double v = y * q + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y + k[10] * r2 + k[11] * r4;
  if (k[12] != 0.0 || k[13] != 0.0) {
    /* R = Ry(ty) Rx(tx); s (u', v', 1) = [R33 0 -R13; 0 R33 -R23; 0 0 1] R (u, v, 1) */
    double cx = cos(k[12]), sx = sin(k[12]), cy = cos(k[13]), sy = sin(k[13]);
    double rx = cy * u + sy * sx * v - sy * cx, ry = cx * v + sx,
           rz = sy * u - cy * sx * v + cy * cx;
    double r13 = -sy * cx, r23 = sx, r33 = cy * cx;
    u = (r33 * rx - r13 * rz) / rz;
    v = (r33 * ry - r23 * rz) / rz;
  }
  plane[0] = u;
  plane[1] = v;
}

/* Applies the lens distortion to a point of the image plane. False: unknown distortion. */
static bool distort(const vlCameraDef *def, double plane[2]) {
  double k[14] = {0}, x = plane[0], y = plane[1], r2 = x * x + y * y;
  if (def->distortion_count > 14)
    return false;
  memcpy(k, def->distortion_coefficients, def->distortion_count * sizeof *k);
  switch (def->distortion) {
    case VL_DISTORTION_NONE:
      return true;
    case VL_DISTORTION_OPENCV:
      opencv(k, plane);
      return true;
    case VL_DISTORTION_RADIAL: {
      double q =
          1.0 + k[0] * r2 + k[1] * pow(r2, 2.0) + k[2] * pow(r2, 3.0) + k[3] * pow(r2, 4.0);
      plane[0] = q * x;
      plane[1] = q * y;
      return true;
    }
    case VL_DISTORTION_THIN_PRISM: { /* COLMAP: k1 k2 p1 p2 k3 k4 sx1 sy1 */
      double q = k[0] * r2 + k[1] * pow(r2, 2.0) + k[4] * pow(r2, 3.0) + k[5] * pow(r2, 4.0);
      plane[0] = x + x * q + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x) + k[6] * r2;
      plane[1] = y + y * q + 2.0 * k[3] * x * y + k[2] * (r2 + 2.0 * y * y) + k[7] * r2;
      return true;
    }
    case VL_DISTORTION_RAD_TAN_THIN_PRISM: { /* Project Aria: k0 to k5, p0 p1, s0 to s3 */
      double q = 1.0, power = 1.0;
      for (int i = 0; i < 6; i++) {
        power *= r2;
        q += k[i] * power;
      }
      x *= q;
      y *= q;
      r2 = x * x + y * y;
      plane[0] =
          x + k[6] * (2.0 * x * x + r2) + 2.0 * k[7] * x * y + k[8] * r2 + k[9] * r2 * r2;
      plane[1] =
          y + k[7] * (2.0 * y * y + r2) + 2.0 * k[6] * x * y + k[10] * r2 + k[11] * r2 * r2;
      return true;
    }
    default:
      return false;
  }
}

/* Solves world_from_camera (p, 1) = (point, 1) for p by Cramer's rule. */
static void to_camera(const double m[16], const double point[3], double p[3]) {
  double a[3] = {m[0], m[4], m[8]}, b[3] = {m[1], m[5], m[9]}, c[3] = {m[2], m[6], m[10]};
  double d[3] = {point[0] - m[3], point[1] - m[7], point[2] - m[11]}, n[3];
  vector_cross(b, c, n);
  const double det = vector_dot(a, n);
  p[0] = vector_dot(d, n) / det;
  vector_cross(d, c, n);
  p[1] = vector_dot(a, n) / det;
  vector_cross(b, d, n);
  p[2] = vector_dot(a, n) / det;
}

bool verify_knows(const VerifyModel *m) {
  const double ahead[3] = {0, 0, 1};
  double plane[2] = {0, 0};
  bool known;
  to_plane(&m->camera, ahead, plane, &known);
  return m->camera.eye_circle == 0.0 && known && distort(&m->def, (double[2]){0, 0});
}

bool verify_project(const VerifyModel *m, const double point[3], double pixel[2]) {
  const vlCamera *c = &m->camera;
  double p[3], plane[2] = {0, 0};
  bool known;
  to_camera(c->world_from_camera, point, p);
  if (!to_plane(c, p, plane, &known) || !distort(&m->def, plane))
    return false;
  pixel[0] = c->cx + c->fx * plane[0] + c->skew * plane[1];
  pixel[1] = c->cy + c->fy * plane[1];
  return isfinite(pixel[0]) && isfinite(pixel[1]);
}
