/* shape/surface_point.h: surface points of shapes of any kind (kinds.h): intersection,
 * evaluation and sampling. */
#ifndef SHAPE_SURFACE_POINT_H
#define SHAPE_SURFACE_POINT_H

#include "math/double3.h"
#include "shape/shape_kind.h"
#include "velo/shape.h"

/* Transforms a world-space ray to the space of an instance's group; t is unchanged. */
void vl_ray_to_group(const vlWorldInstance *instance, double o[3], double d[3]);

/* Raises vlWorldInstance.error to the bound for these maps: from_group m and its inverse w,
 * both rounded to floats. A point x of the group is placed at m x; a ray is mapped by w, which
 * puts it at w m x, off by rounding errors of at most gamma |w| (|m| |x|), and so off by |m|
 * times that in world space. Embree computes its own w, with errors as large. */
void vl_instance_error(const float m[12], const float w[12], float error[4]);

/* Fills the members of *shape that only its kind has. to_group, from_group: the def's transform
 * and its inverse. */
vlResult vl_shape_compile(vlWorld *world, const vlShapeDef *def, const vlMat4 *to_group,
                          const vlMat4 *from_group, vlWorldShape *shape, vlError *error);

/* Nearest hit in (t_min, t_max) of a ray in group space. */
bool vl_shape_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3],
                        const double d[3], double t_min, double t_max, vlShapeHit *hit);

/* Computes the surface at a hit of vl_shape_intersect. */
void vl_shape_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit,
                    vlSurfacePoint *point);

/* Whether the map preserves angles. *scale: the factor by which it multiplies lengths. */
static inline bool vl_is_similarity(const double m[12], double *scale) {
  double l[3];
  for (int i = 0; i < 3; i++)
    l[i] = vl_dot_columns(m, i, i);
  if (l[1] > l[0] * 1.0001 || l[1] < l[0] * 0.9999 || l[2] > l[0] * 1.0001 ||
      l[2] < l[0] * 0.9999)
    return false;
  for (int i = 0; i < 3; i++) { /* no shear: the axes stay perpendicular */
    double skew = vl_dot_columns(m, i, (i + 1) % 3);
    if (skew > l[0] * 0.0001 || skew < -l[0] * 0.0001)
      return false;
  }
  *scale = __builtin_sqrt(l[0]);
  return true;
}

/* By how much the radius of a unit sphere under a map of vl_is_similarity may deviate from
 * `scale`, relative to it: bound from the entries of m^T m / scale^2 - 1 (Gershgorin's
 * circles). */
static inline double vl_similarity_error(const double m[12], double scale) {
  double max = 0;
  for (int i = 0; i < 3; i++) {
    double sum = 0;
    for (int j = 0; j < 3; j++)
      sum += __builtin_fabs(vl_dot_columns(m, i, j) / (scale * scale) - (i == j));
    max = sum > max ? sum : max;
  }
  return max;
}

/* Centre and radius of a full sphere under a similarity, in group space; false for any other
 * shape. */
static inline bool vl_whole_sphere(const vlWorldShape *s, vlVec3 *center, float *radius) {
  *center = vl_load3(s->whole_center);
  *radius = s->whole_radius;
  return s->whole_radius > 0.0f;
}

/* Samples a point uniformly over the parameters, with its density per unit area in group
 * space. */
void vl_shape_sample(const vlWorldShape *shape, uint32_t prim, float u, float v,
                     vlSurfacePoint *point, double *pdf);
/* The density with which vl_shape_sample gives this point. */
double vl_shape_pdf(const vlWorldShape *shape, uint32_t prim, const vlSurfacePoint *point);

#endif
