/* trace/medium/volume.hot.c: path tracing through participating media. Surfaces use the path
 * tracer's stages; between them are flights (medium.hot.c) that scatter in media or cross
 * interfaces (pbrt book 14.2.3). All lanes of a batch are at the same depth, in a medium or on
 * a surface:
 *
 *   rays -> travel -> emission -> those that scatter in media: light samples, phase function ->
 * volume.scattered
 *                              -> those on surfaces: as in path.hot.c -> rays
 *   rays <- both
 *
 * The weight is beta over the mean of the rescaled densities: u, of the path as it was sampled,
 * and l, of the path if light sampling had sampled its last segment. */
#include "trace/medium/volume.h"
#include "trace/medium/phase.h"
#include "trace/tracer/record.h"

/* ---- weights and densities
 * --------------------------------------------------------------------------------------- */

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
    float u0 = v->u[0][i], u1 = alone ? u0 : v->u[1][i], u2 = alone ? u0 : v->u[2][i],
          u3 = alone ? u0 : v->u[3][i];
    float inv = 1.0f / vl_flight_mean_of(u0, u1, u2, u3, 4);
    v->u[0][i] = u0 * inv;
    v->u[1][i] = u1 * inv;
    v->u[2][i] = u2 * inv;
    v->u[3][i] = u3 * inv;
    p->beta[0][i] *= inv;
    p->beta[1][i] *= inv;
    p->beta[2][i] *= inv;
    p->beta[3][i] *= inv;
  }
}

/* ---- travel
 * ------------------------------------------------------------------------------------------------------
 */

/* Stores how the ray of lane i ended. given: radiance that media added. */
static void end_lane(vlTracing *t, uint32_t i, uint32_t event, float odds,
                     const float given[4]) {
  vlHits *h = &t->s->hits;
  vlVolumeScratch *v = t->s->volume;
  uint32_t lane = t->s->rays.lane[i];
  v->event[i] = (uint8_t)event;
  v->odds[lane] = vl_some_odds(odds);
  for (int c = 0; c < 4; c++)
    t->batch->radiance[c][lane] += given[c];
  for (int c = 0; t->batch->recorder && c < 4; c++)
    v->given[c][i] = given[c];
  if (event == VL_ON_SURFACE)
    h->material[i] = vl_hit_material(t->world, &t->s->rays, h, i);
  else
    h->shape[i] = VL_NONE;
}

/* Ends the lanes of a block that travel through vacuum to no interface: nothing changes their
 * paths. The others are open. t_min: null: 0. */
static void open_lanes(vlTracing *t, vlTravel *k, uint32_t first, const float *t_min) {
  const float none[4] = {0, 0, 0, 0};
  k->count = 0;
  for (uint32_t i = 0; i < k->f.n; i++) {
    bool through =
        t->s->volume->a.medium[first + i] != VL_NONE || vl_meets_interface(t->world, &k->x, i);
    if (through)
      k->open[k->count++] = i;
    else
      end_lane(t, first + i, k->x.shape[i] == VL_NONE ? VL_IN_SKY : VL_ON_SURFACE, 1.0f, none);
    k->f.from[i] = t_min ? t_min[first + i] : 0.0f;
  }
}

/* The block of rays from lane `first` on. */
static void begin_block(vlTracing *t, vlTravel *k, uint32_t first, uint32_t n,
                        const float *t_max, float *time) {
  vlTraceScratch *s = t->s;
  vlPaths *p = &s->rays;
  vlHits *h = &s->hits;
  vlVolumeRows *v = &s->volume->a;
  vlFlights *f = &k->f;
  f->n = n;
  f->rays =
      (vlRays){p->ox + first,        p->oy + first, p->oz + first, p->dx + first,
               p->dy + first,        p->dz + first, NULL,          t_max ? t_max + first : NULL,
               p->time ? time : NULL};
  for (uint32_t i = 0; p->time && i < n; i++)
    time[i] = vl_path_time(p, first + i);
  for (int c = 0; c < 4; c++) {
    f->beta[c] = p->beta[c] + first;
    f->lambda[c] = p->lambda[c] + first;
    f->u[c] = v->u[c] + first;
    f->l[c] = v->l[c] + first;
  }
  k->x.shape = h->shape + first;
  k->x.prim = h->prim + first;
  k->x.instance = h->instance + first;
  k->x.hit = h->t + first;
}

