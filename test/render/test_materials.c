/* test/render/test_materials.c: materials in images: mixes, bump and normal maps, interfaces,
 * dispersive glass. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

enum { SIZE = 32 };

static Stage stage(void) {
  Stage s = stage_open(48, 36);
  add_sky(&s, 0.4f);
  add_point(&s, 2, 3, 1, 20);
  s.camera.fov = 0.8;
  s.render.spp = 16;
  s.render.max_depth = 3;
  return s;
}

static void add_ball(Stage *s, vlMaterialId material) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(def.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -4);
  def.material = material;
  vl_scene_add_shape(s->scene, &def);
}

/* ---- mixes ------------------------------------------------------------------------------- */

static vlMaterialId add_mix(Stage *s, vlMaterialId a, vlMaterialId b, float amount) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_MIX);
  def.materials[0] = a;
  def.materials[1] = b;
  def.amount = vl_float_input(amount);
  vlMaterialId id = vl_scene_add_material(s->scene, &def);
  assert_int_not_equal(id.index, 0);
  return id;
}

static void mixes(void **state) {
  (void)state;
  Image p[6];
  for (int i = 0; i < 6; i++) {
    Stage s = stage();
    if (i >= 4)
      s.render.spp = 64;
    vlMaterialId red = add_diffuse(&s, 0.8f, 0.2f, 0.1f);
    vlMaterialDef metal = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
    metal.u_roughness = metal.v_roughness = vl_float_input(0.3f);
    vlMaterialId copper = vl_scene_add_material(s.scene, &metal), mixed = red;
    if (i == 1)
      mixed = copper;
    if (i == 2)
      mixed = add_mix(&s, red, copper, 0);
    if (i == 3)
      mixed = add_mix(&s, red, copper, 1);
    if (i == 4)
      mixed = add_mix(&s, red, copper, 0.5f);
    if (i == 5) /* a long chain, the last share of which is the first material */
      for (int k = 0; k < 24; k++)
        mixed = add_mix(&s, mixed, copper, 0);
    add_ball(&s, mixed);
    p[i] = stage_finish(&s);
    assert_int_equal(p[i].stats.not_finite, 0);
  }
  assert_true(image_differing(&p[0], &p[2], 0) == 0);
  assert_true(image_differing(&p[1], &p[3], 0) == 0);
  for (int c = 0; c < 3; c++) {
    double half = 0.5 * (image_mean(&p[0], c) + image_mean(&p[1], c));
    assert_ratio("half of each", image_mean(&p[4], c), half, 0.01);
    assert_ratio("chain of mixes", image_mean(&p[5], c), image_mean(&p[0], c), 0.01);
  }
  for (int i = 0; i < 6; i++)
    image_free(&p[i]);
}

/* A chequered amount chooses by place. */
static void mix_by_texture(void **state) {
  (void)state;
  Image p[2];
  for (int way = 0; way < 2; way++) {
    Stage s = stage();
    vlMaterialId m[2] = {add_diffuse(&s, 0.8f, 0.2f, 0.1f), add_diffuse(&s, 0.1f, 0.3f, 0.6f)};
    vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
    checks.float_a = vl_float_input(0);
    checks.float_b = vl_float_input(1);
    checks.su = checks.sv = 4;
    vlMaterialDef mix = vl_default_material_def(VL_MATERIAL_MIX);
    mix.materials[0] = m[0];
    mix.materials[1] = m[1];
    mix.amount.texture = vl_scene_add_texture(s.scene, &checks);
    Quad q = quad_at(0, 0, -3, 1, 0, 0, 0, 1, 0);
    q.material = vl_scene_add_material(s.scene, &mix);
    if (!way)
      add_quad(&s, &q);
    for (int i = 0; i < 16 && way; i++) {
      Quad cell = quad_at(-0.75f + 0.5f * (float)(i & 3), -0.75f + 0.5f * (float)(i >> 2), -3,
                          0.25f, 0, 0, 0, 0.25f, 0);
      cell.material = m[((i & 3) + (i >> 2)) & 1];
      add_quad(&s, &cell);
    }
    p[way] = stage_finish(&s);
  }
  double differing = image_differing(&p[0], &p[1], 0.02);
  if (differing > 0.03)
    fail_msg("mix by texture: %.1f %% of the pixels differ", 100 * differing);
  for (int c = 0; c < 3; c++)
    assert_ratio("mix by texture", image_mean(&p[0], c), image_mean(&p[1], c), 3e-3);
  image_free(&p[0]);
  image_free(&p[1]);
}

