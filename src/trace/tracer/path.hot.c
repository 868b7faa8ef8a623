/* trace/tracer/path.hot.c: path tracing with next-event estimation, multiple importance sampling (power heuristic) and
 * Russian roulette (pbrt book 13.4), bounce by bounce over a batch. */
#include "trace/tracer/record.h"

/* ---- runs of one BSDF -------------------------------------------------------------------------------------------- */

/* A run of lanes that share a BSDF kind, with parameter rows shifted to the run's start. A run may start at any lane,
 * because a lane's result does not depend on its place in the vector loop. */
typedef struct Run {
  vlBsdfKind kind;
  uint32_t first, last;
} Run;

static Run next_kind(const vlWorld *world, const vlHits *h, uint32_t first, uint32_t n) {
  Run r = {world->materials.items[h->material[first]].bsdf, first, first + 1};
  while (r.last < n && world->materials.items[h->material[r.last]].bsdf == r.kind) r.last++;
  return r;
}

static vlBsdfParams params_of(vlTracing *t, uint32_t first) {
  vlShade *s = &t->s->shade;
  vlBsdfParams p;
  for (int c = 0; c < 4; c++) {
    p.reflectance[c] = s->reflectance[c] + first;
    p.tint[c] = t->world->by_channel ? s->tint[c] + first : NULL;
    p.eta[c] = s->eta[c] + first;
    p.k[c] = s->k[c] + first;
    p.lambda[c] = t->world->def.color == VL_COLOR_RGB ? NULL : t->s->b.lambda[c] + first;
  }
  for (int k = 0; k < VL_BSDF_ROWS; k++) p.own[k] = s->own[k] + first;
  p.alpha_x = s->alpha_x + first;
  p.alpha_y = s->alpha_y + first;
  p.eta_s = s->eta_s + first;
  p.coat = s->coat + first;
  p.seed = s->seed + first;
  p.measured = s->measured + first;
  return p;
}

/* ---- direct light ------------------------------------------------------------------------------------------------ */

void vl_stage_light_bsdf(vlTracing *t, uint32_t n) {
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  const vlLightSamples *l = &s->light;
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float x = l->wx[i], y = l->wy[i], z = l->wz[i];
    sh->wi[0][i] = x * sh->tx[i] + y * sh->ty[i] + z * sh->tz[i];
    sh->wi[1][i] = x * sh->bx[i] + y * sh->by[i] + z * sh->bz[i];
    sh->wi[2][i] = x * s->surface.nx[i] + y * s->surface.ny[i] + z * s->surface.nz[i];
  }
  for (uint32_t first = 0; first < n;) {
    Run r = next_kind(t->world, &s->hits_b, first, n);
    vlBsdfParams params = params_of(t, first);
    vlBsdfDirections wo = {sh->wo[0] + first, sh->wo[1] + first, sh->wo[2] + first};
    vlBsdfDirections wi = {sh->wi[0] + first, sh->wi[1] + first, sh->wi[2] + first};
    float *const value[4] = {sh->value[0] + first, sh->value[1] + first, sh->value[2] + first, sh->value[3] + first};
    t->bsdf->eval(r.kind, r.last - first, &params, wo, wi, value, sh->pdf + first);
    first = r.last;
  }
}

void vl_stage_light_samples(vlTracing *t, uint32_t n, const vlPaths *p, uint32_t dimension) {
  vlShade *sh = &t->s->shade;
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LIGHT, sh->u0);
  /* The direct light at the first hit is a function of film point and light point: the four numbers are drawn together
   * (docs/tracers.md). Deeper vertices gain nothing from it. */
  if (dimension == VL_DIM_BOUNCE)
    t->sampler->get_2d_with(t->def->sampler, n, p->px, p->py, p->index, VL_DIM_FIRST_LIGHT, VL_DIM_FILM, sh->u1,
                            sh->u2);
  else
    t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LIGHT_UV, sh->u1, sh->u2);
  vl_stage_lights(t->world, n, p, &t->s->surface, sh->u1, sh->u2, sh->u0, &t->s->light);
}

/* Shadow rays for the light samples that contribute, in the order of the lanes, and their radiance, weighted by BSDF
 * and multiple importance sampling. Returns their number. */
