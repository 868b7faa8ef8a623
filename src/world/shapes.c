/* world/shapes.c: compiles the shapes of a scene: members that all kinds have, groups and
 * instances, bounds. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "schema/schema.h"
#include "shape/displace.h"
#include "shape/surface_point.h"
#include "velo/schema.h"
#include "velo/shape_kinds.h"
#include "world/moving.h"
#include "world/share.h"
#include "world/world.h"

static void store_affine_f(const vlMat4 *m, float r[12]) {
  for (int i = 0; i < 12; i++)
    r[i] = (float)m->m[i];
}
static void store_affine_d(const vlMat4 *m, double r[12]) {
  for (int i = 0; i < 12; i++)
    r[i] = m->m[i];
}

vlResult vl_fail_shape(const vlShapeDef *def, vlError *error, const char *what) {
  return vl_fail_source(error, VL_ERROR_SCENE, def->source, "%s", what);
}

static vlResult constant_node(vlWorld *world, const vlScene *scene, float value, int32_t *node,
                              vlError *error) {
  return vl_world_float_node(world, scene, vl_float_input(value), node, error);
}

/* A mix with an interface among its parts is compiled as a material with holes: the share that
 * is not interface multiplies the shape's alpha. */
static vlResult cut_interface(vlWorld *world, const vlScene *scene, const vlShapeDef *def,
                              vlWorldShape *s, vlError *error) {
  const vlWorldMaterial *m = &world->materials.items[s->material];
  int32_t presence = m->presence, whole = s->alpha, none;
  /* of a mix with the interface, the other part is all there is */
  for (; m->mixed; m = &world->materials.items[s->material]) {
    const vlWorldMaterial *first = &world->materials.items[m->mix[0]];
    const vlWorldMaterial *second = &world->materials.items[m->mix[1]];
    if (!first->nothing && !second->nothing)
      break;
    s->material = m->mix[first->nothing && !second->nothing ? 1 : 0];
  }
  if (presence < 0)
    return VL_OK;
  if (def->inside.index != def->outside.index)
    return vl_fail_shape(def, error, "a mix with an interface cannot divide two media");
  VL_TRY(constant_node(world, scene, 0.0f, &none, error));
  if (whole < 0)
    VL_TRY(constant_node(world, scene, 1.0f, &whole, error));
  return vl_world_mix_node(world, none, whole, presence, &s->alpha, error);
}

static void grow_bounds(float low[3], float high[3], const float p[3]) {
  for (int i = 0; i < 3; i++) {
    low[i] = p[i] < low[i] ? p[i] : low[i];
    high[i] = p[i] > high[i] ? p[i] : high[i];
  }
}

static void empty_bounds(float low[3], float high[3]) {
  for (int i = 0; i < 3; i++) {
    low[i] = INFINITY;
    high[i] = -INFINITY;
  }
}

static void compute_bounds(const vlWorldShape *s, float low[3], float high[3]) {
  empty_bounds(low, high);
  if (vl_shape_is_mesh(s->kind)) { /* the box covers all time steps */
    for (size_t i = 0; i < (size_t)s->steps * s->vertices; i++)
      grow_bounds(low, high, s->positions + 3 * i);
    return;
  }
  for (uint32_t i = 0; i < s->faces; i++) {
    float a[3], b[3];
    vl_world_prim_bounds(s, i, a, b);
    grow_bounds(low, high, a);
    grow_bounds(low, high, b);
  }
}

static vlResult compile_geometry(vlWorld *world, const vlScene *scene, const vlShapeDef *def,
                                 const vlMat4 *m, const vlMat4 *inverse, vlWorldShape *s,
                                 vlError *error) {
  if (!def->displacement.texture.index)
    return vl_shape_compile(world, def, m, inverse, s, error);
  vlShapeDef fine;
  vlPart *part = world->part;
  world->part = NULL; /* texture nodes belong to the world */
  vlResult r = vl_world_displace(world, scene, def, m, &fine, error);
  world->part = part;
  if (r != VL_OK)
    return r;
  r = vl_shape_compile(world, &fine, m, inverse, s, error);
  vl_world_displace_free(world, &fine);
  return r;
}

/* Compiles the geometry, or shares that of the previous world. Shapes with arrays have a part
 * for them. */
