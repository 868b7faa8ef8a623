/* trace/two_way/bidirectional.hot.c: the camera side of the two-way tracers: path tracing in
 * which light samples and hit lights are weighted against splats and merging (two_way.h). */
#include "math/warp.h"
#include "trace/two_way/stages.h"

/* ---- lights that paths hit
 * --------------------------------------------------------------------------------------- */

/* density: density of the light paths that arrive at this point. */
static float hit_weight(const vlTracing *t, const vlPaths *p, uint32_t i, float asked,
                        float density) {
  uint32_t lane = p->lane[i];
  asked =
      p->specular[i] || !(asked > 0.0f) ? 0.0f : asked / (p->pdf[i] * vl_last_odds(t, lane));
  return 1.0f / (1.0f + asked + t->batch->two_way->carry[lane] * density);
}

static void add_radiance(vlTracing *t, const vlPaths *p, uint32_t i, const float radiance[4],
                         float weight) {
  if (vl_has_media(t)) {
    float u[4];
    for (int c = 0; c < 4; c++)
      u[c] = t->s->volume->a.u[c][i];
    weight /= vl_flight_mean(u, vl_volume_rgb(t) ? 3 : 4);
  }
  for (int c = 0; c < 4; c++)
    t->batch->radiance[c][p->lane[i]] += p->beta[c][i] * radiance[c] * weight;
}

/* Weight of a light that the camera sees directly, against light paths that start there
 * (vl_show_lights). */
static float seen_weight(const vlTracing *t, const vlPaths *p, uint32_t i, uint32_t light,
                         const vlPoint *at) {
  const vlTwoWay *way = t->def->two_way;
  uint32_t lane = p->lane[i];
  const vlCameraView *eye = vl_eye_of(t, lane);
  if (!at || !eye->sees || way->light_only)
    return 1.0f;
  vlVec3 d = vl_lane3(p->dx, p->dy, p->dz, i);
  float per_square = 1.0f / (vl_eye_pixel(t, lane, d, at->t) * at->t * at->t);
  float area_pdf = vl_emission_area_pdf(t->world, way, light, at->p);
  return 1.0f / (1.0f + vl_shown(way, light, area_pdf, per_square, vl_abs(vl_dot(d, at->g))) /
                            vl_last_odds(t, lane));
}

static void add_first(vlTracing *t, const vlPaths *p, uint32_t i, const vlHitLight *met,
                      bool sky) {
  add_radiance(t, p, i, met->radiance, seen_weight(t, p, i, met->light, sky ? NULL : &met->at));
}

static void add_later(vlTracing *t, const vlPaths *p, uint32_t i, const vlHitLight *met,
                      bool sky) {
  vlVec3 d = vl_lane3(p->dx, p->dy, p->dz, i);
  float density = vl_emission_density(t->world, t->def->two_way, met->light, d,
                                      sky ? VL_INFINITY : met->at.t, sky ? NULL : &met->at);
  add_radiance(t, p, i, met->radiance, hit_weight(t, p, i, met->pdf, density));
}

/* ---- one vertex
 * --------------------------------------------------------------------------------------------------
 */

/* Sets a and b: the strategies that begin on the camera's side (two_way.h). */
static void weigh(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTwoWayRows *r = t->batch->two_way;
  const vlSurface *f = &t->s->at.surface;
  const vlPaths *p = &t->s->at.paths;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    vlVec3 d = vl_lane3(p->dx, p->dy, p->dz, i);
    float cosine = vl_abs(vl_dot(d, vl_lane3(f->gx, f->gy, f->gz, i))),
          inv = cosine > 0.0f ? 1.0f / cosine : 0.0f;
    r->cosine[i] = cosine;
    r->a[i] = depth == 0 ? 0.0f : r->carry[lane] * inv;
    r->b[i] = depth > 0 && vl_is_inner_end(t, i) ? vl_linked(t, r, lane, f->t[i], inv) : 0.0f;
    if (depth > 0 || !vl_eye_of(t, lane)->sees)
      continue;
    float pixel = vl_eye_pixel(t, lane, d, f->t[i]);
    r->b[i] = t->def->two_way->paths * pixel * f->t[i] * f->t[i] * inv / vl_last_odds(t, lane);
  }
}

/* Adds lane i's light sample as shadow ray `count`; vl_two_way_shadows applies its weight.
 * Returns the next count. */
static uint32_t push_shadow(vlTracing *t, uint32_t i, vlVec3 o, uint32_t count) {
  vlTraceScratch *s = t->s;
  const vlBsdfValues *bsdf = &s->values;
  const vlLightSamples *l = &s->light;
  vlShadowRays *q = &s->shadow;
  vlVec3 w = vl_lane3(l->wx, l->wy, l->wz, i);
  if (vl_has_media(t)) {
    const float value[4] = {bsdf->value[0][i], bsdf->value[1][i], bsdf->value[2][i],
                            bsdf->value[3][i]};
    uint32_t medium =
        vl_medium_beyond(&t->world->shapes.items[s->at.hits.shape[i]],
                         vl_lane3(s->at.surface.gx, s->at.surface.gy, s->at.surface.gz, i), w,
                         s->volume->b.medium[i]);
    uint32_t next = vl_volume_push_shadow(t, &s->at.paths, &s->volume->b, i, o, value,
                                          bsdf->pdf[i], medium, count);
    vl_shadow_from_surface(t, count, i, bsdf->wi[2][i]);
    return next;
  }
  vlVec3 d = l->distant[i] ? w : vl_sub(vl_lane3(l->tx, l->ty, l->tz, i), o);
  vl_set_lane3(q->ox, q->oy, q->oz, count, o);
  vl_set_lane3(q->dx, q->dy, q->dz, count, d);
  q->t_max[count] = l->distant[i] ? VL_INFINITY : VL_ONE_MINUS_EPSILON;
  for (int c = 0; c < 4; c++)
    q->radiance[c][count] =
        s->at.paths.beta[c][i] * bsdf->value[c][i] * l->radiance[c][i] * l->pdf[i];
  q->time[count] = vl_path_time(&s->at.paths, i);
  q->lane[count] = s->at.paths.lane[i];
  return count + 1;
}

