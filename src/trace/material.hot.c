/* trace/material.hot.c: a run of lanes with one material: textures evaluated node by node over the run, bump and normal
 * maps, BSDF parameters; then shading frames for all. */
#include "trace/stages.h"
#include "world/texture_lookup.h"

/* A run of lanes and a stack of scratch rows for nested textures. */
typedef struct Run {
  const vlWorld *world;
  vlTraceScratch *s;
  const vlPaths *paths;
  const vlSurface *surface;
  uint32_t first, last;
  uint32_t top;                                                 /* first free row */
  const float *shift_u, *shift_v, *shift_x, *shift_y, *shift_z; /* added to uv and position (bump), or null */
} Run;

static inline vlTexturePoint point_of(const Run *r, uint32_t i) {
  const vlSurface *f = r->surface;
  vlTexturePoint at;
  at.u = f->u[i], at.v = f->v[i];
  at.p = vl_vec3(f->px[i], f->py[i], f->pz[i]);
  at.n = vl_vec3(f->gx[i], f->gy[i], f->gz[i]); /* the true surface's, as pbrt's */
  at.width = f->width[i];
  at.uv_width = f->width[i] * f->uv_scale[i];
  if (r->shift_u) {
    at.u += r->shift_u[i], at.v += r->shift_v[i];
    at.p = vl_add(at.p, vl_vec3(r->shift_x[i], r->shift_y[i], r->shift_z[i]));
  }
  return at;
}

static float *push_row(Run *r) {
  return r->s->rows[r->top < VL_TEXTURE_ROWS - 1 ? r->top++ : r->top]; /* enough: world/texture.c limits nesting */
}

static void eval_float(Run *r, int32_t index, float *out);
static void eval_spectrum(Run *r, int32_t index, float *const out[4]);

/* Weight of the second input of mix-like nodes, in w. */
static void mix_weight(Run *r, const vlTextureNode *node, float *w) {
  if (node->kind == VL_NODE_MIX) {
    eval_float(r, node->amount, w);
    return;
  }
  for (uint32_t i = r->first; i < r->last; i++) {
    vlTexturePoint at = point_of(r, i);
    if (node->kind == VL_NODE_CHECKERBOARD)
      w[i] = vl_texture_checker(node, at);
    else
      w[i] = 1.0f - vl_abs(vl_dot(at.n, vl_vec3(node->direction[0], node->direction[1], node->direction[2])));
  }
}

static void bilerp_weights(Run *r, const vlTextureNode *node, float *const w[4]) {
  for (uint32_t i = r->first; i < r->last; i++) {
    vlVec2 st = vl_texture_st(node, point_of(r, i));
    w[0][i] = (1 - st.x) * (1 - st.y), w[1][i] = (1 - st.x) * st.y;
    w[2][i] = st.x * (1 - st.y), w[3][i] = st.x * st.y;
  }
}

