/* test/render/test_textures.c: textures read from images: a square seen by an orthographic
 * camera and the raycast tracer shows its reflectance. Column x of 32 is u = (x + 1/2)/32, row
 * y is v = 1 - (y + 1/2)/32. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/texture.h"
#include "velo/tracer.h"

enum { SIZE = 32 };

static Stage stage(void) {
  Stage s = stage_open(SIZE, SIZE);
  s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
  s.build.color = VL_COLOR_RGB;
  s.render.tracer = VL_TRACER_RAYCAST;
  s.render.sampler = VL_SAMPLER_REGULAR; /* one sample: the pixel's centre */
  s.render.spp = 1;
  return s;
}

static Image show(Stage *s, vlTextureId texture) {
  Quad q = quad_at(0, 0, -1, 1, 0, 0, 0, 1, 0);
  q.material = add_textured(s, texture);
  add_quad(s, &q);
  return stage_finish(s);
}

static vlTextureId add(Stage *s, const vlTextureDef *def) {
  vlTextureId id = vl_scene_add_texture(s->scene, def);
  assert_int_not_equal(id.index, 0);
  return id;
}

static double at_u(uint32_t x) {
  return (x + 0.5) / SIZE;
}
static double at_v(uint32_t y) {
  return 1 - (y + 0.5) / SIZE;
}

typedef double Expected(void *user, double u, double v, int channel);

static void assert_shows(const char *what, Image *p, Expected *f, void *user,
                         double tolerance) {
  for (uint32_t y = 0; y < SIZE; y++)
    for (uint32_t x = 0; x < SIZE; x++)
      for (int c = 0; c < 3; c++) {
        double e = f(user, at_u(x), at_v(y), c), value = image_at(p, x, y, c);
        if (!(fabs(value - e) <= tolerance))
          fail_msg("%s: pixel (%u, %u) channel %d is %.6f, expected %.6f", what, x, y, c, value,
                   e);
      }
  image_free(p);
}

static double constant(void *user, double u, double v, int c) {
  (void)u;
  (void)v;
  (void)c;
  return *(double *)user;
}
static void assert_constant(const char *what, Image p, double value) {
  assert_shows(what, &p, constant, &value, 1e-5);
}

static vlTextureDef grey(vlTextureKind kind, double a, double b) {
  vlTextureDef def = vl_default_texture_def(kind, true);
  def.spectrum_a = vl_spectrum_input(vl_spectrum_constant((float)a));
  def.spectrum_b = vl_spectrum_input(vl_spectrum_constant((float)b));
  return def;
}

/* ---- nodes ------------------------------------------------------------------------------- */

static void constants_scale_and_mix(void **state) {
  (void)state;
  Stage s = stage();
  vlTextureDef def = grey(VL_TEXTURE_CONSTANT, 0.25, 0);
  assert_constant("constant", show(&s, add(&s, &def)), 0.25);
  s = stage();
  def = grey(VL_TEXTURE_SCALE, 0.5, 0);
  def.amount = vl_float_input(0.3f);
  assert_constant("scale", show(&s, add(&s, &def)), 0.15);
  const float amounts[3] = {0, 0.25f, 1};
  for (int i = 0; i < 3; i++) {
    s = stage();
    def = grey(VL_TEXTURE_MIX, 0.2, 0.8);
    def.amount = vl_float_input(amounts[i]);
    assert_constant("mix", show(&s, add(&s, &def)), 0.2 * (1 - amounts[i]) + 0.8 * amounts[i]);
  }
  s = stage();
  /* a float texture as the amount */
  vlTextureDef f = vl_default_texture_def(VL_TEXTURE_MIX, false);
  f.float_a = vl_float_input(0.1f);
  f.float_b = vl_float_input(0.9f);
  f.amount = vl_float_input(0.5f);
  def = grey(VL_TEXTURE_MIX, 0, 1);
  def.amount.texture = add(&s, &f);
  assert_constant("mix by a mixed amount", show(&s, add(&s, &def)), 0.5);
}

