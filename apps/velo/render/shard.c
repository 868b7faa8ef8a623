/* render/shard.c: see shard.h. */
#include "render/shard.h"

#include <stdio.h>

#include "cli/crop.h"
#include "cli/report.h"
#include "velo/tracer.h"

bool shard_read(const Arguments *arguments, uint32_t *index, uint32_t *count) {
  const OptionValue *v = &arguments->values[RENDER_SHARD];
  int used = 0;
  if (v->text[0] < '0' || v->text[0] > '9')
    return false;
  if (sscanf(v->text, "%9u/%9u%n", index, count, &used) != 2 || v->text[used])
    return false;
  return *index >= 1 && *index <= *count;
}

bool shard_is_by_tiles(const Arguments *arguments) {
  return option_count(&arguments->values[RENDER_SHARD_BY], 0) == 1;
}

static bool read_samples(const char *text, uint32_t *first, uint32_t *end) {
  int used = 0;
  if (text[0] < '0' || text[0] > '9')
    return false;
  return sscanf(text, "%9u:%9u%n", first, end, &used) == 2 && !text[used] && *first < *end;
}

int shard_check(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  uint32_t a, b;
  bool part = v[RENDER_SAMPLES].given || v[RENDER_TILES].given || v[RENDER_SHARD].given;
  if (v[RENDER_SAMPLES].given && !read_samples(v[RENDER_SAMPLES].text, &a, &b))
    return report_usage("--samples \"%s\": must be A:B, A below B: the samples A to B - 1",
                        v[RENDER_SAMPLES].text);
  if (v[RENDER_SHARD].given && !shard_read(arguments, &a, &b))
    return report_usage("--shard \"%s\": must be I/N, I from 1 to N", v[RENDER_SHARD].text);
  if (v[RENDER_SHARD].given && (v[RENDER_SAMPLES].given || v[RENDER_TILES].given))
    return report_usage("--shard and --samples or --tiles exclude each other");
  if (v[RENDER_SHARD_BY].given && !v[RENDER_SHARD].given)
    return report_usage("--shard-by goes with --shard");
  if (v[RENDER_TRAJECTORY].given &&
      (v[RENDER_SAMPLES].given || v[RENDER_TILES].given || v[RENDER_SHARD_BY].given))
    return report_usage("a trajectory is split by its frames: --shard I/N alone");
  if (!part || v[RENDER_TRAJECTORY].given)
    return -1;
  if (!v[RENDER_FILM].given && !v[RENDER_CONTINUE].given)
    return report_usage("a part of an image is kept in a film: give --film FILE");
  if (arguments->text_count)
    return report_usage(
        "-o: a part of an image is kept in a film; \"velo film merge\" and \"velo film "
        "develop\" make the image");
  return -1;
}

/* ---- tiles ------------------------------------------------------------------------------- */

/* Divides a rectangle of blocks into `count` parts of about the same area and keeps only part
 * `index`, counted from 0. */
static void cut(uint32_t blocks[4], uint32_t index, uint32_t count) {
  while (count > 1) {
    uint32_t width = crop_width(blocks), height = crop_height(blocks), low = count / 2;
    int axis = width >= height ? 0 : 1;
    uint32_t size = axis ? height : width, other = axis ? width : height;
    uint32_t at = (uint32_t)(((uint64_t)size * low + count / 2) / count);
    while ((uint64_t)at * other < low)
      at++; /* every part gets at least one block */
    while ((uint64_t)(size - at) * other < count - low)
      at--;
    if (index < low) {
      blocks[2 + axis] = blocks[axis] + at;
      count = low;
    } else {
      blocks[axis] += at;
      index -= low;
      count -= low;
    }
  }
}

void shard_block_window(const uint32_t blocks[4], const uint32_t crop[4], uint32_t window[4]) {
  for (int i = 0; i < 4; i++) {
    uint32_t pixel = blocks[i] * FILM_BLOCK;
    window[i] = (pixel > crop[i]) == (i < 2) ? pixel : crop[i];
  }
}

static int tiles_of(const uint32_t crop[4], uint32_t index, uint32_t count, uint32_t tiles[4]) {
  uint32_t blocks[4];
  for (int i = 0; i < 4; i++)
    blocks[i] = (crop[i] + (i < 2 ? 0 : FILM_BLOCK - 1)) / FILM_BLOCK;
  uint64_t max = crop_pixels(blocks);
  if (count > max)
    return report_usage("--shard %u/%u: more parts than tiles of %d pixels (%llu)", index + 1,
                        count, FILM_BLOCK, (unsigned long long)max);
  cut(blocks, index, count);
  shard_block_window(blocks, crop, tiles);
  return -1;
}

static int take_tiles(const OptionValue *v, vlFilmDef *film) {
  for (int i = 0; i < 4; i++) {
    int64_t pixel = v->integers[i], side = film->crop[i];
    bool inside = i < 2 ? pixel >= side : pixel <= side;
    if (!inside || (pixel != side && pixel % FILM_BLOCK))
      return report_usage(
          "--tiles \"%s\": must lie in the film, %u,%u,%u,%u, and be cut at multiples of %d",
          v->text, film->crop[0], film->crop[1], film->crop[2], film->crop[3], FILM_BLOCK);
  }
  for (int i = 0; i < 4; i++)
    film->crop[i] = (uint32_t)v->integers[i];
  return -1;
}

/* ---- both -------------------------------------------------------------------------------- */

bool tracer_has_light_paths(vlTracer tracer) {
  return tracer == VL_TRACER_BIDIRECTIONAL || tracer == VL_TRACER_MERGING ||
         tracer == VL_TRACER_SPPM || tracer == VL_TRACER_LIGHT_PATH;
}

void shard_warn(const Arguments *arguments, vlTracer tracer) {
  const bool tiles = arguments->values[RENDER_TILES].given || shard_is_by_tiles(arguments);
  if (tiles && tracer_has_light_paths(tracer))
    report_warning(
        "this tracer follows light from the lamps for the whole image: each part by tiles "
        "repeats it; parts by samples do not");
}

int shard_apply(const Arguments *arguments, vlFilmDef *film, vlRenderDef *render) {
  const OptionValue *v = arguments->values;
  uint32_t first = 0, end = render->spp, index, count;
  const bool by_tiles = shard_is_by_tiles(arguments);
  int status = -1;
  if (v[RENDER_SHARD].given && !v[RENDER_TRAJECTORY].given) {
    shard_read(arguments, &index, &count);
    if (!by_tiles && count > render->spp)
      return report_usage("--shard %u/%u: more parts than samples per pixel (%u)", index, count,
                          render->spp);
    if (by_tiles) {
      status = tiles_of(film->crop, index - 1, count, film->crop);
    } else {
      first = (uint32_t)((uint64_t)render->spp * (index - 1) / count);
      end = (uint32_t)((uint64_t)render->spp * index / count);
    }
  }
  if (v[RENDER_TILES].given)
    status = take_tiles(&v[RENDER_TILES], film);
  if (v[RENDER_SAMPLES].given) {
    read_samples(v[RENDER_SAMPLES].text, &first, &end);
    if (end > render->spp)
      return report_usage("--samples \"%s\": the image has %u samples per pixel; give --spp",
                          v[RENDER_SAMPLES].text, render->spp);
  }
  if (status < 0)
    shard_warn(arguments, render->tracer);
  render->first_sample = first;
  render->spp = end;
  return status;
}