/* Half of a sheet that is not there: half of what lies behind is seen, and half of the light
 * passes. Both orders, both sorts of amount, alpha beside. */
static void mixed_with_an_interface(void **state) {
  (void)state;
  for (int way = 0; way < 4; way++) {
    Stage s = stage_open(32, 32);
    s.render.spp = 400;
    s.camera.fov = 0.3;
    Quad light = quad_at(0, 0, -9, 30, 0, 0, 0, 30, 0),
         sheet = quad_at(0, 0, -2, 30, 0, 0, 0, 30, 0);
    light.emission = add_emission(&s, 1, true);
    add_quad(&s, &light);
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_INTERFACE);
    vlMaterialId none = vl_scene_add_material(s.scene, &def), black = add_diffuse(&s, 0, 0, 0);
    vlMaterialDef mix = vl_default_material_def(VL_MATERIAL_MIX);
    mix.materials[way & 1] = none;
    mix.materials[!(way & 1)] = black;
    mix.amount = vl_float_input(way & 1 ? 0.7f : 0.3f); /* the interface's share is 0.7 */
    if (way & 2) {
      vlTextureDef t = vl_default_texture_def(VL_TEXTURE_CONSTANT, false);
      t.float_a = mix.amount;
      mix.amount.texture = vl_scene_add_texture(s.scene, &t);
    }
    sheet.material = vl_scene_add_material(s.scene, &mix);
    add_quad(&s, &sheet);
    Image p = stage_finish(&s);
    assert_ratio("through the sheet", image_mean(&p, 1), 0.7, 6e-3);
    image_free(&p);
  }
}

/* A mix of red with a mix of green and nothing: the sheet reflects 0.7 of red and 0.15 of
 * green, and 0.15 of what lies behind is seen. */
static void mix_of_a_mix_with_an_interface(void **state) {
  (void)state;
  for (int way = 0; way < 2; way++) {
    Stage s = stage_open(32, 32);
    s.build.color = VL_COLOR_RGB;
    s.render.spp = 400;
    s.camera.fov = 0.3;
    add_sky(&s, 1);
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_INTERFACE);
    vlMaterialId none = vl_scene_add_material(s.scene, &def);
    vlMaterialId red = add_diffuse(&s, 0.8f, 0, 0), green = add_diffuse(&s, 0, 0.8f, 0);
    vlMaterialId inner = add_mix(&s, way ? green : none, way ? none : green, 0.5f);
    Quad sheet = quad_at(0, 0, -2, 30, 0, 0, 0, 30, 0);
    sheet.material = add_mix(&s, way ? inner : red, way ? red : inner, way ? 0.7f : 0.3f);
    add_quad(&s, &sheet);
    Image p = stage_finish(&s);
    assert_ratio("red and nothing", image_mean(&p, 0), 0.7 * 0.8 + 0.15, 6e-3);
    assert_ratio("green and nothing", image_mean(&p, 1), 0.15 * 0.8 + 0.15, 2e-2);
    assert_ratio("nothing", image_mean(&p, 2), 0.15, 2e-2);
    image_free(&p);
  }
}

/* ---- bump and normal maps ---------------------------------------------------------------- */

/* A wall seen straight on, lit by a sun from `from`; the map bends its normal. */
static Stage wall_stage(const double from[3]) {
  Stage s = stage_open(SIZE, SIZE);
  s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
  s.build.color = VL_COLOR_RGB;
  s.render.sampler = VL_SAMPLER_REGULAR;
  s.render.spp = 1;
  s.render.max_depth = 1;
  vlLightDef sun = vl_default_light_def(VL_LIGHT_DISTANT);
  for (int i = 0; i < 3; i++) {
    sun.from[i] = (float)from[i];
    sun.to[i] = 0;
  }
  sun.scale = (float)M_PI;
  vl_scene_add_light(s.scene, &sun);
  return s;
}

