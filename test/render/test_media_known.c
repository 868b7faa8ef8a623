/* test/render/test_media_known.c: more media of known radiance: equilibrium (an emissive,
 * scattering medium under a sky of its own radiance is invisible), nested media with the camera
 * in the innermost, rotated and stretched grids, colours of RGB grids, emission with
 * scattering, NanoVDB voxels as solid cubes. */
#include <unistd.h>

#include "fog.h"
#include "velo/medium.h"
#include "velo/sampler.h"
#include "velo/tracer.h"
#include "world/nanovdb_file.h"

static Stage narrow(uint32_t spp, vlColorMode color) {
  Stage s = stage_open(8, 8);
  s.camera.fov = 0.02;
  s.build.color = color;
  s.render.tracer = VL_TRACER_VOLPATH;
  s.render.spp = spp;
  return s;
}

/* Light of RGB grids is pbrt's: not divided by its luminance, which for white is int y =
 * 106.86. */
static const double RAW = 106.856895;

/* ---- equilibrium ------------------------------------------------------------------------- */

/* Kirchhoff: under a sky of radiance 2, a medium that emits with the source radiance 2 adds as
 * much light as it absorbs, and scattering changes nothing. This holds for any density, in
 * glass or not. */
static void equilibrium(void **state) {
  (void)state;
  static const float eights[64] = {1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1,
                                   1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1,
                                   1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1,
                                   1, 2, 0, 1, 3, 1, 0, 2, 1, 1, 1, 1, 2, 0, 2, 1};
  enum { CELLS = 6 * 6 * 6 };
  static float a[3 * CELLS], b[3 * CELLS], emission[3 * CELLS];
  for (int i = 0; i < 3 * CELLS; i++) {
    a[i] = (float)(i * 7919 % 101) / 60;
    b[i] = (float)(i * 6101 % 89) / 50;
    emission[i] = 2 / (float)RAW;
  }
  for (int kind = 0; kind < 3; kind++)
    for (int glass = 0; glass < 2; glass++)
      for (int rgb = 0; rgb < 2; rgb++) {
        if (glass && (rgb || kind == 1))
          continue;
        Stage s = stage_open(16, 16);
        s.camera.fov = 0.7;
        s.build.color = rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
        s.render.tracer = VL_TRACER_VOLPATH;
        s.render.sampler = VL_SAMPLER_SOBOL;
        s.render.spp = 128;
        s.render.max_depth = 200;
        vlMediumDef def = fog(0.7f, 1.1f, 0.4f);
        def.emission = vl_spectrum_rgb(2, 2, 2);
        /* radiance in glass is eta^2 times as high */
        def.emission_scale = glass ? 1.5f * 1.5f : 1;
        if (kind == 1) {
          def.kind = VL_MEDIUM_GRID;
          def.nx = def.ny = def.nz = 4;
          def.density = eights;
        }
        if (kind == 2) {
          def.kind = VL_MEDIUM_RGB_GRID;
          def.nx = def.ny = def.nz = 6;
          def.rgb_a = a;
          def.rgb_s = b;
          def.rgb_emission = emission;
        }
        for (int i = 0; i < 3; i++) {
          def.low[i] = -1.3f;
          def.high[i] = 1.3f;
        } /* the emission falls off in the outer half cell */
        set_matrix(def.world_from_medium, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, -3);
        vlMaterialDef window = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
        add_sky(&s, 2);
        add_ball(&s, -3, 1, glass ? vl_scene_add_material(s.scene, &window) : interface(&s),
                 add_medium(&s, &def), (vlMediumId){0});
        Image p = stage_finish(&s);
        for (int c = 0; c < 3; c++)
          assert_ratio("equilibrium", image_mean(&p, c), 2, kind == 2 && !rgb ? 0.02 : 0.01);
        assert_int_equal(p.stats.not_finite, 0);
        image_free(&p);
      }
}

/* ---- media within media ------------------------------------------------------------------ */

/* The camera is in the innermost of three shells and sees the sky through all of them: at
 * first all are homogeneous media, then two of them are grids. */
