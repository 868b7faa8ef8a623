/* conformance/light_power.h: the law of the power by which lights are chosen: it is the
 * integral of the radiance that the light emits, over its area and all directions, computed
 * from the light's own emission of light paths. No image shows a wrong one: it only makes
 * noise. The power that a light's row states, for velo scene info, is the same integral. */
#ifndef TEST_CONFORMANCE_LIGHT_POWER_H
#define TEST_CONFORMANCE_LIGHT_POWER_H

#include "conformance.h"
#include "lights.h"
#include "radiometry.h"
#include "scene/lamps.h"
#include "schema/schema.h"
#include "trace/two_way/stages.h"
#include "world/world.h"

static double fraction(double x) {
  return x - floor(x);
}

enum { EMITTED = 1 << 15 };

/* Ray i of those that leave a light, whose choice is `way`. */
static vlEmission emitted_ray(const vlWorld *world, const vlTwoWay *way, uint32_t i) {
  const float lambda[4] = {0, 0, 0, 0};
  /* Roberts' sequence in four dimensions */
  const float u = (float)fraction(0.5 + i * 0.8566748838545029);
  const float v = (float)fraction(0.5 + i * 0.7338918566271260);
  const float s = (float)fraction(0.5 + i * 0.6287067210378087);
  const float t = (float)fraction(0.5 + i * 0.5385972572236101);
  return vl_emission_sample(world, way, lambda, 0.5f, u, v, s, t);
}

/* A choice, to be freed, of this light alone. */
static float *choice_of_light(const vlWorld *world, uint32_t light) {
  float *choice = calloc(world->lights.count + 1, sizeof *choice);
  assert_non_null(choice);
  for (size_t k = light + 1; k <= world->lights.count; k++)
    choice[k] = 1;
  return choice;
}

/* Luminance of what a light emits in all. The mean of samples: flux is radiance times the
 * cosine over the density of point and direction. */
static Mean emitted_power(const vlWorld *world, uint32_t light) {
  float *choice = choice_of_light(world, light);
  const vlTwoWay way = {.choice = choice};
  Mean mean = {0};
  for (uint32_t i = 0; i < EMITTED; i++) {
    const vlEmission e = emitted_ray(world, &way, i);
    mean_add(&mean, e.valid ? luminance_of(e.flux) : 0);
  }
  free(choice);
  return mean;
}

/* The share of the sphere into which a light with a cone sends as much as at its middle: its
 * power for the choice is that of a light that sends this to all sides. */
static double share_of_sphere(const vlWorldLight *light) {
  if (!light->has_cone && light->kind != VL_LIGHT_PROJECTION)
    return 1;
  const double edge = (double)light->cos_start - (double)light->cos_end;
  return 0.5 * (1 - (double)light->cos_start + edge / (light->cone_squared ? 3 : 2));
}

/* Of the scene's only light; NaN: the row does not know it. */
static void check_stated_power(const char *kind, const char *parameters, const vlScene *scene,
                               const vlWorld *world) {
  char what[200];
  const vlLightDef *def = vl_scene_light(scene, (vlLightId){1});
  assert_non_null(def);
  const double luminance = vl_light_def_luminance(&def->color) * (double)def->scale;
  const double stated = vl_light_power(def, luminance, (double)world->radius);
  if (isnan(stated))
    return;
  const Mean mean = emitted_power(world, 0);
  snprintf(what, sizeof what, "%.140s: power that its row states", parameters);
  check_mean("lights", kind, what, &mean, stated, (Sight){0.01 * stated, 0.05 * stated});
}

/* The density of a ray that a light emits is the one that camera paths find at what the ray
 * meets. No image shows a wrong one if it only weighs estimators that are right by themselves:
 * it makes noise. */
