/* texture/lookup.h: filtered image lookup at one point, of textures and lights. The functions
 * are inline and take values. pbrt book 10.4. */
#ifndef TEXTURE_LOOKUP_H
#define TEXTURE_LOOKUP_H

#include "texture/node.h"

/* Maps an integer texel coordinate into the image by the wrap mode. -1: outside the image
 * (black). */
static inline int32_t vl_wrap_index(int32_t i, int32_t n, vlWrap wrap) {
  if (i >= 0 && i < n)
    return i;
  if (wrap == VL_WRAP_CLAMP)
    return i < 0 ? 0 : n - 1;
  if (wrap == VL_WRAP_BLACK)
    return -1;
  if (wrap == VL_WRAP_MIRROR) {
    int64_t period = 2 * (int64_t)n, m = i % period;
    m = m < 0 ? m + period : m;
    return (int32_t)(m < n ? m : period - 1 - m);
  }
  int32_t m = i % n;
  return m < 0 ? m + n : m;
}

/* vl_wrap_index of i + 1, if that of i is `wrapped`: without a second division where the image
 * repeats. */
static inline int32_t vl_wrap_next(int32_t i, int32_t wrapped, int32_t n, vlWrap wrap) {
  if (wrap == VL_WRAP_REPEAT)
    return wrapped + 1 < n ? wrapped + 1 : 0;
  return vl_wrap_index(i + 1, n, wrap);
}

typedef struct vlTexel {
  float c[4];
} vlTexel;

static inline vlTexel vl_texel_2(const vlMipmap *mip, uint32_t level, int32_t x, int32_t y,
                                 vlWrap wrap, vlWrap wrap_t) {
  int32_t w = (int32_t)mip->levels[level].width, h = (int32_t)mip->levels[level].height;
  /* the square's edges fold onto themselves (pbrt book 3.8.3) */
  if (wrap == VL_WRAP_OCTAHEDRAL) {
    if (x < 0) {
      x = -x - 1;
      y = h - 1 - y;
    } else if (x >= w) {
      x = 2 * w - 1 - x;
      y = h - 1 - y;
    }
    if (y < 0) {
      x = w - 1 - x;
      y = -y - 1;
    } else if (y >= h) {
      x = w - 1 - x;
      y = 2 * h - 1 - y;
    }
    wrap = wrap_t = VL_WRAP_CLAMP;
  }
  x = vl_wrap_index(x, w, wrap);
  y = vl_wrap_index(y, h, wrap_t);
  vlTexel black = {{0, 0, 0, 0}};
  if (x < 0 || y < 0)
    return black;
  vlTexel t = black;
  for (uint32_t i = 0; i < mip->channels; i++)
    t.c[i] = vl_mip_texel(mip, level, (uint32_t)x, (uint32_t)y, i);
  return t;
}

static inline vlTexel vl_texel(const vlMipmap *mip, uint32_t level, int32_t x, int32_t y) {
  return vl_texel_2(mip, level, x, y, VL_WRAP_CLAMP, VL_WRAP_CLAMP);
}

static inline int32_t vl_to_index(float x) { /* floor(x), defined for any float */
  float f = __builtin_floorf(x);
  f = f > 1e9f ? 1e9f : f;
  f = f < -1e9f ? -1e9f : f;
  return f == f ? (int32_t)f : 0;
}

/* The weights of the four texels around a point, and where these texels start in the level:
 * texel 2 j + i at row[j] + column[i]. */
typedef struct vlTexelSquare {
  float w[4];
  size_t row[2];
  uint32_t column[2];
} vlTexelSquare;
VL_INLINE vlTexel vl_blend_channels(const vlMipmap *mip, const vlMipLevel *l,
                                    const vlTexelSquare *q, uint32_t channels) {
  vlTexel r = {{0, 0, 0, 0}};
  if (mip->is_bytes) {
    const uint8_t *top = l->bytes + q->row[0], *below = l->bytes + q->row[1];
    const uint8_t *a = top + q->column[0], *b = top + q->column[1], *c = below + q->column[0],
                  *d = below + q->column[1];
    for (uint32_t i = 0; i < channels; i++) {
      const float *value = mip->decode[i];
      r.c[i] = q->w[0] * value[a[i]] + q->w[1] * value[b[i]] + q->w[2] * value[c[i]] +
               q->w[3] * value[d[i]];
    }
    return r;
  }
  const float *top = l->floats + q->row[0], *below = l->floats + q->row[1];
  const float *a = top + q->column[0], *b = top + q->column[1], *c = below + q->column[0],
              *d = below + q->column[1];
  for (uint32_t i = 0; i < channels; i++)
    r.c[i] = q->w[0] * a[i] + q->w[1] * b[i] + q->w[2] * c[i] + q->w[3] * d[i];
  return r;
}
VL_INLINE vlTexel vl_blend_texels(const vlMipmap *mip, const vlMipLevel *l,
                                  const vlTexelSquare *q) {
  return mip->channels == 3 ? vl_blend_channels(mip, l, q, 3)
                            : vl_blend_channels(mip, l, q, mip->channels);
}
/* The square of a bilinear lookup. *x, *y: indices of the first texel. Returns false, with only
 * the weights set, if a texel is outside of the image or if the edges fold. */
