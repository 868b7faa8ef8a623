/* scene/add.c: adds textures, materials, emissions and lights: each def is checked, then
 * copied. Ids refer only to objects added before, so textures and mixed materials cannot form a
 * cycle. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/cookie.h"
#include "base/unset.h"
#include "color/color.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "velo/edit.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/texture.h"

enum { MAX_OBJECTS = 0x7fffffff };

static bool is_finite_matrix(const double m[16]) {
  for (int i = 0; i < 16; i++)
    if (!isfinite(m[i]))
      return false;
  return true;
}

/* Whether one more object can be added. Reports the reason otherwise. */
static bool may_add(vlScene *scene, const void *def, bool cookie, size_t count, vlSource source,
                    const char *what) {
  if (scene->error.code != VL_OK)
    return false;
  if (!def || !cookie) {
    vl_scene_fail(scene, VL_ERROR_ARGUMENT, source, "%s: " VL_BAD_COOKIE, what);
    return false;
  }
  if (count >= MAX_OBJECTS)
    vl_scene_fail(scene, VL_ERROR_SCENE, source, "too many objects");
  return count < MAX_OBJECTS;
}

static bool bad(vlScene *scene, vlSource source, const char *what, const char *why) {
  vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s: %s", what, why);
  return false;
}

static bool out_of_memory(vlScene *scene) {
  vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
  return false;
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
  if (!is_finite_matrix(d->texture_from_world))
    return bad(scene, d->source, what, "transform is not finite");
  if (!all_finite(d->tint, 4) || !all_finite(d->st_from_uv, 6))
    return bad(scene, d->source, what, "a number is not finite");
  if (d->spectrum && (row->traits & VL_TEXTURE_FLOAT_ONLY))
    return bad(scene, d->source, what, "there is none of colours, only of floats");
  if (!d->spectrum && (row->traits & VL_TEXTURE_COLOR_ONLY))
    return bad(scene, d->source, what, "there is none of floats, only of colours");
  if ((unsigned)d->encoding > VL_ENCODING_GAMMA)
    return bad(scene, d->source, what, "unknown encoding");
  if (d->channel < -1 || d->channel > 3)
    return bad(scene, d->source, what, "its channels are 0 to 3");
  if (d->kind == VL_TEXTURE_IMAGE && !!d->path + !!d->image + !!d->data != 1)
    return bad(scene, d->source, what, "needs either a file name or an image");
  return true;
}

/* Members that the kind's row does not describe are not stored. */
static vlTextureId add_texture(vlScene *scene, const vlTextureDef *def, bool adopt) {
  const vlTextureId none = {0};
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_TEXTURE, scene->textures.count,
               (vlSource){0}, "texture"))
    return none;
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)def->kind);
  if (!row) {
    bad(scene, def->source, "texture", "unknown kind");
    return none;
  }
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
  vlTextureDef *slot = VL_PUSH(scene->context, &scene->textures);
  if (!slot) {
    out_of_memory(scene);
    return none;
  }
  *slot = d;
  return (vlTextureId){(uint32_t)scene->textures.count};
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
      return bad(scene, d->source, "mix material", "needs two materials");
    if (!vl_scene_has(scene, VL_SCENE_MATERIALS, index))
      return bad(scene, d->source, "mix material",
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
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_MATERIAL, scene->materials.count,
               (vlSource){0}, "material"))
    return none;
  const vlKindRow *row = vl_kind_row(&vl_material_family, (int)def->kind);
  if (!row) {
    bad(scene, def->source, "material", "unknown kind");
    return none;
  }
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
    bad(scene, def->source, what,
        "energy is conserved over a diffuse base only, under a medium of albedo 0 and "
        "untextured thickness");
    return none;
  }
  if (d.kind == VL_MATERIAL_MIX) {
    d.materials[0] = def->materials[0];
    d.materials[1] = def->materials[1];
  }
  vlMaterialDef *slot = VL_PUSH(scene->context, &scene->materials);
  if (!slot) {
    out_of_memory(scene);
    return none;
  }
  *slot = d;
  return (vlMaterialId){(uint32_t)scene->materials.count};
}

/* ---- light ------------------------------------------------------------------------------- */