static vlResult add_geometry(vlWorld *world, const vlScene *scene, size_t index,
                             const vlMat4 *m, const vlMat4 *inverse, vlWorldShape *s,
                             vlError *error) {
  const vlShapeDef *def = &scene->shapes.items[index];
  const bool arrays =
      vl_shape_is_mesh(def->kind) || def->kind == VL_SHAPE_CURVES || def->centers;
  bool done;
  world->shape_parts[index] = NULL;
  world->shape_from[index] = VL_NONE;
  if (!vl_shape_reuse(world, scene, index, s, &done))
    return vl_fail_memory(error);
  if (done)
    return VL_OK;
  vlPart *part = arrays ? vl_part_add(world) : NULL;
  if (arrays && !part)
    return vl_fail_memory(error);
  world->part = part;
  vlResult r = compile_geometry(world, scene, def, m, inverse, s, error);
  world->part = NULL;
  if (r != VL_OK || !part)
    return r;
  compute_bounds(s, part->low, part->high);
  world->shape_parts[index] = part;
  return vl_shape_match(world, index, s) ? VL_OK : vl_fail_memory(error);
}

static vlResult add_shape(vlWorld *world, const vlScene *scene, size_t index, vlError *error) {
  const vlShapeDef *def = &scene->shapes.items[index];
  vlWorldShape *s = &world->shapes.items[index];
  vlMat4 m = vl_mat4_load(def->group_from_shape), inverse;
  if (!vl_mat4_inverse(m, &inverse))
    return vl_fail_shape(def, error, "the shape's transform is singular");
  bool mirrored = vl_determinant3(m.m) < 0;
  memset(s, 0, sizeof *s);
  s->kind = def->kind;
  s->triangles = def->kind == VL_SHAPE_TRIANGLES;
  s->traits = vl_kind_row(&vl_shape_family, (int)def->kind)->traits;
  s->material = def->material.index; /* 0 is the default material */
  s->first_light = VL_NONE;
  s->flip = def->reverse_orientation != mirrored;
  s->backdrop = def->backdrop;
  s->hidden = def->hidden_from_camera;
  s->alpha = -1; /* opaque */
  if (vl_scene_shape_is_removed(scene, index)) {
    s->steps = 1;
    world->shape_parts[index] = NULL;
    world->shape_from[index] = VL_NONE;
    return VL_OK;
  }
  if (def->alpha.texture.index || def->alpha.value < 1) {
    VL_TRY(vl_world_float_node(world, scene, def->alpha, &s->alpha, error));
  }
  VL_TRY(cut_interface(world, scene, def, s, error));
  s->pass_shadow = world->materials.items[s->material].traits & VL_MATERIAL_ABSENT;
  world->has_subsurface =
      world->has_subsurface || world->materials.items[s->material].has_subsurface;
  s->radius = def->radius;
  s->inner_radius = def->inner_radius;
  s->height = def->height;
  s->phi_max = def->phi_max;
  s->z_min = def->z_min < def->z_max ? def->z_min : def->z_max;
  s->z_max = def->z_min < def->z_max ? def->z_max : def->z_min;
  if (def->kind == VL_SHAPE_SPHERE) {
    s->z_min = s->z_min < -s->radius ? -s->radius : s->z_min;
    s->z_max = s->z_max > s->radius ? s->radius : s->z_max;
  }
  s->faces = s->steps = 1;
  store_affine_d(&m, s->from_shape);
  store_affine_d(&inverse, s->to_shape);
  vlResult result = add_geometry(world, scene, index, &m, &inverse, s, error);
  world->has_one_sided = world->has_one_sided || s->one_sided;
  world->has_alpha = world->has_alpha || s->alpha >= 0;
  world->has_hidden = world->has_hidden || s->hidden;
  return result;
}

/* Extends the box by a shape. */
static void shape_bounds(const vlWorld *world, size_t index, float low[3], float high[3]) {
  const vlPart *part = world->shape_parts[index];
  float a[3], b[3];
  if (!part)
    compute_bounds(&world->shapes.items[index], a, b);
  const float *from = part ? part->low : a, *to = part ? part->high : b;
  if (!(from[0] <= to[0]))
    return;
  grow_bounds(low, high, from);
  grow_bounds(low, high, to);
}

static void set_group_bounds(const vlWorld *world, vlWorldGroup *group) {
  empty_bounds(group->low, group->high);
  for (uint32_t i = 0; i < group->count; i++)
    shape_bounds(world, group->shapes[i], group->low, group->high);
}

