/* conformance/cameras.h: the laws of projections and distortions: a film point's ray leads back
 * to it; many points at once give the same bits as one; the solid angle is the derivative's;
 * known radii; velo's camera files hold the camera. Those of the whole domain: camera_ways.h;
 * those of rays: camera_rays.h.
 */
#ifndef TEST_CONFORMANCE_CAMERAS_H
#define TEST_CONFORMANCE_CAMERAS_H

#include "camera_rays.h"
#include "camera_ways.h"
#include "conformance.h"
#include "distortion/distortion.case.h"
#include "files.h"
#include "projection/projection.case.h"
#include "projection/properties.row.h"
#include "unit.h"
#include "velo/camera_file.h"
#include "velo/distortion.h"
#include "velo/export.h"
#include "velo/setting.h"
#include "velo/shape_kinds.h"

#define CASE(kind, name, row) &name##_projection,
static const ProjectionCase *const projection_cases[] = {VL_PROJECTION_KINDS(CASE)};
#undef CASE
enum { PROJECTIONS = VL_PROJECTION_OWN };
_Static_assert(sizeof projection_cases / sizeof *projection_cases == PROJECTIONS,
               "a case for each projection");

#define CASE(kind, name) &name##_distortion,
static const DistortionCase *const distortion_cases[] = {VL_DISTORTION_KINDS(CASE)};
#undef CASE

/* ---- the laws ---------------------------------------------------------------------------- */

enum { FILM_WIDTH = 96, FILM_HEIGHT = 64, FILM_POINTS = 24 * 16 };

static void film_points(double pixels[2 * FILM_POINTS]) {
  for (int i = 0; i < FILM_POINTS; i++) {
    pixels[2 * i] = (i % 24 + 0.37) * FILM_WIDTH / 24;
    pixels[2 * i + 1] = (i / 24 + 0.61) * FILM_HEIGHT / 16;
  }
}

/* project after unproject, one at a time and many at once. */
static void check_round_trip(const char *family, const char *kind, const vlCamera *camera,
                             double slack) {
  static double pixels[2 * FILM_POINTS];
  static double origins[3 * FILM_POINTS];
  static double directions[3 * FILM_POINTS];
  static double points[3 * FILM_POINTS];
  static double back[2 * FILM_POINTS];
  static double depths[FILM_POINTS];
  static uint8_t seen[FILM_POINTS];
  static uint8_t found[FILM_POINTS];
  int inside = 0;
  int lost = 0;
  int other_bits = 0;
  double worst = 0;
  double stretched = 0;
  film_points(pixels);
  vl_camera_unproject_batch(camera, FILM_POINTS, pixels, origins, directions, seen);
  for (int i = 0; i < 3 * FILM_POINTS; i++)
    points[i] = origins[i] + 5 * directions[i];
  vl_camera_project_batch(camera, FILM_POINTS, points, back, depths, found);
  for (int i = 0; i < FILM_POINTS; i++) {
    double o[3];
    double d[3];
    double at[2];
    double z;
    double length = 0;
    bool one = vl_camera_unproject(camera, pixels[2 * i], pixels[2 * i + 1], o, d);
    other_bits += one != (seen[i] != 0);
    if (!one)
      continue;
    inside++;
    other_bits += memcmp(d, directions + 3 * i, sizeof d) != 0;
    for (int k = 0; k < 3; k++)
      length += d[k] * d[k];
    stretched = fmax(stretched, fabs(length - 1));
    bool projected = vl_camera_project(camera, points + 3 * i, at, &z);
    lost += !projected || !found[i];
    if (!projected || !found[i])
      continue;
    other_bits += memcmp(at, back + 2 * i, sizeof at) != 0;
    worst = fmax(worst, fmax(fabs(at[0] - pixels[2 * i]), fabs(at[1] - pixels[2 * i + 1])));
  }
  if (inside < FILM_POINTS / 4)
    broken(family, kind, "%d of %d film points have rays", inside, FILM_POINTS);
  if (lost)
    broken(family, kind, "%d of %d rays do not lead back to the film", lost, inside);
  if (!(worst < slack))
    broken(family, kind, "a ray leads back %g pixels off", worst);
  if (!(stretched < 1e-12))
    broken(family, kind, "a direction's length is off by %g", stretched);
  if (other_bits)
    broken(family, kind, "%d points have other bits in a batch", other_bits);
}

