/* material/material.hot.c: the parameters of the BSDFs, from the textures of each run of lanes
 * with one material; then shading frames, and the BSDFs of each run of one kind. */
#include "material/inputs.hot.h"
#include "material/kinds.row.h"
#include "velo/schema.h"
#include "velo/shape.h"

/* Squared sine (1e-6 squared) of the angle between a tangent and the normal. Below it, the
 * tangent is mostly rounding error. */
#define PARALLEL 1e-12f

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
    vl_stage_bump(r, m->displacement);
  if (m->normal_map >= 0)
    vl_stage_normal_map(r, m->normal_map);
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

void vl_stage_local(uint32_t n, const vlVertices *at, const vlVec3Row *w,
                    float wi[3][VL_ROW_SIZE]) {
  const vlShade *sh = &at->shade;
  const vlSurface *f = &at->surface;
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float x = w->x[i], y = w->y[i], z = w->z[i];
    wi[0][i] = x * sh->tangent.x[i] + y * sh->tangent.y[i] + z * sh->tangent.z[i];
    wi[1][i] = x * sh->bitangent.x[i] + y * sh->bitangent.y[i] + z * sh->bitangent.z[i];
    wi[2][i] = x * f->n.x[i] + y * f->n.y[i] + z * f->n.z[i];
  }
}

/* ---- runs of one BSDF -------------------------------------------------------------------- */

/* Lanes [first, last) that share a BSDF kind. A run may start at any lane, because a lane's
 * result does not depend on its place in the vector loop. */
typedef struct Run {
  vlBsdfKind kind;
  uint32_t last;
} Run;

/* The run that begins at lane `first` of n. */
static Run next_kind(const vlWorld *world, const vlHits *h, uint32_t first, uint32_t n) {
  Run r = {world->materials.items[h->material[first]].bsdf, first + 1};
  while (r.last < n && world->materials.items[h->material[r.last]].bsdf == r.kind)
    r.last++;
  return r;
}

/* The row from lane `first` on. Without const, because vlBsdfParams has the rows that kernels
 * write in the same types; evaluation and sampling only read these. */
static float *from(const float *row, uint32_t first) {
  return (float *)(uintptr_t)row + first;
}
static vlBsdfDirections directions(const float w[3][VL_ROW_SIZE], uint32_t first) {
  return (vlBsdfDirections){from(w[0], first), from(w[1], first), from(w[2], first)};
}
static vlBsdfParams params_of(const vlWorld *world, const vlVertices *at, uint32_t first) {
  const vlShade *s = &at->shade;
  vlBsdfParams p;
  for (int c = 0; c < 4; c++) {
    p.reflectance[c] = from(s->reflectance[c], first);
    p.tint[c] = s->tint ? s->tint->at[c] + first : NULL;
    p.eta[c] = from(s->eta[c], first);
    p.k[c] = from(s->k[c], first);
    p.lambda[c] = world->def.color == VL_COLOR_RGB ? NULL : at->paths.lambda[c] + first;
  }
  for (int k = 0; k < VL_BSDF_ROWS; k++)
    p.own[k] = from(s->own[k], first);
  p.alpha_x = from(s->alpha_x, first);
  p.alpha_y = from(s->alpha_y, first);
  p.eta_s = from(s->eta_s, first);
  p.coat = (const vlCoatTable **)(uintptr_t)(s->coat + first);
  p.seed = s->seed + first;
  p.measured = s->measured + first;
  return p;
}

void vl_stage_bsdf(const vlTracing *t, uint32_t n, const vlVertices *at,
                   const float wo[3][VL_ROW_SIZE], vlBsdfValues *to) {
  for (uint32_t first = 0; first < n;) {
    Run r = next_kind(t->world, &at->hits, first, n);
    vlBsdfParams params = params_of(t->world, at, first);
    float *const value[4] = {to->value[0] + first, to->value[1] + first, to->value[2] + first,
                             to->value[3] + first};
    t->bsdf->eval[r.kind](r.last - first, &params, directions(wo, first),
                          directions((const float(*)[VL_ROW_SIZE])to->wi, first), value,
                          to->pdf + first);
    first = r.last;
  }
}

void vl_stage_bsdf_samples(const vlTracing *t, uint32_t n, uint32_t dimension,
                           const vlVertices *at, vlBsdfSamples *to) {
  const vlPaths *p = &at->paths;
  vlNumbers u;
  vl_draw_1d(t, n, p, dimension + VL_DIM_LOBE, u.u0);
  vl_draw_2d(t, n, p, dimension + VL_DIM_BSDF_UV, u.u1, u.u2);
  /* a run is padded to whole lanes from its own first one: the last run reads past VL_PAD(n) */
  for (uint32_t i = n; i < n + VL_LANES && i < VL_ROW_SIZE; i++)
    u.u0[i] = u.u1[i] = u.u2[i] = 0.0f;
  for (uint32_t first = 0; first < n;) {
    Run r = next_kind(t->world, &at->hits, first, n);
    vlBsdfParams params = params_of(t->world, at, first);
    vlBsdfRandom random = {u.u0 + first, u.u1 + first, u.u2 + first};
    vlBsdfSampled out = {.wi = {to->wi[0] + first, to->wi[1] + first, to->wi[2] + first},
                         .pdf = to->pdf + first,
                         .flags = to->flags + first,
                         .eta_scale = to->eta_scale + first};
    for (int c = 0; c < 4; c++)
      out.weight[c] = to->weight[c] + first;
    t->bsdf->sample[r.kind](r.last - first, &params, directions(at->shade.wo, first), random,
                            out);
    first = r.last;
  }
}
