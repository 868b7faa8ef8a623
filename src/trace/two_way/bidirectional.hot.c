/* trace/two_way/bidirectional.hot.c: the camera side of the two-way tracers: path tracing in
 * which light samples and hit lights are weighted against splats and merging (two_way.h). */
#include "math/warp.h"
#include "trace/two_way/stages.h"

/* ---- lights that paths hit --------------------------------------------------------------- */

/* density: density of the light paths that arrive at this point. */
static float hit_weight(const vlTracing *t, const vlPaths *p, const vlFlightEnds *ends,
                        uint32_t i, float asked, float density) {
  uint32_t lane = p->lane[i];
  asked =
      p->specular[i] || !(asked > 0.0f) ? 0.0f : asked / (p->pdf[i] * vl_last_odds(ends, lane));
  return 1.0f / (1.0f + asked + t->lanes->carry[lane] * density);
}

static void add_radiance(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows, uint32_t i,
                         const float radiance[4], float weight) {
  if (rows) {
    float u[4];
    for (int c = 0; c < 4; c++)
      u[c] = rows->u[c][i];
    weight /= vl_flight_mean(u, vl_volume_rgb(t) ? 3 : 4);
  }
  vl_add_radiance(t, p, i, radiance, weight);
}

/* Weight of a light that the camera sees directly, against light paths that start there
 * (vl_show_lights). */
static float seen_weight(const vlTracing *t, const vlPaths *p, const vlFlightEnds *ends,
                         uint32_t i, uint32_t light, const vlPoint *at) {
  const vlTwoWay *way = t->def->two_way;
  uint32_t lane = p->lane[i];
  const vlCameraView *eye = vl_eye_of(t, lane);
  if (!at || !eye->sees || way->light_only)
    return 1.0f;
  vlVec3 d = vl_row3(&p->d, i);
  float per_square = 1.0f / (vl_eye_pixel(t, lane, d, at->t) * at->t * at->t);
  float area_pdf = vl_emission_area_pdf(t->world, way, light, at->p);
  return 1.0f / (1.0f + vl_shown(way, light, area_pdf, per_square, vl_abs(vl_dot(d, at->g))) /
                            vl_last_odds(ends, lane));
}

static void add_first(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows,
                      const vlFlightEnds *ends, uint32_t i, const vlHitLight *met, bool sky) {
  add_radiance(t, p, rows, i, met->radiance,
               seen_weight(t, p, ends, i, met->light, sky ? NULL : &met->at));
}

static void add_later(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows,
                      const vlFlightEnds *ends, uint32_t i, const vlHitLight *met, bool sky) {
  vlVec3 d = vl_row3(&p->d, i);
  float density = vl_emission_density(t->world, t->def->two_way, met->light, d,
                                      sky ? VL_INFINITY : met->at.t, sky ? NULL : &met->at);
  add_radiance(t, p, rows, i, met->radiance, hit_weight(t, p, ends, i, met->pdf, density));
}

/* ---- one vertex -------------------------------------------------------------------------- */

/* Sets the strategies that begin on the camera's side, of n vertices on surfaces. */
static void weigh(const vlTracing *t, uint32_t n, uint32_t depth, const vlVertices *at,
                  const vlFlightEnds *ends, vlWays *r) {
  const vlSurface *f = &at->surface;
  const vlPaths *p = &at->paths;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    vlVec3 d = vl_row3(&p->d, i);
    float cosine = vl_abs(vl_dot(d, vl_row3(&f->g, i))),
          inv = cosine > 0.0f ? 1.0f / cosine : 0.0f;
    r->cosine[i] = cosine;
    r->a[i] = depth == 0 ? 0.0f : t->lanes->carry[lane] * inv;
    r->b[i] = depth > 0 && vl_is_inner_end(t->world, at, i)
                  ? vl_linked(t, ends, lane, f->t[i], inv)
                  : 0.0f;
    if (depth > 0 || !vl_eye_of(t, lane)->sees)
      continue;
    float pixel = vl_eye_pixel(t, lane, d, f->t[i]);
    r->b[i] =
        t->def->two_way->paths * pixel * f->t[i] * f->t[i] * inv / vl_last_odds(ends, lane);
  }
}

/* Adds the light sample of vertex i as shadow ray `count`, from o; vl_two_way_shadows applies
 * its weight. */
static void push_shadow(const vlTracing *t, uint32_t i, vlVec3 o, uint32_t count,
                        const vlTwoWayVertices *x, const vlLightSamples *l,
                        const vlBsdfValues *bsdf, const vlTwoWayShadows *shadows) {
  const vlVertices *at = x->at;
  const vlSurface *f = &at->surface;
  const vlPaths *p = x->paths;
  vlShadowRays *q = shadows->rays;
  vlVec3 w = vl_row3(&l->w, i);
  if (shadows->flights) {
    const vlWorldShape *shape = &t->world->shapes.items[at->hits.shape[i]];
    vlShadowStart start = {
        o,
        {bsdf->value[0][i], bsdf->value[1][i], bsdf->value[2][i], bsdf->value[3][i]},
        bsdf->pdf[i],
        vl_medium_beyond(shape, vl_row3(&f->g, i), w, x->rows->medium[i])};
    vl_volume_push_shadow(t, p, x->rows, l, i, &start, count, q, shadows->flights);
    vl_shadow_from_surface(t, at, i, bsdf->wi[2][i], count, shadows->flights);
    return;
  }
  vlVec3 d = l->distant[i] ? w : vl_sub(vl_row3(&l->target, i), o);
  vl_shadow_way(p, i, o, d, l->distant[i] ? VL_INFINITY : VL_ONE_MINUS_EPSILON, count, q);
  for (int c = 0; c < 4; c++)
    q->radiance[c][count] = p->beta[c][i] * bsdf->value[c][i] * l->radiance[c][i] * l->pdf[i];
}