/* Filters look beyond the edges of the image: where a point there has a direction, the view
 * goes on as it goes up to the edge. */
static void check_edges(const char *kind, const vlCamera *camera) {
  enum { EACH_EDGE = 100, PLACES = 3 };
  static const double inwards[PLACES] = {0.15, 0.05, -0.05}; /* pixels from the edge */
  const double size[2] = {FILM_WIDTH, FILM_HEIGHT};
  uint32_t other = 0;
  for (int i = 0; i < 4 * EACH_EDGE; i++) {
    const int axis = i % 2;
    const bool high = i / 2 % 2 == 1;
    double o[3];
    double d[PLACES][3] = {{0}};
    bool seen = true;
    for (int k = 0; k < PLACES; k++) {
      double at[2];
      at[1 - axis] = size[1 - axis] * (i / 4 + 0.5) / EACH_EDGE;
      at[axis] = high ? size[axis] - inwards[k] : inwards[k];
      seen = seen && vl_camera_unproject(camera, at[0], at[1], o, d[k]);
    }
    const double before = angle_between(d[0], d[1]);
    const double across = angle_between(d[1], d[2]);
    other += seen && !(across > 0.5 * before && across < 2 * before);
  }
  if (other > 4)
    broken("projections", kind, "at %u of %d points of the edge the view does not go on", other,
           4 * EACH_EDGE);
}

/* The solid angle of pixels against that of the triangles between their corners' rays; the sum
 * over the image. */
static void check_solid_angle(const char *kind, const vlCamera *camera, double known) {
  double sum = 0;
  double worst = 0;
  for (int y = 0; y < FILM_HEIGHT; y++)
    for (int x = 0; x < FILM_WIDTH; x++) {
      const double e = 1e-3;
      double o[3];
      double d[3][3];
      double n = 0;
      double cx = x + 0.5;
      double cy = y + 0.5;
      double at = vl_camera_solid_angle(camera, cx, cy);
      sum += at;
      if (x % 7 != 3 || y % 5 != 2)
        continue;
      if (!vl_camera_unproject(camera, cx, cy, o, d[0]) ||
          !vl_camera_unproject(camera, cx + e, cy, o, d[1]) ||
          !vl_camera_unproject(camera, cx, cy + e, o, d[2]))
        continue;
      for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3;
        int j = (k + 2) % 3;
        double part = (d[1][i] - d[0][i]) * (d[2][j] - d[0][j]) -
                      (d[1][j] - d[0][j]) * (d[2][i] - d[0][i]);
        n += part * part;
      }
      worst = fmax(worst, fabs(sqrt(n) / (e * e) - at) / fmax(at, 1e-9));
    }
  if (!(worst < 0.01))
    broken("projections", kind, "a pixel's solid angle is off by %.3g of it", worst);
  if (known > 0 && !(fabs(sum / known - 1) < 0.02))
    broken("projections", kind, "the image covers %.4f steradians, not %.4f", sum, known);
}

/* The point of the plane where a direction is seen. */
static void check_seen(const char *kind, const vlCamera *camera, const double direction[3],
                       double x, double y) {
  double at[2];
  double z;
  if (!vl_camera_project(camera, direction, at, &z)) {
    broken("projections", kind, "does not see (%.3f, %.3f, %.3f)", direction[0], direction[1],
           direction[2]);
    return;
  }
  at[0] = (at[0] - camera->cx) / camera->fx;
  at[1] = (at[1] - camera->cy) / camera->fy;
  if (fabs(at[0] - x) > 2e-7 || fabs(at[1] - y) > 2e-7)
    broken("projections", kind,
           "(%.3f, %.3f, %.3f) is at %.8f, %.8f focal lengths, not %.8f, %.8f", direction[0],
           direction[1], direction[2], at[0], at[1], x, y);
}

