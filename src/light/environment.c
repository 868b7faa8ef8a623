/* light/environment.c: the distribution over the cells of an environment image. */
#include "light/environment_lookup.h"

#include <math.h>

#include "base/error.h"
#include "light/compile.h"

_Static_assert(VL_ENVIRONMENT_CELLS <= VL_GUIDES && VL_GUIDES <= 65536,
               "cells are found from a guide of 16 bits");

/* Sets the pdf of each cell to its weight, the mean luminance, and its colour to that of its
 * (last) texel. *sum_all receives the sum of all weights, *upper the sum over the upper half of
 * directions of weight times cosine. */
static vlResult cell_luminances(const vlMipmap *mip, vlEnvironment *env, uint32_t step,
                                double *sum_all, double *upper, vlError *error) {
  uint32_t n = mip->levels[0].width, channels = mip->channels, size = env->size;
  for (uint32_t y = 0; y < size; y++)
    for (uint32_t x = 0; x < size; x++) {
      vlEnvironmentCell *cell = &env->cells[(size_t)y * size + x];
      double sum = 0;
      uint32_t count = 0;
      for (uint32_t j = y * step; j < (y + 1) * step && j < n; j++)
        for (uint32_t i = x * step; i < (x + 1) * step && i < n; i++) {
          vlTexel texel = vl_texel(mip, 0, (int32_t)i, (int32_t)j);
          for (int c = 0; c < 3; c++)
            cell->color[c] = texel.c[channels < 3 ? 0 : c];
          float l = vl_light_texel_luminance(texel, channels, env->space);
          if (!isfinite(l))
            return vl_fail(error, VL_ERROR_SCENE,
                           "pixel (%u, %u) of the image of the sky is not finite", i, j);
          if (l > 0)
            sum += l;
          count++;
        }
      cell->pdf = (float)(sum / count);
      *sum_all += sum / count;
      vlVec3 d = vl_octahedral_decode(((float)x + 0.5f) / (float)size,
                                      ((float)y + 0.5f) / (float)size);
      *upper += d.z > 0 ? sum / count * d.z : 0;
    }
  return VL_OK;
}

/* Subtracts the mean from all weights, limited to at least 0; if all weights are equal, they
 * become 1. Returns their sum. */
static double compensate(vlEnvironment *env, double mean) {
  uint32_t size = env->size;
  bool flat = true;
  for (uint32_t y = 0; y < size; y++)
    for (uint32_t x = 0; x < size; x++)
      flat = flat && env->cells[(size_t)y * size + x].pdf <= mean * 1.0001;
  double sum = 0;
  for (uint32_t y = 0; y < size; y++)
    for (uint32_t x = 0; x < size; x++) {
      float *pdf = &env->cells[(size_t)y * size + x].pdf;
      double w = flat ? 1 : *pdf > mean ? *pdf - mean : 0;
      *pdf = (float)w;
      sum += w;
    }
  return sum;
}

/* Makes a guide table: for each interval of u, the last of n intervals that starts at or before
 * it. from[i]: start of interval i. */
static void make_guide(const float *from, uint32_t n, uint16_t *guide) {
  uint32_t i = 0;
  for (uint32_t k = 0; k < VL_GUIDES; k++) {
    float u = (float)k * (1.0f / VL_GUIDES);
    while (i + 1 < n && from[i + 1] <= u)
      i++;
    guide[k] = (uint16_t)i;
  }
}

static void make_distribution(vlEnvironment *env, double sum_all) {
  uint32_t size = env->size;
  double marginal = 0;
  env->rows[0] = 0;
  for (uint32_t y = 0; y < size; y++) {
    vlEnvironmentCell *row = env->cells + (size_t)y * size;
    float *below = env->below + (size_t)y * (size + 1);
    double row_sum = 0, run = 0;
    for (uint32_t x = 0; x < size; x++)
      row_sum += row[x].pdf;
    below[0] = 0;
    for (uint32_t x = 0; x < size; x++) {
      run += row[x].pdf;
      below[x + 1] = row_sum > 0 ? (float)(run / row_sum) : (float)(x + 1) / (float)size;
    }
    below[size] = 1;
    marginal += row_sum;
    env->rows[y + 1] = (float)(marginal / sum_all);
    for (uint32_t x = 0; x < size; x++)
      row[x].pdf = (float)(row[x].pdf / sum_all * size * size);
    make_guide(below, size, env->cell_guide + (size_t)y * VL_GUIDES);
  }
  env->rows[size] = 1;
  make_guide(env->rows, size, env->row_guide);
}

/* The weight of a cell is the mean luminance of its texels minus the mean of all texels (MIS
 * compensation, Karlik et al. 2019), so that the uniform part is left to BSDF sampling. */
vlResult vl_world_build_environment(vlWorld *world, vlEnvironment *env, double *mean_luminance,
                                    double *illuminance, vlError *error) {
  const vlMipmap *mip = world->images.items[env->image].mipmap;
  uint32_t n = mip->levels[0].width,
           step = (n + VL_ENVIRONMENT_CELLS - 1) / VL_ENVIRONMENT_CELLS;
  uint32_t size = (n + step - 1) / step;
  env->size = size;
  env->cells_are_texels = step == 1;
  env->cells = vl_world_block(world, (size_t)size * size, sizeof *env->cells);
  env->below = vl_world_block(world, (size_t)size * (size + 1), sizeof *env->below);
  env->rows = vl_world_block(world, size + 1, sizeof *env->rows);
  env->row_guide = vl_world_block(world, VL_GUIDES, sizeof *env->row_guide);
  env->cell_guide = vl_world_block(world, (size_t)size * VL_GUIDES, sizeof *env->cell_guide);
  if (!env->cells || !env->below || !env->rows || !env->row_guide || !env->cell_guide)
    return vl_fail_memory(error);
  double total = 0, upper = 0;
  VL_TRY(cell_luminances(mip, env, step, &total, &upper, error));
  double mean = total / ((double)size * size);
  *mean_luminance = mean;
  /* pbrt-v4 takes the upper half for a hemisphere that fills the square: half of the true
   * illuminance. */
  *illuminance = upper * (world->def.imitate_pbrt ? 2 : 4) * M_PI / ((double)size * size);
  make_distribution(env, compensate(env, mean));
  return VL_OK;
}
