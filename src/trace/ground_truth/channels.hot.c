/* trace/ground_truth/channels.hot.c: ground truth for a batch of rays: ids, distance in double,
 * normals, albedo.
 *
 *   exact rays -> rounded to float -> ids (Embree) -> distance in double, from the exact ray
 *     and the surface itself
 *   ids -> the tracers' stages: normals, uv, textures (64 wavelengths)
 *
 * Hits are the same as those of the tracers: rays pass through interfaces, and a hash of the
 * ray decides mixed materials. */
#include <string.h>

#include "material/bssrdf.h"
#include "material/measured_lookup.h"
#include "trace/ground_truth/exact.h"
#include "trace/ground_truth/scratch.h"
#include "velo/schema.h"

/* Distance in double of hit i, which is that of the batch's lane. t: the distance in float. */
static double exact_distance(const vlWorld *world, const vlGroundTruthBatch *batch,
                             uint32_t lane, const vlHits *h, uint32_t i, double t) {
  const double o[3] = {batch->o[0][lane], batch->o[1][lane], batch->o[2][lane]};
  const double d[3] = {batch->d[0][lane], batch->d[1][lane], batch->d[2][lane]};
  return vl_exact_distance(world, batch->time[lane], o, d, h->shape[i], h->prim[i],
                           h->instance[i], h->t[i], t);
}

/* ---- albedo ------------------------------------------------------------------------------ */

/* Keeps the shading frames; back: restores them. Bump and normal maps change them. */
static void keep_frames(vlGroundTruthScratch *s, uint32_t n, bool back) {
  vlSurface *f = &s->trace.at.surface;
  float *rows[6] = {f->n.x, f->n.y, f->n.z, f->dpdu.x, f->dpdu.y, f->dpdu.z};
  for (int k = 0; k < 6; k++) {
    const float *from = back ? s->kept[k] : rows[k];
    memcpy(back ? rows[k] : s->kept[k], from, n * sizeof *from);
  }
}

/* The end of the run of hits from `first` that have the same material. */
static uint32_t run_end(const uint32_t *material, uint32_t first, uint32_t n) {
  uint32_t last = first + 1;
  while (last < n && material[last] == material[first])
    last++;
  return last;
}

/* Albedo of one lane at channel c, of a material without a reflectance. For conductors and
 * measured materials it is the reflectance at normal incidence, for subsurface materials the
 * diffuse reflectance, and for materials with specular transmission 1. */
static inline float albedo_at(const vlWorldMaterial *m, const vlShade *sh, float lambda, int c,
                              uint32_t i) {
  if (m->measured)
    return vl_measured_albedo(m->measured, c, lambda);
  if (m->subsurface) {
    vlSpline albedo = vl_bssrdf_albedo(m->subsurface->table, sh->own[VL_S_ALBEDO + c][i]);
    return vl_bssrdf_effective(m->subsurface->table, &albedo);
  }
  if (!(m->traits & VL_MATERIAL_METAL))
    return 1.0f;
  float n = sh->eta[c][i], k = sh->k[c][i];
  /* Fresnel's equations at normal incidence */
  return ((n - 1.0f) * (n - 1.0f) + k * k) / ((n + 1.0f) * (n + 1.0f) + k * k);
}

/* Adds to sum[] the albedo of the lanes [first, last), which have one material, at the four
 * wavelengths of a set. */
static void add_albedo(const vlWorldMaterial *m, const vlGroundTruthDef *def, uint32_t set,
                       uint32_t first, uint32_t last, const vlTraceScratch *s,
                       float sum[3][VL_ROW_SIZE]) {
  float values[VL_ROW_SIZE];
  const bool textured = m->reflectance >= 0;
  for (int c = 0; c < 4; c++) {
    const float *albedo = textured ? s->at.shade.reflectance[c] : values;
    for (uint32_t i = first; !textured && i < last; i++)
      values[i] = albedo_at(m, &s->at.shade, s->at.paths.lambda[c][i], c, i);
    for (int k = 0; k < 3; k++) {
      float w = def->weight[set][c][k], *to = sum[k];
      VL_SIMD for (uint32_t i = first; i < last; i++) to[i] += albedo[i] * w;
    }
  }
}

