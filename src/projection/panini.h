/* projection/panini.h: the general Panini projection and its inverse. The scene is projected
 * onto a cylinder about the vertical axis, and the cylinder is viewed from a distance d behind
 * its axis. d = 0 is the perspective projection and d = 1 is the cylindrical stereographic
 * projection; large d approaches the cylindrical orthographic projection. Vertical lines and
 * lines through the centre stay straight (Sharpless, Postle, German, "Pannini: A New Projection
 * for Rendering Wide Angle Perspective Images", 2010). */
#ifndef PROJECTION_PANINI_H
#define PROJECTION_PANINI_H

#include "camera/plane.h"
#include "camera/rays.h"

/* Returns the lower bound of cos(longitude). At the bound the plane is infinite for d <= 1, and
 * it folds for d > 1. */
static inline double vl_panini_edge(double d) {
  return d <= 1.0 ? -d : -1.0 / d;
}

VL_INLINE vlDirection vl_unproject_panini(VL_UNPROJECT_INPUT) {
  double d = c->shape[0];
  double k = x * x / ((d + 1.0) * (d + 1.0)), root = 1.0 + k * (1.0 - d * d);
  double cosine = (vl_root(root) - k * d) / (k + 1.0);
  double over = d + cosine, s = (d + 1.0) / vl_not_tiny(over);
  return (vlDirection){x / s, y / s, cosine,
                       root >= 0.0 && over > VL_HORIZON && k < 1e24 ? 1.0 : 0.0};
}
VL_INLINE vlPlanePoint vl_project_panini(VL_PROJECT_INPUT) {
  double d = c->shape[0];
  double across = vl_length_2d(x, z), scale = 1.0 / vl_not_tiny(across), cosine = z * scale;
  double over = d + cosine, s = (d + 1.0) / vl_not_tiny(over) * scale;
  return (vlPlanePoint){
      x * s, y * s,
      across > 0.0 && over > VL_HORIZON && cosine >= vl_panini_edge(d) ? 1.0 : 0.0};
}

/* The divisor is (d |xz| + z) / (d + 1). */
VL_INLINE vlPlaneDerivatives vl_derive_panini(VL_PROJECT_INPUT) {
  double d = c->shape[0], across = vl_length_2d(x, z), k = 1.0 / (d + 1.0);
  double divisor = (d * across + z) * k;
  const double by[5] = {d * k * x / across, 0.0, (d * z / across + 1.0) * k,
                        (across - z) * k * k, 0.0};
  return vl_derive_quotient(x, y, divisor, by);
}

#endif
