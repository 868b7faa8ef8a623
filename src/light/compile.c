/* light/compile.c: compiles the lights and emissive shapes of a scene. Scales are pbrt-v4's
 * (lights.cpp; book 12): spectra are divided by their own luminance, times scale, or set by
 * power or illuminance. */
#include "light/compile.h"

#include <math.h>
#include <string.h>

#include "base/context.h"
#include "base/error.h"
#include "light/kinds.row.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "texture/lookup.h"
#include "velo/light.h"
#include "velo/shape.h"

vlResult vl_light_color(vlWorld *world, const vlSpectrum *color, float factor, vlEmitted *e,
                        vlError *error) {
  VL_TRY(vl_spectral_compile(world, color, VL_ROLE_ILLUMINANT, &e->spectrum, error));
  e->spectrum.scale *= factor;
  e->image = -1;
  e->image_scale = 1;
  if (world->def.color == VL_COLOR_RGB)
    return VL_OK;
  double photometric = vl_spectrum_photometric(color, error);
  if (!(photometric > 0))
    e->spectrum.scale = 0;
  else
    e->spectrum.scale = (float)(e->spectrum.scale / photometric);
  return VL_OK;
}

void vl_light_image_color(vlWorld *world, vlColorSpace space, float scale, vlEmitted *e) {
  memset(&e->spectrum, 0, sizeof e->spectrum);
  e->space = space;
  e->image_scale = scale;
  e->spectrum.scale = 1;
  if (world->def.color == VL_COLOR_RGB) {
    e->to_srgb = vl_srgb_map(space, VL_ROLE_ILLUMINANT);
    e->spectrum.kind = VL_SPECTRAL_RGB;
    for (int i = 0; i < 3; i++)
      e->spectrum.rgb[i] = 1;
    return;
  }
  e->spectrum.kind = VL_SPECTRAL_DENSE;
  e->spectrum.dense = vl_space_illuminant(space);
  const float *y = vl_cie_y();
  double sum = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    sum += (double)y[i] * e->spectrum.dense[i];
  e->spectrum.scale = (float)(1 / sum);
}

vlResult vl_light_bad_pixel(const char *name, uint32_t x, uint32_t y, vlError *error) {
  return vl_fail(error, VL_ERROR_SCENE,
                 "%s: pixel (%u, %u) is not finite, it cannot be emitted",
                 name ? name : "the image", x, y);
}

vlColorSpace vl_light_image_space(const vlWorld *world, int32_t image, vlColorSpace otherwise) {
  return vl_mipmap_space(image >= 0 ? world->images.items[image].mipmap : NULL, otherwise);
}

vlResult vl_light_set_frame(const vlLightDef *def, const int order[3], const float sign[3],
                            vlWorldLight *light, vlError *error) {
  vlMat4 inverse;
  if (!vl_mat4_inverse(vl_mat4_load(def->world_from_light), &inverse))
    return vl_fail(error, VL_ERROR_SCENE, "the light's transform is singular");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      light->corners[3 * i + j] = sign[i] * (float)inverse.m[4 * order[i] + j];
  return VL_OK;
}

float vl_light_luminance(const vlSpectral *s) {
  if (s->kind == VL_SPECTRAL_RGB)
    return s->scale * (0.2126f * s->rgb[0] + 0.7152f * s->rgb[1] + 0.0722f * s->rgb[2]);
  const float *y = vl_cie_y();
  double sum = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    float v = s->kind == VL_SPECTRAL_DENSE ? s->dense[i]
              : s->kind == VL_SPECTRAL_CONSTANT
                  ? 1
                  : vl_sigmoid(s->sigmoid, (float)(VL_LAMBDA_MIN + i));
    sum += (double)y[i] * v;
  }
  return (float)(sum * s->scale);
}

/* Of no colour less than a hundredth of its largest component: ACES2065-1 has colours of
 * luminance 0 and below, which no light has, but which are emitted as the nearest that there
 * are. Their texels must be chosen, too. */
float vl_light_texel_luminance(vlTexel t, uint32_t channels, vlColorSpace space) {
  if (channels < 3)
    return t.c[0];
  if (space == VL_SPACE_SRGB)
    return 0.2126f * t.c[0] + 0.7152f * t.c[1] + 0.0722f * t.c[2];
  float xyz[9];
  vl_xyz_from_rgb(space, xyz);
  float y = xyz[3] * t.c[0] + xyz[4] * t.c[1] + xyz[5] * t.c[2];
  float min = 0.01f * vl_max(t.c[0], vl_max(t.c[1], t.c[2]));
  return y < min ? min : y;
}

