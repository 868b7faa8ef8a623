/* import/pbrt/medium.c: MakeNamedMedium, and the media of shapes, lights and the camera. Names
 * are resolved at the end, since pbrt allows a medium to be named before it is defined.
 * Parameters and defaults are pbrt-v4's. */
#include <stdio.h>

#include "base/text.h"
#include "import/pbrt/builder.h"
#include "import/pbrt/scattering.h"
#include "velo/light.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "velo/tracer.h"

/* ---- parameters -------------------------------------------------------------------------- */

bool vl_import_scattering_preset(vlDict *dict, const char *parameter, vlSpectrum *absorption,
                                 vlSpectrum *scattering, bool *given) {
  enum { MAX_PRESETS = 64 };
  const char *name = NULL, *names[MAX_PRESETS];
  size_t count = 0;
  *given = false;
  if (!vl_dict_string(dict, parameter, &name))
    return vl_import_fine(dict->import);
  *given = name[0] != 0;
  if (!*given)
    return true;
  for (; count < MAX_PRESETS && vl_scattering_preset(count); count++) {
    const vlScattering *s = vl_scattering_preset(count);
    names[count] = s->name;
    if (!vl_text_is(s->name, name))
      continue;
    *absorption = vl_spectrum_rgb(s->absorption[0], s->absorption[1], s->absorption[2]);
    *scattering = vl_spectrum_rgb(s->scattering[0], s->scattering[1], s->scattering[2]);
    return true;
  }
  vlSource at = vl_dict_find(dict, parameter, VL_BIT_STRING)->source;
  const char *near = vl_nearest_name(name, names, count);
  return vl_dict_fail_at(dict, at, "no preset is named \"%s\"%s", vl_short_text(name).text,
                         vl_hint(near).text);
}

/* A preset takes precedence over sigma_a and sigma_s, as in pbrt. */
static bool read_preset(vlDict *dict, vlMediumDef *def) {
  vlSpectrum absorption, scattering;
  bool given;
  if (!vl_import_scattering_preset(dict, "preset", &absorption, &scattering, &given))
    return false;
  if (given) {
    def->sigma_a = absorption;
    def->sigma_s = scattering;
  }
  return true;
}

/* As in pbrt, the corners of the box are sorted. */
static void sort_box(vlMediumDef *def) {
  for (int i = 0; i < 3; i++) {
    if (!(def->low[i] > def->high[i]))
      continue;
    float t = def->low[i];
    def->low[i] = def->high[i];
    def->high[i] = t;
  }
}

/* Reads a grid: for each cell a number or, of type RGB, three. *values is unchanged when the
 * parameter is not given. */
static bool read_cells(vlDict *dict, const char *name, vlParamType type, const vlMediumDef *def,
                       const float **values) {
  vlParam *p = vl_dict_find(dict, name, 1u << type);
  if (!p)
    return vl_import_fine(dict->import);
  size_t per = type == VL_PARAM_RGB ? 3 : 1; /* numbers per cell */
  size_t count = p->floats.count / per;
  double cells = (double)def->nx * def->ny * def->nz;
  if (p->floats.count % per || (double)count != cells)
    return vl_dict_fail_at(
        dict, p->source,
        "\"%s\" holds %zu numbers, but nx * ny * nz = %u * %u * %u cells need %.0f", name,
        p->floats.count, def->nx, def->ny, def->nz, cells * (double)per);
  *values = p->floats.items;
  return true;
}

/* Rules that the rows do not express, by kind; null: none. */
typedef bool ReadMedium(vlDict *dict, vlMediumDef *def);

static bool read_grid(vlDict *dict, vlMediumDef *def) {
  vlParam *scale = vl_dict_find(dict, "Lescale", VL_BIT_FLOAT);
  if (scale && scale->floats.count == 1)
    def->emission_scale = scale->floats.items[0];
  else if (!read_cells(dict, "Lescale", VL_PARAM_FLOAT, def, &def->emission_scales))
    return false;
  if (vl_import_given(dict, "Le") && def->temperature)
    return vl_dict_fail(dict, "give either \"Le\" or \"temperature\", not both");
  return def->density || vl_dict_missing(dict, "\"float density\"");
}

static bool read_rgb_grid(vlDict *dict, vlMediumDef *def) {
  return def->rgb_a || def->rgb_s ||
         vl_dict_missing(dict, "\"rgb sigma_a\" or \"rgb sigma_s\" (a colour for each cell)");
}

static ReadMedium *const rules[0 VL_MEDIUM_KINDS(VL_COUNT_KIND)] = {
    [VL_MEDIUM_GRID] = read_grid,
    [VL_MEDIUM_RGB_GRID] = read_rgb_grid,
};

/* Reads the arrays of the row: numbers or colours per cell. */
static bool read_arrays(vlDict *dict, vlMediumDef *def) {
  const vlKindRow *row = dict->row;
  VL_EACH_PARAMETER(p, row) {
    if (p->type != VL_PARAMETER_BLOCK || !p->name)
      continue;
    vlParamType type = vl_text_is(p->text, "rgb array") ? VL_PARAM_RGB : VL_PARAM_FLOAT;
    if (!read_cells(dict, p->name, type, def,
                    (const float **)(void *)((char *)def + p->offset)))
      return false;
  }
  return true;
}