/* Known radii are those to the right; of projections that are symmetric about the axis they are
 * those around it, the others have a known point besides. */
static void check_known(const char *kind, const vlCamera *camera, const ProjectionCase *c,
                        bool radial) {
  for (int i = 0; i < 2 && c->known[i].r != 0; i++)
    for (int turn = 0; turn < (radial ? 5 : 1); turn++) {
      const double theta = c->known[i].theta;
      const double across = cos(1.3 * turn);
      const double down = sin(1.3 * turn);
      const double point[3] = {sin(theta) * across, sin(theta) * down, cos(theta)};
      check_seen(kind, camera, point, c->known[i].r * across, c->known[i].r * down);
    }
  const ProjectionSeen *s = &c->seen;
  const double aside[3] = {sin(s->longitude) * cos(s->latitude), sin(s->latitude),
                           cos(s->longitude) * cos(s->latitude)};
  if (s->latitude != 0)
    check_seen(kind, camera, aside, s->x, s->y);
  else if (!radial)
    broken("projections", kind, "its case has no point off the horizontal (seen)");
}

/* velo's camera file gives the same rays. */
static void check_file(const char *family, const char *kind, const vlCameraDef *def,
                       const vlCamera *camera) {
  char path[100];
  snprintf(path, sizeof path, "%s/camera.json", folder);
  vlError error = {0};
  vlCameraFileDef file = vl_default_camera_file_def();
  vlCameraRecord record = {.camera = *def};
  file.dialect = VL_CAMERA_DIALECT_VELO;
  if (vl_camera_write(context, path, &file, &record, &error) != VL_OK) {
    broken(family, kind, "cannot be written: %s", error.message);
    return;
  }
  vlCameraRecord read;
  vlCamera again;
  memset(&read, 0, sizeof read);
  if (vl_camera_read(context, path, &file, &read, &error) != VL_OK ||
      vl_camera_make(&read.camera, &again, NULL, &error) != VL_OK) {
    broken(family, kind, "cannot be read again: %s", error.message);
    return;
  }
  static double pixels[2 * FILM_POINTS];
  int differ = 0;
  film_points(pixels);
  for (int i = 0; i < FILM_POINTS; i++) {
    double o[2][3] = {{0}};
    double d[2][3] = {{0}};
    bool one = vl_camera_unproject(camera, pixels[2 * i], pixels[2 * i + 1], o[0], d[0]);
    bool two = vl_camera_unproject(&again, pixels[2 * i], pixels[2 * i + 1], o[1], d[1]);
    for (int k = 0; k < 3; k++)
      differ += one != two || fabs(d[0][k] - d[1][k]) > 1e-12;
  }
  if (differ)
    broken(family, kind, "its file gives other rays, %d of %d", differ, 3 * FILM_POINTS);
}

/* ---- files of scenes --------------------------------------------------------------------- */

static void count_camera_loss(void *user, const char *what, uint64_t count) {
  (void)what;
  (void)count;
  ++*(int *)user;
}

/* Whether two numbers are the same but for a float's rounding. */
static bool same_number(double a, double b) {
  return a == b || (isfinite(a) && isfinite(b) && fabs(a - b) <= 2e-6 * fmax(fabs(a), fabs(b)));
}

