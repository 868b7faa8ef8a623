/* scene/check_inside.c: scene check: whether the camera is inside a solid where it sees nothing
 * or a wrong image, whether the media of nested solids agree, and whether the scene is on the
 * right side of portals. */
#include <math.h>

#include "base/free.h"
#include "math/double3.h"
#include "scene/check.h"
#include "scene/solid.h"
#include "schema/schema.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/shape.h"
#include "velo/tracer.h"

/* ---- the camera -------------------------------------------------------------------------- */

static void eye_of(const vlCameraDef *d, double eye[3]) {
  for (int k = 0; k < 3; k++)
    eye[k] = d->has_matrix ? d->world_from_camera[4 * k + 3] : d->eye[k];
}

/* Whether the surface is transmissive or absent (interface). */
static bool lets_light_pass(const vlCheck *c, const vlShapeDef *d) {
  const vlMaterialDef *m = vl_scene_material(c->scene, d->material);
  if (d->alpha.texture.index || d->alpha.value < 1 || d->one_sided)
    return true;
  if (!m)
    return false;
  return !(vl_kind_row(&vl_material_family, (int)m->kind)->traits & VL_MATERIAL_OPAQUE);
}

/* Whether a light is inside the solid. Only lights outside of groups are examined; lights of
 * instances count as inside. */
static bool holds_light(const vlCheck *c, const vlSolid *solid,
                        const vlMat4 *group_from_world) {
  const vlScene *s = c->scene;
  double p[3], q[3];
  for (size_t i = 0; i < s->lights.count; i++) {
    const vlLightDef *l = &s->lights.items[i];
    if (vl_scene_light_is_removed(s, i) ||
        (vl_kind_row(&vl_light_family, (int)l->kind)->traits & VL_LIGHT_TRAIT_FAR))
      continue;
    vlMat4 m = vl_mat4_load(l->world_from_light);
    vl_mat4_vertex(&m, l->from, q);
    vl_mat4_point(group_from_world, q, p);
    if (vl_solid_holds(solid, p))
      return true;
  }
  VL_EACH_ITEM(const vlShapeDef, d, &s->shapes) {
    if (!d->emission.index)
      continue;
    if (d->group.index)
      return true;
    vlSolid emission = {.shape = d, .sphere = true};
    for (uint32_t k = 0; k < 16; k++) {
      if (d->positions) {
        const float *x = d->positions + 3 * (size_t)((uint64_t)k * d->vertices / 16);
        vlMat4 m = vl_mat4_load(d->group_from_shape);
        vl_mat4_vertex(&m, x, p);
      } else {
        vl_solid_sample(&emission, k, 16, p);
      }
      vl_mat4_point(group_from_world, p, q);
      if (vl_solid_holds(solid, q))
        return true;
    }
  }
  return false;
}

static const char *medium_name(const vlCheck *c, vlMediumId id) {
  const char *name = id.index ? c->scene->media.items[id.index - 1].name : "";
  return name ? name : "";
}

static void judge(vlCheck *c, const vlSolid *solid, const double *eye,
                  const vlMat4 *group_from_world) {
  const vlShapeDef *d = solid->shape;
  const vlMaterialDef *m = vl_scene_material(c->scene, d->material);
  vlCheckName name = vl_check_material_name(m);
  vlMediumId medium = c->scene->defs.camera_medium;
  bool media = d->inside.index != d->outside.index;
  if (!vl_solid_holds(solid, eye))
    return;
  if (media && d->inside.index != medium.index)
    vl_check_add(
        c, VL_FINDING_CAMERA_INSIDE, VL_SEVERITY_WARNING, d->source,
        "the camera stands in this solid, whose medium is \"%s\", but its own medium is \"%s\"",
        vl_short_text(medium_name(c, d->inside)).text,
        vl_short_text(medium_name(c, medium)).text);
  else if (!media && m && m->kind == VL_MATERIAL_DIELECTRIC)
    vl_check_add(c, VL_FINDING_CAMERA_INSIDE, VL_SEVERITY_WARNING, d->source,
                 "the camera stands in the solid of %s and looks out through its surface",
                 name.text);
  else if (!lets_light_pass(c, d) && !d->emission.index &&
           c->scene->defs.render.tracer != VL_TRACER_RAYCAST &&
           c->scene->defs.render.tracer != VL_TRACER_AMBIENT_OCCLUSION &&
           !holds_light(c, solid, group_from_world))
    vl_check_add(c, VL_FINDING_CAMERA_INSIDE, VL_SEVERITY_WARNING, d->source,
                 "the camera stands in this closed solid of %s, and no light is in there: the "
                 "image stays black",
                 name.text);
}

