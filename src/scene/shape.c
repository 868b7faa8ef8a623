/* scene/shape.c: adds shapes, groups and instances. Meshes may be large: one pass checks the
 * positions, one the indices. */
#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "base/free.h"
#include "base/text.h"
#include "math/double3.h"
#include "math/motion.h"
#include "math/transform.h"
#include "scene/family.h"
#include "schema/schema.h"
#include "velo/shape_kinds.h"

static bool bad(vlScene *scene, const vlShapeDef *d, const char *why) {
  return vl_scene_fail(scene, VL_ERROR_SCENE, d->source, "%s", why);
}

/* Index of the first element that is not finite, or count. A block of elements is checked as a
 * whole by the bits of the exponents, all of which are 1 only in an infinity or NaN: a loop
 * that vectorises. */
static size_t first_not_finite(const float *v, size_t count) {
  enum { BLOCK = 1024 };
  for (size_t start = 0; start < count; start += BLOCK) {
    size_t end = count - start < BLOCK ? count : start + BLOCK;
    uint32_t wrong = 0;
    for (size_t i = start; i < end; i++) {
      uint32_t bits;
      memcpy(&bits, &v[i], sizeof bits);
      wrong |= (bits & 0x7f800000u) == 0x7f800000u;
    }
    if (!wrong)
      continue;
    for (size_t i = start; i < end; i++)
      if (!isfinite(v[i]))
        return i;
  }
  return count;
}

static bool check_floats(vlScene *scene, const vlShapeDef *d, const float *v, size_t per,
                         const char *what) {
  if (!v)
    return true;
  size_t count = (size_t)d->vertices * per, i = first_not_finite(v, count);
  if (i == count)
    return true;
  return vl_scene_fail(scene, VL_ERROR_SCENE, d->source,
                       "%s of vertex %zu is not finite (%c is %f)", what, i / per,
                       per == 2 ? "uv"[i % per] : "xyz"[i % per], (double)v[i]);
}

static bool check_motion(vlScene *scene, const vlShapeDef *d) {
  if (!d->positions_close && !d->normals_close)
    return true;
  if (d->kind != VL_SHAPE_TRIANGLES)
    return bad(scene, d, "only vertices of triangles can move");
  if (!d->positions_close)
    return bad(scene, d, "normals move, but positions do not");
  if (!d->normals != !d->normals_close)
    return bad(scene, d, "normals are needed at both ends of a motion or at neither");
  if (!isfinite(d->times[0]) || !isfinite(d->times[1]) || !(d->times[0] < d->times[1]))
    return vl_scene_fail(scene, VL_ERROR_SCENE, d->source,
                         "vertices cannot move from %g to %g seconds", d->times[0],
                         d->times[1]);
  return check_floats(scene, d, d->positions_close, 3, "position at the end") &&
         check_floats(scene, d, d->normals_close, 3, "normal at the end");
}

static bool check_colors(vlScene *scene, const vlShapeDef *d) {
  size_t count = d->colors ? (size_t)d->vertices * 4 : 0,
         i = first_not_finite(d->colors, count);
  if (i < count)
    vl_scene_fail(scene, VL_ERROR_SCENE, d->source, "colour of vertex %zu is not finite",
                  i / 4);
  return i == count;
}

static bool check_mesh(vlScene *scene, const vlShapeDef *d) {
  size_t per = d->kind == VL_SHAPE_TRIANGLES ? 3 : 4;
  const char *face = per == 3 ? "triangle" : "patch";
  if (d->vertices == 0 || !d->positions)
    return bad(scene, d, "mesh has no vertices");
  if (d->faces == 0 || !d->indices)
    return bad(scene, d, "mesh has no faces");
  size_t count = (size_t)d->faces * per;
  uint32_t top = 0;
  for (size_t i = 0; i < count; i++)
    top = d->indices[i] > top ? d->indices[i] : top;
  if (top >= d->vertices) {
    size_t i = 0;
    while (d->indices[i] < d->vertices)
      i++;
    return vl_scene_fail(scene, VL_ERROR_SCENE, d->source,
                         "%s %zu names vertex %u, but there are only %u vertices (0 to %u)",
                         face, i / per, d->indices[i], d->vertices, d->vertices - 1);
  }
  return check_floats(scene, d, d->positions, 3, "position") &&
         check_floats(scene, d, d->normals, 3, "normal") &&
         check_floats(scene, d, d->tangents, 3, "tangent") &&
         check_floats(scene, d, d->uvs, 2, "uv") &&
         check_floats(scene, d, d->tangent_signs, 1, "sign of the tangent") &&
         check_floats(scene, d, d->more_uvs[0], 2, "uv of set 1") &&
         check_floats(scene, d, d->more_uvs[1], 2, "uv of set 2") &&
         check_floats(scene, d, d->more_uvs[2], 2, "uv of set 3") && check_colors(scene, d) &&
         check_motion(scene, d);
}

