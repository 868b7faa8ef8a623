/* import/pbrt/decimal.h: converts numbers in text to the nearest double, ties to even. The
 * result equals strtod's but depends neither on the locale nor on the machine. The readers of
 * meshes use these functions, too. */
#ifndef IMPORT_PBRT_DECIMAL_H
#define IMPORT_PBRT_DECIMAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Converts text[0, length) to a number: integers, decimals, exponents, hexadecimal. Returns
 * false for other text, infinities and values too large for a double. */
bool vl_number_parse(const char *text, size_t length, double *value);
/* Reads the number at the start of [*text, end) and moves *text past it. */
bool vl_number_scan(const char **text, const char *end, double *value);

#endif
