/* light/light_tree.h: chooses a light by a binary tree over all bounded lights. At each
 * node, a branch is chosen in proportion to its importance for the point that receives light
 * (Conty Estevez and Kulla 2018; pbrt book 12.6.3). Lights without bounds (distant, infinite)
 * are outside the tree; each that reaches the point has one slot, and so has the tree.
 * light_tree_build.c builds the tree; traversal is inline, for the hot loops. */
#ifndef LIGHT_LIGHT_TREE_H
#define LIGHT_LIGHT_TREE_H

#include "base/attributes.h"
#include "math/vec.h"
#include "math/warp.h"
#include "velo/world.h"

/* Bounds of the light that a set of lights emits: position, cone of directions, power. */
typedef struct vlLightBounds {
  float low[3], high[3];
  float axis[3];
  float cos_o; /* cosine of the half angle of the cone around axis that contains all normals */
  float cos_e; /* cosine of the largest angle between a normal and an emitted direction */
  float power;
  bool two_sided;
} vlLightBounds;

typedef struct vlLightNode {
  float center[3];
  float half_diagonal; /* half the diagonal of the bounding box */
  float axis[3];
  float cos_o, sin_o, cos_e;
  float power;
  float two_sided; /* 1 or 0 */
  uint32_t light;  /* of a leaf: index of the light; VL_INNER: an inner node with children at
                      left and left + 1 */
  uint32_t left;
  float low[3], high[3];
} vlLightNode;
#define VL_INNER 0xffffffffu

typedef struct vlLightTree {
  vlLightSampler kind;
  vlLightNode *nodes;
  uint32_t node_count;
  uint64_t *trails; /* per light: the branches from the root to its leaf, one bit each, lowest
                       bit first */
  uint32_t light_count;
  uint32_t *unbounded; /* lights outside the tree */
  uint32_t unbounded_count;
  uint32_t distant_count; /* of them: those that shine from one direction */
  float (*towards)[3];    /* per light outside the tree: the one direction from which it shines;
                             zero: from all */
  uint32_t *slot;         /* per light: index in unbounded, or VL_INNER */
  /* for selection by power and uniform selection: cumulative distribution, light_count + 1
   * values */
  float *cdf;
} vlLightTree;

vlResult vl_light_tree_build(struct vlWorld *world, vlError *error);

/* The members of a node on which its importance depends. Nodes are read as rows of floats, so
 * that a batch can gather them. */
enum { VL_LIGHT_NODE_FLOATS = sizeof(vlLightNode) / sizeof(float) };
typedef struct vlLightCluster {
  float cx, cy, cz, half_diagonal, ax, ay, az, cos_o, sin_o, cos_e, power, two_sided;
} vlLightCluster;
static inline vlLightCluster vl_light_cluster(const float *nodes, uint32_t at) {
  return (vlLightCluster){nodes[at],     nodes[at + 1], nodes[at + 2],  nodes[at + 3],
                          nodes[at + 4], nodes[at + 5], nodes[at + 6],  nodes[at + 7],
                          nodes[at + 8], nodes[at + 9], nodes[at + 10], nodes[at + 11]};
}

/* What receives light: a point, and which lights count there. The same numbers must describe a
 * point where a light is chosen and where the probability of the choice is computed. */
typedef struct vlReceiver {
  vlVec3 p;
  vlVec3 n; /* normal; zero vector: none, light from all directions counts equally */
  /* 1 or -1: only light on the side of n or -n counts; 0: on both (vlSurface.side) */
  float side;
} vlReceiver;

/* Importance of a node for a receiver. Free of branches, so that loops over batches
 * vectorise. */
