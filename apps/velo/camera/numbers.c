/* camera/numbers.c: numbers of options. */
#include "camera/numbers.h"

#include <math.h>
#include <stdlib.h>

bool parse_numbers(const char *text, int count, double *values) {
  for (int i = 0; i < count; i++) {
    char *end;
    values[i] = strtod(text, &end);
    if (end == text || !isfinite(values[i]))
      return false;
    text = end;
    if (i + 1 < count && *text++ != ',')
      return false;
  }
  return *text == 0;
}