/* What two cameras differ in; null: nothing. */
static const char *camera_difference(const vlCamera *a, const vlCamera *b) {
  const struct {
    const char *name;
    double a, b;
  } members[] = {{"lens_radius", a->lens_radius, b->lens_radius},
                 {"focus_distance", a->focus_distance, b->focus_distance},
                 {"shutter_open", a->shutter_open, b->shutter_open},
                 {"shutter_close", a->shutter_close, b->shutter_close},
                 {"exposure_time", a->exposure_time, b->exposure_time},
                 {"near_plane", a->near_plane, b->near_plane},
                 {"far_plane", a->far_plane, b->far_plane},
                 {"readout", a->readout, b->readout},
                 {"readout_direction", a->readout_direction, b->readout_direction},
                 {"blades", a->lens.blades, b->lens.blades},
                 {"rotation", a->lens.rotation, b->lens.rotation},
                 {"ratio", a->lens.ratio, b->lens.ratio},
                 {"tilt_x", a->lens.tilt[0], b->lens.tilt[0]},
                 {"tilt_y", a->lens.tilt[1], b->lens.tilt[1]},
                 {"shutter_points", a->shutter_points, b->shutter_points},
                 {"shutter_value", a->shutter_value[1], b->shutter_value[1]},
                 {"motion", a->moves, b->moves}};
  static double pixels[2 * FILM_POINTS];
  for (size_t i = 0; i < sizeof members / sizeof *members; i++)
    if (!same_number(members[i].a, members[i].b))
      return members[i].name;
  film_points(pixels);
  for (int i = 0; i < FILM_POINTS; i++) {
    double o[2][3] = {{0}};
    double d[2][3] = {{0}};
    bool one = vl_camera_unproject(a, pixels[2 * i], pixels[2 * i + 1], o[0], d[0]);
    bool two = vl_camera_unproject(b, pixels[2 * i], pixels[2 * i + 1], o[1], d[1]);
    if (one != two)
      return "its domain";
    for (int k = 0; k < 3; k++)
      if (fabs(d[0][k] - d[1][k]) > 2e-6 || fabs(o[0][k] - o[1][k]) > 2e-5)
        return "its rays";
  }
  return NULL;
}

/* Whether a glTF file holds near plane, far plane and vertical field of view in its own
 * members, too: velo reads its own description in the extras, others do not. */
static void check_plain_gltf(const char *family, const char *kind, const char *path,
                             const vlCamera *made) {
  static char text[1 << 16];
  vlError error = {0};
  vlScene *scene;
  vlCamera again;
  FILE *file = fopen(path, "rb");
  size_t size = file ? fread(text, 1, sizeof text - 1, file) : 0;
  assert_true(file && fclose(file) == 0 && size > 0 && size < sizeof text - 1);
  text[size] = 0;
  for (char *at = text; (at = strstr(at, "\"extras\"")); at++)
    memcpy(at, "\"unread\"", 8);
  char plain[100];
  snprintf(plain, sizeof plain, "%s/plain.gltf", folder);
  assert_true(write_bytes("plain.gltf", text, size));
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlResult result = vl_scene_load(scene, plain, NULL, &error);
  vlCameraDef read = vl_scene_defs(scene)->camera;
  if (result == VL_OK)
    result = vl_camera_make(&read, &again, NULL, &error);
  vl_scene_destroy(scene);
  if (result != VL_OK) {
    broken(family, kind, "as .gltf without extras: %s", error.message);
    return;
  }
  /* glTF's near plane is above 0, and its orthographic cameras have a far plane */
  bool flat = made->projection == VL_PROJECTION_ORTHOGRAPHIC;
  const double members[3][2] = {
      {made->near_plane > 0 ? made->near_plane : again.near_plane, again.near_plane},
      {flat && isinf(made->far_plane) ? again.far_plane : made->far_plane, again.far_plane},
      {made->height / made->fy, again.height / again.fy}};
  static const char *const names[3] = {"near_plane", "far_plane", "field of view"};
  for (int i = 0; i < 3; i++)
    if (!same_number(members[i][0], members[i][1]))
      broken(family, kind, "as .gltf without extras: %s %g, not %g", names[i], members[i][1],
             members[i][0]);
}

