/* import/pbrt/light.c: LightSource and AreaLightSource of pbrt-v4. This file stores scale,
 * power and illuminance; the world applies them. */
#include <string.h>

#include "color/color.h"
#include "image/image.h"
#include "import/pbrt/builder.h"
#include "velo/light.h"

/* Ignores a power or illuminance that is not positive, as in pbrt. */
static void drop_target(double *value) {
  if (!(*value > 0.0))
    *value = VL_UNSET;
}

/* The portal is in world space whatever the current transform is, as in pbrt. */
static bool read_portal(vlDict *dict, vlLightDef *def, const vlParam *portal) {
  size_t count = portal->floats.count;
  if (count != 12)
    return vl_dict_fail_at(dict, portal->source, "\"portal\" takes 4 points, found %zu numbers",
                           count);
  def->has_portal = true;
  for (int i = 0; i < 12; i++)
    def->portal[i / 3][i % 3] = portal->floats.items[i];
  return true;
}

/* Checks that the radiance has one source. */
static bool check_source(vlDict *dict) {
  if (!vl_row_find(dict->row, "L") || !vl_row_find(dict->row, "filename"))
    return true;
  vlParam *color = vl_dict_find(dict, "L", VL_BITS_SPECTRUM);
  vlParam *file = vl_dict_find(dict, "filename", VL_BIT_STRING);
  if (color && file && file->strings.items[0][0])
    return vl_dict_fail_at(dict, file->source, "give either \"L\" or \"filename\", not both");
  return vl_import_fine(dict->import);
}

/* Rules that the row does not express. */
static bool finish_light(vlDict *dict, vlLightDef *def) {
  vlImport *import = dict->import;
  const vlKindRow *row = dict->row;
  vlParam *portal =
      vl_row_find(row, "portal") ? vl_dict_find(dict, "portal", VL_BIT_POINT3) : NULL;
  bool far = row->traits & VL_LIGHT_TRAIT_FAR,
       has_color = vl_row_find(row, far ? "L" : "I") != NULL;
  bool color_given = has_color && vl_import_given(dict, far ? "L" : "I");
  if (has_color && !color_given)
    def->color.space = dict->space; /* default: the colour space's white */
  drop_target(&def->power);
  drop_target(&def->illuminance);
  if (portal && !read_portal(dict, def, portal))
    return false;
  if (!has_color && vl_dict_find(dict, "I", VL_BITS_SPECTRUM))
    vl_dict_warn(dict, "\"I\" has no effect, as in pbrt: the image is the intensity");
  if (!vl_dict_done(dict))
    return false;
  if ((row->traits & VL_LIGHT_TRAIT_IMAGE) && !def->path && !import->image_missing)
    return vl_dict_fail(dict, "\"string filename\" is missing");
  return true;
}

/* Makes an image of one pixel for a constant environment with a portal, since a portal needs an
 * image, as in pbrt. It names its colour space, so that files to which it is written do. */
static bool plain_sky(vlImport *import, const vlLightDef *def, vlImage **sky) {
  vlImageDef image = vl_default_image_def(1, 1, 3);
  vlError error = {0};
  float rgb[3];
  vlResult r = vl_spectrum_to_rgb(&def->color, VL_ROLE_ILLUMINANT, def->space, rgb, &error);
  if (r == VL_OK)
    r = vl_image_create(import->context, &image, sky);
  if (r != VL_OK)
    return vl_import_fail(import, r, def->source, "%s", error.message);
  memcpy(vl_image_pixels(*sky), rgb, sizeof rgb);
  if (def->space == VL_SPACE_SRGB || vl_image_set_space(*sky, def->space) == VL_OK)
    return true;
  vl_image_destroy(*sky);
  *sky = NULL;
  return vl_import_fail(import, VL_ERROR_MEMORY, def->source, "out of memory");
}

bool vl_import_light(vlImport *import, const vlStatement *s) {
  vlDict dict = vl_import_light_dict(import, "LightSource", &vl_light_family, s);
  const vlKindRow *row = dict.row;
  if (!row) /* permissive: skipped */
    return vl_import_unknown_kind(import, s->source, &vl_light_family, s->names[0]);
  vlLightDef def = vl_default_light_def((vlLightKind)dict.kind);
  vlMat4 ctm;
  import->image_missing = false;
  def.source = s->source;
  def.space = import->state.space;
  if (!vl_import_ctm(import, s->source, &ctm) || !check_source(&dict) ||
      !vl_import_parameters(&dict, &def, true) || !finish_light(&dict, &def))
    return false;
  if ((row->traits & VL_LIGHT_TRAIT_IMAGE) && !def.path)
    return true; /* permissive: skipped */
  memcpy(def.world_from_light, ctm.m, sizeof def.world_from_light);
  if (def.path)
    def.space = VL_SPACE_SRGB; /* as in pbrt, sRGB for an image without a colour space of its
                                  own, whatever the directive ColorSpace names */
  vlImage *sky = NULL;
  if (def.has_portal && !def.path && !plain_sky(import, &def, &sky))
    return false;
  def.image = sky;
  vlLightId id = vl_scene_add_light(import->scene, &def);
  vl_image_destroy(sky);
  return id.index != 0 && ((row->traits & VL_LIGHT_TRAIT_FAR) ||
                           vl_import_note_media(import, 'l', id.index - 1, s->source));
}

bool vl_import_area_light(vlImport *import, const vlStatement *s) {
  vlDict dict = vl_import_light_dict(import, "AreaLightSource", &vl_emission_family, s);
  import->state.emission = (vlEmissionId){0};
  if (s->names[0][0] == 0)
    return true; /* as in pbrt, an empty name ends the current area light */
  if (!dict.row)
    return vl_import_unknown_kind(import, s->source, &vl_emission_family, s->names[0]);
  vlEmissionDef def = vl_default_emission_def();
  def.source = s->source;
  if (!check_source(&dict) || !vl_import_parameters(&dict, &def, true) || !vl_dict_done(&dict))
    return false;
  if (!vl_import_given(&dict, "L"))
    def.radiance.space = dict.space; /* default: the colour space's white */
  drop_target(&def.power);
  import->state.emission = vl_scene_add_emission(import->scene, &def);
  return import->state.emission.index != 0;
}
