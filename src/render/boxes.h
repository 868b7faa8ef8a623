/* render/boxes.h: declarations shared by boxes.c and outline.c. */
#ifndef RENDER_BOXES_H
#define RENDER_BOXES_H

#include "camera/rays.h"
#include "velo/boxes.h"
#include "world/world.h"

/* A rolling shutter's camera, whose times are seconds, and the world that moves before it. */
typedef struct vlBoxRows {
  const vlWorld *world;
  const vlCameraCompiled *camera;
} vlBoxRows;

/* The box in space and the box of the projection of one object or instance, at a time of the
 * world; the camera is held at that time. rows (may be null): each point is projected when its
 * row sees it. corners: of an instance with too many points, use the
 * corners of its box only. */
void vl_box_of_object(const vlWorld *world, const vlCamera *camera, const vlBoxRows *rows,
                      float time, uint32_t id, bool grouped, vlIdBox *box);
void vl_box_of_instance(const vlWorld *world, const vlCamera *camera, const vlBoxRows *rows,
                        float time, uint32_t id, bool corners, vlIdBox *box);
/* Number of points that the projected box of a shape is computed from. */
uint64_t vl_box_points(const vlWorldShape *shape);

#endif