/* Sets the state of the open lanes' flights. */
static void begin_flights(const vlTracing *t, vlTravel *k, uint32_t first) {
  const vlTraceScratch *s = t->s;
  vlFlights *f = &k->f;
  for (uint32_t i = 0; i < f->n; i++) {
    f->path[i] = first + i;
    f->first[i] = s->numbers.u0[first + i];
    f->count[i] = 0;
    f->odds[i] = 1.0f;
    for (int c = 0; c < 4; c++)
      f->given[c][i] = 0.0f;
  }
  for (int c = 0; t->world->by_channel && c < 3; c++)
    for (uint32_t i = 0; i < f->n; i++)
      f->passed[c][i] = s->passed[c][s->rays.lane[first + i]];
}

/* The next flights of the open lanes: each leads to the surface ahead or to the end of the ray.
 */
static void aim_flights(const vlTracing *t, vlTravel *k, const uint32_t *medium) {
  vlFlights *f = &k->f;
  uint32_t lanes[VL_FLIGHTS], count = 0;
  for (uint32_t j = 0; j < k->count; j++) {
    uint32_t i = k->open[j];
    if (k->x.shape[i] != VL_NONE &&
        (medium[i] != VL_NONE || vl_is_interface(t->world, k->x.shape[i])))
      lanes[count++] = i;
    f->medium[i] = medium[i];
    f->to[i] = f->rays.t_max ? f->rays.t_max[i] : VL_INFINITY;
  }
  if (count)
    vl_stage_crossings(t->world, f->n, &f->rays, lanes, count, &k->x);
  for (uint32_t j = 0; j < count; j++)
    f->to[lanes[j]] = k->x.t[lanes[j]];
}

/* Ends lane i of a block and stores what its flights have changed besides the rows of the
 * paths. */
static void end_flight(vlTracing *t, const vlTravel *k, uint32_t first, uint32_t i,
                       uint32_t event) {
  const vlFlights *f = &k->f;
  const float given[4] = {f->given[0][i], f->given[1][i], f->given[2][i], f->given[3][i]};
  for (int c = 0; t->world->by_channel && c < 3; c++)
    t->s->passed[c][t->s->rays.lane[first + i]] = f->passed[c][i];
  t->s->volume->t[first + i] = f->t[i];
  end_lane(t, first + i, event, f->odds[i], given);
}

/* Traces the lanes of a block through media and interfaces to their events. Their origins
 * remain those of their last scattering, which the densities of light sampling need. */
static void travel_block(vlTracing *t, vlTravel *k, uint32_t first, bool emission) {
  uint32_t *medium = t->s->volume->a.medium + first;
  begin_flights(t, k, first);
  for (int step = 0; step < 1024 && k->count > 0;
       step++) { /* a bound; no ray crosses so many interfaces */
    uint32_t on = 0;
    aim_flights(t, k, medium);
    vl_fly(t, &k->f, emission);
    for (uint32_t j = 0; j < k->count; j++) {
      uint32_t i = k->open[j];
      if (k->f.end[i] != VL_FLIGHT_PASSED) {
        end_flight(t, k, first, i,
                   k->f.end[i] == VL_FLIGHT_SCATTERED ? VL_IN_MEDIUM : VL_AT_END);
      } else if (!vl_meets_interface(t->world, &k->x, i)) {
        end_flight(t, k, first, i, k->x.shape[i] != VL_NONE ? VL_ON_SURFACE : VL_IN_SKY);
      } else {
        medium[i] = vl_travel_pass(t, k, i, medium[i]);
        k->open[on++] = i;
      }
    }
    k->count = on;
    vl_travel_closest(t, k);
    t->batch->bounce_rays += on;
  }
  for (uint32_t j = 0; j < k->count; j++)
    end_flight(t, k, first, k->open[j], VL_AT_END);
}

