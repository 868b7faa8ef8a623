/* bench/ray_casts.c: vl_world_cast beside Embree's own 16-wide calls: the same triangles, rays
 * and instruction set, in one thread of one process, alternately. Both read rays from rows of 3
 * floats and write t and ids. Prints nanoseconds per ray (medians), Embree's time over velo's
 * (1: as fast), and how many rays have other results. Usage: bench_ray_casts [SIDE [RAYS]]: a
 * wavy ball of 2 SIDE^2 triangles over a floor; default 500 and 200000 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"
#include "velo/rays.h"
#include "velo/velo.h"

#if VELO_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

enum { ROUNDS = 15, WIDE = 16 };

typedef struct Mesh {
  float *positions;
  uint32_t *indices, vertices, faces;
} Mesh;

typedef struct Rays {
  uint32_t count;
  float *origins, *directions; /* rows of 3 */
} Rays;

/* What both find. */
typedef struct Found {
  double *t;
  uint32_t *primitive;
  uint8_t *occluded;
} Found;

static void *room(size_t count, size_t size) {
  void *block = calloc(count, size);
  if (!block)
    exit(1);
  return block;
}

static double random_unit(void) {
  static uint64_t state = 7;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (double)(state >> 11) * 0x1p-53;
}

/* ---- scenes ------------------------------------------------------------------------------ */

static Mesh wavy_ball(uint32_t side) {
  Mesh m = {.vertices = (side + 1) * (side + 1) + 4, .faces = 2 * side * side + 2};
  m.positions = room(3 * (size_t)m.vertices + 4, sizeof(float));
  m.indices = room(3 * (size_t)m.faces, sizeof(uint32_t));
  float *p = m.positions;
  for (uint32_t j = 0; j <= side; j++)
    for (uint32_t i = 0; i <= side; i++) {
      double a = 2 * M_PI * i / side, b = M_PI * j / side;
      double r = 1 + 0.1 * sin(11 * a) * sin(9 * b);
      *p++ = (float)(r * sin(b) * cos(a));
      *p++ = (float)(r * cos(b));
      *p++ = (float)(r * sin(b) * sin(a));
    }
  const float floor[12] = {-4, -1.2f, -4, 4, -1.2f, -4, 4, -1.2f, 4, -4, -1.2f, 4};
  memcpy(p, floor, sizeof floor);
  uint32_t *f = m.indices;
  for (uint32_t j = 0; j < side; j++)
    for (uint32_t i = 0; i < side; i++) {
      uint32_t k = j * (side + 1) + i,
               quad[6] = {k, k + 1, k + side + 1, k + 1, k + side + 2, k + side + 1};
      memcpy(f, quad, sizeof quad);
      f += 6;
    }
  uint32_t k = m.vertices - 4, ground[6] = {k, k + 1, k + 2, k, k + 2, k + 3};
  memcpy(f, ground, sizeof ground);
  return m;
}

static Rays new_rays(uint32_t count) {
  return (Rays){count, room(3 * (size_t)count, sizeof(float)),
                room(3 * (size_t)count, sizeof(float))};
}

/* Those of a pinhole camera, row by row. */
static Rays coherent_rays(uint32_t count) {
  uint32_t side = (uint32_t)sqrt(count);
  Rays r = new_rays(side * side);
  for (uint32_t i = 0; i < r.count; i++) {
    double x = 2 * (i % side + 0.5) / side - 1, y = 1 - 2 * (i / side + 0.5) / side;
    double d[3] = {0.7 * x, 0.7 * y - 0.2, -1}, l = sqrt(d[0] * d[0] + d[1] * d[1] + 1);
    const float o[3] = {0, 0.6f, 3};
    memcpy(r.origins + 3 * (size_t)i, o, sizeof o);
    for (size_t k = 0; k < 3; k++)
      r.directions[3 * (size_t)i + k] = (float)(d[k] / l);
  }
  return r;
}

