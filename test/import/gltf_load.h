/* test/import/gltf_load.h: writes glTF files made by gltf_writer.h to a directory of the test
 * and loads them; a square as a start. */
#ifndef TEST_IMPORT_GLTF_LOAD_H
#define TEST_IMPORT_GLTF_LOAD_H

#include "import/gltf_writer.h"
#include "import/load.h"
#include "velo/shape.h"

static char folder[64];

static inline int set_up(void **state) {
  (void)state;
  snprintf(folder, sizeof folder, "/tmp/velo-gltf-XXXXXX");
  return !mkdtemp(folder);
}

static inline int tear_down(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  return system(command);
}

static inline const char *in_folder(const char *name) {
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static inline void load(Loaded *l, const Gltf *g, const char *rest, const vlLoadDef *def) {
  gltf_write_text(g, in_folder("t.gltf"), rest);
  start_load(l);
  l->result = vl_scene_load(l->scene, in_folder("t.gltf"), def, &l->error);
}

static inline void fine_with(Loaded *l, const Gltf *g, const char *rest, const vlLoadDef *def) {
  load(l, g, rest, def);
  if (l->result != VL_OK)
    print_message("%s: %s\n", l->error.file, l->error.message);
  assert_int_equal(l->result, VL_OK);
}

static inline void fine(Loaded *l, const Gltf *g, const char *rest) {
  fine_with(l, g, rest, NULL);
}

static const float square[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
static const uint16_t square_faces[6] = {0, 1, 2, 2, 1, 3};

/* accessors 0: positions, 1: indices */
static inline Gltf *new_square(void) {
  Gltf *g = calloc(1, sizeof *g);
  gltf_floats(g, square, 4, "VEC3", 3);
  gltf_shorts(g, square_faces, 6);
  return g;
}

#define SCENE "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
#define SQUARE_MESH \
  "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]"

static inline const vlShapeDef *shape(const Loaded *l, size_t i) {
  assert_true(i < l->scene->shapes.count);
  return &l->scene->shapes.items[i];
}

#endif
