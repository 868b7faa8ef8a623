/* world.c: makes the world: every shape at each of its places, its primitives, and what they are made of. Instances are
 * not shared: a group that stands in ten places is stored ten times. */
#include "world.h"

#include <stdlib.h>

#include "light.h"
#include "material.h"
#include "medium.h"
#include "refuse.h"
#include "texture.h"

/* ---- which shapes this renderer knows ---------------------------------------------------------------------------- */

static bool check_shape(const vlShapeDef *def, vlError *error) {
  switch (def->kind) {
    case VL_SHAPE_TRIANGLES:
    case VL_SHAPE_BILINEAR:
    case VL_SHAPE_SPHERE:
    case VL_SHAPE_DISK:
    case VL_SHAPE_CYLINDER: break;
    default: return refuse_kind(error, def->source, "shapes", (uint32_t)def->kind);
  }
  if (def->centers) return refuse(error, def->source, "many spheres as one shape", NULL);
  if (def->positions_close) return refuse(error, def->source, "a moving mesh", NULL);
  if (def->displacement.texture.index) return refuse(error, def->source, "a displaced mesh", NULL);
  if (def->one_sided) return refuse(error, def->source, "a mesh with one side", NULL);
  return true;
}

static bool check_tracer(const vlSceneDefs *defs, vlError *error) {
  vlTracer tracer = defs->render.tracer;
  if (tracer == VL_TRACER_RAYCAST || tracer == VL_TRACER_AMBIENT_OCCLUSION || tracer == VL_TRACER_RANDOM_WALK)
    return refuse_kind(error, (vlSource){0}, "integrators", (uint32_t)tracer);
  if (defs->build.regularize) return refuse(error, (vlSource){0}, "regularize", NULL);
  return true;
}

/* ---- places ------------------------------------------------------------------------------------------------------ */

/* Sides follow pbrt-v4: a mirrored quadric turns its normals over, a mirrored mesh does not (its normal is defined in
 * its own space), and instances never turn normals. */
static placement place(const vlShapeDef *def, matrix world_from_group) {
  placement p = {.def = def};
  matrix group_from_shape = load_matrix(def->group_from_shape);
  bool shape_mirrors = determinant(&group_from_shape) < 0;
  p.world_from_shape = multiply(world_from_group, group_from_shape);
  p.shape_from_world = invert(&p.world_from_shape);
  p.mesh_mirrored = determinant(&world_from_group) < 0;
  p.flip = def->reverse_orientation != shape_mirrors;
  return p;
}

static bool add_placement(world *w, const vlShapeDef *def, matrix world_from_group, vlError *error) {
  placement *more = realloc(w->placements, (w->placement_count + 1) * sizeof *more);
  if (!more) return refuse_memory(error);
  w->placements = more;
  w->placements[w->placement_count++] = place(def, world_from_group);
  return true;
}

/* A shape of the world itself stands in one place, that of a group in as many as the group has instances. */
static bool place_shape(world *w, const vlShapeDef *def, vlError *error) {
  if (!def->group.index) return add_placement(w, def, identity_matrix(), error);
  vlInstanceInfo info;
  for (uint32_t i = 1; vl_scene_instance(w->scene, (vlInstanceId){i}, &info) == VL_OK; i++) {
    if (info.group.index != def->group.index || !info.shown) continue;
    if (info.moves) return refuse(error, info.source, "a moving instance", NULL);
    if (!add_placement(w, def, load_matrix(info.world_from_group), error)) return false;
  }
  return true;
}

/* ---- primitives -------------------------------------------------------------------------------------------------- */

static int corners_of(const vlShapeDef *def) {
  return def->kind == VL_SHAPE_TRIANGLES ? 3 : def->kind == VL_SHAPE_BILINEAR ? 4 : 0;
}

/* A face of a mesh. One without area is never met, and emits nothing: it is left out. */
static void add_face(world *w, uint32_t index, uint32_t face, int corners) {
  const placement *where = &w->placements[index];
  primitive *p = &w->primitives[w->primitive_count++];
  *p = (primitive){.placement = index, .face = face, .light = -1};
  for (int k = 0; k < corners; k++) {
    uint32_t vertex = where->def->indices[(size_t)corners * face + (size_t)k];
    p->corner[k] = transform_point(&where->world_from_shape, from_floats(where->def->positions + 3 * (size_t)vertex));
  }
  vector n = cross(subtract(p->corner[1], p->corner[0]), subtract(p->corner[2], p->corner[0]));
  if (corners == 3 && !(length(n) > 0)) w->primitive_count--;
}

static bool add_primitives(world *w, vlError *error) {
  size_t most = 0;
  for (uint32_t i = 0; i < w->placement_count; i++) {
    const vlShapeDef *def = w->placements[i].def;
    most += corners_of(def) > 0 ? def->faces : 1;
  }
  w->primitives = malloc((most + 1) * sizeof *w->primitives);
  if (!w->primitives) return refuse_memory(error);
  for (uint32_t i = 0; i < w->placement_count; i++) {
    const vlShapeDef *def = w->placements[i].def;
    int corners = corners_of(def);
    if (corners == 0) w->primitives[w->primitive_count++] = (primitive){.placement = i, .light = -1};
    for (uint32_t face = 0; corners > 0 && face < def->faces; face++) add_face(w, i, face, corners);
  }
  return true;
}

bool make_world(vlContext *context, vlScene *scene, world *w, vlError *error) {
  const vlSceneDefs *defs = vl_scene_defs(scene);
  *w = (world){.context = context, .scene = scene, .rgb = defs->build.color == VL_COLOR_RGB};
  w->media_are_absent = defs->render.tracer == VL_TRACER_PATH;
  if (!check_tracer(defs, error)) return false;
  const vlShapeDef *def;
  for (uint32_t i = 1; (def = vl_scene_shape(scene, (vlShapeId){i})); i++) {
    if (!check_shape(def, error) || !place_shape(w, def, error)) return false;
  }
  return add_primitives(w, error) && read_textures(w, error) && read_materials(w, error) && read_media(w, error) &&
         make_accelerator(w) && read_lights(w, error);
}

void free_world(world *w) {
  free_lights(w);
  free_textures(w);
  free(w->placements);
  free(w->primitives);
  free(w->materials);
  free(w->media);
  free(w->nodes);
  free(w->order);
}
