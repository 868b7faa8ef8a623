/* world/accel/bvh_build.c: builds trees (bvh.h) by the surface area heuristic: a range of primitives is split where the
 * sum of area times number of tests is least, among planes between bins of centres (Wald 2007, "On fast construction
 * of SAH-based bounding volume hierarchies"). A node's children are made by splitting the largest range until there are
 * eight. Large ranges are split one after the other, the others are built in parallel; the tree does not depend on the
 * number of threads. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "world/accel/bvh.h"
#include "world/accel/nearest.h"

enum { BINS = 16, FACES = 8 /* most triangles of a leaf */, CHUNK = 4096 };

/* The fourth lane of a box fills a vector. That of a primitive's box has its numbers instead. */
typedef struct Box {
  float low[4], high[4];
} Box;
typedef union Primitive {
  Box box;
  struct {
    float low[3];
    uint32_t geometry; /* with VL_BVH_ASKS, and the kind in the two bits below */
    float high[3];
    uint32_t primitive;
  };
} Primitive;
enum { KIND = 29 };
static vlBvhKind kind_of(const Primitive *p) {
  return (vlBvhKind)(p->geometry >> KIND & 3);
}
static vlBvhItem item_of(const Primitive *p) {
  return (vlBvhItem){p->geometry & ~(3u << KIND), p->primitive};
}

/* Primitives begin to end - 1. axis -1: split in the middle. */
typedef struct Range {
  uint32_t begin, end, depth;
  Box box, centers; /* centers: of the sums low + high */
  bool leaf;
  int axis;
  float low, scale; /* of the bins */
  int bin;          /* the first of the right half */
} Range;

/* What is built from a range. */
typedef struct Built {
  uint32_t child;
  Box box[2]; /* at times 0 and 1 */
} Built;

/* Nodes, blocks and items of a part of a tree, numbered from 0. */
typedef struct Part {
  Range range;
  Built root;
  VL_ARRAY(vlBvhNode) nodes;
  VL_ARRAY(vlBvhBoxes) later;
  VL_ARRAY(vlBvhFour) fours;
  VL_ARRAY(vlBvhItem) items;
} Part;

/* A node above the parts. Children are nodes of this kind, or parts (number + nodes). */
typedef struct Upper {
  uint32_t count, child[VL_BVH_WIDTH];
} Upper;

typedef struct Builder {
  const vlWorld *world;
  const vlWorldGroup *group; /* null: the world's instances */
  const vlAccelBundle *bundle;
  bool moves;
  uint32_t count, part_size;
  Primitive *primitives;
  uint32_t *starts; /* number of the first primitive of each geometry, and the number of all */
  VL_ARRAY(Upper) uppers;
  VL_ARRAY(Part) parts;
  atomic_bool failed; /* no memory */
} Builder;

/* ---- boxes ------------------------------------------------------------------------------------------------------- */

static Box empty_box(void) {
  Box b;
  for (int i = 0; i < 4; i++) b.low[i] = INFINITY, b.high[i] = -INFINITY;
  return b;
}

static inline void extend(Box *b, const Box *other) {
  for (int i = 0; i < 4; i++) b->low[i] = other->low[i] < b->low[i] ? other->low[i] : b->low[i];
  for (int i = 0; i < 4; i++) b->high[i] = other->high[i] > b->high[i] ? other->high[i] : b->high[i];
}

static inline void extend_point(Box *b, const float p[3]) {
  for (int i = 0; i < 3; i++) b->low[i] = fminf(b->low[i], p[i]), b->high[i] = fmaxf(b->high[i], p[i]);
}

static inline void extend_center(Box *b, const Box *other) {
  for (int i = 0; i < 3; i++) {
    float c = other->low[i] + other->high[i];
    b->low[i] = c < b->low[i] ? c : b->low[i], b->high[i] = c > b->high[i] ? c : b->high[i];
  }
}

