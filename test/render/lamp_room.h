/* test/render/lamp_room.h: parts of a closed room whose lamp stands in a shade, so that most light is indirect. */
#ifndef TEST_RENDER_LAMP_ROOM_H
#define TEST_RENDER_LAMP_ROOM_H

#include "shots.h"

/* A tube that is closed below. */
static UNUSED void add_tube(Stage *s, float y, float height, float radius, vlMaterialId material) {
  for (int k = 0; k < 2; k++) { /* the tube and its bottom */
    vlShapeDef def = vl_default_shape_def(k ? VL_SHAPE_DISK : VL_SHAPE_CYLINDER);
    def.radius = radius, def.z_min = 0, def.z_max = height, def.height = 0;
    set_matrix(def.group_from_shape, 1, 0, 0, 0.4, 0, 0, 1, y, 0, -1, 0, -3); /* z up */
    def.material = material;
    assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
  }
}

static UNUSED void add_ball_of(Stage *s, float x, float y, float radius, vlMaterialId material, vlEmissionId emission) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(def.group_from_shape, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, -3);
  def.radius = radius, def.z_min = -radius, def.z_max = radius;
  def.material = material, def.emission = emission;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

/* The room's six walls. sides: left, right, and the others but the ceiling. */
static UNUSED void add_walls(Stage *s, const vlMaterialId sides[3], vlMaterialId ceiling) {
  for (int axis = 0; axis < 3; axis++)
    for (int side = -1; side <= 1; side += 2) {
      float at[3] = {0, 0, -2}, u[3] = {0}, v[3] = {0};
      at[axis] += 2.5f * (float)side, u[(axis + 1) % 3] = 2.5f, v[(axis + 2) % 3] = 2.5f;
      Quad q = quad_at(at[0], at[1], at[2], u[0], u[1], u[2], v[0], v[1], v[2]);
      q.material = axis == 0 ? sides[side > 0] : axis == 1 && side > 0 ? ceiling : sides[2];
      add_quad(s, &q);
    }
}

#endif
