/* more/patch.h: bilinear patches. */
#pragma once
#include "world.h"

bool meet_patch(const primitive *p, ray r, meeting *m);
void patch_surface(const world *w, const primitive *p, double u, double v, shade_record *record);
