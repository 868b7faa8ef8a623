/* test/render/test_subsurface.c: the subsurface material: thick solids under a white sky have
 * the given reflectance; light that enters around a block's edge, against an integral over the
 * lit side; white solids; and changes that must not affect the image. */
#include "material/bssrdf.h"
#include "shots.h"
#include "velo/medium.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/tracer.h"

static vlMaterialDef body(float sigma_a, float sigma_s) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_SUBSURFACE);
  def.subsurface.sigma_a = vl_spectrum_input(vl_spectrum_constant(sigma_a));
  def.subsurface.sigma_s = vl_spectrum_input(vl_spectrum_constant(sigma_s));
  return def;
}

static vlMaterialDef reflecting(vlSpectrum color, float mfp) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_SUBSURFACE);
  def.subsurface.from_reflectance = true;
  def.reflectance = vl_spectrum_input(color);
  def.subsurface.mfp = vl_spectrum_input(vl_spectrum_constant(mfp));
  return def;
}

static vlMaterialId add(Stage *s, const vlMaterialDef *def) {
  vlMaterialId id = vl_scene_add_material(s->scene, def);
  vlError error;
  if (vl_scene_result(s->scene, &error) != VL_OK)
    fail_msg("material: %s", error.message);
  return id;
}

static Stage open_stage(uint32_t size, uint32_t spp, vlColorMode color) {
  Stage s = stage_open(size, size);
  s.build.color = color;
  s.render.tracer = VL_TRACER_VOLPATH;
  s.render.sampler = VL_SAMPLER_SOBOL;
  s.render.spp = spp;
  s.camera.fov = 0.05;
  return s;
}

static Quad wall(float z, float half, vlMaterialId material) {
  Quad q = quad_at(0, 0, z, half, 0, 0, 0, half, 0);
  q.material = material;
  return q;
}

static vlMediumDef fog(float a) {
  vlMediumDef def = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  def.sigma_a = vl_spectrum_constant(a);
  def.sigma_s = vl_spectrum_constant(0);
  return def;
}

/* Of a body: share of light that leaves again; straight on the surface reflects r0. */
static double effective(float eta, float g, float albedo) {
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlBssrdfTable *table = malloc(sizeof *table);
  vl_bssrdf_build(context, eta, g, table);
  vlSpline a = vl_bssrdf_albedo(table, albedo);
  double e = (double)vl_bssrdf_effective(table, &a);
  free(table);
  vl_context_destroy(context);
  return e;
}
/* The share of all light that is let out again is 1, but that pbrt's polynomial for it is a
 * little off. */
static double let_out(double eta) {
  double sum = 0;
  for (int i = 0; i < 10000; i++) {
    double c = (i + 0.5) / 10000, t = sqrt(1 - (1 - c * c) / (eta * eta));
    double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    sum += 2e-4 * c * (1 - (s * s + p * p) / 2);
  }
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlBssrdfTable *table = malloc(sizeof *table);
  vl_bssrdf_build(context, (float)eta, 0, table);
  sum /= (double)table->leaves;
  free(table);
  vl_context_destroy(context);
  return sum;
}
static double straight(double eta) {
  return (eta - 1) * (eta - 1) / ((eta + 1) * (eta + 1));
}

/* ---- thick and wide ---------------------------------------------------------------------- */

/* A wall under a white sky: what its surface reflects, and of the rest the body's share. Probes
 * reach 0.999 of it. */
static void walls(void **state) {
  (void)state;
  const float etas[] = {1.0f, 1.33f, 1.5f};
  for (int k = 0; k < 3; k++)
    for (int way = 0; way < 2; way++)
      for (int rgb = (k + way) & 1; rgb < 2; rgb += 2) {
        Stage s = open_stage(16, 512, rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL);
        s.render.max_depth = 1;
        vlMaterialDef def = way ? body(3, 17) : reflecting(vl_spectrum_constant(0.6f), 0.2f);
        if (way) {
          def.scale = 0.5f;
          def.g = vl_float_input(0.3f);
        }
        def.eta = vl_spectrum_input(vl_spectrum_constant(etas[k]));
        add_sky(&s, 1);
        Quad q = wall(-3, 3000, add(&s, &def));
        add_quad(&s, &q);
        Image p = stage_finish(&s);
        double r0 = straight((double)etas[k]), out = let_out((double)etas[k]),
               share = way ? effective(etas[k], 0.3f, 0.85f) : 0.6;
        for (int c = 0; c < 3; c++)
          assert_ratio("wall", image_mean(&p, c), r0 + (1 - r0) * 0.999 * share * out, 3e-3);
        assert_int_equal(p.stats.not_finite, 0);
        image_free(&p);
      }
}

