/* scene/extent.c: see extent.h. */
#include "scene/extent.h"

#include <math.h>

#include "math/transform.h"
#include "schema/schema.h"
#include "velo/shape.h"

static void visit_box(const vlMat4 *m, const double low[3], const double high[3],
                      vlPointVisit *visit, void *user) {
  for (int k = 0; k < 8; k++) {
    double corner[3] = {k & 1 ? low[0] : high[0], k & 2 ? low[1] : high[1],
                        k & 4 ? low[2] : high[2]},
           p[3];
    vl_mat4_point(m, corner, p);
    visit(user, p);
  }
}

static void visit_shape(const vlShapeDef *d, const vlMat4 *world_from_group, size_t most,
                        vlPointVisit *visit, void *user) {
  vlMat4 m = vl_mat4_multiply(*world_from_group, vl_mat4_load(d->group_from_shape));
  for (size_t i = 0; d->centers && i < d->faces; i += d->faces / most + 1) {
    const double *c = d->centers + 3 * i;
    double r = d->radii[i], low[3] = {c[0] - r, c[1] - r, c[2] - r},
           high[3] = {c[0] + r, c[1] + r, c[2] + r};
    visit_box(&m, low, high, visit, user);
  }
  if (d->centers)
    return;
  if (!d->positions) {
    double low[3], high[3];
    vl_shape_own_box(d, low, high);
    if (low[0] > high[0])
      return;
    visit_box(&m, low, high, visit, user);
    return;
  }
  size_t step = d->vertices / most + 1;
  for (size_t i = 0; i < d->vertices; i += step) {
    double v[3] = {d->positions[3 * i], d->positions[3 * i + 1], d->positions[3 * i + 2]}, p[3];
    vl_mat4_point(&m, v, p);
    visit(user, p);
  }
}

void vl_extent_grow(void *user, const double p[3]) {
  vlExtent *b = user;
  for (int i = 0; i < 3; i++) {
    b->low[i] = fmin(b->low[i], p[i]);
    b->high[i] = fmax(b->high[i], p[i]);
  }
}

const vlExtent vl_extent_nothing = {{INFINITY, INFINITY, INFINITY},
                                    {-INFINITY, -INFINITY, -INFINITY}};

void vl_extent_visit(const vlScene *scene, const vlExtent *boxes, const bool *without,
                     vlPointVisit *visit, void *user) {
  vlMat4 identity = vl_mat4_identity();
  for (size_t i = 0; i + 2 < scene->frame_points.count; i += 3)
    visit(user, scene->frame_points.items + i);
  if (scene->frame_points.count)
    return;
  for (size_t i = 0; i < scene->shapes.count; i++)
    if (!scene->shapes.items[i].group.index && !(without && without[i]))
      visit_shape(&scene->shapes.items[i], &identity, 20000, visit, user);
  for (size_t i = 0; i < scene->instances.count; i++) {
    const vlSceneInstance *instance = &scene->instances.items[i];
    const vlExtent *b = &boxes[instance->group.index - 1];
    vlMat4 m = vl_mat4_load(instance->world_from_group);
    if (!instance->hidden && b->low[0] <= b->high[0])
      visit_box(&m, b->low, b->high, visit, user);
  }
}

bool vl_extent_groups(vlScene *scene, vlExtent **boxes) {
  *boxes = vl_alloc_array(scene->context, scene->groups.count + 1, sizeof **boxes);
  if (!*boxes) {
    vl_scene_fail(scene, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
    return false;
  }
  vlMat4 identity = vl_mat4_identity();
  for (size_t i = 0; i < scene->groups.count; i++)
    (*boxes)[i] = vl_extent_nothing;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *d = &scene->shapes.items[i];
    if (d->group.index)
      visit_shape(d, &identity, SIZE_MAX, vl_extent_grow, &(*boxes)[d->group.index - 1]);
  }
  return true;
}
