/* nanovdb_file.h: writes a small NanoVDB file, byte by byte from the format's description. */
#ifndef TEST_WORLD_NANOVDB_FILE_H
#define TEST_WORLD_NANOVDB_FILE_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

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

static inline void put(unsigned char *p, const void *v, size_t n) {
  memcpy(p, v, n);
}
static inline void put_u32(unsigned char *p, uint32_t v) {
  put(p, &v, 4);
}
static inline void put_u64(unsigned char *p, uint64_t v) {
  put(p, &v, 8);
}
static inline void put_f(unsigned char *p, float v) {
  put(p, &v, 4);
}
static inline void put_d(unsigned char *p, double v) {
  put(p, &v, 8);
}
static inline void set_bit(unsigned char *mask, uint32_t n) {
  mask[n >> 3] |= (unsigned char)(1u << (n & 7));
}

/* Two leaves at (0,0,0) and (8,0,0) of values x + 10 y + 100 z (+ 1), a tile of 8^3 of 5 at
 * (16,0,0), a tile of 128^3 of 7 at (128,0,0); voxels of half a unit, the first at (10, 0,
 * 0). */
static inline unsigned char *make_grid(void) {
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
  for (int i = 0; i < 6; i++)
    put_d(g + 560 + 8 * i, box[i]);
  put_u32(g + 632, 2);          /* fog volume */
  put_u32(g + 636, 1);          /* floats */
  put_u64(g + GRID + 24, TREE); /* root's offset from the tree */
  unsigned char *root = g + ROOT_AT, *tile = root + ROOT, *upper = g + UPPER_AT,
                *lower = g + LOWER_AT;
  put_u32(root + 24, 1);
  put_u64(tile, 0);
  put_u64(tile + 8, UPPER_AT - ROOT_AT);
  unsigned char *upper_child = upper + 32 + 4096, *lower_child = lower + 32 + 512;
  set_bit(upper_child, 0);
  put_u64(upper + UPPER_TABLE, LOWER_AT - UPPER_AT);
  put_f(upper + UPPER_TABLE + 8 * (1 << 10), 7);
  for (uint32_t k = 0; k < 2; k++) {
    set_bit(lower_child, k << 8);
    put_u64(lower + LOWER_TABLE + 8 * (size_t)(k << 8),
            LEAF_AT - LOWER_AT + (uint64_t)k * LEAF);
    for (uint32_t n = 0; n < 512; n++)
      put_f(g + LEAF_AT + k * LEAF + LEAF_TABLE + 4 * (size_t)n,
            (float)(8 * k + (n >> 6) + 10 * (n >> 3 & 7) + 100 * (n & 7) + 1));
  }
  put_f(lower + LOWER_TABLE + 8 * (size_t)(2 << 8), 5);
  return g;
}

/* A file of one grid; codec 0 plain, 1 zlib. Returns its bytes. */
static inline unsigned char *make_file(const unsigned char *grid, uint16_t codec,
                                       size_t *size) {
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

#endif
