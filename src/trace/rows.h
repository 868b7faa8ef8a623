/* trace/rows.h: the arrays that the stages of a bounce exchange (trace/stages.h); private to
 * the hot files of trace.
 *
 *   vlPaths (rays) -> vlHits -> vlVertices: sorted by material, with vlSurface and vlShade
 *     (frame, wo, BSDF parameters)
 *   vlVertices -> vlLightSamples -> vlBsdfValues -> vlShadowRays -> radiance
 *   vlVertices -> vlBsdfSamples -> vlPaths of the next bounce
 *
 * Every array has VL_ROW_SIZE elements. Elements from n on hold old data, which is safe to
 * read: numbers are finite, and indices are valid. */
#ifndef TRACE_ROWS_H
#define TRACE_ROWS_H

#include "material/bsdf.hot.h"
#include "trace/surface/offset.h"
#include "trace/trace.h"

#define VL_ROW __attribute__((aligned(64)))

/* Paths: the ray, the throughput, and what multiple importance sampling needs at the next
 * hit. */
typedef struct vlPaths {
  VL_ROW float ox[VL_ROW_SIZE], oy[VL_ROW_SIZE], oz[VL_ROW_SIZE];
  VL_ROW float dx[VL_ROW_SIZE], dy[VL_ROW_SIZE], dz[VL_ROW_SIZE];
  VL_ROW float beta[4][VL_ROW_SIZE];
  VL_ROW float lambda[4][VL_ROW_SIZE];
  VL_ROW float pdf[VL_ROW_SIZE]; /* density per solid angle with which BSDF sampling drew the
                                    direction */
  /* surface normal at the ray's origin; the light tree uses it */
  VL_ROW float from_nx[VL_ROW_SIZE], from_ny[VL_ROW_SIZE], from_nz[VL_ROW_SIZE];
  VL_ROW float from_side[VL_ROW_SIZE]; /* vlSurface.side at the ray's origin */
  VL_ROW float eta_scale[VL_ROW_SIZE];
  VL_ROW float cone[VL_ROW_SIZE];   /* width of the footprint at the ray's origin */
  VL_ROW float spread[VL_ROW_SIZE]; /* growth of the footprint's width per unit length; negative
                                       where the cone converges */
  VL_ROW uint32_t specular[VL_ROW_SIZE]; /* 1: the ray comes from the camera or a specular lobe,
                                            so MIS has no light sample to weigh it against */
  VL_ROW int32_t px[VL_ROW_SIZE], py[VL_ROW_SIZE];
  VL_ROW uint32_t index[VL_ROW_SIZE];
  VL_ROW uint32_t lane[VL_ROW_SIZE]; /* the path's element of the batch */
  const float *time; /* by lane: the world's time, 0 to 1; null if nothing moves */
} vlPaths;
static inline float vl_path_time(const vlPaths *p, uint32_t i) {
  return p->time ? p->time[p->lane[i]] : 0.0f;
}

/* The world's times of the first n paths, in `room`; null if nothing moves. */
static inline const float *vl_path_times(const vlPaths *p, uint32_t n, float *room) {
  for (uint32_t i = 0; p->time && i < n; i++)
    room[i] = vl_path_time(p, i);
  return p->time ? room : NULL;
}

typedef struct vlHits {
  VL_ROW uint32_t shape[VL_ROW_SIZE], prim[VL_ROW_SIZE], instance[VL_ROW_SIZE],
      material[VL_ROW_SIZE];
  VL_ROW float t[VL_ROW_SIZE]; /* distance along the ray, set for shapes other than triangles;
                                  it identifies the crossing (world/accel/accel.h) */
} vlHits;

