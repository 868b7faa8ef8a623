/* tracer/path.hot.c: path tracing with next-event estimation, multiple importance
 * sampling (power heuristic) and Russian roulette (pbrt book 13.4), bounce by bounce over a
 * batch. */
#include "tracer/record.h"
#include "world/accel/crossed.h"

/* ---- direct light ------------------------------------------------------------------------ */

void vl_stage_light_bsdf(const vlTracing *t, uint32_t n, const vlVertices *at,
                         const vlLightSamples *light, vlBsdfValues *to) {
  vl_stage_local(n, at, &light->w, to->wi);
  vl_stage_bsdf(t, n, at, at->shade.wo, to);
}

void vl_stage_light_samples(const vlTracing *t, uint32_t n, const vlPaths *p,
                            const vlSurface *surface, uint32_t dimension,
                            vlLightSamples *light) {
  vlNumbers r;
  vl_draw_1d(t, n, p, dimension + VL_DIM_LIGHT, r.u0);
  /* The direct light at the first hit is a function of film point and light point: the four
   * numbers are drawn together (docs/tracers.md). Deeper vertices gain nothing from it. */
  if (dimension == VL_DIM_BOUNCE)
    t->sampler->get_2d_with(t->def->sampler, n, p->px, p->py, p->index, VL_DIM_FIRST_LIGHT,
                            VL_DIM_FILM, r.u1, r.u2);
  else
    vl_draw_2d(t, n, p, dimension + VL_DIM_LIGHT_UV, r.u1, r.u2);
  vl_stage_lights(t->world, n, p, surface, r.u1, r.u2, r.u0, light);
}

/* Shadow rays for the light samples that contribute, in the order of the vertices, and their
 * radiance, weighted by BSDF and multiple importance sampling. Returns their number. */
static uint32_t make_shadow_rays(uint32_t n, const vlVertices *at, const vlLightSamples *l,
                                 const vlBsdfValues *bsdf, vlShadowRays *q) {
  const vlPaths *p = &at->paths;
  const vlSurface *f = &at->surface;
  uint32_t padded = VL_PAD(n), lit[VL_ROW_SIZE];
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 w = vl_vec3(l->w.x[i], l->w.y[i], l->w.z[i]);
    vlVec3 o = vl_surface_origin(f, i, w);
    int distant = l->distant[i], delta = l->delta[i];
    float x = l->target.x[i] - o.x, y = l->target.y[i] - o.y, z = l->target.z[i] - o.z;
    float mis = vl_power_heuristic(l->pdf[i], bsdf->pdf[i]), weight = delta ? 1.0f : mis;
    lit[i] = (l->pdf[i] > 0.0f) & vl_has_value(bsdf, i) ? 1 : 0;
    vl_set_row3(&q->o, i, o);
    q->d.x[i] = distant ? w.x : x;
    q->d.y[i] = distant ? w.y : y;
    q->d.z[i] = distant ? w.z : z;
    q->t_max[i] = distant ? VL_INFINITY : VL_ONE_MINUS_EPSILON;
    for (int c = 0; c < 4; c++)
      q->radiance[c][i] = p->beta[c][i] * bsdf->value[c][i] * l->radiance[c][i] * weight;
  }
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!lit[i])
      continue;
    uint32_t k = count++;
    q->lane[k] = p->lane[i];
    if (p->time)
      q->time[k] = vl_path_time(p, i);
    if (k != i)
      vl_shadow_move(q, i, k);
  }
  return count;
}

/* Weakens the light of shadow rays by the surfaces of partial alpha that they have crossed. */
static void weaken(uint32_t count, vlShadowRays *q) {
  for (uint32_t k = 0; k < count; k++) {
    if (q->crossed[k] == 0)
      continue;
    float passes = vl_crossed_passes(q->crossed[k]);
    for (int c = 0; c < 4; c++)
      q->radiance[c][k] *= passes;
  }
}

