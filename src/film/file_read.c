/* film/file_read.c: vl_film_read: reads the blocks of a file into a film in memory. */
#include <string.h>

#include "base/error.h"
#include "film/file.h"
#include "velo/film.h"

/* Summary of all blocks that have samples. crop: their bounding box, pixels; range: the samples
 * of the first; pixels: their number; least: the smallest number of samples of a block. */
typedef struct Extent {
  uint32_t crop[4];
  vlSampleSpan range;
  /* even: all pixels of the crop have the samples of `range`; joined: all have a single range
   * with the same first */
  bool any, even, joined;
  uint64_t pixels, min;
} Extent;

static void add_block(Extent *e, const vlFilmReader *r) {
  const vlFilmBlockHead *h = &r->head;
  if (!h->range_count)
    return;
  uint64_t samples = vl_film_samples(r->ranges, h->range_count);
  if (!e->any)
    *e = (Extent){.crop = {h->x0, h->y0, h->x1, h->y1},
                  .range = r->ranges[0],
                  .any = true,
                  .even = h->range_count == 1,
                  .joined = true,
                  .min = samples};
  e->joined = e->joined && h->range_count == 1 && r->ranges[0].first == e->range.first;
  e->even = e->even && e->joined && r->ranges[0].end == e->range.end;
  e->crop[0] = h->x0 < e->crop[0] ? h->x0 : e->crop[0];
  e->crop[1] = h->y0 < e->crop[1] ? h->y0 : e->crop[1];
  e->crop[2] = h->x1 > e->crop[2] ? h->x1 : e->crop[2];
  e->crop[3] = h->y1 > e->crop[3] ? h->y1 : e->crop[3];
  e->min = samples < e->min ? samples : e->min;
  e->pixels += (uint64_t)(h->x1 - h->x0) * (h->y1 - h->y0);
}

static vlResult find_extent(vlFilmReader *r, bool partial, Extent *e, vlError *error) {
  uint64_t at = r->at;
  *e = (Extent){.any = false};
  while (r->next <= r->blocks) {
    bool last = r->next == r->blocks;
    VL_TRY(vl_film_reader_next(r, error));
    if (!last)
      add_block(e, r);
  }
  r->next = 0;
  r->at = at;
  if (!e->any)
    return vl_fail(error, VL_ERROR_SCENE, "%s: the film has no samples", r->path);
  uint64_t area = (uint64_t)(e->crop[2] - e->crop[0]) * (e->crop[3] - e->crop[1]);
  if (e->pixels != area) {
    e->even = e->joined = false;
    e->min = 0;
  }
  if (partial || e->joined)
    return VL_OK;
  return vl_fail(error, VL_ERROR_SCENE,
                 "%s: its pixels do not all begin with the same samples; \"velo film info "
                 "--missing\" lists what is missing",
                 r->path);
}

static vlResult fill(vlFilmReader *r, vlFilm *film, bool blocks_differ, vlError *error) {
  size_t count = vl_film_pixels(film), n = film->def.buckets;
  film->front = vl_alloc_zero(film->context, count, sizeof *film->front);
  bool good = film->front != NULL;
  if (good && film->def.errors) {
    film->moments[0] = vl_alloc_zero(film->context, count, sizeof *film->moments[0]);
    good = film->moments[0] != NULL;
  }
  if (good && n) {
    film->spectrum.sums[0] =
        vl_alloc_zero(film->context, count * n, sizeof *film->spectrum.sums[0]);
    film->spectrum.weights[0] =
        vl_alloc_zero(film->context, count * n, sizeof *film->spectrum.weights[0]);
    good = film->spectrum.sums[0] && film->spectrum.weights[0];
  }
  char *data = good ? vl_alloc(film->context, vl_film_max_data(&film->def)) : NULL;
  vlResult result = data ? VL_OK : vl_fail_memory(error);
  while (result == VL_OK && r->next < r->blocks) {
    result = vl_film_reader_next(r, error);
    if (result == VL_OK)
      result = vl_film_reader_data(r, data, error);
    if (result != VL_OK || !r->head.range_count)
      continue;
    uint32_t block = vl_film_block_at(film->def.crop, r->head.x0, r->head.y0);
    if (r->head.compared.spp) {
      if (!vl_film_compared(film)) {
        result = vl_fail_memory(error);
        break;
      }
      film->compared[block] = r->head.compared;
    }
    const uint32_t window[4] = {r->head.x0, r->head.y0, r->head.x1, r->head.y1};
    vl_film_copy_block(film, window, VL_TO_FILM, data);
    uint32_t end = r->ranges[r->head.range_count - 1].end;
    if (film->end < end)
      film->end = end;
    if (blocks_differ &&
        vl_film_set_block_spp(film, block, r->ranges[0].end - r->ranges[0].first) != VL_OK)
      result = vl_fail_memory(error);
  }
  vl_free(film->context, data);
  return result;
}

vlResult vl_film_read(vlContext *context, const char *path, bool partial, vlFilm **film,
                      vlError *error) {
  vl_error_clear(error);
  if (film)
    *film = NULL;
  if (!context || !path || !film)
    return vl_fail_argument(error, "film file: context, path or film is null");
  vlFilmReader reader;
  Extent extent;
  VL_TRY(vl_film_reader_open(&reader, context, path, error));
  vlResult result = find_extent(&reader, partial, &extent, error);
  vlFilm *made = NULL;
  if (result == VL_OK) {
    vlFilmDef def = reader.shape.def;
    memcpy(def.crop, extent.crop, sizeof def.crop);
    result = vl_film_create(context, &def, &made);
    if (result != VL_OK)
      /* the def was checked with the header, so only memory can be missing */
      result = vl_fail_memory(error);
  }
  bool blocks_differ = extent.joined && !extent.even;
  if (result == VL_OK)
    result = fill(&reader, made, blocks_differ, error);
  if (result == VL_OK) {
    if (!blocks_differ)
      vl_film_set_spp(made, (uint32_t)extent.min);
    vl_film_set_sequence(made, (vlFilmSequence){reader.shape.sequence, extent.range.first,
                                                !extent.joined, reader.shape.own});
  } else {
    vl_film_destroy(made);
    made = NULL;
  }
  vl_film_reader_close(&reader);
  *film = made;
  return result;
}
