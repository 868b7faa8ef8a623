/* tracer/record.hot.c: see record.h. */
#include "tracer/record.h"
#include "schema/schema.h"
#include "velo/texture.h"

static vlPathRecorder *recorder(const vlTracing *t) {
  return t->batch->recorder;
}

/* The last vertex of a lane's path; null if none. */
static vlPathVertex *last_vertex(const vlTracing *t, uint32_t lane) {
  vlPathRecorder *r = recorder(t);
  uint32_t count = r->paths[lane].vertex_count;
  return count ? &r->vertices[(size_t)lane * r->max_vertices + count - 1] : NULL;
}

/* A new vertex, all zero; null if there is no room. */
static vlPathVertex *new_vertex(const vlTracing *t, uint32_t lane) {
  vlPathRecorder *r = recorder(t);
  if (r->paths[lane].vertex_count == r->max_vertices) {
    r->lost++;
    return NULL;
  }
  r->paths[lane].vertex_count++;
  vlPathVertex *v = last_vertex(t, lane);
  *v = (vlPathVertex){.fate = VL_PATH_ABSORBED, .survival = 1.0f};
  return v;
}

static void put_ids(const vlHits *h, uint32_t i, vlPathVertex *v) {
  v->object = h->shape[i] + 1;
  v->material = h->material[i] + 1;
  v->instance = h->instance[i] == VL_NONE ? 0 : h->instance[i] + 1;
  v->primitive = h->prim[i] + 1;
}

/* ---- arrivals ---------------------------------------------------------------------------- */

vlPathVertex *vl_record_arrival(vlTracing *t, const vlPaths *p, uint32_t i, uint32_t bounce) {
  vlPathVertex *v = new_vertex(t, p->lane[i]);
  if (!v)
    return NULL;
  v->event = VL_PATH_NOTHING;
  v->fate = VL_PATH_LEFT;
  v->distance = VL_INFINITY;
  v->bounce = bounce;
  vl_store3(v->arrival, vl_row3(&p->d, i));
  for (int c = 0; c < 4; c++)
    v->throughput[c] = p->beta[c][i];
  return v;
}

void vl_record_surface(vlTracing *t, const vlPaths *p, const vlHits *h, uint32_t i,
                       vlPathVertex *v) {
  vlPoint at = vl_hit_point(t->world, p, h, i);
  v->event = VL_PATH_SURFACE;
  v->fate = VL_PATH_ABSORBED;
  put_ids(h, i, v);
  vl_store3(v->position, at.p);
  vl_store3(v->normal, at.g);
  v->uv[0] = at.u;
  v->uv[1] = at.v;
  v->distance = vl_length(vl_sub(at.p, vl_row3(&p->o, i)));
}

void vl_record_arrivals(vlTracing *t, uint32_t n, uint32_t bounce, const vlPaths *rays,
                        const vlHits *hits) {
  for (uint32_t i = 0; i < n; i++) {
    vlPathVertex *v = vl_record_arrival(t, rays, i, bounce);
    if (v && hits->shape[i] != VL_NONE)
      vl_record_surface(t, rays, hits, i, v);
  }
}

void vl_record_limit(const vlTracing *t, uint32_t lane) {
  vlPathVertex *v = last_vertex(t, lane);
  if (v && v->event != VL_PATH_NOTHING)
    v->fate = VL_PATH_DEPTH;
}

void vl_record_depth(const vlTracing *t, uint32_t n, const vlPaths *rays) {
  for (uint32_t i = 0; i < n; i++)
    vl_record_limit(t, rays->lane[i]);
}

/* ---- light ------------------------------------------------------------------------------- */

/* Says which light it is: type, object, distant, light. */
static void name_light(const vlWorld *world, uint32_t light, vlPathContribution *to) {
  const vlWorldLight *l = &world->lights.items[light];
  to->light = light + 1;
  to->type = l->shape == VL_NONE ? vl_kind_row(&vl_light_family, (int)l->kind)->name : "area";
  to->object = l->shape == VL_NONE ? 0 : l->shape + 1;
  to->distant = l->far;
}

void vl_record_light(vlTracing *t, uint32_t lane, const vlPathContribution *light) {
  vlPathRecorder *r = recorder(t);
  vlPath *path = &r->paths[lane];
  if (path->contribution_count == r->max_contributions || path->vertex_count == 0) {
    r->lost++;
    return;
  }
  vlPathContribution *to =
      &r->contributions[(size_t)lane * r->max_contributions + path->contribution_count++];
  *to = *light;
  to->vertex = path->vertex_count - 1;
}

