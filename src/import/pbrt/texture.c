/* import/pbrt/texture.c: Texture entities to the scene, in the order in which they refer to each other. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/pbrt/builder.h"

static const char *const kinds[] = {"constant", "scale", "mix",      "directionmix", "bilerp", "checkerboard",
                                    "imagemap", "fbm",   "wrinkled", "windy",        "marble", "dots"};
static const vlTextureKind kind_values[] = {VL_TEXTURE_CONSTANT,      VL_TEXTURE_SCALE,  VL_TEXTURE_MIX,
                                            VL_TEXTURE_DIRECTION_MIX, VL_TEXTURE_BILERP, VL_TEXTURE_CHECKERBOARD,
                                            VL_TEXTURE_IMAGE,         VL_TEXTURE_FBM,    VL_TEXTURE_WRINKLED,
                                            VL_TEXTURE_WINDY,         VL_TEXTURE_MARBLE, VL_TEXTURE_DOTS};
enum { KINDS = sizeof kinds / sizeof *kinds };

bool vl_import_texture_id(vlImport *import, const char *name, bool spectrum, vlSource place, vlTextureId *id) {
  const vlNameTable *table = spectrum ? &import->spectrum_textures : &import->float_textures;
  const vlNameTable *other = spectrum ? &import->float_textures : &import->spectrum_textures;
  const char *type = spectrum ? "spectrum" : "float";
  uint32_t index;
  if (!vl_names_find(table, name, &index)) {
    if (vl_names_find(other, name, &index))
      return vl_import_fail(import, VL_ERROR_SCENE, place,
                            "texture \"%.80s\" is a %s texture; a %s texture is needed here", name,
                            spectrum ? "float" : "spectrum", type);
    const char *near = vl_names_nearest(table, name);
    if (near)
      return vl_import_fail(import, VL_ERROR_SCENE, place, "there is no %s texture \"%.80s\" (did you mean \"%s\"?)",
                            type, name, near);
    return vl_import_fail(import, VL_ERROR_SCENE, place, "there is no %s texture \"%.80s\"", type, name);
  }
  if (import->textures.items[index].state == VL_IN_PROGRESS)
    return vl_import_fail(import, VL_ERROR_SCENE, place, "texture \"%.80s\" refers to itself", name);
  if (!vl_import_finish_texture(import, index)) return false;
  id->index = import->textures.items[index].id;
  return true;
}

static bool read_mapping(vlDict *dict, vlTextureDef *def, const vlMat4 *texture_from_world, bool three) {
  static const char *const names[] = {"uv", "spherical", "cylindrical", "planar"};
  memcpy(def->texture_from_world, texture_from_world->m, sizeof def->texture_from_world);
  if (three) return true; /* cubes of texture space */
  int mapping = 0;
  double v[3];
  vl_dict_choice(dict, "mapping", names, 4, &mapping);
  def->mapping = (vlMapping)mapping;
  if (mapping == 0) {
    vl_dict_float(dict, "uscale", &def->su);
    vl_dict_float(dict, "vscale", &def->sv);
  }
  if (mapping == 0 || mapping == 3) {
    vl_dict_float(dict, "udelta", &def->du);
    vl_dict_float(dict, "vdelta", &def->dv);
  }
  if (mapping == 3 && vl_dict_vector(dict, "v1", VL_PARAM_VECTOR3, v))
    for (int i = 0; i < 3; i++) def->planar_v1[i] = (float)v[i];
  if (mapping == 3 && vl_dict_vector(dict, "v2", VL_PARAM_VECTOR3, v))
    for (int i = 0; i < 3; i++) def->planar_v2[i] = (float)v[i];
  return dict->import->scene->error.code == VL_OK;
}

/* "sRGB", "linear", "gamma 2.2" */
static bool read_encoding(vlDict *dict, vlTextureDef *def) {
  vlParam *p = vl_dict_find(dict, "encoding", 1u << VL_PARAM_STRING);
  if (!p) return true;
  const char *text = p->strings.items[0];
  def->encoding_given = true;
  if (strcmp(text, "sRGB") == 0 || strcmp(text, "srgb") == 0) {
    def->encoding = VL_ENCODING_SRGB;
  } else if (strcmp(text, "linear") == 0) {
    def->encoding = VL_ENCODING_LINEAR;
  } else if (sscanf(text, "gamma %f", &def->gamma) == 1 && def->gamma > 0.0f && isfinite(def->gamma)) {
    def->encoding = VL_ENCODING_GAMMA;
  } else {
    return vl_import_fail(dict->import, VL_ERROR_SCENE, p->place,
                          "%s: unknown encoding \"%.12s\" (known: sRGB, linear, gamma followed by a number)",
                          dict->what, text);
  }
  return true;
}

