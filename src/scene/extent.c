/* scene/extent.c: see extent.h. */
#include "scene/extent.h"

#include <math.h>

#include "math/double3.h"
#include "math/transform.h"
#include "schema/schema.h"
#include "velo/shape.h"

vlExtent vl_extent_of_sphere(const vlShapeDef *shape, size_t i) {
  const double *c = shape->centers + 3 * i;
  const double r = shape->radii[i];
  return (vlExtent){{c[0] - r, c[1] - r, c[2] - r}, {c[0] + r, c[1] + r, c[2] + r}};
}

void vl_mesh_face(const vlShapeDef *shape, const vlMat4 *m, size_t face, double p[3][3],
                  double n[3]) {
  double a[3], b[3];
  for (size_t k = 0; k < 3; k++) {
    const float *v = shape->positions + 3 * (size_t)shape->indices[3 * face + k];
    for (int i = 0; i < 3; i++)
      p[k][i] = v[i];
    if (m)
      vl_mat4_vertex(m, v, p[k]);
  }
  vl_sub3(p[1], p[0], a);
  vl_sub3(p[2], p[0], b);
  vl_cross3(a, b, n);
}

void vl_extent_visit_box(const vlMat4 *m, const vlExtent *box, vlPointVisit *visit,
                         void *user) {
  for (int k = 0; k < 8; k++) {
    double corner[3], p[3];
    vl_extent_corner(box, k, corner);
    vl_mat4_point(m, corner, p);
    visit(user, p);
  }
}

static void visit_shape(const vlShapeDef *d, const vlMat4 *world_from_group, size_t max,
                        vlPointVisit *visit, void *user) {
  vlMat4 m = vl_mat4_load(d->group_from_shape);
  if (world_from_group)
    m = vl_mat4_multiply(*world_from_group, m);
  for (size_t i = 0; d->centers && i < d->faces; i += d->faces / max + 1) {
    const vlExtent box = vl_extent_of_sphere(d, i);
    vl_extent_visit_box(&m, &box, visit, user);
  }
  if (d->centers)
    return;
  if (!d->positions) {
    vlExtent box;
    vl_shape_own_box(d, box.low, box.high);
    if (!vl_extent_is_empty(&box))
      vl_extent_visit_box(&m, &box, visit, user);
    return;
  }
  size_t step = d->vertices / max + 1;
  for (size_t i = 0; i < d->vertices; i += step) {
    double p[3];
    vl_mat4_vertex(&m, d->positions + 3 * i, p);
    visit(user, p);
  }
}

void vl_extent_visit_shape(const vlShapeDef *shape, const vlMat4 *world_from_group,
                           vlPointVisit *visit, void *user) {
  visit_shape(shape, world_from_group, SIZE_MAX, visit, user);
}

/* Hands on the points within limits. */
typedef struct Within {
  const vlExtent *limits;
  vlPointVisit *visit;
  void *user;
} Within;

static void visit_within(void *user, const double p[3]) {
  const Within *w = user;
  const vlExtent point = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
  if (vl_extent_holds(w->limits, &point))
    w->visit(w->user, p);
}

void vl_extent_visit(const vlScene *scene, const vlExtent *boxes, const bool *without,
                     vlPointVisit *visit, void *user) {
  Within within = {&boxes[scene->groups.count], visit, user};
  for (size_t i = 0; i + 2 < scene->frame_points.count; i += 3)
    visit(user, scene->frame_points.items + i);
  if (scene->frame_points.count)
    return;
  for (size_t i = 0; i < scene->shapes.count; i++)
    if (!scene->shapes.items[i].group.index && !(without && without[i]))
      visit_shape(&scene->shapes.items[i], NULL, 20000, visit_within, &within);
  VL_EACH_ITEM(const vlSceneInstance, instance, &scene->instances) {
    const vlExtent *b = &boxes[instance->group.index - 1];
    vlMat4 m = vl_mat4_load(instance->world_from_group);
    if (!instance->hidden && !vl_extent_is_empty(b))
      vl_extent_visit_box(&m, b, visit_within, &within);
  }
}

bool vl_extent_groups(vlScene *scene, vlExtent **boxes) {
  *boxes = vl_alloc_array(scene->context, scene->groups.count + 1, sizeof **boxes);
  if (!*boxes)
    return vl_scene_fail_memory(scene);
  const vlExtent everything = {{-INFINITY, -INFINITY, -INFINITY},
                               {INFINITY, INFINITY, INFINITY}};
  for (size_t i = 0; i < scene->groups.count; i++)
    (*boxes)[i] = vl_extent_nothing;
  (*boxes)[scene->groups.count] = everything;
  VL_EACH_ITEM(const vlShapeDef, d, &scene->shapes) {
    if (d->group.index)
      vl_extent_visit_shape(d, NULL, vl_extent_grow, &(*boxes)[d->group.index - 1]);
  }
  return true;
}
