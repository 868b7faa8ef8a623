/* scene/things.c: see things.h. */
#include "scene/things.h"

#include "math/double3.h"
#include "math/transform.h"
#include "velo/shape_kinds.h"

static const uint64_t MAX_FACES = 8000000;

static double surface_of(const vlExtent *box) {
  const double x = vl_extent_size(box, 0);
  const double y = vl_extent_size(box, 1);
  const double z = vl_extent_size(box, 2);
  return 2 * (x * y + y * z + z * x);
}

static void visit_box(const vlExtent *box, vlThingVisit *visit, void *user) {
  const vlThing thing = {.box = *box, .body = *box, .surface = surface_of(box)};
  visit(user, &thing);
}

/* The box of a face without the tip of a needle. */
static vlExtent body_of(const double p[3][3], const vlExtent *box) {
  const double thin = 0.1; /* the shortest edge of a needle over its others */
  double squared[3];       /* lengths of the edges that begin at each corner */
  vlExtent body = vl_extent_nothing;
  int min = 0;
  for (int k = 0; k < 3; k++) {
    squared[k] = 0;
    for (int i = 0; i < 3; i++)
      squared[k] += (p[(k + 1) % 3][i] - p[k][i]) * (p[(k + 1) % 3][i] - p[k][i]);
    min = squared[k] < squared[min] ? k : min;
  }
  const double others = fmin(squared[(min + 1) % 3], squared[(min + 2) % 3]);
  if (!(squared[min] < thin * thin * others))
    return *box;
  vl_extent_grow(&body, p[min]);
  vl_extent_grow(&body, p[(min + 1) % 3]);
  return body;
}

static void visit_faces(const vlShapeDef *shape, vlThingVisit *visit, void *user) {
  const vlMat4 m = vl_mat4_load(shape->group_from_shape);
  for (size_t i = 0; i < shape->faces; i++) {
    double p[3][3], n[3];
    vlThing thing = {.box = vl_extent_nothing};
    vl_mesh_face(shape, &m, i, p, n);
    for (int k = 0; k < 3; k++)
      vl_extent_grow(&thing.box, p[k]);
    thing.body = body_of((const double(*)[3])p, &thing.box);
    thing.surface = 0.5 * vl_norm3(n);
    visit(user, &thing);
  }
}

static void visit_spheres(const vlShapeDef *shape, vlThingVisit *visit, void *user) {
  const vlMat4 m = vl_mat4_load(shape->group_from_shape);
  for (size_t i = 0; i < shape->faces; i++) {
    const vlExtent own = vl_extent_of_sphere(shape, i);
    vlExtent box = vl_extent_nothing;
    vl_extent_visit_box(&m, &own, vl_extent_grow, &box);
    visit_box(&box, visit, user);
  }
}

void vl_things_visit(const vlScene *scene, const vlExtent *boxes, vlThingVisit *visit,
                     void *user) {
  VL_EACH_ITEM(const vlShapeDef, shape, &scene->shapes) {
    vlExtent box = vl_extent_nothing;
    if (shape->group.index)
      continue;
    if (shape->kind == VL_SHAPE_TRIANGLES && shape->indices) {
      visit_faces(shape, visit, user);
      continue;
    }
    if (shape->centers) {
      visit_spheres(shape, visit, user);
      continue;
    }
    vl_extent_visit_shape(shape, NULL, vl_extent_grow, &box);
    if (!vl_extent_is_empty(&box))
      visit_box(&box, visit, user);
  }
  VL_EACH_ITEM(const vlSceneInstance, instance, &scene->instances) {
    const vlExtent *own = &boxes[instance->group.index - 1];
    const vlMat4 m = vl_mat4_load(instance->world_from_group);
    vlExtent box = vl_extent_nothing;
    if (instance->hidden || vl_extent_is_empty(own))
      continue;
    vl_extent_visit_box(&m, own, vl_extent_grow, &box);
    visit_box(&box, visit, user);
  }
}

static uint64_t count_faces(const vlScene *scene) {
  uint64_t sum = 0;
  for (size_t i = 0; i < scene->shapes.count; i++)
    sum += scene->shapes.items[i].group.index ? 0 : scene->shapes.items[i].faces;
  return sum;
}

bool vl_things_are_few(const vlScene *scene) {
  return count_faces(scene) <= MAX_FACES;
}
