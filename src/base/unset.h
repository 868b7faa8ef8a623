/* base/unset.h: tells a number that is not given from other numbers that are not finite. */
#ifndef BASE_UNSET_H
#define BASE_UNSET_H

#include <string.h>

#include "velo/base.h"

/* Whether a value of a def is VL_UNSET (not given). Other NaN are wrong values. Its sign does
 * not count. */
static inline bool vl_is_unset(double value) {
  double unset = VL_UNSET;
  uint64_t bits;
  uint64_t of_unset;
  memcpy(&bits, &value, sizeof bits);
  memcpy(&of_unset, &unset, sizeof of_unset);
  return bits << 1 == of_unset << 1;
}

#endif
