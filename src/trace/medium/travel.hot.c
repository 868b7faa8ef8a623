/* trace/medium/travel.hot.c: rays on their way through media and interfaces: what camera rays,
 * bounces and shadow rays have in common, then camera rays and bounces. Shadow rays are in
 * volume_shadow.hot.c. */
#include "trace/medium/volume.h"

void vl_travel_start(vlTravel *k) {
  __builtin_memset(k, 0, sizeof *k);
  for (uint32_t i = 0; i < VL_FLIGHTS; i++)
    k->f.medium[i] = VL_NONE;
}

void vl_travel_closest(const vlTracing *t, vlTravel *k) {
  const vlRays *r = &k->f.rays;
  VL_ROW float o[3][VL_FLIGHTS], d[3][VL_FLIGHTS], t_min[VL_FLIGHTS], t_max[VL_FLIGHTS],
      time[VL_FLIGHTS];
  VL_ROW uint32_t shape[VL_FLIGHTS], prim[VL_FLIGHTS], instance[VL_FLIGHTS];
  VL_ROW float hit[VL_FLIGHTS];
  if (k->count == 0)
    return;
  for (uint32_t j = 0; j < k->count; j++) {
    uint32_t i = k->open[j];
    o[0][j] = r->ox[i];
    o[1][j] = r->oy[i];
    o[2][j] = r->oz[i];
    d[0][j] = r->dx[i];
    d[1][j] = r->dy[i];
    d[2][j] = r->dz[i];
    t_min[j] = k->f.from[i];
    if (r->t_max)
      t_max[j] = r->t_max[i];
    if (r->time)
      time[j] = r->time[i];
  }
  vlRays rays = {
      o[0], o[1], o[2], d[0], d[1], d[2], t_min, r->t_max ? t_max : NULL, r->time ? time : NULL,
      NULL};
  vl_accel_closest(t->world, k->count, &rays, false, shape, prim, instance, hit);
  if (k->camera && t->world->has_hidden)
    vl_pass_hidden(t, k->count, &rays, shape, prim, instance, hit);
  for (uint32_t j = 0; j < k->count; j++) {
    uint32_t i = k->open[j];
    k->x.shape[i] = shape[j];
    k->x.prim[i] = prim[j];
    k->x.instance[i] = instance[j];
    k->x.hit[i] = hit[j];
  }
}

uint32_t vl_travel_pass(const vlTracing *t, vlTravel *k, uint32_t i, uint32_t medium) {
  const vlRays *r = &k->f.rays;
  const vlCrossings *x = &k->x;
  vlVec3 d = vl_ray_direction(r, i), g = vl_lane3(x->gx, x->gy, x->gz, i);
  if (t->def->fit)
    vl_fit_border(t, k->f.paths->lane[k->f.path[i]], x->shape[i], g, d, medium);
  k->f.from[i] = vl_past_crossing(x->t[i], g, x->offset[i], d, k->f.from[i]);
  return vl_medium_beyond(&t->world->shapes.items[x->shape[i]], g, d, medium);
}

/* ---- camera rays and bounces */

/* The rays of a bounce on their way: arguments of vl_volume_travel. */
typedef struct Rays {
  vlPaths *paths;
  vlVolumeRows *rows;
  vlHits *hits;
  vlFlightEnds *ends;
  vlAddLight *pass_light; /* may be null */
} Rays;

/* Stores how ray i ended. given: radiance that media added. */
static void end_ray(vlTracing *t, const Rays *r, uint32_t i, uint32_t event, float odds,
                    const float given[4]) {
  uint32_t lane = r->paths->lane[i];
  r->ends->event[i] = (uint8_t)event;
  r->ends->odds[lane] = vl_some_odds(odds);
  for (int c = 0; c < 4; c++)
    t->batch->radiance[c][lane] += given[c];
  for (int c = 0; t->batch->recorder && c < 4; c++)
    r->ends->given[c][i] = given[c];
  if (event == VL_ON_SURFACE)
    r->hits->material[i] = vl_hit_material(t->world, r->paths, r->hits, i);
  else
    r->hits->shape[i] = VL_NONE;
}

