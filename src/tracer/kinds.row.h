/* tracer/kinds.row.h: what each kind of tracer has, by its full names: its row (the file
 * NAME.row.c), and the function that traces a batch. Those of light paths share one. */
#ifndef TRACER_KINDS_ROW_H
#define TRACER_KINDS_ROW_H

/* X(kind, row, trace) */
#define VL_TRACER_FUNCTIONS(X)                                                                \
  X(VL_TRACER_PATH, vl_tracer_row_path, vl_trace_path)                                        \
  X(VL_TRACER_VOLPATH, vl_tracer_row_volpath, vl_trace_volpath)                               \
  X(VL_TRACER_RAYCAST, vl_tracer_row_raycast, vl_trace_raycast)                               \
  X(VL_TRACER_AMBIENT_OCCLUSION, vl_tracer_row_ambient_occlusion, vl_trace_ambient_occlusion) \
  X(VL_TRACER_BIDIRECTIONAL, vl_tracer_row_bidirectional, vl_trace_path)                      \
  X(VL_TRACER_MERGING, vl_tracer_row_merging, vl_trace_path)                                  \
  X(VL_TRACER_SPPM, vl_tracer_row_sppm, vl_trace_path)                                        \
  X(VL_TRACER_LIGHT_PATH, vl_tracer_row_light_path, vl_trace_path)                            \
  X(VL_TRACER_RANDOM_WALK, vl_tracer_row_random_walk, vl_trace_random_walk)

#endif
