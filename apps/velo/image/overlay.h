/* image/overlay.h: smooth lines over an image. Curves of one colour are gathered as coverage and laid on at once, so
 * that where they cross or join nothing is painted twice. */
#ifndef APP_IMAGE_OVERLAY_H
#define APP_IMAGE_OVERLAY_H

#include "velo/velo.h"

typedef struct Overlay {
  uint32_t width, height;
  uint8_t *rgb;    /* display values */
  float *coverage; /* of the curves since the last overlay_paint, 0 to 1 */
} Overlay;

/* Takes the image's display values: those of an 8-bit file as they are, light by sRGB's curve. false: memory. */
bool overlay_begin(Overlay *overlay, const vlImage *image);
void overlay_end(Overlay *overlay);
/* A segment between two places in pixels from the corner; they may lie far outside. */
void overlay_line(Overlay *overlay, double x0, double y0, double x1, double y1, double width);
void overlay_ring(Overlay *overlay, double x, double y, double radius, double width);
/* What a camera sees of a half circle of directions from n cos(t) + d sin(t), t from `from` to `to`: a straight line of
 * the world, or the horizon. d and n: unit vectors at right angles, world space. */
void overlay_arc(Overlay *overlay, const vlCamera *camera, const double d[3], const double n[3], double from, double to,
                 double width);
/* Lays the coverage on, `opacity` 0 to 1, and clears it. */
void overlay_paint(Overlay *overlay, const uint8_t color[3], double opacity);
vlResult overlay_write(const Overlay *overlay, vlContext *context, const char *path, vlError *error);

#endif
