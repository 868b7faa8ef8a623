/* scene/defaults.c: the vl_default_*_def functions of the scene. Defaults are pbrt-v4's, since pbrt files leave most
 * parameters out. */
#include <string.h>

#include "base/cookie.h"
#include "color/named.h"
#include "scene/schema/schema.h"

static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

vlSpectrum vl_spectrum_constant(float value) {
  return (vlSpectrum){.kind = VL_SPECTRUM_CONSTANT, .scale = 1.0f, .value = value};
}
vlSpectrum vl_spectrum_rgb(float r, float g, float b) {
  return (vlSpectrum){.kind = VL_SPECTRUM_RGB, .scale = 1.0f, .rgb = {r, g, b}};
}
vlSpectrum vl_spectrum_blackbody(float kelvin) {
  return (vlSpectrum){.kind = VL_SPECTRUM_BLACKBODY, .scale = 1.0f, .kelvin = kelvin};
}
vlSpectrum vl_spectrum_named(const char *name) {
  return (vlSpectrum){.kind = VL_SPECTRUM_NAMED, .scale = 1.0f, .name = name};
}
const char *vl_spectrum_name(uint32_t index) {
  return vl_named_spectrum_name(index);
}

vlFloatInput vl_float_input(float value) {
  return (vlFloatInput){{0}, value};
}
vlSpectrumInput vl_spectrum_input(vlSpectrum value) {
  return (vlSpectrumInput){{0}, value};
}

vlTextureDef vl_default_texture_def(vlTextureKind kind, bool spectrum) {
  vlTextureDef def = {.cookie = VL_COOKIE_TEXTURE,
                      .kind = kind,
                      .spectrum = spectrum,
                      .tint = {1, 1, 1, 1},
                      .channel = -1,
                      .cutoff = VL_UNSET};
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)kind);
  if (row) vl_row_set_defaults(row, &def);
  memcpy(def.texture_from_world, identity, sizeof identity);
  return def;
}

vlMaterialDef vl_default_material_def(vlMaterialKind kind) {
  vlMaterialDef def = {.cookie = VL_COOKIE_MATERIAL, .kind = kind};
  const vlKindRow *row = vl_kind_row(&vl_material_family, (int)kind);
  if (row) vl_row_set_defaults(row, &def);
  return def;
}

vlLoadDef vl_default_load_def(void) {
  return (vlLoadDef){.cookie = VL_COOKIE_LOAD, .time = VL_UNSET, .time_close = VL_UNSET};
}
