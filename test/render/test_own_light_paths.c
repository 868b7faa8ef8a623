/* test/render/test_own_light_paths.c: light paths and cameras of one's own (render/own_view.h):
 * an own pinhole has the splats of velo's; other cameras get by two-way tracers the image that
 * paths from the camera alone give. */
#include "render/shots.h"

#include "api/small_world.h"
#include "render/own_pinhole.h"
#include "render/own_view.h"
#include "velo/filter_kinds.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

/* Equidistant, 20 pixels per radian; it has no rays beyond 0.7 radians. */
static void fisheye_rays(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    double x = (points->x[i] - 0.5 * points->width) / 20,
           y = (points->y[i] - 0.5 * points->height) / 20;
    double angle = hypot(x, y), k = angle > 0 ? sin(angle) / angle : 1;
    if (angle > 0.7)
      continue;
    rays->dx[i] = k * x;
    rays->dy[i] = k * y;
    rays->dz[i] = cos(angle);
  }
}
static void fisheye_pixels(void *user, const vlOwnSpacePoints *points) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    double across = hypot(points->x[i], points->y[i]), angle = atan2(across, points->z[i]);
    double k = across > 0 ? 20 * angle / across : 0;
    points->film_x[i] = k * points->x[i] + 0.5 * points->width;
    points->film_y[i] = k * points->y[i] + 0.5 * points->height;
  }
}

/* Parallel rays, in a window of 4 by 3, with a weight that grows to the right; with `user`,
 * `pixels` knows the upper half only. */
static void parallel_rays(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    rays->ox[i] = 4 * (points->x[i] / points->width - 0.5);
    rays->oy[i] = 3 * (points->y[i] / points->height - 0.5);
    rays->dz[i] = 2;
    rays->weight[i] = 0.5 + fmax(0, points->x[i]) / points->width;
  }
}
static void parallel_pixels(void *user, const vlOwnSpacePoints *points) {
  for (uint32_t i = 0; i < points->count; i++) {
    if (user && !(points->y[i] < 0))
      continue;
    points->film_x[i] = (points->x[i] / 4 + 0.5) * points->width;
    points->film_y[i] = (points->y[i] / 3 + 0.5) * points->height;
  }
}

/* Rays from a line, each column from its own point, as a pushbroom camera's. */
static void line_rays(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    rays->ox[i] = 4 * (points->x[i] / points->width - 0.5);
    rays->dy[i] = points->y[i] - 0.5 * points->height;
    rays->dz[i] = 40;
  }
}
static void line_pixels(void *user, const vlOwnSpacePoints *points) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    if (!(points->z[i] > 0))
      continue;
    points->film_x[i] = (points->x[i] / 4 + 0.5) * points->width;
    points->film_y[i] = 40 * points->y[i] / points->z[i] + 0.5 * points->height;
  }
}

/* Two pinholes beside each other, the right one turned: a seam in the middle. */
static const double turn = 0.5;
static void pair_rays(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    double x = points->x[i] - 0.5 * points->width, z = 40, c = x < 0 ? 1 : cos(turn),
           s = x < 0 ? 0 : sin(turn);
    rays->dx[i] = c * x + s * z;
    rays->dy[i] = points->y[i] - 0.5 * points->height;
    rays->dz[i] = c * z - s * x;
  }
}
static void pair_pixels(void *user, const vlOwnSpacePoints *points) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++)
    for (int k = 0; k < 2; k++) { /* what both see belongs to the left one */
      double c = k ? 1 : cos(turn), s = k ? 0 : sin(turn),
             x = c * points->x[i] - s * points->z[i];
      double z = c * points->z[i] + s * points->x[i], film = 40 * x / z;
      if (!(z > 0) || (k ? film >= 0 : film < 0))
        continue;
      points->film_x[i] = film + 0.5 * points->width;
      points->film_y[i] = 40 * points->y[i] / z + 0.5 * points->height;
    }
}

/* Half a pixel off the rays: it must not be believed. */
static void wrong_pixels(void *user, const vlOwnSpacePoints *points) {
  pinhole_pixels(user, points);
  for (uint32_t i = 0; i < points->count; i++)
    points->film_x[i] += 0.5;
}

static const vlOwnCamera fisheye = {
    .name = "fisheye", .rays = fisheye_rays, .pixels = fisheye_pixels};
static const vlOwnCamera parallel = {
    .name = "parallel", .rays = parallel_rays, .pixels = parallel_pixels};
