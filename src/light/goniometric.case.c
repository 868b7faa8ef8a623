/* light/goniometric.case.c: what tests know of goniometric lights. */
#include "light/light.case.h"

#define SKEW "ConcatTransform [1 0 0 0 .6 1 0 0 0 0 1 0 0 0 0 1]"

/* The image has .2, .4, .6, .8 in its quarters: left top, right top, left bottom, right bottom.
 * Its map has y upwards: below the light, u goes with x and v with z. The distance is the root
 * of 1.5. The lamp file's intensity is linear in C, from 2 at C 0 to 1 at C 180; that of the
 * other one from 3 to 9. */
const LightCase goniometric_light =
    {
        .before = "Translate 0 1 0",
        .variants =
            {
                {.parameters = "\"string filename\" \"quarters.pfm\" \"rgb I\" [1 1 1]",
                 .known = {{.5, .5, {.8 / 1.5, .8 / 1.5, .8 / 1.5}},
                           {-.5, .5, {.6 / 1.5, .6 / 1.5, .6 / 1.5}},
                           {.5, -.5, {.4 / 1.5, .4 / 1.5, .4 / 1.5}},
                           {-.5, -.5, {.2 / 1.5, .2 / 1.5, .2 / 1.5}}}},
                {.parameters = "\"string filename\" \"lamp.ies\" \"rgb I\" [1 1 1]",
                 .known = {{.5, 0, {2 / 1.25, 2 / 1.25, 2 / 1.25}},
                           {-.5, 0, {1 / 1.25, 1 / 1.25, 1 / 1.25}},
                           {0, -.5, {1.5 / 1.25, 1.5 / 1.25, 1.5 / 1.25}},
                           {.5, -.5, {1.75 / 1.5, 1.75 / 1.5, 1.75 / 1.5}}}},
                {.parameters = "\"string filename\" \"other.ies\" \"rgb I\" [1 1 1]",
                 .known = {{.5, 0, {3 / 1.25, 3 / 1.25, 3 / 1.25}},
                           {-.5, 0, {9 / 1.25, 9 / 1.25, 9 / 1.25}}}},
                /* x goes along with y */
                {.parameters = "\"string filename\" \"quarters.pfm\" \"rgb I\" [1 1 1]",
                 .before = SKEW,
                 .known = {{-.1, .5, {.8 / 1.26, .8 / 1.26, .8 / 1.26}},
                           {-1.1, .5, {.6 / 2.46, .6 / 2.46, .6 / 2.46}},
                           {-.1, -.5, {.4 / 1.26, .4 / 1.26, .4 / 1.26}},
                           {-1.1, -.5, {.2 / 2.46, .2 / 2.46, .2 / 2.46}}}},
                {.parameters = "\"string filename\" \"lamp.ies\" \"rgb I\" [1 1 1]",
                 .before = SKEW,
                 .known = {{-.1, 0, {2 / 1.01, 2 / 1.01, 2 / 1.01}},
                           {-1.1, 0, {1 / 2.21, 1 / 2.21, 1 / 2.21}},
                           {-.6, -.5, {1.5 / 1.61, 1.5 / 1.61, 1.5 / 1.61}},
                           {-.1, -.5, {1.75 / 1.26, 1.75 / 1.26, 1.75 / 1.26}}}},
                /* almost all light leaves near the poles of the map */
                {.parameters = "\"string filename\" \"sky.pfm\" \"rgb I\" [1 1 1]",
                 .before = "Scale 1 .1 1"},
            },
        .parameters = {{.base = "\"string filename\" \"sky.pfm\""}},
};
