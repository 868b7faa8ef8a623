/* film/blocks.c: see blocks.h. */
#include "film/blocks.h"

#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "render/shard.h"

typedef struct Grid {
  uint32_t *ids; /* by block: index of its list + 1; 0: none */
  uint32_t across, down;
} Grid;

static int out_of_memory(void) {
  return report_error(NULL, VL_ERROR_MEMORY, NULL);
}

/* Finds the parts of [0, planned) that are not in the ranges. `gaps` has room for count + 1
 * ranges. */
static uint32_t find_gaps(const vlSampleRange *ranges, uint32_t count, uint32_t planned,
                          vlSampleRange *gaps) {
  uint32_t n = 0, at = 0;
  for (uint32_t i = 0; i < count; i++) {
    uint32_t first = ranges[i].first < planned ? ranges[i].first : planned;
    if (at < first)
      gaps[n++] = (vlSampleRange){at, first};
    if (ranges[i].end > at)
      at = ranges[i].end;
  }
  if (at < planned)
    gaps[n++] = (vlSampleRange){at, planned};
  return n;
}

/* Returns the number of the list with these ranges, counted from 1. Returns 0 if out of
 * memory. */
static uint32_t find_list(FilmParts *parts, const vlSampleRange *ranges, uint32_t count) {
  for (uint32_t i = parts->list_count; i > 0; i--) {
    const RangeList *list = &parts->lists[i - 1];
    if (list->count == count && memcmp(list->ranges, ranges, count * sizeof *ranges) == 0)
      return i;
  }
  RangeList *more = realloc(parts->lists, (parts->list_count + 1) * sizeof *more);
  if (!more)
    return 0;
  parts->lists = more;
  vlSampleRange *copy = malloc(count * sizeof *copy);
  if (!copy)
    return 0;
  memcpy(copy, ranges, count * sizeof *copy);
  more[parts->list_count] = (RangeList){copy, count};
  return ++parts->list_count;
}

static int read_blocks(vlFilmFile *file, bool check, uint32_t planned, FilmParts *parts,
                       Grid *grid) {
  vlFilmBlock block;
  vlError error = {0};
  vlSampleRange *gaps = NULL;
  int status = -1;
  for (uint32_t i = 0; status < 0; i++) {
    vlResult result = vl_film_file_next(file, check, &block, &error);
    status = report_error(&error, result, NULL);
    if (status >= 0 || block.x1 == 0)
      break;
    const vlSampleRange *ranges = block.ranges;
    uint32_t count = block.range_count;
    if (planned) {
      vlSampleRange *more = realloc(gaps, (count + 1) * sizeof *gaps);
      if (!more) {
        status = out_of_memory();
        break;
      }
      gaps = more;
      count = find_gaps(ranges, count, planned, gaps);
      ranges = gaps;
    }
    grid->ids[i] = count ? find_list(parts, ranges, count) : 0;
    if (count && !grid->ids[i])
      status = out_of_memory();
  }
  free(gaps);
  return status;
}

/* Whether a run of blocks has this list. */
static bool same_run(const Grid *grid, uint32_t x, uint32_t y, uint32_t width, uint32_t id) {
  for (uint32_t i = 0; i < width; i++)
    if (grid->ids[(size_t)y * grid->across + x + i] != id)
      return false;
  return true;
}

/* Takes a rectangle that begins at a block. It is extended as far as possible to the right, and
 * then down. */
static void take_part(Grid *grid, uint32_t x, uint32_t y, const uint32_t crop[4],
                      FilmParts *parts) {
  uint32_t id = grid->ids[(size_t)y * grid->across + x], width = 1, height = 1;
  while (x + width < grid->across && grid->ids[(size_t)y * grid->across + x + width] == id)
    width++;
  while (y + height < grid->down && same_run(grid, x, y + height, width, id))
    height++;
  for (uint32_t k = 0; k < height; k++)
    memset(grid->ids + (size_t)(y + k) * grid->across + x, 0, width * sizeof *grid->ids);
  FilmPart *part = &parts->parts[parts->count++];
  const uint32_t blocks[4] = {x, y, x + width, y + height};
  for (int i = 0; i < 4; i++) {
    uint32_t pixel = (crop[i & 1] / FILM_BLOCK + blocks[i]) * FILM_BLOCK;
    part->window[i] =
        i < 2 ? (pixel > crop[i] ? pixel : crop[i]) : (pixel < crop[i] ? pixel : crop[i]);
  }
  part->samples = parts->lists[id - 1];
}

int film_parts_read(vlFilmFile *file, bool check, uint32_t planned, FilmParts *parts) {
  const uint32_t *crop = vl_film_file_def(file)->crop;
  Grid grid = {.across = (crop[2] + FILM_BLOCK - 1) / FILM_BLOCK - crop[0] / FILM_BLOCK,
               .down = (crop[3] + FILM_BLOCK - 1) / FILM_BLOCK - crop[1] / FILM_BLOCK};
  memset(parts, 0, sizeof *parts);
  size_t blocks = (size_t)grid.across * grid.down;
  grid.ids = calloc(blocks, sizeof *grid.ids);
  int status = grid.ids ? read_blocks(file, check, planned, parts, &grid) : out_of_memory();
  uint32_t used = 0;
  for (size_t i = 0; i < blocks && status < 0; i++)
    used += grid.ids[i] != 0;
  if (status < 0 && !(parts->parts = calloc(used ? used : 1, sizeof *parts->parts)))
    status = out_of_memory();
  for (uint32_t y = 0; y < grid.down && status < 0; y++)
    for (uint32_t x = 0; x < grid.across; x++)
      if (grid.ids[(size_t)y * grid.across + x])
        take_part(&grid, x, y, crop, parts);
  free(grid.ids);
  return status;
}

void film_parts_free(FilmParts *parts) {
  for (uint32_t i = 0; i < parts->list_count; i++)
    free(parts->lists[i].ranges);
  free(parts->lists);
  free(parts->parts);
}
