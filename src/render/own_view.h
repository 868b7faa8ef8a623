/* render/own_view.h: a camera of one's own (velo/own.h) as light paths connect to it.
 *
 * vlOwnCamera.pixels gives the film point of a point in space. There, vlOwnCamera.rays must
 * give a ray through that point, within 1/16 of a pixel; else the point is not seen. The
 * density of the camera's rays is that of `rays`, whose film points are uniform: one pixel is
 * as large at distance t as |(o_x + t d_x) x (o_y + t d_y) . d|, with the derivatives of the
 * ray's origin o and direction d by the film point. They are central differences. This holds
 * for rays from one point, for parallel rays, and for any others. */
#ifndef RENDER_OWN_VIEW_H
#define RENDER_OWN_VIEW_H

#include "camera/rays.h"
#include "film/film.h"
#include "trace/two_way/two_way.h"

/* Sets view->sees, look and reach if the camera is one of one's own; else it does nothing.
 * Bounds must be set. */
void vl_own_view(const vlCameraCompiled *camera, const vlFilmDef *film, vlCameraView *view);

#endif
