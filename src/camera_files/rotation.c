/* camera_files/rotation.c: rotations in the representations of files: vectors (Rodrigues),
 * quaternions, matrices; conversion of poses between directions and axes. */
#include <math.h>

#include "camera_files/files.h"

#include "math/double3.h"
#include "math/elementary.h"

void vl_rotation_from_vector(const double v[3], double r[9]) {
  double angle = vl_norm3(v);
  /* sin(a)/a and (1 - cos(a))/a^2; below 1e-4 their series are exact to the last bit */
  double a2 = angle * angle;
  double s = angle < 1e-4 ? 1.0 - a2 / 6.0 : vl_precise_sin(angle) / angle;
  double half = angle < 1e-4 ? 1.0 : vl_precise_sin(0.5 * angle) / (0.5 * angle);
  double c = angle < 1e-4 ? 0.5 - a2 / 24.0 : 0.5 * half * half;
  double x = v[0], y = v[1], z = v[2];
  r[0] = 1.0 - c * (y * y + z * z);
  r[1] = c * x * y - s * z;
  r[2] = c * x * z + s * y;
  r[3] = c * x * y + s * z;
  r[4] = 1.0 - c * (x * x + z * z);
  r[5] = c * y * z - s * x;
  r[6] = c * x * z - s * y;
  r[7] = c * y * z + s * x;
  r[8] = 1.0 - c * (x * x + y * y);
}

/* Converts through the quaternion, which is well conditioned at every angle. */
void vl_rotation_to_vector(const double r[9], double v[3]) {
  double q[4];
  vl_rotation_to_quaternion(r, q);
  double sine = vl_norm3(q + 1);
  double scale = sine > 0.0 ? 2.0 * vl_precise_atan2(sine, q[0]) / sine : 2.0;
  for (int i = 0; i < 3; i++)
    v[i] = scale * q[i + 1];
}

bool vl_rotation_from_quaternion(const double q[4], double r[9]) {
  double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(n > 1e-200 && n < 1e200))
    return false;
  double s = 2.0 / n, w = q[0], x = q[1], y = q[2], z = q[3];
  r[0] = 1.0 - s * (y * y + z * z);
  r[1] = s * (x * y - w * z);
  r[2] = s * (x * z + w * y);
  r[3] = s * (x * y + w * z);
  r[4] = 1.0 - s * (x * x + z * z);
  r[5] = s * (y * z - w * x);
  r[6] = s * (x * z - w * y);
  r[7] = s * (y * z + w * x);
  r[8] = 1.0 - s * (x * x + y * y);
  return true;
}

/* Starts from the largest component, which avoids division by small numbers (Shepperd 1978).
 * The scalar part is not negative. */
void vl_rotation_to_quaternion(const double r[9], double q[4]) {
  double squares[4] = {1.0 + r[0] + r[4] + r[8], 1.0 + r[0] - r[4] - r[8],
                       1.0 - r[0] + r[4] - r[8], 1.0 - r[0] - r[4] + r[8]};
  int best = 0;
  for (int i = 1; i < 4; i++)
    if (squares[i] > squares[best])
      best = i;
  const double products[4][4] = {{squares[0], r[7] - r[5], r[2] - r[6], r[3] - r[1]},
                                 {r[7] - r[5], squares[1], r[3] + r[1], r[2] + r[6]},
                                 {r[2] - r[6], r[3] + r[1], squares[2], r[7] + r[5]},
                                 {r[3] - r[1], r[2] + r[6], r[7] + r[5], squares[3]}};
  double length = 0.0;
  for (int i = 0; i < 4; i++)
    length += products[best][i] * products[best][i];
  length = sqrt(length) * (products[best][0] < 0.0 ? -1.0 : 1.0);
  for (int i = 0; i < 4; i++)
    q[i] = products[best][i] / length;
}

double vl_rotation_error(const double m[12]) {
  double worst = 0.0;
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++) {
      worst = fmax(worst, fabs(vl_dot_columns(m, i, j) - (i == j ? 1.0 : 0.0)));
    }
  return worst;
}

void vl_camera_set_pose(vlCameraDef *def, const double r[9], const double t[3]) {
  def->has_matrix = true;
  double *m = def->world_from_camera;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      m[4 * i + j] = r[3 * j + i] + 0.0;
    m[4 * i + 3] = 0.0 - (r[i] * t[0] + r[3 + i] * t[1] + r[6 + i] * t[2]);
    m[12 + i] = 0.0;
  }
  m[15] = 1.0;
}

void vl_camera_get_pose(const vlCamera *camera, double r[9], double t[3]) {
  vl_split_map(camera->camera_from_world, r, t);
}

void vl_camera_flip_columns(const double m[16], double x, double y, double z,
                            double result[16]) {
  const double sign[4] = {x, y, z, 1.0};
  for (int i = 0; i < 16; i++)
    result[i] = m[i] * sign[i % 4] + 0.0;
}

void vl_camera_transpose(const double m[16], double result[16]) {
  for (int i = 0; i < 16; i++)
    result[i] = m[4 * (i % 4) + i / 4];
}

void vl_camera_flip_axes(const double m[16], double result[16]) {
  vl_camera_flip_columns(m, 1.0, -1.0, -1.0, result);
}
