/* texture/batch.hot.c: evaluation of textures over a run of lanes that share a material:
 * floats, and spectra at each lane's four wavelengths. A node's inputs are evaluated to rows of
 * a stack, then combined by the functions of texture/kinds.h. Undefined values are NaN: the
 * film drops and counts such samples (vlRenderStats.not_finite). */
#include "texture/kinds.h"
#include "texture/run.hot.h"

/* ---- the point of a lane ----------------------------------------------------------------- */

/* Interpolates the vertex attributes (uv sets, colours) of lane i's triangle at the point. */
static inline void lane_corner(const vlTextureRun *r, const vlTextureNode *node, uint32_t i,
                               vlTexturePoint *at) {
  const vlHits *h = &r->at->hits;
  vlTextureCorner where = {&r->world->shapes.items[h->shape[i]], h->prim[i], {1, 0, 0}};
  vlVec2 w = vl_corner_weights(&r->s->corners, i, at->p);
  where.weights[0] = 1.0f - w.x - w.y;
  where.weights[1] = w.x;
  where.weights[2] = w.y;
  vl_texture_at_corner(node, &where, at);
}

/* Computes the footprint's axes in texture coordinates (s, t). For the first uv set they are
 * the surface's axes; for other mappings they are finite differences along each axis. */
static inline void lane_axes(const vlTextureRun *r, const vlTextureNode *node, uint32_t i,
                             vlTexturePoint *at) {
  const vlSurface *f = &r->at->surface;
  if (node->uv_set == 0 && (node->st_given || node->mapping == VL_MAPPING_UV)) {
    const float uv[4] = {f->across_u[i], f->across_v[i], f->along_u[i], f->along_v[i]};
    vl_texture_axes_of_uv(node, uv, at);
    return;
  }
  const vlPaths *p = &r->at->paths;
  vlFootprint print = vl_footprint_of(vl_row3(&p->d, i), at->n, at->width);
  vlVec2 here = vl_texture_st(node, *at);
  vlTexturePoint step = *at;
  for (int k = 0; k < 2; k++) {
    step.p = vl_add(at->p, k ? print.along : print.across);
    if (vl_texture_needs_corner(node))
      lane_corner(r, node, i, &step);
    vlVec2 there = vl_texture_st(node, step);
    float s = there.x - here.x, t = there.y - here.y;
    /* the shorter way across the mapping's seam */
    if (node->mapping == VL_MAPPING_SPHERICAL || node->mapping == VL_MAPPING_CYLINDRICAL) {
      s -= __builtin_rintf(s);
      t -= node->mapping == VL_MAPPING_SPHERICAL ? __builtin_rintf(t) : 0.0f;
    }
    at->axes[2 * k] = s;
    at->axes[2 * k + 1] = t;
  }
}

/* Where lane i is. */
static inline vlTexturePoint point_of(const vlTextureRun *r, const vlTextureNode *node,
                                      uint32_t i) {
  const vlSurface *f = &r->at->surface;
  vlTexturePoint at = {.color = {1, 1, 1, 1}};
  at.u = f->u[i];
  at.v = f->v[i];
  at.p = vl_row3(&f->p, i);
  at.n = vl_row3(&f->g, i); /* geometric normal, as in pbrt */
  at.width = f->width[i];
  if (r->shift_u) {
    at.u += r->shift_u[i];
    at.v += r->shift_v[i];
    at.p = vl_add(at.p, vl_vec3(r->shift_x[i], r->shift_y[i], r->shift_z[i]));
  }
  if (vl_texture_needs_corner(node))
    lane_corner(r, node, i, &at);
  if (node->image >= 0)
    lane_axes(r, node, i, &at);
  return at;
}

/* ---- point functions over a run ---------------------------------------------------------- */

typedef float PointFloat(const vlTextureNode *node, vlTexturePoint at);

/* Inlined together with f, so that there is one loop per kind. */
VL_INLINE void each_lane(const vlTextureRun *r, const vlTextureNode *node, PointFloat *f,
                         float *out) {
  for (uint32_t i = r->first; i < r->last; i++)
    out[i] = f(node, point_of(r, node, i));
}