static inline bool vl_texel_square(const vlMipmap *mip, uint32_t level, float s, float t,
                                   vlWrap wrap, vlWrap wrap_t, vlTexelSquare *q, int32_t *x,
                                   int32_t *y) {
  const vlMipLevel *l = &mip->levels[level];
  float fx = s * (float)l->width - 0.5f, fy = t * (float)l->height - 0.5f;
  int32_t xi = vl_to_index(fx), yi = vl_to_index(fy);
  float dx = fx - (float)xi, dy = fy - (float)yi;
  q->w[0] = (1 - dx) * (1 - dy);
  q->w[1] = dx * (1 - dy);
  q->w[2] = (1 - dx) * dy;
  q->w[3] = dx * dy;
  *x = xi;
  *y = yi;
  if (!(wrap != VL_WRAP_OCTAHEDRAL && dx >= 0.0f && dx <= 1.0f && dy >= 0.0f && dy <= 1.0f))
    return false;
  int32_t x0 = vl_wrap_index(xi, (int32_t)l->width, wrap),
          x1 = vl_wrap_next(xi, x0, (int32_t)l->width, wrap);
  int32_t y0 = vl_wrap_index(yi, (int32_t)l->height, wrap_t),
          y1 = vl_wrap_next(yi, y0, (int32_t)l->height, wrap_t);
  if ((x0 | x1 | y0 | y1) < 0)
    return false;
  uint32_t n = mip->channels;
  size_t pitch = (size_t)l->width * n;
  q->row[0] = (size_t)y0 * pitch;
  q->row[1] = (size_t)y1 * pitch;
  q->column[0] = (uint32_t)x0 * n;
  q->column[1] = (uint32_t)x1 * n;
  return true;
}
/* Bilinear lookup in one level. (s, t) = (0, 0) is the top left corner of the image. */
static inline vlTexel vl_bilinear_2(const vlMipmap *mip, uint32_t level, float s, float t,
                                    vlWrap wrap, vlWrap wrap_t) {
  vlTexelSquare q;
  int32_t x, y;
  if (vl_texel_square(mip, level, s, t, wrap, wrap_t, &q, &x, &y))
    return vl_blend_texels(mip, &mip->levels[level], &q);
  vlTexel a = vl_texel_2(mip, level, x, y, wrap, wrap_t),
          b = vl_texel_2(mip, level, x + 1, y, wrap, wrap_t);
  vlTexel c = vl_texel_2(mip, level, x, y + 1, wrap, wrap_t),
          d = vl_texel_2(mip, level, x + 1, y + 1, wrap, wrap_t), r;
  for (int i = 0; i < 4; i++)
    r.c[i] = q.w[0] * a.c[i] + q.w[1] * b.c[i] + q.w[2] * c.c[i] + q.w[3] * d.c[i];
  return r;
}
static inline vlTexel vl_bilinear(const vlMipmap *mip, float s, float t, vlWrap wrap) {
  return vl_bilinear_2(mip, 0, s, t, wrap, wrap);
}

static inline vlTexel vl_nearest_2(const vlMipmap *mip, uint32_t level, float s, float t,
                                   vlWrap wrap, vlWrap wrap_t) {
  return vl_texel_2(mip, level, vl_to_index(s * (float)mip->levels[level].width),
                    vl_to_index(t * (float)mip->levels[level].height), wrap, wrap_t);
}
/* Of the finest level of an octahedral map. */
static inline vlTexel vl_octahedral_texel(const vlMipmap *mip, float s, float t) {
  return vl_nearest_2(mip, 0, s, t, VL_WRAP_OCTAHEDRAL, VL_WRAP_OCTAHEDRAL);
}

/* log2 of a positive float, to about 1e-3, for choosing a mip level. */
static inline float vl_log2_rough(float x) {
  return vl_ln(x) * 1.44269504f;
}

