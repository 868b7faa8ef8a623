/* sampler/multi_jittered.case.c: what tests know of the sampler multi jittered. */
#include "sampler/sampler.case.h"

const SamplerCase multi_jittered_sampler = {.rows = true, .cells = true, .scattered = true};
