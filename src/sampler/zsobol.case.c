/* sampler/zsobol.case.c: what tests know of the sampler zsobol. */
#include "sampler/sampler.case.h"

const SamplerCase zsobol_sampler = {
    .rows = true, .cells = true, .curve = true, .scattered = true, .open = true};
