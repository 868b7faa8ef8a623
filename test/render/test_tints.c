/* test/render/test_tints.c: the tint of principled materials that transmit (glTF's base colour,
 * MTL's Tf): white light that crosses surfaces of colours c_k leaves them as the product of c_k
 * per channel of linear sRGB, in both colour modes, for every tracer. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "fog.h"
#include "velo/load.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/tracer.h"

static const float blue[3] = {0.8f, 0.95f, 1.0f}, amber[3] = {0.9f, 0.6f, 0.2f};

static Stage open_stage(vlColorMode color, vlTracer tracer, uint32_t spp) {
  Stage s = stage_open(16, 16);
  s.build.color = color;
  s.render.tracer = tracer;
  s.render.spp = spp;
  s.render.max_depth = 250;
  s.camera.fov = 0.02;
  return s;
}

/* Clear dielectric. A sheet has the index 1, so that it reflects nothing; a solid reflects
 * 2e-5. */
static vlMaterialDef glass(vlSpectrumInput color, bool sheet) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  def.reflectance = color;
  def.eta = vl_spectrum_input(vl_spectrum_constant(sheet ? 1.0f : 1.01f));
  def.principled.metallic = vl_float_input(0);
  def.principled.transmission = vl_float_input(1);
  def.principled.roughness = vl_float_input(0);
  def.principled.thin_walled = sheet;
  return def;
}
static vlSpectrumInput rgb(const float c[3]) {
  return vl_spectrum_input(vl_spectrum_rgb(c[0], c[1], c[2]));
}

/* A colour as such, or that of a texture: an image, or a product. */
typedef enum Coloring { PLAIN, IMAGE_OF_ONE_TEXEL, SCALED } Coloring;
static vlSpectrumInput colored(Stage *s, const float c[3], Coloring by) {
  vlSpectrumInput plain = rgb(c), input = plain;
  if (by == PLAIN)
    return plain;
  vlTextureDef def =
      vl_default_texture_def(by == SCALED ? VL_TEXTURE_SCALE : VL_TEXTURE_IMAGE, true);
  vlImage *image = NULL;
  if (by == SCALED) {
    def.spectrum_a = plain;
    def.amount = vl_float_input(1);
  } else {
    vlImageDef size = vl_default_image_def(1, 1, 3);
    assert_int_equal(vl_image_create(s->context, &size, &image), VL_OK);
    memcpy(vl_image_pixels(image), c, 3 * sizeof *c);
    def.image = image;
  }
  input.texture = vl_scene_add_texture(s->scene, &def);
  vl_image_destroy(image);
  return input;
}

static void add_sheet(Stage *s, float z, vlMaterialId material) {
  Quad q = quad_at(0, 0, z, 900, 0, 0, 0, 900, 0);
  q.material = material;
  add_quad(s, &q);
}

