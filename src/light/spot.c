/* light/spot.c: spot lights (pbrt book 12.2.1), set by scale or by power over the cone. As in
 * pbrt the cone is round in the light's frame. */
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

/* A cone in a skewed frame. Its light is chosen as one that emits to all sides. */
static vlResult compile_skewed(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                               vlEmitted *e, vlError *error) {
  vlMat4 inverse;
  if (!vl_mat4_inverse(vl_mat4_load(def->world_from_light), &inverse))
    return vl_fail(error, VL_ERROR_SCENE, "the light's transform is singular");
  double axis[3];
  for (int i = 0; i < 3; i++)
    axis[i] = (double)def->to[i] - (double)def->from[i];
  vl_normalize3(axis);
  for (int i = 0; i < 3; i++) {
    light->own[i] = (float)axis[i];
    for (int j = 0; j < 3; j++)
      light->corners[3 * i + j] = (float)inverse.m[4 * i + j];
  }
  light->skewed_cone = true;
  const double solid = vl_light_power_spot(def, 1, 0);
  const double factor = def->power == def->power ? def->scale * def->power / solid : def->scale;
  vlResult r = vl_light_color(world, &def->color, (float)factor, e, error);
  light->power = (float)solid * vl_light_luminance(&e->spectrum);
  return r;
}

vlResult vl_compile_light_spot(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                               vlEmitted *e, vlError *error) {
  light->cos_end = (float)vl_precise_cos(def->cone_angle);
  light->cos_start = (float)vl_precise_cos(def->cone_angle - def->cone_delta);
  light->cone_squared = def->cone_squared;
  if (vl_stretch(def->world_from_light).is_skewed)
    return compile_skewed(world, def, light, e, error);
  light->has_cone = true;
  float factor = def->scale;
  if (def->power == def->power)
    factor *= (float)(def->power / solid_angle(light));
  vlResult r = vl_light_color(world, &def->color, factor, e, error);
  light->power = 4 * VL_PI * vl_light_luminance(&e->spectrum);
  return r;
}
