/* light/point.c: point lights (pbrt book 12.2), set by scale or by power over the whole
 * sphere. */
#include <math.h>

#include "light/compile.h"
#include "velo/light.h"

vlCompileLight vl_compile_light_point;

vlResult vl_compile_light_point(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                                vlEmitted *e, vlError *error) {
  float factor = def->scale;
  if (!isnan(def->power))
    factor *= (float)(def->power / (4 * M_PI));
  vlResult r = vl_light_color(world, &def->color, factor, e, error);
  light->power = 4 * VL_PI * vl_light_luminance(&e->spectrum);
  return r;
}