static void nested(void **state) {
  (void)state;
  const double sigma[3] = {0.4, 0.2, 0.1};
  for (int turn = 0; turn < 3; turn++) {
    Stage s = narrow(turn ? 2048 : 64, VL_COLOR_RGB);
    vlMediumId id[3];
    for (int k = 0; k < 3; k++) {
      vlMediumDef def = fog((float)sigma[k], 0, 0);
      if (turn && (k + turn) % 3)
        make_even_grid(&def, 50);
      id[k] = add_medium(&s, &def);
    }
    vl_scene_defs(s.scene)->camera_medium = id[0];
    add_ball(&s, 0, 1, interface(&s), id[0], id[1]);
    add_ball(&s, 0, 3, interface(&s), id[1], id[2]);
    add_ball(&s, 0, 6, interface(&s), id[2], (vlMediumId){0});
    add_sky(&s, 1);
    Image p = stage_finish(&s);
    assert_ratio("nested", image_mean(&p, 1), exp(-0.4 * 1 - 0.2 * 2 - 0.1 * 3),
                 turn ? 6e-3 : 1e-4);
    image_free(&p);
  }
}

/* A lamp (a point, then a small ball that paths run into as well) in the outer shell, looked
 * for through both. */
static void lamp_in_shell(void **state) {
  (void)state;
  double mean[2];
  for (int with = 0; with < 2; with++) {
    Stage s = narrow(256, VL_COLOR_RGB);
    vlMediumDef a = fog(0.5f, 0, 0), b = fog(0.3f, 0, 0);
    vlMediumId inner = {0}, outer = {0};
    if (with) {
      inner = add_medium(&s, &a);
      outer = add_medium(&s, &b);
    }
    vl_scene_defs(s.scene)->camera_medium = inner;
    add_ball(&s, 0, 4, interface(&s), inner, outer);
    Quad wall = quad_at(0, 0, -2, 1, 0, 0, 0, 1, 0);
    wall.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    add_quad(&s, &wall);
    vlLightDef point = vl_default_light_def(VL_LIGHT_POINT);
    point.color = vl_spectrum_rgb(9, 9, 9);
    point.from[2] = 8;
    point.medium = outer;
    vl_scene_add_light(s.scene, &point);
    Image p = stage_finish(&s);
    mean[with] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_ratio("lamp in a shell", mean[1] / mean[0], exp(-0.5 * (2 + 6) - 0.3 * 4), 2e-3);
}

/* ---- lamps that light passes ------------------------------------------------------------- */

/* An emissive interface in a medium: seen through 2 of it; and one near a wall, which
 * directions of the wall's material meet often, by a medium so thin that it changes nothing.
 * Both with another interface in between. */
static void lamps_that_light_passes(void **state) {
  (void)state;
  double mean[2][2];
  for (int wall = 0; wall < 2; wall++)
    for (int with = 0; with < 2; with++) {
      Stage s = narrow(1024, VL_COLOR_RGB);
      vlMediumDef def = fog(wall ? 1e-7f : 0.4f, 0, 0);
      if (with)
        vl_scene_defs(s.scene)->camera_medium = add_medium(&s, &def);
      /* faces away from the camera where there is a wall */
      Quad lamp = quad_at(0, 0, wall ? -1.5f : -2, wall ? -1 : 1, 0, 0, 0, 1, 0);
      lamp.material = interface(&s);
      lamp.emission = add_emission(&s, 3, false);
      add_quad(&s, &lamp);
      Quad pane = quad_at(0, 0, -1.75f, 4, 0, 0, 0, 4, 0);
      pane.material = interface(&s);
      add_quad(&s, &pane);
      Quad back = quad_at(0, 0, -2, 4, 0, 0, 0, 4, 0);
      back.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
      if (wall)
        add_quad(&s, &back);
      Image p = stage_finish(&s);
      mean[wall][with] = image_mean(&p, 1);
      image_free(&p);
    }
  assert_ratio("seen", mean[0][0], 3, 1e-4);
  assert_ratio("seen in a medium", mean[0][1], 3 * exp(-0.4 * 2), 1e-4);
  assert_ratio("before a wall", mean[1][1] / mean[1][0], 1, 2e-3);
}

/* ---- grids, turned and stretched --------------------------------------------------------- */

/* A box of density 1 to 3 along its x, which the world stretches twofold and turns to the line
 * of sight: coefficients are the world's. Between cell centres linear, outside of them towards
 * 0. */
static void stretched(void **state) {
  (void)state;
  const float ramp[2] = {1, 3};
  for (int back = 0; back < 2; back++) {
    Stage s = narrow(4096, VL_COLOR_RGB);
    s.camera.fov = 0.001;
    vlMediumDef def = fog(0.25f, 0, 0);
    def.kind = VL_MEDIUM_GRID;
    def.nx = 2;
    def.ny = def.nz = 1;
    def.density = ramp;
    for (int i = 0; i < 3; i++) {
      def.low[i] = 0;
      def.high[i] = 1;
    }
    /* x -> -z twice as long, y -> x, z -> y four times as wide; the ray goes through the middle
     * of both */
    if (back)
      set_matrix(def.world_from_medium, 0, 1, 0, -0.5, 0, 0, 4, -2, 2, 0, 0, -5);
    if (!back)
      set_matrix(def.world_from_medium, 0, 1, 0, -0.5, 0, 0, 4, -2, -2, 0, 0, -3);
    vlMediumId id = add_medium(&s, &def);
    add_ball(&s, -4, 3, interface(&s), id, (vlMediumId){0});
    add_sky(&s, 1);
    Image p = stage_finish(&s);
    /* along x: 1/2 to 1 in the first quarter, to 3 in the half between the centres, to 3/2 at
     * the end */
    double depth = (0.75 / 4 + 2.0 / 2 + 2.25 / 4) * 2 * 0.25;
    assert_ratio("stretched", image_mean(&p, 1), exp(-depth), 5e-3);
    image_free(&p);
  }
}

/* An RGB grid of one colour, absorbing, then emissive, against what colours say. */
static void rgb_grids(void **state) {
  (void)state;
  static float sigma[24], emission[24], none[24];
  for (int i = 0; i < 24; i++) {
    sigma[i] = (float[3]){0.2f, 0.5f, 1.0f}[i % 3];
    emission[i] = (float[3]){3, 2, 1}[i % 3];
  }
  for (int rgb = 0; rgb < 2; rgb++) {
    double seen[3], known[3];
    for (int way = 0; way < 3; way++) { /* the grid before a sky; emissive; the same colours of
                                           a homogeneous medium */
      Stage s = narrow(2048, rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL);
      vlMediumDef def = fog(0, 0, 0);
      if (way < 2) {
        def.kind = VL_MEDIUM_RGB_GRID;
        def.nx = def.ny = def.nz = 2;
        def.rgb_a = sigma;
        def.rgb_s = none;
        if (way == 1)
          def.rgb_emission = emission;
        def.scale = 0.8f;
        for (int i = 0; i < 3; i++) {
          def.low[i] = -20;
          def.high[i] = 20;
        }
      } else {
        def.sigma_a = vl_spectrum_rgb(0.2f, 0.5f, 1.0f);
        def.scale = 0.8f;
      }
      add_ball(&s, -3, 1, interface(&s), add_medium(&s, &def), (vlMediumId){0});
      if (way != 1)
        add_sky(&s, 1);
      Image p = stage_finish(&s);
      for (int c = 0; c < 3; c++) {
        double mean = image_mean(&p, c), passes = exp(-2 * 0.8 * (double)sigma[c]);
        if (way == 0)
          seen[c] = mean;
        if (way == 2)
          known[c] = mean;
        if (rgb && way != 1)
          assert_ratio("RGB absorption", mean, passes, 8e-3);
        if (rgb && way == 1)
          assert_ratio("RGB emission", mean, RAW * (double)emission[c] * (1 - passes), 0.015);
      }
      image_free(&p);
    }
    for (int c = 0; c < 3; c++)
      assert_near("RGB grid as its colours", seen[c], known[c], 8e-3);
  }
}

/* ---- emissive and scattering ------------------------------------------------------------- */

/* A thin ball of little albedo: emission along the ray, and once scattered emission, which is
 * small but known to order: the whole lies between none scattered and all of it coming from an
 * endless medium. */
static void emissive_fog(void **state) {
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    Stage s = narrow(4096, VL_COLOR_RGB);
    /* emission at the end of the first flight, and of the one after one scattering */
    s.render.max_depth = 1;
    vlMediumDef def = fog(0.3f, 0.2f, 0);
    def.emission = vl_spectrum_rgb(1, 1, 1);
    if (kind)
      make_even_grid(&def, 20);
    add_ball(&s, -3, 1, interface(&s), add_medium(&s, &def), (vlMediumId){0});
    Image p = stage_finish(&s);
    /* At the last permitted bounce a medium dims and gives no light: so what is seen is the
     * first flight's emission. */
    assert_ratio("first flight", image_mean(&p, 1), 0.3 / 0.5 * (1 - exp(-0.5 * 2)), 6e-3);
    image_free(&p);
    Stage t = narrow(8192, VL_COLOR_RGB);
    t.render.max_depth = 2;
    add_ball(&t, -3, 1, interface(&t), add_medium(&t, &def), (vlMediumId){0});
    p = stage_finish(&t);
    /* And once scattered: along the ray a mean over all directions of (1 - exp(-0.5 l)) of the
     * way l out of the ball */
    double sum = 0;
    const int n = 400, m = 400;
    for (int i = 0; i < n; i++) {
      double x = -1 + 2 * (i + 0.5) / n, mean = 0;
      for (int j = 0; j < m; j++) {
        double mu = -1 + 2 * (j + 0.5) / m, l = -x * mu + sqrt(x * x * mu * mu + 1 - x * x);
        mean += 0.3 / 0.5 * (1 - exp(-0.5 * l)) / m;
      }
      sum += 2.0 / n * exp(-0.5 * (1 + x)) * 0.2 * mean;
    }
    assert_ratio("once scattered", image_mean(&p, 1), 0.3 / 0.5 * (1 - exp(-1.0)) + sum, 8e-3);
    image_free(&p);
  }
}

