/* test/render/test_media.c: participating media of known radiance: Beer's law, fully scattering
 * media under a white sky, single scattering by quadrature, emissive fog, every kind and both
 * colour modes. Also changes that must not affect the image. */
#include "fog.h"
#include "velo/medium.h"
#include "velo/sampler.h"
#include "velo/texture.h"
#include "velo/tracer.h"

static const float eights[64] = {1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1,
                                 1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1,
                                 1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1,
                                 1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1};
static const float colours[24] = {1, 2, 3, .5f, 1, 0, 0, 0, 2, 1,   1,   1,
                                  3, 2, 1, 0,   1, 2, 1, 2, 1, .3f, .2f, .1f};

/* One of each kind that needs no file, round z = -3; of albedo 1. */
static vlMediumDef white_medium(int kind) {
  vlMediumDef def = vl_default_medium_def((vlMediumKind)kind);
  def.sigma_a = vl_spectrum_constant(0);
  def.sigma_s = vl_spectrum_rgb(1, 1.5f, 2);
  for (int i = 0; i < 3; i++) {
    def.low[i] = -1;
    def.high[i] = 1;
  }
  set_matrix(def.world_from_medium, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, -3);
  def.g = 0.4f;
  static const float none[24] = {0};
  if (kind == VL_MEDIUM_GRID) {
    def.nx = def.ny = def.nz = 4;
    def.density = eights;
  }
  if (kind == VL_MEDIUM_RGB_GRID) {
    def.nx = def.ny = def.nz = 2;
    def.rgb_s = colours;
    def.rgb_a = none;
  }
  return def;
}

/* ---- white furnaces ---------------------------------------------------------------------- */

/* Grey ones vanish but for rounding; of coloured ones paths carry more of this and less of
 * that. */
static void furnace(void **state) {
  (void)state;
  for (int kind = VL_MEDIUM_HOMOGENEOUS; kind <= VL_MEDIUM_CLOUD; kind++)
    for (int rgb = 0; rgb < 2; rgb++)
      for (int grey = kind != VL_MEDIUM_RGB_GRID ? 1 : 0; grey >= 0; grey--) {
        Stage s = stage_open(24, 24);
        s.camera.fov = 0.7;
        s.build.color = rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
        s.render.tracer = VL_TRACER_VOLPATH;
        s.render.sampler = VL_SAMPLER_SOBOL;
        s.render.spp = grey ? (kind < VL_MEDIUM_CLOUD ? 1024 : 512) : 128;
        s.render.max_depth = 300;
        vlMediumDef def = white_medium(kind);
        if (grey)
          def.sigma_s = vl_spectrum_constant(2);
        add_sky(&s, 1);
        add_ball(&s, -3, 1.0f, interface(&s), add_medium(&s, &def), (vlMediumId){0});
        Image p = stage_finish(&s);
        /* wavelengths are themselves chance, where they are not colours */
        for (int c = 0; c < 3; c++)
          assert_near("furnace", image_mean(&p, c), 1, grey ? (rgb ? 1.5e-3 : 3e-3) : 8e-3);
        assert_int_equal(p.stats.not_finite, 0);
        image_free(&p);
      }
}

/* Inside of glass, too: a smooth dielectric ball full of fog reflects and passes all. */
static void furnace_in_glass(void **state) {
  (void)state;
  Stage s = stage_open(24, 24);
  s.camera.fov = 0.8;
  s.render.tracer = VL_TRACER_VOLPATH;
  s.render.spp = 256;
  s.render.max_depth = 1000;
  vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
  vlMediumDef def = fog(0, 2, -0.3f);
  add_sky(&s, 1);
  add_ball(&s, -3, 1.0f, vl_scene_add_material(s.scene, &glass), add_medium(&s, &def),
           (vlMediumId){0});
  Image p = stage_finish(&s);
  for (int c = 0; c < 3; c++)
    assert_near("fog in glass", image_mean(&p, c), 1, 4e-3);
  image_free(&p);
}

/* ---- absorption -------------------------------------------------------------------------- */

/* Beer's law: the sky through the middle of a ball of fog: homogeneous, on a grid, and
 * scattering without return. */
