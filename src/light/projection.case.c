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
             .rim = {{.97, .97}, {-.97, .97}, {.97, -.97}, {-.97, -.97}}},
            /* x goes along with y: the square becomes a parallelogram */
            {.parameters = "\"string filename\" \"quarters.pfm\" \"float fov\" 90",
             .before = "ConcatTransform [1 0 0 0 .3 1 0 0 0 0 1 0 0 0 0 1]",
             .known = {{.65, .5, {.4 / 1.6725, .4 / 1.6725, .4 / 1.6725}},
                       {-.35, .5, {.2 / 1.3725, .2 / 1.3725, .2 / 1.3725}},
                       {.35, -.5, {.8 / 1.3725, .8 / 1.3725, .8 / 1.3725}},
                       {1.5, .5, {0, 0, 0}}},
             .rim = {{1.261, .97}, {-.679, .97}, {.679, -.97}, {-1.261, -.97}}},
        },
    .parameters = {{.base = "\"string filename\" \"sky.pfm\""}},
};
