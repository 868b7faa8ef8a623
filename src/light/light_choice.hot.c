/* light/light_choice.hot.c: chooses a light for each lane of a batch. The lanes at one
 * node of the light tree descend together: the numbers of its children need not be gathered by
 * lane, and a node costs nothing for lanes that are elsewhere. The lanes make the same
 * decisions as vl_light_choose (light/light_tree.h), which explains them. */
#include <stddef.h>

#include "trace/stages.h"

enum { LIGHT_FIELD = 12, LEFT_FIELD = 13 };
_Static_assert(offsetof(vlLightNode, light) == LIGHT_FIELD * sizeof(float), "layout of a node");
_Static_assert(offsetof(vlLightNode, left) == LEFT_FIELD * sizeof(float), "layout of a node");

/* Lanes on their way down the tree: remaining random number, and probability of the way so
 * far. */
typedef struct Walk {
  uint32_t count;
  vlUintRow lane, node;
  vlFloatRow u, pmf;
} Walk;

/* Lanes at the same node: the last `count` of a walk. */
typedef struct Segment {
  uint32_t node, count;
} Segment;

enum { FEW = 8, SEGMENTS = VL_ROW_SIZE / FEW };

/* The lanes of `together` are a stack of segments of FEW lanes or more. `apart` has the lanes
 * at all other nodes. */
typedef struct Descent {
  const vlLightTree *tree;
  const vlSurface *f;
  vlLightSamples *out;
  float *rest;
  vlLanesByLight *by_light;
  uint32_t segment_count;
  Segment segments[SEGMENTS];
  Walk together, apart;
  Walk second; /* lanes that go to the second child */
  vlUintRow side;
} Descent;

/* By lane, what vl_light_tree_counts says. */
static void find_counts(const vlLightTree *tree, uint32_t n, const vlSurface *restrict f,
                        uint32_t *restrict counts) {
  uint32_t padded = VL_PAD(n);
  if (tree->node_count == 0 || tree->unbounded_count == 0) {
    for (uint32_t i = 0; i < padded; i++)
      counts[i] = tree->node_count > 0;
    return;
  }
  vlLightCluster root = vl_light_cluster((const float *)tree->nodes, 0);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    float side = f->side[i]; /* gcc's report names this line: tools/check_vectorised */
    vlReceiver at = vl_receiver(f, i);
    at.side = side;
    counts[i] = vl_light_importance(root, at) > 0.0f ? 1u : 0u;
  }
}

/* Lane i has arrived at its light. */
static inline void choose(Descent *d, uint32_t i, uint32_t light, float pmf, float rest) {
  d->out->light[i] = light;
  d->out->pmf[i] = pmf;
  d->rest[i] = rest;
  d->by_light->lane[d->by_light->count++] = i;
}

/* ---- one level --------------------------------------------------------------------------- */

/* One level of one lane's descent, from the node whose children are a and b. *second: 1 if the
 * lane goes to the second child. If neither child has importance, pmf becomes 0. */
typedef struct Step {
  float u, pmf;
} Step;
VL_INLINE Step step_down(vlLightCluster a, vlLightCluster b, vlReceiver at, float u0,
                         float pmf0, uint32_t *second) {
  float ia = vl_light_importance(a, at), ib = vl_light_importance(b, at);
  float sum = ia + ib, some = sum > 0.0f ? sum : 1.0f;
  float pa = ia / some, pb = 1.0f - pa;
  *second = u0 < pa ? 0u : 1u;
  float part = *second ? pb : pa, used = *second ? u0 - pa : u0;
  float chance = sum > 0.0f ? part : 0.0f, divisor = part > 0.0f ? part : 1.0f;
  return (Step){vl_min(used / divisor, VL_ONE_MINUS_EPSILON), pmf0 * chance};
}

/* One level from the node whose children are at `left`, for `count` lanes of the walk from
 * `first` on. */
