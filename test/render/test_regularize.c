/* test_regularize.c: regularisation of scattered paths (vlBuildDef.regularize). Surfaces seen
 * directly and in mirrors are bit-identical; surfaces met after scattering are, to the bit,
 * those of the larger alpha. */
#include "render/shots.h"
#include "velo/medium.h"
#include "velo/tracer.h"

enum { DIELECTRIC, CONDUCTOR, COAT, COATED_METAL, WALKED_COAT, PRINCIPLED, KINDS };

static float widened(float alpha) {
  float twice = 2.0f * alpha;
  return alpha >= 0.3f ? alpha : twice < 0.1f ? 0.1f : twice > 0.3f ? 0.3f : twice;
}

/* A material of alphas u and v. */
static vlMaterialId shiny(Stage *s, int kind, float u, float v) {
  static const vlMaterialKind kinds[KINDS] = {
      VL_MATERIAL_DIELECTRIC,       VL_MATERIAL_CONDUCTOR,      VL_MATERIAL_COATED_DIFFUSE,
      VL_MATERIAL_COATED_CONDUCTOR, VL_MATERIAL_COATED_DIFFUSE, VL_MATERIAL_PRINCIPLED};
  vlMaterialDef def = vl_default_material_def(kinds[kind]);
  def.remap_roughness = false;
  def.u_roughness = vl_float_input(u);
  def.v_roughness = vl_float_input(v);
  def.coat_u_roughness = vl_float_input(u);
  def.coat_v_roughness = vl_float_input(v);
  if (kind == WALKED_COAT)
    def.albedo = vl_spectrum_input(vl_spectrum_constant(0.5f));
  if (kind == PRINCIPLED) {
    def.principled.roughness = vl_float_input(sqrtf(u));
    def.principled.clearcoat = vl_float_input(0.5f);
    def.principled.clearcoat_roughness = vl_float_input(sqrtf(v));
  }
  return vl_scene_add_material(s->scene, &def);
}

/* The eye sees a grey wall; the material is behind it. Or, first: before it. */
static Image room(int kind, float u, float v, bool regularize, bool first, uint32_t depth,
                  bool medium) {
  Stage s = stage_open(24, 24);
  s.build.regularize = regularize;
  s.render.spp = 8;
  s.render.max_depth = depth;
  if (medium) {
    s.render.tracer = VL_TRACER_VOLPATH;
    vlMediumDef air = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
    air.sigma_s = vl_spectrum_constant(0);
    air.sigma_a = vl_spectrum_constant(0.1f);
    vl_scene_defs(s.scene)->camera_medium = vl_scene_add_medium(s.scene, &air);
  }
  vlMaterialId grey = add_diffuse(&s, 0.5f, 0.5f, 0.5f), other = shiny(&s, kind, u, v);
  Quad wall = quad_at(0, 0, -1, 3, 0, 0, 0, 3, 0), back = quad_at(0, 0, 1, -3, 0, 0, 0, 3, 0);
  wall.material = first ? other : grey;
  back.material = first ? grey : other;
  add_quad(&s, &wall);
  add_quad(&s, &back);
  add_point(&s, 0.4f, 0.7f, -0.3f, 4);
  add_sky(&s, 0.3f);
  return stage_finish(&s);
}

static bool same(const Image *a, const Image *b) {
  return memcmp(a->rgba, b->rgba, (size_t)a->width * a->height * 4 * sizeof(float)) == 0;
}

/* Behind the wall: as if the material had the greater alphas. */
static void rougher(void **state) {
  (void)state;
  const float alphas[4][2] = {{0, 0}, {0.02f, 0.02f}, {0.1f, 0.2f}, {0.35f, 0.12f}};
  for (int medium = 0; medium < 2; medium++)
    for (int kind = 0; kind < KINDS; kind++)
      for (int i = 0; i < 4; i++) {
        float u = alphas[i][0], v = alphas[i][1];
        if (kind == PRINCIPLED && i == 0)
          continue; /* has a least alpha of its own */
        Image on = room(kind, u, v, true, false, 3, medium),
              off = room(kind, u, v, false, false, 3, medium);
        Image rough = room(kind, widened(u), widened(v), false, false, 3, medium);
        if (kind == PRINCIPLED) { /* its roughness is the root: rounded */
          double differing = image_differing(&on, &rough, 1e-3);
          if (differing > 0.02)
            fail_msg("kind %d alphas %d: %g of the pixels differ", kind, i, differing);
        } else if (!same(&on, &rough)) {
          fail_msg("kind %d alphas %d medium %d: not as the rougher one", kind, i, medium);
        }
        if (same(&on, &off))
          fail_msg("kind %d alphas %d: nothing has changed", kind, i);
        image_free(&on);
        image_free(&off);
        image_free(&rough);
      }
}

