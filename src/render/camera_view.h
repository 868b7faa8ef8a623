/* render/camera_view.h: the camera as light paths connect to it, and the first merging
 * radius. */
#ifndef RENDER_CAMERA_VIEW_H
#define RENDER_CAMERA_VIEW_H

#include "math/motion.h"
#include "trace/ground_truth/ground_truth.h"
#include "trace/two_way/two_way.h"
#include "velo/render.h"

/* Sets the view. view->sees is false unless the camera is perspective with a round lens or a
 * pinhole, or one of one's own that projects points, has no lens and does not move
 * (own_view.h); for the last, the caller sets view->camera. A moving camera has its first
 * pose. */
void vl_camera_view(const vlCamera *camera, const vlFilmDef *film, vlCameraView *view);
/* Moves the view to another pose; at: world from camera. */
void vl_camera_view_move(vlCameraView *view, vlAffine at);
/* The camera without a lens, when its shutter opens, as the world. */
vlCamera vl_opening_pinhole(const vlCamera *camera);
/* The ray of such a camera through the middle of cell i of side x side cells of the image.
 * False: it has none there. */
bool vl_pinhole_ray(const vlCamera *pinhole, int side, int i, double origin[3],
                    double direction[3]);
/* Finds the exact first hits of a batch of rays. */
vlResult vl_first_hits(const vlWorld *world, vlIsa isa, vlGroundTruthBatch *batch,
                       vlError *error);
/* The radius (world units) that merging starts from: two pixels wide at the median distance at
 * which the camera's rays meet a surface. 0: no ray meets one. */
vlResult vl_first_radius(const vlWorld *world, const vlCamera *camera, const vlTraceDef *trace,
                         float *radius, vlError *error);

#endif
