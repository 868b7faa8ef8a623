/* render/adaptive.c: see adaptive.h. */
#include "render/adaptive.h"

#include <math.h>

#include "base/context.h"
#include "base/free.h"

enum { FIRST_COMPARISON = 8 };

/* The least number above spp (> 0) of the form n * 2^k, with n from `parts` to 2 * parts - 1;
 * parts: a power of two. spp >= parts. */
static uint32_t next_number(uint32_t spp, uint32_t parts) {
  uint32_t step = (1u << (31 - __builtin_clz(spp))) / parts;
  return spp < UINT32_MAX - step ? (spp / step + 1) * step : UINT32_MAX;
}

/* The least 2^k or 3 * 2^k above spp, from 8 on. */
static uint32_t next_comparison(uint32_t spp) {
  return spp < FIRST_COMPARISON ? FIRST_COMPARISON : next_number(spp, 2);
}

static bool is_compared(uint32_t spp) {
  return spp >= FIRST_COMPARISON && next_comparison(spp - 1) == spp;
}

static float view_factor(const vlAdaptive *a) {
  return (float)vl_film_view_factor(a->exposure, a->scale);
}

/* The block's last comparison, if it was of these display values; null: there is none. */
static const vlComparedNoise *last_comparison(const vlAdaptive *a, uint32_t block) {
  const vlComparedNoise *last = a->compared + block;
  bool holds = is_compared(last->spp) && last->spp <= vl_film_block_spp(a->film, block) &&
               last->view == (uint32_t)a->view && last->factor == view_factor(a);
  return holds ? last : NULL;
}

/* The number of samples at which a block ends by this comparison, which may be null;
 * UINT32_MAX: not known yet. The error falls as the square root of the number of samples. */
static uint32_t end_by(const vlAdaptive *a, const vlComparedNoise *last) {
  if (!last)
    return UINT32_MAX;
  double ratio = (double)last->noise / a->noise, needed = (double)last->spp * ratio * ratio;
  uint32_t end = next_number(last->spp, 8), next = next_comparison(last->spp);
  while (end < needed && end < next)
    end = next_number(end, 8);
  return end >= needed ? end : UINT32_MAX;
}

typedef struct Comparison {
  vlAdaptive *a;
  const uint8_t *wanted; /* null: all blocks */
} Comparison;

static void compare_block(void *user, uint32_t block, VL_UNUSED uint32_t worker) {
  const Comparison *c = user;
  vlAdaptive *a = c->a;
  if (c->wanted && !c->wanted[block])
    return;
  const vlComparedNoise *last = last_comparison(a, block);
  uint32_t spp = vl_film_block_spp(a->film, block);
  bool is_new = is_compared(spp) && (!last || last->spp < spp);
  if (is_new && end_by(a, last) == UINT32_MAX) {
    vl_film_compare_block(a->film, block, a->view, a->exposure, a->scale, a->correlation);
    last = last_comparison(a, block);
  }
  a->end[block] = end_by(a, last);
}

static bool is_done(const vlAdaptive *a, uint32_t block) {
  return vl_film_block_spp(a->film, block) >= a->end[block];
}

static void compare_blocks(vlAdaptive *a, const uint8_t *wanted) {
  Comparison c = {a, wanted};
  if (a->noise > 0)
    vl_parallel_for(a->context, a->blocks, compare_block, &c);
}

vlResult vl_adaptive_create(vlAdaptive *a, vlContext *context, vlFilm *film,
                            const vlRenderDef *def, double correlation) {
  *a = (vlAdaptive){.context = context,
                    .film = film,
                    .noise = def->noise,
                    .view = def->noise_view,
                    .exposure = def->noise_exposure,
                    .scale = def->noise_scale,
                    .correlation = correlation,
                    .blocks = vl_film_block_count(vl_film_def(film)->crop)};
  a->end = vl_alloc_array(context, a->blocks, sizeof *a->end);
  a->pass = vl_alloc_zero(context, a->blocks, sizeof *a->pass);
  if (a->noise > 0)
    a->compared = vl_film_compared(film);
  else
    vl_film_forget_compared(film);
  if (!a->end || !a->pass || (a->noise > 0 && !a->compared))
    return VL_ERROR_MEMORY;
  for (uint32_t i = 0; i < a->blocks; i++)
    a->end[i] = UINT32_MAX;
  compare_blocks(a, NULL);
  return VL_OK;
}

