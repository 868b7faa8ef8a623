/* world/shape/patch.h: the bilinear patch, for surface_point.c. Its vertices are in group space. */
#ifndef WORLD_SHAPE_PATCH_H
#define WORLD_SHAPE_PATCH_H

#include "world/shape/double3.h"
#include "world/shape/surface_point.h"

/* Fills t, a, b. */
bool vl_patch_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3], const double d[3], double t_min,
                        double t_max, vlShapeHit *hit);
void vl_patch_point(const vlWorldShape *shape, uint32_t prim, double u, double v, vlSurfacePoint *point);
void vl_patch_sample(const vlWorldShape *shape, uint32_t prim, float u, float v, vlSurfacePoint *point, double *pdf);
double vl_patch_pdf(const vlWorldShape *shape, uint32_t prim, const double at[3]);

#endif
