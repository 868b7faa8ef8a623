/* world/light/lights.c: scene lights and glowing shapes -> world lights, with the distribution over pictures of the
 * sky. Scales are pbrt-v4's (lights.cpp's conventions; book 12): spectra divided by their own luminance, times scale,
 * or set by power or illuminance. */
#include <math.h>
#include <string.h>

#include "base/error.h"
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

void vl_light_picture_color(vlWorld *world, vlColorSpace space, float scale, vlEmitted *e) {
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

vlColorSpace vl_light_picture_space(const vlWorld *world, int32_t image, vlColorSpace otherwise) {
  const vlMipmap *mip = image >= 0 ? world->images.items[image].mipmap : NULL;
  return mip && mip->space_told ? mip->space : otherwise;
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

/* ---- the sky ----------------------------------------------------------------------------------------------------- */

enum { MAX_CELLS = 1024 };

/* A distribution over cells: mean luminance of the texels of each, less the mean of all (MIS compensation, Karlik et
 * al. 2019), so that light sampling leaves the flat part to the BSDF. */
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
            return vl_fail(error, VL_ERROR_SCENE, "pixel (%u, %u) of the picture of the sky is not finite", i, j);
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
  /* pbrt-v4 takes the upper half for a hemisphere that fills the square: half of what really arrives. */
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
  vl_light_picture_color(world, vl_light_picture_space(world, e->image, def->space), def->scale, e);
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  if (mip->levels[0].width != mip->levels[0].height)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: %u x %u: a picture of the sky must be square (equal-area octahedral map)",
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
  double l = 0, sign = row->traits & VL_LIGHT_TRAIT_FAR ? -1 : 1; /* the direction of one far away is towards it */
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
  if (!light->delta) { /* rays that miss everything see it */
    uint32_t *slot = VL_PUSH(world->context, &world->infinite_lights);
    if (!slot) return vl_fail_memory(error);
    *slot = (uint32_t)world->lights.count - 1;
  }
  vlResult r = compile[def->kind](world, def, light, e, error);
  return vl_world_placed(def->source, error, r);
}

/* ---- glowing shapes ---------------------------------------------------------------------------------------------- */

static float mean_image_luminance(const vlMipmap *mip) {
  uint32_t last = mip->level_count - 1;
  return vl_light_texel_luminance(vl_texel(mip, last, 0, 0, VL_WRAP_CLAMP), mip->channels);
}

static vlResult add_emission(vlWorld *world, const vlScene *scene, const vlEmissionDef *def, vlEmitted *e,
                             vlError *error) {
  e->two_sided = def->two_sided;
  if (def->texture.index) {
    vlSpectrumInput input = vl_spectrum_input(vl_spectrum_constant(0.0f));
    input.texture = def->texture;
    int32_t node;
    vlResult r = vl_world_spectrum_node(world, scene, input, VL_ROLE_ILLUMINANT, &node, error);
    if (r != VL_OK) return r;
    e->node = node + 1;
    e->image = world->nodes.items[node].image;
    vl_light_picture_color(world, world->nodes.items[node].space, def->scale, e);
    return VL_OK;
  }
  if (!def->image) return vl_light_color(world, &def->radiance, def->scale, e, error);
  e->image = vl_world_add_image(world, def->image, NULL, NULL, 1, true, error);
  if (e->image < 0) return error && error->code ? error->code : VL_ERROR_SCENE;
  vl_light_picture_color(world, vl_light_picture_space(world, e->image, VL_SPACE_SRGB), def->scale, e);
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  for (uint32_t y = 0; y < mip->levels[0].height; y++)
    for (uint32_t x = 0; x < mip->levels[0].width; x++)
      if (!isfinite(vl_light_texel_luminance(vl_texel(mip, 0, (int32_t)x, (int32_t)y, VL_WRAP_CLAMP), mip->channels)))
        return vl_fail(error, VL_ERROR_SCENE, "%s: pixel (%u, %u) is not finite, it cannot shine", def->image, x, y);
  return VL_OK;
}

/* Mean luminance of an emission's texture over a triangle, about: where a picture is dark, no light need be asked. */
static float face_luminance(const vlWorld *world, const vlWorldShape *s, uint32_t prim, const vlEmitted *e) {
  static const float inside[4][3] = {
      {1 / 3.0f, 1 / 3.0f, 1 / 3.0f}, {0.7f, 0.15f, 0.15f}, {0.15f, 0.7f, 0.15f}, {0.15f, 0.15f, 0.7f}};
  const vlTextureNode *node = &world->nodes.items[e->node - 1];
  const float *uvs = s->glow_uvs ? s->glow_uvs : s->uvs;
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  float unit[6] = {0, 0, 1, 0, 1, 1}, t[6];
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 2; j++) t[2 * k + j] = uvs ? uvs[2 * (size_t)f[k] + j] : unit[2 * k + j];
  float area = fabsf((t[2] - t[0]) * (t[5] - t[1]) - (t[4] - t[0]) * (t[3] - t[1])), sum = 0;
  vlTexturePoint at = {0, 0, vl_vec3(0, 0, 0), vl_vec3(0, 0, 1), 0, {0, 0, 0, 0}, {1, 1, 1, 1}};
  float side = sqrtf(0.5f * area), axes[4] = {side, 0, 0, side};
  vl_texture_axes_of_uv(node, axes, &at);
  for (int i = 0; i < 4; i++) {
    at.u = inside[i][0] * t[0] + inside[i][1] * t[2] + inside[i][2] * t[4];
    at.v = inside[i][0] * t[1] + inside[i][1] * t[3] + inside[i][2] * t[5];
    vlTexel x = vl_texture_rgba(node, world->images.items[e->image].mipmap, at);
    sum += 0.25f * vl_light_texel_luminance(x, 4);
  }
  return e->image_scale * (isfinite(sum) ? sum : 0);
}

