/* trace/two_way/connect.hot.c: connections of inner vertices: a vertex of the camera path to one of a light path on a
 * diffuse surface (Veach 1997, chapter 10; two_way.h has the weights).
 *
 * Each vertex of a camera path looks at a few vertices of the pass's light paths, evenly distributed over them, and
 * keeps one with a probability in proportion to what it would contribute if it were visible (resampled importance
 * sampling: Talbot et al. 2005; Nabata et al. 2020 for bidirectional tracers). Only that one costs a shadow ray. The
 * estimate is unbiased for any such probability above 0. On diffuse surfaces it is exact up to visibility. */
#include "math/hash.h"
#include "trace/two_way/stages.h"

enum { CANDIDATES = 8 }; /* of each connection */

void vl_stage_groups(vlTracing *t, uint32_t n, float *u) {
  const vlTwoWay *way = t->def->two_way;
  uint32_t *group = t->batch->two_way->group;
  for (uint32_t i = 0; i < n; i++) {
    group[i] = (uint32_t)(u[i] * (float)way->inner.groups);
    u[i] = vl_group_wavelength(way, group[i]);
  }
}

/* The camera path's vertex on lane i. */
typedef struct End {
  vlVec3 p, g, n; /* n: shading normal on the side of wo */
  float tint[4];  /* throughput; on diffuse surfaces times the reflectance */
  float ways;     /* the strategies on the camera's side, with merging; an estimate for other surfaces */
  bool diffuse;
  uint32_t room; /* largest number of bounces that a light path may have */
} End;

static End end_of(const vlTracing *t, uint32_t i, uint32_t depth) {
  const vlTraceScratch *s = t->s;
  const vlSurface *f = &s->surface;
  const vlTwoWayRows *r = t->batch->two_way;
  float z = s->shade.wo[2][i];
  End e = {.p = vl_lane3(f->px, f->py, f->pz, i),
           .g = vl_lane3(f->gx, f->gy, f->gz, i),
           .n = vl_mul(vl_lane3(f->nx, f->ny, f->nz, i), z < 0.0f ? -1.0f : 1.0f),
           .ways = r->a[i] * vl_abs(z) * VL_INV_PI + r->b[i] + t->def->two_way->merged,
           .diffuse = vl_is_inner_end(t, i),
           .room = t->def->max_depth - depth - 1};
  for (int c = 0; c < 4; c++) e.tint[c] = s->b.beta[c][i] * (e.diffuse ? s->shade.reflectance[c][i] : 1.0f);
  return e;
}

/* What the connection would contribute if it were visible, up to a constant factor. */
static float worth_of(const vlTwoWay *way, const End *e, const vlLightVertex *x) {
  if (x->bounce > e->room) return 0.0f;
  vlVec3 to = vl_vec3(x->p[0] - e->p.x, x->p[1] - e->p.y, x->p[2] - e->p.z);
  float d2 = vl_length2(to);
  if (!(d2 > 0.0f)) return 0.0f;
  float inv2 = 1.0f / d2, inv = __builtin_sqrtf(inv2);
  float here = vl_dot(e->n, to) * inv, there = -vl_dot(vl_vec3(x->n[0], x->n[1], x->n[2]), to) * inv;
  float flat_here = vl_abs(vl_dot(e->g, to)) * inv,
        flat_there = vl_abs(vl_dot(vl_vec3(x->g[0], x->g[1], x->g[2]), to)) * inv;
  here = e->diffuse ? here : vl_max(vl_abs(here), 0.01f);
  if (!(here > 0.0f) || !(there > 0.0f)) return 0.0f;
  float power = 0.0f;
  for (int c = 0; c < 4; c++) power += e->tint[c] * x->power[c];
  float others = (e->ways * there * flat_here + x->back * here * flat_there) * VL_INV_PI;
  return power * here * flat_there / (way->connect * d2 + others);
}

/* Chooses a vertex for lane i. Returns its index, or VL_NONE. *factor: 1 / (its probability * light paths). */
static uint32_t choose(const vlTracing *t, uint32_t i, uint32_t depth, float *factor) {
  const vlTwoWay *way = t->def->two_way;
  const vlLightVertices *inner = &way->inner;
  const vlPaths *p = &t->s->b;
  uint32_t group = t->batch->two_way->group[p->lane[i]], first = inner->start[group];
  uint32_t count = inner->start[group + 1] - first, chosen = VL_NONE;
  if (count == 0 || vl_all_specular(t->world, t->s, i)) return VL_NONE;
  uint32_t seed = vl_hash3((uint32_t)p->px[i] ^ t->def->sampler->seed, (uint32_t)p->py[i], p->index[i]);
  seed = vl_hash2(seed, depth);
  End e = end_of(t, i, depth);
  uint32_t at[CANDIDATES];
  for (uint32_t k = 0; k < CANDIDATES; k++) {
    float u = ((float)k + vl_unit_float(vl_hash(seed + 1 + k))) * (1.0f / CANDIDATES);
    uint32_t place = (uint32_t)(u * (float)count);
    at[k] = inner->order[first + (place < count ? place : count - 1)];
    __builtin_prefetch(&inner->vertices[at[k]]);
  }
  float u = vl_unit_float(vl_hash(seed)), sum = 0.0f, kept = 0.0f;
  for (uint32_t k = 0; k < CANDIDATES; k++) {
    float worth = worth_of(way, &e, &inner->vertices[at[k]]);
    if (!(worth > 0.0f) || !(worth < VL_INFINITY)) continue;
    sum += worth;
    float share = worth / sum;
    bool take = u < share;
    u = take ? u / share : (u - share) / (1.0f - share);
    if (take) chosen = at[k], kept = worth;
  }
  float paths = (float)(inner->paths / inner->groups);
  if (chosen != VL_NONE) *factor = sum / (kept * CANDIDATES) * (float)count / paths;
  return chosen;
}

