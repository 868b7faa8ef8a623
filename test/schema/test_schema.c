/* test/scene/test_schema.c: the rows of all families: well formed, with defaults in range; the
 * functions that read them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/scene.h"
#include "schema/schema.h"
#include "unit.h"
#include "velo/filter_kinds.h"
#include "velo/material.h"
#include "velo/render.h"
#include "velo/texture.h"

static void well_formed(void **state) {
  (void)state;
  const vlKindFamily *family;
  uint32_t families = 0;
  for (; (family = vl_kind_family(families)); families++) {
    assert_ptr_equal(vl_kind_family_find(family->name), family);
    assert_true(family->kind_count > 0 && family->name && family->thing);
    for (uint32_t i = 0; i < family->kind_count; i++) {
      const vlKindRow *row = family->rows[i];
      assert_non_null(row);
      assert_true(row->description && row->description[0] && family->words[i]);
      /* readers have room for so many */
      assert_true(row->parameter_count <= 64 || !family->directive);
      if (row->name)
        assert_int_equal(vl_kind_find(family, row->name), i);
      if (row->alias)
        assert_int_equal(vl_kind_find(family, row->alias), i);
      for (uint32_t k = 0; k < row->parameter_count; k++) {
        const vlParameter *p = &row->parameters[k];
        assert_true(p->member && p->description && p->description[0]);
        assert_true(p->low <= p->high);
        if (p->name)
          assert_ptr_equal(vl_row_find(row, p->name), p); /* no name twice */
        if (p->type == VL_PARAMETER_CHOICE)
          assert_non_null(p->choices);
        if (p->type == VL_PARAMETER_EITHER_INPUT)
          assert_true(p->second);
        if (!(p->flags & VL_PARAMETER_SHORTHAND))
          assert_true(p->size);
      }
    }
  }
  assert_true(families >= 3);
  assert_null(vl_kind_family(families));
  assert_null(vl_kind_family_find("material"));
}

/* Every default is in range, and is known as the default. */
static void check_defaults(const vlKindRow *row, const void *def) {
  char message[VL_GIVEN_MESSAGE];
  for (uint32_t k = 0; k < row->parameter_count; k++) {
    const vlParameter *p = &row->parameters[k];
    if (p->flags & (VL_PARAMETER_SHORTHAND | VL_PARAMETER_REQUIRED) ||
        p->type == VL_PARAMETER_BLOCK)
      continue;
    if (!vl_parameter_check(p, def, row->description, message))
      fail_msg("%s", message);
    for (int half = 0; half < 2; half++)
      if (!vl_parameter_is_default(p, def, half))
        fail_msg("%s: %s is not the default", row->description, p->member);
  }
}

static void defaults(void **state) {
  (void)state;
  for (uint32_t i = 0; i < vl_material_family.kind_count; i++) {
    vlMaterialDef def = vl_default_material_def((vlMaterialKind)i);
    check_defaults(vl_material_family.rows[i], &def);
  }
  for (uint32_t i = 0; i < vl_texture_family.kind_count; i++) {
    vlTextureDef def = vl_default_texture_def((vlTextureKind)i, i & 1);
    check_defaults(vl_texture_family.rows[i], &def);
  }
  for (uint32_t i = 0; i < vl_pixel_filter_family.kind_count; i++) {
    vlPixelFilter def = vl_default_pixel_filter((vlPixelFilterKind)i);
    check_defaults(vl_pixel_filter_family.rows[i], &def);
  }
  /* some of pbrt's, by hand */
  assert_true(vl_default_material_def(VL_MATERIAL_SUBSURFACE).eta.value.value == 1.33f);
  assert_string_equal(vl_default_material_def(VL_MATERIAL_COATED_CONDUCTOR).eta.value.name,
                      "metal-Cu-eta");
  assert_true(vl_default_material_def(VL_MATERIAL_HAIR).hair.eumelanin.value == 1.3f);
  vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, true);
  assert_true(checks.dimension == 2 && checks.spectrum_a.value.value == 1 &&
              checks.spectrum_b.value.value == 0);
}

