/* test/camera/test_jacobian_complex.c: derivatives of projection and unprojection against exact
 * ones: complex steps through a second implementation of the equations (complex_camera.h), for
 * random cameras of every projection and distortion but lenses of many elements. */
#include "camera/context.h"
#include "camera/random_cameras.h"

#include "camera/complex_camera.h"

enum { CAMERAS = 200, COLUMNS = VL_JACOBIAN_COLUMNS };

typedef struct Place {
  vlCamera camera;
  double tau[2];
  bool distorted;
  double rotation[9], translation[3]; /* camera_from_world */
} Place;

static void read_pose(Place *p) {
  for (int i = 0; i < 3; i++) {
    for (int k = 0; k < 3; k++)
      p->rotation[3 * i + k] = p->camera.camera_from_world[4 * i + k];
    p->translation[i] = p->camera.camera_from_world[4 * i + 3];
  }
}

/* Axis k times v. */
static void turn_about(int k, const long double v[3], long double out[3]) {
  int a = (k + 1) % 3, b = (k + 2) % 3;
  out[k] = 0;
  out[a] = -v[b];
  out[b] = v[a];
}

/* The derivative of the film point by a change of the point (camera space) and of a number of
 * the camera; column below VL_JACOBIAN_INTRINSICS: of none. */
static void derive(const Place *p, const long double at[3], const long double by[3], int column,
                   long double out[2]) {
  ComplexCamera c = complex_camera(&p->camera, p->tau);
  Number d[3], film[2] = {0, 0};
  for (int i = 0; i < 3; i++)
    d[i] = CMPLXL(at[i], by[i] * COMPLEX_STEP);
  if (column >= VL_JACOBIAN_INTRINSICS)
    *complex_column(&c, column) += imaginary(COMPLEX_STEP);
  assert_true(complex_film(&c, p->distorted, d, film));
  out[0] = cimagl(film[0]) / COMPLEX_STEP;
  out[1] = cimagl(film[1]) / COMPLEX_STEP;
}

/* How a column moves the point in camera space: by the point in the world, or by the pose. */
static void motion_of(const Place *p, int column, const long double at[3], long double by[3]) {
  by[0] = by[1] = by[2] = 0;
  if (column < VL_JACOBIAN_POSE)
    for (int i = 0; i < 3; i++)
      by[i] = p->rotation[3 * i + column];
  else if (column < VL_JACOBIAN_POSE + 3)
    by[column - VL_JACOBIAN_POSE] = 1;
  else if (column < VL_JACOBIAN_INTRINSICS)
    turn_about(column - VL_JACOBIAN_POSE - 3, at, by);
}

static void to_camera(const Place *p, const double world[3], bool point, long double out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = point ? p->translation[i] : 0;
    for (int k = 0; k < 3; k++)
      out[i] += (long double)p->rotation[3 * i + k] * world[k];
  }
}

static void to_world(const Place *p, const long double v[3], long double out[3]) {
  for (int i = 0; i < 3; i++)
    out[i] = p->rotation[i] * v[0] + p->rotation[3 + i] * v[1] + p->rotation[6 + i] * v[2];
}

static bool has_column(vlProjection kind, vlDistortion bent, int column) {
  int numbers = kind == VL_PROJECTION_EUCM || kind == VL_PROJECTION_DOUBLE_SPHERE ? 2 : 1;
  if (column >= VL_JACOBIAN_SHAPE && column < VL_JACOBIAN_DISTORTION)
    return kind != VL_PROJECTION_CUBE && !isnan(projections[kind]->shape[0]) &&
           column - VL_JACOBIAN_SHAPE < numbers;
  if (column >= VL_JACOBIAN_DISTORTION)
    return bent != VL_DISTORTION_NONE && (column < COLUMNS - 2 || bent == VL_DISTORTION_OPENCV);
  return true;
}

/* Errors are relative to the column's largest number. */
static void compare(vlProjection kind, vlDistortion bent, int column, const double *rows,
                    const long double *exact, int count) {
  long double size = 1e-9L, error = 0;
  for (int k = 0; k < count; k++) {
    size = fmaxl(size, fabsl(exact[k]));
    error = fmaxl(error, fabsl(exact[k] - rows[k * COLUMNS + column]));
  }
  if (!(error <= 1e-8L * size))
    fail_msg("%s, distortion %u, %s, column %d: off by %Lg", vl_projection_name(kind), bent,
             count == 2 ? "project" : "unproject", column, error / size);
}

static int check_projection(vlProjection kind, vlDistortion bent, const Place *p,
                            const double point[3]) {
  double rows[2 * COLUMNS];
  uint8_t valid;
  vlError error;
  assert_int_equal(vl_camera_project_jacobian(&p->camera, 1, point, rows, &valid, &error),
                   VL_OK);
  if (!valid)
    return 0;
  long double at[3], by[3], exact[2];
  to_camera(p, point, true, at);
  for (int column = 0; column < COLUMNS; column++) {
    if (!has_column(kind, bent, column))
      continue;
    motion_of(p, column, at, by);
    derive(p, at, by, column, exact);
    compare(kind, bent, column, rows, exact, 2);
  }
  return 1;
}

/* Solves the three equations rows x = right (Cramer's rule). */
static void solve(long double m[3][3], const long double right[3], long double x[3]) {
  long double whole = 0;
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    whole += m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    long double minors[3] = {m[1][j] * m[2][k] - m[1][k] * m[2][j],
                             m[2][j] * m[0][k] - m[2][k] * m[0][j],
                             m[0][j] * m[1][k] - m[0][k] * m[1][j]};
    x[i] = (right[0] * minors[0] + right[1] * minors[1] + right[2] * minors[2]) / whole;
  }
}