/* ---- NanoVDB ----------------------------------------------------------------------------- */

/* A cube of 128^3 voxels of side 1/2 and density 7, starting at (74, 0, 0). A ray goes through
 * its middle; the medium is unchanged, rotated, and stretched along the ray. */
static void voxels(void **state) {
  (void)state;
  char path[128];
  size_t size;
  unsigned char *grid = make_grid(), *file = make_file(grid, 1, &size);
  snprintf(path, sizeof path, "%s/test_media_known_%d.nvdb", VELO_BINARY_DIR, (int)getpid());
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(file, 1, size, f), size);
  fclose(f);
  free(grid);
  free(file);
  for (int way = 0; way < 3; way++) {
    Stage s = narrow(4096, VL_COLOR_RGB);
    vlMediumDef def = vl_default_medium_def(VL_MEDIUM_NANOVDB);
    def.sigma_a = vl_spectrum_constant(0.002f);
    def.sigma_s = vl_spectrum_constant(0);
    def.path = path;
    if (way == 0)
      set_matrix(def.world_from_medium, 1, 0, 0, -106, 0, 1, 0, -32, 0, 0, 1, -200);
    if (way == 1)
      set_matrix(def.world_from_medium, 0, 1, 0, -32, 0, 0, 1, -32, 1, 0, 0, -300);
    if (way == 2)
      set_matrix(def.world_from_medium, 0, 1, 0, -32, 0, 0, 1, -32, -1.5, 0, 0, 0);
    vlMediumId id = add_medium(&s, &def);
    add_ball(&s, 0, 1000, interface(&s), id, (vlMediumId){0});
    vl_scene_defs(s.scene)->camera_medium = id;
    add_sky(&s, 1);
    Image p = stage_finish(&s);
    assert_ratio("voxels", image_mean(&p, 1), exp(-0.002 * 7 * 64 * (way == 2 ? 1.5 : 1)),
                 0.01);
    image_free(&p);
  }
  remove(path);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equilibrium),   cmocka_unit_test(nested),
      cmocka_unit_test(lamp_in_shell), cmocka_unit_test(lamps_that_light_passes),
      cmocka_unit_test(stretched),     cmocka_unit_test(rgb_grids),
      cmocka_unit_test(emissive_fog),  cmocka_unit_test(voxels)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
