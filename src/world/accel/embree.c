/* world/accel/embree.c: the one file that calls Embree (3.13 or 4). Triangles are Embree's own
 * geometry; other shapes are user geometry, intersected by surface_point.c. Filters decide by a
 * hash of ray and primitive whether a ray passes because of alpha, so that the result does not
 * depend on the order of traversal. Shadow rays pass interface surfaces. Inside instances
 * Embree gives callbacks the ray in the group's space. Embree's transformation of the ray
 * differs between instruction sets; the callbacks therefore read the world-space ray by its id
 * and transform it themselves.
 *
 * For reproducible results (docs/decisions/0013-the-bits-of-embree.md): Embree runs with an
 * instruction set without fused multiply-add, and a filter decides which of several hits is the
 * nearest (nearest.h). */
#include "world/accel/embree.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/isa.h"
#include "base/machine.h"
#include "velo/shape.h"
#include "world/accel/bundle.h"
#include "world/accel/local_ray.h"
#include "world/accel/nearest_packet.h"
#include "world/accel/occluders.h"
#include "world/accel/packet_rays.h"
#include "world/accel/share.h"
#include "world/world.h"

#if VELO_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

/* What user_bounds reads; needed only while a scene is built. During queries the world of the
 * query gives the shape, because worlds share Embree's scenes. */
typedef struct AccelGeometry {
  const vlWorld *world;
  const vlWorldShape *shape;
  const uint32_t *members; /* for a bundle: shape index of each primitive; otherwise null */
} AccelGeometry;

/* Embree's query context, extended by the rays of the call. */
#if VELO_EMBREE_MAJOR >= 4
typedef struct RTCRayQueryContext EmbreeContext;
#else
typedef struct RTCIntersectContext EmbreeContext;
#endif
typedef struct Query {
  EmbreeContext context; /* first, because Embree passes its address to callbacks */
  vlEmbreeQuery q;
} Query;

static const vlEmbreeQuery *query_of(const EmbreeContext *context) {
  return &((const Query *)(const void *)context)->q;
}

/* Embree's number of an instance; VL_NONE for the shapes outside of groups. */
_Static_assert(RTC_INVALID_GEOMETRY_ID == VL_NONE, "no instance");
static inline uint32_t instance_of(const vlWorld *world, unsigned inst) {
  return world->accel.split && inst == 0 ? VL_NONE : inst;
}

/* Index of an instance that instance_of returned. */
static inline uint32_t index_of(const vlWorld *world, uint32_t inst) {
  return inst == VL_NONE ? VL_NONE : inst - world->groups.items[0].count;
}

/* ---- filters ----------------------------------------------------------------------------- */

static bool filter_rejects(const struct RTCFilterFunctionNArguments *args, unsigned i,
                           bool shadow) {
  const vlEmbreeQuery *q = query_of(args->context);
  uint32_t inst = instance_of(q->world, *hit_row(args->hit, args->N, INST, i));
  uint32_t prim = *hit_row(args->hit, args->N, PRIM, i);
  const vlWorldShape *shape =
      vl_accel_shape(q->world, inst, *hit_row(args->hit, args->N, GEOM, i), &prim);
  return vl_triangle_lets_pass(q->world, q->rays, *hit_row(args->ray, args->N, ID, i),
                               index_of(q->world, inst), shape, prim, shadow);
}

/* Reads the hit of ray i of n as Embree passes it to a filter; the t of the ray is then the t
 * of the hit. */
