/* image/flip.c: see flip.h. Section numbers are the paper's. Two pipelines are combined at the
 * end: colour (contrast sensitivity filter, Hunt-adjusted L*a*b*, HyAB distance) and features
 * (edges and points of the luminance). */
#include "image/flip.h"

#include <string.h>

#include "base/free.h"
#include "image/pixel.h"
#include "math/approx.h"

enum { MAX_RADIUS = 32 };

typedef struct Kernel {
  int radius;
  float w[2 * MAX_RADIUS + 1];
} Kernel;

typedef struct Vec {
  float x, y, z;
} Vec;

/* Planes of width*height floats. */
typedef struct Flip {
  uint32_t width, height;
  float *color[2][3]; /* Y Cx Cz of both images; filtered in place */
  float *feature[2]; /* [0]: edges of the first image, later the larger feature difference; [1]:
                        points */
  float *work[3];
} Flip;

static const Vec WHITE = {0.950428545f, 1.0f, 1.088900371f}; /* D65, by the paper's matrix */

static Vec xyz_of_rgb(Vec c) {
  return (Vec){(float)(10135552.0 / 24577794.0) * c.x + (float)(8788810.0 / 24577794.0) * c.y +
                   (float)(4435075.0 / 24577794.0) * c.z,
               (float)(2613072.0 / 12288897.0) * c.x + (float)(8788810.0 / 12288897.0) * c.y +
                   (float)(887015.0 / 12288897.0) * c.z,
               (float)(1425312.0 / 73733382.0) * c.x + (float)(8788810.0 / 73733382.0) * c.y +
                   (float)(70074185.0 / 73733382.0) * c.z};
}
static Vec rgb_of_xyz(Vec c) { /* inverse of xyz_of_rgb */
  return (Vec){3.241003275f * c.x - 1.537398934f * c.y - 0.498615861f * c.z,
               -0.969224334f * c.x + 1.875930071f * c.y + 0.041554224f * c.z,
               0.055639423f * c.x - 0.204011202f * c.y + 1.057148933f * c.z};
}

/* Section 4.1.1: a linear opponent space: luminance and two colour differences. */
static Vec ycc_of_xyz(Vec c) {
  float x = c.x / WHITE.x, y = c.y / WHITE.y, z = c.z / WHITE.z;
  return (Vec){116.0f * y - 16.0f, 500.0f * (x - y), 200.0f * (y - z)};
}
static Vec xyz_of_ycc(Vec c) {
  float y = (c.x + 16.0f) / 116.0f;
  return (Vec){(c.y / 500.0f + y) * WHITE.x, y * WHITE.y, (y - c.z / 200.0f) * WHITE.z};
}

static float lab_curve(float t) {
  return t > 0.00885645168f ? vl_pow(t, 1.0f / 3.0f) : t * 7.78703704f + 0.137931034f;
}
/* Section 4.1.3: L*a*b* with Hunt's adjustment: colour differences are weaker at low
 * luminance. */
static Vec hunt_lab_of_xyz(Vec c) {
  float x = lab_curve(c.x / WHITE.x), y = lab_curve(c.y / WHITE.y),
        z = lab_curve(c.z / WHITE.z);
  float lightness = 116.0f * y - 16.0f;
  return (Vec){lightness, 0.01f * lightness * 500.0f * (x - y),
               0.01f * lightness * 200.0f * (y - z)};
}
static float hyab(Vec a, Vec b) {
  float l = a.x - b.x, da = a.y - b.y, db = a.z - b.z;
  return (l < 0.0f ? -l : l) + __builtin_sqrtf(da * da + db * db);
}

/* exp(x) in double by repeated squaring, for the weights of the kernels. */
static double weight_exp(double x) {
  double y = x / 1024.0, sum = 1.0;
  for (int k = 12; k >= 1; k--)
    sum = sum * y / k + 1.0;
  for (int i = 0; i < 10; i++)
    sum *= sum;
  return sum;
}

/* Gaussian exp(-pi^2 d^2 / b), d in degrees, normalised. Returns its sum before
 * normalisation. */
static double csf_kernel(Kernel *k, int radius, double b) {
  const double pi = 3.14159265358979324;
  double sum = 0.0, w[2 * MAX_RADIUS + 1];
  k->radius = radius;
  for (int i = -radius; i <= radius; i++) {
    double d = i / VL_FLIP_PIXELS_PER_DEGREE;
    sum += w[i + radius] = weight_exp(-pi * pi * d * d / b);
  }
  for (int i = 0; i <= 2 * radius; i++)
    k->w[i] = (float)(w[i] / sum);
  return sum;
}