static void instance_bounds(const vlWorld *world, const vlWorldInstance *instance, float low[3],
                            float high[3]) {
  const float *a = world->groups.items[instance->group].low;
  const float *b = world->groups.items[instance->group].high;
  for (uint32_t key = 0; key == 0 || key < instance->keys; key++) {
    const float *m = instance->keys ? instance->path + 12 * (size_t)key : instance->from_group;
    for (int c = 0; a[0] <= b[0] && c < 8; c++) {
      vlVec3 corner = vl_vec3(c & 1 ? a[0] : b[0], c & 2 ? a[1] : b[1], c & 4 ? a[2] : b[2]);
      vlVec3 q = vl_affine_point(m, corner);
      grow_bounds(low, high, (const float[]){q.x, q.y, q.z});
    }
  }
}

/* Checks that all coordinates are within 1e18 of 0; rays cannot be traced beyond. */
static vlResult check_reach(const float low[3], const float high[3], const vlSource *source,
                            vlError *error) {
  for (int i = 0; i < 3; i++)
    if (low[i] <= high[i] && !(low[i] > -1e18f && high[i] < 1e18f))
      return vl_fail_source(
          error, VL_ERROR_SCENE, *source,
          "the shape reaches from %g to %g: rays can be followed to 1e18 at most",
          (double)low[i], (double)high[i]);
  return VL_OK;
}

/* If edges are shorter, distances of near hits (a length times an area) have few digits or
 * none, and a triangle can shadow itself. The product of the ray offset, 6e-7 edge lengths, and
 * twice the area must exceed 2^-126 (docs/conventions.md). */
#define SMALLEST_EDGE 1e-10f

/* Warns about the first shape whose triangles are too small. Their size is estimated from the
 * shape's box. */