/* Filtering over the elliptic footprint: the MIP level matches the shorter axis, because MIP
 * levels are isotropic. Several taps cover the longer axis. */
enum { VL_FILTER_TAPS = 8 };
typedef struct vlFilterPlan {
  float level; /* >= 0 */
  uint32_t taps;
  float s, t; /* from the first tap to the last */
} vlFilterPlan;
/* a, b: the footprint's axes; width, height: of the finest level; last: index of the coarsest.
 * Without branches, for vector loops. */
VL_INLINE vlFilterPlan vl_filter_plan(float width, float height, float last, vlVec2 a,
                                      vlVec2 b) {
  /* axes in texels */
  float as = a.x * width, at = a.y * height, bs = b.x * width, bt = b.y * height;
  float a2 = as * as + at * at, b2 = bs * bs + bt * bt;
  int32_t first = a2 > b2;
  float long2 = first ? a2 : b2;
  /* else magnification: no texel is skipped */
  int32_t reduces = (long2 > 1.0f) & (long2 < 1e30f);
  float longer = __builtin_sqrtf(reduces ? long2 : 1.0f);
  float shorter = vl_max(vl_abs(as * bt - at * bs) / longer, 1.0f); /* ellipse of equal area */
  float level = vl_min(vl_log2_rough(shorter), last), whole = long2 >= 1e30f ? last : 0.0f;
  uint32_t taps =
      (uint32_t)(int32_t)vl_min(longer / shorter * 0.99999f, (float)(VL_FILTER_TAPS - 1)) + 1;
  vlFilterPlan plan;
  plan.level = reduces ? level : whole;
  plan.taps = reduces ? taps : 1;
  float s = first ? a.x : b.x, t = first ? a.y : b.y;
  plan.s = reduces ? s : 0.0f;
  plan.t = reduces ? t : 0.0f;
  return plan;
}
static inline vlFilterPlan vl_filter_plan_of(const vlMipmap *mip, const float axes[4]) {
  return vl_filter_plan((float)mip->levels[0].width, (float)mip->levels[0].height,
                        (float)(mip->level_count - 1), (vlVec2){axes[0], axes[1]},
                        (vlVec2){axes[2], axes[3]});
}

/* Converts a footprint's axes in uv to axes in (s, t), for nodes whose (s, t) is an affine
 * function of uv. */
static inline void vl_texture_axes_of_uv(const vlTextureNode *node, const float uv[4],
                                         vlTexturePoint *at) {
  for (int k = 0; k < 4; k += 2) {
    at->axes[k] =
        node->st_given ? node->st[0] * uv[k] + node->st[1] * uv[k + 1] : node->su * uv[k];
    at->axes[k + 1] =
        node->st_given ? node->st[3] * uv[k] + node->st[4] * uv[k + 1] : node->sv * uv[k + 1];
  }
}

/* A lookup in an image texture: where the image is read (t is measured from the top) and how it
 * is filtered. */
typedef struct vlImageLookup {
  float s, t;
  vlFilterPlan plan;
} vlImageLookup;
static inline vlImageLookup vl_image_lookup(const vlTextureNode *node, const vlMipmap *mip,
                                            vlTexturePoint at) {
  vlVec2 st = vl_texture_st(node, at); /* t is measured from the bottom */
  return (vlImageLookup){st.x, 1.0f - st.y, vl_filter_plan_of(mip, at.axes)};
}

/* A trilinear filter blends two levels. */
static inline bool vl_two_levels(const vlTextureNode *node, float level) {
  return node->filter != VL_FILTER_BILINEAR && level - (float)(uint32_t)level > 0.0f;
}
/* Where tap k is, in lengths of the footprint from its middle. */
static inline float vl_tap_offset(float inv_taps, uint32_t k) {
  return 0.5f * inv_taps - 0.5f + (float)k * inv_taps;
}

/* The squares of all taps and levels of a lookup, in this order. Returns their number; 0 if the
 * filter reads one texel only, or if some square is not plain (vl_texel_square). */
enum { VL_LOOKUP_SQUARES = 2 * VL_FILTER_TAPS };
static inline uint32_t vl_lookup_squares(const vlTextureNode *node, const vlMipmap *mip,
                                         const vlImageLookup *at, vlTexelSquare *out) {
  if (node->filter == VL_FILTER_POINT)
    return 0;
  uint32_t levels = vl_two_levels(node, at->plan.level) ? 2 : 1, count = 0;
  float inv = 1.0f / (float)at->plan.taps;
  for (uint32_t k = 0; k < at->plan.taps; k++) {
    float offset = vl_tap_offset(inv, k), s = at->s + offset * at->plan.s,
          t = at->t - offset * at->plan.t;
    for (uint32_t level = 0; level < levels; level++) {
      int32_t x, y;
      if (!vl_texel_square(mip, (uint32_t)at->plan.level + level, s, t, node->wrap,
                           node->wrap_t, out + count++, &x, &y))
        return 0;
    }
  }
  return count;
}

