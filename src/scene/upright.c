/* scene/upright.c: see upright.h. The measure of an end of the model along an axis is the area
 * of the convex hull of what lies in the outermost fiftieth there, divided by that of the whole
 * model, both seen along the axis. */
#include "scene/upright.h"

#include <math.h>

#include "math/elementary.h"
#include "scene/faces.h"
#include "scene/facing.h"
#include "scene/posture.h"

enum { DIRECTIONS = 24, LOW = 0, HIGH = 1, WHOLE = 2 };

/* The support of a set of points in a plane: the largest coordinate in each direction. */
typedef struct Hull {
  double max[DIRECTIONS];
} Hull;

typedef struct Ends {
  vlExtent box;
  double cosine[DIRECTIONS], sine[DIRECTIONS];
  Hull hulls[3][3]; /* of each axis: low end, high end, the whole */
  double arms[3];   /* where along each axis the ends of x are, as a sum; of x: their number */
} Ends;

static void grow(const Ends *e, Hull *hull, double x, double y) {
  for (int k = 0; k < DIRECTIONS; k++)
    hull->max[k] = fmax(hull->max[k], x * e->cosine[k] + y * e->sine[k]);
}

/* The model's ends to the left and right: hands, wings. */
static void add_arm(Ends *e, const double p[3]) {
  double at[3];
  for (int i = 0; i < 3; i++)
    at[i] = (p[i] - e->box.low[i]) / vl_extent_size(&e->box, i);
  if (at[0] > 0.02 && at[0] < 0.98)
    return;
  e->arms[0]++;
  e->arms[1] += at[1];
  e->arms[2] += at[2];
}

static void visit(void *user, const double p[3]) {
  Ends *e = user;
  add_arm(e, p);
  for (int axis = 0; axis < 3; axis++) {
    const double low = e->box.low[axis], size = e->box.high[axis] - low,
                 at = (p[axis] - low) / size;
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    const double x = p[i] - e->box.low[i], y = p[j] - e->box.low[j];
    grow(e, &e->hulls[axis][WHOLE], x, y);
    if (at <= 0.02)
      grow(e, &e->hulls[axis][LOW], x, y);
    if (at >= 0.98)
      grow(e, &e->hulls[axis][HIGH], x, y);
  }
}

/* The area of the polygon whose edges have the directions' distances from the origin. */
static double area(const Hull *hull) {
  const double turn = 2 * M_PI / DIRECTIONS, c = vl_precise_cos(turn), s = vl_precise_sin(turn);
  double sum = 0;
  for (int k = 0; k < DIRECTIONS; k++) {
    const double h = hull->max[k], before = hull->max[(k + DIRECTIONS - 1) % DIRECTIONS],
                 after = hull->max[(k + 1) % DIRECTIONS];
    sum += 0.5 * h * (before + after - 2 * h * c) / s;
  }
  return sum;
}

static double share(const Ends *e, int axis, int end) {
  const double whole = area(&e->hulls[axis][WHOLE]), part = area(&e->hulls[axis][end]);
  return whole > 0 && isfinite(part) ? part / whole : 0;
}

static bool measure(const vlScene *scene, const vlExtent *boxes, Ends *e) {
  *e = (Ends){.box = vl_extent_nothing};
  vl_extent_visit(scene, boxes, NULL, vl_extent_grow, &e->box);
  for (int i = 0; i < 3; i++)
    if (!(e->box.high[i] > e->box.low[i]))
      return false;
  for (int k = 0; k < DIRECTIONS; k++) {
    const double turn = 2 * M_PI * k / DIRECTIONS;
    e->cosine[k] = vl_precise_cos(turn);
    e->sine[k] = vl_precise_sin(turn);
    for (int axis = 0; axis < 3; axis++)
      for (int part = 0; part < 3; part++)
        e->hulls[axis][part].max[k] = -INFINITY;
  }
  vl_extent_visit(scene, boxes, NULL, visit, e);
  return true;
}

static double size_of(const Ends *e, int axis) {
  return vl_extent_size(&e->box, axis);
}