/* Ends the lanes of a block that travel through vacuum to no interface: nothing changes their
 * paths. The others are open. t_min: null: 0. */
static void open_lanes(vlTracing *t, const Rays *r, vlTravel *k, uint32_t first,
                       const float *t_min) {
  const float none[4] = {0, 0, 0, 0};
  k->count = 0;
  for (uint32_t i = 0; i < k->f.n; i++) {
    if (t->def->fit && k->x.shape[i] == VL_NONE)
      vl_fit_endless(t, r->rows->medium[first + i]);
    bool through =
        r->rows->medium[first + i] != VL_NONE || vl_meets_interface(t->world, &k->x, i);
    if (through)
      k->open[k->count++] = i;
    else
      end_ray(t, r, first + i, k->x.shape[i] == VL_NONE ? VL_IN_SKY : VL_ON_SURFACE, 1.0f,
              none);
    k->f.from[i] = t_min ? t_min[first + i] : 0.0f;
  }
}

/* The block of rays from lane `first` on. */
static void begin_block(const Rays *r, vlTravel *k, uint32_t first, uint32_t n,
                        const float *t_max, float *time) {
  vlPaths *p = r->paths;
  vlHits *h = r->hits;
  vlVolumeRows *v = r->rows;
  vlFlights *f = &k->f;
  f->n = n;
  f->rays = vl_rays_of(&p->o, &p->d, first, NULL, t_max ? t_max + first : NULL,
                       p->time ? time : NULL);
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

/* Sets the state of the open lanes' flights. u: the first random numbers, by ray. */
static void begin_flights(const vlTracing *t, const vlPaths *p, const float *u, vlTravel *k,
                          uint32_t first) {
  vlFlights *f = &k->f;
  for (uint32_t i = 0; i < f->n; i++) {
    f->path[i] = first + i;
    f->first[i] = u[first + i];
    f->count[i] = 0;
    f->odds[i] = 1.0f;
    for (int c = 0; c < 4; c++)
      f->given[c][i] = 0.0f;
  }
  for (int c = 0; t->world->by_channel && c < 3; c++)
    for (uint32_t i = 0; i < f->n; i++)
      f->passed[c][i] = t->passed[c][p->lane[first + i]];
}

void vl_travel_aim(const vlTracing *t, vlTravel *k, const uint32_t *medium) {
  vlFlights *f = &k->f;
  uint32_t lanes[VL_FLIGHTS], count = 0;
  for (uint32_t j = 0; j < k->count; j++) {
    uint32_t i = k->open[j];
    if (k->x.shape[i] != VL_NONE &&
        (medium[i] != VL_NONE || vl_is_interface(t->world, k->x.shape[i])))
      lanes[count++] = i;
    f->medium[i] = k->clear ? VL_NONE : medium[i];
    f->to[i] = f->rays.t_max ? f->rays.t_max[i] : VL_INFINITY;
  }
  if (count)
    vl_stage_crossings(t->world, f->n, &f->rays, lanes, count, &k->x);
  for (uint32_t j = 0; j < count; j++)
    f->to[lanes[j]] = k->x.t[lanes[j]];
}

/* Ends lane i of a block and stores what its flights have changed besides the rows of the
 * paths. */
static void end_flight(vlTracing *t, const Rays *r, const vlTravel *k, uint32_t first,
                       uint32_t i, uint32_t event) {
  const vlFlights *f = &k->f;
  const float given[4] = {f->given[0][i], f->given[1][i], f->given[2][i], f->given[3][i]};
  for (int c = 0; t->world->by_channel && c < 3; c++)
    t->passed[c][r->paths->lane[first + i]] = f->passed[c][i];
  r->ends->t[first + i] = f->t[i];
  end_ray(t, r, first + i, event, f->odds[i], given);
}

/* Adds the light of the interface that ray i has met, where it emits. odds: of getting there.
 */
static void meet_light(vlTracing *t, const Rays *r, uint32_t i, float odds) {
  vlHitLight met;
  if (!r->pass_light || t->world->shapes.items[r->hits->shape[i]].first_light == VL_NONE ||
      !vl_hit_emission(t->world, r->paths, r->hits, i, &met))
    return;
  r->ends->odds[r->paths->lane[i]] = vl_some_odds(odds);
  r->pass_light(t, r->paths, r->rows, r->ends, i, &met, false);
}

/* Traces the lanes of a block through media and interfaces to their events. Their origins
 * remain those of their last scattering, which the densities of light sampling need. */
static void travel_block(vlTracing *t, const Rays *r, vlTravel *k, uint32_t first,
                         bool emission) {
  uint32_t *medium = r->rows->medium + first;
  /* a bound; no ray crosses so many interfaces */
  for (int step = 0; step < 1024 && k->count > 0; step++) {
    uint32_t on = 0;
    vl_travel_aim(t, k, medium);
    vl_fly(t, &k->f, emission);
    for (uint32_t j = 0; j < k->count; j++) {
      uint32_t i = k->open[j];
      if (k->f.end[i] != VL_FLIGHT_PASSED) {
        end_flight(t, r, k, first, i,
                   k->f.end[i] == VL_FLIGHT_SCATTERED ? VL_IN_MEDIUM : VL_AT_END);
      } else if (!vl_meets_interface(t->world, &k->x, i)) {
        end_flight(t, r, k, first, i, k->x.shape[i] != VL_NONE ? VL_ON_SURFACE : VL_IN_SKY);
      } else {
        meet_light(t, r, first + i, k->f.odds[i]);
        medium[i] = vl_travel_pass(t, k, i, medium[i]);
        k->open[on++] = i;
      }
    }
    k->count = on;
    vl_travel_closest(t, k);
    t->batch->bounce_rays += on;
  }
  for (uint32_t j = 0; j < k->count; j++)
    end_flight(t, r, k, first, k->open[j], VL_AT_END);
}

void vl_volume_travel(vlTracing *t, uint32_t n, uint32_t depth, bool emission,
                      vlAddLight *pass_light, vlPaths *p, vlVolumeRows *rows, vlHits *hits,
                      vlFlightEnds *ends) {
  const Rays r = {p, rows, hits, ends, pass_light};
  bool camera = depth == 0 && !t->light;
  const float *t_min = camera ? t->batch->rays.t_min : NULL,
              *t_max = camera ? t->batch->rays.t_max : NULL;
  vlFloatRow u;
  vl_closest_hits(t, n, camera, p, hits);
  if (!camera)
    t->batch->bounce_rays += n;
  vl_draw_1d(t, n, p, vl_bounce_dimension(depth) + VL_DIM_FLIGHT, u);
  VL_ROW float odds[VL_FLIGHTS], time[VL_FLIGHTS] = {0};
  vlTravel k;
  vl_travel_start(&k);
  k.f.paths = p;
  k.f.depth = depth;
  k.f.purpose = VL_KEY_FLIGHT;
  k.f.odds = odds;
  k.clear = camera && t->def->irradiance;
  k.camera = camera;
  for (uint32_t first = 0; first < n; first += VL_FLIGHTS) {
    begin_block(&r, &k, first, n - first < VL_FLIGHTS ? n - first : VL_FLIGHTS, t_max, time);
    open_lanes(t, &r, &k, first, t_min);
    if (k.count == 0)
      continue;
    begin_flights(t, p, u, &k, first);
    travel_block(t, &r, &k, first, emission);
  }
  for (uint32_t i = 0; camera && i < n; i++)
    t->batch->alpha[i] =
        ends->event[i] == VL_IN_SKY || (ends->event[i] == VL_ON_SURFACE &&
                                        t->world->shapes.items[hits->shape[i]].backdrop)
            ? 0.0f
            : 1.0f;
}
