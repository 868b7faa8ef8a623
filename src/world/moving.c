/* world/moving.c: compiles motions of the scene into keys at equal time steps, and
 * evaluates positions between them. See moving.h. */
#include "world/moving.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "math/double3.h"
#include "math/motion.h"
#include "scene/scene.h"
#include "shape/surface_point.h"
#include "velo/shape.h"

/* ---- when -------------------------------------------------------------------------------- */

float vl_world_time(const vlWorld *world, double seconds) {
  if (!world->moves)
    return 0;
  double t = (seconds - world->time_open) / (world->time_close - world->time_open);
  return t > 0 ? (t < 1 ? (float)t : 1) : 0;
}

static void note_times(vlWorld *world, double from, double to) {
  world->time_open = !world->moves || from < world->time_open ? from : world->time_open;
  world->time_close = !world->moves || to > world->time_close ? to : world->time_close;
  world->moves = true;
}

static bool keys_differ(const vlSceneInstance *source) {
  for (uint32_t k = 1; k < source->keys; k++)
    if (memcmp(source->poses, source->poses + 16 * (size_t)k, 16 * sizeof *source->poses) != 0)
      return true;
  return false;
}

void vl_world_find_times(vlWorld *world, const vlScene *scene) {
  VL_EACH_ITEM(const vlSceneInstance, source, &scene->instances) {
    if (keys_differ(source))
      note_times(world, source->times[0], source->times[source->keys - 1]);
  }
  VL_EACH_ITEM(const vlShapeDef, def, &scene->shapes) {
    if (def->positions_close)
      note_times(world, def->times[0], def->times[1]);
  }
}

enum { MAX_STEPS = 128 }; /* Embree supports 129 keys */

uint32_t vl_world_time_steps(const vlWorld *world, double from, double to) {
  double span = world->time_close - world->time_open;
  for (uint32_t steps = 1; steps <= MAX_STEPS; steps++) {
    double a = (from - world->time_open) / span * steps,
           b = (to - world->time_open) / span * steps;
    /* tolerance, relative to a step, since times are given with a few decimals */
    const double same = 1e-6;
    if (fabs(a - round(a)) < same && fabs(b - round(b)) < same)
      return steps;
  }
  return 0;
}

/* ---- instances --------------------------------------------------------------------------- */

/* The exact motion in double precision: one segment between each pair of consecutive keys of
 * the scene. */
typedef struct Motion {
  const vlSceneInstance *source;
  vlMotion *between;
  /* the world's time 0 and the length of the world's time interval, in seconds */
  double open, span;
} Motion;

static vlAffine true_pose(const Motion *motion, double time) {
  const vlSceneInstance *source = motion->source;
  double seconds = motion->open + time * motion->span;
  uint32_t k = 0, last = source->keys - 2;
  for (uint32_t high = last; k < high;) { /* the last key at or before `seconds` */
    uint32_t middle = k + (high - k + 1) / 2;
    if (seconds >= source->times[middle])
      k = middle;
    else
      high = middle - 1;
  }
  double f = (seconds - source->times[k]) / (source->times[k + 1] - source->times[k]);
  return vl_motion_between(&motion->between[k], f > 0 ? (f < 1 ? f : 1) : 0);
}

/* Transforms the corners of the box by the pose `at` and by the linear interpolation of a and b
 * at f, and returns the largest squared distance between the two positions of a corner. */
static double corner_distance(const vlAffine *at, const vlAffine *a, const vlAffine *b,
                              double f, const float low[3], const float high[3]) {
  double m[9], t[3], max = 0;
  for (int i = 0; i < 9; i++)
    m[i] = at->m[i] - ((1 - f) * a->m[i] + f * b->m[i]);
  for (int i = 0; i < 3; i++)
    t[i] = at->p[i] - ((1 - f) * a->p[i] + f * b->p[i]);
  for (int c = 0; c < 8; c++) {
    double p[3] = {c & 1 ? low[0] : high[0], c & 2 ? low[1] : high[1],
                   c & 4 ? low[2] : high[2]},
           q[3];
    for (int i = 0; i < 3; i++)
      q[i] = m[3 * i] * p[0] + m[3 * i + 1] * p[1] + m[3 * i + 2] * p[2] + t[i];
    max = fmax(max, vl_dot3(q, q));
  }
  return max;
}

