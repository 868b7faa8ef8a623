/* light/spot.case.c: what tests know of spot lights. */
#include "light/light.case.h"

static void square(vlLightDef *def) {
  def->cone_squared = true;
}

/* Straight down, from a height of 1. */
#define CONE                                       \
  "\"point3 from\" [0 1 0] \"point3 to\" [0 0 0] " \
  "\"float coneangle\" 40 \"float conedeltaangle\" 20 "

#define UNEVEN "ConcatTransform [2 0 0 0 .3 1 0 0 0 0 .6 0 0 0 0 1]"

/* Between the cosines of 40 and of 20 degrees t runs from 0 to 1; the falloff is 3 t^2 - 2 t^3,
 * here of t = .4994 and of .1955 (36.87 degrees), over the squared distance; t^2 where it is
 * squared. */
const LightCase spot_light = {
    .variants =
        {
            {.parameters = CONE "\"rgb I\" [1 1 1]",
             .known = {{0, 0, {1, 1, 1}},
                       {.612460, 0, {.363607, .363607, .363607}},
                       {.75, 0, {.063842, .063842, .063842}},
                       {1, 0, {0, 0, 0}}}},
            {.parameters = CONE "\"rgb I\" [1 1 1]",
             .change = square,
             .known = {{0, 0, {1, 1, 1}},
                       {.612460, 0, {.181390, .181390, .181390}},
                       {.75, 0, {.024472, .024472, .024472}},
                       {1, 0, {0, 0, 0}}}},
            /* a power of 10 over 2 pi (1 - cos 20 + (cos 20 - cos 40) / 3) */
            {.parameters = CONE "\"rgb I\" [1 1 1] \"float power\" 10",
             .change = square,
             .known = {{0, 0, {13.46601, 13.46601, 13.46601}},
                       {.612460, 0, {2.442599, 2.442599, 2.442599}}}},
            {.parameters = "\"point3 from\" [0 1 0] \"point3 to\" [1 0 0] \"rgb I\" [1 2 4]",
             .known = {{1, 0, {.5, 1, 2}}}},
            /* the cone is round in a frame that is skewed and scaled: x' = 2 x + .3 y, z' = .6
             * z; the power is that of the world's directions */
            {.parameters = CONE "\"rgb I\" [1 1 1] \"float power\" 10",
             .before = UNEVEN,
             .change = square,
             .known = {{-.3, 0, {10.01089, 10.01089, 10.01089}},
                       {.6, .2, {8.564451, 8.564451, 8.564451}},
                       {-1.2, .1, {.950077, .950077, .950077}},
                       {.2, .55, {0, 0, 0}}}},
            /* the same, however far the point is at which it points */
            {.parameters = "\"point3 from\" [0 1 0] \"point3 to\" [0 -2 0] "
                           "\"float coneangle\" 40 \"float conedeltaangle\" 20 "
                           "\"rgb I\" [1 1 1] \"float power\" 10",
             .before = UNEVEN,
             .change = square,
             .known = {{-.3, 0, {10.01089, 10.01089, 10.01089}},
                       {.6, .2, {8.564451, 8.564451, 8.564451}}}},
            {.parameters = CONE "\"rgb I\" [1 1 1]",
             .before = UNEVEN,
             .known = {{-.3, 0, {.735294, .735294, .735294}},
                       {.6, .2, {.826441, .826441, .826441}},
                       {-1.2, .1, {.142781, .142781, .142781}},
                       {.2, .55, {0, 0, 0}}}},
        },
    .parameters = {{.base = "\"point3 from\" [1 3 2];\"point3 to\" [0 0 0]"},
                   {.parameter = "coneangle", .value = "\"float coneangle\" 12"},
                   {.parameter = "conedeltaangle", .value = "\"float conedeltaangle\" 25"}},
};
