/* test_nanovdb.c: NanoVDB files made here, byte by byte, are read back voxel by voxel; invalid
 * ones are rejected with a reason, whichever byte is wrong. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
/* cmocka.h needs the headers above */

#include "medium/lookup.h"
#include "unit.h"
#include "velo/medium.h"
#include "velo/render.h"
#include "world/nanovdb_file.h"

static const char *file_name(void) {
  static char name[128];
  snprintf(name, sizeof name, "%s/test_nanovdb_%d.nvdb", VELO_BINARY_DIR, (int)getpid());
  return name;
}

/* max_memory: of the context; 0: no limit. peak: receives the most bytes that it held; may be
 * null. */
static vlResult load_within(const unsigned char *file, size_t size, size_t max_memory,
                            size_t *peak, vlError *error,
                            void (*look)(const vlWorldMedium *m)) {
  FILE *f = fopen(file_name(), "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(file, 1, size, f), size);
  fclose(f);
  vlContext *context;
  vlScene *scene;
  vlWorld *world = NULL;
  vlContextDef context_def = vl_default_context_def();
  context_def.threads = 1;
  context_def.max_memory = max_memory;
  assert_int_equal(vl_context_create(&context_def, &context), VL_OK);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlMediumDef def = vl_default_medium_def(VL_MEDIUM_NANOVDB);
  def.path = file_name();
  vl_scene_defs(scene)->camera_medium = vl_scene_add_medium(scene, &def);
  vlResult r = vl_world_build(scene, NULL, &world, error);
  if (r == VL_OK && look)
    look(&world->media.items[0]);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  assert_int_equal(vl_context_memory(context, peak), 0);
  vl_context_destroy(context);
  remove(file_name());
  return r;
}

static vlResult load(const unsigned char *file, size_t size, vlError *error,
                     void (*look)(const vlWorldMedium *m)) {
  return load_within(file, size, 0, NULL, error, look);
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
    vlVec3 q = {10 + 30 * (float)(h & 1023) / 1023, 8 * (float)(h >> 10 & 1023) / 1023,
                8 * (float)(h >> 20) / 4095};
    size_t cell[3];
    const float at[3] = {q.x, q.y, q.z};
    for (int i = 0; i < 3; i++) {
      float x = (at[i] - m->low[i]) / (m->high[i] - m->low[i]) * (float)m->cells[i];
      cell[i] = (size_t)(x < 63 ? x : 63);
    }
    assert_true(vl_sparse_lookup(g, q) <=
                m->majorants[(cell[2] * 64 + cell[1]) * 64 + cell[0]] * 1.0001f);
  }
}

static void read_back(void **state) {
  (void)state;
  unsigned char *grid = make_grid();
  for (uint16_t codec = 0; codec < 2; codec++) {
    size_t size;
    vlError error = {0};
    unsigned char *file = make_file(grid, codec, &size);
    if (load(file, size, &error, look) != VL_OK)
      fail_msg("%s", error.message);
    free(file);
  }
  free(grid);
}

static void expect(const unsigned char *file, size_t size, const char *word) {
  vlError error = {0};
  vlResult r = load(file, size, &error, NULL);
  if (r != VL_ERROR_SCENE || !strstr(error.message, word))
    fail_msg("%d: %s (expected: %s)", r, error.message, word);
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
  put(file + 16 + 176, "density2", 8); /* its name only begins so */
  expect(file, size, "no grid \"density\"");
  put(file + 16 + 176, "density", 8);
  file[14] = 2;
  expect(file, size, "BLOSC");
  file[14] = 0;
  expect(file, size - 100, "damaged");
  expect(file, 100, "damaged");
  put_u64(file + 16, SIZE + 8); /* plain, but more than is there */
  expect(file, size, "damaged");
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
  put_u32(file + 16 + 136, (uint32_t)size - 16 - 176 + 1); /* a name up to behind the end */
  expect(file, size, "damaged");
  put_u32(file + 16 + 136, 0); /* without a name, and nothing follows */
  put_u64(file + 24, 0);
  expect(file, 16 + 176, "no grid \"density\"");
  free(file);
  free(grid);
}

/* Any wrong byte of what is not values: an image's worth of memory or an error, never a
 * crash. */
