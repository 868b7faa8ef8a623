/* trace/light/light_choice.hot.c: chooses a light for each lane of a batch. All lanes descend the light tree together,
 * one level at a time. They make the same decisions as vl_light_choose (world/light/light_tree.h), which explains
 * them. */
#include <stddef.h>

#include "trace/stages.h"

enum { LIGHT_FIELD = 12, LEFT_FIELD = 13 };
_Static_assert(offsetof(vlLightNode, light) == LIGHT_FIELD * sizeof(float), "layout of a node");
_Static_assert(offsetof(vlLightNode, left) == LEFT_FIELD * sizeof(float), "layout of a node");

/* The state of the descent, by lane: node and remaining random number. */
typedef struct Walk {
  VL_ROW uint32_t node[VL_ROW_SIZE];
  VL_ROW float u[VL_ROW_SIZE];
} Walk;

/* The surface normal for the cosine of arriving light; 0 in media, where all directions count equally. */
static inline vlVec3 facing_light(const vlSurface *f, uint32_t i) {
  return vl_mul(vl_vec3(f->nx[i], f->ny[i], f->nz[i]), 1.0f - f->no_cosine[i]);
}

/* Starts the descent. Lanes that choose a light without bounds are done, and their light is set; the others start at
 * the root. */
static void start(const vlLightTree *tree, uint32_t padded, const float *u, Walk *w, vlLightSamples *out) {
  float slots = (float)(tree->unbounded_count + 1), p_unbounded = (float)tree->unbounded_count / slots;
  uint32_t last = tree->unbounded_count ? tree->unbounded_count - 1 : 0;
  for (uint32_t i = 0; i < padded; i++) {
    uint32_t k = (uint32_t)(int32_t)(u[i] * slots);
    k = k < last ? k : last;
    bool beside = u[i] < p_unbounded;
    out->light[i] = beside ? tree->unbounded[k] : VL_INNER;
    out->pmf[i] = 1.0f / slots;
    w->node[i] = 0;
    float rest = beside ? u[i] * slots - (float)k : (u[i] - p_unbounded) / (1.0f - p_unbounded);
    w->u[i] = vl_min(rest, VL_ONE_MINUS_EPSILON);
  }
}

/* One level of one lane's descent, from the node whose children are a and b. left: index of the first child. *second:
 * 1 if the lane goes to the second child. If neither child has importance, pmf becomes 0. */
typedef struct Step {
  uint32_t node;
  float u, pmf;
} Step;
static inline __attribute__((always_inline)) Step step_down(vlLightCluster a, vlLightCluster b, uint32_t left, vlVec3 p,
                                                            vlVec3 n, float u0, float pmf0, uint32_t *second) {
  float ia = vl_light_importance(a, p, n), ib = vl_light_importance(b, p, n);
  float sum = ia + ib, some = sum > 0.0f ? sum : 1.0f;
  float pa = ia / some, pb = 1.0f - pa;
  *second = u0 < pa ? 0u : 1u;
  float part = *second ? pb : pa, used = *second ? u0 - pa : u0;
  float chance = sum > 0.0f ? part : 0.0f, divisor = part > 0.0f ? part : 1.0f;
  return (Step){left + *second, vl_min(used / divisor, VL_ONE_MINUS_EPSILON), pmf0 * chance};
}

/* Descends one level from inner node `from`, for the lanes at this node. */
static void descend_from(const float *nodes, uint32_t from, uint32_t padded, const vlSurface *restrict f,
                         Walk *restrict w, vlLightSamples *restrict out) {
  uint32_t left = vl_float_bits(nodes[from * VL_LIGHT_NODE_FLOATS + LEFT_FIELD]), at = left * VL_LIGHT_NODE_FLOATS;
  vlLightCluster a = vl_light_cluster(nodes, at), b = vl_light_cluster(nodes, at + VL_LIGHT_NODE_FLOATS);
  uint32_t light_a = vl_float_bits(nodes[at + LIGHT_FIELD]);
  uint32_t light_b = vl_float_bits(nodes[at + VL_LIGHT_NODE_FLOATS + LIGHT_FIELD]);
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 p = vl_vec3(f->px[i], f->py[i], f->pz[i]), n = facing_light(f, i);
    uint32_t node0 = w->node[i], light0 = out->light[i], second;
    float u0 = w->u[i], pmf0 = out->pmf[i];
    Step s = step_down(a, b, left, p, n, u0, pmf0, &second);
    uint32_t light = second ? light_b : light_a, next = light == VL_INNER ? s.node : 0;
    int here = (light0 == VL_INNER) & (node0 == from);
    out->pmf[i] = here ? s.pmf : pmf0;
    out->light[i] = here ? light : light0;
    w->u[i] = here ? s.u : u0;
    w->node[i] = here ? next : node0;
  }
}