/* From points around the ball in all directions. */
static Rays random_rays(uint32_t count) {
  Rays r = new_rays(count);
  for (size_t i = 0; i < count; i++) {
    double z = 2 * random_unit() - 1, a = 2 * M_PI * random_unit(), s = sqrt(1 - z * z);
    const double d[3] = {s * cos(a), s * sin(a), z};
    for (size_t k = 0; k < 3; k++) {
      r.origins[3 * i + k] = (float)(3 * random_unit() - 1.5);
      r.directions[3 * i + k] = (float)d[k];
    }
  }
  return r;
}

/* ---- Embree ------------------------------------------------------------------------------ */

static RTCScene embree_scene(RTCDevice device, const Mesh *m) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m->positions, 0,
                             3 * sizeof(float), m->vertices);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->indices, 0,
                             3 * sizeof(uint32_t), m->faces);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, 0);
  rtcReleaseGeometry(g);
  rtcCommitScene(scene);
  return scene;
}

static void fill(struct RTCRay16 *q, const Rays *r, uint32_t first, int valid[WIDE]) {
  for (uint32_t k = 0; k < WIDE; k++) {
    uint32_t i = first + k < r->count ? first + k : r->count - 1;
    const float *o = r->origins + 3 * (size_t)i, *d = r->directions + 3 * (size_t)i;
    valid[k] = first + k < r->count ? -1 : 0;
    q->org_x[k] = o[0];
    q->org_y[k] = o[1];
    q->org_z[k] = o[2];
    q->dir_x[k] = d[0];
    q->dir_y[k] = d[1];
    q->dir_z[k] = d[2];
    q->tnear[k] = q->time[k] = 0;
    q->tfar[k] = INFINITY;
    q->mask[k] = (unsigned)-1;
    q->flags[k] = 0;
    q->id[k] = k;
  }
}

#if VELO_EMBREE_MAJOR >= 4
#define BEGIN(coherent)                 \
  struct RTCIntersectArguments nearest; \
  struct RTCOccludedArguments any;      \
  rtcInitIntersectArguments(&nearest);  \
  rtcInitOccludedArguments(&any);       \
  nearest.flags = any.flags =           \
      (coherent) ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT
#define NEAREST(scene, q) rtcIntersect16(valid, scene, q, &nearest)
#define ANY(scene, q) rtcOccluded16(valid, scene, q, &any)
#else
#define BEGIN(coherent)               \
  struct RTCIntersectContext context; \
  rtcInitIntersectContext(&context);  \
  context.flags =                     \
      (coherent) ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
#define NEAREST(scene, q) rtcIntersect16(valid, scene, &context, q)
#define ANY(scene, q) rtcOccluded16(valid, scene, &context, q)
#endif

static void embree_hits(RTCScene scene, const Rays *r, bool coherent, Found *found) {
  int valid[WIDE] __attribute__((aligned(64)));
  BEGIN(coherent);
  for (uint32_t first = 0; first < r->count; first += WIDE) {
    struct RTCRayHit16 q;
    fill(&q.ray, r, first, valid);
    for (int k = 0; k < WIDE; k++)
      q.hit.geomID[k] = q.hit.primID[k] = q.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    NEAREST(scene, &q);
    for (uint32_t k = 0; k < WIDE && first + k < r->count; k++) {
      found->t[first + k] = (double)q.ray.tfar[k];
      found->primitive[first + k] =
          q.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? 0 : q.hit.primID[k] + 1;
    }
  }
}

static void embree_occluded(RTCScene scene, const Rays *r, bool coherent, Found *found) {
  int valid[WIDE] __attribute__((aligned(64)));
  BEGIN(coherent);
  for (uint32_t first = 0; first < r->count; first += WIDE) {
    struct RTCRay16 q;
    fill(&q, r, first, valid);
    ANY(scene, &q);
    for (uint32_t k = 0; k < WIDE && first + k < r->count; k++)
      found->occluded[first + k] = q.tfar[k] < 0;
  }
}

/* ---- velo -------------------------------------------------------------------------------- */

