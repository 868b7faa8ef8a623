/* color.c: from spectra to numbers at four wavelengths, and from these to red, green and blue. */
#include "color.h"

/* ---- the wavelengths of a path (pbrt book 4.5.4) ----------------------------------------------------------------- */

static const double LOWEST = 360, HIGHEST = 830;

/* The density of wavelengths: high where the eye sees well. It is the derivative of a tanh, so that it can be inverted:
 * p(l) = .0039398042 / cosh^2(.0072 (l - 538)), zero outside of 360 to 830 nm. */
static double wavelength_density(double nm) {
  return nm < LOWEST || nm > HIGHEST ? 0 : 0.0039398042 / square(cosh(0.0072 * (nm - 538)));
}
static double wavelength_of(double u) {
  return 538 - 138.888889 * atanh(0.85691062 - 1.82750197 * u);
}

/* One random number serves all four: they lie a quarter of the distribution apart. */
wavelengths sample_wavelengths(bool rgb, sampler *s) {
  wavelengths w = {.rgb = rgb};
  double u = next_number(s);
  for (int i = 0; i < CHANNELS; i++) {
    double shifted = u + (double)i / CHANNELS;
    w.nm[i] = wavelength_of(shifted - floor(shifted));
    w.density[i] = wavelength_density(w.nm[i]);
  }
  return w;
}

/* The three others get density 0, which removes them from the mean in radiance_to_rgb. The first one must then count
 * four times: its density as one of four becomes a quarter. */
void keep_first_wavelength(wavelengths *w) {
  if (w->rgb || w->density[1] == 0) return;
  for (int i = 1; i < CHANNELS; i++) w->density[i] = 0;
  w->density[0] /= CHANNELS;
}

/* ---- spectra of the scene ---------------------------------------------------------------------------------------- */

/* The value of a table with one number per nm, linear between them. */
static double table_at(const float *table, int stride, double nm) {
  double x = nm - VL_SPECTRUM_FIRST_NM;
  if (x < 0 || x > VL_SPECTRUM_VALUES - 1) return 0;
  int i = x < VL_SPECTRUM_VALUES - 1 ? (int)x : VL_SPECTRUM_VALUES - 2;
  double a = (double)table[stride * i];
  double b = (double)table[stride * (i + 1)];
  return a + (x - i) * (b - a);
}

bool read_color(const vlSpectrum *s, vlParameterRole role, color *result, vlError *error) {
  if (vl_spectrum_tabulate(s, role, result->nm, error) != VL_OK) return false;
  if (vl_spectrum_linear_rgb(s, role, result->rgb, error) != VL_OK) return false;
  if (role != VL_PARAMETER_ILLUMINANT) return true;
  double luminance = vl_spectrum_luminance(s, error);
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++)
    result->nm[i] = luminance > 0 ? (float)((double)result->nm[i] / luminance) : 0;
  return true;
}

void white_light(vlColorSpace space, color *result) {
  static const float white[3] = {1, 1, 1};
  vlSpectrum s = vl_spectrum_rgb(white[0], white[1], white[2]);
  s.space = space;
  double luminance = vl_spectrum_luminance(&s, NULL);
  vl_white_tabulate(space, result->nm);
  for (int i = 0; i < VL_SPECTRUM_VALUES; i++) result->nm[i] = (float)((double)result->nm[i] / luminance);
  for (int i = 0; i < 3; i++) result->rgb[i] = white[i];
}

spectrum color_at(const color *c, const wavelengths *w) {
  spectrum result = {{0}};
  for (int i = 0; i < CHANNELS; i++) {
    if (!w->rgb) result.c[i] = table_at(c->nm, 1, w->nm[i]);
    if (w->rgb) result.c[i] = (double)c->rgb[i < 3 ? i : 2];
  }
  return result;
}

/* ---- texels ------------------------------------------------------------------------------------------------------ */

spectrum reflectance_of(vlColorSpace space, const double rgb[3], const wavelengths *w) {
  spectrum result = {{0}};
  if (w->rgb) {
    for (int i = 0; i < CHANNELS; i++) result.c[i] = clamp(rgb[i < 3 ? i : 2], 0, 1);
    return result;
  }
  float clamped[3];
  for (int i = 0; i < 3; i++) clamped[i] = (float)clamp(rgb[i], 0, 1);
  vl_reflectance_at(space, clamped, CHANNELS, w->nm, result.c);
  return result;
}

/* Colours above 1: twice the largest component times a reflectance (pbrt book 4.6.6). */
spectrum unbounded_of(vlColorSpace space, const double rgb[3], const wavelengths *w) {
  double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));
  if (!(most > 0)) return gray(0);
  double half[3];
  for (int i = 0; i < 3; i++) half[i] = rgb[i] / (2 * most);
  return scaled(2 * most, reflectance_of(space, half, w));
}

/* ---- radiance to RGB --------------------------------------------------------------------------------------------- */

/* X, Y and Z are integrals of the radiance times the observer's curves. Each wavelength estimates them: its value times
 * the curve, divided by its density; the four estimates are averaged. */
void radiance_to_rgb(spectrum radiance, const wavelengths *w, vlColorSpace space, double rgb[3]) {
  static float observer[3 * VL_SPECTRUM_VALUES];
  static double to_rgb[9];
  static vlColorSpace space_of_matrix;
  static bool ready = false;
  if (!ready || space != space_of_matrix) {
    vl_observer_tabulate(observer);
    vl_color_space_matrix(space, to_rgb);
    space_of_matrix = space;
    ready = true;
  }
  if (w->rgb) {
    for (int i = 0; i < 3; i++) rgb[i] = radiance.c[i];
    return;
  }
  double xyz[3] = {0, 0, 0};
  for (int i = 0; i < CHANNELS; i++) {
    if (w->density[i] == 0) continue;
    for (int k = 0; k < 3; k++)
      xyz[k] += radiance.c[i] * table_at(observer + k, 3, w->nm[i]) / (w->density[i] * CHANNELS);
  }
  for (int k = 0; k < 3; k++) rgb[k] = to_rgb[3 * k] * xyz[0] + to_rgb[3 * k + 1] * xyz[1] + to_rgb[3 * k + 2] * xyz[2];
}