static void fill(const vlTextureRun *r, float value, float *out) {
  VL_SIMD
  for (uint32_t i = r->first; i < r->last; i++)
    out[i] = value;
}

static void bilerp_weights(const vlTextureRun *r, const vlTextureNode *node,
                           float *const w[4]) {
  for (uint32_t i = r->first; i < r->last; i++) {
    vlBilerpWeights k = vl_node_bilerp(node, point_of(r, node, i));
    for (int j = 0; j < 4; j++)
      w[j][i] = k.w[j];
  }
}

/* Some lanes' lookups of a plain image. All are computed, and their texels requested, before
 * the first is read. */
typedef struct Lookups {
  uint32_t count;
  vlImageLookup at[VL_LANES];
  const vlTexelSquare *squares[VL_LANES]; /* null: not computed */
  vlTexelSquare memory[VL_LANES * VL_LOOKUP_SQUARES];
} Lookups;

/* Two calls of an inline function, so that each is compiled for its own case. */
static vlTexel value_of(const vlTextureNode *node, const vlMipmap *mip, const Lookups *l,
                        uint32_t k) {
  return l->squares[k] ? vl_image_value(node, mip, &l->at[k], l->squares[k])
                       : vl_image_value(node, mip, &l->at[k], NULL);
}

/* Where the lookups are, and how they are filtered: vl_image_lookup for many lanes. */
static void plan_lookups(const vlTextureRun *r, const vlTextureNode *node, const vlMipmap *mip,
                         uint32_t first, Lookups *restrict l) {
  VL_ROW float s[VL_LANES], t[VL_LANES], axes[4][VL_LANES], level[VL_LANES], ds[VL_LANES],
      dt[VL_LANES];
  VL_ROW uint32_t taps[VL_LANES];
  for (uint32_t k = 0; k < l->count; k++) {
    vlTexturePoint at = point_of(r, node, first + k);
    vlVec2 st = vl_texture_st(node, at);
    s[k] = st.x;
    t[k] = st.y;
    for (int c = 0; c < 4; c++)
      axes[c][k] = at.axes[c];
  }
  for (uint32_t k = l->count; k < VL_LANES; k++)
    for (int c = 0; c < 4; c++)
      axes[c][k] = 0.0f;
  float width = (float)mip->levels[0].width, height = (float)mip->levels[0].height;
  float last = (float)(mip->level_count - 1);
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < VL_LANES; k++) {
    vlVec2 a = {axes[0][k], axes[1][k]}, b = {axes[2][k], axes[3][k]};
    vlFilterPlan plan = vl_filter_plan(width, height, last, a, b);
    level[k] = plan.level;
    taps[k] = plan.taps;
    ds[k] = plan.s;
    dt[k] = plan.t;
  }
  for (uint32_t k = 0; k < l->count; k++)
    l->at[k] = (vlImageLookup){s[k], 1.0f - t[k], {level[k], taps[k], ds[k], dt[k]}};
}

static void look_up(const vlTextureRun *r, const vlTextureNode *node, const vlMipmap *mip,
                    uint32_t first, Lookups *l) {
  vlTexelSquare *next = l->memory;
  l->count = r->last - first < VL_LANES ? r->last - first : VL_LANES;
  plan_lookups(r, node, mip, first, l);
  for (uint32_t k = 0; k < l->count; k++) {
    uint32_t count = vl_lookup_squares(node, mip, &l->at[k], next);
    vl_prefetch_squares(mip, &l->at[k], next, count); /* must prefetch */
    l->squares[k] = count ? next : NULL;
    next += count;
  }
}

/* ---- floats ------------------------------------------------------------------------------ */

static void image_floats(const vlTextureRun *r, const vlTextureNode *node, float *out) {
  const vlMipmap *mip = r->world->images.items[node->image].mipmap;
  if (!node->plain) {
    for (uint32_t i = r->first; i < r->last; i++)
      out[i] = vl_node_image_float(node, mip, point_of(r, node, i));
    return;
  }
  Lookups l;
  for (uint32_t first = r->first; first < r->last; first += l.count) {
    look_up(r, node, mip, first, &l);
    for (uint32_t k = 0; k < l.count; k++)
      out[first + k] = vl_plain_float(mip, value_of(node, mip, &l, k));
  }
}

