/* light/environment.hot.c: environment maps, for many lanes at once: light samples, and
 * radiance and density for rays that hit nothing. Each lane reads a few cache lines of large
 * tables, so the work is divided into loops, and each loop prefetches the memory that the next
 * loop reads. */
#include "light/kinds.hot.h"
#include "math/octahedral.h"
#include "texture/lookup.h"

enum { BLOCK = VL_SKY_BLOCK };

/* A block of lanes. The arrays are filled to a multiple of VL_LANES with copies of the last
 * lane. */
typedef struct Block {
  VL_ROW uint32_t lane[BLOCK], y[BLOCK], cell[BLOCK];
  VL_ROW float u[BLOCK], dx[BLOCK], dy[BLOCK];
  VL_ROW float s[BLOCK], t[BLOCK]; /* position in the image, in [0, 1]^2 */
  VL_ROW float wx[BLOCK], wy[BLOCK], wz[BLOCK];
  VL_ROW float rgb[3][BLOCK], lambda[4][BLOCK], radiance[4][BLOCK];
} Block;

/* Always inlined: see vl_prefetch_texels. */
VL_INLINE void request(const void *address) {
  __builtin_prefetch(address, 0, 3);
}

VL_INLINE void request_texel(const vlEnvironment *env, const vlMipmap *mip, float s, float t) {
  if (env->cells_are_texels)
    return; /* the colour is in the cell */
  const vlMipLevel *l = &mip->levels[0];
  uint32_t x = (uint32_t)(int32_t)(s * (float)l->width),
           y = (uint32_t)(int32_t)(t * (float)l->height);
  x = x < l->width ? x : l->width - 1;
  y = y < l->height ? y : l->height - 1;
  size_t at = ((size_t)y * l->width + x) * mip->channels;
  request(mip->is_bytes ? (const void *)(l->bytes + at) : (const void *)(l->floats + at));
}

static uint32_t fill_lanes(Block *b, const uint32_t *lanes, uint32_t count) {
  uint32_t padded = VL_PAD(count);
  for (uint32_t k = 0; k < padded; k++)
    b->lane[k] = lanes[k < count ? k : count - 1];
  return padded;
}

/* ---- radiance ---------------------------------------------------------------------------- */

static inline float scaled(float scale, float value) {
  float y = scale * value;
  return y > 0.0f ? y : 0.0f;
}

/* Looks up the image's colours at s, t, in b->cell. */
static void read_colors(const vlEnvironment *env, const vlMipmap *mip, float scale,
                        uint32_t padded, Block *b) {
  if (env->cells_are_texels) {
    for (uint32_t k = 0; k < padded; k++)
      for (int c = 0; c < 3; c++)
        b->rgb[c][k] = scaled(scale, env->cells[b->cell[k]].color[c]);
    return;
  }
  for (uint32_t k = 0; k < padded; k++) {
    vlTexel x = vl_octahedral_texel(mip, b->s[k], b->t[k]);
    for (int c = 0; c < 3; c++)
      b->rgb[c][k] = scaled(scale, x.c[mip->channels < 3 ? 0 : c]);
  }
}

/* Multiplies the radiance by the illuminant. */
static void illuminate(const vlSpectral *illuminant, uint32_t padded, Block *restrict b) {
  const float *dense = illuminant->dense;
  float factor = illuminant->scale;
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < padded; k++) {
    for (int c = 0; c < 4; c++)
      b->radiance[c][k] *= factor * vl_dense_at(dense, b->lambda[c][k]);
  }
}

/* With the same operations as vl_emitted_at. */
static void radiance(const vlWorld *world, const vlEnvironment *env, const vlEmitted *e,
                     const vlPaths *paths, uint32_t padded, Block *b) {
  read_colors(env, world->images.items[e->image].mipmap, e->image_scale, padded, b);
  if (world->def.color == VL_COLOR_RGB) {
    for (uint32_t k = 0; k < padded; k++) {
      vlVec3 rgb = vl_to_srgb(&e->to_srgb, vl_lane3(b->rgb[0], b->rgb[1], b->rgb[2], k));
      rgb = vl_mul(rgb, e->spectrum.scale);
      vl_set_lane3(b->radiance[0], b->radiance[1], b->radiance[2], k, rgb);
      b->radiance[3][k] = 0.0f;
    }
    return;
  }
  for (int c = 0; c < 4; c++)
    for (uint32_t k = 0; k < padded; k++)
      b->lambda[c][k] = paths->lambda[c][b->lane[k]];
  vl_upsample_rows(vl_rgb_table(e->space), false, padded, b->rgb, b->lambda, b->radiance);
  illuminate(&e->spectrum, padded, b);
}

/* ---- light samples ----------------------------------------------------------------------- */