static void beer(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    Stage s = stage_open(8, 8);
    s.camera.fov = 0.02;
    s.build.color = VL_COLOR_RGB;
    s.render.tracer = VL_TRACER_VOLPATH;
    s.render.spp = kind ? 4096 : 64;
    s.render.max_depth = kind == 2 ? 0 : 5;
    vlMediumDef def = fog(0, 0, 0);
    def.sigma_a = vl_spectrum_rgb(0.1f, 0.5f, 1.0f);
    if (kind == 1) /* far wider than the ball, so that it is 1 wherever the ray goes */
      make_even_grid(&def, 20);
    if (kind == 2)
      def.sigma_s = vl_spectrum_constant(0.25f);
    vlMediumId id = add_medium(&s, &def);
    add_ball(&s, -3, 1.0f, interface(&s), id, (vlMediumId){0});
    add_sky(&s, 1);
    Image p = stage_finish(&s);
    const double sigma[3] = {0.1, 0.5, 1.0}, more = kind == 2 ? 0.25 : 0;
    for (int c = 0; c < 3; c++)
      assert_ratio("Beer", image_mean(&p, c), exp(-2 * (sigma[c] + more)), kind ? 5e-3 : 1e-3);
    image_free(&p);
  }
}

/* ---- single scattering ------------------------------------------------------------------- */

static double phase(double g, double cosine) {
  return (1 - g * g) / (4 * M_PI * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* A lamp in fog without end, the camera in it: once-scattered light along the central ray is an
 * integral. */
static void single_scattering(void **state) {
  (void)state;
  const double a = 0.1, sc = 0.3, g = 0.5, lamp[3] = {1, 0.5, -2};
  double expected = 0;
  const int n = 400000;
  for (int k = 0; k < n; k++) {
    double t = 60 * (k + 0.5) / n, to[3] = {lamp[0], lamp[1], lamp[2] + t};
    /* between lamp to fog and fog to eye */
    double d = sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]), cosine = -to[2] / d;
    expected += 60.0 / n * sc * phase(g, cosine) * exp(-(a + sc) * (t + d)) / (d * d);
  }
  for (int kind = 0; kind < 2; kind++) {
    Stage s = stage_open(8, 8);
    s.camera.fov = 0.002;
    s.render.tracer = VL_TRACER_VOLPATH;
    s.render.spp = 8192;
    s.render.max_depth = 1;
    vlMediumDef def = fog((float)a, (float)sc, (float)g);
    if (kind == 1)
      make_even_grid(&def, 200);
    add_point(&s, (float)lamp[0], (float)lamp[1], (float)lamp[2], 1);
    vl_scene_defs(s.scene)->camera_medium = add_medium(&s, &def);
    Image p = stage_finish(&s);
    assert_ratio("single scattering", image_mean(&p, 1), expected, 6e-3);
    image_free(&p);
  }
}

/* ---- emission ---------------------------------------------------------------------------- */

static void emissive(void **state) {
  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    Stage s = stage_open(8, 8);
    s.camera.fov = 0.02;
    s.build.color = kind & 1 ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
    s.render.tracer = VL_TRACER_VOLPATH;
    s.render.spp = 1024;
    vlMediumDef def = fog(0.7f, 0, 0);
    def.emission = vl_spectrum_rgb(3, 3, 3);
    if (kind > 1)
      make_even_grid(&def, 20);
    add_ball(&s, -3, 1.0f, interface(&s), add_medium(&s, &def), (vlMediumId){0});
    Image p = stage_finish(&s);
    for (int c = 0; c < 3; c++)
      assert_ratio("emission", image_mean(&p, c), 3 * (1 - exp(-1.4)), kind == 3 ? 8e-3 : 5e-3);
    image_free(&p);
  }
}

/* A grid of one temperature against the black body of it as emission: raw, its maximum 1. */
static void hot(void **state) {
  (void)state;
  const float kelvin[8] = {30, 30, 30, 30, 30, 30, 30, 30};
  double mean[2][2][3];
  for (int rgb = 0; rgb < 2; rgb++)
    for (int way = 0; way < 2; way++) {
      Stage s = stage_open(8, 8);
      s.camera.fov = 0.02;
      s.build.color = rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
      s.render.tracer = VL_TRACER_VOLPATH;
      s.render.spp = 1024;
      vlMediumDef def = fog(0.7f, 0, 0);
      make_even_grid(&def, 20);
      if (way == 0)
        def.emission = vl_spectrum_blackbody(2500);
      if (way == 1) {
        def.temperature = kelvin;
        def.temperature_offset = 5;
        def.temperature_scale = 100;
      }
      add_ball(&s, -3, 1.0f, interface(&s), add_medium(&s, &def), (vlMediumId){0});
      Image p = stage_finish(&s);
      for (int c = 0; c < 3; c++)
        mean[rgb][way][c] = image_mean(&p, c);
      image_free(&p);
    }
  double factor = mean[0][1][1] / mean[0][0][1]; /* the body's own luminance */
  assert_true(factor > 5 && factor < 107);
  for (int rgb = 0; rgb < 2; rgb++)
    for (int c = 0; c < 3; c++)
      assert_near("black body", mean[rgb][1][c], factor * mean[rgb][0][c],
                  0.015 * factor * mean[rgb][0][0]);
}

