/* trace/ground_truth/scratch.h: working memory of channels.hot.c; private to trace. */
#ifndef TRACE_GROUND_TRUTH_SCRATCH_H
#define TRACE_GROUND_TRUTH_SCRATCH_H

#include "trace/ground_truth/ground_truth.h"
#include "trace/stages.h"

struct vlGroundTruthScratch {
  vlTraceScratch trace;
  /* radiance output of the stages; its values are not used */
  VL_ROW float light[4][VL_ROW_SIZE];
  VL_ROW float time[VL_ROW_SIZE];
  VL_ROW float albedo[3][VL_ROW_SIZE]; /* by path */
  VL_ROW float kept[6][VL_ROW_SIZE]; /* shading normal and dpdu without bump and normal maps */
};

#endif
