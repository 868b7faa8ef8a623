/* test_illuminance.c: the illuminance of visible surfaces where it is known: lamps, skies,
 * disks of light, an integrating sphere, fog; whatever material, camera and tracer show it. */
#include "render/fog.h"
#include "velo/channels.h"
#include "velo/tracer.h"

#define PI 3.14159265358979323846

enum { SIZE = 8 };

/* The channel of each pixel. The stage is closed. */
static void take(Stage *s, float lux[SIZE * SIZE]) {
  vlWorld *world = NULL;
  vlCamera camera;
  vlFilm *film = NULL;
  vlImage *floats = NULL;
  vlError error = {0};
  if (vl_world_build(s->scene, &s->build, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  if (vl_camera_make(&s->camera, &camera, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(vl_film_create(s->context, &s->film, &film), VL_OK);
  assert_int_equal(vl_render(world, &camera, film, &s->render, NULL, NULL), VL_OK);
  vlChannelsDef def = vl_default_channels_def(SIZE, SIZE);
  def.channels = VL_CHANNEL_ILLUMINANCE;
  def.film = film;
  def.render = &s->render;
  if (vl_render_channels(world, &camera, &def, &floats, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_string_equal(vl_image_channel_name(floats, 0), "illuminance.Y");
  for (uint32_t i = 0; i < SIZE * SIZE; i++)
    lux[i] = vl_image_get(floats, i % SIZE, i / SIZE, 0);
  vl_image_destroy(floats);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(s);
}
static double mean(Stage *s) {
  float lux[SIZE * SIZE];
  take(s, lux);
  double sum = 0;
  for (uint32_t i = 0; i < SIZE * SIZE; i++)
    sum += lux[i];
  return sum / (SIZE * SIZE);
}

static Stage stage(void) {
  Stage s = stage_open(SIZE, SIZE);
  s.camera.fov = 0.01;
  s.render.spp = 64;
  s.render.max_depth = 1;
  return s;
}

/* A wall at z = -2, 80 wide, turned by 60 degrees about y if tilted. */
static void add_wall(Stage *s, vlMaterialId material, bool tilted) {
  float x = tilted ? 20 : 40, z = tilted ? 34.6410162f : 0;
  Quad wall = quad_at(0, 0, -2, x, 0, z, 0, 40, 0);
  wall.material = material;
  add_quad(s, &wall);
}

static vlMaterialId add_kind(Stage *s, uint32_t kind) {
  vlMaterialDef def = vl_default_material_def(kind);
  return vl_scene_add_material(s->scene, &def);
}

/* I cos / d^2 on whatever material. */
static void materials(void **state) {
  (void)state;
  static const uint32_t kinds[] = {VL_MATERIAL_DIFFUSE,
                                   VL_MATERIAL_CONDUCTOR,
                                   VL_MATERIAL_DIELECTRIC,
                                   VL_MATERIAL_PRINCIPLED,
                                   VL_MATERIAL_DIFFUSE_TRANSMISSION,
                                   VL_MATERIAL_SUBSURFACE,
                                   VL_MATERIAL_HAIR};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    for (int tilted = 0; tilted < 2; tilted++) {
      Stage s = stage();
      add_wall(&s, add_kind(&s, kinds[i]), tilted);
      add_point(&s, 0, 0, 0, 4000);
      char what[40];
      snprintf(what, sizeof what, "material %u, tilted %d", kinds[i], tilted);
      assert_ratio(what, mean(&s), tilted ? 500 : 1000, 0.003);
    }
}

/* The camera's settings and the film's do not count, nor does the colour mode. */
static void cameras(void **state) {
  (void)state;
  for (int which = 0; which < 6; which++) {
    Stage s = stage();
    add_wall(&s, add_diffuse(&s, 0, 0, 0), false);
    vlLightDef light = vl_default_light_def(VL_LIGHT_DISTANT);
    light.to[2] = -1;
    light.illuminance = 1000;
    assert_int_not_equal(vl_scene_add_light(s.scene, &light).index, 0);
    s.camera.exposure_time = which == 0 ? 0.01 : 1;
    s.camera.lens.vignetting = which == 1;
    s.camera.fov = which == 1 ? 1.5 : 0.01;
    s.film.white_balance = which == 2 ? 3000 : 0;
    s.film.sensor = which == 3 ? vl_sensor_name(1) : NULL;
    s.build.color = which == 4 ? VL_COLOR_RGB : s.build.color;
    s.film.max_component = which == 5 ? 1 : s.film.max_component;
    char what[20];
    snprintf(what, sizeof what, "setting %d", which);
    assert_ratio(what, mean(&s), 1000, 0.003);
  }
}

/* A sky of luminance L: pi L on a surface that sees half of it, of every shape. */
static void skies(void **state) {
  (void)state;
  for (int which = 0; which < 2; which++) {
    Stage s = stage();
    s.render.spp = 256;
    if (which) {
      const vlMediumId none = {0};
      add_ball(&s, -5, 1, add_kind(&s, VL_MATERIAL_DIELECTRIC), none, none);
      s.camera.fov = 0.1;
    } else {
      add_wall(&s, add_kind(&s, VL_MATERIAL_CONDUCTOR), true);
    }
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    def.color = vl_spectrum_blackbody(3000);
    def.scale = 7;
    assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
    assert_ratio(which ? "ball" : "wall", mean(&s), 7 * PI, 0.01);
  }
}

/* A disk of light of radius r at the distance d: pi L r^2 / (r^2 + d^2); and on the disk
 * itself, which nothing lights, 0. */
static void disks(void **state) {
  (void)state;
  for (int behind = 0; behind < 2; behind++) {
    Stage s = stage();
    s.render.spp = 256;
    add_wall(&s, add_diffuse(&s, 0.8f, 0.1f, 0.1f), false);
    vlShapeDef disk = vl_default_shape_def(VL_SHAPE_DISK);
    disk.radius = 1.5f;
    disk.emission = add_emission(&s, 20, true);
    set_matrix(disk.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, behind ? -1 : 0.5);
    assert_int_not_equal(vl_scene_add_shape(s.scene, &disk).index, 0);
    double expected = behind ? 0 : 20 * PI * 2.25 / (2.25 + 6.25);
    assert_near(behind ? "the disk" : "disk", mean(&s), expected, 0.005 * expected);
  }
}

/* A lamp of I in the middle of a sphere of radius 2 and reflectance .75: (I / 4) / (1 - .75).
 */
static void bounces(void **state) {
  (void)state;
  Stage s = stage();
  s.render.spp = 64;
  s.render.max_depth = 100;
  const vlMediumId none = {0};
  add_ball(&s, 0, 2, add_diffuse(&s, 0.75f, 0.75f, 0.75f), none, none);
  s.camera.eye[2] = 0.5;
  add_point(&s, 0, 0, 0, 100);
  assert_ratio("integrating sphere", mean(&s), 100, 0.02);
}

/* Fog between lamp and wall absorbs; fog between wall and camera does not count. */
static void absorption(void **state) {
  (void)state;
  Stage s = stage();
  vlMediumDef def = fog(0.5f, 0, 0);
  vlMediumId medium = add_medium(&s, &def);
  vl_scene_defs(s.scene)->camera_medium = medium;
  s.camera.eye[2] = 6;
  add_wall(&s, add_diffuse(&s, 0.5f, 0.5f, 0.5f), false);
  vlLightDef light = vl_default_light_def(VL_LIGHT_POINT);
  light.scale = 4000;
  light.medium = medium;
  light.from[0] = 0;
  assert_int_not_equal(vl_scene_add_light(s.scene, &light).index, 0);
  assert_ratio("fog", mean(&s), 1000 * exp(-1), 0.005);
}

/* A pixel that shows sky and wall has the illuminance of the wall; one without a wall has 0.
 * The sky is black; the wall covers the right 3.5 pixels. */
static void edges(void **state) {
  (void)state;
  Stage s = stage();
  s.camera.fov = 2 * atan(1e-3);
  Quad wall = quad_at(10 + 1e-3f / 4, 0, -2, 10, 0, 0, 0, 40, 0);
  wall.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
  add_quad(&s, &wall);
  add_point(&s, 0, 0, 0, 4000);
  float lux[SIZE * SIZE];
  take(&s, lux);
  for (uint32_t i = 0; i < SIZE * SIZE; i++)
    assert_near("edge", lux[i], i % SIZE < 4 ? 0 : 1000, 10);
}

/* The tracer of the image does not change a bit. */
static void tracers(void **state) {
  (void)state;
  static const uint32_t kinds[] = {VL_TRACER_VOLPATH,       VL_TRACER_SPPM,
                                   VL_TRACER_RAYCAST,       VL_TRACER_AMBIENT_OCCLUSION,
                                   VL_TRACER_BIDIRECTIONAL, VL_TRACER_LIGHT_PATH};
  float first[SIZE * SIZE], lux[SIZE * SIZE];
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    Stage s = stage();
    s.render.spp = 4;
    s.render.tracer = kinds[i];
    s.render.transparent = i == 1;
    add_wall(&s, add_diffuse(&s, 0.5f, 0.5f, 0.5f), true);
    add_sky(&s, 1);
    take(&s, i ? lux : first);
    if (i)
      assert_memory_equal(first, lux, sizeof lux);
  }
}

static bool stop(void *user) {
  ++*(int *)user;
  return true;
}

static void wrong(void **state) {
  (void)state;
  Stage s = stage();
  add_wall(&s, add_diffuse(&s, 0, 0, 0), false);
  add_point(&s, 0, 0, 0, 1);
  vlWorld *world = NULL;
  vlCamera camera;
  vlFilm *film = NULL;
  vlImage *floats = NULL;
  vlError error = {0};
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
  vlChannelsDef def = vl_default_channels_def(SIZE, SIZE);
  def.channels = VL_CHANNEL_ILLUMINANCE;
  assert_int_equal(vl_render_channels(world, &camera, &def, &floats, NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "illuminance"));
  def.film = film;
  def.render = &s.render;
  assert_int_equal(vl_render_channels(world, &camera, &def, &floats, NULL, &error),
                   VL_ERROR_ARGUMENT);
  assert_string_equal(error.message, "ground truth: the film has no samples yet");
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, NULL), VL_OK);
  int asked = 0;
  def.stop = stop;
  def.stop_user = &asked;
  s.render.max_depth = 0;
  vlResult r = vl_render_channels(world, &camera, &def, &floats, NULL, &error);
  /* it may be asked when all is done: then nothing is thrown away */
  assert_true(r == VL_OK ? floats != NULL : r == VL_CANCELLED && asked && !floats);
  vl_image_destroy(floats);
  vlCancel *cancel = NULL;
  assert_int_equal(vl_cancel_create(s.context, &cancel), VL_OK);
  vl_cancel_request(cancel);
  def.stop = NULL;
  def.cancel = cancel;
  assert_int_equal(vl_render_channels(world, &camera, &def, &floats, NULL, NULL), VL_CANCELLED);
  assert_null(floats);
  vl_cancel_destroy(cancel);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(materials), cmocka_unit_test(cameras), cmocka_unit_test(skies),
      cmocka_unit_test(disks),     cmocka_unit_test(bounces), cmocka_unit_test(absorption),
      cmocka_unit_test(edges),     cmocka_unit_test(tracers), cmocka_unit_test(wrong)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
