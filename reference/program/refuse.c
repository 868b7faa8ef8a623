/* refuse.c: errors. */
#include "refuse.h"

#include <stdio.h>

bool refuse(vlError *error, vlSource source, const char *what) {
  error->code = VL_ERROR_UNSUPPORTED;
  snprintf(error->file, sizeof error->file, "%s", source.file ? source.file : "");
  error->line = source.line;
  error->column = source.column;
  snprintf(error->message, sizeof error->message, "%s is not part of the reference renderer", what);
  return false;
}

bool refuse_kind(vlError *error, vlSource source, const char *family, uint32_t kind) {
  const vlKindFamily *rows = vl_kind_family_find(family);
  const char *name = rows && kind < rows->kind_count ? rows->rows[kind]->name : NULL;
  char what[200];
  snprintf(what, sizeof what, "%s \"%s\"", rows ? rows->thing : family, name ? name : "of this kind");
  return refuse(error, source, what);
}
