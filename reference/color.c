/* color.c: from spectra to numbers at four wavelengths, and from these to red, green and blue. */
#include "color.h"

/* Wavelengths that the eye sees well are drawn more often: p(l) = .0039398042 / cosh^2(.0072 (l - 538)), 360 to 830 nm.
 * Its integral is a tanh, so that atanh makes a wavelength of a uniform number. One number serves all four, a quarter
 * of the distribution apart (pbrt book 4.5.4). */
wavelengths sample_wavelengths(bool rgb, sampler *s) {
  wavelengths w = {.rgb = rgb, .crossed = {1, 1, 1}};
  double u = next_number(s);
  for (int i = 0; i < CHANNELS; i++) {
    double shifted = u + (double)i / CHANNELS;
    shifted -= floor(shifted);
    w.nm[i] = 538 - 138.888889 * atanh(0.85691062 - 1.82750197 * shifted);
    w.density[i] = 0.0039398042 / square(cosh(0.0072 * (w.nm[i] - 538)));
  }
  return w;
}

/* The three others get density 0, which removes them from the mean of four in radiance_to_rgb. The first one must then
 * count four times as much: its density, which divides it, becomes a quarter. */
void keep_first_wavelength(wavelengths *w) {
  if (channels_of(w) < CHANNELS) return;
  for (int i = 1; i < CHANNELS; i++) w->density[i] = 0;
  w->density[0] /= CHANNELS;
}

uint32_t channels_of(const wavelengths *w) {
  if (w->rgb) return 3;
  return w->density[1] == 0 ? 1 : CHANNELS;
}

color *make_color(const vlSpectrum *s, vlParameterRole role) {
  color *c = resize(NULL, 1, sizeof *c);
  *c = (color){.of = s, .role = role};
  vl_spectrum_tabulate(s, role, c->values, NULL);
  vl_spectrum_linear_rgb(s, role, c->rgb, NULL);
  double luminance = role == VL_PARAMETER_ILLUMINANT ? vl_spectrum_luminance(s, NULL) : 1;
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++) {
    c->values[i] = luminance > 0 ? (float)((double)c->values[i] / luminance) : 0;
    c->varies = c->varies || c->values[i] != c->values[0];
  }
  return c;
}

double table_at(const float *table, int stride, double nm) {
  double x = clamp(nm - VL_SPECTRUM_FIRST_NM, 0, VL_SPECTRUM_VALUES - 1);
  int i = (int)fmin(x, VL_SPECTRUM_VALUES - 2);
  return (double)table[stride * i] * (i + 1 - x) + (double)table[stride * (i + 1)] * (x - i);
}

spectrum color_at(const color *c, const wavelengths *w) {
  spectrum result;
  for (int i = 0; i < CHANNELS; i++)
    result.c[i] = w->rgb ? (double)c->rgb[i < 3 ? i : 2] : table_at(c->values, 1, w->nm[i]);
  return result;
}

/* A colour without upper limit is a factor times a reflectance whose largest component is 1/2 (pbrt book 4.6.6). */
spectrum texel_spectrum(vlColorSpace space, const double rgb[3], vlParameterRole role, const wavelengths *w) {
  double factor = role == VL_PARAMETER_ALBEDO ? 1 : 2 * fmax(rgb[0], fmax(rgb[1], rgb[2]));
  if (!(factor > 0)) return gray(0);
  spectrum result;
  float reflectance[CHANNELS];
  for (int i = 0; i < CHANNELS; i++) {
    result.c[i] = clamp(rgb[i < 3 ? i : 2] / factor, 0, 1);
    reflectance[i] = (float)result.c[i];
  }
  if (!w->rgb) vl_reflectance_at(space, reflectance, CHANNELS, w->nm, result.c);
  return scaled(factor, result);
}

/* X, Y and Z are integrals over the wavelengths of the radiance times the observer's curves (pbrt book 4.6.1). Each
 * wavelength estimates them: radiance times curve, divided by its density; the result is the mean of the four. */
void radiance_to_rgb(const observer *o, spectrum radiance, const wavelengths *w, double rgb[3]) {
  double xyz[3] = {0, 0, 0};
  for (int i = 0; i < CHANNELS; i++) {
    if (w->density[i] == 0) continue;
    for (int k = 0; k < 3; k++)
      xyz[k] += radiance.c[i] * table_at(o->xyz + k, 3, w->nm[i]) / (w->density[i] * CHANNELS);
  }
  for (int k = 0; k < 3; k++) {
    const double *row = o->rgb_from_xyz + 3 * k;
    rgb[k] = w->rgb ? radiance.c[k] : row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2];
  }
}
