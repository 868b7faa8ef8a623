/* light/light_tree_build.c: builds the light tree top down by the
 * surface-area-orientation cost (pbrt book 12.6.3). */
#include "light/light_tree.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "light/light_kind.h"
#include "light/spread.h"
#include "math/approx_double.h"
#include "shape/surface_point.h"
#include "velo/shape_kinds.h"
#include "world/world.h"

enum { BUCKETS = 12, MAX_DEPTH = 60 };

typedef struct Item {
  vlLightBounds bounds;
  uint32_t light;
} Item;

typedef struct Cone {
  vlVec3 axis;
  float cos_o;
  bool empty;
} Cone;

/* acosf and cosf differ between C libraries; these functions give the same bits everywhere. */
static float arccos(float x) {
  return (float)vl_acos_double((double)x);
}

static float cosine(float x) {
  return (float)vl_sincos_double((double)x).cos;
}

static Cone cone_union(Cone a, Cone b) {
  if (a.empty)
    return b;
  if (b.empty)
    return a;
  /* Frequent, cheap cases with the same results as below: one cone is the whole sphere, or b's
   * direction lies in a. */
  if (a.cos_o <= -1)
    return a;
  if (b.cos_o <= -1)
    return b;
  if (b.cos_o >= 1 && vl_dot(a.axis, b.axis) >= a.cos_o)
    return a;
  float ta = arccos(vl_clamp(a.cos_o, -1, 1)), tb = arccos(vl_clamp(b.cos_o, -1, 1));
  float td = arccos(vl_clamp(vl_dot(a.axis, b.axis), -1, 1));
  if (fminf(td + tb, VL_PI) <= ta)
    return a;
  if (fminf(td + ta, VL_PI) <= tb)
    return b;
  float to = (ta + td + tb) / 2;
  Cone all = {a.axis, -1, false};
  if (to >= VL_PI)
    return all;
  vlVec3 axis = vl_cross(a.axis, b.axis);
  if (!(vl_length2(axis) > 0))
    return all;
  axis = vl_normalize(axis);
  /* rotate a's axis towards b's (Rodrigues; axis is normal to it) */
  float turn = to - ta, s = (float)vl_sincos_double(turn).sin, c = cosine(turn);
  vlVec3 w = vl_add(vl_mul(a.axis, c), vl_mul(vl_cross(axis, a.axis), s));
  return (Cone){vl_normalize(w), cosine(to), false};
}

/* Extends a to bound both a and b. It works in place and by comparisons, because most of the
 * build's time is spent here. */
static void absorb(vlLightBounds *a, const vlLightBounds *b) {
  if (b->power == 0)
    return;
  if (a->power == 0) {
    *a = *b;
    return;
  }
  for (int i = 0; i < 3; i++) {
    a->low[i] = b->low[i] < a->low[i] ? b->low[i] : a->low[i];
    a->high[i] = b->high[i] > a->high[i] ? b->high[i] : a->high[i];
  }
  if (a->cos_o > -1) { /* otherwise a's cone is the whole sphere already */
    Cone ca = {vl_load3(a->axis), a->cos_o, false};
    Cone cb = {vl_load3(b->axis), b->cos_o, false};
    Cone c = cone_union(ca, cb);
    vl_store3(a->axis, c.axis);
    a->cos_o = c.cos_o;
  }
  a->cos_e = b->cos_e < a->cos_e ? b->cos_e : a->cos_e;
  a->power = a->power + b->power;
  a->two_sided = a->two_sided || b->two_sided;
}

static float cost_of(const vlLightBounds *b, const float parent_low[3],
                     const float parent_high[3], int dimension) {
  if (b->power == 0)
    return 0;
  float to = arccos(vl_clamp(b->cos_o, -1, 1)), te = arccos(vl_clamp(b->cos_e, -1, 1));
  float tw = fminf(to + te, VL_PI), sin_o = sqrtf(fmaxf(0, 1 - b->cos_o * b->cos_o));
  float orientation =
      2 * VL_PI * (1 - b->cos_o) +
      VL_PI / 2 * (2 * tw * sin_o - cosine(to - 2 * tw) - 2 * to * sin_o + b->cos_o);
  float d[3], longest = 0;
  for (int i = 0; i < 3; i++) {
    d[i] = b->high[i] - b->low[i];
    longest = fmaxf(longest, parent_high[i] - parent_low[i]);
  }
  float area = 2 * (d[0] * d[1] + d[1] * d[2] + d[2] * d[0]);
  float extent = parent_high[dimension] - parent_low[dimension];
  float regular = extent > 0 ? longest / extent : 0;
  return b->power * orientation * regular * area;
}