/* ---- all lights ------------------------------------------------------------------------- */

#define DECLARE(kind, row, power, compile, sample, emit, density) vlCompileLight compile;
VL_LIGHT_FUNCTIONS(DECLARE)

static vlResult compile_kind(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                             vlEmitted *e, vlError *error) {
  switch (def->kind) {
#define COMPILE(kind, row, power, compile, sample, emit, density) \
  case kind:                                                      \
    return compile(world, def, light, e, error);
    VL_LIGHT_FUNCTIONS(COMPILE)
  }
  return VL_OK;
}

static vlResult add_light(vlWorld *world, const vlLightDef *def, vlError *error) {
  vlWorldLight *light = VL_PUSH(world->context, &world->lights);
  vlEmitted *e = VL_PUSH(world->context, &world->emitted);
  const vlKindRow *row = vl_kind_row(&vl_light_family, (int)def->kind);
  if (!light || !e)
    return vl_fail_memory(error);
  e->image = -1;
  light->emitted = (uint32_t)world->emitted.count - 1;
  light->shape = light->environment = light->lamp = VL_NONE;
  vlMat4 m = vl_mat4_load(def->world_from_light);
  double from[3] = {def->from[0], def->from[1], def->from[2]},
         to[3] = {def->to[0], def->to[1], def->to[2]}, a[3], b[3];
  vl_mat4_point(&m, from, a);
  vl_mat4_point(&m, to, b);
  double l = 0, sign = row->traits & VL_LIGHT_TRAIT_FAR
                           ? -1
                           : 1; /* if far, the direction is to the light */
  for (int i = 0; i < 3; i++)
    l += (b[i] - a[i]) * (b[i] - a[i]);
  l = sqrt(l);
  if (!(l > 0) && (row->traits & VL_LIGHT_TRAIT_AIMS))
    return vl_fail(error, VL_ERROR_SCENE,
                   "the light has no direction: \"from\" and \"to\" are the same point");
  for (int i = 0; i < 3; i++) {
    light->position[i] = (float)a[i];
    light->direction[i] = l > 0 ? (float)(sign * (b[i] - a[i]) / l) : 0;
  }
  light->kind = (uint32_t)def->kind;
  light->at_point = (row->traits & VL_LIGHT_TRAIT_AT_POINT) != 0;
  light->far = (row->traits & VL_LIGHT_TRAIT_FAR) != 0;
  light->delta = (row->traits & VL_LIGHT_TRAIT_DELTA) != 0;
  if (!light->delta) { /* rays that miss all surfaces hit the light */
    uint32_t *slot = VL_PUSH(world->context, &world->infinite_lights);
    if (!slot)
      return vl_fail_memory(error);
    *slot = (uint32_t)world->lights.count - 1;
  }
  vlResult r = compile_kind(world, def, light, e, error);
  return vl_world_locate_error(def->source, error, r);
}

vlResult vl_world_add_lights(vlWorld *world, const vlScene *scene, vlError *error) {
  vlResult r = VL_OK;
  vlEmitted white;
  memset(&white, 0, sizeof white);
  vl_light_image_color(world, VL_SPACE_SRGB, 1, &white);
  world->white = white.spectrum;
  for (size_t i = 0; r == VL_OK && i < scene->lights.count; i++) {
    r = vl_world_step(world, "lights", 0.5, error);
    if (vl_scene_mark(&scene->light_marks, i).hidden)
      continue;
    if (r == VL_OK)
      r = add_light(world, &scene->lights.items[i], error);
  }
  uint32_t *compiled =
      vl_alloc_array(world->context, scene->emissions.count + 1, sizeof *compiled);
  if (!compiled && r == VL_OK)
    r = vl_fail_memory(error);
  for (size_t i = 0; compiled && i < scene->emissions.count; i++)
    compiled[i] = VL_NONE;
  for (size_t i = 0; r == VL_OK && i < scene->shapes.count; i++)
    if (scene->shapes.items[i].emission.index && world->shapes.items[i].faces > 0 &&
        !vl_scene_mark(&scene->shape_marks, i).hidden)
      r = vl_world_add_shape_lights(world, scene, (uint32_t)i, compiled, error);
  vl_free(world->context, compiled);
  if (r == VL_OK)
    r = vl_world_step(world, "lights", 0.5, error);
  if (r == VL_OK)
    r = vl_light_tree_build(world, error);
  world->info.lights = world->lights.count;
  return r;
}
