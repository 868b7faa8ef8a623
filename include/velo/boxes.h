/** @file
 * velo/boxes.h: bounding boxes of the objects and instances in an image: in pixels, around the
 * visible part and around the whole including occluded parts; and in space.
 * docs/ground-truth.md has the conventions. */
#ifndef VELO_BOXES_H
#define VELO_BOXES_H

#include "velo/channels.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The boxes of one object or instance. A pixel belongs to an object if the ray through the
 * pixel's centre meets the object; only pixels of the crop window count. Boxes of pixels are
 * x0, y0, x1, y1 in the whole image; x1 and y1 are exclusive. All four are 0 if there are no
 * pixels. */
typedef struct vlIdBox {
  uint64_t seen, all; /**< numbers of pixels: those that show the object, and those that would
                         show it if nothing else were there */
  uint32_t seen_box[4], all_box[4]; /**< around the `seen` pixels; around the `all` pixels */
  /** Whether `outline` is given. It is not given if a part of the box has no projection (behind
   * the camera), or if the object is part of an instance. */
  bool has_outline;
  /** Box around the projections of the eight corners of the box in space: x0, y0, x1, y1 in
   * pixels. It may reach beyond the image. */
  double outline[4];
  bool has_space, grouped; /**< has_space: the box in space is given; grouped: the object is
                              part of instances */
  /** The corners of the box in space, in the coordinates of the box, and the matrix from these
   * coordinates to the world. For objects the coordinates are world space, or the space of
   * their group, and the matrix is the identity. For instances they are the space of the
   * group. */
  double low[3], high[3], world_from_box[16];
} vlIdBox;

/** What vl_world_boxes computes. */
typedef struct vlBoxesDef {
  uint32_t cookie;
  uint32_t crop[4]; /**< crop window, pixels: x0, y0, x1, y1; x1, y1 exclusive; default: the
                       whole image */
  double time; /**< time at which the scene is seen, seconds; unset: the middle of the exposure
                  (vl_camera_time), of a rolling shutter that of each row for pixels and
                  outlines, and that of the middle of the image for poses in space */
  vlStopFn *stop;         /**< returns true to stop with VL_CANCELLED; default null: never */
  void *stop_user;        /**< passed to stop */
  const vlCancel *cancel; /**< stops the call within one tile of 32 x 32 pixels; default null */
} vlBoxesDef;
/** The default def for an image of this size, in pixels. */
VL_API vlBoxesDef vl_default_boxes_def(uint32_t width, uint32_t height);

/** Fills objects[id - 1] and instances[id - 1] for each id of the world (vl_world_id_count);
 * either array may be null. The box in space and the outline are given for each id whose `all`
 * is above 0. The ray through each pixel's centre continues behind each surface that it meets
 * (up to 256 surfaces), so the cost is that of the ground truth times the number of surfaces
 * along a ray. The results do not depend on the number of threads. Must not be called from
 * inside a parallel loop. Errors: ARGUMENT, MEMORY, CANCELLED. */
VL_API vlResult vl_world_boxes(const vlWorld *world, const vlCamera *camera,
                               const vlBoxesDef *def, vlIdBox *objects, vlIdBox *instances,
                               vlError *error);

#ifdef __cplusplus
}
#endif
#endif
