/* sampler/kinds.row.h: what each kind of sampler has, by its full names: its row (the file
 * NAME.row.c), and two kernels (NAME.hot.c): numbers of one and of two dimensions. */
#ifndef SAMPLER_KINDS_ROW_H
#define SAMPLER_KINDS_ROW_H

/* X(kind, row, one, two) */
#define VL_SAMPLER_FUNCTIONS(X)                                                               \
  X(VL_SAMPLER_INDEPENDENT, vl_sampler_row_independent, vl_sampler_independent_1d,            \
    vl_sampler_independent_2d)                                                                \
  X(VL_SAMPLER_REGULAR, vl_sampler_row_regular, vl_sampler_regular_1d, vl_sampler_regular_2d) \
  X(VL_SAMPLER_STRATIFIED, vl_sampler_row_stratified, vl_sampler_stratified_1d,               \
    vl_sampler_stratified_2d)                                                                 \
  X(VL_SAMPLER_NROOKS, vl_sampler_row_nrooks, vl_sampler_stratified_1d, vl_sampler_nrooks_2d) \
  X(VL_SAMPLER_MULTI_JITTERED, vl_sampler_row_multi_jittered, vl_sampler_stratified_1d,       \
    vl_sampler_multi_jittered_2d)                                                             \
  X(VL_SAMPLER_HAMMERSLEY, vl_sampler_row_hammersley, vl_sampler_stratified_1d,               \
    vl_sampler_hammersley_2d)                                                                 \
  X(VL_SAMPLER_HALTON, vl_sampler_row_halton, vl_sampler_halton_1d, vl_sampler_halton_2d)     \
  X(VL_SAMPLER_SOBOL, vl_sampler_row_sobol, vl_sampler_sobol_1d, vl_sampler_sobol_2d)         \
  X(VL_SAMPLER_ZSOBOL, vl_sampler_row_zsobol, vl_sampler_zsobol_1d, vl_sampler_zsobol_2d)

#endif
