/* tables.h: what the parts of the generator share. It runs when velo is built and writes constant C tables. */
#ifndef COLOR_TABLES_TABLES_H
#define COLOR_TABLES_TABLES_H

#include <stdbool.h>
#include <stdio.h>

enum { LAMBDA_COUNT = 471, LAMBDA_MIN = 360, SPACE_COUNT = 4 };

/* A colour space as seen by a reflectance under the space's illuminant. */
typedef struct space {
  int illuminant; /* which of the named spectra */
  double xy[8];   /* red, green, blue, white */
  double xyz_from_rgb[9], rgb_from_xyz[9];
  double weight[3][LAMBDA_COUNT]; /* rgb = sum over nm of weight * reflectance; each sums to 1 */
} space;

/* channels.c: how the channels of linear sRGB share each wavelength. False: no such spectra. */
bool make_channels(const space *srgb, float shares[LAMBDA_COUNT][3]);
/* dense.c: the spectra, once; then the file. */
void make_spectra(space spaces[SPACE_COUNT]);
bool write_spectra(FILE *file, const space spaces[SPACE_COUNT]);
/* rgb.c: the coefficient table of one space, 3 N^3 colours, 3 floats each. */
void solve_space(const space *s, float *coefficients);

#endif
