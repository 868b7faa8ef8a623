/* trace/path.hot.c: the tracers. Path tracing with next-event estimation, multiple importance sampling (power
 * heuristic) and Russian roulette (pbrt book 13.4), bounce by bounce over a batch; raycast and ambient occlusion beside
 * it. */
#include "math/hash.h"
#include "trace/stages.h"

typedef struct Tracing {
  const vlWorld *world;
  const vlTraceDef *def;
  vlTraceScratch *s;
  vlTraceBatch *batch;
  const vlSamplerKernels *sampler;
  const vlBsdfKernels *bsdf;
} Tracing;

static inline float power_heuristic(float a, float b) {
  float a2 = a * a, b2 = b * b;
  return a2 < VL_INFINITY ? (a2 + b2 > 0.0f ? a2 / (a2 + b2) : 0.0f) : 1.0f;
}

static void add_radiance(vlTraceBatch *batch, uint32_t lane, const vlPaths *p, uint32_t i, const float radiance[4],
                         float weight) {
  for (int c = 0; c < 4; c++) batch->radiance[c][lane] += p->beta[c][i] * radiance[c] * weight;
}

/* ---- light that rays run into
 * -------------------------------------------------------------------------------------------- */

static void add_sky(Tracing *t, const vlPaths *p, uint32_t i) {
  const vlWorld *world = t->world;
  vlVec3 d = vl_vec3(p->dx[i], p->dy[i], p->dz[i]);
  float lambda[4] = {p->lambda[0][i], p->lambda[1][i], p->lambda[2][i], p->lambda[3][i]}, radiance[4];
  for (size_t k = 0; k < world->infinite_lights.count; k++) {
    uint32_t index = world->infinite_lights.items[k];
    const vlWorldLight *light = &world->lights.items[index];
    VL_HOT(vl_infinite_at)(world, light, d, lambda, radiance);
    float weight = 1.0f;
    if (!p->specular[i]) {
      float pdf = VL_HOT(vl_infinite_pdf)(world, light, d) *
                  vl_light_pmf(&world->tree, vl_vec3(p->ox[i], p->oy[i], p->oz[i]),
                               vl_vec3(p->from_nx[i], p->from_ny[i], p->from_nz[i]), index);
      weight = power_heuristic(p->pdf[i], pdf);
    }
    add_radiance(t->batch, p->lane[i], p, i, radiance, weight);
  }
}

static void add_glow(Tracing *t, const vlPaths *p, const vlHits *h, uint32_t i) {
  const vlWorld *world = t->world;
  uint32_t index = world->shapes.items[h->shape[i]].first_light + h->prim[i];
  const vlWorldLight *light = &world->lights.items[index];
  const vlEmitted *e = &world->emitted.items[light->emitted];
  vlVec3 o = vl_vec3(p->ox[i], p->oy[i], p->oz[i]), d = vl_vec3(p->dx[i], p->dy[i], p->dz[i]);
  vlPoint at = VL_HOT(vl_point_at)(world, o, d, h->shape[i], h->prim[i], h->instance[i], h->t[i]);
  if (!(vl_dot(d, at.g) < 0.0f) && !e->two_sided) return;
  float lambda[4] = {p->lambda[0][i], p->lambda[1][i], p->lambda[2][i], p->lambda[3][i]}, radiance[4];
  VL_HOT(vl_emitted_at)(world, e, lambda, at.u, 1.0f - at.v, false, radiance);
  float weight = 1.0f;
  if (!p->specular[i]) {
    vlVec3 from_n = vl_vec3(p->from_nx[i], p->from_ny[i], p->from_nz[i]);
    float pdf = VL_HOT(vl_area_pdf)(world, light, o, &at) * vl_light_pmf(&world->tree, o, from_n, index);
    weight = power_heuristic(p->pdf[i], pdf);
  }
  add_radiance(t->batch, p->lane[i], p, i, radiance, weight);
}

/* ---- hits
 * ------------------------------------------------------------------------------------------------------------------ */

