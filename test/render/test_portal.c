/* test/render/test_portal.c: portals: a portal over a room's only window gives the same image
 * as without it, with every tracer, with less noise. Behind a portal and beside it there is no
 * light. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/tracer.h"

enum { SIZE = 16, SEEDS = 20, BLOCKS = 4, SKY = 32, PLAIN_SPP = 128, PORTAL_SPP = 32 };

/* Walls at -1 and 1; a window in the ceiling (y = 1): |x - 0.2| < 0.4, |z| < 0.3. */
static void add_room(Stage *s) {
  vlMaterialId grey = add_diffuse(s, 0.6f, 0.5f, 0.4f);
  const float walls[5][9] = {{0, -1, 0, 1, 0, 0, 0, 0, 1},
                             {-1, 0, 0, 0, 1, 0, 0, 0, 1},
                             {1, 0, 0, 0, 1, 0, 0, 0, 1},
                             {0, 0, -1, 1, 0, 0, 0, 1, 0},
                             {0, 0, 1, 1, 0, 0, 0, 1, 0}};
  const float ceiling[4][4] = {{-0.6f, 0, 0.4f, 1},
                               {0.8f, 0, 0.2f, 1},
                               {0.2f, 0.65f, 0.4f, 0.35f},
                               {0.2f, -0.65f, 0.4f, 0.35f}}; /* middle x, z and half sides */
  for (int i = 0; i < 9; i++) {
    const float *w = walls[i < 5 ? i : 0], *c = ceiling[i < 5 ? 0 : i - 5];
    Quad q = i < 5 ? quad_at(w[0], w[1], w[2], w[3], w[4], w[5], w[6], w[7], w[8])
                   : quad_at(c[0], 1, c[1], c[2], 0, 0, 0, 0, c[3]);
    q.material = grey;
    add_quad(s, &q);
  }
}

static void add_imaged_sky(Stage *s, bool portal) {
  float sky[SKY * SKY * 3];
  for (int i = 0; i < SKY * SKY; i++)
    for (int c = 0; c < 3; c++)
      sky[3 * i + c] = i % 5 == 0 ? 0.0f : 0.5f + 0.4f * (float)((i * (c + 3)) % 7);
  for (int c = 0; c < 3; c++)
    sky[3 * (SKY * (SKY / 2 + 2) + SKY / 2 + 3) + c] = 300; /* a sun, high up */
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  vlImage *image = make_image(s, SKY, SKY, sky);
  def.image = image;
  /* its zenith is the world's y */
  set_matrix(def.world_from_light, 1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0);
  /* (last - first) x (second - first) = z x x = y */
  const float corners[4][3] = {
      {-0.2f, 1, -0.3f}, {0.6f, 1, -0.3f}, {0.6f, 1, 0.3f}, {-0.2f, 1, 0.3f}};
  def.has_portal = portal;
  memcpy(def.portal, corners, sizeof corners);
  assert_int_not_equal(vl_scene_add_light(s->scene, &def).index, 0);
  vl_image_destroy(image);
}

static Image room(vlTracer tracer, bool portal, uint32_t seed, uint32_t spp) {
  Stage s = stage_open(SIZE, SIZE);
  s.camera.eye[2] = 0.95;
  s.camera.eye[1] = -0.3;
  s.camera.lookat[1] = 0.1;
  s.camera.fov = 1.4;
  s.render.tracer = tracer;
  s.render.max_depth = 3;
  s.render.sampler = VL_SAMPLER_INDEPENDENT;
  s.render.seed = seed;
  s.render.spp = spp;
  add_room(&s);
  add_imaged_sky(&s, portal);
  return stage_finish(&s);
}

typedef struct Blocks {
  double mean[BLOCKS * BLOCKS], variance[BLOCKS * BLOCKS]; /* of the mean */
} Blocks;

