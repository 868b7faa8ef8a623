/* light/emissive_faces.c: see emissive_faces.h. Emission images are looked up at the
 * finest level, bilinearly or at the nearest texel (light/light.hot.c). A lookup in a
 * triangle can read only texels whose centre is less than one texel away from the triangle
 * along both axes. For each row of texels, the triangle is clipped to the band within one texel
 * of the row; the clipped part gives the range of columns. */
#include "light/emissive_faces.h"

#include <math.h>
#include <string.h>

#include "base/context.h"
#include "texture/lookup.h"
#include "velo/shape_kinds.h"

static bool texel_emits(const vlMipmap *mip, const vlTextureNode *node, uint32_t x,
                        uint32_t y) {
  uint32_t n = mip->channels < 3 ? 1 : 3;
  bool emits = false;
  for (uint32_t c = 0; c < 3; c++) {
    float tint = node ? node->scale * node->tint[c] : 1.0f;
    emits |= vl_mip_texel(mip, 0, x, y, c < n ? c : 0) * tint > 0.0f;
  }
  return emits;
}

bool vl_emissive_faces_make(const vlWorld *world, const vlEmitted *e, vlEmissiveFaces *s) {
  memset(s, 0, sizeof *s);
  if (e->image < 0 || !world->images.items[e->image].mipmap)
    return true;
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  s->node = e->node > 0 ? &world->nodes.items[e->node - 1] : NULL;
  s->wrap = s->node ? s->node->wrap : VL_WRAP_CLAMP;
  s->wrap_t = s->node ? s->node->wrap_t : VL_WRAP_CLAMP;
  if (s->wrap == VL_WRAP_OCTAHEDRAL || s->wrap_t == VL_WRAP_OCTAHEDRAL)
    return true;
  if (s->node && (s->node->invert || !(s->node->st_given || s->node->mapping == VL_MAPPING_UV)))
    return true;
  s->width = mip->levels[0].width;
  s->height = mip->levels[0].height;
  s->words = (s->width + 63) / 64;
  s->bits = vl_alloc_zero(world->context, (size_t)s->words * s->height, sizeof *s->bits);
  if (!s->bits)
    return false;
  for (uint32_t y = 0; y < s->height; y++)
    for (uint32_t x = 0; x < s->width; x++) {
      if (!texel_emits(mip, s->node, x, y))
        continue;
      s->bits[(size_t)y * s->words + x / 64] |= 1ull << x % 64;
      s->any = true;
    }
  return true;
}

void vl_emissive_faces_free(const vlWorld *world, vlEmissiveFaces *s) {
  vl_free(world->context, s->bits);
  memset(s, 0, sizeof *s);
}

/* Whether a bit is set in columns [from, to] of a row of the image. */
static bool row_emits(const vlEmissiveFaces *s, int32_t row, int32_t from, int32_t to) {
  row = vl_wrap_index(row, (int32_t)s->height, s->wrap_t);
  if (row < 0)
    return false;
  const uint64_t *bits = s->bits + (size_t)row * s->words;
  int32_t n = (int32_t)s->width;
  if (to - from >= 2 * n) { /* all columns in any wrap mode */
    from = 0;
    to = n - 1;
  }
  if (from < 0 || to >= n) {
    bool emits = false;
    for (int32_t x = from; x <= to && !emits; x++) {
      int32_t k = vl_wrap_index(x, n, s->wrap);
      emits = k >= 0 && (bits[k / 64] >> k % 64 & 1);
    }
    return emits;
  }
  uint64_t sum = 0;
  for (int32_t w = from / 64; w <= to / 64; w++) {
    uint64_t mask = ~0ull;
    if (w == from / 64)
      mask &= ~0ull << from % 64;
    if (w == to / 64)
      mask &= ~0ull >> (63 - to % 64);
    sum |= bits[w] & mask;
  }
  return sum != 0;
}

/* Gives the x range of the part of a triangle with low <= y <= high. An empty range has first >
 * last. */