static const vlOwnCamera upper = {
    .name = "upper", .rays = parallel_rays, .pixels = parallel_pixels, .user = &of_small};
static const vlOwnCamera line = {.name = "line", .rays = line_rays, .pixels = line_pixels};
static const vlOwnCamera pair = {.name = "pair", .rays = pair_rays, .pixels = pair_pixels};
static const vlOwnCamera wrong = {
    .name = "wrong", .rays = pinhole_rays, .pixels = wrong_pixels, .user = &of_small};

/* Lamps, mirrors and glass on a floor; the same with a cloud; or a floor, a wall and a point
 * light. */
typedef enum What { CLEAR, CLOUD, DIFFUSE } What;

static void fill(Stage *s, What what) {
  if (what == DIFFUSE) {
    Quad ground = quad_at(0, 0, 0, 4, 0, 0, 0, 0, -4),
         wall = quad_at(0, 1, -1.5f, 4, 0, 0, 0, 1, 0);
    ground.material = wall.material = add_diffuse(s, 0.6f, 0.5f, 0.4f);
    add_quad(s, &ground);
    add_quad(s, &wall);
    add_point(s, 1, 2.5f, 1, 8);
    return;
  }
  small_scene(s->scene);
  if (what != CLOUD)
    return;
  vlMediumDef medium = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  medium.sigma_a = vl_spectrum_constant(0.2f);
  medium.sigma_s = vl_spectrum_constant(1.5f);
  vlMaterialDef nothing = vl_default_material_def(VL_MATERIAL_INTERFACE);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 0.6f;
  ball.z_min = -0.6f;
  ball.z_max = 0.6f;
  ball.material = vl_scene_add_material(s->scene, &nothing);
  ball.inside = vl_scene_add_medium(s->scene, &medium);
  small_place(ball.group_from_shape, 0.5, 0.8, 1.5);
  vl_scene_add_shape(s->scene, &ball);
}

static Stage stage_of(const vlOwnCamera *own, vlTracer tracer, What what, uint32_t spp,
                      uint32_t seed) {
  Stage s = stage_open(SMALL_WIDTH, SMALL_HEIGHT);
  const double eye[3] = {0, 1.6, 5}, lookat[3] = {0, 0.5, 0};
  memcpy(s.camera.eye, eye, sizeof eye);
  memcpy(s.camera.lookat, lookat, sizeof lookat);
  s.camera.fx = s.camera.fy = 40;
  s.camera.own = own;
  fill(&s, what);
  s.build.color = VL_COLOR_RGB;
  s.film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_TRIANGLE);
  s.render.tracer = tracer;
  s.render.spp = spp;
  s.render.seed = seed;
  s.render.max_depth = 4;
  return s;
}

/* velo's pinhole and the own one trace the same paths: only rounding differs. */
static void pinhole_is_velos(void **state) {
  (void)state;
  const vlTracer tracers[] = {VL_TRACER_LIGHT_PATH, VL_TRACER_BIDIRECTIONAL, VL_TRACER_MERGING};
  for (int what = CLEAR; what <= CLOUD; what++)
    for (size_t i = 0; i < sizeof tracers / sizeof *tracers; i++) {
      Image p[2];
      for (int k = 0; k < 2; k++) {
        Stage s = stage_of(k ? &pinhole : NULL, tracers[i], (What)what, 4, 0);
        p[k] = stage_finish(&s);
        assert_int_equal(p[k].stats.not_finite, 0);
      }
      double differing = image_differing(&p[0], &p[1], 1e-3);
      print_message("%s, tracer %d: %.3g of the pixels differ, mean %.4g and %.4g\n",
                    what == CLOUD ? "cloud" : "clear", (int)tracers[i], differing,
                    image_mean(&p[0], 1), image_mean(&p[1], 1));
      assert_true(differing < 0.02 && image_mean(&p[0], 1) > 0.02);
      assert_ratio("mean", image_mean(&p[1], 1), image_mean(&p[0], 1), 1e-3);
      image_free(&p[0]);
      image_free(&p[1]);
    }
}

enum { BLOCK = 10, BLOCKS = SMALL_WIDTH / BLOCK * (SMALL_HEIGHT / BLOCK), SEEDS = 16 };

