/* render/boxes.c: bounding boxes and pixel counts of each object and instance, both for its
 * visible pixels and for all pixels that it would cover if nothing were in front of it. Rays
 * through the pixels' centres collect all intersections, not only the first. Counts are sums
 * and extremes of integers, so the result does not depend on the order of work. */
#include "render/boxes.h"

#include <stdatomic.h>
#include <string.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/free.h"
#include "render/channel_pass.h"
#include "world/moving.h"

/* Number of pixels and their bounding box. */
typedef struct Extent {
  atomic_ullong count;
  atomic_uint low[2], high[2]; /* inclusive; low holds ~low, so that zero means empty */
} Extent;
typedef struct Count {
  Extent seen, all;
} Count;

typedef struct Pass {
  vlChannelPass channels; /* camera, kernels, tiles */
  vlChannelsDef def;
  Count *counts[2]; /* objects, instances */
  vlIdBox *boxes[2];
  uint32_t ids[2];
  uint8_t *grouped; /* by object: it is in a group */
  bool corners;     /* the instances have too many points in all: the corners of their boxes are
                       used */
  float time;
} Pass;

static void raise(atomic_uint *value, uint32_t to) {
  unsigned now = atomic_load_explicit(value, memory_order_relaxed);
  while (now < to && !atomic_compare_exchange_weak_explicit(
                         value, &now, to, memory_order_relaxed, memory_order_relaxed)) {
  }
}

static void note(Extent *e, uint32_t x, uint32_t y) {
  atomic_fetch_add_explicit(&e->count, 1, memory_order_relaxed);
  raise(&e->low[0], ~x);
  raise(&e->low[1], ~y);
  raise(&e->high[0], x);
  raise(&e->high[1], y);
}

static void note_pixel(Pass *p, const vlGroundTruthBatch *b, uint32_t lane,
                       const vlGroundTruthLayers *layers, uint32_t x, uint32_t y) {
  uint32_t first[2] = {b->object[lane], b->instance[lane]};
  for (int k = 0; k < 2; k++) {
    if (!p->counts[k])
      continue;
    if (first[k]) {
      note(&p->counts[k][first[k] - 1].seen, x, y);
      note(&p->counts[k][first[k] - 1].all, x, y);
    }
    const uint32_t *ids = k ? layers->instance : layers->object;
    for (uint32_t i = 0; i < layers->count; i++) {
      bool again = ids[i] == 0 || ids[i] == first[k];
      for (uint32_t j = 0; j < i && !again; j++)
        again = ids[j] == ids[i];
      if (!again)
        note(&p->counts[k][ids[i] - 1].all, x, y);
    }
  }
}

static void count_tile(void *user, uint32_t tile, uint32_t worker) {
  Pass *p = user;
  const vlChannelPass *c = &p->channels;
  vlChannelWorker *w = &c->workers[worker];
  vlGroundTruthBatch *b = w->batch;
  uint32_t n = 0, x, y;
  if (vl_stop_check(c->stop))
    return;
  for (uint32_t k = 0; k < VL_TILE_PIXELS; k++) {
    if (!vl_channel_pixel(c, tile, vl_channel_order(c, k), &x, &y))
      continue;
    w->x[n] = x;
    w->y[n] = y;
    w->lane_x[n] = w->lane_y[n] = 0.5f;
    n++;
  }
  n = vl_channel_rays(c, w, n);
  if (n == 0)
    return;
  unsigned state = vl_accel_enter();
  c->ground_truth_kernels->trace(c->world, &c->ground_truth, w->scratch, b);
  for (uint32_t i = 0; i < n; i++) {
    vlGroundTruthLayers layers;
    if (!b->object[i])
      continue;
    c->ground_truth_kernels->layers(c->world, b, i, &layers);
    note_pixel(p, b, i, &layers, w->x[i], w->y[i]);
  }
  vl_accel_leave(state);
}

static void put_extent(Extent *e, uint64_t *count, uint32_t box[4]) {
  *count = atomic_load(&e->count);
  for (int k = 0; k < 2 && *count; k++) {
    box[k] = ~atomic_load(&e->low[k]);
    box[2 + k] = atomic_load(&e->high[k]) + 1;
  }
}

