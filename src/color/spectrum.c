/* color/spectrum.c: evaluates a vlSpectrum: its values every nm, its luminance, its colour. */
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "color/named.h"
#include "color/tables.h"
#include "math/double3.h"
#include "math/elementary.h"

static vlResult unknown_name(const char *name, vlError *error) {
  enum { MAX_NAMES = 128 };
  const char *names[MAX_NAMES];
  uint32_t count = vl_table_named_count < MAX_NAMES ? vl_table_named_count : MAX_NAMES;
  for (uint32_t i = 0; i < count; i++)
    names[i] = vl_table_named[i].name;
  const char *nearest = name ? vl_nearest_name(name, names, count) : NULL;
  if (nearest)
    return vl_fail(error, VL_ERROR_SCENE, "unknown spectrum \"%s\"; did you mean \"%s\"?",
                   vl_argument_text(name).text, nearest);
  return vl_fail(error, VL_ERROR_SCENE, "unknown spectrum \"%s\"", vl_argument_text(name).text);
}

/* Validates a spectrum. */
static vlResult check(const vlSpectrum *s, vlError *error) {
  if (!s)
    return vl_fail_argument(error, "spectrum is null");
  if (!isfinite(s->scale))
    return vl_fail(error, VL_ERROR_SCENE, "the spectrum's scale is not finite");
  switch (s->kind) {
    case VL_SPECTRUM_CONSTANT:
      if (!isfinite(s->value))
        return vl_fail(error, VL_ERROR_SCENE, "the spectrum's value is not finite");
      return VL_OK;
    case VL_SPECTRUM_RGB:
      if (!isfinite(s->rgb[0]) || !isfinite(s->rgb[1]) || !isfinite(s->rgb[2]))
        return vl_fail(error, VL_ERROR_SCENE, "an RGB value is not finite");
      if ((unsigned)s->space > VL_SPACE_ACES2065_1)
        return vl_fail_argument(error, "unknown colour space %d", (int)s->space);
      return VL_OK;
    case VL_SPECTRUM_BLACKBODY:
      if (!(s->kelvin > 0) || !isfinite(s->kelvin))
        return vl_fail(error, VL_ERROR_SCENE,
                       "a black body needs a temperature above 0 kelvin, not %g",
                       (double)s->kelvin);
      return VL_OK;
    case VL_SPECTRUM_SAMPLED:
      if (s->count == 0 || !s->wavelengths || !s->values)
        return vl_fail(error, VL_ERROR_SCENE, "the spectrum has no samples");
      for (uint32_t i = 0; i < s->count; i++) {
        if (!isfinite(s->wavelengths[i]) || !isfinite(s->values[i]))
          return vl_fail(error, VL_ERROR_SCENE, "the spectrum's sample %u is not finite",
                         i + 1);
        if (i > 0 && !(s->wavelengths[i] > s->wavelengths[i - 1]))
          return vl_fail(error, VL_ERROR_SCENE,
                         "the spectrum's wavelengths must ascend: %g after %g",
                         (double)s->wavelengths[i], (double)s->wavelengths[i - 1]);
      }
      return VL_OK;
    case VL_SPECTRUM_NAMED:
      return vl_named_spectrum(s->name) ? VL_OK : unknown_name(s->name, error);
  }
  return vl_fail_argument(error, "unknown kind of spectrum %d", (int)s->kind);
}

/* Planck's law, divided by its maximum: (x / xm)^5 (e^xm - 1) / (e^x - 1), x = hc / (lambda k
 * T); xm is the x of the maximum, by Wien's displacement law. lambda: nm. */
static float blackbody(double lambda, double kelvin) {
  const double hc_over_k = 1.438776877e7; /* nm K */
  const double xm = 4.965114231744276;
  const double peak = 142.32492159405578; /* e^xm - 1 */
  double x = hc_over_k / (lambda * kelvin);
  double u = x / xm;
  double value = u * u * (u * u) * u * peak / vl_precise_expm1(x);
  return isfinite(value) ? (float)value : 0.0f; /* low temperatures give infinity / infinity */
}

/* Interpolates the samples linearly; 0 outside of them. */
static void sampled(const vlSpectrum *s, float *dense) {
  uint32_t j = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    double l = VL_LAMBDA_MIN + i;
    while (j + 1 < s->count && (double)s->wavelengths[j + 1] <= l)
      j++;
    double low = (double)s->wavelengths[j], value = 0;
    if (l == low) {
      value = (double)s->values[j];
    } else if (l > low && j + 1 < s->count) {
      double t = (l - low) / ((double)s->wavelengths[j + 1] - low);
      value = (double)s->values[j] + t * ((double)s->values[j + 1] - (double)s->values[j]);
    }
    dense[i] = (float)(value * (double)s->scale);
  }
}