static void band(const double x[3], const double y[3], double low, double high, double *first,
                 double *last) {
  *first = INFINITY;
  *last = -INFINITY;
  for (int k = 0; k < 3; k++) {
    int j = (k + 1) % 3;
    double at[4] = {NAN, NAN, NAN, NAN};
    if (y[k] >= low && y[k] <= high)
      at[0] = x[k];
    for (int edge = 0; edge < 2; edge++) {
      double level = edge ? high : low, d = y[j] - y[k];
      if ((y[k] < level) != (y[j] < level))
        at[1 + edge] = x[k] + (x[j] - x[k]) * ((level - y[k]) / d);
    }
    for (int i = 0; i < 3; i++) { /* fmin and fmax ignore NaN */
      *first = fmin(*first, at[i]);
      *last = fmax(*last, at[i]);
    }
  }
}

static bool triangle_emits(const vlEmissiveFaces *s, const float uv[3][2]) {
  double x[3], y[3], size = 0, x_low = INFINITY, x_high = -INFINITY, y_low = INFINITY,
                     y_high = -INFINITY;
  for (int k = 0; k < 3; k++) {
    vlVec2 st = {uv[k][0], uv[k][1]};
    vlTexturePoint at = {st.x, st.y,         vl_vec3(0, 0, 0), vl_vec3(0, 0, 1),
                         0,    {0, 0, 0, 0}, {1, 1, 1, 1}};
    if (s->node)
      st = vl_texture_st(s->node, at);
    x[k] = (double)st.x * s->width;
    y[k] = (1.0 - (double)st.y) * s->height;
    x_low = fmin(x_low, x[k]);
    x_high = fmax(x_high, x[k]);
    y_low = fmin(y_low, y[k]);
    y_high = fmax(y_high, y[k]);
    size = fmax(size, fmax(fabs(x[k]), fabs(y[k])));
  }
  if (!(size < 1e8) || isnan(x[0] + x[1] + x[2] + y[0] + y[1] + y[2]))
    return true;
  double hair = 0.01 + 1e-5 * size; /* margin, in texels: lookups interpolate uv in float */
  if (y_high - y_low > 2.0 * s->height || x_high - x_low > 2.0 * s->width)
    return s->any;
  int32_t from = (int32_t)floor(y_low - 0.5 - hair), to = (int32_t)floor(y_high + 0.5 + hair);
  bool emits = false;
  for (int32_t row = from; row <= to && !emits; row++) {
    double first, last;
    band(x, y, row - 0.5 - hair, row + 1.5 + hair, &first, &last);
    if (first <= last)
      emits = row_emits(s, row, (int32_t)floor(first - 0.5 - hair),
                        (int32_t)floor(last + 0.5 + hair));
  }
  return emits;
}

bool vl_face_emits(const vlEmissiveFaces *s, const vlWorldShape *shape, uint32_t prim) {
  if (!s->bits)
    return true;
  static const float unit[2][4][2] = {{{0, 0}, {1, 0}, {1, 1}, {0, 0}},
                                      {{0, 0}, {1, 0}, {0, 1}, {1, 1}}};
  static const int parts[4][3] = {
      {0, 1, 2}, {1, 2, 3}, {0, 1, 3}, {0, 2, 3}}; /* their union contains the patch */
  bool patch = shape->kind == VL_SHAPE_BILINEAR, emits = false;
  int corners = patch ? 4 : 3;
  const float *uvs = shape->emission_uvs ? shape->emission_uvs : shape->uvs;
  const uint32_t *f = shape->indices + (size_t)corners * prim;
  float uv[4][2];
  for (int k = 0; k < corners; k++)
    for (int i = 0; i < 2; i++)
      uv[k][i] = uvs ? uvs[2 * (size_t)f[k] + (size_t)i] : unit[patch][k][i];
  for (int i = 0; i < (patch ? 4 : 1) && !emits; i++) {
    const float(*c)[2] = (const float(*)[2])uv;
    const float corner[3][2] = {{c[parts[i][0]][0], c[parts[i][0]][1]},
                                {c[parts[i][1]][0], c[parts[i][1]][1]},
                                {c[parts[i][2]][0], c[parts[i][2]][1]}};
    emits = triangle_emits(s, corner);
  }
  return emits;
}
