/* camera/draw_paint.c: draws a camera's outline over the view from outside. A piece of a line
 * that lies behind the scene is faint and dashed. */
#include <math.h>
#include <string.h>

#include "camera/draw.h"
#include "cli/macros.h"
#include "cli/vector.h"

/* How a part is drawn: width in units of the pen, opacity of its faces. */
typedef struct Style {
  uint8_t color[3];
  double width, opacity, fill, dot;
  bool dashed;
} Style;

static const Style styles[] = {
    [VL_DRAWING_EYE] = {{20, 20, 20}, 1.0, 1, 0, 4.5, false},
    [VL_DRAWING_WINDOW] = {{20, 70, 170}, 1.5, 1, 0.16, 0, false},
    [VL_DRAWING_GRID] = {{20, 70, 170}, 0.5, 0.38, 0, 0, false},
    [VL_DRAWING_VOLUME] = {{70, 70, 70}, 0.9, 0.9, 0, 0, false},
    [VL_DRAWING_NEAR] = {{10, 120, 60}, 1.2, 1, 0.14, 0, false},
    [VL_DRAWING_FAR] = {{90, 90, 90}, 0.9, 0.9, 0.06, 0, false},
    [VL_DRAWING_AXES] = {{200, 30, 30}, 1.5, 1, 0, 0, false},
    [VL_DRAWING_DISTANCE] = {{90, 90, 90}, 0.8, 0.9, 0, 0, true},
    [VL_DRAWING_FOCUS] = {{160, 40, 150}, 1.2, 1, 0.12, 0, false},
    [VL_DRAWING_PROJECTOR] = {{225, 95, 0}, 1.2, 1, 0, 3.6, false},
    [VL_DRAWING_FILM] = {{130, 80, 20}, 1.1, 1, 0.16, 0, false},
    [VL_DRAWING_PATH] = {{225, 95, 0}, 1.3, 1, 0, 0, false},
};

typedef struct Canvas {
  Overlay *overlay;
  const Outside *outside;
  double pen;          /* width of a line of width 1, pixels */
  const double *plane; /* of the face that is painted: four corners */
} Canvas;

/* Depth of the scene at a point of the image. */
static double scene_depth(const Outside *o, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < o->camera.width && y < o->camera.height))
    return INFINITY;
  return (double)o->depth[(size_t)y * o->camera.width + (size_t)x];
}

static bool in_front(const Outside *o, const double pixel[2], double z) {
  return z <= 1.004 * scene_depth(o, pixel[0], pixel[1]);
}

/* ---- lines ------------------------------------------------------------------------------- */

/* Which pieces of lines are drawn. */
typedef enum Pieces { SEEN, HIDDEN } Pieces;

static void draw_line(const Canvas *c, const vlDrawingLine *l, Pieces pieces, double width,
                      bool dashed) {
  enum { MAX_STEPS = 4096 };
  const vlCamera *camera = &c->outside->camera;
  double a[2], b[2];
  if (!vl_camera_project(camera, l->from, a, NULL) ||
      !vl_camera_project(camera, l->to, b, NULL))
    return;
  double length = hypot(b[0] - a[0], b[1] - a[1]), dash = 5 * c->pen;
  int steps = (int)fmin(MAX_STEPS, ceil(length / 1.5)) + 1;
  double last[2] = {a[0], a[1]}, way[3];
  vector_subtract(l->to, l->from, way);
  for (int i = 1; i <= steps; i++) {
    double point[3], middle[3], p[2], q[2], z;
    vector_along(l->from, (double)i / steps, way, point);
    vector_along(l->from, (i - 0.5) / steps, way, middle);
    if (!vl_camera_project(camera, point, p, NULL) || !vl_camera_project(camera, middle, q, &z))
      return;
    bool seen = in_front(c->outside, q, z);
    bool gap = dashed && fmod(hypot(q[0] - a[0], q[1] - a[1]), 2 * dash) > dash;
    if (seen == (pieces == SEEN) && !gap)
      overlay_line(c->overlay, last[0], last[1], p[0], p[1], width);
    last[0] = p[0];
    last[1] = p[1];
  }
}

static bool is_dot(const vlDrawingLine *l) {
  return l->from[0] == l->to[0] && l->from[1] == l->to[1] && l->from[2] == l->to[2];
}

