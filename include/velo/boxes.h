/** @file
 * velo/boxes.h: boxes around what an image shows: in pixels round what is seen of each object and instance, and round
 * all of it, seen or hidden; and in space. docs/ground-truth.md has the conventions. */
#ifndef VELO_BOXES_H
#define VELO_BOXES_H

#include "velo/channels.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Pixels count by their centres, those of the crop window alone; boxes of pixels are x0, y0, x1, y1 in the whole
 * image, exclusive: pixel edges; all 0 when there are none. */
typedef struct vlIdBox {
  uint64_t seen, all; /**< pixels that show it; pixels that would, if nothing else were there */
  uint32_t seen_box[4], all_box[4];
  /** Box of the projections of all its corners, x0 y0 x1 y1, may reach beyond the image; not when part of it has no
   * projection (behind the camera), nor for objects that are parts of instances. */
  bool has_outline;
  double outline[4];
  /** Box in its own space, and where that is in the world: objects: world space or that of their group, with the
   * identity; instances: the space of their group. */
  bool has_space, grouped; /**< grouped: an object that is part of instances */
  double low[3], high[3], world_from_box[16];
} vlIdBox;

typedef struct vlBoxesDef {
  uint32_t cookie;
  uint32_t crop[4]; /**< x0, y0, x1, y1, exclusive; default all */
  double time;      /**< seconds; unset: the middle of the shutter's time */
  vlStopFn *stop;   /**< to give up with VL_CANCELLED; default null: never */
  void *stop_user;
} vlBoxesDef;
VL_API vlBoxesDef vl_default_boxes_def(uint32_t width, uint32_t height);

/** Fills objects[id - 1] and instances[id - 1] for each id of the world (vl_world_id_count); either may be null. Space
 * and outline are found for what some pixel would show. A ray through each pixel's centre goes on behind what it meets
 * (256 surfaces deep), so this costs as much as the ground truth, times the surfaces that lie behind each other. The
 * same numbers for any number of threads. Not from inside a parallel body. */
VL_API vlResult vl_world_boxes(const vlWorld *world, const vlCamera *camera, const vlBoxesDef *def, vlIdBox *objects,
                               vlIdBox *instances, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
