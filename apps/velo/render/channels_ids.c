/* render/channels_ids.c: writes FILE.ids.json, which describes the ids of an image. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/image.h"
#include "render/channels.h"
#include "render/outputs.h"
#include "velo/header.h"

static void mark_ids(const vlImage *ids, const char *name, bool *seen, uint32_t count) {
  int channel = vl_image_find_channel(ids, name);
  if (channel < 0)
    return;
  size_t pixels = image_pixel_count(ids), step = vl_image_channels(ids);
  const uint32_t *whole = vl_image_const_pixels(ids);
  const float *floats = vl_image_const_pixels(ids); /* floats since channels_make_visible */
  for (size_t i = 0, at = (size_t)channel; i < pixels; i++, at += step) {
    uint32_t value = vl_image_type(ids) == VL_PIXEL_U32 ? whole[at] : (uint32_t)floats[at];
    if (value <= count)
      seen[value] = true;
  }
}

/* x, y, width, height, as in COCO. */
static void put_corners(Json *json, const char *key, const double c[4]) {
  json_numbers(json, key, (const double[4]){c[0], c[1], c[2] - c[0], c[3] - c[1]}, 4);
}
static void put_pixels(Json *json, const char *key, const uint32_t c[4]) {
  put_corners(json, key, (const double[4]){c[0], c[1], c[2], c[3]});
}

static void put_box(Json *json, const vlIdBox *b, bool instance) {
  json_integer(json, "pixels", (int64_t)b->seen);
  if (b->seen)
    put_pixels(json, "box", b->seen_box);
  json_integer(json, "amodal_pixels", (int64_t)b->all);
  if (b->all)
    put_pixels(json, "amodal_box", b->all_box);
  if (b->all)
    json_number(json, "occluded", 1 - (double)b->seen / (double)b->all);
  if (b->has_outline)
    put_corners(json, "outline_box", b->outline);
  if (!b->has_space)
    return;
  json_begin(json, "box3d", '{');
  json_text(json, "space", instance || b->grouped ? "group" : "world");
  json_numbers(json, "low", b->low, 3);
  json_numbers(json, "high", b->high, 3);
  if (instance)
    json_numbers(json, "world_from_group", b->world_from_box, 16);
  json_end(json, '}');
}

static void put_id(Json *json, const vlWorld *world, const Channels *c, vlIdKind kind,
                   uint32_t id) {
  vlIdInfo info;
  char key[16];
  if (vl_world_id_info(world, kind, id, &info) != VL_OK)
    return;
  text_set(key, "%u", id);
  fputs(json->comma ? ",\n    " : "\n    ", json->out);
  json->comma = false;
  json_begin(json, key, '{');
  json_put(json, "type %s, name %s, path %s, place %s", info.type, info.name, info.path,
           info.place);
  if (info.material)
    json_integer(json, "material", info.material);
  if (info.source.file) {
    json_text(json, "file", info.source.file);
    if (info.source.line)
      json_integer(json, "line", info.source.line);
    if (info.source.line)
      json_integer(json, "column", info.source.column);
  }
  if (c->box_list[0] && kind != VL_ID_MATERIAL)
    put_box(json, &c->box_list[kind == VL_ID_INSTANCE][id - 1], kind == VL_ID_INSTANCE);
  json_end(json, '}');
}

/* Ids that only have a box: completely hidden objects. */
static void mark_boxes(const Channels *c, vlIdKind kind, bool *seen, uint32_t count) {
  if (!c->box_list[0] || kind == VL_ID_MATERIAL)
    return;
  for (uint32_t id = 1; id <= count; id++)
    seen[id] = seen[id] || c->box_list[kind == VL_ID_INSTANCE][id - 1].all > 0;
}

static bool put_all(FILE *file, const vlWorld *world, const Channels *c, const Channels *right,
                    const char *path) {
  const vlImage *ids = c->layers[1];
  static const struct {
    const char *channel, *key;
    vlIdKind kind;
  } kinds[] = {{"id.object.Y", "objects", VL_ID_OBJECT},
               {"id.material.Y", "materials", VL_ID_MATERIAL},
               {"id.instance.Y", "instances", VL_ID_INSTANCE}};
  Json json = {.out = file};
  json_begin(&json, NULL, '{');
  json_text(&json, "image", text_file_name(path));
  for (size_t k = 0; k < LENGTH(kinds); k++) {
    if (vl_image_find_channel(ids, kinds[k].channel) < 0)
      continue;
    uint32_t count = vl_world_id_count(world, kinds[k].kind);
    bool *seen = calloc((size_t)count + 1, 1);
    if (!seen)
      return false;
    mark_ids(ids, kinds[k].channel, seen, count);
    if (right)
      mark_ids(right->layers[1], kinds[k].channel, seen, count);
    if (right)
      mark_boxes(right, kinds[k].kind, seen, count);
    mark_boxes(c, kinds[k].kind, seen, count);
    fputs(",\n  ", file);
    json.comma = false;
    json_begin(&json, kinds[k].key, '{');
    for (uint32_t id = 1; id <= count; id++)
      if (seen[id])
        put_id(&json, world, c, kinds[k].kind, id);
    json_end(&json, '}');
    free(seen);
  }
  json_end(&json, '}');
  fputc('\n', file);
  return fflush(file) == 0 && !ferror(file);
}

/* Composes the file in memory, then writes it as a whole. */
int channels_write_ids(const Channels *c, const Channels *right, const Job *job,
                       const char *path) {
  char target[4200];
  const vlImage *ids = c->layers[1];
  if (!ids)
    return STATUS_OK;
  bool any = vl_image_find_channel(ids, "id.object.Y") >= 0 ||
             vl_image_find_channel(ids, "id.material.Y") >= 0 ||
             vl_image_find_channel(ids, "id.instance.Y") >= 0;
  if (!any || output_is_stdout(path))
    return STATUS_OK;
  if (right && !right->layers[1])
    right = NULL; /* the render stopped before its ground truth */
  if (!output_ids_path(path, target, sizeof target))
    return report_failure(STATUS_IO, "cannot write %s.ids.json: %s", path,
                          strerror(ENAMETOOLONG));
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  bool good = file && put_all(file, job->world, c, right, path);
  if (file && fclose(file) != 0)
    good = false;
  vlError error = {0};
  vlResult result =
      good ? vl_write_file(job->context, target, text, size, &error) : VL_ERROR_MEMORY;
  free(text);
  return report_finish(&error, result, target);
}

/* Ids and counts in a form that other programs display (docs/ground-truth.md, "In other
 * programs"). */
vlResult channels_make_visible(vlImage **ids) {
  if (!*ids)
    return VL_OK;
  vlImage *shown = NULL;
  TRY_RESULT(vl_image_show_ids(*ids, &shown));
  if (vl_image_type(shown) == VL_PIXEL_U32)
    report_note("ids of 2^24 and more are written as integers, which not every program shows");
  vl_image_destroy(*ids);
  *ids = shown;
  return VL_OK;
}