/* The same for all hits. */
static void add_albedos(const vlWorld *world, const vlGroundTruthDef *def, uint32_t set,
                        uint32_t n, const vlTraceScratch *s, float sum[3][VL_ROW_SIZE]) {
  const uint32_t *material = s->at.hits.material;
  for (uint32_t first = 0, last; first < n; first = last) {
    last = run_end(material, first, n);
    add_albedo(&world->materials.items[material[first]], def, set, first, last, s, sum);
  }
}

/* Evaluates the hits' materials at each set of wavelengths: shading normals and albedo. */
static void shade(const vlWorld *world, const vlGroundTruthDef *def, uint32_t n,
                  vlGroundTruthScratch *scratch, vlGroundTruthBatch *batch) {
  vlTraceScratch *s = &scratch->trace;
  memset(scratch->albedo, 0, sizeof scratch->albedo);
  keep_frames(scratch, n, false);
  for (uint32_t set = 0; set < def->sets; set++) {
    if (set)
      keep_frames(scratch, n, true);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = 0; i < n; i++) {
        s->at.paths.lambda[c][i] = def->lambda[set][c];
        s->at.paths.beta[c][i] = 1.0f;
      }
    for (uint32_t first = 0, last; first < n; first = last) {
      last = run_end(s->at.hits.material, first, n);
      vl_stage_material(world, first, last, s->at.hits.material[first], &s->at, s);
    }
    if (def->albedo)
      add_albedos(world, def, set, n, s, scratch->albedo);
  }
  for (int k = 0; k < 3; k++)
    for (uint32_t i = 0; i < n; i++)
      batch->albedo[k][s->at.paths.lane[i]] = scratch->albedo[k][i];
}

/* ---- the batch --------------------------------------------------------------------------- */

/* Fills n elements of a row with a value. */
static void fill(float *row, uint32_t n, float value) {
  VL_SIMD for (uint32_t i = 0; i < n; i++) row[i] = value;
}

/* The rays, rounded to float, and the values of pixels that show nothing. */
static void start(const vlGroundTruthDef *def, vlGroundTruthBatch *batch, vlPaths *p) {
  uint32_t n = batch->n;
  float *const origin[3] = {p->o.x, p->o.y, p->o.z}, *const direction[3] = {p->d.x, p->d.y,
                                                                            p->d.z};
  for (int k = 0; k < 3; k++) {
    const double *o = batch->o[k], *d = batch->d[k];
    float *to_o = origin[k], *to_d = direction[k];
    VL_SIMD for (uint32_t i = 0; i < n; i++) {
      to_o[i] = (float)o[i];
      to_d[i] = (float)d[i];
    }
    fill(batch->n_shading[k], n, 0.0f);
    fill(batch->n_geometric[k], n, 0.0f);
    fill(batch->albedo[k], n, 0.0f);
  }
  fill(p->cone, n, def->pixel_width);
  fill(p->spread, n, def->pixel_spread);
  for (int c = 0; c < 4; c++) {
    fill(p->lambda[c], n, def->lambda[0][c]);
    fill(p->beta[c], n, 0.0f);
  }
  fill(batch->uv[0], n, 0.0f);
  fill(batch->uv[1], n, 0.0f);
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    p->lane[i] = i;
    p->specular[i] = 1;
  }
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    batch->distance[i] = VL_INFINITY;
  }
  VL_SIMD for (uint32_t i = 0; i < n; i++) {
    batch->object[i] = batch->material[i] = batch->instance[i] = batch->primitive[i] = 0;
  }
}

/* Copies the elements order[0] to order[n - 1] of a row. */
static void take(const float *from, const uint32_t *order, uint32_t n, float *to) {
  VL_SIMD for (uint32_t k = 0; k < n; k++) to[k] = from[order[k]];
}
static void take_ids(const uint32_t *from, const uint32_t *order, uint32_t n, uint32_t *to) {
  VL_SIMD for (uint32_t k = 0; k < n; k++) to[k] = from[order[k]];
}

