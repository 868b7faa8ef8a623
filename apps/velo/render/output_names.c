/* render/output_names.c: see output_names.h. */
#include "render/output_names.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/report.h"

static OutputName *push(OutputNames *names) {
  if (names->count == names->capacity) {
    size_t wanted = names->capacity ? 2 * names->capacity : 16;
    OutputName *grown = realloc(names->items, wanted * sizeof *grown);
    if (!grown)
      return NULL;
    names->items = grown;
    names->capacity = wanted;
  }
  return &names->items[names->count++];
}

void output_names_add(OutputNames *names, const char *path, vlOutputKind kind) {
  const char *opened = output_opened(path);
  char *copy = strdup(opened);
  OutputName *name = copy ? push(names) : NULL;
  if (!name) {
    free(copy);
    names->failed = true;
    return;
  }
  *name = (OutputName){.path = copy, .kind = kind};
  vl_file_id(copy, &name->id);
}

void output_names_add_image(OutputNames *names, const char *path, bool part, bool ids) {
  char other[PATH_MAX + 64], own[PATH_MAX + 160], described[PATH_MAX + 160];
  output_names_add(names, path, VL_OUTPUT_PLAIN);
  ids = ids && output_holds_layers(path) && !output_is_stdout(path) &&
        output_ids_path(path, own, sizeof own);
  if (ids)
    output_names_add(names, own, VL_OUTPUT_PLAIN);
  if (!part || !output_part_path(path, other, sizeof other))
    return;
  output_names_add(names, other, VL_OUTPUT_PLAIN);
  /* cut alike */
  if (ids && output_ids_path(other, described, sizeof described) && strcmp(own, described) != 0)
    output_names_add(names, described, VL_OUTPUT_PLAIN);
}

static int compare(const void *a, const void *b) {
  const OutputName *x = a, *y = b;
  if (x->id.device != y->id.device)
    return x->id.device < y->id.device ? -1 : 1;
  if (x->id.inode != y->id.inode)
    return x->id.inode < y->id.inode ? -1 : 1;
  return strcmp(x->id.name, y->id.name);
}

/* Devices such as /dev/null take what several outputs write. */
static bool is_device(const char *path) {
  struct stat info;
  return !output_is_stdout(path) && stat(path, &info) == 0 && S_ISCHR(info.st_mode);
}

/* Whether the name of a frame is one that only the write of that frame reports. */
static bool is_later(const OutputNames *names, const OutputName *name, vlContext *context) {
  return names->frames && vl_check_output(context, name->path, name->kind, NULL) == VL_ERROR_IO;
}

int output_names_check(OutputNames *names, vlContext *context) {
  int status = names->failed ? report_no_memory() : -1;
  for (size_t i = 0; i < names->count && status < 0; i++)
    if (!is_later(names, &names->items[i], context))
      status = output_check(context, names->items[i].path, names->items[i].kind);
  if (names->count)
    qsort(names->items, names->count, sizeof *names->items, compare);
  for (size_t i = 1; i < names->count && status < 0; i++) {
    const OutputName *a = &names->items[i - 1], *b = &names->items[i];
    if (compare(a, b) != 0 || is_device(a->path))
      continue;
    if (strcmp(a->path, b->path) == 0)
      status =
          report_usage("%s would be written twice; give the outputs different names", a->path);
    else
      status = report_usage("the outputs %s and %s are the same file", a->path, b->path);
  }
  for (size_t i = 0; i < names->count; i++)
    free(names->items[i].path);
  free(names->items);
  *names = (OutputNames){0};
  return status;
}

int outputs_check_inputs(vlContext *context, const Outputs *outputs) {
  OutputNames names = {0};
  for (int i = 0; i < outputs->count; i++)
    output_names_add_image(&names, outputs->paths[i], false, false);
  return output_names_check(&names, context);
}