static double checks(void *user, double u, double v, int c) {
  const vlTextureDef *d = user;
  (void)c;
  return ((int)floor(u * d->su + d->du) + (int)floor(v * d->sv + d->dv)) & 1 ? 0.2 : 0.7;
}

static void checkerboard(void **state) {
  (void)state;
  Stage s = stage();
  vlTextureDef def = grey(VL_TEXTURE_CHECKERBOARD, 0.7, 0.2);
  def.su = 4;
  def.sv = 2;
  def.du = -8;
  def.dv = 0.5f;
  Image p = show(&s, add(&s, &def));
  assert_shows("checkerboard", &p, checks, &def, 1e-5);
  /* Three dimensions: cells of the world, moved by the texture's matrix; the plane z = -1 is
   * put in cell -1. */
  s = stage();
  vlTextureDef solid = grey(VL_TEXTURE_CHECKERBOARD, 0.7, 0.2);
  solid.dimension = 3;
  set_matrix(solid.texture_from_world, 2, 0, 0, 2, 0, 1, 0, 1.5, 0, 0, 1, 0.5);
  p = show(&s, add(&s, &solid));
  def.du = 1; /* u = (x + 1)/2: floor(2x + 2) = floor(4u); the odd layer of z adds one */
  assert_shows("solid checkerboard", &p, checks,
               &(vlTextureDef){.su = 4, .sv = 2, .du = 1, .dv = 0.5f}, 1e-5);
}

static double bilerp(void *user, double s, double t, int c) {
  (void)user;
  (void)c;
  return (1 - s) * (1 - t) * 0.1 + (1 - s) * t * 0.3 + s * (1 - t) * 0.5 + s * t * 0.9;
}

static void bilerp_and_direction_mix(void **state) {
  (void)state;
  Stage s = stage();
  vlTextureDef def = grey(VL_TEXTURE_BILERP, 0.1, 0.3); /* v00 v01 v10 v11 */
  def.spectrum_c = vl_spectrum_input(vl_spectrum_constant(0.5f));
  def.spectrum_d = vl_spectrum_input(vl_spectrum_constant(0.9f));
  Image p = show(&s, add(&s, &def));
  assert_shows("bilerp", &p, bilerp, NULL, 1e-5);
  const float directions[3][3] = {{0, 0, -1}, {1, 0, 0}, {0, 0.6f, 0.8f}};
  const double expected[3] = {0.9, 0.1, 0.74};
  for (int i = 0; i < 3; i++) {
    s = stage();
    def = grey(VL_TEXTURE_DIRECTION_MIX, 0.9, 0.1);
    memcpy(def.direction, directions[i], sizeof def.direction);
    assert_constant("direction mix", show(&s, add(&s, &def)), expected[i]);
  }
}

/* Nested as deep as is allowed: no level disturbs another. Deeper: one clear error. */
static void nesting(void **state) {
  (void)state;
  const vlTextureKind kinds[3] = {VL_TEXTURE_SCALE, VL_TEXTURE_MIX, VL_TEXTURE_BILERP};
  for (int k = 0; k < 3; k++)
    for (int deep = 1; deep < 40; deep += deep < 14 ? 1 : 25) {
      Stage s = stage();
      vlTextureDef leaf = grey(VL_TEXTURE_CONSTANT, 0.3, 0);
      vlTextureId id = add(&s, &leaf);
      for (int i = 0; i < deep; i++) {
        vlTextureDef def = grey(kinds[k], 0.3, 0.3);
        def.spectrum_c = def.spectrum_d = def.spectrum_a;
        def.amount = vl_float_input(kinds[k] == VL_TEXTURE_SCALE ? 1 : 0.5f);
        vlSpectrumInput *slot =
            kinds[k] == VL_TEXTURE_SCALE ? &def.spectrum_a : &def.spectrum_b;
        if (kinds[k] == VL_TEXTURE_BILERP)
          slot = &def.spectrum_d;
        slot->texture = id;
        id = add(&s, &def);
      }
      vlMaterialId material = add_textured(&s, id);
      Quad q = quad_at(0, 0, -1, 1, 0, 0, 0, 1, 0);
      q.material = material;
      add_quad(&s, &q);
      vlWorld *world = NULL;
      vlError error;
      vlResult r = vl_world_build(s.scene, &s.build, &world, &error);
      if (r == VL_OK) {
        vl_world_destroy(world);
        assert_true(deep < 20);
        Image p = stage_take(&s);
        double value = 0.3;
        assert_shows("nested textures", &p, constant, &value, 1e-5);
      } else {
        assert_int_equal(r, VL_ERROR_SCENE);
        assert_non_null(strstr(error.message, "nested"));
        assert_true(deep > 5);
      }
      stage_close(&s);
    }
}

