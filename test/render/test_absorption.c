/* test/render/test_absorption.c: absorption by RGB channel (vlMediumDef.rgb_absorption): each
 * channel of white light is multiplied by exp(-sigma_a x), in both colour modes, for every
 * tracer, for any depth and any number of segments. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "fog.h"
#include "velo/load.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

static const double attenuation[3] = {0.8, 0.95, 1.0}; /* over a unit of depth */

/* A medium in which a distance of 2 has `depth` units of absorption. */
static vlMediumId glass_of(Stage *s, double depth, const double color[3], float scattering) {
  vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  float sigma[3];
  for (int c = 0; c < 3; c++)
    sigma[c] = (float)(-log(color[c]) * depth / 2);
  def.sigma_a = vl_spectrum_rgb(sigma[0], sigma[1], sigma[2]);
  def.sigma_s = vl_spectrum_constant(scattering);
  def.rgb_absorption = true;
  return add_medium(s, &def);
}

static Stage open_stage(vlColorMode color, vlTracer tracer, uint32_t size, uint32_t spp) {
  Stage s = stage_open(size, size);
  s.build.color = color;
  s.render.tracer = tracer;
  s.render.spp = spp;
  add_sky(&s, 1);
  return s;
}

/* Absolute tolerance: the noise that a few wavelengths leave. */
static void assert_law(const char *what, const Image *p, const double expected[3]) {
  for (int c = 0; c < 3; c++) {
    double seen = image_mean(p, c);
    if (fabs(seen - expected[c]) > 0.01 * expected[c] + 1e-3)
      fail_msg("%s: channel %d: %.5f, expected %.5f", what, c, seen, expected[c]);
  }
}

static void one_piece(void **state) {
  (void)state;
  const double depths[4] = {1, 10, 30, 100};
  const vlTracer tracers[3] = {VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING};
  for (int d = 0; d < 4; d++)
    for (int k = 0; k < (d == 1 ? 3 : 1); k++)
      for (int mode = 0; mode < 2; mode++) {
        Stage s = open_stage((vlColorMode)mode, tracers[k], 16, 256);
        s.camera.fov = 0.02;
        add_ball(&s, -3, 1, interface(&s), glass_of(&s, depths[d], attenuation, 0),
                 (vlMediumId){0});
        Image p = stage_finish(&s);
        double expected[3];
        for (int c = 0; c < 3; c++)
          expected[c] = pow(attenuation[c], depths[d]);
        assert_law(mode ? "a slab, RGB" : "a slab, spectral", &p, expected);
        image_free(&p);
      }
}

/* Two media of different colours, one behind the other, and then the first again. */
static void several_pieces(void **state) {
  (void)state;
  const double other[3] = {1.0, 0.9, 0.7}, depth[3] = {6, 4, 9};
  for (int mode = 0; mode < 2; mode++) {
    Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, 16, 256);
    s.camera.fov = 0.02;
    double expected[3];
    for (int c = 0; c < 3; c++)
      expected[c] = pow(attenuation[c], depth[0] + depth[2]) * pow(other[c], depth[1]);
    for (int k = 0; k < 3; k++)
      add_ball(&s, -3 - 3 * (float)k, 1, interface(&s),
               glass_of(&s, depth[k], k == 1 ? other : attenuation, 0), (vlMediumId){0});
    Image p = stage_finish(&s);
    assert_law("three in a row", &p, expected);
    image_free(&p);
  }
}

/* The camera and a lamp are in the medium, 2 in front of a wall, so light crosses the medium
 * twice. `merged`: most of the light is found by light paths that merge with camera paths at
 * the wall. */
static void see_wall(bool merged, bool absorbs, double mean[3]) {
  Stage s = stage_open(8, 8);
  s.camera.fov = 0.02;
  s.render.spp = 1024;
  s.render.tracer = merged ? VL_TRACER_MERGING : VL_TRACER_VOLPATH;
  if (merged) {
    s.render.merge_radius = 0.4;
    s.render.light_paths = 512;
  }
  vlMediumDef none = fog(0, 0, 0);
  /* 5 units a length of 1 */
  vlMediumId medium = absorbs ? glass_of(&s, 2 * 5, attenuation, 0) : add_medium(&s, &none);
  vl_scene_defs(s.scene)->camera_medium = medium;
  add_ball(&s, -102, 100, add_diffuse(&s, 0.5f, 0.5f, 0.5f), (vlMediumId){0}, medium);
  vlLightDef lamp = vl_default_light_def(VL_LIGHT_POINT);
  lamp.color = vl_spectrum_rgb(1, 1, 1);
  lamp.medium = medium;
  assert_int_not_equal(vl_scene_add_light(s.scene, &lamp).index, 0);
  Image p = stage_finish(&s);
  for (int c = 0; c < 3; c++)
    mean[c] = image_mean(&p, c);
  image_free(&p);
}

