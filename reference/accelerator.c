/* accelerator.c: a tree of boxes (bounding volume hierarchy, pbrt book 7.3). A ray that misses a box misses all that is
 * in it. Each box is split at the middle of its longest side. */
#include "refuse.h"
#include "texture.h"
#include "world.h"

struct node {
  vector low, high;
  uint32_t first, count; /* a leaf's primitives */
  uint32_t second;       /* 0: a leaf; else the second child; the first child is the next node */
  int axis;              /* along which an inner node is split */
};

enum { LEAF = 4, DEPTH = 64 };

static double along(vector v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Moves the primitives whose middle lies below the middle of the node to the front; returns their number. */
static uint32_t divide(primitive *primitives, const node *n) {
  double plane = (along(n->low, n->axis) + along(n->high, n->axis)) / 2;
  uint32_t below = 0;
  for (uint32_t i = 0; i < n->count; i++) {
    primitive p = primitives[n->first + i];
    if ((along(p.low, n->axis) + along(p.high, n->axis)) / 2 >= plane) continue;
    primitives[n->first + i] = primitives[n->first + below];
    primitives[n->first + below++] = p;
  }
  return below > 0 && below < n->count ? below : n->count / 2; /* all in one place: any half */
}

/* Makes the node of some primitives, and those below it. Returns the number of nodes so far. */
static uint32_t build(world *w, uint32_t index, uint32_t first, uint32_t count, int depth) {
  node *n = &w->nodes[index];
  *n = (node){w->primitives[first].low, w->primitives[first].high, first, count, 0, 0};
  for (uint32_t i = first; i < first + count; i++) {
    n->low = least(n->low, w->primitives[i].low);
    n->high = greatest(n->high, w->primitives[i].high);
  }
  if (count <= LEAF || depth > DEPTH) return index + 1;
  vector size = subtract(n->high, n->low);
  n->axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  uint32_t below = divide(w->primitives, n);
  n->second = build(w, index + 1, first, below, depth + 1);
  return build(w, n->second, first + below, count - below, depth + 1);
}

void make_accelerator(world *w) {
  w->nodes = resize(NULL, 2 * (size_t)w->primitive_count, sizeof *w->nodes);
  if (w->primitive_count == 0) return;
  build(w, 0, 0, w->primitive_count, 0);
  w->radius = length(subtract(w->nodes[0].high, w->nodes[0].low)) / 2;
}

/* The ray is inside the box where it is between all three pairs of planes. A little slack covers rounding. */
static bool meets_box(const node *n, ray r) {
  for (int axis = 0; axis < 3; axis++) {
    double t1 = (along(n->low, axis) - along(r.origin, axis)) / along(r.direction, axis);
    double t2 = (along(n->high, axis) - along(r.origin, axis)) / along(r.direction, axis);
    if (isnan(t1) || isnan(t2)) continue; /* the ray lies in a plane of the box: the plane does not count */
    r.t_min = fmax(r.t_min, fmin(t1, t2));
    r.t_max = fmin(r.t_max, fmax(t1, t2));
  }
  return r.t_min * (1 - 1e-12) <= r.t_max * (1 + 1e-12);
}

/* The nearest hit of one primitive that is there; a ray may meet a curved one twice. Alpha is the share of the surface
 * that is there. */
static bool meet_primitive(const world *w, const primitive *p, ray r, sampler *s, shade_record *hit) {
  meeting m;
  while (meet_shape(w, p, r, &m)) {
    shade_record record = {.arrival = r.direction};
    shape_surface(w, p, m.a, m.b, &record);
    record.t = m.t;
    double alpha = number_at(w, record.where->def->alpha, &record);
    if (alpha >= 1 || (alpha > 0 && next_number(s) < alpha)) {
      *hit = record;
      return true;
    }
    r.t_min = m.t;
  }
  return false;
}

/* Looks into the nearer half first. r->t_max becomes the distance of the nearest hit so far. */
static bool search(const world *w, uint32_t index, ray *r, sampler *s, shade_record *hit) {
  const node *n = &w->nodes[index];
  bool found = false;
  if (!meets_box(n, *r)) return false;
  if (n->second) {
    bool backwards = along(r->direction, n->axis) < 0;
    found = search(w, backwards ? n->second : index + 1, r, s, hit);
    return search(w, backwards ? index + 1 : n->second, r, s, hit) || found;
  }
  for (uint32_t i = n->first; i < n->first + n->count; i++) {
    if (!meet_primitive(w, &w->primitives[i], *r, s, hit)) continue;
    r->t_max = hit->t;
    found = true;
  }
  return found;
}

bool find_hit(const world *w, ray r, sampler *s, shade_record *hit) {
  return w->primitive_count > 0 && search(w, 0, &r, s, hit);
}