void vl_volume_travel(vlTracing *t, uint32_t n, uint32_t depth, bool emission) {
  vlTraceScratch *s = t->s;
  vlPaths *p = &s->rays;
  bool camera = depth == 0 && !t->light;
  const float *t_min = camera ? t->batch->t_min : NULL,
              *t_max = camera ? t->batch->t_max : NULL;
  vl_closest_hits(t, n, camera, p, &s->hits);
  if (!camera)
    t->batch->bounce_rays += n;
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index,
                     VL_DIM_BOUNCE + depth * VL_DIM_STRIDE + VL_DIM_FLIGHT, s->numbers.u0);
  VL_ROW float odds[VL_FLIGHTS], time[VL_FLIGHTS] = {0};
  vlTravel k;
  vl_travel_start(&k);
  k.f.paths = p;
  k.f.depth = depth;
  k.f.purpose = VL_KEY_FLIGHT;
  k.f.odds = odds;
  for (uint32_t first = 0; first < n; first += VL_FLIGHTS) {
    begin_block(t, &k, first, n - first < VL_FLIGHTS ? n - first : VL_FLIGHTS, t_max, time);
    open_lanes(t, &k, first, t_min);
    if (k.count)
      travel_block(t, &k, first, emission);
  }
  for (uint32_t i = 0; camera && i < n; i++)
    t->batch->alpha[i] = s->volume->event[i] == VL_IN_SKY ? 0.0f : 1.0f;
}

/* ---- lights that rays hit
 * ---------------------------------------------------------------------------------------- */

static void add_light(vlTracing *t, const vlPaths *p, uint32_t i, const vlHitLight *met,
                      bool sky) {
  (void)sky;
  float inv = vl_volume_inverse_density(t, i, met->pdf);
  for (int c = 0; c < 4; c++)
    t->batch->radiance[c][p->lane[i]] += p->beta[c][i] * met->radiance[c] * inv;
}

/* ---- scattering in media
 * ----------------------------------------------------------------------------------------- */

static void phase_light(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  const vlPaths *p = &v->scattered;
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, &s->at.surface, dimension, &s->light);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!(s->light.pdf[i] > 0.0f))
      continue;
    vlVec3 d = vl_lane3(p->dx, p->dy, p->dz, i),
           w = vl_lane3(s->light.wx, s->light.wy, s->light.wz, i);
    float phase = vl_phase(t->world->media.items[v->c.medium[i]].g, vl_dot(d, w));
    const float value[4] = {phase, phase, phase, phase};
    count = vl_volume_push_shadow(t, p, &v->c, i, vl_lane3(p->ox, p->oy, p->oz, i), value,
                                  phase, v->c.medium[i], count);
  }
  vl_volume_shadows(t, p, count, depth);
}

uint32_t vl_volume_phase_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlPaths *p = &v->scattered;
  vlNumbers *u = &s->numbers;
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_ROULETTE,
                     u->u0);
  t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_BSDF_UV,
                     u->u1, u->u2);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    float most =
        vl_max(vl_max(p->beta[0][i], p->beta[1][i]), vl_max(p->beta[2][i], p->beta[3][i]));
    float sum = p->beta[0][i] + p->beta[1][i] + p->beta[2][i] + p->beta[3][i];
    if (sum != sum)
      t->batch->radiance[0][p->lane[i]] = __builtin_nanf(""); /* the film drops and counts it */
    float survive = vl_roulette_survival(most * p->eta_scale[i], depth);
    if (!(most > 0.0f) || !(u->u0[i] < survive))
      continue;
    vlVec3 d = vl_lane3(p->dx, p->dy, p->dz, i);
    float g = t->world->media.items[v->c.medium[i]].g;
    vlVec3 w = vl_phase_sample(g, d, u->u1[i], u->u2[i]);
    float pdf = vl_phase(g, vl_dot(d, w));
    for (int c = 0; c < 4; c++) {
      p->beta[c][i] /= survive;
      v->c.l[c][i] = v->c.u[c][i] / pdf;
    }
    vl_set_lane3(p->dx, p->dy, p->dz, i, w);
    p->pdf[i] = pdf;
    p->specular[i] = 0;
    vl_note_scattered(t, p->lane[i]);
    v->kept[count++] = i;
  }
  return count;
}

uint32_t vl_volume_gather(vlTracing *t, uint32_t n) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vlPaths *p = &v->scattered;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++)
    if (v->event[i] == VL_IN_MEDIUM)
      s->order[count++] = i;
  if (count == 0)
    return 0;
  vl_permute_paths(&s->rays, p, s->order, count);
  vl_volume_permute(&v->a, &v->c, s->order, count);
  vl_volume_normalise_all(t, p, &v->c, count);
  for (uint32_t i = 0; i < count; i++) {
    float distance = v->t[s->order[i]];
    p->ox[i] += distance * p->dx[i];
    p->oy[i] += distance * p->dy[i];
    p->oz[i] += distance * p->dz[i];
    p->cone[i] = vl_abs(p->cone[i] + p->spread[i] * distance);
    p->spread[i] = t->def->pixel_spread;
    p->from_nx[i] = p->from_ny[i] = p->from_nz[i] = p->from_side[i] = 0.0f;
    s->at.surface.px[i] = p->ox[i];
    s->at.surface.py[i] = p->oy[i];
    s->at.surface.pz[i] = p->oz[i];
    s->at.surface.nx[i] = s->at.surface.ny[i] = s->at.surface.nz[i] =
        0.0f; /* no normal: all directions count equally */
    s->at.surface.no_cosine[i] = 1.0f;
    s->at.surface.side[i] = 0.0f;
  }
  return count;
}