/* The material a hit really has: mixes are decided by a hash of the ray, so that the choice needs no sampler dimension.
 */
static uint32_t resolve_material(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i) {
  uint32_t material = world->shapes.items[h->shape[i]].material;
  while (world->materials.items[material].kind == VL_MATERIAL_MIX) { /* parts come before: it ends */
    const vlWorldMaterial *m = &world->materials.items[material];
    vlVec3 o = vl_vec3(p->ox[i], p->oy[i], p->oz[i]), d = vl_vec3(p->dx[i], p->dy[i], p->dz[i]);
    vlPoint at = VL_HOT(vl_point_at)(world, o, d, h->shape[i], h->prim[i], h->instance[i], h->t[i]);
    float position[3] = {at.p.x, at.p.y, at.p.z};
    float amount = vl_texture_float_at(world, m->amount, at.u, at.v, position);
    uint32_t hash = vl_hash3(vl_float_bits(d.x), vl_float_bits(d.y), vl_float_bits(d.z));
    hash = vl_hash3(hash, vl_float_bits(at.p.x), vl_float_bits(at.p.y));
    hash = vl_hash3(hash, vl_float_bits(at.p.z), material);
    material = m->mix[vl_unit_float(hash) < amount ? 1 : 0];
  }
  return material;
}

/* Interface surfaces bend nothing: the same ray goes on behind them. It keeps its start, which the weights of multiple
 * importance sampling ask for, and its end. */
static void pass_interfaces(Tracing *t, vlPaths *p, vlHits *h, uint32_t i, const float *t_max) {
  const vlWorld *world = t->world;
  float t_min = 0;
  for (int step = 0; h->shape[i] != VL_NONE; step++) {
    if (world->materials.items[world->shapes.items[h->shape[i]].material].kind != VL_MATERIAL_INTERFACE) return;
    if (step == 1024) h->shape[i] = VL_NONE; /* no ray needs so many */
    if (h->shape[i] == VL_NONE) return;
    if (world->shapes.items[h->shape[i]].first_light != VL_NONE) add_glow(t, p, h, i);
    vlVec3 o = vl_vec3(p->ox[i], p->oy[i], p->oz[i]), d = vl_vec3(p->dx[i], p->dy[i], p->dz[i]);
    vlPoint at = VL_HOT(vl_point_at)(world, o, d, h->shape[i], h->prim[i], h->instance[i], h->t[i]);
    /* Past the surface by what its point may be wrong, along the ray; ever forward. */
    float margin = 2.0f * at.offset / vl_max(vl_abs(vl_dot(at.g, d)), 0.01f) + 0x1p-22f * vl_abs(at.t);
    t_min = vl_max(at.t, t_min) + vl_max(margin, 1e-30f);
    vlRays ray = {p->ox + i, p->oy + i, p->oz + i, p->dx + i, p->dy + i, p->dz + i, &t_min, t_max ? t_max + i : NULL};
    vl_accel_closest(world, 1, &ray, false, h->shape + i, h->prim + i, h->instance + i, h->t + i);
    t->batch->bounce_rays++;
  }
}

static void trace_rays(Tracing *t, uint32_t n, bool camera) {
  vlPaths *p = &t->s->a;
  vlHits *h = &t->s->hits_a;
  vlRays rays = {
      p->ox, p->oy, p->oz, p->dx, p->dy, p->dz, camera ? t->batch->t_min : NULL, camera ? t->batch->t_max : NULL};
  vl_accel_closest(t->world, n, &rays, camera, h->shape, h->prim, h->instance, h->t);
  if (!camera) t->batch->bounce_rays += n;
  for (uint32_t i = 0; i < n; i++) {
    if (h->shape[i] == VL_NONE) continue;
    if (t->world->has_interfaces) pass_interfaces(t, p, h, i, rays.t_max);
    if (h->shape[i] != VL_NONE) h->material[i] = resolve_material(t->world, p, h, i);
  }
}