static void eval_float(Run *r, int32_t index, float *out) {
  const vlTextureNode *node = &r->world->nodes.items[index];
  uint32_t top = r->top;
  switch (node->kind) {
    case VL_NODE_IMAGE: {
      const vlMipmap *mip = r->world->images.items[node->image].mipmap;
      for (uint32_t i = r->first; i < r->last; i++) out[i] = vl_texture_image_float(node, mip, point_of(r, i));
      break;
    }
    case VL_NODE_SCALE: {
      float *w = push_row(r);
      eval_float(r, node->a, out);
      eval_float(r, node->amount, w);
      for (uint32_t i = r->first; i < r->last; i++) out[i] = out[i] * w[i];
      break;
    }
    case VL_NODE_MIX:
    case VL_NODE_CHECKERBOARD:
    case VL_NODE_DIRECTION_MIX: {
      float *w = push_row(r), *b = push_row(r);
      mix_weight(r, node, w);
      eval_float(r, node->a, out);
      eval_float(r, node->b, b);
      for (uint32_t i = r->first; i < r->last; i++) out[i] = (1 - w[i]) * out[i] + w[i] * b[i];
      break;
    }
    case VL_NODE_BILERP: {
      float *w[4] = {push_row(r), push_row(r), push_row(r), push_row(r)}, *x = push_row(r);
      bilerp_weights(r, node, w);
      int32_t inputs[4] = {node->a, node->b, node->c, node->d};
      for (int k = 0; k < 4; k++) {
        eval_float(r, inputs[k], x);
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

static void constant_spectrum(const Run *r, const vlSpectral *s, float *const out[4]) {
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

/* A picture's colour at the wavelengths, by its role (pbrt book 10.4.1): albedos are clamped, others scaled. */
static void image_spectrum(Run *r, const vlTextureNode *node, float *const out[4]) {
  const vlMipmap *mip = r->world->images.items[node->image].mipmap;
  bool rgb_mode = r->world->def.color == VL_COLOR_RGB;
  const vlRgbTable *table = vl_rgb_table(node->space);
  for (uint32_t i = r->first; i < r->last; i++) {
    vlTexel t = vl_texture_image(node, mip, point_of(r, i));
    float c[3] = {t.c[0], mip->channels < 3 ? t.c[0] : t.c[1], mip->channels < 3 ? t.c[0] : t.c[2]};
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

static void eval_spectrum(Run *r, int32_t index, float *const out[4]) {
  const vlTextureNode *node = &r->world->nodes.items[index];
  uint32_t top = r->top;
  switch (node->kind) {
    case VL_NODE_SPECTRUM: constant_spectrum(r, &node->spectrum, out); break;
    case VL_NODE_IMAGE: image_spectrum(r, node, out); break;
    case VL_NODE_SCALE: {
      float *w = push_row(r);
      eval_spectrum(r, node->a, out);
      eval_float(r, node->amount, w);
      for (int c = 0; c < 4; c++)
        for (uint32_t i = r->first; i < r->last; i++) out[c][i] = out[c][i] * w[i];
      break;
    }
    case VL_NODE_MIX:
    case VL_NODE_CHECKERBOARD:
    case VL_NODE_DIRECTION_MIX: {
      float *w = push_row(r), *b[4] = {push_row(r), push_row(r), push_row(r), push_row(r)};
      mix_weight(r, node, w);
      eval_spectrum(r, node->a, out);
      eval_spectrum(r, node->b, b);
      for (int c = 0; c < 4; c++)
        for (uint32_t i = r->first; i < r->last; i++) out[c][i] = (1 - w[i]) * out[c][i] + w[i] * b[c][i];
      break;
    }
    case VL_NODE_BILERP: {
      float *w[4] = {push_row(r), push_row(r), push_row(r), push_row(r)};
      float *x[4] = {push_row(r), push_row(r), push_row(r), push_row(r)};
      bilerp_weights(r, node, w);
      int32_t inputs[4] = {node->a, node->b, node->c, node->d};
      for (int k = 0; k < 4; k++) {
        eval_spectrum(r, inputs[k], x);
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

/* ---- bump and normal maps: both turn the shading normal and dpdu ------------------------------------------------- */

static vlVec3 facing(vlVec3 n, vlVec3 side) {
  return vl_dot(n, side) < 0.0f ? vl_neg(n) : n;
}

/* Displaced positions to either side, by differences (pbrt book 10.5.3; the curvature term is left out: it is small
 * against the slope). */
static void bump(Run *r, int32_t node) { /* VL_BUMP_ROWS rows of its own */
  vlSurface *f = &r->s->surface;
  float *h = push_row(r), *hu = push_row(r), *hv = push_row(r), *step = push_row(r);
  float *su = push_row(r), *sv = push_row(r), *x = push_row(r), *y = push_row(r), *z = push_row(r);
  eval_float(r, node, h);
  for (uint32_t i = r->first; i < r->last; i++) {
    float w = 0.5f * f->width[i] * f->uv_scale[i];
    step[i] = w > 1e-6f ? w : 0.0005f;
  }
  r->shift_u = su, r->shift_v = sv, r->shift_x = x, r->shift_y = y, r->shift_z = z;
  for (uint32_t i = r->first; i < r->last; i++)
    su[i] = step[i], sv[i] = 0.0f, x[i] = step[i] * f->ux[i], y[i] = step[i] * f->uy[i], z[i] = step[i] * f->uz[i];
  eval_float(r, node, hu);
  for (uint32_t i = r->first; i < r->last; i++)
    su[i] = 0.0f, sv[i] = step[i], x[i] = step[i] * f->vx[i], y[i] = step[i] * f->vy[i], z[i] = step[i] * f->vz[i];
  eval_float(r, node, hv);
  r->shift_u = NULL;
  for (uint32_t i = r->first; i < r->last; i++) {
    vlVec3 n = vl_vec3(f->nx[i], f->ny[i], f->nz[i]);
    vlVec3 du = vl_add(vl_vec3(f->ux[i], f->uy[i], f->uz[i]), vl_mul(n, (hu[i] - h[i]) / step[i]));
    vlVec3 dv = vl_add(vl_vec3(f->vx[i], f->vy[i], f->vz[i]), vl_mul(n, (hv[i] - h[i]) / step[i]));
    vlVec3 m = vl_cross(du, dv);
    if (!(vl_length2(m) > 0.0f)) continue;
    m = facing(vl_normalize(m), n);
    f->nx[i] = m.x, f->ny[i] = m.y, f->nz[i] = m.z;
    f->ux[i] = du.x, f->uy[i] = du.y, f->uz[i] = du.z;
  }
}

static void normal_map(Run *r, int32_t image) {
  vlSurface *f = &r->s->surface;
  const vlMipmap *mip = r->world->images.items[image].mipmap;
  if (mip->channels < 3) return;
  for (uint32_t i = r->first; i < r->last; i++) {
    vlTexel t = vl_bilinear(mip, 0, f->u[i], 1.0f - f->v[i], VL_WRAP_REPEAT);
    vlVec3 local = vl_normalize(vl_vec3(2 * t.c[0] - 1, 2 * t.c[1] - 1, 2 * t.c[2] - 1));
    vlVec3 n = vl_vec3(f->nx[i], f->ny[i], f->nz[i]), u = vl_vec3(f->ux[i], f->uy[i], f->uz[i]);
    vlVec3 x = vl_normalize(vl_sub(u, vl_mul(n, vl_dot(u, n))));
    vlFrame frame = {x, vl_cross(n, x), n};
    vlVec3 m = vl_normalize(vl_from_local(frame, local));
    if (!(vl_length2(m) > 0.0f)) continue;
    f->nx[i] = m.x, f->ny[i] = m.y, f->nz[i] = m.z;
  }
}

/* ---- parameters -------------------------------------------------------------------------------------------------- */

static void roughness(Run *r, const vlWorldMaterial *m, int32_t node, float *alpha) {
  eval_float(r, node, alpha);
  for (uint32_t i = r->first; i < r->last; i++) {
    float x = alpha[i] > 0.0f ? alpha[i] : 0.0f;
    alpha[i] = m->remap ? __builtin_sqrtf(x) : x;
  }
}

static void spectrum_rows(Run *r, int32_t node, float rows[4][VL_ROW_SIZE]) {
  float *const out[4] = {rows[0], rows[1], rows[2], rows[3]};
  eval_spectrum(r, node, out);
}

void VL_HOT(vl_stage_material)(const vlWorld *world, uint32_t first, uint32_t last, uint32_t material,
                               vlTraceScratch *s) {
  const vlWorldMaterial *m = &world->materials.items[material];
  vlShade *shade = &s->shade;
  Run r = {world, s, &s->b, &s->surface, first, last, 0, NULL, NULL, NULL, NULL, NULL};
  if (m->displacement >= 0) bump(&r, m->displacement);
  if (m->normal_map >= 0) normal_map(&r, m->normal_map);
  r.top = 0;
  if (m->reflectance >= 0) {
    spectrum_rows(&r, m->reflectance, shade->reflectance);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = first; i < last; i++) shade->reflectance[c][i] = vl_clamp(shade->reflectance[c][i], 0.0f, 1.0f);
  }
  if (m->kind == VL_MATERIAL_CONDUCTOR && m->use_reflectance) {
    /* eta = 1, k = 2 sqrt(R / (1 - R)) reflects R straight on (pbrt book 9.3.6's convention of the conductor material).
     */
    for (int c = 0; c < 4; c++)
      for (uint32_t i = first; i < last; i++) {
        float x = vl_clamp(shade->reflectance[c][i], 0.0f, 0.9999f);
        shade->eta[c][i] = 1.0f;
        shade->k[c][i] = 2.0f * __builtin_sqrtf(x / (1.0f - x));
      }
  } else {
    if (m->eta >= 0) spectrum_rows(&r, m->eta, shade->eta);
    if (m->k >= 0) spectrum_rows(&r, m->k, shade->k);
  }
  if (m->u_roughness >= 0) {
    roughness(&r, m, m->u_roughness, shade->alpha_x);
    roughness(&r, m, m->v_roughness, shade->alpha_y);
  }
  for (uint32_t i = first; i < last; i++) {
    shade->eta_s[i] = m->dispersive ? shade->eta[0][i] : m->eta_s;
    shade->coat[i] = m->coat;
  }
  if (m->dispersive) { /* each wavelength goes its own way: the hero alone is followed, with the weight of all four */
    vlPaths *p = &s->b;
    for (uint32_t i = first; i < last; i++) {
      /* That the hero is alone is told by equal wavelengths: weights may be zero for other reasons. */
      bool alone = p->lambda[1][i] == p->lambda[0][i];
      p->beta[0][i] *= alone ? 1.0f : 4.0f;
      p->beta[1][i] = p->beta[2][i] = p->beta[3][i] = 0.0f;
      p->lambda[1][i] = p->lambda[2][i] = p->lambda[3][i] = p->lambda[0][i];
    }
  }
}

void VL_HOT(vl_stage_frames)(uint32_t n, const vlPaths *paths, const vlSurface *f, vlShade *shade) {
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 nn = vl_vec3(f->nx[i], f->ny[i], f->nz[i]), u = vl_vec3(f->ux[i], f->uy[i], f->uz[i]);
    vlVec3 t = vl_sub(u, vl_mul(nn, vl_dot(u, nn)));
    float ok = vl_length2(t) > 1e-12f * vl_length2(u) ? 1.0f : 0.0f;
    vlFrame any = vl_frame_from_z(nn);
    t = vl_normalize(t);
    t.x = ok > 0.0f ? t.x : any.x.x, t.y = ok > 0.0f ? t.y : any.x.y, t.z = ok > 0.0f ? t.z : any.x.z;
    vlVec3 b = vl_cross(nn, t);
    shade->tx[i] = t.x, shade->ty[i] = t.y, shade->tz[i] = t.z;
    shade->bx[i] = b.x, shade->by[i] = b.y, shade->bz[i] = b.z;
    vlVec3 wo = vl_vec3(-paths->dx[i], -paths->dy[i], -paths->dz[i]);
    shade->wo[0][i] = vl_dot(wo, t), shade->wo[1][i] = vl_dot(wo, b), shade->wo[2][i] = vl_dot(wo, nn);
  }
}
