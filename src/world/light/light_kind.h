/* world/light/light_kind.h: the kinds of light of a world. */
#ifndef WORLD_LIGHT_LIGHT_KIND_H
#define WORLD_LIGHT_LIGHT_KIND_H

#include "velo/light.h"

/* The kinds of light of the scene, with the same numbers, and AREA: a face of an emissive
 * shape. X(NAME, name). */
#define VL_WORLD_LIGHT_KINDS(X) VL_LIGHT_KINDS(X) X(AREA, area)
#define VL_WORLD_LIGHT_KIND(K, k) VL_WL_##K,
typedef enum vlWorldLightKind { VL_WORLD_LIGHT_KINDS(VL_WORLD_LIGHT_KIND) } vlWorldLightKind;
#undef VL_WORLD_LIGHT_KIND

#endif