/* Moves path order[k] of a to place k of b. */
static void permute_paths(const vlPaths *a, vlPaths *b, const uint32_t *order, uint32_t n) {
#define MOVE(field) \
  VL_SIMD           \
  for (uint32_t k = 0; k < n; k++) b->field[k] = a->field[order[k]]
  MOVE(ox);
  MOVE(oy);
  MOVE(oz);
  MOVE(dx);
  MOVE(dy);
  MOVE(dz);
  for (int c = 0; c < 4; c++) {
    MOVE(beta[c]);
    MOVE(lambda[c]);
  }
  MOVE(pdf);
  MOVE(from_nx);
  MOVE(from_ny);
  MOVE(from_nz);
  MOVE(eta_scale);
  MOVE(cone);
  MOVE(specular);
  MOVE(px);
  MOVE(py);
  MOVE(index);
  MOVE(lane);
}
static void permute_hits(const vlHits *a, vlHits *b, const uint32_t *order, uint32_t n) {
  MOVE(shape);
  MOVE(prim);
  MOVE(instance);
  MOVE(material);
  MOVE(t);
#undef MOVE
}

/* Paths of a that hit something go to b, those of one material together (and materials of one kind): a counting sort
 * that keeps the order of the tile. Returns how many; runs gets the material of each run's first lane. */
static uint32_t sort_by_material(Tracing *t, uint32_t n) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  uint32_t materials = (uint32_t)world->materials.count, count = 0;
  if (materials <= VL_BATCH) {
    uint32_t *start = s->slot;
    for (uint32_t m = 0; m <= materials && m < VL_BATCH; m++) start[m] = 0;
    uint32_t total = 0;
    for (uint32_t i = 0; i < n; i++)
      if (s->hits_a.shape[i] != VL_NONE) start[world->rank[s->hits_a.material[i]]]++;
    for (uint32_t m = 0; m < materials; m++) {
      uint32_t c = start[m];
      start[m] = total;
      total += c;
    }
    for (uint32_t i = 0; i < n; i++)
      if (s->hits_a.shape[i] != VL_NONE) s->order[start[world->rank[s->hits_a.material[i]]]++] = i;
    count = total;
  } else { /* more materials than lanes: insertion by rank, stable */
    for (uint32_t i = 0; i < n; i++) {
      if (s->hits_a.shape[i] == VL_NONE) continue;
      uint32_t k = count++, rank = world->rank[s->hits_a.material[i]];
      for (; k > 0 && world->rank[s->hits_a.material[s->order[k - 1]]] > rank; k--) s->order[k] = s->order[k - 1];
      s->order[k] = i;
    }
  }
  permute_paths(&s->a, &s->b, s->order, count);
  permute_hits(&s->hits_a, &s->hits_b, s->order, count);
  return count;
}

static vlBsdfKind bsdf_kind(vlMaterialKind kind) {
  switch (kind) {
    case VL_MATERIAL_CONDUCTOR: return VL_BSDF_CONDUCTOR;
    case VL_MATERIAL_DIELECTRIC: return VL_BSDF_DIELECTRIC;
    case VL_MATERIAL_THIN_DIELECTRIC: return VL_BSDF_THIN_DIELECTRIC;
    case VL_MATERIAL_COATED_DIFFUSE: return VL_BSDF_COATED_DIFFUSE;
    default: return VL_BSDF_DIFFUSE;
  }
}

/* Calls for each run of lanes that share a BSDF kind, with parameter rows shifted to the run. Runs need not start at a
 * multiple of the vector width: elements are computed one by one, whatever the loop's shape. */
typedef struct Run {
  vlBsdfKind kind;
  uint32_t first, last;
} Run;

static Run next_kind(const vlWorld *world, const vlHits *h, uint32_t first, uint32_t n) {
  Run r = {bsdf_kind(world->materials.items[h->material[first]].kind), first, first + 1};
  while (r.last < n && bsdf_kind(world->materials.items[h->material[r.last]].kind) == r.kind) r.last++;
  return r;
}

