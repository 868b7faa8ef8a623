/* trace/two_way/volume.hot.c: vertices in media, of camera and light paths (two_way.h). The
 * phase function's value is its density, in both directions. */
#include "trace/medium/phase.h"
#include "trace/two_way/stages.h"

void vl_two_way_shadows(vlTracing *t, const vlPaths *p, uint32_t count, uint32_t depth,
                        const vlTwoWayShadows *shadows) {
  vlShadowRays *q = shadows->rays;
  vl_stage_occluded(t, count, p, q);
  t->batch->shadow_rays += count;
  if (shadows->flights)
    vl_volume_pass_media(t, p, count, depth, q, shadows->flights);
  for (uint32_t k = 0; k < count; k++) {
    float passes[4], scale;
    if (!vl_two_way_arrives(t, k, passes, &scale, shadows))
      continue;
    for (int c = 0; c < 4; c++)
      t->batch->radiance[c][q->lane[k]] += q->radiance[c][k] * passes[c] * scale;
  }
}

static float extinction(const vlWorld *world, const vlMediumVertices *in, uint32_t i) {
  const vlPaths *p = &in->paths;
  return vl_medium_extinction(&world->media.items[in->rows.medium[i]], vl_row3(&p->o, i));
}

/* w: unit, away from the vertex */
static float phase_of(const vlWorld *world, const vlTwoWayVertices *x, uint32_t i, vlVec3 w) {
  const vlPaths *p = x->paths;
  return vl_phase(world->media.items[x->rows->medium[i]].g, vl_dot(vl_row3(&p->d, i), w));
}

/* Samples new directions and updates what the paths carry. */
static uint32_t scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                        const vlWays *ways, vlMediumVertices *in, uint32_t *kept) {
  const vlPaths *p = &in->paths;
  const vlTwoWay *way = t->def->two_way;
  uint32_t count = vl_volume_phase_scatter(t, n, depth + 1, dimension, in, kept);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = kept[k], lane = p->lane[i];
    float pdf = p->pdf[i];
    t->lanes->carry[lane] =
        (ways->a[i] * pdf + ways->b[i] + way->merged_volume) * ways->cosine[i] / pdf;
    t->lanes->link[lane] = way->connect / pdf;
  }
  return count;
}

/* ---- camera paths ------------------------------------------------------------------------ */

/* Sets the strategies that begin on the camera's side, of n vertices. */
static void arrive(const vlTracing *t, uint32_t n, uint32_t depth, const vlMediumVertices *in,
                   const vlFlightEnds *ends, vlWays *to) {
  const vlPaths *p = &in->paths;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    float dense = extinction(t->world, in, i), distance = ends->t[in->ray[i]];
    to->cosine[i] = dense;
    to->a[i] = depth == 0 ? 0.0f : t->lanes->carry[lane] / dense;
    to->b[i] = depth == 0 ? 0.0f : vl_linked(t, ends, lane, distance, 1.0f / dense);
    if (depth > 0 || !vl_eye_of(t, lane)->sees)
      continue;
    float pixel = vl_eye_pixel(t, lane, vl_row3(&p->d, i), distance);
    to->b[i] =
        t->def->two_way->paths * pixel * distance * distance / (dense * ends->odds[lane]);
  }
}

/* Takes light samples at n vertices, and adds the radiance of those that arrive. light, q:
 * memory for what is between. */
static void light_samples(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                          const vlTwoWayVertices *x, const vlSurface *points,
                          vlLightSamples *light, const vlTwoWayShadows *q) {
  const vlWorld *world = t->world;
  const vlTwoWay *way = t->def->two_way;
  const vlPaths *p = x->paths;
  const vlWays *ways = x->ways;
  const vlLightSamples *l = light;
  if (world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, points, dimension, light);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!(l->pdf[i] > 0.0f))
      continue;
    vlVec3 at = vl_row3(&p->o, i), w = vl_row3(&l->w, i);
    float phase = phase_of(world, x, i, w);
    float density = vl_sampled_density(t, l, i, at);
    q->strategies->own[count] = l->pdf[i];
    q->strategies->others[count] =
        (l->delta[i] ? 0.0f : phase) +
        (way->merged_volume + ways->a[i] * phase + ways->b[i]) * density * ways->cosine[i];
    vlShadowStart start = {at, {phase, phase, phase, phase}, phase, x->rows->medium[i]};
    vl_volume_push_shadow(t, p, x->rows, l, i, &start, count++, q->rays, q->flights);
  }
  vl_two_way_shadows(t, p, count, depth, q);
}

uint32_t vl_eye_in_media(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlWays *ways = &t->batch->two_way->ways;
  vlSurface *points = &s->at.surface; /* free until rays are sorted */
  const vlTwoWayVertices x = vl_two_way_scattered(t);
  const vlTwoWayShadows q = vl_two_way_shadows_of(t);
  uint32_t dimension = vl_bounce_dimension(depth);
  n = vl_volume_gather(t, n, &s->rays, &v->rays, &v->ends, &v->scattered, points);
  if (n == 0)
    return 0;
  arrive(t, n, depth, &v->scattered, &v->ends, ways);
  light_samples(t, n, depth, dimension, &x, points, &s->light, &q);
  if (t->def->two_way->inner.paths)
    vl_connect_from_media(t, n, depth, &x, &q);
  if (t->def->two_way->merge)
    vl_stage_merge_media(t, n, depth, &x);
  return scatter(t, n, depth, dimension, ways, &v->scattered, v->kept);
}

/* ---- light paths ------------------------------------------------------------------------- */

