/* accelerator.c: a tree of boxes (bounding volume hierarchy, pbrt book 7.3). A ray that misses a box misses all that is
 * in it. Each box is split at the middle of its longest side. */
#include <stdlib.h>

#include "texture.h"
#include "world.h"

struct node {
  vector low, high;
  uint32_t first; /* leaf: first entry of `order`; else the second child; the first child is the next node */
  uint32_t count; /* primitives of a leaf; 0: an inner node */
  int axis;       /* along which an inner node is split */
};

enum { LEAF = 4, DEPTH = 128 };

static double along(vector v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* ---- building ---------------------------------------------------------------------------------------------------- */

static void bound_all(const world *w, uint32_t first, uint32_t count, vector *low, vector *high) {
  bound_shape(w, &w->primitives[w->order[first]], low, high);
  for (uint32_t i = first + 1; i < first + count; i++) {
    vector l, h;
    bound_shape(w, &w->primitives[w->order[i]], &l, &h);
    *low = make_vector(fmin(low->x, l.x), fmin(low->y, l.y), fmin(low->z, l.z));
    *high = make_vector(fmax(high->x, h.x), fmax(high->y, h.y), fmax(high->z, h.z));
  }
}

/* Moves the primitives whose middle lies below a plane to the front; returns their number. */
static uint32_t divide(world *w, uint32_t first, uint32_t count, int axis, double plane) {
  uint32_t below = 0;
  for (uint32_t i = 0; i < count; i++) {
    vector low, high;
    uint32_t index = w->order[first + i];
    bound_shape(w, &w->primitives[index], &low, &high);
    if ((along(low, axis) + along(high, axis)) / 2 >= plane) continue;
    w->order[first + i] = w->order[first + below];
    w->order[first + below++] = index;
  }
  return below;
}

/* Makes the node of some primitives, and those below it. Returns the number of nodes so far. */
static uint32_t build(world *w, uint32_t node_count, uint32_t first, uint32_t count, int depth) {
  node *n = &w->nodes[node_count++];
  bound_all(w, first, count, &n->low, &n->high);
  n->first = first;
  n->count = count;
  if (count <= LEAF || depth > DEPTH / 2) return node_count;
  vector size = subtract(n->high, n->low);
  n->axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  double plane = (along(n->low, n->axis) + along(n->high, n->axis)) / 2;
  uint32_t below = divide(w, first, count, n->axis, plane);
  if (below == 0 || below == count) below = count / 2; /* all in one place: any half */
  n->count = 0;
  node_count = build(w, node_count, first, below, depth + 1);
  n->first = node_count;
  return build(w, node_count, first + below, count - below, depth + 1);
}

bool make_accelerator(world *w) {
  w->nodes = malloc((2 * (size_t)w->primitive_count + 1) * sizeof *w->nodes);
  w->order = malloc(((size_t)w->primitive_count + 1) * sizeof *w->order);
  if (!w->nodes || !w->order) return false;
  for (uint32_t i = 0; i < w->primitive_count; i++) w->order[i] = i;
  if (w->primitive_count == 0) return true;
  build(w, 0, 0, w->primitive_count, 0);
  w->low = w->nodes[0].low;
  w->high = w->nodes[0].high;
  w->radius = length(subtract(w->high, w->low)) / 2;
  return true;
}

/* ---- rays -------------------------------------------------------------------------------------------------------- */

/* The ray is inside the box where it is between all three pairs of planes. A little slack covers rounding. */
static bool meets_box(const node *n, ray r) {
  double from = r.t_min, to = r.t_max;
  for (int axis = 0; axis < 3; axis++) {
    double inverse = 1 / along(r.direction, axis);
    double near = (along(n->low, axis) - along(r.origin, axis)) * inverse;
    double far = (along(n->high, axis) - along(r.origin, axis)) * inverse;
    if (near > far) {
      double swap = near;
      near = far;
      far = swap;
    }
    near -= fabs(near) * 1e-12;
    far += fabs(far) * 1e-12;
    if (near > from) from = near; /* comparisons with NaN, for a ray in a plane, are false: the plane does not count */
    if (far < to) to = far;
  }
  return from <= to;
}

/* Alpha is the share of the surface that is there. */
static bool is_there(const world *w, const shade_record *record, sampler *s) {
  double alpha = number_at(w, record->where->def->alpha, record);
  if (alpha >= 1) return true;
  return alpha > 0 && next_number(s) < alpha;
}

/* The nearest hit of one primitive that is there; a ray may meet a curved one twice. */
static bool meet_primitive(const world *w, const primitive *p, ray r, sampler *s, shade_record *hit) {
  meeting m;
  while (meet_shape(w, p, r, &m)) {
    shade_record record;
    shape_surface(w, p, m.a, m.b, &record);
    record.t = m.t;
    if (is_there(w, &record, s)) {
      *hit = record;
      return true;
    }
    r.t_min = m.t;
  }
  return false;
}

bool find_hit(const world *w, ray r, sampler *s, shade_record *hit) {
  uint32_t stack[DEPTH], waiting = 0;
  bool found = false;
  if (w->primitive_count == 0) return false;
  stack[waiting++] = 0;
  while (waiting > 0) {
    uint32_t index = stack[--waiting];
    const node *n = &w->nodes[index];
    if (!meets_box(n, r)) continue;
    if (n->count == 0) { /* the nearer child last, so that it comes first */
      bool backwards = along(r.direction, n->axis) < 0;
      stack[waiting++] = backwards ? index + 1 : n->first;
      stack[waiting++] = backwards ? n->first : index + 1;
      continue;
    }
    for (uint32_t i = n->first; i < n->first + n->count; i++) {
      if (!meet_primitive(w, &w->primitives[w->order[i]], r, s, hit)) continue;
      r.t_max = hit->t;
      found = true;
    }
  }
  return found;
}