/* Whether the model looks turned about the axis: the other two have the same ends. */
static bool is_round(const Ends *e, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double max = fmax(size_of(e, i), size_of(e, j));
  if (fabs(size_of(e, i) - size_of(e, j)) > 0.03 * max)
    return false;
  const double ends[4] = {share(e, i, LOW), share(e, i, HIGH), share(e, j, LOW),
                          share(e, j, HIGH)};
  double low = ends[0], high = ends[0];
  for (int k = 1; k < 4; k++) {
    low = fmin(low, ends[k]);
    high = fmax(high, ends[k]);
  }
  return high - low < 0.05;
}

/* Whether the model is a city: many blocks of different heights on one plane. */
static bool is_city(const vlScene *scene, const Ends *e, int axis) {
  const double blocks_least = 0.9, walls_least = 0.1, lower_least = 0.6, plane = 0.5;
  const int levels_least = 10;
  if (share(e, axis, LOW) < plane)
    return false;
  const vlBlocks blocks = vl_facing_blocks(scene, &e->box, axis);
  return blocks.flat + blocks.walls >= blocks_least && blocks.walls >= walls_least &&
         blocks.lower >= lower_least * blocks.flat && blocks.levels >= levels_least;
}

/* Whether the model's ground, a plain or the plane of a city, is at right angles to the axis.
 */
static bool has_ground(const vlScene *scene, const vlExtent *boxes, vlPlains *plains,
                       const Ends *e, int axis) {
  return vl_plain_search(scene, boxes, axis, plains) || is_city(scene, e, axis);
}

/* Whether the model is an open sheet that lies: terrain. */
static bool is_sheet(const vlScene *scene, int axis) {
  const double max = 0.7;
  double n[3];
  vl_facing_mean_normal(scene, false, n);
  return fabs(n[axis]) >= max;
}

/* Whether the model is a figure on its feet with its arms stretched out: the same on the left
 * and on the right, flat, with its arms high up (those of aircraft are in the middle). */
static bool is_figure(const Ends *e, int now, int other) {
  const double feet = 0.15, more = 2, none = 0.35, same = 0.02, flat = 0.4, wide = 0.5,
               arms = 0.7;
  const double low = share(e, other, LOW), high = share(e, other, HIGH);
  return low >= feet && low >= more * high && share(e, now, LOW) < none &&
         share(e, now, HIGH) < none && fabs(share(e, 0, LOW) - share(e, 0, HIGH)) < same &&
         size_of(e, now) <= flat * size_of(e, other) &&
         size_of(e, 0) >= wide * size_of(e, other) && e->arms[other] >= arms * e->arms[0];
}

/* Whether the model has a wide base and a small top along `other`, and along `now` no such
 * thing: a chair. */
static bool has_foot(const Ends *e, int now, int other) {
  const double wide = 0.8, small = 0.3, max = 0.6;
  return share(e, other, LOW) >= wide && share(e, other, HIGH) <= small &&
         share(e, now, LOW) - share(e, now, HIGH) <= max;
}

/* Whether the model stands on its lowest part along `other`, and not along `now`. */
static bool stands(const Ends *e, int now, int other) {
  const double no_base = 0.12, base = 0.15, larger = 0.25;
  const double max = fmax(size_of(e, 0), fmax(size_of(e, 1), size_of(e, 2)));
  const double low = share(e, other, LOW), high = share(e, other, HIGH);
  if (size_of(e, other) < 0.5 * max)
    return false;
  if (has_foot(e, now, other) || is_figure(e, now, other))
    return true;
  return share(e, now, LOW) < no_base &&
         (low - high >= larger || (low >= base && is_round(e, other)));
}

/* ---- the surface as a whole -------------------------------------------------------------- */

/* How far the middle of the surface is inside of what the model stands on along the axis, as a
 * share of its height; negative: it falls over. */
