/* import/pbrt/lens.c: see lens.h. Aperture images and lens files become objects owned by the
 * scene. */
#include "import/pbrt/lens.h"

#include "base/text.h"
#include "image/image.h"
#include "velo/projection.h"

static bool scene_ok(const vlDict *dict) {
  return dict->import->scene->error.code == VL_OK;
}

static bool fail_with(vlDict *dict, vlSource source, vlResult code, const vlError *error) {
  if (code == VL_ERROR_MEMORY)
    return vl_import_fail_memory(dict->import);
  if (error->file[0] && error->line > 0) {
    vlSource there = {error->file, error->line, error->column};
    return vl_import_fail(dict->import, code, there, "%s", error->message);
  }
  return vl_import_fail(dict->import, code == VL_ERROR_ARGUMENT ? VL_ERROR_SCENE : code, source,
                        "%s: %s%s%s", dict->what, error->file[0] ? error->file : "",
                        error->file[0] ? ": " : "", error->message);
}

/* Makes an aperture from the mean of the image's red, green and blue, as in pbrt, or from its
 * first channel. */
static vlResult aperture_from_image(vlImport *import, const vlImage *image,
                                    vlAperture **aperture, vlError *error) {
  uint32_t w = vl_image_width(image), h = vl_image_height(image);
  int c[3] = {vl_image_find_channel(image, "R"), vl_image_find_channel(image, "G"),
              vl_image_find_channel(image, "B")};
  if (c[0] < 0 || c[1] < 0 || c[2] < 0)
    c[0] = c[1] = c[2] = 0;
  float *values = vl_alloc_array(import->context, (size_t)w * h, sizeof *values);
  if (!values)
    return VL_ERROR_MEMORY;
  for (uint32_t y = 0; y < h; y++)
    for (uint32_t x = 0; x < w; x++) {
      float sum = 0.0f;
      for (int k = 0; k < 3; k++)
        sum += vl_image_get(image, x, y, (uint32_t)c[k]);
      values[(size_t)y * w + x] = sum / 3.0f;
    }
  vlResult result = vl_aperture_create(import->context, w, h, values, aperture, error);
  vl_free(import->context, values);
  return result;
}

/* The aperture: a built-in name or an image file. "circle" and "circular" mean none. */
static bool read_aperture(vlDict *dict, const vlAperture **aperture) {
  static const char *const names[] = {"gaussian", "square", "pentagon", "star"};
  vlImport *import = dict->import;
  const char *name = "circle";
  vlParam *p = vl_dict_find(dict, "aperture", 1u << VL_PARAM_STRING);
  if (!vl_dict_string(dict, "aperture", &name) || vl_text_is(name, "circle") ||
      vl_text_is(name, "circular") || name[0] == 0)
    return scene_ok(dict);
  vlAperture **slot = VL_PUSH(import->context, &import->scene->apertures);
  if (!slot)
    return vl_import_fail_memory(import);
  vlError error = {0};
  vlResult result = VL_OK;
  bool named = false;
  for (int i = 0; i < 4; i++)
    named = named || vl_text_is(name, names[i]);
  if (named) {
    result = vl_aperture_create_named(import->context, name, slot, &error);
  } else {
    char path[4096];
    vlImage *image = NULL;
    if (!vl_import_path(import, p, path, sizeof path))
      return false;
    result = vl_image_read_named(import->context, NULL, path, &image, &error);
    if (result == VL_OK)
      result = aperture_from_image(import, image, slot, &error);
    vl_image_destroy(image);
  }
  if (result != VL_OK)
    return fail_with(dict, p->source, result, &error);
  *aperture = *slot;
  return true;
}

bool vl_import_lens(vlDict *dict, vlCameraDef *def) {
  vl_dict_floats(dict, "focuspixel", 2, def->lens.focus_pixel);
  return read_aperture(dict, &def->lens.aperture);
}

/* All defaults are pbrt's. */
bool vl_import_optics(vlDict *dict, vlCameraDef *def, double film_diagonal) {
  vlImport *import = dict->import;
  vlOpticsDef optics = vl_default_optics_def();
  const char *file = NULL;
  char path[4096];
  optics.aperture_diameter = 1.0;
  optics.film_diagonal = film_diagonal;
  vl_dict_double(dict, "aperturediameter", &optics.aperture_diameter);
  vl_dict_double(dict, "focusdistance", &optics.focus_distance);
  vlParam *p = vl_dict_find(dict, "lensfile", 1u << VL_PARAM_STRING);
  vl_dict_string(dict, "lensfile", &file);
  if (!scene_ok(dict))
    return false;
  if (!p)
    return vl_import_fail(import, VL_ERROR_SCENE, dict->source,
                          "%s: \"string lensfile\" is missing", dict->what);
  if (!vl_import_path(import, p, path, sizeof path) || !read_aperture(dict, &optics.aperture))
    return false;
  vlOptics **slot = VL_PUSH(import->context, &import->scene->optics);
  if (!slot)
    return vl_import_fail_memory(import);
  vlError error = {0};
  vlResult result = vl_optics_load(import->context, path, &optics, slot, &error);
  if (result != VL_OK)
    return fail_with(dict, p->source, result, &error);
  def->projection = VL_PROJECTION_OPTICS;
  def->lens.optics = *slot;
  return true;
}
