/* camera/drawing.c: vl_camera_outline: a camera as lines, faces and labels in world space. */
#include "velo/drawing.h"
#include "math/double3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "base/context.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/free.h"
#include "math/elementary.h"

/* Steps of a curve: an edge of the image, a circle. */
enum { STEPS = 48, EDGES = 8 };

typedef struct Pen {
  vlContext *context;
  const vlCamera *camera;
  const vlDrawingDef *def;
  uint32_t index;    /* of the camera */
  bool flat;         /* the view surface is a plane */
  double forward[3]; /* unit view direction */
  bool failed;
  VL_ARRAY(vlDrawingLine) lines;
  VL_ARRAY(vlDrawingFace) faces;
  VL_ARRAY(vlDrawingLabel) labels;
} Pen;

/* ---- primitives -------------------------------------------------------------------------- */

static bool wanted(const Pen *p, vlDrawingPart part) {
  return p->def->parts >> part & 1;
}

/* An element that was added; null, without memory, makes the drawing fail. */
static void *kept(Pen *p, void *added) {
  p->failed |= !added;
  return added;
}
/* A new element of a part; null if the part is not wanted. */
#define NEW(p, part, elements) \
  (wanted(p, part) ? kept(p, VL_PUSH((p)->context, &(p)->elements)) : NULL)

static void line(Pen *p, vlDrawingPart part, const double a[3], const double b[3]) {
  vlDrawingLine *l = NEW(p, part, lines);
  if (!l)
    return;
  l->part = part;
  l->camera = p->index;
  memcpy(l->from, a, sizeof l->from);
  memcpy(l->to, b, sizeof l->to);
}

static void face(Pen *p, vlDrawingPart part, const double a[3], const double b[3],
                 const double c[3], const double d[3]) {
  vlDrawingFace *f = NEW(p, part, faces);
  if (!f)
    return;
  f->part = part;
  f->camera = p->index;
  const double *const corners[4] = {a, b, c, d};
  for (int i = 0; i < 4; i++)
    memcpy(f->corners[i], corners[i], sizeof f->corners[i]);
}

static void label(Pen *p, vlDrawingPart part, const double at[3], const char *text) {
  vlDrawingLabel *l = NEW(p, part, labels);
  if (!l)
    return;
  l->part = part;
  l->camera = p->index;
  memcpy(l->at, at, sizeof l->at);
  snprintf(l->text, sizeof l->text, "%s", text);
}

static void eye_of(const vlCamera *c, double eye[3]) {
  for (int i = 0; i < 3; i++)
    eye[i] = c->world_from_camera[4 * i + 3];
}

/* Unit camera axis i (0 right, 1 down, 2 forward) in the world. */
static void axis_of(const vlCamera *c, int i, double axis[3]) {
  for (int k = 0; k < 3; k++)
    axis[k] = c->world_from_camera[4 * k + i];
  vl_normalize3(axis);
}

/* ---- the view surface -------------------------------------------------------------------- */

/* The point at `depth` on the ray of film point (x, y): depth along the view direction if the
 * surface is flat, else distance from the ray's origin. Negative depth: behind the eye. */
static bool at_depth(const Pen *p, double x, double y, double depth, double point[3]) {
  double o[3], d[3];
  if (!vl_camera_unproject(p->camera, x, y, o, d))
    return false;
  double along = p->flat ? vl_dot3(d, p->forward) : 1.0;
  if (!(along > 1e-6))
    return false;
  vl_along3(o, depth / along, d, point);
  return true;
}

/* A curve on the surface at `depth` between two film points; pieces without rays are left
 * out. */
static void curve(Pen *p, vlDrawingPart part, double x0, double y0, double x1, double y1,
                  double depth) {
  const vlCamera *c = p->camera;
  bool straight = p->flat && c->distortion.steps == 0;
  int steps = straight ? 1 : STEPS;
  double last[3], next[3];
  bool known = false;
  for (int i = 0; i <= steps; i++) {
    double t = (double)i / steps;
    bool valid = at_depth(p, x0 + t * (x1 - x0), y0 + t * (y1 - y0), depth, next);
    if (valid && known)
      line(p, part, last, next);
    known = valid;
    memcpy(last, next, sizeof last);
  }
}