VL_INLINE void read_hit(const struct RTCFilterFunctionNArguments *args, unsigned n, unsigned i,
                        vlNearest *hit) {
  hit->world = query_of(args->context)->world;
  hit->t = *ray_row(args->ray, n, TFAR, i);
  hit->instance = instance_of(hit->world, *hit_row(args->hit, n, INST, i));
  hit->geometry = *hit_row(args->hit, n, GEOM, i);
  hit->primitive = *hit_row(args->hit, n, PRIM, i);
  for (int k = 0; k < 3; k++)
    hit->normal[k] = *ray_row(args->hit, n, NORMAL + k, i);
  if (n == 1) { /* the members lie one after the other, as in RTCRay */
    memcpy(hit->o, args->ray, (TIME + 1) * sizeof(float));
    return;
  }
  for (int k = 0; k < 3; k++) {
    hit->o[k] = *ray_row(args->ray, n, ORIGIN + k, i);
    hit->d[k] = *ray_row(args->ray, n, DIRECTION + k, i);
  }
  hit->time = *ray_row(args->ray, n, TIME, i);
}
_Static_assert(offsetof(vlNearest, time) - offsetof(vlNearest, o) == TIME * sizeof(float) &&
                   offsetof(vlNearest, d) - offsetof(vlNearest, o) == DIRECTION * sizeof(float),
               "the layout of a single ray");

VL_NOINLINE bool compare_hit(const struct RTCFilterFunctionNArguments *args, vlNearest *known) {
  vlNearest hit;
  read_hit(args, 1, 0, &hit);
  return vl_nearest_offer(known, &hit);
}

/* What is known of the ray of a packet that Embree calls lane k. */
static vlNearest known_of(const vlEmbreeQuery *q, uint32_t k) {
  const vlNearestPacket *p = q->packet;
  return vl_packet_known(p, q->world, q->rays, instance_of(q->world, p->instance[k]),
                         q->first + k, k);
}

/* Keeps the rays of hits that are inside of an instance, for later comparisons. */
static void keep_rays(const struct RTCFilterFunctionNArguments *args, vlNearestPacket *p) {
  for (int j = 0; j < 3; j++) {
    vl_packet_blend(p->o[j], ray_row(args->ray, VL_PACKET, ORIGIN + j, 0), args->valid);
    vl_packet_blend(p->d[j], ray_row(args->ray, VL_PACKET, DIRECTION + j, 0), args->valid);
  }
  vl_packet_blend(p->time, ray_row(args->ray, VL_PACKET, TIME, 0), args->valid);
}

/* Takes out the hits that are not the nearest. */
VL_NOINLINE void compare_packet(const struct RTCFilterFunctionNArguments *args,
                                const vlEmbreeQuery *q) {
  for (unsigned k = 0; k < VL_PACKET; k++) {
    if (!args->valid[k])
      continue;
    vlNearest known = known_of(q, k), hit;
    read_hit(args, VL_PACKET, k, &hit);
    if (!vl_nearest_offer(&known, &hit))
      args->valid[k] = 0;
  }
}

/* Takes the hits of a packet that are the nearest so far, and takes out the others. Sets the
 * rays' largest t, beyond which further hits do not matter. */
static inline void take_nearest(const struct RTCFilterFunctionNArguments *args,
                                const vlEmbreeQuery *q) {
  float *far = ray_row(args->ray, VL_PACKET, TFAR, 0), limit[VL_PACKET];
  if (!vl_packet_clearly(q->packet, far, args->valid))
    compare_packet(args, q);
  if (args->context->instID[0] != RTC_INVALID_GEOMETRY_ID)
    keep_rays(args, q->packet);
  vl_packet_blend(q->packet->t, far, args->valid);
  VL_SIMD
  for (int k = 0; k < VL_PACKET; k++)
    limit[k] = far[k] * VL_NEAREST_WINDOW;
  vl_packet_blend(far, limit, args->valid);
}

/* Whether the hit of a single ray is the nearest so far; as take_nearest. */
VL_INLINE bool is_nearest(const struct RTCFilterFunctionNArguments *args,
                          const vlEmbreeQuery *q) {
  float t = *ray_row(args->ray, 1, TFAR, 0);
  if (vl_nearest_clearly(q->nearest, t))
    read_hit(args, 1, 0, q->nearest);
  else if (!compare_hit(args, q->nearest))
    return false;
  *ray_row(args->ray, 1, TFAR, 0) = t * VL_NEAREST_WINDOW;
  return true;
}

