/* sampler/sampler.c: computes the constants of a sampler: how spp samples are laid out in
 * cells, and numbers of bits. */
#include "sampler/sampler.h"

#include "velo/schema.h"

static uint32_t bits_for(uint32_t count) { /* smallest b with 2^b >= count */
  return count > 1 ? 32u - (uint32_t)__builtin_clz(count - 1) : 0;
}

static uint32_t floor_sqrt(uint32_t x) {
  uint32_t r = 0;
  while ((uint64_t)(r + 1) * (r + 1) <= x)
    r++;
  return r;
}

void vl_sampler_init(vlSampler *sampler, uint32_t kind, uint32_t seed, uint32_t width,
                     uint32_t height, uint32_t spp) {
  enum { MAX_SET = 1 << 20 };
  uint32_t count = spp ? spp : 1;
  uint32_t set = count < MAX_SET ? count : MAX_SET, root = floor_sqrt(set);
  /* Rows and columns: a factorisation with an aspect ratio of at most 2, if there is one; else
   * about sqrt(set) rows, the last of which are shorter by one cell. */
  uint32_t rows = root;
  while (rows > 1 && set % rows != 0)
    rows--;
  if (set / rows > 2 * rows)
    rows = set - root * root > root ? root + 1 : root;
  uint32_t columns = (set + rows - 1) / rows;
  /* multi-jittered counts up to grid_x * grid_y */
  uint32_t bits = bits_for(set + 2 * root + 2);
  *sampler = (vlSampler){
      .kind = kind,
      .seed = seed,
      .spp = count,
      .set = set,
      .log2_spp = count <= 0x80000000u ? bits_for(count) : 31,
      .morton_bits = 2 * bits_for(width > height ? width : height),
      .grid_x = columns,
      .grid_y = rows,
      .wide = rows - (rows * columns - set),
      .jitter_bits = bits < 14 ? 22 - bits : 8,
  };
}

/* By the sampler's row: a sampler that can go on without end has one sequence for any number of
 * samples; the others lay out cells for exactly the planned number. */
uint32_t vl_sampler_sequence(uint32_t kind, uint32_t spp) {
  const vlKindFamily *samplers = vl_kind_family_find("samplers");
  if ((uint32_t)kind < samplers->kind_count &&
      samplers->rows[kind]->traits & VL_SAMPLER_TRAIT_OPEN)
    return VL_SEQUENCE_LENGTH;
  return spp ? spp : 1;
}
