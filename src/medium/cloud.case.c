/* medium/cloud.case.c: what tests know of clouds. */
#include "medium/medium.case.h"

const MediumCase cloud_medium = {
    .shape = BOX "\"float density\" 3 ",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .5",
    .absorbs = "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]",
    .parameters =
        {
            {.base = "\"point3 p0\" [-1 -1 -1];\"point3 p1\" [1 1 1];\"float density\" 4"},
            {.parameter = "density", .value = "\"float density\" 3"},
        },
};
