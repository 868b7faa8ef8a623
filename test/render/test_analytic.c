/* test/render/test_analytic.c: images of known value: closed spheres with light inside (pbrt's
 * analytic integrator tests), white furnaces, solid angles. Means over the whole image are
 * compared with the exact number. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "unit.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/render.h"
#include "velo/shape_kinds.h"

typedef struct Bench {
  vlContext *context;
  vlScene *scene;
} Bench;

static Bench begin(void) {
  Bench b = {NULL, NULL};
  assert_int_equal(vl_context_create(NULL, &b.context), VL_OK);
  assert_int_equal(vl_scene_create(b.context, &b.scene), VL_OK);
  return b;
}

static vlShapeId add_sphere(Bench *b, double radius, vlMaterialId material,
                            vlEmissionId emission, bool inside_out) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.radius = (float)radius;
  def.z_min = (float)-radius;
  def.z_max = (float)radius;
  def.material = material;
  def.emission = emission;
  def.reverse_orientation = inside_out;
  return vl_scene_add_shape(b->scene, &def);
}

/* A sphere of triangles: a subdivided octahedron, its vertices on the sphere. */
static void add_mesh_sphere(Bench *b, float radius, vlMaterialId material,
                            vlEmissionId emission, bool inside_out) {
  enum { N = 24 };
  static float p[(N + 1) * (2 * N + 1) * 3];
  static uint32_t index[N * 2 * N * 6];
  uint32_t v = 0, t = 0;
  for (int i = 0; i <= N; i++)
    for (int j = 0; j <= 2 * N; j++) {
      double theta = M_PI * i / N, phi = M_PI * (j % (2 * N)) / N;
      p[v++] = radius * (float)(sin(theta) * cos(phi));
      p[v++] = radius * (float)(sin(theta) * sin(phi));
      p[v++] = radius * (float)cos(theta);
    }
  for (uint32_t i = 0; i < N; i++)
    for (uint32_t j = 0; j < 2 * N; j++) {
      uint32_t a = i * (2 * N + 1) + j, c = a + 2 * N + 1;
      uint32_t f[6] = {a, c, a + 1, a + 1, c, c + 1};
      memcpy(index + t, f, sizeof f);
      t += 6;
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = v / 3;
  def.faces = t / 3;
  def.positions = p;
  def.indices = index;
  def.material = material;
  def.emission = emission;
  def.reverse_orientation = inside_out;
  assert_int_not_equal(vl_scene_add_shape(b->scene, &def).index, 0);
}

static vlMaterialId diffuse(Bench *b, float albedo) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  def.reflectance = vl_spectrum_input(vl_spectrum_constant(albedo));
  return vl_scene_add_material(b->scene, &def);
}

static vlEmissionId emission(Bench *b, float radiance) {
  vlEmissionDef def = vl_default_emission_def();
  def.radiance = vl_spectrum_rgb(radiance, radiance, radiance);
  return vl_scene_add_emission(b->scene, &def);
}

static void sky(Bench *b) {
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  def.color = vl_spectrum_rgb(1, 1, 1);
  assert_int_not_equal(vl_scene_add_light(b->scene, &def).index, 0);
}

typedef struct Shot {
  double eye[3], lookat[3], fov;
  uint32_t size, spp, max_depth;
  vlColorMode color;
} Shot;

/* Renders and returns the means of R, G, B; extremes of G in range, if asked for. Frees the
 * bench. */
