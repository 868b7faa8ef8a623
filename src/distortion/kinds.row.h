/* distortion/kinds.row.h: what each kind of distortion has, by its full names: its row (the
 * file NAME.row.c) and its compile function (NAME.c). */
#ifndef DISTORTION_KINDS_ROW_H
#define DISTORTION_KINDS_ROW_H

/* X(kind, row, compile) */
#define VL_DISTORTION_FUNCTIONS(X)                                                            \
  X(VL_DISTORTION_NONE, vl_distortion_row_none, vl_distortion_compile_none)                   \
  X(VL_DISTORTION_OPENCV, vl_distortion_row_opencv, vl_distortion_compile_opencv)             \
  X(VL_DISTORTION_RADIAL, vl_distortion_row_radial, vl_distortion_compile_radial)             \
  X(VL_DISTORTION_THIN_PRISM, vl_distortion_row_thin_prism, vl_distortion_compile_thin_prism) \
  X(VL_DISTORTION_RAD_TAN_THIN_PRISM, vl_distortion_row_rad_tan_thin_prism,                   \
    vl_distortion_compile_rad_tan_thin_prism)

#endif