static double stability(const Ends *e, const vlPosture *p, int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const double x = p->middle[i] * size_of(e, i), y = p->middle[j] * size_of(e, j);
  double min = INFINITY;
  for (int k = 0; k < DIRECTIONS; k++)
    min = fmin(min, e->hulls[axis][LOW].max[k] - x * e->cosine[k] - y * e->sine[k]);
  return min / size_of(e, axis);
}

/* Height as a share of the smaller of the other two sides. */
static double flatness(const Ends *e, int axis) {
  return size_of(e, axis) / fmin(size_of(e, (axis + 1) % 3), size_of(e, (axis + 2) % 3));
}

/* Things have a top and a bottom that differ, while sides resemble each other: cars, aircraft,
 * trees, houses. Charts, which are the same above and below, lean on their back. Of 18 glTF
 * files, whose up is known, 17 have along y at most .05 more symmetry than along z, one .31: it
 * stands firmer as it is. (These numbers are of a prototype of the measure, with other
 * samples.) */
static bool is_symmetric_otherwise(const Ends *e, const vlPosture *p, int now, int other) {
  const double chart = 0.15, flat = 0.4, min = now == 1 ? 0.2 : 0.35, more = 0.05, back = 0.5,
               firm = 0.1, height = flatness(e, other);
  if (height < chart || (height < flat && p->ends[other][LOW] >= back))
    return false;
  if (p->symmetry[now] - p->symmetry[other] < (height < flat ? min + more : min))
    return false;
  const double stands = stability(e, p, now);
  return stands < firm || stability(e, p, other) > stands;
}

/* Whether the model is a height field over `axis`: terrain, open, or on a block with a flat
 * underside. It has hills in both directions; curtains and flags have folds in one. */
static bool is_terrain(const vlPosture *p, int axis) {
  const double single = 0.97, slope = 0.05, whole = 0.95, level = 0.8, steep = 0.3, full = 0.8,
               none = 0.1, both_sides = 2.2, even = 0.5;
  const bool open = fabs(p->normal[axis]) >= single * p->facing[axis] &&
                    p->flat[axis] <= level * p->silhouette[axis] && p->facing[axis] >= steep;
  const bool block = p->ends[axis][LOW] >= full && p->ends[axis][HIGH] <= none &&
                     p->silhouette[axis] <= both_sides &&
                     p->flat[axis] <= p->ends[axis][LOW] + even;
  return (open || block) && p->covered[axis] >= whole && p->facing[(axis + 1) % 3] >= slope &&
         p->facing[(axis + 2) % 3] >= slope;
}

/* Whether the model is a storey: hollow, with a floor and straight walls, and as high along
 * `other` as rooms are, in metres, centimetres or millimetres. */
static bool is_storey(const Ends *e, const vlPosture *p, int now, int other) {
  const double low = 2, high = 4.5, floor_least = 0.8, wall_least = 0.5, hollow = 3, max = 0.85;
  const double height = size_of(e, other);
  bool storey = false;
  for (double unit = 1; unit <= 1000; unit *= unit > 1 ? 10 : 100)
    storey = storey || (height >= low * unit && height <= high * unit);
  for (int i = 0; i < 3; i++)
    if (i != other)
      storey = storey && p->ends[i][LOW] >= wall_least && p->ends[i][HIGH] >= wall_least &&
               p->silhouette[i] >= hollow;
  return storey && p->ends[other][LOW] >= floor_least &&
         height <= max * fmin(size_of(e, now), size_of(e, 0));
}

/* How the parts of a model, its shapes, stand along two axes. */
typedef struct Standing {
  const Ends *e;
  int now, other;
  const vlShapeDef *shape; /* whose faces are added */
  vlExtent box;            /* of it */
  double area, moment;     /* sums: of its faces; of them times their place along `other` */
  uint32_t parts, low_now; /* all; at the low end of the model along `now` */
  uint32_t low_other;      /* at the low end along `other`, and tapering away from it */
} Standing;

