/* schema/defaults.c: the vl_default_*_def functions of scenes and of an image's settings.
 * Defaults of scenes are pbrt-v4's, since pbrt files leave most parameters out. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "color/color.h"
#include "color/named.h"
#include "schema/schema.h"
#include "velo/filter_kinds.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/sampler.h"
#include "velo/texture.h"
#include "velo/tracer.h"

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
  vl_kind_set_defaults(&vl_texture_family, (int)kind, &def);
  memcpy(def.texture_from_world, identity, sizeof identity);
  return def;
}

vlLoadDef vl_default_load_def(void) {
  return (vlLoadDef){
      .cookie = VL_COOKIE_LOAD, .time = VL_UNSET, .time_close = VL_UNSET, .unit = VL_UNSET};
}

/* ---- the settings of an image ------------------------------------------------------------ */

vlBuildDef vl_default_build_def(void) {
  return (vlBuildDef){.cookie = VL_COOKIE_BUILD,
                      .color = VL_COLOR_SPECTRAL,
                      .light_sampler = VL_LIGHT_SAMPLER_BVH};
}

vlFilmDef vl_default_film_def(uint32_t width, uint32_t height) {
  return (vlFilmDef){.cookie = VL_COOKIE_FILM,
                     .width = width,
                     .height = height,
                     .crop = {0, 0, width, height},
                     .filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN),
                     .space = (vlColorSpace)0,
                     .max_component = INFINITY,
                     .lambda_min = VL_LAMBDA_MIN,
                     .lambda_max = VL_LAMBDA_MIN + VL_LAMBDA_COUNT - 1};
}

vlDevelopDef vl_default_develop_def(void) {
  return (vlDevelopDef){.cookie = VL_COOKIE_DEVELOP, .exposure = 1.0f};
}

vlRenderDef vl_default_render_def(void) {
  return (vlRenderDef){.cookie = VL_COOKIE_RENDER,
                       .tracer = VL_TRACER_PATH,
                       .sampler = VL_SAMPLER_ZSOBOL,
                       .spp = 16,
                       .max_depth = 5,
                       .ao_distance = INFINITY,
                       .merge_radius = VL_UNSET,
                       .light_paths = VL_AS_MANY_AS_PIXELS,
                       .noise_scale = 1.0f,
                       .share_samples = true,
                       .ao_cosine = true};
}