/* ---- spectra ----------------------------------------------------------------------------- */

static void constant_spectrum(const vlTextureRun *r, const vlSpectral *s, float *const out[4]) {
  for (int c = 0; c < 4; c++) {
    const float *lambda = r->at->paths.lambda[c];
    if (r->rgb) {
      fill(r, c < 3 ? s->scale * s->rgb[c] : 0.0f, out[c]);
      continue;
    }
    switch (s->kind) {
      case VL_SPECTRAL_SIGMOID:
        VL_SIMD
        for (uint32_t i = r->first; i < r->last; i++)
          out[c][i] = s->scale * vl_sigmoid(s->sigmoid, lambda[i]);
        break;
      case VL_SPECTRAL_DENSE:
        VL_SIMD
        for (uint32_t i = r->first; i < r->last; i++)
          out[c][i] = s->scale * vl_dense_at(s->dense, lambda[i]);
        break;
      case VL_SPECTRAL_CONSTANT:
      case VL_SPECTRAL_RGB:
        fill(r, vl_spectral_at(s, c, 0.0f), out[c]);
        break;
    }
  }
}

/* Conversion of colours to spectra by the node's role (pbrt book 10.4.1): albedos are clamped,
 * other colours scaled. */
typedef struct Upsampling {
  bool rgb_mode, albedo;
  const vlRgbTable *table;
  const float *illuminant;  /* null: no factor */
  const vlSrgbMap *to_srgb; /* in RGB mode */
} Upsampling;

static Upsampling upsampling_of(const vlTextureRun *r, const vlTextureNode *node) {
  return (Upsampling){r->rgb || r->world->def.color == VL_COLOR_RGB,
                      node->role == VL_ROLE_ALBEDO, vl_rgb_table(node->space),
                      node->role == VL_ROLE_ILLUMINANT ? node->spectrum.dense : NULL,
                      &node->to_srgb};
}

void vl_upsample_rows(const vlRgbTable *table, bool albedo, uint32_t padded,
                      float (*const rgb)[VL_SKY_BLOCK], float (*const lambda)[VL_SKY_BLOCK],
                      float (*const value)[VL_SKY_BLOCK]) {
  float max = albedo ? 1.0f : VL_INFINITY;
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < padded; k++) {
    float red = rgb[0][k], green = rgb[1][k], blue = rgb[2][k];
    red = red > max ? max : red;
    green = green > max ? max : green;
    blue = blue > max ? max : blue;
    float m = vl_max(red, vl_max(green, blue));
    float scale = albedo ? 1.0f : 2.0f * m, inv = scale > 0.0f ? 1.0f / scale : 0.0f;
    vlRgbPoint at = vl_rgb_point(red * inv, green * inv, blue * inv);
    vlSigmoid s = {vl_rgb_coefficient(table->coefficients, 0, at),
                   vl_rgb_coefficient(table->coefficients, 1, at),
                   vl_rgb_coefficient(table->coefficients, 2, at)};
    for (int c = 0; c < 4; c++)
      value[c][k] = scale * vl_sigmoid(s, lambda[c][k]);
  }
}

static void upsample(const vlTextureRun *r, const Upsampling *up, vlVec3 rgb, uint32_t i,
                     float *const out[4]) {
  float c[3] = {rgb.x, rgb.y, rgb.z}, lambda[4], value[4];
  if (up->rgb_mode) {
    vl_store3(c, vl_to_srgb(up->to_srgb, rgb));
    for (int k = 0; k < 4; k++)
      out[k][i] = k < 3 ? (up->albedo && c[k] > 1.0f ? 1.0f : c[k]) : 0.0f;
    return;
  }
  vl_path_lambda(&r->at->paths, i, lambda);
  vl_upsample(up->table, up->albedo, c, lambda, value);
  for (int k = 0; k < 4; k++)
    out[k][i] = up->illuminant ? value[k] * vl_dense_at(up->illuminant, lambda[k]) : value[k];
}

