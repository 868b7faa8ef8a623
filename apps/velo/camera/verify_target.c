/* camera/verify_target.c: a chessboard, with or without markers in its white squares, and its
 * placement in front of the camera. White squares are emissive geometry, so no texture filter
 * affects the image; black squares are empty. */
#include <math.h>
#include <stdlib.h>

#include "camera/verify.h"
#include "cli/vector.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"

/* A marker fills the middle 6 x 6 of a white square's 10 x 10 cells: a black frame around 4 x 4
 * bits. */
enum { CELLS = 10, FRAME = 2, BITS = 4, MAX_QUADS = 8192 };

double random_unit(Random *random) { /* splitmix64 */
  uint64_t z = (random->state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* ---- markers ----------------------------------------------------------------------------- */

/* A marker's code after a quarter turn; bit BITS * y + x is cell (x, y). */
static unsigned quarter_turn(unsigned code) {
  unsigned turned = 0;
  for (int y = 0; y < BITS; y++)
    for (int x = 0; x < BITS; x++)
      if (code >> (BITS * y + x) & 1u)
        turned |= 1u << (BITS * x + BITS - 1 - y);
  return turned;
}

static int differing_bits(unsigned a, unsigned b) {
  int count = 0;
  for (unsigned d = a ^ b; d; d &= d - 1)
    count++;
  return count;
}

/* Marker k: the k-th of a fixed sequence of codes. Each differs in at least four bits from all
 * earlier ones and from itself, in every rotation. */
static unsigned marker_code(int index) {
  unsigned codes[MAX_TARGET_SIDE * MAX_TARGET_SIDE], candidate = 0;
  Random random = {2026};
  for (int count = 0; count <= index;) {
    candidate = (unsigned)(random_unit(&random) * 65536.0);
    bool apart = true;
    unsigned turned = candidate;
    for (int turn = 0; turn < 4; turn++) {
      if (turn > 0 && differing_bits(turned, candidate) < 4)
        apart = false;
      for (int k = 0; k < count; k++)
        if (differing_bits(turned, codes[k]) < 4)
          apart = false;
      turned = quarter_turn(turned);
    }
    if (apart)
      codes[count++] = candidate;
  }
  return candidate;
}

static bool is_white(int i, int j) {
  return (i + j) % 2 == 1;
}

/* Returns the number of the white square (i, j), counted by rows. */
static int marker_of(const Target *target, int i, int j) {
  return (j * (target->corners + 1) + i) / 2;
}

static bool cell_is_white(unsigned code, int x, int y) {
  if (x < FRAME || y < FRAME || x >= CELLS - FRAME || y >= CELLS - FRAME)
    return true;
  x -= FRAME + 1;
  y -= FRAME + 1;
  return x >= 0 && y >= 0 && x < BITS && y < BITS && (code >> (BITS * y + x) & 1u);
}

/* The value at film point (x, y), linear between the centres of pixels. */
static double sample(const Image *p, double x, double y) {
  double fx = fmin(fmax(x - 0.5, 0.0), p->width - 1.001),
         fy = fmin(fmax(y - 0.5, 0.0), p->height - 1.001);
  int i = (int)fx, j = (int)fy;
  const float *at = p->pixels + (size_t)j * (size_t)p->width + i;
  fx -= i;
  fy -= j;
  return (1 - fy) * ((1 - fx) * (double)at[0] + fx * (double)at[1]) +
         fy * ((1 - fx) * (double)at[p->width] + fx * (double)at[p->width + 1]);
}

int target_read_marker(const Target *target, int i, int j, const Image *image, double c[4][2]) {
  if (!target->charuco || !is_white(i, j))
    return -1;
  for (int k = 0; k < 4; k++) { /* cells smaller than 2.4 pixels cannot be read */
    static const int round[5] = {0, 1, 3, 2, 0};
    const double *a = c[round[k]], *b = c[round[k + 1]];
    if (hypot(a[0] - b[0], a[1] - b[1]) < 2.4 * CELLS)
      return -1;
  }
  double values[BITS * BITS] = {0.0}, black = 0.0, white = 0.0;
  for (int pass = 0; pass < CELLS * CELLS; pass++) {
    int x = pass % CELLS, y = pass / CELLS;
    double u = (x + 0.5) / CELLS, v = (y + 0.5) / CELLS, at[2];
    for (int a = 0; a < 2; a++)
      at[a] =
          (1 - v) * ((1 - u) * c[0][a] + u * c[1][a]) + v * ((1 - u) * c[2][a] + u * c[3][a]);
    double value = sample(image, at[0], at[1]);
    int bx = x - FRAME - 1, by = y - FRAME - 1;
    bool inside = bx >= 0 && by >= 0 && bx < BITS && by < BITS;
    bool frame = !inside && bx >= -1 && by >= -1 && bx <= BITS && by <= BITS;
    if (inside)
      values[BITS * by + bx] = value;
    if (frame)
      black += value / (4.0 * BITS + 4.0);
    /* the corners of the white border, one cell from the square's edge */
    if ((x == 1 || x == CELLS - 2) && (y == 1 || y == CELLS - 2))
      white += 0.25 * value;
  }
  unsigned code = 0;
  for (int k = 0; k < BITS * BITS; k++)
    if (values[k] > 0.5 * (black + white))
      code |= 1u << k;
  return code == marker_code(marker_of(target, i, j));
}

/* ---- size and pose ----------------------------------------------------------------------- */

double target_choose(Target *target, const vlCamera *camera) {
  double side = sqrt((double)camera->width * camera->height) / (target->charuco ? 16.0 : 20.0);
  side = fmin(fmax(side, target->charuco ? 28.0 : 16.0), target->charuco ? 72.0 : 48.0);
  double max = 0.7 * fmin(camera->width, camera->height) / side - 1.0;
  target->corners = max > 7.0 ? (target->charuco ? 5 : 7) : max > 5.0 ? 5 : 3;
  return side;
}

/* The world point at a distance along the ray of film point (x, y). */
static bool point_at(const vlCamera *c, double x, double y, double distance, double p[3],
                     double direction[3]) {
  double origin[3];
  if (!vl_camera_unproject(c, x, y, origin, direction))
    return false;
  vector_along(origin, distance, direction, p);
  return true;
}

/* The axes of a pixel around film point (x, y) at a distance: u to the right, v down, and
 * the direction of its ray. center: the point itself. */
static bool pixel_axes(const vlCamera *camera, double x, double y, double distance,
                       double center[3], double direction[3], double u[3], double v[3]) {
  double other[3], left[3], right[3], above[3], below[3];
  if (!point_at(camera, x, y, distance, center, direction) ||
      !point_at(camera, x - 0.5, y, distance, left, other) ||
      !point_at(camera, x + 0.5, y, distance, right, other) ||
      !point_at(camera, x, y - 0.5, distance, above, other) ||
      !point_at(camera, x, y + 0.5, distance, below, other))
    return false;
  vector_subtract(right, left, u);
  vector_subtract(below, above, v);
  return true;
}

/* Makes u orthogonal to the direction (unit) and of length 1. False: it is parallel to it. */
static bool make_orthogonal(const double direction[3], double u[3]) {
  vector_along(u, -vector_dot(u, direction), direction, u);
  return vector_normalize(u);
}

bool target_place(const Target *target, const vlCamera *camera, double x, double y, double side,
                  Random *random, Placement *placement) {
  const double *m = camera->world_from_camera;
  const double eye[3] = {m[3], m[7], m[11]};
  /* comparable to the distance of the world's origin, to preserve precision */
  const double distance = fmax(1.0, vector_length(eye)) * (1.0 + random_unit(random));
  const double turn = 2.0 * M_PI * random_unit(random);
  const double tilt = 0.6 * random_unit(random);
  const double lean = 2.0 * M_PI * random_unit(random); /* about which axis it is tilted */
  double direction[3], u[3], v[3], normal[3];
  if (!pixel_axes(camera, x, y, distance, placement->center, direction, u, v))
    return false;
  vector_cross(u, v, normal);
  const double area = vector_length(normal); /* of a pixel at this distance */
  double size = side * sqrt(area);
  /* a flat board cannot fill a hemisphere */
  const double widest = 1.1 * distance / (target->corners + 1);
  if (camera->projection != VL_PROJECTION_ORTHOGRAPHIC && size > widest)
    size = widest;
  if (!(area > 0.0) || !isfinite(size) || !make_orthogonal(direction, u))
    return false;
  vector_cross(direction, u, v);
  const double c = cos(turn), s = sin(turn);
  for (int a = 0; a < 3; a++) {
    /* axes of the tilt: e stays; f is foreshortened and tilts away from the camera */
    double e = cos(lean) * u[a] + sin(lean) * v[a], f = -sin(lean) * u[a] + cos(lean) * v[a];
    double g = cos(tilt) * f + sin(tilt) * direction[a];
    placement->x[a] = size * (c * e + s * g);
    placement->y[a] = size * (-s * e + c * g);
  }
  return true;
}

void target_point(const Target *target, const Placement *placement, double i, double j,
                  double point[3]) {
  double middle = 0.5 * (target->corners + 1);
  for (int a = 0; a < 3; a++)
    point[a] = (double)(float)(placement->center[a] + (i - middle) * placement->x[a] +
                               (j - middle) * placement->y[a]);
}

/* ---- geometry ---------------------------------------------------------------------------- */

typedef struct Quads {
  const Target *target;
  const Placement *placement;
  uint32_t count;
  float positions[12 * MAX_QUADS];
  uint32_t indices[6 * MAX_QUADS];
} Quads;

static void add_quad(Quads *q, double i0, double j0, double i1, double j1) {
  if (q->count == MAX_QUADS)
    return;
  const double corners[4][2] = {{i0, j0}, {i1, j0}, {i1, j1}, {i0, j1}};
  static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
  for (int k = 0; k < 4; k++) {
    double p[3];
    target_point(q->target, q->placement, corners[k][0], corners[k][1], p);
    for (int a = 0; a < 3; a++)
      q->positions[12 * q->count + 3 * (uint32_t)k + (uint32_t)a] = (float)p[a];
  }
  for (uint32_t k = 0; k < 6; k++)
    q->indices[6 * q->count + k] = 4 * q->count + order[k];
  q->count++;
}

static void add_marker(Quads *q, int i, int j) {
  unsigned code = marker_code(marker_of(q->target, i, j));
  for (int y = 0; y < CELLS; y++)
    for (int x = 0; x < CELLS; x++) {
      int end = x;
      while (end < CELLS && cell_is_white(code, end, y))
        end++;
      if (end > x)
        add_quad(q, i + x / (double)CELLS, j + y / (double)CELLS, i + end / (double)CELLS,
                 j + (y + 1) / (double)CELLS);
      x = end > x ? end - 1 : x;
    }
}

static void add_board(Quads *q) {
  int n = q->target->corners + 1;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      if (!is_white(i, j))
        continue;
      if (q->target->charuco)
        add_marker(q, i, j);
      else
        add_quad(q, i, j, i + 1, j + 1);
    }
  add_quad(q, -1, -1, n + 1, 0);
  add_quad(q, -1, n, n + 1, n + 1);
  add_quad(q, -1, 0, 0, n);
  add_quad(q, n, 0, n + 1, n);
}

vlResult target_build(vlContext *context, const Target *target, const Placement *placement,
                      vlWorld **world, vlError *error) {
  vlScene *scene = NULL;
  Quads *quads = calloc(1, sizeof *quads);
  *world = NULL;
  vlResult result = quads ? vl_scene_create(context, &scene) : VL_ERROR_MEMORY;
  if (result == VL_OK) {
    quads->target = target;
    quads->placement = placement;
    add_board(quads);
    vlEmissionDef emission = vl_default_emission_def();
    emission.radiance = vl_spectrum_rgb(1, 1, 1);
    emission.two_sided = true;
    vlShapeDef shape = vl_default_shape_def(VL_SHAPE_TRIANGLES);
    shape.vertices = 4 * quads->count;
    shape.faces = 2 * quads->count;
    shape.positions = quads->positions;
    shape.indices = quads->indices;
    shape.emission = vl_scene_add_emission(scene, &emission);
    vl_scene_add_shape(scene, &shape);
    result = vl_scene_result(scene, error);
  }
  if (result == VL_OK) {
    vlBuildDef build = vl_default_build_def();
    build.color = VL_COLOR_RGB;
    build.light_sampler = VL_LIGHT_SAMPLER_UNIFORM;
    result = vl_world_build(scene, &build, world, error);
  }
  vl_scene_destroy(scene);
  free(quads);
  return result;
}
