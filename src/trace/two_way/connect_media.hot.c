/* trace/two_way/connect_media.hot.c: connections of inner vertices in worlds with media
 * (connect.hot.c). Each end may be on a surface or in a medium. In a medium the phase
 * function's value is its density in both directions, and the extinction replaces the cosine in
 * the weights (two_way.h). The shadow ray estimates the transmittance as that of a light sample
 * does. */
#include "trace/medium/phase.h"
#include "trace/two_way/stages.h"

/* A connection that promises less than LITTLE times the radiance that its path has found
 * already plays Russian roulette. Of the values tried, this one has nearly no more noise. */
static const float LITTLE = 0.1f, MIN_SURVIVAL = 0.1f;

/* The transmittance between ends in the same uniform medium is known, up to what is in between.
 * Elsewhere 1 stands for it: where the worth is too small, the few connections that are made
 * would count too much. */
void vl_worths_in_media(const vlTracing *t, const vlEnd *e, const uint32_t at[VL_CANDIDATES],
                        float worth[VL_CANDIDATES]) {
  const vlTwoWay *way = t->def->two_way;
  _Alignas(64) float p[3][VL_CANDIDATES], g[3][VL_CANDIDATES], n[3][VL_CANDIDATES],
      power[4][VL_CANDIDATES];
  _Alignas(64) float a[VL_CANDIDATES], dense[VL_CANDIDATES], asymmetry[VL_CANDIDATES],
      b[VL_CANDIDATES];
  _Alignas(64) float near[VL_CANDIDATES], sigma[VL_CANDIDATES], in[VL_CANDIDATES];
  float extinction = e->air ? t->world->media.items[e->air - 1].extinction : 0.0f;
  vl_gather(way, e, at, p, g, n, power, b, near);
  for (uint32_t k = 0; k < VL_CANDIDATES; k++) {
    const vlLightVertex *x = &way->inner.vertices[at[k]];
    in[k] = x->inside ? 1.0f : 0.0f;
    a[k] = in[k] * x->a;
    dense[k] = x->dense;
    asymmetry[k] = in[k] * x->asymmetry;
    sigma[k] = x->air == e->air ? extinction : 0.0f;
  }
  vlEnd end = *e;
  float connect = way->connect, phases = end.inside ? 1.0f : 0.0f; /* one of three is not 0 */
  float cosines = end.diffuse ? VL_INV_PI : 0.0f,
        bents = end.inside || end.diffuse ? 0.0f : VL_INV_PI;
  /* one vector of 8 */
  VL_SIMD
  for (uint32_t k = 0; k < VL_CANDIDATES; k++) {
    vlVec3 to = vl_vec3(p[0][k] - end.p.x, p[1][k] - end.p.y, p[2][k] - end.p.z);
    float d2 = vl_length2(to), inv2 = 1.0f / d2, inv = __builtin_sqrtf(inv2);
    float here = vl_dot(end.n, to) * inv,
          there = -vl_dot(vl_vec3(n[0][k], n[1][k], n[2][k]), to) * inv;
    float flat_here = vl_abs(vl_dot(end.g, to)) * inv;
    float flat_there = vl_abs(vl_dot(vl_vec3(g[0][k], g[1][k], g[2][k]), to)) * inv;
    float phase_here = vl_phase(end.asymmetry, here),
          phase_there = vl_phase(asymmetry[k], there);
    float bent = vl_max(vl_abs(here), 0.01f);
    int inside = in[k] > 0.0f;
    float forth = phases * phase_here + cosines * here + bents * bent; /* value and density */
    float lambert = there * VL_INV_PI;
    float back = inside ? phase_there : lambert;
    float gives = inside ? phase_there : flat_there;
    /* one of two is 0 here */
    float cosine_here = end.dense + flat_here, cosine_there = inside ? dense[k] : flat_there;
    float ways = end.a * phase_here + end.ways, light_ways = a[k] * phase_there + b[k];
    float sum =
        end.tint[0] * power[0][k] + end.tint[1] * power[1][k] + end.tint[2] * power[2][k];
    sum += end.tint[3] * power[3][k];
    float passes = vl_exp(-sigma[k] * d2 * inv);
    float others = ways * back * cosine_here + light_ways * forth * cosine_there;
    float w = passes * sum * forth * gives / (connect * d2 + passes * others);
    int good = (near[k] > 0.0f) & (d2 > 0.0f) & (forth > 0.0f) & (back > 0.0f) & (w > 0.0f) &
               (w < VL_INFINITY);
    worth[k] = good ? w : 0.0f;
  }
}

