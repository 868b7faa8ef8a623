/* test/render/test_camera.c: effects of the camera on the image: circle of confusion, near and
 * far plane, orthographic projection, exposure time, crop; depths and tracers of a render. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

/* ---- lens -------------------------------------------------------------------------------- */

/* A small bright square out of focus becomes a uniformly bright disk of radius lens_radius *
 * |1/z - 1/focus| * fx pixels. */
static void circle_of_confusion(void **state) {
  (void)state;
  enum { SIDE = 32 };
  const double depths[3] = {1.5, 4, 9};
  for (int i = 0; i < 3; i++) {
    Stage s = stage_open(SIDE, SIDE);
    s.build.color = VL_COLOR_RGB;
    s.render.spp = 4096;
    s.render.max_depth = 0;
    s.camera.fx = s.camera.fy = 60;
    s.camera.lens_radius = 0.4;
    s.camera.focus_distance = 2.5;
    double z = depths[i], side = 0.02 * z, radius = 0.4 * fabs(1 / z - 1 / 2.5) * 60;
    Quad q = quad_at((float)(0.1 * z), (float)(-0.05 * z), (float)-z, (float)side, 0, 0, 0,
                     (float)side, 0);
    q.emission = add_emission(&s, 100, true);
    add_quad(&s, &q);
    Image p = stage_finish(&s);
    double sum = 0, mx = 0, my = 0, second = 0;
    for (uint32_t y = 0; y < SIDE; y++)
      for (uint32_t x = 0; x < SIDE; x++) {
        double v = image_at(&p, x, y, 1);
        sum += v;
        mx += v * (x + 0.5);
        my += v * (y + 0.5);
      }
    mx /= sum;
    my /= sum;
    for (uint32_t y = 0; y < SIDE; y++)
      for (uint32_t x = 0; x < SIDE; x++) {
        double dx = x + 0.5 - mx, dy = y + 0.5 - my;
        second += image_at(&p, x, y, 1) * (dx * dx + dy * dy);
      }
    /* x^2 + y^2 of a disk: R^2/2; of the square: 2 a^2/3; of a pixel: 1/6 */
    double a = side / z * 60, expected = radius * radius / 2 + 2 * a * a / 3 + 1.0 / 6;
    assert_ratio("second moment of the blur", second / sum, expected, 0.01);
    assert_near("centre of the blur, x", mx, SIDE / 2 + 60 * 0.1, 0.05);
    assert_near("centre of the blur, y", my, SIDE / 2 + 60 * 0.05, 0.05);
    assert_ratio("light in the blur", sum, 100 * 4 * a * a, 0.01);
    image_free(&p);
  }
}

static void near_and_far(void **state) {
  (void)state;
  for (int projection = 0; projection < 2; projection++) {
    Stage s = stage_open(32, 32);
    s.camera.projection = projection ? VL_PROJECTION_ORTHOGRAPHIC : VL_PROJECTION_PERSPECTIVE;
    s.camera.near_plane = 2;
    s.camera.far_plane = 4;
    s.render.max_depth = 0;
    /* Three walls: in front of the near plane, between the planes (left half), behind the far
     * plane. The limits are planes, not distances: the whole wall at depth 3.99 is visible,
     * including the corners. */
    const float z[3] = {-1.9f, -3.99f, -4.01f}, light[3] = {5, 1, 7};
    for (int k = 0; k < 3; k++) {
      Quad q = quad_at(k == 1 ? -10 : 0, 0, z[k], k == 1 ? 10 : 50, 0, 0, 0, 50, 0);
      q.emission = add_emission(&s, light[k], true);
      add_quad(&s, &q);
    }
    Image p = stage_finish(&s);
    assert_near("left half", image_region(&p, 0, 0, 16, 32, 1), 1, 0.01);
    assert_near("right half", image_region(&p, 16, 0, 32, 32, 1), 0, 0);
    image_free(&p);
  }
}

/* Orthographic projection: sizes do not depend on depth, and screen units are scene units. */
static void orthographic(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    Stage s = stage_open(40, 40);
    s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
    s.camera.screen_min_x = s.camera.screen_min_y = -2;
    s.camera.screen_max_x = s.camera.screen_max_y = 2;
    s.render.max_depth = 0;
    s.render.spp = 64;
    Quad q = quad_at(0.5f, 0.25f, k ? -30 : -1, 0.8f, 0, 0, 0, 0.6f, 0);
    q.emission = add_emission(&s, 1, true);
    add_quad(&s, &q);
    Image p = stage_finish(&s);
    assert_ratio("area", image_mean(&p, 3) * 16, 1.6 * 1.2, 5e-3);
    double mx = 0, my = 0, sum = 0;
    for (uint32_t y = 0; y < 40; y++)
      for (uint32_t x = 0; x < 40; x++) {
        double v = image_at(&p, x, y, 3);
        sum += v;
        mx += v * (x + 0.5);
        my += v * (y + 0.5);
      }
    assert_near("x", mx / sum, 20 + 10 * 0.5, 0.03);
    assert_near("y", my / sum, 20 - 10 * 0.25, 0.03);
    image_free(&p);
  }
}

