/* shape/curves.case.c: what tests know of curves. */
#include "shape/shape.case.h"

/* A straight curve. Flat ones turn to the ray and are seen as wide as they are: 2 w l times the
 * mean sine of the angle between axis and ray, pi / 4. The width of ribbons is also multiplied
 * by the cosine between their normal and the ray, and so is their normal: the mean product is
 * 4 / (3 pi). As in pbrt, v is 1/2 on the axis and falls to the left of a ray that has the
 * curve's way above it (here to +y). */
#define STRAIGHT "\"point3 P\" [-.6 0 0 -.2 0 0 .2 0 0 .6 0 0] \"float width\" .1 "
#define TAPERED \
  "\"point3 P\" [-.6 0 0 -.2 0 0 .2 0 0 .6 0 0] \"float width0\" .05 \"float width1\" .15 "
#define TWISTED                                                                                 \
  "\"point3 P\" [-.6 0 0 -.2 0 0 .2 0 0 .6 0 0] \"float width\" .3 \"string type\" \"ribbon\" " \
  "\"normal N\" [0 0 1 0 1 0]"
#define BENT "\"point3 P\" [-1 0 0 -.3 1 .2 .3 -1 -.2 1 0 0]"

const ShapeCase curves_shape = {
    .variants =
        {
            {.parameters = STRAIGHT "\"string type\" \"flat\"",
             .area = 0.12 * HALF_TURN / 2,
             .reach = 0.61,
             .faces_rays = true,
             .known = {{{.3, .04, 1}, {0, 0, -1}, 1, .75, .1},
                       {{.3, .06, 1}, {0, 0, -1}, INFINITY, NAN, NAN}}},
            {.parameters = STRAIGHT "\"string type\" \"ribbon\" \"normal N\" [0 0 1 0 0 1]",
             .area = 0.12 * 8 / (3 * HALF_TURN),
             .reach = 0.61,
             .faces_rays = true, /* its points lie across the ray, as in pbrt */
             .known = {{{.3, .04, 1}, {0, 0, -1}, 1, .75, .1}}},
            /* its normal turns evenly from z to y: by 67.5 degrees at u = .75, where it is seen
             * .114805 wide */
            {.parameters = TWISTED,
             .area = 0.36 * 8 / (3 * HALF_TURN),
             .reach = 0.63,
             .faces_rays = true,
             .known = {{{.3, .05, 1}, {0, 0, -1}, 1, .75, .0644789, .38268343},
                       {{.3, .06, 1}, {0, 0, -1}, INFINITY, NAN, NAN}}},
            {.parameters = STRAIGHT "\"string type\" \"cylinder\"",
             .area = 0.12 * HALF_TURN / 2,
             .reach = 0.61,
             .faces_rays = true,
             /* the normal turns by 90 degrees from the middle to an edge */
             .known = {{{.3, .025, 1}, {0, 0, -1}, 1, .75, .25, .70710678}}},
            /* it widens from .05 to .15, in one piece */
            {.parameters = TAPERED "\"string type\" \"flat\" \"integer splitdepth\" 0",
             .area = 0.12 * HALF_TURN / 2,
             .reach = 0.61,
             .faces_rays = true,
             .known = {{{.3, .06, 1}, {0, 0, -1}, 1, .75, .02},
                       {{-.3, .04, 1}, {0, 0, -1}, INFINITY, NAN, NAN}}},
        },
    .parameters =
        {
            {.base = BENT ";\"float width\" .6"},
            {.parameter = "P", .value = "\"point3 P\" [-1 0 0 -.3 -1 .2 .3 1 -.2 1 0 0]"},
            {.parameter = "splitdepth", .no_effect = "only the speed depends on it"},
            {.parameter = "degree",
             .base = "\"string basis\" \"bspline\";" BENT ";\"float width\" .6"},
            {.parameter = "N",
             .base = "\"string type\" \"ribbon\";\"normal N\" [0 0 1 0 0 1];" BENT
                     ";\"float width\" .6",
             .value = "\"normal N\" [0 .6 1 .6 0 1]"},
        },
};
