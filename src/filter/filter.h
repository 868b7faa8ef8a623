/* filter/filter.h: a pixel filter compiled for sampling. Filters are even products f(x) f(y).
 * Half an axis is described by the inverse of the cumulated |f|. It is divided into segments:
 * the lobes (f's sign is constant in each), divided again near ends where f touches zero
 * without a change of sign. A segment has bins of equal mass; within a bin the density is
 * linear from f at one edge to f at the other. */
#ifndef FILTER_FILTER_H
#define FILTER_FILTER_H

#include "film/film.h"
#include "velo/filter_kinds.h"

enum { VL_FILTER_SEGMENTS = 240, VL_FILTER_EDGES = 12288 };

typedef struct vlFilterAxis {
  float radius;
  uint32_t segments, edges;         /* none for the analytic filters */
  float start[VL_FILTER_SEGMENTS];  /* mass before the segment; the half axis has mass 1 */
  float scale[VL_FILTER_SEGMENTS];  /* bins per unit of mass */
  float sign[VL_FILTER_SEGMENTS];   /* the weight: +- integral of |f| / integral of f */
  int32_t base[VL_FILTER_SEGMENTS]; /* first edge */
  int32_t last[VL_FILTER_SEGMENTS]; /* index of the last bin in the segment */
  float x[VL_FILTER_EDGES];
  float f[VL_FILTER_EDGES]; /* |f(x)|, not normalised */
} vlFilterAxis;

/* The filter along an axis, at equal steps from 0 to its radius, scaled to an integral of 1. */
enum { VL_FILTER_STEPS = 1024 }; /* per pixel: linear interpolation is exact to 1e-6 */
struct vlFilterCurve {
  float *values;
  float steps, per_step; /* number of steps, and steps per pixel */
};

struct vlFilterTable {
  vlPixelFilterKind kind;
  vlFilterAxis axis[2];
  vlFilterCurve curve[2]; /* along x and y; both have the same values if the radii are equal */
};

/* Errors: ARGUMENT if the parameters are not valid (those that the row of the kind allows
 * are), or it has no mass; MEMORY. */
vlResult vl_filter_compile(vlContext *context, const vlPixelFilter *filter,
                           vlFilterTable *table);
/* A table of zeros is allowed. */
void vl_filter_free(vlContext *context, vlFilterTable *table);
/* f of one axis, not normalised; 0 outside the radius. */
double vl_filter_value(const vlPixelFilter *filter, int axis, double x);

/* |weight|, the same for every sample. */
static inline double vl_filter_weight(const vlFilterTable *filter) {
  double weight = 1;
  for (int i = 0; i < 2; i++)
    if (filter->axis[i].segments)
      weight *=
          filter->axis[i].sign[0] < 0 ? -filter->axis[i].sign[0] : filter->axis[i].sign[0];
  return weight;
}

/* The same bits as vlFilterKernels.curve. */
static inline float vl_filter_curve_at(const vlFilterCurve *c, float x) {
  float at = (x < 0.0f ? -x : x) * c->per_step, inside = at <= c->steps ? 1.0f : 0.0f;
  at = at < c->steps ? at : c->steps;
  int32_t k = (int32_t)at;
  return inside * (c->values[k] + (at - (float)k) * (c->values[k + 1] - c->values[k]));
}

#endif
