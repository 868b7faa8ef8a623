/* test/scene/test_scene.c: the scene as filled by a program: copies, ids, defaults, rejected
 * values, counts, memory. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "failing_allocator.h"
#include "scene/scene.h"
#include "unit.h"
#include "velo/check.h"
#include "velo/edit.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/render.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

static vlContext *context;
static vlScene *scene;

static int set_up(void **state) {
  (void)state;
  return vl_context_create(NULL, &context) != VL_OK ||
         vl_scene_create(context, &scene) != VL_OK;
}

static int tear_down(void **state) {
  (void)state;
  vl_scene_destroy(scene);
  size_t left = vl_context_memory(context, NULL);
  vl_context_destroy(context);
  return left != 0;
}

static const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const uint32_t face[] = {0, 1, 2};

static vlShapeDef triangle(void) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 3;
  def.faces = 1;
  def.positions = corners;
  def.indices = face;
  return def;
}

/* The caller's memory may change right after. */
static void everything_is_copied(void **state) {
  (void)state;
  float p[9], wavelengths[2] = {400, 700}, values[2] = {1, 2};
  uint32_t v[3] = {0, 1, 2};
  char name[16] = "wall", file[16] = "a.pbrt", path[16] = "x.png", metal[32] = "metal-Au-eta";
  memcpy(p, corners, sizeof p);
  vlTextureDef t = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  t.name = name;
  t.path = path;
  t.source.file = file;
  assert_int_equal(vl_scene_add_texture(scene, &t).index, 1);
  vlMaterialDef m = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  m.name = name;
  m.normal_map = path;
  m.eta.value = vl_spectrum_named(metal);
  m.k.value = (vlSpectrum){.kind = VL_SPECTRUM_SAMPLED,
                           .scale = 1,
                           .count = 2,
                           .wavelengths = wavelengths,
                           .values = values};
  assert_int_equal(vl_scene_add_material(scene, &m).index, 1);
  vlShapeDef s = triangle();
  s.positions = p;
  s.normals = p;
  s.tangents = p;
  s.uvs = p;
  s.indices = v;
  s.source = (vlSource){file, 3, 4};
  s.material.index = 1;
  assert_int_equal(vl_scene_add_shape(scene, &s).index, 1);
  vlImage *image;
  vlImageDef id = vl_default_image_def(2, 1, 3);
  id.type = VL_PIXEL_U8;
  id.encoding = VL_ENCODING_GAMMA;
  id.gamma = 1.7f;
  assert_int_equal(vl_image_create(context, &id, &image), VL_OK);
  ((uint8_t *)vl_image_pixels(image))[5] = 77;
  float value = vl_image_get(image, 1, 0, 2);
  vlLightDef l = vl_default_light_def(VL_LIGHT_INFINITE);
  l.image = image;
  assert_int_equal(vl_scene_add_light(scene, &l).index, 1);
  vl_image_destroy(image);
  vlEmissionDef e = vl_default_emission_def();
  e.image = path;
  assert_int_equal(vl_scene_add_emission(scene, &e).index, 1);
  memset(p, 0, sizeof p);
  memset(v, 0, sizeof v);
  memset(name, 'x', 4);
  memset(file, 'x', 4);
  memset(path, 'x', 4);
  memset(metal, 'x', 9);
  wavelengths[1] = values[1] = 0;
  assert_int_equal(vl_scene_result(scene, NULL), VL_OK);
  assert_string_equal(scene->textures.items[0].name, "wall");
  assert_string_equal(scene->textures.items[0].path, "x.png");
  assert_string_equal(scene->materials.items[0].eta.value.name, "metal-Au-eta");
  assert_true(scene->materials.items[0].k.value.wavelengths[1] == 700 &&
              scene->materials.items[0].k.value.values[1] == 2);
  assert_string_equal(scene->materials.items[0].normal_map, "x.png");
  assert_true(scene->shapes.items[0].positions[3] == 1 && scene->shapes.items[0].uvs[3] == 1 &&
              scene->shapes.items[0].indices[2] == 2);
  assert_string_equal(scene->shapes.items[0].source.file, "a.pbrt");
  /* kept once */
  assert_ptr_equal(scene->shapes.items[0].source.file, scene->textures.items[0].source.file);
  assert_true(vl_image_get(scene->lights.items[0].image, 1, 0, 2) == value);
  assert_string_equal(scene->emissions.items[0].image, "x.png");
}