/* A task of vl_parallel_for: the ids of the objects come first, then those of the instances. */
static void put_box(void *user, uint32_t index, VL_UNUSED uint32_t worker) {
  Pass *p = user;
  const vlChannelPass *c = &p->channels;
  if (vl_stop_check(c->stop))
    return;
  uint32_t objects = p->boxes[0] ? p->ids[0] : 0, k = index >= objects,
           id = index - (k ? objects : 0) + 1;
  vlIdBox *box = &p->boxes[k][id - 1];
  memset(box, 0, sizeof *box);
  Count *count = &p->counts[k][id - 1];
  put_extent(&count->seen, &box->seen, box->seen_box);
  put_extent(&count->all, &box->all, box->all_box);
  if (!box->all)
    return;
  const vlBoxRows rows = {c->world, &c->compiled}, *by_row = c->rows ? &rows : NULL;
  if (k)
    vl_box_of_instance(c->world, &c->camera, by_row, p->time, id, p->corners, box);
  else
    vl_box_of_object(c->world, &c->camera, by_row, p->time, id, p->grouped[id - 1], box);
}

/* Finds which objects are in groups, and whether the instances in the image have too many
 * points in all. */
static void look_at_groups(Pass *p) {
  const vlWorld *world = p->channels.world;
  const uint64_t max = 1 << 26;
  uint64_t points = 0;
  for (size_t g = 1; g < world->groups.count; g++)
    for (uint32_t i = 0; i < world->groups.items[g].count; i++)
      p->grouped[world->groups.items[g].shapes[i]] = 1;
  for (uint32_t id = 0; id < p->ids[1] && p->counts[1]; id++) {
    if (!atomic_load(&p->counts[1][id].all.count))
      continue;
    const vlWorldGroup *group = &world->groups.items[world->instances.items[id].group];
    for (uint32_t i = 0; i < group->count && points <= max; i++)
      points += vl_box_points(&world->shapes.items[group->shapes[i]]);
  }
  p->corners = points > max;
}

vlBoxesDef vl_default_boxes_def(uint32_t width, uint32_t height) {
  return (vlBoxesDef){
      .cookie = VL_COOKIE_BOXES, .crop = {0, 0, width, height}, .time = VL_UNSET};
}

static vlResult make_room(Pass *p, vlError *error) {
  vlChannelPass *c = &p->channels;
  vlContext *context = c->world->context;
  bool whole = true;
  for (int k = 0; k < 2; k++)
    if (p->boxes[k]) {
      p->counts[k] = vl_alloc_zero(context, (size_t)p->ids[k] + 1, sizeof(Count));
      whole = whole && p->counts[k];
    }
  p->grouped = vl_alloc_zero(context, (size_t)p->ids[0] + 1, 1);
  return whole && p->grouped ? vl_channel_make_workers(c, error) : vl_fail_memory(error);
}

static void free_room(Pass *p) {
  vlChannelPass *c = &p->channels;
  vlContext *context = c->world->context;
  vl_channel_free_workers(c);
  vl_free(context, p->grouped);
  for (int k = 0; k < 2; k++)
    vl_free(context, p->counts[k]);
}

vlResult vl_world_boxes(const vlWorld *world, const vlCamera *camera, const vlBoxesDef *def,
                        vlIdBox *objects, vlIdBox *instances, vlError *error) {
  vl_error_clear(error);
  if (!world || !camera || !def)
    return vl_fail_argument(error, "boxes: world, camera or def is null");
  if (def->cookie != VL_COOKIE_BOXES)
    return vl_fail_argument(error, "boxes: " VL_BAD_COOKIE);
  const uint32_t *crop = def->crop;
  if (!vl_crop_fits(crop, camera->width, camera->height))
    return vl_fail_argument(error,
                            "boxes: crop %u,%u,%u,%u does not suit a camera of %u x %u pixels",
                            crop[0], crop[1], crop[2], crop[3], camera->width, camera->height);
  Pass pass, *p = &pass;
  memset(p, 0, sizeof *p);
  vlChannelPass *c = &p->channels;
  p->def = vl_default_channels_def(camera->width, camera->height);
  memcpy(p->def.crop, crop, sizeof p->def.crop);
  p->def.channels = VL_CHANNEL_ID_OBJECT;
  p->def.time = def->time;
  p->boxes[0] = objects;
  p->boxes[1] = instances;
  p->ids[0] = vl_world_id_count(world, VL_ID_OBJECT);
  p->ids[1] = vl_world_id_count(world, VL_ID_INSTANCE);
  c->world = world;
  c->def = &p->def;
  vlStop stop;
  vl_stop_init(&stop, def->cancel, def->stop, def->stop_user);
  c->stop = &stop;
  vl_channel_prepare(c, camera);
  p->time = vl_world_time(world, c->time);
  vlResult result = make_room(p, error);
  if (result == VL_OK) {
    vl_parallel_for(world->context, c->tiles, count_tile, p);
    look_at_groups(p);
    vl_parallel_for(world->context, (objects ? p->ids[0] : 0) + (instances ? p->ids[1] : 0),
                    put_box, p);
    if (atomic_load(&stop.stopped))
      result = vl_fail(error, VL_CANCELLED, "stopped");
  }
  free_room(p);
  return result;
}
