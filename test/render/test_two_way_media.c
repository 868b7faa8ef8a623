/* test/render/test_two_way_media.c: the tracers with light paths against the path tracer, in
 * media: the same mean within both standard errors, for every kind of medium, for lights inside
 * and outside; a white furnace; the same bits for any threads. */
#include "render/agreement.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

enum { SIZE = 18, FINE = 72 }; /* of three bands each */

typedef enum Air {
  FOG,    /* the camera and all else stand in it */
  WALLED, /* fog in a room whose window lets the eye in */
  GRID,   /* a ball of it */
  RGB_GRID,
  CLOUD,
  IN_GLASS, /* smooth glass full of fog */
  DARK,     /* a ball that absorbs only, on a grid */
  GLOWING,  /* a ball that shines itself */
  AIRS
} Air;
static const char *const air_name[AIRS] = {"fog",   "walled fog",   "grid",      "rgb grid",
                                           "cloud", "fog in glass", "dark grid", "emission"};
typedef enum Lamp { PANEL, BALL, POINT, SPOT, DISTANT, SKY } Lamp;

typedef struct Case {
  Air air;
  Lamp lamp;
  bool spectral;
  vlContext *context; /* null: an own one */
  uint32_t size;      /* 0: as the tracer wants it */
} Case;

static vlMediumId add_medium(Stage *s, Air air) {
  static const float densities[8] = {1, 2, 0.2f, 1, 3, 1, 0, 2};
  static const float colours[24] = {1, 2, 3, .5f, 1, 0, 0, 0, 2, 1,   1,   1,
                                    3, 2, 1, 0,   1, 2, 1, 2, 1, .3f, .2f, .1f};
  static const float little[24] = {.1f, .1f, .2f, .1f, .1f, .2f, .1f, .1f, .2f, .1f, .1f, .2f,
                                   .1f, .1f, .2f, .1f, .1f, .2f, .1f, .1f, .2f, .1f, .1f, .2f};
  static const vlMediumKind kinds[AIRS] = {[GRID] = VL_MEDIUM_GRID,
                                           [DARK] = VL_MEDIUM_GRID,
                                           [RGB_GRID] = VL_MEDIUM_RGB_GRID,
                                           [CLOUD] = VL_MEDIUM_CLOUD};
  vlMediumDef def = vl_default_medium_def(kinds[air]);
  float thick = air == FOG || air == WALLED ? 0.15f : air == CLOUD ? 5.0f : 1.0f;
  def.sigma_a = vl_spectrum_rgb(0.1f * thick, 0.2f * thick, 0.4f * thick);
  def.sigma_s = vl_spectrum_rgb(1.5f * thick, 1.0f * thick, 0.6f * thick);
  def.g = 0.4f;
  for (int i = 0; i < 3; i++) {
    def.low[i] = -0.8f;
    def.high[i] = 0.8f;
  }
  set_matrix(def.world_from_medium, 0, 0, 1, 0, 0, 1, 0, -0.2, -1, 0, 0, -3);
  if (air == DARK)
    def.sigma_s = vl_spectrum_constant(0);
  if (air == GLOWING)
    def.emission = vl_spectrum_rgb(0.3f, 0.4f, 0.2f);
  def.nx = def.ny = def.nz = 2;
  def.density = densities;
  def.rgb_s = colours;
  def.rgb_a = little;
  vlMediumId id = vl_scene_add_medium(s->scene, &def);
  vlError error;
  if (vl_scene_result(s->scene, &error) != VL_OK)
    fail_msg("medium: %s", error.message);
  return id;
}

static void add_ball(Stage *s, float x, float y, float z, float radius, vlMaterialId material,
                     vlMediumId inside, vlMediumId outside, vlEmissionId emission) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(def.group_from_shape, 1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z);
  def.radius = radius;
  def.z_min = -radius;
  def.z_max = radius;
  def.material = material;
  def.emission = emission;
  def.inside = inside;
  def.outside = outside;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

