/* test_nanovdb.c: NanoVDB files made here, byte by byte after the format, are read back voxel by voxel; wrong ones are
 * refused with a word about why, whatever byte is wrong. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>
/* after those */
#include <cmocka.h>

#include "velo/velo.h"
#include "world/medium_lookup.h"

/* Offsets of version 32's layout for grids of floats. */
enum {
  GRID = 672,
  TREE = 64,
  ROOT = 64,
  TILE = 32,
  UPPER_TABLE = 8256,
  UPPER = UPPER_TABLE + 32768 * 8,
  LOWER_TABLE = 1088,
  LOWER = LOWER_TABLE + 4096 * 8,
  LEAF_TABLE = 96,
  LEAF = LEAF_TABLE + 2048,
  ROOT_AT = GRID + TREE,
  UPPER_AT = ROOT_AT + ROOT + 2 * TILE,
  LOWER_AT = UPPER_AT + UPPER,
  LEAF_AT = LOWER_AT + LOWER,
  SIZE = LEAF_AT + 2 * LEAF
};

static void put(unsigned char *p, const void *v, size_t n) {
  memcpy(p, v, n);
}
static void put_u32(unsigned char *p, uint32_t v) {
  put(p, &v, 4);
}
static void put_u64(unsigned char *p, uint64_t v) {
  put(p, &v, 8);
}
static void put_f(unsigned char *p, float v) {
  put(p, &v, 4);
}
static void put_d(unsigned char *p, double v) {
  put(p, &v, 8);
}
static void set_bit(unsigned char *mask, uint32_t n) {
  mask[n >> 3] |= (unsigned char)(1u << (n & 7));
}

/* Two leaves at (0,0,0) and (8,0,0) of values x + 10 y + 100 z (+ 1), a tile of 8^3 of 5 at (16,0,0), a tile of 128^3
 * of 7 at (128,0,0); voxels of half a unit, the first at (10, 0, 0). */
static unsigned char *make_grid(void) {
  unsigned char *g = calloc(1, SIZE);
  put(g, "NanoVDB0", 8);
  put_u32(g + 16, 32u << 21 | 4u << 10);
  put_u64(g + 32, SIZE);
  put(g + 40, "density", 8);
  for (uint32_t i = 0; i < 3; i++) {
    put_d(g + 296 + 88 + 8 * (4 * (size_t)i), 0.5);
    put_d(g + 296 + 160 + 8 * (4 * (size_t)i), 2.0);
  }
  put_d(g + 296 + 232, 10);
  const double box[6] = {10, 0, 0, 10 + 128, 64, 64};
  for (int i = 0; i < 6; i++) put_d(g + 560 + 8 * i, box[i]);
  put_u32(g + 632, 2);          /* fog volume */
  put_u32(g + 636, 1);          /* floats */
  put_u64(g + GRID + 24, TREE); /* root's offset from the tree */
  unsigned char *root = g + ROOT_AT, *tile = root + ROOT, *upper = g + UPPER_AT, *lower = g + LOWER_AT;
  put_u32(root + 24, 1);
  put_u64(tile, 0);
  put_u64(tile + 8, UPPER_AT - ROOT_AT);
  unsigned char *upper_child = upper + 32 + 4096, *lower_child = lower + 32 + 512;
  set_bit(upper_child, 0);
  put_u64(upper + UPPER_TABLE, LOWER_AT - UPPER_AT);
  put_f(upper + UPPER_TABLE + 8 * (1 << 10), 7);
  for (uint32_t k = 0; k < 2; k++) {
    set_bit(lower_child, k << 8);
    put_u64(lower + LOWER_TABLE + 8 * (size_t)(k << 8), LEAF_AT - LOWER_AT + (uint64_t)k * LEAF);
    for (uint32_t n = 0; n < 512; n++)
      put_f(g + LEAF_AT + k * LEAF + LEAF_TABLE + 4 * (size_t)n,
            (float)(8 * k + (n >> 6) + 10 * (n >> 3 & 7) + 100 * (n & 7) + 1));
  }
  put_f(lower + LOWER_TABLE + 8 * (size_t)(2 << 8), 5);
  return g;
}

static const char *file_name(void) {
  static char name[128];
  snprintf(name, sizeof name, "%s/test_nanovdb_%d.nvdb", VELO_BINARY_DIR, (int)getpid());
  return name;
}

/* A file of one grid; codec 0 plain, 1 zlib. Returns its bytes. */
static unsigned char *make_file(const unsigned char *grid, uint16_t codec, size_t *size) {
  uLongf packed = compressBound(SIZE);
  unsigned char *file = calloc(1, 16 + 176 + 8 + 8 + packed), *body = file + 16 + 176 + 8;
  put(file, "NanoVDB0", 8);
  put_u32(file + 8, 32u << 21 | 4u << 10);
  file[12] = 1;
  file[14] = (unsigned char)codec;
  put_u64(file + 16, SIZE);
  put_u32(file + 16 + 136, 8);
  put(file + 16 + 176, "density", 8);
  uint64_t bytes = SIZE;
  if (codec == 1) {
    compress(body + 8, &packed, grid, SIZE);
    put_u64(body, packed);
    bytes = packed + 8;
  } else {
    put(body, grid, SIZE);
  }
  put_u64(file + 24, bytes);
  *size = 16 + 176 + 8 + bytes;
  return file;
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
  vl_scene_settings(scene)->camera_medium = vl_scene_add_medium(scene, &def);
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

/* Any wrong byte of what is not values: a picture's worth of memory or an error, never a crash. */
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