/* Checks one instance of a group. Shapes of one material may together form a solid. */
static void check_group(vlCheck *c, uint32_t group, const vlExtent *boxes,
                        const double world_eye[3], const double *pose) {
  const vlScene *s = c->scene;
  vlMat4 inverse = vl_mat4_identity();
  double eye[3];
  if (pose && !vl_mat4_inverse(vl_mat4_load(pose), &inverse))
    return;
  vl_mat4_point(&inverse, world_eye, eye);
  uint32_t *shapes = vl_alloc_array(c->context, s->shapes.count + 1, sizeof *shapes);
  uint8_t *done = vl_alloc_zero(c->context, s->materials.count + 1, 1);
  if (!shapes || !done)
    c->no_memory = true;
  for (size_t i = 0; i < s->shapes.count && !c->no_memory; i++) {
    const vlShapeDef *d = &s->shapes.items[i];
    if (d->group.index != group || !vl_extent_surrounds(&boxes[i], eye))
      continue;
    bool meshed = vl_shape_is_mesh(d->kind);
    size_t count = 0;
    if (meshed && done[d->material.index])
      continue;
    if (!meshed)
      shapes[count++] = (uint32_t)i;
    for (size_t j = i; meshed && j < s->shapes.count; j++) {
      const vlShapeDef *e = &s->shapes.items[j];
      bool same = e->group.index == group && e->material.index == d->material.index &&
                  vl_shape_is_mesh(e->kind);
      if (same)
        shapes[count++] = (uint32_t)j;
    }
    if (meshed)
      done[d->material.index] = 1;
    vlSolid solid;
    if (vl_solid_make(s, shapes, count, &solid))
      judge(c, &solid, eye, &inverse);
    else
      c->no_memory = true;
    vl_solid_free(s, &solid);
  }
  VL_FREE(c->context, shapes, done);
}

/* The boxes of the groups, in their spaces; that of an empty one has low > high. Null: no
 * memory. */
static vlExtent *group_boxes(vlCheck *c, const vlExtent *boxes) {
  const vlScene *s = c->scene;
  vlExtent *groups = vl_alloc_array(c->context, s->groups.count + 1, sizeof *groups);
  if (!groups)
    c->no_memory = true;
  for (size_t g = 0; groups && g <= s->groups.count; g++)
    groups[g] = vl_extent_nothing;
  for (size_t i = 0; groups && i < s->shapes.count; i++)
    vl_extent_join(&groups[s->shapes.items[i].group.index], &boxes[i]);
  return groups;
}

static void check_camera(vlCheck *c, const vlExtent *boxes, const vlExtent *groups) {
  const vlScene *s = c->scene;
  double eye[3], p[3];
  if (s->defs.camera_missing)
    return;
  eye_of(&s->defs.camera, eye);
  check_group(c, 0, boxes, eye, NULL);
  for (size_t i = 0; i < s->instances.count && !c->no_memory; i++) {
    const vlSceneInstance *instance = &s->instances.items[i];
    vlMat4 inverse;
    if (instance->keys || !vl_mat4_inverse(vl_mat4_load(instance->world_from_group), &inverse))
      continue;
    vl_mat4_point(&inverse, eye, p);
    if (vl_extent_surrounds(&groups[instance->group.index], p))
      check_group(c, instance->group.index, boxes, eye, instance->world_from_group);
  }
}

