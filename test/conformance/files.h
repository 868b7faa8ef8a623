/* conformance/files.h: the files that the cases of kinds name: images, meshes, a measured BRDF,
 * densities. */
#ifndef TEST_CONFORMANCE_FILES_H
#define TEST_CONFORMANCE_FILES_H

#include <unistd.h>

#include "../trace/measured_file.h"
#include "../world/nanovdb_file.h"
#include "conformance.h"

static void path_of(char path[100], const char *name) {
  snprintf(path, 100, "%s/%s", folder, name);
}

static bool write_bytes(const char *name, const void *bytes, size_t size) {
  char path[100];
  path_of(path, name);
  FILE *file = fopen(path, "wb");
  bool done = file && fwrite(bytes, 1, size, file) == size;
  return file && fclose(file) == 0 && done;
}

/* An image of size x size pixels of three floats, in the format that the name says. */
static bool write_square(const char *name, uint32_t size, const float *pixels) {
  vlImageDef def = vl_default_image_def(size, size, 3);
  vlImage *image;
  char path[100];
  path_of(path, name);
  if (vl_image_create(context, &def, &image) != VL_OK)
    return false;
  memcpy(vl_image_pixels(image), pixels, 3 * (size_t)size * size * sizeof *pixels);
  bool done = vl_image_write(image, path, NULL, NULL) == VL_OK;
  vl_image_destroy(image);
  return done;
}

/* An image of 8 x 8 pixels of many values. */
static bool write_image(const char *name, float phase) {
  float pixels[3 * 64];
  for (int i = 0; i < 3 * 64; i++)
    pixels[i] = 0.5f + 0.4f * (float)((i * 37 + (int)phase * 11) % 64 - 32) / 32;
  return write_square(name, 8, pixels);
}

/* An image of 64 x 64 pixels: waves, and on them a grain of single pixels. */
static bool write_grain(const char *name) {
  static float pixels[3 * 64 * 64];
  for (int i = 0; i < 3 * 64 * 64; i++) {
    const int x = i / 3 % 64;
    const int y = i / 192;
    const double wave = sin(2 * PI * 3 * x / 64) * cos(2 * PI * (x + 4 * y) / 64);
    const double grain = fmod(i * 0.6180339887498949 + i % 7 * 0.41, 1.0) - 0.5;
    pixels[i] = (float)(0.5 + 0.25 * wave + 0.4 * grain);
  }
  return write_square(name, 64, pixels);
}

/* An image of 8 x 8 pixels with .2 and .4 in the left and right half of its upper rows, .6 and
 * .8 of the lower. */
static bool write_quarters(const char *name) {
  float pixels[3 * 64];
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 24; x++)
      pixels[24 * y + x] = (x < 12 ? 0.2f : 0.4f) + (y < 4 ? 0.0f : 0.4f);
  return write_square(name, 8, pixels);
}

/* The same image, of one channel; the lowest row is the file's first. */
static bool write_grey_quarters(const char *name) {
  char file[300] = "Pf\n8 8\n-1.0\n";
  const size_t head = strlen(file);
  for (int i = 0; i < 64; i++) {
    const float value = (i % 8 < 4 ? 0.2f : 0.4f) + (i < 32 ? 0.4f : 0.0f);
    memcpy(file + head + 4 * (size_t)i, &value, sizeof value);
  }
  return write_bytes(name, file, head + 256);
}

/* An image of 8 x 8 pixels whose left half is black, the right one white. */
static bool write_halves(const char *name) {
  float pixels[3 * 64];
  for (int i = 0; i < 3 * 64; i++)
    pixels[i] = i % 24 < 12 ? 0.0f : 1.0f;
  return write_square(name, 8, pixels);
}

/* An image of bytes whose name does not say its format: writers of scenes change it. */
static bool write_nameless(const char *name, float phase) {
  char png[100];
  char path[100];
  path_of(png, "nameless.png");
  path_of(path, name);
  return write_image("nameless.png", phase) && rename(png, path) == 0;
}

/* A map whose normals all are (.4, -.2, .8) but for their length. */
static bool write_tilted(const char *name) {
  static const float texel[3] = {0.7f, 0.4f, 0.9f};
  float pixels[12];
  for (int i = 0; i < 12; i++)
    pixels[i] = texel[i % 3];
  return write_square(name, 2, pixels);
}

/* A lamp of some candela towards the half plane C 0, changing linearly to those towards C 180,
 * and none upwards. */
static bool write_lamp(const char *name, int from, int to) {
  char file[200];
  const int size = snprintf(file, sizeof file,
                            "IESNA:LM-63-2002\nTILT=NONE\n1 -1 .5 3 2 1 2 0 0 0\n1 1 0\n"
                            "0 60 90\n0 180\n%d %d %d\n%d %d %d\n",
                            2 * from, 2 * from, 2 * from, 2 * to, 2 * to, 2 * to);
  return write_bytes(name, file, (size_t)size);
}

/* Its tables are not square. */
static bool write_measured(const char *name, double alpha) {
  char path[100];
  mfSurface metal = mf_surface(alpha, alpha);
  metal.nodes = metal.samples = 16;
  metal.rows = 11;
  mfFile file = mf_measure(&metal);
  path_of(path, name);
  bool done = mf_write(path, &file);
  free(file.bytes);
  return done;
}