typedef struct vlSurface {
  VL_ROW float px[VL_ROW_SIZE], py[VL_ROW_SIZE], pz[VL_ROW_SIZE];
  VL_ROW float t[VL_ROW_SIZE];
  VL_ROW float gx[VL_ROW_SIZE], gy[VL_ROW_SIZE], gz[VL_ROW_SIZE]; /* geometric normal, unit */
  VL_ROW float nx[VL_ROW_SIZE], ny[VL_ROW_SIZE], nz[VL_ROW_SIZE]; /* shading normal, unit */
  VL_ROW float ux[VL_ROW_SIZE], uy[VL_ROW_SIZE], uz[VL_ROW_SIZE]; /* dpdu */
  VL_ROW float vx[VL_ROW_SIZE], vy[VL_ROW_SIZE], vz[VL_ROW_SIZE]; /* dpdv */
  VL_ROW float u[VL_ROW_SIZE], v[VL_ROW_SIZE];
  VL_ROW float offset[VL_ROW_SIZE]; /* distance along the geometric normal by which a new ray's
                                       origin is moved off the surface */
  VL_ROW float uv_scale[VL_ROW_SIZE]; /* uv per world length */
  VL_ROW float width[VL_ROW_SIZE];    /* width of the footprint, world units */
  /* the footprint's axes in uv; only set if the world has image textures (footprint.hot.c) */
  VL_ROW float across_u[VL_ROW_SIZE], across_v[VL_ROW_SIZE];
  VL_ROW float along_u[VL_ROW_SIZE], along_v[VL_ROW_SIZE];
  /* mean curvature of the shading normals: positive where convex */
  VL_ROW float curvature[VL_ROW_SIZE];
  VL_ROW float dn[6][VL_ROW_SIZE]; /* dndu, dndv; for triangles only if the material has a bump
                                      map (material.hot.c) */
  /* 1: light from all directions counts equally (in media); 0: light is weighted by the cosine
   * to the normal */
  VL_ROW float no_cosine[VL_ROW_SIZE];
  VL_ROW float side[VL_ROW_SIZE]; /* 1 or -1: only light on the side of n or -n counts, the
                                     viewer's; 0: on both sides */
} vlSurface;

/* Corners of the triangles that a batch hits, one triangle per lane. */
typedef struct vlCorners {
  VL_ROW float p[9][VL_ROW_SIZE]; /* x y z of corners 0, 1, 2; world space */
  VL_ROW float n[9][VL_ROW_SIZE]; /* vertex normals; zero if the mesh has none */
  VL_ROW float uv[6][VL_ROW_SIZE];
  VL_ROW float error[VL_ROW_SIZE]; /* bound of the rounding error of the instance's transform */
  VL_ROW float flip[VL_ROW_SIZE];  /* -1: the shape's normals are reversed; else 1 */
} vlCorners;

/* Corner k of lane i's triangle, of vlCorners.p or .n. */
static inline vlVec3 vl_corner(const float (*rows)[VL_ROW_SIZE], int k, uint32_t i) {
  return vl_lane3(rows[3 * k], rows[3 * k + 1], rows[3 * k + 2], i);
}
/* Barycentric coordinates, of corners 1 and 2, of a point of lane i's triangle. */
static inline vlVec2 vl_corner_weights(const vlCorners *c, uint32_t i, vlVec3 point) {
  vlVec3 first = vl_corner(c->p, 0, i), e1 = vl_sub(vl_corner(c->p, 1, i), first),
         e2 = vl_sub(vl_corner(c->p, 2, i), first), g = vl_cross(e1, e2),
         way = vl_sub(point, first);
  float total = vl_length2(g), inv = total > 0.0f ? 1.0f / total : 0.0f;
  return (vlVec2){vl_dot(vl_cross(way, e2), g) * inv, vl_dot(vl_cross(e1, way), g) * inv};
}

/* Factors on the light that crosses surfaces. rgb: of each channel of linear sRGB (the fourth
 * row is not used). at: at the path's wavelengths, after all that the path has crossed. */
typedef struct vlTint {
  VL_ROW float rgb[4][VL_ROW_SIZE], at[4][VL_ROW_SIZE];
} vlTint;

