/* world/light_tree.h: choosing a light: a binary tree over all bounded lights, walked with the importance that each
 * branch has for the point to be lit (Conty Estevez and Kulla 2018; pbrt book 12.6.3). Lights without bounds (distant,
 * infinite) share one slot each beside the tree. Building: light_tree.c; walking: inline, for the hot loops. */
#ifndef WORLD_LIGHT_TREE_H
#define WORLD_LIGHT_TREE_H

#include "math/vec.h"
#include "velo/render.h"

/* What a set of lights sends out: from where, in which cone of directions, how much. */
typedef struct vlLightBounds {
  float low[3], high[3];
  float axis[3];
  float cos_o; /* cosine of the cone of normals round axis */
  float cos_e; /* cosine of how far beyond a normal light goes */
  float power;
  bool two_sided;
} vlLightBounds;

typedef struct vlLightNode {
  float center[3];
  float half_diagonal; /* of the bounds */
  float axis[3];
  float cos_o, sin_o, cos_e;
  float power;
  uint32_t two_sided;
  uint32_t light; /* leaf: index of the light; VL_INNER: children at left and left + 1 */
  uint32_t left;
  float low[3], high[3];
} vlLightNode;
#define VL_INNER 0xffffffffu

typedef struct vlLightTree {
  vlLightSampler kind;
  vlLightNode *nodes;
  uint32_t node_count;
  uint64_t *trails; /* per light: left/right decisions from the root, lowest bit first */
  uint32_t light_count;
  uint32_t *unbounded; /* lights beside the tree */
  uint32_t unbounded_count;
  uint32_t *slot; /* per light: index in unbounded, or VL_INNER */
  float *cdf;     /* power and uniform: light_count + 1 */
} vlLightTree;

vlResult vl_light_tree_build(struct vlWorld *world, vlError *error);

/* Importance of a node for a point p with normal n (zero vector: none). */
static inline float vl_light_importance(const vlLightNode *b, vlVec3 p, vlVec3 n) {
  vlVec3 center = vl_vec3(b->center[0], b->center[1], b->center[2]);
  vlVec3 to = vl_sub(p, center);
  float d2 = vl_length2(to);
  float r = b->half_diagonal;
  float d2_limited = vl_max(d2, r); /* as in the book: not less than half the diagonal */
  vlVec3 wi = vl_normalize(to);
  float cos_w = vl_dot(vl_vec3(b->axis[0], b->axis[1], b->axis[2]), wi);
  if (b->two_sided) cos_w = vl_abs(cos_w);
  float sin_w = __builtin_sqrtf(vl_max(0.0f, 1.0f - cos_w * cos_w));
  /* Angle that the bounds subtend at p: everything, when p is inside their sphere. */
  float sin2_b = d2 > r * r ? r * r / d2 : 1.0f;
  float cos_b = d2 > r * r ? __builtin_sqrtf(vl_max(0.0f, 1.0f - sin2_b)) : -1.0f;
  float sin_b = d2 > r * r ? __builtin_sqrtf(sin2_b) : 0.0f;
  /* theta_x = max(0, theta_w - theta_o), theta_p = max(0, theta_x - theta_b), by differences of cosines. */
  float cos_x = cos_w > b->cos_o ? 1.0f : cos_w * b->cos_o + sin_w * b->sin_o;
  float sin_x = cos_w > b->cos_o ? 0.0f : sin_w * b->cos_o - cos_w * b->sin_o;
  float cos_p = cos_x > cos_b ? 1.0f : cos_x * cos_b + sin_x * sin_b;
  if (cos_p <= b->cos_e) return 0.0f;
  float importance = b->power * cos_p / d2_limited;
  if (n.x != 0.0f || n.y != 0.0f || n.z != 0.0f) {
    float cos_i = vl_abs(vl_dot(wi, n));
    float sin_i = __builtin_sqrtf(vl_max(0.0f, 1.0f - cos_i * cos_i));
    importance *= cos_i > cos_b ? 1.0f : vl_max(0.0f, cos_i * cos_b + sin_i * sin_b);
  }
  return vl_max(importance, 0.0f);
}

