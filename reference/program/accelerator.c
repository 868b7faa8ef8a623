/* program/accelerator.c: a tree of boxes (bounding volume hierarchy, pbrt book 7.3). A ray that misses a box misses all
 * that is in it. Each box is split at the middle of its longest side. */
#include "more/more.h"
#include "program.h"
struct node {
  vector low, high;
  uint32_t first, count; /* its primitives */
  uint32_t second;       /* 0: a leaf; else the second child; the first child is the next node */
};

enum { LEAF = 4, DEPTH = 64 };

static vector least(vector a, vector b) {
  return make_vector(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
}
static vector greatest(vector a, vector b) {
  return make_vector(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z));
}

static void include_point(primitive *p, vector point) {
  p->low = least(p->low, point);
  p->high = greatest(p->high, point);
}

static void widen(primitive *p, double by) {
  p->low = subtract(p->low, make_vector(by, by, by));
  p->high = add(p->high, make_vector(by, by, by));
}

/* Half of a curve's width, as long as any direction of the shape can become in the world. */
static double reach_of_curve(const placement *where, uint32_t face) {
  const float *width = where->def->widths + 2 * (size_t)face;
  const matrix *m = &where->world_from_shape;
  return (double)fmaxf(width[0], width[1]) / 2 * (length(m->x) + length(m->y) + length(m->z));
}

/* The box of what moves: around the corners of its box at many times, and half a step more for what is between. */
static void bound_motion(const motion *moves, primitive *p) {
  enum { TIMES = 256 };
  double first, last, longest = 0;
  vector low = p->low, high = p->high;
  times_of(moves, &first, &last);
  for (int k = 0; k < 8; k++) {
    vector corner = make_vector(k & 1 ? low.x : high.x, k & 2 ? low.y : high.y, k & 4 ? low.z : high.z),
           before = corner;
    for (int i = 0; i <= TIMES; i++) {
      matrix m = world_from_rest(moves, first + (last - first) * i / TIMES);
      vector now = transform_point(&m, corner);
      include_point(p, now);
      longest = fmax(longest, length(subtract(now, before)));
      before = now;
    }
  }
  widen(p, longest / 2);
}

/* The box around the corners; of a quadric those of a cube around the whole of it, taken to the world. */
static void bound_primitive(const world *w, primitive *p) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  double size = fmax((double)def->radius, fmax(fabs((double)def->z_min), fabs((double)def->z_max)));
  if (def->kind == VL_SHAPE_DISK) size = fmax((double)def->radius, fabs((double)def->height));
  p->low = make_vector((double)INFINITY, (double)INFINITY, (double)INFINITY);
  p->high = negate(p->low);
  for (int k = 0; k < 8 && is_quadric(def->kind); k++) {
    vector corner = make_vector(k & 1 ? size : -size, k & 2 ? size : -size, k & 4 ? size : -size);
    include_point(p, transform_point(&where->world_from_shape, corner));
  }
  uint32_t corners = def->kind == VL_SHAPE_TRIANGLES ? 3 : more_corners(def);
  for (uint32_t k = 0; k < corners; k++) include_point(p, p->corner[k]);
  if (def->kind == VL_SHAPE_CURVES) widen(p, reach_of_curve(where, p->face));
  if (where->moves) bound_motion(where->moves, p);
}

static double along(vector v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Moves the primitives whose middle lies below the middle of the node to the front; returns their number. */
static uint32_t divide(primitive *primitives, const node *n) {
  vector size = subtract(n->high, n->low), twice_middle = add(n->high, n->low);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  uint32_t below = 0;
  for (uint32_t i = 0; i < n->count; i++) {
    primitive p = primitives[i];
    if (along(add(p.low, p.high), axis) >= along(twice_middle, axis)) continue;
    primitives[i] = primitives[below];
    primitives[below++] = p;
  }
  return below > 0 && below < n->count ? below : n->count / 2; /* all in one place: any half */
}

/* Makes the node of some primitives, and those below it. Returns the number of nodes so far. */
static uint32_t build(world *w, uint32_t index, uint32_t first, uint32_t count, int depth) {
  node *n = &w->nodes[index];
  *n = (node){w->primitives[first].low, w->primitives[first].high, first, count, 0};
  for (uint32_t i = first; i < first + count; i++) {
    n->low = least(n->low, w->primitives[i].low);
    n->high = greatest(n->high, w->primitives[i].high);
  }
  if (count <= LEAF || depth > DEPTH) return index + 1;
  uint32_t below = divide(w->primitives + first, n);
  n->second = build(w, index + 1, first, below, depth + 1);
  return build(w, n->second, first + below, count - below, depth + 1);
}

void make_accelerator(world *w) {
  w->nodes = resize(NULL, 2 * (size_t)w->primitive_count, sizeof *w->nodes);
  if (w->primitive_count == 0) return;
  for (uint32_t i = 0; i < w->primitive_count; i++) bound_primitive(w, &w->primitives[i]);
  build(w, 0, 0, w->primitive_count, 0);
  w->radius = length(subtract(w->nodes[0].high, w->nodes[0].low)) / 2;
}

/* The ray is inside the box where it is between all three pairs of planes. A little slack covers rounding. */
static bool meets_box(const node *n, const ray *r) {
  double from = r->t_min, to = r->t_max;
  for (int axis = 0; axis < 3; axis++) {
    double t1 = (along(n->low, axis) - along(r->origin, axis)) / along(r->direction, axis);
    double t2 = (along(n->high, axis) - along(r->origin, axis)) / along(r->direction, axis);
    if (isnan(t1) || isnan(t2)) continue; /* the ray lies in a plane of the box: the plane does not count */
    from = fmax(from, fmin(t1, t2));
    to = fmin(to, fmax(t1, t2));
  }
  return from * (1 - 1e-12) <= to * (1 + 1e-12);
}

/* r->t_max becomes the distance of the nearest hit so far. */
static bool search(const world *w, uint32_t index, ray *r, sampler *s, shade_record *hit) {
  const node *n = &w->nodes[index];
  if (!meets_box(n, r)) return false;
  if (!n->second) return nearest_of(w, n->first, n->count, r, s, hit);
  bool found = search(w, index + 1, r, s, hit);
  return search(w, n->second, r, s, hit) || found;
}

bool find_hit(const world *w, ray r, sampler *s, shade_record *hit) {
  return w->primitive_count > 0 && search(w, 0, &r, s, hit);
}
