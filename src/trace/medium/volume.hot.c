/* trace/medium/volume.hot.c: path tracing through participating media. Surfaces use the path
 * tracer's stages; between them are flights (medium.hot.c) that scatter in media or cross
 * interfaces (pbrt book 14.2.3). All lanes of a batch are at the same depth, in a medium or on
 * a surface:
 *
 *   rays -> travel -> emission -> those that scatter in media: light samples, phase function ->
 *     volume.scattered
 *                              -> those on surfaces: as in path.hot.c -> rays
 *   rays <- both
 *
 * The weight is beta over the mean of the rescaled densities: u, of the path as it was sampled,
 * and l, of the path if light sampling had sampled its last segment. */
#include "trace/medium/volume.h"
#include "trace/medium/phase.h"
#include "trace/surface/probes.h"
#include "tracer/record.h"

/* ---- weights and densities --------------------------------------------------------------- */

void vl_volume_permute(const vlVolumeRows *a, vlVolumeRows *b, const uint32_t *order,
                       uint32_t n) {
  for (int c = 0; c < 4; c++)
    for (uint32_t k = 0; k < n; k++) {
      b->u[c][k] = a->u[c][order[k]];
      b->l[c][k] = a->l[c][order[k]];
    }
  for (uint32_t k = 0; k < n; k++)
    b->medium[k] = a->medium[order[k]];
}

/* A path with only the hero wavelength uses the hero's density, if the hero samples its
 * flights. */
void vl_volume_normalise(const vlTracing *t, vlPaths *p, vlVolumeRows *v, uint32_t i) {
  float u[4];
  bool alone = !t->light && !vl_volume_rgb(t) && p->lambda[1][i] == p->lambda[0][i];
  for (int c = 0; c < 4; c++)
    u[c] = v->u[alone ? 0 : c][i];
  float inv = 1.0f / vl_flight_mean(u, vl_volume_rgb(t) ? 3 : 4);
  for (int c = 0; c < 4; c++) {
    v->u[c][i] = u[c] * inv;
    p->beta[c][i] *= inv;
  }
}

void vl_volume_normalise_all(const vlTracing *t, vlPaths *p, vlVolumeRows *v, uint32_t n) {
  if (vl_volume_rgb(t)) {
    for (uint32_t i = 0; i < n; i++)
      vl_volume_normalise(t, p, v, i);
    return;
  }
  uint32_t padded = VL_PAD(n);
  int heroes = !t->light;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    float first = p->lambda[0][i], second = p->lambda[1][i];
    int alone = heroes & (second == first);
    float u0 = v->u[0][i], u1 = alone ? u0 : v->u[1][i];
    float u2 = alone ? u0 : v->u[2][i], u3 = alone ? u0 : v->u[3][i];
    float inv = 1.0f / vl_flight_mean_of(u0, u1, u2, u3, 4);
    v->u[0][i] = u0 * inv;
    v->u[1][i] = u1 * inv;
    v->u[2][i] = u2 * inv;
    v->u[3][i] = u3 * inv;
    for (int c = 0; c < 4; c++)
      p->beta[c][i] *= inv;
  }
}

/* ---- lights that rays hit ---------------------------------------------------------------- */

static void add_light(vlTracing *t, const vlPaths *p, const vlVolumeRows *rows,
                      VL_UNUSED const vlFlightEnds *ends, uint32_t i, const vlHitLight *met,
                      VL_UNUSED bool sky) {
  vl_add_radiance(t, p, i, met->radiance, vl_volume_inverse_density(t, rows, i, met->pdf));
}

/* ---- scattering in media ----------------------------------------------------------------- */

/* Takes light samples at the points of n vertices in media, and adds the radiance of those that
 * arrive. light, q, flights: memory for what is between. */