static void counts(void **state) {
  (void)state;
  vlShapeDef s = triangle();
  vlEmissionDef e = vl_default_emission_def();
  vlGroupId group = vl_scene_add_group(scene, "chair");
  const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  s.emission = vl_scene_add_emission(scene, &e);
  vl_scene_add_shape(scene, &s);
  s.group = group;
  s.emission.index = 0;
  vl_scene_add_shape(scene, &s);
  vlShapeDef sphere = vl_default_shape_def(VL_SHAPE_SPHERE);
  vl_scene_add_shape(scene, &sphere);
  vl_scene_add_instance(scene, group, m, (vlSource){0});
  vl_scene_add_instance(scene, group, m, (vlSource){0});
  assert_int_equal(vl_scene_result(scene, NULL), VL_OK);
  vlSceneInfo info;
  vl_scene_info(scene, &info);
  assert_int_equal(info.shapes, 3);
  assert_int_equal(info.triangles, 2);
  assert_int_equal(info.vertices, 6);
  assert_int_equal(info.emissive_shapes, 1);
  assert_int_equal(info.groups, 1);
  assert_int_equal(info.instances, 2);
  assert_int_equal(scene->groups.items[0].shape_count, 1);
}

/* Each refusal in a scene of its own; the first error stays, later adds give 0. */
static void refuses(vlResult code, const char *message) {
  vlError error;
  vlResult result = vl_scene_result(scene, &error);
  if (result != code || strcmp(error.message, message) != 0)
    print_message("%s: %s\n not %s\n", vl_result_name(result), error.message, message);
  assert_int_equal(result, code);
  assert_string_equal(error.message, message);
  vlShapeDef good = triangle();
  assert_int_equal(vl_scene_add_shape(scene, &good).index, 0);
  assert_int_equal(vl_scene_add_group(scene, "g").index, 0);
  vl_scene_destroy(scene);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
}

static void bad_shapes(void **state) {
  (void)state;
  float p[9];
  uint32_t v[3];
  vlShapeDef d = {0};
  assert_int_equal(vl_scene_add_shape(scene, &d).index, 0);
  refuses(VL_ERROR_ARGUMENT, "shape: def.cookie is not that of a default def of this version");
#define BAD(change, message)          \
  do {                                \
    memcpy(p, corners, sizeof p);     \
    memcpy(v, face, sizeof v);        \
    d = triangle();                   \
    d.positions = p;                  \
    d.indices = v;                    \
    change;                           \
    vl_scene_add_shape(scene, &d);    \
    refuses(VL_ERROR_SCENE, message); \
  } while (0)
  BAD(v[1] = 3, "triangle 0 names vertex 3, but there are only 3 vertices (0 to 2)");
  BAD(v[2] = UINT32_MAX,
      "triangle 0 names vertex 4294967295, but there are only 3 vertices (0 to 2)");
  BAD(p[7] = NAN, "position of vertex 2 is not finite (y is nan)");
  BAD(p[2] = -INFINITY, "position of vertex 0 is not finite (z is -inf)");
  BAD((d.normals = p, p[3] = INFINITY, d.positions = corners),
      "normal of vertex 1 is not finite (x is inf)");
  BAD((d.uvs = p, p[3] = NAN, d.positions = corners),
      "uv of vertex 1 is not finite (v is nan)");
  BAD(d.vertices = 0, "mesh has no vertices");
  BAD(d.faces = 0, "mesh has no faces");
  BAD(d.indices = NULL, "mesh has no faces");
  BAD(d.group.index = 1, "there is no such group");
  BAD(d.material.index = 1, "there is no such material");
  BAD(d.emission.index = 1, "there is no such emission");
  BAD(d.alpha.texture.index = 1,
      "trianglemesh: parameter \"alpha\" names a texture that does not exist (add it first)");
  BAD(d.group_from_shape[3] = NAN, "transform of the shape is not finite");
  BAD(d.group_from_shape[0] = 0, "transform of the shape is singular: it flattens the shape");
#undef BAD
  const struct {
    vlShapeKind kind;
    size_t offset;
    float value;
    const char *message;
  } quadrics[] = {
      {VL_SHAPE_SPHERE, offsetof(vlShapeDef, radius), 0,
       "sphere: parameter \"radius\" must be a number above 0; it is 0"},
      {VL_SHAPE_DISK, offsetof(vlShapeDef, radius), -2,
       "disk: parameter \"radius\" must be a number above 0; it is -2"},
      {VL_SHAPE_CYLINDER, offsetof(vlShapeDef, radius), NAN,
       "cylinder: parameter \"radius\" must be a number above 0; it is nan"},
      {VL_SHAPE_DISK, offsetof(vlShapeDef, inner_radius), 1,
       "inner radius must be less than the radius"},
      {VL_SHAPE_CYLINDER, offsetof(vlShapeDef, z_min), 1, "zmin must be below zmax"},
      {VL_SHAPE_SPHERE, offsetof(vlShapeDef, phi_max), 0,
       "sphere: parameter \"phimax\" must be a number above 0 degrees; it is 0 degrees"}};
  for (size_t i = 0; i < sizeof quadrics / sizeof *quadrics; i++) {
    d = vl_default_shape_def(quadrics[i].kind);
    memcpy((char *)&d + quadrics[i].offset, &quadrics[i].value, sizeof(float));
    vl_scene_add_shape(scene, &d);
    refuses(VL_ERROR_SCENE, quadrics[i].message);
  }
  const double m[16] = {1, 0, 0, NAN};
  vl_scene_add_instance(scene, (vlGroupId){1}, m, (vlSource){0});
  refuses(VL_ERROR_SCENE, "instance: there is no such group");
  vl_scene_add_instance(scene, vl_scene_add_group(scene, NULL), m, (vlSource){0});
  refuses(VL_ERROR_SCENE, "instance: transform is not finite");
}

