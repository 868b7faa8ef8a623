/* camera/paths_trace.c: traces the paths of a pixel and puts them in order; see paths.h. */
#include <math.h>
#include <stdlib.h>

#include "camera/paths.h"
#include "cli/crop.h"
#include "cli/macros.h"
#include "velo/channels.h"

/* A path to be put in order. */
typedef struct Rank {
  double share;
  uint32_t index;
} Rank;

static int larger_first(const void *a, const void *b) {
  const Rank *i = a, *j = b;
  if (!(i->share == j->share))
    return !isfinite(i->share) || i->share > j->share ? -1 : 1;
  return i->index < j->index ? -1 : i->index > j->index;
}

static uint32_t *make_order(const vlPixelPaths *paths, bool by_sample) {
  uint32_t count = paths->count, *order = malloc(count * sizeof *order);
  Rank *ranks = malloc(count * sizeof *ranks);
  for (uint32_t i = 0; ranks && i < count; i++)
    ranks[i] = (Rank){.share = fabs(paths_share(&paths->paths[i])), .index = i};
  if (ranks && !by_sample)
    qsort(ranks, count, sizeof *ranks, larger_first);
  for (uint32_t i = 0; ranks && order && i < count; i++)
    order[i] = ranks[i].index;
  if (!ranks) {
    free(order);
    order = NULL;
  }
  free(ranks);
  return order;
}

static vlResult see(const PathsRequest *r, TracedPaths *traced, vlError *error) {
  vlChannelsDef def = vl_default_channels_def(r->film->width, r->film->height);
  def.channels = VL_CHANNEL_Z | VL_CHANNEL_DISTANCE | VL_CHANNEL_P | VL_CHANNEL_N |
                 VL_CHANNEL_NG | VL_CHANNEL_UV | VL_CHANNEL_ALBEDO | VL_CHANNEL_ID_OBJECT |
                 VL_CHANNEL_ID_MATERIAL | VL_CHANNEL_ID_INSTANCE | VL_CHANNEL_ID_PRIMITIVE;
  def.cancel = r->render->cancel;
  def.priority = r->render->priority;
  crop_set_pixel(def.crop, r->pixel[0], r->pixel[1]);
  return vl_render_channels(r->world, r->camera, &def, &traced->channels, &traced->ids, error);
}

vlResult paths_trace(const PathsRequest *r, TracedPaths *traced, vlError *error) {
  *traced = (TracedPaths){.paths = NULL};
  vlFilmDef film = *r->film;
  crop_set(film.crop, 0, 0, film.width, film.height);
  TRY_RESULT(vl_trace_paths(r->world, r->camera, &film, r->render, r->pixel[0], r->pixel[1],
                            r->first, r->count, &traced->paths, error));
  TRY_RESULT(see(r, traced, error));
  traced->order = make_order(traced->paths, r->by_sample);
  return traced->order ? VL_OK : VL_ERROR_MEMORY;
}

void paths_free(TracedPaths *traced) {
  free(traced->order);
  vl_image_destroy(traced->channels);
  vl_image_destroy(traced->ids);
  vl_pixel_paths_destroy(traced->paths);
  *traced = (TracedPaths){.paths = NULL};
}