/* merged: where the disk is wide, paths are a little longer, so a few percent more light is
 * absorbed. */
static void there_and_back(void **state) {
  (void)state;
  for (int merged = 0; merged < 2; merged++) {
    double clear[3], seen[3];
    see_wall(merged, false, clear);
    see_wall(merged, true, seen);
    for (int c = 0; c < 3; c++) { /* 2 there, 2 back */
      double expected = pow(attenuation[c], 4 * 5), value = seen[c] / clear[c];
      if (fabs(value - expected) > (merged ? 0.03 : 0.01) * expected + 2e-3)
        fail_msg("%s: channel %d: %.5f, expected %.5f", merged ? "merged" : "asked for", c,
                 value, expected);
    }
  }
}

static void add_box(Stage *s, const float low[3], const float high[3], vlMaterialId material,
                    vlMediumId inside) {
  float p[24];
  static const uint32_t faces[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 3; k++)
      p[3 * i + k] = i >> k & 1 ? high[k] : low[k];
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = p;
  def.vertices = 8;
  def.indices = faces;
  def.faces = 12;
  def.material = material;
  def.inside = inside;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

/* Compares what the two colour modes see. */
static void assert_same_law(const char *what, const Image images[2]) {
  for (int c = 0; c < 3; c++) {
    double spectral = image_mean(&images[0], c), rgb = image_mean(&images[1], c);
    if (fabs(spectral - rgb) > 0.01 * rgb + 1.5e-3)
      fail_msg("%s: channel %d: spectral %.5f, RGB %.5f", what, c, spectral, rgb);
  }
}

/* From inside a glass rod, light arrives through the end of the rod after many total internal
 * reflections. */
static void total_reflection(void **state) {
  (void)state;
  Image images[2];
  for (int mode = 0; mode < 2; mode++) {
    Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, 16, 256);
    s.camera.fov = 0.9;
    s.camera.near_plane = 1e-3;
    s.render.max_depth = 60;
    vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
    vlMediumId inside = glass_of(&s, 4, attenuation, 0);
    add_box(&s, (float[3]){-0.2f, -0.2f, -4}, (float[3]){0.2f, 0.2f, 1},
            vl_scene_add_material(s.scene, &glass), inside);
    vl_scene_defs(s.scene)->camera_medium = inside;
    images[mode] = stage_finish(&s);
  }
  assert_true(image_mean(&images[1], 0) < 0.5 * image_mean(&images[1], 2)); /* it is deep */
  assert_same_law("a rod", images);
  for (int mode = 0; mode < 2; mode++)
    image_free(&images[mode]);
}

/* Scattering in a coloured ball with a grey ball inside. Paths have many segments, which the
 * tracers connect in many ways. */
static void scattered(void **state) {
  (void)state;
  const vlTracer tracers[3] = {VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING};
  const double color[3] = {0.3, 0.8, 1.0};
  for (int k = 0; k < 3; k++) {
    Image images[2];
    for (int mode = 0; mode < 2; mode++) {
      Stage s = open_stage((vlColorMode)mode, tracers[k], 16, 512);
      s.camera.fov = 0.6;
      s.render.max_depth = 30;
      vlMediumId inside = glass_of(&s, 3, color, 1.5f);
      vlMaterialDef grey = vl_default_material_def(VL_MATERIAL_DIFFUSE);
      grey.reflectance.value = vl_spectrum_constant(0.8f);
      add_ball(&s, -3, 1, interface(&s), inside, (vlMediumId){0});
      add_ball(&s, -3, 0.6f, vl_scene_add_material(s.scene, &grey), (vlMediumId){0}, inside);
      images[mode] = stage_finish(&s);
    }
    assert_true(image_mean(&images[1], 0) < 0.4 * image_mean(&images[1], 2));
    assert_same_law(k == 0 ? "volpath" : k == 1 ? "bidirectional" : "merging", images);
    for (int mode = 0; mode < 2; mode++)
      image_free(&images[mode]);
  }
}

/* The tint of a principled solid (MTL's Tf, glTF's base colour) is applied at both crossings,
 * whatever lies between them. The tint of a sheet is applied once. */
