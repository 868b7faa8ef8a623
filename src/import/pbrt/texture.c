/* import/pbrt/texture.c: Texture directives become textures of the scene, each after the
 * textures that it refers to. */
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "import/pbrt/builder.h"
#include "math/double3.h"
#include "velo/texture.h"

/* ---- the statement ----------------------------------------------------------------------- */

bool vl_import_texture(vlImport *import, const vlStatement *s) {
  bool spectrum = vl_text_is(s->names[1], "spectrum") || vl_text_is(s->names[1], "color");
  if (!spectrum && !vl_text_is(s->names[1], "float"))
    return vl_import_wrong(
        import, s->source,
        "Texture \"%s\": the type must be \"float\" or \"spectrum\", not \"%s\"",
        vl_short_text(s->names[0]).text, vl_short_text(s->names[1]).text);
  vlNameTable *table = spectrum ? &import->spectrum_textures : &import->float_textures;
  uint32_t index;
  if (vl_names_find(table, s->names[0], &index))
    return vl_import_wrong(import, s->source,
                           "%s texture \"%s\" is made a second time (first in line %u)",
                           spectrum ? "spectrum" : "float", vl_short_text(s->names[0]).text,
                           import->textures.items[index].source.line);
  vlPending *p = vl_import_wait(import, s, VL_ATTR_TEXTURE, true);
  if (!p)
    return false;
  p->spectrum = spectrum;
  if (!vl_import_ctm(import, s->source, &p->ctm) ||
      !(p->name = vl_import_keep(import, s->names[0])) ||
      !(p->kind = vl_import_keep(import, s->names[2])))
    return false;
  return vl_import_add_name(import, table, p->name, import->textures.count - 1);
}

/* ---- the end of the file ----------------------------------------------------------------- */

bool vl_import_texture_id(vlImport *import, const char *name, bool spectrum, vlSource source,
                          vlTextureId *id) {
  const vlNameTable *table = spectrum ? &import->spectrum_textures : &import->float_textures;
  const vlNameTable *other = spectrum ? &import->float_textures : &import->spectrum_textures;
  const char *type = spectrum ? "spectrum" : "float";
  uint32_t index;
  if (!vl_names_find(table, name, &index)) {
    if (vl_names_find(other, name, &index))
      return vl_import_wrong(import, source,
                             "texture \"%s\" is a %s texture; a %s texture is needed here",
                             vl_short_text(name).text, spectrum ? "float" : "spectrum", type);
    return vl_import_missing_name(import, source,
                                  spectrum ? "spectrum texture" : "float texture", name, table);
  }
  if (import->textures.items[index].state == VL_IN_PROGRESS)
    return vl_import_wrong(import, source, "texture \"%s\" refers to itself",
                           vl_short_text(name).text);
  if (!vl_import_finish_texture(import, index))
    return false;
  id->index = import->textures.items[index].id;
  return true;
}

/* ---- what a table cannot say ------------------------------------------------------------- */

/* A parameter that does not belong to the mapping is an error, like any unknown one. */
static bool check_mapping(vlDict *dict, const vlTextureDef *def) {
  static const struct {
    const char *name;
    bool in[4]; /* per mapping: whether it has the parameter */
  } parameters[] = {
      {"uscale", {true, false, false, false}}, {"vscale", {true, false, false, false}},
      {"udelta", {true, false, false, true}},  {"vdelta", {true, false, false, true}},
      {"v1", {false, false, false, true}},     {"v2", {false, false, false, true}}};
  bool solid = def->kind == VL_TEXTURE_CHECKERBOARD && def->dimension == 3;
  const vlParam *mapping = solid ? vl_dict_find(dict, "mapping", ~0u) : NULL;
  if (mapping && !mapping->optional)
    return vl_dict_fail_at(dict, mapping->source,
                           "\"mapping\" has no effect with \"dimension\" 3");
  for (size_t i = 0; i < VL_LENGTH(parameters); i++) {
    const char *name = parameters[i].name;
    if (parameters[i].in[def->mapping] && !solid)
      continue;
    const vlParam *p = vl_import_given(dict, name) ? vl_dict_find(dict, name, ~0u) : NULL;
    if (p && !p->optional) /* attributes may stay unused */
      return vl_dict_fail_at(dict, p->source, "\"%s\" has no effect with this mapping", name);
  }
  return true;
}

/* Encodings: "sRGB", "linear", "gamma 2.2". */
static bool read_encoding(vlDict *dict, vlTextureDef *def) {
  vlParam *p = vl_dict_find(dict, "encoding", 1u << VL_PARAM_STRING);
  if (!p)
    return true;
  const char *text = p->strings.items[0];
  def->encoding_given = true;
  if (vl_text_is(text, "sRGB") || vl_text_is(text, "srgb")) {
    def->encoding = VL_ENCODING_SRGB;
  } else if (vl_text_is(text, "linear")) {
    def->encoding = VL_ENCODING_LINEAR;
  } else if (sscanf(text, "gamma %f", &def->gamma) == 1 && def->gamma > 0.0f &&
             isfinite(def->gamma)) {
    def->encoding = VL_ENCODING_GAMMA;
  } else {
    return vl_dict_fail_at(
        dict, p->source,
        "unknown encoding \"%s\" (known: sRGB, linear, gamma followed by a number)",
        vl_short_text(text).text);
  }
  return true;
}

