/* camera/pose.c: position and orientation of the camera, from eye, lookat, up and roll (the
 * lecture's compute_uvw) or from a matrix. */
#include <math.h>

#include "base/error.h"
#include "camera/parts.h"
#include "math/elementary.h"
#include "math/transform.h"

typedef struct {
  double x, y, z;
} Vec;

static Vec vec(const double a[3]) {
  return (Vec){a[0], a[1], a[2]};
}

static double dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static Vec cross(Vec a, Vec b) {
  return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double largest(Vec a) {
  return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
}

/* Normalises a vector. It is scaled first, so that very long and very short vectors neither
 * overflow nor underflow. Axis-aligned vectors keep exact zeros and ones. */
static Vec normalized(Vec a) {
  double scale = largest(a);
  a = (Vec){a.x / scale, a.y / scale, a.z / scale};
  double length = sqrt(dot(a, a));
  return (Vec){a.x / length, a.y / length, a.z / length};
}

/* If the sine between up and the view direction is below this, their cross product is mostly
 * rounding. */
static const double parallel_sine = 1e-9;

/* u to the right, v up, w backwards, against the view direction: the lecture's viewing
 * coordinates. */
typedef struct {
  Vec u, v, w;
} Basis;

static vlResult basis_from_lookat(const vlCameraDef *def, Basis *basis, const char **warning,
                                  vlError *error) {
  Vec e = vec(def->eye), l = vec(def->lookat), up = vec(def->up);
  Vec back = {e.x - l.x, e.y - l.y, e.z - l.z};
  if (largest(back) == 0.0)
    return vl_fail_argument(error,
                            "camera: eye and lookat are the same point (%g %g %g); there is no "
                            "direction to look in",
                            e.x, e.y, e.z);
  if (!isfinite(largest(back)))
    return vl_fail_argument(error,
                            "camera: eye and lookat are too far apart for double precision");
  if (largest(up) == 0.0)
    return vl_fail_argument(error, "camera: up is the zero vector");

  Vec w = normalized(back);
  Vec right = cross(normalized(up), w);
  if (sqrt(dot(right, right)) < parallel_sine) {
    if (warning)
      *warning =
          "camera: up is parallel to the view direction; the image's right is taken along "
          "the world's x axis (z when looking along x)";
    /* The default up vector is the component of x perpendicular to w, or of z if w is near x.
     * When the camera looks straight down, the top of the image is -z, as on a map. */
    Vec axis = fabs(w.x) > 0.9 ? (Vec){0.0, 0.0, 1.0} : (Vec){1.0, 0.0, 0.0};
    double along = dot(axis, w);
    right = (Vec){axis.x - along * w.x, axis.y - along * w.y, axis.z - along * w.z};
  }
  basis->w = w;
  basis->u = normalized(right);
  basis->v = cross(w, basis->u);
  return VL_OK;
}

static vlResult check_matrix(const vlMat4 *m, vlError *error) {
  if (!vl_mat4_is_finite(*m))
    return vl_fail_argument(error,
                            "camera: world_from_camera holds a value that is not finite");
  const double *a = m->m;
  if (!vl_is_affine(a))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: the last row of world_from_camera is %g %g %g %g; a pose has 0 0 0 1", a[12],
        a[13], a[14], a[15]);
  /* Returns the volume spanned by the three normalised axes; it is 0 if they are coplanar. */
  Vec x = {a[0], a[4], a[8]}, y = {a[1], a[5], a[9]}, z = {a[2], a[6], a[10]};
  double volume = 0.0, max = fmax(largest(x), fmax(largest(y), largest(z)));
  if (max > 1e30)
    return vl_fail_argument(error,
                            "camera: world_from_camera stretches by %g; 1e30 is the most", max);
  if (largest(x) > 0.0 && largest(y) > 0.0 && largest(z) > 0.0)
    volume = fabs(dot(normalized(x), cross(normalized(y), normalized(z))));
  if (!(volume > parallel_sine))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: world_from_camera is singular; its three axes lie in a plane or one is zero");
  return VL_OK;
}

static vlResult fill(vlMat4 m, vlCamera *camera, vlError *error) {
  vlMat4 inverse;
  if (!vl_mat4_inverse(m, &inverse) || !vl_mat4_is_finite(inverse))
    return vl_fail_argument(
        error, "camera: world_from_camera cannot be inverted; its scale is too extreme");
  for (int i = 0; i < 16; i++) {
    camera->world_from_camera[i] = m.m[i] + 0.0;
    camera->camera_from_world[i] = inverse.m[i] + 0.0;
  }
  return VL_OK;
}

vlResult vl_camera_pose(const vlCameraDef *def, vlCamera *camera, const char **warning,
                        vlError *error) {
  vlMat4 m = vl_mat4_identity();
  if (def->has_matrix) {
    m = vl_mat4_load(def->world_from_camera);
    VL_TRY(check_matrix(&m, error));
  } else {
    Basis b = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    VL_TRY(basis_from_lookat(def, &b, warning, error));
    /* x = u, y = -v (down), z = -w (forward); 0 - v instead of -v keeps -0 out of the matrix */
    m.m[0] = b.u.x;
    m.m[1] = 0.0 - b.v.x;
    m.m[2] = 0.0 - b.w.x;
    m.m[3] = def->eye[0];
    m.m[4] = b.u.y;
    m.m[5] = 0.0 - b.v.y;
    m.m[6] = 0.0 - b.w.y;
    m.m[7] = def->eye[1];
    m.m[8] = b.u.z;
    m.m[9] = 0.0 - b.v.z;
    m.m[10] = 0.0 - b.w.z;
    m.m[11] = def->eye[2];
  }
  if (def->roll != 0.0) {
    /* about z, from x (right) to y (down): clockwise as seen from behind the camera */
    vlMat4 turn = vl_mat4_identity();
    double s = vl_precise_sin(def->roll), c = vl_precise_cos(def->roll);
    turn.m[0] = c;
    turn.m[1] = -s;
    turn.m[4] = s;
    turn.m[5] = c;
    m = vl_mat4_multiply(m, turn);
  }
  return fill(m, camera, error);
}

vlResult vl_camera_pose_matrix(const double world_from_camera[16], vlCamera *camera,
                               vlError *error) {
  vlMat4 m = vl_mat4_load(world_from_camera);
  VL_TRY(check_matrix(&m, error));
  return fill(m, camera, error);
}
