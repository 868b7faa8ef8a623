/* trace/two_way/volume.hot.c: vertices in media, of camera and light paths (two_way.h). The
 * phase function's value is its density, in both directions. */
#include "trace/medium/phase.h"
#include "trace/two_way/stages.h"

void vl_two_way_shadows(vlTracing *t, const vlPaths *p, uint32_t count, uint32_t depth) {
  vlShadowRays *q = &t->s->shadow;
  vl_stage_occluded(t, count, p, q);
  t->batch->shadow_rays += count;
  if (vl_has_media(t))
    vl_volume_pass_media(t, p, count, depth);
  for (uint32_t k = 0; k < count; k++) {
    float passes[4], scale;
    if (!vl_two_way_arrives(t, t->batch->two_way, k, passes, &scale))
      continue;
    for (int c = 0; c < 4; c++)
      t->batch->radiance[c][q->lane[k]] += q->radiance[c][k] * passes[c] * scale;
  }
}

static float extinction(const vlTracing *t, uint32_t i) {
  const vlVolumeScratch *v = t->s->volume;
  const vlPaths *p = &v->scattered;
  return vl_medium_extinction(&t->world->media.items[v->c.medium[i]],
                              vl_lane3(p->ox, p->oy, p->oz, i));
}

static float phase_of(const vlTracing *t, uint32_t i,
                      vlVec3 w) { /* w: unit, away from the vertex */
  const vlVolumeScratch *v = t->s->volume;
  return vl_phase(t->world->media.items[v->c.medium[i]].g,
                  vl_dot(vl_lane3(v->scattered.dx, v->scattered.dy, v->scattered.dz, i), w));
}

/* ---- camera paths
 * ------------------------------------------------------------------------------------------------
 */

static void arrive(vlTracing *t, uint32_t n, uint32_t depth) {
  const vlVolumeScratch *v = t->s->volume;
  const vlPaths *p = &v->scattered;
  vlTwoWayRows *r = t->batch->two_way;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    float dense = extinction(t, i), distance = v->t[t->s->order[i]];
    r->cosine[i] = dense;
    r->a[i] = depth == 0 ? 0.0f : r->carry[lane] / dense;
    r->b[i] = depth == 0 ? 0.0f : vl_linked(t, r, lane, distance, 1.0f / dense);
    if (depth > 0 || !vl_eye_of(t, lane)->sees)
      continue;
    float pixel = vl_eye_pixel(t, lane, vl_lane3(p->dx, p->dy, p->dz, i), distance);
    r->b[i] = t->def->two_way->paths * pixel * distance * distance / (dense * v->odds[lane]);
  }
}

static void light_samples(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  const vlWorld *world = t->world;
  const vlTwoWay *way = t->def->two_way;
  vlVolumeScratch *v = t->s->volume;
  const vlPaths *p = &v->scattered;
  vlTwoWayRows *r = t->batch->two_way;
  const vlLightSamples *l = &t->s->light;
  if (world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, &t->s->at.surface, dimension, &t->s->light);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!(l->pdf[i] > 0.0f))
      continue;
    vlVec3 at = vl_lane3(p->ox, p->oy, p->oz, i), w = vl_lane3(l->wx, l->wy, l->wz, i);
    float phase = phase_of(t, i, w);
    const float value[4] = {phase, phase, phase, phase};
    vlPoint point;
    __builtin_memset(&point, 0, sizeof point);
    point.p = vl_lane3(l->tx, l->ty, l->tz, i);
    float density =
        vl_emission_density(world, way, l->light[i], w, vl_length(vl_sub(point.p, at)), &point);
    r->own[count] = l->pdf[i];
    r->others[count] =
        (l->delta[i] ? 0.0f : phase) +
        (way->merged_volume + r->a[i] * phase + r->b[i]) * density * r->cosine[i];
    count = vl_volume_push_shadow(t, p, &v->c, i, at, value, phase, v->c.medium[i], count);
  }
  vl_two_way_shadows(t, p, count, depth);
}

