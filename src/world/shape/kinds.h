/* world/shape/kinds.h: the functions of each kind of shape: sphere, disk, cylinder (quadric.c), triangle mesh (mesh.c),
 * bilinear patches (patch.c), curves (curve.c). Ray intersection, surface properties at a hit, sampling by area.
 * Computed in double, one point at a time: such shapes are few. (Triangles are handled in trace, in batches.)
 * Conventions (parametrisation, normals): pbrt book 6.2-6.4 and 6.6. */
#ifndef WORLD_SHAPE_KINDS_H
#define WORLD_SHAPE_KINDS_H

#include "math/transform.h"
#include "world/shape/double3.h"
#include "world/world.h"

typedef struct vlShapeHit {
  double t;    /* along the (not normalised) ray */
  double a, b; /* bilinear patches, curves: parameters; else unused */
  double p[3]; /* shape space */
  double d[3]; /* curves: the ray's direction in shape space, unit */
} vlShapeHit;

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

/* Of a kind, each in group space. */
typedef struct vlShapeFunctions {
  /* Copies what the kind alone has. `shape` holds the numbers of the def, both maps and one face. */
  vlResult (*compile)(vlWorld *world, const vlShapeDef *def, const vlMat4 *to_group, const vlMat4 *from_group,
                      vlWorldShape *shape, vlError *error);
  /* Extends low and high by the box of a face. */
  void (*bounds)(const vlWorldShape *shape, uint32_t prim, double low[3], double high[3]);
  /* The nearest hit in (t_min, t_max) of a ray: fills what `point` reads. False: none. */
  bool (*intersect)(const vlWorldShape *shape, uint32_t prim, const double o[3], const double d[3], double t_min,
                    double t_max, vlShapeHit *hit);
  /* The surface at a hit. The errors are 0 when it is called. */
  void (*point)(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit, vlSurfacePoint *point);
  /* A point for random numbers u, v in [0, 1), and its density per area. Both are 0 when it is called. */
  void (*sample)(const vlWorldShape *shape, uint32_t prim, float u, float v, vlSurfacePoint *point, double *pdf);
  /* The density of `sample` at a point. */
  double (*pdf)(const vlWorldShape *shape, uint32_t prim, const double at[3]);
} vlShapeFunctions;

/* Defines the functions of a kind, which are called PREFIX_compile and so on: one that is missing does not compile. */
#define VL_SHAPE_FUNCTIONS(kind, prefix)                                                                    \
  const vlShapeFunctions vl_shape_functions_##kind = {                                                      \
      prefix##_compile, prefix##_bounds, prefix##_intersect, prefix##_point, prefix##_sample, prefix##_pdf, \
  };
/* A kind without functions does not link. */
#define VL_SHAPE_DECLARE(K, k) extern const vlShapeFunctions vl_shape_functions_##k;
VL_SHAPE_KINDS(VL_SHAPE_DECLARE)
#undef VL_SHAPE_DECLARE

#endif