static float area(const Box *b) {
  float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

/* Makes the two boxes wide enough that the box between them at `time` contains `at`. */
static void contain(Box box[2], float time, const Box *at) {
  for (int i = 0; i < 3; i++) {
    float low = box[0].low[i] * (1 - time) + box[1].low[i] * time - at->low[i];
    float high = at->high[i] - (box[0].high[i] * (1 - time) + box[1].high[i] * time);
    for (int k = 0; k < 2; k++) box[k].low[i] -= fmaxf(low, 0), box[k].high[i] += fmaxf(high, 0);
  }
}

/* By several rounding errors: of the sums above, and of positions and boxes between two times. */
static void widen(Box box[2]) {
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) {
      float most =
          fmaxf(fmaxf(fabsf(box[0].low[i]), fabsf(box[0].high[i])), fmaxf(fabsf(box[1].low[i]), fabsf(box[1].high[i])));
      box[k].low[i] -= 0x1p-20f * most, box[k].high[i] += 0x1p-20f * most;
    }
}

/* ---- primitives -------------------------------------------------------------------------------------------------- */

/* Box of a triangle at one of its steps. */
static Box triangle_box(const vlWorldShape *s, uint32_t prim, uint32_t step) {
  Box b = empty_box();
  for (int k = 0; k < 3; k++) {
    size_t vertex = (size_t)step * s->vertices + s->indices[3 * (size_t)prim + (size_t)k];
    extend_point(&b, s->positions + 3 * vertex);
  }
  return b;
}

static void moving_triangle(const vlWorldShape *s, uint32_t prim, Box box[2]) {
  box[0] = triangle_box(s, prim, 0), box[1] = triangle_box(s, prim, s->steps - 1);
  for (uint32_t k = 1; k + 1 < s->steps; k++) {
    Box at = triangle_box(s, prim, k);
    contain(box, (float)k / (float)(s->steps - 1), &at);
  }
  widen(box);
}

/* Box of an instance with a pose. A ray in the group's space may be off by the instance's error. */
static Box placed_box(const vlWorldInstance *instance, const vlBvh *group, const float pose[12]) {
  Box b = empty_box();
  float error = instance->error[3];
  for (int i = 0; i < 3; i++) error += instance->error[i] * fmaxf(fabsf(group->low[i]), fabsf(group->high[i]));
  for (int c = 0; c < 8; c++) {
    float p[3];
    for (int i = 0; i < 3; i++) {
      double x = (double)pose[4 * i + 3];
      for (int j = 0; j < 3; j++) x += (double)pose[4 * i + j] * (double)(c >> j & 1 ? group->high[j] : group->low[j]);
      p[i] = (float)x;
    }
    extend_point(&b, p);
  }
  for (int i = 0; i < 3; i++) b.low[i] -= error, b.high[i] += error;
  return b;
}

static void instance_boxes(const vlWorld *world, uint32_t index, Box box[2]) {
  const vlWorldInstance *q = &world->instances.items[index];
  const vlBvh *group = world->accel.groups[q->group];
  if (!q->keys) {
    box[0] = box[1] = placed_box(q, group, q->from_group);
  } else {
    box[0] = placed_box(q, group, q->path), box[1] = placed_box(q, group, q->path + 12 * (size_t)(q->keys - 1));
    for (uint32_t k = 1; k + 1 < q->keys; k++) {
      Box at = placed_box(q, group, q->path + 12 * (size_t)k);
      contain(box, (float)k / (float)(q->keys - 1), &at);
    }
  }
  widen(box);
}

static const vlWorldShape *shape_of(const Builder *b, vlBvhItem item, uint32_t *prim) {
  uint32_t geometry = item.geometry & ~VL_BVH_ASKS;
  bool bundled = b->bundle->members && geometry == b->bundle->geometry;
  *prim = bundled ? 0 : item.primitive;
  return &b->world->shapes.items[bundled ? b->bundle->members[item.primitive] : b->group->shapes[geometry]];
}

/* Boxes of a primitive at times 0 and 1. */
static void item_boxes(const Builder *b, vlBvhKind kind, vlBvhItem item, Box box[2]) {
  if (!b->group) {
    instance_boxes(b->world, item.geometry, box);
    return;
  }
  uint32_t prim;
  const vlWorldShape *s = shape_of(b, item, &prim);
  if (kind == VL_BVH_MOVING) {
    moving_triangle(s, prim, box);
    return;
  }
  box[0] = empty_box();
  if (kind == VL_BVH_FOURS)
    box[0] = triangle_box(s, prim, 0);
  else
    vl_world_prim_bounds(s, prim, box[0].low, box[0].high);
  box[1] = box[0];
}