static void check_emitted_density(const char *family, const char *kind, const char *parameters,
                                  const vlWorld *world, uint32_t light) {
  enum { RAYS = 1 << 10 };
  const float distance = 2; /* any */
  float *choice = choice_of_light(world, light);
  const vlTwoWay way = {.choice = choice};
  const bool at_point = world->lights.items[light].at_point;
  uint32_t valid = 0;
  uint32_t wrong = 0;
  for (uint32_t i = 0; i < RAYS; i++) {
    const vlEmission e = emitted_ray(world, &way, i);
    const vlPoint at = {.p = e.at, .g = e.n, .n = e.n};
    const vlVec3 w = {-e.d.x, -e.d.y, -e.d.z};
    if (!e.valid)
      continue;
    const float found = vl_emission_density(world, &way, light, w, distance, &at);
    const double known = (double)e.density / (at_point ? (double)(distance * distance) : 1);
    valid++;
    wrong += !(fabs((double)found - known) <= 1e-3 * known);
  }
  free(choice);
  /* rays at the edge of a cone or of a cell may count to either side */
  if (wrong > valid / 50)
    broken(family, kind, "%s: the density of %u of %u light paths is not that of their ends",
           parameters, wrong, valid);
}

/* Light paths leave only where light goes: of an even lamp nearly none is dark. One that starts
 * in vain makes noise and no other image. Those of projected images fill the cone around the
 * image. */
static void check_dark_paths(const char *family, const char *kind, const char *parameters,
                             const vlWorld *world, uint32_t light) {
  enum { RAYS = 1 << 12 };
  float *choice = choice_of_light(world, light);
  const vlTwoWay way = {.choice = choice};
  uint32_t dark = 0;
  for (uint32_t i = 0; i < RAYS; i++) {
    const vlEmission e = emitted_ray(world, &way, i);
    dark += !(e.valid && luminance_of(e.flux) > 0);
  }
  free(choice);
  const bool cone = world->lights.items[light].kind == VL_LIGHT_PROJECTION;
  if (dark > (cone ? RAYS * 2 / 5 : RAYS / 200))
    broken(family, kind, "%s: %u of %u light paths leave light %u in the dark", parameters,
           dark, RAYS, light);
}

static void check_chosen_power(const char *family, const char *kind, const char *parameters,
                               const char *text) {
  char what[200];
  vlError error = {0};
  vlWorld *world;
  vlScene *scene = need_scene(text);
  vlBuildDef def = vl_default_build_def();
  def.color = VL_COLOR_RGB;
  assert_int_equal(vl_world_build(scene, &def, &world, &error), VL_OK);
  if (world->lights.count == 0)
    broken(family, kind, "%s: no light", parameters);
  for (uint32_t i = 0; i < world->lights.count && i < 4; i++) {
    const vlWorldLight *light = &world->lights.items[i];
    const double power = (double)light->power * share_of_sphere(light);
    const Mean mean = emitted_power(world, i);
    snprintf(what, sizeof what, "%.140s: power for the choice of light %u", parameters, i);
    /* an image's mean is taken for that of each face, whatever part of it the face shows */
    const bool image = strstr(parameters, "filename") && light->shape != VL_NONE;
    const Sight sight = {(image ? 0.25 : 0.01) * power, (image ? 0.5 : 0.05) * power};
    check_mean(family, kind, what, &mean, power, sight);
    check_emitted_density(family, kind, parameters, world, i);
    check_dark_paths(family, kind, parameters, world, i);
  }
  if (strcmp(family, "lights") == 0)
    check_stated_power(kind, parameters, scene, world);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
}

/* The same with another scale, which a power for the choice may forget. */
static void check_scaled_power(const char *family, const char *kind, const char *form,
                               const char *parameters) {
  static char text[TEXT];
  static char scaled[TEXT];
  scene_text(text, form, kind, parameters);
  check_chosen_power(family, kind, parameters, text);
  if (strstr(parameters, "float scale"))
    return;
  snprintf(scaled, sizeof scaled, "%s \"float scale\" .4", parameters);
  scene_text(text, form, kind, scaled);
  check_chosen_power(family, kind, scaled, text);
}