typedef struct vlShade {
  /* frame: tangent; bitangent = n x t */
  VL_ROW float tx[VL_ROW_SIZE], ty[VL_ROW_SIZE], tz[VL_ROW_SIZE];
  VL_ROW float bx[VL_ROW_SIZE], by[VL_ROW_SIZE], bz[VL_ROW_SIZE];
  VL_ROW float wo[3][VL_ROW_SIZE]; /* local */
  VL_ROW float reflectance[4][VL_ROW_SIZE], eta[4][VL_ROW_SIZE], k[4][VL_ROW_SIZE];
  vlTint *tint; /* only with vlWorld.by_channel; else null */
  VL_ROW float alpha_x[VL_ROW_SIZE], alpha_y[VL_ROW_SIZE], eta_s[VL_ROW_SIZE];
  const vlCoatTable *coat[VL_ROW_SIZE];
  VL_ROW float own[VL_BSDF_ROWS][VL_ROW_SIZE]; /* rows that depend on the kind;
                                                  material/bsdf.hot.h names them */
  VL_ROW uint32_t seed[VL_ROW_SIZE];
  const vlMeasured *measured[VL_ROW_SIZE];
} vlShade;

/* The paths of a bounce that have hit surfaces, sorted by material. */
typedef struct vlVertices {
  vlPaths paths; /* the rays that have arrived */
  vlHits hits;
  vlSurface surface;
  vlShade shade;
} vlVertices;

/* The BSDFs for given directions; material/bsdf.hot.h says what value and pdf are. */
typedef struct vlBsdfValues {
  VL_ROW float wi[3][VL_ROW_SIZE]; /* local */
  VL_ROW float value[4][VL_ROW_SIZE], pdf[VL_ROW_SIZE];
} vlBsdfValues;

/* Directions that the BSDFs have sampled. */
typedef struct vlBsdfSamples {
  VL_ROW float wi[3][VL_ROW_SIZE]; /* local */
  VL_ROW float weight[4][VL_ROW_SIZE], pdf[VL_ROW_SIZE], eta_scale[VL_ROW_SIZE];
  VL_ROW uint32_t flags[VL_ROW_SIZE];
} vlBsdfSamples;

/* Random numbers of a stage, by lane. */
typedef struct vlNumbers {
  VL_ROW float u0[VL_ROW_SIZE], u1[VL_ROW_SIZE], u2[VL_ROW_SIZE];
} vlNumbers;

typedef struct vlLightSamples {
  VL_ROW uint32_t light[VL_ROW_SIZE]; /* index of the chosen light; VL_INNER: not chosen yet */
  VL_ROW float pmf[VL_ROW_SIZE];
  VL_ROW float wx[VL_ROW_SIZE], wy[VL_ROW_SIZE], wz[VL_ROW_SIZE]; /* towards the light, unit */
  /* point that must be visible */
  VL_ROW float tx[VL_ROW_SIZE], ty[VL_ROW_SIZE], tz[VL_ROW_SIZE];
  VL_ROW float radiance[4][VL_ROW_SIZE]; /* already divided by the pdf */
  VL_ROW float pdf[VL_ROW_SIZE];      /* per solid angle, times the probability of choosing the
                                         light; 0: no sample */
  VL_ROW uint32_t delta[VL_ROW_SIZE]; /* a delta light: a BSDF sample cannot hit it */
  VL_ROW uint32_t distant[VL_ROW_SIZE]; /* 1: the target is infinitely far, and tx, ty, tz hold
                                           the direction */
} vlLightSamples;

typedef struct vlShadowRays {
  VL_ROW float ox[VL_ROW_SIZE], oy[VL_ROW_SIZE], oz[VL_ROW_SIZE], dx[VL_ROW_SIZE],
      dy[VL_ROW_SIZE], dz[VL_ROW_SIZE], t_max[VL_ROW_SIZE];
  VL_ROW float radiance[4][VL_ROW_SIZE];
  VL_ROW uint32_t lane[VL_ROW_SIZE];
  VL_ROW float time[VL_ROW_SIZE];       /* the world's time; only set if something moves */
  VL_ROW uint32_t crossed[VL_ROW_SIZE]; /* vlRays.crossed */
  uint8_t occluded[VL_ROW_SIZE];
} vlShadowRays;