/* Makes primitive i of geometry g. One that is not in Embree's range (nor in that of rays) has an empty box. */
static void make_primitive(const Builder *b, uint32_t g, uint32_t i, Primitive *p) {
  vlBvhKind kind = VL_BVH_OTHERS;
  vlBvhItem item = {g, i};
  uint32_t prim;
  const vlWorldShape *s = b->group ? shape_of(b, item, &prim) : NULL;
  if (s && s->kind == VL_SHAPE_TRIANGLES) kind = s->steps > 1 ? VL_BVH_MOVING : VL_BVH_FOURS;
  Box box[2];
  item_boxes(b, kind, item, box);
  extend(&box[0], &box[1]);
  for (int k = 0; k < 3; k++)
    if (!(box[0].low[k] > -1.8e18f && box[0].high[k] < 1.8e18f)) box[0].low[0] = INFINITY;
  p->box = box[0];
  p->geometry = g | (uint32_t)kind << KIND, p->primitive = i;
  if (kind != VL_BVH_OTHERS && (s->alpha >= 0 || s->one_sided || s->pass_shadow)) p->geometry |= VL_BVH_ASKS;
}

static bool is_stopped(Builder *b) {
  return atomic_load_explicit(&b->failed, memory_order_relaxed) || vl_task_stopped(b->world->task, NULL, 0);
}

static void make_chunk(void *user, uint32_t index, uint32_t worker) {
  Builder *b = user;
  (void)worker;
  uint32_t i = index * CHUNK, end = b->count - i < CHUNK ? b->count : i + CHUNK, g = 0;
  if (is_stopped(b)) return;
  for (uint32_t high = b->group ? b->group->count : 0;
       g + 1 < high;) { /* the last geometry that begins at or before i */
    uint32_t middle = (g + high) / 2;
    if (b->starts[middle] <= i)
      g = middle;
    else
      high = middle;
  }
  for (; i < end; i++) {
    while (b->group && i >= b->starts[g + 1]) g++;
    make_primitive(b, b->group ? g : i, b->group ? i - b->starts[g] : 0, &b->primitives[i]);
  }
}

/* Numbers the primitives of a group. False: there are too many. */
static bool count_primitives(Builder *b) {
  uint64_t count = 0;
  for (uint32_t g = 0; g < b->group->count; g++) {
    const vlWorldShape *s = &b->world->shapes.items[b->group->shapes[g]];
    bool bundled = b->bundle->members && vl_accel_bundled(s);
    b->starts[g] = (uint32_t)count;
    count += bundled ? (g == b->bundle->geometry ? b->bundle->count : 0) : s->faces;
    b->moves = b->moves || (s->kind == VL_SHAPE_TRIANGLES && s->steps > 1);
    if (count >= VL_BVH_MOST) return false;
  }
  b->starts[b->group->count] = b->count = (uint32_t)count;
  return true;
}

/* ---- splits ------------------------------------------------------------------------------------------------------ */

static inline int bin_at(const Primitive *p, int axis, float low, float scale) {
  int bin = (int)((p->low[axis] + p->high[axis] - low) * scale);
  return bin < 0 ? 0 : bin < BINS ? bin : BINS - 1;
}

static bool is_alike(const Builder *b, const Range *r) {
  for (uint32_t i = r->begin + 1; i < r->end; i++)
    if (kind_of(&b->primitives[i]) != kind_of(&b->primitives[r->begin])) return false;
  return true;
}

static float tests(uint32_t count) {
  return (float)((count + VL_BVH_FOUR - 1) / VL_BVH_FOUR);
}

typedef struct Bin {
  Box box;
  uint32_t count;
} Bin;

/* The best plane between bins along an axis. Returns area times tests of both halves. */
static float best_plane(const Bin bins[BINS], int *plane) {
  float right[BINS], least = INFINITY;
  Box box = empty_box();
  uint32_t count = 0;
  for (int k = BINS - 1; k > 0; k--) {
    extend(&box, &bins[k].box);
    count += bins[k].count;
    right[k] = count ? area(&box) * tests(count) : INFINITY;
  }
  box = empty_box(), count = 0;
  for (int k = 1; k < BINS; k++) {
    extend(&box, &bins[k - 1].box);
    count += bins[k - 1].count;
    float cost = count ? area(&box) * tests(count) + right[k] : INFINITY;
    if (cost < least) least = cost, *plane = k;
  }
  return least;
}

