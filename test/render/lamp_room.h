/* test/render/lamp_room.h: what the tests of inner connections share: parts of a closed room
 * whose lamp stands in a shade, so that most light is indirect; its noise; a white furnace. */
#ifndef TEST_RENDER_LAMP_ROOM_H
#define TEST_RENDER_LAMP_ROOM_H

#include "render/agreement.h"
#include "shots.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

/* A tube that is closed below. */
static UNUSED void add_tube(Stage *s, float y, float height, float radius,
                            vlMaterialId material) {
  for (int k = 0; k < 2; k++) { /* the tube and its bottom */
    vlShapeDef def = vl_default_shape_def(k ? VL_SHAPE_DISK : VL_SHAPE_CYLINDER);
    def.radius = radius;
    def.z_min = 0;
    def.z_max = height;
    def.height = 0;
    set_matrix(def.group_from_shape, 1, 0, 0, 0.4, 0, 0, 1, y, 0, -1, 0, -3); /* z up */
    def.material = material;
    assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
  }
}

static UNUSED void add_ball_of(Stage *s, float x, float y, float radius, vlMaterialId material,
                               vlEmissionId emission) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(def.group_from_shape, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, -3);
  def.radius = radius;
  def.z_min = -radius;
  def.z_max = radius;
  def.material = material;
  def.emission = emission;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

/* The room's six walls. sides: left, right, and the others but the ceiling. */
static UNUSED void add_walls(Stage *s, const vlMaterialId sides[3], vlMaterialId ceiling) {
  for (int axis = 0; axis < 3; axis++)
    for (int side = -1; side <= 1; side += 2) {
      float at[3] = {0, 0, -2}, u[3] = {0}, v[3] = {0};
      at[axis] += 2.5f * (float)side;
      u[(axis + 1) % 3] = 2.5f;
      v[(axis + 2) % 3] = 2.5f;
      Quad q = quad_at(at[0], at[1], at[2], u[0], u[1], u[2], v[0], v[1], v[2]);
      q.material = axis == 0 ? sides[side > 0] : axis == 1 && side > 0 ? ceiling : sides[2];
      add_quad(s, &q);
    }
}

/* The mean of (a - b)^2 / (a + b)^2 over the pixels of two seeds, 8 samples each. */
static UNUSED double pair_noise(MakeStage *make, const void *user, vlTracer tracer) {
  Image p[2];
  for (uint32_t k = 0; k < 2; k++) {
    Stage s = make(user, tracer);
    s.render.tracer = tracer;
    s.render.spp = 8;
    s.render.seed = k;
    p[k] = stage_finish(&s);
  }
  double sum = 0;
  uint32_t pixels = p[0].width * p[0].height;
  for (uint32_t i = 0; i < pixels; i++) {
    double a = p[0].rgba[4 * i + 1], b = p[1].rgba[4 * i + 1];
    sum += a + b > 0 ? (a - b) * (a - b) / ((a + b) * (a + b)) : 1;
  }
  image_free(&p[0]);
  image_free(&p[1]);
  return sum / pixels;
}

/* A ball around the camera that emits 1 and reflects a half of the light. */
static UNUSED void add_furnace(Stage *s) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.radius = 2;
  def.z_min = -2;
  def.z_max = 2;
  def.material = add_diffuse(s, 0.5f, 0.5f, 0.5f);
  def.emission = add_emission(s, 1, true);
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

/* The bidirectional radiance of a furnace is `times` its emission everywhere. */
static UNUSED void assert_furnace(MakeStage *furnace, const void *user, double times) {
  Stage s = furnace(user, VL_TRACER_RAYCAST);
  s.render.tracer = VL_TRACER_RAYCAST;
  s.render.spp = 256; /* emission of 1 in the colours of the film */
  Image one = stage_finish(&s);
  Measure m = measure(furnace, user, VL_TRACER_BIDIRECTIONAL);
  for (int c = 0; c < AGREEMENT_CHANNELS; c++)
    for (int band = 0; band < AGREEMENT_BANDS; band++)
      assert_ratio("furnace", m.mean[band][c], times * image_mean(&one, c),
                   0.001 + 5 * m.error[band][c] / m.mean[band][c]);
  image_free(&one);
}

#endif