static void add_slab(Stage *s, float near, float far, vlMaterialId material,
                     vlMediumId inside) {
  float p[24];
  static const uint32_t faces[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  for (int i = 0; i < 8; i++) {
    p[3 * i] = i & 1 ? 900.0f : -900.0f;
    p[3 * i + 1] = i & 2 ? 900.0f : -900.0f;
    p[3 * i + 2] = i & 4 ? near : far;
  }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = p;
  def.vertices = 8;
  def.indices = faces;
  def.faces = 12;
  def.material = material;
  def.inside = inside;
  assert_int_not_equal(vl_scene_add_shape(s->scene, &def).index, 0);
}

/* Absolute: what a few wavelengths leave of noise. */
static void assert_color(const char *what, vlColorMode mode, const double seen[3],
                         const double expected[3]) {
  for (int c = 0; c < 3; c++)
    if (!(fabs(seen[c] - expected[c]) <= 0.01 * expected[c] + 1e-3))
      fail_msg("%s, %s: channel %d: %.5f, expected %.5f", what,
               mode == VL_COLOR_RGB ? "RGB" : "spectral", c, seen[c], expected[c]);
}
static void assert_image(const char *what, vlColorMode mode, Image *p,
                         const double expected[3]) {
  double seen[3];
  for (int c = 0; c < 3; c++)
    seen[c] = image_mean(p, c);
  image_free(p);
  assert_color(what, mode, seen, expected);
}

/* ---- sheets and solids ------------------------------------------------------------------- */

/* n sheets, or n / 2 solids, of two colours in turns. */
static void stack_of(int n, bool sheets, const float *const colors[2], Coloring by,
                     vlColorMode mode, vlTracer tracer) {
  Stage s = open_stage(mode, tracer, n > 10 ? 64 : 512);
  add_sky(&s, 1);
  vlMaterialId material[2];
  for (int k = 0; k < 2; k++) {
    vlMaterialDef def = glass(colored(&s, colors[k], by), sheets);
    material[k] = vl_scene_add_material(s.scene, &def);
  }
  double expected[3] = {1, 1, 1};
  for (int i = 0; i < n; i++) {
    int which = (sheets ? i : i / 2) % 2;
    if (sheets)
      add_sheet(&s, -2.0f - (float)i, material[which]);
    if (!sheets && i % 2 == 0)
      add_slab(&s, -2.0f - (float)i, -2.5f - (float)i, material[which], (vlMediumId){0});
    for (int c = 0; c < 3; c++)
      expected[c] *= (double)colors[which][c];
  }
  Image p = stage_finish(&s);
  char what[64];
  snprintf(what, sizeof what, "%d %s, tracer %d", n, sheets ? "sheets" : "sides of solids",
           (int)tracer);
  assert_image(what, mode, &p, expected);
}

static void stacks(void **state) {
  (void)state;
  const float *const one[2] = {blue, blue}, *const two[2] = {blue, amber};
  const int counts[5] = {1, 3, 10, 30, 100};
  for (int mode = 0; mode < 2; mode++) {
    for (int k = 0; k < 5; k++)
      stack_of(counts[k], true, one, PLAIN, (vlColorMode)mode, VL_TRACER_VOLPATH);
    for (int k = 1; k < 3; k++)
      stack_of(counts[k], true, two, PLAIN, (vlColorMode)mode, VL_TRACER_VOLPATH);
    for (int n = 2; n < 7; n += 4)
      stack_of(n, false, two, PLAIN, (vlColorMode)mode, VL_TRACER_VOLPATH);
  }
  stack_of(6, true, two, IMAGE_OF_ONE_TEXEL, VL_COLOR_SPECTRAL, VL_TRACER_VOLPATH);
  stack_of(6, true, two, SCALED, VL_COLOR_SPECTRAL, VL_TRACER_VOLPATH);
}

static void stacks_of_all_tracers(void **state) {
  (void)state;
  const float *const two[2] = {blue, amber};
  const vlTracer tracers[4] = {VL_TRACER_PATH, VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING,
                               VL_TRACER_SPPM};
  for (int k = 0; k < 4; k++) {
    stack_of(6, true, two, PLAIN, VL_COLOR_SPECTRAL, tracers[k]);
    stack_of(6, false, two, PLAIN, VL_COLOR_SPECTRAL, tracers[k]);
  }
}

/* A tinted solid that also absorbs, behind a tinted sheet. */
static void with_absorption(void **state) {
  (void)state;
  for (int mode = 0; mode < 2; mode++) {
    Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, 256);
    add_sky(&s, 1);
    vlMaterialDef sheet = glass(rgb(amber), true), solid = glass(rgb(blue), false);
    vlMediumDef medium = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
    const double depth[3] = {0.02, 0.3, 2};
    medium.sigma_a = vl_spectrum_rgb((float)depth[0], (float)depth[1], (float)depth[2]);
    medium.sigma_s = vl_spectrum_constant(0);
    medium.rgb_absorption = true;
    add_sheet(&s, -2, vl_scene_add_material(s.scene, &sheet));
    add_slab(&s, -3, -4, vl_scene_add_material(s.scene, &solid), add_medium(&s, &medium));
    Image p = stage_finish(&s);
    double expected[3];
    for (int c = 0; c < 3; c++)
      expected[c] = (double)amber[c] * pow((double)blue[c], 2) * exp(-depth[c]);
    assert_image("a sheet before a solid that absorbs", (vlColorMode)mode, &p, expected);
  }
}

