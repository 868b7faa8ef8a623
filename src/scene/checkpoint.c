/* scene/checkpoint.c: checkpoints of a scene, and the way back to them (velo/edit.h). A
 * checkpoint is a copy of the scene's struct without its arrays: what was added later lies at
 * the end of the arrays, so the way back is to shorten them. */
#include "scene/scene.h"
#include "velo/edit.h"
#include "velo/shape.h"

struct vlSceneCheckpoint {
  vlScene scene;     /* of its arrays only the counts are used */
  uint64_t unread[]; /* the numbers in scene.unread, which a load counts on */
};

vlResult vl_scene_checkpoint(const vlScene *scene, vlSceneCheckpoint **checkpoint,
                             vlError *error) {
  vl_error_clear(error);
  if (!scene || !checkpoint)
    return vl_fail_argument(error, "scene checkpoint: a pointer is null");
  const size_t unread = scene->unread.count * sizeof *(*checkpoint)->unread;
  *checkpoint = vl_alloc_zero(scene->context, 1, sizeof **checkpoint + unread);
  if (!*checkpoint)
    return vl_fail_memory(error);
  (*checkpoint)->scene = *scene;
  for (size_t i = 0; i < scene->unread.count; i++)
    (*checkpoint)->unread[i] = scene->unread.items[i].count;
  return VL_OK;
}

void vl_scene_checkpoint_destroy(vlSceneCheckpoint *checkpoint) {
  if (checkpoint)
    vl_free(checkpoint->scene.context, checkpoint);
}

/* Counts the remaining shapes of the groups. */
static void count_groups(vlScene *scene) {
  for (size_t i = 0; i < scene->groups.count; i++)
    scene->groups.items[i].shape_count = 0;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const uint32_t group = scene->shapes.items[i].group.index;
    if (group)
      scene->groups.items[group - 1].shape_count++;
  }
}

void vl_scene_roll_back(vlScene *scene, vlSceneCheckpoint *checkpoint) {
  if (!scene || !checkpoint || checkpoint->scene.number != scene->number)
    return;
  const vlScene after = *scene, *before = &checkpoint->scene;
  vl_scene_free_beyond(scene, (vlSceneCounts){before->blocks.count, before->images.count,
                                              before->apertures.count, before->optics.count});
  *scene = *before;
#define KEEP_ARRAY(array)                                               \
  scene->array.items = after.array.items; /* it may have moved since */ \
  scene->array.capacity = after.array.capacity;
  VL_SCENE_ARRAYS(KEEP_ARRAY)
#undef KEEP_ARRAY
  for (size_t i = 0; i < scene->unread.count; i++)
    scene->unread.items[i].count = checkpoint->unread[i];
  count_groups(scene);
  vl_scene_checkpoint_destroy(checkpoint);
}