static Blocks measure(vlTracer tracer, bool portal, uint32_t spp) {
  Blocks b;
  memset(&b, 0, sizeof b);
  double sum[BLOCKS * BLOCKS] = {0}, squares[BLOCKS * BLOCKS] = {0};
  for (uint32_t seed = 1; seed <= SEEDS; seed++) {
    Image p = room(tracer, portal, 200 * (uint32_t)tracer + seed + (portal ? 100 : 0), spp);
    for (uint32_t k = 0; k < BLOCKS * BLOCKS; k++) {
      uint32_t x = k % BLOCKS * (SIZE / BLOCKS), y = k / BLOCKS * (SIZE / BLOCKS);
      double v = image_region(&p, x, y, x + SIZE / BLOCKS, y + SIZE / BLOCKS, 1);
      sum[k] += v;
      squares[k] += v * v;
    }
    image_free(&p);
  }
  for (int k = 0; k < BLOCKS * BLOCKS; k++) {
    b.mean[k] = sum[k] / SEEDS;
    b.variance[k] = (squares[k] / SEEDS - b.mean[k] * b.mean[k]) / (SEEDS - 1);
  }
  return b;
}

/* z of each block, and of all together. Student's t with 38 degrees of freedom: |t| > 4.5 by
 * chance 6e-5. */
