/* light/spot.c: spot lights (pbrt book 12.2.1), set by scale or by power over the cone. As in
 * pbrt the cone is round in the light's frame. */
#include <math.h>

#include "base/error.h"
#include "light/compile.h"
#include "light/light.row.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "math/stretch.h"
#include "velo/light.h"

vlCompileLight vl_compile_light_spot;
vlLightPower vl_light_power_spot;

/* The integral of the falloff over the directions of the light's frame, sr. */
static float solid_angle(const vlWorldLight *light) {
  float mean_edge = light->cone_squared ? 1 / 3.0f : 0.5f; /* of the falloff over the edge */
  return 2 * VL_PI * ((1 - light->cos_start) + mean_edge * (light->cos_start - light->cos_end));
}

/* For a cone in a skewed frame. */
static vlResult set_skewed_frame(const vlLightDef *def, vlWorldLight *light, vlError *error) {
  static const int order[3] = {0, 1, 2};
  static const float sign[3] = {1, 1, 1};
  double axis[3];
  for (int i = 0; i < 3; i++)
    axis[i] = (double)def->to[i] - (double)def->from[i];
  vl_normalize3(axis);
  for (int i = 0; i < 3; i++)
    light->own[i] = (float)axis[i];
  light->skewed_cone = true;
  return vl_light_set_frame(def, order, sign, light, error);
}

/* A skewed cone is chosen as a light that emits to all sides. */
vlResult vl_compile_light_spot(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                               vlEmitted *e, vlError *error) {
  light->cos_end = (float)vl_precise_cos(def->cone_angle);
  light->cos_start = (float)vl_precise_cos(def->cone_angle - def->cone_delta);
  light->cone_squared = def->cone_squared;
  light->has_cone = !vl_stretch(def->world_from_light).is_skewed;
  if (!light->has_cone)
    VL_TRY(set_skewed_frame(def, light, error));
  float solid = light->has_cone ? solid_angle(light) : (float)vl_light_power_spot(def, 1, 0);
  float factor = def->scale;
  if (!isnan(def->power))
    factor *= (float)(def->power / solid);
  vlResult r = vl_light_color(world, &def->color, factor, e, error);
  light->power = (light->has_cone ? 4 * VL_PI : solid) * vl_light_luminance(&e->spectrum);
  return r;
}
