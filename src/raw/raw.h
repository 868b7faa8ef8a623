/* raw/raw.h: the raw image, and what the files of this room share. */
#ifndef RAW_RAW_H
#define RAW_RAW_H

#include "base/context.h"
#include "velo/raw.h"

struct vlRaw {
  vlContext *context;
  vlRawDef def;
  uint16_t *numbers; /* width * height, rows from the top */
};

/* Finds which value of a def is out of its range. ARGUMENT with the field's name, or OK. */
vlResult vl_raw_check(const vlRawDef *def, vlError *error);
/* Whether every number is below 2^bits; else ARGUMENT with the pixel. */
vlResult vl_raw_check_numbers(const vlRaw *raw, vlError *error);
/* The letter of a vlRawColor. */
char vl_raw_letter(uint32_t color);
/* For each cell of the pattern the index of its colour among vl_raw_colors. Returns the number
 * of colours. */
uint32_t vl_raw_planes(const vlRawDef *def, uint8_t planes[VL_RAW_MAX_CELLS]);
/* The cell of the pattern that a pixel belongs to. */
static inline uint32_t vl_raw_cell(const vlRawDef *def, uint32_t x, uint32_t y) {
  return y % def->pattern_rows * def->pattern_columns + x % def->pattern_columns;
}
/* Whether the def has matrices, which a pattern of several colours needs for colour. */
bool vl_raw_has_matrices(const vlRawDef *def);
/* The camera's numbers for white, as development takes them: the def's neutral; where it has
 * none, that of D65 by the matrix; without matrices ones. */
void vl_raw_neutral(const vlRawDef *def, double neutral[VL_RAW_MAX_COLORS]);
/* The row-major 3 x `colors` matrix from the camera's numbers (black level subtracted, white
 * level 1, not white-balanced) to linear sRGB: the matrix for the light whose white has
 * the neutral (vl_raw_neutral), then Bradford's adaptation of that white to D65. The neutral
 * becomes (1, 1, 1). Writes the light's temperature in kelvin. False: the matrices have no
 * inverse. */
bool vl_raw_color_matrix(const vlRawDef *def, double rgb_from_camera[3 * VL_RAW_MAX_COLORS],
                         double *kelvin);

/* Solves the symmetric system a x = b of `n` <= 4 unknowns, a row-major n x n, for `columns`
 * right sides (b and x: n x columns). False: singular. */
bool vl_raw_solve(uint32_t n, const double *a, uint32_t columns, const double *b, double *x);

#endif
