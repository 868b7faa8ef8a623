/** @file
 * velo/header.h: the header attributes of a rendered image: camera, colour, settings
 * (docs/ground-truth.md). Nothing that differs between two equal renders is written: no times,
 * no host name, no number of threads. */
#ifndef VELO_HEADER_H
#define VELO_HEADER_H

#include "velo/camera.h"
#include "velo/image.h"
#include "velo/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What a header is made from. Pointers are read during the call only. */
typedef struct vlHeaderDef {
  uint32_t cookie;
  const vlCamera *camera;  /**< at the film's size; required */
  const vlSceneDefs *defs; /**< settings and the camera's description; required */
  const char *scene; /**< the scene's file, of which the last name is written; may be null */
  const char *view;  /**< writes the camera only, its names after "view."; null: all */
  double time;      /**< of the camera and of the ground truth, seconds; VL_UNSET (default): the
                       camera in the middle of its exposure, and ground truth of a rolling shutter
                       when each row is exposed ("velo.channelsTime") */
  uint32_t samples; /**< per pixel, of the image; 0 (default): not written */
} vlHeaderDef;
/** The default def. */
VL_API vlHeaderDef vl_default_header_def(void);
/** Sets the attributes. Errors: ARGUMENT, MEMORY. */
VL_API vlResult vl_image_set_header(vlImage *image, const vlHeaderDef *def);
/** Makes an image, owned by the caller, of integers (type U32, at most 16 channels) in a form
 * that other programs show: channel names end in one letter ("id.object.Y"), and values are
 * floats, which are exact below 2^24. If a value is not, the new image keeps integers. It has
 * the attributes of `ids`. Errors: ARGUMENT, MEMORY. */
VL_API vlResult vl_image_show_ids(const vlImage *ids, vlImage **shown);

#ifdef __cplusplus
}
#endif
#endif
