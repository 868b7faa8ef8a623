/* distortion/distortion.row.h: what a distortion's row says of it. */
#ifndef DISTORTION_DISTORTION_ROW_H
#define DISTORTION_DISTORTION_ROW_H

#include "velo/distortion.h"

typedef struct vlDistortionRow {
  const char *name;        /* in settings */
  const char *header_name; /* in headers of images; null: `name` */
  const char *key;         /* in velo's JSON */
  const char *title;       /* in messages */
  uint32_t counts;         /* bit n: there may be n coefficients */
  const char *how_many;    /* the same in words */
} vlDistortionRow;

/* The row of a kind; null: there is no such kind. */
const vlDistortionRow *vl_distortion_row(vlDistortion kind);
/* The names of all kinds, and null. */
extern const char *const vl_distortion_names[];

#endif