/* upsample for lanes from first on, with the same operations. */
static void upsample_lanes(const vlTextureRun *r, const Upsampling *up, uint32_t count,
                           float rgb[3][VL_SKY_BLOCK], uint32_t first, float *const out[4]) {
  if (up->rgb_mode || count < VL_LANES / 4) {
    for (uint32_t k = 0; k < count; k++)
      upsample(r, up, vl_lane3(rgb[0], rgb[1], rgb[2], k), first + k, out);
    return;
  }
  VL_ROW float lambda[4][VL_SKY_BLOCK], value[4][VL_SKY_BLOCK];
  for (int c = 0; c < 4; c++)
    for (uint32_t k = 0; k < VL_LANES; k++)
      lambda[c][k] = r->at->paths.lambda[c][first + (k < count ? k : count - 1)];
  vl_upsample_rows(up->table, up->albedo, VL_LANES, rgb, lambda, value);
  for (int c = 0; c < 4; c++)
    for (uint32_t k = 0; k < count; k++)
      out[c][first + k] = up->illuminant
                              ? value[c][k] * vl_dense_at(up->illuminant, lambda[c][k])
                              : value[c][k];
}

static void image_spectrum(const vlTextureRun *r, const vlTextureNode *node,
                           float *const out[4]) {
  const vlMipmap *mip = r->world->images.items[node->image].mipmap;
  Upsampling up = upsampling_of(r, node);
  if (!node->plain) {
    for (uint32_t i = r->first; i < r->last; i++)
      upsample(r, &up, vl_node_image_rgb(node, mip, point_of(r, node, i)), i, out);
    return;
  }
  Lookups l;
  for (uint32_t first = r->first; first < r->last; first += l.count) {
    VL_ROW float rgb[3][VL_SKY_BLOCK];
    look_up(r, node, mip, first, &l);
    for (uint32_t k = 0; k < VL_LANES; k++) {
      uint32_t j = k < l.count ? k : l.count - 1;
      vlVec3 c = j == k ? vl_plain_rgb(mip, value_of(node, mip, &l, k))
                        : vl_lane3(rgb[0], rgb[1], rgb[2], j);
      vl_set_lane3(rgb[0], rgb[1], rgb[2], k, c);
    }
    upsample_lanes(r, &up, l.count, rgb, first, out);
  }
}

typedef vlVec3 PointColor(const vlTextureNode *node, vlTexturePoint at);
VL_INLINE void each_color(const vlTextureRun *r, const vlTextureNode *node, PointColor *f,
                          float *const out[4]) {
  Upsampling up = upsampling_of(r, node);
  for (uint32_t i = r->first; i < r->last; i++)
    upsample(r, &up, f(node, point_of(r, node, i)), i, out);
}

/* ---- numbers and spectra ----------------------------------------------------------------- */

/* Evaluates a node to `count` rows: 1, of a number, or 4, of a spectrum. */
static void evaluate(vlTextureRun *r, int32_t index, int count, float *const *out);

static void take_rows(vlTextureRun *r, int count, float *rows[4]) {
  for (int c = 0; c < count; c++)
    rows[c] = vl_texture_row(r);
}

/* The shares of the second input, as a row of the stack. */
static const float *amount_share(vlTextureRun *r, const vlTextureNode *node) {
  float *share = vl_texture_row(r);
  vl_texture_float(r, node->amount, share);
  return share;
}
VL_INLINE const float *point_share(vlTextureRun *r, const vlTextureNode *node, PointFloat *f) {
  float *share = vl_texture_row(r);
  each_lane(r, node, f, share);
  return share;
}

/* Mixes the two inputs of a node by the share of the second. */
static void mix(vlTextureRun *r, const vlTextureNode *node, const float *share, int count,
                float *const *out) {
  float *b[4];
  take_rows(r, count, b);
  evaluate(r, node->a, count, out);
  evaluate(r, node->b, count, b);
  for (int c = 0; c < count; c++)
    for (uint32_t i = r->first; i < r->last; i++)
      out[c][i] = vl_node_mix(out[c][i], b[c][i], share[i]);
}

