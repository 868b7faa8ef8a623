/* scene/tray.h: models that one looks into from above: rooms without a ceiling, trays. */
#ifndef SCENE_TRAY_H
#define SCENE_TRAY_H

#include "scene/extent.h"

/* Whether the model has a floor at its low end along the axis, walls on all four sides and no
 * ceiling, and is lower than wide. Its walls have two sides, or the model is a sheet that is
 * seen from both sides. box: of the scene. Shapes in groups are left out. */
bool vl_tray_is(const vlScene *scene, const vlExtent *box, int axis);

#endif
