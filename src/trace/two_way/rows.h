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
  vlFloatRow carry; /* (S + H) cos / fwd of the previous vertex; two_way.h */
  vlFloatRow link;  /* C / fwd of the previous vertex, or 0 if the edge from there cannot be a
                       connection */
  vlUintRow group;  /* of a camera path: vlLightVertices; remains 0 where all have the same */
  union {
    struct {              /* camera paths */
      vlUintRow smooth;   /* vertices not counted as bounces: vlTwoWay.apart */
      vlFloatRow area[3]; /* of one's own camera: vlCameraSample.area; 0: not connected */
    };
    struct {                            /* light paths */
      vlFloatRow flux[4];               /* at the start; beta starts from 1 */
      vlFloatRow lambda[4], inv_pdf[4]; /* of the wavelengths */
      vlUintRow light;
      vlFloatRow density; /* vl_emission_density of the first ray */
      /* point on the light, or direction of an infinite light; the light's normal there */
      vlVec3Row l, ln;
    };
  };
} vlTwoWayLanes;

/* The strategies that begin on the path's own side, by vertex: S = a rev + b (two_way.h). */
typedef struct vlWays {
  vlFloatRow a, b;
  vlFloatRow cosine; /* between the incoming ray and the geometric normal; in media: the
                        extinction */
} vlWays;

/* By shadow ray: the density of the strategy that has made it, and of the others. */
typedef struct vlStrategies {
  vlFloatRow own, others;
} vlStrategies;

/* The photons of n vertices, grouped by vertex: `count` of them from pair[first] on. */
typedef struct vlMergeList {
  vlUintRow first, count;
  uint32_t pair[VL_MERGE_PAIRS]; /* indices of photons */
} vlMergeList;

/* By shadow ray towards the camera: its film point. Then, by splat, the arguments of
 * vlLightBatch.splat. */
typedef struct vlSplatRows {
  vlFloatRow x, y;
  vlFloatRow value[4], lambda[4], inv_pdf[4];
} vlSplatRows;

/* Where light paths start, by ray. */
typedef struct vlLightStarts {
  vlFloatRow area_pdf, offset, side, share; /* vlEmission */
  vlUintRow medium;                         /* by lane */
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
          vlUintRow passed; /* of the vertices */
          union {
            vlPhoton photons[VL_BATCH];
            vlLightVertex vertices[VL_BATCH];
          };
        };
      };
      vlFloatRow unused[4]; /* radiance that the stages add */
    };
  };
} vlTwoWayRows;

#endif