/* Converts positions s, t to directions. */
static void directions(const vlEnvironment *env, uint32_t padded, Block *restrict b) {
  const float *m = env->world_from_light;
  const float turn[9] = {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]};
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < padded; k++) {
    vlVec3 w = vl_normalize(vl_turn(turn, vl_octahedral_decode(b->s[k], b->t[k])));
    vl_set_lane3(b->wx, b->wy, b->wz, k, w);
  }
}

static void choose_cells(const vlEnvironment *env, const vlMipmap *mip, const float *u,
                         const float *v, uint32_t padded, Block *b) {
  for (uint32_t k = 0; k < padded; k++) {
    uint32_t i = b->lane[k], y = vl_environment_row(env, v[i], &b->dy[k]);
    b->y[k] = y;
    b->u[k] = u[i];
    request(env->cell_guide + (size_t)y * VL_GUIDES + vl_guide_index(u[i])); /* must prefetch */
  }
  for (uint32_t k = 0; k < padded; k++)
    request(env->below + (size_t)b->y[k] * (env->size + 1) +
            env->cell_guide[(size_t)b->y[k] * VL_GUIDES + vl_guide_index(b->u[k])]);
  for (uint32_t k = 0; k < padded; k++) {
    uint32_t x = vl_environment_cell(env, b->y[k], b->u[k], &b->dx[k]);
    b->s[k] = ((float)x + b->dx[k]) / (float)env->size;
    b->t[k] = ((float)b->y[k] + b->dy[k]) / (float)env->size;
    b->cell[k] = b->y[k] * env->size + x;
    request(env->cells + b->cell[k]);
    request_texel(env, mip, b->s[k], b->t[k]); /* must prefetch */
  }
}

void vl_sample_environment(const vlWorld *world, const vlWorldLight *light,
                           const vlPaths *paths, const uint32_t *lanes, uint32_t count,
                           const float *u, const float *v, vlLightSamples *out) {
  const vlEnvironment *env = &world->environments.items[light->environment];
  const vlEmitted *e = &world->emitted.items[light->emitted];
  Block b;
  uint32_t padded = fill_lanes(&b, lanes, count);
  choose_cells(env, world->images.items[e->image].mipmap, u, v, padded, &b);
  directions(env, padded, &b);
  radiance(world, env, e, paths, padded, &b);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = b.lane[k];
    out->delta[i] = false;
    out->distant[i] = true;
    float pdf = env->cells[b.cell[k]].pdf * (0.25f * VL_INV_PI);
    if (!(pdf > 0.0f) || !(pdf < VL_INFINITY))
      continue;
    float total = pdf * out->pmf[i], inv = 1.0f / total;
    out->pdf[i] = total;
    out->w.x[i] = out->target.x[i] = b.wx[k];
    out->w.y[i] = out->target.y[i] = b.wy[k];
    out->w.z[i] = out->target.z[i] = b.wz[k];
    for (int c = 0; c < 4; c++)
      out->radiance[c][i] = b.radiance[c][k] * inv;
  }
}

/* ---- rays that hit nothing --------------------------------------------------------------- */

/* Converts the rays' directions to positions s, t. */
static void squares(const vlEnvironment *env, const vlPaths *paths, uint32_t padded,
                    Block *restrict b) {
  const float *m = env->light_from_world;
  const float turn[9] = {m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]};
  for (uint32_t k = 0; k < padded; k++) {
    uint32_t i = b->lane[k];
    vl_set_lane3(b->wx, b->wy, b->wz, k, vl_row3(&paths->d, i));
  }
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < padded; k++) {
    vlVec3 d = vl_vec3(b->wx[k], b->wy[k], b->wz[k]);
    vlVec2 st = vl_octahedral_encode(vl_normalize(vl_turn(turn, d)));
    b->s[k] = st.x;
    b->t[k] = st.y;
  }
}

void vl_hit_environment(const vlWorld *world, const vlWorldLight *light, const vlPaths *paths,
                        const uint32_t *lanes, uint32_t count, vlSkyHits *out) {
  const vlEnvironment *env = &world->environments.items[light->environment];
  const vlEmitted *e = &world->emitted.items[light->emitted];
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  Block b;
  uint32_t padded = fill_lanes(&b, lanes, count);
  squares(env, paths, padded, &b);
  for (uint32_t k = 0; k < padded; k++) {
    b.cell[k] = vl_environment_at(env, b.s[k], b.t[k]);
    request(env->cells + b.cell[k]);
    request_texel(env, mip, b.s[k], b.t[k]);
  }
  radiance(world, env, e, paths, padded, &b);
  for (uint32_t k = 0; k < count; k++) {
    for (int c = 0; c < 4; c++)
      out->radiance[c][k] = b.radiance[c][k];
    out->pdf[k] =
        paths->specular[b.lane[k]] ? 0.0f : env->cells[b.cell[k]].pdf * (0.25f * VL_INV_PI);
  }
}
