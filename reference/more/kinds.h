/* more/kinds.h: what the kinds of more/ keep in the core's structures, beside the core's own fields. */
#pragma once
#include "color.h"

typedef enum more_kind { MORE_COATED, MORE_HAIR } more_kind;

typedef struct more_bsdf {
  more_kind kind;
  double coat_thickness;       /* coated: sigma_t is 1 */
  uint32_t coat_depth;         /* coated: most surfaces that a walk inside meets */
  double offset;               /* hair: of the point from the middle, -1 to 1 */
  double beta_m, beta_n, tilt; /* hair: roughness along and around; angle of the scales */
  spectrum absorption;         /* hair: per radius */
} more_bsdf;

typedef struct more_light {
  int unused;
} more_light;
