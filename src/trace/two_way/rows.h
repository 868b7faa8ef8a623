/* trace/two_way/rows.h: the arrays that the stages of the two-way tracers exchange, besides
 * those of trace/rows.h. */
#ifndef TRACE_TWO_WAY_ROWS_H
#define TRACE_TWO_WAY_ROWS_H

#include "trace/medium/rows.h"
#include "trace/rows.h"
#include "trace/two_way/two_way.h"

enum { VL_MERGE_PAIRS = 4 * VL_BATCH };

/* What a path carries, by lane: the path's element of the batch, which sorting does not change.
 */
typedef struct vlTwoWayLanes {
  VL_ROW float carry[VL_ROW_SIZE]; /* (S + H) cos / fwd of the previous vertex; two_way.h */
  VL_ROW float link[VL_ROW_SIZE]; /* C / fwd of the previous vertex, or 0 if the edge from there
                                     cannot be a connection */
  VL_ROW uint32_t group[VL_ROW_SIZE]; /* of a camera path: vlLightVertices; remains 0 where all
                                         have the same */
  union {
    struct {                               /* camera paths */
      VL_ROW uint32_t smooth[VL_ROW_SIZE]; /* vertices not counted as bounces: vlTwoWay.apart */
      VL_ROW float area[3][VL_ROW_SIZE];   /* of one's own camera: vlCameraSample.area; 0: not
                                              connected */
    };
    struct {                             /* light paths */
      VL_ROW float flux[4][VL_ROW_SIZE]; /* at the start; beta starts from 1 */
      VL_ROW float lambda[4][VL_ROW_SIZE], inv_pdf[4][VL_ROW_SIZE]; /* of the wavelengths */
      VL_ROW uint32_t light[VL_ROW_SIZE];
      VL_ROW float density[VL_ROW_SIZE]; /* vl_emission_density of the first ray */
      /* point on the light, or direction of an infinite light; the light's normal there */
      VL_ROW float lx[VL_ROW_SIZE], ly[VL_ROW_SIZE], lz[VL_ROW_SIZE];
      VL_ROW float lnx[VL_ROW_SIZE], lny[VL_ROW_SIZE], lnz[VL_ROW_SIZE];
    };
  };
} vlTwoWayLanes;

/* The strategies that begin on the path's own side, by vertex: S = a rev + b (two_way.h). */
typedef struct vlWays {
  VL_ROW float a[VL_ROW_SIZE], b[VL_ROW_SIZE];
  VL_ROW float cosine[VL_ROW_SIZE]; /* between the incoming ray and the geometric normal; in
                                       media: the extinction */
} vlWays;

/* By shadow ray: the density of the strategy that has made it, and of the others. */
typedef struct vlStrategies {
  VL_ROW float own[VL_ROW_SIZE], others[VL_ROW_SIZE];
} vlStrategies;

/* The photons of n vertices, grouped by vertex: `count` of them from pair[first] on. */
typedef struct vlMergeList {
  VL_ROW uint32_t first[VL_ROW_SIZE], count[VL_ROW_SIZE];
  uint32_t pair[VL_MERGE_PAIRS]; /* indices of photons */
} vlMergeList;

/* By shadow ray towards the camera: its film point. Then, by splat, the arguments of
 * vlLightBatch.splat. */
typedef struct vlSplatRows {
  VL_ROW float x[VL_ROW_SIZE], y[VL_ROW_SIZE];
  VL_ROW float value[4][VL_ROW_SIZE], lambda[4][VL_ROW_SIZE], inv_pdf[4][VL_ROW_SIZE];
} vlSplatRows;

/* Where light paths start, by ray. */
typedef struct vlLightStarts {
  VL_ROW float area_pdf[VL_ROW_SIZE], offset[VL_ROW_SIZE], side[VL_ROW_SIZE],
      share[VL_ROW_SIZE];              /* vlEmission */
  VL_ROW uint32_t medium[VL_ROW_SIZE]; /* by lane */
} vlLightStarts;

/* A worker's memory. */
typedef struct vlTwoWayRows {
  vlTwoWayLanes lanes;
  vlWays ways;             /* of vlTraceScratch.at or of vlVolumeScratch.scattered */
  vlBsdfValues back;       /* vl_stage_reverse */
  vlStrategies strategies; /* of vlTraceScratch.shadow */
  vlCameraSample views[VL_BATCH];
  union {
    vlMergeList list; /* camera paths */
    struct {          /* light paths */
      vlSplatRows splats;
      union { /* one after the other */
        vlLightStarts starts;
        struct {
          VL_ROW uint32_t passed[VL_ROW_SIZE]; /* of the vertices */
          union {
            vlPhoton photons[VL_BATCH];
            vlLightVertex vertices[VL_BATCH];
          };
        };
      };
      VL_ROW float unused[4][VL_ROW_SIZE]; /* radiance that the stages add */
    };
  };
} vlTwoWayRows;

#endif