/* Largest deviation of a corner of the box from the exact motion, sampled at three times in
 * each step. */
static double strayed(const Motion *motion, uint32_t steps, const float low[3],
                      const float high[3]) {
  double max = 0;
  vlAffine ends[2];
  ends[1] = true_pose(motion, 0);
  for (uint32_t k = 0; k < steps; k++) {
    ends[0] = ends[1];
    ends[1] = true_pose(motion, (k + 1.0) / steps);
    for (int part = 1; part < 4; part++) {
      double f = part / 4.0;
      vlAffine at = true_pose(motion, (k + f) / steps);
      max = fmax(max, corner_distance(&at, &ends[0], &ends[1], f, low, high));
    }
  }
  return sqrt(max);
}

/* Allowed deviation, relative to the size of the moving object. A rotation by 180 degrees
 * between two keys of the scene, the largest possible one, deviates by 1e-4 of the radius at
 * 128 steps. Slower rotations meet this tolerance. */
static const double tolerance = 1e-5;

static uint32_t choose_steps(const Motion *motion, const float low[3], const float high[3]) {
  static const uint8_t tries[] = {1,  2,  3,  4,  5,  6,  8,  10, 12, 16,
                                  20, 24, 32, 40, 48, 64, 80, 96, 128};
  vlAffine start = true_pose(motion, 0);
  double size = 0;
  for (int i = 0; i < 3; i++) {
    double row = 0;
    for (int j = 0; j < 3; j++)
      row += fabs(start.m[3 * i + j]) * (high[j] - low[j]);
    size = fmax(size, row);
  }
  /* The deviation is proportional to 1 / steps^2, so numbers of steps that are too small can be
   * skipped. */
  double min = 1;
  for (size_t i = 0; i < sizeof tries; i++) {
    if (tries[i] < min && tries[i] < MAX_STEPS)
      continue;
    double far = strayed(motion, tries[i], low, high);
    if (far <= tolerance * size)
      return tries[i];
    if (i == 0 && motion->source->keys == 2 && size > 0)
      min = 0.7 * sqrt(far / (tolerance * size));
  }
  return MAX_STEPS;
}

/* The bound for an instance at rest, at the worst of the keys, and that of the interpolated
 * matrix: Embree and velo both compute a (1 - f) + b f, where f is the fractional part of time
 * * steps. The sum has three rounding errors, and f has the rounding error of time * steps. The
 * bound is doubled because both Embree and velo round. */
static void find_error(vlWorldInstance *q) {
  const float eps = 0x1p-24f;
  float steps = (float)(q->keys - 1), mixed[4] = {0, 0, 0, 0};
  memset(q->error, 0, sizeof q->error);
  for (uint32_t k = 0; k < q->keys; k++) {
    vlWorldInstance at;
    vl_instance_move(q, (float)k / steps, &at);
    vl_instance_error(at.from_group, at.to_group, q->error);
  }
  for (uint32_t k = 0; k + 1 < q->keys; k++) {
    const float *a = q->path + 12 * (size_t)k, *b = a + 12;
    for (int i = 0; i < 12; i++) {
      float size = fabsf(a[i]) + fabsf(b[i]),
            error = 2 * eps * (3 * size + 2 * steps * fabsf(b[i] - a[i]));
      mixed[i % 4] = error > mixed[i % 4] ? error : mixed[i % 4];
    }
  }
  for (int i = 0; i < 4; i++)
    q->error[i] += mixed[i];
}

