/* tracer/own.hot.c: a tracer of one's own: starts it on a batch, and answers its
 * questions by the stages of the path tracer. Lanes of the questions are lanes of the batch;
 * the stages have the lanes with hits, sorted by material. */
#include "tracer/own.h"

#include "math/warp.h"

static void clear(float (*rows)[VL_OWN_BATCH], int count) {
  for (int c = 0; c < count; c++)
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
      rows[c][i] = 0.0f;
}

static void put3(float (*rows)[VL_OWN_BATCH], uint32_t lane, vlVec3 v) {
  vl_set_lane3(rows[0], rows[1], rows[2], lane, v);
}

static vlVec3 get3(float (*rows)[VL_OWN_BATCH], uint32_t lane) {
  return vl_lane3(rows[0], rows[1], rows[2], lane);
}

static void no_rays(vlTraceRays *r, uint32_t count) {
  r->count = count;
  clear(r->origin, 3);
  clear(r->direction, 2);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    r->direction[2][i] = 1.0f;
    r->t_min[i] = r->width[i] = 0.0f;
    r->t_max[i] = -1.0f;
  }
}

static uint32_t lanes_of(const vlTrace *w, const vlTraceRays *r) {
  return r->count < w->batch.n ? r->count : w->batch.n;
}

/* ---- hits -------------------------------------------------------------------------------- */

static void start(vlTrace *w, const vlTraceRays *r, uint32_t count) {
  vlPaths *p = &w->t.s->rays;
  const vlTraceBatch *b = &w->batch;
  for (uint32_t i = 0; i < VL_PAD(count); i++) {
    uint32_t k = i < count ? i : count - 1;
    vl_path_start(p, i, b->px[k], b->py[k], b->index[k], k);
    vl_set_row3(&p->o, i, vl_lane3(r->origin[0], r->origin[1], r->origin[2], k));
    vl_set_row3(&p->d, i, vl_lane3(r->direction[0], r->direction[1], r->direction[2], k));
    w->t_min[i] = r->t_min[k];
    w->t_max[i] = i < count ? r->t_max[k] : -1.0f;
    p->cone[i] = r->width[k];
    p->spread[i] = w->t.def->pixel_spread;
    for (int c = 0; c < 4; c++) {
      p->beta[c][i] = 1.0f;
      p->lambda[c][i] = b->lambda[c] ? b->lambda[c][k] : 0.0f;
    }
  }
}

static void clear_hits(vlTraceHits *h, uint32_t count) {
  h->count = count;
  clear(h->position, 3);
  clear(h->normal, 3);
  clear(h->shading, 3);
  clear(h->uv, 2);
  clear(h->reflectance, 4);
  clear(h->emission, 4);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    h->t[i] = VL_INFINITY;
    h->object[i] = h->material[i] = 0;
  }
}

static void find_hits(vlTrace *w, const vlTraceRays *r, vlTraceHits *h) {
  vlTracing *t = &w->t;
  vlTraceScratch *s = t->s;
  const vlSurface *f = &s->at.surface;
  const vlWorld *world = t->world;
  uint32_t count = lanes_of(w, r);
  clear_hits(h, count);
  w->hits = 0;
  w->lanes = count;
  if (count == 0)
    return;
  start(w, r, count);
  w->batch.rays.t_min = w->t_min;
  w->batch.rays.t_max = w->t_max;
  for (int c = 0; c < 4; c++)
    w->batch.radiance[c] = h->emission[c];
  vl_stage_hits(t, count, true, vl_add_hit_light, &s->rays, &s->hits);
  if (w->begun)
    w->batch.bounce_rays += count;
  for (uint32_t i = 0; i < count && !w->begun; i++) {
    uint32_t shape = s->hits.shape[i];
    w->batch.alpha[i] = shape == VL_NONE || world->shapes.items[shape].backdrop ? 0.0f : 1.0f;
  }
  w->begun = true;
  vl_stage_emission(t, count, &s->rays, &s->hits);
  for (uint32_t i = 0; i < count; i++)
    for (int c = 0; c < 4 && r->t_max[i] < 0.0f; c++)
      h->emission[c][i] = 0.0f;
  uint32_t n = w->hits = vl_stage_sort(world, count, &s->rays, &s->hits, s->order, &s->at);
  vl_stage_shade(t, n, &s->at);
  for (uint32_t k = 0; k < n; k++) {
    uint32_t lane = s->at.paths.lane[k], shape = s->at.hits.shape[k];
    vlVec3 g = vl_row3(&f->g, k), d = vl_row3(&s->at.paths.d, k);
    h->t[lane] = f->t[k];
    put3(h->position, lane, vl_row3(&f->p, k));
    put3(h->normal, lane, vl_dot(g, d) > 0.0f ? vl_neg(g) : g);
    put3(h->shading, lane, vl_row3(&f->n, k));
    h->uv[0][lane] = f->u[k];
    h->uv[1][lane] = f->v[k];
    h->object[lane] = shape + 1;
    h->material[lane] = world->shapes.items[shape].material + 1;
    bool has = world->materials.items[s->at.hits.material[k]].reflectance >= 0;
    for (int c = 0; c < 4; c++)
      h->reflectance[c][lane] = has ? s->at.shade.reflectance[c][k] : 1.0f;
  }
}

