/* import/gltf/meshopt.c: EXT_meshopt_compression: compressed buffer views, decoded by
 * meshoptimizer. The decoders never read outside their input but assert that sizes are valid:
 * sizes are checked here. */
#include <meshoptimizer.h>

#include "import/gltf/gltf.h"

/* Largest ratio of decoded to encoded bytes; the formats reach about 64. */
enum { MAX_TIMES = 256 };

typedef enum { ATTRIBUTES, TRIANGLES, INDICES } Mode;
typedef enum { NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL } Filter;

static bool sizes_fit(Mode mode, Filter filter, size_t count, size_t stride) {
  if (mode == TRIANGLES)
    return count % 3 == 0 && (stride == 2 || stride == 4) && filter == NONE;
  if (mode == INDICES)
    return (stride == 2 || stride == 4) && filter == NONE;
  if (stride == 0 || stride > 256 || stride % 4)
    return false;
  return filter == OCTAHEDRAL ? stride == 4 || stride == 8
                              : filter != QUATERNION || stride == 8;
}

static int decode(Mode mode, void *out, size_t count, size_t stride, const uint8_t *data,
                  size_t size) {
  switch (mode) {
    case TRIANGLES:
      return meshopt_decodeIndexBuffer(out, count, stride, data, size);
    case INDICES:
      return meshopt_decodeIndexSequence(out, count, stride, data, size);
    case ATTRIBUTES:
      return meshopt_decodeVertexBuffer(out, count, stride, data, size);
  }
  return -1;
}

bool vl_gltf_unpack_view(vlGltf *g, const vlGltfLocation *up, vlGltfView *view) {
  static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  const vlGltfLocation *at = VL_GLTF_KEY(up, "extensions.EXT_meshopt_compression");
  vlGltfRange r;
  size_t count = 0;
  int mode = ATTRIBUTES, filter = NONE;
  if (!vl_gltf_range(at, &r) || !vl_gltf_size(at, "count", &count) ||
      !vl_gltf_choice(at, "mode", modes, 3, &mode) ||
      !vl_gltf_choice(at, "filter", filters, 4, &filter))
    return false;
  if (!vl_gltf_check_range(at, &r))
    return false;
  const size_t length = r.length, stride = r.stride;
  if (!sizes_fit((Mode)mode, (Filter)filter, count, stride))
    return vl_gltf_fail(at, "%zu elements of %zu bytes: mode %s with filter %s has no such",
                        count, stride, modes[mode], filters[filter]);
  if (count > MAX_TIMES * length / stride)
    return vl_gltf_fail(at, "%zu bytes cannot hold %zu elements of %zu bytes", length, count,
                        stride);
  uint8_t *out = vl_gltf_make(g, count + 1, stride);
  if (!out)
    return false;
  if (count &&
      decode((Mode)mode, out, count, stride, g->buffers[r.buffer].data + r.offset, length) != 0)
    return vl_gltf_fail(at, "its bytes are no meshopt %s", modes[mode]);
  if (count && filter == OCTAHEDRAL)
    meshopt_decodeFilterOct(out, count, stride);
  if (count && filter == QUATERNION)
    meshopt_decodeFilterQuat(out, count, stride);
  if (count && filter == EXPONENTIAL)
    meshopt_decodeFilterExp(out, count, stride);
  g->total += count * stride;
  view->data = out;
  view->size = count * stride;
  view->stride = mode == ATTRIBUTES ? stride : 0;
  return true;
}
