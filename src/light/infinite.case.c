/* light/infinite.case.c: what tests know of infinite lights. */
#include "light/light.case.h"

const LightCase infinite_light = {
    .variants =
        {
            {.parameters = "\"rgb L\" [.5 1 2]"},
            {.parameters = "\"string filename\" \"sky.pfm\"", .compensated = true},
            {.parameters = "\"string filename\" \"quarters.pfm\"", .compensated = true},
            {.parameters = "\"string filename\" \"sky.pfm\" "
                           "\"point3 portal\" [-1.2 0 -1.2 1.2 0 -1.2 1.2 2 -1.2 -1.2 2 -1.2]"},
            {.parameters = "\"string filename\" \"sky.pfm\" "
                           "\"point3 portal\" [-.8 0 -1.8 1.2 0 -.3 1.2 2 -.3 -.8 2 -1.8]"},
        },
    .illuminated = {"\"rgb L\" [1 1 1]", "\"string filename\" \"sky.pfm\""},
    .faced = {0, 0, 1},
    .parameters = {{.parameter = "portal",
                    .base = "\"string filename\" \"sky.pfm\"",
                    .value = "\"point3 portal\" [-2 0 -3 -2 4 -3 2 4 -3 2 0 -3]"}},
};