/* The film point `share` of the way round the image circle, pulled in a little; false where the
 * camera has no circle or it lies outside of the image there. */
static bool on_circle(const vlCamera *c, double share, double xy[2]) {
  if (!(c->limit < 1e6))
    return false;
  double t = 2.0 * M_PI * share, r = c->limit * (1.0 - 1e-6);
  xy[0] = c->cx + c->fx * r * vl_precise_cos(t) + c->skew * r * vl_precise_sin(t);
  xy[1] = c->cy + c->fy * r * vl_precise_sin(t);
  return xy[0] >= 0 && xy[1] >= 0 && xy[0] <= c->width && xy[1] <= c->height;
}

/* The border of the image at `depth`: the window's edges, and the image circle where it is
 * inside of them. */
static void border(Pen *p, vlDrawingPart part, double depth) {
  const vlCamera *c = p->camera;
  double w = c->width, h = c->height, a[2], b[2], u[3], v[3];
  curve(p, part, 0, 0, w, 0, depth);
  curve(p, part, w, 0, w, h, depth);
  curve(p, part, w, h, 0, h, depth);
  curve(p, part, 0, h, 0, 0, depth);
  for (int i = 0; i < 4 * STEPS; i++) {
    if (!on_circle(c, (double)i / (4 * STEPS), a) ||
        !on_circle(c, (double)(i + 1) / (4 * STEPS), b))
      continue;
    if (at_depth(p, a[0], a[1], depth, u) && at_depth(p, b[0], b[1], depth, v))
      line(p, part, u, v);
  }
}

/* Whether the whole image circle is inside of the image. */
static bool whole_circle(const vlCamera *c) {
  double xy[2];
  for (int i = 0; i < 4; i++)
    if (!on_circle(c, 0.25 * i, xy))
      return false;
  return true;
}

/* Film point (i, j) of a net of n x n over the image, or over the image circle: its rings and
 * spokes. */
static void net_point(const vlCamera *c, bool circle, int i, int j, int n, double xy[2]) {
  xy[0] = c->width * (double)i / n;
  xy[1] = c->height * (double)j / n;
  if (!circle)
    return;
  double rim[2] = {c->cx, c->cy}, share = (double)j / n;
  on_circle(c, (double)i / n, rim);
  xy[0] = c->cx + share * (rim[0] - c->cx);
  xy[1] = c->cy + share * (rim[1] - c->cy);
}

/* Faces of the surface at `depth`. */
static void surface(Pen *p, vlDrawingPart part, double depth) {
  const vlCamera *c = p->camera;
  bool circle = whole_circle(c);
  int n = p->flat && c->distortion.steps == 0 ? 1 : 32;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      double q[4][3], xy[2];
      bool valid = true;
      for (int k = 0; k < 4; k++) {
        net_point(c, circle, i + (k == 1 || k == 2), j + (k >= 2), n, xy);
        valid = valid && at_depth(p, xy[0], xy[1], depth, q[k]);
      }
      if (valid)
        face(p, part, q[0], q[1], q[2], q[3]);
    }
}

/* Every how many pixels there is a grid line: 1, 2, 5, 10, ... */
static uint32_t grid_step(uint32_t size, uint32_t max) {
  static const uint32_t factors[3] = {1, 2, 5};
  for (uint64_t ten = 1;; ten *= 10)
    for (int i = 0; i < 3; i++)
      if (size / (factors[i] * ten) <= (max ? max : 1))
        return (uint32_t)(factors[i] * ten);
}

static void grid(Pen *p, double depth) {
  const vlCamera *c = p->camera;
  if (p->def->grid == 0)
    return;
  uint32_t step = grid_step(c->width > c->height ? c->width : c->height, p->def->grid);
  for (uint32_t x = step; x < c->width; x += step)
    curve(p, VL_DRAWING_GRID, x, 0, x, c->height, depth);
  for (uint32_t y = step; y < c->height; y += step)
    curve(p, VL_DRAWING_GRID, 0, y, c->width, y, depth);
}

