/* film/blocks.c: the blocks of a film and their numbers of samples, which differ with adaptive
 * sampling. */
#include "film/sums.h"

static uint32_t cells(uint32_t low, uint32_t high) {
  return (high + VL_FILM_BLOCK - 1) / VL_FILM_BLOCK - low / VL_FILM_BLOCK;
}

uint32_t vl_film_block_count(const uint32_t w[4]) {
  return cells(w[0], w[2]) * cells(w[1], w[3]);
}

void vl_film_block_window(const uint32_t w[4], uint32_t index, uint32_t area[4]) {
  uint32_t across = cells(w[0], w[2]), x = w[0] / VL_FILM_BLOCK + index % across;
  uint32_t y = w[1] / VL_FILM_BLOCK + index / across;
  area[0] = x * VL_FILM_BLOCK > w[0] ? x * VL_FILM_BLOCK : w[0];
  area[1] = y * VL_FILM_BLOCK > w[1] ? y * VL_FILM_BLOCK : w[1];
  area[2] = (x + 1) * VL_FILM_BLOCK < w[2] ? (x + 1) * VL_FILM_BLOCK : w[2];
  area[3] = (y + 1) * VL_FILM_BLOCK < w[3] ? (y + 1) * VL_FILM_BLOCK : w[3];
}

uint32_t vl_film_block_at(const uint32_t w[4], uint32_t x, uint32_t y) {
  return (y / VL_FILM_BLOCK - w[1] / VL_FILM_BLOCK) * cells(w[0], w[2]) + x / VL_FILM_BLOCK -
         w[0] / VL_FILM_BLOCK;
}

uint32_t vl_film_block_spp(const vlFilm *film, uint32_t block) {
  return film->block_spp ? film->block_spp[block] : film->spp;
}

vlResult vl_film_set_block_spp(vlFilm *film, uint32_t block, uint32_t spp) {
  uint32_t count = vl_film_block_count(film->def.crop);
  if (!film->block_spp) {
    film->block_spp = vl_alloc_array(film->context, count, sizeof *film->block_spp);
    if (!film->block_spp)
      return VL_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
      film->block_spp[i] = film->spp;
  }
  film->block_spp[block] = spp;
  if (film->spp < spp)
    film->spp = spp;
  return VL_OK;
}

vlComparedNoise *vl_film_compared(vlFilm *film) {
  if (!film->compared)
    film->compared = vl_alloc_zero(film->context, vl_film_block_count(film->def.crop),
                                   sizeof *film->compared);
  return film->compared;
}

void vl_film_forget_compared(vlFilm *film) {
  vl_free(film->context, film->compared);
  film->compared = NULL;
}

bool vl_film_is_adaptive(const vlFilm *film) {
  uint32_t count = vl_film_block_count(film->def.crop);
  for (uint32_t i = 0; film->block_spp && i < count; i++)
    if (film->block_spp[i] != film->spp)
      return true;
  return false;
}