static bool check_curves(vlScene *scene, const vlShapeDef *d) {
  if (d->faces == 0 || !d->positions)
    return bad(scene, d, "curves have no segments");
  if (!d->widths)
    return bad(scene, d, "curves need widths, two for each segment");
  if (d->faces > 0x1fffffff || d->vertices != 4 * d->faces)
    return bad(scene, d, "curves need four points for each segment");
  if (d->curve == VL_CURVE_RIBBON && !d->normals)
    return bad(scene, d, "ribbons need normals");
  if (first_not_finite(d->widths, 2 * (size_t)d->faces) < 2 * (size_t)d->faces ||
      (d->normals && first_not_finite(d->normals, 6 * (size_t)d->faces) < 6 * (size_t)d->faces))
    return bad(scene, d, "a width or normal of a curve is not finite");
  for (size_t i = 0; i < 2 * (size_t)d->faces; i++)
    if (d->widths[i] < 0.0f)
      return bad(scene, d, "a curve's width is negative");
  return check_floats(scene, d, d->positions, 3, "position");
}

static bool check_spheres(vlScene *scene, const vlShapeDef *d) {
  if (!d->centers || !d->radii || d->faces == 0 || d->faces > 0x7fffffff)
    return bad(
        scene, d,
        "many spheres: they need centers, radii and a number of faces from 1 to 2^31 - 1");
  if (d->emission.index)
    return bad(scene, d, "many spheres as one shape cannot be area lights");
  for (size_t i = 0; i < d->faces; i++) {
    const double *c = d->centers + 3 * i;
    if (!isfinite(c[0] + c[1] + c[2]))
      return vl_scene_fail(scene, VL_ERROR_SCENE, d->source,
                           "the center of sphere %zu is not finite", i);
    if (!(d->radii[i] > 0.0f) || !isfinite(d->radii[i]))
      return vl_scene_fail(scene, VL_ERROR_SCENE, d->source,
                           "the radius of sphere %zu must be above 0, it is %g", i,
                           (double)d->radii[i]);
  }
  return true;
}

/* Checks rules that the ranges of the row do not express. */
static bool check_quadric(vlScene *scene, const vlShapeDef *d) {
  if (d->centers || d->radii)
    return check_spheres(scene, d);
  if (d->kind == VL_SHAPE_DISK && d->inner_radius >= d->radius)
    return bad(scene, d, "inner radius must be less than the radius");
  if (d->kind != VL_SHAPE_DISK && !(d->z_min < d->z_max))
    return bad(scene, d, "zmin must be below zmax");
  if (d->kind == VL_SHAPE_SPHERE && (d->z_min >= d->radius || d->z_max <= -d->radius))
    return bad(scene, d, "zmin and zmax leave nothing of the sphere");
  return true;
}

static bool check_displacement(vlScene *scene, const vlShapeDef *d) {
  uint32_t index = d->displacement.texture.index;
  if (!index)
    return true;
  if (d->kind != VL_SHAPE_TRIANGLES || d->positions_close)
    return bad(scene, d, "displacement: only triangles at rest can be displaced");
  return true;
}

bool vl_shape_may_emit(const vlShapeDef *d) {
  const vlKindRow *row = vl_kind_row(&vl_shape_family, (int)d->kind);
  return (row->traits & VL_SHAPE_TRAIT_EMITS) && !d->centers && !d->radii;
}

/* Whether an id is none, or that of an object of the scene. */
static bool is_there(const vlScene *scene, vlSceneFamily family, uint32_t index) {
  return index == 0 || vl_scene_has(scene, family, index);
}

static bool check_shape(vlScene *scene, vlShapeDef *d) {
  const vlKindRow *row = vl_kind_row(&vl_shape_family, (int)d->kind);
  if (!row)
    return bad(scene, d, "unknown kind of shape");
  if (!vl_row_take(scene, row, d, false, d->source, row->name))
    return false;
  if (d->emission.index && !(row->traits & VL_SHAPE_TRAIT_EMITS))
    return bad(scene, d, "shapes of this kind cannot be area lights");
  if (!is_there(scene, VL_SCENE_GROUPS, d->group.index))
    return bad(scene, d, "there is no such group");
  if (!is_there(scene, VL_SCENE_MATERIALS, d->material.index))
    return bad(scene, d, "there is no such material");
  if (!is_there(scene, VL_SCENE_EMISSIONS, d->emission.index))
    return bad(scene, d, "there is no such emission");
  if (!is_there(scene, VL_SCENE_MEDIA, d->inside.index) ||
      !is_there(scene, VL_SCENE_MEDIA, d->outside.index))
    return bad(scene, d, "there is no such medium");
  if (!check_displacement(scene, d))
    return false;
  const double *m = d->group_from_shape;
  if (!vl_mat4_is_finite(vl_mat4_load(m)))
    return bad(scene, d, "transform of the shape is not finite");
  double det = vl_determinant3(m);
  if (det == 0.0 || !isfinite(det))
    return bad(scene, d, "transform of the shape is singular: it flattens the shape");
  if (row->traits & VL_SHAPE_TRAIT_MESH)
    return check_mesh(scene, d);
  if (row->traits & VL_SHAPE_TRAIT_QUADRIC)
    return check_quadric(scene, d);
  /* for other kinds the row is enough */
  return d->kind != VL_SHAPE_CURVES || check_curves(scene, d);
}

