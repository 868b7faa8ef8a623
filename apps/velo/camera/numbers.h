/* camera/numbers.h: numbers of options. */
#ifndef APP_CAMERA_NUMBERS_H
#define APP_CAMERA_NUMBERS_H

#include <stdbool.h>

/* Reads `count` finite numbers separated by commas, and nothing else. */
bool parse_numbers(const char *text, int count, double *values);

#endif