/* ---- media ------------------------------------------------------------------------------- */

enum { MAX_SOLIDS = 128, SAMPLES = 64 };

static bool apart(const vlExtent *a, const vlExtent *b) {
  bool away = false;
  for (int k = 0; k < 3; k++) {
    double hair = 1e-4 * vl_extent_size(a, k);
    away = away || a->high[k] <= b->low[k] + hair || b->high[k] <= a->low[k] + hair;
  }
  return away;
}

static uint32_t samples_in(const vlSolid *a, const vlSolid *b) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < SAMPLES; i++) {
    double p[3];
    vl_solid_sample(a, i, SAMPLES, p);
    n += vl_solid_holds(b, p);
  }
  return n;
}

static double box_volume(const vlExtent *b) {
  return vl_extent_size(b, 0) * vl_extent_size(b, 1) * vl_extent_size(b, 2);
}

static void check_nesting(vlCheck *c, const vlSolid *solids, const vlExtent *boxes,
                          const uint32_t *shape, uint32_t n) {
  for (uint32_t i = 0; i < n; i++) {
    const vlShapeDef *d = solids[i].shape;
    uint32_t around = UINT32_MAX;
    for (uint32_t j = 0; j < n; j++) {
      if (j == i || apart(&boxes[shape[i]], &boxes[shape[j]]))
        continue;
      uint32_t in = samples_in(&solids[i], &solids[j]),
               back = samples_in(&solids[j], &solids[i]);
      bool cut = (in > 1 && in < SAMPLES - 1) || (in == SAMPLES && back == SAMPLES);
      if (cut && j > i)
        vl_check_add(
            c, VL_FINDING_MEDIA, VL_SEVERITY_WARNING, solids[j].shape->source,
            "this solid of medium \"%s\" overlaps the solid of medium \"%s\" of line %u",
            vl_short_text(medium_name(c, solids[j].shape->inside)).text,
            vl_short_text(medium_name(c, d->inside)).text, d->source.line);
      if (in == SAMPLES && back == 0 &&
          (around == UINT32_MAX ||
           box_volume(&boxes[shape[j]]) < box_volume(&boxes[shape[around]])))
        around = j;
    }
    if (around != UINT32_MAX && d->outside.index != solids[around].shape->inside.index)
      vl_check_add(
          c, VL_FINDING_MEDIA, VL_SEVERITY_WARNING, d->source,
          "this solid lies in medium \"%s\" (line %u), but says that \"%s\" is outside of it",
          vl_short_text(medium_name(c, solids[around].shape->inside)).text,
          solids[around].shape->source.line, vl_short_text(medium_name(c, d->outside)).text);
  }
}

/* Checks the media of shapes outside of groups, one by one. */
static void check_media(vlCheck *c, const vlExtent *boxes) {
  const vlScene *s = c->scene;
  vlSolid *solids = vl_alloc_zero(c->context, MAX_SOLIDS, sizeof *solids);
  uint32_t shape[MAX_SOLIDS], n = 0;
  if (!solids)
    c->no_memory = true;
  for (uint32_t i = 0; i < s->shapes.count && n < MAX_SOLIDS && !c->no_memory; i++) {
    const vlShapeDef *d = &s->shapes.items[i];
    if (d->group.index || d->inside.index == d->outside.index)
      continue;
    if (!vl_solid_make(s, &i, 1, &solids[n]))
      c->no_memory = true;
    bool closed = solids[n].sphere || solids[n].meshes.part_count;
    for (uint32_t k = 0; k < solids[n].meshes.part_count; k++)
      closed = closed && !solids[n].meshes.parts[k].open_edges;
    shape[n] = i;
    if (closed && !c->no_memory)
      n++;
    else
      vl_solid_free(s, &solids[n]);
  }
  if (!c->no_memory)
    check_nesting(c, solids, boxes, shape, n);
  for (uint32_t i = 0; solids && i < n; i++)
    vl_solid_free(s, &solids[i]);
  vl_free(c->context, solids);
}

