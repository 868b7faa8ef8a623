/* scene/medium.c: adds participating media: each def is checked, then copied. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "math/transform.h"
#include "scene/family.h"
#include "schema/schema.h"
#include "velo/medium.h"

static bool bad(vlScene *scene, const vlMediumDef *d, const char *why) {
  return vl_scene_fail(scene, VL_ERROR_SCENE, d->source, "medium \"%s\": %s",
                       vl_short_text(d->name).text, why);
}

/* Checks the values of a grid: finite and, for most kinds, not negative. */
static bool check_values(vlScene *scene, const vlMediumDef *d, const float *v, size_t per,
                         bool signs, const char *what) {
  size_t count = v ? (size_t)d->nx * d->ny * d->nz * per : 0;
  for (size_t i = 0; i < count; i++) {
    if (isfinite(v[i]) && (signs || v[i] >= 0.0f))
      continue;
    return vl_scene_fail(scene, VL_ERROR_SCENE, d->source,
                         "medium \"%s\": %s: value %zu is %s (%g)", vl_short_text(d->name).text,
                         what, i / per, isfinite(v[i]) ? "negative" : "not finite",
                         (double)v[i]);
  }
  return true;
}

static bool check_grid(vlScene *scene, const vlMediumDef *d) {
  if (d->kind == VL_MEDIUM_GRID && !d->density)
    return bad(scene, d, "the grid has no density");
  if (d->kind == VL_MEDIUM_RGB_GRID && !d->rgb_a && !d->rgb_s)
    return bad(scene, d, "the grid has neither sigma_a nor sigma_s");
  if (d->rgb_emission && !d->rgb_a)
    return bad(scene, d, "a grid that emits needs sigma_a on the grid, too");
  return check_values(scene, d, d->density, 1, false, "density") &&
         check_values(scene, d, d->emission_scales, 1, false, "emission scale") &&
         check_values(scene, d, d->temperature, 1, true, "temperature") &&
         check_values(scene, d, d->rgb_a, 3, false, "sigma_a") &&
         check_values(scene, d, d->rgb_s, 3, false, "sigma_s") &&
         check_values(scene, d, d->rgb_emission, 3, false, "emission");
}

/* Every sample is checked: negative coefficients would produce light. */
static bool check_spectrum(vlScene *scene, const vlMediumDef *d, const vlSpectrum *s,
                           const char *what) {
  bool negative = s->scale < 0.0f || (s->kind == VL_SPECTRUM_CONSTANT && s->value < 0.0f);
  for (uint32_t i = 0; s->kind == VL_SPECTRUM_SAMPLED && i < s->count; i++)
    negative = negative || s->values[i] < 0.0f;
  if (!negative)
    return true;
  return vl_scene_fail(scene, VL_ERROR_SCENE, d->source, "medium \"%s\": %s is negative",
                       vl_short_text(d->name).text, what);
}

static bool check_rgb_absorption(vlScene *scene, const vlMediumDef *d) {
  bool dark = d->emission_scale == 0.0f || d->emission.scale == 0.0f ||
              (d->emission.kind == VL_SPECTRUM_CONSTANT && d->emission.value == 0.0f);
  if (d->kind != VL_MEDIUM_HOMOGENEOUS)
    return bad(scene, d, "only a homogeneous medium can absorb by RGB channel");
  if (d->sigma_a.kind != VL_SPECTRUM_RGB && d->sigma_a.kind != VL_SPECTRUM_CONSTANT)
    return bad(scene, d,
               "to absorb by RGB channel its sigma_a must be an RGB value or a constant");
  return dark || bad(scene, d, "a medium that absorbs by RGB channel cannot emit");
}

static bool check_medium(vlScene *scene, const vlMediumDef *d, const vlKindRow *row) {
  if (!vl_mat4_is_finite(vl_mat4_load(d->world_from_medium)))
    return bad(scene, d, "transform is not finite");
  if (!check_spectrum(scene, d, &d->sigma_a, "sigma_a") ||
      !check_spectrum(scene, d, &d->sigma_s, "sigma_s") ||
      !check_spectrum(scene, d, &d->emission, "emission"))
    return false;
  for (int i = 0; (row->traits & VL_MEDIUM_TRAIT_BOX) && i < 3; i++)
    if (!(d->low[i] < d->high[i]))
      return bad(scene, d, "its box has no room: p0 must be below p1 in x, y and z");
  if (d->path && !d->path[0])
    return bad(scene, d, "it has no file name");
  return !(row->traits & VL_MEDIUM_TRAIT_CELLS) || check_grid(scene, d);
}

/* Copies the members that give values per cell, for kinds with grids. */
static void copy_cells(const vlMediumDef *from, vlMediumDef *to) {
  if (to->kind == VL_MEDIUM_GRID) {
    to->density = from->density;
    to->emission_scales = from->emission_scales;
    to->temperature = from->temperature;
  }
  if (to->kind == VL_MEDIUM_RGB_GRID) {
    to->rgb_a = from->rgb_a;
    to->rgb_s = from->rgb_s;
    to->rgb_emission = from->rgb_emission;
  }
}

vlMediumId vl_scene_add_medium(vlScene *scene, const vlMediumDef *def) {
  const vlMediumId none = {0};
  const vlKindRow *row = vl_scene_row_to_add(scene, VL_SCENE_MEDIA, def);
  if (!row)
    return none;
  if ((unsigned)def->space > VL_SPACE_ACES2065_1) {
    bad(scene, def, "unknown colour space");
    return none;
  }
  if (def->rgb_absorption && !check_rgb_absorption(scene, def))
    return none;
  char what[120];
  snprintf(what, sizeof what, "medium \"%s\"", vl_short_text(def->name).text);
  /* members that the kind does not use keep their defaults */
  vlMediumDef d = vl_default_medium_def(def->kind);
  vl_row_copy_members(row, def, &d);
  d.name = def->name;
  d.source = def->source;
  d.space = def->space;
  memcpy(d.world_from_medium, def->world_from_medium, sizeof d.world_from_medium);
  copy_cells(def, &d);
  if (!vl_row_take(scene, row, &d, true, d.source, what))
    return none;
  if (!vl_scene_copy_source(scene, &d.source) || !vl_scene_copy_string(scene, &d.name) ||
      !check_medium(scene, &d, row))
    return none;
  size_t cells = (size_t)d.nx * d.ny * d.nz;
  const float **grids[6] = {&d.density, &d.emission_scales, &d.temperature,
                            &d.rgb_a,   &d.rgb_s,           &d.rgb_emission};
  for (int i = 0; i < 6; i++)
    if (!vl_scene_copy_block(scene, *grids[i], cells, (i < 3 ? 1 : 3) * sizeof(float),
                             grids[i]))
      return none;
  return (vlMediumId){vl_scene_push(scene, VL_SCENE_MEDIA, &d)};
}
