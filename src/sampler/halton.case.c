/* sampler/halton.case.c: what tests know of the sampler halton. */
#include "sampler/sampler.case.h"

const SamplerCase halton_sampler = {.scattered = true, .open = true};
