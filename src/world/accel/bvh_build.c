/* world/accel/bvh_build.c: builds trees (bvh.h) by the surface area heuristic: a range of primitives is split where the
 * sum of area times number of tests is least, among planes between bins of centres (Wald 2007, "On fast construction
 * of SAH-based bounding volume hierarchies"). A node's children are made by splitting the largest range until there are
 * eight. Large ranges are split one after the other, the others are built in parallel; the tree does not depend on the
 * number of threads. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "world/accel/bundle.h"
#include "world/accel/bvh.h"

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
  uintptr_t child;
  Box box[2]; /* at times 0 and 1 */
} Built;

/* A range that is built in parallel. */
typedef struct Part {
  Range range;
  Built built;
} Part;

/* A node above the parts. Children are nodes of this kind, or parts, counted from PARTS. */
enum { PARTS = 1 << 30 };
typedef struct Upper {
  uint32_t count, child[VL_BVH_WIDTH];
} Upper;

/* A worker's memory for nodes and leaves: the rest of a block. */
typedef struct Arena {
  char *at, *end;
  vlBvhBlock *blocks;
} Arena;

typedef struct Builder {
  const vlWorld *world;
  const vlWorldGroup *group; /* null: the world's instances */
  const vlAccelBundle *bundle;
  vlBvh *tree;
  uint32_t count, part_size;
  Primitive *primitives;
  Arena *arenas; /* one per worker */
  VL_ARRAY(Upper) uppers;
  VL_ARRAY(Part) parts;
  atomic_bool failed; /* no memory */
} Builder;

/* Memory that the tree owns, aligned to VL_BVH_ALIGN. Null: there is none. */
static void *take(Builder *b, Arena *arena, size_t size) {
  enum { BLOCK = 16384 };
  size = (size + VL_BVH_ALIGN - 1) & ~(size_t)(VL_BVH_ALIGN - 1);
  if ((size_t)(arena->end - arena->at) < size) {
    size_t room = b->count < BLOCK / 256 ? 1024 + 128 * (size_t)b->count : BLOCK;
    vlBvhBlock *block = vl_alloc(b->world->context, sizeof *block + VL_BVH_ALIGN + room);
    if (!block) return NULL;
    block->next = arena->blocks;
    arena->blocks = block;
    arena->at = (char *)(block + 1);
    arena->at += VL_BVH_ALIGN - (uintptr_t)arena->at % VL_BVH_ALIGN;
    arena->end = arena->at + room;
  }
  void *taken = arena->at;
  arena->at += size;
  return taken;
}

/* ---- boxes ------------------------------------------------------------------------------------------------------- */

static Box empty_box(void) {
  Box b;
  for (int i = 0; i < 4; i++) {
    b.low[i] = INFINITY;
    b.high[i] = -INFINITY;
  }
  return b;
}

static inline void extend(Box *b, const Box *other) {
  for (int i = 0; i < 4; i++) b->low[i] = other->low[i] < b->low[i] ? other->low[i] : b->low[i];
  for (int i = 0; i < 4; i++) b->high[i] = other->high[i] > b->high[i] ? other->high[i] : b->high[i];
}

static inline void extend_point(Box *b, const float p[3]) {
  for (int i = 0; i < 3; i++) {
    b->low[i] = fminf(b->low[i], p[i]);
    b->high[i] = fmaxf(b->high[i], p[i]);
  }
}

static inline void extend_center(Box *b, const Box *other) {
  for (int i = 0; i < 3; i++) {
    float c = other->low[i] + other->high[i];
    b->low[i] = c < b->low[i] ? c : b->low[i];
    b->high[i] = c > b->high[i] ? c : b->high[i];
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
    for (int k = 0; k < 2; k++) {
      box[k].low[i] -= fmaxf(low, 0);
      box[k].high[i] += fmaxf(high, 0);
    }
  }
}

