/* view/engine_curves.c: drawings over the image as the camera sees them, for every projection
 * and distortion: axes, ground grid, horizon, lines to the vanishing points, and the distortion
 * field. */
#include <math.h>
#include <string.h>

#include "cli/vector.h"
#include "view/engine_status.h"

enum { GRID = 12, GRID_STEPS = 48, AXIS_STEPS = 24, HORIZON_STEPS = 512, FIELD = 24 };

/* A curve on the way into the message: points of the image; a point without a projection begins
 * a new curve. */
typedef struct Curve {
  Json *json;
  const vlCamera *camera;
  const char *name;
  double last[2];
  /* open: the array is begun; known: `last` is the end of it, or a first point */
  bool open, known;
} Curve;

static void curve_break(Curve *c) {
  if (c->open)
    json_end(c->json, ']');
  c->open = c->known = false;
}

static void put_point(Json *json, const double pixel[2]) {
  for (int i = 0; i < 2; i++)
    json_number(json, NULL, floor(100 * pixel[i] + 0.5) / 100);
}

/* Adds the image of a point. Steps of more than a quarter of the image are seams of a
 * panorama. */
static void curve_to(Curve *c, const double point[3]) {
  double pixel[2], w = c->camera->width, h = c->camera->height;
  bool seen = vl_camera_project(c->camera, point, pixel, NULL) && pixel[0] > -2 * w &&
              pixel[0] < 3 * w && pixel[1] > -2 * h && pixel[1] < 3 * h;
  if (!seen) {
    curve_break(c);
    return;
  }
  if (c->known && hypot(pixel[0] - c->last[0], pixel[1] - c->last[1]) > 0.25 * (w + h))
    curve_break(c);
  if (c->known && !c->open) {
    json_begin(c->json, NULL, '[');
    json_text(c->json, NULL, c->name);
    put_point(c->json, c->last);
    c->open = true;
  }
  if (c->known)
    put_point(c->json, pixel);
  memcpy(c->last, pixel, sizeof c->last);
  c->known = true;
}

static void segment(Json *json, const vlCamera *camera, const char *name, const double a[3],
                    const double b[3], int steps) {
  Curve curve = {.json = json, .camera = camera, .name = name};
  double p[3], way[3];
  vector_subtract(b, a, way);
  for (int i = 0; i <= steps; i++) {
    vector_along(a, (double)i / steps, way, p);
    curve_to(&curve, p);
  }
  curve_break(&curve);
}

static const char *const axis_names[3] = {"x", "y", "z"};

static void put_axes(Json *json, const vlCamera *camera, const CameraPose *pose) {
  const double arm = camera_arm(pose);
  for (int i = 0; i < 3; i++) {
    double end[3];
    memcpy(end, pose->lookat, sizeof end);
    end[i] += 0.25 * arm;
    segment(json, camera, axis_names[i], pose->lookat, end, AXIS_STEPS);
  }
}

/* Lines of a plane across the axis that is nearest to up, at the lower end of the scene's
 * bounds; web/overlay.js draws the same. */
static void put_grid(Json *json, const vlCamera *camera, const CameraPose *pose,
                     const vlWorldInfo *info) {
  int k = 0;
  double reach = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(pose->up[i]) > fabs(pose->up[k]))
      k = i;
  for (int i = 0; i < 3; i++)
    reach = hypot(reach, 2 * (pose->lookat[i] - pose->eye[i]));
  if (!(reach > 0))
    return;
  double step = pow(10, floor(log10(reach / 12) + 0.5));
  double level = (double)(pose->up[k] > 0 ? info->bounds_min[k] : info->bounds_max[k]);
  if (!(fabs(level) < 1e6))
    level = 0;
  int axes[2] = {(k + 1) % 3, (k + 2) % 3};
  for (int t = -GRID; t <= GRID; t++)
    for (int n = 0; n < 2; n++) {
      int a = axes[n], b = axes[1 - n];
      double p[3], q[3];
      p[k] = q[k] = level;
      p[a] = q[a] = (floor(pose->lookat[a] / step + 0.5) + t) * step;
      p[b] = (floor(pose->lookat[b] / step + 0.5) - GRID) * step;
      q[b] = (floor(pose->lookat[b] / step + 0.5) + GRID) * step;
      segment(json, camera, t ? "grid" : "middle", p, q, GRID_STEPS);
    }
}