static void shaken(void **state) {
  (void)state;
  unsigned char *grid = make_grid();
  uint32_t h = 1;
  for (int round = 0; round < 120; round++) {
    unsigned char *copy = malloc(SIZE);
    memcpy(copy, grid, SIZE);
    for (int k = 0; k < 4; k++) {
      h = h * 747796405u + 2891336453u;
      const size_t starts[4] = {0, ROOT_AT, UPPER_AT, LOWER_AT},
                   lengths[4] = {ROOT_AT, 160, UPPER, LOWER};
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

/* ---- memory ------------------------------------------------------------------------------ */

/* all 32768 children are one node: 512 MB of bricks */
static void look_before_background(const vlWorldMedium *m) {
  const vlSparseGrid *g = m->sparse;
  assert_true(vl_sparse_value(g, -1, 0, 0) == 2 && vl_sparse_value(g, 0, -5000, 0) == 2);
  assert_true(vl_sparse_value(g, 0, 0, 0) == 0 && vl_sparse_value(g, 1, 0, 0) == 2);
  assert_true(vl_sparse_value(g, 30, 0, 0) == 0 && vl_sparse_value(g, 300, 0, 0) == 0);
  assert_true(vl_sparse_value(g, 16, 0, 0) == 5 && vl_sparse_value(g, 128, 0, 0) == 7);
}

/* Where the tree says nothing a grid has its background; voxels and tiles of 0 stay 0. */
static void background(void **state) {
  (void)state;
  size_t size;
  vlError error = {0};
  unsigned char *grid = make_grid();
  put_f(grid + ROOT_AT + 28, 2);
  put_f(grid + LEAF_AT + LEAF_TABLE, 0);
  unsigned char *file = make_file(grid, 0, &size);
  assert_int_equal(load(file, size, &error, look_before_background), VL_OK);
  free(file);
  free(grid);
}

static void share_lower_nodes(unsigned char *g) {
  memset(g + UPPER_AT + 32 + 4096, 0xff, 4096);
  for (size_t n = 0; n < 32768; n++)
    put_u64(g + UPPER_AT + UPPER_TABLE + 8 * n, LOWER_AT - UPPER_AT);
}

static void share_leaves(unsigned char *g) { /* 4096 children are one leaf, 8 MB of values */
  memset(g + LOWER_AT + 32 + 512, 0xff, 512);
  for (size_t n = 0; n < 4096; n++)
    put_u64(g + LOWER_AT + LOWER_TABLE + 8 * n, LEAF_AT - LOWER_AT);
}

static void set_root_tiles(unsigned char *g, uint32_t count, const uint64_t *keys,
                           int64_t child, float value) {
  unsigned char *tiles = g + ROOT_AT + ROOT;
  put_u32(g + ROOT_AT + 24, count);
  for (uint32_t i = 0; i < count; i++) {
    put_u64(tiles + (size_t)TILE * i, keys[i]);
    put_u64(tiles + (size_t)TILE * i + 8, (uint64_t)child);
    put_f(tiles + (size_t)TILE * i + 20, value);
  }
}

/* A tile whose value is not the background is 32768 blocks; the tiles lie over the rest of the
 * file. */
static void fill_root(unsigned char *g) {
  uint64_t keys[5000];
  for (uint64_t i = 0; i < 5000; i++)
    keys[i] = i << 42;
  set_root_tiles(g, 5000, keys, 0, 3);
}

/* A table of 16384 x 4096 blocks. */
static void spread_root(unsigned char *g) {
  const uint64_t keys[2] = {0, (uint64_t)0x200 << 42 | (uint64_t)0x80 << 21};
  set_root_tiles(g, 2, keys, UPPER_AT - ROOT_AT, 0);
}

/* Nodes that are shared and parts that lie apart take no more memory than a whole file of this
 * size could. */
static void takes_no_more_than_its_size(void **state) {
  (void)state;
  static const struct {
    void (*damage)(unsigned char *grid);
    const char *word;
    size_t max; /* bytes; the file itself, the grid and the arrays while they grow */
  } cases[] = {{share_lower_nodes, "damaged", 1 << 20},
               {share_leaves, "damaged", 3 << 19},
               {fill_root, "fills too much space", 80u << 20},
               {spread_root, "too far", 1 << 20}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    size_t size, peak;
    vlError error = {0};
    unsigned char *grid = make_grid();
    cases[i].damage(grid);
    unsigned char *file = make_file(grid, 0, &size);
    const vlResult r = load_within(file, size, 0, &peak, &error, NULL);
    if (r != VL_ERROR_SCENE || !strstr(error.message, cases[i].word))
      fail_msg("%zu: %d, %s", i, r, error.message);
    if (peak > cases[i].max)
      fail_msg("%zu: %zu bytes", i, peak);
    free(file);
    free(grid);
  }
}

/* A packed grid unpacks to what its file says: 260 MB of 256 KB, which the context's limit
 * refuses before it is there. */
static void unpacks_within_the_limit(void **state) {
  (void)state;
  enum { UNPACKED = 256 << 20 };
  const size_t limit = 32 << 20;
  size_t size, peak;
  vlError error = {0};
  unsigned char *grid = make_grid(), *file = make_file(grid, 1, &size),
                *zeros = calloc(1, UNPACKED);
  uLongf packed = compressBound(UNPACKED);
  unsigned char *bomb = malloc(208 + packed);
  assert_int_equal(compress(bomb + 208, &packed, zeros, UNPACKED), Z_OK);
  put(bomb, file, 200);
  put_u64(bomb + 16, UNPACKED);
  put_u64(bomb + 24, packed + 8);
  put_u64(bomb + 200, packed);
  assert_true(packed < 512 << 10);
  assert_int_equal(load_within(bomb, 208 + packed, limit, &peak, &error, NULL),
                   VL_ERROR_MEMORY);
  assert_true(peak <= limit);
  free(bomb);
  free(zeros);
  free(file);
  free(grid);
}

/* Whatever the limit is: the file is read, or the error is MEMORY, and no more is held. */
static void keeps_the_limit(void **state) {
  (void)state;
  size_t size, whole, refusals = 0;
  vlError error = {0};
  unsigned char *grid = make_grid(), *file = make_file(grid, 1, &size);
  assert_int_equal(load_within(file, size, 0, &whole, &error, NULL), VL_OK);
  for (size_t limit = 100000; limit < whole + whole / 2; limit += whole / 40) {
    size_t peak;
    const vlResult r = load_within(file, size, limit, &peak, &error, NULL);
    if (r != VL_OK && r != VL_ERROR_MEMORY)
      fail_msg("%zu: %d, %s", limit, r, error.message);
    assert_true(peak <= limit);
    assert_true(r == VL_ERROR_MEMORY || limit > SIZE);
    refusals += r == VL_ERROR_MEMORY;
  }
  assert_true(refusals > 20);
  assert_int_equal(load_within(file, size, whole, NULL, &error, NULL), VL_OK);
  free(file);
  free(grid);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(read_back),
                                     cmocka_unit_test(background),
                                     cmocka_unit_test(refused),
                                     cmocka_unit_test(shaken),
                                     cmocka_unit_test(takes_no_more_than_its_size),
                                     cmocka_unit_test(unpacks_within_the_limit),
                                     cmocka_unit_test(keeps_the_limit)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
