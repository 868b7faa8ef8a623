/* color/tabulate.c: the public functions that tell a program the numbers behind a spectrum
 * (velo/color.h). */
#include "velo/color.h"

#include <string.h>

#include "base/error.h"
#include "color/rgb_table.h"

_Static_assert((int)VL_SPECTRUM_VALUES == (int)VL_LAMBDA_COUNT, "one number of values");
_Static_assert((int)VL_SPECTRUM_FIRST_NM == (int)VL_LAMBDA_MIN, "one first wavelength");

/* The internal role of a public one. False: it has none. */
static bool role_of(vlParameterRole role, vlSpectrumRole *result) {
  switch (role) {
    case VL_PARAMETER_NO_ROLE:
      return false;
    case VL_PARAMETER_ALBEDO:
      *result = VL_ROLE_ALBEDO;
      return true;
    case VL_PARAMETER_UNBOUNDED:
      *result = VL_ROLE_UNBOUNDED;
      return true;
    case VL_PARAMETER_ILLUMINANT:
      *result = VL_ROLE_ILLUMINANT;
      return true;
  }
  return false;
}

static bool is_space(vlColorSpace space) {
  return (unsigned)space <= VL_SPACE_ACES2065_1;
}

vlResult vl_spectrum_tabulate(const vlSpectrum *spectrum, vlParameterRole role,
                              float values[VL_SPECTRUM_VALUES], vlError *error) {
  vlSpectrumRole own;
  if (!spectrum || !values)
    return vl_fail_argument(error, "spectrum or values is null");
  if (!role_of(role, &own))
    return vl_fail_argument(error, "%d is not the role of a spectrum", (int)role);
  return vl_spectrum_dense(spectrum, own, values, error);
}

double vl_spectrum_luminance(const vlSpectrum *spectrum, vlError *error) {
  if (!spectrum) {
    vl_fail_argument(error, "spectrum is null");
    return 0;
  }
  return vl_spectrum_photometric(spectrum, error);
}

vlResult vl_spectrum_linear_rgb(const vlSpectrum *spectrum, vlParameterRole role, float rgb[3],
                                vlError *error) {
  vlSpectrumRole own;
  if (!spectrum || !rgb)
    return vl_fail_argument(error, "spectrum or rgb is null");
  if (!role_of(role, &own))
    return vl_fail_argument(error, "%d is not the role of a spectrum", (int)role);
  return vl_spectrum_to_rgb(spectrum, own, VL_SPACE_SRGB, rgb, error);
}

vlResult vl_reflectance_at(vlColorSpace space, const float rgb[3], uint32_t count,
                           const double *wavelengths, double *values) {
  if (!rgb || (count > 0 && (!wavelengths || !values)) || !is_space(space))
    return VL_ERROR_ARGUMENT;
  vlSigmoid sigmoid = vl_rgb_table_lookup(vl_rgb_table(space), rgb[0], rgb[1], rgb[2]);
  for (uint32_t i = 0; i < count; i++)
    values[i] = (double)vl_sigmoid(sigmoid, (float)wavelengths[i]);
  return VL_OK;
}

void vl_observer_tabulate(float xyz[3 * VL_SPECTRUM_VALUES]) {
  const float *const tables[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    for (int k = 0; k < 3; k++)
      xyz[3 * i + k] = tables[k][i];
  }
}

void vl_channels_tabulate(float shares[3 * VL_SPECTRUM_VALUES]) {
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    for (int k = 0; k < 3; k++)
      shares[3 * i + k] = vl_channel_shares[4 * i + k];
  }
}

vlResult vl_white_tabulate(vlColorSpace space, float values[VL_SPECTRUM_VALUES]) {
  if (!values || !is_space(space))
    return VL_ERROR_ARGUMENT;
  memcpy(values, vl_space_illuminant(space), VL_LAMBDA_COUNT * sizeof *values);
  return VL_OK;
}

vlResult vl_color_space_matrix(vlColorSpace space, double rgb_from_xyz[9]) {
  float matrix[9];
  if (!rgb_from_xyz || !is_space(space))
    return VL_ERROR_ARGUMENT;
  vl_rgb_from_xyz(space, matrix);
  for (int i = 0; i < 9; i++)
    rgb_from_xyz[i] = (double)matrix[i];
  return VL_OK;
}
