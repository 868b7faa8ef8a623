/* color/color.h: spectra, colour spaces, and the way between spectra and RGB.
 *
 * Wavelengths in nm, 360 to 830. A dense spectrum is 471 floats, one a nm, linear between. RGB reflectances become
 * smooth spectra s(l) = sigmoid(c0 l^2 + c1 l + c2) (Jakob and Hanika 2019), looked up in a table made at build time.
 */
#ifndef COLOR_COLOR_H
#define COLOR_COLOR_H

#include "math/approx.h"
#include "math/vec.h"
#include "velo/scene.h"

enum { VL_LAMBDA_MIN = 360, VL_LAMBDA_MAX = 830, VL_LAMBDA_COUNT = 471 };

/* c0, c1, c2 act on t = (lambda - 360) / 470, so that floats keep their precision. */
typedef struct vlSigmoid {
  float c0, c1, c2;
} vlSigmoid;
static inline float vl_sigmoid(vlSigmoid s, float lambda) {
  float t = (lambda - 360.0f) * (1.0f / 470.0f);
  float x = (s.c0 * t + s.c1) * t + s.c2;
  return 0.5f + 0.5f * (x / __builtin_sqrtf(1.0f + x * x)); /* never outside [0,1]: the root is never below |x| */
}
/* rgb in [0,1] of the space, clamped. Black, white and greys are constant spectra. Some microseconds: exact to 1e-6
 * where a reflectance can be of that colour at all; for texels there is vl_rgb_table_lookup (color/rgb_table.h). */
vlSigmoid vl_sigmoid_from_rgb(vlColorSpace space, float r, float g, float b);

/* Dense tables, VL_LAMBDA_COUNT floats each: CIE 1931 2-degree observer, standard illuminant of a colour space. */
const float *vl_cie_x(void);
const float *vl_cie_y(void);
const float *vl_cie_z(void);
const float *vl_space_illuminant(vlColorSpace space);

/* What a spectrum stands for, which decides how RGB becomes a spectrum (pbrt book 4.6.6). */
typedef enum vlSpectrumRole { VL_ROLE_ALBEDO, VL_ROLE_UNBOUNDED, VL_ROLE_ILLUMINANT } vlSpectrumRole;

/* Fills dense (VL_LAMBDA_COUNT) with the spectrum, its scale included; RGB illuminants times the space's illuminant.
 * Errors: SCENE for an unknown name (nearest named), wavelengths not ascending, values not finite. */
vlResult vl_spectrum_dense(const vlSpectrum *spectrum, vlSpectrumRole role, float *dense, vlError *error);
/* true when the spectrum has one value at all wavelengths (then *value). */
bool vl_spectrum_is_constant(const vlSpectrum *spectrum, float *value);
/* Integral of Y times s (for RGB illuminants: of the space's illuminant alone), pbrt's SpectrumToPhotometric: lights
 * are divided by it so that an RGB light of (1,1,1) has luminance 1. */
double vl_spectrum_photometric(const vlSpectrum *spectrum, vlError *error);
/* Linear RGB of the space for VL_COLOR_RGB mode. Albedo/unbounded: under the space's illuminant (RGB kinds: exact,
 * converted between spaces); illuminant: the light's own colour, luminance as in spectral mode after the photometric
 * division. */
vlResult vl_spectrum_to_rgb(const vlSpectrum *spectrum, vlSpectrumRole role, vlColorSpace space, float rgb[3],
                            vlError *error);

/* How the channels of linear sRGB share each wavelength (Mallett and Yuksel 2019): three spectra within [0, 1],
 * together 1, whose colours under the space's illuminant are (1,0,0), (0,1,0), (0,0,1). r, g, b, 0 of each nm. What
 * passes a share of each channel, T_r, T_g, T_b, passes T(lambda) = sum_i share_i(lambda) T_i: in [0, 1] where T_i are,
 * and of that colour exactly, however small they are. */
extern const float vl_channel_shares[VL_LAMBDA_COUNT * 4];

/* Row-major 3x3. */
void vl_rgb_from_xyz(vlColorSpace space, float m[9]);
void vl_xyz_from_rgb(vlColorSpace space, float m[9]);
/* r_x r_y g_x g_y b_x b_y w_x w_y */
void vl_space_chromaticities(vlColorSpace space, float xy[8]);

/* Linear interpolation in a dense spectrum; 0 outside. (The index is clamped as an integer: clamped as a float it keeps
 * gcc from making a gather of it.) */
static inline float vl_dense_at(const float *dense, float lambda) {
  float x = lambda - 360.0f;
  int i = (int)x;
  i = i < VL_LAMBDA_COUNT - 2 ? i : VL_LAMBDA_COUNT - 2;
  i = i > 0 ? i : 0;
  float a = dense[i], b = dense[i + 1];
  float value = a + (x - (float)i) * (b - a);
  value = x >= 0.0f ? value : 0.0f;
  return x <= 470.0f ? value : 0.0f;
}

/* T(lambda) of the shares t of linear sRGB's channels; linear between whole nm. */
static inline float vl_channels_at(const float t[3], float lambda) {
  float x = lambda - 360.0f;
  int i = (int)x;
  i = i < VL_LAMBDA_COUNT - 2 ? i : VL_LAMBDA_COUNT - 2;
  i = i > 0 ? i : 0;
  const float *s = vl_channel_shares + 4 * i;
  float a = s[0] * t[0] + s[1] * t[1] + s[2] * t[2], b = s[4] * t[0] + s[5] * t[1] + s[6] * t[2];
  return a + (x - (float)i) * (b - a);
}

/* Hero wavelengths: lambda with density proportional to the observer's sensitivity (Radziszewski et al. 2009, pbrt book
 * 4.5.4). u in [0,1). */
static inline float vl_visible_lambda(float u) {
  float t = 0.85691062f - 1.82750197f * u;
  float atanh_t = 0.5f * vl_ln((1.0f + t) / (1.0f - t));
  return 538.0f - 138.888889f * atanh_t;
}
static inline float vl_visible_pdf(float lambda) {
  float e = vl_exp(0.0072f * (lambda - 538.0f));
  float c = 0.5f * (e + 1.0f / e);
  float p = 0.0039398042f / (c * c);
  return lambda < 360.0f || lambda > 830.0f ? 0.0f : p;
}

#endif