/* A texture that names the one before twice, many times over, would be evaluated 2^n times:
 * refused, at once. */
static void doubling_is_refused(void **state) {
  (void)state;
  Stage s = stage();
  vlTextureDef leaf = vl_default_texture_def(VL_TEXTURE_CONSTANT, false);
  vlTextureId id = add(&s, &leaf);
  for (int i = 0; i < 28; i++) {
    vlTextureDef def = vl_default_texture_def(VL_TEXTURE_SCALE, false);
    def.float_a.texture = def.amount.texture = id;
    id = add(&s, &def);
  }
  vlTextureDef def = grey(VL_TEXTURE_SCALE, 1, 0);
  def.amount.texture = id;
  Quad q = quad_at(0, 0, -1, 1, 0, 0, 0, 1, 0);
  q.material = add_textured(&s, add(&s, &def));
  add_quad(&s, &q);
  vlWorld *world = NULL;
  vlError error;
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "nested"));
  stage_close(&s);
}

/* ---- images ------------------------------------------------------------------------------ */

/* 4 x 2 texels, told apart by their red and green; rows from the top. */
static const float texels[24] = {0.1f, 0.1f, 0.5f, 0.3f, 0.1f, 0.5f, 0.5f, 0.1f,
                                 0.5f, 0.7f, 0.1f, 0.5f, 0.1f, 0.9f, 0.5f, 0.3f,
                                 0.9f, 0.5f, 0.5f, 0.9f, 0.5f, 0.7f, 0.9f, 0.5f};

typedef struct Lookup {
  vlTextureDef def;
  bool bilinear;
} Lookup;

static double texel(int x, int y, vlWrap wrap, int c) {
  if (wrap == VL_WRAP_BLACK && (x < 0 || y < 0 || x > 3 || y > 1))
    return 0;
  if (wrap == VL_WRAP_REPEAT) {
    x = x & 3;
    y = y & 1;
  }
  x = x < 0 ? 0 : x > 3 ? 3 : x;
  y = y < 0 ? 0 : y > 1 ? 1 : y;
  return texels[3 * (4 * y + x) + c];
}

static double image_texture(void *user, double u, double v, int c) {
  const Lookup *l = user;
  const vlTextureDef *d = &l->def;
  double x = 4 * (d->su * u + d->du), y = 2 * (1 - (d->sv * v + d->dv)), value;
  if (!l->bilinear) {
    value = texel((int)floor(x), (int)floor(y), d->wrap, c);
  } else {
    int xi = (int)floor(x - 0.5), yi = (int)floor(y - 0.5);
    double fx = x - 0.5 - xi, fy = y - 0.5 - yi;
    value = (1 - fx) * (1 - fy) * texel(xi, yi, d->wrap, c) +
            fx * (1 - fy) * texel(xi + 1, yi, d->wrap, c) +
            (1 - fx) * fy * texel(xi, yi + 1, d->wrap, c) +
            fx * fy * texel(xi + 1, yi + 1, d->wrap, c);
  }
  value *= d->scale;
  if (d->invert)
    value = 1 - value;
  return value < 0 ? 0 : value > 1 ? 1 : value;
}

