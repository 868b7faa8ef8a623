/* render/turn.c: see turn.h. */
#include "render/turn.h"

#include <math.h>

#include "cli/vector.h"

/* Sine and cosine of an angle in degrees by their series: the same bits on all machines. */
static void sine_cosine(double degrees, double *sine, double *cosine) {
  const double turn = fmod(degrees, 360), quarters = floor(turn / 90 + 0.5);
  const double x = (turn - 90 * quarters) * (3.14159265358979323846 / 180), xx = x * x;
  double s = 0, c = 0;
  for (int k = 9; k >= 0; k--) {
    s = 1 - s * xx / ((2 * k + 2) * (2 * k + 3));
    c = 1 - c * xx / ((2 * k + 1) * (2 * k + 2));
  }
  s *= x;
  switch (((int)quarters % 4 + 4) % 4) {
    case 0:
      *sine = s;
      *cosine = c;
      break;
    case 1:
      *sine = c;
      *cosine = -s;
      break;
    case 2:
      *sine = -s;
      *cosine = -c;
      break;
    default:
      *sine = -c;
      *cosine = s;
      break;
  }
}

/* p = middle + R (p - middle), R about the unit axis (Rodrigues); a direction has no middle. */
static void turn(const double axis[3], double degrees, const double *middle, double p[3]) {
  double v[3], along = 0, s, c;
  sine_cosine(degrees, &s, &c);
  for (int i = 0; i < 3; i++) {
    v[i] = p[i] - (middle ? middle[i] : 0);
    along += axis[i] * v[i];
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    p[i] = (middle ? middle[i] : 0) + c * v[i] + s * (axis[j] * v[k] - axis[k] * v[j]) +
           (1 - c) * along * axis[i];
  }
}

/* Looks at the middle from a distance at which the sphere around the scene's box fits. */
static void stand_back(vlCameraDef *camera, const double low[3], const double high[3],
                       const double middle[3]) {
  double radius = 0, length = 0, sine, cosine;
  sine_cosine(0.5 * camera->fov * (180 / 3.14159265358979323846), &sine, &cosine);
  for (int i = 0; i < 3; i++) {
    radius += 0.25 * (high[i] - low[i]) * (high[i] - low[i]);
    length += (camera->eye[i] - camera->lookat[i]) * (camera->eye[i] - camera->lookat[i]);
  }
  const double far = 1.05 * sqrt(radius) / sine;
  for (int i = 0; i < 3 && length > 0; i++) {
    const double ahead = (camera->lookat[i] - camera->eye[i]) / sqrt(length);
    camera->lookat[i] = middle[i];
    camera->eye[i] = middle[i] - far * ahead;
  }
}

void turn_camera(vlCameraDef *camera, const double low[3], const double high[3], bool automatic,
                 const double up[3], double degrees) {
  const double length = vector_length(up);
  double middle[3], axis[3];
  for (int i = 0; i < 3; i++) {
    axis[i] = length > 0 ? up[i] / length : i == 1;
    middle[i] = low[0] <= high[0] ? 0.5 * (low[i] + high[i]) : 0;
  }
  if (automatic && low[0] <= high[0])
    stand_back(camera, low, high, middle);
  if (camera->has_matrix) {
    for (int column = 0; column < 4; column++) {
      double *m = camera->world_from_camera, v[3] = {m[column], m[4 + column], m[8 + column]};
      turn(axis, degrees, column == 3 ? middle : NULL, v);
      m[column] = v[0];
      m[4 + column] = v[1];
      m[8 + column] = v[2];
    }
  } else {
    turn(axis, degrees, middle, camera->eye);
    turn(axis, degrees, middle, camera->lookat);
    turn(axis, degrees, NULL, camera->up);
  }
}