static vlResult fill_path(const Motion *motion, float *path, uint32_t steps, vlError *error) {
  for (uint32_t k = 0; k <= steps; k++) {
    vlAffine at = true_pose(motion, (double)k / steps);
    for (int i = 0; i < 12; i++) {
      float x = (float)(i % 4 == 3 ? at.p[i / 4] : at.m[3 * (i / 4) + i % 4]);
      path[12 * (size_t)k + i] = x;
      const vlSource *source = &motion->source->source;
      if (!isfinite(x))
        return vl_fail_source(error, VL_ERROR_SCENE, *source,
                              "the instance's motion leaves the range of floats");
    }
  }
  return VL_OK;
}

vlResult vl_world_add_motion(vlWorld *world, const vlSceneInstance *source, const float low[3],
                             const float high[3], vlWorldInstance *q, vlError *error) {
  q->keys = 0;
  if (!keys_differ(source))
    return VL_OK;
  Motion motion = {source, vl_alloc_array(world->context, source->keys, sizeof(vlMotion)),
                   world->time_open, world->time_close - world->time_open};
  if (!motion.between)
    return vl_fail_memory(error);
  /* the scene has checked that a motion exists */
  for (uint32_t k = 0; k + 1 < source->keys; k++)
    vl_motion_make(source->poses + 16 * (size_t)k, source->poses + 16 * (size_t)(k + 1),
                   &motion.between[k]);
  uint32_t steps = choose_steps(&motion, low, high);
  float *path = vl_world_block(world, 12 * (size_t)(steps + 1), sizeof *path);
  vlResult r = path ? fill_path(&motion, path, steps, error) : vl_fail_memory(error);
  vl_free(world->context, motion.between);
  if (r != VL_OK)
    return r;
  q->keys = steps + 1;
  q->path = path;
  find_error(q);
  vlWorldInstance start;
  vl_instance_move(q, 0, &start);
  memcpy(q->from_group, start.from_group, sizeof q->from_group);
  memcpy(q->to_group, start.to_group, sizeof q->to_group);
  return VL_OK;
}

void vl_instance_move(const vlWorldInstance *q, float time, vlWorldInstance *moved) {
  vlTimeStep k = vl_time_step(time, q->keys);
  const float *a = q->path + 12 * (size_t)k.first, *b = a + 12;
  float *m = moved->from_group, *w = moved->to_group;
  moved->group = q->group;
  moved->mirrored = q->mirrored;
  moved->keys = 0;
  moved->path = NULL;
  memcpy(moved->error, q->error, sizeof moved->error);
  for (int i = 0; i < 12; i++)
    m[i] = a[i] * (1.0f - k.part) + b[i] * k.part;
  double x[3] = {m[0], m[4], m[8]}, y[3] = {m[1], m[5], m[9]}, z[3] = {m[2], m[6], m[10]},
         rows[3][3];
  vl_cross3(y, z, rows[0]);
  vl_cross3(z, x, rows[1]);
  vl_cross3(x, y, rows[2]);
  double volume = vl_dot3(x, rows[0]), inverse = volume != 0 ? 1 / volume : 0;
  for (int i = 0; i < 3; i++) {
    double move = 0;
    for (int j = 0; j < 3; j++) {
      double e = rows[i][j] * inverse;
      w[4 * i + j] = (float)e;
      move += e * m[4 * j + 3];
    }
    w[4 * i + 3] = (float)-move;
  }
}

/* ---- vertices ---------------------------------------------------------------------------- */

float vl_moving_vertex_error(const vlWorldShape *s, uint32_t vertex, float time) {
  vlTimeStep k = vl_time_step(time, s->steps);
  const float *a = s->positions + 3 * ((size_t)k.first * s->vertices + vertex),
              *b = a + 3 * (size_t)s->vertices;
  float worst = 0, steps = (float)(s->steps - 1);
  for (int i = 0; i < 3; i++) {
    float error =
        2 * 0x1p-24f * (3 * (fabsf(a[i]) + fabsf(b[i])) + 2 * steps * fabsf(b[i] - a[i]));
    worst = error > worst ? error : worst;
  }
  return worst;
}

