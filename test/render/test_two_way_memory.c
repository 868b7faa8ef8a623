/* test/render/test_two_way_memory.c: the tracers with light paths when memory runs out: each
 * failing allocation gives an error and leaks nothing. */
#include "render/shots.h"

#include "failing_allocator.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

/* A ball of fog over a floor under a lamp, a few pixels wide. */
static vlResult fill(vlScene *scene) {
  static const float p[12] = {-3, -1, 0, 3, -1, 0, -3, -1, -6, 3, -1, -6};
  static const uint32_t face[4] = {0, 1, 2, 3};
  vlMaterialDef diffuse = vl_default_material_def(VL_MATERIAL_DIFFUSE),
                skin = vl_default_material_def(VL_MATERIAL_INTERFACE);
  vlShapeDef floor = vl_default_shape_def(VL_SHAPE_BILINEAR),
             ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  floor.vertices = 4;
  floor.faces = 1;
  floor.positions = p;
  floor.indices = face;
  floor.material = vl_scene_add_material(scene, &diffuse);
  vl_scene_add_shape(scene, &floor);
  vlMediumDef fog = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  ball.inside = vl_scene_add_medium(scene, &fog);
  ball.material = vl_scene_add_material(scene, &skin);
  set_matrix(ball.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3);
  vl_scene_add_shape(scene, &ball);
  vlLightDef lamp = vl_default_light_def(VL_LIGHT_POINT);
  lamp.from[1] = 1.5f;
  lamp.from[2] = -3;
  vl_scene_add_light(scene, &lamp);
  return vl_scene_result(scene, NULL);
}

static vlResult render(vlContext *context, void *user) {
  const vlTracer *tracer = user;
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlBuildDef build = vl_default_build_def();
  build.color = VL_COLOR_RGB;
  vlRenderStats stats;
  vlCamera camera;
  vlCameraDef camera_def = vl_default_camera_def(8, 8);
  camera_def.lookat[2] = -1;
  vlFilmDef film_def = vl_default_film_def(8, 8);
  vlRenderDef def = vl_default_render_def();
  def.tracer = *tracer;
  def.spp = 2;
  def.light_paths = 1 << 17; /* photons that the first room cannot hold */
  vlResult r = vl_scene_create(context, &scene);
  if (r == VL_OK)
    r = fill(scene);
  if (r == VL_OK)
    r = vl_world_build(scene, &build, &world, NULL);
  if (r == VL_OK)
    r = vl_camera_make(&camera_def, &camera, NULL, NULL);
  if (r == VL_OK)
    r = vl_film_create(context, &film_def, &film);
  if (r == VL_OK)
    r = vl_render(world, &camera, film, &def, &stats, NULL);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return r;
}

static void out_of_memory(void **state) {
  (void)state;
  vlTracer tracers[] = {VL_TRACER_MERGING, VL_TRACER_BIDIRECTIONAL, VL_TRACER_VOLPATH};
  fail_everywhere(render, &tracers[0], 30);
  fail_everywhere(render, &tracers[1], 30);
  fail_everywhere(render, &tracers[2], 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(out_of_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
