/* view/frame.h: an image as it is sent to pages: half floats (colours) or floats (ground
 * truth), and the binary message that brings a page from one frame to the next: only tiles that
 * changed. docs/view.md has the layout. */
#ifndef APP_VIEW_FRAME_H
#define APP_VIEW_FRAME_H

#include <stdatomic.h>

#include "velo/image.h"
#include "velo/spectrum.h"

typedef enum FrameFormat { FRAME_HALF, FRAME_FLOAT } FrameFormat;

/* Shared by the render thread and the server: constant but for the number of references. */
typedef struct ViewFrame {
  atomic_uint references;
  uint32_t serial;        /* number of the frame, from 1 */
  uint32_t change;        /* the last change that it shows */
  uint32_t width, height; /* the whole image, pixels */
  uint32_t x0, y0;        /* position of the frame's first pixel in the image */
  uint32_t scale;         /* a pixel of the frame covers scale x scale pixels of the image */
  uint32_t columns, rows; /* pixels of the frame */
  FrameFormat format;
  uint32_t channels, channel; /* numbers per pixel; index of the ground truth, 0: the image */
  uint32_t spp;               /* samples per pixel */
  bool denoised;              /* not the mean of the samples, but its denoised copy */
  bool moved;                 /* an earlier image, moved with the camera */
  uint8_t *pixels;            /* rows from the top, no padding */
} ViewFrame;

enum { FRAME_HEADER = 64, FRAME_TILE = 64 };

/* The first channels of an image as a frame, with one reference; null without memory. matrix:
 * 3x3 for three channels, row-major, applied to each pixel; null: none. */
ViewFrame *frame_make(const vlImage *image, FrameFormat format, uint32_t channels,
                      const float *matrix);
/* Fills the matrix from a film's space to linear Rec. 709, which pages show, and returns it;
 * white is not adapted, as in image/display.c. Null: the film is in that space. */
const float *frame_to_rec709(vlColorSpace space, float matrix[9]);
ViewFrame *frame_keep(ViewFrame *frame);
/* Null is allowed. */
void frame_drop(ViewFrame *frame);
/* The bytes of the message that shows `now` where `before` is shown (null: nothing);
 * `before_room` bytes are left free before it. The caller frees the result; null without
 * memory. *size: length of the message. */
uint8_t *frame_message(const ViewFrame *now, const ViewFrame *before, size_t before_room,
                       size_t *size);

#endif