/* ---- textures ---------------------------------------------------------------------------- */

/* Sheets whose colour is an image: blue on the left, amber on the right. `mixed`: the image is
 * one half of a mix whose other half is white. */
static void textures(void **state) {
  (void)state;
  for (int mixed = 0; mixed < 2; mixed++)
    for (int mode = 0; mode < 2; mode++) {
      Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, 512);
      add_sky(&s, 1);
      s.camera.fov = 0.8;
      float pixels[6];
      memcpy(pixels, blue, sizeof blue);
      memcpy(pixels + 3, amber, sizeof amber);
      vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
      vlImage *image = make_image(&s, 2, 1, pixels);
      def.image = image;
      def.filter = VL_FILTER_POINT;
      vlTextureId texture = vl_scene_add_texture(s.scene, &def);
      vl_image_destroy(image);
      if (mixed) {
        vlTextureDef mix = vl_default_texture_def(VL_TEXTURE_MIX, true);
        mix.spectrum_a = (vlSpectrumInput){texture, vl_spectrum_constant(1)};
        mix.spectrum_b = vl_spectrum_input(vl_spectrum_constant(1));
        mix.amount = vl_float_input(0.5f);
        texture = vl_scene_add_texture(s.scene, &mix);
      }
      vlMaterialDef tinted = glass((vlSpectrumInput){texture, vl_spectrum_constant(1)}, true);
      vlMaterialId material = vl_scene_add_material(s.scene, &tinted);
      for (int i = 0; i < 10; i++)
        add_sheet(&s, -2 - (float)i, material);
      Image p = stage_finish(&s);
      double left[3], right[3], seen[2][3];
      for (int c = 0; c < 3; c++) {
        left[c] = pow(mixed ? 0.5 + 0.5 * (double)blue[c] : (double)blue[c], 10);
        right[c] = pow(mixed ? 0.5 + 0.5 * (double)amber[c] : (double)amber[c], 10);
        seen[0][c] = image_region(&p, 0, 0, 7, 16, c);
        seen[1][c] = image_region(&p, 9, 0, 16, 16, c);
      }
      image_free(&p);
      assert_color("left half", (vlColorMode)mode, seen[0], left);
      assert_color("right half", (vlColorMode)mode, seen[1], right);
    }
}

/* A base colour that is a measured spectrum acts per wavelength, as a filter does: two sheets
 * are a sheet of its square. */
static void spectra_multiply(void **state) {
  (void)state;
  float lambda[4] = {360, 520, 600, 830}, once[4] = {0.9f, 0.2f, 0.7f, 0.5f}, twice[4];
  for (int i = 0; i < 4; i++)
    twice[i] = once[i] * once[i];
  double seen[2][3];
  for (int k = 0; k < 2; k++) {
    Stage s = open_stage(VL_COLOR_SPECTRAL, VL_TRACER_VOLPATH, 256);
    add_sky(&s, 1);
    /* constant in steps, so that the square of the interpolated spectrum is the interpolated
     * square */
    float steps[8], values[8];
    for (int i = 0; i < 4; i++) {
      steps[2 * i] = lambda[i];
      steps[2 * i + 1] = i < 3 ? lambda[i + 1] - 0.001f : 840;
      values[2 * i] = values[2 * i + 1] = k ? twice[i] : once[i];
    }
    vlSpectrum color = {.kind = VL_SPECTRUM_SAMPLED,
                        .scale = 1,
                        .count = 8,
                        .wavelengths = steps,
                        .values = values};
    vlMaterialDef def = glass(vl_spectrum_input(color), true);
    vlMaterialId material = vl_scene_add_material(s.scene, &def);
    for (int i = 0; i < 2 - k; i++)
      add_sheet(&s, -2 - (float)i, material);
    Image p = stage_finish(&s);
    for (int c = 0; c < 3; c++)
      seen[k][c] = image_mean(&p, c);
    image_free(&p);
  }
  assert_color("two sheets of a spectrum", VL_COLOR_SPECTRAL, seen[0], seen[1]);
}

/* ---- partial transmission ---------------------------------------------------------------- */