/* The filter for VL_BITS_PORTABLE, for triangles that need no other filter. */
static void filter_nearest(const struct RTCFilterFunctionNArguments *args) {
  const vlEmbreeQuery *q = query_of(args->context);
  if (q->packet)
    take_nearest(args, q);
  else if (q->nearest && args->valid[0] == -1 && !is_nearest(args, q))
    args->valid[0] = 0;
}

static inline void drop_rejected(const struct RTCFilterFunctionNArguments *args,
                                 bool occluded) {
  for (unsigned i = 0; i < args->N; i++)
    if (args->valid[i] == -1 && filter_rejects(args, i, occluded))
      args->valid[i] = 0;
}

static void filter_closest(const struct RTCFilterFunctionNArguments *args) {
  drop_rejected(args, false);
  filter_nearest(args);
}

static void filter_occluded(const struct RTCFilterFunctionNArguments *args) {
  drop_rejected(args, true);
}

/* For shadow rays and opaque triangles that stay in place. */
static void learn_occluder(const struct RTCFilterFunctionNArguments *args) {
  const vlEmbreeQuery *q = query_of(args->context);
  for (unsigned i = 0; q->occluders && i < args->N; i++)
    if (args->valid[i] == -1 &&
        instance_of(q->world, *hit_row(args->hit, args->N, INST, i)) == VL_NONE)
      vl_occluders_learn(q->occluders, *hit_row(args->hit, args->N, GEOM, i),
                         *hit_row(args->hit, args->N, PRIM, i));
}

/* ---- user geometry ----------------------------------------------------------------------- */

static void user_bounds(const struct RTCBoundsFunctionArguments *args) {
  const AccelGeometry *g = args->geometryUserPtr;
  float low[3], high[3];
  uint32_t prim = args->primID;
  const vlWorldShape *shape = g->members ? &g->world->shapes.items[g->members[prim]] : g->shape;
  if (g->members)
    prim = 0;
  vl_world_prim_bounds(shape, prim, low, high);
  args->bounds_o->lower_x = low[0];
  args->bounds_o->lower_y = low[1];
  args->bounds_o->lower_z = low[2];
  args->bounds_o->upper_x = high[0];
  args->bounds_o->upper_y = high[1];
  args->bounds_o->upper_z = high[2];
}

static bool user_hit(const EmbreeContext *context, void *ray, unsigned n, unsigned i,
                     uint32_t geometry, uint32_t prim, bool shadow, double *t) {
  const vlEmbreeQuery *q = query_of(context);
  uint32_t inst = instance_of(q->world, context->instID[0]);
  const vlWorldShape *shape = vl_accel_shape(q->world, inst, geometry, &prim);
  return vl_ray_meets_shape(
      q->world, q->rays, *hit_row(ray, n, ID, i), index_of(q->world, inst), shape, prim, shadow,
      (double)*ray_row(ray, n, TNEAR, i), (double)*ray_row(ray, n, TFAR, i), t);
}

/* vl_nearest_offer for ray i of a callback. */
static bool offer_user_hit(const vlEmbreeQuery *q, unsigned i, const vlNearest *hit) {
  if (!q->packet)
    return vl_nearest_offer(q->nearest, hit);
  vlNearest known = known_of(q, i);
  if (!vl_nearest_offer(&known, hit))
    return false;
  q->packet->t[i] = hit->t;
  return true;
}

static void user_intersect(const struct RTCIntersectFunctionNArguments *args) {
  void *ray = args->rayhit, *hit = ray_row(ray, args->N, HIT, 0);
  for (unsigned i = 0; i < args->N; i++) {
    double t;
    if (args->valid[i] != -1 ||
        !user_hit(args->context, ray, args->N, i, args->geomID, args->primID, false, &t))
      continue;
    const vlEmbreeQuery *q = query_of(args->context);
    float limit = (float)t;
    if (q->nearest || q->packet) {
      vlNearest met = {.t = (float)t,
                       .instance = instance_of(q->world, args->context->instID[0]),
                       .geometry = args->geomID,
                       .primitive = args->primID};
      if (!offer_user_hit(q, i, &met))
        continue;
      limit = met.t * VL_NEAREST_WINDOW;
    }
    *ray_row(ray, args->N, TFAR, i) = limit;
    *hit_row(hit, args->N, GEOM, i) = args->geomID;
    *hit_row(hit, args->N, PRIM, i) = args->primID;
    *hit_row(hit, args->N, INST, i) = args->context->instID[0];
  }
}