/* The scene with this camera as a file of a scene and read again: the same camera, or the
 * writer says what it loses. False: it loses something. */
static bool check_scene_file(const char *family, const char *kind, const vlCameraDef *def,
                             const char *suffix) {
  char path[100];
  int losses = 0;
  vlError error = {0};
  vlScene *scene;
  vlCamera made;
  vlCamera again;
  if (vl_camera_make(def, &made, NULL, &error) != VL_OK)
    return false;
  snprintf(path, sizeof path, "%s/camera.%s", folder, suffix);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vl_scene_defs(scene)->camera = *def;
  vl_scene_defs(scene)->film = vl_default_film_def(def->width, def->height);
  vl_scene_defs(scene)->camera_missing = false;
  static const float corners[9] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  static const uint32_t face[3] = {0, 1, 2};
  vlShapeDef triangle = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  triangle.vertices = 3;
  triangle.faces = 1;
  triangle.positions = corners;
  triangle.indices = face;
  vl_scene_add_shape(scene, &triangle);
  vlSaveDef save = vl_default_save_def();
  save.lost = count_camera_loss;
  save.lost_user = &losses;
  vlResult result = vl_scene_save(scene, path, &save, &error);
  vl_scene_destroy(scene);
  if (losses)
    return false;
  if (result != VL_OK)
    broken(family, kind, "as .%s: %s", suffix, error.message);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  result = vl_scene_load(scene, path, NULL, &error);
  vlCameraDef read = vl_scene_defs(scene)->camera;
  read.width = def->width; /* glTF has no sizes of images */
  read.height = def->height;
  /* pbrt's is the film's */
  read.exposure_time *= (double)vl_scene_defs(scene)->develop.exposure;
  if (result == VL_OK)
    result = vl_camera_make(&read, &again, NULL, &error);
  if (result != VL_OK)
    broken(family, kind, "as .%s it cannot be read: %s", suffix, error.message);
  else if (camera_difference(&made, &again))
    broken(family, kind, "as .%s: other %s", suffix, camera_difference(&made, &again));
  vl_scene_destroy(scene);
  bool pinhole = def->projection == VL_PROJECTION_PERSPECTIVE && def->distortion_count == 0;
  if (strcmp(suffix, "gltf") == 0 && (pinhole || def->projection == VL_PROJECTION_ORTHOGRAPHIC))
    check_plain_gltf(family, kind, path, &made);
  return true;
}