static bool finish_image(vlDict *dict, VL_UNUSED const vlMat4 *ctm, vlTextureDef *def) {
  float anisotropy = 8.0f;
  /* accepted and ignored: limit of pbrt's EWA filter */
  vl_dict_float(dict, "maxanisotropy", &anisotropy);
  if (!read_encoding(dict, def) || !vl_dict_done(dict))
    return false; /* a misspelt "filename" is reported first */
  if (dict->import->image_missing)
    return true;
  return def->path || vl_dict_fail(dict, "\"string filename\" is missing");
}

static bool finish_direction_mix(vlDict *dict, const vlMat4 *ctm, vlTextureDef *def) {
  double d[3], world[3];
  for (int i = 0; i < 3; i++)
    d[i] = (double)def->direction[i];
  vlParam *p = vl_dict_find(dict, "dir", ~0u);
  for (int i = 0; p && i < 3; i++)
    d[i] = p->exact[i];
  vl_mat4_vector(ctm, d, world);
  double length = vl_norm3(world);
  if (!(length > 0.0))
    return vl_dict_fail(dict, "\"dir\" is zero");
  for (int i = 0; i < 3; i++)
    def->direction[i] = (float)(world[i] / length);
  return true;
}

/* Rules that run after the row's parameters are read; null: none. */
typedef bool Rule(vlDict *dict, const vlMat4 *ctm, vlTextureDef *def);
static Rule *const rules[0 VL_TEXTURE_KINDS(VL_COUNT_KIND)] = {
    [VL_TEXTURE_IMAGE] = finish_image, [VL_TEXTURE_DIRECTION_MIX] = finish_direction_mix};

/* ---- textures ---------------------------------------------------------------------------- */

static bool read_texture(vlDict *dict, vlTextureDef *def, const vlPending *pending) {
  vlMat4 texture_from_world;
  const vlKindRow *row = dict->row;
  if (!vl_mat4_inverse(pending->ctm, &texture_from_world))
    return vl_dict_fail_at(dict, pending->source, "the current transform is singular");
  memcpy(def->texture_from_world, texture_from_world.m, sizeof def->texture_from_world);
  if (row->traits & (def->spectrum ? VL_TEXTURE_FLOAT_ONLY : VL_TEXTURE_COLOR_ONLY))
    return vl_dict_fail(dict, "this is a %s texture only",
                        def->spectrum ? "float" : "spectrum");
  return vl_import_parameters(dict, def, def->spectrum) &&
         (!vl_row_find(row, "mapping") || check_mapping(dict, def)) &&
         (!rules[def->kind] || rules[def->kind](dict, &pending->ctm, def)) &&
         vl_dict_done(dict);
}

/* The texture in place of an image that is missing: middle grey, or the number 1. */
static vlTextureDef stand_in(const vlTextureDef *image) {
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_CONSTANT, image->spectrum);
  def.name = image->name;
  def.source = image->source;
  def.spectrum_a = vl_spectrum_input(vl_spectrum_constant(0.5f));
  return def;
}

static bool finish(vlImport *import, vlPending *pending) {
  char what[160];
  snprintf(what, sizeof what, "Texture \"%s\" (%s)", vl_short_text(pending->name).text,
           vl_import_kind_text(&vl_texture_family, pending->kind).text);
  vlDict dict =
      vl_import_dict(import, what, pending->source, pending->space, &pending->params, NULL);
  vl_dict_set_kind(&dict, &vl_texture_family, vl_kind_find(&vl_texture_family, pending->kind));
  vlTextureDef def = vl_default_texture_def(
      dict.row ? (vlTextureKind)dict.kind : VL_TEXTURE_CONSTANT, pending->spectrum);
  def.name = pending->name;
  def.source = pending->source;
  if (!dict.row) { /* permissive: a constant replaces it: middle grey, or 1 */
    if (vl_text_is(pending->kind, "ptex")) {
      if (!vl_import_unsupported(
              import, pending->source,
              "texture \"ptex\": Ptex files are not supported (to convert: bake it into an "
              "image over uv, and name that by \"imagemap\")"))
        return false;
    } else if (!vl_import_unknown_kind(import, pending->source, &vl_texture_family,
                                       pending->kind)) {
      return false;
    }
    def.spectrum_a = vl_spectrum_input(vl_spectrum_constant(0.5f));
  } else {
    import->image_missing = false;
    if (!read_texture(&dict, &def, pending))
      return false;
    if (import->image_missing)
      def = stand_in(&def);
  }
  pending->id = vl_scene_add_texture(import->scene, &def).index;
  return pending->id != 0;
}

bool vl_import_finish_texture(vlImport *import, uint32_t index) {
  /* the array no longer grows */
  return vl_import_finish_once(import, &import->textures.items[index], finish,
                               "textures refer to each other");
}
