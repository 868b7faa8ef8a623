/* render/frame_writer.h: images on their way to files, in a thread of its own beside the rendering. */
#ifndef APP_RENDER_FRAME_WRITER_H
#define APP_RENDER_FRAME_WRITER_H

#include "render/frames.h"

/* One image, whole: what the writer takes and frees. */
typedef struct FrameImage {
  Frame frame;
  Job jobs[2]; /* of each view, with its camera */
  Channels channels[2];
  vlImage *images[2];
  uint32_t spp;
  bool stopped; /* not finished: it goes to NAME.part.EXT */
  bool renamed; /* the layers have their view in their names */
} FrameImage;

typedef struct FrameWriter FrameWriter;

/* Null: out of memory or threads. */
FrameWriter *frame_writer_start(vlContext *context, const vlWorld *world, const Frames *frames, const Outputs *outputs);
/* Waits while too many are under way. Takes what the image holds. */
void frame_writer_put(FrameWriter *writer, const FrameImage *image);
/* Waits for all; the exit code of the first failure, or STATUS_OK. *written: finished images whose files are all whole.
 */
int frame_writer_finish(FrameWriter *writer, uint32_t *written);
void frame_image_free(FrameImage *image);

#endif