static void node_from_bounds(const vlLightBounds *b, vlLightNode *node) {
  memset(node, 0, sizeof *node);
  float d2 = 0;
  for (int i = 0; i < 3; i++) {
    node->low[i] = b->low[i];
    node->high[i] = b->high[i];
    node->center[i] = 0.5f * (b->low[i] + b->high[i]);
    float d = b->high[i] - b->low[i];
    d2 += d * d;
    node->axis[i] = b->axis[i];
  }
  node->half_diagonal = 0.5f * sqrtf(d2);
  node->cos_o = b->cos_o;
  node->sin_o = sqrtf(fmaxf(0, 1 - b->cos_o * b->cos_o));
  node->cos_e = b->cos_e;
  node->power = b->power;
  node->two_sided = b->two_sided;
}

typedef struct Builder {
  vlLightTree *tree;
  uint32_t next;
} Builder;

static float centroid(const Item *item, int dimension) {
  return 0.5f * (item->bounds.low[dimension] + item->bounds.high[dimension]);
}

/* The bucket of an item between the bounds low and high of all centroids. */
static int bucket_of(const Item *item, int k, const float low[3], const float high[3]) {
  int b = (int)(BUCKETS * (centroid(item, k) - low[k]) / (high[k] - low[k]));
  return b < 0 ? 0 : b >= BUCKETS ? BUCKETS - 1 : b;
}

/* Partitions items so that the first part is [0, result); 0 < result < count. */
static uint32_t split_items(Item *items, uint32_t count, const vlLightBounds *all) {
  float clow[3] = {INFINITY, INFINITY, INFINITY}, chigh[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) {
      float c = centroid(&items[i], k);
      clow[k] = c < clow[k] ? c : clow[k];
      chigh[k] = c > chigh[k] ? c : chigh[k];
    }
  float best = INFINITY;
  int best_dimension = -1, best_bucket = 0;
  for (int k = 0; k < 3; k++) {
    if (!(chigh[k] > clow[k]))
      continue;
    vlLightBounds buckets[BUCKETS];
    memset(buckets, 0, sizeof buckets);
    for (uint32_t i = 0; i < count; i++)
      absorb(&buckets[bucket_of(&items[i], k, clow, chigh)], &items[i].bounds);
    /* most nodes are small and fill two or three buckets */
    int filled[BUCKETS] = {0}, fill_count = 0;
    for (int b = 0; b < BUCKETS; b++)
      if (buckets[b].power != 0)
        filled[fill_count++] = b;
    vlLightBounds left = buckets[fill_count ? filled[0] : 0];
    for (int s = 0; s + 1 < fill_count; s++) {
      if (s > 0)
        absorb(&left, &buckets[filled[s]]);
      vlLightBounds right = buckets[filled[s + 1]];
      for (int b = s + 2; b < fill_count; b++)
        absorb(&right, &buckets[filled[b]]);
      float cost =
          cost_of(&left, all->low, all->high, k) + cost_of(&right, all->low, all->high, k);
      if (cost < best) {
        best = cost;
        best_dimension = k;
        best_bucket = filled[s];
      }
    }
  }
  if (best_dimension < 0)
    return count / 2;
  uint32_t middle = 0;
  for (uint32_t i = 0; i < count; i++) {
    if (bucket_of(&items[i], best_dimension, clow, chigh) > best_bucket)
      continue;
    Item t = items[i];
    items[i] = items[middle];
    items[middle++] = t;
  }
  return middle == 0 || middle == count ? count / 2 : middle;
}

static vlLightBounds build_node(Builder *b, uint32_t at, Item *items, uint32_t count,
                                uint64_t trail, uint32_t depth) {
  vlLightNode *node = &b->tree->nodes[at];
  if (count == 1) {
    node_from_bounds(&items[0].bounds, node);
    node->light = items[0].light;
    b->tree->trails[items[0].light] = trail;
    return items[0].bounds;
  }
  vlLightBounds all = items[0].bounds;
  for (uint32_t i = 1; i < count; i++)
    absorb(&all, &items[i].bounds);
  /* Trails have 64 bits. Beyond a certain depth nodes are split at the median, which bounds the
   * depth. */
  uint32_t middle = depth > MAX_DEPTH - 34 ? count / 2 : split_items(items, count, &all);
  uint32_t left = b->next;
  b->next += 2;
  build_node(b, left, items, middle, trail, depth + 1);
  build_node(b, left + 1, items + middle, count - middle, trail | 1ull << depth, depth + 1);
  node_from_bounds(&all, node);
  node->light = VL_INNER;
  node->left = left;
  return all;
}

