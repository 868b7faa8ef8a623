/* world/accel/brute_force.h: worlds of few primitives. Each ray is tested against all of them,
 * many rays at a time. Below some tens of triangles this is faster than any tree: the loops
 * over rays vectorise, and there is nothing to wait for. */
#ifndef WORLD_ACCEL_BRUTE_FORCE_H
#define WORLD_ACCEL_BRUTE_FORCE_H

#include "base/isa.h"
#include "world/accel/accel.h"

enum {
  VL_BRUTE_FACES = 48,    /* at most as many faces, and a multiple of VL_LANES */
  VL_BRUTE_OTHERS = 8,    /* at most as many primitives of other kinds, */
  VL_BRUTE_OTHER_COST = 4 /* each of which counts as this number of faces */
};

/* Triangles, and pairs of triangles that make up a plane convex quadrilateral, as a structure
 * of arrays in world space. Edge k leads from a corner to the next; the fourth edge of a
 * triangle is its third one again. A line with the direction d through the point o, relative to
 * the centre, passes edge k on the side that the sign of d . moment_k + (o x d) . edge_k tells
 * (Pluecker coordinates; Jones 2000, "Intersecting a ray and a triangle with Pluecker
 * coordinates", Ray Tracing News 13.1). Two faces with a common edge compute the same number
 * with opposite signs, so no ray passes between them. */
typedef struct vlBruteForce {
  uint32_t faces, others;
  float center[3];
  _Alignas(64) float edge[4][3][VL_BRUTE_FACES];   /* [edge][axis] */
  _Alignas(64) float moment[4][3][VL_BRUTE_FACES]; /* of the edge: a x b of its ends, relative
                                                      to the centre */
  _Alignas(64) float normal[3][VL_BRUTE_FACES];    /* unit length; 0 where a face has no area */
  /* a point of the face, not relative to the centre */
  _Alignas(64) float corner[3][VL_BRUTE_FACES];
  /* Rounding may put a line through a corner on the wrong side of all edges that meet there. So
   * a line may be outside of an edge by this number times |normal . d|: about a rounding error,
   * which makes the face wider by 1e-7 of the world. */
  _Alignas(64) float tolerance[VL_BRUTE_FACES];
  /* Of a quadrilateral: the edge between its triangles. The sign is positive for rays on the
   * side of the second triangle if that of all other edges is. */
  float diagonal_edge[VL_BRUTE_FACES][3], diagonal_moment[VL_BRUTE_FACES][3];
  bool pair[VL_BRUTE_FACES]; /* a quadrilateral: its second triangle is the next prim of the
                                shape */
  /* Ids of the faces (of their first triangles), then of the others, in the order of shapes and
   * prims. Of hits at the same distance the first counts. */
  uint32_t shape[VL_BRUTE_FACES + VL_BRUTE_OTHERS], prim[VL_BRUTE_FACES + VL_BRUTE_OTHERS];
  bool pass_shadow[VL_BRUTE_FACES + VL_BRUTE_OTHERS];
  float sphere[VL_BRUTE_OTHERS][4]; /* bounding spheres of the others: centre, radius squared */
} vlBruteForce;

/* Makes it for a world whose shapes are complete. *result is null if the world is not of that
 * kind: more primitives, instances, motion, opacities, surfaces with one side. Error:
 * MEMORY. */
vlResult vl_brute_force_make(const struct vlWorld *world, vlBruteForce **result);

/* As vl_accel_closest and vl_accel_occluded. The result for a ray does not depend on the other
 * rays, nor on their number. */
typedef struct vlBruteForceKernels {
  void (*closest)(const struct vlWorld *world, const vlBruteForce *b, uint32_t n,
                  const vlRays *rays, uint32_t *shape, uint32_t *prim, uint32_t *instance,
                  float *t);
  void (*occluded)(const struct vlWorld *world, const vlBruteForce *b, uint32_t n,
                   const vlRays *rays, uint8_t *occluded);
} vlBruteForceKernels;
VL_KERNEL_TABLE(vlBruteForceKernels, vl_brute_force)

#endif