/* Lines along the edges of the view volume, up to a depth: through the corners; of curved
 * surfaces also through the middles of the edges, and around the image circle. */
static void edges(Pen *p, vlDrawingPart part, double to) {
  const vlCamera *c = p->camera;
  double a[3], b[3], xy[2];
  bool circle = on_circle(c, 0, xy) || on_circle(c, 0.25, xy);
  for (int i = 0; i < EDGES; i++) {
    static const double square[EDGES][2] = {{0, 0},   {1, 0},   {1, 1},   {0, 1},
                                            {0.5, 0}, {1, 0.5}, {0.5, 1}, {0, 0.5}};
    if (p->flat && i >= 4)
      break;
    if (!circle || !on_circle(c, (double)i / EDGES, xy)) {
      xy[0] = square[i][0] * c->width;
      xy[1] = square[i][1] * c->height;
    }
    if (at_depth(p, xy[0], xy[1], 0, a) && at_depth(p, xy[0], xy[1], to, b))
      line(p, part, a, b);
  }
}

/* ---- the parts of one camera ------------------------------------------------------------- */

static void draw_eye(Pen *p) {
  const vlCamera *c = p->camera;
  double eye[3], right[3], down[3], last[3], next[3];
  eye_of(c, eye);
  axis_of(c, 0, right);
  axis_of(c, 1, down);
  line(p, VL_DRAWING_EYE, eye, eye);
  label(p, VL_DRAWING_EYE, eye, "e");
  for (int i = 0; c->lens_radius > 0 && i <= STEPS; i++) {
    double t = 2 * M_PI * i / STEPS;
    vl_along3(eye, c->lens_radius * vl_precise_cos(t), right, next);
    vl_along3(next, c->lens_radius * vl_precise_sin(t), down, next);
    if (i)
      line(p, VL_DRAWING_EYE, last, next);
    memcpy(last, next, sizeof last);
  }
}

static void draw_axes(Pen *p, double length) {
  static const char *const names[3] = {"u", "v", "w"};
  static const int sign[3] = {1, -1, -1};
  double eye[3], axis[3], end[3];
  eye_of(p->camera, eye);
  for (int i = 0; i < 3; i++) {
    axis_of(p->camera, i, axis);
    vl_along3(eye, sign[i] * length, axis, end);
    line(p, VL_DRAWING_AXES, eye, end);
    label(p, VL_DRAWING_AXES, end, names[i]);
  }
}

/* The plane in focus, where the corners' rays meet it. */
static void draw_focus(Pen *p) {
  const vlCamera *c = p->camera;
  if (!(c->lens_radius > 0) || !(c->focus_distance < 1e30) || !p->flat)
    return;
  double q[4][3];
  for (int k = 0; k < 4; k++) {
    double x = k == 1 || k == 2 ? c->width : 0, y = k >= 2 ? c->height : 0, o[3], d[3], at[3];
    if (!vl_camera_unproject(c, x, y, o, d))
      return;
    vl_map_vector(c->camera_from_world, d, at);
    /* the plane in focus: f . x = 1 in camera space (compile.c) */
    double inv = 1 / c->focus_distance;
    double per = at[2] * inv + at[0] * (c->lens.tilt[0] * inv + c->lens.hinge[0]) +
                 at[1] * (c->lens.tilt[1] * inv + c->lens.hinge[1]);
    if (!(per > 1e-9))
      return;
    vl_along3(o, 1 / per, d, q[k]);
  }
  face(p, VL_DRAWING_FOCUS, q[0], q[1], q[2], q[3]);
  for (int k = 0; k < 4; k++)
    line(p, VL_DRAWING_FOCUS, q[k], q[(k + 1) % 4]);
  label(p, VL_DRAWING_FOCUS, q[1], "focus");
}

