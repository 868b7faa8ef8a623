/* import/gltf/draco_primitive.c: KHR_draco_mesh_compression: the accessors of a primitive get
 * their elements from a compressed mesh. Builds without libdraco report that the extension
 * needs it. */
#include "import/gltf/draco.h"

#include "import/gltf/gltf.h"

#ifdef VELO_DRACO
/* Fills an accessor. index: its number; id: of Draco's attribute, negative: the indices of the
 * faces. */
static bool fill(vlGltf *g, const vlGltfLocation *at, const vlDraco *mesh, size_t index,
                 int64_t id) {
  const vlGltfAccessor *read = vl_gltf_accessor(g, index);
  vlGltfAccessor *a = &g->accessors[index];
  if (!read)
    return false;
  size_t wanted = id < 0 ? 3 * (size_t)vl_draco_faces(mesh) : vl_draco_points(mesh);
  if (a->count != wanted)
    return vl_gltf_fail(VL_GLTF_ROOT(g, "accessors", index),
                        "%zu elements, but the compressed mesh has %zu", a->count, wanted);
  uint32_t type = id < 0 ? VL_GLTF_UINT : a->type;
  size_t size = id < 0 || a->type == VL_GLTF_FLOAT ? 4
                : a->type == VL_GLTF_UINT          ? 4
                : a->type >= VL_GLTF_SHORT         ? 2
                                                   : 1;
  if (!vl_gltf_spend(at, (uint64_t)a->count * a->components * size))
    return false;
  uint8_t *data = vl_gltf_make(g, a->count + 1, a->components * size);
  if (!data)
    return false;
  if (id < 0)
    vl_draco_indices(mesh, (uint32_t *)(void *)data);
  else if (!vl_draco_values(mesh, (uint32_t)id, type, a->components, data))
    return vl_gltf_fail(at, "the compressed mesh has no attribute %d of this type", (int)id);
  a->data = data;
  a->type = type;
  a->stride = size * a->components;
  return true;
}

static bool fill_all(vlGltf *g, const vlGltfLocation *at, const vlGltfLocation *here,
                     const json_t *own, const vlDraco *mesh) {
  const char *key;
  json_t *value;
  size_t accessor;
  g->total += 64 * (uint64_t)vl_draco_points(mesh) + 12 * (uint64_t)vl_draco_faces(mesh);
  if (!vl_gltf_index(at, "indices", g->accessor_count, &accessor))
    return false;
  if (accessor != VL_GLTF_NONE && !fill(g, here, mesh, accessor, -1))
    return false;
  json_object_foreach((json_t *)(uintptr_t)own, key, value) {
    if (!vl_gltf_index(VL_GLTF_KEY(at, "attributes"), key, g->accessor_count, &accessor))
      return false;
    double id = json_is_integer(value) ? json_number_value(value) : -1;
    if (!(id >= 0 && id < 4294967296.0))
      return vl_gltf_fail_key(here, "attributes", "an id of an attribute makes no sense");
    if (accessor != VL_GLTF_NONE && !fill(g, here, mesh, accessor, (int64_t)id))
      return false;
  }
  return true;
}

bool vl_gltf_unpack_primitive(vlGltf *g, const vlGltfLocation *at) {
  const vlGltfLocation *here = VL_GLTF_KEY(at, "extensions.KHR_draco_mesh_compression");
  const json_t *own;
  size_t view, first;
  if (!json_is_object(vl_gltf_json(here)))
    return true;
  if (!vl_gltf_index(here, "bufferView", g->view_count, &view) ||
      !vl_gltf_object(here, "attributes", &own) ||
      !vl_gltf_index(at, "indices", g->accessor_count, &first))
    return false;
  if (view == VL_GLTF_NONE || !own)
    return vl_gltf_fail(here, "needs bufferView and attributes");
  const vlGltfView *v = vl_gltf_view(g, here, view);
  if (!v)
    return false;
  /* The mesh of an accessor that stands in two primitives is decoded once. */
  if (first != VL_GLTF_NONE && g->accessors[first].state == VL_GLTF_GOOD &&
      g->accessors[first].data)
    return true;
  char reason[100] = "memory is exhausted";
  vlDraco *mesh = vl_draco_open(v->data, v->size, reason, sizeof reason);
  if (!mesh)
    return vl_gltf_fail(here, "its bytes are no mesh of Draco: %s", reason);
  bool ok = fill_all(g, at, here, own, mesh);
  vl_draco_close(mesh);
  return ok;
}
#else
static const char name[] = "KHR_draco_mesh_compression";

bool vl_gltf_unpack_primitive(vlGltf *g, const vlGltfLocation *at) {
  size_t position;
  if (!vl_gltf_extension(vl_gltf_json(at), name))
    return true;
  if (!vl_gltf_index(VL_GLTF_KEY(at, "attributes"), "POSITION", g->accessor_count, &position))
    return false;
  /* a fallback that is not compressed is read */
  if (position == VL_GLTF_NONE ||
      json_object_get(vl_gltf_item(g, "accessors", position), "bufferView"))
    return true;
  return vl_gltf_fail_code(VL_ERROR_UNSUPPORTED, at,
                           "is compressed by %s: this velo was built without libdraco", name);
}
#endif
