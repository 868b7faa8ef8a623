/* test/import/load.h: loads scenes from strings and records their messages. */
#ifndef TEST_IMPORT_LOAD_H
#define TEST_IMPORT_LOAD_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "import/import.h"
#include "scene/scene.h"
#include "unit.h"

typedef struct Loaded {
  vlContext *context;
  vlScene *scene;
  vlResult result;
  vlError error;
  char log[4096]; /* lines "level file:line:column: text
                   * " */
} Loaded;

static inline void note(void *user, vlLogLevel level, const vlError *where,
                        const char *message) {
  Loaded *l = user;
  size_t n = strlen(l->log);
  static const char *const levels[] = {"error", "warning", "info", "debug"};
  snprintf(l->log + n, sizeof l->log - n, "%s %s:%u:%u: %s\n", levels[level],
           where ? where->file : "", where ? where->line : 0, where ? where->column : 0,
           message);
}

static inline void start_load(Loaded *l) {
  memset(l, 0, sizeof *l);
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  def.log = note;
  def.log_user = l;
  assert_int_equal(vl_context_create(&def, &l->context), VL_OK);
  assert_int_equal(vl_scene_create(l->context, &l->scene), VL_OK);
}

static inline void end_load(Loaded *l) {
  vl_scene_destroy(l->scene);
  assert_int_equal(vl_context_memory(l->context, NULL), 0); /* no leak */
  vl_context_destroy(l->context);
}

/* The text is loaded as the file "t.pbrt". */
static inline void load_text(Loaded *l, const char *text, bool permissive) {
  start_load(l);
  vlLoadDef def = vl_default_load_def();
  def.permissive = permissive;
  l->result = vl_import_pbrt_memory(l->scene, text, strlen(text), "t.pbrt", &def, &l->error);
}

static inline void load_fine(Loaded *l, const char *text) {
  load_text(l, text, false);
  if (l->result != VL_OK)
    print_message("%s:%u:%u: %s\n", l->error.file, l->error.line, l->error.column,
                  l->error.message);
  assert_int_equal(l->result, VL_OK);
}

/* Expects the error as the program prints it: "file:line:column: message". Prints the
 * difference. */
static inline bool gives_error(const char *text, vlResult code, const char *expected) {
  Loaded l;
  char said[1200];
  load_text(&l, text, false);
  snprintf(said, sizeof said, "%s:%u:%u: %s", l.error.file, l.error.line, l.error.column,
           l.error.message);
  bool fine = strcmp(said, expected) == 0 && l.result == code;
  if (!fine)
    print_message("scene: %s\n said: %s (%s)\n not:  %s\n", text, said,
                  vl_result_name(l.result), expected);
  end_load(&l);
  return fine;
}

static inline void assert_error(const char *text, vlResult code, const char *expected) {
  assert_true(gives_error(text, code, expected));
}

static inline void assert_near(double a, double b, double tolerance) {
  if (!(fabs(a - b) <= tolerance))
    print_message("%.17g is not %.17g\n", a, b);
  assert_true(fabs(a - b) <= tolerance);
}

#endif
