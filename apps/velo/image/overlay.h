/* image/overlay.h: antialiased lines, quadrilaterals and labels over an image, in linear light.
 * What has one colour is first accumulated as coverage and then painted together, so that
 * crossings are not painted twice. */
#ifndef APP_IMAGE_OVERLAY_H
#define APP_IMAGE_OVERLAY_H

#include "velo/camera.h"
#include "velo/image.h"

typedef struct Overlay {
  uint32_t width, height;
  float *rgb;      /* linear light, 0 to 1 */
  float *coverage; /* coverage in [0, 1] by the curves since the last overlay_paint */
} Overlay;

/* Makes an overlay of the image, clamped to [0, 1]. 8-bit values that are not painted are
 * written unchanged. Returns false if out of memory. */
bool overlay_begin(Overlay *overlay, const vlImage *image);
void overlay_end(Overlay *overlay);
/* Adds a segment between two film points in pixels, which may lie far outside. */
void overlay_line(Overlay *overlay, double x0, double y0, double x1, double y1, double width);
void overlay_ring(Overlay *overlay, double x, double y, double radius, double width);
/* Adds the projection of the directions n cos(t) + d sin(t) for t between `from` and `to`
 * (radians). The curve is the image of a straight line in the world, or of the horizon. d and n
 * are orthogonal unit vectors in world space. */
void overlay_arc(Overlay *overlay, const vlCamera *camera, const double d[3], const double n[3],
                 double from, double to, double width);
/* The bounds of a quadrilateral. */
void overlay_bounds(const double corners[4][2], double low[2], double high[2]);
/* Adds a quadrilateral; seen is called with each pixel's centre: 0 where it is hidden. Null: it
 * is not hidden. */
typedef bool OverlaySeen(void *user, double x, double y);
void overlay_quad(Overlay *overlay, const double corners[4][2], OverlaySeen *seen, void *user);
/* Adds a text in strokes: small letters, digits, P and '. (x, y): left end of the base line;
 * size: height of a P. */
void overlay_text(Overlay *overlay, const char *text, double x, double y, double size,
                  double width);
double overlay_text_width(const char *text, double size);
/* Paints the coverage with `opacity` in [0, 1] and clears it. color: sRGB. */
void overlay_paint(Overlay *overlay, const uint8_t color[3], double opacity);
vlResult overlay_write(const Overlay *overlay, vlContext *context, const char *path,
                       vlError *error);

#endif
