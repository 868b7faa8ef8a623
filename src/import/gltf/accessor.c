/* import/gltf/accessor.c: typed arrays over buffer views. An accessor is checked once; its
 * elements are then read as floats or unsigned integers. */

#include "base/text.h"
#include "import/gltf/gltf.h"

static uint32_t component_size(uint32_t type) {
  static const uint8_t sizes[] = {1, 1, 2, 2, 0, 4, 4};
  const uint32_t i = type - VL_GLTF_BYTE;
  return i < VL_LENGTH(sizes) ? sizes[i] : 0;
}

static uint32_t component_count(const char *type, bool *matrix) {
  static const struct {
    const char *name;
    uint32_t count;
  } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
               {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
  for (size_t i = 0; i < VL_LENGTH(types); i++)
    if (vl_text_is(types[i].name, type)) {
      *matrix = i > 3;
      return types[i].count;
    }
  return 0;
}

const vlGltfView *vl_gltf_view(vlGltf *g, const vlGltfLocation *at, size_t index) {
  if (g->views[index].data)
    return &g->views[index];
  vl_gltf_fail(at, "bufferViews[%zu] holds nothing that velo can read", index);
  return NULL;
}

/* Checks that `count` elements of `size` bytes, `stride` bytes apart from `offset` on, lie
 * inside the view. */
static bool fits(vlGltf *g, const vlGltfLocation *at, size_t view, size_t offset, size_t count,
                 size_t size, size_t stride) {
  const vlGltfView *v = vl_gltf_view(g, at, view);
  if (!v)
    return false;
  if (count == 0)
    return true;
  /* count and offset are below 2^53 and stride is at most 252. The division avoids an overflow
   * of the sum. */
  if (count > v->size || offset > v->size || size > v->size - offset ||
      (count - 1) > (v->size - offset - size) / stride)
    return vl_gltf_fail(
        at, "%zu elements of %zu bytes do not fit into bufferViews[%zu], which has %zu bytes",
        count, size, view, v->size);
  return true;
}

static bool read_sparse(vlGltf *g, const vlGltfLocation *up, vlGltfAccessor *a, size_t size) {
  const json_t *sparse, *indices, *values;
  if (!vl_gltf_object(up, "sparse", &sparse))
    return false;
  if (!sparse)
    return true;
  const vlGltfLocation *at = VL_GLTF_KEY(up, "sparse"), *at_i = VL_GLTF_KEY(at, "indices"),
                       *at_v = VL_GLTF_KEY(at, "values");
  size_t index_view, value_view;
  size_t index_offset = 0, value_offset = 0, type = 0;
  if (!vl_gltf_size(at, "count", &a->sparse_count) ||
      !vl_gltf_object(at, "indices", &indices) || !vl_gltf_object(at, "values", &values) ||
      !vl_gltf_need_index(at_i, "bufferView", g->view_count, &index_view) ||
      !vl_gltf_size(at_i, "byteOffset", &index_offset) ||
      !vl_gltf_size(at_i, "componentType", &type) ||
      !vl_gltf_need_index(at_v, "bufferView", g->view_count, &value_view) ||
      !vl_gltf_size(at_v, "byteOffset", &value_offset))
    return false;
  if (type != VL_GLTF_UBYTE && type != VL_GLTF_USHORT && type != VL_GLTF_UINT)
    return vl_gltf_fail_key(at_i, "componentType", "%zu is not 5121, 5123 or 5125", type);
  if (a->sparse_count > a->count)
    return vl_gltf_fail_key(at, "count", "more than the accessor's count");
  size_t index_size = component_size((uint32_t)type);
  if (!fits(g, at_i, index_view, index_offset, a->sparse_count, index_size, index_size) ||
      !fits(g, at_v, value_view, value_offset, a->sparse_count, size, size))
    return false;
  a->sparse_type = (uint32_t)type;
  a->sparse_indices = g->views[index_view].data + index_offset;
  a->sparse_values = g->views[value_view].data + value_offset;
  return true;
}

static uint32_t read_uint(const uint8_t *p, uint32_t type) {
  uint16_t s;
  uint32_t i;
  if (type == VL_GLTF_UBYTE)
    return *p;
  if (type == VL_GLTF_USHORT) {
    memcpy(&s, p, 2);
    return s;
  }
  memcpy(&i, p, 4);
  return i;
}

static bool read_accessor(vlGltf *g, size_t index, vlGltfAccessor *a) {
  const vlGltfLocation *at = VL_GLTF_ROOT(g, "accessors", index);
  const char *type = "";
  size_t view;
  size_t offset = 0, component = 0;
  if (!vl_gltf_index(at, "bufferView", g->view_count, &view) ||
      !vl_gltf_size(at, "byteOffset", &offset) || !vl_gltf_size(at, "count", &a->count) ||
      !vl_gltf_size(at, "componentType", &component) || !vl_gltf_text(at, "type", &type) ||
      !vl_gltf_bool(at, "normalized", &a->normalized))
    return false;
  a->components = component_count(type, &a->matrix);
  a->type = component <= VL_GLTF_FLOAT ? (uint32_t)component : 0;
  size_t one = component_size(a->type);
  if (!a->components)
    return vl_gltf_fail_key(
        at, "type", "unknown type \"%s\" (known: SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3, MAT4)",
        vl_short_text(type).text);
  if (!one)
    return vl_gltf_fail_key(at, "componentType",
                            "%zu is not 5120, 5121, 5122, 5123, 5125 or 5126", component);
  if (a->count == 0)
    return vl_gltf_fail_key(at, "count", "must be at least 1");
  if (a->count > UINT32_MAX)
    return vl_gltf_fail_key(at, "count", "%zu is too many", a->count);
  if (a->matrix && one < 4)
    return vl_gltf_fail(at, "matrices of small integers are not supported");
  size_t size = one * a->components;
  a->stride = view != VL_GLTF_NONE && g->views[view].stride ? g->views[view].stride : size;
  if (a->stride < size)
    return vl_gltf_fail(at, "its elements of %zu bytes overlap at a byteStride of %zu", size,
                        a->stride);
  if (view != VL_GLTF_NONE) {
    if (!fits(g, at, view, offset, a->count, size, a->stride))
      return false;
    a->data = g->views[view].data + offset;
  } else if (a->count > g->total + 65536) /* without a view all elements are zero, so the
                                               file's size does not limit their number */
    return vl_gltf_fail_key(at, "count", "%zu zeros are out of proportion to the file",
                            a->count);
  if (!read_sparse(g, at, a, size))
    return false;
  for (size_t i = 0; i < a->sparse_count; i++) {
    uint32_t k =
        read_uint(a->sparse_indices + i * component_size(a->sparse_type), a->sparse_type);
    if (k >= a->count)
      return vl_gltf_fail_key(at, "sparse.indices", "names element %u of %zu", k, a->count);
  }
  a->state = VL_GLTF_GOOD;
  return true;
}

const vlGltfAccessor *vl_gltf_accessor(vlGltf *g, size_t index) {
  vlGltfAccessor *a = &g->accessors[index];
  return a->state == VL_GLTF_GOOD || read_accessor(g, index, a) ? a : NULL;
}

/* ---- reading ----------------------------------------------------------------------------- */

/* max: of the signed type. */
static float from_signed(float value, float max, bool normalized) {
  return normalized ? fmaxf(value / max, -1.0f) : value;
}

static float read_float(const uint8_t *p, uint32_t type, bool normalized) {
  int8_t b;
  int16_t s;
  float f;
  switch (type) {
    case VL_GLTF_BYTE:
      memcpy(&b, p, 1);
      return from_signed(b, 127.0f, normalized);
    case VL_GLTF_SHORT:
      memcpy(&s, p, 2);
      return from_signed(s, 32767.0f, normalized);
    case VL_GLTF_FLOAT:
      memcpy(&f, p, 4);
      return f;
    case VL_GLTF_UBYTE:
      return normalized ? (float)*p / 255.0f : (float)*p;
    case VL_GLTF_USHORT:
      f = (float)read_uint(p, type);
      return normalized ? f / 65535.0f : f;
    default:
      return normalized ? (float)((double)read_uint(p, type) / 4294967295.0)
                        : (float)read_uint(p, type);
  }
}

static void read_element(const vlGltfAccessor *a, const uint8_t *p, uint32_t components,
                         float *out) {
  size_t one = component_size(a->type);
  for (uint32_t c = 0; c < components; c++)
    out[c] = p ? read_float(p + c * one, a->type, a->normalized) : 0.0f;
}

/* Reads all elements as floats, `components` per element. Components that the accessor lacks
 * are left unchanged in out. Normalised integers map to [-1, 1] or [0, 1]; other integers keep
 * their value. */
static void read_floats(const vlGltfAccessor *a, uint32_t wanted, float *out) {
  uint32_t n = wanted < a->components ? wanted : a->components;
  if (a->data && a->type == VL_GLTF_FLOAT && n == wanted) {
    if (n == a->components && a->stride == 4 * n)
      memcpy(out, a->data, a->count * 4 * n);
    else
      for (size_t i = 0; i < a->count; i++)
        memcpy(out + i * wanted, a->data + i * a->stride, 4 * n);
  } else {
    for (size_t i = 0; i < a->count; i++)
      read_element(a, a->data ? a->data + i * a->stride : NULL, n, out + i * wanted);
  }
  size_t size = component_size(a->type) * a->components, step = component_size(a->sparse_type);
  for (size_t i = 0; i < a->sparse_count; i++)
    read_element(
        a, a->sparse_values + i * size, n,
        out + (size_t)read_uint(a->sparse_indices + i * step, a->sparse_type) * wanted);
}

static uint32_t as_uint(const uint8_t *p, uint32_t type) {
  if (type == VL_GLTF_UBYTE || type == VL_GLTF_USHORT || type == VL_GLTF_UINT)
    return read_uint(p, type);
  float f = read_float(p, type, false);
  return f > 0 && f < 4e9f ? (uint32_t)f : 0;
}

void vl_gltf_read_uints(const vlGltfAccessor *a, uint32_t wanted, uint32_t *out) {
  uint32_t n = wanted < a->components ? wanted : a->components;
  size_t one = component_size(a->type), step = component_size(a->sparse_type);
  for (size_t i = 0; i < a->count; i++)
    for (uint32_t c = 0; c < wanted; c++)
      out[i * wanted + c] =
          a->data && c < n ? as_uint(a->data + i * a->stride + c * one, a->type) : 0;
  for (size_t i = 0; i < a->sparse_count; i++) {
    uint32_t k = read_uint(a->sparse_indices + i * step, a->sparse_type);
    for (uint32_t c = 0; c < n; c++)
      out[(size_t)k * wanted + c] =
          as_uint(a->sparse_values + (i * a->components + c) * one, a->type);
  }
}

bool vl_gltf_spend(const vlGltfLocation *at, uint64_t bytes) {
  vlGltf *g = vl_gltf_of(at);
  /* Triangles may share their data and points become small solids, so the geometry may be
   * larger than the file. More than a thousandfold is refused. */
  uint64_t limit = (256u << 20) + 1000 * (g->total + g->file_size);
  g->spent += bytes;
  return g->spent <= limit ||
         vl_gltf_fail(at, "the file repeats its data too often: more than %llu MB of geometry",
                      (unsigned long long)(limit >> 20));
}

float *vl_gltf_load_floats(const vlGltfLocation *at, size_t index, uint32_t components,
                           size_t count, size_t *read) {
  vlGltf *g = vl_gltf_of(at);
  const vlGltfAccessor *a = vl_gltf_accessor(g, index);
  if (!a)
    return NULL;
  if (count && a->count != count) {
    vl_gltf_fail(at, "accessors[%zu] has %zu elements, %zu are needed", index, a->count, count);
    return NULL;
  }
  if (!vl_gltf_spend(at, (uint64_t)a->count * components * 4))
    return NULL;
  float *out = vl_alloc_array(g->context, a->count, components * sizeof(float));
  if (!out) {
    vl_gltf_fail_memory(g);
    return NULL;
  }
  if (components > a->components)
    for (size_t i = 0; i < a->count * components; i++)
      out[i] = i % components == 3 ? 1.0f : 0.0f;
  read_floats(a, components, out);
  if (read)
    *read = a->count;
  return out;
}
