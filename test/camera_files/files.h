/* test/camera_files/files.h: helpers of the camera file tests: a directory of their own, files
 * with given text, reading and writing that must succeed or must fail with a given message. */
#ifndef TEST_CAMERA_FILES_FILES_H
#define TEST_CAMERA_FILES_FILES_H

#include "camera/cameras.h"

#include <stdio.h>

#include "failing_allocator.h"
#include "velo/camera_file.h"

static vlContext *context;
static char folder[64];

static inline int files_setup(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  snprintf(folder, sizeof folder, "/tmp/velo_files_XXXXXX");
  return vl_context_create(&def, &context) != VL_OK || !mkdtemp(folder);
}

static inline int files_teardown(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", folder);
  vl_context_destroy(context);
  return system(command);
}

/* Valid until the fourth call after this one. */
static inline const char *path_of(const char *name) {
  static char paths[4][512];
  static int turn;
  char *path = paths[turn = (turn + 1) % 4];
  snprintf(path, sizeof paths[0], "%s/%s", folder, name);
  return path;
}

static inline const char *put_bytes(const char *name, const char *text, size_t size) {
  const char *path = path_of(name);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, size, file), size);
  fclose(file);
  return path;
}
static inline const char *put(const char *name, const char *text) {
  return put_bytes(name, text, strlen(text));
}

static inline vlCameraRecord read_with(const char *path, const vlCameraFileDef *def) {
  vlCameraRecord record;
  vlError error;
  if (vl_camera_read(context, path, def, &record, &error) != VL_OK)
    fail_msg("%s:%u: %s", error.file, error.line, error.message);
  return record;
}

/* The error message of reading a text. */
static inline vlError refused(const char *name, const char *text) {
  vlCameraRecord record;
  vlError error;
  assert_int_equal(vl_camera_read(context, put(name, text), NULL, &record, &error),
                   VL_ERROR_SCENE);
  assert_non_null(strstr(error.file, name));
  assert_null(strchr(error.message, '\n'));
  return error;
}
#define REFUSED(name, at_line, text, words)                           \
  do {                                                                \
    vlError refused_error = refused(name, text);                      \
    if (!strstr(refused_error.message, words))                        \
      fail_msg("\"%s\" is not in: %s", words, refused_error.message); \
    assert_int_equal(refused_error.line, at_line);                    \
  } while (0)

/* Writes a record and reads it again while each allocation in turn fails. file may be null. */
static inline void check_memory(const char *path, const vlCameraRecord *record,
                                const vlCameraFileDef *file) {
  bool done = false;
  for (long n = 1; !done && n < 1000; n++) {
    failAllocator fail = {.fail_at = 0};
    vlContextDef def = vl_default_context_def();
    def.threads = 1;
    def.allocator = fail_allocator(&fail);
    vlContext *own;
    assert_int_equal(vl_context_create(&def, &own), VL_OK);
    vlCameraRecord r = *record;
    fail_after(&fail, n - 1);
    vlResult result = vl_camera_write(own, path, file, &r, NULL);
    if (result == VL_OK)
      result = vl_camera_read(own, path, NULL, &r, NULL);
    done = !atomic_load(&fail.refused);
    assert_int_equal(result, done ? VL_OK : VL_ERROR_MEMORY);
    vl_context_destroy(own);
    assert_int_equal(atomic_load(&fail.blocks), 0);
  }
  assert_true(done);
}

#endif
