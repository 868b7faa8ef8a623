/** @file
 * velo/boxes.h: bounding boxes of what an image shows: in pixels around the visible part of each object and instance,
 * and around all of it, visible or occluded; and in space. docs/ground-truth.md has the conventions. */
#ifndef VELO_BOXES_H
#define VELO_BOXES_H

#include "velo/channels.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The boxes of one object or instance. A pixel belongs to it when the ray through the pixel's centre meets it; only
 * pixels of the crop window count. Boxes of pixels are x0, y0, x1, y1 in the whole image, exclusive, as pixel edges;
 * all 0 when there are no pixels. */
typedef struct vlIdBox {
  uint64_t seen, all; /**< number of pixels that show it; number that would show it if nothing else were there */
  uint32_t seen_box[4], all_box[4]; /**< around the `seen` pixels; around the `all` pixels */
  /** Whether `outline` is given. Not when part of the box has no projection (behind the camera), nor for objects that
   * are parts of instances. */
  bool has_outline;
  /** Box around the projections of the eight corners of the box in space: x0, y0, x1, y1 in pixels, may reach beyond
   * the image. */
  double outline[4];
  bool has_space, grouped; /**< the box in space is given; an object that is part of instances */
  /** Corners of the box in space, in its own space, and the matrix from that space to the world. Objects: world space,
   * or that of their group, with the identity here; instances: the space of their group. */
  double low[3], high[3], world_from_box[16];
} vlIdBox;

/** What vl_world_boxes computes. */
typedef struct vlBoxesDef {
  uint32_t cookie;
  uint32_t crop[4]; /**< pixels: x0, y0, x1, y1, exclusive; default: the whole image */
  double time;      /**< seconds; unset: the middle of the exposure (vl_camera_time) */
  vlStopFn *stop;   /**< returns true to stop with VL_CANCELLED; default null: never */
  void *stop_user;  /**< passed to stop */
} vlBoxesDef;
/** The default def for an image of this size, in pixels. */
VL_API vlBoxesDef vl_default_boxes_def(uint32_t width, uint32_t height);

/** Fills objects[id - 1] and instances[id - 1] for each id of the world (vl_world_id_count); either may be null. The
 * box in space and the outline are given for everything with `all` above 0. The ray through each pixel's centre
 * continues behind each surface it meets (at most 256 surfaces), so the cost is that of the ground truth times the
 * number of surfaces along a ray. The numbers do not depend on the number of threads. Not from inside a parallel body.
 * Errors: ARGUMENT, MEMORY, CANCELLED. */
VL_API vlResult vl_world_boxes(const vlWorld *world, const vlCamera *camera, const vlBoxesDef *def, vlIdBox *objects,
                               vlIdBox *instances, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
