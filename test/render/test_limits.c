/* test/render/test_limits.c: limits of bounces of one kind (vlRenderDef.max_diffuse_depth and
 * the like). In a closed room that shines and reflects by rho, a limit of n leaves the sum of
 * rho^k up to k = n. Where all bounces are of one kind, its limit is max_depth. */
#include "fog.h"
#include "velo/paths.h"
#include "velo/tracer.h"

typedef enum Kind { DIFFUSE, GLOSSY, TRANSMISSION, VOLUME } Kind;

static uint32_t *limit_of(vlRenderDef *def, Kind kind) {
  uint32_t *const limits[] = {&def->max_diffuse_depth, &def->max_glossy_depth,
                              &def->max_transmission_depth, &def->max_volume_depth};
  return limits[kind];
}

/* ---- a room that shines ------------------------------------------------------------------ */

typedef struct Room {
  vlMaterialKind material;
  uint32_t limits[4]; /* by Kind; 0: none */
  uint32_t max_depth;
  vlTracer tracer;
} Room;

static vlMaterialId wall_of(Stage *s, const Room *room) {
  vlMaterialDef def = vl_default_material_def(room->material);
  const vlSpectrum half = vl_spectrum_constant(0.5f);
  def.reflectance = vl_spectrum_input(half);
  if (room->material == VL_MATERIAL_CONDUCTOR) {
    def.use_reflectance = true;
    def.u_roughness = def.v_roughness = vl_float_input(0);
  }
  return vl_scene_add_material(s->scene, &def);
}

/* The camera is at the centre, so it sees the wall from straight above. */
static Stage room_stage(vlContext *context, const Room *room) {
  Stage s = stage_open_in(context, 16, 16);
  s.camera.fov = 0.1;
  s.build.color = VL_COLOR_RGB;
  s.render.spp = 64;
  s.render.tracer = room->tracer;
  s.render.max_depth = room->max_depth;
  for (int k = 0; k < 4; k++)
    *limit_of(&s.render, (Kind)k) = room->limits[k];
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.radius = 2;
  def.z_min = -2;
  def.z_max = 2;
  def.material = wall_of(&s, room);
  def.emission = add_emission(&s, 1, true);
  assert_int_not_equal(vl_scene_add_shape(s.scene, &def).index, 0);
  return s;
}

static Image room_image(vlContext *context, const void *what) {
  Stage s = room_stage(context, what);
  return stage_finish(&s);
}

static double room_mean(const Room *room) {
  Image p = room_image(NULL, room);
  double mean = image_mean(&p, 1);
  image_free(&p);
  return mean;
}

static void partial_sums(void **state) {
  (void)state;
  const vlMaterialKind materials[] = {VL_MATERIAL_DIFFUSE, VL_MATERIAL_CONDUCTOR};
  for (int m = 0; m < 2; m++)
    for (uint32_t n = 1; n <= 5; n++) {
      Room room = {.material = materials[m], .max_depth = 60, .tracer = VL_TRACER_PATH};
      room.limits[m == 0 ? DIFFUSE : GLOSSY] = n;
      double expected = 2 - pow(0.5, n);
      assert_ratio(m ? "mirrors" : "matt", room_mean(&room), expected, 0.01);
    }
}

static void same(const char *what, const Room *a, const Room *b) {
  Image p = room_image(NULL, a), q = room_image(NULL, b);
  if (memcmp(p.rgba, q.rgba, (size_t)p.width * p.height * 4 * sizeof(float)) != 0)
    fail_msg("%s: other bytes", what);
  image_free(&p);
  image_free(&q);
}

static void one_kind_alone(void **state) {
  (void)state;
  for (uint32_t n = 1; n <= 3; n++) {
    Room all = {VL_MATERIAL_DIFFUSE, {0}, n, VL_TRACER_PATH}, kind = all, others = all;
    kind.max_depth = 60;
    kind.limits[DIFFUSE] = n;
    same("the limit of the only kind", &all, &kind);
    others.limits[GLOSSY] = others.limits[TRANSMISSION] = others.limits[VOLUME] = 1;
    same("limits of other kinds", &all, &others);
  }
}

static void other_tracers(void **state) {
  (void)state;
  const vlTracer tracers[] = {VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING, VL_TRACER_LIGHT_PATH,
                              VL_TRACER_RANDOM_WALK};
  const Room volpath = {VL_MATERIAL_DIFFUSE, {2, 0, 0, 0}, 60, VL_TRACER_VOLPATH};
  for (int k = 0; k < 4; k++) {
    Room room = volpath;
    room.tracer = tracers[k];
    same("volpath takes the place of others", &volpath, &room);
  }
}