static void exposure_and_crop(void **state) {
  (void)state;
  Image p[3];
  for (int k = 0; k < 3; k++) {
    Stage s = stage_open(48, 36);
    add_sky(&s, 0.5f);
    vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
    set_matrix(def.group_from_shape, 1, 0, 0, 0.3, 0, 1, 0, 0, 0, 0, 1, -3);
    vl_scene_add_shape(s.scene, &def);
    if (k == 1)
      s.camera.exposure_time = 2;
    if (k == 2) {
      s.film.crop[0] = 7;
      s.film.crop[1] = 5;
      s.film.crop[2] = 30;
      s.film.crop[3] = 17;
    }
    p[k] = stage_finish(&s);
  }
  for (uint32_t y = 0; y < 36; y++)
    for (uint32_t x = 0; x < 48; x++)
      for (int c = 0; c < 3; c++)
        assert_ratio("twice the exposure", image_at(&p[1], x, y, c),
                     2 * image_at(&p[0], x, y, c), 1e-5);
  assert_int_equal(p[2].width, 23);
  assert_int_equal(p[2].height, 12);
  for (uint32_t y = 0; y < 12; y++)
    for (uint32_t x = 0; x < 23; x++)
      for (int c = 0; c < 4; c++)
        assert_true(image_at(&p[2], x, y, c) == image_at(&p[0], x + 7, y + 5, c));
  for (int k = 0; k < 3; k++)
    image_free(&p[k]);
}

/* ---- depths and tracers ------------------------------------------------------------------ */

/* In a closed emissive sphere depth n holds the first n + 1 terms of a geometric series. */
static void depths(void **state) {
  (void)state;
  double expected = 0, power = 1;
  for (uint32_t depth = 0; depth < 5; depth++) {
    expected += power;
    power *= 0.6;
    /* every point emits light, or a point light's wall emits light: one less */
    for (int light = 0; light < 2; light++) {
      Stage s = stage_open(16, 16);
      s.render.max_depth = depth;
      s.render.spp = 64;
      vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
      def.reverse_orientation = true;
      def.material = add_diffuse(&s, 0.6f, 0.6f, 0.6f);
      if (light == 0)
        def.emission = add_emission(&s, 1, false);
      if (light == 1)
        add_point(&s, 0, 0, 0, (float)M_PI);
      vl_scene_add_shape(s.scene, &def);
      Image p = stage_finish(&s);
      assert_near(light ? "point light, depth" : "emission, depth", image_mean(&p, 1),
                  light ? expected - 1 : expected, 0.006 * expected);
      image_free(&p);
    }
  }
}

static void raycast(void **state) {
  (void)state;
  Stage s = stage_open(32, 32);
  s.build.color = VL_COLOR_RGB;
  s.render.tracer = VL_TRACER_RAYCAST;
  s.render.sampler = VL_SAMPLER_REGULAR;
  s.render.spp = 1;
  s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.material = add_diffuse(&s, 0.8f, 0.4f, 0.2f);
  ball.radius = 0.75f;
  ball.z_min = -0.75f;
  ball.z_max = 0.75f;
  set_matrix(ball.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -2);
  vl_scene_add_shape(s.scene, &ball);
  add_sky(&s, 0.3f);
  Image p = stage_finish(&s);
  for (uint32_t y = 0; y < 32; y++)
    for (uint32_t x = 0; x < 32; x++) {
      double u = (x + 0.5) / 16 - 1, v = (y + 0.5) / 16 - 1,
             r2 = (u * u + v * v) / (0.75 * 0.75);
      if (fabs(r2 - 1) < 0.05)
        continue;
      double cosine = r2 < 1 ? sqrt(1 - r2) : 0;
      assert_near("raycast red", image_at(&p, x, y, 0), r2 < 1 ? 0.8 * cosine : 0.3, 2e-4);
      assert_near("raycast blue", image_at(&p, x, y, 2), r2 < 1 ? 0.2 * cosine : 0.3, 2e-4);
    }
  image_free(&p);
}

