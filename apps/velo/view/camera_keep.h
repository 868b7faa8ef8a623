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

/* For another time of the same animation; the arguments are as camera_keep's. added: the
 * scene's camera is not the file's. False: the page's camera has parts of the old scene. Else
 * *kept is the scene's camera if it is the file's and the page has not moved it; otherwise the
 * page's, with the shutter of the new one. */
bool camera_follow(const ViewCamera *before, const ViewCamera *now, const ViewCamera *shown,
                   bool added, ViewCamera *kept);

#endif
