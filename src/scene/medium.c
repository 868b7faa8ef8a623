/* scene/medium.c: participating media come in: checked, then copied. Defaults are pbrt-v4's. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "scene/scene.h"

vlMediumDef vl_default_medium_def(vlMediumKind kind) {
  vlMediumDef def = {
      .cookie = VL_COOKIE_MEDIUM,
      .kind = kind,
      .sigma_a = vl_spectrum_constant(1.0f),
      .sigma_s = vl_spectrum_constant(1.0f),
      .scale = 1.0f,
      .emission = vl_spectrum_constant(0.0f),
      .emission_scale = 1.0f,
      .nx = 1,
      .ny = 1,
      .nz = 1,
      .high = {1, 1, 1},
      .temperature_scale = 1.0f,
      .cloud_density = 1.0f,
      .wispiness = 1.0f,
      .frequency = 5.0f,
  };
  for (int i = 0; i < 16; i += 5) def.world_from_medium[i] = 1.0;
  return def;
}

static bool bad(vlScene *scene, const vlMediumDef *d, const char *why) {
  vl_scene_fail(scene, VL_ERROR_SCENE, d->source, "medium \"%.80s\": %s", d->name ? d->name : "", why);
  return false;
}

/* Values of a grid: finite, and none below 0 where that makes no sense. */
static bool check_values(vlScene *scene, const vlMediumDef *d, const float *v, size_t per, bool signs,
                         const char *what) {
  size_t count = v ? (size_t)d->nx * d->ny * d->nz * per : 0;
  for (size_t i = 0; i < count; i++) {
    if (isfinite(v[i]) && (signs || v[i] >= 0.0f)) continue;
    vl_scene_fail(scene, VL_ERROR_SCENE, d->source, "medium \"%.80s\": %s: value %zu is %s (%g)",
                  d->name ? d->name : "", what, i / per, isfinite(v[i]) ? "negative" : "not finite", (double)v[i]);
    return false;
  }
  return true;
}

static bool check_grid(vlScene *scene, const vlMediumDef *d) {
  if (d->nx == 0 || d->ny == 0 || d->nz == 0) return bad(scene, d, "nx, ny and nz must be at least 1");
  if (d->nx > 16384 || d->ny > 16384 || d->nz > 16384) return bad(scene, d, "nx, ny and nz must be at most 16384");
  if (d->kind == VL_MEDIUM_GRID && !d->density) return bad(scene, d, "the grid has no density");
  if (d->kind == VL_MEDIUM_RGB_GRID && !d->rgb_a && !d->rgb_s)
    return bad(scene, d, "the grid has neither sigma_a nor sigma_s");
  if (d->rgb_emission && !d->rgb_a) return bad(scene, d, "a grid that emits needs sigma_a on the grid, too");
  return check_values(scene, d, d->density, 1, false, "density") &&
         check_values(scene, d, d->emission_scales, 1, false, "emission scale") &&
         check_values(scene, d, d->temperature, 1, true, "temperature") &&
         check_values(scene, d, d->rgb_a, 3, false, "sigma_a") &&
         check_values(scene, d, d->rgb_s, 3, false, "sigma_s") &&
         check_values(scene, d, d->rgb_emission, 3, false, "emission");
}

/* Every sample must be there: negative coefficients would make light of nothing. */
static bool check_spectrum(vlScene *scene, const vlMediumDef *d, const vlSpectrum *s, const char *what) {
  bool negative = s->scale < 0.0f || (s->kind == VL_SPECTRUM_CONSTANT && s->value < 0.0f);
  for (uint32_t i = 0; s->kind == VL_SPECTRUM_SAMPLED && i < s->count; i++) negative = negative || s->values[i] < 0.0f;
  if (!negative) return true;
  vl_scene_fail(scene, VL_ERROR_SCENE, d->source, "medium \"%.80s\": %s is negative", d->name ? d->name : "", what);
  return false;
}

static bool check_rgb_absorption(vlScene *scene, const vlMediumDef *d) {
  bool dark = d->emission_scale == 0.0f || d->emission.scale == 0.0f ||
              (d->emission.kind == VL_SPECTRUM_CONSTANT && d->emission.value == 0.0f);
  if (d->kind != VL_MEDIUM_HOMOGENEOUS) return bad(scene, d, "only a homogeneous medium can absorb by RGB channel");
  if (d->sigma_a.kind != VL_SPECTRUM_RGB && d->sigma_a.kind != VL_SPECTRUM_CONSTANT)
    return bad(scene, d, "to absorb by RGB channel its sigma_a must be an RGB value or a constant");
  return dark || bad(scene, d, "a medium that absorbs by RGB channel cannot emit");
}