static bool make_camera(const char *family, const char *kind, vlCameraDef *def,
                        vlCamera *camera) {
  static const double axes[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  vlError error = {0};
  def->has_matrix = true; /* camera space is world space: z forward, y down */
  memcpy(def->world_from_camera, axes, sizeof axes);
  if (vl_camera_make(def, camera, NULL, &error) == VL_OK)
    return true;
  broken(family, kind, "%s", error.message);
  return false;
}

/* The derivatives at some points of the film, 5 away. */
static void check_derivatives_in_film(const char *family, const char *kind,
                                      const vlCamera *camera) {
  enum { EACH = 11 };
  static double pixels[2 * FILM_POINTS];
  static double points[3 * FILM_POINTS];
  uint32_t count = 0;
  film_points(pixels);
  for (int i = 0; i < FILM_POINTS; i += EACH) {
    double o[3];
    double d[3];
    if (!vl_camera_unproject(camera, pixels[2 * i], pixels[2 * i + 1], o, d))
      continue;
    for (int k = 0; k < 3; k++)
      points[3 * count + (uint32_t)k] = o[k] + 5 * d[k];
    count++;
  }
  check_derivatives(family, kind, camera, points, count);
}

/* The whole domain of a projection, to its end. */
static void check_domain(const char *name, const vlCameraDef *def, const vlCamera *camera,
                         double end) {
  check_ways("projections", name, camera);
  check_ray_width(name, camera);
  /* without distortion a perspective camera sees all that lies ahead */
  bool circles = vl_projection_row(def->projection)->traits & VL_PROJECTION_CIRCLE &&
                 def->projection != VL_PROJECTION_PERSPECTIVE;
  if (end > 0)
    check_end(name, def, end, circles);
}

static vlCameraDef def_of_projection(vlProjection kind) {
  const ProjectionCase *c = projection_cases[kind];
  vlCameraDef def = vl_default_camera_def(FILM_WIDTH, FILM_HEIGHT);
  def.projection = kind;
  if (c->fov > 0)
    def.fov = c->fov * PI / 180;
  if (c->fov > 0)
    def.fov_axis = VL_FOV_SMALLER;
  if (c->focal > 0)
    def.fx = def.fy = c->focal;
  memcpy(def.shape, c->shape, sizeof def.shape);
  return def;
}

/* The laws that need no known values, for the other shape of a case. */
static void check_other_shape(const char *name, vlProjection kind) {
  vlCameraDef def = def_of_projection(kind);
  vlCamera camera;
  memcpy(def.shape, projection_cases[kind]->other, sizeof def.shape);
  if (!make_camera("projections", name, &def, &camera))
    return;
  check_round_trip("projections", name, &camera, 1e-8);
  check_solid_angle(name, &camera, 0);
  check_domain(name, &def, &camera, 0);
  check_derivatives_in_film("projections", name, &camera);
  check_file("projections", name, &def, &camera);
}

/* Pixels of another form, and then columns of pixels that lean: panoramas would go on around
 * there. */
static void check_other_pixels(const char *name, const vlCameraDef *def, const vlCamera *camera,
                               const ProjectionCase *c) {
  const vlProjectionRow *row = vl_projection_row(def->projection);
  vlCameraDef other = *def;
  vlCamera tall;
  other.fov = VL_UNSET;
  other.fx = camera->fx;
  other.fy = 1.3 * camera->fy;
  if (!make_camera("projections", name, &other, &tall))
    return;
  check_round_trip("projections", name, &tall, 1e-8);
  check_known(name, &tall, c, row->traits & VL_PROJECTION_RADIAL);
  check_derivatives_in_film("projections", name, &tall);
  check_moving(name, &other);
  check_scene_file("projections", name, &other, "pbrt");
  check_scene_file("projections", name, &other, "gltf");
  other.skew = 0.2 * camera->fx;
  if (!(row->traits & VL_PROJECTION_RADIAL) || !make_camera("projections", name, &other, &tall))
    return;
  check_round_trip("projections", name, &tall, 1e-8);
  check_file("projections", name, &other, &tall);
}

static void laws_of_projections(void **state) {
  (void)state;
  vlOptics *optics = NULL;
  vlOpticsDef optics_def = vl_default_optics_def();
  assert_int_equal(
      vl_optics_load(context, VELO_SOURCE_DIR "/scenes/cameras/lenses/double_gauss_50mm.dat",
                     &optics_def, &optics, NULL),
      VL_OK);
  for (int p = 0; p < PROJECTIONS; p++) {
    const ProjectionCase *c = projection_cases[p];
    const char *name = vl_projection_name((vlProjection)p);
    vlCameraDef def = def_of_projection((vlProjection)p);
    vlCamera camera;
    if (c->optics)
      def.lens.optics = optics;
    if (!make_camera("projections", name, &def, &camera))
      continue;
    check_round_trip("projections", name, &camera, c->optics ? 1e-6 : 1e-8);
    if (p != VL_PROJECTION_ORTHOGRAPHIC)
      check_solid_angle(name, &camera, c->solid_angle);
    if (c->solid_angle > 3.99 * PI)
      check_whole_sphere(name, &camera);
    const vlProjectionRow *row = vl_projection_row((vlProjection)p);
    check_known(name, &camera, c, row->traits & VL_PROJECTION_RADIAL);
    if (p != VL_PROJECTION_ORTHOGRAPHIC && !c->optics)
      check_domain(name, &def, &camera, c->end);
    if (p != VL_PROJECTION_ORTHOGRAPHIC)
      check_edges(name, &camera);
    check_derivatives_in_film("projections", name, &camera);
    check_moving(name, &def);
    check_clock(name, &def);
    if (!c->optics)
      check_focus_point(name, &def);
    if (!c->optics)
      check_file("projections", name, &def, &camera);
    if (!c->optics)
      check_scene_file("projections", name, &def, "pbrt");
    check_scene_file("projections", name, &def, "gltf");
    if (!c->optics)
      check_other_pixels(name, &def, &camera, c);
    if (c->has_other)
      check_other_shape(name, (vlProjection)p);
  }
  vl_optics_destroy(optics);
  expect_no_failures();
}

static void check_distortion(const char *name, const DistortionCase *c, vlDistortion kind,
                             const DistortionVariant *variant) {
  vlCameraDef def = vl_default_camera_def(FILM_WIDTH, FILM_HEIGHT);
  vlCamera camera;
  def.fx = def.fy = 70;
  def.distortion = kind;
  def.distortion_count = variant->count;
  memcpy(def.distortion_coefficients, variant->k, sizeof variant->k);
  if (!make_camera("distortions", name, &def, &camera))
    return;
  check_round_trip("distortions", name, &camera, 1e-8);
  check_ways("distortions", name, &camera);
  check_round_end(name, &camera);
  check_derivatives_in_film("distortions", name, &camera);
  check_file("distortions", name, &def, &camera);
  check_scene_file("distortions", name, &def, "pbrt");
  check_scene_file("distortions", name, &def, "gltf");
  for (int k = 0; k < 4; k++) {
    const double point[3] = {k & 1 ? 0.3 : -0.4, k & 2 ? 0.25 : -0.1, 1};
    double known[2];
    double at[2] = {0, 0};
    c->plain(variant, point[0], point[1], known);
    vl_camera_project(&camera, point, at, NULL);
    for (int j = 0; j < 2; j++)
      if (fabs((at[j] - (j ? camera.cy : camera.cx)) / 70 - known[j]) > 1e-10)
        broken("distortions", name, "(%g, %g) goes to %.9f along %c, not to %.9f", point[0],
               point[1], (at[j] - (j ? camera.cy : camera.cx)) / 70, j ? 'y' : 'x', known[j]);
  }
}

static void laws_of_distortions(void **state) {
  (void)state;
#define NAME(kind, name) #name,
  static const char *const names[] = {VL_DISTORTION_KINDS(NAME)};
#undef NAME
  for (uint32_t k = 0; k < VL_DISTORTION_KIND_COUNT; k++)
    for (int i = 0; i < DISTORTION_VARIANTS; i++)
      if (i == 0 || distortion_cases[k]->variants[i].count)
        check_distortion(names[k], distortion_cases[k], k, &distortion_cases[k]->variants[i]);
  expect_no_failures();
}

/* ---- settings ---------------------------------------------------------------------------- */

/* Puts another value than the default into a member; false: it has no number. */
static bool put_other_setting(const vlParameter *p, vlCameraDef *def) {
  bool limited = p->low != 0 || p->high != 0;
  double number = isinf(p->value[0]) ? 50 : p->value[0] + 0.25;
  if (limited && number <= p->low)
    number = p->low + 0.25;
  if (limited && number >= p->high)
    number = 0.5 * (p->low + p->high) + 0.01;
  char message[VL_GIVEN_MESSAGE];
  vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = number};
  if (p->type == VL_PARAMETER_COUNT)
    given.number = floor(number) + 5;
  if (p->type == VL_PARAMETER_BOOL)
    given = (vlGiven){.kind = VL_GIVEN_FLAG, .number = p->value[0] == 0};
  if (p->type == VL_PARAMETER_CHOICE)
    given = (vlGiven){.kind = VL_GIVEN_TEXT, .text = p->choices[p->value[0] == 0 ? 1 : 0]};
  if (p->type == VL_PARAMETER_DOUBLE3) {
    double *at = (double *)(void *)((char *)def + p->offset);
    for (int i = 0; i < 3; i++)
      at[i] = p->value[i] + 0.3 + 0.1 * i;
    return true;
  }
  bool one = p->type == VL_PARAMETER_COUNT || p->type == VL_PARAMETER_BOOL ||
             p->type == VL_PARAMETER_CHOICE || p->type == VL_PARAMETER_DOUBLE;
  double checked;
  if (!one || !vl_given_check(p, p->member, &given, &checked, message))
    return false;
  vl_given_put(p, checked, def);
  return true;
}

