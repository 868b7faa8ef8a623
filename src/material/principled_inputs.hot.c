/* material/principled_inputs.hot.c: the principled material's parameters over a run of lanes:
 * textures, normal maps, tangent. */
#include "material/inputs.hot.h"
#include "material/principled.h"

static void fill(float *row, uint32_t first, uint32_t last, float x) {
  for (uint32_t i = first; i < last; i++)
    row[i] = x;
}

static void share(vlTextureRun *r, int32_t node, float *row) {
  vl_texture_float(r, node, row);
  for (uint32_t i = r->first; i < r->last; i++)
    row[i] = vl_clamp(row[i], 0.0f, 1.0f);
}

/* ---- normals ----------------------------------------------------------------------------- */

/* The normal of a tangent-space normal map. Its green axis is along dpdv, as in glTF (up in the
 * image). */
static vlVec3 mapped(const vlTextureRun *r, const vlTextureNode *node, float scale,
                     uint32_t i) {
  const vlSurface *f = &r->at->surface;
  vlTexel t = vl_texture_texel(r, node, i);
  vlVec3 local =
      vl_normalize(vl_vec3(scale * (2 * t.c[0] - 1), scale * (2 * t.c[1] - 1), 2 * t.c[2] - 1));
  vlVec3 n = vl_row3(&f->n, i), u = vl_row3(&f->dpdu, i), v = vl_row3(&f->dpdv, i);
  vlVec3 x = vl_normalize(vl_sub(u, vl_mul(n, vl_dot(u, n)))), y = vl_cross(n, x);
  y = vl_dot(y, v) < 0.0f ? vl_neg(y) : y; /* mirrored uv */
  vlVec3 m = vl_normalize(vl_from_local((vlFrame){x, y, n}, local));
  return vl_length2(m) > 0.0f ? m : n;
}

static bool is_map(const vlTextureRun *r, int32_t node) {
  return node >= 0 && r->world->nodes.items[node].image >= 0 &&
         r->world->images.items[r->world->nodes.items[node].image].mipmap->channels >= 3;
}

/* The normals of base and coat. The coat has the interpolated vertex normal unless it has its
 * own map; it stays in world space until the frames are computed. */
static void normals(vlTextureRun *r, const vlWorldPrincipled *p) {
  vlSurface *f = &r->at->surface;
  float(*rows)[VL_ROW_SIZE] = r->at->shade.own;
  if (p->has_coat) {
    bool map = is_map(r, p->coat_normal);
    for (uint32_t i = r->first; i < r->last; i++) {
      vlVec3 c =
          map ? mapped(r, &r->world->nodes.items[p->coat_normal], p->coat_normal_scale, i)
              : vl_row3(&f->n, i);
      rows[VL_P_COAT_X][i] = c.x;
      rows[VL_P_COAT_Y][i] = c.y;
      rows[VL_P_COAT_Z][i] = c.z;
    }
  }
  if (!is_map(r, p->normal))
    return;
  const vlTextureNode *node = &r->world->nodes.items[p->normal];
  for (uint32_t i = r->first; i < r->last; i++) {
    vlVec3 m = mapped(r, node, p->normal_scale, i);
    vl_set_row3(&f->n, i, m);
  }
}

/* Rotates dpdu around the normal. The result is the tangent of the anisotropic microfacets. */
static void turn_tangent(vlTextureRun *r, const float *angle) {
  vlSurface *f = &r->at->surface;
  for (uint32_t i = r->first; i < r->last; i++) {
    vlSinCos a = vl_sincos(angle[i]);
    vlVec3 n = vl_row3(&f->n, i), u = vl_row3(&f->dpdu, i);
    vlVec3 x = vl_normalize(vl_sub(u, vl_mul(n, vl_dot(u, n)))), y = vl_cross(n, x);
    y = vl_dot(y, vl_row3(&f->dpdv, i)) < 0.0f ? vl_neg(y) : y;
    vlVec3 t = vl_add(vl_mul(x, a.cos), vl_mul(y, a.sin));
    vl_set_row3(&f->dpdu, i, t);
  }
}

/* ---- parameters -------------------------------------------------------------------------- */

