/* scene/add.c: adds textures and materials: each def is checked by its row, then copied. Has
 * what adding any def needs, too. Ids refer only to objects added before, so textures and
 * mixed materials cannot form a cycle. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "color/color.h"
#include "color/named.h"
#include "math/transform.h"
#include "scene/family.h"
#include "schema/schema.h"
#include "velo/material.h"
#include "velo/texture.h"

bool vl_scene_reject(vlScene *scene, vlSource source, const char *what, const char *why) {
  return vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s: %s", what, why);
}

/* ---- adding ------------------------------------------------------------------------------ */

enum { MAX_OBJECTS = 0x7fffffff };

bool vl_scene_may_add(vlScene *scene, vlSceneFamily family, const void *def) {
  const vlSceneRow *row = &vl_scene_rows[family];
  const vlSource nowhere = {0};
  if (scene->error.code != VL_OK)
    return false;
  if (!def || *(const uint32_t *)def != row->cookie) { /* the first member of each def */
    return vl_scene_fail(scene, VL_ERROR_ARGUMENT, nowhere, "%s: " VL_BAD_COOKIE, row->thing);
  }
  if (*vl_scene_count_of(scene, family) < MAX_OBJECTS)
    return true;
  return vl_scene_fail(scene, VL_ERROR_SCENE, nowhere, "too many objects");
}

const vlKindRow *vl_scene_row_to_add(vlScene *scene, vlSceneFamily family, const void *def) {
  if (!vl_scene_may_add(scene, family, def))
    return NULL;
  const vlKindRow *row = vl_scene_def_row(family, def);
  if (!row)
    vl_scene_reject(scene, vl_scene_def_source(family, def), vl_scene_rows[family].thing,
                    "unknown kind");
  return row;
}

uint32_t vl_scene_push(vlScene *scene, vlSceneFamily family, const void *def) {
  const vlSceneRow *row = &vl_scene_rows[family];
  size_t *count = vl_scene_count_of(scene, family);
  void *items = (char *)scene + row->items;
  void *capacity = (char *)scene + row->capacity;
  if (*count >= MAX_OBJECTS ||
      !vl_array_reserve(scene->context, items, capacity, *count, row->size, 1)) {
    vl_scene_fail_memory(scene);
    return 0;
  }
  ++*count;
  memcpy(vl_scene_at(scene, family, (uint32_t)*count), def, row->size);
  return (uint32_t)*count;
}

/* ---- what a row describes ---------------------------------------------------------------- */

static bool check_name(vlScene *scene, const char *name, vlSource source, const char *what) {
  const char *near;
  if (vl_named_spectrum_find(name, &near))
    return true;
  return vl_scene_fail(scene, VL_ERROR_SCENE, source,
                       near ? "%s: no spectrum is named \"%s\" (did you mean \"%s\"?)"
                            : "%s: no spectrum is named \"%s\"",
                       what, vl_argument_text(name).text, near);
}

static bool copy_spectrum(vlScene *scene, vlSpectrum *s, vlSource source, const char *what) {
  const char *bad = NULL;
  if (!isfinite(s->scale))
    bad = "scale is not finite";
  switch (s->kind) {
    case VL_SPECTRUM_CONSTANT:
      if (!isfinite(s->value))
        bad = "value is not finite";
      break;
    case VL_SPECTRUM_RGB:
      for (int i = 0; i < 3; i++)
        if (!isfinite(s->rgb[i]))
          bad = "rgb value is not finite";
      for (int i = 0; i < 3 && !bad; i++)
        if (s->rgb[i] < 0.0f)
          bad = "rgb value is negative";
      break;
    case VL_SPECTRUM_BLACKBODY:
      if (!(s->kelvin > 0.0f) || !isfinite(s->kelvin))
        bad = "blackbody temperature must be above 0 kelvin";
      break;
    case VL_SPECTRUM_SAMPLED:
      if (s->count == 0 || !s->wavelengths || !s->values)
        bad = "sampled spectrum has no samples";
      for (uint32_t i = 0; i < s->count && !bad; i++) {
        if (!isfinite(s->wavelengths[i]) || !isfinite(s->values[i]))
          bad = "sampled spectrum has a value that is not finite";
        else if (i && !(s->wavelengths[i] > s->wavelengths[i - 1]))
          bad = "wavelengths of the sampled spectrum are not ascending";
      }
      break;
    case VL_SPECTRUM_NAMED:
      if (!s->name)
        bad = "spectrum has no name";
      else if (!check_name(scene, s->name, source, what))
        return false;
      break;
    default:
      bad = "unknown kind of spectrum";
      break;
  }
  if (bad)
    return vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s: %s", what, bad);
  if (s->kind == VL_SPECTRUM_SAMPLED)
    return vl_scene_copy_block(scene, s->wavelengths, s->count, sizeof(float),
                               &s->wavelengths) &&
           vl_scene_copy_block(scene, s->values, s->count, sizeof(float), &s->values);
  s->wavelengths = s->values = NULL;
  s->count = 0;
  if (s->kind != VL_SPECTRUM_NAMED)
    s->name = NULL;
  return vl_scene_copy_string(scene, &s->name);
}

