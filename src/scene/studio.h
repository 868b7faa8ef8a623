/* scene/studio.h: the built-in studios, as functions of the direction. Directions: x right, y
 * ahead (away from the viewer), z up; the viewer looks ahead, so that the studio's main light,
 * on the left of him, is at negative x and negative y. */
#ifndef SCENE_STUDIO_H
#define SCENE_STUDIO_H

#include "velo/load.h"

typedef struct vlStudio {
  /* Radiance from the unit direction d. A white surface that is turned about as the visible
   * ones of a model has a radiance of about 0.6. */
  void (*radiance)(vlVec3 d, float rgb[3]);
  float floor[3]; /* the albedo of a floor that has the radiance of the studio's floor */
} vlStudio;

/* The studio of which an environment is made (that of lamps, too: VL_ENVIRONMENT_STUDIO); null:
 * none. */
const vlStudio *vl_studio(vlEnvironmentKind kind);

#endif