void vl_stage_occluded(vlTracing *t, uint32_t count, const vlPaths *p, vlShadowRays *q) {
  bool weighs = t->world->has_alpha && !t->world->has_interfaces;
  vlRays rays = vl_rays_of(&q->o, &q->d, 0, NULL, q->t_max, p->time ? q->time : NULL);
  rays.crossed = weighs ? q->crossed : NULL;
  if (weighs)
    memset(q->crossed, 0, count * sizeof *q->crossed);
  vl_accel_occluded(t->world, count, &rays, &t->s->occluders, q->occluded);
  if (weighs)
    weaken(count, q);
}

/* Takes light samples, and adds the radiance of those that arrive. light, values, shadow:
 * memory for what is between. */
static void direct_light(vlTracing *t, uint32_t n, uint32_t dimension, const vlVertices *at,
                         vlLightSamples *light, vlBsdfValues *values, vlShadowRays *shadow) {
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, &at->paths, &at->surface, dimension, light);
  vl_stage_light_bsdf(t, n, at, light, values);
  uint32_t count = make_shadow_rays(n, at, light, values, shadow);
  vl_stage_occluded(t, count, &at->paths, shadow);
  t->batch->shadow_rays += count;
  if (t->batch->recorder)
    vl_record_direct_light(t, n, count, at, light, values, shadow);
  for (uint32_t k = 0; k < count; k++)
    if (!shadow->occluded[k])
      for (int c = 0; c < 4; c++)
        t->batch->radiance[c][shadow->lane[k]] += shadow->radiance[c][k];
}

/* ---- the next direction ------------------------------------------------------------------ */

/* Width and spread of the cone that leaves a surface. Specular reflection and transmission
 * change the spread by the curvature perpendicular to the plane of incidence (Coddington's
 * sagittal equations). This is the smaller of the changes in the two planes, so textures are
 * not blurred. All other lobes restart with the camera's spread and the present width. */
static inline vlVec2 cone_after(float pixel_spread, float cone, float spread, float distance,
                                float bend, float wo_z, float wi_z, float eta_scale,
                                uint32_t specular) {
  float width = cone + spread * distance;
  float sign = width < 0.0f ? -1.0f : 1.0f; /* past a focus */
  width = width * sign;
  spread = spread * sign;
  float side = wo_z < 0.0f ? -1.0f : 1.0f, k = bend * side, in = wo_z * side,
        out = vl_abs(wi_z);
  /* ratio of the indices, incident over transmitted */
  float ratio = eta_scale > 0.0f ? 1.0f / __builtin_sqrtf(eta_scale) : 1.0f;
  float reflected = spread + 2.0f * k * in * width;
  float refracted = ratio * spread - k * (out - ratio * in) * width;
  float smooth = wi_z * side > 0.0f ? reflected : refracted;
  return (vlVec2){width, specular ? smooth : pixel_spread};
}

/* The rays that leave n vertices, ray i from vertex i, with Russian roulette by the numbers u.
 * alive: 1 for those that go on; broken: 1 where the throughput is no number. Sets all of the
 * rays but what remains the same along a path. */
