/* image/overlay.h: antialiased lines over an image. Curves of one colour are first accumulated as coverage and then
 * painted together, so that crossings are not painted twice. */
#ifndef APP_IMAGE_OVERLAY_H
#define APP_IMAGE_OVERLAY_H

#include "velo/velo.h"

typedef struct Overlay {
  uint32_t width, height;
  uint8_t *rgb;    /* display values */
  float *coverage; /* coverage in [0, 1] by the curves since the last overlay_paint */
} Overlay;

/* Makes an overlay of the image's display values. 8-bit values are unchanged; linear light is sRGB-encoded. Returns
 * false if out of memory. */
bool overlay_begin(Overlay *overlay, const vlImage *image);
void overlay_end(Overlay *overlay);
/* Adds a segment between two film points in pixels, which may lie far outside. */
void overlay_line(Overlay *overlay, double x0, double y0, double x1, double y1, double width);
void overlay_ring(Overlay *overlay, double x, double y, double radius, double width);
/* Adds the projection of the directions n cos(t) + d sin(t) for t between `from` and `to` (radians). The curve is the
 * image of a straight line in the world, or of the horizon. d and n are orthogonal unit vectors in world space. */
void overlay_arc(Overlay *overlay, const vlCamera *camera, const double d[3], const double n[3], double from, double to,
                 double width);
/* Paints the coverage with `opacity` in [0, 1] and clears it. */
void overlay_paint(Overlay *overlay, const uint8_t color[3], double opacity);
vlResult overlay_write(const Overlay *overlay, vlContext *context, const char *path, vlError *error);

#endif