/* A file of densities whose first voxels surround the origin. */
static bool write_nanovdb(const char *name, float last) {
  unsigned char *grid = make_grid();
  const double low[3] = {-2, -2 + 0.1 * last, -2};
  const double high[3] = {126, 62, 62};
  for (size_t i = 0; i < 3; i++) {
    put_d(grid + 296 + 232 + 8 * i, low[i]); /* the map's translation */
    put_d(grid + 560 + 8 * i, low[i]);       /* the bounding box in world space */
    put_d(grid + 584 + 8 * i, high[i]);
  }
  size_t size;
  unsigned char *file = make_file(grid, 0, &size);
  bool done = write_bytes(name, file, size);
  free(file);
  free(grid);
  return done;
}

/* A file of eight blocks of 128 voxels in each direction, of the densities 1 to 8: the number
 * grows along x, then y, then z. They are tiles of the upper node, whose table has x first; it
 * ends at the origin, so that all coordinates of its voxels are negative. The first block is a
 * lower node, of tiles of eight voxels: by the same order eight parts of the densities 2 to 9,
 * which meet three quarters through it. */
static bool write_blocks(const char *name) {
  unsigned char *grid = make_grid();
  unsigned char *upper = grid + UPPER_AT;
  upper[32 + 4096] = 0;                            /* the first tile is no lower node */
  put_u64(grid + ROOT_AT + ROOT, UINT64_MAX >> 1); /* the node before the origin */
  put_u32(grid + ROOT_AT + 24, 2);                 /* a tile behind it: 4096^3 voxels of 1 */
  put_f(grid + ROOT_AT + ROOT + TILE + 20, 1);
  for (size_t i = 0; i < 2; i++)
    put_u64(upper + UPPER_TABLE + 8 * (i << 10), 0);
  for (uint32_t i = 1; i < 8; i++) {
    const size_t at = (size_t)(30 + (i & 1)) << 10 | (30 + (i >> 1 & 1)) << 5 | (30 + (i >> 2));
    put_u64(upper + UPPER_TABLE + 8 * at, 0);
    put_f(upper + UPPER_TABLE + 8 * at, (float)(i + 1));
  }
  const uint32_t first = 30 << 10 | 30 << 5 | 30;
  set_bit(upper + 32 + 4096, first);
  put_u64(upper + UPPER_TABLE + 8 * (size_t)first, LOWER_AT - UPPER_AT);
  unsigned char *lower = grid + LOWER_AT;
  memset(lower + 32 + 512, 0, 512); /* none of its tiles is a leaf */
  for (uint32_t n = 0; n < 4096; n++) {
    const uint32_t part = (n >> 8 >= 12) + 2 * ((n >> 4 & 15) >= 12) + 4 * ((n & 15) >= 12);
    put_u64(lower + LOWER_TABLE + 8 * (size_t)n, 0);
    put_f(lower + LOWER_TABLE + 8 * (size_t)n, (float)(part + 2));
  }
  for (size_t i = 0; i < 3; i++) {
    put_d(grid + 296 + 88 + 8 * (4 * i), 1.0 / 128); /* the map, its inverse */
    put_d(grid + 296 + 160 + 8 * (4 * i), 128);
    put_d(grid + 296 + 232 + 8 * i, 1);
    put_d(grid + 560 + 8 * i, -1);
    put_d(grid + 584 + 8 * i, 1);
  }
  size_t size;
  unsigned char *file = make_file(grid, 0, &size);
  bool done = write_bytes(name, file, size);
  free(file);
  free(grid);
  return done;
}

static const char ply[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
    "float z\n"
    "property float u\nproperty float v\nelement face 2\nproperty list uchar int "
    "vertex_indices\n"
    "end_header\n-1 -1 0 0 0\n1 -1 0 1 0\n-1 1 0 0 1\n1 1 0 1 1\n3 0 1 2\n3 1 3 2\n";

/* The same as one quad. */
static const char quad_ply[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
    "float z\n"
    "property float u\nproperty float v\nelement face 1\nproperty list uchar int "
    "vertex_indices\n"
    "end_header\n-1 -1 0 0 0\n1 -1 0 1 0\n-1 1 0 0 1\n1 1 0 1 1\n4 0 1 3 2\n";

static bool write_files(void) {
  bool done = write_image("a.pfm", 0) && write_image("b.pfm", 1) && write_image("sky.pfm", 2) &&
              write_image("other.pfm", 3) && write_image("normals.pfm", 4) &&
              write_nameless("normals.img", 4) && write_image("a.tga", 5) &&
              write_quarters("quarters.pfm") && write_grey_quarters("grey.pfm") &&
              write_halves("halves.pfm") && write_grain("grain.pfm") &&
              write_tilted("tilted.pfm") && write_lamp("lamp.ies", 2, 1) &&
              write_lamp("other.ies", 3, 9);
  done = done && write_bytes("a.ply", ply, sizeof ply - 1) &&
         write_bytes("quad.ply", quad_ply, sizeof quad_ply - 1);
  done = done && write_measured("a.bsdf", 0.3) && write_measured("b.bsdf", 0.1) &&
         write_nanovdb("a.nvdb", 0) && write_nanovdb("b.nvdb", 1) &&
         write_blocks("blocks.nvdb");
  return done;
}

/* Removes the folder and all files in it. */
static void remove_files(void) {
  char command[100];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  if (system(command) != 0)
    print_error("%s stays\n", folder);
}

#endif
