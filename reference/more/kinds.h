/* more/kinds.h: what the kinds of more/ keep in the core's structures, beside the core's own fields. */
#pragma once
#include "color.h"

typedef struct more_bsdf {
  double coat_thickness; /* coated: sigma_t is 1 */
  uint32_t coat_depth;   /* coated: most surfaces that a walk inside meets */
} more_bsdf;

typedef struct more_light {
  int unused;
} more_light;
