/* test/api/test_remove.c: objects of every family are removed; an error names who still uses
 * one; places are given again, with other serials; all memory comes back. */
#include <string.h>

#include "unit.h"
#include "velo/edit.h"
#include "velo/velo.h"

typedef struct Fixture {
  vlContext *context;
  vlScene *scene;
  vlTextureId texture;
  vlMaterialId material;
  vlEmissionId emission;
  vlMediumId medium;
  vlLightId light;
  vlGroupId group;
  vlShapeId shape;
  vlInstanceId instance;
} Fixture;

static const float wavelengths[2] = {400, 700};
static const float values[2] = {0.25f, 0.5f};

static vlSpectrum sampled(void) {
  return (vlSpectrum){.kind = VL_SPECTRUM_SAMPLED,
                      .scale = 1,
                      .wavelengths = wavelengths,
                      .values = values,
                      .count = 2};
}

static void add_looks(Fixture *f) {
  vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_CONSTANT, true);
  texture.name = "stone";
  texture.spectrum_a.value = sampled();
  f->texture = vl_scene_add_texture(f->scene, &texture);
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  material.name = "grey";
  material.reflectance.texture = f->texture;
  f->material = vl_scene_add_material(f->scene, &material);
  vlEmissionDef emission = vl_default_emission_def();
  emission.radiance = sampled();
  f->emission = vl_scene_add_emission(f->scene, &emission);
  vlMediumDef medium = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  medium.name = "fog";
  f->medium = vl_scene_add_medium(f->scene, &medium);
  vlLightDef light = vl_default_light_def(VL_LIGHT_POINT);
  light.color = sampled();
  light.medium = f->medium;
  f->light = vl_scene_add_light(f->scene, &light);
}

static void add_things(Fixture *f) {
  static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  add_looks(f);
  f->group = vl_scene_add_group(f->scene, "pile");
  vlShapeDef shape = vl_default_shape_def(VL_SHAPE_SPHERE);
  shape.label.name = "ball";
  shape.group = f->group;
  shape.material = f->material;
  shape.emission = f->emission;
  f->shape = vl_scene_add_shape(f->scene, &shape);
  f->instance = vl_scene_add_instance(f->scene, f->group, identity, (vlSource){0});
  assert_int_equal(vl_scene_result(f->scene, NULL), VL_OK);
}

static Fixture begin(void) {
  Fixture f = {0};
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  assert_int_equal(vl_context_create(&def, &f.context), VL_OK);
  assert_int_equal(vl_scene_create(f.context, &f.scene), VL_OK);
  return f;
}

static void end(Fixture *f) {
  vl_scene_destroy(f->scene);
  assert_int_equal(vl_context_memory(f->context, NULL), 0);
  vl_context_destroy(f->context);
}

static void refused(const Fixture *f, vlSceneFamily family, uint32_t index, const char *text) {
  vlError error;
  assert_int_equal(vl_scene_remove(f->scene, family, index, &error), VL_ERROR_SCENE);
  assert_string_equal(error.message, text);
  assert_true(vl_scene_has(f->scene, family, index));
  assert_int_equal(vl_scene_result(f->scene, NULL), VL_OK);
}

static void removed(const Fixture *f, vlSceneFamily family, uint32_t index) {
  assert_int_equal(vl_scene_remove(f->scene, family, index, NULL), VL_OK);
  assert_false(vl_scene_has(f->scene, family, index));
  assert_int_equal(vl_scene_remove(f->scene, family, index, NULL), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_serial(f->scene, family, index), 0);
}

static void remove_all(const Fixture *f) {
  removed(f, VL_SCENE_INSTANCES, f->instance.index);
  removed(f, VL_SCENE_GROUPS, f->group.index); /* with its shape */
  assert_false(vl_scene_has(f->scene, VL_SCENE_SHAPES, f->shape.index));
  removed(f, VL_SCENE_LIGHTS, f->light.index);
  removed(f, VL_SCENE_MEDIA, f->medium.index);
  removed(f, VL_SCENE_EMISSIONS, f->emission.index);
  removed(f, VL_SCENE_MATERIALS, f->material.index);
  removed(f, VL_SCENE_TEXTURES, f->texture.index);
}

