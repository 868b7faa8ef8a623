/* test/render/test_two_way.c: the tracers with light paths against the path tracer: the same
 * mean within both standard errors, for every kind of light and surface; the same bits for any
 * threads; failing allocations. */
#include "render/agreement.h"
#include "velo/filter_kinds.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

enum { SIZE = 24, FINE = 96 };

typedef enum Lamp {
  PANEL,
  PANEL_BOTH,
  PATCH,
  BALL,
  POINT,
  SPOT,
  DISTANT,
  SKY,
  IMAGE,
  MEASURED,
  SLIDE,
  SKEWED,
  WASHER,
  SKEWED_WASHER,
  LAMPS
} Lamp;
static const char *const lamp_name[LAMPS] = {"panel",      "two-sided panel",
                                             "patch",      "ball",
                                             "point",      "spot",
                                             "distant",    "uniform sky",
                                             "image sky",  "goniometric",
                                             "projection", "projection, skewed",
                                             "lamp file",  "lamp file, skewed"};

static void add_round(Stage *s, float x, float y, float z, float radius, vlMaterialId material,
                      vlEmissionId emission) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(def.group_from_shape, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z);
  def.radius = radius;
  def.z_min = -radius;
  def.z_max = radius;
  def.material = material;
  def.emission = emission;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

static vlLightDef lamp_def(vlLightKind kind, float color) {
  vlLightDef def = vl_default_light_def(kind);
  def.color = vl_spectrum_rgb(color, 0.8f * color, 0.6f * color);
  const float from[3] = {0.3f, 1.4f, -2.6f}, to[3] = {-0.2f, -1, -3.2f};
  memcpy(def.from, from, sizeof from);
  memcpy(def.to, to, sizeof to);
  def.cone_angle = 0.8f;
  def.cone_delta = 0.3f;
  return def;
}

static void add_washer(Stage *s, bool skewed) {
  vlLightDef def = lamp_def(VL_LIGHT_GONIOMETRIC, 1);
  def.path = VELO_SOURCE_DIR "/scenes/lamps/wall_washer.ies";
  def.scale = 0.005f;
  if (skewed) {
    def.world_from_light[0] = 2;
    def.world_from_light[4] = 0.5;
  }
  assert_int_not_equal(vl_scene_add_light(s->scene, &def).index, 0);
}

static void add_lamp(Stage *s, Lamp lamp) {
  if (lamp >= WASHER) {
    add_washer(s, lamp == SKEWED_WASHER);
    return;
  }
  vlMaterialId dark = add_diffuse(s, 0.2f, 0.2f, 0.2f);
  if (lamp <= PATCH) {
    Quad q = quad_at(0.4f, 1.3f, -3, 0.3f, 0.05f, 0, 0, 0.1f, 0.3f);
    q.material = dark;
    q.patch = lamp == PATCH;
    q.emission = add_emission(s, 10, lamp == PANEL_BOTH);
    add_quad(s, &q);
  } else if (lamp == BALL) {
    add_round(s, 0.3f, 1.1f, -3, 0.2f, dark, add_emission(s, 8, false));
  } else {
    static const vlLightKind kinds[LAMPS] = {
        [POINT] = VL_LIGHT_POINT,      [SPOT] = VL_LIGHT_SPOT,
        [DISTANT] = VL_LIGHT_DISTANT,  [SKY] = VL_LIGHT_INFINITE,
        [IMAGE] = VL_LIGHT_INFINITE,   [MEASURED] = VL_LIGHT_GONIOMETRIC,
        [SLIDE] = VL_LIGHT_PROJECTION, [SKEWED] = VL_LIGHT_PROJECTION};
    vlLightDef def = lamp_def(kinds[lamp], lamp == POINT || lamp == SPOT || lamp >= MEASURED ? 5
                                           : lamp == DISTANT                                 ? 2
                                                             : 0.7f);
    float rgb[8 * 8 * 3];
    for (int i = 0; i < 8 * 8 * 3; i++)
      rgb[i] = 0.2f + (i / 3 % 8 == 3 ? 4.0f : 0.0f) * (float)(i % 3);
    if (lamp == IMAGE || lamp >= MEASURED)
      def.image = make_image(s, 8, 8, rgb);
    if (lamp >= MEASURED)
      set_matrix(def.world_from_light, 1, 0, 0, 0.3, 0, 0, -1, 1.4, 0, 1, 0, -2.6); /* down */
    if (lamp == SKEWED)
      def.world_from_light[0] = 2;
    def.fov = 1.2f;
    assert_int_not_equal(vl_scene_add_light(s->scene, &def).index, 0);
    vl_image_destroy((vlImage *)(uintptr_t)def.image);
  }
}