static void user_occluded(const struct RTCOccludedFunctionNArguments *args) {
  for (unsigned i = 0; i < args->N; i++) {
    double t;
    if (args->valid[i] == -1 &&
        user_hit(args->context, args->ray, args->N, i, args->geomID, args->primID, true, &t))
      *ray_row(args->ray, args->N, TFAR, i) = -INFINITY;
  }
}

/* ---- building ---------------------------------------------------------------------------- */

static void make_user_geometry(RTCGeometry geometry, uint32_t count) {
  rtcSetGeometryUserPrimitiveCount(geometry, count);
  rtcSetGeometryBoundsFunction(geometry, user_bounds, NULL);
  rtcSetGeometryIntersectFunction(geometry, user_intersect);
  rtcSetGeometryOccludedFunction(geometry, user_occluded);
}

static void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

/* Adds a shape or a bundle to a scene. count: number of shapes in the bundle. */
static vlResult attach_shape(RTCDevice device, RTCScene scene, unsigned id, AccelGeometry *g,
                             uint32_t count, vlError *error) {
  const vlWorldShape *s = g->shape;
  bool triangles = s->triangles;
  RTCGeometry geometry =
      rtcNewGeometry(device, triangles ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_USER);
  if (!geometry)
    return vl_fail_memory(error);
  rtcSetGeometryUserData(geometry, g);
  if (triangles) {
    rtcSetGeometryTimeStepCount(geometry, s->steps);
    for (uint32_t k = 0; k < s->steps; k++)
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, k, RTC_FORMAT_FLOAT3,
                                 s->positions, 12 * (size_t)k * s->vertices, 12, s->vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s->indices,
                               0, 12, s->faces);
    if (s->alpha >= 0 || s->one_sided)
      rtcSetGeometryIntersectFilterFunction(geometry, filter_closest);
    else if (g->world->def.bits == VL_BITS_PORTABLE)
      rtcSetGeometryIntersectFilterFunction(geometry, filter_nearest);
    if (s->alpha >= 0 || s->one_sided || s->pass_shadow)
      rtcSetGeometryOccludedFilterFunction(geometry, filter_occluded);
    else if (s->steps == 1)
      rtcSetGeometryOccludedFilterFunction(geometry, learn_occluder);
  } else {
    make_user_geometry(geometry, g->members ? count : s->faces);
  }
  attach(scene, geometry, id);
  return VL_OK;
}

static vlResult attach_instance(RTCDevice device, RTCScene scene, RTCScene target, unsigned id,
                                const vlWorldInstance *q, vlError *error) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  if (!geometry)
    return vl_fail_memory(error);
  rtcSetGeometryInstancedScene(geometry, target);
  uint32_t steps = q->keys ? q->keys : 1;
  rtcSetGeometryTimeStepCount(geometry, steps);
  /* matrices are interpolated linearly between keys, as in moving.c */
  for (uint32_t k = 0; k < steps; k++)
    rtcSetGeometryTransform(geometry, k, RTC_FORMAT_FLOAT3X4_ROW_MAJOR,
                            q->keys ? q->path + 12 * (size_t)k : q->from_group);
  attach(scene, geometry, id);
  return VL_OK;
}

/* Called by Embree's threads while a scene is built; n: the share that is done. */
static bool go_on(void *user, double n) {
  vlTask *task = user;
  return !vl_task_stopped(task, "accelerator", 0.5 + 0.5 * n);
}

