/* conformance/emitting_faces.h: each face of a mesh on which an image shines is a lamp, however
 * the image goes on beyond its edges; it is chosen by about the light that it sends. */
#ifndef TEST_CONFORMANCE_EMITTING_FACES_H
#define TEST_CONFORMANCE_EMITTING_FACES_H

#include "conformance.h"
#include "texels.h"
#include "unit.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "world/world.h"

enum { FACES_WIDE = 24, EMITTING_FACES = FACES_WIDE * FACES_WIDE };
/* Faces, each nearly one point of the image, from -FACES_OUT to 1 + FACES_OUT. */
#define FACES_OUT 0.6

static float face_coordinate(int i) {
  return (float)((1 + 2 * FACES_OUT) * (i + 0.37) / FACES_WIDE - FACES_OUT);
}

/* The corners of a face, of about this size, whose sides are not along the image's. */
static void face_corner(int i, int corner, double size, float uv[2]) {
  uv[0] =
      face_coordinate(i % FACES_WIDE) + (float)(size * ((corner == 2) + 0.1 * (corner == 1)));
  uv[1] =
      face_coordinate(i / FACES_WIDE) + (float)(size * ((corner == 1) + 0.1 * (corner == 2)));
}

static vlWorld *world_of_faces(vlScene *scene, vlEmissionId emission, double size) {
  static float positions[EMITTING_FACES][3][3];
  static float uvs[EMITTING_FACES][3][2];
  static uint32_t indices[EMITTING_FACES][3];
  for (int i = 0; i < EMITTING_FACES; i++)
    for (int k = 0; k < 3; k++) {
      face_corner(i, k, size, uvs[i][k]);
      positions[i][k][0] = uvs[i][k][0];
      positions[i][k][1] = uvs[i][k][1];
      indices[i][k] = (uint32_t)(3 * i + k);
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = 3 * EMITTING_FACES;
  def.faces = EMITTING_FACES;
  def.positions = positions[0][0];
  def.uvs = uvs[0][0];
  def.indices = indices[0];
  def.emission = emission;
  vl_scene_add_shape(scene, &def);
  vlError error = {0};
  vlWorld *world;
  assert_int_equal(vl_world_build(scene, NULL, &world, &error), VL_OK);
  return world;
}

/* A world of faces on which one texel of an image shines. */
static vlWorld *world_of_texel(TexelCase *t, double size) {
  for (int c = 0; c < 3; c++)
    t->texels[0][3][c] = 1;
  vlImage *image = image_of_texels(t);
  vlScene *scene = need_scene(HEAD "WorldBegin");
  vlTextureDef def = t->def;
  def.image = image;
  vlEmissionDef emission = vl_default_emission_def();
  emission.texture = vl_scene_add_texture(scene, &def);
  vl_image_destroy(image);
  vlWorld *world = world_of_faces(scene, vl_scene_add_emission(scene, &emission), size);
  vl_scene_destroy(scene);
  return world;
}

/* The image at a point of its texture coordinates. */
static double image_at_uv(const TexelCase *t, double u, double v) {
  return image_at(t, TEXELS_WIDE * u, TEXELS_HIGH * (1 - v), 1);
}

/* Each of these faces, which are nearly points, is a light. */
static void check_emitting_faces(vlWrap wrap, bool wrap_t_given, vlWrap wrap_t) {
  TexelCase t = {.channels = 3, .def = vl_default_texture_def(VL_TEXTURE_IMAGE, true)};
  t.def.wrap = wrap;
  t.def.wrap_t_given = wrap_t_given;
  t.def.wrap_t = wrap_t;
  vlWorld *world = world_of_texel(&t, 1e-3);
  uint32_t shine = 0;
  uint32_t missed = 0;
  for (int i = 0; i < EMITTING_FACES; i++) {
    if (!(image_at_uv(&t, (double)face_coordinate(i % FACES_WIDE),
                      (double)face_coordinate(i / FACES_WIDE)) > 0.05))
      continue;
    shine++;
    missed += vl_shape_light(&world->shapes.items[0], (uint32_t)i) == VL_NONE;
  }
  if (shine < 5 || missed > 0)
    broken("textures", "imagemap", "wrap %d, %d: %u of %u faces that shine are no lights",
           (int)wrap, wrap_t_given ? (int)wrap_t : -1, missed, shine);
  vl_world_destroy(world);
}

/* The mean of the image over a face. */
static double mean_over_face(const TexelCase *t, int i, double size) {
  enum { PARTS_OF_FACE = 64 };
  float corners[3][2];
  double sum = 0;
  for (int k = 0; k < 3; k++)
    face_corner(i, k, size, corners[k]);
  for (int j = 0; j < PARTS_OF_FACE; j++) {
    double b = fmod(0.5 + j * 0.7548776662466927, 1.0);
    double c = fmod(0.5 + j * 0.5698402909980532, 1.0);
    const bool beyond = b + c > 1;
    b = beyond ? 1 - b : b;
    c = beyond ? 1 - c : c;
    double at[2];
    for (int k = 0; k < 2; k++)
      at[k] = (double)corners[0][k] + b * (double)(corners[1][k] - corners[0][k]) +
              c * (double)(corners[2][k] - corners[0][k]);
    sum += image_at_uv(t, at[0], at[1]);
  }
  return sum / PARTS_OF_FACE;
}

/* Lights are chosen by about the light that they send, also if the texel that shines is a small
 * part of a face. */
static void check_powers_of_faces(double size) {
  TexelCase t = {.channels = 3, .def = vl_default_texture_def(VL_TEXTURE_IMAGE, true)};
  vlWorld *world = world_of_texel(&t, size);
  uint32_t dark = 0;
  double off = 0;
  double all = 0;
  for (int i = 0; i < EMITTING_FACES; i++) {
    const uint32_t index = vl_shape_light(&world->shapes.items[0], (uint32_t)i);
    const double known = mean_over_face(&t, i, size);
    const vlWorldLight *light = index == VL_NONE ? NULL : &world->lights.items[index];
    const double power = light ? (double)light->power / (PI * (double)light->area) : 0;
    dark += known > 0.02 && !(power > 0);
    off += fabs(power - known);
    all += known;
  }
  if (dark || !(off < 0.5 * all))
    broken("textures", "imagemap",
           "faces of the size %g: %u that shine have no power; the powers are off by %.2f",
           size, dark, off / all);
  vl_world_destroy(world);
}

static void faces_that_emit(void **state) {
  (void)state;
  static const vlWrap wraps[] = {VL_WRAP_REPEAT, VL_WRAP_BLACK, VL_WRAP_CLAMP, VL_WRAP_MIRROR,
                                 VL_WRAP_OCTAHEDRAL};
  for (int i = 0; i < 5; i++) {
    check_emitting_faces(wraps[i], false, VL_WRAP_REPEAT);
    for (int k = 0; k < 4; k++)
      check_emitting_faces(wraps[i], true, wraps[k]);
  }
  check_powers_of_faces(0.1);
  check_powers_of_faces(0.6);
  check_powers_of_faces(1.5);
  expect_no_failures();
}

#endif