/* Copies n lanes of what `start` sets of paths. */
static void take_paths(const vlPaths *a, const uint32_t *order, uint32_t n, vlPaths *b) {
  take(a->o.x, order, n, b->o.x);
  take(a->o.y, order, n, b->o.y);
  take(a->o.z, order, n, b->o.z);
  take(a->d.x, order, n, b->d.x);
  take(a->d.y, order, n, b->d.y);
  take(a->d.z, order, n, b->d.z);
  for (int c = 0; c < 4; c++) {
    take(a->beta[c], order, n, b->beta[c]);
    take(a->lambda[c], order, n, b->lambda[c]);
  }
  take(a->cone, order, n, b->cone);
  take(a->spread, order, n, b->spread);
  take_ids(a->specular, order, n, b->specular);
  take_ids(a->lane, order, n, b->lane);
}

/* Copies those lanes of the rays that have a hit to s->at, without gaps. Returns their
 * number. */
static uint32_t gather_hits(const vlWorld *world, uint32_t n, vlTraceScratch *s,
                            vlGroundTruthBatch *batch) {
  const vlHits *h = &s->hits;
  vlHits *g = &s->at.hits;
  uint32_t count = 0, order[VL_ROW_SIZE];
  for (uint32_t i = 0; i < n; i++) {
    order[count] = i;
    count += h->shape[i] != VL_NONE;
  }
  take_paths(&s->rays, order, count, &s->at.paths);
  take_ids(h->shape, order, count, g->shape);
  take_ids(h->prim, order, count, g->prim);
  take_ids(h->instance, order, count, g->instance);
  take_ids(h->material, order, count, g->material);
  take(h->t, order, count, g->t);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = order[k];
    batch->object[i] = g->shape[k] + 1;
    batch->material[i] = world->shapes.items[g->shape[k]].material + 1;
    batch->instance[i] = g->instance[k] == VL_NONE ? 0 : g->instance[k] + 1;
    batch->primitive[i] = g->prim[k] + 1;
  }
  return count;
}

/* Copies a value of each of the n paths to its lane of the batch. */
static void give(const float *from, const uint32_t *lane, uint32_t n, float *to) {
  for (uint32_t i = 0; i < n; i++)
    to[lane[i]] = from[i];
}

/* Finds what the first n rays of scratch->trace.rays hit. */
static void find_hits(const vlWorld *world, const vlGroundTruthDef *def, uint32_t n,
                      const float *t_min, const float *t_max, vlGroundTruthScratch *scratch) {
  vlTraceScratch *s = &scratch->trace;
  vlTraceBatch rays = {.n = n, .rays = {.t_min = t_min, .t_max = t_max}};
  for (int c = 0; c < 4; c++)
    rays.radiance[c] = scratch->light[c]; /* not used */
  const vlTraceDef trace_def = {
      .isa = def->isa, .pixel_spread = def->pixel_spread, .pixel_width = def->pixel_width};
  vlTracing tracing = {.world = world, .def = &trace_def, .s = s, .batch = &rays};
  vl_stage_hits(&tracing, n, true, NULL, &s->rays, &s->hits);
}

static void trace(const vlWorld *world, const vlGroundTruthDef *def,
                  vlGroundTruthScratch *scratch, vlGroundTruthBatch *batch) {
  vlTraceScratch *s = &scratch->trace;
  start(def, batch, &s->rays);
  s->rays.time = s->at.paths.time = world->moves ? scratch->time : NULL;
  for (uint32_t i = 0; world->moves && i < VL_ROW_SIZE; i++)
    scratch->time[i] = batch->time[i < batch->n ? i : 0];
  if (batch->n == 0)
    return;
  find_hits(world, def, batch->n, batch->t_min, batch->t_max, scratch);
  uint32_t n = gather_hits(world, batch->n, s, batch);
  if (n == 0)
    return;
  vl_stage_surface(world, n, &s->at.paths, &s->at.hits, &s->corners, &s->at.surface);
  if (def->shading || def->albedo)
    shade(world, def, n, scratch, batch);
  const vlSurface *f = &s->at.surface;
  const uint32_t *lane = s->at.paths.lane;
  for (uint32_t i = 0; i < n; i++)
    batch->distance[lane[i]] =
        def->coarse ? f->t[i] : exact_distance(world, batch, lane[i], &s->at.hits, i, f->t[i]);
  give(f->n.x, lane, n, batch->n_shading[0]);
  give(f->n.y, lane, n, batch->n_shading[1]);
  give(f->n.z, lane, n, batch->n_shading[2]);
  if (def->coarse)
    return;
  give(f->g.x, lane, n, batch->n_geometric[0]);
  give(f->g.y, lane, n, batch->n_geometric[1]);
  give(f->g.z, lane, n, batch->n_geometric[2]);
  give(f->u, lane, n, batch->uv[0]);
  give(f->v, lane, n, batch->uv[1]);
}

