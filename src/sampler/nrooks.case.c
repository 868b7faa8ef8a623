/* sampler/nrooks.case.c: what tests know of the sampler nrooks. */
#include "sampler/sampler.case.h"

const SamplerCase nrooks_sampler = {.rows = true, .any_count = true, .scattered = true};