/* Scatters the rays in media and writes the new rays to volume.scattered. Returns the number of
 * paths that go on; volume.kept lists them. */
static uint32_t scatter_in_media(vlTracing *t, uint32_t n, uint32_t depth) {
  uint32_t dimension = vl_bounce_dimension(depth), count = vl_volume_gather(t, n);
  if (count == 0)
    return 0;
  if (t->batch->recorder)
    vl_record_scattering(t, &t->s->volume->scattered, count);
  phase_light(t, count, depth, dimension);
  uint32_t on = vl_volume_phase_scatter(t, count, depth + 1, dimension);
  if (t->batch->recorder)
    vl_record_phase(t, &t->s->volume->scattered, count, on, depth + 1);
  return on;
}

/* ---- scattering on surfaces
 * -------------------------------------------------------------------------------------- */

/* Makes the shadow rays of all n light samples, each at the place of its lane, as
 * vl_volume_push_shadow does. lit: 1 for those that contribute. */
static void make_shadows(uint32_t n, const vlVertices *at, const vlLightSamples *l,
                         const vlBsdfValues *bsdf, vlShadowRays *q, vlVolumeScratch *v,
                         uint32_t lit[VL_ROW_SIZE]) {
  const vlPaths *p = &at->paths;
  const vlSurface *f = &at->surface;
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < padded; i++) {
    float v0 = bsdf->value[0][i], v1 = bsdf->value[1][i], v2 = bsdf->value[2][i],
          v3 = bsdf->value[3][i];
    float sum = v0 + v1 + v2 + v3, pdf = l->pdf[i];
    vlVec3 w = vl_vec3(l->wx[i], l->wy[i], l->wz[i]);
    vlVec3 o = vl_offset_origin(vl_vec3(f->px[i], f->py[i], f->pz[i]),
                                vl_vec3(f->gx[i], f->gy[i], f->gz[i]), f->offset[i], w);
    vlVec3 to = vl_sub(vl_vec3(l->tx[i], l->ty[i], l->tz[i]), o), d = vl_normalize(to);
    int distant = l->distant[i], delta = l->delta[i];
    float length = distant ? VL_INFINITY : vl_length(to), own = bsdf->pdf[i];
    lit[i] = (pdf > 0.0f) & ((sum > 0.0f) | (sum != sum)) ? 1 : 0;
    vl_set_lane3(q->ox, q->oy, q->oz, i, o);
    q->dx[i] = distant ? w.x : d.x;
    q->dy[i] = distant ? w.y : d.y;
    q->dz[i] = distant ? w.z : d.z;
    q->t_max[i] = length * VL_SHADOW_END;
    q->radiance[0][i] = p->beta[0][i] * v0 * l->radiance[0][i] * pdf;
    q->radiance[1][i] = p->beta[1][i] * v1 * l->radiance[1][i] * pdf;
    q->radiance[2][i] = p->beta[2][i] * v2 * l->radiance[2][i] * pdf;
    q->radiance[3][i] = p->beta[3][i] * v3 * l->radiance[3][i] * pdf;
    v->light_pdf[i] = pdf;
    v->pdf[i] = delta ? 0.0f : own;
  }
}

