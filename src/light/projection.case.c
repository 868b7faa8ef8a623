/* light/projection.case.c: what tests know of projection lights. */
#include "light/light.case.h"

const LightCase projection_light = {
    .before = "Translate 0 1 0 Rotate 90 1 0 0",
    .variants =
        {
            {.parameters = "\"string filename\" \"quarters.pfm\" \"float fov\" 90",
             .known = {{.5, .5, {.4 / 1.5, .4 / 1.5, .4 / 1.5}},
                       {-.5, .5, {.2 / 1.5, .2 / 1.5, .2 / 1.5}},
                       {.5, -.5, {.8 / 1.5, .8 / 1.5, .8 / 1.5}},
                       {1.2, 0, {0, 0, 0}}},
             .known_count = 4,
             .rim = {{.97, .97}, {-.97, .97}, {.97, -.97}, {-.97, -.97}}},
        },
    .parameters = {{.base = "\"string filename\" \"sky.pfm\""}},
};