/* A lamp with an image, seen from the front, is upright with and without fog in the world. */
static void imaged_lamp(void **state) {
  (void)state;
  const float rows[6] = {4, 4, 4, 1, 1, 1}; /* bright above */
  double half[2][2];
  for (int with = 0; with < 2; with++) {
    Stage s = stage_open(8, 8);
    s.camera.fov = 0.5;
    s.build.color = VL_COLOR_RGB;
    s.render.tracer = VL_TRACER_VOLPATH;
    s.render.spp = 16;
    vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    vlImage *image = make_image(&s, 1, 2, rows);
    texture.image = image;
    texture.filter = VL_FILTER_POINT;
    vlEmissionDef emission = vl_default_emission_def();
    emission.texture = vl_scene_add_texture(s.scene, &texture);
    vl_image_destroy(image);
    Quad lamp = quad_at(0, 0, -3, 2, 0, 0, 0, 2, 0);
    lamp.emission = vl_scene_add_emission(s.scene, &emission);
    add_quad(&s, &lamp);
    vlMediumDef def = fog(1, 0, 0);
    if (with)
      add_ball(&s, -3, 0.01f, interface(&s), add_medium(&s, &def), (vlMediumId){0});
    Image p = stage_finish(&s);
    half[with][0] = image_region(&p, 0, 0, 8, 3, 1);
    half[with][1] = image_region(&p, 0, 5, 8, 8, 1);
    image_free(&p);
  }
  assert_true(half[0][0] > 2 * half[0][1]);
  for (int k = 0; k < 2; k++)
    assert_ratio("imaged lamp", half[1][k], half[0][k], 1e-3);
}

/* ---- what must not show ------------------------------------------------------------------ */

static Image rich(vlContext *context, const void *what) {
  (void)what;
  Stage s = stage_open_in(context, 24, 24);
  s.camera.fov = 0.9;
  s.render.tracer = VL_TRACER_VOLPATH;
  s.render.spp = 8;
  s.render.max_depth = 12;
  add_sky(&s, 0.5f);
  add_point(&s, 1, 2, -1, 5);
  vlMediumDef dust = fog(0.01f, 0.05f, 0.2f);
  vlMediumId air = add_medium(&s, &dust);
  vl_scene_defs(s.scene)->camera_medium = air;
  vlMediumDef def = white_medium(VL_MEDIUM_GRID);
  def.emission = vl_spectrum_rgb(0.5f, 0.1f, 0.1f);
  def.sigma_a = vl_spectrum_rgb(0.1f, 0.3f, 0.6f);
  add_ball(&s, -3, 0.9f, interface(&s), add_medium(&s, &def), air);
  Quad floor = quad_at(0, -1, -3, 4, 0, 0, 0, 0, -4);
  floor.material = add_diffuse(&s, 0.7f, 0.5f, 0.3f);
  add_quad(&s, &floor);
  return stage_finish(&s);
}

static void same_bits(void **state) {
  (void)state;
  Image a = assert_same_bits(rich, NULL, 1);
  assert_int_equal(a.stats.not_finite, 0);
  image_free(&a);
}

/* The tracer of surfaces passes through interfaces and sees no medium; without media both
 * tracers are one. */
static void path_looks_past(void **state) {
  (void)state;
  Image past[2];
  for (int with = 0; with < 2; with++) {
    Stage s = stage_open(16, 16);
    s.render.spp = 16;
    s.render.tracer = with ? VL_TRACER_PATH : VL_TRACER_VOLPATH;
    vlMediumDef def = fog(1, 1, 0);
    vlMediumId id = {0};
    if (with)
      id = add_medium(&s, &def);
    add_sky(&s, 1);
    add_ball(&s, -3, 1, interface(&s), id, (vlMediumId){0});
    add_ball(&s, -3, 0.5f, add_diffuse(&s, 0.5f, 0.5f, 0.5f), (vlMediumId){0}, (vlMediumId){0});
    past[with] = stage_finish(&s);
  }
  assert_memory_equal(past[0].rgba, past[1].rgba, (size_t)16 * 16 * 4 * sizeof(float));
  image_free(&past[0]);
  image_free(&past[1]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(furnace),    cmocka_unit_test(furnace_in_glass),
      cmocka_unit_test(beer),       cmocka_unit_test(single_scattering),
      cmocka_unit_test(emissive),   cmocka_unit_test(hot),
      cmocka_unit_test(same_bits),  cmocka_unit_test(path_looks_past),
      cmocka_unit_test(imaged_lamp)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
