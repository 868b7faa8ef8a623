/* test/import/gltf_writer.h: writes small glTF 2.0 files for tests. Arrays go into one buffer,
 * as base64 or as a binary chunk. The test gives the rest of the JSON as text. */
#ifndef TEST_IMPORT_GLTF_WRITER_H
#define TEST_IMPORT_GLTF_WRITER_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Gltf {
  uint8_t bytes[65536];
  size_t size;
  char views[8192], accessors[8192], rest[32768];
  int view_count, accessor_count;
} Gltf;

static inline int gltf_view(Gltf *g, const void *data, size_t size, int stride) {
  while (g->size % 4)
    g->bytes[g->size++] = 0;
  char stride_text[40] = "";
  if (stride)
    snprintf(stride_text, sizeof stride_text, ",\"byteStride\":%d", stride);
  size_t n = strlen(g->views);
  snprintf(g->views + n, sizeof g->views - n,
           "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu%s}", n ? "," : "", g->size,
           size, stride_text);
  memcpy(g->bytes + g->size, data, size);
  g->size += size;
  return g->view_count++;
}

/* Adds an accessor and returns its index. view < 0: no buffer view. more: further members, such
 * as ",\"normalized\":true"; may be null. */
static inline int gltf_accessor(Gltf *g, int view, int type, size_t count, const char *shape,
                                const char *more) {
  char view_text[40] = "";
  if (view >= 0)
    snprintf(view_text, sizeof view_text, "\"bufferView\":%d,", view);
  size_t n = strlen(g->accessors);
  snprintf(g->accessors + n, sizeof g->accessors - n,
           "%s{%s\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"%s}", n ? "," : "",
           view_text, type, count, shape, more ? more : "");
  return g->accessor_count++;
}

static inline int gltf_floats(Gltf *g, const float *data, size_t count, const char *shape,
                              int components) {
  return gltf_accessor(g, gltf_view(g, data, count * (size_t)components * sizeof *data, 0),
                       5126, count, shape, NULL);
}
static inline int gltf_shorts(Gltf *g, const uint16_t *data, size_t count) {
  return gltf_accessor(g, gltf_view(g, data, count * sizeof *data, 0), 5123, count, "SCALAR",
                       NULL);
}

/* The text of the .gltf file. rest: the members after the arrays, such as
 * "\"nodes\":[...],\"meshes\":[...]". */
static inline char *gltf_json(const Gltf *g, const char *uri, const char *rest) {
  size_t room = strlen(g->views) + strlen(g->accessors) + strlen(rest) + strlen(uri) + 1000;
  char *text = malloc(room);
  snprintf(text, room,
           "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu%s%s%s}],"
           "\"bufferViews\":[%s],"
           "\"accessors\":[%s]%s%s}",
           g->size, *uri ? ",\"uri\":\"" : "", uri, *uri ? "\"" : "", g->views, g->accessors,
           *rest ? "," : "", rest);
  return text;
}

static inline char *gltf_base64(const uint8_t *data, size_t size) {
  static const char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  char *text = malloc(size * 4 / 3 + 64), *to = text;
  to += sprintf(to, "data:application/octet-stream;base64,");
  for (size_t i = 0; i < size; i += 3) {
    uint32_t v = (uint32_t)data[i] << 16 | (i + 1 < size ? (uint32_t)data[i + 1] << 8 : 0) |
                 (i + 2 < size ? data[i + 2] : 0);
    for (int k = 0; k < 4; k++)
      *to++ = i + (size_t)k > size ? '=' : digits[v >> (18 - 6 * k) & 63];
  }
  *to = 0;
  return text;
}

static inline void gltf_file(const char *path, const void *data, size_t size) {
  FILE *f = fopen(path, "wb");
  if (f) {
    fwrite(data, 1, size, f);
    fclose(f);
  }
}

static inline void gltf_write_text(const Gltf *g, const char *path, const char *rest) {
  char *uri = gltf_base64(g->bytes, g->size), *text = gltf_json(g, uri, rest);
  gltf_file(path, text, strlen(text));
  free(text);
  free(uri);
}

/* The bytes of a .glb; the caller frees them. */
static inline uint8_t *gltf_binary(const Gltf *g, const char *rest, size_t *size) {
  char *text = gltf_json(g, "", rest);
  size_t json = (strlen(text) + 3) & ~(size_t)3, bin = (g->size + 3) & ~(size_t)3;
  *size = 12 + 8 + json + 8 + bin;
  uint8_t *out = calloc(1, *size);
  const uint32_t head[5] = {0x46546C67, 2, (uint32_t)*size, (uint32_t)json, 0x4E4F534A};
  const uint32_t chunk[2] = {(uint32_t)bin, 0x004E4942};
  memcpy(out, head, 20);
  memset(out + 20, ' ', json);
  memcpy(out + 20, text, strlen(text));
  memcpy(out + 20 + json, chunk, 8);
  memcpy(out + 28 + json, g->bytes, g->size);
  free(text);
  return out;
}

#endif