/* Sets the way of shadow ray k, of path i. */
static inline void vl_shadow_way(const vlPaths *p, uint32_t i, vlVec3 o, vlVec3 d, float t_max,
                                 uint32_t k, vlShadowRays *q) {
  vl_set_lane3(q->ox, q->oy, q->oz, k, o);
  vl_set_lane3(q->dx, q->dy, q->dz, k, d);
  q->t_max[k] = t_max;
  q->time[k] = vl_path_time(p, i);
  q->lane[k] = p->lane[i];
}
/* Moves the way and the radiance of shadow ray i to index k. */
static inline void vl_shadow_move(vlShadowRays *q, uint32_t i, uint32_t k) {
  vl_set_lane3(q->ox, q->oy, q->oz, k, vl_lane3(q->ox, q->oy, q->oz, i));
  vl_set_lane3(q->dx, q->dy, q->dz, k, vl_lane3(q->dx, q->dy, q->dz, i));
  q->t_max[k] = q->t_max[i];
  for (int c = 0; c < 4; c++)
    q->radiance[c][k] = q->radiance[c][i];
}

/* ---- elements of the arrays */

static inline void vl_path_lambda(const vlPaths *p, uint32_t i, float lambda[4]) {
  for (int c = 0; c < 4; c++)
    lambda[c] = p->lambda[c][i];
}
/* How surface lane i receives light, and how the point that ray i left did. */
VL_INLINE vlReceiver vl_receiver(const vlSurface *f, uint32_t i) {
  vlVec3 n = vl_mul(vl_vec3(f->nx[i], f->ny[i], f->nz[i]), 1.0f - f->no_cosine[i]);
  return (vlReceiver){vl_vec3(f->px[i], f->py[i], f->pz[i]), n, f->side[i]};
}
static inline vlReceiver vl_receiver_before(const vlPaths *p, uint32_t i) {
  vlReceiver r = {vl_lane3(p->ox, p->oy, p->oz, i),
                  vl_lane3(p->from_nx, p->from_ny, p->from_nz, i), p->from_side[i]};
  return r;
}
/* Copies element i of a to element k of b. */
static inline void vl_hit_copy(const vlHits *a, uint32_t i, vlHits *b, uint32_t k) {
  b->shape[k] = a->shape[i];
  b->prim[k] = a->prim[i];
  b->instance[k] = a->instance[i];
  b->material[k] = a->material[i];
  b->t[k] = a->t[i];
}
/* Starts path k, which the camera or a light sends: nothing lies before it. Ray, beta, lambda,
 * cone and spread are left to the caller. */
static inline void vl_path_start(vlPaths *p, uint32_t k, int32_t px, int32_t py, uint32_t index,
                                 uint32_t lane) {
  p->pdf[k] = p->eta_scale[k] = 1.0f;
  p->from_nx[k] = p->from_ny[k] = p->from_nz[k] = p->from_side[k] = 0.0f;
  p->specular[k] = 1;
  p->px[k] = px;
  p->py[k] = py;
  p->index[k] = index;
  p->lane[k] = lane;
}
/* Copies what stays the same along a path, from element i of a to element k of b. */
static inline void vl_path_copy_constants(const vlPaths *a, uint32_t i, vlPaths *b,
                                          uint32_t k) {
  for (int c = 0; c < 4; c++)
    b->lambda[c][k] = a->lambda[c][i];
  b->px[k] = a->px[i];
  b->py[k] = a->py[i];
  b->index[k] = a->index[i];
  b->lane[k] = a->lane[i];
}
/* Copies what each bounce changes. */
static inline void vl_path_copy_ray(const vlPaths *a, uint32_t i, vlPaths *b, uint32_t k) {
  vl_set_lane3(b->ox, b->oy, b->oz, k, vl_lane3(a->ox, a->oy, a->oz, i));
  vl_set_lane3(b->dx, b->dy, b->dz, k, vl_lane3(a->dx, a->dy, a->dz, i));
  vl_set_lane3(b->from_nx, b->from_ny, b->from_nz, k,
               vl_lane3(a->from_nx, a->from_ny, a->from_nz, i));
  for (int c = 0; c < 4; c++)
    b->beta[c][k] = a->beta[c][i];
  b->pdf[k] = a->pdf[i];
  b->from_side[k] = a->from_side[i];
  b->eta_scale[k] = a->eta_scale[i];
  b->cone[k] = a->cone[i];
  b->spread[k] = a->spread[i];
  b->specular[k] = a->specular[i];
}
static inline void vl_path_copy(const vlPaths *a, uint32_t i, vlPaths *b, uint32_t k) {
  vl_path_copy_constants(a, i, b, k);
  vl_path_copy_ray(a, i, b, k);
}

#endif