static void add_lamp(Stage *s, Lamp lamp) {
  static const vlLightKind kinds[] = {[POINT] = VL_LIGHT_POINT,
                                      [SPOT] = VL_LIGHT_SPOT,
                                      [DISTANT] = VL_LIGHT_DISTANT,
                                      [SKY] = VL_LIGHT_INFINITE};
  vlMaterialId dark = add_diffuse(s, 0.2f, 0.2f, 0.2f);
  if (lamp == PANEL) {
    Quad q = quad_at(0.4f, 1.3f, -3, 0.3f, 0.05f, 0, 0, 0.1f, 0.3f);
    q.material = dark;
    q.emission = add_emission(s, 10, false);
    add_quad(s, &q);
  } else if (lamp == BALL) {
    add_ball(s, 0.3f, 1.1f, -3, 0.2f, dark, (vlMediumId){0}, (vlMediumId){0},
             add_emission(s, 8, false));
  } else {
    vlLightDef def = vl_default_light_def(kinds[lamp]);
    float color = lamp == POINT || lamp == SPOT ? 5 : lamp == DISTANT ? 2 : 0.7f;
    const float from[3] = {0.3f, 1.2f, -2.6f}, to[3] = {-0.2f, -1, -3.2f};
    def.color = vl_spectrum_rgb(color, 0.8f * color, 0.6f * color);
    memcpy(def.from, from, sizeof from);
    memcpy(def.to, to, sizeof to);
    def.cone_angle = 0.8f;
    def.cone_delta = 0.3f;
    assert_int_not_equal(vl_scene_add_light(s->scene, &def).index, 0);
  }
}

static vlMaterialId material_of(Stage *s, vlMaterialKind kind) {
  vlMaterialDef def = vl_default_material_def(kind);
  return vl_scene_add_material(s->scene, &def);
}

