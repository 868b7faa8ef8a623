/* trace/ground_truth/scratch.h: working memory of channels.hot.c; private to trace. */
#ifndef TRACE_GROUND_TRUTH_SCRATCH_H
#define TRACE_GROUND_TRUTH_SCRATCH_H

#include "trace/ground_truth/ground_truth.h"
#include "trace/stages.h"

struct vlGroundTruthScratch {
  vlTraceScratch trace;
  /* radiance output of the stages; its values are not used */
  vlFloatRow light[4];
  vlFloatRow time;
  vlFloatRow albedo[3]; /* by path */
  vlFloatRow kept[6];   /* shading normal and dpdu without bump and normal maps */
};

#endif
