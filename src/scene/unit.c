/* scene/unit.c: see unit.h. The illuminance of a point light of I candela at d units is
 * I / (d metres)^2, and the luminance of a surface of A units^2 that sends P lumens is
 * P / (pi A metres^2). */
#include "scene/unit.h"

#include "velo/light.h"

void vl_scene_state_unit(vlScene *scene, size_t first_light, size_t first_emission,
                         double metres) {
  const double factor = 1 / (metres * metres);
  for (size_t i = first_light; i < scene->lights.count; i++) {
    vlLightDef *light = &scene->lights.items[i];
    if (light->kind != VL_LIGHT_DISTANT && light->kind != VL_LIGHT_INFINITE)
      light->scale = (float)(light->scale * factor);
  }
  for (size_t i = first_emission; i < scene->emissions.count; i++)
    scene->emissions.items[i].power *= factor;
}
