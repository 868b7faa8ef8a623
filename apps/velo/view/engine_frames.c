/* view/engine_frames.c: images become frames for the pages: the film, or an image of another
 * kind. */
#include "view/engine_parts.h"

void engine_publish(Engine *e, const vlImage *image, FrameFormat format, uint32_t channels,
                    uint32_t scale) {
  double start = engine_clock();
  const float *matrix =
      format == FRAME_HALF ? frame_to_rec709(e->model.job.defs->film.space) : NULL;
  ViewFrame *frame = frame_make(image, format, channels, matrix);
  if (!frame)
    return;
  frame->serial = ++e->serial;
  frame->change = e->now.change;
  frame->width = e->now.camera.made.width;
  frame->height = e->now.camera.made.height;
  frame->x0 = e->now.crop[0] / scale * scale;
  frame->y0 = e->now.crop[1] / scale * scale;
  frame->scale = scale;
  frame->channel = e->now.channel;
  frame->spp = scale == 1 && e->film ? vl_film_spp(e->film) : 0;
  server_show(e->server, frame);
  frame_drop(frame);
  e->published = engine_clock();
  e->publish_seconds = e->published - start;
}

void engine_publish_film(Engine *e, const vlFilm *film, uint32_t scale) {
  double start = engine_clock(), used = engine_thread_seconds();
  vlImage *image = NULL;
  if (vl_film_develop(film, &e->model.job.defs->develop, &image) == VL_OK) {
    engine_publish(e, image, FRAME_HALF, 3, scale);
    e->publish_seconds = engine_clock() - start;
  }
  vl_image_destroy(image);
  e->frame_seconds += engine_thread_seconds() - used;
}
