/* tables.h: declarations that the files of the generator share. The generator runs when velo is
 * built and writes constant C tables. */
#ifndef COLOR_TABLES_TABLES_H
#define COLOR_TABLES_TABLES_H

#include <stdbool.h>
#include <stdio.h>

enum { LAMBDA_COUNT = 471, LAMBDA_MIN = 360, SPACE_COUNT = 4 };

/* A colour space, and the weights that give the colour of a reflectance under the space's
 * illuminant. */
typedef struct space {
  int illuminant; /* index of the illuminant among the named spectra */
  double xy[8];   /* red, green, blue, white */
  double xyz_from_rgb[9], rgb_from_xyz[9];
  double weight[3]
               [LAMBDA_COUNT]; /* rgb = sum over nm of weight * reflectance; each sums to 1 */
} space;

/* In channels.c: computes the share of each channel of linear sRGB at each wavelength. False:
 * no such spectra exist. */
bool make_channels(const space *srgb, float shares[LAMBDA_COUNT][3]);
/* In dense.c: computes the spectra and the spaces. To be called once, before the file is
 * written. */
void make_spectra(space spaces[SPACE_COUNT]);
bool write_spectra(FILE *file, const space spaces[SPACE_COUNT]);
/* Writes count values, each the stride-th, as members of an initialiser. */
void write_floats(FILE *file, const float *v, int count, int stride);
/* In curves.c. */
void write_curves(FILE *file);
/* In rgb.c: computes the coefficient table of one space: 3 N^3 colours with 3 floats each. */
void solve_space(const space *s, float *coefficients);

#endif