float vl_connection_survival(const vlTracing *t, uint32_t lane, float expected) {
  float known = 0.0f;
  for (int c = 0; c < 4; c++)
    known += t->batch->radiance[c][lane];
  known *= LITTLE;
  return expected < known ? vl_max(expected / known, MIN_SURVIVAL) : 1.0f;
}

void vl_push_connection(const vlTracing *t, const vlPaths *p, const vlVolumeRows *rows,
                        const vlConnection *c, uint32_t vertex, uint32_t count,
                        const vlTwoWayShadows *shadows) {
  const vlLightVertex *x = &t->def->two_way->inner.vertices[vertex];
  vlShadowRays *q = shadows->rays;
  vlShadowFlights *f = shadows->flights;
  float connect = t->def->two_way->connect, gives, back, ways = x->back, cosine;
  vlVec3 end = vl_load3(x->p), n = vl_load3(x->n);
  float inv2 = 1.0f / vl_length2(vl_sub(end, c->at)), there = -vl_dot(n, c->w);
  if (x->inside) {
    gives = back = vl_phase(x->asymmetry, there);
    ways += x->a * back;
    cosine = x->dense;
  } else {
    vlVec3 g = vl_load3(x->g);
    gives = cosine = vl_abs(vl_dot(g, c->w));
    back = there * VL_INV_PI;
    end = vl_offset_end(end, g, x->offset, c->w, c->at);
  }
  shadows->strategies->own[count] = connect;
  shadows->strategies->others[count] =
      inv2 * (c->ways * back * c->cosine + ways * c->forth * cosine);
  float factor =
      c->factor * connect * gives * inv2 * (x->alone && vl_hero_only(p, c->i) ? 0.25f : 1.0f);
  for (int k = 0; k < 4; k++) {
    q->radiance[k][count] = p->beta[k][c->i] * c->value[k] * x->power[k] * factor;
    f->density[k][count] = rows->u[k][c->i];
  }
  vlVec3 d = vl_sub(end, c->o);
  vl_shadow_way(p, c->i, c->o, vl_normalize(d), vl_length(d) * VL_SHADOW_END, count, q);
  f->medium[count] = c->medium;
  f->from[count] = c->i;
}

void vl_connect_from_media(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *in,
                           const vlTwoWayShadows *q) {
  const vlPaths *p = in->paths;
  const vlWays *ways = in->ways;
  const vlTwoWay *way = t->def->two_way;
  uint32_t count = 0, chosen[VL_ROW_SIZE];
  float factor[VL_ROW_SIZE];
  if (depth + 2 > t->def->max_depth)
    return;
  vl_choose_vertices(t, n, depth, in, chosen, factor);
  for (uint32_t i = 0; i < n; i++) {
    if (chosen[i] == VL_NONE)
      continue;
    const vlLightVertex *x = &way->inner.vertices[chosen[i]];
    uint32_t medium = in->rows->medium[i], lane = p->lane[i];
    vlVec3 at = vl_row3(&p->o, i);
    vlVec3 w = vl_normalize(vl_sub(vl_load3(x->p), at));
    float phase = vl_phase(t->world->media.items[medium].g, vl_dot(vl_row3(&p->d, i), w));
    vlConnection c = {.i = i,
                      .at = at,
                      .o = at,
                      .w = w,
                      .value = {phase, phase, phase, phase},
                      .forth = phase,
                      .ways = ways->a[i] * phase + ways->b[i] + way->merged_volume,
                      .cosine = ways->cosine[i],
                      .factor = factor[i],
                      .medium = medium};
    vl_push_connection(t, p, in->rows, &c, chosen[i], count, q);
    if (t->world->by_channel) {
      const float eye[3] = {t->passed[0][lane], t->passed[1][lane], t->passed[2][lane]};
      vl_join_channels(p, i, eye, way->inner.passed[chosen[i]], count, q);
    }
    count++;
  }
  vl_two_way_shadows(t, p, count, depth + VL_CONNECTION_KEY, q);
}