static void occluded(vlTrace *w, const vlTraceRays *r, uint8_t *result) {
  uint32_t count = lanes_of(w, r);
  __builtin_memset(result, 0, VL_OWN_BATCH);
  if (count == 0)
    return;
  vlRays rays = {
      r->origin[0],    r->origin[1], r->origin[2], r->direction[0],    r->direction[1],
      r->direction[2], r->t_min,     r->t_max,     w->batch.rays.time, NULL};
  vl_accel_occluded(w->t.world, count, &rays, &w->t.s->occluders, result);
  w->batch.shadow_rays += count;
  for (uint32_t i = 0; i < count; i++)
    if (r->t_max[i] < 0.0f)
      result[i] = 0;
}

/* ---- from the hits ----------------------------------------------------------------------- */

static void leave(vlTrace *w, float (*direction)[VL_OWN_BATCH], vlTraceRays *r) {
  const vlSurface *f = &w->t.s->at.surface;
  float d[3][VL_OWN_BATCH];
  __builtin_memcpy(d, direction, sizeof d); /* it may be that of r */
  no_rays(r, w->lanes);
  for (uint32_t k = 0; k < w->hits; k++) {
    uint32_t lane = w->t.s->at.paths.lane[k];
    vlVec3 to = get3(d, lane);
    put3(r->direction, lane, to);
    put3(r->origin, lane, vl_surface_origin(f, k, to));
    r->t_max[lane] = VL_INFINITY;
    r->width[lane] = f->width[k];
  }
}

static void lights(vlTrace *w, uint32_t bounce, vlTraceLights *out) {
  vlTraceScratch *s = w->t.s;
  const vlSurface *f = &s->at.surface;
  const vlLightSamples *l = &s->light;
  clear(out->direction, 3);
  clear(out->radiance, 4);
  clear(&out->pdf, 1);
  __builtin_memset(out->delta, 0, sizeof out->delta);
  no_rays(&out->rays, w->lanes);
  if (w->hits == 0 || w->t.world->lights.count == 0)
    return;
  vl_stage_light_samples(&w->t, w->hits, &s->at.paths, f,
                         VL_DIM_BOUNCE + bounce * VL_DIM_STRIDE, &s->light);
  for (uint32_t k = 0; k < w->hits; k++) {
    uint32_t lane = s->at.paths.lane[k];
    if (!(l->pdf[k] > 0.0f))
      continue;
    vlVec3 to = vl_row3(&l->w, k), o = vl_surface_origin(f, k, to);
    put3(out->direction, lane, to);
    for (int c = 0; c < 4; c++)
      out->radiance[c][lane] = l->radiance[c][k];
    out->pdf[lane] = l->pdf[k];
    out->delta[lane] = l->delta[k] ? 1 : 0;
    put3(out->rays.origin, lane, o);
    put3(out->rays.direction, lane, l->distant[k] ? to : vl_sub(vl_row3(&l->target, k), o));
    out->rays.t_max[lane] = l->distant[k] ? VL_INFINITY : VL_ONE_MINUS_EPSILON;
  }
}

static void bsdf(vlTrace *w, float (*direction)[VL_OWN_BATCH], float (*value)[VL_OWN_BATCH],
                 float *pdf) {
  vlTraceScratch *s = w->t.s;
  float d[3][VL_OWN_BATCH];
  vlVec3Row to;
  __builtin_memcpy(d, direction, sizeof d);
  clear(value, 4);
  for (uint32_t i = 0; pdf && i < VL_OWN_BATCH; i++)
    pdf[i] = 0.0f;
  if (w->hits == 0)
    return;
  for (uint32_t k = 0; k < VL_PAD(w->hits); k++) {
    uint32_t lane = s->at.paths.lane[k < w->hits ? k : w->hits - 1];
    vl_set_row3(&to, k, vl_lane3(d[0], d[1], d[2], lane));
  }
  vl_stage_local(w->hits, &s->at, &to, s->values.wi);
  vl_stage_bsdf(&w->t, w->hits, &s->at, s->at.shade.wo, &s->values);
  for (uint32_t k = 0; k < w->hits; k++) {
    uint32_t lane = s->at.paths.lane[k];
    for (int c = 0; c < 4; c++)
      value[c][lane] = s->values.value[c][k];
    if (pdf)
      pdf[lane] = s->values.pdf[k];
  }
}