static void step_together(const float *nodes, uint32_t left, uint32_t first, uint32_t count,
                          const vlSurface *restrict f, Walk *restrict w,
                          uint32_t *restrict side) {
  uint32_t at = left * VL_LIGHT_NODE_FLOATS, padded = VL_PAD(count);
  vlLightCluster a = vl_light_cluster(nodes, at),
                 b = vl_light_cluster(nodes, at + VL_LIGHT_NODE_FLOATS);
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = first; k < first + padded; k++) {
    uint32_t i = w->lane[k];
    Step s = step_down(a, b, vl_receiver(f, i), w->u[k], w->pmf[k], &side[k]);
    w->u[k] = s.u;
    w->pmf[k] = s.pmf;
  }
}

/* One level for all lanes of a walk, each from its own node. */
static void step_apart(const float *restrict nodes, const vlSurface *restrict f,
                       Walk *restrict w) {
  uint32_t padded = VL_PAD(w->count);
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < padded; k++) {
    uint32_t i = w->lane[k], second;
    uint32_t left = vl_float_bits(nodes[w->node[k] * VL_LIGHT_NODE_FLOATS + LEFT_FIELD]);
    uint32_t at = left * VL_LIGHT_NODE_FLOATS;
    Step s = step_down(vl_light_cluster(nodes, at),
                       vl_light_cluster(nodes, at + VL_LIGHT_NODE_FLOATS), vl_receiver(f, i),
                       w->u[k], w->pmf[k], &second);
    w->node[k] = left + second;
    w->u[k] = s.u;
    w->pmf[k] = s.pmf;
  }
}

/* ---- the descent ------------------------------------------------------------------------- */

/* Starts the descent. Lanes that choose a light without bounds are done; the others start at
 * the root. */
static void start(Descent *d, uint32_t n, const float *u, const uint32_t *counts) {
  const vlLightTree *tree = d->tree;
  uint32_t count = 0;
  Walk *w = &d->together;
  for (uint32_t i = 0; i < n; i++) {
    vlLightChoice c = {VL_INNER, 1.0f, u[i]};
    if (tree->unbounded_count)
      c = vl_light_choose_slot(tree, vl_receiver(d->f, i), counts[i] != 0, u[i]);
    bool beside = c.light != VL_INNER, none = !(c.pmf > 0.0f);
    d->out->light[i] = 0;
    d->out->pmf[i] = 0.0f; /* for lanes that no light reaches */
    if (beside)
      choose(d, i, c.light, c.pmf, c.rest);
    w->lane[count] = i;
    w->u[count] = c.rest;
    w->pmf[count] = c.pmf;
    count += !beside && !none;
  }
  w->count = count;
}

/* The last `count` lanes of the walk have arrived at a node, and leave the walk if it is a leaf
 * or they are few. */
static void arrive(Descent *d, uint32_t node, Walk *w, uint32_t count) {
  uint32_t light = d->tree->nodes[node].light, first = w->count - count;
  if (light != VL_INNER) {
    for (uint32_t k = first; k < w->count; k++)
      choose(d, w->lane[k], light, w->pmf[k], w->u[k]);
    w->count = first;
  } else if (count < FEW) {
    Walk *a = &d->apart;
    for (uint32_t k = first; k < w->count; k++, a->count++) {
      a->lane[a->count] = w->lane[k];
      a->node[a->count] = node;
      a->u[a->count] = w->u[k];
      a->pmf[a->count] = w->pmf[k];
    }
    w->count = first;
  } else {
    d->segments[d->segment_count++] = (Segment){node, count};
  }
}