static void phase_light(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                        const vlMediumVertices *in, const vlSurface *points,
                        vlLightSamples *light, vlShadowRays *q, vlShadowFlights *flights) {
  const vlPaths *p = &in->paths;
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, points, dimension, light);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!(light->pdf[i] > 0.0f))
      continue;
    uint32_t medium = in->rows.medium[i];
    vlVec3 d = vl_row3(&p->d, i);
    vlVec3 w = vl_row3(&light->w, i);
    float phase = vl_phase(t->world->media.items[medium].g, vl_dot(d, w));
    vlShadowStart start = {vl_row3(&p->o, i), {phase, phase, phase, phase}, phase, medium};
    vl_volume_push_shadow(t, p, &in->rows, light, i, &start, count++, q, flights);
  }
  vl_volume_shadows(t, p, light, count, depth, q, flights);
}

uint32_t vl_volume_phase_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                                 vlMediumVertices *in, uint32_t *kept) {
  vlPaths *p = &in->paths;
  vlVolumeRows *rows = &in->rows;
  vlNumbers u;
  vl_draw_1d(t, n, p, dimension + VL_DIM_ROULETTE, u.u0);
  vl_draw_2d(t, n, p, dimension + VL_DIM_BSDF_UV, u.u1, u.u2);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    float max = vl_largest4(p->beta[0][i], p->beta[1][i], p->beta[2][i], p->beta[3][i]);
    vl_note_unsound(t, p, i);
    float survive = vl_roulette_survival(max * p->eta_scale[i], depth);
    if (!(max > 0.0f) || !(u.u0[i] < survive))
      continue;
    vlVec3 d = vl_row3(&p->d, i);
    float g = t->world->media.items[rows->medium[i]].g;
    vlVec3 w = vl_phase_sample(g, d, u.u1[i], u.u2[i]);
    float pdf = vl_phase(g, vl_dot(d, w));
    for (int c = 0; c < 4; c++) {
      p->beta[c][i] /= survive;
      rows->l[c][i] = rows->u[c][i] / pdf;
    }
    vl_set_row3(&p->d, i, w);
    p->pdf[i] = pdf;
    p->specular[i] = 0;
    vl_note_scattered(t, p->lane[i]);
    vl_limits_count_medium(t, p->lane[i]);
    kept[count++] = i;
  }
  return count;
}

uint32_t vl_volume_gather(const vlTracing *t, uint32_t n, const vlPaths *rays,
                          const vlVolumeRows *rows, const vlFlightEnds *ends,
                          vlMediumVertices *to, vlSurface *points) {
  vlPaths *p = &to->paths;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++)
    if (ends->event[i] == VL_IN_MEDIUM)
      to->ray[count++] = i;
  if (count == 0)
    return 0;
  p->time = rays->time;
  vl_permute_paths(rays, p, to->ray, count);
  vl_volume_permute(rows, &to->rows, to->ray, count);
  vl_volume_normalise_all(t, p, &to->rows, count);
  for (uint32_t i = 0; i < count; i++) {
    float distance = ends->t[to->ray[i]];
    p->o.x[i] += distance * p->d.x[i];
    p->o.y[i] += distance * p->d.y[i];
    p->o.z[i] += distance * p->d.z[i];
    p->cone[i] = vl_abs(p->cone[i] + p->spread[i] * distance);
    p->spread[i] = t->def->pixel_spread;
    p->from_n.x[i] = p->from_n.y[i] = p->from_n.z[i] = p->from_side[i] = 0.0f;
    vl_set_row3(&points->p, i, vl_row3(&p->o, i));
    /* no normal: all directions count equally */
    points->n.x[i] = points->n.y[i] = points->n.z[i] = 0.0f;
    points->no_cosine[i] = 1.0f;
    points->side[i] = 0.0f;
  }
  return count;
}

/* Scatters those of the n rays that scatter in media. The new rays are in s->volume->scattered.
 */
