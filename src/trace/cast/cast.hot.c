/* trace/cast/cast.hot.c: hits of the caller's own rays. The ids come from the accelerator, as
 * for camera rays; then only what is wanted is computed, for all hits of the batch. */
#include "trace/cast/cast.h"

#include "trace/ground_truth/exact.h"
#include "trace/stages.h"
#include "velo/schema.h"

/* ---- rays -------------------------------------------------------------------------------- */

static inline double largest(double a, double b, double c) {
  a = __builtin_fabs(a);
  b = __builtin_fabs(b);
  c = __builtin_fabs(c);
  a = a > b ? a : b;
  return a > c ? a : c;
}

static bool check(vlCastBatch *b) {
  uint32_t wrong = 0;
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < b->n; i++)
    b->start[i] = b->start[i] < 0.0 ? 0.0 : b->start[i];
  for (uint32_t i = 0; i < b->n; i++) {
    double length = largest(b->d[0][i], b->d[1][i], b->d[2][i]);
    double reach = largest(b->o[0][i], b->o[1][i], b->o[2][i]);
    double sum = (b->d[0][i] - b->d[0][i]) + (b->d[1][i] - b->d[1][i]) +
                 (b->d[2][i] - b->d[2][i]) + (b->o[0][i] - b->o[0][i]) +
                 (b->o[1][i] - b->o[1][i]) + (b->o[2][i] - b->o[2][i]);
    uint32_t fine = (sum == 0.0) & (length > 0.0) & (length <= VL_CAST_LONGEST) &
                    (reach < VL_CAST_FAR) & (b->end[i] > b->start[i]) &
                    (b->start[i] < (double)VL_INFINITY);
    wrong |= !fine;
  }
  return !wrong;
}

/* Makes directions unit, and distances of t. The largest component is taken out first, since
 * squares may leave the range of double. */
static void normalize(vlCastBatch *b) {
  uint32_t padded = VL_PAD(b->n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    double most = largest(b->d[0][i], b->d[1][i], b->d[2][i]);
    double scale = 1.0 / most;
    double x = b->d[0][i] * scale, y = b->d[1][i] * scale, z = b->d[2][i] * scale;
    double l = __builtin_sqrt(x * x + y * y + z * z), unit = 1.0 / l;
    b->d[0][i] = x * unit;
    b->d[1][i] = y * unit;
    b->d[2][i] = z * unit;
    b->length[i] = most * l;
    b->start[i] = b->start[i] * b->length[i];
    b->end[i] = b->end[i] * b->length[i];
  }
}

/* The part of a ray in float that holds all of the exact one: distances are compared with its
 * end in double afterwards (drop_beyond). */
static const double WIDER = 1.0 + 0x1p-18;

static void round_rays(vlCastBatch *b, vlPaths *p) {
  uint32_t padded = VL_PAD(b->n);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    p->ox[i] = (float)b->o[0][i];
    p->oy[i] = (float)b->o[1][i];
    p->oz[i] = (float)b->o[2][i];
    p->dx[i] = (float)b->d[0][i];
    p->dy[i] = (float)b->d[1][i];
    p->dz[i] = (float)b->d[2][i];
    b->t_min[i] = (float)b->start[i];
    b->t_max[i] = (float)(b->end[i] * WIDER);
  }
}

/* Whether most neighbours start close to each other, as the world is large, in directions
 * within 8 degrees. Every fourth pair is looked at. */
static bool are_coherent(const vlWorld *world, uint32_t n, const vlPaths *p) {
  const float close = 0.02f * world->radius, least_cosine = 0.99f;
  uint32_t similar = 0, pairs = 0;
  for (uint32_t i = 1; i < n; i += 4) {
    vlVec3 a = vl_lane3(p->dx, p->dy, p->dz, i), b = vl_lane3(p->dx, p->dy, p->dz, i - 1);
    vlVec3 step =
        vl_sub(vl_lane3(p->ox, p->oy, p->oz, i), vl_lane3(p->ox, p->oy, p->oz, i - 1));
    similar += vl_dot(a, b) > least_cosine && vl_length2(step) <= close * close;
    pairs++;
  }
  return 8 * similar >= 7 * pairs && pairs;
}

