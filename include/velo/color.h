/** @file
 * velo/color.h: the numbers behind a vlSpectrum: its values at wavelengths, its luminance, its
 * colour. For programs that compute light from a scene's description themselves. Wavelengths
 * are in nm, from 360 to 830. Any thread may call these functions; they keep nothing. */
#ifndef VELO_COLOR_H
#define VELO_COLOR_H

#include "velo/schema.h"
#include "velo/spectrum.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A tabulated spectrum has one value for each nm from 360 to 830, both included; between them
 * it is linear, outside it is 0. */
enum { VL_SPECTRUM_FIRST_NM = 360, VL_SPECTRUM_VALUES = 471 };

/** Writes the values of a spectrum, with its scale. The role says how an RGB value becomes a
 * spectrum (Jakob and Hanika 2019; pbrt book 4.6.6): VL_PARAMETER_ALBEDO, a reflectance;
 * VL_PARAMETER_UNBOUNDED, 2 max(r, g, b) times a reflectance; VL_PARAMETER_ILLUMINANT, the same
 * times the white of the colour space. Errors: ARGUMENT (null, no role), SCENE (unknown name,
 * numbers that are not finite, wavelengths that do not ascend). */
VL_API vlResult vl_spectrum_tabulate(const vlSpectrum *spectrum, vlParameterRole role,
                                     float values[VL_SPECTRUM_VALUES], vlError *error);
/** The number by which the spectrum of a light is divided, so that scale alone sets its
 * brightness: the sum over all nm of its values times the observer's y; for an RGB value that
 * of the white of its colour space (pbrt's SpectrumToPhotometric, book 12.1). 0 after an error,
 * which is that of vl_spectrum_tabulate. */
VL_API double vl_spectrum_luminance(const vlSpectrum *spectrum, vlError *error);
/** The spectrum as linear sRGB, as VL_COLOR_RGB renders it: a light's own colour at luminance 1
 * times its scale, else the colour under the white. Errors: as vl_spectrum_tabulate. */
VL_API vlResult vl_spectrum_linear_rgb(const vlSpectrum *spectrum, vlParameterRole role,
                                       float rgb[3], vlError *error);

/** Values at `count` wavelengths of the reflectance spectrum that has a linear colour, clamped
 * to [0, 1], for texels: the table's interpolation, exact to 1e-3. ARGUMENT: a null pointer, an
 * unknown space. */
VL_API vlResult vl_reflectance_at(vlColorSpace space, const float rgb[3], uint32_t count,
                                  const double *wavelengths, double *values);
/** The CIE 1931 2-degree observer: x, y, z for each nm. */
VL_API void vl_observer_tabulate(float xyz[3 * VL_SPECTRUM_VALUES]);
/** Three spectra s_R, s_G, s_B for each nm, each from 0 to 1; their sum is 1. What leaves the
 * shares t_R, t_G and t_B of the channels of linear sRGB, leaves the share s_R t_R + s_G t_G +
 * s_B t_B at a wavelength (Mallett and Yuksel 2019; docs/media.md: absorption by channel,
 * colours of what transmits light). */
VL_API void vl_channels_tabulate(float shares[3 * VL_SPECTRUM_VALUES]);
/** The white of a colour space, for each nm. ARGUMENT: an unknown space. */
VL_API vlResult vl_white_tabulate(vlColorSpace space, float values[VL_SPECTRUM_VALUES]);
/** The row-major matrix from XYZ to the linear RGB of a colour space. ARGUMENT: an unknown
 * space. */
VL_API vlResult vl_color_space_matrix(vlColorSpace space, double rgb_from_xyz[9]);

#ifdef __cplusplus
}
#endif
#endif
