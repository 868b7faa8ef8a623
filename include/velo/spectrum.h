/** @file
 * velo/spectrum.h: spectra by value, and inputs: numbers and spectra that may be textured. */
#ifndef VELO_SPECTRUM_H
#define VELO_SPECTRUM_H

#include "velo/scene_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Colour spaces of RGB values, all linear: sRGB (Rec. 709), DCI-P3, Rec. 2020, ACES 2065-1. */
typedef enum vlColorSpace {
  VL_SPACE_SRGB,
  VL_SPACE_DCI_P3,
  VL_SPACE_REC2020,
  VL_SPACE_ACES2065_1
} vlColorSpace;

/** How a spectrum is given. */
typedef enum vlSpectrumKind {
  VL_SPECTRUM_CONSTANT, /**< `value` at every wavelength */
  VL_SPECTRUM_RGB, /**< `rgb` in `space`; the role of the parameter (vlParameterRole) decides
                    * how it becomes a spectrum
                    */
  VL_SPECTRUM_BLACKBODY, /**< a black body at `kelvin`, normalised to maximum 1 */
  VL_SPECTRUM_SAMPLED,   /**< `count` pairs of wavelength and value: linear between them, 0
                            outside */
  VL_SPECTRUM_NAMED      /**< `name`: "metal-Au-eta", "glass-BK7", "stdillum-D65", ...
                          * (vl_spectrum_name)
                          */
} vlSpectrumKind;
/** A spectrum by value. Only `scale` and the fields of the kind are read. */
typedef struct vlSpectrum {
  vlSpectrumKind kind; /**< which fields below are read */
  float scale;         /**< factor on all values */
  float value;         /**< CONSTANT */
  float rgb[3];        /**< RGB: linear */
  vlColorSpace space;  /**< RGB: the colour space */
  float kelvin;        /**< BLACKBODY: temperature */
  uint32_t count;      /**< SAMPLED: number of pairs */
  /** SAMPLED: wavelengths in nm, ascending, and the values at them */
  const float *wavelengths, *values;
  const char *name; /**< NAMED */
} vlSpectrum;
/** The same value at every wavelength. */
VL_API vlSpectrum vl_spectrum_constant(float value);
/** A linear sRGB colour. */
VL_API vlSpectrum vl_spectrum_rgb(float r, float g, float b);
/** A black body at this temperature, in kelvin, normalised to maximum 1. */
VL_API vlSpectrum vl_spectrum_blackbody(float kelvin);
/** One of the library's named spectra; the string must stay valid until a def with this
 * spectrum is added. */
VL_API vlSpectrum vl_spectrum_named(const char *name);
/** Name `index`, from 0, of the library's spectra; null past the end. Constant strings. */
VL_API const char *vl_spectrum_name(uint32_t index);

/** A number that may be textured. */
typedef struct vlFloatInput {
  vlTextureId texture; /**< a float texture; index 0: none */
  float value;         /**< used without a texture */
} vlFloatInput;
/** A spectrum that may be textured. */
typedef struct vlSpectrumInput {
  vlTextureId texture; /**< a colour texture; index 0: none */
  vlSpectrum value;    /**< used without a texture */
} vlSpectrumInput;
/** A number without a texture. */
VL_API vlFloatInput vl_float_input(float value);
/** A spectrum without a texture. */
VL_API vlSpectrumInput vl_spectrum_input(vlSpectrum value);

#ifdef __cplusplus
}
#endif
#endif