/* A radiometric number of a light, and the photometric number that takes its place. */
typedef struct Radiometric {
  double *given; /* VL_UNSET afterwards */
  double *result;
  double rival; /* what must not be given, too; VL_UNSET: it is not */
  const char *name, *rival_name;
} Radiometric;

/* color: the light's only colour; null: it has those of an image. */
static bool to_photometric(vlScene *scene, const Radiometric *r, const vlSpectrum *color,
                           vlSource source, const char *what) {
  if (vl_is_unset(*r->given))
    return true;
  vlError error = {0};
  double result = color ? *r->given * vl_spectrum_per_watt(color, &error) : 0;
  if (!vl_is_unset(r->rival))
    vl_scene_fail(scene, VL_ERROR_SCENE, source, "%s: give either \"%s\" or \"%s\", not both",
                  what, r->name, r->rival_name);
  else if (!color)
    vl_scene_fail(scene, VL_ERROR_SCENE, source,
                  "%s: \"%s\" needs one spectrum; the pixels of an image have many", what,
                  r->name);
  else if (error.code != VL_OK)
    vl_scene_fail(scene, error.code, source, "%s: %s", what, error.message);
  else if (!(result > 0) || !isfinite(result))
    vl_scene_fail(scene, VL_ERROR_SCENE, source,
                  "%s: \"%s\" %g: its spectrum makes %g of it in lumens", what, r->name,
                  *r->given, result);
  *r->given = VL_UNSET;
  *r->result = result;
  return scene->error.code == VL_OK;
}

static bool light_to_photometric(vlScene *scene, vlLightDef *d, const char *what) {
  bool own_color = d->kind != VL_LIGHT_PROJECTION &&
                   (d->kind != VL_LIGHT_INFINITE || (!d->path && !d->image));
  const vlSpectrum *color = own_color ? &d->color : NULL;
  const Radiometric power = {&d->radiant_power, &d->power, d->power, "radiantpower", "power"};
  const Radiometric lux = {&d->irradiance, &d->illuminance, d->illuminance, "irradiance",
                           "illuminance"};
  if (!to_photometric(scene, &power, color, d->source, what) ||
      !to_photometric(scene, &lux, color, d->source, what))
    return false;
  double candela = 1;
  const Radiometric intensity = {&d->radiant_intensity, &candela, d->power, "radiantintensity",
                                 vl_is_unset(power.rival) ? "radiantpower" : "power"};
  if (!to_photometric(scene, &intensity, color, d->source, what))
    return false;
  d->scale = (float)((double)d->scale * candela);
  return true;
}

vlEmissionId vl_scene_add_emission(vlScene *scene, const vlEmissionDef *def) {
  const vlEmissionId none = {0};
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_EMISSION, scene->emissions.count,
               (vlSource){0}, "emission"))
    return none;
  vlEmissionDef d = *def;
  if (!vl_row_take(scene, vl_kind_row(&vl_emission_family, 0), &d, true, d.source, "emission"))
    return none;
  if (d.power < 0.0) {
    bad(scene, d.source, "emission", "power must not be negative");
    return none;
  }
  const Radiometric power = {&d.radiant_power, &d.power, d.power, "radiantpower", "power"};
  bool images = d.image || d.texture.index;
  if (!to_photometric(scene, &power, images ? NULL : &d.radiance, d.source, "emission"))
    return none;
  if (d.texture.index && scene->textures.items[d.texture.index - 1].kind != VL_TEXTURE_IMAGE) {
    bad(scene, d.source, "emission", "its texture must be an image");
    return none;
  }
  if (!vl_scene_copy_source(scene, &d.source))
    return none;
  vlEmissionDef *slot = VL_PUSH(scene->context, &scene->emissions);
  if (!slot) {
    out_of_memory(scene);
    return none;
  }
  *slot = d;
  return (vlEmissionId){(uint32_t)scene->emissions.count};
}