static void draw_projectors(Pen *p) {
  const vlDrawingDef *def = p->def;
  for (uint32_t i = 0; i < def->point_count; i++) {
    const double *point = def->points + 3 * i;
    double pixel[2], o[3], d[3], image[3], behind[3];
    char name[16];
    if (!vl_camera_project(p->camera, point, pixel, NULL))
      continue;
    if (!vl_camera_unproject(p->camera, pixel[0], pixel[1], o, d))
      continue;
    if (!at_depth(p, pixel[0], pixel[1], def->plane, image))
      continue;
    line(p, VL_DRAWING_PROJECTOR, point, o);
    line(p, VL_DRAWING_PROJECTOR, point, point);
    snprintf(name, sizeof name, def->point_count > 1 ? "P%u" : "P", i + 1);
    label(p, VL_DRAWING_PROJECTOR, point, name);
    snprintf(name, sizeof name, def->point_count > 1 ? "P%u'" : "P'", i + 1);
    if (wanted(p, VL_DRAWING_WINDOW)) {
      line(p, VL_DRAWING_PROJECTOR, image, image);
      label(p, VL_DRAWING_PROJECTOR, image, name);
    }
    if (!wanted(p, VL_DRAWING_FILM) || !at_depth(p, pixel[0], pixel[1], -def->plane, behind))
      continue;
    line(p, VL_DRAWING_PROJECTOR, o, behind);
    line(p, VL_DRAWING_PROJECTOR, behind, behind);
    if (!wanted(p, VL_DRAWING_WINDOW))
      label(p, VL_DRAWING_PROJECTOR, behind, name);
  }
}