static void tints(void **state) {
  (void)state;
  static const float colors[3][3] = {
      {0.8f, 0.95f, 1.0f}, {0.9f, 0.5f, 0.1f}, {0.2f, 0.6f, 0.3f}};
  static const float depths[3] = {0.01f, 1.0f, 100.0f};
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 4; d++) /* the last: a sheet */
      for (int mode = 0; mode < 2; mode++) {
        Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, 16, 256);
        s.camera.fov = 0.02;
        vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
        def.reflectance =
            vl_spectrum_input(vl_spectrum_rgb(colors[k][0], colors[k][1], colors[k][2]));
        def.eta = vl_spectrum_input(vl_spectrum_constant(d == 0 ? 1.0f : 1.01f));
        def.principled.metallic = vl_float_input(0);
        def.principled.transmission = vl_float_input(1);
        def.principled.roughness = vl_float_input(0);
        def.principled.thin_walled = d == 3;
        vlMaterialId glass = vl_scene_add_material(s.scene, &def);
        Quad sheet = quad_at(0, 0, -2, 9, 0, 0, 0, 9, 0);
        sheet.material = glass;
        if (d == 3)
          add_quad(&s, &sheet);
        else
          add_box(&s, (float[3]){-900, -900, -2 - depths[d]}, (float[3]){900, 900, -2}, glass,
                  (vlMediumId){0});
        Image p = stage_finish(&s);
        double expected[3];
        for (int c = 0; c < 3; c++)
          expected[c] = pow((double)colors[k][c], d == 3 ? 1 : 2);
        assert_law(mode ? "a tint, RGB" : "a tint, spectral", &p, expected);
        image_free(&p);
      }
}

/* The same scene through an OBJ file: MTL's Tf of a glass solid. */
static void tint_of_mtl(void **state) {
  (void)state;
  static const double color[3] = {0.9, 0.5, 0.1};
  char folder[] = "/tmp/velo-absorption-XXXXXX", obj[64], mtl[64];
  assert_non_null(mkdtemp(folder));
  snprintf(obj, sizeof obj, "%s/slab.obj", folder);
  snprintf(mtl, sizeof mtl, "%s/slab.mtl", folder);
  FILE *file = fopen(mtl, "w");
  assert_non_null(file);
  fputs("newmtl glass\nKd 0 0 0\nKs 0 0 0\nNs 100000000\nNi 1.01\nillum 7\nTf 0.9 0.5 0.1\n",
        file);
  fclose(file);
  assert_non_null(file = fopen(obj, "w"));
  fputs("mtllib slab.mtl\nusemtl glass\n", file);
  for (int i = 0; i < 8; i++)
    fprintf(file, "v %d %d %d\n", i & 1 ? 9 : -9, i & 2 ? 9 : -9, i & 4 ? -2 : -5);
  fputs("f 5 6 8 7\nf 2 1 3 4\nf 6 2 4 8\nf 1 5 7 3\nf 7 8 4 3\nf 1 2 6 5\n", file);
  fclose(file);
  for (int mode = 0; mode < 2; mode++) {
    Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, 16, 256);
    vlError error = {0};
    s.camera.fov = 0.02;
    if (vl_scene_load(s.scene, obj, NULL, &error) != VL_OK)
      fail_msg("%s", error.message);
    Image p = stage_finish(&s);
    double expected[3];
    for (int c = 0; c < 3; c++)
      expected[c] = color[c] * color[c];
    assert_law(mode ? "Tf, RGB" : "Tf, spectral", &p, expected);
    image_free(&p);
  }
  assert_int_equal(unlink(obj) | unlink(mtl) | rmdir(folder), 0);
}

/* Absorption by channel is an error for media to which it cannot apply. */
static void refused(void **state) {
  (void)state;
  for (int what = 0; what < 3; what++) {
    Stage s = stage_open(4, 4);
    vlMediumDef def =
        vl_default_medium_def(what == 0 ? VL_MEDIUM_CLOUD : VL_MEDIUM_HOMOGENEOUS);
    def.rgb_absorption = true;
    if (what == 1)
      def.sigma_a = vl_spectrum_blackbody(5000);
    if (what == 2)
      def.emission = vl_spectrum_rgb(1, 0, 0);
    assert_int_equal(vl_scene_add_medium(s.scene, &def).index, 0);
    assert_int_equal(vl_scene_result(s.scene, NULL), VL_ERROR_SCENE);
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_piece),      cmocka_unit_test(several_pieces),
      cmocka_unit_test(there_and_back), cmocka_unit_test(total_reflection),
      cmocka_unit_test(scattered),      cmocka_unit_test(refused),
      cmocka_unit_test(tints),          cmocka_unit_test(tint_of_mtl),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
