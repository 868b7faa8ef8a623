/* test/render/test_feature_samples.c: features of denoisers are means over few samples where
 * all agree, over more where they vary; what passes late in the exposure is seen; the values
 * depend neither on the number of threads, which decides on the regions that workers take, nor
 * on the instruction set. */
#include "render/ground_truths.h"
#include "velo/own.h"

enum { W = 150, H = 140, FIRST = 4, ALL = 8, SPP = 16, BORDER = 2 };

/* How many camera samples of each pixel were made with indices from FIRST on. */
typedef struct Later {
  uint32_t count[H][W];
} Later;

/* Numbers of a hash. Counts film points. One thread calls it. */
static void numbers(void *user, const vlOwnSamples *s) {
  Later *later = user;
  for (uint32_t i = 0; i < s->count; i++) {
    uint32_t h = (uint32_t)s->x[i] * 0x9e3779b1u ^ (uint32_t)s->y[i] * 0x85ebca6bu ^
                 s->index[i] * 0xc2b2ae35u ^ s->dimension * 0x27d4eb2fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    h ^= h >> 15;
    s->u[i] = (float)(h >> 16) * 0x1p-16f;
    if (s->v)
      s->v[i] = (float)(h & 0xffff) * 0x1p-16f;
    bool inside = s->x[i] >= 0 && s->y[i] >= 0 && s->x[i] < W && s->y[i] < H;
    if (inside && s->dimension == 0 && s->index[i] >= FIRST)
      later->count[s->y[i]][s->x[i]]++;
  }
}

static Stage open_on(uint32_t threads) {
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  def.threads = threads;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  Stage s = stage_open_in(context, W, H);
  s.film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  s.render.spp = SPP;
  s.render.max_depth = 0;
  return s;
}

static GroundTruth features_of(Stage *s, Later *later) {
  GroundTruth t = ground_truth_begin(s);
  vlError error = {0};
  const vlOwnSampler own = {"hash", numbers, later};
  s->render.own_sampler = later ? &own : NULL;
  assert_int_equal(vl_film_create(s->context, &s->film, &t.film), VL_OK);
  if (vl_render(t.world, &t.camera, t.film, &s->render, NULL, &error) != VL_OK)
    fail_msg("render: %s", error.message);
  if (later)
    memset(later, 0, sizeof *later);
  vlChannelsDef def = vl_default_channels_def(W, H);
  def.channels = VL_CHANNEL_FEATURES;
  memcpy(def.crop, s->film.crop, sizeof def.crop);
  def.film = t.film;
  def.render = &s->render;
  ground_truth_channels(&t, &def);
  s->render.own_sampler = NULL;
  return t;
}

/* A wall; its left part has another colour. */
static void add_walls(Stage *s) {
  Quad left = quad_at(-20.1f, 0, -5, 20, 0, 0, 0, 40, 0),
       right = quad_at(19.9f, 0, -5, 20, 0, 0, 0, 40, 0);
  left.material = add_diffuse(s, 0.8f, 0.2f, 0.2f);
  right.material = add_diffuse(s, 0.2f, 0.8f, 0.2f);
  add_quad(s, &left);
  add_quad(s, &right);
}

/* Away from the edge four samples are traced, in pixels that count a sample of it all. */
static void test_where_they_vary(void **state) {
  (void)state;
  Stage s = open_on(1);
  add_walls(&s);
  Later *later = calloc(1, sizeof *later);
  assert_non_null(later);
  GroundTruth t = features_of(&s, later);
  uint32_t edge = W; /* the column with both colours, in the middle row */
  for (uint32_t x = 0; x < W && edge == W; x++)
    if (number(&t, x, H / 2, "feature.albedo.R") < 0.79f)
      edge = x + 1;
  assert_true(edge > 40 && edge < W - 40);
  for (uint32_t y = 0; y < H; y++)
    for (uint32_t x = 0; x < W; x++) {
      const uint32_t away = x > edge ? x - edge : edge - x;
      if (away > 2 * BORDER + 3 && later->count[y][x] != 0)
        fail_msg("pixel %u, %u: %u later samples", x, y, later->count[y][x]);
      if (away <= 1 && later->count[y][x] < ALL - FIRST)
        fail_msg("pixel %u, %u at the edge: %u later samples", x, y, later->count[y][x]);
    }
  free(later);
  ground_truth_free(&t);
  stage_close(&s);
}

/* A worker of few takes squares of 64 x 64 pixels, one of many 32 x 32; a crop has the values
 * of the whole image. */
static void test_same_bits(void **state) {
  (void)state;
  Stage s = open_on(1);
  add_walls(&s);
  GroundTruth whole = features_of(&s, NULL);
  static const uint32_t threads[] = {2, 5, 16};
  for (size_t k = 0; k < sizeof threads / sizeof *threads; k++) {
    Stage other = open_on(threads[k]);
    add_walls(&other);
    GroundTruth t = features_of(&other, NULL);
    same_bits(whole.floats, t.floats, 0, 0);
    ground_truth_free(&t);
    stage_close(&other);
  }
  const uint32_t crop[4] = {37, 21, 141, 132};
  memcpy(s.film.crop, crop, sizeof crop);
  GroundTruth part = features_of(&s, NULL);
  same_bits(whole.floats, part.floats, crop[0], crop[1]);
  ground_truth_free(&part);
  ground_truth_free(&whole);
  stage_close(&s);
}

/* A square comes before the camera at 0.82 of the exposure. Of the eight samples' times only
 * 7/8 is later, that of the seventh. */
static void test_late_motion(void **state) {
  (void)state;
  Stage s = open_on(2);
  vlGroupId group = vl_scene_add_group(s.scene, "square");
  Quad square = quad_at(0, 0, -5, 2, 0, 0, 0, 2, 0);
  square.material = add_diffuse(&s, 0.8f, 0.8f, 0.8f);
  square.group = group;
  add_quad(&s, &square);
  const double times[4] = {0, 0.8, 0.82, 1};
  double poses[64];
  for (int k = 0; k < 4; k++)
    set_matrix(poses + 16 * k, 1, 0, 0, k < 2 ? 100 : 0, 0, 1, 0, 0, 0, 0, 1, 0);
  vl_scene_add_moving_instance(s.scene, group, 4, times, poses, (vlSource){0});
  s.camera.shutter_open = 0;
  s.camera.shutter_close = 1;
  GroundTruth t = features_of(&s, NULL);
  assert_near("albedo", number(&t, W / 2, H / 2, "feature.albedo.R"), 0.8 / ALL, 0.04);
  ground_truth_free(&t);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_where_they_vary),
                                     cmocka_unit_test(test_same_bits),
                                     cmocka_unit_test(test_late_motion)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
