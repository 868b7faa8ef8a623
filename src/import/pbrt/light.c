/* import/pbrt/light.c: LightSource and AreaLightSource, as pbrt-v4 means them; what scale, power and illuminance do to
 * the light itself is the world's business. */
#include <stdio.h>
#include <string.h>

#include "color/color.h"
#include "import/pbrt/builder.h"

static const double degrees = 0.017453292519943295;

static void read_points(vlDict *dict, vlLightDef *def, bool aims) {
  double v[3];
  if (vl_dict_vector(dict, "from", VL_PARAM_POINT3, v))
    for (int i = 0; i < 3; i++) def->from[i] = (float)v[i];
  if (aims && vl_dict_vector(dict, "to", VL_PARAM_POINT3, v))
    for (int i = 0; i < 3; i++) def->to[i] = (float)v[i];
}

/* pbrt: a value that is not above zero counts as not given. */
static void read_target(vlDict *dict, const char *name, double *value) {
  double v;
  if (vl_dict_double(dict, name, &v) && v > 0.0) *value = v;
}

/* In the world's space, whatever the current transform: as pbrt. */
static bool read_portal(vlDict *dict, vlLightDef *def, const vlParam *portal) {
  vlImport *import = dict->import;
  size_t count = portal->floats.count;
  if (count != 12)
    return vl_import_fail(import, VL_ERROR_SCENE, portal->place, "%s: \"portal\" takes 4 points, found %zu numbers",
                          dict->what, count);
  def->has_portal = true;
  for (int i = 0; i < 12; i++) def->portal[i / 3][i % 3] = portal->floats.items[i];
  return true;
}

static bool read_infinite(vlDict *dict, vlLightDef *def, bool has_color) {
  vlImport *import = dict->import;
  vlParam *file = vl_dict_find(dict, "filename", 1u << VL_PARAM_STRING);
  vlParam *portal = vl_dict_find(dict, "portal", 1u << VL_PARAM_POINT3);
  read_target(dict, "illuminance", &def->illuminance);
  if (portal && !read_portal(dict, def, portal)) return false;
  if (!file) return true;
  if (has_color)
    return vl_import_fail(import, VL_ERROR_SCENE, file->place, "%s: give either \"L\" or \"filename\", not both",
                          dict->what);
  char path[4096];
  if (!vl_dict_done(dict) || !vl_import_path(import, file, path, sizeof path)) return false;
  def->path = vl_import_keep(import, path);
  return def->path != NULL;
}

/* Goniometric and projection lights stand at the origin of their space, and need an image. */
static bool read_goniometric(vlDict *dict, vlLightDef *def) {
  vlImport *import = dict->import;
  vlParam *file = vl_dict_find(dict, "filename", 1u << VL_PARAM_STRING);
  double fov = 90.0;
  read_target(dict, "power", &def->power);
  if (def->kind == VL_LIGHT_PROJECTION && vl_dict_find(dict, "I", VL_BITS_SPECTRUM))
    vl_import_warn(import, VL_LOG_WARNING, dict->place,
                   "%s: \"I\" has no effect, as in pbrt: the image is the intensity", dict->what);
  if (def->kind == VL_LIGHT_PROJECTION && vl_dict_double(dict, "fov", &fov)) def->fov = (float)(fov * degrees);
  if (!vl_dict_done(dict)) return false;
  if (!file)
    return vl_import_fail(import, VL_ERROR_SCENE, dict->place, "%s: \"string filename\" is missing", dict->what);
  char path[4096];
  if (!vl_import_path(import, file, path, sizeof path)) return false;
  def->path = vl_import_keep(import, path);
  return def->path != NULL;
}

static bool read_light(vlDict *dict, vlLightDef *def) {
  bool given = false;
  bool intensity = def->kind == VL_LIGHT_POINT || def->kind == VL_LIGHT_SPOT || def->kind == VL_LIGHT_GONIOMETRIC;
  if (def->kind != VL_LIGHT_PROJECTION && !vl_import_light_spectrum(dict, intensity ? "I" : "L", &def->color, &given))
    return false;
  vl_dict_float(dict, "scale", &def->scale);
  switch (def->kind) {
    case VL_LIGHT_POINT:
      read_points(dict, def, false);
      read_target(dict, "power", &def->power);
      break;
    case VL_LIGHT_SPOT: {
      double angle = 30.0, delta = 5.0;
      read_points(dict, def, true);
      read_target(dict, "power", &def->power);
      vl_dict_double(dict, "coneangle", &angle);
      vl_dict_double(dict, "conedeltaangle", &delta);
      def->cone_angle = (float)(angle * degrees);
      def->cone_delta = (float)(delta * degrees);
      break;
    }
    case VL_LIGHT_DISTANT:
      read_points(dict, def, true);
      read_target(dict, "illuminance", &def->illuminance);
      break;
    case VL_LIGHT_INFINITE:
      if (!read_infinite(dict, def, given)) return false;
      break;
    case VL_LIGHT_GONIOMETRIC:
    case VL_LIGHT_PROJECTION: return read_goniometric(dict, def);
  }
  return vl_dict_done(dict);
}