static void surface_light(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  const vlVertices *at = &s->at;
  const vlPaths *p = &at->paths;
  const vlLightSamples *l = &s->light;
  if (t->world->lights.count == 0)
    return;
  vl_stage_light_samples(t, n, p, &at->surface, dimension, &s->light);
  vl_stage_light_bsdf(t, n, at, l, &s->values);
  uint32_t count = 0, lit[VL_ROW_SIZE];
  make_shadows(n, at, l, &s->values, &s->shadow, v, lit);
  for (uint32_t i = 0; i < n; i++) {
    if (!lit[i])
      continue;
    /* Light samples through a subsurface material are taken at the exit (subsurface.hot.c). */
    bool into = t->world->has_subsurface &&
                t->world->materials.items[at->hits.material[i]].subsurface &&
                (s->values.wi[2][i] < 0.0f) != (at->shade.wo[2][i] < 0.0f);
    if (into)
      continue;
    vlVec3 g = vl_lane3(s->at.surface.gx, s->at.surface.gy, s->at.surface.gz, i),
           w = vl_lane3(l->wx, l->wy, l->wz, i);
    const vlWorldShape *shape = &t->world->shapes.items[s->at.hits.shape[i]];
    uint32_t k = count++;
    if (k != i)
      vl_shadow_move(&s->shadow, i, k);
    v->light_pdf[k] = v->light_pdf[i];
    v->pdf[k] = v->pdf[i];
    for (int c = 0; c < 4; c++)
      v->density[c][k] = v->b.u[c][i];
    v->shadow_medium[k] = vl_medium_beyond(shape, g, w, v->b.medium[i]);
    v->from[k] = i;
    s->shadow.time[k] = vl_path_time(p, i);
    s->shadow.lane[k] = p->lane[i];
    vl_shadow_from_surface(t, k, i, s->values.wi[2][i]);
  }
  vl_volume_shadows(t, p, count, depth);
}

void vl_volume_go_on(vlTracing *t, uint32_t count) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *v = s->volume;
  vl_volume_permute(&v->b, &v->a, s->order, count);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = s->order[k];
    float pdf = s->rays.pdf[k], inv = pdf > 0.0f ? 1.0f / pdf : 0.0f;
    for (int c = 0; c < 4; c++)
      v->a.l[c][k] = v->a.u[c][k] * inv;
    v->a.medium[k] =
        vl_medium_beyond(&t->world->shapes.items[s->at.hits.shape[i]],
                         vl_lane3(s->at.surface.gx, s->at.surface.gy, s->at.surface.gz, i),
                         vl_lane3(s->rays.dx, s->rays.dy, s->rays.dz, k), v->a.medium[k]);
  }
}

static uint32_t scatter_on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  uint32_t dimension = vl_bounce_dimension(depth);
  if (t->def->fit)
    vl_fit_surfaces(t, n);
  vl_stage_regularize(t, n, &s->at);
  vl_volume_normalise_all(t, &s->at.paths, &s->volume->b, n);
  if (t->batch->recorder)
    vl_record_shaded(t, n, &s->at);
  surface_light(t, n, depth, dimension);
  uint32_t count =
      vl_stage_scatter(t, n, depth + 1, dimension, &s->at, &s->samples, s->order, &s->rays);
  vl_volume_go_on(t, count);
  return t->world->has_subsurface ? vl_stage_subsurface(t, count, depth) : count;
}

/* ---- the tracer
 * --------------------------------------------------------------------------------------------------
 */

uint32_t vl_volume_append(vlTracing *t, uint32_t count, uint32_t n) {
  vlVolumeScratch *v = t->s->volume;
  for (uint32_t k = 0; k < count; k++, n++) {
    vl_path_copy(&v->scattered, v->kept[k], &t->s->rays, n);
    vl_volume_copy(&v->c, v->kept[k], &v->a, n);
  }
  return n;
}

void vl_volume_start(vlTracing *t, uint32_t n, const uint32_t *medium) {
  vlPaths *p = &t->s->rays;
  vlVolumeRows *rows = &t->s->volume->a;
  for (uint32_t i = 0; i < n; i++) {
    for (int c = 0; c < 4; c++)
      rows->u[c][i] = rows->l[c][i] = 1.0f;
    rows->medium[i] = medium ? medium[p->lane[i]] : t->world->camera_medium;
    if (vl_volume_rgb(t))
      p->beta[3][i] = 0.0f;
  }
}

static bool arrive(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vl_stage_lights_hit(t, n, &s->rays, &s->hits, s->volume->event, add_light);
  if (t->batch->recorder)
    vl_volume_record_travel(t, n, depth);
  return true;
}

void vl_volume_tracer(vlTracing *t) {
  static const vlBounceSteps steps = {arrive, scatter_in_media, scatter_on_surfaces};
  vl_volume_start(t, t->batch->n, NULL);
  vl_trace_bounces(t, t->batch->n, t->def->max_depth, &steps);
}
