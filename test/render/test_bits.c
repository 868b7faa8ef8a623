/* test/render/test_bits.c: the same bits on every instruction set and for any number of
 * threads, in difficult cases: coverage and quadrics inside rotated instances (Embree's own
 * arithmetic differs there), mixes, interfaces, dispersion, bump maps, a lens. */
#include "render/shots.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

static void fill(Stage *s) {
  add_sky(s, 0.3f);
  add_point(s, 1, 2, 0, 5);
  s->camera.fov = 0.9;
  s->camera.lens_radius = 0.02;
  s->camera.focus_distance = 3;
  s->render.spp = 8;
  s->render.max_depth = 8;
  vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
  checks.su = 7;
  checks.sv = 5;
  checks.float_a = vl_float_input(0.7f);
  checks.float_b = vl_float_input(0.2f);
  vlTextureId cover = vl_scene_add_texture(s->scene, &checks);
  vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC),
                bumpy = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
  glass.eta = vl_spectrum_input(vl_spectrum_named("glass-SF11"));
  bumpy.u_roughness = bumpy.v_roughness = vl_float_input(0.1f);
  vlTextureDef height = vl_default_texture_def(VL_TEXTURE_SCALE, false);
  height.float_a.texture = cover;
  height.amount = vl_float_input(0.05f);
  bumpy.displacement.texture = vl_scene_add_texture(s->scene, &height);
  vlMaterialDef none = vl_default_material_def(VL_MATERIAL_INTERFACE),
                mix = vl_default_material_def(VL_MATERIAL_MIX);
  vlMaterialId ids[4] = {
      vl_scene_add_material(s->scene, &glass), vl_scene_add_material(s->scene, &bumpy),
      vl_scene_add_material(s->scene, &none), add_diffuse(s, 0.7f, 0.3f, 0.2f)};
  mix.materials[0] = ids[1];
  mix.materials[1] = ids[3];
  mix.amount.texture = cover;
  vlMaterialId mixed = vl_scene_add_material(s->scene, &mix);
  vlGroupId group = vl_scene_add_group(s->scene, "group");
  for (int k = 0; k < 5; k++) {
    vlShapeDef def =
        vl_default_shape_def((vlShapeKind[5]){VL_SHAPE_SPHERE, VL_SHAPE_CYLINDER, VL_SHAPE_DISK,
                                              VL_SHAPE_SPHERE, VL_SHAPE_SPHERE}[k]);
    set_matrix(def.group_from_shape, 0.31, 0.07, 0, 0.6 * k - 1.2, -0.07, 0.33, 0.05, 0.1, 0,
               -0.05, 0.35, 0.02 * k);
    def.material = k == 4 ? ids[2] : k == 3 ? ids[0] : mixed;
    if (k < 3)
      def.alpha.texture = cover;
    def.group = group;
    vl_scene_add_shape(s->scene, &def);
  }
  Quad card = quad_at(0, -0.4f, 0, 1.3f, 0.1f, 0.2f, 0, 0.1f, -0.6f);
  card.material = mixed;
  card.alpha.texture = cover;
  card.group = group;
  add_quad(s, &card);
  card.patch = true;
  card.p[1] = 0.3f;
  add_quad(s, &card);
  for (int k = 0; k < 3; k++) {
    double place[16];
    set_matrix(place, 0.83, -0.41, 0.13, 0.1 * k, 0.39, 0.81, 0.21, 0.5 * k - 0.5, -0.17, -0.11,
               0.93, -3 - 0.7 * k);
    vl_scene_add_instance(s->scene, group, place, (vlSource){0});
  }
}

static void same_bits(void **state) {
  (void)state;
  for (int color = 0; color < 2; color++) {
    Image first = {0, 0, NULL, {0}};
    for (int k = 0; k < 6; k++) {
      vlContextDef def = vl_default_context_def();
      def.isa = (vlIsa[3]){VL_ISA_BASE, VL_ISA_V3, VL_ISA_V4}[k % 3];
      def.threads = k < 3 ? 1 : 3;
      Stage s = stage_open(40, 30);
      vl_scene_destroy(s.scene);
      vl_context_destroy(s.context);
      if (vl_context_create(&def, &s.context) == VL_ERROR_UNSUPPORTED)
        continue; /* this machine lacks it */
      assert_int_equal(vl_scene_create(s.context, &s.scene), VL_OK);
      s.build.color = (vlColorMode)color;
      fill(&s);
      Image p = stage_finish(&s);
      if (!first.rgba) {
        first = p;
        assert_true(image_mean(&p, 1) > 0.05);
        continue;
      }
      size_t n = (size_t)p.width * p.height * 4, differing = 0;
      for (size_t i = 0; i < n; i++)
        differing += memcmp(&p.rgba[i], &first.rgba[i], sizeof(float)) != 0;
      if (differing)
        fail_msg("isa v%d, %u threads: %zu of %zu numbers differ", (int)def.isa, def.threads,
                 differing, n);
      image_free(&p);
    }
    image_free(&first);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(same_bits)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
