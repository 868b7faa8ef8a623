/* light/light_kind.h: the kinds of light of a world: those of the scene, with the same numbers,
 * and a face of an emissive shape. */
#ifndef LIGHT_LIGHT_KIND_H
#define LIGHT_LIGHT_KIND_H

#include "velo/light.h"

enum {
#define VL_COUNT(kind, name) +1
  VL_LIGHT_AREA = 0 VL_LIGHT_KINDS(VL_COUNT)
#undef VL_COUNT
};

#endif