static bool read_medium(vlDict *dict, vlMediumDef *def) {
  ReadMedium *rule = rules[dict->kind];
  if (!vl_import_parameters(dict, def, true))
    return false;
  if (dict->row->traits & VL_MEDIUM_TRAIT_BOX)
    sort_box(def);
  if (vl_row_find(dict->row, "preset") && !read_preset(dict, def))
    return false;
  return read_arrays(dict, def) && (!rule || rule(dict, def)) && vl_dict_done(dict);
}

bool vl_import_medium(vlImport *import, const vlStatement *s) {
  uint32_t index;
  char what[96];
  const char *type = NULL;
  snprintf(what, sizeof what, "MakeNamedMedium \"%s\"", vl_short_text(s->names[0]).text);
  if (vl_names_find(&import->media, s->names[0], &index))
    return vl_import_wrong(import, s->source, "medium \"%s\" is made a second time",
                           vl_short_text(s->names[0]).text);
  vlDict dict = vl_import_dict(import, what, s->source, import->state.space, s->params,
                               &import->attributes[VL_ATTR_MEDIUM]);
  if (!vl_dict_type(&dict, &type))
    return false;
  vl_dict_set_kind(&dict, &vl_medium_family, vl_kind_find(&vl_medium_family, type));
  const char *name = vl_import_keep(import, s->names[0]);
  if (!name)
    return false;
  vlMediumId id = {0};
  if (!dict.row) { /* permissive: vacuum */
    if (!vl_import_unknown_kind(import, s->source, &vl_medium_family, type))
      return false;
  } else {
    vlMediumDef def = vl_default_medium_def((vlMediumKind)dict.kind);
    vlMat4 ctm;
    def.name = name;
    def.source = s->source;
    def.space = import->state.space;
    if (!vl_import_ctm(import, s->source, &ctm) || !read_medium(&dict, &def))
      return false;
    memcpy(def.world_from_medium, ctm.m, sizeof def.world_from_medium);
    id = vl_scene_add_medium(import->scene, &def);
    if (!id.index)
      return false;
  }
  return vl_import_add_name(import, &import->media, name, id.index);
}

/* ---- the media of shapes, lights and the camera ------------------------------------------ */

bool vl_import_note_media(vlImport *import, char target, uint32_t index, vlSource source) {
  const char *inside = target == 's' && import->state.inside ? import->state.inside : "";
  const char *outside = import->state.outside ? import->state.outside : "";
  if (!inside[0] && !outside[0])
    return true;
  vlMediumLink *link = VL_IMPORT_PUSH(import, &import->medium_links);
  if (!link)
    return false;
  *link = (vlMediumLink){target, index, inside, outside, source};
  return vl_scene_copy_source(import->scene, &link->source);
}

/* The medium of this name; index 0 for "", which is vacuum. */
static bool find(vlImport *import, const char *name, vlSource source, vlMediumId *id) {
  id->index = 0;
  if (!name[0] || vl_names_find(&import->media, name, &id->index))
    return true;
  return vl_import_missing_name(import, source, "medium", name, &import->media);
}

/* Warns when a scene with media names one of pbrt's surface integrators, which ignore media.
 * Velo's light-tracing and photon-mapping tracers do not ignore media; the message says which
 * case applies. It says what the file means: the command line may name another tracer. */
static void warn_surface_integrator(vlImport *import, const vlMediumLink *link) {
  const vlChoice *integrator = &import->integrator;
  vlTracer tracer = vl_scene_defs(import->scene)->render.tracer;
  if (tracer == VL_TRACER_VOLPATH || tracer == VL_TRACER_BIDIRECTIONAL || !integrator->given)
    return;
  bool through =
      !(vl_kind_row(&vl_tracer_family, (int)tracer)->traits & VL_TRACER_TRAIT_NO_MEDIA);
  vl_import_warn(import, VL_LOG_WARNING, link->source,
                 through
                     ? "integrator \"%s\" of pbrt looks past participating media (here "
                       "\"%s\"), velo's goes through"
                     : "integrator \"%s\" looks past participating media (here \"%s\"), as in "
                       "pbrt; volpath goes through",
                 vl_import_kind_text(&vl_tracer_family, integrator->kind).text,
                 vl_short_text(link->inside[0] ? link->inside : link->outside).text);
}

bool vl_import_finish_media(vlImport *import) {
  vlScene *scene = import->scene;
  VL_EACH_ITEM(const vlMediumLink, link, &import->medium_links) {
    vlMediumId inside, outside;
    if (!find(import, link->inside, link->source, &inside) ||
        !find(import, link->outside, link->source, &outside)) {
      if (!vl_import_recover(import))
        return false;
      continue;
    }
    if (link->target == 's') {
      scene->shapes.items[link->index].inside = inside;
      scene->shapes.items[link->index].outside = outside;
    } else if (link->target == 'l') {
      scene->lights.items[link->index].medium = outside;
    } else {
      vl_scene_defs(scene)->camera_medium = outside;
    }
  }
  if (import->medium_links.count)
    warn_surface_integrator(import, &import->medium_links.items[0]);
  return true;
}
