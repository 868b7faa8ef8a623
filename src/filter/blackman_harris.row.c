/* filter/blackman_harris.row.c: the name and the parameters of the pixel filter blackman
 * harris. */
#include "filter/filter.row.h"

const vlKindRow vl_filter_row_blackman_harris = {
    .name = "blackmanharris",
    .alias = "blackman-harris",
    .traits = VL_FILTER_TRAIT_POSITIVE,
    .description = "the Blackman-Harris window",
    VL_PARAMETERS(RADII(2)),
};
