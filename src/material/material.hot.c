/* material/material.hot.c: shading of a run of lanes with one material: bump and normal
 * maps, BSDF parameters from textures; then shading frames for all lanes. */
#include "material/inputs.hot.h"
#include "material/kinds.row.h"
#include "velo/schema.h"
#include "velo/shape.h"

/* Shifts of uv for bump maps. Those below MIN_STEP are a few roundings of a uv near 1 (6e-8):
 * the difference of heights would be noise. DEFAULT_STEP is pbrt's for surfaces without a
 * footprint. */
#define MIN_STEP 1e-6f
#define DEFAULT_STEP 0.0005f
/* Squared sine (1e-6 squared) of the angle between a tangent and the normal. Below it, the
 * tangent is mostly rounding error. */
#define PARALLEL 1e-12f

/* ---- bump and normal maps: both change the shading normal and dpdu ----------------------- */

/* n, or -n, on the side of `side`. */
static vlVec3 facing(vlVec3 n, vlVec3 side) {
  return vl_dot(n, side) < 0.0f ? vl_neg(n) : n;
}

/* Computes dndu and dndv of the interpolated normals of lane i's triangle: 0 without normals or
 * uv. */
static void triangle_normal_slopes(const vlCorners *c, vlSurface *f, uint32_t i) {
  vlVec2 b = vl_corner_weights(c, i, vl_row3(&f->p, i));
  vlVec3 n = vl_corner(c->n, 0, i), m1 = vl_sub(vl_corner(c->n, 1, i), n),
         m2 = vl_sub(vl_corner(c->n, 2, i), n);
  float length = vl_length(vl_add(n, vl_add(vl_mul(m1, b.x), vl_mul(m2, b.y))));
  float u1 = c->uv[2][i] - c->uv[0][i], v1 = c->uv[3][i] - c->uv[1][i];
  float u2 = c->uv[4][i] - c->uv[0][i], v2 = c->uv[5][i] - c->uv[1][i];
  float det = (u1 * v2 - v1 * u2) * length;
  float scale = f->uv_scale[i] > 0.0f && vl_abs(det) > 0.0f ? 1.0f / det : 0.0f;
  vlVec3 ns = vl_row3(&f->n, i);
  vlVec3 du = vl_mul(vl_sub(vl_mul(m1, v2), vl_mul(m2, v1)), scale);
  vlVec3 dv = vl_mul(vl_sub(vl_mul(m2, u1), vl_mul(m1, u2)), scale);
  du = vl_sub(du, vl_mul(ns, vl_dot(du, ns)));
  dv = vl_sub(dv, vl_mul(ns, vl_dot(dv, ns)));
  vl_set_lane3(f->dn[0], f->dn[1], f->dn[2], i, du);
  vl_set_lane3(f->dn[3], f->dn[4], f->dn[5], i, dv);
}

/* A tangent of a flat face, turned as its normal g is turned to n: a tangent of the smooth
 * surface that the vertex normals stand for. Without it, a bump map would show the faces. */
static vlVec3 turned(vlVec3 tangent, vlVec3 g, vlVec3 n) {
  float share = vl_dot(n, tangent) / (1.0f + vl_dot(g, n));
  return vl_sub(tangent, vl_mul(vl_add(g, n), share));
}

/* Bump mapping: the surface p + h n has the derivatives dpdu + h' n + h dndu, and likewise in
 * v; h' by finite differences (pbrt book 10.5.3). */