static vlBsdfParams params_of(vlShade *s, uint32_t first) {
  vlBsdfParams p;
  for (int c = 0; c < 4; c++) {
    p.reflectance[c] = s->reflectance[c] + first;
    p.eta[c] = s->eta[c] + first;
    p.k[c] = s->k[c] + first;
  }
  p.alpha_x = s->alpha_x + first;
  p.alpha_y = s->alpha_y + first;
  p.eta_s = s->eta_s + first;
  p.coat = s->coat + first;
  return p;
}

/* Surfaces, materials, frames of the n sorted hits. */
static void shade(Tracing *t, uint32_t n) {
  vlTraceScratch *s = t->s;
  VL_HOT(vl_stage_surface)(t->world, n, &s->b, &s->hits_b, &s->corners, &s->surface, t->def);
  for (uint32_t first = 0, last; first < n; first = last) {
    uint32_t material = s->hits_b.material[first];
    for (last = first + 1; last < n && s->hits_b.material[last] == material;) last++;
    VL_HOT(vl_stage_material)(t->world, first, last, material, s);
  }
  VL_HOT(vl_stage_frames)(n, &s->b, &s->surface, &s->shade);
}

/* ---- direct light
 * --------------------------------------------------------------------------------------------------------- */

/* Light samples, weighed by the BSDF, become shadow rays; those that arrive add their radiance. */
static void direct_light(Tracing *t, uint32_t n, uint32_t dimension) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  if (world->lights.count == 0) return;
  vlPaths *p = &s->b;
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LIGHT, sh->u0);
  t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LIGHT_UV, sh->u1, sh->u2);
  VL_HOT(vl_stage_lights)(world, n, p, &s->surface, sh->u0, sh->u1, sh->u2, &s->light);
  const vlLightSamples *l = &s->light;
  uint32_t padded = VL_PAD(n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float x = l->wx[i], y = l->wy[i], z = l->wz[i];
    sh->wi[0][i] = x * sh->tx[i] + y * sh->ty[i] + z * sh->tz[i];
    sh->wi[1][i] = x * sh->bx[i] + y * sh->by[i] + z * sh->bz[i];
    sh->wi[2][i] = x * s->surface.nx[i] + y * s->surface.ny[i] + z * s->surface.nz[i];
  }
  for (uint32_t first = 0; first < n;) {
    Run r = next_kind(world, &s->hits_b, first, n);
    vlBsdfParams params = params_of(sh, first);
    vlBsdfDirections wo = {sh->wo[0] + first, sh->wo[1] + first, sh->wo[2] + first};
    vlBsdfDirections wi = {sh->wi[0] + first, sh->wi[1] + first, sh->wi[2] + first};
    float *const value[4] = {sh->value[0] + first, sh->value[1] + first, sh->value[2] + first, sh->value[3] + first};
    t->bsdf->eval(r.kind, r.last - first, &params, wo, wi, value, sh->pdf + first);
    first = r.last;
  }
  vlShadowRays *q = &s->shadow;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!(l->pdf[i] > 0.0f)) continue;
    float sum = sh->value[0][i] + sh->value[1][i] + sh->value[2][i] + sh->value[3][i];
    if (!(sum > 0.0f) && sum == sum) continue;
    float weight = l->delta[i] ? 1.0f : power_heuristic(l->pdf[i], sh->pdf[i]);
    vlVec3 at = vl_vec3(s->surface.px[i], s->surface.py[i], s->surface.pz[i]);
    vlVec3 g = vl_vec3(s->surface.gx[i], s->surface.gy[i], s->surface.gz[i]), w = vl_vec3(l->wx[i], l->wy[i], l->wz[i]);
    vlVec3 o = vl_offset_origin(at, g, s->surface.offset[i], w);
    vlVec3 d = l->distant[i] ? w : vl_vec3(l->tx[i] - o.x, l->ty[i] - o.y, l->tz[i] - o.z);
    q->ox[count] = o.x, q->oy[count] = o.y, q->oz[count] = o.z;
    q->dx[count] = d.x, q->dy[count] = d.y, q->dz[count] = d.z;
    q->t_max[count] = l->distant[i] ? VL_INFINITY : VL_ONE_MINUS_EPSILON;
    for (int c = 0; c < 4; c++) q->radiance[c][count] = p->beta[c][i] * sh->value[c][i] * l->radiance[c][i] * weight;
    q->lane[count++] = p->lane[i];
  }
  vlRays rays = {q->ox, q->oy, q->oz, q->dx, q->dy, q->dz, NULL, q->t_max};
  vl_accel_occluded(world, count, &rays, q->occluded);
  t->batch->shadow_rays += count;
  for (uint32_t k = 0; k < count; k++)
    if (!q->occluded[k])
      for (int c = 0; c < 4; c++) t->batch->radiance[c][q->lane[k]] += q->radiance[c][k];
}

