/* scene/defaults.c: the vl_default_*_def of the scene: pbrt-v4's defaults, since its scene files are the ones that
 * leave most unsaid. */
#include <string.h>

#include "base/cookie.h"
#include "color/named.h"
#include "velo/scene.h"

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
  vlTextureDef def = {
      .cookie = VL_COOKIE_TEXTURE,
      .kind = kind,
      .spectrum = spectrum,
      .direction = {0, 1, 0},
      .dimension = 2,
      .octaves = 8,
      .omega = 0.5f,
      .variation = 0.2f,
      .wrap = VL_WRAP_REPEAT,
      .filter = VL_FILTER_BILINEAR,
      .encoding = VL_ENCODING_SRGB,
      .gamma = 2.2f,
      .scale = 1.0f,
      .tint = {1, 1, 1, 1},
      .channel = -1,
      .cutoff = VL_UNSET,
      .space = VL_SPACE_SRGB,
      .mapping = VL_MAPPING_UV,
      .su = 1.0f,
      .sv = 1.0f,
      .planar_v1 = {1, 0, 0},
      .planar_v2 = {0, 1, 0},
  };
  memcpy(def.texture_from_world, identity, sizeof identity);
  /* What the inputs hold when nothing is said: value 1; tex 1; tex1 0, tex2 1; tex1 1, tex2 0; v00 0, v01 1, v10 0,
   * v11 1. */
  float v[4] = {1, 1, 0, 0};
  if (kind == VL_TEXTURE_MIX || kind == VL_TEXTURE_DIRECTION_MIX) v[0] = 0, v[1] = 1;
  if (kind == VL_TEXTURE_CHECKERBOARD) v[0] = 1, v[1] = 0;
  if (kind == VL_TEXTURE_DOTS) v[0] = 0, v[1] = 1;
  if (kind == VL_TEXTURE_BILERP) v[0] = 0, v[1] = 1, v[2] = 0, v[3] = 1;
  vlFloatInput *floats[4] = {&def.float_a, &def.float_b, &def.float_c, &def.float_d};
  vlSpectrumInput *spectra[4] = {&def.spectrum_a, &def.spectrum_b, &def.spectrum_c, &def.spectrum_d};
  for (int i = 0; i < 4; i++) {
    *floats[i] = vl_float_input(v[i]);
    *spectra[i] = vl_spectrum_input(vl_spectrum_constant(v[i]));
  }
  def.amount = vl_float_input(kind == VL_TEXTURE_MIX ? 0.5f : 1.0f);
  return def;
}

static vlPrincipledDef principled(void) {
  vlSpectrumInput white = vl_spectrum_input(vl_spectrum_constant(1.0f));
  return (vlPrincipledDef){
      .metallic = vl_float_input(1.0f),
      .roughness = vl_float_input(1.0f),
      .specular = vl_float_input(1.0f),
      .specular_color = white,
      .thin_walled = true,
      .diffuse_transmission_color = white,
      .sheen_color = vl_spectrum_input(vl_spectrum_constant(0.0f)),
      .iridescence_ior = 1.3f,
      .iridescence_thickness = vl_float_input(400.0f),
      .normal_scale = 1.0f,
      .clearcoat_normal_scale = 1.0f,
  };
}

vlMaterialDef vl_default_material_def(vlMaterialKind kind) {
  vlMaterialDef def = {
      .cookie = VL_COOKIE_MATERIAL,
      .kind = kind,
      .reflectance = vl_spectrum_input(vl_spectrum_constant(0.5f)),
      .remap_roughness = true,
      .eta = vl_spectrum_input(vl_spectrum_constant(1.5f)),
      .k = vl_spectrum_input(vl_spectrum_constant(0.0f)),
      .thickness = vl_float_input(0.01f),
      .albedo = vl_spectrum_input(vl_spectrum_constant(0.0f)),
      .max_depth = 10,
      .samples = 1,
      .amount = vl_float_input(0.5f),
      .principled = principled(),
      .transmittance = vl_spectrum_input(vl_spectrum_constant(0.25f)),
      .scale = 1.0f,
      .coat_eta = vl_spectrum_input(vl_spectrum_constant(1.5f)),
      .hair = {.color = VL_HAIR_MELANIN,
               .sigma_a = vl_spectrum_input(vl_spectrum_constant(0.0f)),
               .eumelanin = vl_float_input(1.3f),
               .pheomelanin = vl_float_input(0.0f),
               .eta = vl_float_input(1.55f),
               .beta_m = vl_float_input(0.3f),
               .beta_n = vl_float_input(0.3f),
               .alpha = vl_float_input(2.0f)},
      .subsurface = {.sigma_a = vl_spectrum_input(vl_spectrum_rgb(0.0011f, 0.0024f, 0.014f)),
                     .sigma_s = vl_spectrum_input(vl_spectrum_rgb(2.55f, 3.21f, 3.77f)),
                     .mfp = vl_spectrum_input(vl_spectrum_constant(1.0f))},
  };
  if (kind == VL_MATERIAL_SUBSURFACE) def.eta = vl_spectrum_input(vl_spectrum_constant(1.33f));
  if (kind == VL_MATERIAL_DIFFUSE_TRANSMISSION) def.reflectance = vl_spectrum_input(vl_spectrum_constant(0.25f));
  if (kind == VL_MATERIAL_PRINCIPLED) def.reflectance = vl_spectrum_input(vl_spectrum_constant(1.0f));
  if (kind == VL_MATERIAL_CONDUCTOR || kind == VL_MATERIAL_COATED_CONDUCTOR) {
    def.eta = vl_spectrum_input(vl_spectrum_named("metal-Cu-eta"));
    def.k = vl_spectrum_input(vl_spectrum_named("metal-Cu-k"));
  }
  return def;
}

vlLoadDef vl_default_load_def(void) {
  return (vlLoadDef){.cookie = VL_COOKIE_LOAD, .time = VL_UNSET, .time_close = VL_UNSET};
}