/* Converts RGB to a spectrum by its role. Albedo: a reflectance. Unbounded: scale * reflectance
 * with scale = 2 max(r, g, b), which keeps the sigmoid in its accurate range. Illuminant: the
 * unbounded spectrum times the illuminant of the colour space (pbrt book 4.6.6). */
static void from_rgb(const vlSpectrum *s, vlSpectrumRole role, float *dense) {
  float rgb[3], scale = s->scale, high = 0;
  for (int i = 0; i < 3; i++) {
    rgb[i] = s->rgb[i] > 0 ? s->rgb[i] : 0;
    high = rgb[i] > high ? rgb[i] : high;
  }
  if (role != VL_ROLE_ALBEDO) {
    for (int i = 0; i < 3 && high > 0; i++)
      rgb[i] = 0.5f * (rgb[i] / high);
    scale = 2 * high * s->scale;
  }
  vlSigmoid c = vl_sigmoid_from_rgb(s->space, rgb[0], rgb[1], rgb[2]);
  const float *light = vl_space_illuminant(s->space);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    float value = scale * vl_sigmoid(c, (float)(VL_LAMBDA_MIN + i));
    dense[i] = role == VL_ROLE_ILLUMINANT ? value * light[i] : value;
  }
}

vlResult vl_spectrum_dense(const vlSpectrum *spectrum, vlSpectrumRole role, float *dense,
                           vlError *error) {
  VL_TRY(check(spectrum, error));
  switch (spectrum->kind) {
    case VL_SPECTRUM_CONSTANT:
      for (int i = 0; i < VL_LAMBDA_COUNT; i++)
        dense[i] = spectrum->value * spectrum->scale;
      break;
    case VL_SPECTRUM_RGB:
      from_rgb(spectrum, role, dense);
      break;
    case VL_SPECTRUM_BLACKBODY:
      for (int i = 0; i < VL_LAMBDA_COUNT; i++)
        dense[i] =
            spectrum->scale * blackbody((double)(VL_LAMBDA_MIN + i), (double)spectrum->kelvin);
      break;
    case VL_SPECTRUM_SAMPLED:
      sampled(spectrum, dense);
      break;
    case VL_SPECTRUM_NAMED: {
      const float *values = vl_named_spectrum(spectrum->name);
      for (int i = 0; i < VL_LAMBDA_COUNT; i++)
        dense[i] = spectrum->scale * values[i];
      break;
    }
  }
  /* finite samples may overflow when scaled */
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    if (!isfinite(dense[i]))
      return vl_fail(error, VL_ERROR_SCENE, "the spectrum's values are too large");
  }
  return VL_OK;
}

bool vl_spectrum_is_constant(const vlSpectrum *spectrum, float *value) {
  if (!spectrum)
    return false;
  const vlSpectrum *s = spectrum;
  if (s->kind == VL_SPECTRUM_CONSTANT) {
    *value = s->value * s->scale;
    return true;
  }
  if (s->kind == VL_SPECTRUM_SAMPLED && s->count > 1 && s->wavelengths && s->values &&
      s->wavelengths[0] <= VL_LAMBDA_MIN && s->wavelengths[s->count - 1] >= VL_LAMBDA_MAX) {
    for (uint32_t i = 1; i < s->count; i++) {
      if (s->values[i] != s->values[0])
        return false;
    }
    *value = s->values[0] * s->scale;
    return true;
  }
  const float *named = s->kind == VL_SPECTRUM_NAMED ? vl_named_spectrum(s->name) : NULL;
  if (!named)
    return false;
  for (int i = 1; i < VL_LAMBDA_COUNT; i++) {
    if (named[i] != named[0])
      return false;
  }
  *value = named[0] * s->scale;
  return true;
}

/* X, Y, Z: sums over each nm of the CIE matching functions times the spectrum, and times a
 * light unless that is null. */
static void integrate(const float *dense, const float *light, double xyz[3]) {
  for (int k = 0; k < 3; k++) {
    xyz[k] = 0;
    for (int i = 0; i < VL_LAMBDA_COUNT; i++)
      xyz[k] +=
          (double)vl_table_cie[k][i] * (double)dense[i] * (light ? (double)light[i] : 1.0);
  }
}

double vl_spectrum_photometric(const vlSpectrum *spectrum, vlError *error) {
  float dense[VL_LAMBDA_COUNT];
  double xyz[3];
  if (spectrum->kind == VL_SPECTRUM_RGB) {
    if (check(spectrum, error) != VL_OK)
      return 0;
    return vl_table_named[vl_table_spaces[spectrum->space].illuminant].y;
  }
  if (vl_spectrum_dense(spectrum, VL_ROLE_ILLUMINANT, dense, error) != VL_OK)
    return 0;
  integrate(dense, NULL, xyz);
  return xyz[1];
}