/* Shutter curves of the fewest and of the most points, in text and in files of scenes. */
static void settings_of_arrays(void) {
  static const uint32_t counts[2] = {2, VL_SHUTTER_POINTS};
  for (int k = 0; k < 2; k++) {
    char text[TEXT];
    char curve[1000] = "";
    vlCameraDef def = vl_default_camera_def(FILM_WIDTH, FILM_HEIGHT);
    def.eye[2] = 3;
    def.shutter_points = counts[k];
    for (uint32_t i = 0; i < counts[k]; i++) {
      def.shutter_at[i] = (double)i / counts[k];
      def.shutter_value[i] = 1.0 + i % 3;
      size_t used = strlen(curve);
      snprintf(curve + used, sizeof curve - used, "%.17g %.17g ", def.shutter_at[i],
               def.shutter_value[i]);
    }
    snprintf(text, sizeof text, "Camera \"pinhole\" \"float shutterpoints\" [%s] WorldBegin",
             curve);
    vlScene *scene = need_scene(text);
    const vlCameraDef *read = &vl_scene_defs(scene)->camera;
    bool same = read->shutter_points == def.shutter_points;
    for (uint32_t i = 0; i < counts[k] && same; i++)
      same = same_number(read->shutter_at[i], def.shutter_at[i]) &&
             same_number(read->shutter_value[i], def.shutter_value[i]);
    if (!same)
      broken("cameras", "shutterpoints", "%u points are read as others", counts[k]);
    vl_scene_destroy(scene);
    check_scene_file("cameras", "shutter", &def, "pbrt");
    check_scene_file("cameras", "shutter", &def, "gltf");
  }
}