void vl_record_hit_light(vlTracing *t, const vlPaths *p, uint32_t i, const vlHitLight *met,
                         bool sky, float weight, float factor) {
  vlPathContribution c = {.event = sky ? VL_PATH_LIGHT_SKY : VL_PATH_LIGHT_HIT,
                          .light_pdf = met->pdf,
                          .bsdf_pdf = p->pdf[i],
                          .weight = weight};
  name_light(t->world, met->light, &c);
  vl_store3(c.target, sky ? vl_row3(&p->d, i) : met->at.p);
  for (int k = 0; k < 4; k++)
    c.radiance[k] = p->beta[k][i] * met->radiance[k] * factor;
  vl_record_light(t, p->lane[i], &c);
}

static void record_hit(vlTracing *t, const vlPaths *p, VL_UNUSED const vlVolumeRows *rows,
                       VL_UNUSED const vlFlightEnds *ends, uint32_t i, const vlHitLight *met,
                       bool sky) {
  float weight = p->specular[i] ? 1.0f : vl_power_heuristic(p->pdf[i], met->pdf);
  vl_record_hit_light(t, p, i, met, sky, weight, weight);
}

void vl_record_emission(vlTracing *t, uint32_t n, const vlPaths *rays, const vlHits *hits) {
  vl_stage_lights_hit(t, n, rays, hits, NULL, NULL, record_hit);
}

void vl_record_sampled(const vlWorld *world, const vlLightSamples *l, uint32_t i,
                       vlPathContribution *to) {
  name_light(world, l->light[i], to);
  to->distant = l->distant[i];
  vl_store3(to->target, vl_row3(&l->target, i));
}

void vl_record_direct_light(vlTracing *t, uint32_t n, uint32_t count, const vlVertices *at,
                            const vlLightSamples *l, const vlBsdfValues *values,
                            const vlShadowRays *q) {
  for (uint32_t k = 0, i = 0; k < count; k++, i++) {
    while (i < n && at->paths.lane[i] != q->lane[k])
      i++; /* the rays are in the order of the lanes */
    if (i == n)
      return;
    vlPathContribution c = {
        .event = VL_PATH_LIGHT_SAMPLED,
        .occluded = q->occluded[k],
        .light_pdf = l->pdf[i],
        .bsdf_pdf = l->delta[i] ? 0.0f : values->pdf[i],
        .weight = l->delta[i] ? 1.0f : vl_power_heuristic(l->pdf[i], values->pdf[i])};
    vl_record_sampled(t->world, l, i, &c);
    for (int m = 0; m < 4; m++)
      c.radiance[m] = q->occluded[k] ? 0.0f : q->radiance[m][k];
    vl_record_light(t, q->lane[k], &c);
  }
}

/* ---- scattering -------------------------------------------------------------------------- */

/* The first image of a texture node and its inputs; null if none. */
static const char *image_of(const vlWorld *world, int32_t node) {
  for (int32_t k = node; k >= 0;) {
    const vlTextureNode *n = &world->nodes.items[k];
    if (n->kind == VL_TEXTURE_IMAGE)
      return world->images.items[n->image].path;
    const char *first = image_of(world, n->a);
    if (first)
      return first;
    k = n->b;
  }
  return NULL;
}

static void put_texture(const vlWorld *world, int32_t node, vlPathVertex *v) {
#define NAME(kind, name, ...) [kind] = #name,
  static const char *const names[] = {VL_TEXTURE_KINDS(NAME)};
#undef NAME
  if (node < 0)
    return;
  uint32_t kind = world->nodes.items[node].kind;
  if (kind == VL_TEXTURE_CONSTANT)
    return;
  v->texture = names[kind];
  v->image = image_of(world, node);
}

void vl_record_shaded(vlTracing *t, uint32_t n, const vlVertices *at) {
  for (uint32_t i = 0; i < n; i++) {
    vlPathVertex *v = last_vertex(t, at->paths.lane[i]);
    if (!v)
      continue;
    const vlWorldMaterial *m = &t->world->materials.items[at->hits.material[i]];
    v->bsdf = t->bsdf->names[m->bsdf];
    vl_store3(v->shading, vl_row3(&at->surface.n, i));
    put_texture(t->world, m->reflectance, v);
    for (int c = 0; c < 4; c++) {
      v->throughput[c] = at->paths.beta[c][i];
      v->reflectance[c] = m->reflectance >= 0 ? at->shade.reflectance[c][i] : 0.0f;
    }
  }
}

/* After the scattering, of the four wavelengths. */
static float largest_throughput(const vlPathVertex *v) {
  float max = 0.0f;
  for (int c = 0; c < 4; c++)
    max = vl_max(max, v->throughput[c] * v->factor[c]);
  return max;
}

/* The paths of the `count` vertices in `order` go on along the rays of the same indices. lane:
 * of the vertices. */
