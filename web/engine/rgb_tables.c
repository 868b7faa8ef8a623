/* engine/rgb_tables.c: in WebAssembly, the coefficient tables of src/color/rgb_table.h come
 * from JavaScript, each when the first scene needs it. */
#include <stddef.h>
#include <stdlib.h>

#include "color/color.h"
#include "color/rgb_table.h"

/* web/engine/rgb_tables.js: copies the table to memory. If the table is not there yet, it
 * throws, which ends this instance of the program; the caller fetches the table and begins
 * anew. */
extern void velo_copy_rgb_table(int space, float *coefficients, size_t size);

enum { COEFFICIENTS = 3 * VL_RGB_TABLE_Z * VL_RGB_TABLE_XY * VL_RGB_TABLE_XY * 3 };

const vlRgbTable *vl_rgb_table(vlColorSpace space) {
  static float memory[4][COEFFICIENTS];
  static vlRgbTable tables[4];
  vlRgbTable *table = &tables[(unsigned)space < 4 ? space : VL_SPACE_SRGB];
  if (!table->coefficients) {
    float *coefficients = memory[table - tables];
    velo_copy_rgb_table((int)(table - tables), coefficients, sizeof memory[0]);
    table->coefficients = coefficients;
  }
  return table;
}
