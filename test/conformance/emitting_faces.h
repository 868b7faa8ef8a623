/* conformance/emitting_faces.h: each face of a mesh on which an image shines is a lamp, however
 * the image goes on beyond its edges. */
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

static vlWorld *world_of_faces(vlScene *scene, vlEmissionId emission) {
  static float positions[EMITTING_FACES][3][3];
  static float uvs[EMITTING_FACES][3][2];
  static uint32_t indices[EMITTING_FACES][3];
  for (int i = 0; i < EMITTING_FACES; i++)
    for (int k = 0; k < 3; k++) {
      uvs[i][k][0] = face_coordinate(i % FACES_WIDE) + 1e-3f * (float)(k == 1);
      uvs[i][k][1] = face_coordinate(i / FACES_WIDE) + 1e-3f * (float)(k == 2);
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

/* Each face on which one texel of an image shines is a light. */
static void check_emitting_faces(vlWrap wrap, bool wrap_t_given, vlWrap wrap_t) {
  TexelCase t = {.channels = 3, .def = vl_default_texture_def(VL_TEXTURE_IMAGE, true)};
  for (int c = 0; c < 3; c++)
    t.texels[0][3][c] = 1;
  t.def.wrap = wrap;
  t.def.wrap_t_given = wrap_t_given;
  t.def.wrap_t = wrap_t;
  vlImage *image = image_of_texels(&t);
  vlScene *scene = need_scene(HEAD "WorldBegin");
  vlTextureDef def = t.def;
  def.image = image;
  vlEmissionDef emission = vl_default_emission_def();
  emission.texture = vl_scene_add_texture(scene, &def);
  vl_image_destroy(image);
  vlWorld *world = world_of_faces(scene, vl_scene_add_emission(scene, &emission));
  uint32_t shine = 0;
  uint32_t missed = 0;
  for (int i = 0; i < EMITTING_FACES; i++) {
    const double x = TEXELS_WIDE * (double)face_coordinate(i % FACES_WIDE);
    const double y = TEXELS_HIGH * (1 - (double)face_coordinate(i / FACES_WIDE));
    if (!(image_at(&t, x, y, 1) > 0.05))
      continue;
    shine++;
    missed += vl_shape_light(&world->shapes.items[0], (uint32_t)i) == VL_NONE;
  }
  if (shine < 5 || missed > 0)
    broken("textures", "imagemap", "wrap %d, %d: %u of %u faces that shine are no lights",
           (int)wrap, wrap_t_given ? (int)wrap_t : -1, missed, shine);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
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
  expect_no_failures();
}

#endif