static void direct_light(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  const vlBsdfValues *bsdf = &s->values;
  vlTwoWayRows *r = t->batch->two_way;
  const vlTwoWay *way = t->def->two_way;
  if (world->lights.count == 0)
    return;
  const vlPaths *p = &s->at.paths;
  const vlSurface *f = &s->at.surface;
  vl_stage_light_samples(t, n, p, f, dimension, &s->light);
  vl_stage_light_bsdf(t, n, &s->at, &s->light, &s->values);
  const vlLightSamples *l = &s->light;
  uint32_t count = 0, *lane_of = r->count;
  for (uint32_t i = 0; i < n; i++) {
    if (!(l->pdf[i] > 0.0f))
      continue;
    float sum = bsdf->value[0][i] + bsdf->value[1][i] + bsdf->value[2][i] + bsdf->value[3][i];
    if (!(sum > 0.0f) && sum == sum)
      continue;
    vlVec3 at = vl_lane3(f->px, f->py, f->pz, i), g = vl_lane3(f->gx, f->gy, f->gz, i);
    vlVec3 w = vl_lane3(l->wx, l->wy, l->wz, i);
    vlPoint point;
    __builtin_memset(&point, 0, sizeof point);
    point.p = vl_lane3(l->tx, l->ty, l->tz, i);
    r->light_ways[count] =
        vl_abs(vl_dot(w, g)) *
        vl_emission_density(world, way, l->light[i], w, vl_length(vl_sub(point.p, at)), &point);
    r->light_pdf[count] = l->delta[i] ? 0.0f : bsdf->pdf[i];
    r->own[count] = l->pdf[i];
    lane_of[count] = i;
    count = push_shadow(t, i, vl_offset_origin(at, g, f->offset[i], w), count);
  }
  vl_stage_reverse(t, n, &s->at, bsdf->wi, &r->back);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = lane_of[k];
    r->others[k] =
        r->light_pdf[k] + (way->merged + r->a[i] * r->back.pdf[i] + r->b[i]) * r->light_ways[k];
  }
  vl_two_way_shadows(t, p, count, depth);
}

static uint32_t scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  const vlBsdfSamples *samples = &s->samples;
  vlTwoWayRows *r = t->batch->two_way;
  const vlTwoWay *way = t->def->two_way;
  const vlSurface *f = &s->at.surface;
  const vlPaths *p = &s->rays;
  uint32_t count =
      vl_stage_scatter(t, n, depth + 1, dimension, &s->at, &s->samples, s->order, &s->rays);
  if (vl_has_media(t))
    vl_volume_go_on(t, count);
  vl_stage_reverse(t, n, &s->at, samples->wi, &r->back);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = s->order[k], lane = p->lane[k], *smooth = &r->smooth[lane];
    float cosine =
        vl_abs(vl_dot(vl_lane3(p->dx, p->dy, p->dz, k), vl_lane3(f->gx, f->gy, f->gz, i)));
    float pdf = samples->pdf[i];
    bool specular = samples->flags[i] & VL_SAMPLED_SPECULAR;
    r->link[lane] = !specular && pdf > 0.0f ? way->connect / pdf : 0.0f;
    if (way->apart && p->specular[k] && *smooth == depth && depth < t->def->max_depth)
      *smooth = depth + 1;
    r->carry[lane] = vl_carried(r, i, specular, pdf, way->merged, cosine);
  }
  return count;
}

/* With vlTwoWay.apart, each path has its own last bounce. Ends the paths that have reached it.
 */
static void end_long(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  uint32_t *smooth = t->batch->two_way->smooth;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = s->rays.lane[i];
    if (depth == 0)
      smooth[lane] = 0;
    if (depth - smooth[lane] < t->def->max_depth)
      continue;
    s->hits.shape[i] = VL_NONE;
    if (vl_has_media(t))
      s->volume->event[i] = VL_AT_END;
  }
}

/* ---- the tracers
 * -------------------------------------------------------------------------------------------------
 */

static bool arrive(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  const vlTwoWay *way = t->def->two_way;
  vl_stage_lights_hit(t, n, &s->rays, &s->hits, vl_has_media(t) ? s->volume->event : NULL,
                      depth == 0 ? add_first : add_later);
  if (way->apart)
    end_long(t, n, depth);
  return !way->light_only;
}

static uint32_t on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  uint32_t dimension = vl_bounce_dimension(depth);
  if (vl_has_media(t))
    vl_volume_normalise_all(t, &t->s->at.paths, &t->s->volume->b, n);
  weigh(t, n, depth);
  direct_light(t, n, depth, dimension);
  if (t->def->two_way->inner.paths)
    vl_stage_connect(t, n, depth);
  if (t->def->two_way->merge)
    vl_stage_merge(t, n, depth);
  return scatter(t, n, depth, dimension);
}

void vl_bidirectional_tracer(vlTracing *t) {
  const vlTwoWay *way = t->def->two_way;
  const vlBounceSteps steps = {arrive, vl_has_media(t) ? vl_eye_in_media : NULL, on_surfaces};
  if (way->alone)
    return;
  vl_measure_camera_rays(t);
  if (vl_has_media(t))
    vl_volume_start(t, t->batch->n, NULL);
  vl_trace_bounces(t, t->batch->n, (way->apart ? 2 : 1) * t->def->max_depth, &steps);
}
