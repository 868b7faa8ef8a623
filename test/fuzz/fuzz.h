/* test/fuzz/fuzz.h: helpers of the fuzz targets: a context without log, the input as a file, a
 * bound on memory. */
#ifndef TEST_FUZZ_FUZZ_H
#define TEST_FUZZ_FUZZ_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "velo/velo.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* An untrusted file may use memory in proportion to its size; a gzip stream expands at most a
 * thousandfold. If a target exceeds this bound, it stops, which counts as a crash. */
enum { FUZZ_MEMORY = 1 << 28, FUZZ_LEFT = 1 << 16 /* the context's own */ };

static inline vlContext *fuzz_context(void) {
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  vlContext *context = NULL;
  if (vl_context_create(&def, &context) != VL_OK)
    exit(1);
  return context;
}

static inline void fuzz_end(vlContext *context) {
  size_t peak = 0, left = vl_context_memory(context, &peak);
  if (left > FUZZ_LEFT || peak > FUZZ_MEMORY) {
    fprintf(stderr, "%zu bytes left, peak of %zu bytes\n", left, peak);
    abort();
  }
  vl_context_destroy(context);
}

/* Writes the input to a file of that name in a directory of this process, in $TMPDIR. The path
 * is valid until the next call. */
static inline const char *fuzz_file(const char *name, const uint8_t *data, size_t size) {
  static char folder[192], path[256];
  if (!folder[0]) {
    const char *scratch = getenv("TMPDIR");
    if (!scratch || !*scratch)
      scratch = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    snprintf(folder, sizeof folder, "%.150s/velo-fuzz-XXXXXX", scratch);
    if (!mkdtemp(folder))
      exit(1);
  }
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  if (!file || fwrite(data, 1, size, file) != size)
    exit(1);
  fclose(file);
  return path;
}

#endif
