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

/* What searches along the axes have found; all zero: none was made. */
typedef struct vlPlains {
  bool searched[3], found[3];
  vlPlain plain[3];
} vlPlains;
/* The plain, if the lowest tenth of the scene's height is one: nearly all of its surface lies
 * flat, it has no large gaps, and it is eight times as long as all that rises above it is in
 * any direction. Else null. axis: that which is upwards. boxes: those of the groups, and the
 * limits of what counts. Searches once along each axis of a scene that stays as it is. */
const vlPlain *vl_plain_search(const vlScene *scene, const vlExtent *boxes, int axis,
                               vlPlains *plains);

#endif