static void draw_film(Pen *p) {
  double depth = -p->def->plane, at[3];
  if (!wanted(p, VL_DRAWING_FILM) || p->camera->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return;
  surface(p, VL_DRAWING_FILM, depth);
  border(p, VL_DRAWING_FILM, depth);
  grid(p, depth);
  edges(p, VL_DRAWING_FILM, depth);
  if (at_depth(p, 0, p->camera->height, depth, at))
    label(p, VL_DRAWING_FILM, at, "film");
}

static void draw_volume(Pen *p) {
  const vlCamera *c = p->camera;
  bool has_near = c->near_plane > 0, has_far = c->far_plane < 1e30;
  double end = has_far ? c->far_plane : p->def->reach, at[3];
  if (!has_far && (!p->flat || end < p->def->plane))
    end = p->def->plane;
  edges(p, VL_DRAWING_VOLUME, end);
  if (has_near) {
    surface(p, VL_DRAWING_NEAR, c->near_plane);
    border(p, VL_DRAWING_NEAR, c->near_plane);
    if (at_depth(p, 0, 0, c->near_plane, at))
      label(p, VL_DRAWING_NEAR, at, "near");
  }
  if (has_far) {
    surface(p, VL_DRAWING_FAR, end);
    if (at_depth(p, 0, 0, end, at))
      label(p, VL_DRAWING_FAR, at, "far");
  }
  if (end != p->def->plane)
    border(p, VL_DRAWING_FAR, end);
}

static void draw_whole(Pen *p) {
  const vlCamera *c = p->camera;
  double eye[3], centre[3], middle[3], plane = p->def->plane;
  eye_of(c, eye);
  draw_volume(p);
  surface(p, VL_DRAWING_WINDOW, plane);
  grid(p, plane);
  border(p, VL_DRAWING_WINDOW, plane);
  vl_along3(eye, plane, p->forward, centre);
  vl_along3(eye, 0.5 * plane, p->forward, middle);
  line(p, VL_DRAWING_DISTANCE, eye, centre);
  label(p, VL_DRAWING_DISTANCE, middle, "d");
  draw_film(p);
  draw_focus(p);
  draw_axes(p, 0.25 * fmax(plane, p->flat ? 0.7 * p->def->reach : plane));
  draw_projectors(p);
  draw_eye(p);
}

static void draw_small(Pen *p) {
  edges(p, VL_DRAWING_VOLUME, p->def->plane);
  surface(p, VL_DRAWING_WINDOW, p->def->plane);
  border(p, VL_DRAWING_WINDOW, p->def->plane);
  draw_eye(p);
}

/* ---- the call ---------------------------------------------------------------------------- */

vlDrawingDef vl_default_drawing_def(void) {
  return (vlDrawingDef){.cookie = VL_COOKIE_DRAWING,
                        .parts = ~(1u << VL_DRAWING_FILM),
                        .plane = 1,
                        .reach = 2,
                        .grid = 16};
}

static bool good(const vlDrawingDef *def) {
  bool numbers = def->plane > 0 && def->plane < 1e30 && def->reach > 0 && def->reach < 1e30;
  if (def->point_count && !def->points)
    return false;
  for (uint32_t i = 0; i < 3 * def->point_count; i++)
    numbers = numbers && isfinite(def->points[i]);
  return numbers;
}

static void extend(vlDrawing *d, const double point[3]) {
  for (int i = 0; i < 3; i++) {
    d->low[i] = fmin(d->low[i], point[i]);
    d->high[i] = fmax(d->high[i], point[i]);
  }
}

typedef struct Block {
  vlContext *context;
  vlDrawing head;
} Block;

void vl_drawing_destroy(vlDrawing *drawing) {
  if (!drawing)
    return;
  Block *block = (Block *)(void *)((char *)drawing - offsetof(Block, head));
  VL_FREE(block->context, vl_owned(drawing->lines), vl_owned(drawing->faces),
          vl_owned(drawing->labels), block);
}

/* Draws one camera as a whole, or several as small ones that a path joins. */
static void draw_cameras(Pen *p, const vlCamera *cameras, uint32_t count) {
  double eye[3], before[3];
  for (uint32_t i = 0; i < count; i++) {
    vlCamera still = cameras[i];
    still.moves = false; /* drawn when it opens */
    p->camera = &still;
    p->index = i;
    p->flat = still.projection == VL_PROJECTION_PERSPECTIVE ||
              still.projection == VL_PROJECTION_ORTHOGRAPHIC;
    axis_of(&still, 2, p->forward);
    if (count == 1) {
      draw_whole(p);
      return;
    }
    draw_small(p);
    eye_of(&still, eye);
    if (i)
      line(p, VL_DRAWING_PATH, before, eye);
    memcpy(before, eye, sizeof before);
  }
}

vlResult vl_camera_outline(vlContext *context, const vlCamera *cameras, uint32_t count,
                           const vlDrawingDef *def, vlDrawing **drawing, vlError *error) {
  vl_error_clear(error);
  if (drawing)
    *drawing = NULL;
  vlDrawingDef standard = vl_default_drawing_def();
  if (!def)
    def = &standard;
  if (!context || !cameras || !count || !drawing || def->cookie != VL_COOKIE_DRAWING ||
      !good(def))
    return vl_fail_argument(error,
                            "outline: no camera, or a number of the def that is not possible");
  Pen p = {.context = context, .def = def};
  draw_cameras(&p, cameras, count);
  Block *block = vl_alloc_zero(context, 1, sizeof *block);
  if (!block || p.failed) {
    VL_FREE(context, p.lines.items, p.faces.items, p.labels.items, block);
    return vl_fail_memory(error);
  }
  block->context = context;
  block->head = (vlDrawing){.lines = p.lines.items,
                            .faces = p.faces.items,
                            .labels = p.labels.items,
                            .line_count = (uint32_t)p.lines.count,
                            .face_count = (uint32_t)p.faces.count,
                            .label_count = (uint32_t)p.labels.count,
                            .low = {INFINITY, INFINITY, INFINITY},
                            .high = {-INFINITY, -INFINITY, -INFINITY}};
  vlDrawing *d = &block->head;
  for (uint32_t i = 0; i < d->line_count; i++) {
    extend(d, d->lines[i].from);
    extend(d, d->lines[i].to);
  }
  *drawing = d;
  return VL_OK;
}