/* ---- ids only ---------------------------------------------------------------------------- */

static void hits(const vlWorld *world, const vlGroundTruthDef *def,
                 vlGroundTruthScratch *scratch, const vlGroundTruthHits *to) {
  vlTraceScratch *s = &scratch->trace;
  vlPaths *p = &s->rays;
  uint32_t n = to->n;
  if (n == 0)
    return;
  for (uint32_t i = 0; i < n; i++) {
    vl_set_row3(&p->o, i, vl_ray_origin(&to->rays, i));
    vl_set_row3(&p->d, i, vl_ray_direction(&to->rays, i));
    p->cone[i] = def->pixel_width;
    p->spread[i] = def->pixel_spread;
    p->specular[i] = 1;
    p->lane[i] = i;
    for (int c = 0; c < 4; c++) {
      p->lambda[c][i] = def->lambda[0][c];
      p->beta[c][i] = 0.0f;
    }
  }
  p->time = to->rays.time;
  find_hits(world, def, n, to->rays.t_min, to->rays.t_max, scratch);
  const vlHits *h = &s->hits;
  for (uint32_t i = 0; i < n; i++) {
    bool hit = h->shape[i] != VL_NONE;
    to->object[i] = hit ? h->shape[i] + 1 : 0;
    to->material[i] = hit ? world->shapes.items[h->shape[i]].material + 1 : 0;
    to->instance[i] = hit && h->instance[i] != VL_NONE ? h->instance[i] + 1 : 0;
    if (!to->distance)
      continue;
    to->distance[i] = VL_INFINITY;
    if (!hit)
      continue;
    to->distance[i] = vl_hit_point(world, p, h, i).t;
  }
}

/* The objects along a lane's ray, each once, nearest first. Advances past each surface by the
 * error bound of the hit point, as hits.hot.c does at interfaces. */
static void layers(const vlWorld *world, const vlGroundTruthBatch *batch, uint32_t lane,
                   vlGroundTruthLayers *to) {
  float t_min = batch->t_min[lane];
  vlVec3 o = {(float)batch->o[0][lane], (float)batch->o[1][lane], (float)batch->o[2][lane]};
  vlVec3 d = {(float)batch->d[0][lane], (float)batch->d[1][lane], (float)batch->d[2][lane]};
  to->count = 0;
  for (int step = 0; step < VL_GROUND_TRUTH_LAYERS; step++) {
    uint32_t shape, prim, instance;
    float t;
    vlRays ray = vl_one_ray(&o, &d, &t_min, batch->t_max + lane, &batch->time[lane]);
    vl_accel_closest(world, 1, &ray, false, &shape, &prim, &instance, &t);
    if (shape == VL_NONE)
      return;
    vlPoint at = vl_point_at_time(world, batch->time[lane], o, d, shape, prim, instance, t);
    uint32_t object = shape + 1;
    uint32_t placed = instance == VL_NONE ? 0 : instance + 1;
    uint32_t k = 0;
    while (k < to->count && (to->object[k] != object || to->instance[k] != placed))
      k++;
    const vlWorldMaterial *m = &world->materials.items[world->shapes.items[shape].material];
    bool seen = !(m->traits & VL_MATERIAL_ABSENT);
    if (k == to->count && seen) {
      to->object[k] = object;
      to->instance[k] = placed;
      to->count++;
    }
    t_min = vl_past_surface(&at, d, t_min);
  }
}

const vlGroundTruthKernels vl_ground_truth_kernel_table = {trace, hits, layers};