static uint32_t make_shadow_rays(vlTracing *t, uint32_t n) {
  vlTraceScratch *s = t->s;
  const vlPaths *p = &s->b;
  const vlSurface *f = &s->surface;
  const vlShade *sh = &s->shade;
  const vlLightSamples *l = &s->light;
  vlShadowRays *q = &s->shadow;
  uint32_t padded = VL_PAD(n), lit[VL_ROW_SIZE];
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float v0 = sh->value[0][i], v1 = sh->value[1][i], v2 = sh->value[2][i], v3 = sh->value[3][i],
          sum = v0 + v1 + v2 + v3;
    vlVec3 w = vl_vec3(l->wx[i], l->wy[i], l->wz[i]);
    vlVec3 o =
        vl_offset_origin(vl_vec3(f->px[i], f->py[i], f->pz[i]), vl_vec3(f->gx[i], f->gy[i], f->gz[i]), f->offset[i], w);
    int distant = l->distant[i], delta = l->delta[i];
    float x = l->tx[i] - o.x, y = l->ty[i] - o.y, z = l->tz[i] - o.z;
    float mis = vl_power_heuristic(l->pdf[i], sh->pdf[i]), weight = delta ? 1.0f : mis;
    lit[i] = (l->pdf[i] > 0.0f) & ((sum > 0.0f) | (sum != sum)) ? 1 : 0;
    vl_set_lane3(q->ox, q->oy, q->oz, i, o);
    q->dx[i] = distant ? w.x : x;
    q->dy[i] = distant ? w.y : y;
    q->dz[i] = distant ? w.z : z;
    q->t_max[i] = distant ? VL_INFINITY : VL_ONE_MINUS_EPSILON;
    q->radiance[0][i] = p->beta[0][i] * v0 * l->radiance[0][i] * weight;
    q->radiance[1][i] = p->beta[1][i] * v1 * l->radiance[1][i] * weight;
    q->radiance[2][i] = p->beta[2][i] * v2 * l->radiance[2][i] * weight;
    q->radiance[3][i] = p->beta[3][i] * v3 * l->radiance[3][i] * weight;
  }
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!lit[i]) continue;
    uint32_t k = count++;
    q->lane[k] = p->lane[i];
    if (p->time) q->time[k] = vl_path_time(p, i);
    if (k != i) vl_shadow_move(q, i, k);
  }
  return count;
}

/* Makes shadow rays for the light samples, weighted by BSDF and multiple importance sampling. Unoccluded rays add
 * their radiance. */
static void direct_light(vlTracing *t, uint32_t n, uint32_t dimension) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  if (world->lights.count == 0) return;
  vlPaths *p = &s->b;
  vl_stage_light_samples(t, n, p, dimension);
  vl_stage_light_bsdf(t, n);
  vlShadowRays *q = &s->shadow;
  uint32_t count = make_shadow_rays(t, n);
  vlRays rays = {q->ox, q->oy, q->oz, q->dx, q->dy, q->dz, NULL, q->t_max, p->time ? q->time : NULL};
  vl_accel_occluded(world, count, &rays, &s->occluders, q->occluded);
  t->batch->shadow_rays += count;
  if (t->batch->recorder) vl_record_direct_light(t, n, count);
  for (uint32_t k = 0; k < count; k++)
    if (!q->occluded[k])
      for (int c = 0; c < 4; c++) t->batch->radiance[c][q->lane[k]] += q->radiance[c][k];
}

/* ---- the next direction ------------------------------------------------------------------------------------------ */

/* Width and spread of the cone that leaves a surface. Specular reflection and transmission change the spread by the
 * curvature perpendicular to the plane of incidence (Coddington's sagittal equations). This is the smaller of the
 * changes in the two planes, so textures are not blurred. All other lobes restart with the camera's spread and the
 * present width. */
static inline vlVec2 cone_after(float pixel_spread, float cone, float spread, float distance, float bend, float wo_z,
                                float wi_z, float eta_scale, uint32_t specular) {
  float width = cone + spread * distance;
  float sign = width < 0.0f ? -1.0f : 1.0f; /* past a focus */
  width = width * sign;
  spread = spread * sign;
  float side = wo_z < 0.0f ? -1.0f : 1.0f, k = bend * side, in = wo_z * side, out = vl_abs(wi_z);
  float ratio =
      eta_scale > 0.0f ? 1.0f / __builtin_sqrtf(eta_scale) : 1.0f; /* ratio of the indices, incident over transmitted */
  float reflected = spread + 2.0f * k * in * width;
  float refracted = ratio * spread - k * (out - ratio * in) * width;
  float smooth = wi_z * side > 0.0f ? reflected : refracted;
  return (vlVec2){width, specular ? smooth : pixel_spread};
}

