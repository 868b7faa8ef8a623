/* test_nanovdb.c: NanoVDB files made here, byte by byte, are read back voxel by voxel; invalid ones are rejected with a
 * reason, whichever byte is wrong. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka.h needs the headers above */
#include <cmocka.h>

#include "velo/velo.h"
#include "world/medium/medium_lookup.h"
#include "world/nanovdb_file.h"

static const char *file_name(void) {
  static char name[128];
  snprintf(name, sizeof name, "%s/test_nanovdb_%d.nvdb", VELO_BINARY_DIR, (int)getpid());
  return name;
}

static vlResult load(const unsigned char *file, size_t size, vlError *error, void (*look)(const vlWorldMedium *m)) {
  FILE *f = fopen(file_name(), "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(file, 1, size, f), size);
  fclose(f);
  vlContext *context;
  vlScene *scene;
  vlWorld *world = NULL;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlMediumDef def = vl_default_medium_def(VL_MEDIUM_NANOVDB);
  def.path = file_name();
  vl_scene_defs(scene)->camera_medium = vl_scene_add_medium(scene, &def);
  vlResult r = vl_world_build(scene, NULL, &world, error);
  if (r == VL_OK && look) look(&world->media.items[0]);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
  remove(file_name());
  return r;
}

static void look(const vlWorldMedium *m) {
  const vlSparseGrid *g = m->sparse;
  for (int x = -1; x < 26; x++)
    for (int y = -1; y < 9; y++)
      for (int z = -1; z < 9; z++) {
        bool inside = x >= 0 && y >= 0 && z >= 0 && y < 8 && z < 8 && x < 24;
        float expected = !inside ? 0 : x < 16 ? (float)(x + 10 * y + 100 * z + 1) : 5;
        assert_true(vl_sparse_value(g, x, y, z) == expected);
      }
  assert_true(vl_sparse_value(g, 128, 0, 0) == 7 && vl_sparse_value(g, 255, 127, 127) == 7);
  assert_true(vl_sparse_value(g, 256, 0, 0) == 0 && vl_sparse_value(g, 127, 127, 127) == 0);
  vlVec3 p = {10 + 0.5f * 3.25f, 0.5f * 2.5f, 0.5f * 1.75f}; /* linear in between */
  assert_true(fabsf(vl_sparse_lookup(g, p) - (3.25f + 25 + 175 + 1)) < 1e-3f);
  /* Majorants: no lookup is above that of its cell. */
  for (int k = 0; k < 200000; k++) {
    uint32_t h = vl_float_bits((float)k) * 2654435761u;
    vlVec3 q = {10 + 30 * (float)(h & 1023) / 1023, 8 * (float)(h >> 10 & 1023) / 1023, 8 * (float)(h >> 20) / 4095};
    size_t cell[3];
    const float at[3] = {q.x, q.y, q.z};
    for (int i = 0; i < 3; i++) {
      float x = (at[i] - m->low[i]) / (m->high[i] - m->low[i]) * (float)m->cells[i];
      cell[i] = (size_t)(x < 63 ? x : 63);
    }
    assert_true(vl_sparse_lookup(g, q) <= m->majorants[(cell[2] * 64 + cell[1]) * 64 + cell[0]] * 1.0001f);
  }
}

static void read_back(void **state) {
  (void)state;
  unsigned char *grid = make_grid();
  for (uint16_t codec = 0; codec < 2; codec++) {
    size_t size;
    vlError error = {0};
    unsigned char *file = make_file(grid, codec, &size);
    if (load(file, size, &error, look) != VL_OK) fail_msg("%s", error.message);
    free(file);
  }
  free(grid);
}

static void expect(const unsigned char *file, size_t size, const char *word) {
  vlError error = {0};
  vlResult r = load(file, size, &error, NULL);
  if (r != VL_ERROR_SCENE || !strstr(error.message, word)) fail_msg("%d: %s (expected: %s)", r, error.message, word);
}

static void refused(void **state) {
  (void)state;
  size_t size;
  unsigned char *grid = make_grid();
  const struct {
    size_t at;
    uint32_t value;
    const char *word;
  } wrong[] = {{636, 2, "not floats"},
               {632, 1, "no fog volume"},
               {ROOT_AT + 24, 0x7fffffff, "damaged"},
               {ROOT_AT + ROOT + 8, 0xfffffff8, "damaged"},
               {UPPER_AT + UPPER_TABLE, 0x10000000, "damaged"},
               {LOWER_AT + LOWER_TABLE, 0x10000000, "damaged"},
               {LEAF_AT + LEAF_TABLE, 0x7fc00000, "not finite"},
               {LOWER_AT + LOWER_TABLE + 8 * (2 << 8), 0x7f800000, "not finite"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    unsigned char *copy = malloc(SIZE);
    memcpy(copy, grid, SIZE);
    put_u32(copy + wrong[i].at, wrong[i].value);
    unsigned char *file = make_file(copy, 0, &size);
    expect(file, size, wrong[i].word);
    free(file);
    free(copy);
  }
  unsigned char *file = make_file(grid, 0, &size);
  file[14] = 2;
  expect(file, size, "BLOSC");
  file[14] = 0;
  expect(file, size - 100, "damaged");
  expect(file, 100, "damaged");
  file[11] = 0x7f;
  expect(file, size, "version");
  put(file, "nothing!", 8);
  expect(file, size, "no NanoVDB file");
  free(file);
  file = make_file(grid, 1, &size);
  put_u64(file + 16, (uint64_t)1 << 40); /* unpacked to a terabyte */
  expect(file, size, "damaged");
  put_u64(file + 16, SIZE);
  file[size - 30] ^= 0x55;
  expect(file, size, "damaged");
  put(file + 16 + 176, "smoke\0\0", 7);
  expect(file, size, "no grid \"density\"");
  free(file);
  free(grid);
}

/* Any wrong byte of what is not values: an image's worth of memory or an error, never a crash. */
static void shaken(void **state) {
  (void)state;
  unsigned char *grid = make_grid();
  uint32_t h = 1;
  for (int round = 0; round < 120; round++) {
    unsigned char *copy = malloc(SIZE);
    memcpy(copy, grid, SIZE);
    for (int k = 0; k < 4; k++) {
      h = h * 747796405u + 2891336453u;
      const size_t starts[4] = {0, ROOT_AT, UPPER_AT, LOWER_AT}, lengths[4] = {ROOT_AT, 160, UPPER, LOWER};
      size_t part = h >> 8 & 3;
      copy[starts[part] + (h >> 10) % (round & 1            ? lengths[part]
                                       : lengths[part] < 64 ? lengths[part]
                                                            : 64)] = (unsigned char)(h >> 24);
    }
    size_t size;
    vlError error = {0};
    unsigned char *file = make_file(copy, 0, &size);
    load(file, size, &error, NULL);
    free(file);
    free(copy);
  }
  free(grid);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(read_back), cmocka_unit_test(refused), cmocka_unit_test(shaken)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
