/* world/texture/texture_noise.h: noise textures at one point: fbm, wrinkled, windy, marble, dots. Patterns and
 * constants are those of pbrt (pbrt 3rd edition, 10.6; the fourth edition keeps them). */
#ifndef WORLD_TEXTURE_TEXTURE_NOISE_H
#define WORLD_TEXTURE_TEXTURE_NOISE_H

#include "math/noise.h"
#include "world/texture/texture_lookup.h"

/* Width of the footprint in texture space: its width in world units times the largest factor by which the map from
 * world to texture space stretches a length. */
static inline float vl_texture_space_width(const vlTextureNode *node, vlTexturePoint at) {
  const float *m = node->texture_from_world;
  float x = m[0] * m[0] + m[4] * m[4] + m[8] * m[8], y = m[1] * m[1] + m[5] * m[5] + m[9] * m[9];
  float z = m[2] * m[2] + m[6] * m[6] + m[10] * m[10];
  return at.width * __builtin_sqrtf(vl_max(x, vl_max(y, z)));
}

static inline float vl_node_fbm(const vlTextureNode *node, vlTexturePoint at) {
  return vl_fractal_noise(vl_texture_space(node, at.p), vl_texture_space_width(node, at), node->omega, node->octaves);
}

static inline float vl_node_wrinkled(const vlTextureNode *node, vlTexturePoint at) {
  return vl_turbulence(vl_texture_space(node, at.p), vl_texture_space_width(node, at), node->omega, node->octaves);
}

static inline float vl_node_windy(const vlTextureNode *node, vlTexturePoint at) {
  vlVec3 p = vl_texture_space(node, at.p);
  float width = vl_texture_space_width(node, at);
  float wind = vl_fractal_noise(vl_mul(p, 0.1f), 0.1f * width, 0.5f, 3);
  return vl_abs(wind) * vl_fractal_noise(p, width, 0.5f, 6);
}

/* Marble: the colour along a vein, from a spline over nine colours. */
static inline vlVec3 vl_node_marble(const vlTextureNode *node, vlTexturePoint at) {
  static const float colors[9][3] = {{.58f, .58f, .6f}, {.58f, .58f, .6f}, {.58f, .58f, .6f},
                                     {.5f, .5f, .5f},   {.6f, .59f, .58f}, {.58f, .58f, .6f},
                                     {.58f, .58f, .6f}, {.2f, .2f, .33f},  {.58f, .58f, .6f}};
  enum { SEGMENTS = 6 };
  vlVec3 p = vl_mul(vl_texture_space(node, at.p), node->scale);
  float width = vl_abs(node->scale) * vl_texture_space_width(node, at);
  float vein = p.y + node->variation * vl_fractal_noise(p, width, node->omega, node->octaves);
  float t = 0.5f + 0.5f * vl_sincos(vl_clamp(vein, -1e4f, 1e4f)).sin;
  float s = vl_clamp(t, 0.0f, 1.0f) * SEGMENTS;
  int first = (int)s < SEGMENTS - 1 ? (int)s : SEGMENTS - 1;
  s -= (float)first;
  float out[3];
  for (int k = 0; k < 3; k++) { /* cubic Bezier */
    float a = colors[first][k], b = colors[first + 1][k], c = colors[first + 2][k], d = colors[first + 3][k];
    float r = 1.0f - s;
    out[k] = 1.5f * (r * r * r * a + 3.0f * r * r * s * b + 3.0f * r * s * s * c + s * s * s * d);
  }
  return vl_vec3(out[0], out[1], out[2]);
}

/* 1 inside a dot, 0 outside. Texture space is divided into unit cells. About half of them contain a dot of radius 0.35
 * at a random place. */
static inline float vl_node_dots(const vlTextureNode *node, vlTexturePoint at) {
  const float radius = 0.35f, shift = 0.5f - radius;
  vlVec2 st = vl_texture_st(node, at);
  float s = __builtin_floorf(st.x + 0.5f), t = __builtin_floorf(st.y + 0.5f);
  if (!(vl_noise(s + 0.5f, t + 0.5f, 0.5f) > 0.0f)) return 0.0f;
  float x = st.x - (s + shift * vl_noise(s + 1.5f, t + 2.8f, 0.5f));
  float y = st.y - (t + shift * vl_noise(s + 4.5f, t + 9.8f, 0.5f));
  return x * x + y * y < radius * radius ? 1.0f : 0.0f;
}

#endif
