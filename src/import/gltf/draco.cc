// import/gltf/draco.cc: see draco.h. The library's only file in C++; no exception leaves it.
#include "import/gltf/draco.h"

#include <draco/compression/decode.h>

#include <cstdio>
#include <memory>
#include <new>

struct vlDraco {
  std::unique_ptr<draco::Mesh> mesh;
};

vlDraco *vl_draco_open(const uint8_t *data, size_t size, char *reason, size_t reason_size) {
  try {
    draco::DecoderBuffer buffer;
    draco::Decoder decoder;
    buffer.Init(reinterpret_cast<const char *>(data), size);
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) {
      std::snprintf(reason, reason_size, "%s", result.status().error_msg());
      return nullptr;
    }
    std::unique_ptr<vlDraco> made(new vlDraco);
    made->mesh = std::move(result).value();
    const uint32_t points = made->mesh->num_points();
    for (uint32_t i = 0; i < made->mesh->num_faces(); i++)
      for (int k = 0; k < 3; k++)
        if (made->mesh->face(draco::FaceIndex(i))[k].value() >= points) {
          std::snprintf(reason, reason_size, "a face names a point that is not there");
          return nullptr;
        }
    return made.release();
  } catch (const std::exception &e) {
    std::snprintf(reason, reason_size, "%s", e.what());
    return nullptr;
  }
}

void vl_draco_close(vlDraco *mesh) {
  delete mesh;
}

uint32_t vl_draco_faces(const vlDraco *mesh) {
  return mesh->mesh->num_faces();
}

uint32_t vl_draco_points(const vlDraco *mesh) {
  return mesh->mesh->num_points();
}

void vl_draco_indices(const vlDraco *mesh, uint32_t *indices) {
  for (uint32_t i = 0; i < mesh->mesh->num_faces(); i++)
    for (int k = 0; k < 3; k++) indices[3 * (size_t)i + k] = mesh->mesh->face(draco::FaceIndex(i))[k].value();
}

template <typename T>
static bool convert(const vlDraco *mesh, const draco::PointAttribute *a, uint32_t components, void *values) {
  T *out = static_cast<T *>(values);
  for (uint32_t i = 0; i < mesh->mesh->num_points(); i++) {
    const draco::AttributeValueIndex index = a->mapped_index(draco::PointIndex(i));
    if (index.value() >= a->size()) return false;
    if (!a->ConvertValue<T>(index, static_cast<int8_t>(components), out + (size_t)i * components)) return false;
  }
  return true;
}

bool vl_draco_values(const vlDraco *mesh, uint32_t id, uint32_t type, uint32_t components, void *values) {
  const draco::PointAttribute *a = mesh->mesh->GetAttributeByUniqueId(id);
  if (!a || components > 16) return false;
  switch (type) {
    case 5120: return convert<int8_t>(mesh, a, components, values);
    case 5121: return convert<uint8_t>(mesh, a, components, values);
    case 5122: return convert<int16_t>(mesh, a, components, values);
    case 5123: return convert<uint16_t>(mesh, a, components, values);
    case 5125: return convert<uint32_t>(mesh, a, components, values);
    case 5126: return convert<float>(mesh, a, components, values);
    default: return false;
  }
}
