/* sampler/sobol.case.c: what tests know of the sampler sobol. */
#include "sampler/sampler.case.h"

const SamplerCase sobol_sampler = {
    .rows = true, .cells = true, .scattered = true, .open = true};
