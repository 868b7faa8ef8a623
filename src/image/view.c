/* image/view.c: view transforms: conversion of linear light to display values. The input is
 * linear Rec.709 R G B, or Y; the result is 8-bit sRGB. Only arithmetic with fixed bits
 * (math/approx.h, tables) is used, so results are the same on every machine. */
#include "image/view.h"
#include "image/image.h"
#include "image/pixel.h"
#include "math/approx.h"

typedef struct Color {
  float r, g, b;
} Color;

static float largest(Color c) {
  float m = c.r > c.g ? c.r : c.g;
  return m > c.b ? m : c.b;
}
static float smallest(Color c) {
  float m = c.r < c.g ? c.r : c.g;
  return m < c.b ? m : c.b;
}

/* Khronos PBR Neutral tone mapper (KhronosGroup/ToneMapping, PBR_Neutral, specification of
 * 2024). It subtracts the Fresnel reflection of 0.04, compresses only above 0.8, and
 * desaturates compressed colours towards white. Result in [0, 1], linear. */
static Color khronos_neutral(Color c) {
  const float f90 = 0.04f, start = 0.8f - 0.04f, desaturation = 0.15f;
  float x = smallest(c);
  float offset = x <= 2.0f * f90 ? x - x * x / (4.0f * f90) : f90;
  c.r -= offset;
  c.g -= offset;
  c.b -= offset;
  float peak = largest(c);
  if (peak <= start)
    return c;
  float d = 1.0f - start, to = 1.0f - d * d / (peak + d - start), scale = to / peak;
  float g = 1.0f / (desaturation * (peak - to) + 1.0f);
  float white = to * (1.0f - g);
  return (Color){c.r * scale * g + white, c.g * scale * g + white, c.b * scale * g + white};
}

/* AgX (Troy Sobotka, github.com/sobotka/AgX) with Benjamin Wrensch's polynomial for the
 * contrast curve ("Minimal AgX Implementation", iolite-engine.com, 2023): inset matrix, 16.5
 * stops of log2 around middle grey, curve, outset matrix. The result is display-encoded. */
static float agx_curve(float v) {
  float stops = vl_ln(v > 1e-30f ? v : 1e-30f) * 1.44269504088896341f;
  float x = (stops + 12.47393f) / (4.026069f + 12.47393f);
  x = vl_clamp01(x);
  float x2 = x * x, x4 = x2 * x2;
  return 15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 +
         0.1191f * x - 0.00232f;
}

static Color agx(Color c) {
  float r = agx_curve(0.842479062253094f * c.r + 0.0784335999999992f * c.g +
                      0.0792237451477643f * c.b);
  float g = agx_curve(0.0423282422610123f * c.r + 0.878468636469772f * c.g +
                      0.0791661274605434f * c.b);
  float b = agx_curve(0.0423756549057051f * c.r + 0.0784336f * c.g + 0.879142973793104f * c.b);
  return (Color){1.19687900512017f * r - 0.0980208811401368f * g - 0.0990297440797205f * b,
                 -0.0528968517574562f * r + 1.15190312990417f * g - 0.0989611768448433f * b,
                 -0.0529716355144438f * r - 0.0980434501171241f * g + 1.15107367264116f * b};
}

static bool is_encoded(vlView view) {
  return view == VL_VIEW_AGX || view == VL_VIEW_RAW;
}

static Color tone_map(vlView view, Color c) {
  if (view != VL_VIEW_KHRONOS_NEUTRAL && view != VL_VIEW_AGX)
    return c;
  c.r = c.r > 0.0f ? c.r : 0.0f; /* both are defined for non-negative light */
  c.g = c.g > 0.0f ? c.g : 0.0f;
  c.b = c.b > 0.0f ? c.b : 0.0f;
  return view == VL_VIEW_AGX ? agx(c) : khronos_neutral(c);
}

/* The sRGB curve (IEC 61966-2-1) of a value in [0, 1]. */
static float srgb_curve(float x) {
  return x <= 0.0031308f ? 12.92f * x : 1.055f * vl_exp(vl_ln(x) * (1.0f / 2.4f)) - 0.055f;
}

void vl_view_display(vlView view, const float linear[3], float display[3]) {
  Color c = tone_map(view, (Color){linear[0], linear[1], linear[2]});
  const float values[3] = {vl_clamp01(c.r), vl_clamp01(c.g), vl_clamp01(c.b)};
  for (int i = 0; i < 3; i++)
    display[i] = is_encoded(view) ? values[i] : vl_clamp01(srgb_curve(values[i]));
}

static void to_bytes(vlView view, Color c, uint8_t out[3]) {
  bool encoded = is_encoded(view);
  c = tone_map(view, c);
  out[0] = encoded ? vl_linear_to_unorm8(c.r) : vl_linear_to_srgb8(c.r);
  out[1] = encoded ? vl_linear_to_unorm8(c.g) : vl_linear_to_srgb8(c.g);
  out[2] = encoded ? vl_linear_to_unorm8(c.b) : vl_linear_to_srgb8(c.b);
}

/* NaN and infinity become 0 and are counted. Values that only the exposure makes infinite are
 * clamped. */
static float finite_value(float v, float scale, uint64_t *bad) {
  if (!(v - v == 0.0f)) {
    ++*bad;
    return 0.0f;
  }
  float scaled = v * scale;
  return scaled < 1e30f ? scaled > -1e30f ? scaled : -1e30f : 1e30f;
}

vlResult vl_image_view(const vlImage *image, vlView view, float exposure, uint64_t *not_finite,
                       vlImage **result) {
  if (result)
    *result = NULL;
  if (!image || !result || (unsigned)view > VL_VIEW_RAW ||
      !(exposure > -200.0f && exposure < 200.0f))
    return VL_ERROR_ARGUMENT;
  uint32_t channel[4], count = vl_image_shown(image, channel);
  count = count >= 3 ? 3 : 1;
  vlImageDef def = vl_default_image_def(image->width, image->height, count);
  def.type = VL_PIXEL_U8;
  def.encoding = VL_ENCODING_SRGB;
  float *row = vl_alloc_array(image->context, image->width, count * sizeof *row);
  vlResult code = row ? vl_image_create(image->context, &def, result) : VL_ERROR_MEMORY;
  float scale = (float)vl_exp2_exact(exposure);
  scale = scale < 3e38f ? scale : 3e38f;
  uint64_t bad = 0;
  for (uint32_t y = 0; code == VL_OK && y < image->height; y++) {
    vl_image_row_to_float(image, y, channel, count, row);
    uint8_t *out = vl_image_row(*result, y);
    for (uint32_t x = 0; x < image->width; x++) {
      uint8_t bytes[3];
      const float *v = row + (size_t)x * count;
      float r = finite_value(v[0], scale, &bad);
      Color c = count == 1 ? (Color){r, r, r}
                           : (Color){r, finite_value(v[1], scale, &bad),
                                     finite_value(v[2], scale, &bad)};
      to_bytes(view, c, bytes);
      for (uint32_t k = 0; k < count; k++)
        out[(size_t)x * count + k] = bytes[k];
    }
  }
  vl_free(image->context, row);
  if (not_finite)
    *not_finite = bad;
  return code;
}