VL_INLINE float vl_light_importance(vlLightCluster b, vlReceiver at) {
  vlVec3 p = at.p, n = at.n;
  vlVec3 to = vl_sub(p, vl_vec3(b.cx, b.cy, b.cz));
  float d2 = vl_length2(to);
  float r = b.half_diagonal;
  /* squared distance, limited from below as in the pbrt book */
  float d2_limited = vl_max(d2, r);
  vlVec3 wi = vl_normalize(to);
  float cos_w = vl_dot(vl_vec3(b.ax, b.ay, b.az), wi);
  cos_w = b.two_sided > 0.0f ? vl_abs(cos_w) : cos_w;
  float sin_w = vl_safe_sqrt(1.0f - cos_w * cos_w);
  /* theta_b, the angle that the bounds subtend at p. It covers the full sphere if p is inside
   * the bounding sphere of the bounds. */
  float inside = d2 > r * r ? 0.0f : 1.0f;
  float sin2_b = r * r / vl_max(d2, VL_MIN_NORMAL);
  float cos_b = vl_safe_sqrt(1.0f - sin2_b), sin_b = __builtin_sqrtf(sin2_b);
  cos_b = inside > 0.0f ? -1.0f : cos_b;
  sin_b = inside > 0.0f ? 0.0f : sin_b;
  /* theta_x = max(0, theta_w - theta_o), theta_p = max(0, theta_x - theta_b), by differences of
   * cosines. */
  float cos_x = cos_w * b.cos_o + sin_w * b.sin_o, sin_x = sin_w * b.cos_o - cos_w * b.sin_o;
  sin_x = cos_w > b.cos_o ? 0.0f : sin_x;
  cos_x = cos_w > b.cos_o ? 1.0f : cos_x;
  float cos_p = cos_x * cos_b + sin_x * sin_b;
  cos_p = cos_x > cos_b ? 1.0f : cos_p;
  float importance = b.power * cos_p / d2_limited;
  float has_n = vl_abs(n.x) + vl_abs(n.y) + vl_abs(n.z);
  float cos_n = vl_dot(wi, n);
  float cos_i = at.side != 0.0f ? -at.side * cos_n : vl_abs(cos_n);
  float sin_i = vl_safe_sqrt(1.0f - cos_i * cos_i);
  float turned = vl_max(0.0f, cos_i * cos_b + sin_i * sin_b);
  turned = cos_i > cos_b ? 1.0f : turned;
  importance *= has_n > 0.0f ? turned : 1.0f;
  importance = cos_p > b.cos_e ? importance : 0.0f;
  return importance > 0.0f && importance < VL_INFINITY ? importance : 0.0f;
}
static inline float vl_light_node_importance(const vlLightNode *node, vlReceiver at) {
  return vl_light_importance(vl_light_cluster((const float *)node, 0), at);
}

typedef struct vlLightChoice {
  uint32_t light; /* index of the light; VL_INNER: no light */
  float pmf;
  float rest; /* the position of u in the light's part of [0, 1): uniform again */
} vlLightChoice;

static inline vlLightChoice vl_light_choose_cdf(const vlLightTree *tree, float u) {
  uint32_t i = vl_find_interval(tree->cdf, tree->light_count, u);
  float pmf = tree->cdf[i + 1] - tree->cdf[i];
  return (vlLightChoice){i, pmf, vl_min((u - tree->cdf[i]) / pmf, VL_ONE_MINUS_EPSILON)};
}

/* Traverses the tree from an inner node that was reached with probability pmf; the random
 * number u in [0, 1) is rescaled and reused at each level. */
static inline vlLightChoice vl_light_walk(const vlLightTree *tree, const vlLightNode *node,
                                          vlReceiver at, float u, float pmf) {
  while (node->light == VL_INNER) {
    const vlLightNode *a = tree->nodes + node->left, *b = a + 1;
    float ia = vl_light_node_importance(a, at), ib = vl_light_node_importance(b, at);
    if (!(ia + ib > 0.0f))
      return (vlLightChoice){VL_INNER, 0.0f, 0.0f};
    float pa = ia / (ia + ib);
    bool left = u < pa;
    float part = left ? pa : 1.0f - pa;
    u = vl_min((left ? u : u - pa) / part, VL_ONE_MINUS_EPSILON);
    pmf *= part;
    node = left ? a : b;
  }
  return (vlLightChoice){node->light, pmf, u};
}

/* Whether light k of those outside the tree can count at a receiver. Directions that lie on the
 * surface may count: the BSDF rounds their cosine in another way. */
static inline bool vl_light_reaches(const vlLightTree *tree, uint32_t k, vlReceiver at) {
  const float *w = tree->towards[k];
  bool everywhere = w[0] == 0.0f && w[1] == 0.0f && w[2] == 0.0f;
  return everywhere || at.side == 0.0f || at.side * vl_dot(at.n, vl_load3(w)) > -0x1p-12f;
}

/* The lights outside the tree that reach a receiver, and the tree if any of its lights does:
 * each has the same chance. */
