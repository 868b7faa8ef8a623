/* color/tables.h: the constant tables that tools/color_tables writes when velo is built. */
#ifndef COLOR_TABLES_H
#define COLOR_TABLES_H

#include "color/color.h"
#include "color/kernels.h"

typedef struct vlNamedTable {
  char name[24];
  double y; /* sum over all nm of Y times values */
  float values[VL_LAMBDA_COUNT];
} vlNamedTable;
extern const uint32_t vl_table_named_count;
extern const vlNamedTable vl_table_named[]; /* ascending by name */

typedef struct vlSpaceTable {
  double xy[8]; /* red, green, blue, white */
  double xyz_from_rgb[9], rgb_from_xyz[9];
  /* index into vl_table_named; its y equals that of the constant spectrum 1 */
  uint32_t illuminant;
} vlSpaceTable;
extern const vlSpaceTable vl_table_spaces[4];

/* CIE 15: S0, S1, S2 of daylight, 360 to 830 nm in steps of 10 nm. */
enum { VL_DAYLIGHT_COUNT = 48 };
extern const double vl_table_daylight[3][VL_DAYLIGHT_COUNT];

extern const double vl_table_y_integral; /* sum of Y over all nm */
extern const float vl_table_cie[3][VL_LAMBDA_COUNT];

#endif