/* Takes the last segment one level down. */
static void descend_together(Descent *d) {
  Segment s = d->segments[--d->segment_count];
  Walk *w = &d->together, *other = &d->second;
  uint32_t left = d->tree->nodes[s.node].left, last = w->count, first = last - s.count,
           a = first, b = 0;
  for (uint32_t k = last; k < first + VL_PAD(s.count); k++) {
    w->lane[k] = 0;
    w->u[k] = 0.0f;
    w->pmf[k] = 0.0f;
  }
  step_together((const float *)d->tree->nodes, left, first, s.count, d->f, w, d->side);
  for (uint32_t k = first; k < last; k++) { /* without branches, since the sides are random */
    uint32_t lane = w->lane[k], second = d->side[k], lit = w->pmf[k] > 0.0f;
    float u = w->u[k], pmf = w->pmf[k];
    w->lane[a] = other->lane[b] = lane;
    w->u[a] = other->u[b] = u;
    w->pmf[a] = other->pmf[b] = pmf;
    a += lit & ~second;
    b += lit & second;
  }
  w->count = a;
  arrive(d, left, w, a - first);
  for (uint32_t k = 0; k < b; k++, w->count++) {
    w->lane[w->count] = other->lane[k];
    w->u[w->count] = other->u[k];
    w->pmf[w->count] = other->pmf[k];
  }
  arrive(d, left + 1, w, b);
}

/* Takes all lanes that are apart one level down. */
static void descend_apart(Descent *d) {
  Walk *w = &d->apart;
  uint32_t count = 0;
  for (uint32_t k = w->count; k < VL_PAD(w->count); k++) {
    w->lane[k] = w->node[k] = 0;
    w->u[k] = 0.0f;
    w->pmf[k] = 0.0f;
  }
  step_apart((const float *)d->tree->nodes, d->f, w);
  for (uint32_t k = 0; k < w->count; k++) {
    uint32_t i = w->lane[k], light = d->tree->nodes[w->node[k]].light;
    if (!(w->pmf[k] > 0.0f))
      continue;
    if (light != VL_INNER)
      choose(d, i, light, w->pmf[k], w->u[k]);
    w->lane[count] = i;
    w->node[count] = w->node[k];
    w->u[count] = w->u[k];
    w->pmf[count] = w->pmf[k];
    count += light == VL_INNER;
  }
  w->count = count;
}

void vl_stage_light_choice(const vlLightTree *tree, uint32_t n, const vlSurface *f,
                           const float *u, vlLightSamples *out, float *rest,
                           vlLanesByLight *by_light) {
  vlUintRow counts;
  by_light->count = 0;
  if (tree->kind == VL_LIGHT_SAMPLER_BVH)
    find_counts(tree, n, f, counts);
  if (tree->kind != VL_LIGHT_SAMPLER_BVH || tree->node_count < 3) { /* no tree to descend */
    for (uint32_t i = 0; i < n; i++) {
      bool in_tree = tree->kind == VL_LIGHT_SAMPLER_BVH && counts[i] != 0;
      vlLightChoice c = vl_light_choose(tree, vl_receiver(f, i), in_tree, u[i]);
      out->light[i] = c.light;
      out->pmf[i] = c.pmf;
      rest[i] = c.rest;
      if (c.pmf > 0.0f)
        by_light->lane[by_light->count++] = i;
    }
    return;
  }
  Descent d;
  d.tree = tree;
  d.f = f;
  d.out = out;
  d.rest = rest;
  d.by_light = by_light;
  d.segment_count = d.apart.count = 0;
  start(&d, n, u, counts);
  arrive(&d, 0, &d.together, d.together.count);
  while (d.segment_count)
    descend_together(&d);
  while (d.apart.count >= FEW)
    descend_apart(&d);
  for (uint32_t k = 0; k < d.apart.count; k++) { /* the last few lanes one by one */
    const Walk *w = &d.apart;
    uint32_t i = w->lane[k];
    vlLightChoice c =
        vl_light_walk(tree, tree->nodes + w->node[k], vl_receiver(f, i), w->u[k], w->pmf[k]);
    if (c.pmf > 0.0f)
      choose(&d, i, c.light, c.pmf, c.rest);
  }
}
