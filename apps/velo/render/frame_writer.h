/* render/frame_writer.h: writes images to files in a thread beside the rendering. */
#ifndef APP_RENDER_FRAME_WRITER_H
#define APP_RENDER_FRAME_WRITER_H

#include "render/frames.h"

/* A complete image, passed to the writer, which frees it. */
typedef struct FrameImage {
  Frame frame;
  Job jobs[2]; /* one job per view; each has the view's camera */
  Channels channels[2];
  vlImage *images[2];
  vlImage *clean; /* the denoised copy of the first; null: none */
  uint32_t spp;
  bool stopped; /* interrupted: written to NAME.part.EXT */
} FrameImage;

typedef struct FrameWriter FrameWriter;

/* denoised: of the denoised copies. Null: out of memory or of threads. */
FrameWriter *frame_writer_start(vlContext *context, const Frames *frames,
                                const Outputs *outputs, const Outputs *denoised);
/* Queues an image and takes ownership of its data. Waits while the queue is full. */
void frame_writer_put(FrameWriter *writer, const FrameImage *image);
/* Waits until all images are written. Returns the exit code of the first failure, or STATUS_OK.
 * *written: number of finished images whose files are all complete. */
int frame_writer_finish(FrameWriter *writer, uint32_t *written);
void frame_image_free(FrameImage *image);

#endif