static void far_point(const double eye[3], const double direction[3], double point[3]) {
  vector_along(eye, 1e6, direction, point);
}

/* The images of all directions across up. */
static void put_horizon(Json *json, const vlCamera *camera, const CameraPose *pose) {
  Curve curve = {.json = json, .camera = camera, .name = "horizon"};
  double a[3], b[3], d[3], p[3];
  if (camera->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return;
  vector_across(pose->up, a, b);
  for (int i = 0; i <= HORIZON_STEPS; i++) {
    double t = 2 * M_PI * i / HORIZON_STEPS;
    for (int k = 0; k < 3; k++)
      d[k] = cos(t) * a[k] + sin(t) * b[k];
    far_point(pose->eye, d, p);
    curve_to(&curve, p);
  }
  curve_break(&curve);
}

/* The images of lines parallel to the axes, through the rays of the image's corners and middle,
 * up to their vanishing points. */
static void put_vanishing_lines(Json *json, const vlCamera *camera, const CameraPose *pose) {
  static const double positions[5][2] = {
      {0.02, 0.02}, {0.98, 0.02}, {0.02, 0.98}, {0.98, 0.98}, {0.5, 0.5}};
  if (camera->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return;
  for (int axis = 0; axis < 3; axis++)
    for (int n = 0; n < 5; n++) {
      double o[3], d[3], p[3], mixed[3];
      if (!vl_camera_unproject(camera, positions[n][0] * camera->width,
                               positions[n][1] * camera->height, o, d))
        continue;
      /* the end that the camera sees */
      double sign = camera->world_from_camera[4 * axis + 2] < 0 ? -1 : 1;
      Curve curve = {.json = json, .camera = camera, .name = axis_names[axis]};
      for (int i = 0; i <= AXIS_STEPS; i++) {
        double t = (double)i / AXIS_STEPS;
        for (int k = 0; k < 3; k++)
          mixed[k] = (1 - t) * d[k] + (k == axis ? sign * t : 0);
        far_point(pose->eye, mixed, p);
        curve_to(&curve, p);
      }
      curve_break(&curve);
    }
}

/* Where a pinhole of the same fx, fy, cx, cy would show what a pixel shows: x0, y0, x, y for
 * points of a net. */
static void put_field(Json *json, const vlCamera *c) {
  double greatest = 0;
  int rows = (int)ceil((double)FIELD * c->height / c->width);
  json_begin(json, "field", '[');
  for (int i = 0; i < (FIELD + 1) * (rows + 1) && c->projection != VL_PROJECTION_ORTHOGRAPHIC;
       i++) {
    double o[3], d[3], at[3];
    const double to[2] = {(double)c->width * (i % (FIELD + 1)) / FIELD,
                          (double)c->height * (i / (FIELD + 1)) / rows};
    if (!vl_camera_unproject(c, to[0], to[1], o, d))
      continue;
    for (int k = 0; k < 3; k++)
      at[k] = vector_dot(c->camera_from_world + 4 * k, d);
    if (!(at[2] > 0.02))
      continue;
    const double from[2] = {c->cx + (c->fx * at[0] + c->skew * at[1]) / at[2],
                            c->cy + c->fy * at[1] / at[2]};
    double length = hypot(to[0] - from[0], to[1] - from[1]);
    if (length > greatest)
      greatest = length;
    json_begin(json, NULL, '[');
    put_point(json, from);
    put_point(json, to);
    json_end(json, ']');
  }
  json_end(json, ']');
  json_number(json, "greatest", greatest);
}

void engine_put_curves(Json *json, const ViewCamera *camera, const vlWorldInfo *info,
                       bool field) {
  const CameraPose pose = camera_pose(camera);
  const vlCamera *c = &camera->made;
  static const char *const names[] = {"axes", "grid", "horizon", "vanishing"};
  json_begin(json, "curves", '{');
  for (int i = 0; i < 4; i++) {
    json_begin(json, names[i], '[');
    if (i == 0)
      put_axes(json, c, &pose);
    if (i == 1)
      put_grid(json, c, &pose, info);
    if (i == 2)
      put_horizon(json, c, &pose);
    if (i == 3)
      put_vanishing_lines(json, c, &pose);
    json_end(json, ']');
  }
  json_end(json, '}');
  if (field)
    put_field(json, c);
}
