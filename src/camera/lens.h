/* camera/lens.h: the thin lens, applied after any projection: a disk in the plane z = 0. Rays
 * of one film point that start at different points of the disk meet in the plane of focus z =
 * focus distance (pbrt book 5.2.3). */
#ifndef CAMERA_LENS_H
#define CAMERA_LENS_H

#include "camera/rays.h"

typedef struct vlLensPoint {
  float x, y;
} vlLensPoint;

/* Maps [0,1)^2 to the unit disk and preserves area; concentric squares become circles (Shirley
 * and Chiu, "A low distortion map between disk and square", 1997). The angle within each
 * quarter is at most pi/4, so short Taylor polynomials replace sine and cosine, without
 * branches. Their error is below 4e-7 of the radius. */
static inline vlLensPoint vl_lens_disk(float u, float v) {
  float a = 2.0f * u - 1.0f, b = 2.0f * v - 1.0f;
  float aa = a < 0.0f ? -a : a, bb = b < 0.0f ? -b : b;
  int wide = aa > bb;
  float radius = wide ? a : b, other = wide ? b : a;
  float divisor = radius == 0.0f ? 1.0f : radius;
  float angle = 0.785398163f * (other / divisor);
  float q = angle * angle;
  float sine =
      angle * (1.0f + q * (-1.66666667e-1f + q * (8.33333333e-3f + q * -1.98412698e-4f)));
  float cosine =
      1.0f + q * (-0.5f + q * (4.16666667e-2f + q * (-1.38888889e-3f + q * 2.48015873e-5f)));
  float along = radius * cosine, across = radius * sine;
  return (vlLensPoint){wide ? along : across, wide ? across : along};
}

/* The ray through the point (lx, ly) of the lens, bent there. */
static inline vlCameraLocal vl_lens_bend(vlCameraLocal r, double lx, double ly, double bend) {
  r.ox += lx;
  r.oy += ly;
  r.dx -= lx * bend;
  r.dy -= ly * bend;
  return r;
}

/* With r = o + s d and the point of focus at z = F: the ray starts at o + l and aims at o + d
 * F/dz. depth = dz. Projections that see more than the half-space z > 0 focus on a sphere: for
 * them d has unit length and depth is 1. */
static inline vlCameraLocal vl_lens_apply_at(const vlCameraCompiled *c, vlCameraLocal r,
                                             vlLensPoint disk, double depth) {
  double lx = c->lens_radius * (double)disk.x, ly = c->lens_radius * (double)disk.y;
  return vl_lens_bend(r, lx, ly, depth * c->inv_focus);
}
static inline vlCameraLocal vl_lens_apply(const vlCameraCompiled *c, vlCameraLocal r,
                                          vlLensPoint disk) {
  return vl_lens_apply_at(c, r, disk, r.dz);
}

/* The general case, with the plane in focus p . focus = 1: the ray o + s d intersects it at 1 /
 * s = d . focus / (1 - o . focus). lens: a point of the aperture, in lens radii. */
static inline vlCameraLocal vl_lens_refract(const vlCameraCompiled *c, vlCameraLocal r,
                                            vlLensPoint lens) {
  double lx = c->lens_radius * (double)lens.x, ly = c->lens_radius * (double)lens.y;
  const double *a = c->focus;
  double plane = (a[0] * r.dx + a[1] * r.dy + a[2] * r.dz) / (1.0 - a[0] * r.ox - a[1] * r.oy);
  return vl_lens_bend(r, lx, ly, c->ahead ? plane : c->inv_focus);
}

/* Maps n pairs of random numbers to points of a shaped aperture. Defined in lens_points.c. */
void vl_lens_points(const vlCameraCompiled *c, uint32_t n, const float *u, const float *v,
                    float *x, float *y);

#endif
