/* light/point.case.c: what tests know of point lights. */
#include "light/light.case.h"

const LightCase point_light = {
    .variants =
        {
            {.parameters = "\"point3 from\" [0 2 0] \"rgb I\" [4 2 1]",
             .known = {{0, 0, {1, .5, .25}}, {2, 0, {.5, .25, .125}}}},
            {.parameters = "\"point3 from\" [0 1 0] \"rgb I\" [1 1 1] \"float scale\" 3",
             .known = {{0, 0, {3, 3, 3}}}},
            {.parameters =
                 "\"point3 from\" [0 1 0] \"rgb I\" [1 1 1] \"float power\" 25.1327412",
             .known = {{0, 0, {2, 2, 2}}}},
        },
    .parameters = {{.base = "\"point3 from\" [1 3 2]"}},
};
