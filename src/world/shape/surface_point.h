/* world/shape/surface_point.h: sphere, disk, cylinder, bilinear patch and curve: where a ray meets them, what the
 * surface is like there, and points spread over them by area. Double inside; scalar: such shapes are few. Triangles
 * live in trace (batches). Conventions (parametrisation, normals): pbrt book 6.2-6.4 and 6.6. */
#ifndef WORLD_SHAPE_SURFACE_POINT_H
#define WORLD_SHAPE_SURFACE_POINT_H

#include "world/world.h"

typedef struct vlShapeHit {
  double t;    /* along the (not normalised) ray */
  double a, b; /* bilinear patches, curves: parameters; else unused */
  double p[3]; /* shape space */
  double d[3]; /* curves: the ray's direction in shape space, unit */
} vlShapeHit;

/* A ray of the world in the space of an instance's group; t stays what it is. */
void vl_ray_to_group(const vlWorldInstance *instance, double o[3], double d[3]);

/* Nearest hit in (t_min, t_max) of a ray in group space. */
bool vl_shape_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3], const double d[3], double t_min,
                        double t_max, vlShapeHit *hit);

/* All in group space; n is unit, oriented as pbrt orients it (flip applied); uv as textures see it. */
typedef struct vlSurfacePoint {
  double p[3];
  double n[3];  /* geometric normal */
  double ns[3]; /* shading normal: vertex normals interpolated, else n */
  double dpdu[3], dpdv[3];
  double dndu[3], dndv[3]; /* of ns; curves: 0, they are thin */
  double error[3];         /* of curves, how far off p may be along each axis; else 0: rounding alone */
  float uv[2];
} vlSurfacePoint;
/* The derivative of a unit normal n = m / |m|, |m| = length, from that of m: what points along n goes. */
static inline void vl_normal_derivative(const double n[3], double length, double d[3]) {
  double along = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
  for (int i = 0; i < 3; i++) d[i] = length > 0 ? (d[i] - along * n[i]) / length : 0;
}
void vl_shape_point(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit, vlSurfacePoint *point);

/* Does the map keep angles? *scale: how much longer lengths become. */
static inline bool vl_is_similarity(const double m[12], double *scale) {
  double l[3];
  for (int i = 0; i < 3; i++) l[i] = m[i] * m[i] + m[4 + i] * m[4 + i] + m[8 + i] * m[8 + i];
  if (l[1] > l[0] * 1.0001 || l[1] < l[0] * 0.9999 || l[2] > l[0] * 1.0001 || l[2] < l[0] * 0.9999) return false;
  for (int i = 0; i < 3; i++) { /* no shear: the axes stay at right angles */
    int j = (i + 1) % 3;
    double skew = m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j];
    if (skew > l[0] * 0.0001 || skew < -l[0] * 0.0001) return false;
  }
  *scale = __builtin_sqrt(l[0]);
  return true;
}

/* Centre and radius of a whole sphere under a similarity, in group space; else false. */
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

/* A point spread uniformly over the parameters, with its density per unit area in group space. */
void vl_shape_sample(const vlWorldShape *shape, uint32_t prim, float u, float v, vlSurfacePoint *point, double *pdf);
/* The density that vl_shape_sample gives to a point already found. */
double vl_shape_pdf(const vlWorldShape *shape, uint32_t prim, const vlSurfacePoint *point);

#endif
