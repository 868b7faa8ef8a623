/* trace/texture/texture.hot.c: textures over a run of lanes that share a material: floats, and spectra at each lane's
 * four wavelengths. A node's inputs are evaluated into rows of a stack, then combined. */
#include "trace/texture/texture_run.h"

/* Weight of the second input of mix-like nodes, in w. */
static void mix_weight(vlTextureRun *r, const vlTextureNode *node, float *w) {
  if (node->kind == VL_NODE_MIX) {
    vl_texture_float(r, node->amount, w);
    return;
  }
  for (uint32_t i = r->first; i < r->last; i++) {
    vlTexturePoint at = vl_texture_point_of(r, node, i);
    if (node->kind == VL_NODE_CHECKERBOARD)
      w[i] = vl_texture_checker(node, at);
    else if (node->kind == VL_NODE_DOTS)
      w[i] = vl_texture_dots(node, at);
    else
      w[i] = 1.0f - vl_abs(vl_dot(at.n, vl_vec3(node->direction[0], node->direction[1], node->direction[2])));
  }
}

static void bilerp_weights(vlTextureRun *r, const vlTextureNode *node, float *const w[4]) {
  for (uint32_t i = r->first; i < r->last; i++) {
    vlVec2 st = vl_texture_st(node, vl_texture_point_of(r, node, i));
    w[0][i] = (1 - st.x) * (1 - st.y), w[1][i] = (1 - st.x) * st.y;
    w[2][i] = st.x * (1 - st.y), w[3][i] = st.x * st.y;
  }
}

void vl_texture_float(vlTextureRun *r, int32_t index, float *out) {
  const vlTextureNode *node = &r->world->nodes.items[index];
  uint32_t top = r->top;
  switch (node->kind) {
    case VL_NODE_IMAGE: {
      const vlMipmap *mip = r->world->images.items[node->image].mipmap;
      for (uint32_t i = r->first; i < r->last; i++)
        out[i] = vl_texture_image_float(node, mip, vl_texture_point_of(r, node, i));
      break;
    }
    case VL_NODE_FBM:
    case VL_NODE_WRINKLED:
    case VL_NODE_WINDY:
      for (uint32_t i = r->first; i < r->last; i++) out[i] = vl_texture_noise(node, vl_texture_point_of(r, node, i));
      break;
    case VL_NODE_VERTEX_COLOR:
      for (uint32_t i = r->first; i < r->last; i++)
        out[i] = vl_texture_channel(node, NULL, vl_texture_point_of(r, node, i));
      break;
    case VL_NODE_SCALE: {
      float *w = vl_texture_row(r);
      vl_texture_float(r, node->a, out);
      vl_texture_float(r, node->amount, w);
      for (uint32_t i = r->first; i < r->last; i++) out[i] = out[i] * w[i];
      break;
    }
    case VL_NODE_MIX:
    case VL_NODE_CHECKERBOARD:
    case VL_NODE_DOTS:
    case VL_NODE_DIRECTION_MIX: {
      float *w = vl_texture_row(r), *b = vl_texture_row(r);
      mix_weight(r, node, w);
      vl_texture_float(r, node->a, out);
      vl_texture_float(r, node->b, b);
      for (uint32_t i = r->first; i < r->last; i++) out[i] = (1 - w[i]) * out[i] + w[i] * b[i];
      break;
    }
    case VL_NODE_BILERP: {
      float *w[4] = {vl_texture_row(r), vl_texture_row(r), vl_texture_row(r), vl_texture_row(r)},
            *x = vl_texture_row(r);
      bilerp_weights(r, node, w);
      int32_t inputs[4] = {node->a, node->b, node->c, node->d};
      for (int k = 0; k < 4; k++) {
        vl_texture_float(r, inputs[k], x);
        for (uint32_t i = r->first; i < r->last; i++) out[i] = (k ? out[i] : 0.0f) + w[k][i] * x[i];
      }
      break;
    }
    default:
      for (uint32_t i = r->first; i < r->last; i++) out[i] = node->value;
      break;
  }
  r->top = top;
}

static void constant_spectrum(const vlTextureRun *r, const vlSpectral *s, float *const out[4]) {
  for (int c = 0; c < 4; c++) {
    const float *lambda = r->paths->lambda[c];
    if (s->kind == VL_SPECTRAL_SIGMOID) {
      VL_SIMD
      for (uint32_t i = r->first; i < r->last; i++) out[c][i] = s->scale * vl_sigmoid(s->sigmoid, lambda[i]);
    } else if (s->kind == VL_SPECTRAL_DENSE) {
      VL_SIMD
      for (uint32_t i = r->first; i < r->last; i++) out[c][i] = s->scale * vl_dense_at(s->dense, lambda[i]);
    } else {
      float x = s->kind == VL_SPECTRAL_RGB ? (c < 3 ? s->scale * s->rgb[c] : 0.0f) : s->scale;
      VL_SIMD
      for (uint32_t i = r->first; i < r->last; i++) out[c][i] = x;
    }
  }
}

