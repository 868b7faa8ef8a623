/* view/camera_keep.h: the camera with which a page goes on after its scene was loaded again. */
#ifndef APP_VIEW_CAMERA_KEEP_H
#define APP_VIEW_CAMERA_KEEP_H

#include "view/camera_pose.h"

/* before, now: the scene's camera, before and now; shown: the page's. False: the scene's camera
 * changed in more than the size of the image, or the page's has parts of the old scene. Else
 * *kept (it may be *shown) is the page's camera for the size of the image: its field of view is
 * that of the scene's camera if the page left it so; otherwise it is kept across the smaller
 * side, as with --resolution. */
bool camera_keep(const ViewCamera *before, const ViewCamera *now, const ViewCamera *shown,
                 ViewCamera *kept);

#endif