/* Decides whether a range becomes a leaf, and otherwise how it is split. */
static void decide(const Builder *b, Range *r) {
  uint32_t n = r->end - r->begin;
  bool small = n <= FACES && is_alike(b, r), faces = small && kind_of(&b->primitives[r->begin]) != VL_BVH_OTHERS;
  r->axis = -1;
  r->leaf = n == 1 || (faces && n <= VL_BVH_FOUR);
  if (r->leaf || r->depth >= VL_BVH_DEPTH) return;
  Bin bins[3][BINS];
  float scale[3];
  for (int i = 0; i < 3; i++) {
    float extent = r->centers.high[i] - r->centers.low[i];
    scale[i] = extent > 0x1p-100f && extent < 0x1p100f ? 0.9999f * BINS / extent : 0;
    for (int k = 0; k < BINS; k++) bins[i][k] = (Bin){empty_box(), 0};
  }
  for (uint32_t k = r->begin; k < r->end; k++) {
    const Primitive *p = &b->primitives[k];
    for (int i = 0; i < 3; i++) {
      Bin *bin = &bins[i][bin_at(p, i, r->centers.low[i], scale[i])];
      extend(&bin->box, &p->box);
      bin->count++;
    }
  }
  float least = INFINITY;
  for (int i = 0; i < 3; i++) {
    int plane = 0;
    float cost = scale[i] > 0 ? best_plane(bins[i], &plane) : INFINITY;
    if (cost < least) least = cost, r->axis = i, r->bin = plane, r->low = r->centers.low[i], r->scale = scale[i];
  }
  float whole = area(&r->box); /* the test of a node counts as that of a block */
  r->leaf = faces && whole * tests(n) <= whole + least;
}

static void add(Range *r, const Primitive *p) {
  extend(&r->box, &p->box);
  extend_center(&r->centers, &p->box);
}

static void split(const Builder *b, const Range *r, Range half[2]) {
  Primitive *p = b->primitives;
  uint32_t i = r->begin, j = r->end;
  for (int k = 0; k < 2; k++) half[k] = (Range){.depth = r->depth + 1, .box = empty_box(), .centers = empty_box()};
  if (r->axis < 0) {
    i = r->begin + (r->end - r->begin) / 2;
    for (uint32_t k = r->begin; k < r->end; k++) add(&half[k >= i], &p[k]);
  } else {
    while (i < j) {
      if (bin_at(&p[i], r->axis, r->low, r->scale) < r->bin) {
        add(&half[0], &p[i++]);
        continue;
      }
      Primitive other = p[--j];
      p[j] = p[i], p[i] = other;
      add(&half[1], &p[j]);
    }
  }
  half[0].begin = r->begin, half[0].end = half[1].begin = i, half[1].end = r->end;
  decide(b, &half[0]);
  decide(b, &half[1]);
}

/* Splits a range into up to eight. Those of at most `small` primitives stay whole. */
static uint32_t split_often(const Builder *b, const Range *range, uint32_t small, Range to[VL_BVH_WIDTH]) {
  uint32_t count = 1;
  to[0] = *range;
  while (count < VL_BVH_WIDTH) {
    uint32_t largest = VL_BVH_WIDTH;
    float most = -1;
    for (uint32_t k = 0; k < count; k++) {
      float size = area(&to[k].box);
      if (!to[k].leaf && to[k].end - to[k].begin > small && (size > most || largest == VL_BVH_WIDTH))
        most = size, largest = k;
    }
    if (largest == VL_BVH_WIDTH) break;
    Range half[2];
    split(b, &to[largest], half);
    to[largest] = half[0], to[count++] = half[1];
  }
  return count;
}

/* ---- nodes ------------------------------------------------------------------------------------------------------- */

/* Numbers so large that no ray meets the box, and finite, for products with 0. */
static void clear_boxes(vlBvhBoxes *boxes) {
  for (int row = 0; row < 6; row++)
    for (int k = 0; k < VL_BVH_WIDTH; k++) (*boxes)[row][k] = row & 1 ? -0x1p126f : 0x1p126f;
}

static void set_box(vlBvhBoxes *boxes, uint32_t k, const Box *box) {
  for (int i = 0; i < 3; i++) (*boxes)[2 * i][k] = box->low[i], (*boxes)[2 * i + 1][k] = box->high[i];
}