/* By several rounding errors: of the sums above, and of positions and boxes between two times. */
static void widen(Box box[2]) {
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) {
      float most =
          fmaxf(fmaxf(fabsf(box[0].low[i]), fabsf(box[0].high[i])), fmaxf(fabsf(box[1].low[i]), fabsf(box[1].high[i])));
      box[k].low[i] -= 0x1p-20f * most;
      box[k].high[i] += 0x1p-20f * most;
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
  for (int i = 0; i < 3; i++) {
    b.low[i] -= error;
    b.high[i] += error;
  }
  return b;
}

static const vlWorldShape *shape_of(const Builder *b, vlBvhItem item, uint32_t *prim) {
  uint32_t geometry = item.geometry & ~VL_BVH_ASKS;
  bool bundled = b->bundle->members && geometry == b->bundle->geometry;
  *prim = bundled ? 0 : item.primitive;
  return &b->world->shapes.items[bundled ? b->bundle->members[item.primitive] : b->group->shapes[geometry]];
}

/* Box of a primitive at one of its steps or keys. */
static Box item_box(const Builder *b, vlBvhItem item, uint32_t step) {
  if (!b->group) {
    const vlWorldInstance *q = &b->world->instances.items[item.geometry];
    return placed_box(q, b->world->accel.groups[q->group], q->keys ? q->path + 12 * (size_t)step : q->from_group);
  }
  uint32_t prim;
  const vlWorldShape *s = shape_of(b, item, &prim);
  if (s->kind == VL_SHAPE_TRIANGLES) return triangle_box(s, prim, step);
  Box box = empty_box();
  vl_world_prim_bounds(s, prim, box.low, box.high);
  return box;
}

/* Boxes of a primitive at times 0 and 1. */
static void item_boxes(const Builder *b, vlBvhItem item, Box box[2]) {
  uint32_t prim, keys = b->group ? shape_of(b, item, &prim)->steps : b->world->instances.items[item.geometry].keys;
  box[0] = item_box(b, item, 0);
  box[1] = keys > 1 ? item_box(b, item, keys - 1) : box[0];
  for (uint32_t k = 1; k + 1 < keys; k++) {
    Box at = item_box(b, item, k);
    contain(box, (float)k / (float)(keys - 1), &at);
  }
  if (keys > 1 || !b->group) widen(box);
}

/* Lists all primitives, without their boxes. */
static void list_primitives(Builder *b) {
  uint32_t count = 0;
  for (size_t g = 0; g < (b->group ? b->group->count : b->count); g++) {
    const vlWorldShape *s = b->group ? &b->world->shapes.items[b->group->shapes[g]] : NULL;
    bool bundled = s && b->bundle->members && vl_accel_bundled(s), triangles = s && s->kind == VL_SHAPE_TRIANGLES;
    uint32_t n = !s ? 1 : !bundled ? s->faces : g == b->bundle->geometry ? b->bundle->count : 0;
    vlBvhKind kind = !triangles ? VL_BVH_OTHERS : s->steps > 1 ? VL_BVH_MOVING : VL_BVH_FOURS;
    b->tree->moves |= kind == VL_BVH_MOVING || (!s && b->world->instances.items[g].keys > 0);
    bool asks = triangles && (s->alpha >= 0 || s->one_sided || s->pass_shadow);
    for (uint32_t i = 0; i < n; i++, count++) {
      b->primitives[count].geometry = (uint32_t)g | (uint32_t)kind << KIND | (asks ? VL_BVH_ASKS : 0);
      b->primitives[count].primitive = i;
    }
  }
}

static bool is_stopped(const Builder *b) {
  return atomic_load_explicit(&b->failed, memory_order_relaxed) || vl_task_stopped(b->world->task, NULL, 0);
}

