/* trace/cast/cast.hot.c: hits of the caller's own rays. The ids come from the accelerator, as
 * for camera rays; then only what is wanted is computed, for all hits of the batch. */
#include "trace/cast/cast.h"

#include "trace/cast/rays.h"
#include "trace/ground_truth/exact.h"
#include "trace/stages.h"
#include "velo/schema.h"

/* ---- hits -------------------------------------------------------------------------------- */

static vlRays rays_of(const vlWorld *world, const vlPaths *p, const vlCastBatch *b) {
  return vl_rays_of(&p->o, &p->d, 0, b->t_min, b->t_max, world->moves ? b->time : NULL);
}

static bool is_interface(const vlWorld *world, uint32_t shape) {
  uint32_t material = world->shapes.items[shape].material;
  return (world->materials.items[material].traits & VL_MATERIAL_ABSENT) != 0;
}

/* Finds the hit of ray i behind the interfaces that it meets first. */
static void pass_interfaces(const vlWorld *world, const vlPaths *p, const vlCastBatch *b,
                            vlHits *h, uint32_t i) {
  enum { MAX_PASSED = 1024 }; /* no ray crosses so many */
  float t_min = b->t_min[i];
  vlVec3 o = vl_row3(&p->o, i), d = vl_row3(&p->d, i);
  for (int step = 0; h->shape[i] != VL_NONE && is_interface(world, h->shape[i]); step++) {
    if (step == MAX_PASSED) {
      h->shape[i] = VL_NONE;
      return;
    }
    vlPoint at = vl_point_at_time(world, b->time[i], o, d, h->shape[i], h->prim[i],
                                  h->instance[i], h->t[i]);
    t_min = vl_past_surface(&at, d, t_min);
    vlRays ray = vl_rays_of(&p->o, &p->d, i, &t_min, b->t_max + i, b->time + i);
    vl_accel_closest(world, 1, &ray, false, h->shape + i, h->prim + i, h->instance + i,
                     h->t + i);
  }
}

/* Copies the lanes that have a hit to `at`, without gaps. Their paths' lanes are those of the
 * batch. */
static uint32_t gather(uint32_t n, const vlPaths *p, const vlHits *h, vlVertices *at) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (h->shape[i] == VL_NONE)
      continue;
    uint32_t k = count++;
    vl_set_row3(&at->paths.o, k, vl_row3(&p->o, i));
    vl_set_row3(&at->paths.d, k, vl_row3(&p->d, i));
    at->paths.lane[k] = i;
    vl_hit_copy(h, i, &at->hits, k);
  }
  return count;
}

/* Shading normals as the channel N has them: with the bump and normal maps of the material. A
 * ray has no footprint: maps are read at their finest level. */
static void shade(const vlWorld *world, uint32_t n, vlTraceScratch *s) {
  vlVertices *at = &s->at;
  for (uint32_t i = 0; i < n; i++) {
    at->paths.cone[i] = at->paths.spread[i] = 0.0f;
    at->paths.specular[i] = 1;
    for (int c = 0; c < 4; c++) {
      at->paths.lambda[c][i] = world->def.color == VL_COLOR_RGB ? 0.0f : 550.0f;
      at->paths.beta[c][i] = 1.0f;
    }
    at->hits.material[i] = vl_hit_material(world, &at->paths, &at->hits, i);
  }
  for (uint32_t first = 0, last; first < n; first = last) {
    uint32_t material = at->hits.material[first];
    for (last = first + 1; last < n && at->hits.material[last] == material;)
      last++;
    vl_stage_material(world, first, last, material, at, s);
  }
}

static void put_surface(uint32_t n, const vlVertices *at, uint32_t wanted, vlCastBatch *b) {
  const vlSurface *f = &at->surface;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = at->paths.lane[i];
    b->normal[0][lane] = f->g.x[i];
    b->normal[1][lane] = f->g.y[i];
    b->normal[2][lane] = f->g.z[i];
    b->shading[0][lane] = f->n.x[i];
    b->shading[1][lane] = f->n.y[i];
    b->shading[2][lane] = f->n.z[i];
    b->uv[0][lane] = f->u[i];
    b->uv[1][lane] = f->v[i];
    if (!(wanted & VL_CAST_ON))
      continue;
    vlVec3 g = vl_row3(&f->g, i), d = vl_row3(&at->paths.d, i);
    b->t_min[lane] = vl_past_crossing(f->t[i], g, f->offset[i], d, b->t_min[lane]);
  }
}

