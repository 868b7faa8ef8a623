/* world/medium/medium.h: compiled participating media (pbrt book 11): coefficients as spectra, densities on grids, and
 * a coarse grid of majorants over each, along which free flights are sampled (trace/medium/medium.hot.c). medium.c
 * compiles them, nanovdb.c reads those of files, medium_lookup.h looks up. */
#ifndef WORLD_MEDIUM_MEDIUM_H
#define WORLD_MEDIUM_MEDIUM_H

#include "world/texture/texture.h"

/* Values at the centres of equal cells of a box; null: none. x fastest; `per` floats a cell. */
typedef struct vlDenseGrid {
  uint32_t nx, ny, nz;
  const float *values;
} vlDenseGrid;

/* Values at whole coordinates, most of them the background: a table of blocks of 16^3 bricks of 8^3 values. An entry of
 * a table is the number of what lies there, or with VL_SPARSE_TILE set that of a value which is the same all over it.
 */
#define VL_SPARSE_TILE 0x80000000u
enum { VL_BRICK = 8, VL_BLOCK = 128, VL_BRICK_VALUES = 512, VL_BLOCK_BRICKS = 4096 };
typedef struct vlSparseGrid {
  float index_from_medium[12];
  int32_t low[3];                 /* first coordinates of the table, multiples of 128 */
  uint32_t size[3];               /* blocks */
  const uint32_t *blocks;         /* size[0] * size[1] * size[2], x fastest */
  const uint32_t *bricks;         /* 4096 a block, x fastest */
  const float *values;            /* 512 a brick, x fastest */
  const float *tiles;             /* tile 0: the background */
  double box_low[3], box_high[3]; /* of what is not background, medium space */
} vlSparseGrid;

typedef struct vlWorldMedium {
  vlMediumKind kind;
  vlSpectral sigma_a, sigma_s; /* scale included */
  vlSpectral emission;         /* luminance as said, scale included */
  float g;
  bool scatters, emits, grey; /* grey: the majorant is the same for all channels */
  bool by_channel;            /* absorbs by channel of linear sRGB: vlMediumDef.rgb_absorption, in spectral mode */
  float sigma_rgb[3];         /* by_channel: absorption, scale included; sigma_a is 0 */
  bool uniform;               /* the same everywhere: no box, no majorants */
  bool own_sigma;             /* coefficients are looked up, and sigma_a and sigma_s are not read */
  float extinction;           /* homogeneous: vl_medium_extinction */
  float medium_from_world[12];
  float low[3], high[3]; /* medium space; kinds but homogeneous */
  /* Upper bounds of the density (of an RGB grid: of sigma_t) over equal cells of the box. */
  uint32_t cells[3];
  const float *majorants;
  vlDenseGrid density, emission_scales, temperature;
  vlDenseGrid rgb_a, rgb_s, rgb_emission; /* 4 a cell: sigmoid and scale, or r g b 0 */
  float rgb_scale, rgb_emission_scale;
  vlSpectral illuminant; /* RGB grids: of the colour space */
  const vlSparseGrid *sparse, *sparse_temperature;
  float temperature_offset, temperature_scale, temperature_emission;
  const float *blackbody_rgb; /* RGB mode: VL_BLACKBODY_STEPS of 3 */
  float cloud_density, wispiness, frequency;
} vlWorldMedium;

/* Colours of black bodies in RGB mode: step k is of VL_BLACKBODY_LOW * 2^(k / 32) kelvin. */
enum { VL_BLACKBODY_STEPS = 321 };
#define VL_BLACKBODY_LOW 100.0f

struct vlScene;
struct vlWorld;
/* Compiles the media that something lies in; tells shapes, world->camera_medium and lights. */
vlResult vl_world_add_media(struct vlWorld *world, const struct vlScene *scene, vlError *error);
/* Reads the grid of that name (null where there is none: *grid stays null). */
vlResult vl_nanovdb_read(struct vlWorld *world, const char *path, const char *name, const vlSparseGrid **grid,
                         vlError *error);

#endif