/* Half of the base transmits, half is matt. A lamp far behind n sheets is seen through the half
 * that transmits, (c / 2)^n; before a white sky a sheet shows c, half of it reflected. */
static void half(void **state) {
  (void)state;
  for (int mode = 0; mode < 2; mode++)
    for (int n = 0; n < 4; n++) { /* 0: before the sky */
      Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, n > 0 ? 1024 : 256);
      vlMaterialDef def = glass(rgb(amber), true);
      def.principled.transmission = vl_float_input(0.5f);
      vlMaterialId material = vl_scene_add_material(s.scene, &def);
      for (int i = 0; i < (n > 0 ? n : 1); i++)
        add_sheet(&s, -2 - (float)i, material);
      if (n == 0) {
        add_sky(&s, 1);
      } else { /* light that the sheets reflect to each other adds less than 1e-3 */
        Quad lamp = quad_at(0, 0, -100, 5, 0, 0, 0, 5, 0);
        lamp.emission = add_emission(&s, 1, true);
        add_quad(&s, &lamp);
      }
      Image p = stage_finish(&s);
      double expected[3];
      for (int c = 0; c < 3; c++)
        expected[c] = n > 0 ? pow((double)amber[c] / 2, n) : (double)amber[c];
      assert_image(n > 0 ? "a lamp through half-clear sheets" : "a half-clear sheet",
                   (vlColorMode)mode, &p, expected);
    }
}

/* ---- rough glass ------------------------------------------------------------------------- */

/* The camera stands in a ball of rough glass, a lamp outside of it in a grey room; both sides
 * may be full of media that absorb by channel. Light samples, splats and photons join paths
 * through the glass. Everything acts by channel, so that both colour modes show the same. */
static Image rough(vlColorMode mode, vlTracer tracer, bool media) {
  static const float tint[3] = {0.2f, 0.7f, 1.0f},
                     sigma[2][3] = {{0.1f, 0.3f, 0.6f}, {0.4f, 0.02f, 0.2f}};
  /* at 256 samples the red of a spectral image has a standard error of 0.25 %, that of an RGB
   * image 0.04 % */
  Stage s = open_stage(mode, tracer, mode == VL_COLOR_SPECTRAL ? 512 : 256);
  s.camera.fov = 0.8;
  s.render.max_depth = 12;
  s.render.merge_radius = 0.1;
  vlMediumId medium[2] = {{0}, {0}}; /* within the ball, around it */
  for (int k = 0; media && k < 2; k++) {
    vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
    def.sigma_a = vl_spectrum_rgb(sigma[k][0], sigma[k][1], sigma[k][2]);
    def.sigma_s = vl_spectrum_constant(0);
    def.rgb_absorption = true;
    medium[k] = add_medium(&s, &def);
  }
  vl_scene_defs(s.scene)->camera_medium = medium[0];
  vlMaterialDef def = glass(rgb(tint), true);
  def.principled.roughness = vl_float_input(0.7f);
  add_ball(&s, 0, 2, vl_scene_add_material(s.scene, &def), medium[0], medium[1]);
  vlMaterialDef grey = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  grey.reflectance.value = vl_spectrum_constant(0.5f);
  add_ball(&s, 0, 6, vl_scene_add_material(s.scene, &grey), medium[1], (vlMediumId){0});
  vlLightDef lamp = vl_default_light_def(VL_LIGHT_POINT);
  lamp.color = vl_spectrum_rgb(40, 40, 40);
  lamp.from[0] = 1;
  lamp.from[1] = 1;
  lamp.from[2] = -4;
  lamp.medium = medium[1];
  assert_int_not_equal(vl_scene_add_light(s.scene, &lamp).index, 0);
  return stage_finish(&s);
}

static void rough_glass(void **state) {
  (void)state;
  const vlTracer tracers[4] = {VL_TRACER_PATH, VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL,
                               VL_TRACER_MERGING};
  for (int k = 0; k < 4; k++)
    for (int media = 0; media < (tracers[k] == VL_TRACER_PATH ? 1 : 2); media++) {
      Image spectral = rough(VL_COLOR_SPECTRAL, tracers[k], media),
            plain = rough(VL_COLOR_RGB, tracers[k], media);
      for (int c = 0; c < 3; c++) {
        double a = image_mean(&spectral, c), b = image_mean(&plain, c);
        if (!(fabs(a - b) <= 0.003 * b))
          fail_msg("tracer %d, media %d: channel %d: spectral %.5f, RGB %.5f", (int)tracers[k],
                   media, c, a, b);
      }
      image_free(&spectral);
      image_free(&plain);
    }
}

