/* sampler/regular.case.c: what tests know of the sampler regular. */
#include "sampler/sampler.case.h"

const SamplerCase regular_sampler = {.cells = true, .centre = true, .any_count = true};
