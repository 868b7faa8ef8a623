/* test/camera/random_cameras.h: random cameras of every projection and distortion. */
#ifndef TEST_CAMERA_RANDOM_CAMERAS_H
#define TEST_CAMERA_RANDOM_CAMERAS_H

#include "camera/cameras.h"
#include "unit.h"

#include "distortion/distortion.case.h"
#include "projection/projection.case.h"

#define PROJECTION(kind, name, row) &name##_projection,
static const ProjectionCase *const projections[] = {VL_PROJECTION_KINDS(PROJECTION)};
#define DISTORTION(kind, name) &name##_distortion,
static const DistortionCase *const distortions[] = {VL_DISTORTION_KINDS(DISTORTION)};

static inline bool has_distortion(vlProjection kind) {
  return kind == VL_PROJECTION_PERSPECTIVE || kind == VL_PROJECTION_EQUIDISTANT;
}

/* A random camera; strength: of its distortion, relative to that of the model's case. False:
 * the kind is a lens of many elements. */
static inline bool random_camera(vlProjection kind, vlDistortion bent, double strength,
                                 uint64_t *state, vlCamera *camera) {
  const ProjectionCase *c = projections[kind];
  if (c->optics)
    return false;
  vlCameraDef d = vl_default_camera_def(640, 480);
  d.projection = kind;
  memcpy(d.shape, c->shape, sizeof d.shape);
  for (int i = 0; i < 2; i++)
    if (kind != VL_PROJECTION_CUBE)
      d.shape[i] *= next_between(state, 0.95, 1.0);
  d.fx = kind == VL_PROJECTION_CUBE ? VL_UNSET : next_between(state, 200, 300);
  d.fy = kind == VL_PROJECTION_CUBE ? VL_UNSET : next_between(state, 200, 300);
  if (kind == VL_PROJECTION_CUBE) {
    d.width = 600;
    d.height = 100;
  } else {
    d.cx = next_between(state, 300, 340);
    d.cy = next_between(state, 220, 260);
    d.skew = next_between(state, -2, 2);
  }
  for (int i = 0; i < 3; i++) {
    d.eye[i] = next_between(state, -2, 2);
    d.lookat[i] = d.eye[i] + next_between(state, 0.2, 2);
  }
  d.roll = next_between(state, -3, 3);
  d.distortion = bent;
  if (bent != VL_DISTORTION_NONE) {
    const DistortionVariant *v = &distortions[bent]->variants[0];
    d.distortion_count = v->count;
    for (uint32_t i = 0; i < v->count; i++)
      d.distortion_coefficients[i] = strength * v->k[i] * next_unit(state);
    if (bent == VL_DISTORTION_OPENCV) {
      d.distortion_count = 14;
      d.distortion_coefficients[12] = next_between(state, -0.1, 0.1);
      d.distortion_coefficients[13] = next_between(state, -0.1, 0.1);
    }
  }
  vlError error;
  if (vl_camera_make(&d, camera, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  return true;
}

enum {
  PROJECTIONS = sizeof projections / sizeof *projections,
  DISTORTIONS = sizeof distortions / sizeof *distortions
};

#endif
