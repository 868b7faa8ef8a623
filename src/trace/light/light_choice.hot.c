/* trace/light/light_choice.hot.c: which light each lane of a batch asks: all lanes walk down the light tree together, a
 * level at a time. The same decisions as vl_light_choose (world/light/light_tree.h), which says why. */
#include <stddef.h>

#include "trace/stages.h"

enum { LIGHT_FIELD = 12, LEFT_FIELD = 13 };
_Static_assert(offsetof(vlLightNode, light) == LIGHT_FIELD * sizeof(float), "layout of a node");
_Static_assert(offsetof(vlLightNode, left) == LEFT_FIELD * sizeof(float), "layout of a node");

/* The state of the walk: where each lane stands, and what is left of its random number. */
typedef struct Walk {
  VL_ROW uint32_t node[VL_ROW_SIZE];
  VL_ROW float u[VL_ROW_SIZE];
} Walk;

/* The normal that light's cosine is taken to; 0 where light from all around counts alike. */
static inline vlVec3 facing_light(const vlSurface *f, uint32_t i) {
  return vl_mul(vl_vec3(f->nx[i], f->ny[i], f->nz[i]), 1.0f - f->no_cosine[i]);
}

/* Lanes that chose a light without bounds are done (light set); the others stand at the root. */
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
    w->u[i] = vl_min((u[i] - p_unbounded) / (1.0f - p_unbounded), VL_ONE_MINUS_EPSILON);
  }
}

/* One level down for the lanes that have no light yet; what reaches a leaf has its light, what no branch lights pmf 0.
 */
static void descend(const float *restrict nodes, uint32_t padded, const vlSurface *restrict f, Walk *restrict w,
                    vlLightSamples *restrict out) {
  /* must vectorise */
  VL_SIMD
  for (uint32_t i = 0; i < padded; i++) {
    vlVec3 p = vl_vec3(f->px[i], f->py[i], f->pz[i]), n = facing_light(f, i);
    uint32_t node0 = w->node[i], light0 = out->light[i];
    float u0 = w->u[i], pmf0 = out->pmf[i];
    uint32_t left = vl_float_bits(nodes[node0 * VL_LIGHT_NODE_FLOATS + LEFT_FIELD]), at = left * VL_LIGHT_NODE_FLOATS;
    float ia = vl_light_importance(vl_light_cluster(nodes, at), p, n);
    float ib = vl_light_importance(vl_light_cluster(nodes, at + VL_LIGHT_NODE_FLOATS), p, n);
    float sum = ia + ib, some = sum > 0.0f ? sum : 1.0f;
    float pa = ia / some, pb = 1.0f - pa;
    uint32_t second = u0 < pa ? 0u : 1u;
    float part = second ? pb : pa, used = second ? u0 - pa : u0;
    float chance = sum > 0.0f ? part : 0.0f, divisor = part > 0.0f ? part : 1.0f;
    float u = vl_min(used / divisor, VL_ONE_MINUS_EPSILON), pmf = pmf0 * chance;
    uint32_t node = left + second;
    uint32_t light = vl_float_bits(nodes[node * VL_LIGHT_NODE_FLOATS + LIGHT_FIELD]);
    uint32_t next = light == VL_INNER ? node : 0;
    out->pmf[i] = light0 == VL_INNER ? pmf : pmf0;
    out->light[i] = light0 == VL_INNER ? light : light0;
    w->u[i] = light0 == VL_INNER ? u : u0;
    w->node[i] = light0 == VL_INNER ? next : 0;
  }
}

void vl_stage_light_choice(const vlLightTree *tree, uint32_t n, const vlSurface *f, const float *u,
                           vlLightSamples *out) {
  if (tree->kind != VL_LIGHT_SAMPLER_BVH || tree->node_count < 3) { /* nothing to walk */
    for (uint32_t i = 0; i < n; i++) {
      vlLightChoice c = vl_light_choose(tree, vl_vec3(f->px[i], f->py[i], f->pz[i]), facing_light(f, i), u[i]);
      out->light[i] = c.light;
      out->pmf[i] = c.pmf;
    }
    return;
  }
  Walk w;
  uint32_t padded = VL_PAD(n);
  start(tree, padded, u, &w, out);
  for (uint32_t waiting = n; waiting > 0;) {
    descend((const float *)tree->nodes, padded, f, &w, out);
    waiting = 0;
    for (uint32_t i = 0; i < n; i++) {
      if (!(out->pmf[i] > 0.0f)) out->light[i] = 0; /* lit by nothing: done */
      waiting += out->light[i] == VL_INNER;
    }
    if (waiting > n / 4) continue;
    for (uint32_t i = 0; waiting > 0 && i < n; i++) { /* the last few go alone */
      if (out->light[i] != VL_INNER) continue;
      vlLightChoice c = vl_light_walk(tree, tree->nodes + w.node[i], vl_vec3(f->px[i], f->py[i], f->pz[i]),
                                      facing_light(f, i), w.u[i], out->pmf[i]);
      out->light[i] = c.light;
      out->pmf[i] = c.pmf;
    }
    return;
  }
}