uint32_t vl_stage_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  vlPaths *p = &s->b;
  const vlSurface *f = &s->surface;
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LOBE, sh->u0);
  t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_BSDF_UV, sh->u1, sh->u2);
  for (uint32_t first = 0; first < n;) {
    Run r = next_kind(t->world, &s->hits_b, first, n);
    vlBsdfParams params = params_of(t, first);
    vlBsdfDirections wo = {sh->wo[0] + first, sh->wo[1] + first, sh->wo[2] + first};
    vlBsdfDirections wi = {sh->wi[0] + first, sh->wi[1] + first, sh->wi[2] + first};
    float *const weight[4] = {sh->value[0] + first, sh->value[1] + first, sh->value[2] + first, sh->value[3] + first};
    t->bsdf->sample(r.kind, r.last - first, &params, wo, sh->u0 + first, sh->u1 + first, sh->u2 + first, wi, weight,
                    sh->pdf + first, sh->flags + first, sh->eta_scale + first);
    first = r.last;
  }
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_ROULETTE, sh->u0);
  uint32_t padded = VL_PAD(n);
  uint32_t alive[VL_ROW_SIZE];
  float broken[VL_ROW_SIZE];
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float x = sh->wi[0][i], y = sh->wi[1][i], z = sh->wi[2][i];
    vlVec3 w = vl_vec3(x * sh->tx[i] + y * sh->bx[i] + z * f->nx[i], x * sh->ty[i] + y * sh->by[i] + z * f->ny[i],
                       x * sh->tz[i] + y * sh->bz[i] + z * f->nz[i]);
    w = vl_normalize(w);
    vlVec3 o =
        vl_offset_origin(vl_vec3(f->px[i], f->py[i], f->pz[i]), vl_vec3(f->gx[i], f->gy[i], f->gz[i]), f->offset[i], w);
    float b0 = p->beta[0][i] * sh->value[0][i], b1 = p->beta[1][i] * sh->value[1][i];
    float b2 = p->beta[2][i] * sh->value[2][i], b3 = p->beta[3][i] * sh->value[3][i];
    float eta = p->eta_scale[i] * sh->eta_scale[i];
    float most = vl_max(vl_max(b0, b1), vl_max(b2, b3));
    float survive = vl_roulette_survival(most * eta, depth);
    uint32_t lives = most > 0.0f && !(sh->flags[i] & VL_SAMPLED_NONE) && sh->u0[i] < survive ? 1 : 0;
    float inv = survive > 0.0f ? 1.0f / survive : 0.0f;
    float sum = b0 + b1 + b2 + b3;
    alive[i] = lives;
    broken[i] = sum == sum ? 0.0f : 1.0f;
    vl_set_lane3(p->ox, p->oy, p->oz, i, o);
    vl_set_lane3(p->dx, p->dy, p->dz, i, w);
    p->beta[0][i] = b0 * inv;
    p->beta[1][i] = b1 * inv;
    p->beta[2][i] = b2 * inv;
    p->beta[3][i] = b3 * inv;
    p->pdf[i] = sh->pdf[i];
    p->specular[i] = sh->flags[i] & VL_SAMPLED_SPECULAR;
    p->eta_scale[i] = eta;
    vlVec2 cone = cone_after(t->def->pixel_spread, p->cone[i], p->spread[i], f->t[i], f->curvature[i], sh->wo[2][i], z,
                             sh->eta_scale[i], sh->flags[i] & VL_SAMPLED_SPECULAR);
    p->cone[i] = cone.x;
    p->spread[i] = cone.y;
    float c = 1.0f - f->no_cosine[i];
    p->from_nx[i] = c * f->nx[i];
    p->from_ny[i] = c * f->ny[i];
    p->from_nz[i] = c * f->nz[i];
    p->from_side[i] = f->side[i];
  }
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    s->order[count] = i;
    count += alive[i];
    if (alive[i] && !(sh->flags[i] & VL_SAMPLED_SPECULAR)) vl_note_scattered(t, p->lane[i]);
    if (broken[i] > 0.0f) t->batch->radiance[0][p->lane[i]] = __builtin_nanf(""); /* the film drops and counts it */
  }
  for (uint32_t k = 0; t->world->by_channel && k < count; k++) vl_passed_go_on(t, s->order[k]);
  if (t->batch->recorder) vl_record_scatter(t, n, count, depth);
  vl_permute_paths(p, &s->a, s->order, count);
  return count;
}

/* ---- the path tracer --------------------------------------------------------------------------------------------- */

void vl_path_tracer(vlTracing *t) {
  uint32_t n = t->batch->n;
  for (uint32_t depth = 0; n > 0 && !vl_is_cancelled(t->def->cancel); depth++) {
    vl_stage_hits(t, n, depth == 0);
    if (depth == 0) vl_stage_alpha(t);
    vl_stage_emission(t, n);
    if (t->batch->recorder) {
      vl_record_arrivals(t, n, depth);
      vl_record_emission(t, n);
      if (depth >= t->def->max_depth) vl_record_depth(t, n);
    }
    if (depth >= t->def->max_depth) break;
    n = vl_stage_sort(t, n);
    if (n == 0) break;
    uint32_t dimension = VL_DIM_BOUNCE + depth * VL_DIM_STRIDE;
    vl_stage_shade(t, n);
    vl_stage_regularize(t, n);
    if (t->batch->recorder) vl_record_shaded(t, n);
    direct_light(t, n, dimension);
    n = vl_stage_scatter(t, n, depth + 1, dimension);
  }
}