/* Finds the boxes of some primitives. One that is not in Embree's range, nor in that of rays, has an empty box. */
static void find_boxes(void *user, uint32_t index, uint32_t worker) {
  Builder *b = user;
  (void)worker;
  uint32_t i = index * CHUNK, end = b->count - i < CHUNK ? b->count : i + CHUNK;
  for (; i < end && !(i % 1024 == 0 && is_stopped(b)); i++) {
    Primitive *p = &b->primitives[i];
    Box box[2];
    item_boxes(b, item_of(p), box);
    extend(&box[0], &box[1]);
    bool near = true;
    for (int k = 0; k < 3; k++) {
      p->low[k] = box[0].low[k];
      p->high[k] = box[0].high[k];
      near = near && p->low[k] > -1.8e18f && p->high[k] < 1.8e18f;
    }
    if (!near) p->low[0] = INFINITY;
  }
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
  box = empty_box();
  count = 0;
  for (int k = 1; k < BINS; k++) {
    extend(&box, &bins[k - 1].box);
    count += bins[k - 1].count;
    float cost = count ? area(&box) * tests(count) + right[k] : INFINITY;
    if (cost < least) {
      least = cost;
      *plane = k;
    }
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
    if (cost < least) {
      least = cost;
      r->axis = i;
      r->bin = plane;
      r->low = r->centers.low[i];
      r->scale = scale[i];
    }
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
      p[j] = p[i];
      p[i] = other;
      add(&half[1], &p[j]);
    }
  }
  half[0].begin = r->begin;
  half[0].end = half[1].begin = i;
  half[1].end = r->end;
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
      if (!to[k].leaf && to[k].end - to[k].begin > small && (size > most || largest == VL_BVH_WIDTH)) {
        most = size;
        largest = k;
      }
    }
    if (largest == VL_BVH_WIDTH) break;
    Range half[2];
    split(b, &to[largest], half);
    to[largest] = half[0];
    to[count++] = half[1];
  }
  return count;
}

/* ---- nodes ------------------------------------------------------------------------------------------------------- */

static void set_box(vlBvhBoxes *boxes, uint32_t k, const Box *box) {
  for (int i = 0; i < 3; i++) {
    (*boxes)[2 * i][k] = box->low[i];
    (*boxes)[2 * i + 1][k] = box->high[i];
  }
}

static bool make_node(Builder *b, Arena *arena, const Built *children, uint32_t count, Built *built) {
  vlBvhNode *node = take(b, arena, sizeof *node + (b->tree->moves ? sizeof node->later[0] : 0));
  if (!node) return false;
  Box none; /* so large that no ray meets it, and finite, for products with 0 */
  for (int i = 0; i < 4; i++) {
    none.low[i] = 0x1p126f;
    none.high[i] = -0x1p126f;
  }
  built->child = vl_bvh_child(VL_BVH_NODE, 1, node);
  built->box[0] = built->box[1] = empty_box();
  for (uint32_t k = 0; k < VL_BVH_WIDTH; k++) {
    node->child[k] = k < count ? children[k].child : 0;
    set_box(&node->boxes, k, k < count ? &children[k].box[0] : &none);
    if (b->tree->moves) set_box(&node->later[0], k, k < count ? &children[k].box[1] : &none);
    for (int i = 0; i < 2 && k < count; i++) extend(&built->box[i], &children[k].box[i]);
  }
  return true;
}

static void put_face(const Builder *b, vlBvhItem item, vlBvhFour *four, uint32_t k) {
  uint32_t prim;
  const vlWorldShape *s = shape_of(b, item, &prim);
  for (size_t c = 0; c < 3; c++)
    for (size_t i = 0; i < 3; i++)
      four->corner[c][i][k] = s->positions[3 * (size_t)s->indices[3 * (size_t)prim + c] + i];
  four->geometry[k] = item.geometry;
  four->primitive[k] = item.primitive;
}