static void prepare(const vlWorld *world, vlTraceScratch *s, vlCastBatch *b) {
  vlPaths *p = &s->rays;
  for (uint32_t i = b->n; i < VL_PAD(b->n); i++) {
    for (int k = 0; k < 3; k++) {
      b->o[k][i] = b->o[k][0];
      b->d[k][i] = b->d[k][0];
    }
    b->start[i] = b->start[0];
    b->end[i] = b->end[0];
  }
  normalize(b);
  round_rays(b, p);
  b->coherent = are_coherent(world, b->n, p);
  b->finite_ends = false;
  for (uint32_t i = 0; i < b->n; i++)
    b->finite_ends = b->finite_ends || b->end[i] < VL_INFINITY;
}

static vlRays rays_of(const vlWorld *world, const vlPaths *p, const vlCastBatch *b) {
  return (vlRays){p->ox,    p->oy,    p->oz,
                  p->dx,    p->dy,    p->dz,
                  b->t_min, b->t_max, world->moves ? b->time : NULL};
}

/* ---- hits -------------------------------------------------------------------------------- */

static bool is_interface(const vlWorld *world, uint32_t shape) {
  uint32_t material = world->shapes.items[shape].material;
  return (world->materials.items[material].traits & VL_MATERIAL_ABSENT) != 0;
}

/* Finds the hit of ray i behind the interfaces that it meets first. */
static void pass_interfaces(const vlWorld *world, const vlPaths *p, const vlCastBatch *b,
                            vlHits *h, uint32_t i) {
  enum { MAX_PASSED = 1024 }; /* no ray crosses so many */
  float t_min = b->t_min[i];
  vlVec3 o = vl_lane3(p->ox, p->oy, p->oz, i), d = vl_lane3(p->dx, p->dy, p->dz, i);
  for (int step = 0; h->shape[i] != VL_NONE && is_interface(world, h->shape[i]); step++) {
    if (step == MAX_PASSED) {
      h->shape[i] = VL_NONE;
      return;
    }
    vlPoint at = vl_point_at_time(world, b->time[i], o, d, h->shape[i], h->prim[i],
                                  h->instance[i], h->t[i]);
    t_min = vl_past_surface(&at, d, t_min);
    vlRays ray = {p->ox + i, p->oy + i, p->oz + i,    p->dx + i,  p->dy + i,
                  p->dz + i, &t_min,    b->t_max + i, b->time + i};
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
    at->paths.ox[k] = p->ox[i];
    at->paths.oy[k] = p->oy[i];
    at->paths.oz[k] = p->oz[i];
    at->paths.dx[k] = p->dx[i];
    at->paths.dy[k] = p->dy[i];
    at->paths.dz[k] = p->dz[i];
    at->paths.lane[k] = i;
    at->hits.shape[k] = h->shape[i];
    at->hits.prim[k] = h->prim[i];
    at->hits.instance[k] = h->instance[i];
    at->hits.t[k] = h->t[i];
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
    b->normal[0][lane] = f->gx[i];
    b->normal[1][lane] = f->gy[i];
    b->normal[2][lane] = f->gz[i];
    b->shading[0][lane] = f->nx[i];
    b->shading[1][lane] = f->ny[i];
    b->shading[2][lane] = f->nz[i];
    b->uv[0][lane] = f->u[i];
    b->uv[1][lane] = f->v[i];
    if (!(wanted & VL_CAST_ON))
      continue;
    vlVec3 g = vl_lane3(f->gx, f->gy, f->gz, i),
           d = vl_lane3(at->paths.dx, at->paths.dy, at->paths.dz, i);
    b->t_min[lane] = vl_past_crossing(f->t[i], g, f->offset[i], d, b->t_min[lane]);
  }
}