static RTCScene new_scene(const vlWorld *world) {
  RTCScene scene = rtcNewScene(world->accel.device);
  if (!scene)
    return NULL;
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  if (world->task->cancel || world->task->progress)
    rtcSetSceneProgressMonitorFunction(scene, go_on, world->task);
  return scene;
}

/* Whether the address space has room for Embree's threads (their stacks and heaps). Embree's
 * threads end the process when they run out of memory during a build. The test reserves that
 * much address space, which takes no memory, and releases it again. */
static bool has_room(const vlWorld *world) {
  size_t primitives = 0;
  for (size_t i = 0; i < world->shapes.count; i++)
    if (world->shape_from[i] == VL_NONE)
      primitives += (size_t)world->shapes.items[i].faces + 1;
  size_t bytes = ((size_t)64 << 20) + ((size_t)72 << 20) * vl_context_threads(world->context) +
                 256 * primitives;
  return vl_machine_has_addresses(bytes);
}

static bool on_memory(void *context, ssize_t bytes, bool taken) {
  return vl_count_foreign(context, (int64_t)bytes, taken);
}

/* A world's accelerator under construction. */
typedef struct Builder {
  vlWorld *world;
  RTCDevice device;
  AccelGeometry *geometries; /* one per shape */
} Builder;

/* The device is shared with the previous world. */
static vlResult open_device(vlWorld *world, RTCDevice *device, vlError *error) {
  char config[64];
  *device = world->previous ? world->previous->accel.device : NULL;
  if (*device) {
    rtcRetainDevice(*device);
    return VL_OK;
  }
  VL_TRY(vl_try_threads(world->context, error));
  const char *set;
  VL_TRY(vl_embree_choose_set(world->def.bits, &set, error));
  snprintf(config, sizeof config, "threads=%u,hugepages=1%s%s",
           vl_context_threads(world->context), set ? ",isa=" : "", set ? set : "");
  *device = rtcNewDevice(config);
  if (!*device)
    return vl_fail(error, VL_ERROR_MEMORY, "Embree gives no device (error %d)",
                   (int)rtcGetDeviceError(NULL));
  rtcSetDeviceMemoryMonitorFunction(*device, on_memory, world->context);
  return VL_OK;
}

static vlResult device_error(RTCDevice device, vlError *error) {
  enum RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_OUT_OF_MEMORY)
    return vl_fail_memory(error);
  /* Embree's scheduler reports this error when memory is short */
  if (code == RTC_ERROR_UNKNOWN)
    return vl_fail(error, VL_ERROR_MEMORY, "Embree cannot build the scene (error %d)",
                   (int)code);
  if (code != RTC_ERROR_NONE)
    return vl_fail(error, VL_ERROR_SCENE, "Embree refuses the scene (error %d)", (int)code);
  return VL_OK;
}

/* Ends the building of a scene. done: the share of the groups that is built. */
static vlResult commit(const vlWorld *world, RTCScene scene, double done, vlError *error) {
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, NULL, NULL);
  VL_TRY(vl_world_step(world, "accelerator", 0.5 + 0.5 * done, error));
  return device_error(world->accel.device, error);
}

static vlResult attach_group(const Builder *b, RTCScene scene, uint32_t k, vlError *error) {
  const vlWorldGroup *group = &b->world->groups.items[k];
  const vlAccelBundle *bundle = &b->world->accel.bundles[k];
  vlResult r = VL_OK;
  for (uint32_t i = 0; r == VL_OK && i < group->count; i++) {
    AccelGeometry *g = &b->geometries[group->shapes[i]];
    if (bundle->members && i > bundle->geometry && vl_accel_bundled(g->shape))
      continue; /* is in the bundle */
    if (bundle->members && i == bundle->geometry)
      g->members = bundle->members;
    r = attach_shape(b->device, scene, i, g, bundle->count, error);
  }
  return r;
}

