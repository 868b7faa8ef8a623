/* color/color.h: spectra, colour spaces, and conversion between spectra and RGB. Wavelengths
 * are in nm, from 360 to 830. A dense spectrum is an array of 471 floats, one per nm,
 * interpolated linearly. RGB reflectances become smooth spectra s(l) = sigmoid(c0 l^2 + c1 l +
 * c2) (Jakob and Hanika 2019). The coefficients come from a table made at build time. */
#ifndef COLOR_COLOR_H
#define COLOR_COLOR_H

#include "math/approx.h"
#include "math/vec.h"
#include "velo/spectrum.h"

enum { VL_LAMBDA_MIN = 360, VL_LAMBDA_MAX = 830, VL_LAMBDA_COUNT = 471 };

/* c0, c1, c2 act on t = (lambda - 360) / 470, so that floats keep their precision. */
typedef struct vlSigmoid {
  float c0, c1, c2;
} vlSigmoid;
static inline float vl_sigmoid(vlSigmoid s, float lambda) {
  float t = (lambda - 360.0f) * (1.0f / 470.0f);
  float x = (s.c0 * t + s.c1) * t + s.c2;
  /* within [0,1]: the root is never below |x| */
  return 0.5f + 0.5f * (x / __builtin_sqrtf(1.0f + x * x));
}
/* Coefficients of the reflectance spectrum of an RGB colour. r, g and b are clamped to [0,1].
 * Black, white and greys give constant spectra. A call takes some microseconds. The result is
 * exact to 1e-6 for colours that a reflectance can have. For texels use the faster
 * vl_rgb_table_lookup (color/rgb_table.h). */
vlSigmoid vl_sigmoid_from_rgb(vlColorSpace space, float r, float g, float b);

/* Dense spectra of VL_LAMBDA_COUNT floats in static storage: the CIE 1931 2-degree observer and
 * the standard illuminant of a colour space. */
const float *vl_cie_x(void);
const float *vl_cie_y(void);
const float *vl_cie_z(void);
const float *vl_space_illuminant(vlColorSpace space);

/* The role of a spectrum, which determines how RGB becomes a spectrum (pbrt book 4.6.6). */
typedef enum vlSpectrumRole {
  VL_ROLE_ALBEDO,
  VL_ROLE_UNBOUNDED,
  VL_ROLE_ILLUMINANT
} vlSpectrumRole;

/* Writes the spectrum, including its scale, to `dense` (VL_LAMBDA_COUNT floats). RGB
 * illuminants are multiplied by the illuminant of the colour space. Errors: SCENE for an
 * unknown name (with the nearest one), wavelengths not ascending, values not finite. */
vlResult vl_spectrum_dense(const vlSpectrum *spectrum, vlSpectrumRole role, float *dense,
                           vlError *error);
/* Whether the spectrum is constant over all wavelengths; *value is then that constant. */
bool vl_spectrum_is_constant(const vlSpectrum *spectrum, float *value);
/* Integral of Y times the spectrum, as pbrt's SpectrumToPhotometric. For RGB illuminants it is
 * the integral of Y times the colour space's illuminant alone. Lights are divided by it, so
 * that an RGB light of (1,1,1) has luminance 1. 0: the spectrum has no light, or an error,
 * which is that of vl_spectrum_dense. */
double vl_spectrum_photometric(const vlSpectrum *spectrum, vlError *error);
/* The factor from a light's radiometric number to its photometric one, as that is before the
 * light's spectrum is divided by vl_spectrum_photometric: from W to lm, from W/m^2 to lx, from
 * W/sr to cd. It is 683 lm/W times vl_spectrum_photometric over the integral of the spectrum
 * from 360 to 830 nm (BIPM 2019, The International System of Units, appendix 3). 0: the
 * spectrum has no light, or an error, which is that of vl_spectrum_dense. */
double vl_spectrum_per_watt(const vlSpectrum *spectrum, vlError *error);
/* Converts a spectrum to linear RGB of a colour space, for VL_COLOR_RGB mode. For the roles
 * albedo and unbounded, the result is the colour under the space's illuminant; RGB spectra are
 * converted between spaces exactly. For the role illuminant, the result is the light's own
 * colour, with the same luminance as in spectral mode after the division by
 * vl_spectrum_photometric. */
vlResult vl_spectrum_to_rgb(const vlSpectrum *spectrum, vlSpectrumRole role, vlColorSpace space,
                            float rgb[3], vlError *error);