static uint32_t scatter_in_media(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlMediumVertices *in = &v->scattered;
  vlSurface *points = &s->at.surface; /* free until rays are sorted */
  uint32_t dimension = vl_bounce_dimension(depth);
  uint32_t count = vl_volume_gather(t, n, &s->rays, &v->rays, &v->ends, in, points);
  if (count == 0)
    return 0;
  if (t->batch->recorder)
    vl_record_scattering(t, &in->paths, count);
  phase_light(t, count, depth, dimension, in, points, &s->light, &s->shadow, &v->shadow);
  uint32_t on = vl_volume_phase_scatter(t, count, depth + 1, dimension, in, v->kept);
  if (t->batch->recorder)
    vl_record_phase(t, count, depth + 1, &in->paths, v->kept, on);
  return on;
}

/* ---- scattering on surfaces -------------------------------------------------------------- */

/* Makes the shadow rays of all n light samples, each at the index of its lane, as
 * vl_volume_push_shadow does. lit: 1 for those that contribute. */
static void make_shadows(uint32_t n, const vlVertices *at, const vlLightSamples *l,
                         const vlBsdfValues *bsdf, vlShadowRays *q, vlShadowFlights *flights,
                         uint32_t lit[VL_ROW_SIZE]) {
  const vlPaths *p = &at->paths;
  const vlSurface *f = &at->surface;
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    float pdf = l->pdf[i];
    vlVec3 w = vl_vec3(l->w.x[i], l->w.y[i], l->w.z[i]);
    vlVec3 o = vl_surface_origin(f, i, w);
    vlVec3 to = vl_sub(vl_vec3(l->target.x[i], l->target.y[i], l->target.z[i]), o),
           d = vl_normalize(to);
    int distant = l->distant[i], delta = l->delta[i];
    float length = distant ? VL_INFINITY : vl_length(to), own = bsdf->pdf[i];
    lit[i] = (pdf > 0.0f) & vl_has_value(bsdf, i) ? 1 : 0;
    vl_set_row3(&q->o, i, o);
    q->d.x[i] = distant ? w.x : d.x;
    q->d.y[i] = distant ? w.y : d.y;
    q->d.z[i] = distant ? w.z : d.z;
    q->t_max[i] = length * VL_SHADOW_END;
    for (int c = 0; c < 4; c++)
      q->radiance[c][i] = p->beta[c][i] * bsdf->value[c][i] * l->radiance[c][i] * pdf;
    flights->light_pdf[i] = pdf;
    flights->pdf[i] = delta ? 0.0f : own;
  }
}

/* Takes light samples at n vertices on surfaces, and adds the radiance of those that arrive.
 * light, values, q, flights: memory for what is between. */
static void surface_light(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                          const vlVertices *at, const vlVolumeRows *rows, vlLightSamples *light,
                          vlBsdfValues *values, vlShadowRays *q, vlShadowFlights *flights) {
  const vlPaths *p = &at->paths;
  const vlSurface *f = &at->surface;
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, f, dimension, light);
  vl_stage_light_bsdf(t, n, at, light, values);
  uint32_t count = 0, lit[VL_ROW_SIZE];
  make_shadows(n, at, light, values, q, flights, lit);
  for (uint32_t i = 0; i < n; i++) {
    if (!lit[i])
      continue;
    /* Light samples through a subsurface material are taken at the exit (subsurface.hot.c). */
    bool into = t->world->has_subsurface &&
                t->world->materials.items[at->hits.material[i]].subsurface &&
                (values->wi[2][i] < 0.0f) != (at->shade.wo[2][i] < 0.0f);
    if (into)
      continue;
    vlVec3 g = vl_row3(&f->g, i);
    vlVec3 w = vl_row3(&light->w, i);
    const vlWorldShape *shape = &t->world->shapes.items[at->hits.shape[i]];
    uint32_t k = count++;
    if (k != i)
      vl_shadow_move(q, i, k);
    flights->light_pdf[k] = flights->light_pdf[i];
    flights->pdf[k] = flights->pdf[i];
    for (int c = 0; c < 4; c++)
      flights->density[c][k] = rows->u[c][i];
    flights->medium[k] = vl_medium_beyond(shape, g, w, rows->medium[i]);
    flights->from[k] = i;
    q->time[k] = vl_path_time(p, i);
    q->lane[k] = p->lane[i];
    vl_shadow_from_surface(t, at, i, values->wi[2][i], k, flights);
  }
  vl_volume_shadows(t, p, light, count, depth, q, flights);
}