static bool make_leaf(Builder *b, Arena *arena, const Range *r, Built *built) {
  const Primitive *p = b->primitives + r->begin;
  uint32_t n = r->end - r->begin, blocks = (n + VL_BVH_FOUR - 1) / VL_BVH_FOUR;
  vlBvhKind kind = kind_of(p);
  size_t size = kind == VL_BVH_FOURS ? blocks * sizeof(vlBvhFour) : n * sizeof(vlBvhItem);
  void *leaf = take(b, arena, size);
  if (!leaf) return false;
  memset(leaf, 0, size);
  built->child = vl_bvh_child(kind, kind == VL_BVH_FOURS ? blocks : n, leaf);
  built->box[0] = built->box[1] = empty_box();
  for (uint32_t i = 0; i < n; i++) {
    vlBvhItem item = item_of(&p[i]);
    Box box[2] = {p[i].box, p[i].box};
    if (b->tree->moves) item_boxes(b, item, box);
    for (int k = 0; k < 2; k++) extend(&built->box[k], &box[k]);
    if (kind == VL_BVH_FOURS)
      put_face(b, item, (vlBvhFour *)leaf + i / VL_BVH_FOUR, i % VL_BVH_FOUR);
    else
      ((vlBvhItem *)leaf)[i] = item;
  }
  return true;
}

static bool make_tree(Builder *b, Arena *arena, const Range *range, Built *built) {
  if (range->leaf) return make_leaf(b, arena, range, built);
  Range ranges[VL_BVH_WIDTH];
  Built children[VL_BVH_WIDTH];
  uint32_t count = split_often(b, range, 1, ranges);
  for (uint32_t k = 0; k < count; k++)
    if (!make_tree(b, arena, &ranges[k], &children[k])) return false;
  return make_node(b, arena, children, count, built);
}

static void make_part(void *user, uint32_t index, uint32_t worker) {
  Builder *b = user;
  Part *part = &b->parts.items[index];
  if (!is_stopped(b) && !make_tree(b, &b->arenas[worker], &part->range, &part->built)) atomic_store(&b->failed, true);
}

/* Splits a range until the parts are small. *child: as in Upper. */
static bool split_upper(Builder *b, const Range *range, uint32_t *child) {
  vlContext *c = b->world->context;
  if (is_stopped(b) || !VL_RESERVE(c, &b->parts, 1) || !VL_RESERVE(c, &b->uppers, 1)) return false;
  if (range->leaf || range->end - range->begin <= b->part_size) {
    *child = PARTS + (uint32_t)b->parts.count;
    b->parts.items[b->parts.count++].range = *range;
    return true;
  }
  Range ranges[VL_BVH_WIDTH];
  Upper upper = {.count = split_often(b, range, b->part_size, ranges)};
  uint32_t index = *child = (uint32_t)b->uppers.count++;
  for (uint32_t k = 0; k < upper.count; k++)
    if (!split_upper(b, &ranges[k], &upper.child[k])) return false;
  b->uppers.items[index] = upper;
  return true;
}

/* Makes an upper node and those below it. */
static bool join(Builder *b, uint32_t child, Built *built) {
  if (child >= PARTS) {
    *built = b->parts.items[child - PARTS].built;
    return true;
  }
  const Upper *upper = &b->uppers.items[child];
  Built children[VL_BVH_WIDTH];
  for (uint32_t k = 0; k < upper->count; k++)
    if (!join(b, upper->child[k], &children[k])) return false;
  return make_node(b, &b->arenas[0], children, upper->count, built);
}

/* ---- the whole --------------------------------------------------------------------------------------------------- */

/* The range of all primitives with a box. */
static Range all_primitives(Builder *b) {
  Range all = {.box = empty_box(), .centers = empty_box()};
  for (uint32_t i = 0; i < b->count; i++) {
    if (!(b->primitives[i].low[0] <= b->primitives[i].high[0])) continue;
    b->primitives[all.end] = b->primitives[i];
    add(&all, &b->primitives[all.end++]);
  }
  if (all.end) decide(b, &all);
  return all;
}

