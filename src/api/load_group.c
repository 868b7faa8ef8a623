/* api/load_group.c: vl_scene_load_group: loads a file and gathers its shapes in one group. */
#include <string.h>

#include "math/transform.h"
#include "scene/extent.h"
#include "schema/schema.h"
#include "velo/group.h"
#include "velo/shape.h"

/* Numbers of a scene's things before a file was loaded. */
typedef struct Before {
  size_t shapes, instances, lights, choices, points;
  vlSceneDefs defs;
} Before;

static void turn_inside_out(vlShapeDef *d, const double pose[16]) {
  /* Instances never flip normals, but a mirroring group_from_shape does, except those of meshes
   * (vlShapeDef). */
  if (!vl_shape_is_mesh(d->kind) && vl_determinant3(pose) < 0)
    d->reverse_orientation = !d->reverse_orientation;
}

static void move_shape(vlShapeDef *d, vlGroupId group, const double pose[16]) {
  vlMat4 m = vl_mat4_multiply(vl_mat4_load(pose), vl_mat4_load(d->group_from_shape));
  memcpy(d->group_from_shape, m.m, sizeof m.m);
  d->group = group;
  turn_inside_out(d, pose);
}

/* A loaded shape as the importer added it. */
typedef struct Loaded {
  uint32_t group;
  double pose[16];
  bool reversed;
} Loaded;

/* Replaces an instance by its shapes: the first instance of a group takes the group's shapes,
 * the others copy them. */
static bool dissolve(vlScene *scene, size_t first_shape, const Loaded *all, size_t count,
                     vlGroupId group, const vlSceneInstance *instance) {
  for (size_t i = 0; i < count; i++) {
    if (all[i].group != instance->group.index)
      continue;
    vlShapeDef *d = &scene->shapes.items[first_shape + i];
    if (d->group.index != group.index) {
      scene->groups.items[d->group.index - 1].shape_count--;
      scene->groups.items[group.index - 1].shape_count++;
      move_shape(d, group, instance->world_from_group);
      continue;
    }
    vlShapeDef copy = *d;
    memcpy(copy.group_from_shape, all[i].pose, sizeof copy.group_from_shape);
    copy.reverse_orientation = all[i].reversed;
    move_shape(&copy, group, instance->world_from_group);
    if (!vl_scene_add_shape(scene, &copy).index)
      return false;
  }
  return true;
}

static bool gather(vlScene *scene, const Before *before, vlGroupId group,
                   vlLoadedGroup *loaded) {
  size_t count = scene->shapes.count - before->shapes;
  Loaded *all = vl_alloc_array(scene->context, count + 1, sizeof *all);
  if (!all)
    return vl_scene_fail_memory(scene);
  for (size_t i = 0; i < count; i++) {
    vlShapeDef *d = &scene->shapes.items[before->shapes + i];
    all[i] = (Loaded){.group = d->group.index, .reversed = d->reverse_orientation};
    memcpy(all[i].pose, d->group_from_shape, sizeof all[i].pose);
    if (d->emission.index)
      loaded->emitters++;
    d->emission.index = 0;
    if (d->group.index)
      continue;
    d->group = group;
    scene->groups.items[group.index - 1].shape_count++;
  }
  bool fine = true;
  for (size_t i = before->instances; i < scene->instances.count; i++) {
    const vlSceneInstance instance = scene->instances.items[i];
    fine = fine && dissolve(scene, before->shapes, all, count, group, &instance);
  }
  vl_free(scene->context, all);
  scene->instances.count = before->instances;
  return fine;
}

static vlResult find_box(vlScene *scene, vlGroupId group, vlLoadedGroup *loaded,
                         vlError *error) {
  vlExtent *boxes;
  if (!vl_extent_groups(scene, &boxes))
    return vl_scene_result(scene, error);
  memcpy(loaded->low, boxes[group.index - 1].low, sizeof loaded->low);
  memcpy(loaded->high, boxes[group.index - 1].high, sizeof loaded->high);
  vl_free(scene->context, boxes);
  return VL_OK;
}

vlResult vl_scene_load_group(vlScene *scene, const char *path, const vlLoadDef *def,
                             const char *name, vlLoadedGroup *loaded, vlError *error) {
  vl_error_clear(error);
  if (!scene || !path || !loaded)
    return vl_fail_argument(error, "load group: a pointer is null");
  memset(loaded, 0, sizeof *loaded);
  VL_TRY(vl_scene_result(scene, error));
  vlGroupId group = vl_scene_add_group(scene, name);
  if (!group.index)
    return vl_scene_result(scene, error);
  const Before before = {scene->shapes.count,  scene->instances.count,    scene->lights.count,
                         scene->choices.count, scene->frame_points.count, scene->defs};
  bool in_full = scene->camera_in_full;
  vlResult result = vl_scene_load(scene, path, def, error);
  scene->defs = before.defs;
  scene->camera_in_full = in_full;
  scene->choices.count = before.choices;
  scene->frame_points.count = before.points;
  loaded->lights = (uint32_t)(scene->lights.count - before.lights);
  scene->lights.count = before.lights;
  if (result != VL_OK)
    return result;
  if (!gather(scene, &before, group, loaded))
    return vl_scene_result(scene, error);
  loaded->group = group;
  loaded->shapes = scene->groups.items[group.index - 1].shape_count;
  loaded->first_object = (uint32_t)before.shapes + 1;
  if (loaded->shapes == 0) {
    vl_scene_fail(scene, VL_ERROR_SCENE, (vlSource){path, 0, 0}, "the file has no shapes");
    return vl_scene_result(scene, error);
  }
  return find_box(scene, group, loaded, error);
}
