/* filter/kinds.row.h: what each kind of pixel filter has, by its full names: its row (the file
 * NAME.row.c) and its value at a distance from the centre (NAME.c). */
#ifndef FILTER_KINDS_ROW_H
#define FILTER_KINDS_ROW_H

/* X(kind, row, value) */
#define VL_PIXEL_FILTER_FUNCTIONS(X)                                            \
  X(VL_PIXEL_FILTER_BOX, vl_filter_row_box, vl_filter_value_box)                \
  X(VL_PIXEL_FILTER_TRIANGLE, vl_filter_row_triangle, vl_filter_value_triangle) \
  X(VL_PIXEL_FILTER_GAUSSIAN, vl_filter_row_gaussian, vl_filter_value_gaussian) \
  X(VL_PIXEL_FILTER_MITCHELL, vl_filter_row_mitchell, vl_filter_value_mitchell) \
  X(VL_PIXEL_FILTER_LANCZOS, vl_filter_row_lanczos, vl_filter_value_lanczos)    \
  X(VL_PIXEL_FILTER_BLACKMAN_HARRIS, vl_filter_row_blackman_harris,             \
    vl_filter_value_blackman_harris)

#endif
