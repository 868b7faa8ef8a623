/* world/medium/medium.h: compiled participating media (pbrt book 11): coefficients as spectra, densities on grids,
 * and a coarse grid of majorants over each, by which free flights are sampled (trace/medium/medium.hot.c). media.c
 * and a file per kind (kinds.h) compile them, nanovdb.c reads NanoVDB grids, medium_lookup.h evaluates them. */
#ifndef WORLD_MEDIUM_MEDIUM_H
#define WORLD_MEDIUM_MEDIUM_H

#include "world/texture/texture.h"

/* Values at the centres of equal cells of a box, x fastest, `per` floats a cell; values null: no grid. */
typedef struct vlDenseGrid {
  uint32_t nx, ny, nz;
  const float *values;
} vlDenseGrid;

/* Values at integer coordinates, most of them the background: a table of blocks of 16^3 bricks of 8^3 values. An
 * entry of a table is the index of a block or brick; with VL_SPARSE_TILE set, it is the index of a constant value
 * (tile). */
#define VL_SPARSE_TILE 0x80000000u
enum { VL_BRICK = 8, VL_BLOCK = 128, VL_BRICK_VALUES = 512, VL_BLOCK_BRICKS = 4096 };
typedef struct vlSparseGrid {
  float index_from_medium[12];
  int32_t low[3];                 /* first coordinates of the table, multiples of 128 */
  uint32_t size[3];               /* blocks */
  const uint32_t *blocks;         /* size[0] * size[1] * size[2], x fastest */
  const uint32_t *bricks;         /* 4096 per block, x fastest */
  const float *values;            /* 512 per brick, x fastest */
  const float *tiles;             /* tile 0: the background */
  double box_low[3], box_high[3]; /* box of what is not background, medium space */
} vlSparseGrid;

typedef struct vlWorldMedium {
  vlMediumKind kind;
  vlSpectral sigma_a, sigma_s; /* scale included */
  vlSpectral emission;         /* scaled to the given luminance, scale included */
  float g;
  bool scatters, emits, grey; /* grey: the majorant is the same for all channels */
  bool by_channel;            /* absorbs by channel of linear sRGB: vlMediumDef.rgb_absorption, in spectral mode */
  float sigma_rgb[3];         /* by_channel: absorption, scale included; sigma_a is 0 */
  bool uniform;               /* constant everywhere: no box, no majorants */
  bool own_sigma;             /* coefficients come from grids; sigma_a and sigma_s are not read */
  float extinction;           /* homogeneous: vl_medium_extinction */
  float medium_from_world[12];
  float low[3], high[3]; /* medium space; all kinds except homogeneous */
  /* Upper bounds of the density (for an RGB grid, of sigma_t) over equal cells of the box. */
  uint32_t cells[3];
  const float *majorants;
  vlDenseGrid density, emission_scales, temperature;
  vlDenseGrid rgb_a, rgb_s, rgb_emission; /* 4 floats per cell: sigmoid and scale, or r g b 0 */
  float rgb_scale, rgb_emission_scale;
  vlSpectral illuminant; /* RGB grids: illuminant of the colour space */
  const vlSparseGrid *sparse, *sparse_temperature;
  float temperature_offset, temperature_scale, temperature_emission;
  const float *blackbody_rgb; /* RGB mode: VL_BLACKBODY_STEPS rows of 3 */
  float own[4];               /* numbers of a kind that has no members above */
} vlWorldMedium;

/* Colours of black bodies in RGB mode: step k is at VL_BLACKBODY_LOW * 2^(k / 32) kelvin. */
enum { VL_BLACKBODY_STEPS = 321 };
#define VL_BLACKBODY_LOW 100.0f

struct vlScene;
struct vlWorld;
/* Compiles the media in use and sets their indices in shapes, world->camera_medium and lights. */
vlResult vl_world_add_media(struct vlWorld *world, const struct vlScene *scene, vlError *error);
/* Reads the grid of that name. If there is none, *grid stays null. */
vlResult vl_nanovdb_read(struct vlWorld *world, const char *path, const char *name, const vlSparseGrid **grid,
                         vlError *error);

#endif
