/* camera_files/numpy.c: arrays in NumPy's files (NumPy's documentation, numpy.lib.format). */
#include "camera_files/numpy.h"

#include <stdlib.h>
#include <string.h>

#include "base/bytes.h"
#include "base/text.h"

bool vl_numpy_open(const char *text, size_t size, vlNumpyArray *array) {
  enum { MAX_HEADER = 512 };
  char header[MAX_HEADER + 16] = "";
  if (size < 12 || memcmp(text, "\x93NUMPY", 6) != 0)
    return false;
  /* format 1 gives the length of the header in 2 bytes, later formats in 4 */
  const size_t start = text[6] == 1 ? 10 : 12, length = vl_little(text + 8, start - 8);
  if (length >= MAX_HEADER || start + length > size)
    return false;
  memcpy(header, text + start, length);
  const char *shape = strstr(header, "'shape': ("), *type = strstr(header, "'descr': '<");
  if (!shape || !type || !vl_has_word_of("f4 f8 i4 i8", type + 11, 2) || type[13] != '\'')
    return false;
  *array = (vlNumpyArray){.data = text + start + length,
                          .count = 1,
                          .sides = {1, 1},
                          .bytes = type[12] == '8' ? 8 : 4,
                          .whole = type[11] == 'i',
                          .by_columns = strstr(header, "'fortran_order': True") != NULL};
  const size_t max = (size - start - length) / array->bytes;
  for (char *at = (char *)shape + 10, *end; *at != ')'; at = end + strspn(end, ", ")) {
    const unsigned long side = strtoul(at, &end, 10);
    if (end == at || side < 1 || side > max / array->count)
      return false;
    if (array->dimensions < 2)
      array->sides[array->dimensions] = side;
    array->dimensions++;
    array->count *= side;
  }
  return max > 0 && !(array->by_columns && array->dimensions > 2);
}

double vl_numpy_at(const vlNumpyArray *array, size_t index) {
  const size_t rows = array->sides[0], columns = array->sides[1];
  const size_t at = array->by_columns ? index % columns * rows + index / columns : index;
  const uint64_t bits = vl_little(array->data + at * array->bytes, array->bytes);
  const uint32_t low = (uint32_t)bits;
  const bool wide = array->bytes == 8;
  float narrow;
  double value;
  memcpy(&narrow, &low, sizeof narrow);
  memcpy(&value, &bits, sizeof value);
  if (array->whole)
    return wide ? (double)(int64_t)bits : (double)(int32_t)low;
  return wide ? value : (double)narrow;
}
