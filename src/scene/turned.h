/* scene/turned.h: objects that are wound the wrong way, so that their faces look inwards. */
#ifndef SCENE_TURNED_H
#define SCENE_TURNED_H

#include "scene/extent.h"

/* Whether the shapes of a shell (a flag for each shape), whose faces look into it, are an
 * object rather than a room. Rooms have flat walls at the ends of the scene's box, and what
 * stands in them looks outwards. box: of the scene. contents: there are other shapes.
 * surrounds: the shell has no large gaps as seen from the middle; if it has, it must be nearly
 * closed, as the sum of its normals says it. Shapes in groups are left out. */
bool vl_turned_is(const vlScene *scene, const vlExtent *box, const bool *shell, bool contents,
                  bool surrounds);

#endif