/* The distance from a point of the floor to where the next of the light's rays meets it. */
static double distance_to_rays(const vlWorld *world, const double at[2]) {
  const float choice[2] = {0, 1};
  const vlTwoWay way = {.choice = choice};
  double nearest = INFINITY;
  for (uint32_t i = 0; i < EMITTED; i++) {
    const vlEmission e = emitted_ray(world, &way, i);
    if (!e.valid || !(luminance_of(e.flux) > 0) || !(e.d.y < 0))
      continue;
    const double t = (double)(-e.o.y / e.d.y);
    const double x = (double)e.o.x + t * (double)e.d.x - at[0];
    const double z = (double)e.o.z + t * (double)e.d.z - at[1];
    nearest = fmin(nearest, hypot(x, z));
  }
  return nearest;
}

/* Where light arrives, light paths do, too. */
static void check_rim(const char *kind, const LightVariant *v, const char *text) {
  vlError error = {0};
  vlWorld *world;
  vlScene *scene = need_scene(text);
  vlBuildDef def = vl_default_build_def();
  def.color = VL_COLOR_RGB;
  assert_int_equal(vl_world_build(scene, &def, &world, &error), VL_OK);
  for (int i = 0; i < 4 && (v->rim[i][0] != 0 || v->rim[i][1] != 0); i++) {
    const LightLaws l = ask_floor(text, v->rim[i][0], v->rim[i][1], 1);
    const double far = distance_to_rays(world, v->rim[i]);
    if (!(mean_of(&l.sampled[1]) > 0))
      broken("lights", kind, "%s: no light at its rim", v->parameters);
    if (!(far < 0.05))
      broken("lights", kind, "%s: light paths end %.3f before (%g, %g)", v->parameters, far,
             v->rim[i][0], v->rim[i][1]);
  }
  vl_world_destroy(world);
  vl_scene_destroy(scene);
}

static void check_power_of_light(const vlKindRow *row, const LightVariant *v,
                                 const char *form) {
  static char text[TEXT];
  check_scaled_power("lights", row->name, form, v->parameters);
  scene_text(text, form, row->name, v->parameters);
  check_rim(row->name, v, text);
}

/* A given power is what arrives around the light, whatever its image, lamp file and frame. */
static void check_given_power(const vlKindRow *row, const LightVariant *v, const char *form) {
  static char parameters[TEXT];
  if (!vl_row_find(row, "power") || row->traits & VL_LIGHT_TRAIT_FAR ||
      !strstr(v->parameters, "filename"))
    return;
  snprintf(parameters, sizeof parameters, "%s \"float power\" 10", v->parameters);
  check_power("lights", row->name, form, parameters);
}

static void chosen_powers(void **state) {
  (void)state;
  static char form[TEXT];
  for_each_light(FLOOR, check_power_of_light);
  for_each_light(AROUND, check_given_power);
  static const char *const shapes[] = {
      "\"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .3]",
      "\"trianglemesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 .5 1 1 .5] "
      "\"integer indices\" [0 1 2 2 1 3] \"point2 uv\" [0 0 1 0 0 1 1 1]",
      "\"sphere\" \"float radius\" .7", "\"disk\" \"float radius\" .7",
      "\"cylinder\" \"float radius\" .4"};
  for (size_t i = 0; i < sizeof emissions / sizeof *emissions; i++)
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
      snprintf(form, sizeof form,
               HEAD
               "WorldBegin AttributeBegin AreaLightSource %%s Translate .3 1.1 .2 Rotate "
               "70 1 .2 .1 Shape %s AttributeEnd\n",
               shapes[k]);
      check_scaled_power("emission", "diffuse", form, emissions[i]);
    }
  change_emission = emit_texture;
  for (size_t k = 0; k < 2; k++) { /* meshes */
    static char text[TEXT];
    snprintf(form, sizeof form, HEAD "WorldBegin AreaLightSource %%s Shape %s", shapes[k]);
    scene_text(text, form, "diffuse", "");
    check_chosen_power("emission", "diffuse", TEXTURE_OF_FILENAME, text);
  }
  change_emission = NULL;
  expect_no_failures();
}

#endif
