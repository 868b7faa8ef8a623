/* medium/medium.case.h: what the tests of media must know of a kind beyond its row: parameters
 * for the laws of test/conformance/transport.h, and cases of its parameters. */
#ifndef MEDIUM_MEDIUM_CASE_H
#define MEDIUM_MEDIUM_CASE_H

#include <math.h>

#include "math/noise.case.h"
#include "schema/parameter.case.h"
#include "velo/medium.h"

/* The medium fills a box from -1 to 1. */
typedef struct MediumCase {
  const char *shape;    /* parameters of all variants */
  const char *scatters; /* nothing absorbs: what enters leaves */
  const char *emits;    /* absorbs, and emits what it absorbs of a sky of 1; null: cannot */
  const char *absorbs;  /* absorbs alone */
  double transmittance; /* of that; 0: not known, but below 1 */
  double emission;      /* where the emission fades at the box's sides; 0: 1 */
  const char *emits_by_cell; /* as emits, but by a scale of each cell; null: has none */
  double emission_by_cell;   /* of that */
  const char *layers; /* absorbs alone, most of it in one of eight layers; null: cannot */
  double passes;      /* the transmittance of that along z */
  double (*density_of_layers)(const double p[3], PlainNoise *noise); /* its extinction */
  double (*density)(const double p[3], PlainNoise *noise); /* the extinction of `absorbs` at a
                                           point of the box; null: not known */
  const char *tall; /* all parameters of one that is not like the others, such as one higher
                       than the box; null: there is none */
  /* All parameters of a medium that reaches beyond one block of the kind's grid, and its
   * extinction; null: the kind has no blocks. */
  const char *blocks;
  double (*density_of_blocks)(const double p[3], PlainNoise *noise);
  const char *hot[2];   /* all parameters of two descriptions of the same emission in the middle
                           of the box; null: has one */
  const char *alike[2]; /* two ways to describe one coloured medium; null: has one */
  ParameterCase parameters[PARAMETER_CASES];
} MediumCase;

/* Values that several kinds use: the box, grids in it, numbers and colours of their cells. */
#define BOX "\"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] "
#define BLOCKS BOX "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 "
#define ONES "[1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1]"
#define NONE "[0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]"
#define HALF_OF "[.5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5]"
#define LAYERS BOX "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 8 "
#define FOUR_THIN ".1 .1 .1 .1 "
#define FOUR_COLORS ".05 .05 .05 .05 .05 .05 .05 .05 .05 .05 .05 .05 "
#define THICK_COLORS "1.5 1.5 1.5 1.5 1.5 1.5 1.5 1.5 1.5 1.5 1.5 1.5 "
#define CELLS                                                                                  \
  "\"integer nx\" 2;\"integer ny\" 2;\"integer nz\" 2;\"point3 p0\" [-1 -1 -1];\"point3 p1\" " \
  "[1 "                                                                                        \
  "1 1]"
#define EIGHT "[1 .5 .2 1 .7 .1 .4 .9]"
/* the largest component of one is more than twice the others, of each */
#define EIGHT_COLORS "[1 .5 .2 1 .7 .1 .2 .9 .4 .1 .3 .8 1 .4 .2 1 .7 .1 .4 .9 .6 .1 .3 .8]"
#define OTHER_COLORS "[.2 .5 1 .1 .7 1 .4 .3 .6 .9 .8 .3 .1 .5 .6 1 .2 .1 .4 .9 .1 .1 .8 .3]"

/* Cases of the numbers of cells along the axes. cells: the parameter that has their values. */
#define SIDE_CASES(cells)                                 \
  {.parameter = "nx",                                     \
   .base = "\"integer nx\" 8;" cells,                     \
   .value = "\"integer nx\" 4 \"integer ny\" 2"},         \
      {.parameter = "ny",                                 \
       .base = "\"integer ny\" 8;" cells,                 \
       .value = "\"integer ny\" 4 \"integer nz\" 2"},     \
  {                                                       \
    .parameter = "nz", .base = "\"integer nz\" 8;" cells, \
    .value = "\"integer nz\" 4 \"integer nx\" 2"          \
  }

/* The extinction of grids of two cells along each axis, .5 in all: it fades at the box's
 * sides. */
static inline double faded_density(const double p[3], PlainNoise *noise) {
  double density = 0.5;
  (void)noise;
  for (int k = 0; k < 3; k++)
    density *= fmin(1, 1.5 - fabs(p[k]));
  return density;
}

/* The extinction of LAYERS: two cells along x and y; along z eight, the third of 1.5, the
 * others of .05. */
static inline double layered_density(const double p[3], PlainNoise *noise) {
  const double at = 4 * (p[2] + 1) - 0.5;
  const double first = floor(at);
  double density = 0;
  (void)noise;
  for (int side = 0; side < 2; side++) {
    const double layer = first + side;
    const double value = layer < 0 || layer > 7 ? 0 : layer == 2 ? 1.5 : 0.05;
    density += value * (side ? at - first : 1 - (at - first));
  }
  return density * fmin(1, 1.5 - fabs(p[0])) * fmin(1, 1.5 - fabs(p[1]));
}

/* Declares the case of each kind, which is in the file of the kind: medium/NAME.case.c. */
#define MEDIUM_CASE(kind, name) extern const MediumCase name##_medium;
VL_MEDIUM_KINDS(MEDIUM_CASE)
#undef MEDIUM_CASE

#endif
