/* medium/compile.c: compiles the media of a scene: spectra, and what each kind adds
 * (kinds.row.h). Only media that are in use are compiled. */
#include <string.h>

#include "base/error.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "medium/compile.h"
#include "medium/kinds.row.h"
#include "scene/scene.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "world/world.h"

/* ---- spectra ----------------------------------------------------------------------------- */

static bool is_zero(const vlSpectral *s) {
  if (s->scale == 0)
    return true;
  if (s->kind == VL_SPECTRAL_RGB)
    return s->rgb[0] == 0 && s->rgb[1] == 0 && s->rgb[2] == 0;
  if (s->kind != VL_SPECTRAL_DENSE)
    return false;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    if (s->dense[i] != 0)
      return false;
  return true;
}

static bool is_grey(const vlSpectral *s) {
  return s->kind == VL_SPECTRAL_CONSTANT || is_zero(s) ||
         (s->kind == VL_SPECTRAL_RGB && s->rgb[0] == s->rgb[1] && s->rgb[0] == s->rgb[2]);
}

static vlResult compile_sigma(vlWorld *world, const vlMediumDef *def, const vlSpectrum *from,
                              vlSpectral *to, vlError *error) {
  vlSpectrum s = *from;
  /* Equal components become a constant, which saves lookups per flight. */
  if (s.kind == VL_SPECTRUM_RGB && s.rgb[0] == s.rgb[1] && s.rgb[0] == s.rgb[2])
    s = (vlSpectrum){.kind = VL_SPECTRUM_CONSTANT, .scale = s.scale, .value = s.rgb[0]};
  vlResult r = vl_spectral_compile(world, &s, VL_ROLE_UNBOUNDED, to, error);
  to->scale *= def->scale;
  return r;
}

/* Absorption by channel of linear sRGB is kept apart from the spectra: flights are sampled by
 * sigma_s alone, and absorption along the way becomes path weight. In RGB mode, and if all
 * channels are equal, sigma_a is used instead. */
static vlResult compile_absorption(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                   vlError *error) {
  if (!def->rgb_absorption || world->def.color == VL_COLOR_RGB ||
      def->sigma_a.kind != VL_SPECTRUM_RGB ||
      (def->sigma_a.rgb[0] == def->sigma_a.rgb[1] &&
       def->sigma_a.rgb[0] == def->sigma_a.rgb[2]))
    return compile_sigma(world, def, &def->sigma_a, &m->sigma_a, error);
  vlSpectrum none = vl_spectrum_constant(0.0f);
  vlResult r =
      vl_spectrum_to_rgb(&def->sigma_a, VL_ROLE_UNBOUNDED, VL_SPACE_SRGB, m->sigma_rgb, error);
  for (int c = 0; c < 3; c++)
    m->sigma_rgb[c] *= def->scale;
  m->by_channel = world->by_channel = true;
  return r == VL_OK ? compile_sigma(world, def, &none, &m->sigma_a, error) : r;
}

static vlResult compile_emission(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                 vlError *error) {
  VL_TRY(vl_spectral_compile(world, &def->emission, VL_ROLE_ILLUMINANT, &m->emission, error));
  m->emission.scale *= def->emission_scale;
  if (world->def.color != VL_COLOR_RGB && !is_zero(&m->emission)) {
    double photometric = vl_spectrum_photometric(&def->emission, error);
    m->emission.scale = photometric > 0 ? (float)(m->emission.scale / photometric) : 0.0f;
  }
  m->emits = !is_zero(&m->emission);
  return VL_OK;
}

vlResult vl_medium_temperature(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                               vlError *error) {
  m->emits = def->emission_scale > 0;
  m->temperature_offset = def->temperature_offset;
  m->temperature_scale = def->temperature_scale;
  m->temperature_emission = def->emission_scale;
  if (world->def.color != VL_COLOR_RGB)
    return VL_OK;
  float *table = vl_world_block(world, (size_t)VL_BLACKBODY_STEPS * 3, sizeof *table);
  if (!table)
    return vl_fail_memory(error);
  for (int k = 0; k < VL_BLACKBODY_STEPS; k++) {
    vlSpectrum body =
        vl_spectrum_blackbody((float)(VL_BLACKBODY_LOW * vl_precise_exp2(k / 32.0)));
    VL_TRY(vl_spectrum_to_rgb(&body, VL_ROLE_ILLUMINANT, VL_SPACE_SRGB, table + 3 * k, error));
    for (int c = 0; c < 3; c++)
      table[3 * k + c] *= (float)vl_spectrum_photometric(&body, error);
  }
  m->blackbody_rgb = table;
  return VL_OK;
}

float *vl_medium_majorants(vlWorld *world, vlWorldMedium *m, uint32_t x, uint32_t y,
                           uint32_t z) {
  m->cells[0] = x;
  m->cells[1] = y;
  m->cells[2] = z;
  float *majorants = vl_world_block(world, (size_t)x * y * z, sizeof *majorants);
  m->majorants = majorants;
  return majorants;
}

