/* import/pbrt/files.c: reads the first file and the files of Include and Import, within limits
 * (parse.h). */
#include <sys/stat.h>

#include "base/file.h"
#include "base/text.h"
#include "import/find.h"
#include "import/pbrt/parser.h"

/* The number of files is not limited. Text that is read again is, since a few small files that
 * include each other twice can stand for any amount. Each repeated file counts as LEAST_BYTES
 * or more. */
enum { MAX_DEPTH = 64, MAX_REPEATED_MEGABYTES = 1024, MIN_BYTES = 256, MAX_PATH = 4096 };

/* ---- files that were read ---------------------------------------------------------------- */

static uint64_t key_of(const struct stat *info) {
  uint64_t h = ((uint64_t)info->st_ino ^ (uint64_t)info->st_dev * 0x9e3779b97f4a7c15u) *
               0xff51afd7ed558ccdu;
  h ^= h >> 32;
  return h ? h : 1;
}

static uint64_t *slot_of(vlParser *parser, uint64_t key) {
  uint32_t i = (uint32_t)key & (parser->seen_capacity - 1);
  while (parser->seen[i] && parser->seen[i] != key)
    i = (i + 1) & (parser->seen_capacity - 1);
  return &parser->seen[i];
}

/* Remembers a file. *again: it was read before. False: out of memory. */
static bool remember(vlParser *parser, const struct stat *info, bool *again) {
  if (2 * (parser->seen_count + 1) > parser->seen_capacity) {
    vlParser grown = *parser;
    grown.seen_capacity = parser->seen_capacity ? 2 * parser->seen_capacity : 64;
    grown.seen = vl_alloc_zero(parser->context, grown.seen_capacity, sizeof *grown.seen);
    if (!grown.seen)
      return false;
    for (uint32_t i = 0; i < parser->seen_capacity; i++)
      if (parser->seen[i])
        *slot_of(&grown, parser->seen[i]) = parser->seen[i];
    vl_free(parser->context, parser->seen);
    *parser = grown;
  }
  uint64_t key = key_of(info), *slot = slot_of(parser, key);
  *again = *slot == key;
  parser->seen_count += !*again;
  *slot = key;
  return true;
}

/* ---- a file ------------------------------------------------------------------------------ */

/* Whether a file of this depth and size may be read. *skip: it is left out instead. */
static bool within_limits(vlParser *parser, vlParserFile *parent, vlSource at, uint32_t depth,
                          const struct stat *info, bool *skip) {
  const vlParseTarget *target = parser->target;
  bool again = false, deep = depth > MAX_DEPTH;
  if (!remember(parser, info, &again))
    return vl_parse_fail_memory(parent);
  uint64_t bytes = info->st_size > MIN_BYTES ? (uint64_t)info->st_size : MIN_BYTES;
  if (again && !deep)
    parser->repeated += bytes;
  bool long_text = parser->repeated > (uint64_t)MAX_REPEATED_MEGABYTES << 20;
  *skip = false;
  if (!deep && !long_text)
    return true;
  if (target->skip && target->skip(target->user, at))
    return *skip = true;
  if (deep)
    return vl_parse_fail(parent, at, "files include each other more than %d deep", MAX_DEPTH);
  return vl_parse_fail(parent, at,
                       "files that are included again and again hold more than %d megabytes",
                       MAX_REPEATED_MEGABYTES);
}

/* Parses one file. `at` is the token in `parent` that names the file; null for the first
 * file. */
static bool parse_path(vlParser *parser, vlParserFile *parent, vlSource at, const char *path,
                       bool included) {
  struct stat info;
  vlParserFile file = {.parser = parser, .parent = parent, .included = included, .path = path};
  file.depth = parent ? parent->depth + 1 : 0;
  const vlParseTarget *target = parser->target;
  if ((!parent || vl_context_allows(parser->context, path)) && stat(path, &info) == 0) {
    file.device = info.st_dev;
    file.inode = info.st_ino;
    for (const vlParserFile *f = parent; f; f = f->parent) {
      if (f->inode != file.inode || f->device != file.device || !f->inode)
        continue;
      if (f == parent)
        return vl_parse_fail(parent, at, "the file includes itself: %s", path);
      return vl_parse_fail(
          parent, at, "the file includes itself in a circle: %s is being read already", path);
    }
    bool skip = false;
    if (parent && !within_limits(parser, parent, at, file.depth, &info, &skip))
      return false;
    if (skip)
      return true;
  }
  char *data;
  size_t size;
  vlError error = {0};
  vlResult result = parent
                        ? vl_file_read(parser->context, path, true, &data, &size, &error)
                        : vl_file_read_given(parser->context, path, true, &data, &size, &error);
  if (result != VL_OK) {
    target->error(target->user, result, at, error.message);
    return parent && target->recover && target->recover(target->user);
  }
  bool fine = vl_parse_block(&file, data, size);
  vl_free(parser->context, data);
  return fine;
}

/* Parses a copy of the text, which ends with a zero byte. */
static bool parse_text(vlParserFile *file, const char *text, size_t size) {
  vlContext *context = file->parser->context;
  char *copy = vl_alloc(context, size + 1);
  if (!copy)
    return vl_parse_fail_memory(file);
  memcpy(copy, text, size);
  copy[size] = 0;
  bool fine = vl_parse_block(file, copy, size);
  vl_free(context, copy);
  return fine;
}

/* The given text of an included file; null: it is read from the disk. */
static const char *given_text(const vlParseTarget *target, const char *name) {
  for (size_t i = 0; i < target->text_count; i++)
    if (vl_text_is(target->texts[2 * i], name))
      return target->texts[2 * i + 1];
  return NULL;
}

static bool follow_text(vlParserFile *parent, vlSource at, const char *name, const char *text,
                        bool included) {
  char path[MAX_PATH];
  vlParserFile file = {
      .parser = parent->parser, .parent = parent, .included = included, .path = path};
  file.depth = parent->depth + 1;
  if (!vl_path_join(parent->parser->first, name, path, sizeof path))
    return vl_parse_fail(parent, at, "file name too long");
  if (file.depth > MAX_DEPTH)
    return vl_parse_fail(parent, at, "files include each other more than %d deep", MAX_DEPTH);
  return parse_text(&file, text, strlen(text));
}

bool vl_parse_follow(vlParserFile *file, const vlToken *at, const char *name, bool included) {
  const vlParseTarget *target = file->parser->target;
  vlSource source = vl_parse_source(file, at);
  char path[MAX_PATH];
  const char *text = given_text(target, name);
  if (text)
    return follow_text(file, source, name, text, included);
  vlFound found = vl_find_file(file->parser->context, file->path, file->parser->first,
                               target->search_path, name, path, sizeof path);
  if (found == VL_FOUND_TOO_LONG)
    return vl_parse_fail(file, source, "file name too long");
  if (found == VL_FOUND_CURRENT && target->found_elsewhere)
    target->found_elsewhere(target->user, source, path);
  return parse_path(file->parser, file, source, path, included);
}

bool vl_parse_file(vlContext *context, const char *path, const vlParseTarget *target) {
  vlParser parser = {.context = context, .target = target, .first = path};
  bool fine = parse_path(&parser, NULL, (vlSource){0}, path, false);
  vl_free(context, parser.seen);
  return fine;
}

bool vl_parse_memory(vlContext *context, const char *data, size_t size, const char *name,
                     const vlParseTarget *target) {
  vlParser parser = {.context = context, .target = target, .first = name};
  vlParserFile file = {.parser = &parser, .path = name};
  bool fine = parse_text(&file, data, size);
  vl_free(context, parser.seen);
  return fine;
}
