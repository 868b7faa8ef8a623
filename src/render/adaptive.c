/* render/adaptive.c: see adaptive.h. */
#include "render/adaptive.h"

#include <string.h>

#include "base/context.h"

enum { FIRST_COMPARISON = 16 };

/* 2^k or 3 * 2^k, from 16 on. */
static bool is_compared(uint32_t spp) {
  uint32_t odd = spp;
  while (odd && odd % 2 == 0) odd /= 2;
  return spp >= FIRST_COMPARISON && (odd == 1 || odd == 3);
}

static uint32_t next_comparison(uint32_t spp) {
  do spp++;
  while (!is_compared(spp));
  return spp;
}

typedef struct Comparison {
  vlAdaptive *a;
  const uint8_t *wanted; /* null: all blocks */
} Comparison;

static void compare_block(void *user, uint32_t block, uint32_t worker) {
  (void)worker;
  const Comparison *c = user;
  vlAdaptive *a = c->a;
  if ((c->wanted && !c->wanted[block]) || !is_compared(vl_film_block_spp(a->film, block))) return;
  a->seen[block] = vl_film_block_noise(a->film, block, a->view, a->exposure, a->scale, a->correlation);
  a->done[block] = a->seen[block] < a->noise;
}

static void compare_blocks(vlAdaptive *a, const uint8_t *wanted) {
  Comparison c = {a, wanted};
  if (a->noise > 0) vl_parallel_for(a->context, a->blocks, compare_block, &c);
}

vlResult vl_adaptive_create(vlAdaptive *a, vlContext *context, vlFilm *film, const vlRenderDef *def,
                            double correlation) {
  *a = (vlAdaptive){.context = context,
                    .film = film,
                    .noise = def->noise,
                    .view = def->noise_view,
                    .exposure = def->noise_exposure,
                    .scale = def->noise_scale,
                    .correlation = correlation,
                    .blocks = vl_film_block_count(vl_film_def(film)->crop)};
  a->done = vl_alloc_zero(context, a->blocks, sizeof *a->done);
  a->seen = vl_alloc_zero(context, a->blocks, sizeof *a->seen);
  a->pass = vl_alloc_zero(context, a->blocks, sizeof *a->pass);
  if (!a->done || !a->seen || !a->pass) return VL_ERROR_MEMORY;
  compare_blocks(a, NULL);
  return VL_OK;
}

void vl_adaptive_destroy(vlAdaptive *a) {
  if (!a->context) return;
  vl_free(a->context, a->done);
  vl_free(a->context, a->seen);
  vl_free(a->context, a->pass);
}

bool vl_adaptive_next(vlAdaptive *a, uint32_t total, uint32_t *first, uint32_t *count) {
  uint32_t least = total, end = total;
  for (uint32_t i = 0; i < a->blocks; i++)
    if (!a->done[i] && vl_film_block_spp(a->film, i) < least) least = vl_film_block_spp(a->film, i);
  a->in_pass = 0;
  for (uint32_t i = 0; i < a->blocks; i++) {
    uint32_t spp = vl_film_block_spp(a->film, i);
    a->pass[i] = !a->done[i] && spp == least && spp < total;
    a->in_pass += a->pass[i];
    if (!a->done[i] && spp > least && spp < end) end = spp;
  }
  if (a->noise > 0 && next_comparison(least) < end) end = next_comparison(least);
  *first = least, *count = end - least;
  return a->in_pass > 0;
}

bool vl_adaptive_has(const vlAdaptive *a, uint32_t x, uint32_t y) {
  return a->pass[vl_film_block_at(vl_film_def(a->film)->crop, x, y)];
}

vlResult vl_adaptive_end_pass(vlAdaptive *a, uint32_t count) {
  if (a->in_pass == a->blocks && !vl_film_is_adaptive(a->film)) {
    vl_film_set_spp(a->film, vl_film_spp(a->film) + count);
  } else {
    for (uint32_t i = 0; i < a->blocks; i++)
      if (a->pass[i] && vl_film_set_block_spp(a->film, i, vl_film_block_spp(a->film, i) + count) != VL_OK)
        return VL_ERROR_MEMORY;
  }
  compare_blocks(a, a->pass);
  return VL_OK;
}

double vl_adaptive_mean_spp(const vlAdaptive *a) {
  double sum = 0;
  for (uint32_t i = 0; i < a->blocks; i++) sum += vl_film_block_spp(a->film, i);
  return sum / a->blocks;
}

double vl_adaptive_expected_spp(const vlAdaptive *a, uint32_t total) {
  double sum = 0;
  for (uint32_t i = 0; i < a->blocks; i++) {
    double spp = vl_film_block_spp(a->film, i), ratio = a->noise > 0 ? a->seen[i] / a->noise : 0;
    double expected = a->done[i] ? spp : a->seen[i] > 0 && spp * ratio * ratio < total ? spp * ratio * ratio : total;
    sum += expected > spp ? expected : spp;
  }
  return sum / a->blocks;
}

uint32_t vl_adaptive_noisy(const vlAdaptive *a) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < a->blocks && a->noise > 0; i++) count += !a->done[i];
  return count;
}