static void end_part(Standing *s) {
  const double near = 0.06, tall = 0.3, heavy = 0.45;
  if (!s->shape || !(s->area > 0))
    return;
  const double from_now = s->box.low[s->now] - s->e->box.low[s->now];
  const double from_other = s->box.low[s->other] - s->e->box.low[s->other];
  const double height = s->box.high[s->other] - s->box.low[s->other];
  const double middle = s->moment / s->area - s->box.low[s->other];
  s->parts++;
  s->low_now += from_now <= near * size_of(s->e, s->now);
  s->low_other += from_other <= near * size_of(s->e, s->other) &&
                  height >= tall * size_of(s->e, s->other) && middle <= heavy * height;
}

static void add_part_face(void *user, const vlFace *face) {
  Standing *s = user;
  if (face->shape != s->shape) {
    end_part(s);
    s->shape = face->shape;
    s->box = vl_extent_nothing;
    s->area = s->moment = 0;
  }
  for (int k = 0; k < 3; k++)
    vl_extent_grow(&s->box, face->corners[k]);
  s->area += face->size;
  s->moment += face->size * face->middle[s->other];
}

/* Whether the model consists of many parts that stand side by side along `other`, each heavier
 * below than above, and not along `now`: trees, chessmen. */
static bool parts_stand(const vlScene *scene, const Ends *e, int now, int other) {
  const uint32_t many = 8;
  Standing s = {.e = e, .now = now, .other = other};
  if (scene->shapes.count < many)
    return false;
  vl_faces_visit(scene, add_part_face, &s);
  end_part(&s);
  return s.parts >= many && 5 * s.low_other >= 4 * s.parts && 2 * s.low_now <= s.parts;
}

/* Whether a cloud of points is wide along `other` and covers all, or has a ground: what
 * scanners on tripods, cars and aircraft give. */
static bool is_survey(const Ends *e, const vlPosture *p, int other) {
  const double wide = 0.75, all = 0.9, ground = 0.2;
  return p->points && flatness(e, other) <= wide &&
         (p->covered[other] >= all || p->lowest[other] >= ground);
}

/* Whether the model is a flat chart that looks down: away from y, which z-up files have as
 * their front. */
static bool is_chart_below(const vlScene *scene, const Ends *e, const vlPosture *p) {
  const double chart = 0.15, flat = 0.9, closed = 0.05;
  const double up[3] = {0, 1, 0};
  if (flatness(e, 1) > chart || p->flat[1] < flat * p->silhouette[1])
    return false;
  return p->normal[1] <= -flat * p->facing[1] ||
         (fabs(p->normal[1]) < closed && vl_facing_raised_is_behind(scene, &e->box, up));
}

/* What the whole surface says. */
typedef enum Guess { UNKNOWN, KEEP, CHANGE } Guess;
static Guess guess_by_surface(const vlScene *scene, const Ends *e, int now, int other) {
  vlPosture p;
  if (!vl_posture_find(scene, &e->box, &p))
    return UNKNOWN;
  if (now == 1 && is_chart_below(scene, e, &p))
    return CHANGE;
  if (is_terrain(&p, now) || is_sheet(scene, now))
    return KEEP;
  const bool change = is_terrain(&p, other) || is_symmetric_otherwise(e, &p, now, other) ||
                      is_storey(e, &p, now, other) || is_survey(e, &p, other) ||
                      parts_stand(scene, e, now, other);
  return change ? CHANGE : UNKNOWN;
}

bool vl_upright_find(const vlScene *scene, const vlExtent *boxes, vlPlains *plains,
                     double up[3], double front[3]) {
  const int now = up[1] != 0 ? 1 : 2, other = 3 - now;
  Ends e;
  if (!measure(scene, boxes, &e) || has_ground(scene, boxes, plains, &e, now))
    return false;
  const Guess guess = guess_by_surface(scene, &e, now, other);
  if (guess == KEEP)
    return false;
  if (guess == UNKNOWN && !has_ground(scene, boxes, plains, &e, other) &&
      !stands(&e, now, other))
    return false;
  for (int i = 0; i < 3; i++) {
    up[i] = i == other;
    front[i] = other == 2 ? -(i == 1) : i == 2;
  }
  return true;
}
