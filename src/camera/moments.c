/* camera/moments.c: see moments.h. The readout is searched from its beginning in equal parts
 * for one in which the film point passes the row that is read, or the row the film point; there
 * the root is found by regula falsi (Illinois variant: Dowell and Jarratt 1971). */
#include "camera/moments.h"

#include <math.h>
#include <string.h>

#include "camera/points.h"
#include "math/double3.h"

/* 0 where the readout begins, 1 where it ends; not clamped. */
static double progress_at(const vlCameraTime *t, double x, double y) {
  double at = t->per_column != 0.0 ? x / t->columns : y / t->rows;
  return t->per_column < 0.0 || t->per_row < 0.0 ? 1.0 - at : at;
}

static double time_at(const vlCameraCompiled *c, double progress) {
  const vlCameraTime *t = &c->when;
  double step = fabs(t->per_row + t->per_column);
  double lines = t->per_column != 0.0 ? t->columns : t->rows;
  double middle = c->shutter_open + c->shutter_time * vl_shutter_share(t, 0.5);
  return middle + (progress * lines - 0.5) * step;
}

double vl_camera_film_time(const vlCameraCompiled *c, double x, double y) {
  double progress = progress_at(&c->when, x, y);
  if (vl_camera_has_one_time(c))
    progress = 0.0;
  return time_at(c, fmin(fmax(progress, 0.0), 1.0));
}

void vl_camera_hold(vlCameraCompiled *c, double seconds) {
  double world_from_camera[12], camera_from_world[12];
  vl_camera_pose_at(c, seconds, world_from_camera, camera_from_world);
  vl_split_map(world_from_camera, c->rotation, c->position);
  memcpy(c->camera_from_world, camera_from_world, sizeof camera_from_world);
  c->when.moves = false;
  c->when.timed = false;
  c->when.per_row = c->when.per_column = 0.0;
  c->when.points = 0;
  c->shutter_open = seconds;
  c->shutter_time = 0.0;
}

bool vl_camera_film_at(const vlCameraCompiled *c, double seconds, const double point[3],
                       double film[2]) {
  double back[12], m[12], x[3];
  vl_camera_pose_at(c, seconds, back, m);
  vl_map_point(m, point, x);
  vlPlanePoint f = vl_camera_film_point(c, x[0], x[1], x[2]);
  film[0] = f.x;
  film[1] = f.y;
  return f.valid > 0.0;
}

/* ---- the solution ------------------------------------------------------------------------ */

/* One try: the film point seen at a part of the readout, and how far its own part is ahead. */
typedef struct Try {
  bool seen;
  double progress, ahead, film[2];
} Try;

typedef struct Search {
  const vlCameraCompiled *camera;
  vlSeenFn *seen;
  void *user;
} Search;

/* A share of the readout. Exact is what doubles can hold. Poses of moving objects have times
 * in float: what is close is a solution as near as these have one, and no jump of the film
 * point. */
static const double EXACT = 1e-15, CLOSE = 1e-5;

static Try look(const Search *s, double progress) {
  Try t = {.progress = progress};
  t.seen = s->seen(s->user, time_at(s->camera, progress), t.film);
  if (t.seen)
    t.ahead = progress_at(&s->camera->when, t.film[0], t.film[1]) - progress;
  return t;
}

/* Between two tries of which one is ahead and the other behind. False: the film point jumps
 * there. */
static bool refine(const Search *s, Try a, Try b, Try *root) {
  double weight_a = 1.0, weight_b = 1.0;
  for (int step = 0; step < 100; step++) {
    double fa = a.ahead * weight_a, fb = b.ahead * weight_b;
    double at = (a.progress * fb - b.progress * fa) / (fb - fa);
    if (step % 4 == 3 || !(at >= a.progress && at <= b.progress))
      at = 0.5 * (a.progress + b.progress);
    *root = look(s, at);
    if (!root->seen)
      return false;
    if (fabs(root->ahead) < EXACT || !(b.progress - a.progress > EXACT))
      break;
    bool left = (root->ahead > 0.0) == (a.ahead > 0.0);
    weight_a = left ? 1.0 : 0.5 * weight_a;
    weight_b = left ? 0.5 * weight_b : 1.0;
    if (left)
      a = *root;
    else
      b = *root;
  }
  return fabs(root->ahead) < CLOSE;
}

/* Where only one end of a part sees it: follows the film point from there. */
static bool follow(const Search *s, const Try *from, double low, double high, Try *root) {
  *root = *from;
  for (int step = 0; step < 200 && root->seen; step++) {
    if (fabs(root->ahead) < EXACT)
      break;
    double next = root->progress + root->ahead;
    if (!(next >= low && next <= high))
      return false;
    *root = look(s, next);
  }
  return root->seen && fabs(root->ahead) < CLOSE;
}

static bool search(const Search *s, Try *root) {
  enum { PARTS = 16 };
  Try first = look(s, 0.0), before = first;
  for (int k = 1; k <= PARTS; k++) {
    Try now = look(s, (double)k / PARTS);
    bool found = false;
    if (before.seen && now.seen && (before.ahead > 0.0) != (now.ahead > 0.0))
      found = refine(s, before, now, root);
    else if (before.seen != now.seen)
      found = follow(s, before.seen ? &before : &now, before.progress, now.progress, root);
    if (found)
      return true;
    before = now;
  }
  *root = first.seen && first.ahead <= 0.0 ? first : before;
  return (first.seen && first.ahead <= 0.0) || (before.seen && before.ahead >= 0.0);
}

bool vl_camera_find_time(const vlCameraCompiled *c, vlSeenFn *seen, void *user, double *seconds,
                         double film[2]) {
  Search s = {c, seen, user};
  Try root;
  *seconds = time_at(c, 0.0);
  if (vl_camera_has_one_time(c))
    return seen(user, *seconds, film);
  if (!search(&s, &root))
    return false;
  *seconds = time_at(c, root.progress);
  memcpy(film, root.film, sizeof root.film);
  return true;
}

/* ---- points at rest ---------------------------------------------------------------------- */

typedef struct Point {
  const vlCameraCompiled *camera;
  const double *at;
} Point;

static bool point_seen(void *user, double seconds, double film[2]) {
  const Point *p = user;
  return vl_camera_film_at(p->camera, seconds, p->at, film);
}

bool vl_camera_hold_at_point(vlCameraCompiled *c, const double point[3]) {
  Point p = {c, point};
  double seconds, film[2];
  if (!vl_camera_find_time(c, point_seen, &p, &seconds, film))
    return false;
  vl_camera_hold(c, seconds);
  return true;
}