static void light_bounds(const vlWorld *world, const vlWorldLight *light, vlLightBounds *b) {
  memset(b, 0, sizeof *b);
  b->power = light->power;
  for (int i = 0; i < 3; i++) {
    b->low[i] = b->high[i] = light->position[i];
    b->axis[i] = i == 2;
  }
  b->cos_o = -1; /* point lights emit in all directions */
  b->cos_e = 0;
  if (light->has_cone) {
    memcpy(b->axis, light->direction, 3 * sizeof *b->axis);
    float to = arccos(light->cos_start), te = arccos(light->cos_end);
    b->cos_o = light->cos_start;
    /* 0.999 gives a hard edge some width, for rounding */
    b->cos_e = fminf(cosine(te - to), 0.999f);
  }
  if (light->shape != VL_NONE) {
    const vlWorldShape *shape = &world->shapes.items[light->shape];
    vl_world_prim_bounds(shape, light->prim, b->low, b->high);
    b->two_sided = world->emitted.items[light->emitted].two_sided;
    const vlEmitted *e = &world->emitted.items[light->emitted];
    b->cos_e = vl_has_spread(e) ? fminf(sqrtf(1 - e->spread_sin2), 0.999f) : 0;
    b->cos_o = -1;
    if (shape->triangles || shape->kind == VL_SHAPE_DISK) {
      b->cos_o = 1;
      memcpy(b->axis, light->direction, 3 * sizeof *b->axis);
    }
  }
}

static vlResult build_cdf(vlWorld *world, vlLightTree *tree, vlError *error) {
  if (!(tree->cdf = vl_world_block(world, tree->light_count + 1, sizeof(float))))
    return vl_fail_memory(error);
  double total = 0, sum = 0;
  for (uint32_t i = 0; i < tree->light_count; i++)
    total += tree->kind == VL_LIGHT_SAMPLER_POWER ? world->lights.items[i].power : 1;
  tree->cdf[0] = 0;
  for (uint32_t i = 0; i < tree->light_count; i++) {
    sum +=
        total > 0
            ? (tree->kind == VL_LIGHT_SAMPLER_POWER ? world->lights.items[i].power : 1) / total
            : 1.0 / tree->light_count;
    tree->cdf[i + 1] = (float)sum;
  }
  tree->cdf[tree->light_count] = 1;
  return VL_OK;
}

vlResult vl_light_tree_build(vlWorld *world, vlError *error) {
  vlLightTree *tree = &world->tree;
  memset(tree, 0, sizeof *tree);
  tree->kind = world->def.light_sampler;
  tree->light_count = (uint32_t)world->lights.count;
  if (tree->light_count == 0)
    return VL_OK;
  if (tree->kind != VL_LIGHT_SAMPLER_BVH)
    return build_cdf(world, tree, error);
  uint32_t n = tree->light_count;
  tree->trails = vl_world_block(world, n, sizeof(uint64_t));
  tree->unbounded = vl_world_block(world, n, sizeof(uint32_t));
  tree->towards = vl_world_block(world, n, sizeof *tree->towards);
  tree->slot = vl_world_block(world, n, sizeof(uint32_t));
  Item *items = vl_alloc_array(world->context, n, sizeof *items);
  if (!tree->trails || !tree->unbounded || !tree->towards || !tree->slot || !items) {
    vl_free(world->context, items);
    return vl_fail_memory(error);
  }
  uint32_t bounded = 0;
  for (uint32_t i = 0; i < n; i++) {
    const vlWorldLight *light = &world->lights.items[i];
    tree->slot[i] = VL_INNER;
    tree->trails[i] = 0;
    if (light->far) {
      tree->slot[i] = tree->unbounded_count;
      bool one_way = light->kind == VL_LIGHT_DISTANT;
      tree->distant_count += one_way;
      for (int k = 0; k < 3; k++)
        tree->towards[tree->unbounded_count][k] = one_way ? light->direction[k] : 0;
      tree->unbounded[tree->unbounded_count++] = i;
    } else {
      light_bounds(world, light, &items[bounded].bounds);
      items[bounded++].light = i;
    }
  }
  vlResult r = VL_OK;
  if (bounded) {
    tree->nodes = vl_world_block(world, 2 * (size_t)bounded, sizeof(vlLightNode));
    if (!tree->nodes) {
      r = vl_fail_memory(error);
    } else {
      Builder b = {tree, 1};
      build_node(&b, 0, items, bounded, 0, 0);
      tree->node_count = b.next;
    }
  }
  vl_free(world->context, items);
  return r;
}