/* Corners and lit side. The renderer turns the geometric normal to the side of the interpolated shading normal: where
 * the three vertex normals agree on the side, so does every point between. */
static void triangle_light(const vlWorldShape *s, uint32_t prim, vlWorldLight *light) {
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  vlVec3 p[3];
  for (int k = 0; k < 3; k++) {
    const float *x = s->positions + 3 * (size_t)f[k];
    p[k] = vl_vec3(x[0], x[1], x[2]);
    for (int i = 0; i < 3; i++) light->corners[3 * k + i] = x[i];
  }
  vlVec3 g = vl_normalize(vl_cross(vl_sub(p[1], p[0]), vl_sub(p[2], p[0])));
  int against = 0;
  for (int k = 0; s->normals && k < 3; k++) {
    const float *x = s->normals + 3 * (size_t)f[k];
    against += vl_dot(g, vl_vec3(x[0], x[1], x[2])) < 0;
  }
  bool flip = s->normals ? against >= 2 : s->flip;
  light->one_sided_normals = against == 0 || against == 3;
  if (flip) g = vl_neg(g);
  light->direction[0] = g.x, light->direction[1] = g.y, light->direction[2] = g.z;
}

static vlResult add_shape_lights(vlWorld *world, const vlScene *scene, uint32_t shape_index, vlError *error) {
  const vlShapeDef *def = &scene->shapes.items[shape_index];
  vlWorldShape *shape = &world->shapes.items[shape_index];
  const vlEmissionDef *emission = &scene->emissions.items[def->emission.index - 1];
  if (def->group.index || shape->steps > 1) {
    vlError where;
    vl_fail_at(&where, VL_ERROR_SCENE, def->source.file, def->source.line, def->source.column, " ");
    vl_log(world->context, VL_LOG_WARNING, &where,
           def->group.index ? "a glowing shape inside an object that is instanced or moves does not shine"
                            : "a glowing shape that moves does not shine");
    return VL_OK;
  }
  bool meshed = shape->kind == VL_SHAPE_TRIANGLES || shape->kind == VL_SHAPE_BILINEAR;
  uint32_t faces = meshed ? shape->faces : 1;
  shape->first_light = (uint32_t)world->lights.count;
  if (!VL_RESERVE(world->context, &world->lights, faces)) return vl_fail_memory(error);
  bool has_power = emission->power == emission->power && emission->power > 0;
  uint32_t shared = VL_NONE;
  float own = 0; /* luminance of the emission's spectrum */
  for (uint32_t i = 0; i < faces; i++) {
    float area = vl_world_prim_area(shape, i);
    if (shared == VL_NONE || has_power) {
      vlEmitted *e = VL_PUSH(world->context, &world->emitted);
      if (!e) return vl_fail_memory(error);
      e->image = -1;
      vlResult r = add_emission(world, scene, emission, e, error);
      if (r != VL_OK) return vl_world_placed(emission->source, error, r);
      uint32_t set = e->node ? world->nodes.items[e->node - 1].uv_set : 0;
      if (set) shape->glow_uvs = shape->more_uvs[set - 1];
      shared = (uint32_t)world->emitted.count - 1;
      if (has_power) { /* as in pbrt, for each primitive */
        float sent = (e->two_sided ? 2 : 1) * area * VL_PI;
        if (e->image >= 0) sent *= mean_image_luminance(world->images.items[e->image].mipmap);
        float f = sent > 0 ? (float)emission->power / sent : 0;
        e->spectrum.scale *= f;
      }
    }
    const vlEmitted *e = &world->emitted.items[shared];
    if (i == 0 || has_power) own = vl_light_luminance(&e->spectrum);
    vlWorldLight *light = &world->lights.items[world->lights.count++];
    memset(light, 0, sizeof *light);
    light->kind = VL_WL_AREA;
    light->emitted = shared;
    light->shape = shape_index;
    light->prim = i;
    light->area = area;
    light->invisible = shape->alpha >= 0 && world->nodes.items[shape->alpha].kind == VL_NODE_FLOAT &&
                       world->nodes.items[shape->alpha].value == 0;
    light->environment = VL_NONE;
    float l = e->image >= 0 ? e->image_scale * mean_image_luminance(world->images.items[e->image].mipmap) * own : own;
    if (e->node && shape->kind == VL_SHAPE_TRIANGLES) l = face_luminance(world, shape, i, e) * own;
    light->power = VL_PI * area * l * (e->two_sided ? 2 : 1);
    if (shape->kind == VL_SHAPE_TRIANGLES) triangle_light(shape, i, light);
    if (shape->kind == VL_SHAPE_DISK) {
      vlSurfacePoint point;
      double pdf;
      vl_shape_sample(shape, 0, 0.5f, 0.5f, &point, &pdf);
      for (int k = 0; k < 3; k++) light->direction[k] = (float)point.n[k];
    }
  }
  return VL_OK;
}

vlResult vl_world_add_lights(vlWorld *world, const vlScene *scene, vlError *error) {
  vlResult r = VL_OK;
  vlEmitted white;
  memset(&white, 0, sizeof white);
  vl_light_picture_color(world, VL_SPACE_SRGB, 1, &white);
  world->white = white.spectrum;
  for (size_t i = 0; r == VL_OK && i < scene->lights.count; i++) r = add_light(world, &scene->lights.items[i], error);
  for (size_t i = 0; r == VL_OK && i < scene->shapes.count; i++)
    if (scene->shapes.items[i].emission.index && (world->shapes.items[i].faces > 0))
      r = add_shape_lights(world, scene, (uint32_t)i, error);
  if (r == VL_OK) r = vl_light_tree_build(world, error);
  world->info.lights = world->lights.count;
  return r;
}
