/* trace/two_way/connect.hot.c: connections of inner vertices: a vertex of the camera path to
 * one of a light path in a medium or on a diffuse surface (Veach 1997, chapter 10; two_way.h
 * has the weights; connect_media.hot.c has what only worlds with media need).
 *
 * Each vertex of a camera path looks at a few vertices of the pass's light paths, evenly
 * distributed over them, and keeps one with a probability in proportion to what it would
 * contribute if it were visible (resampled importance sampling: Talbot et al. 2005; Nabata et
 * al. 2020 for bidirectional tracers). Only that one costs a shadow ray. The estimate is
 * unbiased for any such probability above 0. On diffuse surfaces it is exact up to
 * visibility. */
#include "math/hash.h"
#include "trace/two_way/stages.h"

enum { CANDIDATES = VL_CANDIDATES };

void vl_stage_groups(const vlTracing *t, uint32_t n, float *u) {
  const vlTwoWay *way = t->def->two_way;
  uint32_t *group = t->lanes->group;
  for (uint32_t i = 0; i < n; i++) {
    group[i] = (uint32_t)(u[i] * (float)way->inner.groups);
    u[i] = vl_group_wavelength(way, group[i]);
  }
}

static vlEnd end_on_surface(const vlTracing *t, uint32_t i, uint32_t depth,
                            const vlTwoWayVertices *x) {
  const vlVertices *at = x->at;
  const vlSurface *f = &at->surface;
  const vlWays *r = x->ways;
  float z = at->shade.wo[2][i];
  vlEnd e = {.p = vl_row3(&f->p, i),
             .g = vl_row3(&f->g, i),
             .n = vl_mul(vl_row3(&f->n, i), z < 0.0f ? -1.0f : 1.0f),
             .ways = r->a[i] * vl_abs(z) * VL_INV_PI + r->b[i] + t->def->two_way->merged,
             .diffuse = vl_is_inner_end(t->world, at, i),
             .room = t->def->max_depth - depth - 1,
             .air = x->rows ? vl_air(t->world, x->rows->medium[i]) : 0};
  for (int c = 0; c < 4; c++)
    e.tint[c] = at->paths.beta[c][i] * (e.diffuse ? at->shade.reflectance[c][i] : 1.0f);
  return e;
}

static vlEnd end_in_medium(const vlTracing *t, uint32_t i, uint32_t depth,
                           const vlTwoWayVertices *x) {
  const vlPaths *p = x->paths;
  const vlWays *r = x->ways;
  uint32_t medium = x->rows->medium[i];
  vlEnd e = {.p = vl_row3(&p->o, i),
             .n = vl_row3(&p->d, i),
             .tint = {p->beta[0][i], p->beta[1][i], p->beta[2][i], p->beta[3][i]},
             .ways = r->b[i] + t->def->two_way->merged_volume,
             .room = t->def->max_depth - depth - 1,
             .inside = true,
             .a = r->a[i],
             .dense = r->cosine[i],
             .asymmetry = t->world->media.items[medium].g,
             .air = vl_air(t->world, medium)};
  return e;
}

/* Draws candidates for a lane, one from each of CANDIDATES equal parts of its group's vertices,
 * and prefetches them. False: there are none. */
static bool draw(const vlTracing *t, uint32_t lane, uint32_t seed, uint32_t at[CANDIDATES]) {
  const vlLightVertices *inner = &t->def->two_way->inner;
  uint32_t group = t->lanes->group[lane], first = inner->start[group];
  uint32_t count = inner->start[group + 1] - first;
  if (count == 0)
    return false;
  for (uint32_t k = 0; k < CANDIDATES; k++) {
    float u = ((float)k + vl_unit_float(vl_hash(seed + 1 + k))) * (1.0f / CANDIDATES);
    uint32_t index = (uint32_t)(u * (float)count);
    at[k] = first + (index < count ? index : count - 1);
    __builtin_prefetch(&inner->vertices[at[k]]); /* must prefetch */
  }
  return true;
}

/* What the connections to the candidates would contribute if they were visible, up to a common
 * factor. */