/* A floor, a back wall and things on it. rich: surfaces of several kinds, glass too; else all
 * is diffuse. */
static Stage room_in(vlContext *context, Lamp lamp, bool rich, uint32_t size) {
  Stage s = stage_open_in(context, size, size);
  s.build.color = VL_COLOR_RGB;
  s.camera.fov = 1;
  s.render.spp = size == FINE ? 4 : 32;
  s.render.max_depth = 4;
  add_lamp(&s, lamp);
  Quad q = quad_at(0, -1, -3, 3, 0, 0, 0, 0, -3);
  q.material = add_diffuse(&s, 0.7f, 0.5f, 0.3f);
  add_quad(&s, &q);
  q = quad_at(0, 0, -4.5f, 3, 0, 0, 0, 3, 0);
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
  def.u_roughness = def.v_roughness = vl_float_input(0.3f);
  q.material = rich ? vl_scene_add_material(s.scene, &def) : add_diffuse(&s, 0.3f, 0.6f, 0.8f);
  add_quad(&s, &q);
  def = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  def.u_roughness = vl_float_input(0.2f);
  def.v_roughness = vl_float_input(0.4f);
  vlMaterialId metal = vl_scene_add_material(s.scene, &def),
               plain = add_diffuse(&s, 0.8f, 0.8f, 0.8f);
  add_round(&s, -0.7f, -0.5f, -3.4f, 0.5f, rich ? metal : plain, (vlEmissionId){0});
  def = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
  def.u_roughness = def.v_roughness = vl_float_input(0.35f);
  vlMaterialId frosted = vl_scene_add_material(s.scene, &def);
  if (rich)
    add_round(&s, 0.6f, -0.6f, -3, 0.4f, frosted, (vlEmissionId){0});
  return s;
}

typedef struct Case {
  Lamp lamp;
  bool rich;
  double radius;  /* of the lens */
  uint32_t paths; /* of light; 0: as many as pixels */
  double merge;   /* radius; 0: its own */
} Case;

/* Merging blurs over two pixels: its image is finer. */
static Stage room(const void *user, vlTracer tracer) {
  const Case *c = user;
  Stage s = room_in(NULL, c->lamp, c->rich, tracer == VL_TRACER_MERGING ? FINE : SIZE);
  if (c->radius > 0) {
    s.camera.lens_radius = c->radius;
    s.camera.focus_distance = 2.5;
  }
  if (c->paths)
    s.render.light_paths = c->paths;
  if (c->merge > 0)
    s.render.merge_radius = c->merge;
  return s;
}

static void agrees(const char *how, Case what, vlTracer tracer, const Measure *path,
                   double bias) {
  Measure m = measure(room, &what, tracer);
  assert_agree(what.radius > 0 ? "lens" : lamp_name[what.lamp], how, &m, path, bias);
}

static void all_lamps(void **state) {
  (void)state;
  for (int lamp = 0; lamp < LAMPS; lamp++)
    for (int rich = 0; rich < 2; rich++) {
      Case what = {(Lamp)lamp, rich, 0, 0, 0};
      Measure path = measure(room, &what, VL_TRACER_PATH);
      agrees("bidirectional", what, VL_TRACER_BIDIRECTIONAL, &path, 0.005);
      agrees("merging", what, VL_TRACER_MERGING, &path, 0.02);
      if (!rich)
        agrees("light paths", what, VL_TRACER_LIGHT_PATH, &path, 0.005);
    }
}

static void random_walks(void **state) {
  (void)state;
  Case what = {SKY, true, 0, 0, 0};
  Measure path = measure(room, &what, VL_TRACER_PATH);
  agrees("random walk", what, VL_TRACER_RANDOM_WALK, &path, 0.005);
}