static void bad_materials_and_lights(void **state) {
  (void)state;
  vlMaterialDef m = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  m.reflectance.value = vl_spectrum_rgb(1, NAN, 0);
  vl_scene_add_material(scene, &m);
  refuses(VL_ERROR_SCENE,
          "diffuse material: parameter \"reflectance\": rgb value is not finite");
  m = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  m.eta.value = vl_spectrum_named("metal-MgO-etta");
  vl_scene_add_material(scene, &m);
  refuses(VL_ERROR_SCENE,
          "conductor material: parameter \"eta\": no spectrum is named "
          "\"metal-MgO-etta\" (did you mean \"metal-MgO-eta\"?)");
  m = vl_default_material_def(VL_MATERIAL_MIX);
  vl_scene_add_material(scene, &m);
  refuses(VL_ERROR_SCENE, "mix material: needs two materials");
  /* itself: what is not there yet cannot be named, so no circles */
  m.materials[0].index = m.materials[1].index = 1;
  vl_scene_add_material(scene, &m);
  refuses(VL_ERROR_SCENE, "mix material: there is no such material (add its parts first)");
  vlTextureDef t = vl_default_texture_def(VL_TEXTURE_SCALE, false);
  t.float_a.texture.index = 1;
  vl_scene_add_texture(scene, &t);
  refuses(
      VL_ERROR_SCENE,
      "scale texture: parameter \"tex\" names a texture that does not exist (add it first)");
  t = vl_default_texture_def(VL_TEXTURE_CONSTANT, false);
  vlTextureId number = vl_scene_add_texture(scene, &t);
  m = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  m.reflectance.texture = number;
  vl_scene_add_material(scene, &m);
  refuses(
      VL_ERROR_SCENE,
      "diffuse material: parameter \"reflectance\" needs a spectrum texture, this is a float "
      "texture");
  t = vl_default_texture_def(VL_TEXTURE_IMAGE, false);
  vl_scene_add_texture(scene, &t);
  refuses(VL_ERROR_SCENE, "imagemap texture: needs either a file name or an image");
  vlLightDef l = vl_default_light_def(VL_LIGHT_DISTANT);
  l.to[2] = 0;
  vl_scene_add_light(scene, &l);
  refuses(VL_ERROR_SCENE, "light: from and to are the same point: it has no direction");
  l = vl_default_light_def(VL_LIGHT_POINT);
  l.power = INFINITY;
  vl_scene_add_light(scene, &l);
  refuses(VL_ERROR_SCENE,
          "point light: parameter \"power\" must be a finite number; it is inf");
  l.cookie = 0;
  vl_scene_add_light(scene, &l);
  refuses(VL_ERROR_ARGUMENT, "light: def.cookie is not that of a default def of this version");
  float down[] = {500, 400};
  vlEmissionDef e = vl_default_emission_def();
  e.radiance = (vlSpectrum){
      .kind = VL_SPECTRUM_SAMPLED, .scale = 1, .count = 2, .wavelengths = down, .values = down};
  vl_scene_add_emission(scene, &e);
  refuses(VL_ERROR_SCENE,
          "emission: parameter \"L\": wavelengths of the sampled spectrum are not ascending");
}

