/* medium/kinds.row.h: what each kind of medium has, by its full names: its row (the file
 * NAME.row.c), its compile function (NAME.c), and the density that multiplies its coefficients
 * (NAME.hot.c). */
#ifndef MEDIUM_KINDS_ROW_H
#define MEDIUM_KINDS_ROW_H

/* X(kind, row, compile, density) */
#define VL_MEDIUM_FUNCTIONS(X)                                                              \
  X(VL_MEDIUM_HOMOGENEOUS, vl_medium_row_homogeneous, vl_compile_medium_homogeneous,        \
    vl_medium_density_one)                                                                  \
  X(VL_MEDIUM_GRID, vl_medium_row_grid, vl_compile_medium_grid, vl_medium_density_grid)     \
  X(VL_MEDIUM_RGB_GRID, vl_medium_row_rgb_grid, vl_compile_medium_rgb_grid,                 \
    vl_medium_density_one)                                                                  \
  X(VL_MEDIUM_CLOUD, vl_medium_row_cloud, vl_compile_medium_cloud, vl_medium_density_cloud) \
  X(VL_MEDIUM_NANOVDB, vl_medium_row_nanovdb, vl_compile_medium_nanovdb,                    \
    vl_medium_density_nanovdb)

#endif