/* Descends through the top of the tree, breadth first. Many lanes share a node there, so its numbers need not be
 * gathered by lane. */
static void descend_top(const vlLightTree *tree, uint32_t padded, const vlSurface *f, Walk *w, vlLightSamples *out) {
  enum { TOP = 7 }; /* three levels of a balanced tree */
  uint32_t queue[2 * TOP + 1] = {0}, count = 1;
  for (uint32_t k = 0; k < count && k < TOP; k++) {
    descend_from((const float *)tree->nodes, queue[k], padded, f, w, out);
    uint32_t left = tree->nodes[queue[k]].left;
    for (uint32_t child = left; child < left + 2; child++)
      if (tree->nodes[child].light == VL_INNER) queue[count++] = child;
  }
}

/* Descends one level for the lanes without a light. */
static void descend(const float *restrict nodes, uint32_t padded, const vlSurface *restrict f, Walk *restrict w,
                    vlLightSamples *restrict out) {
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 p = vl_vec3(f->px[i], f->py[i], f->pz[i]), n = facing_light(f, i);
    uint32_t node0 = w->node[i], light0 = out->light[i], second;
    float u0 = w->u[i], pmf0 = out->pmf[i];
    uint32_t left = vl_float_bits(nodes[node0 * VL_LIGHT_NODE_FLOATS + LEFT_FIELD]), at = left * VL_LIGHT_NODE_FLOATS;
    Step s = step_down(vl_light_cluster(nodes, at), vl_light_cluster(nodes, at + VL_LIGHT_NODE_FLOATS), left, p, n, u0,
                       pmf0, &second);
    uint32_t light = vl_float_bits(nodes[s.node * VL_LIGHT_NODE_FLOATS + LIGHT_FIELD]);
    uint32_t next = light == VL_INNER ? s.node : 0;
    out->pmf[i] = light0 == VL_INNER ? s.pmf : pmf0;
    out->light[i] = light0 == VL_INNER ? light : light0;
    w->u[i] = light0 == VL_INNER ? s.u : u0;
    w->node[i] = light0 == VL_INNER ? next : 0;
  }
}

/* Ends the lanes that no light reaches. Returns the number of lanes that are still without a light. */
static uint32_t count_waiting(uint32_t n, vlLightSamples *out) {
  uint32_t waiting = 0;
  for (uint32_t i = 0; i < n; i++) {
    out->light[i] = out->pmf[i] > 0.0f ? out->light[i] : 0;
    waiting += out->light[i] == VL_INNER;
  }
  return waiting;
}

void vl_stage_light_choice(const vlLightTree *tree, uint32_t n, const vlSurface *f, const float *u, vlLightSamples *out,
                           float *rest) {
  if (tree->kind != VL_LIGHT_SAMPLER_BVH || tree->node_count < 3) { /* no tree to descend */
    for (uint32_t i = 0; i < n; i++) {
      vlLightChoice c = vl_light_choose(tree, vl_vec3(f->px[i], f->py[i], f->pz[i]), facing_light(f, i), u[i]);
      out->light[i] = c.light;
      out->pmf[i] = c.pmf;
      rest[i] = c.rest;
    }
    return;
  }
  Walk w;
  uint32_t padded = VL_PAD(n);
  start(tree, padded, u, &w, out);
  descend_top(tree, padded, f, &w, out);
  uint32_t waiting = count_waiting(n, out);
  for (; waiting > n / 4; waiting = count_waiting(n, out)) descend((const float *)tree->nodes, padded, f, &w, out);
  for (uint32_t i = 0; waiting > 0 && i < n; i++) { /* the last few lanes one by one */
    if (out->light[i] != VL_INNER) continue;
    vlLightChoice c = vl_light_walk(tree, tree->nodes + w.node[i], vl_vec3(f->px[i], f->py[i], f->pz[i]),
                                    facing_light(f, i), w.u[i], out->pmf[i]);
    out->light[i] = c.light;
    out->pmf[i] = c.pmf;
    w.u[i] = c.rest;
  }
  for (uint32_t i = 0; i < n; i++) rest[i] = w.u[i];
}