/* Through a lens, light finds the film by way of its points. */
static void through_a_lens(void **state) {
  (void)state;
  Case what = {PANEL, false, 0.1, 0, 0};
  Measure path = measure(room, &what, VL_TRACER_PATH);
  agrees("bidirectional", what, VL_TRACER_BIDIRECTIONAL, &path, 0.005);
  agrees("light paths", what, VL_TRACER_LIGHT_PATH, &path, 0.005);
}

/* More paths from the lights than pixels, and few; a radius of one's own. */
static void paths_and_radius(void **state) {
  (void)state;
  Case what = {PANEL, true, 0, 0, 0};
  Measure path = measure(room, &what, VL_TRACER_PATH);
  what.paths = 3 * SIZE * SIZE + 77;
  agrees("bidirectional, many paths", what, VL_TRACER_BIDIRECTIONAL, &path, 0.005);
  what.paths = 100;
  what.merge = 0.05;
  agrees("bidirectional, few paths", what, VL_TRACER_BIDIRECTIONAL, &path, 0.005);
  agrees("merging, few paths", what, VL_TRACER_MERGING, &path, 0.02);
}

static vlResult try_to_render(double radius, uint32_t paths) {
  Stage s = room_in(NULL, POINT, false, SIZE);
  vlWorld *world = NULL;
  vlCamera camera;
  vlFilm *film = NULL;
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
  s.render.tracer = VL_TRACER_MERGING;
  s.render.spp = 1;
  s.render.merge_radius = radius;
  s.render.light_paths = paths;
  vlResult result = vl_render(world, &camera, film, &s.render, NULL, NULL);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(&s);
  return result;
}

static void bad_options(void **state) {
  (void)state;
  assert_int_equal(try_to_render(0, 5), VL_ERROR_ARGUMENT);
  assert_int_equal(try_to_render(-1, 5), VL_ERROR_ARGUMENT);
  assert_int_equal(try_to_render(INFINITY, 5), VL_ERROR_ARGUMENT);
  assert_int_equal(try_to_render(0.1, (1 << 24) + 1), VL_ERROR_ARGUMENT);
  assert_int_equal(try_to_render(0.1, 0), VL_OK);
  assert_int_equal(try_to_render(1e30, 5), VL_OK);
  assert_int_equal(try_to_render(1e-30, 5), VL_OK);
  assert_int_equal(try_to_render(VL_UNSET, VL_AS_MANY_AS_PIXELS), VL_OK);
}

/* Sums are exact and photons have one order: neither threads, nor instruction sets, nor the
 * crop show. */
typedef struct Colored {
  vlTracer tracer;
  bool crop;
} Colored;

static Image colored(vlContext *context, const void *what) {
  const Colored *c = what;
  Stage s = room_in(context, PANEL, true, SIZE);
  s.build.color = VL_COLOR_SPECTRAL;
  s.film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  s.render.tracer = c->tracer;
  s.render.spp = 5;
  s.render.light_paths = 2 * SIZE * SIZE - 5;
  const uint32_t part[4] = {5, 3, 17, 21};
  if (c->crop)
    memcpy(s.film.crop, part, sizeof part);
  return stage_finish(&s);
}

static void same_bits(void **state) {
  (void)state;
  static const vlTracer tracers[3] = {VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING,
                                      VL_TRACER_SPPM};
  for (int k = 0; k < 3; k++) {
    Colored whole = {tracers[k], false}, some = {tracers[k], true};
    Image a = assert_same_bits(colored, &whole, 1),
          part = image_in(colored, &some, 2, VL_ISA_BASE);
    for (uint32_t y = 0; y < part.height; y++)
      for (uint32_t x = 0; x < part.width; x++)
        assert_memory_equal(&part.rgba[4 * (y * part.width + x)],
                            &a.rgba[4 * ((y + 3) * SIZE + x + 5)], 4 * sizeof(float));
    image_free(&part);
    image_free(&a);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_lamps),      cmocka_unit_test(random_walks),
      cmocka_unit_test(through_a_lens), cmocka_unit_test(paths_and_radius),
      cmocka_unit_test(bad_options),    cmocka_unit_test(same_bits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