static void layers(vlTextureRun *r, const vlWorldPrincipled *p, float (*rows)[VL_ROW_SIZE]) {
  uint32_t first = r->first, last = r->last;
  fill(rows[VL_P_COAT], first, last, 0.0f);
  fill(rows[VL_P_FILM], first, last, 0.0f);
  for (int c = 0; c < 4; c++)
    fill(rows[VL_P_SHEEN + c], first, last, 0.0f);
  if (p->has_coat) {
    share(r, p->clearcoat, rows[VL_P_COAT]);
    share(r, p->clearcoat_roughness, rows[VL_P_COAT_ALPHA]);
    for (uint32_t i = first; i < last; i++) {
      float x = rows[VL_P_COAT_ALPHA][i];
      rows[VL_P_COAT_ALPHA][i] = vl_max(x * x, 1e-3f);
    }
  }
  if (p->has_sheen) {
    vl_texture_albedo(r, p->sheen, 1.0f, rows + VL_P_SHEEN);
    share(r, p->sheen_roughness, rows[VL_P_SHEEN_ALPHA]);
    for (uint32_t i = first; i < last; i++) {
      float x = rows[VL_P_SHEEN_ALPHA][i];
      rows[VL_P_SHEEN_ALPHA][i] = vl_max(x * x, VL_SHEEN_ALPHA);
    }
  }
  if (p->has_film) {
    share(r, p->iridescence, rows[VL_P_FILM]);
    vl_texture_float(r, p->iridescence_thickness, rows[VL_P_FILM_NM]);
    fill(rows[VL_P_FILM_INDEX], first, last, p->film_index);
    for (uint32_t i = first; i < last; i++)
      rows[VL_P_FILM_NM][i] = vl_max(rows[VL_P_FILM_NM][i], 0.0f);
  }
}

void vl_stage_principled(vlTextureRun *r, const vlWorldMaterial *m) {
  const vlWorldPrincipled *p = m->principled;
  vlShade *shade = &r->at->shade;
  float(*rows)[VL_ROW_SIZE] = shade->own;
  uint32_t first = r->first, last = r->last;
  normals(r, p);
  share(r, p->metallic, rows[VL_P_METALLIC]);
  share(r, p->specular, rows[VL_P_F90]);
  share(r, p->transmission, rows[VL_P_TRANSMISSION]);
  fill(rows[VL_P_THIN], first, last, p->thin ? 1.0f : 0.0f);
  fill(rows[VL_P_DIFFUSE_TRANSMISSION], first, last, 0.0f);
  if (p->has_transmission) {
    share(r, p->diffuse_transmission, rows[VL_P_DIFFUSE_TRANSMISSION]);
    vl_texture_albedo(r, p->through, 1.0f, rows + VL_P_THROUGH);
  } else {
    for (int c = 0; c < 4; c++)
      fill(rows[VL_P_THROUGH + c], first, last, 0.0f);
  }
  float(*f0)[VL_ROW_SIZE] = rows + VL_P_F0;
  vl_texture_spectrum(r, p->specular_color, f0);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = first; i < last; i++)
      f0[c][i] = vl_clamp(p->f0 * f0[c][i], 0.0f, 1.0f) * rows[VL_P_F90][i];
  layers(r, p, rows);
  share(r, p->roughness, shade->alpha_x);
  for (uint32_t i = first; i < last; i++) {
    float alpha = vl_max(shade->alpha_x[i] * shade->alpha_x[i], 1e-3f);
    shade->alpha_x[i] = shade->alpha_y[i] = alpha;
  }
  if (p->has_anisotropy) {
    float *angle = vl_texture_row(r);
    vl_texture_float(r, p->anisotropy_rotation, angle);
    turn_tangent(r, angle);
    share(r, p->anisotropy, angle);
    for (uint32_t i = first; i < last; i++)
      shade->alpha_x[i] = shade->alpha_y[i] + (1.0f - shade->alpha_y[i]) * angle[i] * angle[i];
  }
  for (uint32_t i = first; i < last; i++) {
    float lambda = r->at->paths.lambda[0][i];
    shade->eta_s[i] =
        m->dispersive ? vl_max(p->cauchy_a + p->cauchy_b / (lambda * lambda), 1.0f) : m->eta_s;
  }
}

/* Converts the coat's normals of a run from world space to the shading frames. */
void vl_stage_coat_frames(const vlSurface *f, vlShade *shade, uint32_t first, uint32_t last) {
  float(*rows)[VL_ROW_SIZE] = shade->own;
  for (uint32_t i = first; i < last; i++) {
    vlVec3 c = vl_vec3(rows[VL_P_COAT_X][i], rows[VL_P_COAT_Y][i], rows[VL_P_COAT_Z][i]);
    if (!(rows[VL_P_COAT][i] > 0.0f))
      c = vl_row3(&f->n, i);
    vlVec3 local = vl_to_local(vl_shading_frame(f, shade, i), c);
    vl_set_lane3(rows[VL_P_COAT_X], rows[VL_P_COAT_Y], rows[VL_P_COAT_Z], i, local);
  }
}