/* Samples new directions and updates the carried densities. */
static uint32_t scatter(vlTracing *t, vlTwoWayRows *r, uint32_t n, uint32_t depth,
                        uint32_t dimension) {
  const vlPaths *p = &t->s->volume->scattered;
  uint32_t count = vl_volume_phase_scatter(t, n, depth + 1, dimension);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = t->s->volume->kept[k];
    float pdf = p->pdf[i];
    r->carry[p->lane[i]] =
        (r->a[i] * pdf + r->b[i] + t->def->two_way->merged_volume) * r->cosine[i] / pdf;
    r->link[p->lane[i]] = t->def->two_way->connect / pdf;
  }
  return count;
}

uint32_t vl_eye_in_media(vlTracing *t, uint32_t n, uint32_t depth) {
  uint32_t dimension = vl_bounce_dimension(depth);
  n = vl_volume_gather(t, n);
  if (n == 0)
    return 0;
  arrive(t, n, depth);
  light_samples(t, n, depth, dimension);
  if (t->def->two_way->inner.paths)
    vl_connect_from_media(t, n, depth);
  if (t->def->two_way->merge)
    vl_stage_merge_media(t, n, depth);
  return scatter(t, t->batch->two_way, n, depth, dimension);
}

/* ---- light paths
 * -------------------------------------------------------------------------------------------------
 */

static void arrive_from_light(vlTracing *t, vlTwoWayRows *r, uint32_t n, uint32_t depth) {
  const vlVolumeScratch *v = t->s->volume;
  const vlPaths *p = &v->scattered;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    float dense = extinction(t, i), inv = 1.0f / dense, distance = v->t[t->s->order[i]];
    r->cosine[i] = dense;
    r->b[i] = depth > 0 ? vl_linked(t, r, lane, distance, inv) : 0.0f;
    if (depth == 0) {
      float density = vl_light_density(t, r, lane, distance);
      vlVec3 w = vl_neg(vl_lane3(p->dx, p->dy, p->dz, i));
      inv = density > 0.0f ? inv / density : 0.0f;
      r->b[i] = inv / v->odds[lane] *
                vl_light_sample_pdf(
                    t->world, r, lane,
                    (vlReceiver){vl_lane3(p->ox, p->oy, p->oz, i), vl_vec3(0, 0, 0), 0.0f}, w);
    }
    r->a[i] = r->carry[lane] * inv;
  }
}

/* Stores photons. A channel that does not scatter here has no power. */
static void leave_photons(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n,
                          uint32_t depth) {
  const vlVolumeScratch *v = t->s->volume;
  const vlPaths *p = &v->scattered;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    const vlWorldMedium *m = &t->world->media.items[v->c.medium[i]];
    vlPhoton *x = &r->photons[count];
    uint32_t lane = p->lane[i];
    float lambda[4], sum = 0.0f;
    vl_path_lambda(p, i, lambda);
    vlVec3 at = vl_lane3(p->ox, p->oy, p->oz, i);
    vlMediumLight k = vl_medium_coefficients(m, lambda);
    if (!m->uniform)
      k = vl_medium_at(m, &k, lambda, at, false);
    x->p[0] = at.x;
    x->p[1] = at.y;
    x->p[2] = at.z;
    x->w[0] = -p->dx[i];
    x->w[1] = -p->dy[i];
    x->w[2] = -p->dz[i];
    for (int c = 0; c < 4; c++)
      sum += x->power[c] = k.s[c] > 0.0f ? p->beta[c][i] * r->flux[c][lane] / k.s[c] : 0.0f;
    x->a = r->a[i];
    x->b = r->b[i];
    x->bounce = depth + 1;
    x->id = b->first + lane;
    x->alone = vl_hero_only(p, i);
    x->passed = t->world->by_channel ? vl_pack_passed(t->s, lane) : 0;
    x->medium = 1 + v->c.medium[i];
    count += sum > 0.0f && sum < VL_INFINITY;
  }
  if (count)
    b->store(b->user, count, r->photons);
}

