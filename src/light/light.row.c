/* light/light.row.c: the family of lights: the list of its rows, each from the file of its
 * kind, and the power of a light. */
#include "light/light.row.h"

#include <math.h>

#include "base/cookie.h"
#include "light/kinds.row.h"

#define DECLARE(kind, row, power, compile, sample, emit, density) \
  extern const vlKindRow row;                                     \
  vlLightPower power;
VL_LIGHT_FUNCTIONS(DECLARE)

const vlKindFamily vl_light_family = VL_KIND_FAMILY(
    VL_LIGHT_FUNCTIONS(VL_LIST_ROW), VL_LIGHT_KINDS, "lights", "light", "LightSource");

vlLightDef vl_default_light_def(vlLightKind kind) {
  vlLightDef def = {.cookie = VL_COOKIE_LIGHT, .kind = kind};
  vl_family_set_defaults(&vl_light_family, (int)kind, &def);
  for (int i = 0; i < 16; i += 5)
    def.world_from_light[i] = 1.0;
  return def;
}

double vl_light_power_unknown(VL_UNUSED const vlLightDef *def, VL_UNUSED double luminance,
                              VL_UNUSED double radius) {
  return NAN;
}

double vl_light_power(const vlLightDef *def, double luminance, double radius) {
  if (def->power > 0)
    return def->power * (double)def->scale;
  switch (def->kind) {
#define POWER_OF(kind, row, power, compile, sample, emit, density) \
  case kind:                                                       \
    return power(def, luminance, radius);
    VL_LIGHT_FUNCTIONS(POWER_OF)
  }
  return NAN;
}
