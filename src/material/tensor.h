/* material/tensor.h: reads files of named arrays ("tensor_file", version 1.0), the format
 * in which the RGL material database (Dupuy and Jakob 2018) stores its measurements.
 * Little-endian: 12 bytes "tensor_file\0", two bytes of version, a 32-bit count of fields; then
 * for each field the 16-bit length of its name, the name, a 16-bit rank, an 8-bit type, a
 * 64-bit offset of the values from the file's start, and a 64-bit size for each dimension. The
 * last dimension is contiguous. The values may lie anywhere in the file. All sizes and offsets
 * are checked against the file's size. */
#ifndef MATERIAL_TENSOR_H
#define MATERIAL_TENSOR_H

#include "base/context.h"

enum { VL_MAX_TENSOR_FIELDS = 64, VL_MAX_TENSOR_RANK = 8 };

/* The types that velo reads; the format has 11 of them. */
enum { VL_TENSOR_U8 = 1, VL_TENSOR_F32 = 10 };

typedef struct vlTensorField {
  const char *name; /* name_size bytes, not zero-terminated */
  size_t name_size;
  uint32_t type, rank;
  uint64_t shape[VL_MAX_TENSOR_RANK];
  uint64_t count;     /* number of values; all of them lie within the file */
  const char *values; /* unaligned */
} vlTensorField;

typedef struct vlTensor {
  char *data; /* the whole file */
  size_t size;
  uint32_t count;
  vlTensorField fields[VL_MAX_TENSOR_FIELDS];
} vlTensor;

/* Reads a file. Errors: MISSING, IO, MEMORY; SCENE if the file is damaged (the message names
 * the file). On error tensor is empty. */
vlResult vl_tensor_read(vlContext *context, const char *path, vlTensor *tensor, vlError *error);
void vl_tensor_free(vlContext *context, vlTensor *tensor);
/* Finds a field by its name. Null if there is none. */
const vlTensorField *vl_tensor_find(const vlTensor *tensor, const char *name);

#endif