typedef struct Take {
  vlScene *scene;
  vlSource source;
  const char *what;
} Take;

static bool refuse(const Take *t, const vlParameter *p, const char *why) {
  return vl_scene_fail(t->scene, VL_ERROR_SCENE, t->source, "%s: parameter \"%s\" %s", t->what,
                       vl_parameter_label(p), why);
}

static bool refuse_number(const Take *t, const vlParameter *p, double number) {
  char name[200];
  char message[VL_GIVEN_MESSAGE];
  snprintf(name, sizeof name, "%s: parameter \"%s\"", t->what, vl_parameter_label(p));
  vl_parameter_complain(p, name, number, message);
  return vl_scene_fail(t->scene, VL_ERROR_SCENE, t->source, "%s", message);
}

static bool take_texture(const Take *t, const vlParameter *p, vlTextureId id, bool spectrum) {
  if (!id.index)
    return true;
  if (p->flags & VL_PARAMETER_NO_TEXTURE)
    return refuse(t, p, "cannot be textured");
  if (!vl_scene_has(t->scene, VL_SCENE_TEXTURES, id.index))
    return refuse(t, p, "names a texture that does not exist (add it first)");
  if (t->scene->textures.items[id.index - 1].spectrum == spectrum)
    return true;
  return refuse(t, p,
                spectrum ? "needs a spectrum texture, this is a float texture"
                         : "needs a float texture, this is a spectrum texture");
}

static bool take_spectrum(const Take *t, const vlParameter *p, vlSpectrum *s) {
  char what[160];
  snprintf(what, sizeof what, "%s: parameter \"%s\"", t->what, vl_parameter_label(p));
  if (!copy_spectrum(t->scene, s, t->source, what))
    return false;
  return !(p->flags & VL_PARAMETER_ONE_NUMBER) || s->kind == VL_SPECTRUM_CONSTANT ||
         refuse(t, p, "must be one number");
}

static bool take_spectrum_input(const Take *t, const vlParameter *p, vlSpectrumInput *input) {
  if (!take_texture(t, p, input->texture, true))
    return false;
  if (!input->texture.index)
    return take_spectrum(t, p, &input->value);
  input->value = vl_spectrum_constant(1.0f);
  return true;
}

/* What points at nothing needs no copy, and has no texture. */
static bool take_member(const Take *t, const vlParameter *p, void *at) {
  const vlParameterType type = p->type;
  if (type == VL_PARAMETER_STRING || type == VL_PARAMETER_FILE)
    return vl_scene_copy_string(t->scene, at);
  if (type == VL_PARAMETER_SPECTRUM)
    return take_spectrum(t, p, at);
  if (type == VL_PARAMETER_EITHER_INPUT || type == VL_PARAMETER_FLOAT_INPUT)
    return take_texture(t, p, ((vlFloatInput *)at)->texture, false);
  if (type == VL_PARAMETER_SPECTRUM_INPUT)
    return take_spectrum_input(t, p, at);
  return type != VL_PARAMETER_TEXTURE || take_texture(t, p, *(vlTextureId *)at, true);
}

static bool take_parameter(const Take *t, const vlParameter *p, char *def, bool spectrum) {
  if (p->type == VL_PARAMETER_EITHER_INPUT) { /* only the number or the spectrum is read; the
                                                 other is set to 0 */
    if (!spectrum) {
      *(vlSpectrumInput *)(void *)(def + p->second) = (vlSpectrumInput){0};
    } else {
      *(vlFloatInput *)(void *)(def + p->offset) = (vlFloatInput){0};
      return take_spectrum_input(t, p, (vlSpectrumInput *)(void *)(def + p->second));
    }
  } else if (p->second && !take_member(t, p, def + p->second)) {
    return false;
  }
  return take_member(t, p, def + p->offset);
}

bool vl_row_take(vlScene *scene, const vlKindRow *row, void *def, bool spectrum,
                 vlSource source, const char *what) {
  const Take t = {scene, source, what};
  double wrong;
  VL_EACH_PARAMETER(p, row) {
    if (p->flags & VL_PARAMETER_SHORTHAND)
      continue;
    if (!take_parameter(&t, p, def, spectrum))
      return false;
    if (!vl_parameter_fits(p, def, &wrong))
      return refuse_number(&t, p, wrong);
  }
  return true;
}

/* ---- textures ---------------------------------------------------------------------------- */

static bool all_finite(const float *numbers, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(numbers[i]))
      return false;
  return true;
}