/* ---- the next direction
 * ------------------------------------------------------------------------------------------------------ */

/* Samples the BSDFs of the n lanes of b and writes the paths that go on into a. Returns how many. */
static uint32_t scatter(Tracing *t, uint32_t n, uint32_t depth, uint32_t dimension) {
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  vlPaths *p = &s->b;
  const vlSurface *f = &s->surface;
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_LOBE, sh->u0);
  t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_BSDF_UV, sh->u1, sh->u2);
  for (uint32_t first = 0; first < n;) {
    Run r = next_kind(t->world, &s->hits_b, first, n);
    vlBsdfParams params = params_of(sh, first);
    vlBsdfDirections wo = {sh->wo[0] + first, sh->wo[1] + first, sh->wo[2] + first};
    vlBsdfDirections wi = {sh->wi[0] + first, sh->wi[1] + first, sh->wi[2] + first};
    float *const weight[4] = {sh->value[0] + first, sh->value[1] + first, sh->value[2] + first, sh->value[3] + first};
    t->bsdf->sample(r.kind, r.last - first, &params, wo, sh->u0 + first, sh->u1 + first, sh->u2 + first, wi, weight,
                    sh->pdf + first, sh->flags + first, sh->eta_scale + first);
    first = r.last;
  }
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_ROULETTE, sh->u0);
  uint32_t padded = VL_PAD(n);
  uint32_t *alive = s->slot;
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float x = sh->wi[0][i], y = sh->wi[1][i], z = sh->wi[2][i];
    vlVec3 w = vl_vec3(x * sh->tx[i] + y * sh->bx[i] + z * f->nx[i], x * sh->ty[i] + y * sh->by[i] + z * f->ny[i],
                       x * sh->tz[i] + y * sh->bz[i] + z * f->nz[i]);
    w = vl_normalize(w);
    vlVec3 o =
        vl_offset_origin(vl_vec3(f->px[i], f->py[i], f->pz[i]), vl_vec3(f->gx[i], f->gy[i], f->gz[i]), f->offset[i], w);
    float b0 = p->beta[0][i] * sh->value[0][i], b1 = p->beta[1][i] * sh->value[1][i];
    float b2 = p->beta[2][i] * sh->value[2][i], b3 = p->beta[3][i] * sh->value[3][i];
    float eta = p->eta_scale[i] * sh->eta_scale[i];
    float most = vl_max(vl_max(b0, b1), vl_max(b2, b3));
    /* Roulette from the second bounce on, by what the path carries (times the squeezing of solid angles by refraction).
     */
    float carried = most * eta;
    float survive = depth > 1 && carried < 1.0f ? carried : 1.0f;
    uint32_t lives = most > 0.0f && !(sh->flags[i] & VL_SAMPLED_NONE) && sh->u0[i] < survive ? 1 : 0;
    float inv = survive > 0.0f ? 1.0f / survive : 0.0f;
    alive[i] = lives;
    p->ox[i] = o.x, p->oy[i] = o.y, p->oz[i] = o.z;
    p->dx[i] = w.x, p->dy[i] = w.y, p->dz[i] = w.z;
    p->beta[0][i] = b0 * inv, p->beta[1][i] = b1 * inv, p->beta[2][i] = b2 * inv, p->beta[3][i] = b3 * inv;
    p->pdf[i] = sh->pdf[i];
    p->specular[i] = sh->flags[i] & VL_SAMPLED_SPECULAR;
    p->eta_scale[i] = eta;
    p->cone[i] = f->width[i];
    p->from_nx[i] = f->nx[i], p->from_ny[i] = f->ny[i], p->from_nz[i] = f->nz[i];
  }
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    s->order[count] = i;
    count += alive[i];
  }
  permute_paths(p, &s->a, s->order, count);
  return count;
}

