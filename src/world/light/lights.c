/* world/light/lights.c: scene lights and emissive shapes -> world lights, with the sampling distributions of
 * environment images. Scales are pbrt-v4's (lights.cpp; book 12): spectra are divided by their own luminance, times
 * scale, or set by power or illuminance. */
#include <math.h>
#include <string.h>

#include "base/context.h"
#include "base/error.h"
#include "math/elementary.h"
#include "math/octahedral.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "scene/schema/schema.h"
#include "world/light/lights.h"
#include "world/shape/surface_point.h"
#include "world/texture/texture_lookup.h"

vlResult vl_light_color(vlWorld *world, const vlSpectrum *color, float factor, vlEmitted *e, vlError *error) {
  vlResult r = vl_spectral_compile(world, color, VL_ROLE_ILLUMINANT, &e->spectrum, error);
  if (r != VL_OK) return r;
  e->spectrum.scale *= factor;
  e->image = -1;
  e->image_scale = 1;
  if (world->def.color == VL_COLOR_RGB) return VL_OK;
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
    e->spectrum.kind = VL_SPECTRAL_RGB;
    for (int i = 0; i < 3; i++) e->spectrum.rgb[i] = 1;
    return;
  }
  e->spectrum.kind = VL_SPECTRAL_DENSE;
  e->spectrum.dense = vl_space_illuminant(space);
  const float *y = vl_cie_y();
  double sum = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) sum += (double)y[i] * e->spectrum.dense[i];
  e->spectrum.scale = (float)(1 / sum);
}

vlColorSpace vl_light_image_space(const vlWorld *world, int32_t image, vlColorSpace otherwise) {
  const vlMipmap *mip = image >= 0 ? world->images.items[image].mipmap : NULL;
  return mip && mip->space_given ? mip->space : otherwise;
}

float vl_light_luminance(const vlSpectral *s) {
  if (s->kind == VL_SPECTRAL_RGB) return s->scale * (0.2126f * s->rgb[0] + 0.7152f * s->rgb[1] + 0.0722f * s->rgb[2]);
  const float *y = vl_cie_y();
  double sum = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    float v = s->kind == VL_SPECTRAL_DENSE      ? s->dense[i]
              : s->kind == VL_SPECTRAL_CONSTANT ? 1
                                                : vl_sigmoid(s->sigmoid, (float)(VL_LAMBDA_MIN + i));
    sum += (double)y[i] * v;
  }
  return (float)(sum * s->scale);
}

float vl_light_texel_luminance(vlTexel t, uint32_t channels) {
  return channels < 3 ? t.c[0] : 0.2126f * t.c[0] + 0.7152f * t.c[1] + 0.0722f * t.c[2];
}

/* ---- environment images ------------------------------------------------------------------------------------------ */

enum { MAX_CELLS = 1024 };

/* A distribution over cells: the mean luminance of each cell's texels minus the mean of all (MIS compensation,
 * Karlik et al. 2019), so that the uniform part is left to BSDF sampling. */