/* Checks rules that the rows do not express. */
static bool check_texture_def(vlScene *scene, const vlTextureDef *d, const vlKindRow *row) {
  char what[64];
  snprintf(what, sizeof what, "%s texture", row->name ? row->name : "vertex colour");
  if (!vl_mat4_is_finite(vl_mat4_load(d->texture_from_world)))
    return vl_scene_reject(scene, d->source, what, "transform is not finite");
  if (!all_finite(d->tint, 4) || !all_finite(d->st_from_uv, 6))
    return vl_scene_reject(scene, d->source, what, "a number is not finite");
  if (d->spectrum && (row->traits & VL_TEXTURE_FLOAT_ONLY))
    return vl_scene_reject(scene, d->source, what, "there is none of colours, only of floats");
  if (!d->spectrum && (row->traits & VL_TEXTURE_COLOR_ONLY))
    return vl_scene_reject(scene, d->source, what, "there is none of floats, only of colours");
  if ((unsigned)d->encoding > VL_ENCODING_GAMMA)
    return vl_scene_reject(scene, d->source, what, "unknown encoding");
  if (d->channel < -1 || d->channel > 3)
    return vl_scene_reject(scene, d->source, what, "its channels are 0 to 3");
  if (d->kind == VL_TEXTURE_IMAGE && !!d->path + !!d->image + !!d->data != 1)
    return vl_scene_reject(scene, d->source, what, "needs either a file name or an image");
  return true;
}

/* Members that the kind's row does not describe are not stored. */
static vlTextureId add_texture(vlScene *scene, const vlTextureDef *def, bool adopt) {
  const vlTextureId none = {0};
  const vlKindRow *row = vl_scene_row_to_add(scene, VL_SCENE_TEXTURES, def);
  if (!row)
    return none;
  char what[64];
  snprintf(what, sizeof what, "%s texture", row->name ? row->name : "vertex colour");
  vlTextureDef d = vl_default_texture_def(def->kind, def->spectrum);
  d.name = def->name;
  d.source = def->source;
  vl_row_copy_members(row, def, &d);
  if (!vl_scene_copy_source(scene, &d.source) || !check_texture_def(scene, &d, row) ||
      !vl_row_take(scene, row, &d, d.spectrum, d.source, what) ||
      !vl_scene_copy_string(scene, &d.name))
    return none;
  if (!adopt && (!vl_scene_copy_image(scene, &d.image) ||
                 !vl_scene_copy_block(scene, d.data, d.data_size, 1, &d.data)))
    return none;
  return (vlTextureId){vl_scene_push(scene, VL_SCENE_TEXTURES, &d)};
}

vlTextureId vl_scene_add_texture(vlScene *scene, const vlTextureDef *def) {
  return add_texture(scene, def, false);
}

vlTextureId vl_scene_adopt_texture(vlScene *scene, const vlTextureDef *def) {
  return add_texture(scene, def, true);
}

/* ---- materials --------------------------------------------------------------------------- */

static bool check_mix(vlScene *scene, const vlMaterialDef *d) {
  for (int i = 0; i < 2; i++) {
    uint32_t index = d->materials[i].index;
    if (index == 0)
      return vl_scene_reject(scene, d->source, "mix material", "needs two materials");
    if (!vl_scene_has(scene, VL_SCENE_MATERIALS, index))
      return vl_scene_reject(scene, d->source, "mix material",
                             "there is no such material (add its parts first)");
  }
  return true;
}

bool vl_coat_in_closed_form(const vlMaterialDef *def) {
  const vlSpectrum *a = &def->albedo.value;
  float grey = 0;
  bool black =
      (vl_spectrum_is_constant(a, &grey) && grey == 0) ||
      (a->kind == VL_SPECTRUM_RGB && a->rgb[0] == 0 && a->rgb[1] == 0 && a->rgb[2] == 0);
  return def->kind == VL_MATERIAL_COATED_DIFFUSE && !def->albedo.texture.index && black &&
         !def->thickness.texture.index;
}

bool vl_principled_transmits(const vlMaterialDef *def) {
  const vlFloatInput *share = &def->principled.transmission;
  return def->kind == VL_MATERIAL_PRINCIPLED && (share->value > 0 || share->texture.index);
}

/* Members that the kind's row does not describe are not stored. */
vlMaterialId vl_scene_add_material(vlScene *scene, const vlMaterialDef *def) {
  const vlMaterialId none = {0};
  const vlKindRow *row = vl_scene_row_to_add(scene, VL_SCENE_MATERIALS, def);
  if (!row)
    return none;
  if (def->kind == VL_MATERIAL_MIX && !check_mix(scene, def))
    return none;
  char what[64];
  snprintf(what, sizeof what, "%s material", row->name);
  vlMaterialDef d = {.cookie = def->cookie,
                     .kind = def->kind,
                     .name = def->name,
                     .place = def->place,
                     .source = def->source};
  vl_row_copy_members(row, def, &d);
  if (!vl_scene_copy_source(scene, &d.source) ||
      !vl_row_take(scene, row, &d, true, def->source, what) ||
      !vl_scene_copy_string(scene, &d.name) || !vl_scene_copy_string(scene, &d.place))
    return none;
  if (d.conserve_energy && !vl_coat_in_closed_form(&d)) {
    vl_scene_reject(
        scene, def->source, what,
        "energy is conserved over a diffuse base only, under a medium of albedo 0 and "
        "untextured thickness");
    return none;
  }
  if (d.kind == VL_MATERIAL_MIX) {
    d.materials[0] = def->materials[0];
    d.materials[1] = def->materials[1];
  }
  return (vlMaterialId){vl_scene_push(scene, VL_SCENE_MATERIALS, &d)};
}
