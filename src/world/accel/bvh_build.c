/* world/accel/bvh_build.c: builds trees (bvh.h) by the surface area heuristic: a range of
 * primitives is split where the sum of area times number of tests is least, among planes
 * between bins of centres (Wald 2007, "On fast construction of SAH-based bounding volume
 * hierarchies"). A node's children are made by splitting the largest range until there are
 * eight. Large ranges are split one after the other, the others are built in parallel; the tree
 * does not depend on the number of threads. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "velo/shape.h"
#include "world/accel/bundle.h"
#include "world/accel/bvh.h"

enum { BINS = 16, CHUNK = 4096 };

/* The fourth lane of a box fills a vector. That of a primitive's box has its numbers
 * instead. */
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
  uint32_t kinds;   /* one bit each */
  Box box, centers; /* centers: of the sums low + high */
  bool leaf;
  int axis;
  float low, scale; /* of the bins */
  int bin;          /* the first of the right half */
} Range;

/* A range that is built in parallel, and where its address belongs. */
typedef struct Part {
  Range range;
  uintptr_t *child;
} Part;

/* A worker's memory for nodes and leaves: the rest of a block. */
typedef struct Arena {
  char *at, *end;
} Arena;

typedef struct Builder {
  const vlWorld *world;
  uint32_t group; /* VL_NONE: the world's instances */
  vlBvh *tree;
  uint32_t count, part_size;
  Primitive *primitives;
  Arena *arenas; /* one per worker */
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
    if (!block)
      return NULL;
    block->next = atomic_load(&b->tree->blocks);
    while (!atomic_compare_exchange_weak(&b->tree->blocks, &block->next, block))
      continue;
    arena->at = (char *)(block + 1);
    arena->at += VL_BVH_ALIGN - (uintptr_t)arena->at % VL_BVH_ALIGN;
    arena->end = arena->at + room;
  }
  void *taken = arena->at;
  arena->at += size;
  return taken;
}

static Box empty_box(void) {
  const float max = INFINITY;
  return (Box){{max, max, max, max}, {-max, -max, -max, -max}};
}

static inline void extend(Box *b, const Box *other) {
  for (int i = 0; i < 4; i++)
    b->low[i] = other->low[i] < b->low[i] ? other->low[i] : b->low[i];
  for (int i = 0; i < 4; i++)
    b->high[i] = other->high[i] > b->high[i] ? other->high[i] : b->high[i];
}

static inline void extend_point(Box *b, const float p[3]) {
  for (int i = 0; i < 3; i++) {
    b->low[i] = fminf(b->low[i], p[i]);
    b->high[i] = fmaxf(b->high[i], p[i]);
  }
}

