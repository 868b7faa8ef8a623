/* world/shape/surface_point.h: sphere, disk, cylinder, bilinear patch and curve: ray intersection, surface
 * properties at a hit, sampling by area. Computed in double, one point at a time: such shapes are few. Triangles are
 * handled in trace, in batches. Conventions (parametrisation, normals): pbrt book 6.2-6.4 and 6.6. */
#ifndef WORLD_SHAPE_SURFACE_POINT_H
#define WORLD_SHAPE_SURFACE_POINT_H

#include "world/world.h"

typedef struct vlShapeHit {
  double t;    /* along the (not normalised) ray */
  double a, b; /* bilinear patches, curves: parameters; else unused */
  double p[3]; /* shape space */
  double d[3]; /* curves: the ray's direction in shape space, unit */
} vlShapeHit;

/* Transforms a world-space ray to the space of an instance's group; t is unchanged. */
void vl_ray_to_group(const vlWorldInstance *instance, double o[3], double d[3]);

/* Nearest hit in (t_min, t_max) of a ray in group space. */
bool vl_shape_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3], const double d[3], double t_min,
                        double t_max, vlShapeHit *hit);

/* A point of a surface, in group space. n is unit, oriented as in pbrt (flip applied); uv are texture coordinates. */
typedef struct vlSurfacePoint {
  double p[3];
  double n[3];  /* geometric normal */
  double ns[3]; /* shading normal: vertex normals interpolated, else n */
  double dpdu[3], dpdv[3];
  double dndu[3], dndv[3]; /* derivatives of ns; 0 for curves, which are thin */
  double error[3];         /* for curves, the error bound of p along each axis; else 0: rounding alone */
  float uv[2];
} vlSurfacePoint;
/* The derivative of a unit normal n = m / |m|, |m| = length, from that of m: removes the component along n. */
static inline void vl_normal_derivative(const double n[3], double length, double d[3]) {
  double along = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
  for (int i = 0; i < 3; i++) d[i] = length > 0 ? (d[i] - along * n[i]) / length : 0;
}
void vl_shape_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit, vlSurfacePoint *point);

/* Whether the map preserves angles. *scale: factor on lengths. */
static inline bool vl_is_similarity(const double m[12], double *scale) {
  double l[3];
  for (int i = 0; i < 3; i++) l[i] = m[i] * m[i] + m[4 + i] * m[4 + i] + m[8 + i] * m[8 + i];
  if (l[1] > l[0] * 1.0001 || l[1] < l[0] * 0.9999 || l[2] > l[0] * 1.0001 || l[2] < l[0] * 0.9999) return false;
  for (int i = 0; i < 3; i++) { /* no shear: the axes stay perpendicular */
    int j = (i + 1) % 3;
    double skew = m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j];
    if (skew > l[0] * 0.0001 || skew < -l[0] * 0.0001) return false;
  }
  *scale = __builtin_sqrt(l[0]);
  return true;
}

/* Centre and radius of a full sphere under a similarity, in group space; false for any other shape. */
static inline bool vl_whole_sphere(const vlWorldShape *s, vlVec3 *center, float *radius) {
  const double *m = s->from_shape;
  double scale;
  if (s->kind != VL_SHAPE_SPHERE || s->centers || s->z_min > -s->radius || s->z_max < s->radius ||
      s->phi_max < 6.2831f || !vl_is_similarity(m, &scale))
    return false;
  *center = vl_vec3((float)m[3], (float)m[7], (float)m[11]);
  *radius = s->radius * (float)scale;
  return true;
}

/* Samples a point uniformly over the parameters, with its density per unit area in group space. */
void vl_shape_sample(const vlWorldShape *shape, uint32_t prim, float u, float v, vlSurfacePoint *point, double *pdf);
/* The density of vl_shape_sample at a given point. */
double vl_shape_pdf(const vlWorldShape *shape, uint32_t prim, const vlSurfacePoint *point);

#endif
