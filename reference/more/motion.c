/* more/motion.c: what moves: instances and cameras (docs/cameras.md). A shape that moves is at rest in its own space.
 * So it is not the shape that is moved to the time of a ray, but the ray to the shape's first pose. */
#include "more.h"

/* A pose in three parts, applied from right to left: place, rotation, stretch. */
typedef struct pose {
  double time;
  vector place;
  matrix rotation, stretch;
} pose;

struct motion {
  uint32_t count;
  pose *poses;
  matrix rest_from_group; /* the inverse of the first pose */
};

static matrix transposed(matrix m) {
  return (matrix){{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}, {0, 0, 0}};
}

/* The sum of two matrices with weights. */
static matrix weighted(double wa, matrix a, double wb, matrix b) {
  return (matrix){add(scale(wa, a.x), scale(wb, b.x)), add(scale(wa, a.y), scale(wb, b.y)),
                  add(scale(wa, a.z), scale(wb, b.z)), add(scale(wa, a.origin), scale(wb, b.origin))};
}

/* Polar decomposition (Shoemake and Duff 1992): the mean of a matrix and its inverse transposed comes closer and closer
 * to the rotation that is nearest to the matrix. What remains is the stretch. A mirror stays in the rotation. */
static pose take_apart(const double m[16], double time) {
  matrix whole = load_matrix(m);
  pose p = {.time = time, .place = whole.origin};
  whole.origin = make_vector(0, 0, 0);
  p.rotation = whole;
  for (int i = 0; i < 60; i++) p.rotation = weighted(0.5, p.rotation, 0.5, transposed(invert(&p.rotation)));
  p.stretch = multiply(transposed(p.rotation), whole);
  return p;
}

/* A vector turned about an axis (Rodrigues). */
static vector turned(vector v, vector axis, double angle) {
  return blend(v, cross(axis, v), axis, cos(angle), sin(angle), dot(axis, v) * (1 - cos(angle)));
}

/* A part f of a rotation. Its matrix is cos I + (1 - cos) a a^T + sin [a]x for the axis a and its angle: what remains
 * of the symmetric part without I has the axis in each column. */
static matrix part_of(matrix r, double f) {
  double trace = r.x.x + r.y.y + r.z.z, angle = acos(clamp((trace - 1) / 2, -1, 1));
  matrix t = weighted(1, weighted(1, r, 1, transposed(r)), 1 - trace, IDENTITY);
  vector axis = t.x;
  if (length(t.y) > length(axis)) axis = t.y;
  if (length(t.z) > length(axis)) axis = t.z;
  axis = face_forward(normalize(axis), make_vector(r.y.z - r.z.y, r.z.x - r.x.z, r.x.y - r.y.x));
  angle *= f;
  return (matrix){
      turned(IDENTITY.x, axis, angle), turned(IDENTITY.y, axis, angle), turned(IDENTITY.z, axis, angle), {0, 0, 0}};
}

/* Places and stretches change linearly; the rotation from a to b goes the shortest way at constant speed (pbrt book,
 * third edition, 2.9.3). Before a and after b nothing moves. */
static matrix between(const pose *a, const pose *b, double time) {
  double f = clamp((time - a->time) / (b->time - a->time), 0, 1);
  matrix turn = part_of(multiply(transposed(a->rotation), b->rotation), f);
  matrix m = multiply(multiply(a->rotation, turn), weighted(1 - f, a->stretch, f, b->stretch));
  m.origin = add(scale(1 - f, a->place), scale(f, b->place));
  return m;
}

motion *make_motion(const vlInstanceInfo *info) {
  if (!info->moves) return NULL;
  motion *m = resize(NULL, 1, sizeof *m);
  matrix first = load_matrix(info->world_from_group);
  *m = (motion){info->keys, resize(NULL, info->keys, sizeof *m->poses), invert(&first)};
  for (uint32_t i = 0; i < m->count; i++) m->poses[i] = take_apart(info->poses + 16 * (size_t)i, info->times[i]);
  return m;
}

void times_of(const motion *m, double *first, double *last) {
  *first = m->poses[0].time;
  *last = m->poses[m->count - 1].time;
}

matrix world_from_rest(const motion *m, double time) {
  uint32_t i = 0;
  while (i + 2 < m->count && time > m->poses[i + 1].time) i++;
  return multiply(between(&m->poses[i], &m->poses[i + 1], time), m->rest_from_group);
}

/* t stays the same: the direction is not made a unit vector again. */
ray seen_at_rest(const placement *where, ray r) {
  if (!where->moves) return r;
  matrix moved = world_from_rest(where->moves, r.time), back = invert(&moved);
  r.origin = transform_point(&back, r.origin);
  r.direction = transform_vector(&back, r.direction);
  return r;
}

void carry_along(shade_record *record) {
  if (!record->where->moves) return;
  matrix moved = world_from_rest(record->where->moves, record->time), back = invert(&moved);
  record->point = transform_point(&moved, record->point);
  record->tangent = transform_vector(&moved, record->tangent);
  record->normal = normalize(transform_normal(&back, record->normal));
  record->shading_normal = normalize(transform_normal(&back, record->shading_normal));
  record->thickness *= cbrt(determinant(&moved));
}

frame camera_pose(const vlCamera *c, double time) {
  if (!c->moves) return load_matrix(c->world_from_camera);
  pose first = take_apart(c->world_from_camera, c->pose_times[0]);
  pose last = take_apart(c->world_from_camera_close, c->pose_times[1]);
  return between(&first, &last, time);
}

/* How far the shutter is open at a share of its time: linear between the points of its curve, 0 outside. */
static double opening(const vlCamera *c, double share) {
  const double *at = c->shutter_at, *value = c->shutter_value;
  for (uint32_t i = 0; i + 1 < c->shutter_points; i++) {
    if (share < at[i] || share >= at[i + 1]) continue;
    return value[i] + (share - at[i]) / (at[i + 1] - at[i]) * (value[i + 1] - value[i]);
  }
  return c->shutter_points == 0 ? 1 : 0;
}

/* A rolling shutter opens later for each row, or column, in the order in which they are read. The share of the time is
 * drawn under the shutter's curve, as points under that of a filter (film.c). */
double sample_time(const vlCamera *c, uint32_t column, uint32_t row, sampler *s) {
  double share, most = c->shutter_points == 0 ? 1 : 0;
  for (uint32_t i = 0; i < c->shutter_points; i++) most = fmax(most, c->shutter_value[i]);
  do share = next_number(s);
  while (next_number(s) * most >= opening(c, share));
  bool columns = c->readout_direction == VL_READOUT_RIGHT || c->readout_direction == VL_READOUT_LEFT;
  double at = columns ? column : row, count = columns ? c->width : c->height;
  if (c->readout_direction == VL_READOUT_UP || c->readout_direction == VL_READOUT_LEFT) at = count - 1 - at;
  return c->shutter_open + at / count * c->readout + share * (c->shutter_close - c->shutter_open);
}