static Image wall(Stage *s, const vlMaterialDef *def) {
  Quad q = quad_at(0, 0, -1, 1, 0, 0, 0, 1, 0);
  q.material = vl_scene_add_material(s->scene, def);
  add_quad(s, &q);
  return stage_finish(s);
}

static const double sun_at[3] = {0.48, 0.36, 0.8};

static void normal_maps(void **state) {
  (void)state;
  char path[600];
  snprintf(path, sizeof path, "%s/test_materials.pfm", VELO_BINARY_DIR);
  const double normals[3][3] = {{0, 0, 1}, {0.6, 0, 0.8}, {0, -0.28, 0.96}};
  for (int i = 0; i < 3; i++) {
    Stage s = wall_stage(sun_at);
    float rgb[12];
    for (int k = 0; k < 12; k++)
      rgb[k] = (float)(0.5 + 0.5 * normals[i][k % 3]);
    vlImage *image = make_image(&s, 2, 2, rgb);
    assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
    vl_image_destroy(image);
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    def.normal_map = path;
    Image p = wall(&s, &def);
    double cosine = 0;
    for (int k = 0; k < 3; k++)
      cosine += normals[i][k] * sun_at[k];
    assert_ratio("normal map", image_mean(&p, 1), 0.5 * cosine, 1e-4);
    image_free(&p);
  }
  /* Flat: the very image without a map, on a curved thing too. */
  Image p[2];
  for (int mapped = 0; mapped < 2; mapped++) {
    Stage s = stage();
    const float flat[12] = {0.5f, 0.5f, 1, 0.5f, 0.5f, 1, 0.5f, 0.5f, 1, 0.5f, 0.5f, 1};
    vlImage *image = make_image(&s, 2, 2, flat);
    assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
    vl_image_destroy(image);
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    def.normal_map = mapped ? path : NULL;
    add_ball(&s, vl_scene_add_material(s.scene, &def));
    p[mapped] = stage_finish(&s);
  }
  double differing = image_differing(&p[0], &p[1], 1e-3);
  if (differing > 0.01)
    fail_msg("flat normal map: %.1f %% of the pixels differ", 100 * differing);
  image_free(&p[0]);
  image_free(&p[1]);
  remove(path);
}

/* Displacement of slope a along x and b along y: the normal is (-a, -b, 1), normalised. */
static void displacements(void **state) {
  (void)state;
  const double slopes[4][2] = {{0, 0}, {0.5, 0}, {0, 0.5}, {-0.3, 0.4}};
  for (int i = 0; i < 4; i++) {
    double a = slopes[i][0], b = slopes[i][1];
    Stage s = wall_stage(sun_at);
    /* u = (x + 1)/2: twice the slope over u */
    vlTextureDef h = vl_default_texture_def(VL_TEXTURE_BILERP, false);
    h.float_a = vl_float_input(0.7f);
    h.float_b = vl_float_input((float)(0.7 + 2 * b));
    h.float_c = vl_float_input((float)(0.7 + 2 * a));
    h.float_d = vl_float_input((float)(0.7 + 2 * a + 2 * b));
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    def.displacement.texture = vl_scene_add_texture(s.scene, &h);
    Image p = wall(&s, &def);
    double cosine = (-a * sun_at[0] - b * sun_at[1] + sun_at[2]) / sqrt(a * a + b * b + 1);
    assert_ratio("displaced wall", image_mean(&p, 1), 0.5 * cosine, 2e-3);
    image_free(&p);
  }
  Image p[2];
  for (int mapped = 0; mapped < 2; mapped++) {
    Stage s = stage();
    vlTextureDef h = vl_default_texture_def(VL_TEXTURE_CONSTANT, false);
    h.float_a = vl_float_input(0.3f);
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    if (mapped)
      def.displacement.texture = vl_scene_add_texture(s.scene, &h);
    add_ball(&s, vl_scene_add_material(s.scene, &def));
    p[mapped] = stage_finish(&s);
  }
  double differing = image_differing(&p[0], &p[1], 1e-3);
  if (differing > 0.01)
    fail_msg("constant displacement: %.1f %% of the pixels differ", 100 * differing);
  image_free(&p[0]);
  image_free(&p[1]);
}

