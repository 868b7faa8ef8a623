/* more/shapes.h: bilinear patches and curves. */
#pragma once
#include "world.h"

bool meet_patch(const primitive *p, ray r, meeting *m);
void patch_surface(const world *w, const primitive *p, double u, double v, shade_record *record);
bool meet_curve(const world *w, const primitive *p, ray r, meeting *m);
void curve_surface(const world *w, const primitive *p, double u, double v, shade_record *record);
void bound_curve(const world *w, primitive *p);

/* more/accelerator.c: makes the box of a primitive contain a point. */
void include_point(primitive *p, vector point);
