/* import/gltf/file.c: reads the file: .gltf or .glb (distinguished by the first bytes), its
 * JSON, uris, buffers and buffer views. */

#include "base/file.h"
#include "base/bytes.h"
#include "base/free.h"
#include "base/glb.h"
#include "base/json.h"
#include "base/text.h"
#include "import/find.h"
#include "import/gltf/gltf.h"

enum { MAX_ITEMS = 1 << 24 };

/* The .glb container: a header of 12 bytes, then chunks. A chunk consists of its length, its
 * type and its data. */
static bool split_glb(vlGltf *g, const char **json, size_t *json_size) {
  if (g->file_size < 20)
    return vl_gltf_fail(&g->top, "broken .glb: only %zu bytes", g->file_size);
  uint32_t version = vl_little32(g->file + 4), length = vl_little32(g->file + 8);
  if (version != VL_GLB_VERSION)
    return vl_gltf_fail(&g->top, ".glb of version %u; velo reads version 2", version);
  if (length > g->file_size)
    return vl_gltf_fail(&g->top, "broken .glb: says that it has %u bytes, the file has %zu",
                        length, g->file_size);
  size_t at = 12, end = length < 20 ? g->file_size : length;
  for (int k = 0; at + 8 <= end; k++) {
    size_t size = vl_little32(g->file + at);
    uint32_t kind = vl_little32(g->file + at + 4);
    if (size > end - at - 8)
      return vl_gltf_fail(&g->top,
                          "broken .glb: chunk %d of %zu bytes at byte %zu goes past the end", k,
                          size, at);
    if (k == 0 && kind != VL_GLB_JSON)
      return vl_gltf_fail(&g->top, "broken .glb: its first chunk is not JSON");
    if (k == 0) {
      *json = (const char *)g->file + at + 8;
      *json_size = size;
    }
    if (kind == VL_GLB_BIN && !g->chunk) {
      g->chunk = g->file + at + 8;
      g->chunk_size = size;
    }
    at += 8 + size;
    at = (at + 3) & ~(size_t)3;
  }
  if (!*json)
    return vl_gltf_fail(&g->top, "broken .glb: it has no JSON");
  return true;
}

static bool parse(vlGltf *g, const char *text, size_t size) {
  while (size && (text[size - 1] == 0 || text[size - 1] == ' '))
    size--; /* padding */
  if (size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) {
    text += 3;
    size -= 3;
  }
  json_error_t error;
  g->root = vl_json_parse(text, size, 0, &error);
  if (!g->root) {
    if (vl_json_lacks_memory(&error))
      return vl_gltf_fail_memory(g);
    uint32_t line = error.line > 0 ? (uint32_t)error.line : 0,
             column = error.column > 0 ? (uint32_t)error.column : 1;
    return vl_scene_fail(g->scene, VL_ERROR_SCENE, (vlSource){g->path, line, column},
                         "broken JSON: %.*s", (int)vl_json_problem_length(error.text),
                         error.text);
  }
  if (!json_is_object(g->root))
    return vl_gltf_fail(&g->top, "not glTF: the JSON is not an object");
  const json_t *asset = json_object_get(g->root, "asset");
  const char *version = json_string_value(json_object_get(asset, "version"));
  const char *min = json_string_value(json_object_get(asset, "minVersion"));
  if (!version)
    return vl_gltf_fail(&g->top, "asset.version: is missing: not glTF 2.0");
  if (strncmp(min ? min : version, "2.", 2) != 0 || (min && !vl_text_is(min, "2.0")))
    return vl_gltf_fail(&g->top, "asset: glTF %s; velo reads 2.0",
                        vl_short_text(min ? min : version).text);
  return true;
}

/* Counts the elements of the root's array `key` and checks that they are objects. */
static bool count_items(vlGltf *g, const char *key, size_t *count) {
  const json_t *array;
  if (!vl_gltf_array(&g->top, key, &array, count))
    return false;
  if (*count > MAX_ITEMS)
    return vl_gltf_fail_key(&g->top, key, "too many: %zu", *count);
  for (size_t i = 0; i < *count; i++)
    if (!json_is_object(json_array_get(array, i)))
      return vl_gltf_fail(VL_GLTF_ROOT(g, key, i), "must be an object");
  return true;
}