/* Means of blocks over seeds, and their standard errors. */
static void blocks_of(const vlOwnCamera *own, vlTracer tracer, What what, uint32_t spp,
                      double mean[BLOCKS], double error[BLOCKS]) {
  double sum[BLOCKS] = {0}, square[BLOCKS] = {0};
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    Stage s = stage_of(own, tracer, what, spp, 100 * (uint32_t)tracer + seed);
    Image p = stage_finish(&s);
    assert_int_equal(p.stats.not_finite, 0);
    for (uint32_t b = 0; b < BLOCKS; b++) {
      uint32_t x = b % (SMALL_WIDTH / BLOCK) * BLOCK, y = b / (SMALL_WIDTH / BLOCK) * BLOCK;
      double value = image_region(&p, x, y, x + BLOCK, y + BLOCK, 1);
      sum[b] += value;
      square[b] += value * value;
    }
    image_free(&p);
  }
  for (uint32_t b = 0; b < BLOCKS; b++) {
    mean[b] = sum[b] / SEEDS;
    error[b] = sqrt(fmax(0, square[b] / SEEDS - mean[b] * mean[b]) / (SEEDS - 1)) + 1e-6;
  }
}

/* Student's t with 15 degrees of freedom exceeds 6 once in 40,000; there are 12 blocks for each
 * of 11 pairs. */
static void same_blocks(const char *name, const vlOwnCamera *own, vlTracer a, vlTracer b,
                        What what) {
  double ma[BLOCKS], mb[BLOCKS], ea[BLOCKS], eb[BLOCKS], worst = 0, relative = 0, mean = 0;
  blocks_of(own, a, what, 16, ma, ea);
  blocks_of(own, b, what, 16, mb, eb);
  for (uint32_t i = 0; i < BLOCKS; i++) {
    worst = fmax(worst, fabs(ma[i] - mb[i]) / hypot(ea[i], eb[i]));
    relative += hypot(ea[i], eb[i]);
    mean += ma[i];
  }
  print_message("%s: worst z %.2f, mean %.4g, standard error of a block %.2g of it\n", name,
                worst, mean / BLOCKS, relative / mean);
  assert_true(worst < 6);
  assert_true(relative / mean < 0.03); /* a difference of a fifth of a block would be seen */
}

static void other_cameras(void **state) {
  (void)state;
  const vlTracer two_way = VL_TRACER_BIDIRECTIONAL;
  same_blocks("fisheye", &fisheye, VL_TRACER_VOLPATH, two_way, CLEAR);
  same_blocks("fisheye with a cloud", &fisheye, VL_TRACER_VOLPATH, two_way, CLOUD);
  same_blocks("fisheye, merging", &fisheye, VL_TRACER_VOLPATH, VL_TRACER_MERGING, CLEAR);
  same_blocks("parallel, its upper half projects", &upper, VL_TRACER_VOLPATH, two_way, CLEAR);
  same_blocks("line", &line, VL_TRACER_VOLPATH, two_way, CLEAR);
  same_blocks("pair", &pair, VL_TRACER_VOLPATH, two_way, CLEAR);
  same_blocks("wrong", &wrong, VL_TRACER_VOLPATH, two_way, CLEAR);
  /* by light paths alone */
  same_blocks("fisheye's light paths", &fisheye, VL_TRACER_VOLPATH, VL_TRACER_LIGHT_PATH,
              DIFFUSE);
  same_blocks("parallel's light paths", &parallel, VL_TRACER_VOLPATH, VL_TRACER_LIGHT_PATH,
              DIFFUSE);
  same_blocks("line's light paths", &line, VL_TRACER_VOLPATH, VL_TRACER_LIGHT_PATH, DIFFUSE);
  same_blocks("pair's light paths", &pair, VL_TRACER_VOLPATH, VL_TRACER_LIGHT_PATH, DIFFUSE);
}

/* The area of a pixel at the distance 3 is that of a pinhole, beside the seam of the pair, too,
 * and at the border of a camera that has no rays on one side. */
