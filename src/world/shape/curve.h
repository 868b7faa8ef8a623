/* world/shape/curve.h: curves, for surface_point.c: see there. Each primitive is a piece of a cubic Bezier segment. */
#ifndef WORLD_SHAPE_CURVE_H
#define WORLD_SHAPE_CURVE_H

#include "world/shape/surface_point.h"

/* Lays a scene's curves out; false: out of memory. Pieces: 2^s->split a segment. */
bool vl_curve_copy(vlWorld *world, const vlShapeDef *def, vlWorldShape *s);
void vl_curve_bounds(const vlWorldShape *s, uint32_t prim, double low[3], double high[3]);
/* Fills t, a, b (u along the segment, v across), p, d. */
bool vl_curve_intersect(const vlWorldShape *s, uint32_t prim, const double o[3], const double d[3], double t_min,
                        double t_max, vlShapeHit *hit);
void vl_curve_point(const vlWorldShape *s, uint32_t prim, const vlShapeHit *hit, vlSurfacePoint *point);
/* The middle of a piece, seen from the front; curves do not emission, so that nothing else is asked for. */
void vl_curve_middle(const vlWorldShape *s, uint32_t prim, vlSurfacePoint *point);

#endif