static void worths_of(const vlTwoWay *way, const vlEnd *e, const uint32_t at[CANDIDATES],
                      float worth[CANDIDATES]) {
  _Alignas(64) float p[3][CANDIDATES], g[3][CANDIDATES], n[3][CANDIDATES], power[4][CANDIDATES];
  _Alignas(64) float back[CANDIDATES], near[CANDIDATES];
  vl_gather(way, e, at, p, g, n, power, back, near);
  /* a select would keep the loop from being a vector */
  float cosines = e->diffuse ? 1.0f : 0.0f, bents = 1.0f - cosines;
  /* one vector of 8 */
  VL_SIMD
  for (uint32_t k = 0; k < CANDIDATES; k++) {
    vlVec3 to = vl_vec3(p[0][k] - e->p.x, p[1][k] - e->p.y, p[2][k] - e->p.z);
    float d2 = vl_length2(to), inv2 = 1.0f / d2, inv = __builtin_sqrtf(inv2);
    float here = vl_dot(e->n, to) * inv,
          there = -vl_dot(vl_vec3(n[0][k], n[1][k], n[2][k]), to) * inv;
    float flat_here = vl_abs(vl_dot(e->g, to)) * inv;
    float flat_there = vl_abs(vl_dot(vl_vec3(g[0][k], g[1][k], g[2][k]), to)) * inv;
    float bent = vl_max(vl_abs(here), 0.01f);
    here = cosines * here + bents * bent;
    float sum = e->tint[0] * power[0][k] + e->tint[1] * power[1][k] + e->tint[2] * power[2][k];
    sum += e->tint[3] * power[3][k];
    float others = (e->ways * there * flat_here + back[k] * here * flat_there) * VL_INV_PI;
    float w = sum * here * flat_there / (way->connect * d2 + others);
    int good = (near[k] > 0.0f) & (d2 > 0.0f) & (here > 0.0f) & (there > 0.0f) & (w > 0.0f) &
               (w < VL_INFINITY);
    worth[k] = good ? w : 0.0f;
  }
}

/* Chooses one of the candidates for an end. Returns its index, or VL_NONE. *factor: 1 / (its
 * probability * light paths). */
static uint32_t choose(const vlTracing *t, const vlEnd *e, uint32_t lane, uint32_t seed,
                       const uint32_t at[CANDIDATES], float *factor) {
  const vlTwoWay *way = t->def->two_way;
  const vlLightVertices *inner = &way->inner;
  float worth[CANDIDATES], u = vl_unit_float(vl_hash(seed)), sum = 0.0f, kept = 0.0f;
  uint32_t chosen = VL_NONE, group = t->lanes->group[lane];
  if (vl_has_media(t))
    vl_worths_in_media(t, e, at, worth);
  else
    worths_of(way, e, at, worth);
  for (uint32_t k = 0; k < CANDIDATES; k++) {
    if (!(worth[k] > 0.0f))
      continue;
    sum += worth[k];
    float share = worth[k] / sum;
    bool take = u < share;
    u = take ? u / share : (u - share) / (1.0f - share);
    if (take) {
      chosen = at[k];
      kept = worth[k];
    }
  }
  float paths = (float)(inner->paths / inner->groups),
        count = (float)(inner->start[group + 1] - inner->start[group]);
  if (chosen == VL_NONE)
    return VL_NONE;
  *factor = sum / (kept * CANDIDATES) * count / paths;
  if (!vl_has_media(t))
    return chosen;
  float survive =
      vl_connection_survival(t, lane, way->connect * sum / CANDIDATES * count / paths);
  *factor /= survive;
  return vl_unit_float(vl_hash(seed + 1 + CANDIDATES)) < survive ? chosen : VL_NONE;
}

/* Candidates are drawn some lanes ahead of their use, since most of them are not in the
 * cache. */
void vl_choose_vertices(const vlTracing *t, uint32_t n, uint32_t depth,
                        const vlTwoWayVertices *x, uint32_t *chosen, float *factor) {
  enum { AHEAD = 8 };
  uint32_t at[AHEAD][CANDIDATES], seed[AHEAD];
  bool drawn[AHEAD];
  const vlPaths *p = x->paths;
  for (uint32_t k = 0; k < n + AHEAD; k++) {
    uint32_t slot = k % AHEAD, i = k - AHEAD;
    if (k >= AHEAD && drawn[slot]) {
      vlEnd e = x->at ? end_on_surface(t, i, depth, x) : end_in_medium(t, i, depth, x);
      chosen[i] = choose(t, &e, p->lane[i], seed[slot], at[slot], &factor[i]);
    } else if (k >= AHEAD) {
      chosen[i] = VL_NONE;
    }
    if (k >= n)
      continue;
    seed[slot] =
        vl_hash3((uint32_t)p->px[k] ^ t->def->sampler->seed, (uint32_t)p->py[k], p->index[k]);
    seed[slot] = vl_hash2(seed[slot], depth);
    drawn[slot] = !(x->at && vl_all_specular(t->world, x->at, k)) &&
                  draw(t, p->lane[k], seed[slot], at[slot]);
  }
}

void vl_join_channels(const vlPaths *p, uint32_t i, const float eye[3], uint32_t light,
                      uint32_t count, const vlTwoWayShadows *q) {
  float far[3];
  vl_unpack_passed(light, far);
  for (int k = 0; q->flights && k < 3; k++)
    q->flights->passed[k][count] = far[k] * eye[k];
  for (int c = 0; c < 4; c++)
    q->rays->radiance[c][count] *= vl_joined_factor(far, eye, p->lambda[c][i]);
}

/* The same for vertex i on a surface, which may attenuate light that crosses it towards the
 * light path's vertex. */
