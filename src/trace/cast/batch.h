/* trace/cast/batch.h: a batch of the caller's own rays, and their hits. */
#ifndef TRACE_CAST_BATCH_H
#define TRACE_CAST_BATCH_H

#include "trace/trace.h"

/* Rays that are not traced: origins that are farther away than this along an axis, directions
 * with a larger component. */
#define VL_CAST_FAR 1.8e18
#define VL_MAX_CAST_LENGTH 1e300

/* Rays and their hits; n <= VL_BATCH. */
typedef struct vlCastBatch {
  uint32_t n;
  /* The rays: as the caller gives them; `prepare` makes the directions unit. */
  double o[3][VL_ROW_SIZE], d[3][VL_ROW_SIZE];
  double length[VL_ROW_SIZE]; /* of the caller's directions; by `prepare` */
  double end[VL_ROW_SIZE];   /* the largest t, in lengths of the direction; `prepare`: distance;
                                inclusive */
  double start[VL_ROW_SIZE]; /* the smallest t; `prepare`: distance */
  float time[VL_ROW_SIZE];   /* the world's time */
  bool finite_ends;          /* some end is finite; by `prepare` */
  bool coherent; /* neighbouring rays are similar, and are traced as packets; by `prepare` */
  /* Rows for the accelerator, by `prepare`. t_min: `next` moves it past the hit. */
  float t_min[VL_ROW_SIZE], t_max[VL_ROW_SIZE];
  /* The hits, by `next`: indices; shape VL_NONE: none. */
  uint32_t shape[VL_ROW_SIZE], prim[VL_ROW_SIZE], instance[VL_ROW_SIZE];
  double distance[VL_ROW_SIZE], t[VL_ROW_SIZE]; /* t in lengths of the caller's direction */
  float normal[3][VL_ROW_SIZE], shading[3][VL_ROW_SIZE], uv[2][VL_ROW_SIZE];
  double velocity[3][VL_ROW_SIZE];
  uint8_t occluded[VL_ROW_SIZE];
} vlCastBatch;

#endif