static void same_bits(void **state) {
  (void)state;
  const Room room = {VL_MATERIAL_COATED_DIFFUSE, {2, 1, 0, 0}, 20, VL_TRACER_VOLPATH};
  Image p = assert_same_bits(room_image, &room, 2);
  image_free(&p);
}

/* Recorded paths end where the image's do, and say why. */
static void recorded(void **state) {
  (void)state;
  const Room room = {VL_MATERIAL_DIFFUSE, {2, 0, 0, 0}, 60, VL_TRACER_PATH};
  Stage s = room_stage(NULL, &room);
  s.render.share_samples = false;
  vlWorld *world = NULL;
  vlCamera camera;
  vlPixelPaths *paths = NULL;
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
  assert_int_equal(vl_trace_paths(world, &camera, &s.film, &s.render, 3, 4, 0, 8, &paths, NULL),
                   VL_OK);
  assert_int_equal(paths->count, 8);
  for (uint32_t i = 0; i < paths->count; i++) {
    const vlPath *path = &paths->paths[i];
    assert_int_equal(path->vertex_count, 3);
    assert_int_equal(path->vertices[2].fate, VL_PATH_DEPTH);
  }
  vl_pixel_paths_destroy(paths);
  vl_world_destroy(world);
  stage_close(&s);
}

/* ---- panes ------------------------------------------------------------------------------- */

/* The radiance of thin panes before a sky of 1. */
static double panes(int count, uint32_t transmissions, uint32_t reflections) {
  Stage s = stage_open(8, 8);
  s.camera.fov = 0.1;
  s.render.spp = 1024;
  s.render.max_depth = 100;
  s.render.max_transmission_depth = transmissions;
  s.render.max_glossy_depth = reflections;
  add_sky(&s, 1);
  vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_THIN_DIELECTRIC);
  glass.eta = vl_spectrum_input(vl_spectrum_constant(2)); /* reflects f, with its echoes r */
  vlMaterialId material = vl_scene_add_material(s.scene, &glass);
  for (int k = 0; k < count; k++) {
    Quad quad = quad_at(0, 0, -1.0f - (float)k, 5, 0, 0, 0, 5, 0);
    quad.material = material;
    add_quad(&s, &quad);
  }
  Image p = stage_finish(&s);
  double mean = image_mean(&p, 1);
  image_free(&p);
  return mean;
}

static void through_panes(void **state) {
  (void)state;
  const double f = 1.0 / 9, r = 2 * f / (1 + f), t = 1 - r;
  assert_near("no limit", panes(2, 0, 0), 1, 0.01);
  assert_near("one pane, once", panes(1, 1, 0), 1, 0.01);
  assert_near("two panes, once", panes(2, 1, 0), r, 0.01);
  assert_near("two panes, twice", panes(2, 2, 0), 1, 0.01);
  assert_near("three panes, twice", panes(3, 2, 0), r + t * t * r / (1 - r * r), 0.015);
  assert_near("two panes, one reflection", panes(2, 0, 1), r + t * t, 0.015);
}

/* ---- fog --------------------------------------------------------------------------------- */

static double fog_mean(uint32_t max_depth, uint32_t scatterings) {
  Stage s = stage_open(8, 8);
  s.camera.fov = 0.35;
  s.render.spp = 1024;
  s.render.tracer = VL_TRACER_VOLPATH;
  s.render.max_depth = max_depth;
  s.render.max_volume_depth = scatterings;
  add_sky(&s, 1);
  vlMediumDef def = fog(0, 1, 0);
  add_ball(&s, -3, 1, interface(&s), add_medium(&s, &def), (vlMediumId){0});
  Image p = stage_finish(&s);
  double mean = image_mean(&p, 1);
  image_free(&p);
  return mean;
}

static void in_fog(void **state) {
  (void)state;
  assert_near("white fog", fog_mean(200, 0), 1, 0.02);
  for (uint32_t n = 1; n <= 3; n++)
    assert_ratio("scatterings", fog_mean(200, n), fog_mean(n, 0), 0.02);
  assert_true(fog_mean(200, 1) < 0.95 * fog_mean(200, 3));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(partial_sums),  cmocka_unit_test(one_kind_alone),
      cmocka_unit_test(other_tracers), cmocka_unit_test(same_bits),
      cmocka_unit_test(recorded),      cmocka_unit_test(through_panes),
      cmocka_unit_test(in_fog)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
