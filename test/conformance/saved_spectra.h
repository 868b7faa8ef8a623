/* conformance/saved_spectra.h: a law of writers of scenes: a spectrum and its scale are one
 * description of a colour: the same colour with another scale gives the same file. */
#ifndef TEST_CONFORMANCE_SAVED_SPECTRA_H
#define TEST_CONFORMANCE_SAVED_SPECTRA_H

#include "conformance.h"
#include "hostile.h"
#include "unit.h"
#include "velo/export.h"

enum { SAVED = 1 << 19 };
typedef struct Saved {
  char bytes[SAVED];
  size_t size;
} Saved;

/* The first value of the spectrum, or of the input with one; null: it has none. */
static vlSpectrum *spectrum_of(const vlParameter *p, AnyDef *def) {
  char *at = (char *)def + p->offset;
  if (p->type == VL_PARAMETER_SPECTRUM)
    return (vlSpectrum *)(void *)at;
  return p->type == VL_PARAMETER_SPECTRUM_INPUT ? &((vlSpectrumInput *)(void *)at)->value
                                                : NULL;
}

/* The file of a square with the material, or in the light. False: it cannot be written. */
static bool save_def(const char *family, AnyDef *def, const char *suffix, Saved *saved) {
  char path[100];
  vlError error = {0};
  vlMaterialDef grey = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  const bool material = strcmp(family, "materials") == 0;
  vlScene *scene = need_scene(HEAD "WorldBegin");
  add_square(scene, material ? &def->material : &grey);
  if (strcmp(family, "lights") == 0)
    vl_scene_add_light(scene, &def->light);
  snprintf(path, sizeof path, "%s/saved.%s", folder, suffix);
  const bool done = vl_scene_result(scene, &error) == VL_OK &&
                    vl_scene_save(scene, path, NULL, &error) == VL_OK;
  vl_scene_destroy(scene);
  FILE *file = done ? fopen(path, "rb") : NULL;
  saved->size = file ? fread(saved->bytes, 1, SAVED, file) : 0;
  return file && fclose(file) == 0 && saved->size > 0 && saved->size < SAVED;
}

static void check_saved_spectrum(const vlKindFamily *family, int kind, const vlParameter *p,
                                 bool rgb, const char *suffix) {
  static Saved saved[2];
  for (int i = 0; i < 2; i++) {
    const float scale = i ? 0.5f : 1.0f;
    AnyDef def;
    usual_def(family->name, kind, &def);
    vlSpectrum *spectrum = spectrum_of(p, &def);
    if (!spectrum)
      return;
    *spectrum = rgb ? vl_spectrum_rgb(0.3f / scale, 0.2f / scale, 0.4f / scale)
                    : vl_spectrum_constant(0.3f / scale);
    spectrum->scale = scale;
    if (!save_def(family->name, &def, suffix, &saved[i]))
      return;
  }
  if (saved[0].size != saved[1].size ||
      memcmp(saved[0].bytes, saved[1].bytes, saved[0].size) != 0)
    broken(family->name, family->words[kind],
           "\"%s\": as .%s a %s of half the values and twice the scale is another colour",
           p->member, suffix, rgb ? "colour" : "constant spectrum");
}

static void spectra_of_files(void **state) {
  (void)state;
  static const char *const of_defs[] = {"materials", "lights"};
  for (size_t f = 0; f < sizeof of_defs / sizeof *of_defs; f++) {
    const vlKindFamily *family = vl_kind_family_find(of_defs[f]);
    for (uint32_t i = 0; i < family->kind_count; i++)
      for (uint32_t k = 0; k < family->rows[i]->parameter_count; k++)
        for (int way = 0; way < 4; way++)
          check_saved_spectrum(family, (int)i, &family->rows[i]->parameters[k], way & 1,
                               way & 2 ? "pbrt" : "glb");
  }
  expect_no_failures();
}

#endif