static void arrive_from_light(const vlTracing *t, uint32_t n, uint32_t depth,
                              const vlMediumVertices *in, const vlFlightEnds *ends,
                              vlWays *to) {
  const vlPaths *p = &in->paths;
  for (uint32_t i = 0; i < n; i++) {
    vlReceiver at = {vl_row3(&p->o, i), vl_vec3(0, 0, 0), 0.0f};
    vl_arrive_from_light(t, depth, p, i, at, extinction(t->world, in, i), ends->t[in->ray[i]],
                         ends, to);
  }
}

/* Stores photons. A channel that does not scatter here has no power. */
static void leave_photons(const vlTracing *t, uint32_t n, uint32_t depth,
                          const vlTwoWayVertices *v, vlPhoton *photons) {
  const vlLightBatch *b = t->light;
  const vlPaths *p = v->paths;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    const vlWorldMedium *m = &t->world->media.items[v->rows->medium[i]];
    vlPhoton *x = &photons[count];
    float lambda[4];
    vl_path_lambda(p, i, lambda);
    vlVec3 at = vl_row3(&p->o, i);
    vlMediumLight k = vl_medium_coefficients(m, lambda);
    if (!m->uniform)
      k = vl_medium_at(m, &k, lambda, at, false);
    vl_leave_photon(t, depth, v, i, at, 1 + v->rows->medium[i], x);
    for (int c = 0; c < 4; c++)
      x->power[c] =
          k.s[c] > 0.0f ? p->beta[c][i] * t->lanes->flux[c][p->lane[i]] / k.s[c] : 0.0f;
    count += vl_carries_power(x->power);
  }
  if (count)
    b->store(b->user, count, photons);
}

/* Stores vertices that camera paths connect to. passed: memory for vlPhoton.passed. */
static void leave_vertices(const vlTracing *t, uint32_t n, uint32_t depth,
                           const vlTwoWayVertices *v, vlLightVertex *vertices,
                           uint32_t *passed) {
  const vlTwoWay *way = t->def->two_way;
  const vlLightBatch *b = t->light;
  const vlPaths *p = v->paths;
  const vlWays *ways = v->ways;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i], medium = v->rows->medium[i];
    if (b->first + lane >= way->inner.paths)
      continue;
    vlLightVertex *x = &vertices[count];
    vl_leave_path(t, depth, v, i, vl_row3(&p->o, i), x, &passed[count]);
    x->a = ways->a[i];
    x->dense = ways->cosine[i];
    x->asymmetry = t->world->media.items[medium].g;
    vl_store3(x->n, vl_row3(&p->d, i));
    for (int c = 0; c < 4; c++)
      x->power[c] = p->beta[c][i] * t->lanes->flux[c][lane];
    x->back = ways->b[i] + way->merged_volume;
    x->offset = 0.0f;
    x->inside = 1;
    count += vl_carries_power(x->power);
  }
  if (count)
    b->leave(b->user, count, vertices, passed);
}

/* Connects n vertices to the camera, as vl_connect_to_camera does for surfaces. */
static void show(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                 const vlTwoWayVertices *x, vlCameraSample *views, vlSplatRows *splats,
                 const vlTwoWayShadows *shadows) {
  const vlTwoWay *way = t->def->two_way;
  if (!way->eye.sees)
    return;
  const vlPaths *p = x->paths;
  const vlWays *ways = x->ways;
  vlShadowRays *q = shadows->rays;
  vlShadowFlights *f = shadows->flights;
  uint32_t count = 0;
  vl_look_from(t, n, p, dimension, &p->o, views);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    vlVec3 o = vl_row3(&p->o, i);
    const vlCameraSample *view = &views[i];
    if (!view->seen)
      continue;
    float phase = phase_of(t->world, x, i, view->w);
    vl_shadow_way(p, i, o, view->w,
                  vl_min(view->end, VL_SHADOW_END) * vl_length(vl_sub(view->from, o)), count,
                  q);
    shadows->strategies->own[count] = way->paths / view->per_square;
    shadows->strategies->others[count] =
        way->light_only
            ? 0.0f
            : ways->cosine[i] * (way->merged_volume + ways->a[i] * phase + ways->b[i]);
    for (int c = 0; c < 4; c++) {
      q->radiance[c][count] = p->beta[c][i] * t->lanes->flux[c][lane] * phase * view->weight;
      f->density[c][count] = x->rows->u[c][i];
    }
    f->medium[count] = x->rows->medium[i];
    f->from[count] = i;
    vl_shadow_from_medium(t, lane, count, f);
    splats->x[count] = view->x;
    splats->y[count] = view->y;
    count++;
  }
  vl_two_way_splats(t, p, count, depth, splats, shadows);
}

uint32_t vl_light_in_media(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlTwoWayRows *r = t->batch->two_way;
  const vlTwoWay *way = t->def->two_way;
  const vlTwoWayVertices x = vl_two_way_scattered(t);
  const vlTwoWayShadows q = vl_two_way_shadows_of(t);
  uint32_t dimension = vl_bounce_dimension(depth);
  bool last = depth + 1 == vl_light_bounces(t->def);
  n = vl_volume_gather(t, n, &s->rays, &v->rays, &v->ends, &v->scattered, &s->at.surface);
  if (n == 0)
    return 0;
  arrive_from_light(t, n, depth, &v->scattered, &v->ends, &r->ways);
  if (way->merge)
    leave_photons(t, n, depth, &x, r->photons);
  if (way->inner.paths && !last)
    leave_vertices(t, n, depth, &x, r->vertices, r->passed);
  show(t, n, depth, dimension, &x, r->views, &r->splats, &q);
  return last ? 0 : scatter(t, n, depth, dimension, &r->ways, &v->scattered, v->kept);
}
