/* light/spot.c: spot lights (pbrt book 12.2.1), set by scale or by power over the
 * cone. */
#include "light/compile.h"
#include "math/elementary.h"
#include "velo/light.h"

vlCompileLight vl_compile_light_spot;

vlResult vl_compile_light_spot(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                               vlEmitted *e, vlError *error) {
  light->cos_end = (float)vl_precise_cos(def->cone_angle);
  light->cos_start = (float)vl_precise_cos(def->cone_angle - def->cone_delta);
  light->cone_squared = def->cone_squared;
  light->has_cone = true;
  float factor = def->scale;
  float mean_edge = def->cone_squared ? 1 / 3.0f : 0.5f; /* of the falloff over the edge */
  float solid =
      2 * VL_PI * ((1 - light->cos_start) + mean_edge * (light->cos_start - light->cos_end));
  if (def->power == def->power)
    factor *= (float)(def->power / solid);
  vlResult r = vl_light_color(world, &def->color, factor, e, error);
  light->power = 4 * VL_PI * vl_light_luminance(&e->spectrum);
  return r;
}