static bool check_medium(vlScene *scene, const vlMediumDef *d) {
  const float numbers[] = {d->scale,   d->g,       d->emission_scale, d->temperature_offset, d->temperature_scale,
                           d->low[0],  d->low[1],  d->low[2],         d->cloud_density,      d->wispiness,
                           d->high[0], d->high[1], d->high[2],        d->frequency};
  if ((unsigned)d->kind > VL_MEDIUM_NANOVDB) return bad(scene, d, "unknown kind");
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    if (!isfinite(numbers[i])) return bad(scene, d, "a number is not finite");
  for (int i = 0; i < 16; i++)
    if (!isfinite(d->world_from_medium[i])) return bad(scene, d, "transform is not finite");
  if (d->scale < 0.0f) return bad(scene, d, "scale is negative");
  if (d->emission_scale < 0.0f) return bad(scene, d, "scale of the emission is negative");
  if (d->g < -1.0f || d->g > 1.0f) return bad(scene, d, "g must lie between -1 and 1");
  if (!check_spectrum(scene, d, &d->sigma_a, "sigma_a") || !check_spectrum(scene, d, &d->sigma_s, "sigma_s") ||
      !check_spectrum(scene, d, &d->emission, "emission"))
    return false;
  if (d->rgb_absorption && !check_rgb_absorption(scene, d)) return false;
  bool boxed = d->kind == VL_MEDIUM_GRID || d->kind == VL_MEDIUM_RGB_GRID || d->kind == VL_MEDIUM_CLOUD;
  for (int i = 0; boxed && i < 3; i++)
    if (!(d->low[i] < d->high[i])) return bad(scene, d, "its box has no room: p0 must be below p1 in x, y and z");
  if (d->kind == VL_MEDIUM_CLOUD && (d->cloud_density < 0.0f || d->frequency < 0.0f || d->wispiness < 0.0f))
    return bad(scene, d, "density, frequency and wispiness must not be negative");
  if (d->kind == VL_MEDIUM_NANOVDB && (!d->path || !d->path[0])) return bad(scene, d, "it has no file name");
  return (d->kind != VL_MEDIUM_GRID && d->kind != VL_MEDIUM_RGB_GRID) || check_grid(scene, d);
}

/* Arrays that a kind does not read are not copied. */
static void drop_unused(vlMediumDef *d) {
  if (d->kind != VL_MEDIUM_GRID) d->density = d->emission_scales = d->temperature = NULL;
  if (d->kind != VL_MEDIUM_RGB_GRID) d->rgb_a = d->rgb_s = d->rgb_emission = NULL;
  if (d->kind != VL_MEDIUM_NANOVDB) d->path = d->grid = d->temperature_grid = NULL;
}

vlMediumId vl_scene_add_medium(vlScene *scene, const vlMediumDef *def) {
  const vlMediumId none = {0};
  if (scene->error.code != VL_OK) return none;
  if (!def || def->cookie != VL_COOKIE_MEDIUM) {
    vl_scene_fail(scene, VL_ERROR_ARGUMENT, (vlSource){0},
                  "medium: the def does not come from vl_default_medium_def()");
    return none;
  }
  vlMediumDef d = *def;
  drop_unused(&d);
  if (!vl_scene_copy_source(scene, &d.source) || !vl_scene_copy_string(scene, &d.name) || !check_medium(scene, &d))
    return none;
  if (!vl_scene_copy_spectrum(scene, &d.sigma_a, d.source, "sigma_a") ||
      !vl_scene_copy_spectrum(scene, &d.sigma_s, d.source, "sigma_s") ||
      !vl_scene_copy_spectrum(scene, &d.emission, d.source, "emission"))
    return none;
  size_t cells = (size_t)d.nx * d.ny * d.nz;
  const float **grids[6] = {&d.density, &d.emission_scales, &d.temperature, &d.rgb_a, &d.rgb_s, &d.rgb_emission};
  for (int i = 0; i < 6; i++)
    if (!vl_scene_copy_block(scene, *grids[i], cells, (i < 3 ? 1 : 3) * sizeof(float), grids[i])) return none;
  if (!vl_scene_copy_string(scene, &d.path) || !vl_scene_copy_string(scene, &d.grid) ||
      !vl_scene_copy_string(scene, &d.temperature_grid))
    return none;
  vlMediumDef *slot = scene->media.count < 0x7fffffff ? VL_PUSH(scene->context, &scene->media) : NULL;
  if (!slot) {
    vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
    return none;
  }
  *slot = d;
  return (vlMediumId){(uint32_t)scene->media.count};
}