/* ---- all --------------------------------------------------------------------------------- */

#define DECLARE(kind, row, compile, density) vlCompileMedium compile;
VL_MEDIUM_FUNCTIONS(DECLARE)

static vlResult compile_kind(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                             vlError *error) {
  switch (def->kind) {
#define COMPILE(kind, row, compile, density) \
  case kind:                                 \
    return compile(world, def, m, error);
    VL_MEDIUM_FUNCTIONS(COMPILE)
  }
  return vl_fail_argument(error, "no such kind of medium");
}

static vlResult compile(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                        vlError *error) {
  vlMat4 inverse;
  m->kind = def->kind;
  /* as in pbrt-v4; beyond that, float directions are too coarse */
  m->g = vl_clamp(def->g, -0.99f, 0.99f);
  if (!vl_mat4_inverse(vl_mat4_load(def->world_from_medium), &inverse))
    return vl_fail(error, VL_ERROR_SCENE, "the medium's transform is singular");
  for (int i = 0; i < 12; i++)
    m->medium_from_world[i] = (float)inverse.m[i];
  VL_TRY(compile_absorption(world, def, m, error));
  VL_TRY(compile_sigma(world, def, &def->sigma_s, &m->sigma_s, error));
  VL_TRY(compile_emission(world, def, m, error));
  m->scatters = !is_zero(&m->sigma_s);
  m->grey = is_grey(&m->sigma_a) && is_grey(&m->sigma_s);
  m->temperature_emission = 1;
  return compile_kind(world, def, m, error);
}

/* Compiles a medium, or shares that of the previous world if neither it nor its file has
 * changed. */
static vlResult obtain(vlWorld *world, const vlScene *scene, vlMediumId id, vlWorldMedium *m,
                       vlError *error) {
  const vlMediumDef *def = &scene->media.items[id.index - 1];
  const vlWorld *previous = world->previous;
  vlFileStamp stamp = vl_file_stamp(def->path);
  vlWorldFilePart *kept = VL_PUSH(world->context, &world->medium_parts);
  if (!kept)
    return vl_fail_memory(error);
  const uint64_t generation = vl_scene_mark(&scene->medium_marks, id.index - 1).generation;
  bool same_scene = previous && previous->scene_number == scene->number;
  for (size_t i = 0; same_scene && i < previous->media.count; i++) {
    const vlWorldFilePart *known = &previous->medium_parts.items[i];
    if (known->id != id.index || known->generation != generation ||
        !vl_file_stamp_same(&known->stamp, &stamp))
      continue;
    if (!vl_part_share(world, known->part))
      return vl_fail_memory(error);
    *kept = *known;
    *m = previous->media.items[i];
    world->by_channel = world->by_channel || m->by_channel;
    return VL_OK;
  }
  *kept = (vlWorldFilePart){vl_part_add(world), stamp, id.index, generation};
  if (!(world->part = kept->part))
    return vl_fail_memory(error);
  vlResult r = compile(world, def, m, error);
  world->part = NULL;
  return r;
}

/* Returns the index in world->media of a medium of the scene. The medium is compiled at its
 * first use. */
static vlResult use(vlWorld *world, const vlScene *scene, uint32_t *compiled, vlMediumId id,
                    uint32_t *index, vlError *error) {
  *index = VL_NONE;
  if (id.index == 0)
    return VL_OK;
  if (!compiled[id.index - 1]) {
    const vlMediumDef *def = &scene->media.items[id.index - 1];
    vlWorldMedium *m = VL_PUSH(world->context, &world->media);
    if (!m)
      return vl_fail_memory(error);
    memset(m, 0, sizeof *m);
    vlResult r = obtain(world, scene, id, m, error);
    if (r != VL_OK)
      return vl_world_locate_error(def->source, error, r);
    compiled[id.index - 1] = (uint32_t)world->media.count;
  }
  *index = compiled[id.index - 1] - 1;
  return VL_OK;
}

vlResult vl_world_add_media(vlWorld *world, const vlScene *scene, vlError *error) {
  world->camera_medium = VL_NONE;
  uint32_t *compiled = vl_world_block(world, scene->media.count + 1, sizeof *compiled);
  if (!compiled)
    return vl_fail_memory(error);
  memset(compiled, 0, (scene->media.count + 1) * sizeof *compiled);
  vlResult r =
      use(world, scene, compiled, scene->defs.camera_medium, &world->camera_medium, error);
  for (size_t i = 0; r == VL_OK && i < scene->shapes.count; i++) {
    const vlShapeDef *def = &scene->shapes.items[i];
    vlWorldShape *shape = &world->shapes.items[i];
    shape->inside = shape->outside = VL_NONE;
    if (def->inside.index == def->outside.index)
      continue;
    r = use(world, scene, compiled, def->inside, &shape->inside, error);
    if (r == VL_OK)
      r = use(world, scene, compiled, def->outside, &shape->outside, error);
  }
  return r;
}
