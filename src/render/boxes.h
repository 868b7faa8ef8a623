/* render/boxes.h: what the files of the boxes share. */
#ifndef RENDER_BOXES_H
#define RENDER_BOXES_H

#include "velo/boxes.h"
#include "world/world.h"

/* Space and outline of one object or instance, as it is at a (world's) time; camera: held then. corners: of an
 * instance, those of its box alone, where it has too many of its own. */
void vl_box_of_object(const vlWorld *world, const vlCamera *camera, float time, uint32_t id, bool grouped,
                      vlIdBox *box);
void vl_box_of_instance(const vlWorld *world, const vlCamera *camera, float time, uint32_t id, bool corners,
                        vlIdBox *box);
/* Points that the outline of a shape is found from. */
uint64_t vl_box_points(const vlWorldShape *shape);

#endif