/* Stores a def. The scene must own the def's arrays, or they are null. */
static vlShapeId push_shape(vlScene *scene, const vlShapeDef *d) {
  const vlShapeId id = {vl_scene_push(scene, VL_SCENE_SHAPES, d)};
  if (id.index && d->group.index)
    scene->groups.items[d->group.index - 1].shape_count++;
  return id;
}

void vl_shape_drop_attributes(vlShapeDef *d) {
  d->tangents = d->uvs = d->positions_close = d->normals_close = NULL;
  d->tangent_signs = d->colors = d->more_uvs[0] = d->more_uvs[1] = d->more_uvs[2] = NULL;
  d->indices = NULL;
}

static void drop_unused(vlShapeDef *d) {
  if (d->kind != VL_SHAPE_SPHERE) {
    d->centers = NULL;
    d->radii = NULL;
  }
  if (vl_shape_is_mesh(d->kind)) {
    d->widths = NULL;
    return;
  }
  if (d->kind == VL_SHAPE_CURVES) {
    if (d->curve != VL_CURVE_RIBBON)
      d->normals = NULL;
    vl_shape_drop_attributes(d);
    return;
  }
  d->widths = NULL;
  d->vertices = 0;
  if (!d->centers && !d->radii)
    d->faces = 0;
  d->positions = d->normals = NULL;
  vl_shape_drop_attributes(d);
}

vlShapeId vl_scene_add_shape(vlScene *scene, const vlShapeDef *def) {
  const vlShapeId none = {0};
  if (!vl_scene_may_add(scene, VL_SCENE_SHAPES, def))
    return none;
  vlShapeDef d = *def;
  drop_unused(&d);
  if (!vl_scene_copy_source(scene, &d.source) || !vl_scene_copy_label(scene, &d.label) ||
      !check_shape(scene, &d))
    return none;
  size_t v = d.vertices, per = d.kind == VL_SHAPE_TRIANGLES ? 3 : 4;
  size_t normals = d.kind == VL_SHAPE_CURVES ? 2 * (size_t)d.faces : v;
  const struct {
    void *array; /* its address in the def */
    size_t count, size;
  } arrays[] = {{&d.positions, v, 3 * sizeof(float)},
                {&d.normals, normals, 3 * sizeof(float)},
                {&d.tangents, v, 3 * sizeof(float)},
                {&d.uvs, v, 2 * sizeof(float)},
                {&d.positions_close, v, 3 * sizeof(float)},
                {&d.normals_close, v, 3 * sizeof(float)},
                {&d.tangent_signs, v, sizeof(float)},
                {&d.colors, v, 4 * sizeof(float)},
                {&d.widths, 2 * (size_t)d.faces, sizeof(float)},
                {&d.centers, d.faces, 3 * sizeof(double)},
                {&d.radii, d.faces, sizeof(float)},
                {&d.indices, d.faces, per * sizeof(uint32_t)},
                {&d.more_uvs[0], v, 2 * sizeof(float)},
                {&d.more_uvs[1], v, 2 * sizeof(float)},
                {&d.more_uvs[2], v, 2 * sizeof(float)}};
  for (size_t i = 0; i < VL_LENGTH(arrays); i++)
    if (!vl_scene_copy_array(scene, arrays[i].array, arrays[i].count, arrays[i].size))
      return none;
  return push_shape(scene, &d);
}

vlShapeId vl_scene_adopt_shape(vlScene *scene, const vlShapeDef *def) {
  vlShapeDef d = *def;
  bool fine = scene->error.code == VL_OK && d.cookie == VL_COOKIE_SHAPE &&
              vl_scene_copy_source(scene, &d.source) && vl_scene_copy_label(scene, &d.label) &&
              check_shape(scene, &d);
  const void *blocks[VL_SHAPE_ARRAYS];
  vl_shape_arrays(&d, blocks);
  for (int i = 0; i < VL_SHAPE_ARRAYS; i++) {
    void *block = vl_owned(blocks[i]);
    if (fine)
      fine = vl_scene_own(scene, block);
    else
      vl_free(scene->context, block);
  }
  return fine ? push_shape(scene, &d) : (vlShapeId){0};
}