static void bump(vlTextureRun *r, int32_t node) { /* uses VL_BUMP_ROWS rows */
  vlSurface *f = &r->at->surface;
  float *h = vl_texture_row(r), *hu = vl_texture_row(r), *hv = vl_texture_row(r),
        *step = vl_texture_row(r);
  float *su = vl_texture_row(r), *sv = vl_texture_row(r), *x = vl_texture_row(r),
        *y = vl_texture_row(r), *z = vl_texture_row(r);
  vl_texture_float(r, node, h);
  for (uint32_t i = r->first; i < r->last; i++) {
    float w = 0.5f * f->width[i] * f->uv_scale[i];
    step[i] = w > MIN_STEP ? w : DEFAULT_STEP;
  }
  r->shift_u = su;
  r->shift_v = sv;
  r->shift_x = x;
  r->shift_y = y;
  r->shift_z = z;
  for (uint32_t i = r->first; i < r->last; i++) {
    su[i] = step[i];
    sv[i] = 0.0f;
    x[i] = step[i] * f->dpdu.x[i];
    y[i] = step[i] * f->dpdu.y[i];
    z[i] = step[i] * f->dpdu.z[i];
  }
  vl_texture_float(r, node, hu);
  for (uint32_t i = r->first; i < r->last; i++) {
    su[i] = 0.0f;
    sv[i] = step[i];
    x[i] = step[i] * f->dpdv.x[i];
    y[i] = step[i] * f->dpdv.y[i];
    z[i] = step[i] * f->dpdv.z[i];
  }
  vl_texture_float(r, node, hv);
  r->shift_u = NULL;
  for (uint32_t i = r->first; i < r->last; i++) {
    if (r->world->shapes.items[r->at->hits.shape[i]].triangles)
      triangle_normal_slopes(&r->s->corners, f, i);
    vlVec3 n = vl_row3(&f->n, i);
    vlVec3 g = facing(vl_row3(&f->g, i), n);
    vlVec3 du = turned(vl_row3(&f->dpdu, i), g, n);
    vlVec3 dv = turned(vl_row3(&f->dpdv, i), g, n);
    du = vl_add(du, vl_mul(n, (hu[i] - h[i]) / step[i]));
    dv = vl_add(dv, vl_mul(n, (hv[i] - h[i]) / step[i]));
    du = vl_add(du, vl_mul(vl_lane3(f->dn[0], f->dn[1], f->dn[2], i), h[i]));
    dv = vl_add(dv, vl_mul(vl_lane3(f->dn[3], f->dn[4], f->dn[5], i), h[i]));
    vlVec3 m = vl_cross(du, dv);
    if (!(vl_length2(m) > 0.0f))
      continue;
    m = facing(vl_normalize(m), n);
    vl_set_row3(&f->n, i, m);
    vl_set_row3(&f->dpdu, i, du);
  }
}

static void normal_map(vlTextureRun *r, int32_t image) {
  vlSurface *f = &r->at->surface;
  const vlMipmap *mip = r->world->images.items[image].mipmap;
  if (mip->channels < 3)
    return;
  for (uint32_t i = r->first; i < r->last; i++) {
    vlTexel t = vl_bilinear(mip, f->u[i], 1.0f - f->v[i], VL_WRAP_REPEAT);
    vlVec3 local = vl_normalize(vl_vec3(2 * t.c[0] - 1, 2 * t.c[1] - 1, 2 * t.c[2] - 1));
    vlVec3 n = vl_row3(&f->n, i), u = vl_row3(&f->dpdu, i);
    vlVec3 x = vl_normalize(vl_sub(u, vl_mul(n, vl_dot(u, n))));
    vlFrame frame = {x, vl_cross(n, x), n};
    vlVec3 m = vl_normalize(vl_from_local(frame, local));
    if (!(vl_length2(m) > 0.0f))
      continue;
    vl_set_row3(&f->n, i, m);
  }
}

/* ---- parameters -------------------------------------------------------------------------- */

static void reflectance(vlTextureRun *r, const vlWorldMaterial *m) {
  vlShade *shade = &r->at->shade;
  if (m->reflectance < 0)
    return;
  vl_texture_albedo(r, m->reflectance, 1.0f, shade->reflectance);
}

static void metal(vlTextureRun *r, const vlWorldMaterial *m) {
  vlShade *shade = &r->at->shade;
  if (!m->use_reflectance) {
    vl_texture_spectrum(r, m->eta, shade->eta);
    vl_texture_spectrum(r, m->k, shade->k);
    return;
  }
  /* eta = 1, k = 2 sqrt(R / (1 - R)) gives reflectance R at normal incidence (pbrt book 9.3.6's
   * conductor material). */
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++) {
      float x = vl_clamp(shade->reflectance[c][i], 0.0f, 0.9999f);
      shade->eta[c][i] = 1.0f;
      shade->k[c][i] = 2.0f * __builtin_sqrtf(x / (1.0f - x));
    }
}