static void check_edges(const vlWorld *world, const float low[3], const float high[3],
                        uint64_t triangles, const vlSource *source, bool *warned) {
  if (*warned || triangles == 0 || !(low[0] <= high[0]))
    return;
  float extent = fmaxf(fmaxf(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
  float edge = extent / sqrtf(fmaxf(0.5f * (float)triangles, 1.0f));
  if (!(edge < SMALLEST_EDGE) || extent == 0)
    return;
  vl_world_warn(
      world, *source,
      "triangles of about %.2g: edges below %g may hide light from themselves; use a smaller "
      "unit of length",
      (double)edge, (double)SMALLEST_EDGE);
  *warned = true;
}

static uint64_t group_triangles(const vlWorld *world, const vlWorldGroup *group) {
  uint64_t sum = 0;
  for (uint32_t i = 0; i < group->count; i++) {
    const vlWorldShape *s = &world->shapes.items[group->shapes[i]];
    if (s->kind == VL_SHAPE_TRIANGLES)
      sum += s->faces;
  }
  return sum;
}

/* Bounds of the world so far. */
typedef struct Bounds {
  vlWorld *world;
  float low[3], high[3];
  bool warned;
  vlError *error;
} Bounds;

/* Adds the box from a to b of a shape or an instance with so many triangles. */
static vlResult add_bounds(Bounds *all, const float a[3], const float b[3], uint64_t triangles,
                           const vlSource *source) {
  check_edges(all->world, a, b, triangles, source, &all->warned);
  if (a[0] <= b[0]) {
    grow_bounds(all->low, all->high, a);
    grow_bounds(all->low, all->high, b);
  }
  return check_reach(all->low, all->high, source, all->error);
}

static vlResult set_world_bounds(vlWorld *world, const vlScene *scene, vlError *error) {
  Bounds bounds = {.world = world, .error = error};
  float *low = bounds.low, *high = bounds.high, a[3], b[3];
  empty_bounds(low, high);
  const vlWorldGroup *root = &world->groups.items[0];
  for (uint32_t i = 0; i < root->count; i++) {
    const vlWorldShape *s = &world->shapes.items[root->shapes[i]];
    const vlSource *source = &scene->shapes.items[root->shapes[i]].source;
    empty_bounds(a, b);
    shape_bounds(world, root->shapes[i], a, b);
    VL_TRY(add_bounds(&bounds, a, b, s->kind == VL_SHAPE_TRIANGLES ? s->faces : 0, source));
  }
  for (size_t i = 0, k = 0; k < world->instances.count; i++) {
    if (scene->instances.items[i].hidden ||
        world->groups.items[scene->instances.items[i].group.index].count == 0)
      continue;
    const vlSource *source = &scene->instances.items[i].source;
    const vlWorldInstance *instance = &world->instances.items[k++];
    empty_bounds(a, b);
    instance_bounds(world, instance, a, b);
    VL_TRY(add_bounds(&bounds, a, b,
                      group_triangles(world, &world->groups.items[instance->group]), source));
  }
  for (int i = 0; i < 3; i++) {
    if (low[i] > high[i])
      low[i] = high[i] = 0;
    world->bounds_min[i] = low[i];
    world->bounds_max[i] = high[i];
    world->center[i] = 0.5f * (low[i] + high[i]);
  }
  float d[3] = {high[0] - world->center[0], high[1] - world->center[1],
                high[2] - world->center[2]};
  world->radius = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return VL_OK;
}

static vlResult add_instances(vlWorld *world, const vlScene *scene, vlError *error) {
  VL_EACH_ITEM(const vlSceneInstance, source, &scene->instances) {
    if (source->hidden || world->groups.items[source->group.index].count == 0)
      continue;
    vlWorldInstance *instance = VL_PUSH(world->context, &world->instances);
    if (!instance)
      return vl_fail_memory(error);
    memset(instance, 0, sizeof *instance);
    vlMat4 m = vl_mat4_load(source->world_from_group), inverse;
    if (!vl_mat4_inverse(m, &inverse))
      return vl_fail_source(error, VL_ERROR_SCENE, source->source,
                            "the instance's transform is singular");
    instance->group = source->group.index;
    instance->mirrored = vl_determinant3(m.m) < 0;
    store_affine_f(&m, instance->from_group);
    store_affine_f(&inverse, instance->to_group);
    vl_instance_error(instance->from_group, instance->to_group, instance->error);
    if (source->keys == 0)
      continue;
    const vlWorldGroup *group = &world->groups.items[source->group.index];
    VL_TRY(vl_world_add_motion(world, source, group->low, group->high, instance, error));
  }
  return VL_OK;
}

/* Whether rays can hit a shape: it is shown, and a mesh has faces. */
static bool is_in_group(const vlScene *scene, size_t index) {
  const vlShapeDef *def = &scene->shapes.items[index];
  return (def->faces || !vl_shape_is_mesh(def->kind)) &&
         !vl_scene_mark(&scene->shape_marks, index).hidden;
}

vlResult vl_world_add_shapes(vlWorld *world, const vlScene *scene, vlError *error) {
  size_t group_count = scene->groups.count + 1;
  vl_world_find_times(world, scene);
  if (!VL_RESERVE_ZERO(world->context, &world->shapes, scene->shapes.count) ||
      !VL_RESERVE_ZERO(world->context, &world->groups, group_count))
    return vl_fail_memory(error);
  world->shape_parts = vl_world_block(world, scene->shapes.count, sizeof(vlPart *));
  world->shape_from = vl_world_block(world, scene->shapes.count, sizeof(uint32_t));
  if (!world->shape_parts || !world->shape_from)
    return vl_fail_memory(error);
  world->groups.count = group_count;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *def = &scene->shapes.items[i];
    vlResult r = vl_world_step(world, "shapes",
                               0.4 + 0.1 * (double)i / (double)scene->shapes.count, error);
    if (r == VL_OK)
      r = add_shape(world, scene, i, error);
    if (r != VL_OK)
      return r;
    world->shapes.count = i + 1;
    if (is_in_group(scene, i))
      world->groups.items[def->group.index].count++;
    world->info.primitives += world->shapes.items[i].faces;
    if (def->kind == VL_SHAPE_TRIANGLES)
      world->info.triangles += world->shapes.items[i].faces;
  }
  for (size_t k = 0; k < group_count; k++) {
    vlWorldGroup *group = &world->groups.items[k];
    group->shapes = vl_world_block(world, group->count, sizeof(uint32_t));
    if (!group->shapes)
      return vl_fail_memory(error);
    group->count = 0;
  }
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *def = &scene->shapes.items[i];
    if (!is_in_group(scene, i))
      continue;
    vlWorldGroup *group = &world->groups.items[def->group.index];
    group->shapes[group->count++] = (uint32_t)i;
  }
  for (size_t k = 0; k < group_count; k++)
    set_group_bounds(world, &world->groups.items[k]);
  vlResult r = add_instances(world, scene, error);
  if (r == VL_OK)
    r = set_world_bounds(world, scene, error);
  world->info.instances = world->instances.count;
  return r;
}
