/* export/values.c: the scene's spectra, textures and roughnesses as the plain numbers of other
 * formats. */
#include <math.h>

#include "color/color.h"
#include "export/image.h"
#include "image/image.h"
#include "schema/schema.h"
#include "velo/material.h"

static void to_rgb(const vlSpectrum *s, vlSpectrumRole role, float rgb[3]) {
  if (s->kind == VL_SPECTRUM_RGB && s->space == VL_SPACE_SRGB) {
    for (int i = 0; i < 3; i++)
      rgb[i] = s->rgb[i] * s->scale;
    return;
  }
  if (s->kind == VL_SPECTRUM_CONSTANT && role != VL_ROLE_ILLUMINANT) {
    rgb[0] = rgb[1] = rgb[2] = s->value * s->scale;
    return;
  }
  if (vl_spectrum_to_rgb(s, role, VL_SPACE_SRGB, rgb, NULL) != VL_OK)
    rgb[0] = rgb[1] = rgb[2] = 0;
  for (int i = 0; i < 3; i++)
    rgb[i] = isfinite(rgb[i]) && rgb[i] > 0 ? rgb[i] : 0;
}

void vl_export_light_rgb(const vlSpectrum *s, float rgb[3]) {
  to_rgb(s, VL_ROLE_ILLUMINANT, rgb);
}

/* Whether a texture is computed, so that its mean stands in for it. */
static bool is_computed(const vlTextureDef *t) {
  return t && t->kind != VL_TEXTURE_IMAGE && t->kind != VL_TEXTURE_VERTEX_COLOR &&
         t->kind != VL_TEXTURE_CONSTANT;
}

/* The number of an input whose texture is not computed; of images it is their factor. t: the
 * texture; null: none. */
static float plain_number(const vlTextureDef *t, const vlFloatInput *input) {
  if (!t)
    return input->value;
  return t->kind == VL_TEXTURE_CONSTANT
             ? t->float_a.value
             : t->bias + t->scale * t->tint[t->channel < 0 ? 0 : t->channel];
}

static float mean_number(const vlExport *x, const vlFloatInput *input, int depth);

/* The mean share of the second input of a texture that has two. */
static float second_share(const vlExport *x, const vlTextureDef *t, int depth) {
  return t->kind == VL_TEXTURE_MIX ? mean_number(x, &t->amount, depth + 1) : 0.5f;
}

/* The approximate mean of a number; of noise 1/2. depth limits the nesting of textures. */
static float mean_number(const vlExport *x, const vlFloatInput *input, int depth) {
  const vlTextureDef *t = vl_scene_texture(x->scene, input->texture);
  if (depth > 8)
    return input->value;
  if (!is_computed(t))
    return plain_number(t, input);
  if (vl_kind_row(&vl_texture_family, (int)t->kind)->traits & VL_TEXTURE_FLOAT_ONLY)
    return 0.5f;
  const float a = mean_number(x, &t->float_a, depth + 1);
  if (t->kind == VL_TEXTURE_SCALE)
    return a * mean_number(x, &t->amount, depth + 1);
  const float b = mean_number(x, &t->float_b, depth + 1);
  if (t->kind == VL_TEXTURE_BILERP)
    return 0.25f * (a + b + mean_number(x, &t->float_c, depth + 1) +
                    mean_number(x, &t->float_d, depth + 1));
  const float share = second_share(x, t, depth);
  return (1 - share) * a + share * b;
}

/* The approximate mean of a texture that is not an image. depth limits the nesting of
 * textures. */
static void mean_rgb(const vlExport *x, const vlSpectrumInput *input, int depth, float rgb[3]) {
  const vlTextureDef *t = vl_scene_texture(x->scene, input->texture);
  float a[3], b[3], c[3], d[3];
  if (!t || depth > 8) {
    to_rgb(&input->value, VL_ROLE_ALBEDO, rgb);
  } else if (t->kind == VL_TEXTURE_IMAGE || t->kind == VL_TEXTURE_VERTEX_COLOR) {
    for (int i = 0; i < 3; i++) {
      const float factor = t->tint[i] * (t->kind == VL_TEXTURE_IMAGE ? t->scale : 1);
      rgb[i] = t->invert ? 1 - 0.5f * factor : factor; /* 1/2: a texel's, of those inverted */
    }
  } else if (t->kind == VL_TEXTURE_CONSTANT || t->kind == VL_TEXTURE_SCALE) {
    mean_rgb(x, &t->spectrum_a, depth + 1, rgb);
    for (int i = 0; i < 3 && t->kind == VL_TEXTURE_SCALE; i++)
      rgb[i] *= mean_number(x, &t->amount, depth + 1);
  } else if (t->kind == VL_TEXTURE_BILERP) {
    mean_rgb(x, &t->spectrum_a, depth + 1, a);
    mean_rgb(x, &t->spectrum_b, depth + 1, b);
    mean_rgb(x, &t->spectrum_c, depth + 1, c);
    mean_rgb(x, &t->spectrum_d, depth + 1, d);
    for (int i = 0; i < 3; i++)
      rgb[i] = 0.25f * (a[i] + b[i] + c[i] + d[i]);
  } else {
    mean_rgb(x, &t->spectrum_a, depth + 1, a);
    mean_rgb(x, &t->spectrum_b, depth + 1, b);
    const float share = second_share(x, t, depth);
    for (int i = 0; i < 3; i++)
      rgb[i] = (1 - share) * a[i] + share * b[i];
  }
}