void vl_stage_roughness(vlTextureRun *r, const vlWorldMaterial *m, int32_t node, float *alpha) {
  vl_texture_float(r, node, alpha);
  for (uint32_t i = r->first; i < r->last; i++) {
    float x = alpha[i] > 0.0f ? alpha[i] : 0.0f;
    alpha[i] = m->remap ? __builtin_sqrtf(x) : x;
  }
}

static void alphas(vlTextureRun *r, const vlWorldMaterial *m) {
  vl_stage_roughness(r, m, m->u_roughness, r->at->shade.alpha_x);
  vl_stage_roughness(r, m, m->v_roughness, r->at->shade.alpha_y);
}

static void index_of_refraction(vlTextureRun *r, const vlWorldMaterial *m) {
  vlShade *shade = &r->at->shade;
  if (m->dispersive)
    vl_texture_spectrum(r, m->eta, shade->eta);
  for (uint32_t i = r->first; i < r->last; i++)
    shade->eta_s[i] = m->dispersive ? shade->eta[0][i] : m->eta_s;
}

#define DECLARE(kind, name, parameters, eval, sample) vlParametersFn parameters;
VL_BSDF_KINDS(DECLARE)

void vl_parameters_diffuse(vlTextureRun *r, const vlWorldMaterial *m) {
  reflectance(r, m);
}

void vl_parameters_conductor(vlTextureRun *r, const vlWorldMaterial *m) {
  reflectance(r, m);
  metal(r, m);
  alphas(r, m);
}

void vl_parameters_dielectric(vlTextureRun *r, const vlWorldMaterial *m) {
  reflectance(r, m);
  alphas(r, m);
  if (m->subsurface)
    vl_stage_subsurface_inputs(r, m);
  index_of_refraction(r, m);
}

void vl_parameters_thin(vlTextureRun *r, const vlWorldMaterial *m) {
  index_of_refraction(r, m);
}

void vl_parameters_coat(vlTextureRun *r, const vlWorldMaterial *m) {
  reflectance(r, m);
  alphas(r, m);
  index_of_refraction(r, m);
  for (uint32_t i = r->first; i < r->last; i++)
    r->at->shade.coat[i] = m->coat;
}

void vl_parameters_layered(vlTextureRun *r, const vlWorldMaterial *m) {
  reflectance(r, m);
  if (m->traits & VL_MATERIAL_METAL)
    metal(r, m);
  alphas(r, m);
  vl_stage_layers(r, m);
  index_of_refraction(r, m);
}

void vl_parameters_translucent(vlTextureRun *r, const vlWorldMaterial *m) {
  reflectance(r, m);
  vl_stage_translucent(r, m);
}

void vl_parameters_hair(vlTextureRun *r, const vlWorldMaterial *m) {
  reflectance(r, m);
  vl_stage_hair(r, m);
}

void vl_parameters_measured(vlTextureRun *r, const vlWorldMaterial *m) {
  for (uint32_t i = r->first; i < r->last; i++)
    r->at->shade.measured[i] = m->measured;
}

void vl_parameters_principled(vlTextureRun *r, const vlWorldMaterial *m) {
  vl_stage_principled(r, m);
  reflectance(r, m);
}

/* The factor on the light that crosses the surface. White light has the colour of passed_i
 * before and of passed_i tint_i after it, for all that the path has crossed so far. At a
 * wavelength the factor is the ratio of the two, so that the product over a path is the
 * transmittance of the whole path. */