static bool count_all(vlGltf *g) {
  const struct {
    const char *key;
    size_t *count;
  } arrays[] = {{"buffers", &g->buffer_count},     {"bufferViews", &g->view_count},
                {"accessors", &g->accessor_count}, {"nodes", &g->node_count},
                {"materials", &g->material_count}, {"images", &g->image_count},
                {"textures", &g->texture_count},   {"meshes", &g->mesh_count},
                {"skins", &g->skin_count},         {"cameras", &g->camera_count},
                {"samplers", &g->sampler_count},   {"animations", &g->animation_count},
                {"scenes", &g->scene_count}};
  for (size_t i = 0; i < VL_LENGTH(arrays); i++)
    if (!count_items(g, arrays[i].key, arrays[i].count))
      return false;
  if (!vl_gltf_array(VL_GLTF_KEY(&g->top, "extensions.KHR_lights_punctual"), "lights",
                     &g->lights, &g->light_count) ||
      !vl_gltf_array(VL_GLTF_KEY(&g->top, "extensions.EXT_lights_ies"), "lights", &g->lamps,
                     &g->lamp_count))
    return false;
  return (g->buffers = vl_gltf_make(g, g->buffer_count + 1, sizeof *g->buffers)) &&
         (g->views = vl_gltf_make(g, g->view_count + 1, sizeof *g->views)) &&
         (g->accessors = vl_gltf_make(g, g->accessor_count + 1, sizeof *g->accessors)) &&
         (g->nodes = vl_gltf_make(g, g->node_count + 1, sizeof *g->nodes)) &&
         (g->materials = vl_gltf_make(g, 2 * (g->material_count + 1), sizeof *g->materials)) &&
         (g->images = vl_gltf_make(g, g->image_count + 1, sizeof *g->images)) &&
         (g->meshes = vl_gltf_make(g, g->mesh_count + 1, sizeof *g->meshes));
}

/* Keeps a block until vl_gltf_close, which frees it. False: out of memory; the block is
 * freed. */
static bool own(vlGltf *g, void *block) {
  void **slot = VL_PUSH(g->context, &g->blocks);
  if (!slot) {
    vl_free(g->context, block);
    return vl_gltf_fail_memory(g);
  }
  *slot = block;
  return true;
}

void *vl_gltf_make(vlGltf *g, size_t count, size_t size) {
  void *block = vl_alloc_zero(g->context, count, size);
  if (!block)
    vl_gltf_fail_memory(g);
  return block && own(g, block) ? block : NULL;
}

bool vl_gltf_open(vlGltf *g) {
  char *data;
  vlError error;
  vl_error_clear(&error);
  vlResult r = vl_file_read_given(g->context, g->path, false, &data, &g->file_size, &error);
  if (r != VL_OK)
    return vl_scene_fail(g->scene, r, (vlSource){0}, "%s", error.message);
  g->file = (uint8_t *)data;
  if (!own(g, data))
    return false;
  const char *json = data;
  size_t size = g->file_size;
  if (size >= 4 && memcmp(data, "glTF", 4) == 0) {
    json = NULL;
    if (!split_glb(g, &json, &size))
      return false;
  } else if (vl_ends_with(g->path, ".glb") &&
             (size == 0 || (data[0] != '{' && (unsigned char)data[0] != 0xef)))
    return vl_gltf_fail(&g->top, "no .glb: it does not begin with \"glTF\"");
  return parse(g, json, size) && count_all(g);
}

void vl_gltf_close(vlGltf *g) {
  json_decref(g->root);
  for (size_t i = 0; g->nodes && i < g->node_count; i++)
    VL_FREE(g->context, g->nodes[i].weights, g->nodes[i].weights_close);
  VL_FREE(g->context, g->material_names.slots, g->shape_names.slots, g->instance_names.slots);
  for (size_t i = 0; i < g->blocks.count; i++)
    vl_free(g->context, g->blocks.items[i]);
  VL_ARRAY_FREE(g->context, &g->blocks);
}

/* ---- uris -------------------------------------------------------------------------------- */

static int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z')
    return c - 'A';
  if (c >= 'a' && c <= 'z')
    return c - 'a' + 26;
  if (c >= '0' && c <= '9')
    return c - '0' + 52;
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