static void make_rays(const vlTracing *t, uint32_t n, uint32_t depth, const vlVertices *at,
                      const vlBsdfSamples *s, const float *u, vlPaths *to, uint32_t *alive,
                      float *broken) {
  const vlPaths *p = &at->paths;
  const vlSurface *f = &at->surface;
  const vlShade *sh = &at->shade;
  float pixel_spread = t->def->pixel_spread;
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float x = s->wi[0][i], y = s->wi[1][i], z = s->wi[2][i];
    vlVec3 w = vl_vec3(x * sh->tangent.x[i] + y * sh->bitangent.x[i] + z * f->n.x[i],
                       x * sh->tangent.y[i] + y * sh->bitangent.y[i] + z * f->n.y[i],
                       x * sh->tangent.z[i] + y * sh->bitangent.z[i] + z * f->n.z[i]);
    w = vl_normalize(w);
    vlVec3 o = vl_surface_origin(f, i, w);
    float b0 = p->beta[0][i] * s->weight[0][i], b1 = p->beta[1][i] * s->weight[1][i];
    float b2 = p->beta[2][i] * s->weight[2][i], b3 = p->beta[3][i] * s->weight[3][i];
    float eta = p->eta_scale[i] * s->eta_scale[i];
    float max = vl_largest4(b0, b1, b2, b3);
    float survive = vl_roulette_survival(max * eta, depth);
    uint32_t lives = max > 0.0f && !(s->flags[i] & VL_SAMPLED_NONE) && u[i] < survive ? 1 : 0;
    float inv = survive > 0.0f ? 1.0f / survive : 0.0f;
    float sum = b0 + b1 + b2 + b3;
    alive[i] = lives;
    broken[i] = sum == sum ? 0.0f : 1.0f;
    vl_set_row3(&to->o, i, o);
    vl_set_row3(&to->d, i, w);
    to->beta[0][i] = b0 * inv;
    to->beta[1][i] = b1 * inv;
    to->beta[2][i] = b2 * inv;
    to->beta[3][i] = b3 * inv;
    to->pdf[i] = s->pdf[i];
    to->specular[i] = s->flags[i] & VL_SAMPLED_SPECULAR;
    to->eta_scale[i] = eta;
    vlVec2 cone =
        cone_after(pixel_spread, p->cone[i], p->spread[i], f->t[i], f->curvature[i],
                   sh->wo[2][i], z, s->eta_scale[i], s->flags[i] & VL_SAMPLED_SPECULAR);
    to->cone[i] = cone.x;
    to->spread[i] = cone.y;
    float c = 1.0f - f->no_cosine[i];
    to->from_n.x[i] = c * f->n.x[i];
    to->from_n.y[i] = c * f->n.y[i];
    to->from_n.z[i] = c * f->n.z[i];
    to->from_side[i] = f->side[i];
  }
}

uint32_t vl_stage_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                          const vlVertices *at, vlBsdfSamples *samples, uint32_t *order,
                          vlPaths *next) {
  const vlPaths *p = &at->paths;
  float u[VL_ROW_SIZE], broken[VL_ROW_SIZE];
  uint32_t alive[VL_ROW_SIZE], count = 0;
  vl_stage_bsdf_samples(t, n, dimension, at, samples);
  vl_draw_1d(t, n, p, dimension + VL_DIM_ROULETTE, u);
  make_rays(t, n, depth, at, samples, u, next, alive, broken);
  for (uint32_t i = 0; i < n; i++) {
    order[count] = i;
    count += alive[i];
    if (alive[i] && !(samples->flags[i] & VL_SAMPLED_SPECULAR))
      vl_note_scattered(t, p->lane[i]);
    if (broken[i] > 0.0f)
      t->batch->radiance[0][p->lane[i]] = __builtin_nanf(""); /* the film drops and counts it */
  }
  if (t->def->limited)
    vl_limits_count(t, n, at, samples, alive);
  for (uint32_t k = 0; t->world->by_channel && k < count; k++)
    vl_passed_go_on(t, at, order[k], samples->wi[2][order[k]]);
  if (t->batch->recorder)
    vl_record_scatter(t, n, depth, at, samples, next, order, count);
  vl_gather_rays(p, order, count, next);
  return count;
}

/* ---- the path tracer --------------------------------------------------------------------- */

static bool arrive(vlTracing *t, uint32_t n, uint32_t depth) {
  const vlPaths *rays = &t->s->rays;
  const vlHits *hits = &t->s->hits;
  vl_stage_emission(t, n, rays, hits);
  if (!t->batch->recorder)
    return true;
  vl_record_arrivals(t, n, depth, rays, hits);
  vl_record_emission(t, n, rays, hits);
  if (depth >= t->def->max_depth)
    vl_record_depth(t, n, rays);
  return true;
}

static uint32_t on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  uint32_t dimension = vl_bounce_dimension(depth);
  vl_stage_regularize(t, n, &s->at);
  if (t->batch->recorder)
    vl_record_shaded(t, n, &s->at);
  direct_light(t, n, dimension, &s->at, &s->light, &s->values, &s->shadow);
  return vl_stage_scatter(t, n, depth + 1, dimension, &s->at, &s->samples, s->order, &s->rays);
}

void vl_path_tracer(vlTracing *t) {
  static const vlBounceSteps steps = {arrive, NULL, on_surfaces, vl_add_hit_light,
                                      vl_add_hit_light};
  vl_trace_bounces(t, t->batch->n, t->def->max_depth, &steps);
}