void vl_adaptive_destroy(vlAdaptive *a) {
  if (!a->context)
    return;
  VL_FREE(a->context, a->end, a->pass);
}

static void block_area(const vlAdaptive *a, uint32_t block, uint32_t area[4]) {
  vl_film_block_window(vl_film_def(a->film)->crop, block, area);
}

/* Takes the blocks below the first rows of the pass out of it. */
static void keep_rows(vlAdaptive *a) {
  uint64_t end = 0;
  for (uint32_t i = 0; i < a->blocks && a->rows; i++) {
    uint32_t area[4];
    if (!a->pass[i])
      continue;
    block_area(a, i, area);
    if (!end)
      end = (uint64_t)area[1] + a->rows;
    a->pass[i] = area[1] < end;
    a->in_pass -= !a->pass[i];
  }
}

uint32_t vl_adaptive_rows(const vlAdaptive *a) {
  const uint32_t *crop = vl_film_def(a->film)->crop;
  uint32_t area[4] = {0, crop[3]}, i = 0;
  while (i < a->blocks && vl_film_block_spp(a->film, i) == vl_film_spp(a->film))
    i++;
  if (i < a->blocks)
    block_area(a, i, area);
  return area[1] - crop[1];
}

bool vl_adaptive_next(vlAdaptive *a, uint32_t total, uint32_t *first, uint32_t *count) {
  uint32_t min = total, end = total;
  for (uint32_t i = 0; i < a->blocks; i++)
    if (!is_done(a, i) && vl_film_block_spp(a->film, i) < min)
      min = vl_film_block_spp(a->film, i);
  a->in_pass = 0;
  for (uint32_t i = 0; i < a->blocks; i++) {
    uint32_t spp = vl_film_block_spp(a->film, i);
    a->pass[i] = !is_done(a, i) && spp == min && spp < total;
    a->in_pass += a->pass[i];
    if (a->pass[i] && a->end[i] < end)
      end = a->end[i];
    if (!is_done(a, i) && spp > min && spp < end)
      end = spp;
  }
  if (a->noise > 0 && next_comparison(min) < end)
    end = next_comparison(min);
  keep_rows(a);
  *first = min;
  *count = end - min;
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
      if (a->pass[i] &&
          vl_film_set_block_spp(a->film, i, vl_film_block_spp(a->film, i) + count) != VL_OK)
        return VL_ERROR_MEMORY;
  }
  compare_blocks(a, a->pass);
  return VL_OK;
}

double vl_adaptive_mean_spp(const vlAdaptive *a) {
  double sum = 0;
  for (uint32_t i = 0; i < a->blocks; i++)
    sum += vl_film_block_spp(a->film, i);
  return sum / a->blocks;
}

double vl_adaptive_expected_spp(const vlAdaptive *a, uint32_t total) {
  double sum = 0;
  for (uint32_t i = 0; i < a->blocks; i++) {
    double spp = vl_film_block_spp(a->film, i), expected = total;
    if (a->compared && a->compared[i].spp) {
      double ratio = (double)a->compared[i].noise / a->noise;
      expected = fmin(total, (double)a->compared[i].spp * ratio * ratio);
    }
    sum += is_done(a, i) ? spp : fmax(spp, expected);
  }
  return sum / a->blocks;
}

uint32_t vl_adaptive_noisy(const vlAdaptive *a) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < a->blocks && a->noise > 0; i++)
    count += !is_done(a, i);
  return count;
}
