/* import/pbrt/decimal.h: converts decimal numbers to the nearest double, ties to even. The
 * result equals strtod's but depends neither on the locale nor on the machine. */
#ifndef IMPORT_PBRT_DECIMAL_H
#define IMPORT_PBRT_DECIMAL_H

#include <stdint.h>

/* mantissa * 10^exponent; HUGE_VAL if that is too large for a double. */
double vl_decimal(uint64_t mantissa, int exponent);

/* Like vl_decimal for any number of digits. The mantissa is the text from `text` to `end`,
 * which holds decimal digits and at most one decimal point. */
double vl_decimal_digits(const char *text, const char *end, int exponent);

#endif