/* Takes light samples at n vertices on surfaces, and adds the radiance of those that arrive.
 * light, bsdf, back, q: memory for what is between. */
static void direct_light(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                         const vlTwoWayVertices *x, vlLightSamples *light, vlBsdfValues *bsdf,
                         vlBsdfValues *back, const vlTwoWayShadows *q) {
  const vlWays *ways = x->ways;
  const vlPaths *p = x->paths;
  const vlSurface *f = &x->at->surface;
  const vlLightSamples *l = light;
  uint32_t count = 0;
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, f, dimension, light);
  vl_stage_light_bsdf(t, n, x->at, light, bsdf);
  vl_stage_reverse(t, n, x->at, bsdf->wi, back);
  for (uint32_t i = 0; i < n; i++) {
    if (!(l->pdf[i] > 0.0f) || !vl_has_value(bsdf, i))
      continue;
    vlVec3 at = vl_row3(&f->p, i), g = vl_row3(&f->g, i);
    vlVec3 w = vl_row3(&l->w, i);
    q->strategies->own[count] = l->pdf[i];
    q->strategies->others[count] =
        (l->delta[i] ? 0.0f : bsdf->pdf[i]) +
        (t->def->two_way->merged + ways->a[i] * back->pdf[i] + ways->b[i]) *
            (vl_abs(vl_dot(w, g)) * vl_sampled_density(t, l, i, at));
    push_shadow(t, i, vl_surface_origin(f, i, w), count, x, l, bsdf, q);
    count++;
  }
  vl_two_way_shadows(t, p, count, depth, q);
}

/* Updates what the paths carry after scattering on surfaces: the `count` rays p leave the
 * vertices in `order`. */
static void carry_on(const vlTracing *t, uint32_t count, uint32_t depth, const vlPaths *p,
                     const uint32_t *order, const vlSurface *f, const vlBsdfSamples *samples,
                     const vlBsdfValues *back, const vlWays *ways) {
  const vlTwoWay *way = t->def->two_way;
  vlTwoWayLanes *lanes = t->lanes;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = order[k], lane = p->lane[k], *smooth = &lanes->smooth[lane];
    float cosine = vl_abs(vl_dot(vl_row3(&p->d, k), vl_row3(&f->g, i)));
    float pdf = samples->pdf[i];
    bool specular = samples->flags[i] & VL_SAMPLED_SPECULAR;
    lanes->link[lane] = !specular && pdf > 0.0f ? way->connect / pdf : 0.0f;
    if (way->apart && p->specular[k] && *smooth == depth && depth < t->def->max_depth)
      *smooth = depth + 1;
    lanes->carry[lane] = vl_carried(ways, i, back->pdf[i], specular, pdf, way->merged, cosine);
  }
}

/* With vlTwoWay.apart, each path has its own last bounce. Ends the paths that have reached
 * it. */
static void end_long(const vlTracing *t, uint32_t n, uint32_t depth, const vlPaths *rays,
                     vlHits *hits, vlFlightEnds *ends) {
  uint32_t *smooth = t->lanes->smooth;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = rays->lane[i];
    if (depth == 0)
      smooth[lane] = 0;
    if (depth - smooth[lane] < t->def->max_depth)
      continue;
    hits->shape[i] = VL_NONE;
    if (ends)
      ends->event[i] = VL_AT_END;
  }
}

/* ---- the tracer -------------------------------------------------------------------------- */

static bool arrive(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  const vlTwoWay *way = t->def->two_way;
  vlFlightEnds *ends = vl_flight_ends(t);
  vl_stage_lights_hit(t, n, &s->rays, &s->hits, ends ? &s->volume->rays : NULL, ends,
                      depth == 0 ? add_first : add_later);
  if (way->apart)
    end_long(t, n, depth, &s->rays, &s->hits, ends);
  return !way->light_only;
}

static uint32_t on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlTwoWayRows *r = t->batch->two_way;
  const vlTwoWay *way = t->def->two_way;
  const vlTwoWayVertices x = vl_two_way_at(t);
  const vlTwoWayShadows q = vl_two_way_shadows_of(t);
  uint32_t dimension = vl_bounce_dimension(depth);
  if (vl_has_media(t))
    vl_volume_normalise_all(t, &s->at.paths, &s->volume->at, n);
  weigh(t, n, depth, &s->at, vl_flight_ends(t), &r->ways);
  direct_light(t, n, depth, dimension, &x, &s->light, &s->values, &r->back, &q);
  if (way->inner.paths)
    vl_stage_connect(t, n, depth, &x, &s->values, &r->back, &q);
  if (way->merge)
    vl_stage_merge(t, n, depth, &x, &s->values, &r->back, &r->list);
  uint32_t count = vl_two_way_scatter(t, n, depth, dimension);
  carry_on(t, count, depth, &s->rays, s->order, &s->at.surface, &s->samples, &r->back,
           &r->ways);
  return count;
}

void vl_bidirectional_tracer(vlTracing *t) {
  const vlTwoWay *way = t->def->two_way;
  const vlBounceSteps steps = {arrive, vl_has_media(t) ? vl_eye_in_media : NULL, on_surfaces,
                               add_first, add_later};
  if (way->alone)
    return;
  vl_measure_camera_rays(t, t->batch->two_way->views);
  if (vl_has_media(t))
    vl_volume_start(t, t->batch->n, NULL, &t->s->rays, &t->s->volume->rays);
  vl_trace_bounces(t, t->batch->n, (way->apart ? 2 : 1) * t->def->max_depth, &steps);
}
