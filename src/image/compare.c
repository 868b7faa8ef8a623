/* image/compare.c: measures of the difference between an image and a reference. Sums run in a
 * fixed order. */
#include <math.h>

#include "base/error.h"
#include "base/free.h"
#include "image/flip.h"
#include "image/image.h"
#include "image/pixel.h"
#include "math/elementary.h"

/* Loads R, G and B of every pixel; an image with only Y gives Y three times. The caller checks
 * for values that are not finite. */
static vlResult load(const vlImage *image, float **rgb) {
  uint32_t channel[4], count = vl_image_color(image, channel);
  if (count < 3)
    channel[1] = channel[2] = channel[0];
  return vl_image_to_float(image, channel, 3, rgb);
}

static bool finite3(const float *v) {
  return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* Magma (van der Walt and Smith, CC0) by Matt Zucker's polynomials of degree 6 (CC0); t in [0,
 * 1]. */
static void magma(float t, uint8_t out[3]) {
  static const float C[3][7] = {{-0.002136485f, 0.251660541f, 8.353717279f, -27.668733086f,
                                 52.176139812f, -50.768525365f, 18.655705066f},
                                {-0.000749655f, 0.677523244f, -3.577719515f, 14.264730781f,
                                 -27.943606072f, 29.046582821f, -11.489773520f},
                                {-0.005386128f, 2.494026599f, 0.314467903f, -13.649213188f,
                                 12.944169442f, 4.234152994f, -5.601961509f}};
  for (int c = 0; c < 3; c++) {
    float v = C[c][6];
    for (int k = 5; k >= 0; k--)
      v = v * t + C[c][k];
    out[c] = vl_linear_to_unorm8(v);
  }
}

typedef struct Pair {
  const vlImage *image;
  float *a, *b;
  float *flip;
  uint8_t *skip; /* per pixel, 1: a value of either image is not finite */
  size_t count;
} Pair;

static void numbers(Pair *p, vlImageDiff *diff) {
  double squares = 0.0, relative = 0.0, light_a = 0.0, light_b = 0.0;
  uint64_t used = 0;
  static const double LUMINANCE[3] = {0.2126, 0.7152, 0.0722};
  for (size_t n = 0; n < p->count; n++) {
    float *a = p->a + 3 * n, *b = p->b + 3 * n;
    if (!finite3(a) || !finite3(b)) {
      diff->not_finite++;
      p->skip[n] = 1;
      for (int c = 0; c < 3; c++)
        /* FLIP filters over neighbouring pixels, so this pixel must not differ */
        a[c] = b[c] = 0.0f;
      continue;
    }
    used++;
    bool differs = false;
    for (int c = 0; c < 3; c++) {
      double d = (double)b[c] - a[c];
      squares += d * d;
      relative += d * d / ((double)a[c] * a[c] + 0.01);
      light_a += LUMINANCE[c] * a[c];
      light_b += LUMINANCE[c] * b[c];
      d = d < 0.0 ? -d : d;
      if (d > diff->max_abs)
        diff->max_abs = d;
      differs |= a[c] != b[c];
    }
    diff->differing += differs;
  }
  if (used) {
    diff->mse = squares / (3.0 * (double)used);
    diff->rel_mse = relative / (3.0 * (double)used);
  }
  diff->psnr = diff->mse > 0.0 ? -10.0 * vl_precise_log10(diff->mse) : INFINITY;
  diff->mean_ratio = light_a == light_b ? 1.0 : light_b / light_a;
}

static vlResult false_color(const Pair *p, vlImage **heat) {
  vlImageDef def = vl_default_image_def(p->image->width, p->image->height, 3);
  def.type = VL_PIXEL_U8;
  def.encoding = VL_ENCODING_SRGB;
  VL_TRY(vl_image_create(p->image->context, &def, heat));
  uint8_t *out = (*heat)->pixels;
  for (size_t n = 0; n < p->count; n++, out += 3) {
    magma(p->flip[n], out);
    if (p->skip[n]) { /* not finite: a green that is not in magma */
      out[0] = out[2] = 0;
      out[1] = 255;
    }
  }
  return VL_OK;
}

static vlResult compare(Pair *p, const vlImage *a, const vlImage *b, vlImageDiff *diff,
                        vlImage **heat) {
  vlContext *context = a->context;
  VL_TRY(load(a, &p->a));
  VL_TRY(load(b, &p->b));
  p->flip = vl_alloc_array(context, p->count, sizeof *p->flip);
  p->skip = vl_alloc_zero(context, p->count, 1);
  if (!p->flip || !p->skip)
    return VL_ERROR_MEMORY;
  numbers(p, diff);
  VL_TRY(vl_flip(context, a->width, a->height, p->a, p->b, p->flip));
  double sum = 0.0;
  for (size_t n = 0; n < p->count; n++)
    sum += p->skip[n] ? 0.0 : p->flip[n];
  if (p->count > diff->not_finite)
    diff->flip = sum / (double)(p->count - diff->not_finite);
  return heat ? false_color(p, heat) : VL_OK;
}

vlResult vl_image_compare(const vlImage *a, const vlImage *b, vlImageDiff *diff, vlImage **heat,
                          vlError *error) {
  if (heat)
    *heat = NULL;
  if (!a || !b || !diff)
    return vl_fail_argument(error, "image compare: a, b or diff is null");
  vl_error_clear(error);
  *diff = (vlImageDiff){0};
  if (a->width != b->width || a->height != b->height)
    return vl_fail_argument(error, "the images differ in size: %ux%u and %ux%u", a->width,
                            a->height, b->width, b->height);
  uint32_t channel[4];
  if (!vl_image_color(a, channel) || !vl_image_color(b, channel))
    return vl_fail_argument(error, "an image without channels R, G, B or Y cannot be compared");
  Pair p = {.image = a, .count = (size_t)a->width * a->height};
  vlResult result = compare(&p, a, b, diff, heat);
  vl_free(a->context, p.a);
  vl_free(b->context, p.b);
  VL_FREE(a->context, p.flip, p.skip);
  return result == VL_ERROR_MEMORY ? vl_fail_memory(error) : result;
}
