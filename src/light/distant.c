/* light/distant.c: distant lights, infinitely far away in one direction (pbrt book 12.3),
 * set by scale or illuminance. */
#include <math.h>

#include "light/compile.h"
#include "velo/light.h"

vlCompileLight vl_compile_light_distant;

vlResult vl_compile_light_distant(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                                  vlEmitted *e, vlError *error) {
  float factor = def->scale;
  if (!isnan(def->illuminance))
    factor *= (float)def->illuminance;
  vlResult r = vl_light_color(world, &def->color, factor, e, error);
  light->power = VL_PI * world->radius * world->radius * vl_light_luminance(&e->spectrum);
  return r;
}