static void draw_lines(const Canvas *c, const vlDrawing *d, vlDrawingPart part, Pieces pieces) {
  const Style *s = &styles[part];
  for (uint32_t i = 0; i < d->line_count; i++) {
    const vlDrawingLine *l = &d->lines[i];
    if (l->part != part || is_dot(l))
      continue;
    draw_line(c, l, pieces, (pieces == SEEN ? 1.0 : 0.75) * s->width * c->pen,
              s->dashed || pieces == HIDDEN);
  }
  overlay_paint(c->overlay, s->color, pieces == SEEN ? s->opacity : 0.5 * s->opacity);
}

static void draw_dots(const Canvas *c, const vlDrawing *d, vlDrawingPart part) {
  static const uint8_t white[3] = {255, 255, 255};
  for (int halo = 1; halo >= 0; halo--) {
    for (uint32_t i = 0; i < d->line_count; i++) {
      const vlDrawingLine *l = &d->lines[i];
      double p[2];
      if (l->part != part || !is_dot(l) ||
          !vl_camera_project(&c->outside->camera, l->from, p, NULL))
        continue;
      overlay_line(c->overlay, p[0], p[1], p[0], p[1],
                   (styles[part].dot + 1.6 * halo) * c->pen);
    }
    overlay_paint(c->overlay, halo ? white : styles[part].color, halo ? 0.9 : 1);
  }
}

/* ---- faces ------------------------------------------------------------------------------- */

/* The point of the face's plane that is seen at a pixel of the drawing. */
static bool face_point(const Canvas *c, double x, double y, double point[3]) {
  const double *q = c->plane;
  double o[3], d[3], n[3], u[3], v[3];
  vector_subtract(q + 6, q, u);
  vector_subtract(q + 9, q + 3, v);
  vector_cross(u, v, n);
  if (!vl_camera_unproject(&c->outside->camera, x, y, o, d))
    return false;
  const double along = vector_dot(n, d);
  if (along == 0)
    return false;
  vector_subtract(q, o, u);
  vector_along(o, vector_dot(n, u) / along, d, point);
  return true;
}

/* Whether the face's plane is in front of the scene at a pixel. */
static bool face_seen(void *user, double x, double y) {
  const Canvas *c = user;
  double point[3], pixel[2], z;
  return face_point(c, x, y, point) &&
         vl_camera_project(&c->outside->camera, point, pixel, &z) &&
         in_front(c->outside, pixel, z);
}

/* Shows the camera's image where the face covers the drawing, and clears the coverage. */
static void paint_image(const Canvas *c, const double q[4][2], bool behind) {
  const float opacity = 0.85F;
  const vlCamera *inside = &c->outside->inside;
  Overlay *o = c->overlay;
  double low[2], high[2];
  overlay_bounds(q, low, high);
  for (long y = (long)fmax(0, low[1] - 1); y < (long)fmin(o->height, high[1] + 1); y++)
    for (long x = (long)fmax(0, low[0] - 1); x < (long)fmin(o->width, high[0] + 1); x++) {
      size_t at = (size_t)y * o->width + (size_t)x;
      double point[3], p[2];
      float cover = o->coverage[at];
      o->coverage[at] = 0.0F;
      if (!(cover > 0.0F) || !face_point(c, (double)x + 0.5, (double)y + 0.5, point))
        continue;
      for (int k = 0; behind && k < 3; k++)
        point[k] = 2 * inside->world_from_camera[4 * k + 3] - point[k];
      if (!vl_camera_project(inside, point, p, NULL))
        continue;
      uint32_t px = (uint32_t)fmax(0, fmin(inside->width - 1.0, p[0]));
      uint32_t py = (uint32_t)fmax(0, fmin(inside->height - 1.0, p[1]));
      for (uint32_t k = 0; k < 3; k++) {
        float v = (float)vl_image_get(c->outside->inside_image, px, py, k);
        o->rgb[3 * at + k] += opacity * cover * (v - o->rgb[3 * at + k]);
      }
    }
}

static void draw_faces(Canvas *c, const vlDrawing *d, vlDrawingPart part) {
  const Style *s = &styles[part];
  for (uint32_t i = 0; i < d->face_count; i++) {
    double q[4][2];
    bool valid = d->faces[i].part == part;
    for (int k = 0; valid && k < 4; k++)
      valid = vl_camera_project(&c->outside->camera, d->faces[i].corners[k], q[k], NULL);
    if (!valid)
      continue;
    c->plane = &d->faces[i].corners[0][0];
    overlay_quad(c->overlay, (const double(*)[2])q, face_seen, c);
    bool shows = part == VL_DRAWING_WINDOW || part == VL_DRAWING_FILM;
    if (shows && c->outside->inside_image)
      paint_image(c, (const double(*)[2])q, part == VL_DRAWING_FILM);
  }
  overlay_paint(c->overlay, s->color, s->fill);
}