/* Fills a node; later is null if nothing moves. */
static void make_node(const Built *children, uint32_t count, vlBvhNode *node, vlBvhBoxes *later, Box box[2]) {
  memset(node->child, 0, sizeof node->child);
  clear_boxes(&node->boxes);
  if (later) clear_boxes(later);
  box[0] = box[1] = empty_box();
  for (uint32_t k = 0; k < count; k++) {
    node->child[k] = children[k].child;
    set_box(&node->boxes, k, &children[k].box[0]);
    if (later) set_box(later, k, &children[k].box[1]);
    for (int i = 0; i < 2; i++) extend(&box[i], &children[k].box[i]);
  }
}

static void put_face(const Builder *b, vlBvhItem item, vlBvhFour *four, uint32_t k) {
  uint32_t prim;
  const vlWorldShape *s = shape_of(b, item, &prim);
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < 3; i++)
      four->corner[c][i][k] = s->positions[3 * (size_t)s->indices[3 * (size_t)prim + (size_t)c] + (size_t)i];
  four->geometry[k] = item.geometry, four->primitive[k] = item.primitive;
}

static bool make_leaf(const Builder *b, Part *part, const Range *r, Built *built) {
  const Primitive *p = b->primitives + r->begin;
  uint32_t n = r->end - r->begin, blocks = (n + VL_BVH_FOUR - 1) / VL_BVH_FOUR;
  vlBvhKind kind = kind_of(p);
  bool fours = kind == VL_BVH_FOURS;
  built->child = fours ? vl_bvh_child(kind, blocks, (uint32_t)part->fours.count)
                       : vl_bvh_child(kind, n, (uint32_t)part->items.count);
  built->box[0] = built->box[1] = empty_box();
  for (uint32_t i = 0; i < n; i++) {
    vlBvhItem item = item_of(&p[i]);
    Box box[2] = {p[i].box, p[i].box};
    if (b->moves) item_boxes(b, kind, item, box);
    for (int k = 0; k < 2; k++) extend(&built->box[k], &box[k]);
    if (fours) {
      if (i % VL_BVH_FOUR == 0 && !VL_PUSH(b->world->context, &part->fours)) return false;
      put_face(b, item, &part->fours.items[part->fours.count - 1], i % VL_BVH_FOUR);
    } else {
      vlBvhItem *to = VL_PUSH(b->world->context, &part->items);
      if (!to) return false;
      *to = item;
    }
  }
  return true;
}

static bool make_tree(Builder *b, Part *part, const Range *range, Built *built) {
  if (range->leaf) return make_leaf(b, part, range, built);
  Range ranges[VL_BVH_WIDTH];
  Built children[VL_BVH_WIDTH];
  uint32_t count = split_often(b, range, 1, ranges), index = (uint32_t)part->nodes.count;
  if (!VL_PUSH(b->world->context, &part->nodes)) return false;
  if (b->moves && !VL_PUSH(b->world->context, &part->later)) return false;
  for (uint32_t k = 0; k < count; k++)
    if (!make_tree(b, part, &ranges[k], &children[k])) return false;
  make_node(children, count, &part->nodes.items[index], b->moves ? &part->later.items[index] : NULL, built->box);
  built->child = vl_bvh_child(VL_BVH_NODE, 1, index);
  return true;
}

static void make_part(void *user, uint32_t index, uint32_t worker) {
  Builder *b = user;
  (void)worker;
  Part *part = &b->parts.items[index];
  if (!is_stopped(b) && !make_tree(b, part, &part->range, &part->root)) atomic_store(&b->failed, true);
}

/* Splits a range until the parts are small. *child: as in Upper, with `parts` counted from PARTS. */
enum { PARTS = 1 << 30 };
static bool split_upper(Builder *b, const Range *range, uint32_t *child) {
  if (is_stopped(b)) return false;
  if (range->leaf || range->end - range->begin <= b->part_size) {
    Part *part = VL_PUSH(b->world->context, &b->parts);
    if (!part) return false;
    part->range = *range;
    *child = PARTS + (uint32_t)b->parts.count - 1;
    return true;
  }
  Range ranges[VL_BVH_WIDTH];
  uint32_t count = split_often(b, range, b->part_size, ranges), index = *child = (uint32_t)b->uppers.count;
  if (!VL_PUSH(b->world->context, &b->uppers)) return false;
  b->uppers.items[index].count = count;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t below;
    if (!split_upper(b, &ranges[k], &below)) return false;
    b->uppers.items[index].child[k] = below;
  }
  return true;
}

