/* medium/medium.h: compiled participating media (pbrt book 11): coefficients as spectra,
 * densities on grids, and for each medium a coarse grid of majorants, by which free flights are
 * sampled (trace/medium/medium.hot.c). compile.c and a file per kind (kinds.row.h) compile
 * them, nanovdb_grid.c reads NanoVDB grids, lookup.h evaluates them. */
#ifndef MEDIUM_MEDIUM_H
#define MEDIUM_MEDIUM_H

#include "texture/node.h"

/* A dense grid: values at the centres of equal cells of a box, x fastest, `per` floats per
 * cell. values is null if there is no grid. */
typedef struct vlDenseGrid {
  uint32_t nx, ny, nz;
  const float *values;
} vlDenseGrid;

/* A sparse grid: values at integer coordinates, most of them equal to the background. A table
 * lists size of the table, in blocks, a block lists 16^3 bricks, and a brick holds 8^3 values.
 * An entry of the table is the index of a block, and an entry of a block the index of a brick;
 * if VL_SPARSE_TILE is set, either is the index of a constant value (tile). */
#define VL_SPARSE_TILE 0x80000000u
enum { VL_BRICK = 8, VL_BLOCK = 128, VL_BRICK_VALUES = 512, VL_BLOCK_BRICKS = 4096 };
typedef struct vlSparseGrid {
  float index_from_medium[12];
  int32_t low[3];         /* smallest coordinates that the table covers, multiples of 128 */
  uint32_t size[3];       /* blocks */
  const uint32_t *blocks; /* size[0] * size[1] * size[2], x fastest */
  const uint32_t *bricks; /* 4096 entries per block, x fastest */
  const float *values;    /* 512 values per brick, x fastest */
  const float *tiles;     /* constant values; tile 0 is the background */
  /* box of all values that differ from the background, medium space */
  double box_low[3], box_high[3];
} vlSparseGrid;

typedef struct vlWorldMedium {
  uint32_t kind;               /* vlMediumKind */
  vlSpectral sigma_a, sigma_s; /* multiplied by the medium's scale */
  vlSpectral emission; /* scaled to the given luminance and multiplied by the medium's scale */
  float g;
  bool scatters, emits, grey; /* grey: the majorant is the same for all channels */
  bool by_channel;            /* absorption is given per channel of linear sRGB
                                 (vlMediumDef.rgb_absorption) and the mode is spectral */
  float sigma_rgb[3]; /* if by_channel: absorption coefficients multiplied by the scale; sigma_a
                         is then 0 */
  bool uniform;       /* the medium is the same everywhere: it has no box and no majorants */
  bool own_sigma;     /* coefficients come from grids; sigma_a and sigma_s are not read */
  float extinction;   /* of a homogeneous medium: the result of vl_medium_extinction */
  float medium_from_world[12];
  /* box of the medium, in medium space; of all kinds except homogeneous */
  float low[3], high[3];
  /* Majorants: upper bounds of the density (of sigma_t for an RGB grid) in equal cells of the
   * box. */
  uint32_t cells[3];
  const float *majorants;
  vlDenseGrid density, emission_scales, temperature;
  /* 4 floats per cell: sigmoid and scale of a spectrum, or r, g, b, 0 */
  vlDenseGrid rgb_a, rgb_s, rgb_emission;
  float rgb_scale, rgb_emission_scale;
  vlSpectral illuminant; /* of RGB grids: the illuminant of the colour space */
  const vlSparseGrid *sparse, *sparse_temperature;
  float temperature_offset, temperature_scale, temperature_emission;
  const float *blackbody_rgb; /* in RGB mode: VL_BLACKBODY_STEPS colours of 3 floats */
  float own[4];               /* parameters of kinds that have no members of their own */
} vlWorldMedium;

/* Colours of blackbodies in RGB mode: colour k has the temperature VL_BLACKBODY_LOW * 2^(k /
 * 32) kelvin. */
enum { VL_BLACKBODY_STEPS = 321 };
#define VL_BLACKBODY_LOW 100.0f

struct vlScene;
struct vlWorld;
/* Compiles the media in use and sets their indices in shapes, world->camera_medium and
 * lights. */
vlResult vl_world_add_media(struct vlWorld *world, const struct vlScene *scene, vlError *error);
/* Reads the grid of that name from a file. If the file has none, *grid stays null. */
vlResult vl_nanovdb_read(struct vlWorld *world, const char *path, const char *name,
                         const vlSparseGrid **grid, vlError *error);

#endif
