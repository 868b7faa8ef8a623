/* test/raw/sample_raw.h: what the tests of raw images share: a context, files, a raw image
 * whose numbers and metadata are all different. */
#ifndef TEST_RAW_SAMPLE_RAW_H
#define TEST_RAW_SAMPLE_RAW_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "failing_allocator.h"
#include "unit.h"
#include "velo/velo.h"

static inline vlContext *make_context(uint32_t threads) {
  vlContextDef def = vl_default_context_def();
  def.threads = threads;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  return context;
}

static inline void end_context(vlContext *context) {
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* The path of a file in a folder of this process. */
static inline const char *in_folder(const char *name, char path[1024]) {
  static char folder[512];
  if (!folder[0]) {
    snprintf(folder, sizeof folder, "%s/raw_test_XXXXXX", VELO_BINARY_DIR);
    assert_non_null(mkdtemp(folder));
  }
  snprintf(path, 1024, "%s/%s", folder, name);
  return path;
}

static inline int remove_folder(void **state) {
  char path[1024], command[1100];
  (void)state;
  snprintf(command, sizeof command, "rm -rf '%s'", in_folder("", path));
  return system(command);
}

/* Whether this build has libtiff. */
static inline bool has_tiff(void) {
  const vlLibrary *library;
  for (uint32_t i = 0; (library = vl_version_library(i)); i++)
    if (strcmp(library->name, "libtiff") == 0)
      return true;
  return false;
}

/* A def with every kind of metadata. */
static inline vlRawDef full_def(const char *pattern, uint32_t width, uint32_t height) {
  vlRawDef def = vl_default_raw_def(width, height);
  assert_int_equal(vl_raw_set_pattern(&def, pattern, NULL), VL_OK);
  for (uint32_t i = 0; i < def.pattern_rows * def.pattern_columns; i++)
    def.black[i] = (uint16_t)(64 + i);
  def.white = 4000;
  snprintf(def.camera, sizeof def.camera, "Sample 1");
  def.exposure_time = 1.0f / 200.0f;
  def.f_number = 2.8f;
  def.focal_length = 0.05f;
  def.iso = 400;
  def.gain = 0.25f;
  def.read_noise = 2.5f;
  def.baseline_exposure = 0.5f;
  return def;
}

/* Sensitivities that are the observer's, mixed by three rows of factors. */
static inline void mix_observer(const float rows[9], float *sensitivities) {
  float xyz[3 * VL_SPECTRUM_VALUES];
  vl_observer_tabulate(xyz);
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < VL_SPECTRUM_VALUES; i++)
      sensitivities[k * VL_SPECTRUM_VALUES + i] = rows[3 * k] * xyz[3 * i] +
                                                  rows[3 * k + 1] * xyz[3 * i + 1] +
                                                  rows[3 * k + 2] * xyz[3 * i + 2];
}

/* A raw image whose numbers run through all values from 0 to `white`. */
static inline vlRaw *make_raw(vlContext *context, const vlRawDef *def) {
  vlRaw *raw = NULL;
  vlError error;
  if (vl_raw_create(context, def, &raw, &error) != VL_OK)
    fail_msg("%s", error.message);
  uint16_t *numbers = vl_raw_numbers(raw);
  for (uint32_t i = 0; i < def->width * def->height; i++)
    numbers[i] = (uint16_t)(i * 2654435761u % (def->white + 1u));
  numbers[0] = def->white;
  return raw;
}

static inline void *slurp(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  void *data = malloc(*size + 1);
  assert_non_null(data);
  assert_int_equal(fread(data, 1, *size, file), *size);
  fclose(file);
  return data;
}

#endif