static float area(const Box *b) {
  float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

/* The shape of a primitive, whose number becomes that in the shape. */
static const vlWorldShape *shape_of(const Builder *b, vlBvhItem *item) {
  return vl_accel_group_shape(b->world, b->group, item->geometry & ~VL_BVH_ASKS,
                              &item->primitive);
}

/* Box of an instance with a pose. A ray in the group's space may be off by the instance's
 * error. */
static Box placed_box(const vlWorldInstance *instance, const vlBvh *group,
                      const float pose[12]) {
  Box b = empty_box();
  float error = instance->error[3];
  for (int i = 0; i < 3; i++)
    error += instance->error[i] * fmaxf(fabsf(group->low[i]), fabsf(group->high[i]));
  for (int i = 0; i < 3; i++) {
    double low = (double)pose[4 * i + 3], high = low;
    for (int j = 0; j < 3; j++) {
      double one = (double)pose[4 * i + j] * (double)group->low[j],
             other = (double)pose[4 * i + j] * (double)group->high[j];
      low += fmin(one, other);
      high += fmax(one, other);
    }
    b.low[i] = (float)low - error;
    b.high[i] = (float)high + error;
  }
  return b;
}

/* Box of a primitive at one of its steps or keys. */
static Box item_box(const Builder *b, vlBvhItem item, uint32_t step) {
  const vlWorldInstance *q =
      b->group == VL_NONE ? &b->world->instances.items[item.geometry] : NULL;
  if (q)
    return placed_box(q, b->world->accel.groups[q->group],
                      q->keys ? q->path + 12 * (size_t)step : q->from_group);
  const vlWorldShape *s = shape_of(b, &item);
  Box box = empty_box();
  for (size_t k = 0; k < 3 && s->triangles; k++) {
    size_t vertex = (size_t)step * s->vertices + s->indices[3 * (size_t)item.primitive + k];
    extend_point(&box, s->positions + 3 * vertex);
  }
  if (!s->triangles)
    vl_world_prim_bounds(s, item.primitive, box.low, box.high);
  return box;
}

/* Boxes of a primitive at times 0 and 1. They are so wide that a box between them contains the
 * primitive at its time, and by several rounding errors wider: of the sums here, and of
 * positions and boxes between two times. */
static void item_boxes(const Builder *b, vlBvhItem item, Box box[2]) {
  vlBvhItem own = item;
  bool placed = b->group == VL_NONE;
  uint32_t keys =
      placed ? b->world->instances.items[item.geometry].keys : shape_of(b, &own)->steps;
  float beside[3] = {0};
  box[0] = item_box(b, item, 0);
  box[1] = keys > 1 ? item_box(b, item, keys - 1) : box[0];
  for (uint32_t k = 1; k + 1 < keys; k++) {
    Box at = item_box(b, item, k);
    float time = (float)k / (float)(keys - 1);
    for (int i = 0; i < 3; i++) {
      float low = box[0].low[i] * (1 - time) + box[1].low[i] * time,
            high = box[0].high[i] * (1 - time) + box[1].high[i] * time;
      beside[i] = fmaxf(beside[i], fmaxf(low - at.low[i], at.high[i] - high));
    }
  }
  for (int i = 0; i < 3 && (placed || keys > 1); i++) {
    float max =
        fmaxf(fmaxf(-box[0].low[i], box[0].high[i]), fmaxf(-box[1].low[i], box[1].high[i]));
    float wide = beside[i] + 0x1p-20f * (beside[i] + max);
    for (int k = 0; k < 2; k++) {
      box[k].low[i] -= wide;
      box[k].high[i] += wide;
    }
  }
}

/* Lists all primitives, without their boxes. */
static void list_primitives(Builder *b) {
  Primitive *to = b->primitives;
  const vlWorldGroup *group = b->group == VL_NONE ? NULL : &b->world->groups.items[b->group];
  for (size_t g = 0; g < (group ? group->count : b->count); g++) {
    const vlWorldShape *s = group ? &b->world->shapes.items[group->shapes[g]] : NULL;
    const vlAccelBundle *bundle =
        s && vl_accel_bundled(s) ? &b->world->accel.bundles[b->group] : NULL;
    uint32_t n = !s                            ? 1
                 : !bundle || !bundle->members ? s->faces
                 : g == bundle->geometry       ? bundle->count
                                               : 0;
    bool triangles = s && s->triangles;
    bool asks = triangles && (s->alpha >= 0 || s->one_sided || s->pass_shadow);
    vlBvhKind kind = !triangles     ? VL_BVH_OTHER
                     : s->steps > 1 ? VL_BVH_FOUR_MOVING
                                    : VL_BVH_FOUR_STILL;
    b->tree->moves |=
        kind == VL_BVH_FOUR_MOVING || (!s && b->world->instances.items[g].keys > 0);
    for (uint32_t i = 0; i < n; i++, to++) {
      to->geometry = (uint32_t)g | (uint32_t)kind << KIND | (asks ? VL_BVH_ASKS : 0);
      to->primitive = i;
    }
  }
}

static bool is_stopped(const Builder *b) {
  return atomic_load_explicit(&b->failed, memory_order_relaxed) ||
         vl_task_stopped(b->world->task, NULL, 0);
}

/* Finds the boxes of some primitives. One that is not in Embree's range, nor in that of rays,
 * has an empty box. */
static void find_boxes(void *user, uint32_t index, VL_UNUSED uint32_t worker) {
  Builder *b = user;
  uint32_t i = index * CHUNK, end = b->count - i < CHUNK ? b->count : i + CHUNK;
  for (; i < end && !is_stopped(b); i++) {
    Primitive *p = &b->primitives[i];
    Box box[2];
    item_boxes(b, item_of(p), box);
    extend(&box[0], &box[1]);
    memcpy(p->low, box[0].low, sizeof p->low);
    memcpy(p->high, box[0].high, sizeof p->high);
    for (int k = 0; k < 3; k++)
      if (!(p->low[k] > -1.8e18f) || !(p->high[k] < 1.8e18f))
        p->low[0] = INFINITY;
  }
}

/* ---- splits ------------------------------------------------------------------------------ */

static inline int bin_at(const Primitive *p, int axis, float low, float scale) {
  int bin = (int)((p->low[axis] + p->high[axis] - low) * scale);
  return bin < 0 ? 0 : bin < BINS ? bin : BINS - 1;
}

typedef struct Bin {
  Box box;
  uint32_t count;
} Bin;

/* Returns area times tests of the sum. */
static float add_bin(Bin *sum, const Bin *bin) {
  extend(&sum->box, &bin->box);
  sum->count += bin->count;
  return sum->count ? area(&sum->box) * (float)((sum->count + VL_BVH_FOUR - 1) / VL_BVH_FOUR)
                    : INFINITY;
}

/* Decides whether a range becomes a leaf, and otherwise how it is split: along the axis along
 * which centres differ most. */
static void decide(const Builder *b, Range *r) {
  bool faces = r->kinds == 1 << VL_BVH_FOUR_STILL || r->kinds == 1 << VL_BVH_FOUR_MOVING;
  int axis = 0;
  for (int i = 1; i < 3; i++)
    if (r->centers.high[i] - r->centers.low[i] > r->centers.high[axis] - r->centers.low[axis])
      axis = i;
  float extent = r->centers.high[axis] - r->centers.low[axis], right[BINS], min = INFINITY;
  r->axis = -1;
  r->leaf = r->end - r->begin <= (faces ? VL_BVH_FOUR : 1);
  if (r->leaf || r->depth >= VL_BVH_DEPTH || !(extent >= 0x1p-100f))
    return;
  Bin bins[BINS + 1], sum = {empty_box(), 0};
  for (int k = 0; k <= BINS; k++)
    bins[k] = sum;
  r->low = r->centers.low[axis];
  r->scale = 0.9999f * BINS / extent;
  for (uint32_t i = r->begin; i < r->end; i++)
    add_bin(&bins[bin_at(&b->primitives[i], axis, r->low, r->scale)],
            &(Bin){b->primitives[i].box, 1});
  for (int k = BINS - 1; k > 0; k--)
    right[k] = add_bin(&sum, &bins[k]);
  sum = bins[BINS];
  for (int k = 1; k < BINS; k++) {
    float cost = add_bin(&sum, &bins[k - 1]) + right[k];
    if (!(cost < min))
      continue;
    min = cost;
    r->bin = k;
    r->axis = axis;
  }
}

static void add(Range *r, const Primitive *p) {
  Box center;
  for (int i = 0; i < 4; i++)
    center.low[i] = center.high[i] = p->box.low[i] + p->box.high[i];
  extend(&r->box, &p->box);
  extend(&r->centers, &center);
  r->kinds |= 1u << kind_of(p);
}

static void split(const Builder *b, const Range *r, Range half[2]) {
  Primitive *p = b->primitives;
  uint32_t i = r->begin, j = r->end, middle = i + (j - i) / 2;
  for (int k = 0; k < 2; k++)
    half[k] = (Range){.depth = r->depth + 1, .box = empty_box(), .centers = empty_box()};
  while (i < j) {
    bool left = r->axis < 0 ? i < middle : bin_at(&p[i], r->axis, r->low, r->scale) < r->bin;
    Primitive next = p[i];
    add(&half[!left], &next);
    if (left) {
      i++;
      continue;
    }
    p[i] = p[--j];
    p[j] = next;
  }
  half[0].begin = r->begin;
  half[0].end = half[1].begin = i;
  half[1].end = r->end;
  decide(b, &half[0]);
  decide(b, &half[1]);
}

/* Splits a range into up to eight. Those of at most `small` primitives stay whole. */
static uint32_t split_often(const Builder *b, const Range *range, uint32_t small,
                            Range to[VL_BVH_WIDTH]) {
  uint32_t count = 1;
  to[0] = *range;
  while (count < VL_BVH_WIDTH) {
    Range *largest = NULL, half[2];
    for (Range *r = to; r < to + count; r++)
      if (!r->leaf && r->end - r->begin > small &&
          (!largest || area(&r->box) > area(&largest->box)))
        largest = r;
    if (!largest)
      break;
    split(b, largest, half);
    *largest = half[0];
    to[count++] = half[1];
  }
  return count;
}

/* ---- nodes ------------------------------------------------------------------------------- */

/* Sets the boxes of child k. No ray meets the box of a null range; it is finite, for products
 * with 0. */
static void set_boxes(const Builder *b, vlBvhNode *node, uint32_t k, const Range *r) {
  bool moves = b->tree->moves;
  Box box[2] = {moves || !r ? empty_box() : r->box, empty_box()};
  for (uint32_t i = r ? r->begin : 0; moves && r && i < r->end; i++) {
    Box at[2];
    item_boxes(b, item_of(&b->primitives[i]), at);
    for (int time = 0; time < 2; time++)
      extend(&box[time], &at[time]);
  }
  for (int time = 0; time <= moves; time++) {
    vlBvhBoxes *boxes = time ? node->later : &node->boxes;
    for (int i = 0; i < 3; i++) {
      (*boxes)[2 * i][k] = fminf(box[time].low[i], 0x1p126f);
      (*boxes)[2 * i + 1][k] = fmaxf(box[time].high[i], -0x1p126f);
    }
  }
}

static bool make_leaf(Builder *b, Arena *arena, const Range *r, uintptr_t *child) {
  const Primitive *p = b->primitives + r->begin;
  vlBvhKind kind = kind_of(p);
  void *leaf = take(b, arena, kind == VL_BVH_OTHER ? sizeof(vlBvhItem) : sizeof(vlBvhFour));
  if (!leaf)
    return false;
  *child = (uintptr_t)leaf | kind;
  if (kind == VL_BVH_OTHER)
    *(vlBvhItem *)leaf = item_of(p);
  for (uint32_t k = 0; k < VL_BVH_FOUR && kind != VL_BVH_OTHER; k++) {
    vlBvhFour *four = leaf;
    vlBvhItem item = item_of(r->begin + k < r->end ? p + k : p);
    four->geometry[k] = item.geometry;
    four->primitive[k] = item.primitive;
    const vlWorldShape *s = shape_of(b, &item);
    vl_bvh_put_corners(s, item.primitive, 0, four, k);
  }
  return true;
}

/* Makes the tree of a range. apart: its small ranges become parts, whose trees are made
 * later. */
static bool make_tree(Builder *b, Arena *arena, const Range *range, bool apart,
                      uintptr_t *child) {
  if (apart && (is_stopped(b) || !VL_RESERVE(b->world->context, &b->parts, 1)))
    return false;
  if (apart && (range->leaf || range->end - range->begin <= b->part_size)) {
    b->parts.items[b->parts.count++] = (Part){*range, child};
    return true;
  }
  if (range->leaf)
    return make_leaf(b, arena, range, child);
  Range ranges[VL_BVH_WIDTH];
  uint32_t count = split_often(b, range, apart ? b->part_size : 1, ranges);
  vlBvhNode *node = take(b, arena, sizeof *node + (b->tree->moves ? sizeof node->later[0] : 0));
  if (!node)
    return false;
  *child = (uintptr_t)node;
  for (uint32_t k = 0; k < VL_BVH_WIDTH; k++) {
    node->child[k] = 0;
    set_boxes(b, node, k, k < count ? &ranges[k] : NULL);
    if (k < count && !make_tree(b, arena, &ranges[k], apart, &node->child[k]))
      return false;
  }
  return true;
}

static void make_part(void *user, uint32_t index, uint32_t worker) {
  Builder *b = user;
  const Part *part = &b->parts.items[index];
  if (!is_stopped(b) && !make_tree(b, &b->arenas[worker], &part->range, false, part->child))
    atomic_store(&b->failed, true);
}

/* False: out of memory, or stopped. */
static bool build(Builder *b) {
  vlContext *c = b->world->context;
  b->primitives = vl_alloc_array(c, (size_t)b->count + 1, sizeof *b->primitives);
  b->arenas = vl_alloc_zero(c, vl_context_threads(c), sizeof *b->arenas);
  if (!b->primitives || !b->arenas)
    return false;
  vlLoopDef loop = vl_loop_def(0, b->world->task->cancel);
  list_primitives(b);
  vl_parallel_for_at(c, &loop, (b->count + CHUNK - 1) / CHUNK, find_boxes, b);
  if (is_stopped(b))
    return false;
  Range all = {.box = empty_box(), .centers = empty_box()};
  for (uint32_t i = 0; i < b->count; i++) {
    if (!(b->primitives[i].low[0] <= b->primitives[i].high[0]))
      continue;
    b->primitives[all.end] = b->primitives[i];
    add(&all, &b->primitives[all.end++]);
  }
  if (all.end == 0)
    return true;
  decide(b, &all);
  b->part_size = all.end / 256 < CHUNK ? CHUNK : all.end / 256;
  for (int i = 0; i < 3; i++) {
    float low = b->tree->low[i] = all.box.low[i], high = b->tree->high[i] = all.box.high[i];
    b->tree->reach = fmaxf(b->tree->reach, fmaxf(-low, high));
  }
  if (!make_tree(b, &b->arenas[0], &all, true, &b->tree->root))
    return false;
  vl_parallel_for_at(c, &loop, (uint32_t)b->parts.count, make_part, b);
  return !is_stopped(b);
}

vlResult vl_bvh_make(const vlWorld *world, uint32_t group, vlBvh **tree, vlError *error) {
  vlContext *c = world->context;
  vlBvh *made = *tree = vl_alloc_zero(c, 1, sizeof *made);
  if (!made)
    return vl_fail_memory(error);
  atomic_init(&made->users, 1);
  Builder b = {.world = world, .group = group, .tree = made};
  uint64_t count = group == VL_NONE ? world->instances.count : 0;
  const vlWorldGroup *shapes = group == VL_NONE ? NULL : &world->groups.items[group];
  for (uint32_t i = 0; shapes && i < shapes->count; i++)
    count += world->shapes.items[shapes->shapes[i]].faces;
  if (!shapes)
    made->maps = vl_alloc_array(c, (size_t)count, sizeof *made->maps);
  for (uint64_t i = 0; made->maps && i < count; i++)
    vl_bvh_map(world->instances.items[i].from_group, made->maps[i]);
  b.count = (uint32_t)count;
  bool built = count < UINT32_MAX && (shapes || made->maps) && build(&b);
  VL_FREE(c, b.arenas, b.primitives);
  VL_ARRAY_FREE(c, &b.parts);
  if (built)
    return VL_OK;
  vl_bvh_release(c, made);
  *tree = NULL;
  VL_TRY(vl_world_step(world, NULL, 0, error));
  return vl_fail_memory(error);
}
