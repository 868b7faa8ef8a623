/* material/measured_tables.h: measured reflection (Dupuy and Jakob 2018, "An Adaptive
 * Parameterization for Efficient Material Acquisition and Rendering"; pbrt book 9.8), from a
 * file of the RGL material database.
 *
 * A direction of elevation theta and azimuth phi is a point of the unit square, (sqrt(2 theta /
 * pi), (phi + pi) / (2 pi)). All tables are bilinear over the square: their rows run along phi,
 * their columns along theta.
 *
 *   ndf(m)     density D of the microfacet normals m, per solid angle.
 *   sigma(o)   projected microfacet area visible from o.
 *   vndf(m)    for each o = (phi_i, theta_i) of a grid, the density of the visible normals over
 *              the unit square. Sampling this density maps a square of random numbers to
 *              normals. The next two tables are over that square.
 *   luminance  for each o, the luminance.
 *   spectra    for each o, the value per wavelength.
 *
 * If sampling vndf maps the point s of the square of random numbers to m, and m is the half
 * vector of o and w, then f(o, w) cos w = spectra(s) D(m) / (4 sigma(o)). */
#ifndef MATERIAL_MEASURED_TABLES_H
#define MATERIAL_MEASURED_TABLES_H

#include "base/context.h"

/* Functions over the unit square, bilinear between width x height nodes. There is one slice per
 * pair of angles (phis x thetas slices, theta fastest). Tables of spectra have one slice per
 * pair of angles and wavelength (wavelength fastest). */
typedef struct vlMeasuredTable {
  uint32_t width, height;
  const float *values;
  /* Running integrals, for tables that are sampled; the slices of these have integral 1.
   * columns: per node, the integral along its row up to the node. rows: per row, the integral
   * over all rows up to it. Null for other tables. */
  const float *columns, *rows;
} vlMeasuredTable;

typedef struct vlMeasured {
  vlMeasuredTable ndf, sigma, vndf, luminance, spectra;
  uint32_t phis, thetas, lambdas; /* sizes of phi, theta and lambda; lambdas is 3 in RGB mode */
  /* ascending, in radians and nm; lambda is null in RGB mode */
  const float *phi, *theta, *lambda;
  bool isotropic; /* azimuths are relative to the azimuth of o */
  bool scaled;    /* spectra are as described above; if false, they hold f cos w */
  /* For symmetric surfaces only a half or a quarter of the azimuths is measured. Lookups rotate
   * or mirror o into the measured part. */
  bool halves, quarters;
  float side_x, side_y; /* signs of x and y in the measured part */
  const float *albedo;  /* albedo at normal incidence, per wavelength */
  float *numbers;       /* the memory of all tables except the file's spectra */
  char *file;
  char *path; /* path of the file */
} vlMeasured;

/* Reads a file. rgb: converts its spectra to linear sRGB under daylight. Errors: MISSING, IO,
 * MEMORY; SCENE if the file is damaged or lacks a field (the message names the file). Memory:
 * at most about three times the size of the file. */
vlResult vl_measured_read(vlContext *context, const char *path, bool rgb, vlMeasured **result,
                          vlError *error);
void vl_measured_free(vlContext *context, vlMeasured *measured);

#endif
