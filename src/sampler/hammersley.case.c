/* sampler/hammersley.case.c: what tests know of the sampler hammersley. */
#include "sampler/sampler.case.h"

const SamplerCase hammersley_sampler = {.rows = true, .cells = true, .scattered = true};