static void finish(Bench *b, Shot shot, double mean[3], double range[2]) {
  vlBuildDef build = vl_default_build_def();
  build.color = shot.color;
  vlWorld *world = NULL;
  vlError error;
  assert_int_equal(vl_world_build(b->scene, &build, &world, &error), VL_OK);
  vlCameraDef camera_def = vl_default_camera_def(shot.size, shot.size);
  memcpy(camera_def.eye, shot.eye, sizeof shot.eye);
  memcpy(camera_def.lookat, shot.lookat, sizeof shot.lookat);
  camera_def.fov = shot.fov;
  vlCamera camera;
  assert_int_equal(vl_camera_make(&camera_def, &camera, NULL, &error), VL_OK);
  vlFilmDef film_def = vl_default_film_def(shot.size, shot.size);
  vlFilm *film = NULL;
  assert_int_equal(vl_film_create(b->context, &film_def, &film), VL_OK);
  vlRenderDef def = vl_default_render_def();
  def.spp = shot.spp;
  def.max_depth = shot.max_depth;
  vlRenderStats stats;
  assert_int_equal(vl_render(world, &camera, film, &def, &stats, &error), VL_OK);
  assert_int_equal(stats.not_finite, 0);
  vlImage *image = NULL;
  vlDevelopDef develop = vl_default_develop_def();
  assert_int_equal(vl_film_develop(film, &develop, &image), VL_OK);
  mean[0] = mean[1] = mean[2] = 0;
  double low = INFINITY, high = -INFINITY;
  for (uint32_t y = 0; y < shot.size; y++)
    for (uint32_t x = 0; x < shot.size; x++) {
      for (uint32_t c = 0; c < 3; c++)
        mean[c] += vl_image_get(image, x, y, c);
      double g = vl_image_get(image, x, y, 1);
      low = g < low ? g : low;
      high = g > high ? g : high;
    }
  for (int c = 0; c < 3; c++)
    mean[c] /= (double)shot.size * shot.size;
  if (range) {
    range[0] = low;
    range[1] = high;
  }
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(b->scene);
  size_t held = vl_context_memory(b->context, NULL);
  assert_int_equal(held, 0);
  vl_context_destroy(b->context);
}

static void assert_mean(const char *what, const double mean[3], double expected,
                        double tolerance) {
  for (int c = 0; c < 3; c++)
    if (!(fabs(mean[c] - expected) <= tolerance * expected))
      fail_msg("%s: channel %d has mean %.6f, expected %.6f within %.2g", what, c, mean[c],
               expected, tolerance);
}

static const Shot inside = {{0, 0, 0}, {0.2, 0.1, -1}, 1.2, 48, 64, 200, VL_COLOR_SPECTRAL};

/* In a closed diffuse sphere the radiance is the emitted one / (1 - albedo). */
static void emissive_sphere(void **state) {
  (void)state;
  for (int rgb = 0; rgb < 2; rgb++) {
    Bench b = begin();
    add_sphere(&b, 1, diffuse(&b, 0.5f), emission(&b, 0.5f), true);
    double mean[3], range[2];
    Shot shot = inside;
    shot.color = rgb ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
    finish(&b, shot, mean, range);
    assert_mean("emissive sphere", mean, 1, 1e-3);
  }
}

static void emissive_mesh_sphere(void **state) {
  (void)state;
  Bench b = begin();
  add_mesh_sphere(&b, 1, diffuse(&b, 0.5f), emission(&b, 0.5f), true);
  double mean[3];
  finish(&b, inside, mean, NULL);
  assert_mean("emissive sphere of triangles", mean, 1, 1e-3);
}

/* A point light of intensity I in the middle lights the wall with I; the wall reflects albedo /
 * pi of it, and so on. */
static void point_light_in_sphere(void **state) {
  (void)state;
  Bench b = begin();
  add_sphere(&b, 1, diffuse(&b, 0.5f), (vlEmissionId){0}, true);
  vlLightDef light = vl_default_light_def(VL_LIGHT_POINT);
  light.color = vl_spectrum_rgb(1, 1, 1);
  light.scale = (float)M_PI;
  vl_scene_add_light(b.scene, &light);
  double mean[3];
  finish(&b, inside, mean, NULL);
  assert_mean("point light in a sphere", mean, 1, 1e-3);
}

