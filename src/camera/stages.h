/* camera/stages.h: parts of the batch loops that one hot file defines and another calls. */
#ifndef CAMERA_STAGES_H
#define CAMERA_STAGES_H

#include "camera/rays.h"

/* In: x, y, pixels from the principal point (overwritten); face, the cell of a cube. Out: directions in camera space, z
 * = 1 for perspective cameras, else unit length. */
typedef struct vlDirections {
  double x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK], face[VL_CAMERA_CHUNK];
  double dx[VL_CAMERA_CHUNK], dy[VL_CAMERA_CHUNK], dz[VL_CAMERA_CHUNK], valid[VL_CAMERA_CHUNK];
} vlDirections;

/* count is padded. */
void vl_camera_directions(const vlCameraCompiled *c, uint32_t count, vlDirections *d);
/* Sets the times of n rays (n padded) of a camera whose `when` is timed; transforms the rays of a moving camera from
 * camera space to the world. */
void vl_camera_time_rays(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s, const vlCameraRays *r);
void vl_camera_unproject_chunk(const vlCameraCompiled *c, uint32_t n, const vlCameraPixels *in, vlCameraPoints *out);
void vl_camera_project_chunk(const vlCameraCompiled *c, uint32_t n, const vlCameraPoints *in, vlCameraPixels *out);
/* A lens of many elements. In: d->x, d->y, pixels from the principal point; lens_u, lens_v. Out: rays in camera
 * space with unit directions; d->x, d->y: origin in the plane z = 0; d->valid: 0 if the lens blocks the ray; seen: 0
 * if no light reaches the film point at all; weight (may be null): factor on the radiance. count is padded. */
void vl_camera_optics(const vlCameraCompiled *c, uint32_t count, const float *lens_u, const float *lens_v,
                      vlDirections *d, double *seen, float *weight);

#endif
