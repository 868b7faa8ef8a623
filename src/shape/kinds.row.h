/* shape/kinds.row.h: what each kind of shape has, by its full names: its row (the file
 * NAME.row.c), its box in shape space, and its functions (shape_kind.h). */
#ifndef SHAPE_KINDS_ROW_H
#define SHAPE_KINDS_ROW_H

/* X(kind, row, box, functions) */
#define VL_SHAPE_FUNCTIONS(X)                                                                \
  X(VL_SHAPE_TRIANGLES, vl_shape_row_triangles, vl_shape_box_points, vl_triangles_functions) \
  X(VL_SHAPE_BILINEAR, vl_shape_row_bilinear, vl_shape_box_points, vl_bilinear_functions)    \
  X(VL_SHAPE_SPHERE, vl_shape_row_sphere, vl_shape_box_sphere, vl_quadric_functions)         \
  X(VL_SHAPE_DISK, vl_shape_row_disk, vl_shape_box_disk, vl_quadric_functions)               \
  X(VL_SHAPE_CYLINDER, vl_shape_row_cylinder, vl_shape_box_cylinder, vl_quadric_functions)   \
  X(VL_SHAPE_CURVES, vl_shape_row_curves, vl_shape_box_points, vl_curves_functions)

#endif
