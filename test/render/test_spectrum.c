/* test/render/test_spectrum.c: spectra of known light: a bucket's mean is that of the spectrum
 * over its wavelengths, also after reflection; glass without dispersion loses nothing; the
 * colours beside the buckets are those of the same light; any number of threads and any crop
 * give the same bytes. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"

enum { SIZE = 8, BUCKETS = 12 };

typedef struct Spectrum {
  double mean[BUCKETS], error[BUCKETS]; /* of the pixels, and of that mean */
  Image image;
  float *pixels;
} Spectrum;

static Spectrum take(Stage *s) {
  Spectrum r;
  memset(&r, 0, sizeof r);
  vlError error = {0};
  vlWorld *world;
  vlCamera camera;
  vlFilm *film;
  vlImage *image, *colors;
  if (vl_world_build(s->scene, &s->build, &world, &error) != VL_OK)
    fail_msg("build: %s", error.message);
  assert_int_equal(vl_camera_make(&s->camera, &camera, NULL, &error), VL_OK);
  assert_int_equal(vl_film_create(s->context, &s->film, &film), VL_OK);
  if (vl_render(world, &camera, film, &s->render, &r.image.stats, &error) != VL_OK)
    fail_msg("render: %s", error.message);
  assert_int_equal(vl_film_spectrum(film, &image), VL_OK);
  assert_int_equal(vl_film_develop(film, NULL, &colors), VL_OK);
  uint32_t w = vl_image_width(image), h = vl_image_height(image);
  r.image.width = w;
  r.image.height = h;
  r.pixels = malloc((size_t)w * h * BUCKETS * sizeof(float));
  r.image.rgba = malloc((size_t)w * h * 4 * sizeof(float));
  memcpy(r.pixels, vl_image_const_pixels(image), (size_t)w * h * BUCKETS * sizeof(float));
  memcpy(r.image.rgba, vl_image_const_pixels(colors), (size_t)w * h * 4 * sizeof(float));
  for (int k = 0; k < BUCKETS; k++) {
    double sum = 0, squares = 0, n = (double)w * h;
    for (size_t i = 0; i < (size_t)w * h; i++)
      sum += r.pixels[i * BUCKETS + k];
    r.mean[k] = sum / n;
    for (size_t i = 0; i < (size_t)w * h; i++)
      squares += pow(r.pixels[i * BUCKETS + k] - r.mean[k], 2);
    r.error[k] = sqrt(squares / n / (n - 1));
  }
  vl_image_destroy(image);
  vl_image_destroy(colors);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(s);
  return r;
}
static void release(Spectrum *s) {
  free(s->pixels);
  image_free(&s->image);
}

static Stage stage(double low, double high) {
  Stage s = stage_open(SIZE, SIZE);
  s.film.buckets = BUCKETS;
  s.film.lambda_min = low;
  s.film.lambda_max = high;
  s.render.sampler = VL_SAMPLER_INDEPENDENT;
  s.render.spp = 512;
  return s;
}

/* Known by hand: linear between its points, 0 outside. */
static const float nm[4] = {420, 500, 560, 680}, light[4] = {0.2f, 2, 1, 3};
static double value_at(const float values[4], double x) {
  for (int i = 0; i < 3; i++)
    if (x >= nm[i] && x <= nm[i + 1])
      return values[i] + (values[i + 1] - values[i]) * (x - nm[i]) / (nm[i + 1] - nm[i]);
  return 0;
}
/* Mean of light, times reflectance where there is one, over the bucket. */
static double expected(double low, double high, int k, const float reflectance[4]) {
  enum { STEPS = 4000 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) {
    double x = low + (high - low) * (k + (i + 0.5) / STEPS) / BUCKETS;
    sum += value_at(light, x) * (reflectance ? value_at(reflectance, x) : 1);
  }
  return sum / STEPS;
}
static vlSpectrum sampled(const float values[4]) {
  vlSpectrum s = vl_spectrum_constant(1);
  s.kind = VL_SPECTRUM_SAMPLED;
  s.count = 4;
  s.wavelengths = nm;
  s.values = values;
  return s;
}
/* Lights are divided by their luminance, so that the scale is known: 106.86 over the integral
 * of Y times the light. */
static double light_scale(void) {
  double y = 0;
  static const struct {
    double nm, y;
  } eye[] = {{420, 0.0040}, {430, 0.0116}, {440, 0.0230}, {450, 0.0380}, {460, 0.0600},
             {470, 0.0910}, {480, 0.1390}, {490, 0.2080}, {500, 0.3230}, {510, 0.5030},
             {520, 0.7100}, {530, 0.8620}, {540, 0.9540}, {550, 0.9950}, {560, 0.9950},
             {570, 0.9520}, {580, 0.8700}, {590, 0.7570}, {600, 0.6310}, {610, 0.5030},
             {620, 0.3810}, {630, 0.2650}, {640, 0.1750}, {650, 0.1070}, {660, 0.0610},
             {670, 0.0320}, {680, 0.0170}};
  for (size_t i = 0; i < sizeof eye / sizeof *eye; i++)
    y += 10 * eye[i].y * value_at(light, eye[i].nm);
  return 106.857 / y;
}

