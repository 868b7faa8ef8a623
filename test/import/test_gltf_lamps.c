/* test_gltf_lamps.c: EXT_lights_ies: external and embedded files, the lamp's axes in its node's
 * space, multiplier and colour, messages about wrong members. */
#include <math.h>

#include "import/gltf_load.h"
#include "velo/export.h"
#include "velo/light.h"
#include "velo/world.h"

#define LAMP "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 180\n0\n9 9\n"

static void is_near(double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance))
    fail_msg("%.9g, not %.9g", value, expected);
}

/* A turned node with the lamp's members; the profile's members. */
#define WITH_LAMP(node, profile)                                                         \
  SCENE                                                                                  \
  "\"extensionsUsed\":[\"EXT_lights_ies\"],\"extensionsRequired\":[\"EXT_lights_ies\"]," \
  "\"nodes\":[{\"translation\":[1,2,3],\"rotation\":[0,0.7071067811865476,0,"            \
  "0.7071067811865476],\"extensions\":{\"EXT_lights_ies\":{" node                        \
  "}}}],\"extensions\":{\"EXT_lights_ies\":{\"lights\":[{" profile "}]}}"

static void write_lamp(const char *name) {
  FILE *file = fopen(in_folder(name), "wb");
  assert_non_null(file);
  assert_true(fputs(LAMP, file) >= 0);
  assert_int_equal(fclose(file), 0);
}

/* The world's direction of one in light space. */
static void turned(const vlLightDef *light, double x, double y, double z, double out[3]) {
  const double *m = light->world_from_light;
  for (int i = 0; i < 3; i++)
    out[i] = m[4 * i] * x + m[4 * i + 1] * y + m[4 * i + 2] * z;
}

static void is_direction(const double d[3], double x, double y, double z) {
  is_near(d[0], x, 1e-6);
  is_near(d[1], y, 1e-6);
  is_near(d[2], z, 1e-6);
}

static void check_light(const vlScene *scene) {
  assert_int_equal(scene->lights.count, 1);
  const vlLightDef *light = &scene->lights.items[0];
  double d[3];
  assert_int_equal(light->kind, VL_LIGHT_GONIOMETRIC);
  is_near((double)light->scale, 2.5, 1e-6);
  is_near((double)light->color.rgb[1], 0.5, 1e-6);
  is_near(light->world_from_light[3], 1, 0);
  is_near(light->world_from_light[7], 2, 0);
  is_near(light->world_from_light[11], 3, 0);
  /* the node turns by 90 degrees about y: its -z is the world's -x, its x the world's -z */
  turned(light, 0, -1, 0, d); /* the aim */
  is_direction(d, -1, 0, 0);
  turned(light, 1, 0, 0, d); /* C 0 */
  is_direction(d, 0, 0, -1);
  turned(light, 0, 0, -1, d); /* C 90 */
  is_direction(d, 0, 1, 0);
}