static vlResult build_environment(vlWorld *world, vlEnvironment *env, double *mean_luminance, double *illuminance,
                                  vlError *error) {
  const vlMipmap *mip = world->images.items[env->image].mipmap;
  uint32_t n = mip->levels[0].width, channels = mip->channels;
  uint32_t step = (n + MAX_CELLS - 1) / MAX_CELLS, size = (n + step - 1) / step;
  env->size = size;
  env->conditional_cdf = vl_world_block(world, (size_t)size * (size + 1), sizeof(float));
  env->marginal_cdf = vl_world_block(world, size + 1, sizeof(float));
  env->pdf = vl_world_block(world, (size_t)size * size, sizeof(float));
  if (!env->conditional_cdf || !env->marginal_cdf || !env->pdf) return vl_fail_memory(error);
  double total = 0, upper = 0;
  for (uint32_t y = 0; y < size; y++)
    for (uint32_t x = 0; x < size; x++) {
      double sum = 0;
      uint32_t count = 0;
      for (uint32_t j = y * step; j < (y + 1) * step && j < n; j++)
        for (uint32_t i = x * step; i < (x + 1) * step && i < n; i++) {
          float l = vl_light_texel_luminance(vl_texel(mip, 0, (int32_t)i, (int32_t)j, VL_WRAP_CLAMP), channels);
          if (!isfinite(l))
            return vl_fail(error, VL_ERROR_SCENE, "pixel (%u, %u) of the image of the sky is not finite", i, j);
          if (l > 0) sum += l;
          count++;
        }
      env->pdf[(size_t)y * size + x] = (float)(sum / count);
      total += sum / count;
      vlVec3 d = vl_octahedral_decode(((float)x + 0.5f) / (float)size, ((float)y + 0.5f) / (float)size);
      upper += d.z > 0 ? sum / count * d.z : 0;
    }
  double mean = total / ((double)size * size);
  *mean_luminance = mean;
  /* pbrt-v4 takes the upper half for a hemisphere that fills the square: half of the true illuminance. */
  *illuminance = upper * (world->def.imitate_pbrt ? 2 : 4) * M_PI / ((double)size * size);
  bool flat = true;
  for (size_t i = 0; i < (size_t)size * size; i++) flat = flat && env->pdf[i] <= mean * 1.0001;
  double sum_all = 0;
  for (size_t i = 0; i < (size_t)size * size; i++) {
    double w = flat ? 1 : env->pdf[i] > mean ? env->pdf[i] - mean : 0;
    env->pdf[i] = (float)w;
    sum_all += w;
  }
  double marginal = 0;
  env->marginal_cdf[0] = 0;
  for (uint32_t y = 0; y < size; y++) {
    float *row = env->pdf + (size_t)y * size, *cdf = env->conditional_cdf + (size_t)y * (size + 1);
    double row_sum = 0, run = 0;
    for (uint32_t x = 0; x < size; x++) row_sum += row[x];
    cdf[0] = 0;
    for (uint32_t x = 0; x < size; x++) {
      run += row[x];
      cdf[x + 1] = row_sum > 0 ? (float)(run / row_sum) : (float)(x + 1) / (float)size;
    }
    cdf[size] = 1;
    marginal += row_sum;
    env->marginal_cdf[y + 1] = (float)(marginal / sum_all);
    for (uint32_t x = 0; x < size; x++) row[x] = (float)(row[x] / sum_all * size * size);
  }
  env->marginal_cdf[size] = 1;
  return VL_OK;
}

vlResult vl_compile_light_infinite(vlWorld *world, const vlLightDef *def, vlWorldLight *light, vlEmitted *e,
                                   vlError *error) {
  light->environment = VL_NONE;
  float area = VL_PI * world->radius * world->radius;
  if (!def->path && !def->image) {
    float factor = def->scale;
    if (def->illuminance == def->illuminance) factor *= (float)(def->illuminance / M_PI);
    vlResult r = vl_light_color(world, &def->color, factor, e, error);
    light->power = 4 * VL_PI * area * vl_light_luminance(&e->spectrum);
    return r;
  }
  e->image = vl_world_add_image(world, def->path, def->image, NULL, 1, false, error);
  if (e->image < 0) return error && error->code ? error->code : VL_ERROR_SCENE;
  vl_light_image_color(world, vl_light_image_space(world, e->image, def->space), def->scale, e);
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  if (mip->levels[0].width != mip->levels[0].height)
    return vl_fail(error, VL_ERROR_SCENE, "%s: %u x %u: an image of the sky must be square (equal-area octahedral map)",
                   def->path ? def->path : "image", mip->levels[0].width, mip->levels[0].height);
  vlEnvironment *env = VL_PUSH(world->context, &world->environments);
  if (!env) return vl_fail_memory(error);
  env->image = e->image;
  vlMat4 m = vl_mat4_load(def->world_from_light), inverse;
  if (!vl_mat4_inverse(m, &inverse)) return vl_fail(error, VL_ERROR_SCENE, "the light's transform is singular");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      env->world_from_light[3 * i + j] = (float)m.m[4 * i + j];
      env->light_from_world[3 * i + j] = (float)inverse.m[4 * i + j];
    }
  double mean = 0, illuminance = 0;
  vlResult r = build_environment(world, env, &mean, &illuminance, error);
  if (def->illuminance == def->illuminance && illuminance > 0)
    e->image_scale *= (float)(def->illuminance / illuminance);
  light->environment = (uint32_t)world->environments.count - 1;
  light->power = (float)(4 * M_PI * area * mean * e->image_scale);
  if (r != VL_OK || !def->has_portal) return r;
  double passes = 0;
  r = vl_world_add_portal(world, def, &world->environments.items[light->environment], &passes, error);
  light->power = (float)(passes * e->image_scale);
  return r;
}

