/* sampler/stratified.case.c: what tests know of the sampler stratified. */
#include "sampler/sampler.case.h"

const SamplerCase stratified_sampler = {.cells = true, .any_count = true, .scattered = true};
