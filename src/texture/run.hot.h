/* texture/run.hot.h: textures evaluated node by node over a run of lanes; private to hot
 * files. */
#ifndef TEXTURE_RUN_HOT_H
#define TEXTURE_RUN_HOT_H

#include <stddef.h>

#include "texture/lookup.h"
#include "trace/stages.h"

/* A run of lanes and a stack of scratch rows for nested textures. */
typedef struct vlTextureRun {
  const vlWorld *world;
  vlVertices *at;
  vlTraceScratch *s;    /* corners and stack */
  uint32_t first, last; /* at most VL_MATERIAL_LANES lanes */
  uint32_t top;         /* first free row */
  const float *shift_u, *shift_v, *shift_x, *shift_y,
      *shift_z; /* offsets added to uv and position, for bump maps; or null */
  bool rgb;     /* spectra are evaluated as linear sRGB, 0 in the fourth row, for nodes with
                   vl_node_has_rgb_colors */
} vlTextureRun;

/* Evaluates a texture. Results go to lanes [first, last) of out, whose rows have the size of
 * the whole batch. */
void vl_texture_float(vlTextureRun *r, int32_t node, float *out);
void vl_texture_spectrum(vlTextureRun *r, int32_t node, float *const out[4]);
/* Takes a scratch row, of which only lanes [first, last) exist; the caller frees it by
 * restoring r->top. The stack cannot overflow: texture/compile.c limits nesting. */
static inline float *vl_texture_row(vlTextureRun *r) {
  uint32_t row = r->top < VL_TEXTURE_ROWS - 1 ? r->top++ : r->top;
  float *stack =
      (float *)(void *)((char *)r->s +
                        offsetof(vlTraceScratch, textures)); /* within the scratch memory */
  return stack + row * VL_MATERIAL_LANES - r->first;
}
_Static_assert(offsetof(vlTraceScratch, textures) >= sizeof(float[VL_BATCH]),
               "a row less `first` is in the memory");

/* Interpolates the vertex attributes (uv sets, colours) of lane i's triangle at the point. */
static inline void vl_texture_lane_corner(const vlTextureRun *r, const vlTextureNode *node,
                                          uint32_t i, vlTexturePoint *at) {
  const vlCorners *c = &r->s->corners;
  const vlHits *h = &r->at->hits;
  vlTextureCorner where = {&r->world->shapes.items[h->shape[i]], h->prim[i], {1, 0, 0}};
  vlVec3 k[3];
  for (int j = 0; j < 3; j++)
    k[j] = vl_vec3(c->p[3 * j][i], c->p[3 * j + 1][i], c->p[3 * j + 2][i]);
  vlVec3 e1 = vl_sub(k[1], k[0]), e2 = vl_sub(k[2], k[0]), g = vl_cross(e1, e2),
         way = vl_sub(at->p, k[0]);
  float total = vl_length2(g), inv = total > 0.0f ? 1.0f / total : 0.0f;
  where.weights[1] = vl_dot(vl_cross(way, e2), g) * inv;
  where.weights[2] = vl_dot(vl_cross(e1, way), g) * inv;
  where.weights[0] = 1.0f - where.weights[1] - where.weights[2];
  vl_texture_at_corner(node, &where, at);
}

/* Computes the footprint's axes in texture coordinates (s, t). For the first uv set they are
 * the surface's axes; for other mappings they are finite differences along each axis. */
static inline void vl_texture_lane_axes(const vlTextureRun *r, const vlTextureNode *node,
                                        uint32_t i, vlTexturePoint *at) {
  const vlSurface *f = &r->at->surface;
  if (vl_texture_over_uv(node)) {
    float axes[4] = {f->across_u[i], f->across_v[i], f->along_u[i], f->along_v[i]};
    vl_texture_axes_of_uv(node, axes, at);
    return;
  }
  const vlPaths *p = &r->at->paths;
  vlFootprint print = vl_footprint_of(vl_lane3(p->dx, p->dy, p->dz, i), at->n, at->width);
  vlVec2 here = vl_texture_st(node, *at);
  vlTexturePoint step = *at;
  for (int k = 0; k < 2; k++) {
    step.p = vl_add(at->p, k ? print.along : print.across);
    if (vl_texture_needs_corner(node))
      vl_texture_lane_corner(r, node, i, &step);
    vlVec2 there = vl_texture_st(node, step);
    float s = there.x - here.x, t = there.y - here.y;
    if (node->mapping == VL_MAPPING_SPHERICAL ||
        node->mapping == VL_MAPPING_CYLINDRICAL) /* the shorter way across the mapping's seam */
    {
      s -= __builtin_rintf(s);
      t -= node->mapping == VL_MAPPING_SPHERICAL ? __builtin_rintf(t) : 0.0f;
    }
    at->axes[2 * k] = s;
    at->axes[2 * k + 1] = t;
  }
}

static inline vlTexturePoint vl_texture_point_of(const vlTextureRun *r,
                                                 const vlTextureNode *node, uint32_t i) {
  const vlSurface *f = &r->at->surface;
  vlTexturePoint at = {.color = {1, 1, 1, 1}};
  at.u = f->u[i];
  at.v = f->v[i];
  at.p = vl_vec3(f->px[i], f->py[i], f->pz[i]);
  at.n = vl_vec3(f->gx[i], f->gy[i], f->gz[i]); /* geometric normal, as in pbrt */
  at.width = f->width[i];
  if (r->shift_u) {
    at.u += r->shift_u[i];
    at.v += r->shift_v[i];
    at.p = vl_add(at.p, vl_vec3(r->shift_x[i], r->shift_y[i], r->shift_z[i]));
  }
  if (vl_texture_needs_corner(node))
    vl_texture_lane_corner(r, node, i, &at);
  if (node->image >= 0)
    vl_texture_lane_axes(r, node, i, &at);
  return at;
}

#endif
