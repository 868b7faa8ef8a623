/* test/import/test_mesh_run.c: merged small meshes give the same triangles in the world as
 * separate Shapes; failing allocations leak nothing. */
#include "import/load_failing.h"

#include "velo/shape_kinds.h"
#include "world/world.h"

enum { BEFORE = 4096, QUADS = 60 };

/* `before` spheres, then quads under changing states. */
static char *text_of(int before) {
  char *text = malloc(64 * (size_t)BEFORE + 1000 * (size_t)QUADS + 1000), *at = text;
  at += sprintf(at, "WorldBegin\nTexture \"t\" \"float\" \"constant\" \"float value\" 0.5\n");
  for (int i = 0; i < before; i++)
    at += sprintf(at, "Shape \"sphere\"\n");
  for (int i = 0; i < QUADS; i++) {
    at += sprintf(at, "AttributeBegin\nTranslate %d 0 %d\n", i, i % 7);
    if (i % 3 == 1)
      at += sprintf(at, "Rotate %d 1 2 3\n", 7 * i);
    if (i % 5 == 2)
      at += sprintf(at, "Scale -1 2 3\n");
    if (i % 4 == 3)
      at += sprintf(at, "ReverseOrientation\n");
    if (i % 2)
      at += sprintf(at, "Material \"conductor\"\n");
    if (i == 30)
      at += sprintf(at, "AreaLightSource \"diffuse\"\n");
    at += sprintf(at,
                  "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0.5 0 1 %d] "
                  "\"integer indices\" [0 1 2 0 2 3]",
                  i % 11);
    if (i % 6 < 2)
      at += sprintf(at, " \"point2 uv\" [0 0 1 0 1 1 0 %d]", i);
    if (i % 10 < 5)
      at += sprintf(at, " \"normal N\" [0 0 1 0.1 0 1 0 0.1 1 0 0 1]");
    if (i % 8 == 4)
      at += sprintf(at, " \"texture alpha\" \"t\"");
    if (i % 8 == 5)
      at += sprintf(at, " \"float alpha\" 0.3");
    at += sprintf(at, "\nAttributeEnd\n");
  }
  return text;
}

/* What a triangle is: corners, normals, uv, side, material kind, emission, alpha. */
typedef struct Face {
  float v[28];
} Face;

static int by_bytes(const void *a, const void *b) {
  return memcmp(a, b, sizeof(Face));
}

static Face *faces_of(const char *text, size_t *count, size_t *shapes) {
  Loaded l;
  load_fine(&l, text);
  vlWorld *world;
  vlError error = {0};
  if (vl_world_build(l.scene, NULL, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  Face *faces = calloc(2 * QUADS, sizeof *faces);
  *count = *shapes = 0;
  for (size_t i = 0; i < world->shapes.count; i++) {
    const vlWorldShape *s = &world->shapes.items[i];
    if (s->kind != VL_SHAPE_TRIANGLES)
      continue;
    ++*shapes;
    for (uint32_t k = 0; k < s->faces; k++) {
      assert_true(*count < 2 * QUADS);
      float *v = faces[(*count)++].v;
      for (int c = 0; c < 3; c++) {
        size_t at = s->indices[3 * k + (uint32_t)c];
        for (size_t j = 0; j < 3; j++) {
          v[3 * (size_t)c + j] = s->positions[3 * at + j] + 0.0f; /* -0 is 0 */
          v[9 + 3 * (size_t)c + j] = s->normals ? s->normals[3 * at + j] + 0.0f : 7;
        }
        for (size_t j = 0; j < 2; j++)
          v[18 + 2 * (size_t)c + j] = s->uvs ? s->uvs[2 * at + j] : 7;
      }
      v[24] = s->flip;
      v[25] = (float)world->materials.items[s->material].kind;
      v[26] = s->first_light != VL_NONE;
      vlTextureQuery at = {0, 0, {v[0], v[1], v[2]}, {0, 0, 1}, NULL};
      v[27] = s->alpha < 0 ? 1 : vl_texture_float_at(world, s->alpha, &at);
    }
  }
  qsort(faces, *count, sizeof *faces, by_bytes);
  vl_world_destroy(world);
  end_load(&l);
  return faces;
}

static void put_together_they_are_the_same(void **state) {
  (void)state;
  char *apart = text_of(0), *together = text_of(BEFORE);
  size_t count[2], shapes[2];
  Face *a = faces_of(apart, &count[0], &shapes[0]),
       *b = faces_of(together, &count[1], &shapes[1]);
  assert_int_equal(count[0], 2 * QUADS);
  assert_int_equal(count[1], 2 * QUADS);
  assert_int_equal(shapes[0], QUADS);
  assert_true(shapes[1] < QUADS);
  for (size_t i = 0; i < 2 * QUADS; i++)
    for (int k = 0; k < 28; k++)
      if (!(fabsf(a[i].v[k] - b[i].v[k]) <= 2e-7f))
        fail_msg("face %zu, number %d: %.9g apart, %.9g together", i, k, (double)a[i].v[k],
                 (double)b[i].v[k]);
  free(a);
  free(b);
  free(apart);
  free(together);
}

static void memory_runs_out(void **state) {
  (void)state;
  char *text = text_of(BEFORE);
  fail_last_allocations(text, 300);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(put_together_they_are_the_same),
      cmocka_unit_test(memory_runs_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