/* A free plane is open everywhere; beside an endless wall at right angles half of the
 * cosine-weighted sky is left, at the very edge; a low ceiling within reach shuts all, out of
 * reach nothing. */
static void ambient_occlusion(void **state) {
  (void)state;
  const double expected[4] = {1, 0.5, 0, 1};
  for (int k = 0; k < 4; k++)
    for (int cosine = 0; cosine < 2; cosine++)
      for (int smooth = 0; smooth < 2; smooth++) {
        Stage s = stage_open(16, 16);
        s.render.tracer = VL_TRACER_AMBIENT_OCCLUSION;
        s.render.ao_cosine = cosine;
        s.render.spp = 256;
        s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
        s.camera.eye[2] = 0.001;
        s.camera.screen_min_x = 1e-4;
        s.camera.screen_max_x = 2e-4;
        s.camera.screen_min_y = -0.5e-4;
        s.camera.screen_max_y = 0.5e-4;
        if (k > 1)
          s.camera.eye[2] = 0.4;
        /* a wall of constant shading normals that lean: openness is of the true surface */
        static const float p[12] = {-100, -100, 0, 100, -100, 0, -100, 100, 0, 100, 100, 0};
        static const float n[12] = {0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f, 0.6f, 0, 0.8f};
        static const uint32_t f[6] = {0, 1, 3, 0, 3, 2};
        vlShapeDef floor = vl_default_shape_def(VL_SHAPE_TRIANGLES);
        floor.vertices = 4;
        floor.faces = 2;
        floor.positions = p;
        floor.indices = f;
        if (smooth)
          floor.normals = n;
        vl_scene_add_shape(s.scene, &floor);
        Quad wall = quad_at(0, 0, 0, 0, 0, 1000, 0, 1000, 0),
             ceiling = quad_at(0, 0, 0.5f, 50, 0, 0, 0, 50, 0);
        if (k == 1)
          add_quad(&s, &wall);
        if (k > 1)
          add_quad(&s, &ceiling);
        if (k == 3)
          s.render.ao_distance = 0.45f;
        Image q = stage_finish(&s);
        char what[64];
        snprintf(what, sizeof what, "openness, case %d, %s", k, cosine ? "cosine" : "uniform");
        assert_near(what, image_mean(&q, 1), expected[k], k == 2 ? 2e-3 : 0.01);
        image_free(&q);
      }
}

/* Images of grey scenes are the same in both colour modes. */
static void modes_agree_on_greys(void **state) {
  (void)state;
  double mean[2][3];
  for (int mode = 0; mode < 2; mode++) {
    Stage s = stage_open(48, 36);
    s.build.color = mode ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
    s.render.spp = 256;
    s.camera.fov = 0.9;
    add_sky(&s, 0.5f);
    add_point(&s, 2, 2, 0, 8);
    vlMaterialDef defs[4];
    for (int k = 0; k < 4; k++) {
      defs[k] = vl_default_material_def(
          (vlMaterialKind[4]){VL_MATERIAL_DIFFUSE, VL_MATERIAL_COATED_DIFFUSE,
                              VL_MATERIAL_DIELECTRIC, VL_MATERIAL_CONDUCTOR}[k]);
      if (k == 3) {
        defs[k].use_reflectance = true;
        defs[k].reflectance = vl_spectrum_input(vl_spectrum_constant(0.7f));
        defs[k].u_roughness = defs[k].v_roughness = vl_float_input(0.2f);
      }
      vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
      set_matrix(ball.group_from_shape, 0.4, 0, 0, 0.9 * k - 1.35, 0, 0.4, 0, 0, 0, 0, 0.4,
                 -3.5);
      ball.material = vl_scene_add_material(s.scene, &defs[k]);
      vl_scene_add_shape(s.scene, &ball);
    }
    Image p = stage_finish(&s);
    for (int c = 0; c < 3; c++)
      mean[mode][c] = image_mean(&p, c);
    image_free(&p);
  }
  for (int c = 0; c < 3; c++) {
    assert_ratio("spectral grey", mean[0][c], mean[1][c], 3e-3);
    assert_ratio("grey", mean[1][c], mean[1][1], 1e-3);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(circle_of_confusion),
      cmocka_unit_test(near_and_far),
      cmocka_unit_test(orthographic),
      cmocka_unit_test(exposure_and_crop),
      cmocka_unit_test(depths),
      cmocka_unit_test(raycast),
      cmocka_unit_test(ambient_occlusion),
      cmocka_unit_test(modes_agree_on_greys),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
