/* camera/stages.h: parts of the batch loops that one hot file defines and another calls. */
#ifndef CAMERA_STAGES_H
#define CAMERA_STAGES_H

#include "camera/rays.h"

/* Input: x, y in pixels from the principal point (overwritten); face, the cell of a cube.
 * Output: directions in camera space, with z = 1 for perspective cameras and of unit length for
 * all others. */
typedef struct vlDirections {
  double x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK], face[VL_CAMERA_CHUNK];
  double dx[VL_CAMERA_CHUNK], dy[VL_CAMERA_CHUNK], dz[VL_CAMERA_CHUNK], valid[VL_CAMERA_CHUNK];
} vlDirections;

/* count is padded. */
void vl_camera_directions(const vlCameraCompiled *c, uint32_t count, vlDirections *d);
/* Sets the times of n rays (n padded) of a camera whose `when` is timed; transforms the rays of
 * a moving camera from camera space to the world. */
void vl_camera_time_rays(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s,
                         const vlCameraRays *r);
void vl_camera_unproject_chunk(const vlCameraCompiled *c, uint32_t n, const vlCameraPixels *in,
                               vlCameraPoints *out);
void vl_camera_project_chunk(const vlCameraCompiled *c, uint32_t n, const vlCameraPoints *in,
                             vlCameraPixels *out);
/* Makes the rays of a lens of many elements. Input: d->x, d->y in pixels from the principal
 * point; lens_u, lens_v. Output: rays in camera space with unit directions. d->x, d->y become
 * the origin in the plane z = 0. d->valid is 0 if the lens blocks the ray. seen is 0 if no
 * light reaches the film point at all. weight (may be null) is a factor on the radiance. count
 * is padded. */
void vl_camera_optics(const vlCameraCompiled *c, uint32_t count, const float *lens_u,
                      const float *lens_v, vlDirections *d, double *seen, float *weight);

#endif
