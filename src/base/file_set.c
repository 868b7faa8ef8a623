/* base/file_set.c: see file_set.h. */
#include "base/file_set.h"

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file_input.h"
#include "base/text.h"

/* The bytes of a regular file, zero-terminated; null: none. They are no input of the
 * context. */
static char *read_bytes(vlContext *context, const char *path, size_t *size) {
  struct stat info;
  *size = 0;
  if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
    return NULL;
  FILE *file = fopen(path, "rb");
  char *text = file ? vl_alloc(context, (size_t)info.st_size + 1) : NULL;
  if (text) {
    *size = fread(text, 1, (size_t)info.st_size, file);
    text[*size] = 0;
  }
  if (file)
    fclose(file);
  return text;
}

void vl_file_set_begin(vlFileSet *set, vlContext *context, const char *main) {
  *set = (vlFileSet){.context = context, .main = main};
  set->earlier = read_bytes(context, main, &set->earlier_size);
}

/* Whether a file has these bytes. It is no input of the context. */
static bool has_bytes(const char *path, const void *data, size_t size) {
  struct stat info;
  char block[65536];
  if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || (uint64_t)info.st_size != size)
    return false;
  FILE *file = fopen(path, "rb");
  const char *left = data, *end = left + size;
  for (size_t n; file && left < end && (n = fread(block, 1, sizeof block, file)) > 0; left += n)
    if (n > (size_t)(end - left) || memcmp(left, block, n) != 0)
      break;
  if (file)
    fclose(file);
  return file && left == end;
}

static bool is_made(const vlFileSet *set, const char *path) {
  for (size_t i = 0; i < set->made.count; i++)
    if (vl_text_is(set->made.items[i], path))
      return true;
  return false;
}

static vlResult keep(const vlFileSet *set, vlPathList *list, const char *path, vlError *error) {
  char *copy = vl_strdup(set->context, path);
  char **slot = copy ? VL_PUSH(set->context, list) : NULL;
  if (slot) {
    *slot = copy;
    return VL_OK;
  }
  vl_free(set->context, copy);
  return vl_fail_memory(error);
}

static vlResult join(const vlFileSet *set, const char *name, char path[4096], vlError *error) {
  if (vl_path_join(set->main, name, path, 4096))
    return VL_OK;
  return vl_fail(error, VL_ERROR_IO, "the file's name is too long");
}

vlResult vl_file_set_name(vlFileSet *set, char *name, size_t size, const void *data,
                          size_t bytes, vlError *error) {
  enum { MAX_NAMES = 10000 };
  char wanted[4096], path[4096];
  struct stat info;
  snprintf(wanted, sizeof wanted, "%s", name);
  const char *last = vl_file_name(wanted), *dot = strrchr(last, '.');
  if (!dot)
    dot = last + strlen(last);
  for (int i = 1; i < MAX_NAMES; i++) {
    if (i > 1 &&
        snprintf(name, size, "%.*s-%d%s", (int)(dot - wanted), wanted, i, dot) >= (int)size)
      return vl_fail(error, VL_ERROR_IO, "the file's name is too long");
    VL_TRY(join(set, name, path, error));
    if (has_bytes(path, data, bytes))
      return VL_OK;
    if (is_made(set, path))
      continue;
    if (lstat(path, &info) != 0)
      return keep(set, &set->made, path, error);
    VL_TRY(keep(set, &set->passed, path, error));
  }
  return vl_fail(error, VL_ERROR_IO, "too many files are called like %.200s", wanted);
}

static vlResult make_folders(vlFileSet *set, char *path, vlError *error) {
  for (char *slash = strchr(path + vl_folder_length(set->main), '/'); slash;
       slash = strchr(slash + 1, '/')) {
    *slash = 0;
    vlResult result = mkdir(path, 0777) == 0 ? keep(set, &set->folders, path, error) : VL_OK;
    *slash = '/';
    if (result != VL_OK)
      return result; /* writing the file reports a folder that cannot be made */
  }
  return VL_OK;
}

vlResult vl_file_set_write(vlFileSet *set, const char *name, const void *data, size_t bytes,
                           vlError *error) {
  char path[4096];
  vlResult result = join(set, name, path, error);
  if (result == VL_OK && !is_made(set, path))
    return VL_OK;
  if (result == VL_OK)
    result = make_folders(set, path, error);
  if (result == VL_OK)
    result = keep(set, &set->written, path, error);
  if (result != VL_OK)
    return result;
  return vl_write_file(set->context, path, data, bytes, error);
}

vlResult vl_file_set_main(vlFileSet *set, const void *data, size_t bytes, vlError *error) {
  return vl_write_file(set->context, set->main, data, bytes, error);
}

/* Moves the passed files that a text mentions before those that it does not, from `from` on.
 * Returns the index of the first that it does not. */
static size_t gather(const vlFileSet *set, size_t from, const char *text, size_t size) {
  for (size_t i = from; text && i < set->passed.count; i++) {
    char *path = set->passed.items[i];
    const char *name = path + vl_folder_length(path);
    if (!memmem(text, size, name, strlen(name)))
      continue;
    set->passed.items[i] = set->passed.items[from];
    set->passed.items[from++] = path;
  }
  return from;
}

/* Removes the passed files that the replaced main file mentions, or one of its files of the
 * same format, which goes, too. */
static void remove_passed(const vlFileSet *set) {
  const char *suffix = strrchr(vl_file_name(set->main), '.');
  char input[4096];
  size_t count = gather(set, 0, set->earlier, set->earlier_size);
  for (size_t i = 0; i < count && suffix; i++) {
    size_t size;
    char *text = vl_ends_with(set->passed.items[i], suffix)
                     ? read_bytes(set->context, set->passed.items[i], &size)
                     : NULL;
    if (text)
      count = gather(set, count, text, size);
    vl_free(set->context, text);
  }
  for (size_t i = 0; i < count; i++)
    if (!vl_file_is_input(set->context, set->passed.items[i], VL_OUTPUT_PLAIN, input,
                          sizeof input))
      unlink(set->passed.items[i]);
}

static void free_list(vlContext *context, vlPathList *list) {
  for (size_t i = 0; i < list->count; i++)
    vl_free(context, list->items[i]);
  VL_ARRAY_FREE(context, list);
}

void vl_file_set_end(vlFileSet *set, bool good) {
  for (size_t i = 0; i < set->written.count && !good; i++)
    unlink(set->written.items[i]);
  for (size_t i = set->folders.count; i-- > 0 && !good;)
    rmdir(set->folders.items[i]);
  if (good)
    remove_passed(set);
  free_list(set->context, &set->made);
  free_list(set->context, &set->passed);
  free_list(set->context, &set->written);
  free_list(set->context, &set->folders);
  vl_free(set->context, set->earlier);
  set->earlier = NULL;
}