/* The first surface that the camera sees does not change, nor does a surface that is rough
 * enough or has no alpha. */
static void unchanged(void **state) {
  (void)state;
  for (int kind = 0; kind < KINDS; kind++) {
    Image on = room(kind, 0.05f, 0.05f, true, true, 1, false),
          off = room(kind, 0.05f, 0.05f, false, true, 1, false);
    if (!same(&on, &off))
      fail_msg("kind %d: the first hit has changed", kind);
    image_free(&on);
    image_free(&off);
    on = room(kind, 0.5f, 0.4f, true, false, 4, false);
    off = room(kind, 0.5f, 0.4f, false, false, 4, false);
    if (!same(&on, &off))
      fail_msg("kind %d: what was rough has changed", kind);
    image_free(&on);
    image_free(&off);
  }
}

/* eye -> mirror -> metal: both as they are. The metal scatters: what the next ray meets is
 * rougher. */
static void in_a_mirror(void **state) {
  (void)state;
  Image p[2][2];
  for (int deep = 0; deep < 2; deep++)
    for (int on = 0; on < 2; on++) {
      Stage s = stage_open(24, 24);
      s.build.regularize = on;
      s.render.spp = 16;
      s.render.max_depth = deep ? 4 : 2;
      Quad mirror = quad_at(0, 0, -1, 3, 0, 0, 0, 3, 0),
           metal = quad_at(0, 0, 1, -3, 0, 0, 0, 3, 0);
      mirror.material = shiny(&s, CONDUCTOR, 0, 0);
      metal.material = shiny(&s, CONDUCTOR, 0.15f, 0.15f);
      add_quad(&s, &mirror);
      add_quad(&s, &metal);
      add_point(&s, 0.4f, 0.7f, -0.3f, 4);
      p[deep][on] = stage_finish(&s);
    }
  assert_true(same(&p[0][0], &p[0][1]));
  assert_false(same(&p[1][0], &p[1][1]));
  for (int i = 0; i < 4; i++)
    image_free(&p[i / 2][i % 2]);
}

/* A medium scatters, too: then a mirror finds the lamp. */
static void in_a_medium(void **state) {
  (void)state;
  double mean[2];
  for (int on = 0; on < 2; on++) {
    Stage s = stage_open(16, 16);
    s.build.regularize = on;
    s.render.spp = 64;
    s.render.max_depth = 2;
    s.render.tracer = VL_TRACER_VOLPATH;
    vlMediumDef fog = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
    fog.sigma_s = vl_spectrum_constant(0.5f);
    fog.sigma_a = vl_spectrum_constant(0);
    vl_scene_defs(s.scene)->camera_medium = vl_scene_add_medium(s.scene, &fog);
    Quad mirror = quad_at(0, 0, -2, 3, 0, 0, 0, 3, 0);
    mirror.material = shiny(&s, CONDUCTOR, 0, 0);
    add_quad(&s, &mirror);
    vlLightDef lamp = vl_default_light_def(VL_LIGHT_POINT);
    lamp.from[0] = 0.4f;
    lamp.from[2] = -1;
    lamp.medium = vl_scene_defs(s.scene)->camera_medium;
    vl_scene_add_light(s.scene, &lamp);
    Image p = stage_finish(&s);
    mean[on] = image_mean(&p, 1);
    image_free(&p);
  }
  print_message("mean %.4f, regularised %.4f\n", mean[0], mean[1]);
  assert_true(mean[0] > 0 && mean[1] > mean[0] * 1.01);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rougher), cmocka_unit_test(unchanged),
                                     cmocka_unit_test(in_a_mirror),
                                     cmocka_unit_test(in_a_medium)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