/* Section 4.2: Gaussian of the feature width 0.082 degrees, its first derivative (edges) and
 * second derivative (points). Positive and negative weights each sum to one. */
static void feature_kernels(Kernel *smooth, Kernel *edge, Kernel *point) {
  double deviation = 0.5 * 0.082 * VL_FLIP_PIXELS_PER_DEGREE;
  int radius = (int)__builtin_ceil(3.0 * deviation);
  double sum = 0.0, edge_sum = 0.0, plus = 0.0, minus = 0.0;
  double g[2 * MAX_RADIUS + 1], p[2 * MAX_RADIUS + 1];
  smooth->radius = edge->radius = point->radius = radius;
  for (int i = -radius; i <= radius; i++) {
    double q = i * i / (deviation * deviation);
    g[i + radius] = weight_exp(-0.5 * q);
    p[i + radius] = (q - 1.0) * g[i + radius];
    sum += g[i + radius];
    if (i < 0)
      edge_sum += -i * g[i + radius];
    *(p[i + radius] > 0.0 ? &plus : &minus) += p[i + radius];
  }
  for (int i = -radius; i <= radius; i++) {
    smooth->w[i + radius] = (float)(g[i + radius] / sum);
    edge->w[i + radius] = (float)(-i * g[i + radius] / edge_sum);
    point->w[i + radius] = (float)(p[i + radius] / (p[i + radius] > 0.0 ? plus : -minus));
  }
}

/* Convolves along rows, then along columns; the border pixels repeat. from and to may be the
 * same plane, work is another. */
static void convolve(const Flip *f, const float *from, const Kernel *kx, const Kernel *ky,
                     float *work, float *to, float *padded) {
  uint32_t w = f->width, h = f->height;
  for (uint32_t y = 0; y < h; y++) {
    const float *row = from + (size_t)y * w;
    float *out = work + (size_t)y * w;
    for (int i = 0; i < kx->radius; i++) {
      padded[i] = row[0];
      padded[(size_t)kx->radius + w + (size_t)i] = row[w - 1];
    }
    memcpy(padded + kx->radius, row, w * sizeof *row);
    memset(out, 0, w * sizeof *out);
    for (int i = 0; i <= 2 * kx->radius; i++)
      for (uint32_t x = 0; x < w; x++)
        out[x] += kx->w[i] * padded[(size_t)x + (size_t)i];
  }
  for (uint32_t y = 0; y < h; y++) {
    float *out = to + (size_t)y * w;
    memset(out, 0, w * sizeof *out);
    for (int i = -ky->radius; i <= ky->radius; i++) {
      int64_t at = (int64_t)y + i;
      at = at < 0 ? 0 : at >= h ? (int64_t)h - 1 : at;
      const float *row = work + (size_t)at * w;
      float weight = ky->w[i + ky->radius];
      for (uint32_t x = 0; x < w; x++)
        out[x] += weight * row[x];
    }
  }
}

/* Section 4.1.2, table 1: contrast sensitivity of each channel as sums of Gaussians. */
static void color_filter(Flip *f, float *padded) {
  const double pi = 3.14159265358979324;
  int radius = (int)__builtin_ceil(3.0 * __builtin_sqrt(0.04 / (2.0 * pi * pi)) *
                                   VL_FLIP_PIXELS_PER_DEGREE);
  Kernel luminance, red_green, narrow, wide;
  csf_kernel(&luminance, radius, 0.0047);
  csf_kernel(&red_green, radius, 0.0053);
  double s1 = csf_kernel(&wide, radius, 0.04), s2 = csf_kernel(&narrow, radius, 0.025);
  double m1 = 34.1 * __builtin_sqrt(pi / 0.04) * s1 * s1,
         m2 = 13.5 * __builtin_sqrt(pi / 0.025) * s2 * s2;
  float share = (float)(m1 / (m1 + m2));
  size_t count = (size_t)f->width * f->height;
  for (int i = 0; i < 2; i++) {
    float **c = f->color[i];
    convolve(f, c[0], &luminance, &luminance, f->work[0], c[0], padded);
    convolve(f, c[1], &red_green, &red_green, f->work[0], c[1], padded);
    convolve(f, c[2], &wide, &wide, f->work[0], f->work[1], padded);
    convolve(f, c[2], &narrow, &narrow, f->work[0], c[2], padded);
    for (size_t k = 0; k < count; k++)
      c[2][k] = share * f->work[1][k] + (1.0f - share) * c[2][k];
  }
}