/* A window of fog in front of a room without borders of its own. */
static void add_window(Stage *s, vlMediumId fog) {
  static const float p[12] = {-4, -4, -1.2f, 4, -4, -1.2f, -4, 4, -1.2f, 4, 4, -1.2f};
  static const uint32_t faces[6] = {0, 1, 3, 0, 3, 2};
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 4;
  def.faces = 2;
  def.positions = p;
  def.indices = faces;
  def.material = material_of(s, VL_MATERIAL_INTERFACE);
  def.inside = fog; /* its normal looks at the eye */
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

static Stage room(const void *user, vlTracer tracer) {
  const Case *c = user;
  uint32_t size = c->size ? c->size : tracer == VL_TRACER_MERGING ? FINE : SIZE;
  Stage s = stage_open_in(c->context, size, size);
  s.build.color = c->spectral ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  s.camera.fov = 1;
  s.render.spp = size == FINE ? 4 : 64;
  s.render.max_depth = 5;
  add_lamp(&s, c->lamp);
  Quad q = quad_at(0, -1, -3, 3, 0, 0, 0, 0, -3);
  q.material = add_diffuse(&s, 0.7f, 0.5f, 0.3f);
  add_quad(&s, &q);
  q = quad_at(0, 0, -4.5f, 3, 0, 0, 0, 3, 0);
  q.material = add_diffuse(&s, 0.3f, 0.6f, 0.8f);
  add_quad(&s, &q);
  vlMediumId medium = add_medium(&s, c->air), none = {0};
  vlEmissionId no_emission = {0};
  if (c->air == FOG) {
    vl_scene_defs(s.scene)->camera_medium = medium;
  } else if (c->air == WALLED) {
    add_window(&s, medium);
  } else {
    vlMaterialId skin =
        material_of(&s, c->air == IN_GLASS ? VL_MATERIAL_DIELECTRIC : VL_MATERIAL_INTERFACE);
    add_ball(&s, 0, -0.2f, -3, 0.75f, skin, medium, none, no_emission);
  }
  if (c->air <= WALLED)
    add_ball(&s, -0.7f, -0.5f, -3.4f, 0.5f, add_diffuse(&s, 0.8f, 0.8f, 0.8f), none, none,
             no_emission);
  return s;
}

static void agrees(const char *how, Case what, vlTracer tracer, const Measure *eye,
                   double bias) {
  Measure m = measure(room, &what, tracer);
  char name[64];
  snprintf(name, sizeof name, "%s, lamp %d, %s", air_name[what.air], (int)what.lamp,
           what.spectral ? "spectral" : "rgb");
  assert_agree(name, how, &m, eye, bias);
}

static void compare(Case what, bool merging) {
  Measure eye = measure(room, &what, VL_TRACER_VOLPATH);
  agrees("bidirectional", what, VL_TRACER_BIDIRECTIONAL, &eye, 0.005);
  if (what.air != IN_GLASS && what.air != GLOWING)
    agrees("light paths", what, VL_TRACER_LIGHT_PATH, &eye, 0.005);
  if (merging)
    agrees("merging", what, VL_TRACER_MERGING, &eye, 0.02);
}

static void lamps_in_fog(void **state) {
  (void)state;
  for (int lamp = PANEL; lamp <= SPOT; lamp++)
    compare((Case){FOG, (Lamp)lamp, false, NULL, 0}, lamp == PANEL);
  compare((Case){WALLED, PANEL, false, NULL, 0}, false);
  compare((Case){WALLED, POINT, true, NULL, 0}, false);
}

static void media_in_the_light(void **state) {
  (void)state;
  for (int air = GRID; air < AIRS; air++)
    for (int spectral = 0; spectral < 2; spectral++)
      compare((Case){(Air)air, air % 2 ? SKY : DISTANT, spectral, NULL, 0},
              air == GRID || air == IN_GLASS);
  compare((Case){GRID, PANEL, true, NULL, 0}, true);
}

/* A medium that scatters all under a white sky is not seen, whichever way light is followed. */
static void furnace(void **state) {
  (void)state;
  static const vlTracer tracers[2] = {VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING};
  for (int k = 0; k < 2; k++)
    for (int grid = 0; grid < 2; grid++) {
      Stage s = stage_open(24, 24);
      s.camera.fov = 0.7;
      s.build.color = VL_COLOR_RGB;
      s.render.tracer = tracers[k];
      s.render.spp = 64;
      s.render.max_depth = 200;
      const float densities[8] = {1, 2, 0.2f, 1, 3, 1, 0, 2};
      vlMediumDef def = vl_default_medium_def(grid ? VL_MEDIUM_GRID : VL_MEDIUM_HOMOGENEOUS);
      def.sigma_a = vl_spectrum_constant(0);
      def.sigma_s = vl_spectrum_constant(2);
      def.g = 0.3f;
      for (int i = 0; i < 3; i++) {
        def.low[i] = -1;
        def.high[i] = 1;
      }
      set_matrix(def.world_from_medium, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3);
      def.nx = def.ny = def.nz = 2;
      def.density = densities;
      add_sky(&s, 1);
      add_ball(&s, 0, 0, -3, 1, material_of(&s, VL_MATERIAL_INTERFACE),
               vl_scene_add_medium(s.scene, &def), (vlMediumId){0}, (vlEmissionId){0});
      Image p = stage_finish(&s);
      for (int c = 0; c < 3; c++)
        assert_near("furnace", image_mean(&p, c), 1, 6e-3);
      image_free(&p);
    }
}

typedef struct Colored {
  vlTracer tracer;
  Air air;
} Colored;

static Image colored(vlContext *context, const void *what) {
  const Colored *c = what;
  Case in = {c->air, PANEL, true, context, SIZE};
  Stage s = room(&in, c->tracer);
  s.render.tracer = c->tracer;
  s.render.spp = 3;
  return stage_finish(&s);
}

static void same_bits(void **state) {
  (void)state;
  static const Air airs[2] = {FOG, RGB_GRID};
  for (int k = 0; k < 2; k++)
    for (int merge = 0; merge < 2; merge++) {
      Colored what = {merge ? VL_TRACER_MERGING : VL_TRACER_BIDIRECTIONAL, airs[k]};
      Image a = assert_same_bits(colored, &what, 2);
      image_free(&a);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(lamps_in_fog),
                                     cmocka_unit_test(media_in_the_light),
                                     cmocka_unit_test(furnace), cmocka_unit_test(same_bits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
