/* view/camera_pose.c: see camera_pose.h. */
#include "view/camera_pose.h"

#include <math.h>
#include <string.h>

#include "cli/vector.h"

/* The rotation whose z axis is that of the matrix and whose y axis is as near as possible;
 * columns x, y, z. */
static void rotation_of(const double m[16], double r[3][3]) {
  for (int i = 0; i < 3; i++) {
    r[1][i] = m[4 * i + 1];
    r[2][i] = m[4 * i + 2];
  }
  vector_normalize(r[2]);
  vector_cross(r[1], r[2], r[0]);
  vector_normalize(r[0]);
  vector_cross(r[2], r[0], r[1]);
}

CameraPose camera_pose(const ViewCamera *camera) {
  const vlCameraDef *def = &camera->def;
  CameraPose pose = {.roll = def->roll};
  if (!def->has_matrix) {
    memcpy(pose.eye, def->eye, sizeof pose.eye);
    memcpy(pose.lookat, def->lookat, sizeof pose.lookat);
    memcpy(pose.up, def->up, sizeof pose.up);
    return pose;
  }
  double r[3][3];
  rotation_of(def->world_from_camera, r);
  for (int i = 0; i < 3; i++) {
    pose.eye[i] = def->world_from_camera[4 * i + 3];
    pose.up[i] = -r[1][i];
  }
  vector_along(pose.eye, camera->units.lookat, r[2], pose.lookat);
  return pose;
}

/* Camera axes that look from eye to lookat; columns x right, y down, z forward. False: there
 * are none. */
static bool look(const CameraPose *pose, double r[3][3]) {
  vector_subtract(pose->lookat, pose->eye, r[2]);
  if (!vector_normalize(r[2]))
    return false;
  const double down[3] = {-pose->up[0], -pose->up[1], -pose->up[2]};
  vector_cross(down, r[2], r[0]);
  if (!vector_normalize(r[0]))
    return false;
  vector_cross(r[2], r[0], r[1]);
  return true;
}

void camera_place(const ViewCamera *now, const CameraPose *pose, vlCameraDef *def) {
  double old[3][3], new[3][3], rest[3][3];
  bool rigid = true;
  const double *m = now->def.world_from_camera;
  if (now->def.has_matrix) {
    rotation_of(m, old);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        const double column[3] = {m[j], m[4 + j], m[8 + j]};
        rest[i][j] = vector_dot(old[i], column);
        rigid &= fabs(rest[i][j] - (i == j)) < 1e-9;
      }
  }
  def->has_matrix_close = false;
  for (int i = 0; i < 3; i++)
    def->eye_close[i] = def->lookat_close[i] = def->up_close[i] = VL_UNSET;
  def->roll_close = VL_UNSET;
  def->roll = pose->roll;
  if (rigid || !look(pose, new)) {
    def->has_matrix = false;
    memcpy(def->eye, pose->eye, sizeof def->eye);
    memcpy(def->lookat, pose->lookat, sizeof def->lookat);
    memcpy(def->up, pose->up, sizeof def->up);
    return;
  }
  for (int row = 0; row < 3; row++) {
    for (int j = 0; j < 3; j++) {
      double sum = 0;
      for (int k = 0; k < 3; k++)
        sum += new[k][row] * rest[k][j];
      def->world_from_camera[4 * row + j] = sum;
    }
    def->world_from_camera[4 * row + 3] = pose->eye[row];
  }
}

double camera_arm(const CameraPose *pose) {
  double arm[3];
  vector_subtract(pose->lookat, pose->eye, arm);
  return vector_length(arm);
}