double vl_spectrum_per_watt(const vlSpectrum *spectrum, vlError *error) {
  const double lumens_per_watt = 683.0;
  float dense[VL_LAMBDA_COUNT];
  if (vl_spectrum_dense(spectrum, VL_ROLE_ILLUMINANT, dense, error) != VL_OK)
    return 0;
  double sum = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    sum += (double)dense[i];
  return sum > 0 ? lumens_per_watt * vl_spectrum_photometric(spectrum, error) / sum : 0;
}

/* Converts RGB between colour spaces. Reflectances are adapted to the white of the new space
 * (Bradford cone responses, von Kries scaling). Lights are not adapted. If the whites are
 * equal, there is no difference. */
static void convert(vlColorSpace from, vlColorSpace to, bool adapt, const double rgb[3],
                    double out[3]) {
  static const double cone[9] = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                 0.0367, 0.0389, -0.0685, 1.0296};
  static const double back[9] = {0.9869929, -0.1470543, 0.1599627, 0.4323053, 0.5183603,
                                 0.0492912, -0.0085287, 0.0400428, 0.9684867};
  const vlSpaceTable *a = &vl_table_spaces[from], *b = &vl_table_spaces[to];
  double xyz[3], lms[3];
  vl_mat3_vector(a->xyz_from_rgb, rgb, xyz);
  if (adapt && a->illuminant != b->illuminant) {
    for (int i = 0; i < 3; i++) {
      double old_white = 0, new_white = 0;
      lms[i] = 0;
      for (int k = 0; k < 3; k++) {
        const double *m = a->xyz_from_rgb + 3 * k, *n = b->xyz_from_rgb + 3 * k;
        old_white += cone[3 * i + k] * (m[0] + m[1] + m[2]);
        new_white += cone[3 * i + k] * (n[0] + n[1] + n[2]);
        lms[i] += cone[3 * i + k] * xyz[k];
      }
      lms[i] *= new_white / old_white;
    }
    vl_mat3_vector(back, lms, xyz);
  }
  vl_mat3_vector(b->rgb_from_xyz, xyz, out);
}

vlSrgbMap vl_srgb_map(vlColorSpace from, vlSpectrumRole role) {
  vlSrgbMap map = {.needed = from != VL_SPACE_SRGB};
  for (int column = 0; map.needed && column < 3; column++) {
    double primary[3] = {0, 0, 0}, srgb[3];
    primary[column] = 1;
    convert(from, VL_SPACE_SRGB, role != VL_ROLE_ILLUMINANT, primary, srgb);
    for (int row = 0; row < 3; row++)
      map.m[3 * row + column] = (float)srgb[row];
  }
  return map;
}

vlResult vl_spectrum_to_rgb(const vlSpectrum *spectrum, vlSpectrumRole role, vlColorSpace space,
                            float rgb[3], vlError *error) {
  float dense[VL_LAMBDA_COUNT], constant;
  VL_TRY(vl_spectrum_dense(spectrum, role, dense, error));
  if ((unsigned)space > VL_SPACE_ACES2065_1)
    return vl_fail_argument(error, "unknown colour space %d", (int)space);
  double out[3];
  if (spectrum->kind == VL_SPECTRUM_RGB) {
    double in[3];
    for (int i = 0; i < 3; i++)
      in[i] = out[i] = (double)spectrum->rgb[i] * (double)spectrum->scale;
    if (spectrum->space != space)
      convert(spectrum->space, space, role != VL_ROLE_ILLUMINANT, in, out);
  } else if (role != VL_ROLE_ILLUMINANT && vl_spectrum_is_constant(spectrum, &constant)) {
    for (int i = 0; i < 3; i++)
      out[i] = (double)constant;
  } else {
    double xyz[3];
    integrate(dense, role == VL_ROLE_ILLUMINANT ? NULL : vl_space_illuminant(space), xyz);
    double unit = role == VL_ROLE_ILLUMINANT ? xyz[1] : vl_table_y_integral;
    vl_mat3_vector(vl_table_spaces[space].rgb_from_xyz, xyz, out);
    for (int i = 0; i < 3; i++)
      out[i] = unit != 0 ? out[i] / unit : 0;
  }
  for (int i = 0; i < 3; i++) {
    double v = out[i] > 0 ? out[i] : 0; /* negative for colours outside of the gamut */
    rgb[i] = (float)(role == VL_ROLE_ALBEDO && v > 1 ? 1 : v);
  }
  return VL_OK;
}