/* The scene of a group's shapes: shared, or built. */
static vlResult make_group(const Builder *b, uint32_t k, vlError *error) {
  vlWorld *world = b->world;
  vlAccel *a = &world->accel;
  RTCScene shared = vl_accel_find_group(world, k);
  if (shared) {
    rtcRetainScene(shared);
    a->groups[k] = shared;
    return VL_OK;
  }
  RTCScene scene = new_scene(world);
  if (!scene)
    return vl_fail_memory(error);
  a->groups[k] = scene;
  VL_TRY(attach_group(b, scene, k, error));
  return commit(world, scene, 1.0 / (k + 1), error);
}

/* The scene of the whole world, in one of three ways: that of group 0, if there are no
 * instances; one that contains the shapes of group 0 and the instances; or, split, one of
 * instances alone. */
static vlResult make_whole(const Builder *b, vlError *error) {
  vlWorld *world = b->world;
  vlAccel *a = &world->accel;
  uint32_t own = world->groups.items[0].count;
  vlResult r = VL_OK;
  if (vl_accel_same_whole(world)) {
    a->scene = world->previous->accel.scene;
    a->split = world->previous->accel.split;
    rtcRetainScene(a->scene);
    a->groups[0] = world->previous->accel.groups[0];
    if (a->groups[0])
      rtcRetainScene(a->groups[0]);
    return VL_OK;
  }
  if (world->instances.count == 0) {
    r = make_group(b, 0, error);
    a->scene = a->groups[0];
    if (a->scene)
      rtcRetainScene(a->scene);
    return r;
  }
  bool split = vl_accel_must_split(world);
  if (split)
    r = make_group(b, 0, error);
  if (r != VL_OK)
    return r;
  a->split = split;
  RTCScene scene = a->scene = new_scene(world);
  if (!scene)
    return vl_fail_memory(error);
  static const vlWorldInstance still = {.from_group = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
  r = split ? attach_instance(b->device, scene, a->groups[0], 0, &still, error)
            : attach_group(b, scene, 0, error);
  for (size_t i = 0; r == VL_OK && i < world->instances.count; i++) {
    const vlWorldInstance *instance = &world->instances.items[i];
    r = attach_instance(b->device, scene, a->groups[instance->group], own + (unsigned)i,
                        instance, error);
  }
  return r == VL_OK ? commit(world, scene, 1, error) : r;
}

vlResult vl_embree_build(vlWorld *world, vlError *error) {
  vlAccel *a = &world->accel;
  if (!has_room(world))
    return vl_fail_memory(error);
  RTCDevice device;
  vlResult r = open_device(world, &device, error);
  if (r != VL_OK)
    return r;
  a->device = device;
  a->packets = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
  Builder b = {world, device,
               vl_alloc_array(world->context, world->shapes.count + 1, sizeof *b.geometries)};
  if (!b.geometries)
    return vl_fail_memory(error);
  for (size_t i = 0; i < world->shapes.count; i++)
    b.geometries[i] = (AccelGeometry){world, &world->shapes.items[i], NULL};
  for (size_t k = world->groups.count; r == VL_OK && k-- > 1;)
    r = make_group(&b, (uint32_t)k, error);
  if (r == VL_OK)
    r = make_whole(&b, error);
  vl_free(world->context, b.geometries);
  return r == VL_OK ? device_error(device, error) : r;
}

void vl_embree_destroy(vlAccel *a) {
  for (uint32_t k = 0; k < a->group_count; k++)
    if (a->groups[k])
      rtcReleaseScene(a->groups[k]);
  if (a->scene)
    rtcReleaseScene(a->scene);
  if (a->device)
    rtcReleaseDevice(a->device);
}

/* ---- tracing ----------------------------------------------------------------------------- */

/* Macros that hide the difference between the queries of Embree 3 and 4. */
#if VELO_EMBREE_MAJOR >= 4
#define BEGIN_QUERY(query, r, coherent)                                         \
  Query query;                                                                  \
  rtcInitRayQueryContext(&query.context);                                       \
  query.q = (vlEmbreeQuery){.world = world, .rays = (r)};                       \
  struct RTCIntersectArguments closest_arguments;                               \
  rtcInitIntersectArguments(&closest_arguments);                                \
  closest_arguments.context = &query.context;                                   \
  closest_arguments.flags =                                                     \
      (coherent) ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT; \
  struct RTCOccludedArguments any_arguments;                                    \
  rtcInitOccludedArguments(&any_arguments);                                     \
  any_arguments.context = &query.context;                                       \
  any_arguments.flags = closest_arguments.flags;                                \
  (void)closest_arguments, (void)any_arguments
#define INTERSECT1(scene, ray) rtcIntersect1((scene), (ray), &closest_arguments)
#define OCCLUDED1(scene, ray) rtcOccluded1((scene), (ray), &any_arguments)
#define INTERSECT8(valid, scene, ray) rtcIntersect8((valid), (scene), (ray), &closest_arguments)
#define OCCLUDED8(valid, scene, ray) rtcOccluded8((valid), (scene), (ray), &any_arguments)
#else
#define BEGIN_QUERY(query, r, coherent)                   \
  Query query;                                            \
  rtcInitIntersectContext(&query.context);                \
  query.q = (vlEmbreeQuery){.world = world, .rays = (r)}; \
  query.context.flags =                                   \
      (coherent) ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
#define INTERSECT1(scene, ray) rtcIntersect1((scene), &query.context, (ray))
#define OCCLUDED1(scene, ray) rtcOccluded1((scene), &query.context, (ray))
#define INTERSECT8(valid, scene, ray) rtcIntersect8((valid), (scene), &query.context, (ray))
#define OCCLUDED8(valid, scene, ray) rtcOccluded8((valid), (scene), &query.context, (ray))
#endif

/* The shape whose ids were stored last: neighbours often meet the same. */
typedef struct LastShape {
  bool known;              /* false also where a geometry has several shapes */
  unsigned geometry, inst; /* Embree's numbers */
  uint32_t shape, instance;
} LastShape;

static inline void store_ids(const vlWorld *world, unsigned geom, unsigned prim, unsigned inst,
                             LastShape *last, uint32_t *shape, uint32_t *prim_out,
                             uint32_t *instance) {
  if (geom == RTC_INVALID_GEOMETRY_ID) {
    *shape = *prim_out = *instance = VL_NONE;
    return;
  }
  *prim_out = prim;
  if (!last->known || geom != last->geometry || inst != last->inst) {
    uint32_t number = instance_of(world, inst);
    const vlWorldShape *s = vl_accel_shape(world, number, geom, prim_out);
    *last = (LastShape){s->triangles, geom, inst, (uint32_t)(s - world->shapes.items),
                        index_of(world, number)};
  }
  *shape = last->shape;
  *instance = last->instance;
}

static void closest_packets(const vlWorld *world, uint32_t n, const vlRays *r, uint32_t *shape,
                            uint32_t *prim, uint32_t *instance, float *t) {
  BEGIN_QUERY(query, r, true);
  struct RTCRayHit8 q;
  vlNearestPacket nearest = {.normal = {q.hit.Ng_x, q.hit.Ng_y, q.hit.Ng_z},
                             .instance = q.hit.instID[0],
                             .geometry = q.hit.geomID,
                             .primitive = q.hit.primID};
  bool portable = world->def.bits == VL_BITS_PORTABLE;
  LastShape last = {.known = false};
  query.q.packet = portable ? &nearest : NULL;
  vl_packet_begin(&q.ray);
  for (uint32_t first = 0; first < n; first += VL_PACKET) {
    int valid[VL_PACKET] __attribute__((aligned(32)));
    query.q.first = first;
    vl_packet_clear(&nearest);
    vl_packet_fill(&q.ray, valid, r, first, n);
    memset(q.hit.geomID, 0xff, sizeof q.hit.geomID); /* RTC_INVALID_GEOMETRY_ID */
    memset(q.hit.instID, 0xff, sizeof q.hit.instID);
    INTERSECT8(valid, world->accel.scene, &q);
    const float *found = portable ? nearest.t : q.ray.tfar;
    for (uint32_t k = 0; k < VL_PACKET && first + k < n; k++) {
      t[first + k] = found[k];
      store_ids(world, q.hit.geomID[k], q.hit.primID[k], q.hit.instID[0][k], &last,
                &shape[first + k], &prim[first + k], &instance[first + k]);
    }
  }
}

/* Embree loads origin and direction as vectors of four. Stores of the same size reach these
 * loads without waiting for the cache. */
typedef float Four __attribute__((vector_size(16)));
_Static_assert(offsetof(struct RTCRay, dir_x) == sizeof(Four) &&
                   offsetof(struct RTCRay, tfar) == 2 * sizeof(Four),
               "a ray begins with two vectors of four");
static inline void fill_ray(struct RTCRay *q, const vlRays *r, uint32_t i) {
  Four origin = {r->ox[i], r->oy[i], r->oz[i], r->t_min ? r->t_min[i] : 0.0f};
  Four direction = {r->dx[i], r->dy[i], r->dz[i], r->time ? r->time[i] : 0.0f};
  memcpy(&q->org_x, &origin, sizeof origin);
  memcpy(&q->dir_x, &direction, sizeof direction);
  q->tfar = r->t_max ? r->t_max[i] : INFINITY;
  q->mask = (unsigned)-1;
  q->id = i;
  q->flags = 0;
}

void vl_embree_closest(const vlWorld *world, uint32_t n, const vlRays *rays, bool coherent,
                       uint32_t *shape, uint32_t *prim, uint32_t *instance, float *t) {
  if (coherent && world->accel.packets) {
    closest_packets(world, n, rays, shape, prim, instance, t);
    return;
  }
  BEGIN_QUERY(query, rays, false);
  vlNearest nearest;
  LastShape last = {.known = false};
  if (world->def.bits == VL_BITS_PORTABLE)
    query.q.nearest = &nearest;
  const bool sound = vl_rays_are_sound(rays, n);
  for (uint32_t i = 0; i < n; i++) {
    query.q.first = i;
    nearest.t = INFINITY;
    struct RTCRayHit q;
    fill_ray(&q.ray, rays, i);
    q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (sound || vl_ray_is_sound(rays, i))
      INTERSECT1(world->accel.scene, &q);
    t[i] = query.q.nearest ? nearest.t : q.ray.tfar;
    store_ids(world, q.hit.geomID, q.hit.primID, q.hit.instID[0], &last, &shape[i], &prim[i],
              &instance[i]);
  }
}

void vl_embree_occluded_packets(const vlWorld *world, uint32_t n, const vlRays *r,
                                uint8_t *occluded) {
  BEGIN_QUERY(query, r, true);
  struct RTCRay8 q;
  vl_packet_begin(&q);
  for (uint32_t first = 0; first < n; first += VL_PACKET) {
    int valid[VL_PACKET] __attribute__((aligned(32)));
    vl_packet_fill(&q, valid, r, first, n);
    OCCLUDED8(valid, world->accel.scene, &q);
    for (uint32_t k = 0; k < VL_PACKET && first + k < n; k++)
      occluded[first + k] = q.tfar[k] < 0;
  }
}

void vl_embree_occluded(const vlWorld *world, uint32_t n, const vlRays *rays,
                        vlOccluders *occluders, uint8_t *occluded) {
  BEGIN_QUERY(query, rays, false);
  query.q.occluders = occluders;
  const bool sound = vl_rays_are_sound(rays, n);
  for (uint32_t i = 0; i < n; i++) {
    if (occluded[i])
      continue;
    struct RTCRay q;
    fill_ray(&q, rays, i);
    if (sound || vl_ray_is_sound(rays, i))
      OCCLUDED1(world->accel.scene, &q);
    occluded[i] = q.tfar < 0;
  }
}