typedef struct vlLightSlots {
  uint32_t outside;
  bool tree;
} vlLightSlots;
/* Whether the tree is one of the slots. Without lights outside it, it is the only one. */
static inline bool vl_light_tree_counts(const vlLightTree *tree, vlReceiver at) {
  return tree->node_count > 0 &&
         (!tree->unbounded_count || vl_light_node_importance(tree->nodes, at) > 0.0f);
}
/* counts: what vl_light_tree_counts says. */
static inline vlLightSlots vl_light_slots(const vlLightTree *tree, vlReceiver at, bool counts) {
  vlLightSlots r = {0, counts};
  if (!tree->distant_count)
    r.outside = tree->unbounded_count;
  for (uint32_t k = 0; tree->distant_count && k < tree->unbounded_count; k++)
    r.outside += vl_light_reaches(tree, k, at);
  return r;
}

/* Chooses a light outside the tree, or the tree (light: VL_INNER). pmf 0: no light counts.
 * counts: as above. */
static inline vlLightChoice vl_light_choose_slot(const vlLightTree *tree, vlReceiver at,
                                                 bool counts, float u) {
  vlLightSlots slots = vl_light_slots(tree, at, counts);
  uint32_t count = slots.outside + slots.tree, wanted, last = count ? count - 1 : 0;
  if (count == 0)
    return (vlLightChoice){VL_INNER, 0.0f, 0.0f};
  wanted = (uint32_t)(int32_t)(u * (float)count);
  wanted = wanted < last ? wanted : last;
  vlLightChoice r = {VL_INNER, 1.0f / (float)count,
                     vl_min(u * (float)count - (float)wanted, VL_ONE_MINUS_EPSILON)};
  if (!tree->distant_count && wanted < slots.outside) {
    r.light = tree->unbounded[wanted];
    return r;
  }
  for (uint32_t k = 0, seen = 0; wanted < slots.outside && k < tree->unbounded_count; k++)
    if (vl_light_reaches(tree, k, at) && seen++ == wanted)
      r.light = tree->unbounded[k];
  return r;
}

/* counts: what vl_light_tree_counts says, computed for many receivers at once. */
static inline vlLightChoice vl_light_choose(const vlLightTree *tree, vlReceiver at, bool counts,
                                            float u) {
  vlLightChoice none = {VL_INNER, 0.0f, 0.0f};
  if (tree->light_count == 0)
    return none;
  if (tree->kind != VL_LIGHT_SAMPLER_BVH)
    return vl_light_choose_cdf(tree, u);
  vlLightChoice slot = vl_light_choose_slot(tree, at, counts, u);
  if (slot.light != VL_INNER || !(slot.pmf > 0.0f))
    return slot;
  const vlLightNode *root = tree->nodes;
  /* beside lights outside the tree, the root's importance is one of the slots */
  if (!tree->unbounded_count && root->light != VL_INNER &&
      !(vl_light_node_importance(root, at) > 0.0f))
    return none;
  return vl_light_walk(tree, root, at, slot.rest, slot.pmf);
}

/* Probability with which vl_light_choose picks this light. */
static inline float vl_light_pmf(const vlLightTree *tree, vlReceiver at, uint32_t light) {
  if (tree->kind != VL_LIGHT_SAMPLER_BVH)
    return tree->cdf[light + 1] - tree->cdf[light];
  vlLightSlots slots = vl_light_slots(tree, at, vl_light_tree_counts(tree, at));
  uint32_t count = slots.outside + slots.tree;
  float pmf = count ? 1.0f / (float)count : 0.0f;
  if (tree->slot[light] != VL_INNER)
    return vl_light_reaches(tree, tree->slot[light], at) ? pmf : 0.0f;
  if (!slots.tree)
    return 0.0f;
  uint64_t trail = tree->trails[light];
  const vlLightNode *node = tree->nodes;
  if (node->light != VL_INNER)
    return tree->unbounded_count || vl_light_node_importance(node, at) > 0.0f ? pmf : 0.0f;
  while (node->light == VL_INNER) {
    const vlLightNode *a = tree->nodes + node->left, *b = a + 1;
    float ia = vl_light_node_importance(a, at), ib = vl_light_node_importance(b, at);
    float pa = ia + ib > 0.0f ? ia / (ia + ib) : 0.0f;
    float pb = ia + ib > 0.0f ? 1.0f - pa : 0.0f;
    pmf *= trail & 1 ? pb : pa;
    node = trail & 1 ? b : a;
    trail >>= 1;
  }
  return pmf;
}

#endif