/* ---- files ------------------------------------------------------------------------------- */

/* Three slabs of glass in an OBJ file: MTL's Tf. */
static void slabs_of_mtl(void **state) {
  (void)state;
  char folder[] = "/tmp/velo-tints-XXXXXX", obj[64], mtl[64];
  assert_non_null(mkdtemp(folder));
  snprintf(obj, sizeof obj, "%s/slabs.obj", folder);
  snprintf(mtl, sizeof mtl, "%s/slabs.mtl", folder);
  FILE *file = fopen(mtl, "w");
  assert_non_null(file);
  fputs("newmtl glass\nKd 0 0 0\nKs 0 0 0\nNs 100000000\nNi 1.01\nillum 7\nTf 0.8 0.95 1\n",
        file);
  fclose(file);
  assert_non_null(file = fopen(obj, "w"));
  fputs("mtllib slabs.mtl\nusemtl glass\n", file);
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 8; i++)
      fprintf(file, "v %d %d %d\n", i & 1 ? 9 : -9, i & 2 ? 9 : -9, (i & 4 ? -2 : -3) - 2 * k);
    static const int faces[6][4] = {{5, 6, 8, 7}, {2, 1, 3, 4}, {6, 2, 4, 8},
                                    {1, 5, 7, 3}, {7, 8, 4, 3}, {1, 2, 6, 5}};
    for (int i = 0; i < 6; i++)
      fprintf(file, "f %d %d %d %d\n", faces[i][0] + 8 * k, faces[i][1] + 8 * k,
              faces[i][2] + 8 * k, faces[i][3] + 8 * k);
  }
  fclose(file);
  for (int mode = 0; mode < 2; mode++) {
    Stage s = open_stage((vlColorMode)mode, VL_TRACER_VOLPATH, 256);
    add_sky(&s, 1);
    vlError error = {0};
    if (vl_scene_load(s.scene, obj, NULL, &error) != VL_OK)
      fail_msg("%s", error.message);
    Image p = stage_finish(&s);
    double expected[3];
    for (int c = 0; c < 3; c++)
      expected[c] = pow((double)blue[c], 6);
    assert_image("Tf of three slabs", (vlColorMode)mode, &p, expected);
  }
  assert_int_equal(unlink(obj) | unlink(mtl) | rmdir(folder), 0);
}

/* The random walk counts what it passes, too: rough sheets before a white sky have the colour
 * in wavelengths that they have in RGB. */
static void random_walks(void **state) {
  (void)state;
  double seen[2][3];
  for (int mode = 0; mode < 2; mode++) {
    Stage s = open_stage((vlColorMode)mode, VL_TRACER_RANDOM_WALK, 2048);
    s.render.max_depth = 5;
    add_sky(&s, 1);
    vlMaterialDef def = glass(rgb(blue), true);
    def.principled.roughness = vl_float_input(0.9f);
    for (int i = 0; i < 4; i++)
      add_sheet(&s, -2 - 0.1f * (float)i, vl_scene_add_material(s.scene, &def));
    Image p = stage_finish(&s);
    for (int c = 0; c < 3; c++)
      seen[mode][c] = image_mean(&p, c);
    image_free(&p);
  }
  for (int c = 0; c < 3; c++)
    assert_true(fabs(seen[0][c] - seen[1][c]) < 0.015 * seen[VL_COLOR_RGB][c]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stacks),           cmocka_unit_test(stacks_of_all_tracers),
      cmocka_unit_test(with_absorption),  cmocka_unit_test(textures),
      cmocka_unit_test(spectra_multiply), cmocka_unit_test(half),
      cmocka_unit_test(rough_glass),      cmocka_unit_test(random_walks),
      cmocka_unit_test(slabs_of_mtl),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
