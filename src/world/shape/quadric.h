/* world/shape/quadric.h: sphere, disk, cylinder, for surface_point.c. at: a point in group space. */
#ifndef WORLD_SHAPE_QUADRIC_H
#define WORLD_SHAPE_QUADRIC_H

#include "world/shape/double3.h"
#include "world/shape/surface_point.h"

/* o, d: ray in group space. Fills t and p. */
bool vl_quadric_intersect(const vlWorldShape *shape, uint32_t prim, const double o[3], const double d[3], double t_min,
                          double t_max, vlShapeHit *hit);
void vl_quadric_point(const vlWorldShape *shape, uint32_t prim, const double p[3],
                      vlSurfacePoint *point); /* p: shape space */
void vl_quadric_sample(const vlWorldShape *shape, uint32_t prim, float u, float v, vlSurfacePoint *point, double *pdf);
/* Extends low and high by the corners of the box of the prim, in group space. */
void vl_quadric_bounds(const vlWorldShape *shape, uint32_t prim, double low[3], double high[3]);
double vl_quadric_pdf(const vlWorldShape *shape, uint32_t prim, const double at[3]);

#endif
