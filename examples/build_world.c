/* build_world: builds a world with velo's public API, as the lecture's World::build does, and renders it: a pinhole
 * camera with eye (300, 400, 500), lookat (0, 0, -50) and view-plane distance 400, three spheres on a plane, one lamp.
 *
 *   build_world IMAGE [IMAGE...]     the suffix selects the format: .exr is linear, .png is for displays
 *   build/release/bin/example_build_world examples/build_world.jpg
 *
 * To compile it against an installed velo:
 *   cc -std=c17 build_world.c $(pkg-config --cflags --libs velo) -o build_world
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <velo/velo.h>

/* Checks the result of a call: on an error, prints one line and exits. */
static void must(vlResult result, const char *what, const vlError *error) {
  if (result == VL_OK) return;
  fprintf(stderr, "build_world: %s: %s%s%s\n", what, vl_result_name(result), error ? ": " : "",
          error ? error->message : "");
  exit(1);
}

static vlMaterialId add_matte(vlScene *scene, float r, float g, float b) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  def.reflectance = vl_spectrum_input(vl_spectrum_rgb(r, g, b));
  return vl_scene_add_material(scene, &def);
}

static vlMaterialId add_metal(vlScene *scene, const char *eta, const char *k, float roughness) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  def.eta = vl_spectrum_input(vl_spectrum_named(eta));
  def.k = vl_spectrum_input(vl_spectrum_named(k));
  def.u_roughness = def.v_roughness = vl_float_input(roughness);
  return vl_scene_add_material(scene, &def);
}

static void add_sphere(vlScene *scene, float x, float y, float z, float radius, vlMaterialId material) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
  def.radius = radius;
  def.z_min = -radius;
  def.z_max = radius;
  def.material = material;
  /* Row-major; the last column is the sphere's centre. */
  const double place[16] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
  memcpy(def.group_from_shape, place, sizeof place);
  vl_scene_add_shape(scene, &def);
}

/* The plane y = height: a square of side 2 size, as two triangles. */
static void add_plane(vlScene *scene, float height, float size, vlMaterialId material) {
  const float positions[] = {-size, height, -size, -size, height, size, size, height, size, size, height, -size};
  const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 4;
  def.faces = 2;
  def.positions = positions;
  def.indices = indices;
  def.material = material;
  vl_scene_add_shape(scene, &def);
}

/* A disk that emits light downwards, and a faint sky. */
static void add_light(vlScene *scene, vlMaterialId black) {
  vlEmissionDef emission = vl_default_emission_def();
  emission.radiance = vl_spectrum_blackbody(5000);
  emission.scale = 14;

  vlShapeDef lamp = vl_default_shape_def(VL_SHAPE_DISK);
  lamp.radius = 180;
  lamp.material = black;
  lamp.emission = vl_scene_add_emission(scene, &emission);
  /* The disk's normal, z, becomes -y; its centre is at (150, 600, 150). */
  const double place[16] = {1, 0, 0, 150, 0, 0, -1, 600, 0, 1, 0, 150, 0, 0, 0, 1};
  memcpy(lamp.group_from_shape, place, sizeof place);
  vl_scene_add_shape(scene, &lamp);

  vlLightDef sky = vl_default_light_def(VL_LIGHT_INFINITE);
  sky.color = vl_spectrum_rgb(0.55f, 0.7f, 1.0f);
  sky.scale = 0.25f;
  vl_scene_add_light(scene, &sky);
}

/* The lecture's World::build. */
static void build(vlScene *scene) {
  vlMaterialId ground = add_matte(scene, 0.45f, 0.45f, 0.42f);
  vlMaterialId red = add_matte(scene, 0.75f, 0.12f, 0.08f);
  vlMaterialId green = add_matte(scene, 0.15f, 0.5f, 0.12f);
  vlMaterialId gold = add_metal(scene, "metal-Au-eta", "metal-Au-k", 0.1f);
  add_plane(scene, -85, 5000, ground);
  add_sphere(scene, 0, 0, -50, 85, red);
  add_sphere(scene, 150, -25, 20, 60, gold);
  add_sphere(scene, -20, -45, 120, 40, green);
  add_light(scene, ground);
}

/* The lecture's set_eye, set_lookat, set_viewdistance and compute_uvw: one description, compiled once. */
static vlCamera pinhole(uint32_t width, uint32_t height, double zoom) {
  vlCameraDef def = vl_default_camera_def(width, height);
  const double eye[3] = {300, 400, 500}, lookat[3] = {0, 0, -50};
  memcpy(def.eye, eye, sizeof eye);
  memcpy(def.lookat, lookat, sizeof lookat);
  def.view_distance = 400;
  def.zoom = zoom; /* 1 in the lecture, on a view plane of 400 pixels */

  vlCamera camera;
  const char *warning = NULL;
  vlError error = {0};
  must(vl_camera_make(&def, &camera, &warning, &error), "camera", &error);
  if (warning) fprintf(stderr, "build_world: camera: %s\n", warning);
  return camera;
}

int main(int count, char **arguments) {
  enum { WIDTH = 400, HEIGHT = 300 };
  if (count < 2) {
    fprintf(stderr, "usage: build_world IMAGE [IMAGE...]\n");
    return 2;
  }

  vlContext *context = NULL;
  vlContextDef context_def = vl_default_context_def();
  must(vl_context_create(&context_def, &context), "context", NULL);

  vlError error = {0};
  vlScene *scene = NULL;
  must(vl_scene_create(context, &scene), "scene", NULL);
  build(scene);
  must(vl_scene_result(scene, &error), "scene", &error); /* the scene remembers its first error */

  vlWorld *world = NULL;
  vlBuildDef build_def = vl_default_build_def();
  must(vl_world_build(scene, &build_def, &world, &error), "world", &error);
  vl_scene_destroy(scene); /* the world does not need it */

  vlCamera camera = pinhole(WIDTH, HEIGHT, 1.5);

  vlFilm *film = NULL;
  vlFilmDef film_def = vl_default_film_def(WIDTH, HEIGHT);
  must(vl_film_create(context, &film_def, &film), "film", NULL);

  vlRenderDef render_def = vl_default_render_def();
  render_def.spp = 32;
  render_def.max_depth = 6;
  vlRenderStats stats;
  must(vl_render(world, &camera, film, &render_def, &stats, &error), "render", &error);

  vlImage *image = NULL;
  vlDevelopDef develop_def = vl_default_develop_def();
  must(vl_film_develop(film, &develop_def, &image), "develop", NULL);
  for (int i = 1; i < count; i++) must(vl_image_write(image, arguments[i], NULL, &error), arguments[i], &error);
  printf("%u x %u pixels, %u samples each, %.2f s\n", (unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)stats.spp,
         stats.seconds);

  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_context_destroy(context);
  return 0;
}
