/* test/render/test_two_way_inner_media.c: connections of inner vertices in media
 * (bidirectional): the mean of volpath in rooms full of fog whose lamps stand in shades;
 * attenuation by channel in both colour modes; less noise than volpath there; exact radiance in
 * a white furnace full of fog; the same bits for any threads. */
#include "render/agreement.h"
#include "render/fog.h"
#include "render/lamp_room.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

enum { SIZE = 20, FURNACE = 24 };

/* BY_CHANNEL: fog that absorbs by RGB channel, and a ball of rough tinted glass. */
typedef enum Air { FOG, GRID, RGB_GRID, BY_CHANNEL, IN_GLASS, IN_ROUGH_GLASS, AIRS } Air;
static const char *const air_name[AIRS] = {
    "fog", "grid", "rgb grid", "fog by channel", "fog in glass", "fog in rough glass"};

typedef struct Case {
  Air air;
  uint32_t depth;
  bool spectral;
  vlContext *context; /* null: an own one */
} Case;

/* Fog of other colours in each channel. The grids fill the room. */
static vlMediumId air_of(Stage *s, Air air) {
  static const float densities[8] = {0.5f, 2, 0, 1, 3, 1, 0.2f, 2};
  static const float colors[24] = {1, 2, 3, .5f, 1, 0, 0, 0, 2, 1,   1,   1,
                                   3, 2, 1, 0,   1, 2, 1, 2, 1, .3f, .2f, .1f};
  static const vlMediumKind kinds[AIRS] = {
      [GRID] = VL_MEDIUM_GRID, [RGB_GRID] = VL_MEDIUM_RGB_GRID};
  vlMediumDef def = vl_default_medium_def(kinds[air]);
  float thick = air >= IN_GLASS ? 2.0f : 0.3f;
  def.sigma_a = vl_spectrum_rgb(0.05f * thick, 0.1f * thick, 0.3f * thick);
  def.sigma_s = vl_spectrum_rgb(1.5f * thick, 1.0f * thick, 0.6f * thick);
  def.rgb_absorption = air == BY_CHANNEL;
  if (air == BY_CHANNEL) {
    def.sigma_a = vl_spectrum_rgb(0.02f, 0.1f, 0.4f);
    def.sigma_s = vl_spectrum_constant(0.5f);
  }
  def.g = 0.4f;
  def.scale = air == RGB_GRID ? 0.2f : 1;
  for (int i = 0; i < 3; i++) {
    def.low[i] = -2.6f;
    def.high[i] = 2.6f;
  }
  set_matrix(def.world_from_medium, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -2);
  def.nx = def.ny = def.nz = 2;
  def.density = densities;
  def.rgb_s = colors;
  def.rgb_a = colors;
  return vl_scene_add_medium(s->scene, &def);
}

static void add_filled_ball(Stage *s, vlMaterialId skin, vlMediumId inside,
                            vlMediumId outside) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(def.group_from_shape, 1, 0, 0, -0.6, 0, 1, 0, -0.4, 0, 0, 1, -2.6);
  def.radius = 0.7f;
  def.z_min = -0.7f;
  def.z_max = 0.7f;
  def.material = skin;
  def.inside = inside;
  def.outside = outside;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

/* A closed room with a bulb in a tube that is open above. */
static Stage room(const void *user, vlTracer tracer) {
  const Case *what = user;
  Stage s = stage_open_in(what->context, SIZE, SIZE);
  s.build.color = what->spectral ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  s.camera.fov = 1.2;
  s.render.max_depth = what->depth;
  s.render.spp = tracer == VL_TRACER_VOLPATH ? 256 : 24;
  s.render.light_paths = 2048; /* several groups of wavelengths */
  vlMaterialId dark = add_diffuse(&s, 0.3f, 0.2f, 0.1f),
               white = add_diffuse(&s, 0.7f, 0.7f, 0.7f);
  const vlMaterialId colored[3] = {add_diffuse(&s, 0.8f, 0.4f, 0.3f),
                                   add_diffuse(&s, 0.3f, 0.5f, 0.8f), white};
  const vlMaterialId grey[3] = {white, white, white},
                     *walls = what->air == BY_CHANNEL ? grey : colored;
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
  def.u_roughness = def.v_roughness = vl_float_input(0.3f);
  add_walls(&s, walls, vl_scene_add_material(s.scene, &def));
  if (what->air == BY_CHANNEL)
    dark = white;
  add_tube(&s, 0.2f, 0.5f, 0.35f, dark);
  add_ball_of(&s, 0.4f, 0.5f, 0.15f, dark, add_emission(&s, 40, false));
  add_ball_of(&s, 0.9f, -1, 0.5f, white, (vlEmissionId){0});
  vlMediumId air = air_of(&s, what->air);
  if (what->air == BY_CHANNEL) {
    def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
    def.reflectance.value = vl_spectrum_rgb(0.9f, 0.6f, 0.4f);
    def.principled.transmission = vl_float_input(1);
    def.principled.roughness = vl_float_input(0.6f);
    add_filled_ball(&s, vl_scene_add_material(s.scene, &def), air, air);
  }
  if (what->air < IN_GLASS) {
    vl_scene_defs(s.scene)->camera_medium = air;
  } else {
    def = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
    def.u_roughness = def.v_roughness = vl_float_input(what->air == IN_GLASS ? 0.0f : 0.4f);
    add_filled_ball(&s, vl_scene_add_material(s.scene, &def), air, (vlMediumId){0});
  }
  return s;
}

