/* light/kinds.row.h: what each kind of light has, by its full names: its row and its power (the
 * file NAME.row.c), its compile function (NAME.c), and three kernels (NAME.hot.c): a sample of
 * the light from a point, a ray that leaves the light, and the density of such rays. */
#ifndef LIGHT_KINDS_ROW_H
#define LIGHT_KINDS_ROW_H

/* X(kind, row, power, compile, sample, emit, density) */
#define VL_LIGHT_FUNCTIONS(X)                                                                 \
  X(VL_LIGHT_POINT, vl_light_row_point, vl_light_power_point, vl_compile_light_point,         \
    vl_light_sample_point, vl_light_emit_point, vl_light_emit_pdf_point)                      \
  X(VL_LIGHT_SPOT, vl_light_row_spot, vl_light_power_spot, vl_compile_light_spot,             \
    vl_light_sample_spot, vl_light_emit_spot, vl_light_emit_pdf_spot)                         \
  X(VL_LIGHT_DISTANT, vl_light_row_distant, vl_light_power_distant, vl_compile_light_distant, \
    vl_light_sample_distant, vl_light_emit_distant, vl_light_emit_pdf_distant)                \
  X(VL_LIGHT_INFINITE, vl_light_row_infinite, vl_light_power_infinite,                        \
    vl_compile_light_infinite, vl_light_sample_infinite, vl_light_emit_infinite,              \
    vl_light_emit_pdf_infinite)                                                               \
  X(VL_LIGHT_GONIOMETRIC, vl_light_row_goniometric, vl_light_power_unknown,                   \
    vl_compile_light_goniometric, vl_light_sample_goniometric, vl_light_emit_goniometric,     \
    vl_light_emit_pdf_goniometric)                                                            \
  X(VL_LIGHT_PROJECTION, vl_light_row_projection, vl_light_power_unknown,                     \
    vl_compile_light_projection, vl_light_sample_projection, vl_light_emit_projection,        \
    vl_light_emit_pdf_projection)

#endif