/* Portals are for images: of a sky that is one colour, one of one pixel (as pbrt does). */
static bool plain_sky(vlImport *import, const vlLightDef *def, vlImage **sky) {
  vlImageDef image = vl_default_image_def(1, 1, 3);
  vlError error = {0};
  float rgb[3];
  vlResult r = vl_spectrum_to_rgb(&def->color, VL_ROLE_ILLUMINANT, def->space, rgb, &error);
  if (r == VL_OK) r = vl_image_create(import->context, &image, sky);
  if (r != VL_OK) return vl_import_fail(import, r, def->source, "%s", error.message);
  memcpy(vl_image_pixels(*sky), rgb, sizeof rgb);
  return true;
}

bool vl_import_light(vlImport *import, const vlStatement *s) {
  static const char *const kinds[] = {"point", "spot", "distant", "infinite", "goniometric", "projection"};
  char what[96];
  snprintf(what, sizeof what, "LightSource \"%.60s\"", s->names[0]);
  vlDict dict = vl_import_dict(import, what, s->place, import->state.space, s->params,
                               vl_import_attributes(import, VL_ATTR_LIGHT));
  int kind = -1;
  for (int i = 0; i < 6; i++)
    if (strcmp(s->names[0], kinds[i]) == 0) kind = i;
  if (kind < 0)
    return vl_import_unknown(import, s->place, "light", s->names[0], kinds, 6, NULL, 0); /* permissive: left out */
  vlLightDef def = vl_default_light_def((vlLightKind)kind);
  vlMat4 ctm;
  def.source = s->place;
  def.space = import->state.space;
  if (!vl_import_ctm(import, s->place, &ctm) || !read_light(&dict, &def)) return false;
  memcpy(def.world_from_light, ctm.m, sizeof def.world_from_light);
  if (def.path) def.space = VL_SPACE_SRGB; /* an image that does not say its own: whatever ColorSpace says, as pbrt */
  vlImage *sky = NULL;
  if (def.has_portal && !def.path && !plain_sky(import, &def, &sky)) return false;
  def.image = sky;
  vlLightId id = vl_scene_add_light(import->scene, &def);
  vl_image_destroy(sky);
  return id.index != 0 && (kind == VL_LIGHT_DISTANT || kind == VL_LIGHT_INFINITE ||
                           vl_import_note_media(import, 'l', id.index - 1, s->place));
}

bool vl_import_area_light(vlImport *import, const vlStatement *s) {
  static const char *const kinds[] = {"diffuse"};
  char what[96];
  snprintf(what, sizeof what, "AreaLightSource \"%.60s\"", s->names[0]);
  vlDict dict = vl_import_dict(import, what, s->place, import->state.space, s->params,
                               vl_import_attributes(import, VL_ATTR_LIGHT));
  import->state.emission = (vlEmissionId){0};
  if (s->names[0][0] == 0) return true; /* pbrt: no area light from here on */
  if (strcmp(s->names[0], "diffuse") != 0)
    return vl_import_unknown(import, s->place, "area light", s->names[0], kinds, 1, NULL, 0);
  vlEmissionDef def = vl_default_emission_def();
  def.source = s->place;
  bool given;
  if (!vl_import_light_spectrum(&dict, "L", &def.radiance, &given)) return false;
  vl_dict_float(&dict, "scale", &def.scale);
  vl_dict_bool(&dict, "twosided", &def.two_sided);
  read_target(&dict, "power", &def.power);
  vlParam *file = vl_dict_find(&dict, "filename", 1u << VL_PARAM_STRING);
  if (!vl_dict_done(&dict)) return false;
  if (file && given)
    return vl_import_fail(import, VL_ERROR_SCENE, file->place, "%s: give either \"L\" or \"filename\", not both", what);
  char path[4096];
  if (file && !vl_import_path(import, file, path, sizeof path)) return false;
  if (file) def.image = path;
  import->state.emission = vl_scene_add_emission(import->scene, &def);
  return import->state.emission.index != 0;
}