typedef struct vlLightChoice {
  uint32_t light; /* VL_INNER: none */
  float pmf;
} vlLightChoice;

static inline vlLightChoice vl_light_choose_cdf(const vlLightTree *tree, float u) {
  uint32_t low = 0, high = tree->light_count; /* cdf[low] <= u < cdf[high] */
  while (high - low > 1) {
    uint32_t mid = (low + high) / 2;
    if (tree->cdf[mid] <= u)
      low = mid;
    else
      high = mid;
  }
  return (vlLightChoice){low, tree->cdf[low + 1] - tree->cdf[low]};
}

static inline vlLightChoice vl_light_choose(const vlLightTree *tree, vlVec3 p, vlVec3 n, float u) {
  vlLightChoice none = {VL_INNER, 0.0f};
  if (tree->light_count == 0) return none;
  if (tree->kind != VL_LIGHT_SAMPLER_BVH) return vl_light_choose_cdf(tree, u);
  uint32_t slots = tree->unbounded_count + (tree->node_count ? 1 : 0);
  float p_unbounded = (float)tree->unbounded_count / (float)slots;
  if (u < p_unbounded) {
    uint32_t i = (uint32_t)(u * (float)slots);
    i = i < tree->unbounded_count ? i : tree->unbounded_count - 1;
    return (vlLightChoice){tree->unbounded[i], 1.0f / (float)slots};
  }
  if (!tree->node_count) return none;
  u = vl_min((u - p_unbounded) / (1.0f - p_unbounded), VL_ONE_MINUS_EPSILON);
  float pmf = 1.0f / (float)slots;
  const vlLightNode *node = tree->nodes;
  if (node->light != VL_INNER) return vl_light_importance(node, p, n) > 0.0f ? (vlLightChoice){node->light, pmf} : none;
  while (node->light == VL_INNER) {
    const vlLightNode *a = tree->nodes + node->left, *b = a + 1;
    float ia = vl_light_importance(a, p, n), ib = vl_light_importance(b, p, n);
    if (!(ia + ib > 0.0f)) return none;
    float pa = ia / (ia + ib);
    if (u < pa) {
      u = vl_min(u / pa, VL_ONE_MINUS_EPSILON);
      pmf *= pa;
      node = a;
    } else {
      u = vl_min((u - pa) / (1.0f - pa), VL_ONE_MINUS_EPSILON);
      pmf *= 1.0f - pa;
      node = b;
    }
  }
  return (vlLightChoice){node->light, pmf};
}

/* Probability with which vl_light_choose picks this light. */
static inline float vl_light_pmf(const vlLightTree *tree, vlVec3 p, vlVec3 n, uint32_t light) {
  if (tree->kind != VL_LIGHT_SAMPLER_BVH) return tree->cdf[light + 1] - tree->cdf[light];
  uint32_t slots = tree->unbounded_count + (tree->node_count ? 1 : 0);
  float pmf = 1.0f / (float)slots;
  if (tree->slot[light] != VL_INNER) return pmf;
  uint64_t trail = tree->trails[light];
  const vlLightNode *node = tree->nodes;
  if (node->light != VL_INNER) return vl_light_importance(node, p, n) > 0.0f ? pmf : 0.0f;
  while (node->light == VL_INNER) {
    const vlLightNode *a = tree->nodes + node->left, *b = a + 1;
    float ia = vl_light_importance(a, p, n), ib = vl_light_importance(b, p, n);
    float pa = ia + ib > 0.0f ? ia / (ia + ib) : 0.0f;
    float pb = ia + ib > 0.0f ? 1.0f - pa : 0.0f;
    pmf *= trail & 1 ? pb : pa;
    node = trail & 1 ? b : a;
    trail >>= 1;
  }
  return pmf;
}

#endif