/* ---- the whole --------------------------------------------------------------------------------------------------- */

/* Allocates a tree and its arrays as one block. */
static vlBvh *allocate(const Builder *b) {
  size_t nodes = b->uppers.count, fours = 0, items = 0, maps = b->group ? 0 : b->world->instances.count;
  for (size_t k = 0; k < b->parts.count; k++) {
    const Part *part = &b->parts.items[k];
    nodes += part->nodes.count, fours += part->fours.count, items += part->items.count;
  }
  if (nodes >= VL_BVH_MOST) return NULL;
  size_t sizes[] = {64 + sizeof(vlBvh),        nodes * sizeof(vlBvhNode), b->moves ? nodes * sizeof(vlBvhBoxes) : 0,
                    fours * sizeof(vlBvhFour), items * sizeof(vlBvhItem), maps * sizeof(float[12])};
  size_t total = 0, at[6];
  for (int k = 0; k < 6; k++) at[k] = total, total += (sizes[k] + 63) & ~(size_t)63;
  char *block = vl_alloc(b->world->context, total + 64);
  if (!block) return NULL;
  char *rows = block + (64 - (uintptr_t)block % 64); /* aligned; the tree itself is at the block's beginning */
  vlBvh *tree = (vlBvh *)(void *)block;
  *tree = (vlBvh){.moves = b->moves, .nodes = (void *)(rows + at[1])};
  tree->later = b->moves ? (void *)(rows + at[2]) : NULL;
  tree->fours = (void *)(rows + at[3]), tree->items = (void *)(rows + at[4]);
  tree->maps = b->group ? NULL : (void *)(rows + at[5]);
  atomic_init(&tree->users, 1);
  return tree;
}

/* The number of a part's child in the whole. */
static uint32_t shifted(uint32_t child, const vlBvh *tree) {
  switch (vl_bvh_kind(child)) {
    case VL_BVH_NODE: return child + tree->node_count;
    case VL_BVH_FOURS: return child + tree->four_count;
    case VL_BVH_MOVING:
    case VL_BVH_OTHERS: break;
  }
  return child + tree->item_count;
}

/* Appends a part's arrays to those of the tree, and frees them. */
static void append(const Builder *b, vlBvh *tree, Part *part) {
  vlContext *c = b->world->context;
  part->root.child = shifted(part->root.child, tree);
  for (size_t i = 0; i < part->nodes.count; i++) {
    vlBvhNode *node = &tree->nodes[tree->node_count + i];
    *node = part->nodes.items[i];
    for (int k = 0; k < VL_BVH_WIDTH; k++)
      if (node->boxes[0][k] <= node->boxes[1][k]) node->child[k] = shifted(node->child[k], tree);
    if (b->moves) memcpy(tree->later[tree->node_count + i], part->later.items[i], sizeof(vlBvhBoxes));
  }
  if (part->fours.count)
    memcpy(tree->fours + tree->four_count, part->fours.items, part->fours.count * sizeof *tree->fours);
  if (part->items.count)
    memcpy(tree->items + tree->item_count, part->items.items, part->items.count * sizeof *tree->items);
  tree->node_count += (uint32_t)part->nodes.count, tree->four_count += (uint32_t)part->fours.count;
  tree->item_count += (uint32_t)part->items.count;
  VL_ARRAY_FREE(c, &part->nodes);
  VL_ARRAY_FREE(c, &part->later);
  VL_ARRAY_FREE(c, &part->fours);
  VL_ARRAY_FREE(c, &part->items);
}

/* Makes an upper node and those below it. */
static Built join(const Builder *b, vlBvh *tree, uint32_t child) {
  if (child >= PARTS) return b->parts.items[child - PARTS].root;
  const Upper *upper = &b->uppers.items[child];
  Built built, children[VL_BVH_WIDTH];
  for (uint32_t k = 0; k < upper->count; k++) children[k] = join(b, tree, upper->child[k]);
  uint32_t index = tree->node_count++;
  make_node(children, upper->count, &tree->nodes[index], b->moves ? &tree->later[index] : NULL, built.box);
  built.child = vl_bvh_child(VL_BVH_NODE, 1, index);
  return built;
}