static void image_orientation_wrap_filter(void **state) {
  (void)state;
  for (int i = 0; i < 9; i++) {
    Stage s = stage();
    vlImage *image = make_image(&s, 4, 2, texels);
    Lookup l = {vl_default_texture_def(VL_TEXTURE_IMAGE, true), i >= 1};
    l.def.image = image;
    l.def.filter = i == 0 ? VL_FILTER_POINT : i == 8 ? VL_FILTER_TRILINEAR : VL_FILTER_BILINEAR;
    if (i >= 2 && i <= 4) {
      l.def.wrap = (vlWrap[3]){VL_WRAP_REPEAT, VL_WRAP_BLACK, VL_WRAP_CLAMP}[i - 2];
      l.def.su = 2;
      l.def.sv = 3;
      l.def.du = -0.6f;
      l.def.dv = -1.1f;
    }
    if (i == 5)
      l.def.invert = true;
    if (i == 6)
      l.def.scale = 0.5f;
    if (i == 7) {
      l.def.invert = true;
      l.def.scale = 1.3f;
    }
    vlTextureId id = add(&s, &l.def);
    vl_image_destroy(image);
    Image p = show(&s, id);
    char what[32];
    snprintf(what, sizeof what, "image, case %d", i);
    assert_shows(what, &p, image_texture, &l, 2e-3);
  }
}

/* 8-bit images from files are sRGB unless an encoding is given; float images are linear. Grey,
 * colour and coverage are read as floats. */
static void encodings_and_floats(void **state) {
  (void)state;
  char path[600];
  snprintf(path, sizeof path, "%s/test_textures.png", VELO_BINARY_DIR);
  double x = 128.0 / 255, srgb = pow((x + 0.055) / 1.055, 2.4);
  const double decoded[4] = {srgb, x, pow(x, 2.2), srgb};
  for (int channels = 1; channels <= 4; channels++)
    for (int e = 0; e < 4; e++)
      for (int as_float = 0; as_float < 2; as_float++) {
        Stage s = stage();
        vlImageDef image_def = vl_default_image_def(2, 2, (uint32_t)channels);
        image_def.type = VL_PIXEL_U8;
        image_def.encoding = VL_ENCODING_SRGB;
        vlImage *image = NULL;
        assert_int_equal(vl_image_create(s.context, &image_def, &image), VL_OK);
        for (int i = 0; i < 4; i++)
          for (int c = 0; c < channels; c++)
            ((uint8_t *)vl_image_pixels(image))[i * channels + c] =
                channels == 4 && c == 3 ? 51 : 128;
        if (channels == 2) {
          vl_image_destroy(image);
          stage_close(&s);
          continue;
        }
        assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
        vl_image_destroy(image);
        vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, !as_float);
        def.path = path;
        def.encoding_given = e > 0;
        def.encoding = (vlEncoding[4]){VL_ENCODING_LINEAR, VL_ENCODING_LINEAR,
                                       VL_ENCODING_GAMMA, VL_ENCODING_SRGB}[e];
        def.gamma = 2.2f;
        vlTextureId id = add(&s, &def);
        double value = decoded[e];
        if (as_float) { /* as the factor of white: four channels give their coverage, which no
                           curve touches */
          vlTextureDef scale = grey(VL_TEXTURE_SCALE, 1, 0);
          scale.amount.texture = id;
          id = add(&s, &scale);
          if (channels == 4)
            value = 0.2;
        }
        Image p = show(&s, id);
        char what[64];
        snprintf(what, sizeof what, "%d channels, encoding %d, %s", channels, e,
                 as_float ? "float" : "colour");
        assert_shows(what, &p, constant, &value, 1e-4);
      }
  remove(path);
}

/* ---- mappings: an image whose red is s and whose green is t ------------------------------ */