static void names_of_spectra(void **state) {
  (void)state;
  uint32_t n = 0;
  bool gold = false;
  for (const char *name; (name = vl_spectrum_name(n)); n++)
    gold = gold || strcmp(name, "metal-Au-eta") == 0;
  assert_true(n >= 8 && gold);
  assert_null(vl_spectrum_name(n + 1000));
}

/* A mesh of a million triangles is checked and copied in a moment. */
static void large_mesh(void **state) {
  (void)state;
  enum { N = 1000 };
  uint32_t vertices = (N + 1) * (N + 1), n = 0;
  float *p = malloc(vertices * 3 * sizeof *p);
  uint32_t *v = malloc((size_t)N * N * 6 * sizeof *v);
  for (uint32_t i = 0; i < vertices; i++) {
    p[3 * i] = (float)(i % (N + 1));
    p[3 * i + 1] = (float)(i / (N + 1));
    p[3 * i + 2] = 0;
  }
  for (uint32_t y = 0; y < N; y++)
    for (uint32_t x = 0; x < N; x++) {
      uint32_t a = y * (N + 1) + x, quad[] = {a, a + 1, a + N + 2, a, a + N + 2, a + N + 1};
      memcpy(v + n, quad, sizeof quad);
      n += 6;
    }
  vlShapeDef d = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  d.vertices = vertices;
  d.faces = 2 * N * N;
  d.positions = p;
  d.indices = v;
  assert_int_equal(vl_scene_add_shape(scene, &d).index, 1);
  p[3 * 777777 + 1] = NAN;
  assert_int_equal(vl_scene_add_shape(scene, &d).index, 0);
  refuses(VL_ERROR_SCENE, "position of vertex 777777 is not finite (y is nan)");
  free(p);
  free(v);
}

/* ---- out of memory ----------------------------------------------------------------------- */