/* A portal must be a rectangle and needs an image. Tolerances are pbrt's. */
static bool check_portal(vlScene *scene, const vlLightDef *d) {
  double sides[4][3], lengths[4];
  if (d->kind != VL_LIGHT_INFINITE || (!d->path && !d->image))
    return bad(scene, d->source, "light", "a portal is for an infinite light with an image");
  for (int k = 0; k < 4; k++) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
      if (!isfinite(d->portal[k][i]))
        return bad(scene, d->source, "light", "portal is not finite");
      sides[k][i] = (double)d->portal[(k + 1) % 4][i] - d->portal[k][i];
      sum += sides[k][i] * sides[k][i];
    }
    lengths[k] = sqrt(sum);
    if (!(sum > 0))
      return bad(scene, d->source, "light", "two corners of its portal are the same");
  }
  for (int k = 0; k < 4; k++) {
    double across = 0, opposite = 0;
    for (int i = 0; i < 3; i++) {
      across += sides[k][i] * sides[(k + 1) % 4][i] / (lengths[k] * lengths[(k + 1) % 4]);
      opposite += sides[k][i] * sides[(k + 2) % 4][i] / (lengths[k] * lengths[(k + 2) % 4]);
    }
    if (fabs(across) > 1e-3 || fabs(opposite + 1) > 1e-3)
      return bad(scene, d->source, "light",
                 "its portal is not a rectangle, corner after corner");
  }
  return true;
}

static bool check_light(vlScene *scene, const vlLightDef *d, const vlKindRow *row) {
  if (d->medium.index && !vl_scene_has(scene, VL_SCENE_MEDIA, d->medium.index))
    return bad(scene, d->source, "light", "there is no such medium");
  if (d->power < 0.0)
    return bad(scene, d->source, "light", "power must not be negative");
  if (d->illuminance < 0.0)
    return bad(scene, d->source, "light", "illuminance must not be negative");
  if (!is_finite_matrix(d->world_from_light))
    return bad(scene, d->source, "light", "transform is not finite");
  bool same = d->from[0] == d->to[0] && d->from[1] == d->to[1] && d->from[2] == d->to[2];
  if ((row->traits & VL_LIGHT_TRAIT_AIMS) && same)
    return bad(scene, d->source, "light",
               "from and to are the same point: it has no direction");
  if (!!d->path + !!d->image + !!d->lamp_data > 1)
    return bad(scene, d->source, "light", "has both a file name and an image");
  if ((row->traits & VL_LIGHT_TRAIT_IMAGE) && !d->path && !d->image && !d->lamp_data)
    return bad(scene, d->source, "light", "needs an image");
  return !d->has_portal || check_portal(scene, d);
}

vlLightId vl_scene_add_light(vlScene *scene, const vlLightDef *def) {
  const vlLightId none = {0};
  if (!may_add(scene, def, def && def->cookie == VL_COOKIE_LIGHT, scene->lights.count,
               (vlSource){0}, "light"))
    return none;
  const vlKindRow *row = vl_kind_row(&vl_light_family, (int)def->kind);
  if (!row) {
    bad(scene, def->source, "light", "unknown kind");
    return none;
  }
  char what[80];
  snprintf(what, sizeof what, "%s light", row->name);
  if ((unsigned)def->space > VL_SPACE_ACES2065_1) {
    bad(scene, def->source, what, "unknown colour space");
    return none;
  }
  vlLightDef d = vl_default_light_def(
      def->kind); /* members that the kind does not use keep their defaults */
  vl_row_copy_members(row, def, &d);
  d.source = def->source;
  memcpy(d.world_from_light, def->world_from_light, sizeof d.world_from_light);
  d.medium = def->medium;
  d.space = def->space;
  d.has_portal = def->has_portal;
  memcpy(d.portal, def->portal, sizeof d.portal);
  if (vl_row_find(row, "filename"))
    d.image = def->image;
  if (!vl_row_take(scene, row, &d, true, d.source, what) || !check_light(scene, &d, row) ||
      !light_to_photometric(scene, &d, what) || !vl_scene_copy_source(scene, &d.source) ||
      !vl_scene_copy_image(scene, &d.image) ||
      !vl_scene_copy_block(scene, d.lamp_data, d.lamp_size, 1, &d.lamp_data))
    return none;
  vlLightDef *slot = VL_PUSH(scene->context, &scene->lights);
  if (!slot) {
    out_of_memory(scene);
    return none;
  }
  *slot = d;
  return (vlLightId){(uint32_t)scene->lights.count};
}