/* The same conversion of many RGB colours of one space to linear sRGB: those of images. */
typedef struct vlSrgbMap {
  bool needed; /* the colours are of another space */
  float m[9];  /* row-major 3x3; set if needed */
} vlSrgbMap;
vlSrgbMap vl_srgb_map(vlColorSpace from, vlSpectrumRole role);
/* Colours outside of sRGB lose their negative components, as in vl_spectrum_to_rgb. Colours of
 * sRGB stay as they are. */
static inline vlVec3 vl_to_srgb(const vlSrgbMap *map, vlVec3 rgb) {
  if (!map->needed)
    return rgb;
  vlVec3 c = vl_turn(map->m, rgb);
  return vl_vec3(vl_max(c.x, 0.0f), vl_max(c.y, 0.0f), vl_max(c.z, 0.0f));
}

/* Share of each channel of linear sRGB at each wavelength (Mallett and Yuksel 2019): three
 * spectra within [0, 1] with sum 1, whose colours under the space's illuminant are (1,0,0),
 * (0,1,0), (0,0,1). The array holds r, g, b, 0 for each nm. A medium with the channel
 * transmittances T_r, T_g, T_b has the spectral transmittance T(lambda) = sum_i share_i(lambda)
 * T_i. It lies in [0, 1] if all T_i do, and its colour is exactly T_r, T_g, T_b, even for very
 * small values. */
extern const float vl_channel_shares[VL_LAMBDA_COUNT * 4];

/* The names of the colour spaces in files, by vlColorSpace; null at the end. */
extern const char *const vl_color_space_names[];

/* Matrix from XYZ to linear RGB of the space, row-major 3x3. */
void vl_rgb_from_xyz(vlColorSpace space, float m[9]);
void vl_xyz_from_rgb(vlColorSpace space, float m[9]);
/* xy chromaticities of red, green, blue and white: r_x r_y g_x g_y b_x b_y w_x w_y. */
void vl_space_chromaticities(vlColorSpace space, float xy[8]);

/* Interpolates linearly in a dense spectrum; 0 outside of 360 to 830 nm. (The index is clamped
 * as an integer: if it were clamped as a float, gcc would not make a gather.) */
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

/* Transmittance at a wavelength from the transmittances t of linear sRGB's channels
 * (vl_channel_shares), interpolated linearly between integer nm. */
static inline float vl_channels_at(const float t[3], float lambda) {
  float x = lambda - 360.0f;
  int i = (int)x;
  i = i < VL_LAMBDA_COUNT - 2 ? i : VL_LAMBDA_COUNT - 2;
  i = i > 0 ? i : 0;
  const float *s = vl_channel_shares + 4 * i;
  float a = s[0] * t[0] + s[1] * t[1] + s[2] * t[2],
        b = s[4] * t[0] + s[5] * t[1] + s[6] * t[2];
  return a + (x - (float)i) * (b - a);
}

/* The sRGB curve (IEC 61966-2-1) for the 256 codes, and the range of linear values that rounds
 * to each code: code c stands for values from vl_srgb8_begin[c] up to vl_srgb8_begin[c + 1].
 * The first are correctly rounded floats, the second are rounded up. */
extern const float vl_srgb8_to_linear[256];
extern const float vl_srgb8_begin[256];

/* The density of sampled wavelengths is piecewise linear between VL_VISIBLE_KNOTS wavelengths.
 * Its values are found by numerical minimisation: four wavelengths, rotated by quarters through
 * the cumulative distribution, have nearly the same sum of RGB for usual lights and
 * reflectances (docs/tracers.md). Each row: the cumulative distribution at the wavelength, the
 * wavelength (nm), the density (1 / nm), twice the slope up to the next row. */
enum { VL_VISIBLE_KNOTS = 12 };
extern const float vl_visible_knots[VL_VISIBLE_KNOTS * 4];

/* Samples a wavelength by inverting the cumulative distribution: with t the rest of u within a
 * segment that starts with density p and has slope s, the density is sqrt(p^2 + 2 s t). u in
 * [0,1). Writes 1 / density (nm). */
static inline float vl_visible_lambda(float u, float *inv_pdf) {
  const float *k = vl_visible_knots;
  int i = (u >= k[4]) + (u >= k[8]) + (u >= k[12]) + (u >= k[16]) + (u >= k[20]) +
          (u >= k[24]) + (u >= k[28]) + (u >= k[32]) + (u >= k[36]) + (u >= k[40]);
  i = 4 * i;
  float t = u - k[i], from = k[i + 2];
  float pdf = __builtin_sqrtf(from * from + k[i + 3] * t);
  float lambda = k[i + 1] + 2.0f * t / (from + pdf);
  *inv_pdf = 1.0f / pdf;
  return lambda < 830.0f ? lambda : 830.0f; /* rounding may leave the range slightly */
}

#endif