static void bounce(vlTrace *w, uint32_t number, vlTraceBounce *out) {
  vlTraceScratch *s = w->t.s;
  vlPaths *from = &s->at.paths, *to = &s->rays;
  clear(out->weight, 4);
  clear(&out->pdf, 1);
  __builtin_memset(out->specular, 0, sizeof out->specular);
  no_rays(&out->rays, w->lanes);
  if (w->hits == 0)
    return;
  for (uint32_t k = 0; k < VL_PAD(w->hits); k++) {
    from->eta_scale[k] = 1.0f;
    for (int c = 0; c < 4; c++)
      from->beta[c][k] = 1.0f;
  }
  for (uint32_t i = 0; i < VL_ROW_SIZE; i++)
    w->radiance[0][i] = 0.0f;
  for (int c = 0; c < 4; c++)
    w->batch.radiance[c] = w->radiance[c];
  uint32_t count = vl_stage_scatter(&w->t, w->hits, 1, VL_DIM_BOUNCE + number * VL_DIM_STRIDE,
                                    &s->at, &s->samples, s->order, to);
  for (uint32_t k = 0; k < w->hits; k++) /* a weight that is no number */
    if (w->radiance[0][from->lane[k]] != 0.0f)
      out->weight[0][from->lane[k]] = w->radiance[0][from->lane[k]];
  for (uint32_t k = 0; k < count; k++) {
    uint32_t lane = to->lane[k];
    for (int c = 0; c < 4; c++)
      out->weight[c][lane] = to->beta[c][k];
    out->pdf[lane] = to->pdf[k];
    out->specular[lane] = to->specular[k] ? 1 : 0;
    put3(out->rays.origin, lane, vl_row3(&to->o, k));
    put3(out->rays.direction, lane, vl_row3(&to->d, k));
    out->rays.t_max[lane] = VL_INFINITY;
    out->rays.width[lane] = vl_abs(to->cone[k]);
  }
}

static const vlTraceQueries queries = {find_hits, occluded, leave, lights, bsdf, bounce};

/* ---- the tracer -------------------------------------------------------------------------- */

static void make_rays(const vlTracing *t, vlTraceRays *r) {
  const vlTraceBatch *b = t->batch;
  no_rays(r, b->n);
  for (uint32_t i = 0; i < b->n; i++) {
    put3(r->origin, i, vl_ray_origin(&b->rays, i));
    put3(r->direction, i, vl_ray_direction(&b->rays, i));
    r->t_min[i] = b->rays.t_min[i];
    r->t_max[i] = b->rays.t_max[i];
    r->width[i] = t->def->pixel_width;
  }
}

void vl_own_tracer(vlTracing *t) {
  vlTraceBatch *b = t->batch;
  vlTrace w = {.queries = &queries, .t = *t, .batch = *b};
  vlTraceRays rays;
  float radiance[4][VL_OWN_BATCH], white[4][VL_OWN_BATCH], lambda[4][VL_OWN_BATCH];
  w.t.batch = &w.batch;
  w.batch.bounce_rays = w.batch.shadow_rays = 0;
  make_rays(t, &rays);
  clear(radiance, 4);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < VL_PAD(b->n); i++) {
      lambda[c][i] = b->lambda[c] ? b->lambda[c][i] : 0.0f;
      white[c][i] = vl_spectral_at(&t->world->white, c, lambda[c][i]);
    }
  for (uint32_t i = 0; i < VL_PAD(b->n); i++)
    b->alpha[i] = 0.0f;
  const vlOwnPaths paths = {b->n,
                            &rays,
                            b->px,
                            b->py,
                            b->index,
                            b->rays.time,
                            b->lambda[0] ? (const float(*)[VL_OWN_BATCH])lambda : NULL,
                            (const float(*)[VL_OWN_BATCH])white,
                            t->def->max_depth,
                            radiance,
                            b->alpha};
  t->def->own->radiance(t->def->own->user, &w, &paths);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < b->n; i++)
      b->radiance[c][i] = radiance[c][i];
  b->bounce_rays += w.batch.bounce_rays;
  b->shadow_rays += w.batch.shadow_rays;
}
