/** @file
 * velo/medium.h: participating media: their kinds, and the def with their parameters. */
#ifndef VELO_MEDIUM_H
#define VELO_MEDIUM_H

#include "velo/spectrum.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(kind, name) for each kind of medium. velo/schema.h describes the parameters. Homogeneous:
 * constant coefficients. Grid: sigma_a and sigma_s times a density on a grid over a box. RGB
 * grid: sigma_a and sigma_s themselves on a grid. Cloud: sigma_a and sigma_s times a procedural
 * density (pbrt-v4's cloud). NanoVDB: sigma_a and sigma_s times a density from a NanoVDB
 * file. */
#define VL_MEDIUM_KINDS(X)              \
  X(VL_MEDIUM_HOMOGENEOUS, homogeneous) \
  X(VL_MEDIUM_GRID, grid)               \
  X(VL_MEDIUM_RGB_GRID, rgb_grid)       \
  X(VL_MEDIUM_CLOUD, cloud)             \
  X(VL_MEDIUM_NANOVDB, nanovdb)
/** The kinds of media: VL_MEDIUM_HOMOGENEOUS and so on, from VL_MEDIUM_KINDS. */
typedef enum vlMediumKind {
#define VL_KIND(kind, name) kind,
  VL_MEDIUM_KINDS(VL_KIND)
#undef VL_KIND
} vlMediumKind;

/** A participating medium (pbrt book 11). Coefficients are per unit of length in world space,
 * whatever the medium's transform. The phase function is Henyey and Greenstein's. A medium with
 * a box is empty outside the box. */
struct vlMediumDef {
  uint32_t cookie;
  const char *name;  /**< for messages; may be null */
  vlSource source;   /**< where the file describes it */
  vlMediumKind kind; /**< which fields below are read */
  /** absorption and scattering coefficients; default 1; not read for RGB grids */
  vlSpectrum sigma_a, sigma_s;
  float scale; /**< factor on both coefficients */
  float g;     /**< mean cosine of scattering, -1 to 1 */
  /** True: sigma_a acts on each channel of linear sRGB, as in glTF: the share exp(-sigma_a x)
   * remains after the distance x. This holds in both colour modes and does not depend on how
   * the distance is divided (docs/media.md). Only for homogeneous media without emission, with
   * a sigma_a that is an RGB value or a constant. False (default): sigma_a is a spectrum, as in
   * pbrt. */
  bool rgb_absorption;
  /** Homogeneous and grid: the medium emits the radiance sigma_a * emission * emission_scale
   * per unit of length. As for lights, the emission spectrum is first divided by its own
   * luminance. */
  vlSpectrum emission;
  float emission_scale;         /**< factor on emission */
  double world_from_medium[16]; /**< medium space to world space */
  /** Grids: nx * ny * nz values, x fastest, at the centres of equal cells that divide the box
   * from low to high. Between the centres the values are interpolated linearly, towards 0 at
   * the box's faces. */
  uint32_t nx, ny, nz;
  float low[3], high[3]; /**< grids and clouds: corners of the box in medium space */
  const float *density, *emission_scales; /**< grid: factors on both coefficients; factors on
                                             emission (may be null) */
  const float *temperature; /**< grid: temperatures for black-body emission, which replaces
                               `emission`; may be null */
  /** kelvin = (value - offset) * scale; no emission below 100 K */
  float temperature_offset, temperature_scale;
  const float *rgb_a, *rgb_s, *rgb_emission; /**< RGB grid: 3 numbers per cell, in `space`;
                                                rgb_a and rgb_s: null means 1 */
  vlColorSpace space;                        /**< colour space of the RGB grid */
  /** cloud: density, strength and frequency of the noise */
  float cloud_density, wispiness, frequency;
  const char *path;                    /**< path of the NanoVDB file */
  const char *grid, *temperature_grid; /**< names of the file's grids; null: "density" and
                                          "temperature", which may be absent */
};
/** The default def of a kind. */
VL_API vlMediumDef vl_default_medium_def(vlMediumKind kind);
/** Adds a medium. Returns index 0 on error: negative coefficients or values, a grid without
 * cells, an empty box, numbers that are not finite. */
VL_API vlMediumId vl_scene_add_medium(vlScene *scene, const vlMediumDef *def);

#ifdef __cplusplus
}
#endif
#endif