/* ---- tracers
 * --------------------------------------------------------------------------------------------------------------------
 */

static void start_paths(Tracing *t) {
  vlTraceBatch *b = t->batch;
  vlPaths *p = &t->s->a;
  uint32_t padded = VL_PAD(b->n);
  if (b->lambda[0]) {
    t->sampler->get_1d(t->def->sampler, b->n, b->px, b->py, b->index, VL_DIM_WAVELENGTH, t->s->shade.u0);
    vl_color_kernels(t->def->isa)->visible_wavelengths(b->n, t->s->shade.u0, b->lambda, b->inv_pdf);
  }
  for (uint32_t i = 0; i < padded; i++) {
    p->ox[i] = b->ox[i], p->oy[i] = b->oy[i], p->oz[i] = b->oz[i];
    p->dx[i] = b->dx[i], p->dy[i] = b->dy[i], p->dz[i] = b->dz[i];
    p->pdf[i] = 1.0f;
    p->from_nx[i] = p->from_ny[i] = p->from_nz[i] = 0.0f;
    p->eta_scale[i] = 1.0f;
    p->cone[i] = t->def->pixel_width;
    p->specular[i] = 1;
    p->px[i] = b->px[i], p->py[i] = b->py[i], p->index[i] = b->index[i];
    p->lane[i] = i;
  }
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < padded; i++) {
      p->beta[c][i] = 1.0f;
      p->lambda[c][i] = b->lambda[c] ? b->lambda[c][i] : 0.0f;
      b->radiance[c][i] = 0.0f;
    }
}

static void set_alpha(Tracing *t) {
  for (uint32_t i = 0; i < t->batch->n; i++) t->batch->alpha[i] = t->s->hits_a.shape[i] == VL_NONE ? 0.0f : 1.0f;
}

static void path_tracer(Tracing *t) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  uint32_t n = t->batch->n;
  for (uint32_t depth = 0; n > 0; depth++) {
    trace_rays(t, n, depth == 0);
    if (depth == 0) set_alpha(t);
    for (uint32_t i = 0; i < n; i++) {
      if (s->hits_a.shape[i] == VL_NONE)
        add_sky(t, &s->a, i);
      else if (world->shapes.items[s->hits_a.shape[i]].first_light != VL_NONE)
        add_glow(t, &s->a, &s->hits_a, i);
    }
    if (depth >= t->def->max_depth) break;
    n = sort_by_material(t, n);
    if (n == 0) break;
    uint32_t dimension = VL_DIM_BOUNCE + depth * VL_DIM_STRIDE;
    shade(t, n);
    direct_light(t, n, dimension);
    n = scatter(t, n, depth + 1, dimension);
  }
}

/* What the eye's ray meets first: emission where it glows, else reflectance times the cosine. */
static void raycast_tracer(Tracing *t) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  uint32_t n = t->batch->n;
  trace_rays(t, n, true);
  set_alpha(t);
  for (uint32_t i = 0; i < n; i++) {
    if (s->hits_a.shape[i] == VL_NONE)
      add_sky(t, &s->a, i);
    else if (world->shapes.items[s->hits_a.shape[i]].first_light != VL_NONE)
      add_glow(t, &s->a, &s->hits_a, i);
  }
  n = sort_by_material(t, n);
  shade(t, n);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = s->b.lane[i];
    const vlWorldMaterial *m = &world->materials.items[s->hits_b.material[i]];
    if (world->shapes.items[s->hits_b.shape[i]].first_light != VL_NONE) continue;
    float lambda[4] = {s->b.lambda[0][i], s->b.lambda[1][i], s->b.lambda[2][i], s->b.lambda[3][i]};
    for (int c = 0; c < 4; c++) {
      float reflectance = m->reflectance >= 0 ? s->shade.reflectance[c][i] : 0.8f;
      float cosine = vl_abs(s->shade.wo[2][i]);
      t->batch->radiance[c][lane] += reflectance * cosine * vl_spectral_at(&world->white, c, lambda[c]);
    }
  }
}

