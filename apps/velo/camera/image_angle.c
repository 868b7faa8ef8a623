/* camera/image_angle.c: the solid angle that an image sees. The film is cut into cells, and the
 * rays through a cell's corners span two triangles on the sphere, whose angles are known. */
#include <math.h>
#include <string.h>

#include "camera/camera.h"
#include "cli/vector.h"

/* Signed solid angle of the triangle between three unit vectors (Van Oosterom and Strackee
 * 1983). */
static double triangle(const double a[3], const double b[3], const double c[3]) {
  double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0]);
  return 2.0 * atan2(volume, 1.0 + vector_dot(a, b) + vector_dot(b, c) + vector_dot(c, a));
}

/* A rectangle of the film, and the rays through its corners: (x0, y0), (x1, y0), (x0, y1),
 * (x1, y1). */
typedef struct Cell {
  double x0, y0, x1, y1;
  const double *rays[4]; /* null: the corner has no ray */
} Cell;

/* Two triangles. False where a corner has no ray, or where rays lie far apart, as at a seam. */
static bool angle_by_corners(const Cell *cell, double *angle) {
  const double far_apart = 0.9;
  const double *const *r = cell->rays;
  if (!r[0] || !r[1] || !r[2] || !r[3])
    return false;
  if (vector_dot(r[0], r[1]) < far_apart || vector_dot(r[2], r[3]) < far_apart ||
      vector_dot(r[0], r[2]) < far_apart || vector_dot(r[1], r[3]) < far_apart)
    return false;
  *angle = fabs(triangle(r[0], r[1], r[2]) + triangle(r[1], r[3], r[2]));
  return true;
}

/* The last ray on the way from a film point that has one to another that has none. */
static void last_ray(const vlCamera *c, double x, double y, double to_x, double to_y,
                     double ray[3]) {
  double seen = 0.0, unseen = 1.0, origin[3], found[3];
  for (int step = 0; step < 12; step++) {
    double t = 0.5 * (seen + unseen);
    if (!vl_camera_unproject(c, x + t * (to_x - x), y + t * (to_y - y), origin, found)) {
      unseen = t;
      continue;
    }
    seen = t;
    memcpy(ray, found, sizeof found);
  }
}

/* Solid angle of a small cell that is not all seen, or that has a seam. */
static double edge_angle(const vlCamera *c, const Cell *cell) {
  double moved[4][3], angle;
  double x[2] = {cell->x0, cell->x1}, y[2] = {cell->y0, cell->y1};
  Cell inner = *cell;
  for (int k = 0; k < 4; k++)
    for (int other = 1; other < 4 && !inner.rays[k]; other++) {
      int m = k ^ other;
      if (!cell->rays[m])
        continue;
      memcpy(moved[k], cell->rays[m], sizeof moved[k]);
      last_ray(c, x[m % 2], y[m / 2], x[k % 2], y[k / 2], moved[k]);
      inner.rays[k] = moved[k];
    }
  if (angle_by_corners(&inner, &angle))
    return angle;
  return vl_camera_solid_angle(c, 0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])) * (x[1] - x[0]) *
         (y[1] - y[0]);
}

/* Solid angle of a cell. Cells at the end of the view and at seams are cut into quarters, at
 * most `cuts` times. */
static double cell_angle(const vlCamera *c, const Cell *cell, int cuts) {
  double angle, origin[3], rays[9][3];
  double x[3] = {cell->x0, 0.5 * (cell->x0 + cell->x1), cell->x1};
  double y[3] = {cell->y0, 0.5 * (cell->y0 + cell->y1), cell->y1};
  bool seen[9];
  if (!cell->rays[0] && !cell->rays[1] && !cell->rays[2] && !cell->rays[3])
    return 0.0;
  if (angle_by_corners(cell, &angle))
    return angle;
  if (!cuts)
    return edge_angle(c, cell);
  for (int i = 0; i < 9; i++)
    seen[i] = vl_camera_unproject(c, x[i % 3], y[i / 3], origin, rays[i]);
  double sum = 0.0;
  for (int j = 0; j < 2; j++)
    for (int i = 0; i < 2; i++) {
      Cell quarter = {.x0 = x[i], .y0 = y[j], .x1 = x[i + 1], .y1 = y[j + 1]};
      for (int k = 0; k < 4; k++) {
        int at = 3 * (j + k / 2) + i + k % 2;
        quarter.rays[k] = seen[at] ? rays[at] : NULL;
      }
      sum += cell_angle(c, &quarter, cuts - 1);
    }
  return sum;
}

enum { GRID = 256 };

/* The rays through the corners of a grid's cells along one horizontal line. */
typedef struct Line {
  double rays[GRID + 1][3];
  uint8_t valid[GRID + 1];
} Line;

static void cast_line(const vlCamera *c, double y, Line *line) {
  double pixels[2 * (GRID + 1)];
  for (int i = 0; i <= GRID; i++) {
    pixels[2 * i] = (double)i * c->width / GRID;
    pixels[2 * i + 1] = y;
  }
  vl_camera_unproject_batch(c, GRID + 1, pixels, NULL, line->rays[0], line->valid);
}

double camera_image_angle(const vlCamera *moving) {
  double w = moving->width, h = moving->height, sum = 0.0;
  vlCamera c;
  Line lines[2];
  if (moving->projection == VL_PROJECTION_ORTHOGRAPHIC ||
      vl_camera_at(moving, vl_camera_time(moving, 0.5 * w, 0.5 * h, 0.5), &c) != VL_OK)
    return 0.0;
  cast_line(&c, 0.0, &lines[0]);
  for (int j = 0; j < GRID; j++) {
    double y0 = j * h / GRID, y1 = (j + 1) * h / GRID;
    cast_line(&c, y1, &lines[(j + 1) % 2]);
    for (int i = 0; i < GRID; i++) {
      Cell cell = {.x0 = i * w / GRID, .y0 = y0, .x1 = (i + 1) * w / GRID, .y1 = y1};
      for (int k = 0; k < 4; k++) {
        const Line *line = &lines[(j + k / 2) % 2];
        cell.rays[k] = line->valid[i + k % 2] ? line->rays[i + k % 2] : NULL;
      }
      sum += cell_angle(&c, &cell, 3);
    }
  }
  return sum;
}