typedef vlResult CompileLight(vlWorld *world, const vlLightDef *def, vlWorldLight *light, vlEmitted *e, vlError *error);
#define COMPILE(K, k) [VL_LIGHT_##K] = vl_compile_light_##k,
static CompileLight *const compile[] = {VL_LIGHT_KINDS(COMPILE)};
#undef COMPILE

static vlResult add_light(vlWorld *world, const vlLightDef *def, vlError *error) {
  vlWorldLight *light = VL_PUSH(world->context, &world->lights);
  vlEmitted *e = VL_PUSH(world->context, &world->emitted);
  const vlKindRow *row = vl_kind_row(&vl_light_family, (int)def->kind);
  if (!light || !e) return vl_fail_memory(error);
  e->image = -1;
  light->emitted = (uint32_t)world->emitted.count - 1;
  light->shape = light->environment = VL_NONE;
  vlMat4 m = vl_mat4_load(def->world_from_light);
  double from[3] = {def->from[0], def->from[1], def->from[2]}, to[3] = {def->to[0], def->to[1], def->to[2]}, a[3], b[3];
  vl_mat4_point(&m, from, a);
  vl_mat4_point(&m, to, b);
  double l = 0, sign = row->traits & VL_LIGHT_TRAIT_FAR ? -1 : 1; /* far: the direction is towards the light */
  for (int i = 0; i < 3; i++) l += (b[i] - a[i]) * (b[i] - a[i]);
  l = sqrt(l);
  if (!(l > 0) && (row->traits & VL_LIGHT_TRAIT_AIMS))
    return vl_fail(error, VL_ERROR_SCENE, "the light has no direction: \"from\" and \"to\" are the same point");
  for (int i = 0; i < 3; i++) {
    light->position[i] = (float)a[i];
    light->direction[i] = l > 0 ? (float)(sign * (b[i] - a[i]) / l) : 0;
  }
  light->kind = (vlWorldLightKind)def->kind;
  light->at_point = (row->traits & VL_LIGHT_TRAIT_AT_POINT) != 0;
  light->far = (row->traits & VL_LIGHT_TRAIT_FAR) != 0;
  light->delta = (row->traits & VL_LIGHT_TRAIT_DELTA) != 0;
  if (!light->delta) { /* rays that miss all surfaces hit it */
    uint32_t *slot = VL_PUSH(world->context, &world->infinite_lights);
    if (!slot) return vl_fail_memory(error);
    *slot = (uint32_t)world->lights.count - 1;
  }
  vlResult r = compile[def->kind](world, def, light, e, error);
  return vl_world_placed(def->source, error, r);
}

vlResult vl_world_add_lights(vlWorld *world, const vlScene *scene, vlError *error) {
  vlResult r = VL_OK;
  vlEmitted white;
  memset(&white, 0, sizeof white);
  vl_light_image_color(world, VL_SPACE_SRGB, 1, &white);
  world->white = white.spectrum;
  for (size_t i = 0; r == VL_OK && i < scene->lights.count; i++) r = add_light(world, &scene->lights.items[i], error);
  uint32_t *compiled = vl_alloc_array(world->context, scene->emissions.count + 1, sizeof *compiled);
  if (!compiled && r == VL_OK) r = vl_fail_memory(error);
  for (size_t i = 0; compiled && i < scene->emissions.count; i++) compiled[i] = VL_NONE;
  for (size_t i = 0; r == VL_OK && i < scene->shapes.count; i++)
    if (scene->shapes.items[i].emission.index && (world->shapes.items[i].faces > 0))
      r = vl_world_add_shape_lights(world, scene, (uint32_t)i, compiled, error);
  vl_free(world->context, compiled);
  if (r == VL_OK) r = vl_light_tree_build(world, error);
  world->info.lights = world->lights.count;
  return r;
}