/* A number of each parameter that has a range, just outside of it: refused, and the message
 * names it. */
/* What a file that is silent about camera, film, sampler and tracer has: the rows and the
 * vl_default_*_def agree. */
static void silent_file(void **state) {
  (void)state;
  vlContext *context;
  vlScene *scene;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  const vlSceneDefs *defs = vl_scene_defs(scene);
  check_defaults(vl_film_family.rows[VL_FILM_RGB], defs);
  check_defaults(vl_sampler_family.rows[defs->render.sampler], defs);
  for (uint32_t i = 0; i < vl_tracer_family.kind_count; i++)
    check_defaults(vl_tracer_family.rows[i], defs);
  vlCameraDef camera = vl_default_camera_def(1280, 720);
  for (uint32_t i = VL_CAMERA_PBRT_PERSPECTIVE + 1; i < vl_camera_family.kind_count; i++)
    check_defaults(vl_camera_family.rows[i], &camera);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
}

static void out_of_range(void **state) {
  (void)state;
  vlContext *context;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  uint32_t tried = 0;
  for (uint32_t i = 0; i < vl_material_family.kind_count; i++) {
    const vlKindRow *row = vl_material_family.rows[i];
    for (uint32_t k = 0; k < row->parameter_count; k++) {
      const vlParameter *p = &row->parameters[k];
      vlMaterialDef def = vl_default_material_def((vlMaterialKind)i);
      float *number = (float *)((char *)&def + p->offset);
      if ((p->low == 0 && p->high == 0) ||
          p->flags & (VL_PARAMETER_CLAMPED | VL_PARAMETER_SHORTHAND))
        continue;
      if (p->type == VL_PARAMETER_FLOAT_INPUT)
        number = &((vlFloatInput *)(void *)number)->value;
      if (p->type == VL_PARAMETER_SPECTRUM_INPUT) {
        ((vlSpectrumInput *)(void *)number)->value = vl_spectrum_constant(0);
        number = &((vlSpectrumInput *)(void *)number)->value.value;
      }
      if (p->type == VL_PARAMETER_COUNT)
        *(uint32_t *)(void *)number = (uint32_t)p->low - 1;
      else
        *number = (float)p->low - (p->flags & VL_PARAMETER_ABOVE_LOW ? 0 : 0.1f);
      vlScene *scene;
      vlError error = {0};
      assert_int_equal(vl_scene_create(context, &scene), VL_OK);
      if (i == VL_MATERIAL_MEASURED)
        def.measured = "x.bsdf";
      assert_int_equal(vl_scene_add_material(scene, &def).index, 0);
      assert_int_equal(vl_scene_result(scene, &error), VL_ERROR_SCENE);
      if (!strstr(error.message, p->name ? p->name : p->member))
        fail_msg("%s: %s", p->member, error.message);
      vl_scene_destroy(scene);
      tried++;
    }
  }
  assert_true(tried > 15);
  vl_context_destroy(context);
}

/* A kind's def keeps what its row names and nothing else. */
static void other_members_are_left_out(void **state) {
  (void)state;
  vlContext *context;
  vlScene *scene;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  def.reflectance.value = vl_spectrum_constant(0.25f);
  def.thickness = vl_float_input(7);
  def.measured = "nothing.bsdf";
  assert_int_equal(vl_scene_add_material(scene, &def).index, 1);
  const vlMaterialDef *kept = &scene->materials.items[0];
  assert_true(kept->reflectance.value.value == 0.25f && kept->thickness.value == 0 &&
              !kept->measured);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(well_formed), cmocka_unit_test(defaults), cmocka_unit_test(silent_file),
      cmocka_unit_test(out_of_range), cmocka_unit_test(other_members_are_left_out)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
