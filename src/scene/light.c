/* scene/light.c: adds emissions and lights: each def is checked, then copied. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/unset.h"
#include "color/color.h"
#include "math/transform.h"
#include "scene/family.h"
#include "schema/schema.h"
#include "velo/light.h"
#include "velo/texture.h"

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
  if (!vl_scene_may_add(scene, VL_SCENE_EMISSIONS, def))
    return none;
  vlEmissionDef d = *def;
  if (!vl_row_take(scene, vl_kind_row(&vl_emission_family, 0), &d, true, d.source, "emission"))
    return none;
  if (d.power < 0.0) {
    vl_scene_reject(scene, d.source, "emission", "power must not be negative");
    return none;
  }
  const Radiometric power = {&d.radiant_power, &d.power, d.power, "radiantpower", "power"};
  bool images = d.image || d.texture.index;
  if (!to_photometric(scene, &power, images ? NULL : &d.radiance, d.source, "emission"))
    return none;
  if (d.texture.index && scene->textures.items[d.texture.index - 1].kind != VL_TEXTURE_IMAGE) {
    vl_scene_reject(scene, d.source, "emission", "its texture must be an image");
    return none;
  }
  if (!vl_scene_copy_source(scene, &d.source))
    return none;
  return (vlEmissionId){vl_scene_push(scene, VL_SCENE_EMISSIONS, &d)};
}

/* A portal must be a rectangle and needs an image. Tolerances are pbrt's. */
static bool check_portal(vlScene *scene, const vlLightDef *d) {
  double sides[4][3], lengths[4];
  if (d->kind != VL_LIGHT_INFINITE || (!d->path && !d->image))
    return vl_scene_reject(scene, d->source, "light",
                           "a portal is for an infinite light with an image");
  for (int k = 0; k < 4; k++) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
      if (!isfinite(d->portal[k][i]))
        return vl_scene_reject(scene, d->source, "light", "portal is not finite");
      sides[k][i] = (double)d->portal[(k + 1) % 4][i] - d->portal[k][i];
      sum += sides[k][i] * sides[k][i];
    }
    lengths[k] = sqrt(sum);
    if (!(sum > 0))
      return vl_scene_reject(scene, d->source, "light",
                             "two corners of its portal are the same");
  }
  for (int k = 0; k < 4; k++) {
    double across = 0, opposite = 0;
    for (int i = 0; i < 3; i++) {
      across += sides[k][i] * sides[(k + 1) % 4][i] / (lengths[k] * lengths[(k + 1) % 4]);
      opposite += sides[k][i] * sides[(k + 2) % 4][i] / (lengths[k] * lengths[(k + 2) % 4]);
    }
    if (fabs(across) > 1e-3 || fabs(opposite + 1) > 1e-3)
      return vl_scene_reject(scene, d->source, "light",
                             "its portal is not a rectangle, corner after corner");
  }
  return true;
}

static bool check_light(vlScene *scene, const vlLightDef *d, const vlKindRow *row) {
  if (d->medium.index && !vl_scene_has(scene, VL_SCENE_MEDIA, d->medium.index))
    return vl_scene_reject(scene, d->source, "light", "there is no such medium");
  if (d->power < 0.0)
    return vl_scene_reject(scene, d->source, "light", "power must not be negative");
  if (d->illuminance < 0.0)
    return vl_scene_reject(scene, d->source, "light", "illuminance must not be negative");
  if (!vl_mat4_is_finite(vl_mat4_load(d->world_from_light)))
    return vl_scene_reject(scene, d->source, "light", "transform is not finite");
  bool same = d->from[0] == d->to[0] && d->from[1] == d->to[1] && d->from[2] == d->to[2];
  if ((row->traits & VL_LIGHT_TRAIT_AIMS) && same)
    return vl_scene_reject(scene, d->source, "light",
                           "from and to are the same point: it has no direction");
  if (!!d->path + !!d->image + !!d->lamp_data > 1)
    return vl_scene_reject(scene, d->source, "light", "has both a file name and an image");
  if ((row->traits & VL_LIGHT_TRAIT_IMAGE) && !d->path && !d->image && !d->lamp_data)
    return vl_scene_reject(scene, d->source, "light", "needs an image");
  return !d->has_portal || check_portal(scene, d);
}

vlLightId vl_scene_add_light(vlScene *scene, const vlLightDef *def) {
  const vlLightId none = {0};
  const vlKindRow *row = vl_scene_row_to_add(scene, VL_SCENE_LIGHTS, def);
  if (!row)
    return none;
  char what[80];
  snprintf(what, sizeof what, "%s light", row->name);
  if ((unsigned)def->space > VL_SPACE_ACES2065_1) {
    vl_scene_reject(scene, def->source, what, "unknown colour space");
    return none;
  }
  /* members that the kind does not use keep their defaults */
  vlLightDef d = vl_default_light_def(def->kind);
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
  return (vlLightId){vl_scene_push(scene, VL_SCENE_LIGHTS, &d)};
}
