/* scene/plain.h: a wide flat ground under a small model: a vehicle on a field, a figure on a
 * floor. */
#ifndef SCENE_PLAIN_H
#define SCENE_PLAIN_H

#include "scene/extent.h"

/* A model on a plain. */
typedef struct vlPlain {
  vlExtent model; /* what stands on it */
  vlExtent shown; /* the part of it that an image of the model shows: a quarter of the
                     model's size to each side */
} vlPlain;

/* Whether the lowest tenth of the scene's height is a plain: nearly all of its surface lies
 * flat, it has no large gaps, and it is eight times as long as all that rises above it is in
 * any direction. axis: that which is upwards. boxes: those of the groups, and the limits of
 * what counts. */
bool vl_plain_find(const vlScene *scene, const vlExtent *boxes, int axis, vlPlain *plain);

#endif
