/* world/material/measured.h: measured reflection (Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient
 * Material Acquisition and Rendering"; pbrt book 9.8), from a file of the RGL material database.
 *
 * A direction of elevation theta and azimuth phi is a point of the unit square, (sqrt(2 theta / pi), (phi + pi) / (2
 * pi)). All tables are bilinear over the square: their rows run along phi, their columns along theta.
 *     ndf(m): density D of the microfacet normals, per solid angle.
 *     sigma(o): projected microfacet area visible from o.
 *     vndf(m): for each o = (phi_i, theta_i) of a grid, the density of the visible normals over the unit square.
 *     Normals are sampled from it, so that the lobe fills the unit square of the next two tables.
 *     luminance: for each o, the luminance over that square of random numbers.
 *     spectra: the same per wavelength.
 * With s the point of that square which vndf maps to m: f(o, w) cos w = spectra(s) D(m) / (4 sigma(o)), m the half
 * vector of o and w. */
#ifndef WORLD_MATERIAL_MEASURED_H
#define WORLD_MATERIAL_MEASURED_H

#include "base/context.h"

/* Functions over the unit square, bilinear between width x height nodes. One slice per pair of angles (phis x
 * thetas, theta fastest; for spectra times wavelengths, wavelength fastest). */
typedef struct vlMeasuredTable {
  uint32_t width, height;
  const float *values;
  /* For tables that are sampled, whose slices have integral 1. columns: running integral of a node's row up to the
   * node. rows: running integral of all rows up to the row. Else null. */
  const float *columns, *rows;
} vlMeasuredTable;

typedef struct vlMeasured {
  vlMeasuredTable ndf, sigma, vndf, luminance, spectra;
  uint32_t phis, thetas, lambdas;    /* RGB: 3 */
  const float *phi, *theta, *lambda; /* ascending; lambda null: RGB */
  bool isotropic;                    /* azimuths are relative to the azimuth of o */
  bool scaled;                       /* spectra are as above; else they hold f cos w itself */
  /* For symmetric surfaces only a half or a quarter of the azimuths is measured: o is rotated or mirrored into it. */
  bool halves, quarters;
  float side_x, side_y; /* signs of x and y in the measured part */
  const float *albedo;  /* per wavelength: albedo at normal incidence */
  float *numbers;       /* the memory of all tables except the file's spectra */
  char *file;
  char *path; /* path of the file */
} vlMeasured;

/* Reads a file. rgb: converts its spectra to linear sRGB under daylight. Errors: MISSING, IO, MEMORY; SCENE if the
 * file is damaged or lacks a field (the message names the file). Memory: at most about three times the size of the
 * file. */
vlResult vl_measured_read(vlContext *context, const char *path, bool rgb, vlMeasured **result, vlError *error);
void vl_measured_free(vlContext *context, vlMeasured *measured);

#endif
