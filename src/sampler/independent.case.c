/* sampler/independent.case.c: what tests know of the sampler independent. */
#include "sampler/sampler.case.h"

const SamplerCase independent_sampler = {.hash = true, .open = true};