/* ---- labels ------------------------------------------------------------------------------ */

static bool is_image(const vlDrawingLabel *l) {
  return strchr(l->text, '\'') != NULL;
}

/* The mean height of the points, or of their images: labels of the lower ones stand below, so
 * that they are apart. */
static double middle_of(const Canvas *c, const vlDrawing *d, const vlDrawingLabel *of) {
  double sum = 0, p[2];
  int count = 0;
  for (uint32_t i = 0; i < d->label_count; i++) {
    const vlDrawingLabel *l = &d->labels[i];
    if (l->part != of->part || is_image(l) != is_image(of))
      continue;
    if (vl_camera_project(&c->outside->camera, l->at, p, NULL)) {
      sum += p[1];
      count++;
    }
  }
  return count ? sum / count + 0.5 : 0;
}

/* A label stands beside its point, away from the eye of its camera. */
static void draw_label(const Canvas *c, const vlDrawing *d, const vlDrawingLabel *l,
                       double width) {
  double p[2], size = 10.5 * c->pen, away[2] = {0, -1}, eye[2];
  if (!vl_camera_project(&c->outside->camera, l->at, p, NULL))
    return;
  for (uint32_t i = 0; i < d->line_count; i++) { /* the eye's dot */
    const vlDrawingLine *e = &d->lines[i];
    if (e->part != VL_DRAWING_EYE || e->camera != l->camera || !is_dot(e))
      continue;
    if (l->part == VL_DRAWING_AXES &&
        vl_camera_project(&c->outside->camera, e->from, eye, NULL)) {
      double length = hypot(p[0] - eye[0], p[1] - eye[1]);
      if (length > 0) {
        away[0] = (p[0] - eye[0]) / length;
        away[1] = (p[1] - eye[1]) / length;
      }
    }
    break;
  }
  if (l->part == VL_DRAWING_EYE) {
    away[0] = -0.5;
    away[1] = 0.9;
  }
  if (l->part == VL_DRAWING_DISTANCE) {
    away[0] = 0;
    away[1] = 1.5;
  }
  if (l->part == VL_DRAWING_PROJECTOR && p[1] > middle_of(c, d, l))
    away[1] = 1.5;
  double text = overlay_text_width(l->text, size), gap = size;
  double x = p[0] + away[0] * (gap + 0.5 * text) - 0.5 * text,
         y = p[1] + away[1] * 1.1 * gap + 0.4 * size;
  x = fmax(2, fmin(c->overlay->width - text - 2, x));
  y = fmax(size + 2, fmin(c->overlay->height - 4.0, y));
  overlay_text(c->overlay, l->text, x, y, size, width);
}

static void draw_labels(const Canvas *c, const vlDrawing *d, vlDrawingPart part) {
  static const uint8_t white[3] = {255, 255, 255};
  for (int halo = 1; halo >= 0; halo--) {
    for (uint32_t i = 0; i < d->label_count; i++)
      if (d->labels[i].part == part)
        draw_label(c, d, &d->labels[i], (halo ? 4.4 : 1.5) * c->pen);
    overlay_paint(c->overlay, halo ? white : styles[part].color, halo ? 0.8 : 1);
  }
}

/* ---- the order -------------------------------------------------------------------------- */

void draw_paint(Overlay *overlay, const Outside *outside, const vlDrawing *drawing) {
  static const vlDrawingPart order[] = {
      VL_DRAWING_FAR,    VL_DRAWING_FOCUS, VL_DRAWING_FILM,      VL_DRAWING_NEAR,
      VL_DRAWING_WINDOW, VL_DRAWING_GRID,  VL_DRAWING_VOLUME,    VL_DRAWING_DISTANCE,
      VL_DRAWING_PATH,   VL_DRAWING_AXES,  VL_DRAWING_PROJECTOR, VL_DRAWING_EYE};
  enum { PARTS = LENGTH(order) };
  Canvas c = {.overlay = overlay,
              .outside = outside,
              .pen = fmax(1.0, 0.0011 * (overlay->width + overlay->height))};
  for (int i = 0; i < PARTS; i++)
    draw_faces(&c, drawing, order[i]);
  for (int i = 0; i < PARTS; i++)
    draw_lines(&c, drawing, order[i], HIDDEN);
  for (int i = 0; i < PARTS; i++)
    draw_lines(&c, drawing, order[i], SEEN);
  for (int i = 0; i < PARTS; i++)
    draw_dots(&c, drawing, order[i]);
  for (int i = 0; i < PARTS; i++)
    draw_labels(&c, drawing, order[i]);
}