/* The colour of a picture, of vertices, of marble. */
static void rgb_at(const vlTextureRun *r, const vlTextureNode *node, const vlMipmap *mip, uint32_t i, float c[3]) {
  vlTexturePoint at = vl_texture_point_of(r, node, i);
  if (node->kind == VL_NODE_MARBLE) {
    vlVec3 m = vl_texture_marble(node, at);
    c[0] = m.x, c[1] = m.y, c[2] = m.z;
    return;
  }
  vlTexel t = node->plain ? vl_texture_image(node, mip, at) : vl_texture_rgba(node, mip, at);
  bool grey = node->plain && mip->channels < 3;
  c[0] = t.c[0], c[1] = grey ? t.c[0] : t.c[1], c[2] = grey ? t.c[0] : t.c[2];
}

/* Such a colour at the wavelengths, by its role (pbrt book 10.4.1): albedos are clamped, others scaled. */
static void image_spectrum(vlTextureRun *r, const vlTextureNode *node, float *const out[4]) {
  const vlMipmap *mip = node->kind == VL_NODE_IMAGE ? r->world->images.items[node->image].mipmap : NULL;
  bool rgb_mode = r->world->def.color == VL_COLOR_RGB;
  const vlRgbTable *table = vl_rgb_table(node->space);
  for (uint32_t i = r->first; i < r->last; i++) {
    float c[3];
    rgb_at(r, node, mip, i, c);
    if (node->role == VL_ROLE_ALBEDO)
      for (int k = 0; k < 3; k++) c[k] = c[k] > 1.0f ? 1.0f : c[k];
    if (rgb_mode) {
      for (int k = 0; k < 4; k++) out[k][i] = k < 3 ? c[k] : 0.0f;
      continue;
    }
    float m = vl_max(c[0], vl_max(c[1], c[2]));
    float scale = node->role == VL_ROLE_ALBEDO ? 1.0f : 2.0f * m, inv = scale > 0.0f ? 1.0f / scale : 0.0f;
    vlSigmoid s = vl_rgb_table_lookup(table, c[0] * inv, c[1] * inv, c[2] * inv);
    for (int k = 0; k < 4; k++) {
      float lambda = r->paths->lambda[k][i];
      float x = scale * vl_sigmoid(s, lambda);
      out[k][i] = node->role == VL_ROLE_ILLUMINANT ? x * vl_dense_at(node->spectrum.dense, lambda) : x;
    }
  }
}

void vl_texture_spectrum(vlTextureRun *r, int32_t index, float *const out[4]) {
  const vlTextureNode *node = &r->world->nodes.items[index];
  uint32_t top = r->top;
  switch (node->kind) {
    case VL_NODE_SPECTRUM: constant_spectrum(r, &node->spectrum, out); break;
    case VL_NODE_IMAGE:
    case VL_NODE_MARBLE:
    case VL_NODE_VERTEX_COLOR: image_spectrum(r, node, out); break;
    case VL_NODE_SCALE: {
      float *w = vl_texture_row(r);
      vl_texture_spectrum(r, node->a, out);
      vl_texture_float(r, node->amount, w);
      for (int c = 0; c < 4; c++)
        for (uint32_t i = r->first; i < r->last; i++) out[c][i] = out[c][i] * w[i];
      break;
    }
    case VL_NODE_MIX:
    case VL_NODE_CHECKERBOARD:
    case VL_NODE_DOTS:
    case VL_NODE_DIRECTION_MIX: {
      float *w = vl_texture_row(r),
            *b[4] = {vl_texture_row(r), vl_texture_row(r), vl_texture_row(r), vl_texture_row(r)};
      mix_weight(r, node, w);
      vl_texture_spectrum(r, node->a, out);
      vl_texture_spectrum(r, node->b, b);
      for (int c = 0; c < 4; c++)
        for (uint32_t i = r->first; i < r->last; i++) out[c][i] = (1 - w[i]) * out[c][i] + w[i] * b[c][i];
      break;
    }
    case VL_NODE_BILERP: {
      float *w[4] = {vl_texture_row(r), vl_texture_row(r), vl_texture_row(r), vl_texture_row(r)};
      float *x[4] = {vl_texture_row(r), vl_texture_row(r), vl_texture_row(r), vl_texture_row(r)};
      bilerp_weights(r, node, w);
      int32_t inputs[4] = {node->a, node->b, node->c, node->d};
      for (int k = 0; k < 4; k++) {
        vl_texture_spectrum(r, inputs[k], x);
        for (int c = 0; c < 4; c++)
          for (uint32_t i = r->first; i < r->last; i++) out[c][i] = (k ? out[c][i] : 0.0f) + w[k][i] * x[c][i];
      }
      break;
    }
    default:
      for (int c = 0; c < 4; c++)
        for (uint32_t i = r->first; i < r->last; i++) out[c][i] = 0.0f;
      break;
  }
  r->top = top;
}
