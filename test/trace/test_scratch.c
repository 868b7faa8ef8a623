/* test/trace/test_scratch.c: a worker's memory by what the world has: at most 0.95 MB without
 * media and subsurface materials, and more only with them. */
#include <stdlib.h>
#include <string.h>

#include "trace/surface/probes.h"
#include "unit.h"
#include "velo/velo.h"

typedef enum Has { NOTHING, MEDIUM, CHANNELS, SUBSURFACE, HAS_COUNT } Has;

static vlWorld *make_world(vlContext *context, Has has) {
  vlScene *scene;
  vlWorld *world;
  vlError error;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlMaterialDef material =
      vl_default_material_def(has == SUBSURFACE ? VL_MATERIAL_SUBSURFACE : VL_MATERIAL_DIFFUSE);
  vlShapeDef shape = vl_default_shape_def(VL_SHAPE_SPHERE);
  shape.material = vl_scene_add_material(scene, &material);
  if (has == MEDIUM || has == CHANNELS) {
    vlMediumDef medium = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
    medium.rgb_absorption = has == CHANNELS;
    medium.sigma_a = vl_spectrum_rgb(0.1f, 0.2f, 0.3f);
    shape.inside = vl_scene_add_medium(scene, &medium);
  }
  assert_int_not_equal(vl_scene_add_shape(scene, &shape).index, 0);
  vlBuildDef build = vl_default_build_def();
  if (vl_world_build(scene, &build, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  vl_scene_destroy(scene);
  return world;
}

static void sizes(void **state) {
  (void)state;
  vlContext *context;
  size_t size[HAS_COUNT];
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  for (int has = 0; has < HAS_COUNT; has++) {
    vlWorld *world = make_world(context, (Has)has);
    size[has] = vl_trace_scratch_size(world);
    vlTraceScratch *s = aligned_alloc(64, size[has]);
    memset(s, 0, size[has]);
    vl_trace_scratch_begin(s, world);
    assert_int_equal(s->volume != NULL, has != NOTHING);
    assert_int_equal(s->subsurface != NULL, has == SUBSURFACE);
    assert_int_equal(s->by_channel != NULL, has == CHANNELS);
    assert_int_equal(s->at.shade.tint != NULL, has == CHANNELS);
    free(s);
    vl_world_destroy(world);
  }
  assert_true(size[NOTHING] <= 954000);
  assert_true(size[MEDIUM] == size[NOTHING] + sizeof(vlVolumeScratch));
  assert_true(size[CHANNELS] == size[MEDIUM] + sizeof(vlByChannel));
  assert_true(size[SUBSURFACE] == size[MEDIUM] + sizeof(vlSubsurfaceScratch));
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sizes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