vlGroupId vl_scene_add_group(vlScene *scene, const char *name) {
  const vlGroupId none = {0};
  if (scene->error.code != VL_OK)
    return none;
  if (!name)
    name = "";
  if (!vl_scene_copy_string(scene, &name))
    return none;
  const vlSceneGroup group = {.name = name};
  return (vlGroupId){vl_scene_push(scene, VL_SCENE_GROUPS, &group)};
}

static bool check_pose(vlScene *scene, const double *m, vlSource source) {
  for (int i = 0; i < 16; i++) {
    if (m && isfinite(m[i]))
      continue;
    return vl_scene_fail(scene, VL_ERROR_SCENE, source, "instance: transform is not finite");
  }
  return true;
}

/* A new instance of an existing group; null after an error. */
static vlSceneInstance *push_instance(vlScene *scene, vlGroupId group, const double *pose,
                                      vlSource source) {
  if (scene->error.code != VL_OK)
    return NULL;
  if (!vl_scene_has(scene, VL_SCENE_GROUPS, group.index)) {
    vl_scene_fail(scene, VL_ERROR_SCENE, source, "instance: there is no such group");
    return NULL;
  }
  if (!check_pose(scene, pose, source) || !vl_scene_copy_source(scene, &source))
    return NULL;
  vlSceneInstance *slot = VL_PUSH(scene->context, &scene->instances);
  if (!slot) {
    vl_scene_fail(scene, VL_ERROR_MEMORY, source, "out of memory");
    return NULL;
  }
  *slot = (vlSceneInstance){.group = group, .source = source};
  memcpy(slot->world_from_group, pose, sizeof slot->world_from_group);
  return slot;
}

vlInstanceId vl_scene_add_instance(vlScene *scene, vlGroupId group,
                                   const double world_from_group[16], vlSource source) {
  bool added = push_instance(scene, group, world_from_group, source) != NULL;
  return (vlInstanceId){added ? (uint32_t)scene->instances.count : 0};
}

void vl_scene_label_instance(vlScene *scene, const vlLabel *label) {
  if (scene->error.code != VL_OK || scene->instances.count == 0)
    return;
  vlLabel copy = *label;
  if (vl_scene_copy_label(scene, &copy))
    scene->instances.items[scene->instances.count - 1].label = copy;
}

static bool check_keys(vlScene *scene, uint32_t keys, const double *times, const double *poses,
                       vlSource source) {
  for (uint32_t k = 0; k < keys; k++) {
    if (!check_pose(scene, poses + 16 * (size_t)k, source))
      return false;
    if (isfinite(times[k]) && (k == 0 || times[k] > times[k - 1]))
      continue;
    return vl_scene_fail(scene, VL_ERROR_SCENE, source,
                         "instance: the times of its poses do not ascend (%g)", times[k]);
  }
  for (uint32_t k = 0; k + 1 < keys; k++) {
    vlMotion motion;
    if (vl_motion_make(poses + 16 * (size_t)k, poses + 16 * (size_t)(k + 1), &motion))
      continue;
    return vl_scene_fail(
        scene, VL_ERROR_SCENE, source,
        "instance: no motion leads from one pose to the next: one is singular, not "
        "affine, or mirrors alone");
  }
  return true;
}

vlInstanceId vl_scene_add_moving_instance(vlScene *scene, vlGroupId group, uint32_t keys,
                                          const double *times, const double *world_from_group,
                                          vlSource source) {
  const vlInstanceId none = {0};
  if (scene->error.code != VL_OK)
    return none;
  if (keys == 0 || keys > 65536 || !times || !world_from_group) {
    vl_scene_fail(scene, VL_ERROR_ARGUMENT, source,
                  "instance: a motion needs 1 to 65536 poses and their times");
    return none;
  }
  if (!check_keys(scene, keys, times, world_from_group, source))
    return none;
  const double *kept_times = times, *kept_poses = world_from_group;
  if (!vl_scene_copy_block(scene, times, keys, sizeof *times, &kept_times) ||
      !vl_scene_copy_block(scene, world_from_group, keys, 16 * sizeof *world_from_group,
                           &kept_poses))
    return none;
  vlSceneInstance *slot = push_instance(scene, group, world_from_group, source);
  if (!slot)
    return none;
  slot->keys = keys > 1 ? keys : 0;
  slot->times = kept_times;
  slot->poses = kept_poses;
  return (vlInstanceId){(uint32_t)scene->instances.count};
}