/* Every setting of cameras, in turn, is in files of scenes, or the writer says that it is
 * not. */
static void settings_of_cameras(void **state) {
  (void)state;
  int kept[2] = {0, 0};
  static const char *const suffixes[] = {"pbrt", "gltf"};
  const vlKindRow *rows = vl_settings(VL_SETTING_CAMERA);
  for (uint32_t i = 0; i < rows->parameter_count; i++) {
    const vlParameter *p = &rows->parameters[i];
    bool size = strcmp(p->member, "width") == 0 || strcmp(p->member, "height") == 0;
    if (p->flags & (VL_PARAMETER_SHORTHAND | VL_PARAMETER_RULE) || size)
      continue;
    for (int k = 0; k < 2; k++) {
      vlCameraDef def = vl_default_camera_def(FILM_WIDTH, FILM_HEIGHT);
      def.eye[2] = 3;
      if (k == 0) { /* without a lens others have no effect; glTF has none */
        def.lens_radius = 0.02;
        def.focus_distance = 4;
      }
      if (strcmp(p->member, "readout_direction") == 0)
        def.readout = 0.1;
      if (strcmp(p->member, "lens.rotation") == 0)
        def.lens.blades = 6;
      if (put_other_setting(p, &def))
        kept[k] += check_scene_file("cameras", p->member, &def, suffixes[k]);
    }
  }
  settings_of_arrays();
  print_message("settings that files of scenes keep: pbrt %d, glTF %d\n", kept[0], kept[1]);
  assert_true(kept[0] > 20);
  expect_no_failures();
}

#endif
