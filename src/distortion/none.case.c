/* distortion/none.case.c: what tests know of cameras without distortion. */
#include "distortion/distortion.case.h"

static void plain(const DistortionVariant *v, double x, double y, double at[2]) {
  (void)v;
  at[0] = x;
  at[1] = y;
}

const DistortionCase none_distortion = {.variants = {{0, {0}}}, .plain = plain};