/* Prefetches the texels of some squares. A function without any effect but prefetches must be
 * always_inline: gcc 12 may take it for one without effects and delete its calls. */
VL_INLINE void vl_prefetch_squares(const vlMipmap *mip, const vlImageLookup *at,
                                   const vlTexelSquare *q, uint32_t count) {
  const vlMipLevel *first = &mip->levels[(uint32_t)at->plan.level];
  bool both = count > at->plan.taps;
  for (uint32_t k = 0; k < count; k++, q++) {
    const vlMipLevel *l = first + (both & k);
    for (int j = 0; j < 2; j++) {
      size_t index = q->row[j] + q->column[0];
      __builtin_prefetch(
          mip->is_bytes ? (const void *)(l->bytes + index) : (const void *)(l->floats + index),
          0, 3);
    }
  }
}

/* A point filter reads one texel of the finer level. A bilinear filter interpolates on that
 * level. A trilinear filter, which also serves for EWA, blends two levels. Bilinear and
 * trilinear filters take several taps. squares: those of vl_lookup_squares; null: they are
 * computed here. */
VL_INLINE vlTexel vl_image_value(const vlTextureNode *node, const vlMipmap *mip,
                                 const vlImageLookup *at, const vlTexelSquare *squares) {
  float s = at->s, t = at->t;
  vlFilterPlan plan = at->plan;
  uint32_t level = (uint32_t)plan.level;
  vlTexel r = {{0, 0, 0, 0}};
  if (node->filter == VL_FILTER_POINT) {
    r = vl_nearest_2(mip, level, s, t, node->wrap, node->wrap_t);
  } else {
    bool both = vl_two_levels(node, plan.level);
    float inv = 1.0f / (float)plan.taps, f = plan.level - (float)level;
    for (uint32_t k = 0; k < plan.taps; k++) {
      float offset = vl_tap_offset(inv, k), x = s + offset * plan.s, y = t - offset * plan.t;
      vlTexel a = squares ? vl_blend_texels(mip, &mip->levels[level], squares++)
                          : vl_bilinear_2(mip, level, x, y, node->wrap, node->wrap_t);
      if (both) {
        vlTexel b = squares ? vl_blend_texels(mip, &mip->levels[level + 1], squares++)
                            : vl_bilinear_2(mip, level + 1, x, y, node->wrap, node->wrap_t);
        for (int i = 0; i < 4; i++)
          a.c[i] = (1 - f) * a.c[i] + f * b.c[i];
      }
      for (int i = 0; i < 4; i++)
        r.c[i] = k ? r.c[i] + a.c[i] : a.c[i];
    }
    for (int i = 0; plan.taps > 1 && i < 4; i++)
      r.c[i] *= inv;
  }
  for (int i = 0; i < 4; i++) {
    float x = r.c[i] * node->scale;
    x = node->invert ? 1.0f - x : x;
    r.c[i] = x < 0.0f ? 0.0f : x;
  }
  return r;
}

static inline vlTexel vl_texture_image(const vlTextureNode *node, const vlMipmap *mip,
                                       vlTexturePoint at) {
  vlImageLookup lookup = vl_image_lookup(node, mip, at);
  return vl_image_value(node, mip, &lookup, NULL);
}

/* Returns all four channels, multiplied by the tint. A grey value is copied to red, green and
 * blue; coverage is 1 if the image has none. If mip is null, the value is the vertex colour. */
static inline vlTexel vl_texture_rgba(const vlTextureNode *node, const vlMipmap *mip,
                                      vlTexturePoint at) {
  vlTexel t = {{1, 1, 1, 1}};
  if (mip) {
    uint32_t n = mip->channels;
    t = vl_texture_image(node, mip, at);
    if (n < 3) {
      t.c[3] = n == 2 ? t.c[1] : 1.0f;
      t.c[1] = t.c[2] = t.c[0];
    }
    if (n == 3)
      t.c[3] = 1.0f;
  }
  for (int c = 0; c < 4; c++)
    t.c[c] *= node->colors ? node->tint[c] * at.color[c] : node->tint[c];
  return t;
}

#endif
