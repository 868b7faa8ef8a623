/* raw/tiff_memory.c: libtiff on files in memory, with its messages kept and its memory bounded.
 */
#include "raw/tiff_memory.h"

#include <errno.h>

#include "base/error.h"
#include "base/text.h"

static size_t size_of(const vlTiffMemory *m) {
  return m->writes ? m->writer.memory_size : m->size;
}

static tmsize_t on_read(thandle_t user, void *data, tmsize_t size) {
  vlTiffMemory *m = user;
  const uint8_t *from = m->writes ? (const uint8_t *)m->writer.memory : m->data;
  size_t all = size_of(m), left = m->at < all ? all - (size_t)m->at : 0;
  size_t n = size < 0 ? 0 : (size_t)size < left ? (size_t)size : left;
  if (n)
    memcpy(data, from + m->at, n);
  m->at += n;
  return (tmsize_t)n;
}

static tmsize_t on_write(thandle_t user, void *data, tmsize_t size) {
  vlTiffMemory *m = user;
  if (!m->writes || size < 0)
    return -1;
  vl_file_write_at(&m->writer, data, (size_t)size, m->at);
  m->at += (uint64_t)size;
  return m->writer.failed_errno ? -1 : size;
}

static toff_t on_seek(thandle_t user, toff_t offset, int whence) {
  vlTiffMemory *m = user;
  uint64_t from = whence == SEEK_CUR ? m->at : whence == SEEK_END ? size_of(m) : 0;
  m->at = from + offset;
  return m->at;
}

static int on_close(VL_UNUSED thandle_t user) {
  return 0;
}

static toff_t on_size(thandle_t user) {
  return size_of(user);
}

static int on_error(VL_UNUSED TIFF *tiff, void *user, VL_UNUSED const char *module,
                    const char *format, va_list arguments) {
  vlTiffMemory *m = user;
  vsnprintf(m->message, sizeof m->message, format, arguments);
  vl_make_printable(m->message);
  return 1;
}

static int on_warning(VL_UNUSED TIFF *tiff, VL_UNUSED void *user, VL_UNUSED const char *module,
                      VL_UNUSED const char *format, VL_UNUSED va_list arguments) {
  return 1;
}

/* mode: of TIFFOpen; m: files are not mapped, c: long strips stay whole. */
static bool open_memory(vlTiffMemory *m, const char *name, const char *mode) {
  TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
  if (!options)
    return false;
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, VL_TIFF_MAX_MEMORY);
  TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, m);
  TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, m);
  m->tiff = TIFFClientOpenExt(name, mode, m, on_read, on_write, on_seek, on_close, on_size,
                              NULL, NULL, options);
  TIFFOpenOptionsFree(options);
  return m->tiff;
}

bool vl_tiff_open_read(vlTiffMemory *memory, vlContext *context, const char *name,
                       const void *data, size_t size) {
  memset(memory, 0, sizeof *memory);
  memory->context = context;
  memory->data = data;
  memory->size = size;
  return open_memory(memory, name, "rmc");
}

bool vl_tiff_open_write(vlTiffMemory *memory, vlContext *context, const char *name) {
  memset(memory, 0, sizeof *memory);
  memory->context = context;
  memory->writes = true;
  vl_file_open_memory(&memory->writer, context, name);
  return open_memory(memory, name, "wlm");
}

void vl_tiff_close(vlTiffMemory *memory) {
  if (memory->tiff)
    TIFFClose(memory->tiff);
  memory->tiff = NULL;
}

vlResult vl_tiff_finish(vlTiffMemory *memory, bool whole, const char *path, vlError *error) {
  vlFileWriter *writer = &memory->writer;
  vlResult result;
  vl_tiff_close(memory);
  if (writer->failed_errno == ENOMEM)
    result = vl_fail_memory(error);
  else if (!whole || writer->failed_errno)
    result = vl_fail(error, VL_ERROR_IO, "cannot write %s: %s", path,
                     memory->message[0] ? memory->message : "libtiff gave up");
  else
    result = vl_write_file(memory->context, path, writer->memory, writer->memory_size, error);
  vl_free(memory->context, writer->memory);
  return result;
}