static bool read_image(vlDict *dict, vlTextureDef *def) {
  static const char *const wraps[] = {"repeat", "black", "clamp", "octahedralsphere"};
  static const char *const filters[] = {"point", "bilinear", "trilinear", "ewa", "EWA"};
  vlImport *import = dict->import;
  vlParam *p = vl_dict_find(dict, "filename", 1u << VL_PARAM_STRING);
  int wrap = VL_WRAP_REPEAT, filter = VL_FILTER_BILINEAR;
  float anisotropy = 8.0f;
  char path[4096];
  vl_dict_choice(dict, "wrap", wraps, 4, &wrap);
  vl_dict_choice(dict, "filter", filters, 5, &filter);
  vl_dict_float(dict, "maxanisotropy", &anisotropy); /* how far the ewa filter goes: velo chooses itself */
  vl_dict_float(dict, "scale", &def->scale);
  vl_dict_bool(dict, "invert", &def->invert);
  if (!read_encoding(dict, def) || import->scene->error.code != VL_OK) return false;
  def->wrap = (vlWrap)wrap;
  def->filter = filter > VL_FILTER_EWA ? VL_FILTER_EWA : (vlTextureFilter)filter;
  if (!vl_dict_done(dict)) return false; /* a misspelt "filename" is told as such */
  if (!p) return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"string filename\" is missing", dict->what);
  if (!vl_import_path(import, p, path, sizeof path)) return false;
  def->path = vl_import_keep(import, path);
  return def->path != NULL;
}

static bool read_inputs(vlDict *dict, vlTextureDef *def) {
  static const char *const names[][5] = {
      {"value"}, {"tex"}, {"tex1", "tex2"}, {"tex1", "tex2"}, {"v00", "v01", "v10", "v11"}, {"tex1", "tex2"}, {NULL},
      {NULL},    {NULL},  {NULL},           {NULL},           {"outside", "inside"}};
  vlFloatInput *floats[4] = {&def->float_a, &def->float_b, &def->float_c, &def->float_d};
  vlSpectrumInput *spectra[4] = {&def->spectrum_a, &def->spectrum_b, &def->spectrum_c, &def->spectrum_d};
  size_t kind = 0;
  while (kind_values[kind] != def->kind) kind++;
  for (int i = 0; names[kind][i]; i++) {
    bool fine = def->spectrum ? vl_import_spectrum_input(dict, names[kind][i], spectra[i], false, NULL)
                              : vl_import_float_input(dict, names[kind][i], floats[i], NULL);
    if (!fine) return false;
  }
  return true;
}

static bool read_noise(vlDict *dict, vlTextureDef *def, const vlMat4 *texture_from_world) {
  static const char *const types[] = {"float", "float", "float", "spectrum"};
  const char *type = types[def->kind - VL_TEXTURE_FBM];
  if (def->spectrum != (def->kind == VL_TEXTURE_MARBLE))
    return vl_import_fail(dict->import, VL_ERROR_SCENE, dict->place, "%s: this is a %s texture only", dict->what, type);
  uint32_t most = 64;
  if (def->kind != VL_TEXTURE_WINDY) {
    vl_dict_count(dict, "octaves", 0, &def->octaves);
    vl_dict_float(dict, "roughness", &def->omega);
  }
  if (def->kind == VL_TEXTURE_MARBLE) {
    vl_dict_float(dict, "scale", &def->scale);
    vl_dict_float(dict, "variation", &def->variation);
  }
  def->octaves = def->octaves < most ? def->octaves : most; /* finer ones are below any footprint */
  return read_mapping(dict, def, texture_from_world, true);
}