static void users_are_named(void **state) {
  (void)state;
  Fixture f = begin();
  add_things(&f);
  refused(&f, VL_SCENE_TEXTURES, f.texture.index,
          "texture: it cannot be removed, material \"grey\" uses it");
  refused(&f, VL_SCENE_MATERIALS, f.material.index,
          "material: it cannot be removed, shape \"ball\" uses it");
  refused(&f, VL_SCENE_EMISSIONS, f.emission.index,
          "emission: it cannot be removed, shape \"ball\" uses it");
  refused(&f, VL_SCENE_MEDIA, f.medium.index,
          "medium: it cannot be removed, light number 1 uses it");
  refused(&f, VL_SCENE_GROUPS, f.group.index,
          "group: it cannot be removed, instance number 1 uses it");
  vl_scene_defs(f.scene)->camera_medium = f.medium;
  assert_int_equal(vl_scene_remove(f.scene, VL_SCENE_LIGHTS, f.light.index, NULL), VL_OK);
  refused(&f, VL_SCENE_MEDIA, f.medium.index,
          "medium: it cannot be removed, the camera uses it");
  end(&f);
}

static void ids_of_removed_objects_are_refused(void **state) {
  (void)state;
  Fixture f = begin();
  add_things(&f);
  remove_all(&f);
  assert_null(vl_scene_texture(f.scene, f.texture));
  assert_null(vl_scene_material(f.scene, f.material));
  assert_null(vl_scene_emission(f.scene, f.emission));
  assert_null(vl_scene_medium(f.scene, f.medium));
  assert_null(vl_scene_light(f.scene, f.light));
  vlSceneInfo info;
  vl_scene_info(f.scene, &info);
  const vlSceneInfo none = {0};
  assert_memory_equal(&info, &none, sizeof info);
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  material.reflectance.texture = f.texture;
  assert_int_equal(vl_scene_add_material(f.scene, &material).index, 0);
  end(&f);
}

static void places_are_given_again(void **state) {
  (void)state;
  Fixture f = begin();
  add_things(&f);
  Fixture later = f; /* the same once more, so that the places are not the last ones */
  add_things(&later);
  const uint64_t held = vl_context_memory(f.context, NULL);
  remove_all(&f);
  vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_CONSTANT, false);
  assert_int_equal(vl_scene_removed(f.scene, VL_SCENE_TEXTURES, &texture), f.texture.index);
  assert_int_equal(vl_scene_set_texture(f.scene, f.texture, &texture, NULL), VL_OK);
  assert_int_not_equal(vl_scene_serial(f.scene, VL_SCENE_TEXTURES, f.texture.index), 0);
  assert_int_equal(vl_scene_removed(f.scene, VL_SCENE_TEXTURES, NULL), 0);
  vlMaterialDef mix = vl_default_material_def(VL_MATERIAL_MIX);
  mix.materials[0] = mix.materials[1] = f.material;
  assert_int_equal(vl_scene_removed(f.scene, VL_SCENE_MATERIALS, &mix), 0); /* it is above */
  assert_int_equal(vl_scene_removed(f.scene, VL_SCENE_MATERIALS, NULL), f.material.index);
  assert_int_equal(vl_scene_set_group(f.scene, f.group, "other", NULL), VL_OK);
  assert_true(vl_scene_has(f.scene, VL_SCENE_GROUPS, f.group.index));
  assert_int_not_equal(vl_scene_serial(f.scene, VL_SCENE_GROUPS, f.group.index), 0);
  assert_true(vl_context_memory(f.context, NULL) < held + 2048);
  end(&f);
}

static void the_last_places_are_cut_off(void **state) {
  (void)state;
  Fixture f = begin();
  add_things(&f);
  Fixture later = f;
  add_things(&later);
  remove_all(&f);
  assert_int_equal(vl_scene_highest(f.scene, VL_SCENE_LIGHTS), 2);
  remove_all(&later);
  for (int family = VL_SCENE_TEXTURES; family <= VL_SCENE_SHAPES; family++)
    assert_int_equal(vl_scene_highest(f.scene, (vlSceneFamily)family), 0);
  assert_int_equal(vl_scene_removed_shape(f.scene).index, 0);
  add_looks(&f); /* as a file that is loaded adds them */
  assert_int_equal(f.light.index, 1);
  assert_int_not_equal(vl_scene_serial(f.scene, VL_SCENE_LIGHTS, 1), 0);
  end(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(users_are_named),
      cmocka_unit_test(ids_of_removed_objects_are_refused),
      cmocka_unit_test(places_are_given_again),
      cmocka_unit_test(the_last_places_are_cut_off),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