/* ---- following a point ------------------------------------------------------------------- */

/* Applies the inverse of m in double precision; vlWorldInstance.to_group is rounded to
 * float. */
static void unmap(const float m[12], const double p[3], double q[3]) {
  double x[3], y[3], z[3], r[3], n[3];
  for (int i = 0; i < 3; i++) {
    x[i] = m[4 * i];
    y[i] = m[4 * i + 1];
    z[i] = m[4 * i + 2];
    r[i] = p[i] - (double)m[4 * i + 3];
  }
  vl_cross3(y, z, n);
  double volume = vl_dot3(x, n);
  q[0] = vl_dot3(r, n) / volume;
  vl_cross3(z, x, n);
  q[1] = vl_dot3(r, n) / volume;
  vl_cross3(x, y, n);
  q[2] = vl_dot3(r, n) / volume;
}

static void corners(const vlWorldShape *s, uint32_t prim, float time, double c[3][3]) {
  for (int k = 0; k < 3; k++) {
    float room[3];
    const float *x = vl_vertex_at(s, s->indices[3 * (size_t)prim + k], time, room);
    for (int i = 0; i < 3; i++)
      c[k][i] = x[i];
  }
}

/* The barycentric coordinates of a point of a triangle, or of the point of its plane below it.
 * False: the triangle has no area. */
static bool weights_in(const double c[3][3], const double p[3], double w[3]) {
  double a[3], b[3], r[3], n[3], x[3];
  vl_sub3(c[1], c[0], a);
  vl_sub3(c[2], c[0], b);
  vl_sub3(p, c[0], r);
  vl_cross3(a, b, n);
  double area = vl_dot3(n, n);
  if (!(area > 0))
    return false;
  vl_cross3(r, b, x);
  w[1] = vl_dot3(x, n) / area;
  vl_cross3(a, r, x);
  w[2] = vl_dot3(x, n) / area;
  w[0] = 1 - w[1] - w[2];
  return true;
}

/* Moves a point with a triangle: its barycentric coordinates stay the same. */
static void follow_triangle(const vlWorldShape *s, uint32_t prim, float from, float to,
                            double p[3]) {
  double c[3][3], w[3];
  corners(s, prim, from, c);
  if (!weights_in(c, p, w))
    return;
  corners(s, prim, to, c);
  for (int i = 0; i < 3; i++)
    p[i] = w[0] * c[0][i] + w[1] * c[1][i] + w[2] * c[2][i];
}

void vl_world_follow(const vlWorld *world, uint32_t shape, uint32_t prim, uint32_t instance,
                     double from_seconds, double to_seconds, const double point[3],
                     double moved[3]) {
  const vlWorldShape *s = &world->shapes.items[shape];
  const vlWorldInstance *q = instance == VL_NONE ? NULL : &world->instances.items[instance];
  float from = vl_world_time(world, from_seconds), to = vl_world_time(world, to_seconds);
  double p[3] = {point[0], point[1], point[2]}, g[3];
  memcpy(moved, p, sizeof p);
  bool flows = s->steps > 1, goes = q && q->keys;
  if (from == to || (!flows && !goes))
    return;
  vlWorldInstance room;
  memcpy(g, p, sizeof g);
  if (q)
    unmap(vl_instance_at(q, from, &room)->from_group, p, g);
  if (flows)
    follow_triangle(s, prim, from, to, g);
  memcpy(moved, g, sizeof g);
  if (q)
    vl_float_map_point(vl_instance_at(q, to, &room)->from_group, g, moved);
}

/* ---- velocities -------------------------------------------------------------------------- */