/* False: out of memory, or stopped. */
static bool build(Builder *b) {
  vlContext *c = b->world->context;
  b->primitives = vl_alloc_array(c, (size_t)b->count + 1, sizeof *b->primitives);
  b->arenas = vl_alloc_zero(c, vl_context_threads(c), sizeof *b->arenas);
  if (atomic_load(&b->failed) || !b->primitives || !b->arenas) return false;
  vlLoopDef loop = vl_loop_def(0, b->world->task->cancel);
  list_primitives(b);
  vl_parallel_for_at(c, &loop, (b->count + CHUNK - 1) / CHUNK, find_boxes, b);
  if (is_stopped(b)) return false;
  Range all = all_primitives(b);
  Built root = {0};
  uint32_t top;
  b->part_size = all.end / 256 < CHUNK ? CHUNK : all.end / 256;
  if (all.end == 0) {
    if (!make_node(b, &b->arenas[0], NULL, 0, &root)) return false;
  } else {
    if (!split_upper(b, &all, &top)) return false;
    vl_parallel_for_at(c, &loop, (uint32_t)b->parts.count, make_part, b);
    if (is_stopped(b) || !join(b, top, &root)) return false;
  }
  extend(&root.box[0], &root.box[1]);
  b->tree->root = root.child;
  for (int i = 0; i < 3; i++) {
    float low = b->tree->low[i] = root.box[0].low[i], high = b->tree->high[i] = root.box[0].high[i];
    if (all.end) b->tree->reach = fmaxf(b->tree->reach, fmaxf(fabsf(low), fabsf(high)));
  }
  return true;
}

static vlResult finish(Builder *b, vlBvh **tree, vlError *error) {
  vlContext *c = b->world->context;
  bool built = b->tree && build(b);
  for (uint32_t k = 0; b->arenas && k < vl_context_threads(c); k++)
    for (vlBvhBlock *block = b->arenas[k].blocks, *next; block; block = next) {
      next = block->next;
      block->next = b->tree->blocks;
      b->tree->blocks = block;
    }
  vl_free(c, b->arenas);
  vl_free(c, b->primitives);
  VL_ARRAY_FREE(c, &b->parts);
  VL_ARRAY_FREE(c, &b->uppers);
  *tree = b->tree;
  if (built) return VL_OK;
  vl_bvh_release(c, b->tree);
  *tree = NULL;
  vlResult r = vl_world_step(b->world, NULL, 0, error);
  return r == VL_OK ? vl_fail_memory(error) : r;
}

static vlBvh *new_tree(const vlWorld *world) {
  vlBvh *tree = vl_alloc_zero(world->context, 1, sizeof *tree);
  if (tree) atomic_init(&tree->users, 1);
  return tree;
}

vlResult vl_bvh_make_group(const vlWorld *world, uint32_t k, vlBvh **tree, vlError *error) {
  const vlWorldGroup *group = &world->groups.items[k];
  Builder b = {.world = world, .group = group, .bundle = &world->accel.bundles[k], .tree = new_tree(world)};
  uint64_t count = 0; /* members of a bundle have one face each */
  for (uint32_t i = 0; i < group->count; i++) count += world->shapes.items[group->shapes[i]].faces;
  b.count = (uint32_t)count;
  if (count >= UINT32_MAX) atomic_store(&b.failed, true);
  return finish(&b, tree, error);
}

vlResult vl_bvh_make_instances(const vlWorld *world, vlBvh **tree, vlError *error) {
  Builder b = {.world = world, .tree = new_tree(world), .count = (uint32_t)world->instances.count};
  if (b.tree) b.tree->maps = vl_alloc_array(world->context, b.count, sizeof *b.tree->maps);
  if (b.tree && !b.tree->maps) atomic_store(&b.failed, true);
  for (uint32_t i = 0; b.tree && b.tree->maps && i < b.count; i++)
    vl_bvh_map(world->instances.items[i].from_group, b.tree->maps[i]);
  return finish(&b, tree, error);
}