static void mappings(void **state) {
  (void)state;
  enum { N = 64 };
  static float ramp[N * N * 3];
  for (int y = 0; y < N; y++)
    for (int x = 0; x < N; x++) {
      float *c = ramp + 3 * (y * N + x);
      c[0] = ((float)x + 0.5f) / N;
      c[1] = 1 - ((float)y + 0.5f) / N;
      c[2] = 0.5f;
    }
  for (int kind = 0; kind < 3; kind++) {
    Stage s = stage();
    vlImage *image = make_image(&s, N, N, ramp);
    vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    def.image = image;
    def.mapping =
        (vlMapping[3]){VL_MAPPING_SPHERICAL, VL_MAPPING_CYLINDRICAL, VL_MAPPING_PLANAR}[kind];
    /* the square's points are (x, y, -1): put them round (0.05, 0.02, 0.4) of the texture */
    set_matrix(def.texture_from_world, 1, 0, 0, 0.05, 0, 1, 0, 0.02, 0, 0, 1, 1.4);
    def.planar_v1[0] = 0.3f;
    def.planar_v1[1] = 0.1f;
    def.planar_v2[0] = 0;
    def.planar_v2[1] = 0.4f;
    def.du = 0.5f;
    def.dv = 0.45f;
    vlTextureId id = add(&s, &def);
    vl_image_destroy(image);
    Image p = show(&s, id);
    int compared = 0;
    for (uint32_t y = 0; y < SIZE; y++)
      for (uint32_t x = 0; x < SIZE; x++) {
        double q[3] = {2 * at_u(x) - 1 + 0.05, 2 * at_v(y) - 1 + 0.02, 0.4}, st[2] = {0, 0};
        double r = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]), phi = atan2(q[1], q[0]);
        if (kind == 0) {
          st[0] = acos(q[2] / r) / M_PI;
          st[1] = (phi < 0 ? phi + 2 * M_PI : phi) / (2 * M_PI);
        }
        if (kind == 1) {
          st[0] = (M_PI + phi) / (2 * M_PI);
          st[1] = q[2];
        }
        if (kind == 2) {
          st[0] = 0.5 + 0.3 * q[0] + 0.1 * q[1];
          st[1] = 0.45 + 0.4 * q[1];
        }
        if (st[0] < 0.02 || st[0] > 0.98 || st[1] < 0.02 || st[1] > 0.98)
          continue; /* the ramp's seam */
        compared++;
        assert_near("mapping, s", image_at(&p, x, y, 0), st[0], 5e-3);
        assert_near("mapping, t", image_at(&p, x, y, 1), st[1], 5e-3);
      }
    assert_true(compared > 600);
    image_free(&p);
  }
  /* One turn of the cylinder is one cell of a checkerboard, without a seam at y = 0. */
  Stage s = stage();
  vlTextureDef def = grey(VL_TEXTURE_CHECKERBOARD, 0.7, 0.2);
  def.mapping = VL_MAPPING_CYLINDRICAL;
  /* z = -1: an odd row */
  assert_constant("checks on a cylinder", show(&s, add(&s, &def)), 0.2);
}

/* Colours: reflectances of the two modes agree, and a texture in spectral mode shows the colour
 * that was meant. */
static void spectral_mode_shows_the_same_colours(void **state) {
  (void)state;
  double mean[2][3];
  for (int mode = 0; mode < 2; mode++) {
    Stage s = stage();
    s.build.color = mode ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
    s.render.spp = 64;
    s.render.sampler = VL_SAMPLER_ZSOBOL;
    vlImage *image = make_image(&s, 4, 2, texels);
    vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    def.image = image;
    vlTextureId id = add(&s, &def);
    vl_image_destroy(image);
    Image p = show(&s, id);
    for (int c = 0; c < 3; c++)
      mean[mode][c] = image_mean(&p, c);
    image_free(&p);
  }
  for (int c = 0; c < 3; c++)
    assert_ratio("mean of a coloured texture", mean[0][c], mean[1][c], 5e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(constants_scale_and_mix),
      cmocka_unit_test(checkerboard),
      cmocka_unit_test(bilerp_and_direction_mix),
      cmocka_unit_test(nesting),
      cmocka_unit_test(doubling_is_refused),
      cmocka_unit_test(image_orientation_wrap_filter),
      cmocka_unit_test(encodings_and_floats),
      cmocka_unit_test(mappings),
      cmocka_unit_test(spectral_mode_shows_the_same_colours),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