static int hex_digit(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

/* Decodes percent escapes such as %20. A % that starts no escape stays. result has room for all
 * of text. */
static size_t unescape(const char *text, char *result) {
  size_t n = 0;
  for (; *text; text++) {
    int high = *text == '%' ? hex_digit(text[1]) : -1,
        low = high >= 0 ? hex_digit(text[2]) : -1;
    bool escaped = low >= 0 && (high || low);
    result[n++] = escaped ? (char)(16 * high + low) : *text;
    if (escaped)
      text += 2;
  }
  result[n] = 0;
  return n;
}

static bool unpack(vlGltf *g, const vlGltfLocation *at, const char *uri, const uint8_t **data,
                   size_t *size) {
  const char *comma = strchr(uri, ',');
  if (!comma)
    return vl_gltf_fail(at, "broken data: uri, it has no comma");
  bool base64 = comma - uri >= 7 && strncmp(comma - 7, ";base64", 7) == 0;
  const char *text = comma + 1;
  uint8_t *block = vl_gltf_make(g, strlen(text) + 1, 1);
  if (!block)
    return false;
  *data = block;
  if (!base64) {
    *size = unescape(text, (char *)block);
    return true;
  }
  uint32_t bits = 0, held = 0;
  size_t n = 0;
  for (const char *s = text; *s && *s != '='; s++) {
    int digit = base64_digit(*s);
    if (digit < 0)
      return vl_gltf_fail(at, "broken data: uri, byte %zu is not of base64", (size_t)(s - uri));
    bits = (bits << 6 | (uint32_t)digit) & 0xffffff;
    held += 6;
    if (held >= 8) {
      held -= 8;
      block[n++] = (uint8_t)(bits >> held);
    }
  }
  *size = n;
  return true;
}

bool vl_gltf_uri(vlGltf *g, const vlGltfLocation *at, const char *uri, const uint8_t **data,
                 size_t *size, const char **path) {
  *data = NULL;
  *path = NULL;
  if (strncmp(uri, "data:", 5) == 0)
    return unpack(g, at, uri, data, size);
  if (strstr(uri, "://") && strncmp(uri, "file://", 7) != 0)
    return vl_gltf_fail(at, "\"%s\": velo fetches nothing from the net",
                        vl_short_text(uri).text);
  if (strncmp(uri, "file://", 7) == 0)
    uri += 7;
  char name[4096], whole[4096];
  if (strlen(uri) >= sizeof name)
    return vl_gltf_fail(at, "the file name is too long");
  unescape(uri, name);
  vlFound found =
      vl_find_file(g->context, g->path, NULL, g->def->search_path, name, whole, sizeof whole);
  if (found == VL_FOUND_TOO_LONG)
    return vl_gltf_fail(at, "the file name is too long");
  *path = whole;
  return vl_scene_copy_string(g->scene, path);
}

/* ---- buffers ----------------------------------------------------------------------------- */

static bool read_buffer(vlGltf *g, size_t i) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "buffers", i);
  vlGltfBuffer *b = &g->buffers[i];
  const char *uri = NULL, *path = NULL;
  size_t length = 0, size = 0;
  if (!vl_gltf_text(at, "uri", &uri) || !vl_gltf_size(at, "byteLength", &length))
    return false;
  if (!uri && (i || !g->chunk))
    return true; /* a fallback of compressed views, or bytes that only another program has */
  if (!uri) {
    b->data = g->chunk;
    size = g->chunk_size;
  } else if (!vl_gltf_uri(g, VL_GLTF_KEY(at, "uri"), uri, &b->data, &size, &path)) {
    return false;
  }
  if (path) {
    char *data;
    vlError error;
    vl_error_clear(&error);
    vlResult r = vl_file_read(g->context, path, false, &data, &size, &error);
    if (r != VL_OK)
      return vl_gltf_fail_code(r, VL_GLTF_KEY(at, "uri"), "%s", error.message);
    if (!own(g, data))
      return false;
    b->data = (const uint8_t *)data;
  }
  if (size < length)
    return vl_gltf_fail_key(at, "byteLength", "%zu, but there are only %zu bytes", length,
                            size);
  b->size = length;
  g->total += length;
  return true;
}

bool vl_gltf_range(const vlGltfLocation *at, vlGltfRange *range) {
  *range = (vlGltfRange){.stride = 0};
  return vl_gltf_need_index(at, "buffer", vl_gltf_of(at)->buffer_count, &range->buffer) &&
         vl_gltf_size(at, "byteOffset", &range->offset) &&
         vl_gltf_size(at, "byteLength", &range->length) &&
         vl_gltf_size(at, "byteStride", &range->stride);
}

bool vl_gltf_check_range(const vlGltfLocation *at, const vlGltfRange *range) {
  const vlGltfBuffer *b = &vl_gltf_of(at)->buffers[range->buffer];
  if (b->data && range->offset <= b->size && range->length <= b->size - range->offset)
    return true;
  return vl_gltf_fail(at, "bytes %zu to %zu, but buffers[%zu] has only %zu", range->offset,
                      range->offset + range->length, range->buffer, b->data ? b->size : 0);
}

static bool read_view(vlGltf *g, size_t i) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "bufferViews", i);
  const json_t *json = vl_gltf_item(g, "bufferViews", i);
  const json_t *packed = vl_gltf_extension(json, "EXT_meshopt_compression");
  vlGltfRange r;
  if (packed)
    return vl_gltf_unpack_view(g, at, &g->views[i]);
  if (!vl_gltf_range(at, &r))
    return false;
  const uint8_t *data = g->buffers[r.buffer].data;
  if (!data)
    return true; /* what reads the view reports it */
  if (!vl_gltf_check_range(at, &r))
    return false;
  if (r.stride && (r.stride < 4 || r.stride > 252))
    return vl_gltf_fail_key(at, "byteStride", "%zu is not from 4 to 252", r.stride);
  g->views[i] = (vlGltfView){data + r.offset, r.length, r.stride};
  return true;
}

bool vl_gltf_read_buffers(vlGltf *g) {
  for (size_t i = 0; i < g->buffer_count; i++)
    if (!read_buffer(g, i))
      return false;
  for (size_t i = 0; i < g->view_count; i++)
    if (!read_view(g, i))
      return false;
  return true;
}
