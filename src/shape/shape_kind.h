/* shape/shape_kind.h: the functions of each kind of shape: sphere, disk, cylinder (quadric.c),
 * triangle mesh (triangles.c), bilinear patches (bilinear.c), curves (curves.c). They intersect
 * rays, compute the surface at a hit, and sample points by area. They compute one point at a
 * time in double precision, since such shapes are few. (The room trace handles triangles, in
 * batches.) Conventions (parametrisation, normals): pbrt book 6.2-6.4 and 6.6. */
#ifndef SHAPE_SHAPE_KIND_H
#define SHAPE_SHAPE_KIND_H

#include "math/double3.h"
#include "math/transform.h"
#include "world/world.h"

typedef struct vlShapeHit {
  double t;    /* distance along the ray, in units of its direction (not normalised) */
  double a, b; /* parameters of the hit on a bilinear patch or curve; unused by other kinds */
  double p[3]; /* position of the hit, shape space */
  double d[3]; /* used by curves: the ray's direction in shape space, unit length */
} vlShapeHit;

/* A point of a surface, in group space. n has unit length and is oriented as in pbrt
 * (vlWorldShape.flip is applied); uv are texture coordinates. */
typedef struct vlSurfacePoint {
  double p[3];
  double n[3];  /* geometric normal */
  double ns[3]; /* shading normal: the interpolated vertex normal, or n if there are no vertex
                   normals */
  double dpdu[3], dpdv[3];
  double dndu[3], dndv[3]; /* derivatives of ns; 0 for curves, which are thin */
  double error[3]; /* bound of the distance between p and the surface that a ray meets, along
                      each axis */
  /* of curves: a ray that leaves starts this far off p, along n; 0 for other kinds */
  double off;
  float uv[2];
} vlSurfacePoint;
/* Derivative of the unit normal n = m / |m|. On entry d is the derivative of m, on return that
 * of n. length: |m|. The component of d along n is removed. */
static inline void vl_normal_derivative(const double n[3], double length, double d[3]) {
  double along = vl_dot3(n, d);
  for (int i = 0; i < 3; i++)
    d[i] = length > 0 ? (d[i] - along * n[i]) / length : 0;
}

/* Reports what is wrong with a shape at its place in the file. */
vlResult vl_fail_shape(const vlShapeDef *def, vlError *error, const char *what);

/* Relative error of what is computed in double precision from the numbers of a shape: thousands
 * of roundings, so that there is room for maps with a condition number of as much. */
#define VL_SHAPE_ERROR 0x1p-40

/* The functions of one kind of shape. All arguments are in group space. */
typedef struct vlShapeFunctions {
  /* Copies the members that only this kind has. On entry `shape` holds the numbers of the def,
   * both maps, and a face count of 1. */
  vlResult (*compile)(vlWorld *world, const vlShapeDef *def, const vlMat4 *to_group,
                      const vlMat4 *from_group, vlWorldShape *shape, vlError *error);
  /* Extends the box [low, high] by the bounding box of a face. */
  void (*bounds)(const vlWorldShape *shape, uint32_t prim, double low[3], double high[3]);
  /* Finds the nearest hit of a ray in (t_min, t_max) and fills the members of hit that `point`
   * reads. False: no hit. */
  bool (*intersect)(const vlWorldShape *shape, uint32_t prim, const double o[3],
                    const double d[3], double t_min, double t_max, vlShapeHit *hit);
  /* Computes the surface at a hit. */
  void (*point)(const vlWorldShape *shape, uint32_t prim, const vlShapeHit *hit,
                vlSurfacePoint *point);
  /* Samples a point from random numbers u, v in [0, 1), and gives its density per area. The
   * caller sets *point and *pdf to 0 before. */
  void (*sample)(const vlWorldShape *shape, uint32_t prim, float u, float v,
                 vlSurfacePoint *point, double *pdf);
  /* The density per area with which `sample` gives the point `at`. */
  double (*pdf)(const vlWorldShape *shape, uint32_t prim, const double at[3]);
} vlShapeFunctions;

#endif