static void check_world(Loaded *l) {
  vlWorld *world = NULL;
  vlWorldInfo info;
  vlError error = {0};
  if (vl_world_build(l->scene, NULL, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  vl_world_info(world, &info);
  assert_int_equal(info.lights, 1);
  vl_world_destroy(world);
}

#define NODE "\"light\":0,\"multiplier\":2.5,\"color\":[1,0.5,0.25]"

static void external(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  write_lamp("lamp.ies");
  fine(&l, g, WITH_LAMP(NODE, "\"uri\":\"lamp.ies\""));
  check_light(l.scene);
  assert_non_null(strstr(l.scene->lights.items[0].path, "lamp.ies"));
  check_world(&l);
  end_load(&l);
  free(g);
}

static void embedded(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded l;
  gltf_view(g, LAMP, strlen(LAMP), 0);
  fine(&l, g, WITH_LAMP(NODE, "\"bufferView\":2,\"mimeType\":\"application/x-ies-lm-63\""));
  check_light(l.scene);
  const vlLightDef *light = &l.scene->lights.items[0];
  assert_int_equal(light->lamp_size, strlen(LAMP));
  assert_memory_equal(light->lamp_data, LAMP, strlen(LAMP));
  check_world(&l);
  end_load(&l);
  free(g);
}

/* Written again as .gltf (a file beside it) and .glb (inside), the light and its file are the
 * same. */
static void written(void **state) {
  (void)state;
  Gltf *g = new_square();
  Loaded first;
  write_lamp("lamp.ies");
  fine(&first, g, WITH_LAMP(NODE, "\"uri\":\"lamp.ies\""));
  static const char *const names[2] = {"again.gltf", "again.glb"};
  for (int i = 0; i < 2; i++) {
    vlSaveDef strict = vl_default_save_def();
    strict.strict = true;
    vlError error = {0};
    if (vl_scene_save(first.scene, in_folder(names[i]), &strict, &error) != VL_OK)
      fail_msg("%s: %s", names[i], error.message);
    Loaded l;
    start_load(&l);
    l.result = vl_scene_load(l.scene, in_folder(names[i]), NULL, &l.error);
    if (l.result != VL_OK)
      fail_msg("%s: %s", names[i], l.error.message);
    check_light(l.scene);
    check_world(&l);
    const vlLightDef *light = &l.scene->lights.items[0];
    for (int c = 0; c < 3; c++)
      is_near((double)light->color.rgb[c], 1.0 / (1 << c), 1e-6);
    if (i) {
      assert_int_equal(light->lamp_size, strlen(LAMP));
      assert_memory_equal(light->lamp_data, LAMP, strlen(LAMP));
    } else {
      assert_non_null(strstr(light->path, "again-lamp1.ies"));
    }
    end_load(&l);
  }
  end_load(&first);
  free(g);
}

/* What glTF has not is left out, and said. */
static void not_written(void **state) {
  (void)state;
  static const char eulumdat[] = "a EULUMDAT file";
  Loaded l;
  start_load(&l);
  vlLightDef def = vl_default_light_def(VL_LIGHT_GONIOMETRIC);
  def.lamp_data = eulumdat;
  def.lamp_size = sizeof eulumdat - 1;
  assert_int_not_equal(vl_scene_add_light(l.scene, &def).index, 0);
  vlSaveDef strict = vl_default_save_def();
  strict.strict = true;
  vlError error = {0};
  assert_int_equal(vl_scene_save(l.scene, in_folder("none.gltf"), &strict, &error),
                   VL_ERROR_UNSUPPORTED);
  assert_non_null(strstr(error.message, "EULUMDAT"));
  def = vl_default_light_def(VL_LIGHT_GONIOMETRIC);
  def.path = "/no/such/lamp.ies";
  assert_int_not_equal(vl_scene_add_light(l.scene, &def).index, 0);
  assert_int_equal(vl_scene_save(l.scene, in_folder("none.gltf"), NULL, &error),
                   VL_ERROR_MISSING);
  end_load(&l);
}

static void wrong(void **state) {
  (void)state;
  static const struct {
    const char *rest, *message;
  } cases[] = {
      {WITH_LAMP("\"light\":1", "\"uri\":\"lamp.ies\""), "EXT_lights_ies"},
      {WITH_LAMP("\"light\":0,\"multiplier\":-1", "\"uri\":\"lamp.ies\""), "negative"},
      {WITH_LAMP("\"light\":0,\"color\":[1,-1,1]", "\"uri\":\"lamp.ies\""), "negative"},
      {WITH_LAMP("\"light\":0", "\"name\":\"none\""), "neither"},
      {WITH_LAMP("\"light\":0", "\"uri\":\"lamp.png\""), "does not end with .ies"},
      {WITH_LAMP("\"light\":0", "\"bufferView\":7"), "bufferView"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Gltf *g = new_square();
    Loaded l;
    load(&l, g, cases[i].rest, NULL);
    if (l.result != VL_ERROR_SCENE || !strstr(l.error.message, cases[i].message))
      fail_msg("%zu: result %d: %s", i, l.result, l.error.message);
    end_load(&l);
    free(g);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(external), cmocka_unit_test(embedded),
                                     cmocka_unit_test(written), cmocka_unit_test(not_written),
                                     cmocka_unit_test(wrong)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
