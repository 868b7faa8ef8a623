/* more/kinds.h: what the kinds of more/ keep in the core's structures, beside the core's own fields. */
#pragma once
#include "color.h"

typedef enum more_kind { MORE_COATED, MORE_HAIR, MORE_TRANSLUCENT, MORE_THIN_GLASS, MORE_PRINCIPLED } more_kind;

typedef struct more_bsdf {
  more_kind kind;
  bool metal;            /* coated: the base is one; else it is diffuse */
  double coat_thickness; /* coated: sigma_t is 1 */
  double coat_alpha_x, coat_alpha_y;
  spectrum coat_albedo; /* coated: of the medium under the coat */
  double coat_g;
  uint32_t coat_depth;         /* coated: most events of a walk inside */
  double offset;               /* hair: of the point from the middle, -1 to 1 */
  double beta_m, beta_n, tilt; /* hair: roughness along and around; angle of the scales */
  spectrum absorption;         /* hair: per radius */
  spectrum transmittance;      /* diffuse transmission */
  /* principled: shares of metal, of the dielectric that transmits, of diffuse light that goes on, of the coat */
  double metallic, clear, passed_on, coat;
  spectrum f0; /* principled: what the dielectric reflects of light along the normal, and of grazing light */
  double f90, sheen_alpha;
  spectrum sheen, tint, tint_rgb; /* tint: of what goes through, at the wavelengths and by channels of RGB */
} more_bsdf;
