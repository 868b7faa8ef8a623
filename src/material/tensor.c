/* material/tensor.c: reads files of named arrays (tensor.h has the layout). */
#include "material/tensor.h"

#include <string.h>

#include "base/error.h"
#include "base/file.h"

static const char magic[12] = "tensor_file";

/* The unread rest of the header. `taken` becomes false at the first value that is missing. */
typedef struct Reader {
  const char *at, *end;
  bool taken;
} Reader;

static uint64_t take(Reader *r, size_t bytes) {
  uint64_t value = 0;
  if ((size_t)(r->end - r->at) < bytes)
    r->taken = false;
  if (!r->taken)
    return 0;
  for (size_t i = 0; i < bytes; i++)
    value |= (uint64_t)(unsigned char)r->at[i] << (8 * i);
  r->at += bytes;
  return value;
}

static size_t type_size(uint32_t type) { /* u8, i8, u16, i16, ..., u64, i64, f16, f32, f64 */
  static const unsigned char sizes[12] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  return type < 12 ? sizes[type] : 0;
}

static vlResult cut(const char *path, vlError *error) {
  return vl_fail(error, VL_ERROR_SCENE,
                 "%s: the tensor file is damaged: it ends before what it announces", path);
}

static vlResult read_field(const vlTensor *t, const char *path, Reader *r, vlTensorField *f,
                           vlError *error) {
  f->name_size = (size_t)take(r, 2);
  if ((size_t)(r->end - r->at) < f->name_size)
    return cut(path, error);
  f->name = r->at;
  r->at += f->name_size;
  f->rank = (uint32_t)take(r, 2);
  f->type = (uint32_t)take(r, 1);
  uint64_t offset = take(r, 8);
  if (!r->taken)
    return cut(path, error);
  size_t size = type_size(f->type);
  if (size == 0)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: the tensor file is damaged: a field is of the unknown type %u", path,
                   f->type);
  if (f->rank > VL_MAX_TENSOR_RANK)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: the tensor file is damaged: a field has %u dimensions", path, f->rank);
  f->count = 1;
  for (uint32_t i = 0; i < f->rank; i++) {
    f->shape[i] = take(r, 8);
    if (f->shape[i] != 0 && f->count > UINT64_MAX / f->shape[i])
      return cut(path, error);
    f->count *= f->shape[i];
  }
  if (!r->taken || offset > t->size || f->count > (t->size - offset) / size)
    return cut(path, error);
  f->values = t->data + offset;
  return VL_OK;
}

vlResult vl_tensor_read(vlContext *context, const char *path, vlTensor *tensor,
                        vlError *error) {
  memset(tensor, 0, sizeof *tensor);
  vlResult result = vl_file_read(context, path, false, &tensor->data, &tensor->size, error);
  if (result != VL_OK) {
    tensor->data = NULL;
    return result;
  }
  Reader r = {tensor->data, tensor->data + tensor->size, true};
  uint32_t count = 0;
  if (tensor->size < sizeof magic || memcmp(tensor->data, magic, sizeof magic) != 0) {
    result = vl_fail(error, VL_ERROR_SCENE,
                     "%s: this is no tensor file (of the RGL material database)", path);
  } else {
    r.at += sizeof magic;
    uint32_t major = (uint32_t)take(&r, 1), minor = (uint32_t)take(&r, 1);
    count = (uint32_t)take(&r, 4);
    if (!r.taken)
      result = cut(path, error);
    else if (major != 1 || minor != 0)
      result = vl_fail(error, VL_ERROR_SCENE,
                       "%s: tensor files of version %u.%u are not understood (known: 1.0)",
                       path, major, minor);
    else if (count > VL_MAX_TENSOR_FIELDS)
      result = vl_fail(error, VL_ERROR_SCENE,
                       "%s: the tensor file is damaged: it announces %u fields", path, count);
  }
  for (uint32_t i = 0; result == VL_OK && i < count; i++) {
    vlTensorField *f = &tensor->fields[i];
    result = read_field(tensor, path, &r, f, error);
    for (uint32_t k = 0; result == VL_OK && k < i; k++)
      if (tensor->fields[k].name_size == f->name_size &&
          memcmp(tensor->fields[k].name, f->name, f->name_size) == 0)
        result = vl_fail(error, VL_ERROR_SCENE,
                         "%s: the tensor file is damaged: it has the same field twice", path);
    tensor->count++;
  }
  if (result != VL_OK)
    vl_tensor_free(context, tensor);
  return result;
}

void vl_tensor_free(vlContext *context, vlTensor *tensor) {
  vl_free(context, tensor->data);
  memset(tensor, 0, sizeof *tensor);
}

const vlTensorField *vl_tensor_find(const vlTensor *tensor, const char *name) {
  for (uint32_t i = 0; i < tensor->count; i++)
    if (tensor->fields[i].name_size == strlen(name) &&
        memcmp(tensor->fields[i].name, name, tensor->fields[i].name_size) == 0)
      return &tensor->fields[i];
  return NULL;
}