/* Light cannot leak through a closed mesh, whatever its position and size. */
static void closed_mesh_is_tight(void **state) {
  (void)state;
  const float radii[3] = {1e-3f, 1, 1e4f};
  for (int i = 0; i < 3; i++) {
    Bench b = begin();
    sky(&b); /* outside: must never be seen */
    add_mesh_sphere(&b, radii[i], diffuse(&b, 0.9f), (vlEmissionId){0}, true);
    double mean[3];
    Shot shot = inside;
    shot.spp = 16;
    finish(&b, shot, mean, NULL);
    for (int c = 0; c < 3; c++)
      assert_true(mean[c] == 0);
  }
}

/* ---- white furnaces: what loses no light cannot be seen before a white sky --------------- */

static void furnace(const char *what, vlMaterialDef *def, bool mesh) {
  Bench b = begin();
  vlMaterialId material = vl_scene_add_material(b.scene, def);
  assert_int_not_equal(material.index, 0);
  if (mesh)
    add_mesh_sphere(&b, 1, material, (vlEmissionId){0}, false);
  else
    add_sphere(&b, 1, material, (vlEmissionId){0}, false);
  sky(&b);
  Shot shot = {{0, 0, 4}, {0, 0, 0}, 0.4, 48, 64, 1000, VL_COLOR_SPECTRAL};
  double mean[3];
  finish(&b, shot, mean, NULL);
  assert_mean(what, mean, 1, 1e-3);
}

static void white_furnace(void **state) {
  (void)state;
  for (int mesh = 0; mesh < 2; mesh++) {
    vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
    def.reflectance = vl_spectrum_input(vl_spectrum_constant(1));
    furnace("diffuse", &def, mesh);
    def = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
    def.u_roughness = def.v_roughness = vl_float_input(0);
    furnace("dielectric", &def, mesh);
    def = vl_default_material_def(VL_MATERIAL_THIN_DIELECTRIC);
    furnace("thin dielectric", &def, mesh);
    def = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
    def.eta = vl_spectrum_input(vl_spectrum_constant(1));
    def.k = vl_spectrum_input(vl_spectrum_constant(1e5f)); /* reflects all but 4 in 10^10 */
    def.u_roughness = def.v_roughness = vl_float_input(0);
    furnace("conductor", &def, mesh);
    def = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
    def.reflectance = vl_spectrum_input(vl_spectrum_constant(1));
    def.u_roughness = def.v_roughness = vl_float_input(0);
    def.thickness = vl_float_input(0);
    def.max_depth = 400;
    furnace("coated diffuse", &def, mesh);
  }
}

/* A floor below a round lamp: irradiance under its centre is pi L r^2 / (r^2 + h^2). */
static void disk_over_floor(void **state) {
  (void)state;
  Bench b = begin();
  vlShapeDef lamp = vl_default_shape_def(VL_SHAPE_DISK);
  lamp.radius = 1;
  lamp.emission = emission(&b, 1);
  lamp.material = diffuse(&b, 0);
  lamp.reverse_orientation = true; /* emits downwards */
  lamp.height = 2;
  vl_scene_add_shape(b.scene, &lamp);
  vlShapeDef floor = vl_default_shape_def(VL_SHAPE_DISK);
  floor.radius = 10;
  floor.material = diffuse(&b, 0.8f);
  vl_scene_add_shape(b.scene, &floor);
  double mean[3];
  Shot shot = {{0, 0.001, 1.5}, {0, 0, 0}, 0.002, 16, 256, 1, VL_COLOR_SPECTRAL};
  finish(&b, shot, mean, NULL);
  assert_mean("disk over a floor", mean, 0.8 * 1.0 / 5.0, 1e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(emissive_sphere),       cmocka_unit_test(emissive_mesh_sphere),
      cmocka_unit_test(point_light_in_sphere), cmocka_unit_test(closed_mesh_is_tight),
      cmocka_unit_test(white_furnace),         cmocka_unit_test(disk_over_floor),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