/* Stores vertices that camera paths connect to. */
static void leave_vertices(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n,
                           uint32_t depth) {
  const vlTwoWay *way = t->def->two_way;
  const vlVolumeScratch *v = t->s->volume;
  const vlPaths *p = &v->scattered;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i], path = b->first + lane, medium = v->c.medium[i];
    if (path >= way->inner.paths)
      continue;
    vlLightVertex *x = &r->vertices[count];
    float sum = 0.0f;
    x->p[0] = p->ox[i];
    x->p[1] = p->oy[i];
    x->p[2] = p->oz[i];
    x->a = r->a[i];
    x->dense = r->cosine[i];
    x->asymmetry = t->world->media.items[medium].g;
    x->n[0] = p->dx[i];
    x->n[1] = p->dy[i];
    x->n[2] = p->dz[i];
    for (int c = 0; c < 4; c++)
      sum += x->power[c] = p->beta[c][i] * r->flux[c][lane];
    x->back = r->b[i] + way->merged_volume;
    x->offset = 0.0f;
    x->path = path & 0x3ffffu;
    x->bounce = (depth + 1) & 255u;
    x->alone = vl_hero_only(p, i);
    x->inside = 1;
    x->air = vl_air(t->world, medium) & 15u;
    r->first[count] = t->world->by_channel ? vl_pack_passed(t->s, lane) : 0;
    count += sum > 0.0f && sum < VL_INFINITY;
  }
  if (count)
    b->leave(b->user, count, r->vertices, r->first);
}

static void show(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n, uint32_t depth,
                 uint32_t dimension) {
  const vlTwoWay *way = t->def->two_way;
  if (!way->eye.sees)
    return;
  vlVolumeScratch *v = t->s->volume;
  const vlPaths *p = &v->scattered;
  vlNumbers *u = &t->s->numbers;
  vlShadowRays *q = &t->s->shadow;
  if (way->eye.lens_radius > 0.0f)
    t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LIGHT_UV,
                       u->u1, u->u2);
  uint32_t count = 0;
  vl_look_from(t, r, n, p->ox, p->oy, p->oz);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    vlVec3 o = vl_lane3(p->ox, p->oy, p->oz, i);
    vlCameraSample view = vl_view_of(t, r, i, lane, o, u->u1[i], u->u2[i]);
    if (!view.seen)
      continue;
    float phase = phase_of(t, i, view.w);
    vl_set_lane3(q->ox, q->oy, q->oz, count, o);
    vl_set_lane3(q->dx, q->dy, q->dz, count, view.w);
    q->t_max[count] = vl_min(view.end, 1.0f - 0x1p-21f) * vl_length(vl_sub(view.from, o));
    q->time[count] = vl_path_time(p, i);
    q->lane[count] = lane;
    r->own[count] = way->paths / view.per_square;
    r->others[count] = way->light_only
                           ? 0.0f
                           : r->cosine[i] * (way->merged_volume + r->a[i] * phase + r->b[i]);
    for (int c = 0; c < 4; c++) {
      q->radiance[c][count] = p->beta[c][i] * r->flux[c][lane] * phase * view.weight;
      v->density[c][count] = v->c.u[c][i];
    }
    v->shadow_medium[count] = v->c.medium[i];
    v->from[count] = i;
    vl_shadow_from_medium(t, count, lane);
    r->x[count] = view.x;
    r->y[count] = view.y;
    count++;
  }
  vl_two_way_splats(t, r, b, p, count, depth);
}

uint32_t vl_light_in_media(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTwoWayRows *r = t->batch->two_way;
  vlLightBatch *b = t->light;
  uint32_t dimension = vl_bounce_dimension(depth);
  bool last = depth + 1 == vl_light_bounces(t->def);
  n = vl_volume_gather(t, n);
  if (n == 0)
    return 0;
  arrive_from_light(t, r, n, depth);
  if (t->def->two_way->merge)
    leave_photons(t, r, b, n, depth);
  if (t->def->two_way->inner.paths && !last)
    leave_vertices(t, r, b, n, depth);
  show(t, r, b, n, depth, dimension);
  return last ? 0 : scatter(t, r, n, depth, dimension);
}