/* How open the sky is round each point (pbrt's ambient occlusion): one ray a sample, white where it goes free. */
static void ambient_occlusion_tracer(Tracing *t) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  uint32_t n = t->batch->n;
  trace_rays(t, n, true);
  set_alpha(t);
  n = sort_by_material(t, n);
  shade(t, n);
  t->sampler->get_2d(t->def->sampler, n, s->b.px, s->b.py, s->b.index, VL_DIM_BOUNCE + VL_DIM_BSDF_UV, sh->u1, sh->u2);
  vlShadowRays *q = &s->shadow;
  for (uint32_t i = 0; i < n; i++) {
    vlVec3 nn = vl_vec3(s->surface.gx[i], s->surface.gy[i], s->surface.gz[i]); /* of the true surface, as pbrt's */
    vlVec3 d = vl_vec3(s->b.dx[i], s->b.dy[i], s->b.dz[i]);
    if (vl_dot(nn, d) > 0.0f) nn = vl_neg(nn);
    bool cosine = t->def->ao_cosine;
    float z = cosine ? __builtin_sqrtf(vl_max(0.0f, 1.0f - sh->u1[i])) : sh->u1[i];
    float r = __builtin_sqrtf(vl_max(0.0f, 1.0f - z * z));
    vlSinCos phi = vl_sincos_turn(sh->u2[i]);
    vlVec3 w = vl_from_local(vl_frame_from_z(nn), vl_vec3(r * phi.cos, r * phi.sin, z));
    vlVec3 o = vl_offset_origin(vl_vec3(s->surface.px[i], s->surface.py[i], s->surface.pz[i]),
                                vl_vec3(s->surface.gx[i], s->surface.gy[i], s->surface.gz[i]), s->surface.offset[i], w);
    float lambda[4] = {s->b.lambda[0][i], s->b.lambda[1][i], s->b.lambda[2][i], s->b.lambda[3][i]};
    q->ox[i] = o.x, q->oy[i] = o.y, q->oz[i] = o.z, q->dx[i] = w.x, q->dy[i] = w.y, q->dz[i] = w.z;
    q->t_max[i] = t->def->ao_distance;
    /* Uniform directions: cos / pi over the density 1 / (2 pi). */
    for (int c = 0; c < 4; c++)
      q->radiance[c][i] = (cosine ? 1.0f : 2.0f * z) * vl_spectral_at(&world->white, c, lambda[c]);
  }
  vlRays rays = {q->ox, q->oy, q->oz, q->dx, q->dy, q->dz, NULL, q->t_max};
  vl_accel_occluded(world, n, &rays, q->occluded);
  t->batch->shadow_rays += n;
  for (uint32_t i = 0; i < n; i++)
    if (!q->occluded[i])
      for (int c = 0; c < 4; c++) t->batch->radiance[c][s->b.lane[i]] += q->radiance[c][i];
}

static void trace(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch, vlTraceBatch *batch) {
  Tracing t = {world, def, scratch, batch, vl_sampler_kernels(def->isa), vl_bsdf_kernels(def->isa)};
  start_paths(&t);
  switch (def->tracer) {
    case VL_TRACER_RAYCAST: raycast_tracer(&t); break;
    case VL_TRACER_AMBIENT_OCCLUSION: ambient_occlusion_tracer(&t); break;
    default: path_tracer(&t); break;
  }
}

const vlTraceKernels VL_HOT(vl_trace_kernels) = {trace};
