/* refuse.c: errors. */
#include "refuse.h"

#include <stdio.h>
#include <velo/schema.h>

bool refuse(vlError *error, vlSource source, const char *what, const char *why) {
  error->code = VL_ERROR_UNSUPPORTED;
  snprintf(error->file, sizeof error->file, "%s", source.file ? source.file : "");
  error->line = source.line;
  error->column = source.column;
  snprintf(error->message, sizeof error->message, "%s %s", what, why ? why : "is not part of the reference renderer");
  return false;
}

bool refuse_kind(vlError *error, vlSource source, const char *family, uint32_t kind) {
  const vlKindFamily *rows = vl_kind_family_find(family);
  char what[200] = "this kind";
  if (rows && kind < rows->kind_count && rows->rows[kind]->name)
    snprintf(what, sizeof what, "%s \"%s\"", rows->thing, rows->rows[kind]->name);
  return refuse(error, source, what, NULL);
}

bool refuse_memory(vlError *error) {
  return refuse(error, (vlSource){0}, "memory", "is used up");
}