/* ---- distances --------------------------------------------------------------------------- */

/* Large meshes are not in the cache: what later lanes read is prefetched, first the indices,
 * then the corners. */
enum { INDEX_AHEAD = 48, CORNER_AHEAD = 16, LARGE_MESH = 4096 };

VL_INLINE void put_corner(const float *positions, uint32_t vertex, float (*rows)[VL_ROW_SIZE],
                          uint32_t i) {
  const float *x = positions + 3 * (size_t)vertex;
  rows[0][i] = x[0];
  rows[1][i] = x[1];
  rows[2][i] = x[2];
}

/* Whether a hit is on a triangle at rest outside of instances, as most are. */
static inline bool is_plain(const vlWorld *world, const vlHits *h, uint32_t i) {
  const vlWorldShape *s = &world->shapes.items[h->shape[i]];
  return h->instance[i] == VL_NONE && s->triangles && s->steps <= 1;
}

/* Gathers the corners of the plain hits first to last - 1 on one shape. */
static void gather_run(const vlWorldShape *s, const uint32_t *prim, uint32_t first,
                       uint32_t last, vlCorners *c) {
  const float *positions = s->positions;
  const uint32_t *indices = s->indices;
  bool large = s->faces >= LARGE_MESH;
  for (uint32_t i = first; i < last; i++) {
    if (large && i + INDEX_AHEAD < last)
      __builtin_prefetch(indices + 3 * (size_t)prim[i + INDEX_AHEAD]);
    if (large && i + CORNER_AHEAD < last) {
      const uint32_t *later = indices + 3 * (size_t)prim[i + CORNER_AHEAD];
      __builtin_prefetch(positions + 3 * (size_t)later[0]);
      __builtin_prefetch(positions + 3 * (size_t)later[1]);
      __builtin_prefetch(positions + 3 * (size_t)later[2]);
    }
    const uint32_t *f = indices + 3 * (size_t)prim[i];
    put_corner(positions, f[0], c->p, i);
    put_corner(positions, f[1], c->p + 3, i);
    put_corner(positions, f[2], c->p + 6, i);
  }
}

/* Gathers the corners of plain hits. False: there are others, too. */
static bool gather_corners(const vlWorld *world, const vlHits *h, uint32_t n, vlCorners *c) {
  bool all = true;
  for (uint32_t first = 0, last; first < n; first = last) {
    uint32_t shape = h->shape[first], instance = h->instance[first];
    last = first + 1;
    while (last < n && h->shape[last] == shape && h->instance[last] == instance)
      last++;
    if (shape == VL_NONE)
      continue;
    if (is_plain(world, h, first))
      gather_run(&world->shapes.items[shape], h->prim, first, last, c);
    else
      all = false;
  }
  return all;
}

/* Distances of hits that are not plain, and t. */
static void measure_other(const vlWorld *world, const vlHits *h, vlCastBatch *b) {
  const double none = (double)__builtin_nanf("");
  for (uint32_t i = 0; i < b->n; i++) {
    if (h->shape[i] == VL_NONE || is_plain(world, h, i))
      continue;
    const double o[3] = {b->o[0][i], b->o[1][i], b->o[2][i]},
                 d[3] = {b->d[0][i], b->d[1][i], b->d[2][i]};
    b->distance[i] = vl_exact_distance(world, b->time[i], o, d, h->shape[i], h->prim[i],
                                       h->instance[i], h->t[i], none);
    b->t[i] = b->distance[i] / b->length[i];
  }
}

/* Distances in double, and t. Rows of rays without a hit get numbers that nobody reads. */
static void measure(const vlWorld *world, const vlHits *h, vlCorners *c, vlCastBatch *b) {
  const double none = (double)__builtin_nanf("");
  bool all = gather_corners(world, h, b->n, c);
  uint32_t padded = VL_PAD(b->n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    Exact x = {c->p[0][i], c->p[1][i], c->p[2][i]}, y = {c->p[3][i], c->p[4][i], c->p[5][i]},
          z = {c->p[6][i], c->p[7][i], c->p[8][i]};
    Exact o = {b->o[0][i], b->o[1][i], b->o[2][i]}, d = {b->d[0][i], b->d[1][i], b->d[2][i]};
    b->distance[i] = exact_plane_distance(x, y, z, o, d, none);
    b->t[i] = b->distance[i] / b->length[i];
  }
  if (!all)
    measure_other(world, h, b);
}