static void scale(vlTextureRun *r, const vlTextureNode *node, int count, float *const *out) {
  float *w = vl_texture_row(r);
  evaluate(r, node->a, count, out);
  vl_texture_float(r, node->amount, w);
  for (int c = 0; c < count; c++)
    for (uint32_t i = r->first; i < r->last; i++)
      out[c][i] = vl_node_scale(out[c][i], w[i]);
}

static void bilerp(vlTextureRun *r, const vlTextureNode *node, int count, float *const *out) {
  float *w[4], *x[4];
  take_rows(r, 4, w);
  take_rows(r, count, x);
  bilerp_weights(r, node, w);
  const int32_t inputs[4] = {node->a, node->b, node->c, node->d};
  for (int k = 0; k < 4; k++) {
    evaluate(r, inputs[k], count, x);
    for (int c = 0; c < count; c++)
      for (uint32_t i = r->first; i < r->last; i++)
        out[c][i] = vl_node_bilerp_add(k ? out[c][i] : 0.0f, w[k][i], x[c][i]);
  }
}

/* A number where a spectrum is wanted, or a spectrum where a number is: vl_scene_add_texture
 * refuses them. */
static void undefined(const vlTextureRun *r, int count, float *const *out) {
  for (int c = 0; c < count; c++)
    fill(r, __builtin_nanf(""), out[c]);
}

/* A case of the switch below, by what the function of the kind gives (VL_TEXTURE_KINDS). */
#define CASE(kind, name, row, gives, function) gives(kind, function)
#define FLOAT(kind, function)               \
  case kind:                                \
    if (number)                             \
      each_lane(r, node, function, out[0]); \
    else                                    \
      undefined(r, count, out);             \
    break;
#define COLOR(kind, function)             \
  case kind:                              \
    if (number)                           \
      undefined(r, count, out);           \
    else                                  \
      each_color(r, node, function, out); \
    break;
#define SHARE(kind, function)                                 \
  case kind:                                                  \
    mix(r, node, point_share(r, node, function), count, out); \
    break;
#define OTHER(kind, function)

static void evaluate(vlTextureRun *r, int32_t index, int count, float *const *out) {
  const vlTextureNode *node = &r->world->nodes.items[index];
  const bool number = count == 1;
  uint32_t top = r->top;
  switch ((vlTextureKind)node->kind) {
    case VL_TEXTURE_CONSTANT:
      if (node->is_spectrum == number)
        undefined(r, count, out);
      else if (number)
        fill(r, node->value, out[0]);
      else
        constant_spectrum(r, &node->spectrum, out);
      break;
    case VL_TEXTURE_IMAGE:
      if (number)
        image_floats(r, node, out[0]);
      else
        image_spectrum(r, node, out);
      break;
    case VL_TEXTURE_VERTEX_COLOR:
      if (number)
        each_lane(r, node, vl_node_vertex_color_float, out[0]);
      else
        each_color(r, node, vl_node_vertex_color_rgb, out);
      break;
    case VL_TEXTURE_SCALE:
      scale(r, node, count, out);
      break;
    case VL_TEXTURE_BILERP:
      bilerp(r, node, count, out);
      break;
    case VL_TEXTURE_MIX:
      mix(r, node, amount_share(r, node), count, out);
      break;
      VL_TEXTURE_KINDS(CASE)
  }
  r->top = top;
}

void vl_texture_float(vlTextureRun *r, int32_t node, float *row) {
  float *const out[1] = {row};
  evaluate(r, node, 1, out);
}

void vl_texture_spectrum(vlTextureRun *r, int32_t node, float rows[][VL_ROW_SIZE]) {
  float *const out[4] = {rows[0], rows[1], rows[2], rows[3]};
  evaluate(r, node, 4, out);
}

void vl_texture_albedo(vlTextureRun *r, int32_t node, float scale, float rows[][VL_ROW_SIZE]) {
  vl_texture_spectrum(r, node, rows);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++)
      rows[c][i] = vl_clamp(scale * rows[c][i], 0.0f, 1.0f);
}

vlTexel vl_texture_texel(const vlTextureRun *r, const vlTextureNode *node, uint32_t i) {
  return vl_texture_image(node, r->world->images.items[node->image].mipmap,
                          point_of(r, node, i));
}