/* Strength of a feature: length of the vector of its responses along x and y. */
static void feature_strength(Flip *f, const float *luminance, const Kernel *shape,
                             const Kernel *smooth, float *out, float *padded) {
  size_t count = (size_t)f->width * f->height;
  convolve(f, luminance, shape, smooth, f->work[0], f->work[1], padded);
  convolve(f, luminance, smooth, shape, f->work[0], out, padded);
  for (size_t k = 0; k < count; k++)
    out[k] = __builtin_sqrtf(f->work[1][k] * f->work[1][k] + out[k] * out[k]);
}

/* Writes the larger of the edge and the point difference to feature[0]. */
static void feature_difference(Flip *f, float *padded) {
  Kernel smooth, edge, point;
  feature_kernels(&smooth, &edge, &point);
  size_t count = (size_t)f->width * f->height;
  for (int shape = 0; shape < 2; shape++) {
    const Kernel *k = shape ? &point : &edge;
    for (int i = 0; i < 2; i++) {
      for (size_t n = 0; n < count; n++)
        f->work[2][n] = (f->color[i][0][n] + 16.0f) / 116.0f;
      /* work: 0 rows, 1 along x, 2 luminance; for the second image, its strength finally
       * overwrites the luminance */
      feature_strength(f, f->work[2], k, &smooth, i ? f->work[2] : f->feature[1], padded);
    }
    for (size_t n = 0; n < count; n++) {
      float d = f->feature[1][n] - f->work[2][n];
      d = d < 0.0f ? -d : d;
      f->feature[0][n] = shape == 0 || d > f->feature[0][n] ? d : f->feature[0][n];
    }
  }
}

static Vec filtered_lab(const Flip *f, int i, size_t n) {
  Vec rgb =
      rgb_of_xyz(xyz_of_ycc((Vec){f->color[i][0][n], f->color[i][1][n], f->color[i][2][n]}));
  return hunt_lab_of_xyz(
      xyz_of_rgb((Vec){vl_clamp01(rgb.x), vl_clamp01(rgb.y), vl_clamp01(rgb.z)}));
}

/* Sections 4.1.3 and 4.3: combines both differences. */
static void combine(const Flip *f, float *flip) {
  const float qc = 0.7f, pc = 0.4f, pt = 0.95f;
  Vec green = hunt_lab_of_xyz(xyz_of_rgb((Vec){0.0f, 1.0f, 0.0f})),
      blue = hunt_lab_of_xyz(xyz_of_rgb((Vec){0.0f, 0.0f, 1.0f}));
  float max = vl_pow(hyab(green, blue), qc), knee = pc * max;
  size_t count = (size_t)f->width * f->height;
  for (size_t n = 0; n < count; n++) {
    float d = vl_pow(hyab(filtered_lab(f, 0, n), filtered_lab(f, 1, n)), qc);
    d = d < knee ? d * (pt / knee) : pt + (d - knee) / (max - knee) * (1.0f - pt);
    d = vl_clamp01(d);
    float feature = vl_clamp01(__builtin_sqrtf(f->feature[0][n] * 0.707106781186547524f));
    /* d = 0 gives 0, except when the feature difference is 1 */
    flip[n] = vl_pow(d, 1.0f - feature);
  }
}

vlResult vl_flip(vlContext *context, uint32_t width, uint32_t height, const float *a,
                 const float *b, float *flip) {
  Flip f = {.width = width, .height = height};
  size_t count = (size_t)width * height;
  if (count > SIZE_MAX / 64)
    return VL_ERROR_MEMORY;
  float *planes = vl_alloc_array(context, count, 11 * sizeof *planes);
  float *padded = vl_alloc_array(context, (size_t)width + 2 * MAX_RADIUS, sizeof *padded);
  if (!planes || !padded) {
    VL_FREE(context, planes, padded);
    return VL_ERROR_MEMORY;
  }
  for (int i = 0; i < 6; i++)
    f.color[i / 3][i % 3] = planes + count * (size_t)i;
  for (int i = 0; i < 2; i++)
    f.feature[i] = planes + count * (size_t)(6 + i);
  for (int i = 0; i < 3; i++)
    f.work[i] = planes + count * (size_t)(8 + i);
  for (int i = 0; i < 2; i++) {
    const float *from = i ? b : a;
    for (size_t n = 0; n < count; n++) {
      Vec c = ycc_of_xyz(xyz_of_rgb((Vec){vl_clamp01(from[3 * n]), vl_clamp01(from[3 * n + 1]),
                                          vl_clamp01(from[3 * n + 2])}));
      f.color[i][0][n] = c.x;
      f.color[i][1][n] = c.y;
      f.color[i][2][n] = c.z;
    }
  }
  /* before the filter: features are those of the unfiltered images */
  feature_difference(&f, padded);
  color_filter(&f, padded);
  combine(&f, flip);
  VL_FREE(context, planes, padded);
  return VL_OK;
}
