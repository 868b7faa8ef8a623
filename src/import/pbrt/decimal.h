/* import/pbrt/decimal.h: decimal numbers to doubles, the nearest one, ties to even: what strtod gives, but independent
 * of the locale, and the same on every machine. */
#ifndef IMPORT_PBRT_DECIMAL_H
#define IMPORT_PBRT_DECIMAL_H

#include <stdint.h>

/* mantissa * 10^exponent; HUGE_VAL where that is beyond doubles. */
double vl_decimal(uint64_t mantissa, int exponent);

/* The same for any number of digits: text holds decimal digits, at most one point among them, up to end. */
double vl_decimal_digits(const char *text, const char *end, int exponent);

#endif
