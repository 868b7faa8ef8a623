/* world.c: makes the world: every shape at each of its places, and its primitives. Instances are not shared: a group
 * that stands in ten places is stored ten times. */
#include "more/more.h"
#include "program/program.h"

/* Which side is the outside follows pbrt-v4: a mirroring transform of the shape turns the normals of a quadric over,
 * not those of a mesh, and that of an instance turns none. */
static placement place(const vlShapeDef *def, matrix world_from_group, motion *moves) {
  placement p = {.def = def, .moves = moves};
  matrix group_from_shape = load_matrix(def->group_from_shape);
  bool shape_mirrors = determinant(&group_from_shape) < 0;
  p.world_from_shape = multiply(world_from_group, group_from_shape);
  p.shape_from_world = invert(&p.world_from_shape);
  p.mesh_mirrored = determinant(&p.world_from_shape) < 0;
  p.flip = def->reverse_orientation != shape_mirrors;
  return p;
}

/* The primitive of a face, or of a whole quadric, which has no corners. A triangle without area is never met, and
 * emits nothing: it is left out. */
static void add_primitive(world *w, uint32_t index, uint32_t face, uint32_t corners) {
  const placement *where = &w->placements[index];
  const vlShapeDef *def = where->def;
  primitive p = {.placement = index, .face = face, .light = -1};
  for (uint32_t k = 0; k < corners; k++) {
    size_t i = (size_t)corners * face + k;
    const float *position = def->positions + 3 * (def->indices ? def->indices[i] : i);
    p.corner[k] = transform_point(&where->world_from_shape, from_floats(position));
  }
  vector n = cross(subtract(p.corner[1], p.corner[0]), subtract(p.corner[2], p.corner[0]));
  if (corners == 3 && !(length(n) > 0)) return;
  w->primitives[w->primitive_count++] = p;
}

static void add_shape(world *w, const vlShapeDef *def, matrix world_from_group, motion *moves) {
  uint32_t corners = def->kind == VL_SHAPE_TRIANGLES ? 3 : more_corners(def);
  uint32_t faces = corners > 0 ? def->faces : 1;
  w->placements = resize(w->placements, w->placement_count + 1, sizeof *w->placements);
  w->primitives = resize(w->primitives, (size_t)w->primitive_count + faces, sizeof *w->primitives);
  w->placements[w->placement_count] = place(def, world_from_group, moves);
  for (uint32_t face = 0; face < faces; face++) add_primitive(w, w->placement_count, face, corners);
  w->placement_count++;
}

/* A shape of the world itself stands in one place, that of a group in as many as the group has instances. */
static void place_shape(world *w, const vlShapeDef *def) {
  if (!def->group.index) add_shape(w, def, IDENTITY, NULL);
  vlInstanceInfo info;
  for (uint32_t i = 1; vl_scene_instance(w->scene, (vlInstanceId){i}, &info) == VL_OK; i++) {
    bool here = def->group.index && info.group.index == def->group.index && info.shown;
    if (here) add_shape(w, def, load_matrix(info.world_from_group), make_motion(&info));
  }
}

bool make_world(vlContext *context, vlScene *scene, world *w, vlError *error) {
  const vlSceneDefs *defs = vl_scene_defs(scene);
  *w = (world){.context = context, .scene = scene, .rgb = defs->build.color == VL_COLOR_RGB};
  w->media_are_absent = defs->render.tracer == VL_TRACER_PATH;
  w->standard_material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  const vlShapeDef *def;
  for (uint32_t i = 1; (def = vl_scene_shape(scene, (vlShapeId){i})); i++) place_shape(w, def);
  make_accelerator(w);
  return read_images(w, error) && read_lights(w, error);
}