static void join_from_surface(const vlTracing *t, const vlVertices *at, uint32_t i,
                              uint32_t vertex, float wi_z, uint32_t count,
                              const vlTwoWayShadows *q) {
  float eye[3];
  if (!t->world->by_channel)
    return;
  vl_passed_on(t, at, i, wi_z, eye);
  vl_join_channels(&at->paths, i, eye, t->def->two_way->inner.passed[vertex], count, q);
}

/* The connection of vertex i in direction w. */
static vlConnection connection(const vlTracing *t, uint32_t i, vlVec3 w, float factor,
                               const vlTwoWayVertices *x, const vlBsdfValues *there,
                               const vlBsdfValues *back) {
  const vlSurface *f = &x->at->surface;
  const vlWays *ways = x->ways;
  vlVec3 at = vl_row3(&f->p, i), g = vl_row3(&f->g, i);
  const vlWorldShape *shape = &t->world->shapes.items[x->at->hits.shape[i]];
  return (vlConnection){
      .i = i,
      .at = at,
      .o = vl_surface_origin(f, i, w),
      .w = w,
      .value = {there->value[0][i], there->value[1][i], there->value[2][i], there->value[3][i]},
      .forth = there->pdf[i],
      .ways = ways->a[i] * back->pdf[i] + ways->b[i] + t->def->two_way->merged,
      .cosine = vl_abs(vl_dot(g, w)),
      .factor = factor,
      .medium = x->rows ? vl_medium_beyond(shape, g, w, x->rows->medium[i]) : VL_NONE};
}

/* Adds a connection to a vertex as shadow ray `count`, in worlds without media. */
static void push(const vlTracing *t, const vlPaths *p, const vlConnection *c, uint32_t vertex,
                 uint32_t count, const vlTwoWayShadows *shadows) {
  const vlTwoWay *way = t->def->two_way;
  const vlLightVertex *x = &way->inner.vertices[vertex];
  vlShadowRays *q = shadows->rays;
  vlVec3 xg = vl_load3(x->g), xp = vl_load3(x->p);
  uint32_t i = c->i;
  float inv2 = 1.0f / vl_length2(vl_sub(xp, c->at)), there = vl_abs(vl_dot(xg, c->w));
  float back = -vl_dot(vl_load3(x->n), c->w) * VL_INV_PI;
  shadows->strategies->own[count] = way->connect;
  shadows->strategies->others[count] =
      inv2 * (c->ways * back * c->cosine + x->back * c->forth * there);
  float factor = c->factor;
  factor *= way->connect * there * inv2 * (x->alone && vl_hero_only(p, i) ? 0.25f : 1.0f);
  for (int k = 0; k < 4; k++)
    q->radiance[k][count] = p->beta[k][i] * c->value[k] * x->power[k] * factor;
  vlVec3 d = vl_sub(vl_offset_end(xp, xg, x->offset, c->w, c->at), c->o);
  vl_shadow_way(p, i, c->o, d, VL_ONE_MINUS_EPSILON, count, q);
}

/* Directions from n vertices to those that they have chosen; along the normals where none.
 * Returns the number of chosen ones. */
static uint32_t aim(uint32_t n, const vlSurface *f, const vlLightVertices *inner,
                    const uint32_t *chosen, vlVec3Row *toward) {
  uint32_t found = 0;
  for (uint32_t i = 0; i < n; i++) {
    vlVec3 w = vl_row3(&f->n, i);
    if (chosen[i] != VL_NONE) {
      const float *p = inner->vertices[chosen[i]].p;
      w = vl_normalize(vl_sub(vl_load3(p), vl_row3(&f->p, i)));
      found++;
    }
    vl_set_row3(toward, i, w);
  }
  return found;
}

void vl_stage_connect(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *x,
                      vlBsdfValues *there, vlBsdfValues *back, const vlTwoWayShadows *q) {
  vlVec3Row toward;
  vlFloatRow factor;
  uint32_t chosen[VL_ROW_SIZE], count = 0;
  if (depth + 2 > t->def->max_depth)
    return;
  vl_choose_vertices(t, n, depth, x, chosen, factor);
  if (!aim(n, &x->at->surface, &t->def->two_way->inner, chosen, &toward))
    return;
  vl_stage_there_and_back(t, n, x->at, &toward, there, back);
  for (uint32_t i = 0; i < n; i++) {
    if (chosen[i] == VL_NONE || !vl_has_value(there, i))
      continue;
    vlVec3 w = vl_row3(&toward, i);
    vlConnection c = connection(t, i, w, factor[i], x, there, back);
    if (q->flights)
      vl_push_connection(t, x->paths, x->rows, &c, chosen[i], count, q);
    else
      push(t, x->paths, &c, chosen[i], count, q);
    join_from_surface(t, x->at, i, chosen[i], there->wi[2][i], count++, q);
  }
  vl_two_way_shadows(t, x->paths, count, depth + VL_CONNECTION_KEY, q);
}