static void rooms(void **state) {
  (void)state;
  for (int k = 0; k < AIRS; k++) {
    /* volpath misses rare light in glass */
    Case what = {(Air)k, k == FOG ? 6 : 3, k != GRID && k != IN_GLASS, NULL};
    Measure path = measure(room, &what, VL_TRACER_VOLPATH),
            both = measure(room, &what, VL_TRACER_BIDIRECTIONAL);
    assert_agree(air_name[k], "bidirectional", &both, &path, k < IN_GLASS ? 0.002 : 0.015);
  }
}

/* With grey surfaces, attenuation by channel has the same law in both colour modes. */
static void law_of_channels(void **state) {
  (void)state;
  Measure seen[2];
  for (int spectral = 0; spectral < 2; spectral++) {
    const Case what = {BY_CHANNEL, 6, spectral == 1, NULL};
    seen[spectral] = measure(room, &what, VL_TRACER_BIDIRECTIONAL);
  }
  assert_agree(air_name[BY_CHANNEL], "spectral", &seen[1], &seen[0], 0.003);
}

static void less_noise(void **state) {
  (void)state;
  static const Air airs[3] = {FOG, GRID, BY_CHANNEL};
  for (int k = 0; k < 3; k++) {
    const Case what = {airs[k], 6, airs[k] == BY_CHANNEL, NULL};
    double path = pair_noise(room, &what, VL_TRACER_VOLPATH);
    double both = pair_noise(room, &what, VL_TRACER_BIDIRECTIONAL);
    if (!(both < path / 3))
      fail_msg("%s: noise of volpath %g, bidirectional %g", air_name[airs[k]], path, both);
  }
}

/* The inside of a ball that emits 1 and reflects a half of the light: 1 + 1/2 + 1/4 + ... = 2
 * everywhere. A medium that absorbs nothing changes nothing, if the weights of all strategies
 * sum to one. */
static Stage furnace(const void *user, vlTracer tracer) {
  (void)tracer;
  static const float densities[8] = {1, 2, 0.2f, 1, 3, 1, 0, 2};
  const Case *what = user;
  Stage s = stage_open_in(NULL, FURNACE, FURNACE);
  s.build.color = what->spectral ? VL_COLOR_SPECTRAL : VL_COLOR_RGB;
  s.render.max_depth = what->depth;
  s.render.spp = 24;
  vlMediumDef medium =
      vl_default_medium_def(what->air == GRID ? VL_MEDIUM_GRID : VL_MEDIUM_HOMOGENEOUS);
  medium.sigma_a = vl_spectrum_constant(0);
  medium.g = 0.3f;
  medium.sigma_s = vl_spectrum_rgb(0.3f, 0.4f, 0.6f);
  for (int i = 0; i < 3; i++) {
    medium.low[i] = -2;
    medium.high[i] = 2;
  }
  medium.nx = medium.ny = medium.nz = 2;
  medium.density = densities;
  vl_scene_defs(s.scene)->camera_medium = add_medium(&s, &medium);
  add_furnace(&s);
  return s;
}

static void white_furnace(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    Case what = {k / 2 ? GRID : FOG, 40, k % 2 == 1, NULL};
    assert_furnace(furnace, &what, 2);
  }
}

static Image in_context(vlContext *context, const void *user) {
  Case what = *(const Case *)user;
  what.context = context;
  Stage s = room(&what, VL_TRACER_BIDIRECTIONAL);
  s.render.tracer = VL_TRACER_BIDIRECTIONAL;
  s.render.spp = 3;
  return stage_finish(&s);
}

static void same_bits(void **state) {
  (void)state;
  static const Air airs[2] = {FOG, GRID};
  for (int k = 0; k < 2; k++) {
    const Case what = {airs[k], 6, true, NULL};
    Image a = assert_same_bits(in_context, &what, 2);
    image_free(&a);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rooms), cmocka_unit_test(law_of_channels), cmocka_unit_test(less_noise),
      cmocka_unit_test(white_furnace), cmocka_unit_test(same_bits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