/* ---- interfaces -------------------------------------------------------------------------- */

/* Boxes, balls and sheets of interface between everything and a near area light: the image must
 * not notice. */
static void interfaces_are_nothing(void **state) {
  (void)state;
  double mean[2];
  for (int way = 0; way < 2; way++) {
    Stage s = stage_open(48, 36);
    s.camera.eye[1] = 0.5;
    s.camera.eye[2] = 2;
    s.camera.lookat[1] = -0.3;
    s.render.spp = 200;
    s.render.max_depth = 2;
    Quad floor = quad_at(0, -0.5f, 0, 1.5f, 0, 0, 0, 0, -1.5f),
         light = quad_at(0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f);
    floor.material = add_diffuse(&s, 0.6f, 0.6f, 0.6f);
    add_quad(&s, &floor);
    light.emission = add_emission(&s, 2, false);
    add_quad(&s, &light);
    if (way) {
      vlMaterialDef def = vl_default_material_def(VL_MATERIAL_INTERFACE);
      vlMaterialId none = vl_scene_add_material(s.scene, &def);
      Quad sheet = quad_at(0, -0.02f, 0, 0.6f, 0, 0, 0, 0, -0.6f); /* just under the light */
      sheet.material = none;
      add_quad(&s, &sheet);
      sheet = quad_at(0, 0, 1, 5, 0, 0, 0, 5, 0);
      sheet.material = none;
      sheet.patch = true;
      add_quad(&s, &sheet);
      vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
      ball.radius = 9;
      ball.z_min = -9;
      ball.z_max = 9;
      ball.material = none;
      vl_scene_add_shape(s.scene, &ball);
    }
    Image p = stage_finish(&s);
    mean[way] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_ratio("behind interfaces", mean[1], mean[0], 4e-3);
}

static void far_plane_behind_an_interface(void **state) {
  (void)state;
  Stage s = stage_open(8, 8);
  s.camera.far_plane = 2;
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_INTERFACE);
  Quad sheet = quad_at(0, 0, -1, 5, 0, 0, 0, 5, 0), light = quad_at(0, 0, -3, 9, 0, 0, 0, 9, 0);
  sheet.material = vl_scene_add_material(s.scene, &def);
  light.emission = add_emission(&s, 1, true);
  add_quad(&s, &sheet);
  add_quad(&s, &light);
  Image p = stage_finish(&s);
  assert_near("light behind the far plane", image_mean(&p, 1), 0, 0);
  assert_near("surface behind the far plane", image_mean(&p, 3), 0, 0);
  image_free(&p);
}

/* ---- glass that splits colours ----------------------------------------------------------- */

/* A thin white strip seen through a wedge whose thick side is on the left. Rays are refracted
 * to the left, blue ones more, so the strip's image moves to the right, its blue part farther
 * than its red part. */
static void prism(void **state) {
  (void)state;
  Stage s = stage_open(96, 8);
  s.camera.fov = 0.5;
  s.camera.fov_axis = VL_FOV_HORIZONTAL;
  s.render.spp = 400;
  s.render.max_depth = 6;
  vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
  glass.eta = vl_spectrum_input(vl_spectrum_named("glass-SF11"));
  vlMaterialId material = vl_scene_add_material(s.scene, &glass);
  /* a closed wedge: thick 0.9 at x = -2, 0.1 at x = 2, its front face at right angles to the
   * view */
  static const float p[24] = {-2, -2, -1,    2, -2, -1,    -2, 2, -1,    2, 2, -1,
                              -2, -2, -1.9f, 2, -2, -1.1f, -2, 2, -1.9f, 2, 2, -1.1f};
  static const uint32_t f[36] = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 8;
  def.faces = 12;
  def.positions = p;
  def.indices = f;
  def.material = material;
  vl_scene_add_shape(s.scene, &def);
  Quad strip = quad_at(-3.2f, 0, -21, 0.15f, 0, 0, 0, 9, 0);
  strip.emission = add_emission(&s, 1, true);
  add_quad(&s, &strip);
  Image q = stage_finish(&s);
  double at[3];
  for (int c = 0; c < 3; c++) {
    double sum = 0, moment = 0;
    for (uint32_t y = 0; y < q.height; y++)
      for (uint32_t x = 0; x < q.width; x++) {
        sum += image_at(&q, x, y, c);
        moment += (x + 0.5) * image_at(&q, x, y, c);
      }
    assert_true(sum > 1);
    at[c] = moment / sum;
  }
  image_free(&q);
  /* Deviation of a thin wedge of angle w: (n - 1) w; n of SF11 is 1.776 at 611 nm, 1.808 at 490
   * nm or so. */
  if (!(at[2] > at[1] && at[1] > at[0] && at[2] - at[0] > 0.5 && at[2] - at[0] < 6))
    fail_msg("prism: red at %.2f, green at %.2f, blue at %.2f", at[0], at[1], at[2]);
}