/* ---- distances --------------------------------------------------------------------------- */

/* Large meshes are not in the cache: what later lanes read is prefetched, first the indices,
 * then the corners. */
enum { AHEAD = 8, LARGE_MESH = 4096 };
static inline __attribute__((always_inline)) const vlWorldShape *large_mesh(
    const vlWorld *world, const vlHits *h, uint32_t i) {
  const vlWorldShape *s = h->shape[i] == VL_NONE ? NULL : &world->shapes.items[h->shape[i]];
  return s && s->triangles && s->faces >= LARGE_MESH ? s : NULL;
}
static inline __attribute__((always_inline)) void prefetch(const vlWorld *world,
                                                           const vlHits *h, uint32_t n,
                                                           uint32_t i) {
  const vlWorldShape *later = i + 2 * AHEAD < n ? large_mesh(world, h, i + 2 * AHEAD) : NULL;
  if (later)
    __builtin_prefetch(later->indices + 3 * (size_t)h->prim[i + 2 * AHEAD]);
  const vlWorldShape *soon = i + AHEAD < n ? large_mesh(world, h, i + AHEAD) : NULL;
  const uint32_t *f = soon ? soon->indices + 3 * (size_t)h->prim[i + AHEAD] : NULL;
  if (!f)
    return;
  __builtin_prefetch(soon->positions + 3 * (size_t)f[0]);
  __builtin_prefetch(soon->positions + 3 * (size_t)f[1]);
  __builtin_prefetch(soon->positions + 3 * (size_t)f[2]);
}

/* Whether a hit is on a triangle at rest outside of instances, as most are. */
static inline __attribute__((always_inline)) bool is_plain(const vlWorld *world,
                                                           const vlHits *h, uint32_t i) {
  const vlWorldShape *s = &world->shapes.items[h->shape[i]];
  return h->instance[i] == VL_NONE && s->triangles && s->steps <= 1;
}

static inline __attribute__((always_inline)) void put_corner(const vlWorldShape *s,
                                                             uint32_t vertex,
                                                             float (*rows)[VL_ROW_SIZE],
                                                             uint32_t i) {
  const float *x = s->positions + 3 * (size_t)vertex;
  rows[0][i] = x[0];
  rows[1][i] = x[1];
  rows[2][i] = x[2];
}

/* Gathers the corners of plain hits. False: there are others, too. */
static bool gather_corners(const vlWorld *world, const vlHits *h, uint32_t n, vlCorners *c) {
  bool all = true;
  for (uint32_t i = 0; i < n; i++) {
    prefetch(world, h, n, i);
    if (h->shape[i] == VL_NONE)
      continue;
    if (!is_plain(world, h, i)) {
      all = false;
      continue;
    }
    const vlWorldShape *s = &world->shapes.items[h->shape[i]];
    const uint32_t *f = s->indices + 3 * (size_t)h->prim[i];
    put_corner(s, f[0], c->p, i);
    put_corner(s, f[1], c->p + 3, i);
    put_corner(s, f[2], c->p + 6, i);
  }
  return all;
}

/* Distances in double. Rows of rays without a hit get numbers that nobody reads. */
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
  }
  for (uint32_t i = 0; i < b->n && !all; i++) {
    if (h->shape[i] == VL_NONE || is_plain(world, h, i))
      continue;
    const double o[3] = {b->o[0][i], b->o[1][i], b->o[2][i]},
                 d[3] = {b->d[0][i], b->d[1][i], b->d[2][i]};
    b->distance[i] = vl_exact_distance(world, b->time[i], o, d, h->shape[i], h->prim[i],
                                       h->instance[i], h->t[i], none);
  }
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
    float *rows[8] = {p->ox, p->oy, p->oz, p->dx, p->dy, p->dz, b->t_min, b->t_max};
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

const vlCastKernels vl_cast_kernel_table = {check, prepare, next, occluded, keep};