/* Adds lane i's connection to x as shadow ray `count`. */
static void push(vlTracing *t, uint32_t i, const vlLightVertex *x, float factor, float forth, uint32_t count) {
  vlTraceScratch *s = t->s;
  const vlTwoWay *way = t->def->two_way;
  vlTwoWayRows *r = t->batch->two_way;
  const vlSurface *f = &s->surface;
  vlShadowRays *q = &s->shadow;
  vlVec3 at = vl_lane3(f->px, f->py, f->pz, i), g = vl_lane3(f->gx, f->gy, f->gz, i);
  vlVec3 w = vl_lane3(s->rows[9], s->rows[10], s->rows[11], i), xg = vl_vec3(x->g[0], x->g[1], x->g[2]);
  vlVec3 xp = vl_vec3(x->p[0], x->p[1], x->p[2]);
  float inv2 = 1.0f / vl_length2(vl_sub(xp, at)), there = vl_abs(vl_dot(xg, w));
  float back = -vl_dot(vl_vec3(x->n[0], x->n[1], x->n[2]), w) * VL_INV_PI;
  r->own[count] = way->connect;
  r->others[count] =
      inv2 * ((r->a[i] * r->rev[i] + r->b[i] + way->merged) * back * vl_abs(vl_dot(g, w)) + x->back * forth * there);
  factor *= way->connect * there * inv2 * (x->alone && vl_hero_only(&s->b, i) ? 0.25f : 1.0f);
  for (int c = 0; c < 4; c++) q->radiance[c][count] = s->b.beta[c][i] * s->rows[3 + c][i] * x->power[c] * factor;
  vlVec3 o = vl_offset_origin(at, g, f->offset[i], w), d = vl_sub(vl_offset_origin(xp, xg, x->offset, vl_neg(w)), o);
  q->ox[count] = o.x, q->oy[count] = o.y, q->oz[count] = o.z;
  q->dx[count] = d.x, q->dy[count] = d.y, q->dz[count] = d.z;
  q->t_max[count] = VL_ONE_MINUS_EPSILON;
  q->time[count] = vl_path_time(&s->b, i);
  q->lane[count] = s->b.lane[i];
}

void vl_stage_connect(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  vlTwoWayRows *r = t->batch->two_way;
  const vlSurface *f = &s->surface;
  const vlLightVertices *inner = &t->def->two_way->inner;
  float(*wi)[VL_ROW_SIZE] = s->rows, (*value)[VL_ROW_SIZE] = s->rows + 3, *forth = s->rows[7], *factor = s->rows[8];
  if (depth + 2 > t->def->max_depth) return;
  uint32_t found = 0;
  for (uint32_t i = 0; i < n; i++) {
    r->first[i] = choose(t, i, depth, &factor[i]);
    vlVec3 w = vl_lane3(f->nx, f->ny, f->nz, i);
    if (r->first[i] != VL_NONE) {
      const float *p = inner->vertices[r->first[i]].p;
      w = vl_normalize(vl_sub(vl_vec3(p[0], p[1], p[2]), vl_lane3(f->px, f->py, f->pz, i)));
      found++;
    }
    s->light.wx[i] = s->rows[9][i] = w.x, s->light.wy[i] = s->rows[10][i] = w.y;
    s->light.wz[i] = s->rows[11][i] = w.z;
  }
  if (!found) return;
  vl_stage_light_bsdf(t, n);
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    for (int k = 0; k < 3; k++) wi[k][i] = sh->wi[k][i];
    for (int c = 0; c < 4; c++) value[c][i] = sh->value[c][i];
    forth[i] = sh->pdf[i];
  }
  vl_stage_reverse(t, r, n, (const float(*)[VL_ROW_SIZE])wi);
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (r->first[i] == VL_NONE) continue;
    float sum = value[0][i] + value[1][i] + value[2][i] + value[3][i];
    if (!(sum > 0.0f) && sum == sum) continue;
    const vlLightVertex *x = &inner->vertices[r->first[i]];
    push(t, i, x, factor[i], forth[i], count++);
  }
  vl_two_way_shadows(t, &s->b, &s->volume.b, count, depth);
}
