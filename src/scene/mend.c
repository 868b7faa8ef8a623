/* scene/mend.c: see mend.h. */
#include "scene/mend.h"

#include <math.h>

#include "math/double3.h"
#include "scene/extent.h"
#include "scene/faces.h"
#include "velo/shape_kinds.h"

/* ---- opacity ----------------------------------------------------------------------------- */

static bool is_invisible(const vlShapeDef *shape) {
  return !shape->alpha.texture.index && shape->alpha.value == 0 && !shape->emission.index;
}

static void show_invisible(vlScene *scene) {
  bool all = scene->shapes.count > 0;
  for (size_t i = 0; i < scene->shapes.count && all; i++)
    all = is_invisible(&scene->shapes.items[i]);
  if (!all)
    return;
  for (size_t i = 0; i < scene->shapes.count; i++)
    scene->shapes.items[i].alpha.value = 1;
  vl_log(scene->context, VL_LOG_INFO, NULL,
         "the whole model has the opacity 0: it is shown as if it had 1");
}

/* ---- winding ----------------------------------------------------------------------------- */

typedef struct Part {
  vlExtent box;
  double volume; /* three times it; negative: the faces look inwards */
  double sum[3]; /* of the faces' areas, as vectors */
  double area;
  bool inward; /* it is closed, one-sided, and its faces look inwards */
} Part;

typedef struct Parts {
  const vlScene *scene;
  Part *items; /* of each shape */
} Parts;

static void add_face(void *user, const vlFace *face) {
  Parts *parts = user;
  Part *part = &parts->items[face->shape - parts->scene->shapes.items];
  const bool first = !(part->area > 0);
  const double *origin = first ? face->middle : part->box.low;
  for (int i = 0; i < 3; i++) {
    /* about a corner of the box, which moves: what was added before moves along */
    part->volume += face->area[i] * (face->middle[i] - origin[i]);
    part->sum[i] += face->area[i];
  }
  part->area += face->size;
  vlExtent grown = first ? vl_extent_nothing : part->box;
  for (int k = 0; k < 3; k++)
    vl_extent_grow(&grown, face->corners[k]);
  for (int i = 0; i < 3; i++)
    part->volume += part->sum[i] * (origin[i] - grown.low[i]);
  part->box = grown;
}

static bool is_closed(const Part *part) {
  return part->area > 0 && vl_norm3(part->sum) < 0.15 * part->area;
}

/* Finds the shapes that are wound inwards. Returns whether there are some. */
static bool find_inward(const Parts *parts) {
  const vlScene *scene = parts->scene;
  bool some = false;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *shape = &scene->shapes.items[i];
    Part *part = &parts->items[i];
    part->inward = shape->one_sided && !shape->group.index && !shape->emission.index &&
                   is_closed(part) && part->volume < 0;
    some = some || part->inward;
  }
  return some;
}

/* The volume of what looks outwards within a shape, three times; its number in *count. */
static double contents(const Parts *parts, size_t shell, size_t *count) {
  double volume = 0;
  *count = 0;
  for (size_t i = 0; i < parts->scene->shapes.count; i++) {
    const Part *part = &parts->items[i];
    if (i == shell || !(part->area > 0) ||
        !vl_extent_holds(&parts->items[shell].box, &part->box))
      continue;
    ++*count;
    volume += !part->inward && is_closed(part) ? fmax(part->volume, 0) : 0;
  }
  return volume;
}

static void mend_winding(vlScene *scene, const Parts *parts) {
  const double thin = 1.7, lesser = 0.75;
  double inward = 0, whole = 0;
  size_t outlines = 0, turned = 0, count;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    whole += parts->items[i].area;
    inward += parts->items[i].inward ? parts->items[i].area : 0;
  }
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const Part *part = &parts->items[i];
    if (!part->inward)
      continue;
    const double inner = contents(parts, i, &count);
    const bool outline = -part->volume > inner && -part->volume < thin * inner;
    if (outline) {
      scene->shapes.items[i].alpha = (vlFloatInput){.value = 0};
      outlines++;
    } else if (count == 0 && inward < lesser * whole) {
      scene->shapes.items[i].one_sided = false;
      turned++;
    }
  }
  if (outlines)
    vl_log(scene->context, VL_LOG_INFO, NULL,
           "shells around the model, which draw its outline, are left out: %zu", outlines);
  if (turned)
    vl_log(scene->context, VL_LOG_INFO, NULL,
           "some of the model's parts have faces that look inwards: %zu are seen from both "
           "sides",
           turned);
}

bool vl_mend_model(vlScene *scene) {
  show_invisible(scene);
  if (scene->shapes.count < 2 || !vl_faces_one_sided(scene))
    return true;
  Parts parts = {.scene = scene};
  parts.items = vl_alloc_zero(scene->context, scene->shapes.count, sizeof *parts.items);
  if (!parts.items)
    return vl_scene_fail_memory(scene);
  vl_faces_visit(scene, add_face, &parts);
  if (find_inward(&parts))
    mend_winding(scene, &parts);
  vl_free(scene->context, parts.items);
  return true;
}
