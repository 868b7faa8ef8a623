/* more/kinds.h: what the kinds of more/ keep in the core's structures, beside the core's own fields. */
#ifndef REFERENCE_MORE_KINDS_H
#define REFERENCE_MORE_KINDS_H

#include "color.h"

typedef struct more_bsdf {
  double coat_thickness; /* coated: sigma_t is 1 */
  uint32_t coat_depth;   /* coated: most surfaces that a walk inside meets */
} more_bsdf;

typedef struct more_material {
  int unused;
} more_material;

typedef struct more_light {
  int unused;
} more_light;

typedef struct more_medium {
  int unused;
} more_medium;

#endif
