/* render/camera_view.h: what the light's paths know of the camera, and how near is near for it. */
#ifndef RENDER_CAMERA_VIEW_H
#define RENDER_CAMERA_VIEW_H

#include "math/motion.h"
#include "trace/two_way/two_way.h"

/* view->sees is false for cameras that are not a perspective one with a round lens or none. Of one that moves: its
 * first pose. */
void vl_camera_view(const vlCamera *camera, const vlFilmDef *film, vlCameraView *view);
/* Where it is at another time: world from camera. */
void vl_camera_view_move(vlCameraView *view, vlAffine at);
/* The radius that merging starts from: two pixels wide where the middling ray of the camera ends; 0: none ends. */
vlResult vl_first_radius(const vlWorld *world, const vlCamera *camera, const vlTraceDef *trace, float *radius,
                         vlError *error);

#endif
