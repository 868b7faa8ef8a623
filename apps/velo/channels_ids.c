/* channels_ids.c: FILE.ids.json: what the ids of a picture stand for. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "channels.h"
#include "report.h"

static void mark_ids(const vlImage *ids, const char *name, bool *seen, uint32_t count) {
  int channel = vl_image_find_channel(ids, name);
  if (channel < 0) return;
  size_t pixels = (size_t)vl_image_width(ids) * vl_image_height(ids), step = vl_image_channels(ids);
  const uint32_t *value = (const uint32_t *)vl_image_const_pixels(ids) + channel;
  for (size_t i = 0; i < pixels; i++, value += step)
    if (*value <= count) seen[*value] = true;
}

static void put_id(Json *json, const vlWorld *world, vlIdKind kind, uint32_t id) {
  vlIdInfo info;
  char key[16];
  if (vl_world_id_info(world, kind, id, &info) != VL_OK) return;
  snprintf(key, sizeof key, "%u", id);
  fputs(json->comma ? ",\n    " : "\n    ", json->out);
  json->comma = false;
  json_begin(json, key, '{');
  json_text(json, "type", info.type);
  if (info.name) json_text(json, "name", info.name);
  if (info.material) json_integer(json, "material", info.material);
  if (info.source.file) {
    json_text(json, "file", info.source.file);
    json_integer(json, "line", info.source.line);
    json_integer(json, "column", info.source.column);
  }
  json_end(json, '}');
}

static bool put_all(FILE *file, const vlWorld *world, const vlImage *ids, const char *path) {
  static const struct {
    const char *channel, *key;
    vlIdKind kind;
  } kinds[] = {{"id.object", "objects", VL_ID_OBJECT},
               {"id.material", "materials", VL_ID_MATERIAL},
               {"id.instance", "instances", VL_ID_INSTANCE}};
  const char *slash = strrchr(path, '/');
  Json json = {.out = file};
  json_begin(&json, NULL, '{');
  json_text(&json, "picture", slash ? slash + 1 : path);
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    if (vl_image_find_channel(ids, kinds[k].channel) < 0) continue;
    uint32_t count = vl_world_id_count(world, kinds[k].kind);
    bool *seen = calloc((size_t)count + 1, 1);
    if (!seen) return false;
    mark_ids(ids, kinds[k].channel, seen, count);
    fputs(",\n  ", file);
    json.comma = false;
    json_begin(&json, kinds[k].key, '{');
    for (uint32_t id = 1; id <= count; id++)
      if (seen[id]) put_id(&json, world, kinds[k].kind, id);
    json_end(&json, '}');
    free(seen);
  }
  json_end(&json, '}');
  fputc('\n', file);
  return fflush(file) == 0 && !ferror(file);
}

/* Written beside the target, synced, renamed: whole or as before. */
int channels_write_ids(const Channels *c, const vlWorld *world, const Job *job, const char *path) {
  char target[4200], temporary[4240];
  const vlImage *ids = c->layers[1];
  (void)job;
  if (!ids) return STATUS_OK;
  bool any = vl_image_find_channel(ids, "id.object") >= 0 || vl_image_find_channel(ids, "id.material") >= 0 ||
             vl_image_find_channel(ids, "id.instance") >= 0;
  if (!any) return STATUS_OK;
  if (snprintf(target, sizeof target, "%s.ids.json", path) >= (int)sizeof target)
    return report_failure(STATUS_IO, "cannot write %s.ids.json: %s", path, strerror(ENAMETOOLONG));
  snprintf(temporary, sizeof temporary, "%s.XXXXXX", target);
  int descriptor = mkstemp(temporary);
  FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
  if (!file) {
    int code = errno;
    if (descriptor >= 0) close(descriptor), unlink(temporary);
    return report_failure(STATUS_IO, "cannot write %s: %s", target, strerror(code));
  }
  errno = 0;
  bool good = put_all(file, world, ids, path) && fsync(descriptor) == 0;
  mode_t mask = umask(0);
  umask(mask);
  good = good && fchmod(descriptor, 0666 & ~mask) == 0;
  int code = errno;
  if (fclose(file) != 0 && good) good = false, code = errno;
  if (good && rename(temporary, target) != 0) good = false, code = errno;
  if (good) return STATUS_OK;
  unlink(temporary);
  return report_failure(STATUS_IO, "cannot write %s: %s", target, strerror(code ? code : EIO));
}
