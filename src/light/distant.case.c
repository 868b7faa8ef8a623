/* light/distant.case.c: what tests know of distant lights. */
#include "light/light.case.h"

const LightCase distant_light = {
    .variants =
        {
            {.parameters = "\"point3 from\" [0 1 0] \"point3 to\" [0 0 0] \"rgb L\" [3 2 1]",
             .known = {{0, 0, {3, 2, 1}}, {1, 1, {3, 2, 1}}}},
            {.parameters = "\"point3 from\" [1 1 0] \"point3 to\" [0 0 0] \"rgb L\" [1 1 1] "
                           "\"float illuminance\" 5",
             .known = {{0, 0, {5, 5, 5}}}},
        },
    .illuminated = {"\"point3 from\" [1 3 2]"},
    .faced = {1, 3, 1},
    .parameters = {{.base = "\"point3 from\" [1 3 2]"}},
};
