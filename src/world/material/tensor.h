/* world/material/tensor.h: reads files of named arrays ("tensor_file", version 1.0), the format in which the RGL
 * material database (Dupuy and Jakob 2018) stores its measurements. Little-endian: 12 bytes "tensor_file\0", two of
 * version, a 32-bit count; for each field a 16-bit length and its name, a 16-bit rank, an 8-bit type, a 64-bit
 * offset from the file's start and a 64-bit size for each dimension, the last of them contiguous. The values may lie
 * anywhere in the file. All sizes and offsets are checked against the file's size. */
#ifndef WORLD_MATERIAL_TENSOR_H
#define WORLD_MATERIAL_TENSOR_H

#include "base/context.h"

enum { VL_TENSOR_FIELDS = 64, VL_TENSOR_RANK = 8 };

/* The types that velo reads; the format has 11 of them. */
enum { VL_TENSOR_U8 = 1, VL_TENSOR_F32 = 10 };

typedef struct vlTensorField {
  const char *name; /* name_size bytes, not zero-terminated */
  size_t name_size;
  uint32_t type, rank;
  uint64_t shape[VL_TENSOR_RANK];
  uint64_t count;     /* number of values; all of them lie within the file */
  const char *values; /* unaligned */
} vlTensorField;

typedef struct vlTensor {
  char *data; /* the whole file */
  size_t size;
  uint32_t count;
  vlTensorField fields[VL_TENSOR_FIELDS];
} vlTensor;

/* Errors: MISSING, IO, MEMORY; SCENE if the file is damaged (the message names the file). On error tensor is empty. */
vlResult vl_tensor_read(vlContext *context, const char *path, vlTensor *tensor, vlError *error);
void vl_tensor_free(vlContext *context, vlTensor *tensor);
/* Null if there is no field of that name. */
const vlTensorField *vl_tensor_find(const vlTensor *tensor, const char *name);

#endif