static vlBvh *build(Builder *b) {
  vlContext *c = b->world->context;
  b->primitives = vl_alloc_array(c, (size_t)b->count + 1, sizeof *b->primitives);
  if (!b->primitives) return NULL;
  vlLoopDef loop = vl_loop_def(0, b->world->task->cancel);
  vl_parallel_for_at(c, &loop, (b->count + CHUNK - 1) / CHUNK, make_chunk, b);
  if (is_stopped(b)) return NULL;
  uint32_t count = 0;
  Range all = {.box = empty_box(), .centers = empty_box()};
  for (uint32_t i = 0; i < b->count; i++) {
    if (!(b->primitives[i].low[0] <= b->primitives[i].high[0])) continue;
    b->primitives[count] = b->primitives[i];
    add(&all, &b->primitives[count++]);
  }
  b->part_size = count / 256 < 4096 ? 4096 : count / 256;
  uint32_t top = 0;
  all.end = count;
  if (count) decide(b, &all);
  if (count ? !split_upper(b, &all, &top) : !VL_PUSH(c, &b->uppers)) return NULL; /* empty: a node without children */
  vl_parallel_for_at(c, &loop, (uint32_t)b->parts.count, make_part, b);
  if (is_stopped(b)) return NULL;
  vl_free(c, b->primitives);
  b->primitives = NULL;
  vlBvh *tree = allocate(b);
  if (!tree) return NULL;
  for (size_t k = 0; k < b->parts.count; k++) append(b, tree, &b->parts.items[k]);
  Built root = join(b, tree, top);
  tree->root = root.child;
  extend(&root.box[0], &root.box[1]);
  memcpy(tree->low, root.box[0].low, sizeof tree->low);
  memcpy(tree->high, root.box[0].high, sizeof tree->high);
  for (int i = 0; count && i < 3; i++)
    tree->reach = fmaxf(tree->reach, fmaxf(fabsf(tree->low[i]), fabsf(tree->high[i])));
  return tree;
}

static vlResult finish(Builder *b, vlBvh **tree, vlError *error) {
  vlContext *c = b->world->context;
  *tree = build(b);
  for (size_t k = 0; k < b->parts.count; k++) {
    Part *part = &b->parts.items[k];
    VL_ARRAY_FREE(c, &part->nodes);
    VL_ARRAY_FREE(c, &part->later);
    VL_ARRAY_FREE(c, &part->fours);
    VL_ARRAY_FREE(c, &part->items);
  }
  VL_ARRAY_FREE(c, &b->parts);
  VL_ARRAY_FREE(c, &b->uppers);
  vl_free(c, b->primitives);
  vl_free(c, b->starts);
  if (*tree) return VL_OK;
  vlResult r = vl_world_step(b->world, NULL, 0, error);
  return r == VL_OK ? vl_fail_memory(error) : r;
}

vlResult vl_bvh_make_group(const vlWorld *world, uint32_t k, vlBvh **tree, vlError *error) {
  Builder b = {.world = world, .group = &world->groups.items[k], .bundle = &world->accel.bundles[k]};
  *tree = NULL;
  b.starts = vl_alloc_array(world->context, (size_t)b.group->count + 1, sizeof *b.starts);
  if (!b.starts) return vl_fail_memory(error);
  if (count_primitives(&b)) return finish(&b, tree, error);
  vl_free(world->context, b.starts);
  return vl_fail(error, VL_ERROR_SCENE, "a group has more than %d primitives, too many for the BVH", VL_BVH_MOST);
}

vlResult vl_bvh_make_instances(const vlWorld *world, vlBvh **tree, vlError *error) {
  Builder b = {.world = world, .count = (uint32_t)world->instances.count};
  for (uint32_t i = 0; i < b.count; i++) b.moves = b.moves || world->instances.items[i].keys > 0;
  vlResult r = finish(&b, tree, error);
  for (uint32_t i = 0; r == VL_OK && i < b.count; i++)
    vl_bvh_map(world->instances.items[i].from_group, (*tree)->maps[i]);
  return r;
}
