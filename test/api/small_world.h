/* test/api/small_world.h: a world of a few objects that uses many parts of the renderer, made
 * with the public API. */
#ifndef TEST_API_SMALL_WORLD_H
#define TEST_API_SMALL_WORLD_H

#include <string.h>

#include "velo/light.h"
#include "velo/material.h"
#include "velo/render.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

enum { SMALL_WIDTH = 40, SMALL_HEIGHT = 30 };

static inline void small_place(double m[16], double x, double y, double z) {
  const double place[16] = {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1};
  memcpy(m, place, sizeof place);
}

/* Fills the scene; errors are kept in it. */
static inline void small_scene(vlScene *scene) {
  vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, true);
  checks.su = checks.sv = 6;
  checks.spectrum_a = vl_spectrum_input(vl_spectrum_rgb(0.7f, 0.6f, 0.5f));
  checks.spectrum_b = vl_spectrum_input(vl_spectrum_rgb(0.1f, 0.2f, 0.3f));
  vlMaterialDef floor = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  floor.reflectance.texture = vl_scene_add_texture(scene, &checks);
  vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
  vlMaterialDef gold = vl_default_material_def(VL_MATERIAL_CONDUCTOR);
  gold.eta = vl_spectrum_input(vl_spectrum_named("metal-Au-eta"));
  gold.k = vl_spectrum_input(vl_spectrum_named("metal-Au-k"));
  gold.u_roughness = gold.v_roughness = vl_float_input(0.2f);
  vlMaterialDef coat = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
  coat.reflectance = vl_spectrum_input(vl_spectrum_rgb(0.6f, 0.1f, 0.1f));

  static const float corners[] = {-4, 0, 4, 4, 0, 4, -4, 0, -4, 4, 0, -4};
  static const float uvs[] = {0, 0, 1, 0, 0, 1, 1, 1};
  static const uint32_t faces[] = {0, 1, 2, 1, 3, 2};
  vlShapeDef ground = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  ground.vertices = 4;
  ground.faces = 2;
  ground.positions = corners;
  ground.uvs = uvs;
  ground.indices = faces;
  ground.material = vl_scene_add_material(scene, &floor);
  vl_scene_add_shape(scene, &ground);

  vlMaterialDef *const materials[3] = {&glass, &gold, &coat};
  for (int i = 0; i < 3; i++) {
    vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
    ball.radius = 0.6f;
    ball.z_min = -0.6f;
    ball.z_max = 0.6f;
    ball.material = vl_scene_add_material(scene, materials[i]);
    small_place(ball.group_from_shape, 1.4 * (i - 1), 0.6, 0);
    vl_scene_add_shape(scene, &ball);
  }

  vlGroupId group = vl_scene_add_group(scene, "pole");
  vlShapeDef pole = vl_default_shape_def(VL_SHAPE_CYLINDER);
  pole.radius = 0.1f;
  pole.z_min = -1;
  pole.z_max = 1;
  pole.group = group;
  vl_scene_add_shape(scene, &pole);
  for (int i = -1; i <= 1; i += 2) {
    double place[16];
    small_place(place, 2.2 * i, 0.4, -0.5);
    vl_scene_add_instance(scene, group, place, (vlSource){0});
  }

  vlEmissionDef emission = vl_default_emission_def();
  emission.radiance = vl_spectrum_blackbody(4500);
  emission.scale = 8;
  vlShapeDef lamp = vl_default_shape_def(VL_SHAPE_DISK);
  lamp.radius = 0.8f;
  lamp.emission = vl_scene_add_emission(scene, &emission);
  const double down[16] = {1, 0, 0, 0, 0, 0, -1, 3, 0, 1, 0, 0, 0, 0, 0, 1};
  memcpy(lamp.group_from_shape, down, sizeof down);
  vl_scene_add_shape(scene, &lamp);
  vlLightDef sky = vl_default_light_def(VL_LIGHT_INFINITE);
  sky.color = vl_spectrum_rgb(0.2f, 0.3f, 0.4f);
  vl_scene_add_light(scene, &sky);
  vlLightDef spot = vl_default_light_def(VL_LIGHT_SPOT);
  const float from[3] = {-3, 3, 3};
  memcpy(spot.from, from, sizeof from);
  memset(spot.to, 0, sizeof spot.to);
  spot.scale = 10;
  vl_scene_add_light(scene, &spot);
}

static inline vlResult small_camera(vlCamera *camera) {
  vlCameraDef def = vl_default_camera_def(SMALL_WIDTH, SMALL_HEIGHT);
  const double eye[3] = {0, 1.6, 5}, lookat[3] = {0, 0.5, 0};
  memcpy(def.eye, eye, sizeof eye);
  memcpy(def.lookat, lookat, sizeof lookat);
  def.fov = 0.8;
  def.lens_radius = 0.02;
  def.focus_distance = 5;
  return vl_camera_make(&def, camera, NULL, NULL);
}

/* Makes scene, world and film, renders and develops. Everything else is destroyed; *image is
 * set on VL_OK only. */
static inline vlResult small_image(vlContext *context, const vlRenderDef *render,
                                   const uint32_t crop[4], vlColorMode color, vlImage **image) {
  *image = NULL;
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlFilm *film = NULL;
  vlCamera camera;
  vlError error;
  vlResult result = vl_scene_create(context, &scene);
  if (result == VL_OK) {
    small_scene(scene);
    result = vl_scene_result(scene, &error);
  }
  vlBuildDef build = vl_default_build_def();
  vlDevelopDef develop = vl_default_develop_def();
  build.color = color;
  if (result == VL_OK)
    result = vl_world_build(scene, &build, &world, &error);
  vl_scene_destroy(scene);
  if (result == VL_OK)
    result = small_camera(&camera);
  vlFilmDef film_def = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
  if (crop)
    memcpy(film_def.crop, crop, sizeof film_def.crop);
  if (result == VL_OK)
    result = vl_film_create(context, &film_def, &film);
  if (result == VL_OK)
    result = vl_render(world, &camera, film, render, NULL, &error);
  if (result == VL_OK || (result == VL_CANCELLED && vl_film_spp(film) > 0)) {
    vlResult developed = vl_film_develop(film, &develop, image);
    if (result == VL_OK)
      result = developed;
  }
  vl_film_destroy(film);
  vl_world_destroy(world);
  return result;
}

#endif