/* Each colour has an albedo and a path length of its own. */
static void colours(void **state) {
  (void)state;
  for (int rgb = 0; rgb < 2; rgb++) {
    Stage s = open_stage(16, 512, rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL);
    s.render.max_depth = 1;
    vlMaterialDef def = reflecting(vl_spectrum_rgb(0.8f, 0.5f, 0.3f), 1);
    def.subsurface.mfp = vl_spectrum_input(vl_spectrum_rgb(0.4f, 0.2f, 0.1f));
    add_sky(&s, 1);
    Quad q = wall(-3, 3000, add(&s, &def));
    add_quad(&s, &q);
    Image p = stage_finish(&s);
    const double color[3] = {0.8, 0.5, 0.3}, r0 = straight(1.33);
    for (int c = 0; c < 3; c++)
      assert_near("coloured wall", image_mean(&p, c), r0 + (1 - r0) * 0.999 * color[c],
                  rgb ? 5e-3 : 1e-2);
    image_free(&p);
  }
}

/* A rough surface: the share of light that it reflects apart, lights and samples find the
 * same. */
static void rough(void **state) {
  (void)state;
  double mean[2];
  for (int white = 0; white < 2; white++) {
    Stage s = open_stage(16, 1024, VL_COLOR_RGB);
    s.render.max_depth = 1;
    vlMaterialDef def = reflecting(vl_spectrum_constant(white ? 0.8f : 0.0f), 0.1f);
    def.u_roughness = def.v_roughness = vl_float_input(0.3f);
    def.remap_roughness = false;
    add_sky(&s, 1);
    Quad q = wall(-3, 3000, add(&s, &def));
    add_quad(&s, &q);
    Image p = stage_finish(&s);
    mean[white] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_near("rough, black", mean[0], straight(1.33), 0.01);
  /* microfacets lose some */
  assert_near("rough, white", mean[1] - mean[0], 0.8 * 0.999 * (1 - mean[0]), 0.012);
}

/* ---- white bodies ------------------------------------------------------------------------ */

/* Balls that give back all, some larger than their mean free path, some not: never brighter
 * than the sky. */
static void white(void **state) {
  (void)state;
  const float lengths[] = {0.003f, 0.03f, 0.3f, 3.0f};
  double before = 2;
  for (int k = 0; k < 4; k++) {
    Stage s = open_stage(24, 256, VL_COLOR_SPECTRAL);
    s.camera.fov = 0.7;
    s.render.max_depth = 50;
    vlMaterialDef def = reflecting(vl_spectrum_constant(1), lengths[k]);
    add_sky(&s, 1);
    vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
    set_matrix(ball.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3);
    ball.material = add(&s, &def);
    vl_scene_add_shape(s.scene, &ball);
    Image p = stage_finish(&s);
    double mean = image_region(&p, 8, 8, 16, 16, 1);
    /* the smaller, the more passes by the profile's reach */
    assert_true(mean < 1.005 && mean < before + 0.005);
    if (k == 0)
      assert_near("white ball", mean, 1, 0.01);
    before = mean;
    assert_int_equal(p.stats.not_finite, 0);
    image_free(&p);
  }
}

/* ---- round a corner ---------------------------------------------------------------------- */

/* A block's front at z = -3 ends at x = 0; its side there is lit by a sun that grazes the
 * front. What is seen of the front at x = -a has come in by the side: an integral over it. Half
 * of its probes go along the normal of the front, which never meet the side: the tangents' find
 * it. */
static void corner(void **state) {
  (void)state;
  const double a = 0.3, sigma = 5;
  const float albedo = 0.9f;
  for (int mesh = 0; mesh < 2; mesh++) {
    Stage s = open_stage(8, 8192, VL_COLOR_RGB);
    s.camera.fov = 0.001;
    s.render.max_depth = 1;
    s.camera.eye[0] = s.camera.lookat[0] = -a;
    vlMaterialDef def = body((float)sigma * (1 - albedo), (float)sigma * albedo);
    vlMaterialId id = add(&s, &def);
    Quad front = quad_at(-50, 0, -3, 50, 0, 0, 0, 50, 0); /* normal +z */
    Quad side = quad_at(0, 0, -53, 0, 50, 0, 0, 0, 50);   /* normal +x */
    front.material = side.material = id;
    front.patch = side.patch = mesh;
    add_quad(&s, &front);
    add_quad(&s, &side);
    vlLightDef sun = vl_default_light_def(VL_LIGHT_DISTANT);
    sun.color = vl_spectrum_rgb(1, 1, 1);
    sun.from[0] = 1;
    sun.from[2] = 0;
    sun.to[2] = 0;
    vl_scene_add_light(s.scene, &sun);
    vlContext *context = s.context;
    vlBssrdfTable *table = malloc(sizeof *table);
    vl_bssrdf_build(context, 1.33f, 0, table);
    vlSpline row = vl_bssrdf_albedo(table, albedo);
    double sum = 0, step = 0.004, reach = (double)vl_bssrdf_sample(table, &row, 0.999f) / sigma;
    for (double y = step / 2; y < reach; y += step)
      for (double z = step / 2; z < reach; z += step) {
        double r = sqrt(a * a + y * y + z * z);
        sum += 2 * step * step * sigma * sigma *
               (double)vl_bssrdf_at(table, &row, (float)(r * sigma));
      }
    double r0 = straight(1.33),
           expected = (1 - r0) * sum * (1 - r0) / (M_PI * (double)table->leaves);
    free(table);
    Image p = stage_finish(&s);
    assert_ratio("round a corner", image_mean(&p, 1), expected, 0.02);
    image_free(&p);
  }
}

/* ---- small triangles --------------------------------------------------------------------- */

/* A ball in which light goes far; probes start far outside of it, because another object makes
 * the world wide. */
static Image far_probes(bool mesh) {
  Stage s = open_stage(16, 256, VL_COLOR_RGB);
  s.camera.fov = 0.2;
  s.render.max_depth = 1;
  add_sky(&s, 1);
  float *block = NULL;
  vlMaterialDef def = reflecting(vl_spectrum_constant(0.6f), 3);
  vlShapeDef ball =
      mesh ? mesh_sphere(100, 1, true, &block) : vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(ball.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -5);
  ball.material = add(&s, &def);
  vl_scene_add_shape(s.scene, &ball);
  free(block);
  Quad away = quad_at(40, 0, -5, 0.1f, 0, 0, 0, 0.1f, 0);
  away.material = add_diffuse(&s, 0, 0, 0);
  add_quad(&s, &away);
  return stage_finish(&s);
}

/* A probe counts each crossing once, also that of a small triangle seen from afar. */
static void fine_mesh(void **state) {
  (void)state;
  Image ball = far_probes(false), mesh = far_probes(true);
  assert_ratio("ball of small triangles", image_mean(&mesh, 1), image_mean(&ball, 1), 5e-3);
  image_free(&ball);
  image_free(&mesh);
}

/* ---- others ------------------------------------------------------------------------------ */

/* A body in a medium: light goes through it on both sides of its way through the body. */
static void in_fog(void **state) {
  (void)state;
  double mean[2];
  for (int with = 0; with < 2; with++) {
    Stage s = open_stage(8, 1024, VL_COLOR_RGB);
    s.render.max_depth = 1;
    vlMaterialDef def = reflecting(vl_spectrum_constant(0.5f), 0.002f);
    Quad q = wall(-3, 30, add(&s, &def));
    add_quad(&s, &q);
    add_point(&s, 0, 0.001f, -2, 10);
    vlMediumDef thin = fog(0.3f);
    if (with) {
      vlMediumId id = vl_scene_add_medium(s.scene, &thin);
      vl_scene_defs(s.scene)->camera_medium = id;
    }
    Image p = stage_finish(&s);
    mean[with] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_ratio("in fog", mean[1] / mean[0], exp(-0.3 * 4), 0.01);
}

/* Half a body, half diffuse: light enters where chance says body, and leaves where it says so
 * again. */
static void mixed(void **state) {
  (void)state;
  double r0 = straight(1.33);
  Stage s = open_stage(16, 1024, VL_COLOR_RGB);
  s.render.max_depth = 1;
  vlMaterialDef def = reflecting(vl_spectrum_constant(0.6f), 0.1f),
                mix = vl_default_material_def(VL_MATERIAL_MIX);
  mix.materials[0] = add(&s, &def);
  mix.materials[1] = add_diffuse(&s, 0.2f, 0.2f, 0.2f);
  mix.amount = vl_float_input(0.25f);
  add_sky(&s, 1);
  Quad q = wall(-3, 3000, add(&s, &mix));
  add_quad(&s, &q);
  Image p = stage_finish(&s);
  assert_near("mixed", image_mean(&p, 1),
              0.75 * (r0 + (1 - r0) * 0.999 * 0.6 * 0.75) + 0.25 * 0.2, 6e-3);
  image_free(&p);
}

/* Absorption and scattering from textures: another body beyond u = 0.5. */
static void textured(void **state) {
  (void)state;
  Stage s = open_stage(16, 256, VL_COLOR_RGB);
  s.render.max_depth = 1;
  s.camera.fov = 0.4;
  vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, true);
  checks.spectrum_a = vl_spectrum_input(vl_spectrum_constant(0.9f));
  checks.spectrum_b = vl_spectrum_input(vl_spectrum_constant(0.3f));
  checks.su = 2;
  checks.sv = 1;
  vlMaterialDef def = reflecting(vl_spectrum_constant(1), 1e-4f);
  def.reflectance.texture = vl_scene_add_texture(s.scene, &checks);
  add_sky(&s, 1);
  Quad q = wall(-3, 3, add(&s, &def));
  add_quad(&s, &q);
  Image p = stage_finish(&s);
  double r0 = straight(1.33);
  assert_near("left", image_region(&p, 0, 0, 6, 16, 1), r0 + (1 - r0) * 0.999 * 0.9, 0.012);
  assert_near("right", image_region(&p, 10, 0, 16, 16, 1), r0 + (1 - r0) * 0.999 * 0.3, 0.012);
  image_free(&p);
}

static void note(void *user, vlLogLevel level, const vlError *where, const char *message) {
  (void)where;
  if (level == VL_LOG_WARNING && strstr(message, "subsurface"))
    ++*(int *)user;
}

/* The path tracer renders glass, bit for bit, and warns once. */
static void as_glass(void **state) {
  (void)state;
  Image p[2];
  int told = 0;
  for (int k = 0; k < 2; k++) {
    Stage s = open_stage(16, 16, VL_COLOR_SPECTRAL);
    vl_scene_destroy(s.scene);
    vl_context_destroy(s.context);
    vlContextDef context = vl_default_context_def();
    context.log = note;
    context.log_user = &told;
    assert_int_equal(vl_context_create(&context, &s.context), VL_OK);
    assert_int_equal(vl_scene_create(s.context, &s.scene), VL_OK);
    s.camera.fov = 0.8;
    s.render.tracer = VL_TRACER_PATH;
    vlMaterialDef glass =
        vl_default_material_def(k ? VL_MATERIAL_SUBSURFACE : VL_MATERIAL_DIELECTRIC);
    glass.eta = vl_spectrum_input(vl_spectrum_constant(1.4f));
    add_sky(&s, 0.3f);
    add_point(&s, 1, 1, 1, 1);
    vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
    set_matrix(ball.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -3);
    ball.material = add(&s, &glass);
    vl_scene_add_shape(s.scene, &ball);
    Quad floor = quad_at(0, -1, -3, 4, 0, 0, 0, 0, -4);
    floor.material = add_diffuse(&s, 0.7f, 0.5f, 0.3f);
    add_quad(&s, &floor);
    p[k] = stage_finish(&s);
  }
  assert_memory_equal(p[0].rgba, p[1].rgba, (size_t)16 * 16 * 4 * sizeof(float));
  assert_int_equal(told, 1);
  image_free(&p[0]);
  image_free(&p[1]);
}

static Image rich(vlContext *context, const void *color) {
  Stage s = stage_open_in(context, 24, 24);
  s.camera.fov = 0.9;
  s.build.color = *(const vlColorMode *)color;
  s.render.tracer = VL_TRACER_VOLPATH;
  s.render.spp = 8;
  s.render.max_depth = 8;
  add_sky(&s, 0.5f);
  add_point(&s, 1, 2, -1, 5);
  vlMediumDef dust = fog(0.02f);
  dust.sigma_s = vl_spectrum_rgb(0.03f, 0.05f, 0.08f);
  vl_scene_defs(s.scene)->camera_medium = vl_scene_add_medium(s.scene, &dust);
  vlMaterialDef skin = reflecting(vl_spectrum_rgb(0.8f, 0.5f, 0.4f), 1),
                marble = body(0.02f, 8);
  skin.subsurface.mfp = vl_spectrum_input(vl_spectrum_rgb(0.3f, 0.1f, 0.05f));
  skin.u_roughness = skin.v_roughness = vl_float_input(0.3f);
  float *block;
  vlShapeDef ball = mesh_sphere(12, 0.8f, true, &block);
  set_matrix(ball.group_from_shape, 1, 0, 0, -0.4, 0, 1, 0, 0, 0, 0, 1, -3);
  ball.material = add(&s, &skin);
  vl_scene_add_shape(s.scene, &ball);
  free(block);
  vlShapeDef other = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(other.group_from_shape, 0.5, 0, 0, 0.6, 0, 0.5, 0, 0, 0, 0, 0.5, -2.4);
  other.material = add(&s, &marble);
  vl_scene_add_shape(s.scene, &other);
  Quad floor = quad_at(0, -1, -3, 4, 0, 0, 0, 0, -4);
  floor.material = add_diffuse(&s, 0.7f, 0.5f, 0.3f);
  add_quad(&s, &floor);
  return stage_finish(&s);
}

static void same_bits(void **state) {
  (void)state;
  for (int color = 0; color < 2; color++) {
    vlColorMode mode = color ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
    Image a = assert_same_bits(rich, &mode, 1);
    assert_int_equal(a.stats.not_finite, 0);
    image_free(&a);
  }
}

/* Extremes: bodies so dense that rays cannot tell the way through them, and so thin that
 * nothing happens. */
static void extremes(void **state) {
  (void)state;
  const float lengths[] = {0, 1e-30f, 1e-9f, 1e9f, 1e30f};
  for (int k = 0; k < 5; k++) {
    Stage s = open_stage(8, 64, VL_COLOR_SPECTRAL);
    vlMaterialDef def = reflecting(vl_spectrum_rgb(0.9f, 0.5f, 0.0f), lengths[k]);
    def.subsurface.mfp = vl_spectrum_input(vl_spectrum_rgb(lengths[k], 1e-3f, 1e20f));
    add_sky(&s, 1);
    Quad q = wall(-3, 30, add(&s, &def));
    add_quad(&s, &q);
    Image p = stage_finish(&s);
    assert_int_equal(p.stats.not_finite, 0);
    for (int c = 0; c < 3; c++)
      assert_true(image_mean(&p, c) < 1.3);
    image_free(&p);
  }
}

static void refused(void **state) {
  (void)state;
  for (int k = 0; k < 5; k++) {
    Stage s = stage_open(8, 8);
    vlMaterialDef def = body(1, 1);
    if (k == 0)
      def.eta = vl_spectrum_input(vl_spectrum_constant(3));
    if (k == 1)
      def.eta = vl_spectrum_input(vl_spectrum_named("glass-BK7"));
    if (k == 2)
      def.g = vl_float_input(1);
    if (k == 3)
      def.g = vl_float_input(NAN);
    if (k == 4)
      def.scale = -1;
    vl_scene_add_material(s.scene, &def);
    assert_int_equal(vl_scene_result(s.scene, NULL), VL_ERROR_SCENE);
    stage_close(&s);
  }
}

/* ---- memory ------------------------------------------------------------------------------ */

typedef struct Purse {
  long left; /* allocations that still succeed */
} Purse;
static void *take(void *user, size_t size) {
  Purse *p = user;
  return p->left-- > 0 ? malloc(size) : NULL;
}
static void give_back(void *user, void *block) {
  (void)user;
  free(block);
}

/* The n-th allocation of a build fails, for every n. */
static void memory(void **state) {
  (void)state;
  vlResult r = VL_ERROR_MEMORY;
  for (long n = 0; r != VL_OK && n < 1000; n++) {
    Purse purse = {1000000};
    vlContextDef def = vl_default_context_def();
    def.threads = 1;
    def.allocator.allocate = take;
    def.allocator.release = give_back;
    def.allocator.user = &purse;
    Stage s = {.build = vl_default_build_def()};
    assert_int_equal(vl_context_create(&def, &s.context), VL_OK);
    assert_int_equal(vl_scene_create(s.context, &s.scene), VL_OK);
    vlMaterialDef one = body(1, 2), two = reflecting(vl_spectrum_rgb(0.1f, 0.2f, 0.3f), 1);
    Quad q = wall(-3, 3, add(&s, &one)), p = wall(-4, 3, add(&s, &two));
    add_quad(&s, &q);
    add_quad(&s, &p);
    purse.left = n;
    vlWorld *world = NULL;
    r = vl_world_build(s.scene, &s.build, &world, NULL);
    if (r != VL_OK)
      assert_int_equal(r, VL_ERROR_MEMORY);
    vl_world_destroy(world);
    purse.left = 1000000;
    stage_close(&s);
  }
  assert_int_equal(r, VL_OK);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(walls),    cmocka_unit_test(colours),   cmocka_unit_test(rough),
      cmocka_unit_test(white),    cmocka_unit_test(corner),    cmocka_unit_test(fine_mesh),
      cmocka_unit_test(in_fog),   cmocka_unit_test(mixed),     cmocka_unit_test(textured),
      cmocka_unit_test(as_glass), cmocka_unit_test(same_bits), cmocka_unit_test(extremes),
      cmocka_unit_test(refused),  cmocka_unit_test(memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
