/* camera/lens.h: the thin lens, applied once after the projection, the same for all of them. A disk in the plane z = 0:
 * whatever point of it a ray starts from, it meets the others in the plane of focus z = focus distance (pbrt
 * book 5.2.3). */
#ifndef CAMERA_LENS_H
#define CAMERA_LENS_H

#include "camera/local.h"
#include "camera/rays.h"

typedef struct vlLensPoint {
  float x, y;
} vlLensPoint;

/* [0,1)^2 to the unit disk, area-preserving, square rings to circles (Shirley and Chiu, "A low distortion map between
 * disk and square", 1997). The angle inside a quarter stays within pi/4, so short Taylor polynomials serve for sine and
 * cosine (error below 4e-7 of the radius) and no branch is needed. */
static inline vlLensPoint vl_lens_disk(float u, float v) {
  float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
  float aa = a < 0.0f ? -a : a, bb = b < 0.0f ? -b : b;
  int wide = aa > bb;
  float radius = wide ? a : b, other = wide ? b : a;
  float divisor = radius == 0.0f ? 1.0f : radius;
  float angle = 0.785398163f * (other / divisor);
  float q = angle * angle;
  float sine = angle * (1.0f + q * (-1.66666667e-1f + q * (8.33333333e-3f + q * -1.98412698e-4f)));
  float cosine = 1.0f + q * (-0.5f + q * (4.16666667e-2f + q * (-1.38888889e-3f + q * 2.48015873e-5f)));
  float along = radius * cosine, across = radius * sine;
  return (vlLensPoint){wide ? along : across, wide ? across : along};
}

/* With r = o + s d and the point of focus at z = F: start at o + l, aim at o + d F/dz. depth = dz. Projections that see
 * more than what lies ahead focus on a sphere instead: d of unit length, depth = 1. */
static inline vlCameraLocal vl_lens_apply_at(const vlCameraCompiled *c, vlCameraLocal r, vlLensPoint disk,
                                             double depth) {
  double lx = c->lens_radius * (double)disk.x, ly = c->lens_radius * (double)disk.y;
  double bend = depth * c->inv_focus;
  r.ox += lx;
  r.oy += ly;
  r.dx -= lx * bend;
  r.dy -= ly * bend;
  return r;
}
static inline vlCameraLocal vl_lens_apply(const vlCameraCompiled *c, vlCameraLocal r, vlLensPoint disk) {
  return vl_lens_apply_at(c, r, disk, r.dz);
}

/* The general case, with the plane in focus p . focus = 1: the ray o + s d meets it at 1 / s = d . focus / (1 - o .
 * focus). lens: a point of the opening, in lens radii. */
static inline vlCameraLocal vl_lens_refract(const vlCameraCompiled *c, vlCameraLocal r, vlLensPoint lens) {
  double lx = c->lens_radius * (double)lens.x, ly = c->lens_radius * (double)lens.y;
  const double *a = c->focus;
  double plane = (a[0] * r.dx + a[1] * r.dy + a[2] * r.dz) / (1.0 - a[0] * r.ox - a[1] * r.oy);
  double bend = c->ahead ? plane : c->inv_focus;
  r.ox += lx;
  r.oy += ly;
  r.dx -= lx * bend;
  r.dy -= ly * bend;
  return r;
}

/* lens_points.c: n pairs of random numbers to points of a shaped opening. */
void vl_lens_points(const vlCameraCompiled *c, uint32_t n, const float *u, const float *v, float *x, float *y);

#endif