/* Glass whose index varies by nothing to speak of is plain glass, also where some wavelengths
 * have died before it. */
static void dispersion_keeps_energy(void **state) {
  (void)state;
  double mean[2];
  static const float nm[2] = {300, 900}, index[2] = {1.49f, 1.51f};
  static const float band_nm[4] = {539, 540, 570, 571}, band[4] = {0, 1, 1, 0};
  for (int way = 0; way < 2; way++) {
    Stage s = stage_open(48, 36);
    s.render.spp = 256;
    s.render.max_depth = 3;
    s.camera.fov = 0.4;
    add_sky(&s, 1);
    vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
    vlSpectrum eta = {.kind = VL_SPECTRUM_SAMPLED,
                      .scale = 1,
                      .count = 2,
                      .wavelengths = nm,
                      .values = index};
    if (way)
      glass.eta = vl_spectrum_input(eta);
    vlMaterialDef narrow = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    vlSpectrum reflectance = {.kind = VL_SPECTRUM_SAMPLED,
                              .scale = 1,
                              .count = 4,
                              .wavelengths = band_nm,
                              .values = band};
    narrow.reflectance = vl_spectrum_input(reflectance);
    Quad q = quad_at(0, 0, -3, 5, 0, 0, 0, 5, 0);
    q.material = vl_scene_add_material(s.scene, &narrow);
    add_quad(&s, &q);
    /* between the wall and the sky; the eye looks through too */
    Quad sheet = quad_at(0, 0, -2, 40, 0, 0, 0, 40, 0);
    sheet.material = vl_scene_add_material(s.scene, &glass);
    s.camera.eye[2] = -2.5;
    s.camera.lookat[2] = -4;
    add_quad(&s, &sheet);
    Image p = stage_finish(&s);
    mean[way] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_true(mean[0] > 0.01);
  assert_ratio("narrow band through dispersive glass", mean[1], mean[0], 0.02);
}

/* A ball of flint glass before a white sky cannot be seen: what it splits comes together
 * again. */
static void dispersion_in_the_white_furnace(void **state) {
  (void)state;
  const char *const glass[2] = {"glass-SF11", "glass-BK7"};
  for (int k = 0; k < 2; k++) {
    Stage s = stage_open(32, 32);
    s.camera.fov = 0.4;
    s.render.spp = 256;
    s.render.max_depth = 500;
    add_sky(&s, 1);
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
    def.eta = vl_spectrum_input(vl_spectrum_named(glass[k]));
    add_ball(&s, vl_scene_add_material(s.scene, &def));
    Image p = stage_finish(&s);
    for (int c = 0; c < 3; c++)
      assert_ratio("flint glass in the furnace", image_mean(&p, c), 1, 3e-3);
    image_free(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(mixes),
      cmocka_unit_test(mix_by_texture),
      cmocka_unit_test(mixed_with_an_interface),
      cmocka_unit_test(mix_of_a_mix_with_an_interface),
      cmocka_unit_test(normal_maps),
      cmocka_unit_test(displacements),
      cmocka_unit_test(interfaces_are_nothing),
      cmocka_unit_test(far_plane_behind_an_interface),
      cmocka_unit_test(prism),
      cmocka_unit_test(dispersion_keeps_energy),
      cmocka_unit_test(dispersion_in_the_white_furnace),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
