/* test/scene/model.h: models of boxes, and what vl_scene_complete adds to them. */
#ifndef TEST_SCENE_MODEL_H
#define TEST_SCENE_MODEL_H

#include <math.h>

#include "scene/scene.h"
#include "unit.h"
#include "velo/shape_kinds.h"

typedef struct Model {
  vlContext *context;
  vlScene *scene;
} Model;

static inline Model begin(void) {
  Model m = {0};
  assert_int_equal(vl_context_create(NULL, &m.context), VL_OK);
  assert_int_equal(vl_scene_create(m.context, &m.scene), VL_OK);
  vl_scene_defs(m.scene)->camera_missing = vl_scene_defs(m.scene)->light_missing = true;
  return m;
}

static inline void end(Model *m) {
  vl_scene_destroy(m->scene);
  vl_context_destroy(m->context);
}

/* Triangles that velo copies: positions of vertices, three indices for each face. */
static inline void add_triangles(Model *m, uint32_t vertices, const float *positions,
                                 uint32_t faces, const uint32_t *indices, bool one_sided) {
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = vertices;
  def.faces = faces;
  def.positions = positions;
  def.indices = indices;
  def.one_sided = one_sided;
  assert_int_not_equal(vl_scene_add_shape(m->scene, &def).index, 0);
}

/* A box whose faces look outwards, or inwards. */
static inline void add_box(Model *m, const float low[3], const float high[3], bool inward,
                           bool one_sided) {
  static const uint32_t faces[36] = {4, 5, 7, 4, 7, 6, 1, 0, 2, 1, 2, 3, 5, 1, 3, 5, 3, 7,
                                     0, 4, 6, 0, 6, 2, 6, 7, 3, 6, 3, 2, 0, 1, 5, 0, 5, 4};
  float p[24];
  uint32_t indices[36];
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 3; k++)
      p[3 * i + k] = i >> k & 1 ? high[k] : low[k];
  for (int i = 0; i < 36; i++)
    indices[i] = faces[inward ? i / 3 * 3 + 2 - i % 3 : i];
  add_triangles(m, 8, p, 12, indices, one_sided);
}

static inline void complete(Model *m, vlCompleteDef *def) {
  def->width = 300;
  def->height = 200;
  vlError error;
  if (vl_scene_complete(m->scene, def, &error) != VL_OK)
    fail_msg("%s", error.message);
}

static inline vlCompleteDef first_image(void) {
  vlCompleteDef def = vl_default_complete_def();
  def.backdrop = def.open_walls = true;
  return def;
}

/* The direction from the middle of the model to the eye; a unit vector. */
static inline void toward_eye(const Model *m, double d[3]) {
  const vlCameraDef *c = &m->scene->defs.camera;
  double length = 0;
  for (int i = 0; i < 3; i++) {
    d[i] = c->eye[i] - c->lookat[i];
    length += d[i] * d[i];
  }
  for (int i = 0; i < 3; i++)
    d[i] /= sqrt(length);
}

#endif
