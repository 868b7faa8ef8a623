/* color.h: radiance at four wavelengths, or as red, green and blue. A path carries four numbers. In a spectral render
 * they belong to four wavelengths that the path draws at its start (pbrt book 4.5); in an RGB render to R, G, B, and
 * the fourth repeats B and is not looked at. The rest of the renderer does not know which. */
#ifndef REFERENCE_COLOR_H
#define REFERENCE_COLOR_H

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
} wavelengths;

/* A spectrum of the scene, with all its values. */
typedef struct color {
  float nm[VL_SPECTRUM_VALUES];
  float rgb[3];
} color;

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
  for (int i = 0; i < CHANNELS; i++) a.c[i] *= s;
  return a;
}
static inline bool is_black(spectrum a) {
  return a.c[0] == 0 && a.c[1] == 0 && a.c[2] == 0 && a.c[3] == 0;
}
static inline double largest(spectrum a) {
  return fmax(fmax(a.c[0], a.c[1]), fmax(a.c[2], a.c[3]));
}
static inline double mean_of(spectrum a) {
  return 0.25 * (a.c[0] + a.c[1] + a.c[2] + a.c[3]);
}
static inline bool is_finite(spectrum a) {
  return isfinite(a.c[0]) && isfinite(a.c[1]) && isfinite(a.c[2]) && isfinite(a.c[3]);
}

/* The wavelengths of a new path. */
wavelengths sample_wavelengths(bool rgb, sampler *s);
/* Glass bends each wavelength another way: from here on the path belongs to its first wavelength alone. */
void keep_first_wavelength(wavelengths *w);

/* Reads a spectrum of the scene. A light's is divided by its luminance, so that its scale alone sets its brightness.
 * The result is false, with an error, for a spectrum that is none. */
bool read_color(const vlSpectrum *s, vlParameterRole role, color *result, vlError *error);
/* The white of sRGB with luminance 1: what the texels of a light's image multiply. */
void white_light(vlColorSpace space, color *result);
spectrum color_at(const color *c, const wavelengths *w);
/* The spectrum of a texel, linear RGB. */
spectrum reflectance_of(vlColorSpace space, const double rgb[3], const wavelengths *w);
spectrum unbounded_of(vlColorSpace space, const double rgb[3], const wavelengths *w);

/* What a path adds to its pixel: its radiance as linear RGB of the film's colour space. */
void radiance_to_rgb(spectrum radiance, const wavelengths *w, vlColorSpace space, double rgb[3]);

#endif