static void go_on(vlTracing *t, const uint32_t *lane, const uint32_t *order, uint32_t count,
                  const vlPaths *rays) {
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = order[k];
    vlPathVertex *v = last_vertex(t, lane[i]);
    if (!v)
      continue;
    v->fate = VL_PATH_ON;
    v->pdf = rays->pdf[i];
    vl_store3(v->direction, vl_row3(&rays->d, i));
  }
}

void vl_record_scatter(vlTracing *t, uint32_t n, uint32_t depth, const vlVertices *at,
                       const vlBsdfSamples *s, const vlPaths *next, const uint32_t *order,
                       uint32_t count) {
  const vlPaths *p = &at->paths;
  for (uint32_t i = 0; i < n; i++) {
    vlPathVertex *v = last_vertex(t, p->lane[i]);
    if (!v)
      continue;
    bool none = s->flags[i] & VL_SAMPLED_NONE;
    v->lobe = s->flags[i] & (VL_SAMPLED_SPECULAR | VL_SAMPLED_TRANSMISSION);
    v->pdf = none ? 0.0f : s->pdf[i];
    for (int c = 0; c < 4; c++)
      v->factor[c] = none ? 0.0f : s->weight[c][i];
    float max = largest_throughput(v);
    v->survival = vl_roulette_survival(max * next->eta_scale[i], depth);
    v->fate = none || !(max > 0.0f) ? VL_PATH_ABSORBED : VL_PATH_ROULETTE;
  }
  go_on(t, p->lane, order, count, next);
}

/* ---- media and subsurface materials ------------------------------------------------------ */

void vl_record_scattering(vlTracing *t, const vlPaths *p, uint32_t n) {
  for (uint32_t i = 0; i < n; i++) {
    vlPathVertex *v = last_vertex(t, p->lane[i]);
    if (!v)
      continue;
    v->bsdf = "henyey_greenstein";
    for (int c = 0; c < 4; c++) {
      v->throughput[c] = p->beta[c][i];
      v->factor[c] = 1.0f;
    }
  }
}

void vl_record_phase(vlTracing *t, uint32_t n, uint32_t depth, const vlPaths *p,
                     const uint32_t *kept, uint32_t count) {
  for (uint32_t i = 0; i < n; i++) {
    vlPathVertex *v = last_vertex(t, p->lane[i]);
    if (!v)
      continue;
    float max = largest_throughput(v);
    v->survival = vl_roulette_survival(max * p->eta_scale[i], depth);
    v->fate = max > 0.0f ? VL_PATH_ROULETTE : VL_PATH_ABSORBED;
  }
  go_on(t, p->lane, kept, count, p);
}

void vl_record_probes(vlTracing *t, uint32_t n, const vlPaths *p, const uint32_t *found) {
  for (uint32_t j = 0; j < n; j++) {
    vlPathVertex *v = last_vertex(t, p->lane[j]);
    if (v && !found[j])
      v->fate = VL_PATH_ABSORBED;
  }
}

void vl_record_exits(vlTracing *t, uint32_t n, const vlPaths *p, const vlHits *hits,
                     const vlSurface *f) {
  for (uint32_t i = 0; i < n; i++) {
    const vlPathVertex *entry = last_vertex(t, p->lane[i]);
    if (!entry)
      continue;
    const vlPathVertex before = *entry;
    vlPathVertex *v = new_vertex(t, p->lane[i]);
    if (!v)
      continue;
    vlVec3 from = vl_load3(before.position);
    vlVec3 at = vl_row3(&f->p, i), way = vl_sub(at, from);
    v->event = VL_PATH_EXIT;
    v->bounce = before.bounce;
    v->bsdf = "subsurface";
    put_ids(hits, i, v);
    vl_store3(v->position, at);
    v->distance = vl_length(way);
    if (v->distance > 0.0f)
      vl_store3(v->arrival, vl_mul(way, 1.0f / v->distance));
    vl_store3(v->normal, vl_row3(&f->g, i));
    vl_store3(v->shading, vl_row3(&f->n, i));
    v->uv[0] = f->u[i];
    v->uv[1] = f->v[i];
    for (int c = 0; c < 4; c++)
      v->throughput[c] = p->beta[c][i];
  }
}

void vl_record_left(vlTracing *t, uint32_t n, const vlPaths *p, const uint8_t *alive) {
  for (uint32_t i = 0; i < n; i++) {
    vlPathVertex *v = last_vertex(t, p->lane[i]);
    if (!v || !alive[i])
      continue;
    v->fate = VL_PATH_ON;
    v->pdf = p->pdf[i];
    vl_store3(v->direction, vl_row3(&p->d, i));
    for (int c = 0; c < 4; c++)
      v->factor[c] = v->throughput[c] > 0.0f ? p->beta[c][i] / v->throughput[c] : 0.0f;
  }
}
