/* test/render/test_two_way_inner.c: connections of inner vertices (bidirectional): exact
 * radiance in a white furnace; the mean of the path tracer in rooms whose lamps stand in
 * shades, for each greatest number of bounces; less noise than the path tracer there. */
#include "render/agreement.h"
#include "render/lamp_room.h"
#include "velo/tracer.h"

enum { SIZE = 24, FURNACE = 32 };

/* A ball whose vertex normals differ from its geometric normals. */
static void add_faceted(Stage *s, float x, float y, float radius, vlMaterialId material) {
  float *block = NULL;
  vlShapeDef def = mesh_sphere(6, radius, true, &block);
  set_matrix(def.group_from_shape, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, -2.6);
  def.material = material;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
  free(block);
}

typedef struct Room {
  uint32_t depth;
  bool spectral, plastic;
} Room;

/* A closed room, with a ceiling of plastic if that is wanted, with a bulb in a tube that is
 * open above. In it are balls, one of plastic, one of glass, and one of few facets. */
static Stage room(const void *user, vlTracer tracer) {
  const Room *what = user;
  Stage s = stage_open_in(NULL, SIZE, SIZE);
  s.build.color = what->spectral ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  s.camera.fov = 1.2;
  s.render.max_depth = what->depth;
  s.render.spp = tracer == VL_TRACER_PATH ? 96 : 20;
  s.render.light_paths = 2048; /* several groups of wavelengths */
  vlMaterialId red = add_diffuse(&s, 0.8f, 0.4f, 0.3f),
               blue = add_diffuse(&s, 0.3f, 0.5f, 0.8f);
  vlMaterialId white = add_diffuse(&s, 0.7f, 0.7f, 0.7f),
               dark = add_diffuse(&s, 0.3f, 0.2f, 0.1f);
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
  def.u_roughness = def.v_roughness = vl_float_input(0.3f);
  vlMaterialId plastic = vl_scene_add_material(s.scene, &def);
  const vlMaterialId walls[3] = {red, blue, white};
  add_walls(&s, walls, what->plastic ? plastic : white);
  add_tube(&s, 0.2f, 0.5f, 0.35f, dark);
  add_ball_of(&s, 0.4f, 0.5f, 0.15f, dark, add_emission(&s, 40, false));
  add_ball_of(&s, -1, -1, 0.6f, plastic, (vlEmissionId){0});
  def = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
  def.u_roughness = def.v_roughness = vl_float_input(0.4f);
  add_ball_of(&s, 0.8f, -0.9f, 0.5f, vl_scene_add_material(s.scene, &def), (vlEmissionId){0});
  add_faceted(&s, -0.9f, 0.6f, 0.5f, white);
  return s;
}

static void rooms(void **state) {
  (void)state;
  static const Room all[4] = {
      {2, false, true}, {3, false, false}, {6, false, true}, {4, true, true}};
  for (int k = 0; k < 4; k++) {
    Measure path = measure(room, &all[k], VL_TRACER_PATH),
            both = measure(room, &all[k], VL_TRACER_BIDIRECTIONAL);
    char what[64];
    snprintf(what, sizeof what, "depth %u%s", all[k].depth,
             all[k].spectral ? ", spectral" : "");
    assert_agree(what, "bidirectional", &both, &path, 0.002);
  }
}

static void less_noise(void **state) {
  (void)state;
  const Room what = {6, false, false};
  double path = pair_noise(room, &what, VL_TRACER_PATH),
         both = pair_noise(room, &what, VL_TRACER_BIDIRECTIONAL);
  if (!(both < path / 5))
    fail_msg("noise of the path tracer %g, bidirectional %g", path, both);
}

/* The inside of a ball that emits 1 and reflects a half of the light: 1 + 1/2 + 1/4 + ...
 * everywhere. */
static Stage furnace(const void *user, vlTracer tracer) {
  (void)tracer;
  Stage s = stage_open_in(NULL, FURNACE, FURNACE);
  s.build.color = *(const bool *)user ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  s.render.max_depth = 5;
  s.render.spp = 16;
  add_furnace(&s);
  return s;
}

static void white_furnace(void **state) {
  (void)state;
  for (int spectral = 0; spectral < 2; spectral++) {
    bool color = spectral;
    assert_furnace(furnace, &color, 1.96875);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rooms), cmocka_unit_test(less_noise),
                                     cmocka_unit_test(white_furnace)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