static vlResult fill(vlContext *from, void *user) {
  (void)user;
  vlScene *s;
  vlResult result = vl_scene_create(from, &s);
  if (result != VL_OK)
    return result;
  vlTextureDef t = vl_default_texture_def(VL_TEXTURE_CONSTANT, true);
  t.name = "t";
  t.source.file = "a.pbrt";
  vlMaterialDef m = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  m.reflectance.texture = vl_scene_add_texture(s, &t);
  m.normal_map = "n.png";
  vlMaterialDef mix = vl_default_material_def(VL_MATERIAL_MIX);
  mix.materials[0] = mix.materials[1] = vl_scene_add_material(s, &m);
  vl_scene_add_material(s, &mix);
  vlEmissionDef e = vl_default_emission_def();
  e.image = "e.png";
  vlLightDef l = vl_default_light_def(VL_LIGHT_INFINITE);
  l.path = "l.exr";
  vl_scene_add_light(s, &l);
  vlShapeDef d = triangle();
  d.normals = corners;
  d.uvs = corners;
  d.tangents = corners;
  d.group = vl_scene_add_group(s, "g");
  d.emission = vl_scene_add_emission(s, &e);
  vl_scene_add_shape(s, &d);
  const double one[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  vl_scene_add_instance(s, d.group, one, (vlSource){"b.pbrt", 1, 1});
  result = vl_scene_result(s, NULL);
  if (result == VL_OK)
    result = vl_scene_remove_shape(s, (vlShapeId){1}, NULL);
  vl_scene_destroy(s);
  return result;
}

static void out_of_memory(void **state) {
  (void)state;
  fail_everywhere(fill, NULL, 20);
}

/* Everything that was added is taken back with its memory, whether an error ended it or not;
 * then the same ids are given again. */
static void checkpoints(void **state) {
  (void)state;
  const double one[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  vlShapeDef d = triangle();
  d.group = vl_scene_add_group(scene, "first");
  vl_scene_add_shape(scene, &d);
  vl_scene_defs(scene)->film.width = 77;
  vlSceneInfo before, after;
  vl_scene_info(scene, &before);
  size_t held = 0;
  for (int round = 0; round < 8; round++) {
    vlSceneCheckpoint *checkpoint;
    assert_int_equal(vl_scene_checkpoint(scene, &checkpoint, NULL), VL_OK);
    assert_int_equal(vl_scene_add_shape(scene, &d).index, 2);
    vl_scene_add_instance(scene, d.group, one, (vlSource){"c.pbrt", 1, 1});
    assert_int_equal(scene->groups.items[0].shape_count, 2);
    vlMaterialDef m = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    m.name = "lost";
    vl_scene_add_material(scene, &m);
    vl_scene_defs(scene)->film.width = 5;
    m.reflectance = vl_spectrum_input(vl_spectrum_named(round % 2 ? "none" : "metal-Au-eta"));
    assert_int_equal(vl_scene_add_material(scene, &m).index, round % 2 ? 0 : 2);
    assert_int_equal(vl_scene_result(scene, NULL), round % 2 ? VL_ERROR_SCENE : VL_OK);
    vl_scene_roll_back(scene, checkpoint);
    assert_int_equal(vl_scene_result(scene, NULL), VL_OK);
    vl_scene_info(scene, &after);
    assert_memory_equal(&before, &after, sizeof before);
    assert_int_equal(scene->groups.items[0].shape_count, 1);
    assert_int_equal(vl_scene_defs(scene)->film.width, 77);
    const size_t now = vl_context_memory(context, NULL);
    assert_true(round == 0 || now == held);
    held = now;
  }
  assert_int_equal(vl_scene_checkpoint(NULL, NULL, NULL), VL_ERROR_ARGUMENT);
  vl_scene_checkpoint_destroy(NULL);
}

/* A shape that is set or removed gives its memory back; its place is given again. */
static void changed_shapes(void **state) {
  (void)state;
  vlShapeDef d = triangle();
  d.label.name = "first";
  d.group = vl_scene_add_group(scene, "g");
  const vlShapeId id = vl_scene_add_shape(scene, &d);
  d.group.index = 0;
  vl_scene_add_shape(scene, &d);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  vlSceneInfo info;
  size_t held = 0;
  for (int round = 0; round < 20; round++) {
    assert_int_equal(vl_scene_set_shape(scene, id, round % 2 ? &ball : &d, NULL), VL_OK);
    assert_int_equal(vl_scene_shape(scene, id)->kind, (round % 2 ? ball : d).kind);
    assert_int_equal(scene->groups.items[0].shape_count, 0);
    assert_int_equal(vl_scene_remove_shape(scene, id, NULL), VL_OK);
    assert_null(vl_scene_shape(scene, id));
    vl_scene_info(scene, &info);
    assert_int_equal(info.shapes, 1);
    assert_int_equal(vl_scene_kind_count(scene, "shapes", VL_SHAPE_TRIANGLES), 1);
    assert_int_equal(vl_scene_removed_shape(scene).index, id.index);
    assert_int_equal(vl_scene_remove_shape(scene, id, NULL), VL_ERROR_ARGUMENT);
    assert_int_equal(vl_scene_show_shape(scene, id, true, NULL), VL_ERROR_ARGUMENT);
    assert_int_equal(vl_scene_shape_serial(scene, id), 0);
    vlCheck *doctor; /* passes over it */
    assert_int_equal(vl_scene_check(scene, NULL, &doctor, NULL), VL_OK);
    vl_check_destroy(doctor);
    assert_true(round == 0 || vl_context_memory(context, NULL) == held);
    held = vl_context_memory(context, NULL);
    assert_int_equal(vl_scene_set_shape(scene, id, &d, NULL), VL_OK);
    assert_true(vl_scene_shape_serial(scene, id) > 0);
    assert_int_equal(vl_scene_removed_shape(scene).index, 0);
  }
  const vlShapeDef own = *vl_scene_shape(scene, id); /* its arrays are the scene's */
  assert_int_equal(vl_scene_set_shape(scene, id, &own, NULL), VL_OK);
  assert_memory_equal(vl_scene_shape(scene, id)->positions, corners, sizeof corners);
  d.faces = 0;
  assert_int_equal(vl_scene_set_shape(scene, id, &d, NULL), VL_ERROR_SCENE);
  assert_memory_equal(vl_scene_shape(scene, id)->positions, corners, sizeof corners);
  assert_int_equal(vl_scene_result(scene, NULL), VL_OK);
  assert_int_equal(vl_scene_set_shape(scene, (vlShapeId){3}, &d, NULL), VL_ERROR_ARGUMENT);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
  const struct CMUnitTest tests[] = {TEST(everything_is_copied), TEST(counts),
                                     TEST(bad_shapes),           TEST(bad_materials_and_lights),
                                     TEST(names_of_spectra),     TEST(large_mesh),
                                     TEST(out_of_memory),        TEST(checkpoints),
                                     TEST(changed_shapes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