static vlWorld *velo_world(vlContext *context, const Mesh *m, vlBits bits) {
  vlScene *scene;
  vlWorld *world = NULL;
  vlError error = {0};
  if (vl_scene_create(context, &scene) != VL_OK)
    exit(1);
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = m->positions;
  def.indices = m->indices;
  def.vertices = m->vertices;
  def.faces = m->faces;
  vl_scene_add_shape(scene, &def);
  vlBuildDef build = vl_default_build_def();
  build.bits = bits;
  if (vl_world_build(scene, &build, &world, &error) != VL_OK) {
    fprintf(stderr, "ray_casts: %s\n", error.message);
    exit(1);
  }
  vl_scene_destroy(scene);
  return world;
}

static void velo_cast(const vlWorld *world, const Rays *r, bool occlusion, Found *found) {
  const vlCastRays rays = {.count = r->count,
                           .origins = {r->origins, 3 * sizeof(float), false},
                           .directions = {r->directions, 3 * sizeof(float), false}};
  const vlCastDef def = vl_default_cast_def();
  const vlCastHits hits = {.t = found->t, .primitive = found->primitive};
  vlResult result =
      occlusion ? vl_world_cast_occluded(world, &rays, &def, found->occluded, NULL, NULL)
                : vl_world_cast(world, &rays, &def, &hits, NULL, NULL);
  if (result != VL_OK)
    exit(1);
}

/* ---- comparison -------------------------------------------------------------------------- */

static Found new_found(uint32_t count) {
  return (Found){room(count, sizeof(double)), room(count, sizeof(uint32_t)), room(count, 1)};
}

static uint32_t differing(const Found *a, const Found *b, uint32_t count, bool occlusion) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < count; i++)
    n += occlusion ? a->occluded[i] != b->occluded[i] : a->primitive[i] != b->primitive[i];
  return n;
}

static void compare(const char *name, RTCScene scene, const vlWorld *world, const Rays *r,
                    bool coherent) {
  Found a = new_found(r->count), b = new_found(r->count);
  for (int occlusion = 0; occlusion < 2; occlusion++) {
    double seconds[2][ROUNDS], ratios[ROUNDS];
    for (int round = -1; round < ROUNDS; round++) { /* the first warms up */
      double begin = processor_seconds();
      if (occlusion)
        embree_occluded(scene, r, coherent, &a);
      else
        embree_hits(scene, r, coherent, &a);
      double middle = processor_seconds();
      velo_cast(world, r, occlusion, &b);
      double end = processor_seconds();
      if (round < 0)
        continue;
      seconds[0][round] = middle - begin;
      seconds[1][round] = end - middle;
      ratios[round] = (middle - begin) / (end - middle);
    }
    printf("%-20s %-8s embree16 %7.1f ns, velo %7.1f ns, ratio %.3f; %u of %u differ\n", name,
           occlusion ? "occluded" : "nearest", 1e9 * median(seconds[0], ROUNDS) / r->count,
           1e9 * median(seconds[1], ROUNDS) / r->count, median(ratios, ROUNDS),
           differing(&a, &b, r->count, occlusion), r->count);
  }
  free(a.t);
  free(a.primitive);
  free(a.occluded);
  free(b.t);
  free(b.primitive);
  free(b.occluded);
}

int main(int argc, char **argv) {
  uint32_t side = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 500,
           count = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 200000;
  vlContext *context;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  if (vl_context_create(&def, &context) != VL_OK)
    return 1;
  Mesh mesh = wavy_ball(side);
  Rays coherent = coherent_rays(count), random = random_rays(count);
  /* VL_BITS_PORTABLE has Embree use AVX; VL_BITS_FAST leaves the choice to it. */
  static const struct {
    const char *device, *names[2];
    vlBits bits;
  } sets[2] = {
      {"threads=1,isa=avx", {"portable coherent", "portable random"}, VL_BITS_PORTABLE},
      {"threads=1", {"fast coherent", "fast random"}, VL_BITS_FAST}};
  for (int k = 0; k < 2; k++) {
    RTCDevice device = rtcNewDevice(sets[k].device);
    RTCScene scene = embree_scene(device, &mesh);
    vlWorld *world = velo_world(context, &mesh, sets[k].bits);
    compare(sets[k].names[0], scene, world, &coherent, true);
    compare(sets[k].names[1], scene, world, &random, false);
    vl_world_destroy(world);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  vl_context_destroy(context);
  return 0;
}
