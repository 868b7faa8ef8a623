/* world/material/measured.h: measured reflection (Dupuy and Jakob 2018, "An Adaptive Parameterization for Efficient
 * Material Acquisition and Rendering"; pbrt book 9.8), from a file of the RGL material database.
 *
 * A direction of elevation theta and azimuth phi is a point of the unit square, (sqrt(2 theta / pi), (phi + pi) / 2
 * pi). All tables are bilinear over it: their rows run along phi, their columns along theta. ndf(m)     density D of
 * the microfacets' normals, per solid angle;   sigma(o): their area as o sees it vndf(m)    for each o = (phi_i,
 * theta_i) of a grid: density of the normals that o sees, over the unit square; by it normals are sampled, so that the
 * square in which the next two live is small where the lobe is luminance  for each o: brightness over that square of
 * random numbers;   spectra: the same for each wavelength With s in the square warped to m by vndf:   f(o, w) cos w =
 * spectra(s) D(m) / (4 sigma(o)),   m halfway. */
#ifndef WORLD_MATERIAL_MEASURED_H
#define WORLD_MATERIAL_MEASURED_H

#include "base/context.h"

/* Functions over the unit square, bilinear between width x height nodes: one slice for each pair of angles (phis x
 * thetas, theta fastest; spectra: times wavelengths, those fastest). */
typedef struct vlMeasuredTable {
  uint32_t width, height;
  const float *values;
  /* Of those that are sampled, whose slices have integral 1: for each node the integral of its row up to it; for each
   * row the integral of all rows up to it. Else null. */
  const float *columns, *rows;
} vlMeasuredTable;

typedef struct vlMeasured {
  vlMeasuredTable ndf, sigma, vndf, luminance, spectra;
  uint32_t phis, thetas, lambdas;    /* RGB: 3 */
  const float *phi, *theta, *lambda; /* ascending; lambda null: RGB */
  bool isotropic;                    /* azimuths are from that of o */
  bool scaled;                       /* spectra are as above; else f cos w itself */
  /* Of a symmetric surface only a half or a quarter of the azimuths is measured: o is turned or mirrored into it. */
  bool halves, quarters;
  float side_x, side_y; /* signs of the part's x and y */
  const float *albedo;  /* by wavelength: what comes back straight on */
  float *numbers;       /* the memory of all tables but the file's spectra */
  char *file;
  char *path; /* what it was read from */
} vlMeasured;

/* Reads a file. rgb: its spectra as linear sRGB under daylight. Errors: MISSING, IO, MEMORY; SCENE where the file is
 * damaged or not what it should be, its name in the message. Memory: at most some three times the file. */
vlResult vl_measured_read(vlContext *context, const char *path, bool rgb, vlMeasured **result, vlError *error);
void vl_measured_free(vlContext *context, vlMeasured *measured);

#endif
