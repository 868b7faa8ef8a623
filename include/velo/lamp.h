/** @file
 * velo/lamp.h: measured luminaires: the luminous intensity over directions from a lamp file
 * (IES LM-63, EULUMDAT).
 *
 * Directions are in light space. There the luminaire aims along -y: that is gamma = 0 (nadir)
 * of photometry of type C, and horizontal = vertical = 0 of types A and B. +y is the zenith
 * (gamma = 180 degrees), +x the half plane C = 0, -z the half plane C = 90 degrees, so that C
 * counts counter-clockwise as seen from +y. Of types A and B, vertical angles rise towards +x,
 * and horizontal ones towards +z. */
#ifndef VELO_LAMP_H
#define VELO_LAMP_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A luminaire. It never changes, so any number of threads may read it. */
typedef struct vlLamp vlLamp;

/** What a lamp file says, and what follows from its intensities. */
typedef struct vlLampInfo {
  char format[32];         /**< such as "IES LM-63-2002" */
  char name[128];          /**< of the luminaire; empty: not given */
  char type;               /**< of photometry: 'A', 'B' or 'C' */
  uint32_t planes;         /**< horizontal angles (C planes) in the file */
  uint32_t angles;         /**< vertical angles (gamma) in each of them */
  double flux;             /**< of the luminaire, lm: the integral of its intensity, which is
                              bilinear in the two angles of the file's type, over all directions */
  double lamps_flux;       /**< of its lamps, lm; VL_UNSET: absolute photometry has none */
  double max_intensity;    /**< candela */
  double max_direction[3]; /**< a direction of max_intensity, light space */
  double watts;            /**< input power, W; VL_UNSET: not given */
  /** Angles between the outermost directions that have at least 50 % (beam) and 10 % (field) of
   * the greatest intensity of their plane, radians, in the planes [0] C 0 - C 180 and [1] C 90
   * - C 270. They are counted from the end of the axis (nadir or zenith) in whose half the
   * greatest intensity is. 0: the plane is dark. */
  double beam[2], field[2];
} vlLampInfo;

/** Reads a lamp file; its content tells the format. Errors: SCENE (wrong contents, with the
 * line), MISSING, IO, MEMORY. */
VL_API vlResult vl_lamp_load(vlContext *context, const char *path, vlLamp **lamp,
                             vlError *error);
/** As vl_lamp_load, from `size` bytes in memory. name: what messages call the file. */
VL_API vlResult vl_lamp_read(vlContext *context, const char *name, const void *data,
                             size_t size, vlLamp **lamp, vlError *error);
/** Null is allowed. */
VL_API void vl_lamp_destroy(vlLamp *lamp);
/** Fills *info. */
VL_API void vl_lamp_info(const vlLamp *lamp, vlLampInfo *info);
/** The intensity in candela in a direction of any length (light space). 0 for a direction that
 * is 0 or not finite. */
VL_API double vl_lamp_intensity(const vlLamp *lamp, const double direction[3]);

#ifdef __cplusplus
}
#endif
#endif