static void compare(const char *what, const Blocks *a, const Blocks *b) {
  double difference = 0, variance = 0, total = 0;
  for (int k = 0; k < BLOCKS * BLOCKS; k++) {
    double v = a->variance[k] + b->variance[k], z = (a->mean[k] - b->mean[k]) / sqrt(v);
    if (!(fabs(z) < 4.5))
      fail_msg("%s: block %d: %g against %g, z = %g", what, k, a->mean[k], b->mean[k], z);
    difference += a->mean[k] - b->mean[k];
    variance += v;
    total += a->mean[k];
  }
  assert_near(what, difference / sqrt(variance), 0, 4);
  if (!(sqrt(variance) < 0.03 * total))
    fail_msg("%s: too noisy to tell: %g", what, sqrt(variance) / total);
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void room_with_and_without(void **state) {
  (void)state;
  Blocks plain = measure(VL_TRACER_PATH, false, PLAIN_SPP),
         portal = measure(VL_TRACER_PATH, true, PORTAL_SPP);
  compare("path tracing", &plain, &portal);
  /* The variance of a sample, block by block: rare bright samples rule the sum over all. */
  double ratio[BLOCKS * BLOCKS];
  for (int k = 0; k < BLOCKS * BLOCKS; k++)
    ratio[k] = PORTAL_SPP * portal.variance[k] / (PLAIN_SPP * plain.variance[k]);
  qsort(ratio, BLOCKS * BLOCKS, sizeof *ratio, ascending);
  double median = ratio[BLOCKS * BLOCKS / 2];
  if (!(median < 0.5))
    fail_msg("a portal must help: median ratio of the variances %g", median);
  const vlTracer tracers[] = {VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL};
  for (int i = 0; i < 2; i++) {
    Blocks other = measure(tracers[i], true, PORTAL_SPP);
    compare(i ? "bidirectional" : "volpath", &plain, &other);
  }
}

/* Seen straight: the sky's own texels inside the frame, black outside, and black from the other
 * side. */
static void seen_from_both_sides(void **state) {
  (void)state;
  for (int side = 0; side < 3; side++) {
    Image p[2];
    for (int portal = 0; portal < 2; portal++) {
      Stage s = stage_open(32, 32);
      s.camera.eye[0] = 0.2;
      s.camera.eye[1] = side == 2 ? 1.5 : 0.5;
      s.camera.lookat[0] = 0.2;
      s.camera.lookat[1] = side == 1 ? -5 : 5;
      s.camera.lookat[2] = 0;
      s.camera.up[0] = s.camera.up[1] = 0;
      s.camera.up[2] = 1;
      s.render.sampler = VL_SAMPLER_REGULAR;
      s.render.spp = 1;
      s.build.color = VL_COLOR_RGB;
      add_imaged_sky(&s, portal);
      p[portal] = stage_finish(&s);
    }
    for (uint32_t y = 0; y < 32; y++)
      for (uint32_t x = 0; x < 32; x++) { /* 90 degrees: at distance 0.5 the image is 1 wide */
        double px = fabs((x + 0.5) / 32 - 0.5), py = fabs((y + 0.5) / 32 - 0.5);
        bool inside = side == 0 && px < 0.4 && py < 0.3;
        assert_near("sky in a portal", image_at(&p[1], x, y, 1),
                    inside ? image_at(&p[0], x, y, 1) : 0, 1e-6);
      }
    image_free(&p[0]);
    image_free(&p[1]);
  }
}

/* Light through a portal on a floor below, against the integral over the window. */
static void floor_under_a_portal(void **state) {
  (void)state;
  Stage s = stage_open(8, 8);
  s.camera.eye[0] = 0.2;
  s.camera.lookat[0] = 0.2;
  s.camera.lookat[1] = -1;
  s.camera.lookat[2] = 0;
  s.camera.up[1] = 0;
  s.camera.up[2] = 1;
  s.camera.fov = 0.01;
  s.build.color = VL_COLOR_RGB;
  s.render.max_depth = 1;
  s.render.spp = 1024;
  Quad q = quad_at(0, -1, 0, 5, 0, 0, 0, 0, 5);
  q.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
  add_quad(&s, &q);
  float sky[3 * 16];
  for (int i = 0; i < 48; i++)
    sky[i] = 3; /* the same from everywhere */
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  vlImage *image = make_image(&s, 4, 4, sky);
  def.image = image;
  def.has_portal = true;
  const float corners[4][3] = {
      {-0.2f, 1, -0.3f}, {0.6f, 1, -0.3f}, {0.6f, 1, 0.3f}, {-0.2f, 1, 0.3f}};
  memcpy(def.portal, corners, sizeof corners);
  vl_scene_add_light(s.scene, &def);
  vl_image_destroy(image);
  Image p = stage_finish(&s);
  double sum = 0;
  for (int i = 0; i < 200; i++)
    for (int j = 0; j < 200; j++) {
      double x = 0.8 * ((i + 0.5) / 200 - 0.5), z = 0.6 * ((j + 0.5) / 200 - 0.5),
             d2 = x * x + z * z + 4;
      sum += 4 / (d2 * d2) * 0.48 / 40000; /* cos cos / d^2 dA at distance 2 */
    }
  assert_ratio("floor under a portal", image_mean(&p, 1), 0.5 / M_PI * 3 * sum, 2e-3);
  image_free(&p);
}

/* A sheet between the sky and the portal shades what is inside, and is black: no point out
 * there sees the light. */
static void sheet_outside_a_portal(void **state) {
  (void)state;
  const vlTracer tracers[] = {VL_TRACER_PATH, VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL,
                              VL_TRACER_LIGHT_PATH, VL_TRACER_MERGING};
  for (size_t i = 0; i < sizeof tracers / sizeof *tracers; i++) {
    Stage s = stage_open(SIZE, SIZE);
    s.camera.eye[1] = 4;
    s.camera.lookat[1] = 0;
    s.camera.lookat[2] = 0;
    s.camera.up[1] = 0;
    s.camera.up[2] = 1;
    s.camera.fov = 1;
    s.render.tracer = tracers[i];
    s.render.max_depth = 3;
    s.render.spp = 16;
    Quad sheet = quad_at(0, 1.5f, 0, 1, 0, 0, 0, 0, 1);
    sheet.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    add_quad(&s, &sheet);
    add_imaged_sky(&s, true);
    Image p = stage_finish(&s);
    if (image_mean(&p, 1) != 0)
      fail_msg("tracer %d lights the outside: %g", (int)tracers[i], image_mean(&p, 1));
    image_free(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(room_with_and_without),
      cmocka_unit_test(seen_from_both_sides),
      cmocka_unit_test(floor_under_a_portal),
      cmocka_unit_test(sheet_outside_a_portal),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