/* Takes away hits beyond the exact end of their ray. */
static void drop_beyond(const vlCastBatch *b, vlHits *h) {
  for (uint32_t i = 0; i < b->n; i++)
    if (h->shape[i] != VL_NONE && b->distance[i] > b->end[i])
      h->shape[i] = VL_NONE;
}

static void follow(const vlWorld *world, const vlHits *h, vlCastBatch *b) {
  for (uint32_t i = 0; i < b->n; i++) {
    double point[3], v[3];
    if (h->shape[i] == VL_NONE)
      continue;
    for (int k = 0; k < 3; k++)
      point[k] = b->o[k][i] + b->distance[i] * b->d[k][i];
    vl_world_velocity(world, h->shape[i], h->prim[i], h->instance[i], b->time[i], point, v);
    for (int k = 0; k < 3; k++)
      b->velocity[k][i] = v[k];
  }
}

/* ---- the batch --------------------------------------------------------------------------- */

static void next(const vlWorld *world, vlTraceScratch *s, uint32_t wanted, vlCastBatch *b) {
  vlPaths *p = &s->rays;
  vlHits *h = &s->hits;
  vlRays rays = rays_of(world, p, b);
  vl_accel_closest(world, b->n, &rays, b->coherent, h->shape, h->prim, h->instance, h->t);
  for (uint32_t i = 0; world->has_interfaces && i < b->n; i++)
    pass_interfaces(world, p, b, h, i);
  if ((wanted & (VL_CAST_DISTANCE | VL_CAST_VELOCITY)) || b->finite_ends)
    measure(world, h, &s->corners, b);
  if (b->finite_ends)
    drop_beyond(b, h);
  if (wanted & VL_CAST_VELOCITY)
    follow(world, h, b);
  if (wanted & (VL_CAST_SURFACE | VL_CAST_SHADING | VL_CAST_ON)) {
    p->time = s->at.paths.time = world->moves ? b->time : NULL;
    uint32_t n = gather(b->n, p, h, &s->at);
    if (n)
      vl_stage_surface(world, n, &s->at.paths, &s->at.hits, &s->corners, &s->at.surface);
    if (wanted & VL_CAST_SHADING)
      shade(world, n, s);
    put_surface(n, &s->at, wanted, b);
  }
  for (uint32_t i = 0; i < b->n; i++) {
    b->shape[i] = h->shape[i];
    b->prim[i] = h->prim[i];
    b->instance[i] = h->instance[i];
  }
}

static void occluded(const vlWorld *world, vlTraceScratch *s, vlCastBatch *b) {
  vlRays rays = rays_of(world, &s->rays, b);
  for (uint32_t i = 0; i < b->n; i++)
    b->t_max[i] = (float)b->end[i];
  if (b->coherent)
    vl_accel_occluded_coherent(world, b->n, &rays, b->occluded);
  else
    vl_accel_occluded(world, b->n, &rays, &s->occluders, b->occluded);
}

static void keep(vlTraceScratch *s, vlCastBatch *b, uint32_t from[VL_ROW_SIZE]) {
  vlPaths *p = &s->rays;
  uint32_t count = 0;
  for (uint32_t i = 0; i < b->n; i++) {
    if (b->shape[i] == VL_NONE)
      continue;
    uint32_t k = count++;
    from[k] = i;
    float *rows[8] = {p->o.x, p->o.y, p->o.z, p->d.x, p->d.y, p->d.z, b->t_min, b->t_max};
    for (int j = 0; j < 8; j++)
      rows[j][k] = rows[j][i];
    for (int j = 0; j < 3; j++) {
      b->o[j][k] = b->o[j][i];
      b->d[j][k] = b->d[j][i];
    }
    b->length[k] = b->length[i];
    b->end[k] = b->end[i];
    b->time[k] = b->time[i];
  }
  b->n = count;
}

const vlCastKernels vl_cast_kernel_table = {vl_cast_read_numbers,
                                            vl_cast_read_vectors,
                                            vl_cast_prefetch,
                                            vl_cast_check,
                                            vl_cast_prepare,
                                            next,
                                            occluded,
                                            keep};
