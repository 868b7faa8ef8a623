/* color.h: radiance at four wavelengths, or as red, green and blue. A path carries four numbers. In a spectral render
 * they belong to four wavelengths that the path draws at its start (pbrt book 4.5); in an RGB render to R, G, B, and
 * the fourth repeats B and is not looked at. The rest of the renderer does not know which. */
#pragma once
#include <stdbool.h>
#include <velo/color.h>

#include "sampler.h"

enum { CHANNELS = 4 };

typedef struct spectrum {
  double c[CHANNELS];
} spectrum;

/* What the four numbers of a path mean. */
typedef struct wavelengths {
  bool rgb;
  double nm[CHANNELS];
  double density[CHANNELS]; /* of each wavelength, 1 / nm; 0: the wavelength no longer counts */
  double crossed[3];        /* share of red, green, blue that the surfaces which the path has crossed leave */
} wavelengths;

static inline spectrum gray(double value) {
  return (spectrum){{value, value, value, value}};
}
static inline spectrum plus(spectrum a, spectrum b) {
  for (int i = 0; i < CHANNELS; i++) a.c[i] += b.c[i];
  return a;
}
static inline spectrum times(spectrum a, spectrum b) {
  for (int i = 0; i < CHANNELS; i++) a.c[i] *= b.c[i];
  return a;
}
static inline spectrum scaled(double s, spectrum a) {
  return times(gray(s), a);
}
static inline double largest(spectrum a) {
  return fmax(fmax(a.c[0], a.c[1]), fmax(a.c[2], a.c[3]));
}

/* The wavelengths of a new path. */
wavelengths sample_wavelengths(bool rgb, sampler *s);
/* Glass bends each wavelength another way: from here on the path belongs to its first wavelength alone. */
void keep_first_wavelength(wavelengths *w);
/* The numbers of a path that count: three in RGB, one where only the first wavelength is left. */
uint32_t channels_of(const wavelengths *w);

/* A spectrum of the scene as a table: one value per nm, and as RGB. */
typedef struct color {
  const vlSpectrum *of;
  vlParameterRole role;
  float values[VL_SPECTRUM_VALUES], rgb[3];
  bool varies;        /* between wavelengths */
  struct color *next; /* in the list of find_color */
} color;

/* The table of a spectrum; find_color makes it when it is first asked for. That of a light (VL_PARAMETER_ILLUMINANT) is
 * divided by its luminance, so that the light's scale alone sets its brightness. */
color *make_color(const vlSpectrum *s, vlParameterRole role);
const color *find_color(const vlSpectrum *s, vlParameterRole role);
spectrum color_at(const color *c, const wavelengths *w);
/* The value of a table with one number per nm, linear between them. */
double table_at(const float *table, int stride, double nm);
/* The spectrum of a texel, linear RGB: a reflectance (VL_PARAMETER_ALBEDO), or any value from 0. */
spectrum texel_spectrum(vlColorSpace space, const double rgb[3], vlParameterRole role, const wavelengths *w);

/* The eye: the observer's curves, and the matrix from X, Y, Z to the film's colours. */
typedef struct observer {
  float xyz[3 * VL_SPECTRUM_VALUES];
  double rgb_from_xyz[9];
} observer;

/* What a path adds to its pixel: its radiance as linear RGB of the film's colour space. */
void radiance_to_rgb(const observer *o, spectrum radiance, const wavelengths *w, double rgb[3]);

/* The array with room for `count` elements, as by realloc. Without memory the program ends. */
void *resize(void *array, size_t count, size_t size);