static bool read_texture(vlDict *dict, vlTextureDef *def, const vlPending *pending) {
  vlMat4 texture_from_world;
  if (!vl_mat4_inverse(pending->ctm, &texture_from_world))
    return vl_import_fail(dict->import, VL_ERROR_SCENE, pending->place, "%s: the current transform is singular",
                          dict->what);
  if (!read_inputs(dict, def)) return false;
  switch (def->kind) {
    case VL_TEXTURE_VERTEX_COLOR: /* not a texture of pbrt */
    case VL_TEXTURE_CONSTANT: break;
    case VL_TEXTURE_SCALE:
      if (!vl_import_float_input(dict, "scale", &def->amount, NULL)) return false;
      break;
    case VL_TEXTURE_MIX:
      if (!vl_import_float_input(dict, "amount", &def->amount, NULL)) return false;
      break;
    case VL_TEXTURE_DIRECTION_MIX: {
      double d[3] = {0, 1, 0}, world[3];
      vl_dict_vector(dict, "dir", VL_PARAM_VECTOR3, d);
      vl_mat4_vector(&pending->ctm, d, world);
      double length = sqrt(world[0] * world[0] + world[1] * world[1] + world[2] * world[2]);
      if (!(length > 0.0))
        return vl_import_fail(dict->import, VL_ERROR_SCENE, dict->place, "%s: \"dir\" is zero", dict->what);
      for (int i = 0; i < 3; i++) def->direction[i] = (float)(world[i] / length);
      break;
    }
    case VL_TEXTURE_FBM:
    case VL_TEXTURE_WRINKLED:
    case VL_TEXTURE_WINDY:
    case VL_TEXTURE_MARBLE:
      if (!read_noise(dict, def, &texture_from_world)) return false;
      break;
    case VL_TEXTURE_DOTS:
    case VL_TEXTURE_BILERP:
      if (!read_mapping(dict, def, &texture_from_world, false)) return false;
      break;
    case VL_TEXTURE_CHECKERBOARD: {
      int32_t dimension = 2;
      vlParam *p = vl_dict_find(dict, "dimension", 1u << VL_PARAM_INTEGER);
      vl_dict_integer(dict, "dimension", &dimension);
      if (dimension != 2 && dimension != 3)
        return vl_import_fail(dict->import, VL_ERROR_SCENE, p->place, "%s: \"dimension\" must be 2 or 3, it is %d",
                              dict->what, dimension);
      def->dimension = (uint32_t)dimension;
      if (!read_mapping(dict, def, &texture_from_world, dimension == 3)) return false;
      break;
    }
    case VL_TEXTURE_IMAGE:
      if (!read_mapping(dict, def, &texture_from_world, false) || !read_image(dict, def)) return false;
      break;
  }
  return vl_dict_done(dict);
}

static bool finish(vlImport *import, uint32_t index) {
  vlPending *pending = &import->textures.items[index]; /* the array does not grow any more */
  char what[128];
  snprintf(what, sizeof what, "Texture \"%.60s\" (%.40s)", pending->name, pending->kind);
  vlDict dict = vl_import_dict(import, what, pending->place, pending->space, &pending->params, NULL);
  int kind = -1;
  for (int i = 0; i < KINDS; i++)
    if (strcmp(pending->kind, kinds[i]) == 0) kind = i;
  vlTextureDef def = vl_default_texture_def(kind < 0 ? VL_TEXTURE_CONSTANT : kind_values[kind], pending->spectrum);
  def.name = pending->name;
  def.source = pending->place;
  def.space = def.kind == VL_TEXTURE_IMAGE ? VL_SPACE_SRGB : pending->space; /* images say their own, or are sRGB */
  if (kind < 0) { /* a constant stands in: middle grey, or one */
    if (strcmp(pending->kind, "ptex") == 0) {
      if (!vl_import_unsupported(import, pending->place, "texture \"ptex\": Ptex files are not supported"))
        return false;
    } else if (!vl_import_unknown(import, pending->place, "texture", pending->kind, kinds, KINDS, NULL, 0)) {
      return false;
    }
    def.spectrum_a = vl_spectrum_input(vl_spectrum_constant(0.5f));
  } else if (!read_texture(&dict, &def, pending)) {
    return false;
  }
  pending->id = vl_scene_add_texture(import->scene, &def).index;
  return pending->id != 0;
}

bool vl_import_finish_texture(vlImport *import, uint32_t index) {
  vlPending *pending = &import->textures.items[index];
  if (pending->state == VL_DONE) return true;
  if (++import->depth > VL_IMPORT_DEPTH)
    return vl_import_fail(import, VL_ERROR_SCENE, pending->place, "textures refer to each other more than %d deep",
                          VL_IMPORT_DEPTH);
  pending->state = VL_IN_PROGRESS;
  if (!finish(import, index)) return false;
  import->depth--;
  pending->state = VL_DONE;
  return true;
}