static void emitter(void **state) {
  (void)state;
  const double ranges[2][2] = {{360, 830}, {430, 670}};
  for (int i = 0; i < 2; i++) {
    Stage s = stage(ranges[i][0], ranges[i][1]);
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    def.color = sampled(light);
    vl_scene_add_light(s.scene, &def);
    double scale = light_scale();
    Spectrum r = take(&s);
    for (int k = 0; k < BUCKETS; k++) {
      double e = scale * expected(ranges[i][0], ranges[i][1], k, NULL);
      /* the table of Y has three digits */
      if (!(fabs(r.mean[k] - e) <= 4.5 * r.error[k] + 4e-3 * e))
        fail_msg("bucket %d: %g, expected %g, standard error %g", k, r.mean[k], e, r.error[k]);
    }
    release(&r);
  }
}

static void reflected(void **state) {
  (void)state;
  static const float paint[4] = {0.9f, 0.1f, 0.5f, 0.8f};
  Stage s = stage(420, 680);
  s.render.max_depth = 1;
  vlLightDef def = vl_default_light_def(VL_LIGHT_DISTANT);
  def.color = sampled(light);
  def.from[2] = 1;
  def.to[2] = 0;
  vl_scene_add_light(s.scene, &def);
  vlMaterialDef matte = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  matte.reflectance = vl_spectrum_input(sampled(paint));
  Quad q = quad_at(0, 0, -1, 5, 0, 0, 0, 5, 0);
  q.material = vl_scene_add_material(s.scene, &matte);
  add_quad(&s, &q);
  double scale = light_scale() / M_PI;
  Spectrum r = take(&s);
  for (int k = 0; k < BUCKETS; k++) {
    double e = scale * expected(420, 680, k, paint);
    if (!(fabs(r.mean[k] - e) <= 4.5 * r.error[k] + 4e-3 * e))
      fail_msg("bucket %d: %g, expected %g, standard error %g", k, r.mean[k], e, r.error[k]);
  }
  release(&r);
}

/* Inside light of a constant spectrum from everywhere a ball of glass that disperses cannot be
 * seen: each bucket is 1 (paths that end after many bounces lack a little). */
static void dispersing_furnace(void **state) {
  (void)state;
  Stage s = stage(400, 700);
  s.render.max_depth = 64;
  s.render.spp = 256;
  s.camera.fov = 0.5;
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  def.color = vl_spectrum_constant(7);
  vl_scene_add_light(s.scene, &def);
  vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
  glass.eta = vl_spectrum_input(vl_spectrum_named("glass-LASF9"));
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(ball.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3);
  ball.material = vl_scene_add_material(s.scene, &glass);
  vl_scene_add_shape(s.scene, &ball);
  Spectrum r = take(&s);
  for (int k = 0; k < BUCKETS; k++)
    if (!(fabs(r.mean[k] - 1) <= 4.5 * r.error[k] + 1e-3))
      fail_msg("bucket %d: %g instead of 1, standard error %g", k, r.mean[k], r.error[k]);
  release(&r);
}

/* Where all samples of a bucket are alike it holds just that; the colours agree with those of
 * an ordinary film. */
static void constant_and_colors(void **state) {
  (void)state;
  double mean[2][3];
  for (int with = 0; with < 2; with++) {
    Stage s = stage(360, 830);
    s.render.spp = 4096;
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    def.color = vl_spectrum_constant(5);
    def.scale = 2;
    vl_scene_add_light(s.scene, &def);
    if (!with) {
      s.film.buckets = 0;
      Image p = stage_finish(&s);
      for (int c = 0; c < 3; c++)
        mean[0][c] = image_mean(&p, c);
      image_free(&p);
      continue;
    }
    Spectrum r = take(&s);
    for (int i = 0; i < SIZE * SIZE * BUCKETS; i++)
      assert_near("constant light", r.pixels[i], 2, 2e-5);
    for (int c = 0; c < 3; c++)
      mean[1][c] = image_mean(&r.image, c);
    release(&r);
  }
  for (int c = 0; c < 3; c++)
    assert_ratio("colours beside the spectrum", mean[1][c], mean[0][c], 0.01);
}

static void same_bytes(void **state) {
  (void)state;
  Spectrum r[2];
  for (int i = 0; i < 2; i++) {
    Stage s = stage_open(40, 24);
    s.film.buckets = BUCKETS;
    s.render.spp = 5;
    if (i) {
      s.film.crop[0] = 9;
      s.film.crop[1] = 5;
      s.film.crop[2] = 31;
      s.film.crop[3] = 20;
    }
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    def.color = sampled(light);
    vl_scene_add_light(s.scene, &def);
    Quad q = quad_at(0, -1, -2, 3, 0, 0, 0, 0, 3);
    q.material = add_diffuse(&s, 0.5f, 0.2f, 0.1f);
    add_quad(&s, &q);
    r[i] = take(&s);
  }
  for (uint32_t y = 5; y < 20; y++)
    assert_memory_equal(r[0].pixels + (y * 40 + 9) * BUCKETS,
                        r[1].pixels + (y - 5) * 22 * BUCKETS, 22 * BUCKETS * sizeof(float));
  release(&r[0]);
  release(&r[1]);
}

static void not_in_rgb(void **state) {
  (void)state;
  Stage s = stage(400, 700);
  s.build.color = VL_COLOR_RGB;
  add_sky(&s, 1);
  vlError error;
  vlWorld *world;
  vlCamera camera;
  vlFilm *film;
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
  assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, &error), VL_ERROR_ARGUMENT);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(emitter),
                                     cmocka_unit_test(reflected),
                                     cmocka_unit_test(dispersing_furnace),
                                     cmocka_unit_test(constant_and_colors),
                                     cmocka_unit_test(same_bytes),
                                     cmocka_unit_test(not_in_rgb)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