void vl_export_rgb(vlExport *x, const vlSpectrumInput *input, float rgb[3]) {
  const vlTextureDef *t = vl_scene_texture(x->scene, input->texture);
  if (is_computed(t))
    vl_export_lose(x, "computed texture (checkerboard, mix, noise, ...): its mean stands in");
  mean_rgb(x, input, 0, rgb);
}

bool vl_export_is_white(vlExport *x, const vlSpectrumInput *input) {
  float rgb[3];
  vl_export_rgb(x, input, rgb);
  return !input->texture.index && rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1;
}

bool vl_export_is_on(const vlFloatInput *input) {
  return input->texture.index || input->value > 0;
}

float vl_export_number(vlExport *x, const vlFloatInput *input) {
  if (is_computed(vl_scene_texture(x->scene, input->texture)))
    vl_export_lose(x, "computed texture (checkerboard, mix, noise, ...): its mean stands in");
  return mean_number(x, input, 0);
}

float vl_export_mean_square(vlExport *x, const vlFloatInput *input) {
  const vlTextureDef *t = vl_export_texture(x, input->texture);
  const float value = vl_export_number(x, input);
  vlImage *own = NULL;
  const vlImage *from = t ? vl_export_pixels(x, t, &own) : NULL;
  if (!from)
    return value * value;
  uint32_t channel[4], have = vl_image_color(from, channel);
  float *row = vl_alloc_array(x->context, from->width, 4 * sizeof *row);
  double sum = 0;
  const uint32_t use = t->channel < 0                ? 0
                       : (uint32_t)t->channel < have ? (uint32_t)t->channel
                                                     : have - 1;
  for (uint32_t y = 0; row && y < from->height; y++) {
    vl_image_row_to_float(from, y, channel, have, row);
    for (size_t i = 0; i < from->width; i++) {
      const double v = (double)t->bias +
                       (double)t->scale * (double)t->tint[use] * (double)row[i * have + use];
      sum += v * v;
    }
  }
  const double mean =
      row ? sum / ((double)from->width * from->height) : (double)value * (double)value;
  vl_free(x->context, row);
  vl_image_destroy(own);
  return (float)mean;
}

float vl_export_eta(const vlSpectrum *eta) {
  float dense[VL_LAMBDA_COUNT];
  if (eta->kind == VL_SPECTRUM_CONSTANT)
    return eta->value * eta->scale;
  if (vl_spectrum_dense(eta, VL_ROLE_UNBOUNDED, dense, NULL) != VL_OK)
    return 1.5f;
  return vl_dense_at(dense, 589.3f);
}

void vl_export_metal_rgb(vlExport *x, const vlMaterialDef *m, float rgb[3]) {
  if (m->use_reflectance) {
    vl_export_rgb(x, &m->reflectance, rgb);
    return;
  }
  float eta[VL_LAMBDA_COUNT], k[VL_LAMBDA_COUNT], nm[VL_LAMBDA_COUNT];
  rgb[0] = rgb[1] = rgb[2] = 0.8f;
  if (vl_spectrum_dense(&m->eta.value, VL_ROLE_UNBOUNDED, eta, NULL) != VL_OK ||
      vl_spectrum_dense(&m->k.value, VL_ROLE_UNBOUNDED, k, NULL) != VL_OK)
    return;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    float e = eta[i], q = k[i] * k[i];
    nm[i] = 360.0f + (float)i;
    eta[i] = ((e - 1) * (e - 1) + q) / ((e + 1) * (e + 1) + q);
  }
  vlSpectrum s = vl_spectrum_constant(1);
  s.kind = VL_SPECTRUM_SAMPLED;
  s.count = VL_LAMBDA_COUNT;
  s.wavelengths = nm;
  s.values = eta;
  to_rgb(&s, VL_ROLE_ALBEDO, rgb);
}

float vl_export_alpha(vlExport *x, const vlMaterialDef *m, const vlFloatInput *roughness) {
  if (roughness->texture.index)
    vl_export_lose(x, "textured roughness: its largest value stands in");
  float v = vl_export_number(x, roughness);
  v = v > 0 ? v : 0;
  return m->remap_roughness ? sqrtf(v) : v;
}
