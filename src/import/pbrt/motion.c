/* import/pbrt/motion.c: animated transforms (ActiveTransform, TransformTimes) become moving
 * instances. A shape under an animated transform is part of a moving group; successive shapes
 * with the same transforms share one. A group inside an object is placed wherever the object
 * is. */
#include <math.h>
#include <string.h>

#include "import/pbrt/builder.h"
#include "math/motion.h"
#include "velo/shape.h"

static bool differ(const vlMat4 m[2]) {
  return memcmp(&m[0], &m[1], sizeof *m) != 0;
}

bool vl_import_ctm(vlImport *import, vlSource source, vlMat4 *ctm) {
  *ctm = import->state.ctm[0];
  if (differ(import->state.ctm))
    vl_import_warn(
        import, VL_LOG_WARNING, source,
        "this cannot move (ActiveTransform): its transform at the start counts, as in pbrt");
  return true;
}

bool vl_import_times(vlImport *import, const vlStatement *s) {
  const double *t = s->numbers;
  if (!isfinite(t[0]) || !isfinite(t[1]) || !(t[0] < t[1]))
    return vl_import_wrong(import, s->source,
                           "TransformTimes: the end (%g) must be after the start (%g)", t[1],
                           t[0]);
  import->times[0] = t[0];
  import->times[1] = t[1];
  return true;
}

bool vl_import_moves(const vlImport *import) {
  return differ(import->state.ctm);
}

/* Reports transforms between which no motion exists. */
static bool check_motion(vlImport *import, vlSource source, const vlMat4 ctm[2]) {
  vlMotion motion;
  if (vl_motion_make(ctm[0].m, ctm[1].m, &motion))
    return true;
  return vl_import_wrong(import, source,
                         "no motion leads from the transform at the start to that at the end: "
                         "one is singular, not affine, or mirrors alone");
}

bool vl_import_add_instance(vlImport *import, vlGroupId group, const vlMat4 ctm[2],
                            vlSource source) {
  if (!differ(ctm)) {
    vl_scene_add_instance(import->scene, group, ctm[0].m, source);
  } else {
    double poses[32];
    if (!check_motion(import, source, ctm))
      return false;
    memcpy(poses, ctm[0].m, sizeof ctm[0].m);
    memcpy(poses + 16, ctm[1].m, sizeof ctm[1].m);
    vl_scene_add_moving_instance(import->scene, group, 2, import->times, poses, source);
  }
  return vl_import_fine(import);
}

bool vl_import_moving_group(vlImport *import, vlSource source, vlGroupId *group) {
  const vlMat4 *ctm = import->state.ctm;
  vlMovingGroup *last =
      import->moving.count ? &import->moving.items[import->moving.count - 1] : NULL;
  if (!last || last->object.index != import->object.index ||
      memcmp(last->ctm, ctm, sizeof last->ctm) != 0) {
    vlGroupId made = vl_scene_add_group(import->scene, "");
    last = made.index ? VL_IMPORT_PUSH(import, &import->moving) : NULL;
    if (!last)
      return false;
    *last = (vlMovingGroup){.group = made, .object = import->object, .source = source};
    memcpy(last->ctm, ctm, sizeof last->ctm);
    if (!vl_scene_copy_source(import->scene, &last->source) ||
        !check_motion(import, source, ctm))
      return false;
    if (!import->in_object && !vl_import_add_instance(import, made, ctm, source))
      return false;
  }
  *group = last->group;
  return true;
}

/* Key times of the product of two motions (a moving group in a moving object). Interpolation
 * between this many keys is accurate enough. */
enum { PRODUCT_KEYS = 33 };

static bool place_part(vlImport *import, const vlMovingGroup *part,
                       const vlSceneInstance *object) {
  double times[PRODUCT_KEYS], poses[16 * PRODUCT_KEYS], outer[16], inner[16];
  double from = import->times[0], to = import->times[1];
  memcpy(outer, object->world_from_group, sizeof outer);
  for (int k = 0; k < PRODUCT_KEYS; k++) {
    double f = (double)k / (PRODUCT_KEYS - 1);
    times[k] = from + (to - from) * f;
    vl_motion_at(part->ctm[0].m, part->ctm[1].m, f, inner);
    if (object->keys)
      vl_motion_at(object->poses, object->poses + 16, f, outer);
    vlMat4 product = vl_mat4_multiply(vl_mat4_load(outer), vl_mat4_load(inner));
    memcpy(poses + 16 * k, product.m, sizeof product.m);
  }
  vl_scene_add_moving_instance(import->scene, part->group, PRODUCT_KEYS, times, poses,
                               object->source);
  return vl_import_fine(import);
}

bool vl_import_finish_motion(vlImport *import) {
  VL_EACH_ITEM(const vlMovingGroup, part, &import->moving) {
    if (!part->object.index)
      continue;
    size_t count = import->scene->instances
                       .count; /* instances added below are not instances of an object */
    for (size_t k = 0; k < count; k++) {
      vlSceneInstance object = import->scene->instances.items[k];
      if (object.group.index == part->object.index && !place_part(import, part, &object))
        return false;
    }
  }
  return true;
}
