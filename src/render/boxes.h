/* render/boxes.h: declarations shared by boxes.c and outline.c. */
#ifndef RENDER_BOXES_H
#define RENDER_BOXES_H

#include "velo/boxes.h"
#include "world/world.h"

/* The box in space and the box of the projection of one object or instance, at a time of the
 * world; the camera is held at that time. corners: of an instance with too many points, use the
 * corners of its box only. */
void vl_box_of_object(const vlWorld *world, const vlCamera *camera, float time, uint32_t id,
                      bool grouped, vlIdBox *box);
void vl_box_of_instance(const vlWorld *world, const vlCamera *camera, float time, uint32_t id,
                        bool corners, vlIdBox *box);
/* Number of points that the projected box of a shape is computed from. */
uint64_t vl_box_points(const vlWorldShape *shape);

#endif