/* ---- portals ----------------------------------------------------------------------------- */

/* The plane of a portal. Points at a positive height see the sky through it
 * (vlLightDef.portal). */
typedef struct Gate {
  double corner[3], normal[3];
} Gate;

static Gate gate_of(const vlLightDef *l) {
  Gate g;
  double x[3], y[3];
  for (int i = 0; i < 3; i++) {
    g.corner[i] = (double)l->portal[0][i];
    x[i] = (double)l->portal[3][i] - g.corner[i];
    y[i] = (double)l->portal[1][i] - g.corner[i];
  }
  /* the sky is on the other side, where x cross y points to */
  vl_cross3(y, x, g.normal);
  vl_normalize3(g.normal);
  return g;
}

static double height_of(const Gate *g, const double p[3]) {
  double h = 0;
  for (int i = 0; i < 3; i++)
    h += g->normal[i] * (p[i] - g->corner[i]);
  return h;
}

/* The heights of the lowest and of the highest corner of a box, placed by `pose` (null: in the
 * world). */
static void heights(const Gate *g, const vlExtent *b, const double *pose, double *low,
                    double *high) {
  const vlMat4 m = pose ? vl_mat4_load(pose) : vl_mat4_identity();
  for (int k = 0; k < 8 && !vl_extent_is_empty(b); k++) {
    double corner[3], p[3];
    vl_extent_corner(b, k, corner);
    vl_mat4_point(&m, corner, p);
    const double h = height_of(g, p);
    *low = fmin(*low, h);
    *high = fmax(*high, h);
  }
}

static void check_portals(vlCheck *c, const vlExtent *boxes, const vlExtent *groups) {
  const vlScene *s = c->scene;
  VL_EACH_ITEM(const vlLightDef, l, &s->lights) {
    if (!l->has_portal)
      continue;
    Gate g = gate_of(l);
    double low = INFINITY, high = -INFINITY, eye[3];
    for (size_t k = 0; k < s->shapes.count; k++)
      if (!s->shapes.items[k].group.index)
        heights(&g, &boxes[k], NULL, &low, &high);
    for (size_t n = 0; n < s->instances.count; n++)
      heights(&g, &groups[s->instances.items[n].group.index],
              s->instances.items[n].world_from_group, &low, &high);
    if (!(low < high))
      continue;
    double hair = 1e-4 * (high - low); /* walls in the portal's plane are on neither side */
    eye_of(&s->defs.camera, eye);
    if (high <= hair)
      vl_check_add(
          c, VL_FINDING_DARK_LIGHT, VL_SEVERITY_WARNING, l->source,
          "this light gives no light: the whole scene is on the side of its portal that the "
          "sky is on; give the portal's corners in the opposite order");
    else if (!s->defs.camera_missing && height_of(&g, eye) < -hair)
      vl_check_add(
          c, VL_FINDING_DARK_LIGHT, VL_SEVERITY_WARNING, l->source,
          "the camera is on the side of this light's portal that the sky is on, where the "
          "light is not seen; if it should be, give the portal's corners in the opposite "
          "order");
  }
}

void vl_check_inside(vlCheck *c) {
  const vlScene *s = c->scene;
  vlExtent *boxes = vl_alloc_array(c->context, s->shapes.count + 1, sizeof *boxes);
  if (!boxes)
    c->no_memory = true;
  for (size_t i = 0; i < s->shapes.count && !c->no_memory; i++)
    boxes[i] = vl_shape_box(&s->shapes.items[i]);
  vlExtent *groups = c->no_memory ? NULL : group_boxes(c, boxes);
  if (!c->no_memory)
    check_camera(c, boxes, groups);
  if (!c->no_memory)
    check_media(c, boxes);
  if (!c->no_memory)
    check_portals(c, boxes, groups);
  VL_FREE(c->context, groups, boxes);
}