static void half_rays(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  pinhole_rays(user, points, rays);
  for (uint32_t i = 0; i < points->count; i++)
    if (points->x[i] < 20)
      rays->dx[i] = rays->dy[i] = rays->dz[i] = 0;
}
static void areas_at_seams(void **state) {
  (void)state;
  const vlOwnCamera half = {
      .name = "half", .rays = half_rays, .pixels = pinhole_pixels, .user = &of_small};
  const vlOwnCamera *const owns[2] = {&pair, &half};
  const double places[5] = {20.001, 20.03, 25, 19.999, 3.5};
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < (k ? 3 : 5); i++) {
      vlCameraDef def = vl_default_camera_def(SMALL_WIDTH, SMALL_HEIGHT);
      def.own = owns[k];
      vlCamera camera;
      vlCameraCompiled c;
      vlCameraView view = {
          .low_x = 0, .high_x = SMALL_WIDTH, .low_y = 0, .high_y = SMALL_HEIGHT};
      vlFilmDef film = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
      vlCameraSample sample;
      double o[3], d[3];
      assert_int_equal(vl_camera_make(&def, &camera, NULL, NULL), VL_OK);
      vl_camera_compile(&camera, &c);
      vl_own_view(&c, &film, &view);
      view.camera = &c;
      assert_true(view.sees && vl_camera_unproject(&camera, places[i], 9, o, d));
      const float x = (float)(o[0] + 3 * d[0]), y = (float)(o[1] + 3 * d[1]),
                  z = (float)(o[2] + 3 * d[2]);
      view.look(&view, 1, &x, &y, &z, &sample);
      double right = hypot(hypot(places[i] - 20, 9 - 15), 40), cosine = 40 / right;
      assert_true(sample.seen);
      assert_near("film", (double)sample.x, places[i], 1e-3);
      assert_ratio("area", 1 / (double)sample.per_square, 9 * cosine * cosine * cosine / 1600,
                   2e-3);
    }
}

/* Where `pixels` does not lead to a ray through the point, nothing is connected. */
static void wrong_inverses(void **state) {
  (void)state;
  Stage s = stage_of(&wrong, VL_TRACER_LIGHT_PATH, CLEAR, 2, 0);
  Image p = stage_finish(&s);
  Stage right = stage_of(&pinhole, VL_TRACER_LIGHT_PATH, CLEAR, 2, 0);
  Image q = stage_finish(&right);
  /* the floor gets all its light from lamps and lights; the sky is hit by camera rays */
  assert_true(image_region(&q, 5, 20, 35, 30, 1) > 0.02);
  assert_true(image_region(&p, 5, 20, 35, 30, 1) == 0);
  image_free(&p);
  image_free(&q);
}

/* Of cameras that light paths cannot be connected to, the tracer that lives of that names
 * it. */
static void what_tracers_lack(void **state) {
  (void)state;
  vlOwnCamera blind = pinhole, lens = pinhole;
  blind.pixels = NULL;
  lens.lens = true;
  const vlOwnCamera *const owns[4] = {&pinhole, &blind, &lens, &pinhole};
  for (int i = 0; i < 4; i++) {
    Stage s = stage_of(owns[i], VL_TRACER_BIDIRECTIONAL, CLEAR, 2, 0);
    vlWorld *world;
    vlCamera camera;
    vlError error = {0};
    if (i == 3) {
      s.camera.eye_close[0] = 0.2;
      s.camera.eye_close[1] = 1.6;
      s.camera.eye_close[2] = 5;
    }
    assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
    assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
    const char *lack = vl_tracer_lacks(world, &camera, &s.film, VL_TRACER_LIGHT_PATH);
    assert_true(i == 0 ? lack == NULL : lack && strstr(lack, "own cameras"));
    assert_null(vl_tracer_lacks(world, &camera, &s.film, VL_TRACER_BIDIRECTIONAL));
    vl_world_destroy(world);
    Image p = stage_finish(&s);
    assert_int_equal(p.stats.not_finite, 0);
    image_free(&p);
  }
}

static Image render_light(vlContext *context, const void *what) {
  Stage s = stage_of(what, VL_TRACER_BIDIRECTIONAL, CLEAR, 2, 0);
  stage_close(&s);
  s = stage_open_in(context, SMALL_WIDTH, SMALL_HEIGHT);
  small_scene(s.scene);
  s.camera = vl_default_camera_def(SMALL_WIDTH, SMALL_HEIGHT);
  const double eye[3] = {0, 1.6, 5}, lookat[3] = {0, 0.5, 0};
  memcpy(s.camera.eye, eye, sizeof eye);
  memcpy(s.camera.lookat, lookat, sizeof lookat);
  s.camera.own = what;
  s.render.tracer = VL_TRACER_BIDIRECTIONAL;
  s.render.spp = 2;
  return stage_finish(&s);
}

static void same_bits(void **state) {
  (void)state;
  Image p = assert_same_bits(render_light, &fisheye, 2);
  image_free(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pinhole_is_velos),  cmocka_unit_test(other_cameras),
      cmocka_unit_test(areas_at_seams),    cmocka_unit_test(wrong_inverses),
      cmocka_unit_test(what_tracers_lack), cmocka_unit_test(same_bits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