/* A ray in camera space. What changes with its film point is the direction, whose length stays
 * 1; with parallel rays the origin, whose z stays. rows: the derivatives of the film point, and
 * of what stays, by what changes. */
typedef struct Ray {
  long double o[3], d[3], rows[3][3];
  bool parallel;
} Ray;

static void read_ray(const Place *p, const double origin[3], const double direction[3],
                     Ray *ray) {
  static const long double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  ray->parallel = p->camera.projection == VL_PROJECTION_ORTHOGRAPHIC;
  to_camera(p, origin, true, ray->o);
  to_camera(p, direction, false, ray->d);
  for (int k = 0; k < 3; k++) {
    long double film[2];
    derive(p, ray->parallel ? ray->o : ray->d, axes[k], 0, film);
    ray->rows[0][k] = film[0];
    ray->rows[1][k] = film[1];
    ray->rows[2][k] = ray->parallel ? k == 2 : ray->d[k];
  }
}

/* How the ray in camera space changes with a column that is not of the pose: such that the film
 * point moves as asked, or stays. */
static void change_ray(const Place *p, int column, Ray *ray, long double by[3]) {
  static const long double none[3] = {0, 0, 0};
  long double right[3] = {0, 0, 0}, film[2];
  if (column < 2)
    right[column] = 1;
  if (column >= VL_JACOBIAN_INTRINSICS) {
    derive(p, ray->parallel ? ray->o : ray->d, none, column, film);
    right[0] = -film[0];
    right[1] = -film[1];
  }
  solve(ray->rows, right, by);
}

static void exact_ray(const Place *p, int column, Ray *ray, long double exact[6]) {
  int pose = column - VL_JACOBIAN_POSE;
  long double by_o[3] = {0, 0, 0}, by_d[3] = {0, 0, 0};
  if (pose >= 0 && pose < 3) {
    by_o[pose] = -1;
  } else if (pose >= 3 && pose < 6) {
    turn_about(pose - 3, ray->o, by_o);
    turn_about(pose - 3, ray->d, by_d);
    for (int i = 0; i < 3; i++) {
      by_o[i] = -by_o[i];
      by_d[i] = -by_d[i];
    }
  } else {
    change_ray(p, column, ray, ray->parallel ? by_o : by_d);
  }
  to_world(p, by_o, exact);
  to_world(p, by_d, exact + 3);
}

static int check_ray(vlProjection kind, vlDistortion bent, const Place *p,
                     const double pixel[3]) {
  double rows[6 * COLUMNS], origin[3], direction[3];
  uint8_t valid;
  vlError error;
  assert_int_equal(vl_camera_unproject_jacobian(&p->camera, 1, pixel, rows, &valid, &error),
                   VL_OK);
  if (!valid)
    return 0;
  Ray ray;
  long double exact[6];
  assert_true(vl_camera_unproject(&p->camera, pixel[0], pixel[1], origin, direction));
  read_ray(p, origin, direction, &ray);
  for (int column = 0; column < COLUMNS; column++) {
    if (column == 2 || !has_column(kind, bent, column))
      continue;
    exact_ray(p, column, &ray, exact);
    compare(kind, bent, column, rows, exact, 6);
  }
  return 1;
}

static void check_model(vlProjection kind, vlDistortion bent) {
  uint64_t state = 7 + kind + 100 * bent;
  int seen[2] = {0, 0};
  for (int i = 0; i < CAMERAS; i++) {
    Place p;
    if (!random_camera(kind, bent, 0.2, &state, &p.camera))
      return;
    const double *tilt = p.camera.distortion.tilt;
    p.distorted = bent != VL_DISTORTION_NONE;
    p.tau[0] = bent == VL_DISTORTION_OPENCV ? atan2(-tilt[7], tilt[8]) : 0.0;
    p.tau[1] = bent == VL_DISTORTION_OPENCV ? asin(tilt[6]) : 0.0;
    read_pose(&p);
    double pixel[3] = {next_between(&state, 0.2, 0.8) * p.camera.width,
                       next_between(&state, 0.2, 0.8) * p.camera.height, 0.0};
    double o[3], d[3], point[3], far = next_between(&state, 2, 5);
    if (kind == VL_PROJECTION_CUBE) { /* within a face: 100 pixels */
      pixel[0] = 100 * floor(next_between(&state, 0, 6)) + next_between(&state, 10, 90);
      pixel[1] = next_between(&state, 10, 90);
    }
    if (!vl_camera_unproject(&p.camera, pixel[0], pixel[1], o, d))
      continue;
    for (int k = 0; k < 3; k++)
      point[k] = o[k] + far * d[k];
    seen[0] += check_projection(kind, bent, &p, point);
    seen[1] += check_ray(kind, bent, &p, pixel);
  }
  assert_true(seen[0] > CAMERAS / 2);
  assert_true(seen[1] > CAMERAS / 2);
}

static void test_every_model(void **state) {
  (void)state;
  for (vlProjection kind = 0; kind < PROJECTIONS; kind++) {
    check_model(kind, VL_DISTORTION_NONE);
    for (vlDistortion bent = 1; bent < DISTORTIONS && has_distortion(kind); bent++)
      check_model(kind, bent);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_model),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
