/* sampler/sampler.row.c: the family of samplers: the list of its rows, each from the file of
 * its kind. */
#include "sampler/sampler.row.h"

#include "sampler/kinds.row.h"
#include "velo/sampler.h"

const char *const vl_sampler_randomizations[] = {"none", "permutedigits", "fastowen", "owen",
                                                 NULL};

VL_SAMPLER_FUNCTIONS(VL_DECLARE_ROW)
const vlKindFamily vl_sampler_family = VL_KIND_FAMILY(
    VL_SAMPLER_FUNCTIONS(VL_LIST_ROW), VL_SAMPLER_KINDS, "samplers", "sampler", "Sampler");