void vl_volume_go_on(const vlTracing *t, uint32_t count, const vlVertices *at,
                     const vlVolumeRows *at_rows, const uint32_t *order, const vlPaths *rays,
                     vlVolumeRows *rows) {
  const vlSurface *f = &at->surface;
  vl_volume_permute(at_rows, rows, order, count);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = order[k];
    float pdf = rays->pdf[k], inv = pdf > 0.0f ? 1.0f / pdf : 0.0f;
    for (int c = 0; c < 4; c++)
      rows->l[c][k] = rows->u[c][k] * inv;
    rows->medium[k] =
        vl_medium_beyond(&t->world->shapes.items[at->hits.shape[i]], vl_row3(&f->g, i),
                         vl_row3(&rays->d, k), rows->medium[k]);
  }
}

static uint32_t scatter_on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  uint32_t dimension = vl_bounce_dimension(depth);
  if (t->def->fit)
    vl_fit_surfaces(t, n, &s->at, &v->at);
  vl_stage_regularize(t, n, &s->at);
  vl_volume_normalise_all(t, &s->at.paths, &v->at, n);
  if (t->batch->recorder)
    vl_record_shaded(t, n, &s->at);
  surface_light(t, n, depth, dimension, &s->at, &v->at, &s->light, &s->values, &s->shadow,
                &v->shadow);
  uint32_t count =
      vl_stage_scatter(t, n, depth + 1, dimension, &s->at, &s->samples, s->order, &s->rays);
  vl_volume_go_on(t, count, &s->at, &v->at, s->order, &s->rays, &v->rays);
  return t->world->has_subsurface ? vl_stage_subsurface(t, count, depth) : count;
}

/* ---- the tracer -------------------------------------------------------------------------- */

uint32_t vl_volume_append(const vlMediumVertices *in, const uint32_t *kept, uint32_t count,
                          uint32_t n, vlPaths *rays, vlVolumeRows *rows) {
  for (uint32_t k = 0; k < count; k++, n++) {
    vl_path_copy(&in->paths, kept[k], rays, n);
    vl_volume_copy(&in->rows, kept[k], rows, n);
  }
  return n;
}

void vl_volume_start(const vlTracing *t, uint32_t n, const uint32_t *medium, vlPaths *rays,
                     vlVolumeRows *rows) {
  for (uint32_t i = 0; i < n; i++) {
    for (int c = 0; c < 4; c++)
      rows->u[c][i] = rows->l[c][i] = 1.0f;
    rows->medium[i] = medium ? medium[rays->lane[i]] : t->world->camera_medium;
    if (vl_volume_rgb(t))
      rays->beta[3][i] = 0.0f;
  }
}

static bool arrive(vlTracing *t, uint32_t n, uint32_t depth) {
  const vlTraceScratch *s = t->s;
  const vlVolumeScratch *v = s->volume;
  vl_stage_lights_hit(t, n, &s->rays, &s->hits, &v->rays, &v->ends, add_light);
  if (t->batch->recorder)
    vl_volume_record_travel(t, n, depth, &s->rays, &v->rays, &s->hits, &v->ends);
  return true;
}

void vl_volume_tracer(vlTracing *t) {
  static const vlBounceSteps steps = {arrive, scatter_in_media, scatter_on_surfaces, add_light,
                                      add_light};
  vl_volume_start(t, t->batch->n, NULL, &t->s->rays, &t->s->volume->rays);
  vl_trace_bounces(t, t->batch->n, t->def->max_depth, &steps);
}
