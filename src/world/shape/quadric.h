/* world/shape/quadric.h: sphere, disk, cylinder, for surface_point.c. at: a point in group space. */
#ifndef WORLD_SHAPE_QUADRIC_H
#define WORLD_SHAPE_QUADRIC_H

#include "world/shape/double3.h"
#include "world/shape/surface_point.h"

/* o, d: ray in group space. Fills t and p. */
bool vl_quadric_intersect(const vlWorldShape *shape, const double o[3], const double d[3], double t_min, double t_max,
                          vlShapeHit *hit);
void vl_quadric_point(const vlWorldShape *shape, const double p[3], vlSurfacePoint *point); /* p: shape space */
void vl_quadric_sample(const vlWorldShape *shape, float u, float v, vlSurfacePoint *point, double *pdf);
double vl_quadric_pdf(const vlWorldShape *shape, const double at[3]);

#endif
