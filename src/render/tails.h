/* render/tails.h: the error that rare, very bright samples give camera paths, measured by light
 * paths.
 *
 * A short render of camera paths does not contain its own rare samples: a path that is found
 * once in 10^5 samples, and is then 10^3 times as bright as its pixel, is in few coarse images
 * and in most renders. A light path that is connected to the camera (two_way.h, strategy 3)
 * finds many such paths easily, and its weight tells with which density camera paths find them.
 * Let f be the radiance of a path, q the density with which light paths find it and p that of
 * camera paths (a ray that hits the light, or a light sample). The second moment of the camera
 * paths' samples is the integral of f^2 / p, which is the mean over light paths of (f / q) (f /
 * p), with f / p = (f / q) / (p / q). So one path of the tracer without the tail measures the
 * tail of the other. */
#ifndef RENDER_TAILS_H
#define RENDER_TAILS_H

#include <stdint.h>

typedef struct vlTails {
  uint32_t width, height; /* of the film */
  const double *base;     /* by pixel and channel: what a relative error is relative to */
  double min;             /* added to base^2 */
  double rare; /* samples that are less bright than this, relative to base, do not count */
  double max;  /* largest component of a sample (vlFilmDef.max_component) */
} vlTails;

/* The squared relative error, as a variance per sample and the mean of three channels, that
 * camera paths have by n light paths that are connected to the camera at film points x, y.
 * color: their radiance, weighted by the balance heuristic against camera paths alone. odds:
 * density of the camera paths over that of the light paths. It replaces the first color, and
 * its square times VL_TAIL_SQUARES the second; the third becomes 0. */
#define VL_TAIL_SQUARES 0x1p-40
void vl_tails_measure(const vlTails *tails, uint32_t n, const float *x, const float *y,
                      const float *odds, float *const color[3]);

#endif