static void tints(vlTextureRun *r, const vlWorldMaterial *m) {
  vlShade *shade = &r->at->shade;
  if (!m->principled || !m->principled->by_channel) {
    for (int c = 0; c < 4; c++)
      for (uint32_t i = r->first; i < r->last; i++) {
        shade->tint->rgb[c][i] = 1.0f;
        shade->tint->at[c][i] = shade->reflectance[c][i];
      }
    return;
  }
  r->rgb = true;
  vl_texture_albedo(r, m->reflectance, 1.0f, shade->tint->rgb);
  r->rgb = false;
  for (uint32_t i = r->first; i < r->last; i++) {
    float before[3], after[3];
    for (int k = 0; k < 3; k++) {
      before[k] = r->s->by_channel->passed[k][r->at->paths.lane[i]];
      after[k] = before[k] * shade->tint->rgb[k][i];
    }
    for (int c = 0; c < 4; c++) {
      float whole = vl_channels_at(before, r->at->paths.lambda[c][i]);
      shade->tint->at[c][i] =
          whole > 0.0f ? vl_channels_at(after, r->at->paths.lambda[c][i]) / whole : 0.0f;
    }
  }
}

#define PARAMETERS(kind, name, parameters, eval, sample) [kind] = parameters,
static vlParametersFn *const parameters[] = {VL_BSDF_KINDS(PARAMETERS)};

/* Dispersion: directions depend on the wavelength, so the path keeps only the hero wavelength,
 * with the weight of all four. */
static void follow_hero(vlPaths *p, uint32_t first, uint32_t last) {
  for (uint32_t i = first; i < last; i++) {
    /* Equal wavelengths mark a path with only the hero left: weights may be zero for other
     * reasons. */
    bool alone = p->lambda[1][i] == p->lambda[0][i];
    p->beta[0][i] *= alone ? 1.0f : 4.0f;
    p->beta[1][i] = p->beta[2][i] = p->beta[3][i] = 0.0f;
    p->lambda[1][i] = p->lambda[2][i] = p->lambda[3][i] = p->lambda[0][i];
  }
}

static void evaluate(vlTextureRun *r, const vlWorldMaterial *m) {
  r->top = 0;
  if (m->displacement >= 0)
    bump(r, m->displacement);
  if (m->normal_map >= 0)
    normal_map(r, m->normal_map);
  r->top = 0;
  parameters[m->bsdf](r, m);
  if (r->at->shade.tint)
    tints(r, m);
}

void vl_stage_material(const vlWorld *world, uint32_t first, uint32_t last, uint32_t material,
                       vlVertices *at, vlTraceScratch *s) {
  const vlWorldMaterial *m = &world->materials.items[material];
  for (uint32_t i = first; m->no_cosine && i < last; i++)
    at->surface.no_cosine[i] = 1.0f;
  for (uint32_t i = first; m->one_sided && i < last; i++)
    at->surface.side[i] = 1.0f;
  vlTextureRun r = {.world = world, .at = at, .s = s, .last = first};
  while (r.last < last) {
    r.first = r.last;
    r.last = last - r.first < VL_MATERIAL_LANES ? last : r.first + VL_MATERIAL_LANES;
    evaluate(&r, m);
  }
  if (m->dispersive)
    follow_hero(&at->paths, first, last);
}

void vl_stage_frames(uint32_t n, const vlPaths *paths, vlSurface *f, vlShade *shade) {
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 nn = vl_vec3(f->n.x[i], f->n.y[i], f->n.z[i]),
           u = vl_vec3(f->dpdu.x[i], f->dpdu.y[i], f->dpdu.z[i]);
    vlVec3 t = vl_sub(u, vl_mul(nn, vl_dot(u, nn)));
    float ok = vl_length2(t) > PARALLEL * vl_length2(u) ? 1.0f : 0.0f;
    vlFrame any = vl_frame_from_z(nn);
    t = vl_normalize(t);
    t.x = ok > 0.0f ? t.x : any.x.x;
    t.y = ok > 0.0f ? t.y : any.x.y;
    t.z = ok > 0.0f ? t.z : any.x.z;
    vlVec3 b = vl_cross(nn, t);
    vl_set_row3(&shade->tangent, i, t);
    vl_set_row3(&shade->bitangent, i, b);
    vlVec3 wo = vl_vec3(-paths->d.x[i], -paths->d.y[i], -paths->d.z[i]);
    shade->wo[0][i] = vl_dot(wo, t);
    shade->wo[1][i] = vl_dot(wo, b);
    float wo_z = vl_dot(wo, nn);
    shade->wo[2][i] = wo_z;
    f->side[i] = wo_z < 0.0f ? -f->side[i] : f->side[i];
  }
}
