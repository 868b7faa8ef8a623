/* scene/solid.c: see solid.h. Also bounding boxes of shapes. */
#include "scene/solid.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"
#include "math/elementary.h"
#include "scene/extent.h"
#include "schema/schema.h"
#include "velo/shape_kinds.h"

vlShapeDef vl_shape_one_sphere(const vlShapeDef *d, uint32_t k) {
  const double *c = d->centers + 3 * (size_t)k;
  vlShapeDef one = *d;
  vlMat4 m =
      vl_mat4_multiply(vl_mat4_load(d->group_from_shape), vl_mat4_translate(c[0], c[1], c[2]));
  memcpy(one.group_from_shape, m.m, sizeof one.group_from_shape);
  one.radius = one.z_max = d->radii[k];
  one.z_min = -one.radius;
  one.phi_max = 2.0f * 3.14159265358979f;
  one.centers = NULL;
  one.radii = NULL;
  one.faces = 0;
  return one;
}

vlExtent vl_shape_box(const vlShapeDef *d) {
  vlExtent box = vl_extent_nothing;
  for (uint32_t i = 0; d->centers && i < d->faces; i++) {
    const vlShapeDef one = vl_shape_one_sphere(d, i);
    const vlExtent own = vl_shape_box(&one);
    vl_extent_join(&box, &own);
  }
  if (!d->centers)
    vl_extent_visit_shape(d, NULL, vl_extent_grow, &box);
  return box;
}

static bool is_whole_sphere(const vlShapeDef *d) {
  return d->kind == VL_SHAPE_SPHERE && !d->centers && d->phi_max > 6.28318f &&
         d->z_min <= -d->radius && d->z_max >= d->radius;
}

bool vl_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count, vlSolid *s) {
  *s = (vlSolid){.shape = &scene->shapes.items[shapes[0]]};
  s->sphere = count == 1 && is_whole_sphere(s->shape);
  if (s->sphere) {
    vl_mat4_inverse(vl_mat4_load(s->shape->group_from_shape), &s->shape_from_group);
    return true;
  }
  return vl_mesh_solid_make(scene, shapes, count, &s->meshes);
}

void vl_solid_free(const vlScene *scene, vlSolid *s) {
  vl_mesh_solid_free(scene, &s->meshes);
}

bool vl_solid_holds(const vlSolid *s, const double p[3]) {
  if (s->sphere) {
    double q[3], r = s->shape->radius;
    vl_mat4_point(&s->shape_from_group, p, q);
    return vl_dot3(q, q) < r * r;
  }
  int winding = 0;
  for (uint32_t i = 0; i < s->meshes.part_count; i++) {
    const vlMeshSolidPart *part = &s->meshes.parts[i];
    if (part->open_edges == 0 && vl_extent_surrounds(&part->box, p))
      winding += vl_mesh_solid_winding(&s->meshes, p, i);
  }
  return winding != 0;
}

void vl_solid_sample(const vlSolid *s, uint32_t i, uint32_t n, double p[3]) {
  if (s->sphere) { /* points on a spiral over the sphere */
    const double golden_angle = 2.39996322972865332;
    double z = 1 - (2.0 * i + 1) / n, r = sqrt(1 - z * z), a = golden_angle * i;
    double q[3] = {0.999 * (double)s->shape->radius * r * vl_precise_cos(a),
                   0.999 * (double)s->shape->radius * r * vl_precise_sin(a),
                   0.999 * (double)s->shape->radius * z};
    vlMat4 m = vl_mat4_load(s->shape->group_from_shape);
    vl_mat4_point(&m, q, p);
    return;
  }
  uint32_t face = (uint32_t)((uint64_t)i * s->meshes.faces / n);
  const vlMeshSolidPart *part = &s->meshes.parts[s->meshes.part[face]];
  for (int k = 0; k < 3; k++) {
    double sum = 0;
    for (int j = 0; j < 3; j++)
      sum +=
          s->meshes
              .points[3 * (size_t)s->meshes.faces3[3 * (size_t)face + (size_t)j] + (size_t)k];
    p[k] = 0.999 * sum / 3 + 0.0005 * (part->box.low[k] + part->box.high[k]);
  }
}