/* The velocity of a point of a triangle whose corners move, per unit of the world's time. */
static void triangle_velocity(const vlWorldShape *s, uint32_t prim, float time,
                              const double p[3], double v[3]) {
  double now[3][3], w[3];
  v[0] = v[1] = v[2] = 0;
  corners(s, prim, time, now);
  if (!weights_in(now, p, w))
    return;
  vlTimeStep step = vl_time_step(time, s->steps);
  for (int k = 0; k < 3; k++) {
    uint32_t vertex = s->indices[3 * (size_t)prim + (uint32_t)k];
    const float *a = s->positions + 3 * ((size_t)step.first * s->vertices + vertex),
                *b = a + 3 * (size_t)s->vertices;
    for (int i = 0; i < 3; i++)
      v[i] += w[k] * ((double)b[i] - (double)a[i]) * (s->steps - 1);
  }
}

/* The velocity of point g of the group in step k of an instance's path, per unit of the world's
 * time. */
static void step_velocity(const vlWorldInstance *q, int64_t k, const double g[3], double v[3]) {
  const float *a = q->path + 12 * k, *b = a + 12;
  double from[3], to[3];
  vl_float_map_point(a, g, from);
  vl_float_map_point(b, g, to);
  for (int i = 0; i < 3; i++)
    v[i] = (to[i] - from[i]) * (q->keys - 1);
}

/* The velocity at the key between two steps, as step `own` sees it: the mean of both, unless
 * the motion bends there: keys of a smooth motion are so dense that it turns by far less
 * (choose_steps). */
static void key_velocity(const double own[3], const double other[3], double v[3]) {
  const double smooth = 0.15;
  double change[3] = {own[0] - other[0], own[1] - other[1], own[2] - other[2]};
  double max = fmax(vl_dot3(own, own), vl_dot3(other, other));
  bool bends = vl_dot3(change, change) > smooth * smooth * max;
  for (int i = 0; i < 3; i++)
    v[i] = bends ? own[i] : 0.5 * (own[i] + other[i]);
}

static void instance_velocity(const vlWorldInstance *q, float time, const double g[3],
                              double v[3]) {
  vlTimeStep step = vl_time_step(time, q->keys);
  int64_t k = step.first, last = (int64_t)q->keys - 2;
  double own[3], other[3], begin[3], end[3];
  step_velocity(q, k, g, own);
  memcpy(begin, own, sizeof own);
  memcpy(end, own, sizeof own);
  if (k > 0) {
    step_velocity(q, k - 1, g, other);
    key_velocity(own, other, begin);
  }
  if (k < last) {
    step_velocity(q, k + 1, g, other);
    key_velocity(own, other, end);
  }
  /* At the ends of the path: as the middle of the step and the other key have it. */
  for (int i = 0; i < 3; i++) {
    if (k == 0 && k < last)
      begin[i] = 2 * own[i] - end[i];
    if (k == last && k > 0)
      end[i] = 2 * own[i] - begin[i];
    v[i] = (1 - (double)step.part) * begin[i] + (double)step.part * end[i];
  }
}

void vl_world_velocity(const vlWorld *world, uint32_t shape, uint32_t prim, uint32_t instance,
                       float time, const double point[3], double velocity[3]) {
  const vlWorldShape *s = &world->shapes.items[shape];
  const vlWorldInstance *q = instance == VL_NONE ? NULL : &world->instances.items[instance];
  double g[3] = {point[0], point[1], point[2]}, flow[3] = {0, 0, 0}, v[3] = {0, 0, 0};
  velocity[0] = velocity[1] = velocity[2] = 0;
  bool flows = s->steps > 1, goes = q && q->keys;
  if (!world->moves || (!flows && !goes))
    return;
  vlWorldInstance room;
  const vlWorldInstance *now = q ? vl_instance_at(q, time, &room) : NULL;
  if (now)
    unmap(now->from_group, point, g);
  if (flows)
    triangle_velocity(s, prim, time, g, flow);
  if (goes)
    instance_velocity(q, time, g, v);
  double turned[3];
  if (now)
    vl_float_map_vector(now->from_group, flow, turned);
  for (int i = 0; i < 3; i++)
    velocity[i] = (v[i] + (now ? turned[i] : flow[i])) / (world->time_close - world->time_open);
}
