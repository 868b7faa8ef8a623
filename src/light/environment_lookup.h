/* light/environment_lookup.h: an environment image in pbrt's equal-area octahedral
 * square, with a distribution over its cells (pbrt book 12.5.2). environment.c builds it; the
 * lookups are inline, for the hot loops.
 *
 * A cell is sampled by inverting the cumulative distribution, not by an alias table:
 * well-distributed random numbers stay well distributed. A guide table (Chen and Asau 1974)
 * replaces the binary search: for each of VL_GUIDES equal intervals of the random number it
 * holds the cell that contains the start of the interval. A linear search from that cell passes
 * 1 cell on average. */
#ifndef LIGHT_ENVIRONMENT_LOOKUP_H
#define LIGHT_ENVIRONMENT_LOOKUP_H

#include "math/octahedral.h"
#include "math/warp.h"
#include "velo/spectrum.h"

/* VL_GUIDES is a power of two, so that u * VL_GUIDES is exact; at least VL_ENVIRONMENT_CELLS.
 * Images of more texels than cells have noise where the texels of a cell differ, such as at the
 * rim of a sun. 2048 x 2048 cells and their tables take 90 MB. */
enum { VL_ENVIRONMENT_CELLS = 2048, VL_GUIDES = 2048 };

/* 16 bytes, so that density and radiance are in one cache line. */
typedef struct vlEnvironmentCell {
  float pdf;      /* density over the unit square */
  float color[3]; /* of the cell's texel, if cells are texels */
} vlEnvironmentCell;

typedef struct vlEnvironment {
  int32_t image;
  vlColorSpace space;    /* of the image */
  uint32_t size;         /* of the distribution: size x size cells */
  bool cells_are_texels; /* the image has as many texels, so that the cells hold its colours */
  vlEnvironmentCell *cells; /* size rows of size cells */
  float *rows;              /* size + 1: cumulative distribution of the rows */
  float *below; /* size rows of size + 1: cumulative distribution of each row's cells, from 0 to
                   1 */
  uint16_t *row_guide;  /* guide table of VL_GUIDES entries for the rows */
  uint16_t *cell_guide; /* a guide table of VL_GUIDES entries per row, for its cells */
  float light_from_world[9], world_from_light[9]; /* rotations, row-major */
  const struct vlPortal *portal; /* the portal through which the environment is visible
                                    (light/portal.h); null: it is visible everywhere */
} vlEnvironment;

static inline uint32_t vl_guide_index(float u) {
  uint32_t i = (uint32_t)(int32_t)(u * VL_GUIDES);
  return i < VL_GUIDES ? i : VL_GUIDES - 1;
}

/* Finds the row, or the cell of row y, that contains u in [0, 1), as vl_find_cell does.
 * *within: position in the row or cell, in [0, 1). */
static inline float vl_within_cell(float low, float high, float u) {
  float width = high - low;
  return width > 0.0f ? vl_clamp((u - low) / width, 0.0f, VL_ONE_MINUS_EPSILON) : 0.5f;
}
static inline uint32_t vl_environment_row(const vlEnvironment *env, float u, float *within) {
  uint32_t i = env->row_guide[vl_guide_index(u)];
  while (i + 1 < env->size && env->rows[i + 1] <= u)
    i++;
  *within = vl_within_cell(env->rows[i], env->rows[i + 1], u);
  return i;
}
static inline uint32_t vl_environment_cell(const vlEnvironment *env, uint32_t y, float u,
                                           float *within) {
  const float *below = env->below + (size_t)y * (env->size + 1);
  uint32_t i = env->cell_guide[(size_t)y * VL_GUIDES + vl_guide_index(u)];
  while (i + 1 < env->size && below[i + 1] <= u)
    i++;
  *within = vl_within_cell(below[i], below[i + 1], u);
  return i;
}

/* The cell that contains a point of the unit square, as an index into cells. */
static inline uint32_t vl_environment_at(const vlEnvironment *env, float s, float t) {
  uint32_t x = (uint32_t)(int32_t)(s * (float)env->size),
           y = (uint32_t)(int32_t)(t * (float)env->size);
  x = x < env->size ? x : env->size - 1;
  y = y < env->size ? y : env->size - 1;
  return y * env->size + x;
}

static inline vlVec3 vl_environment_direction(const vlEnvironment *env, float s, float t) {
  return vl_normalize(vl_turn(env->world_from_light, vl_octahedral_decode(s, t)));
}
static inline vlVec2 vl_environment_square(const vlEnvironment *env, vlVec3 d) {
  return vl_octahedral_encode(vl_normalize(vl_turn(env->light_from_world, d)));
}

#endif
