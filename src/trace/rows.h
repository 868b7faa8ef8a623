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
/* A number for each lane of a batch. */
typedef float vlFloatRow[VL_ROW_SIZE] VL_ROW;
typedef uint32_t vlUintRow[VL_ROW_SIZE] VL_ROW;
/* A point or a direction for each lane. */
typedef struct vlVec3Row {
  vlFloatRow x, y, z;
} vlVec3Row;

/* Loops that must vectorise index the arrays themselves (vl_lane3). */
static inline vlVec3 vl_row3(const vlVec3Row *row, uint32_t i) {
  return vl_vec3(row->x[i], row->y[i], row->z[i]);
}
static inline void vl_set_row3(vlVec3Row *row, uint32_t i, vlVec3 v) {
  row->x[i] = v.x;
  row->y[i] = v.y;
  row->z[i] = v.z;
}
/* The rays from lane `first` on. t_min, t_max, time: of vlRays, for these rays. */
static inline vlRays vl_rays_of(const vlVec3Row *o, const vlVec3Row *d, uint32_t first,
                                const float *t_min, const float *t_max, const float *time) {
  return (vlRays){o->x + first, o->y + first, o->z + first, d->x + first, d->y + first,
                  d->z + first, t_min,        t_max,        time,         NULL};
}

/* Paths: the ray, the throughput, and what multiple importance sampling needs at the next
 * hit. */
typedef struct vlPaths {
  vlVec3Row o, d;
  vlFloatRow beta[4];
  vlFloatRow lambda[4];
  vlFloatRow pdf;   /* density per solid angle with which BSDF sampling drew the direction */
  vlVec3Row from_n; /* surface normal at the ray's origin; the light tree uses it */
  vlFloatRow from_side; /* vlSurface.side at the ray's origin */
  vlFloatRow eta_scale;
  vlFloatRow cone;   /* width of the footprint at the ray's origin */
  vlFloatRow spread; /* growth of the footprint's width per unit length; negative where the cone
                        converges */
  vlUintRow specular; /* 1: the ray comes from the camera or a specular lobe, so MIS has no
                         light sample to weigh it against */
  VL_ROW int32_t px[VL_ROW_SIZE], py[VL_ROW_SIZE];
  vlUintRow index;
  vlUintRow lane;    /* the path's element of the batch */
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
  vlUintRow shape, prim, instance, material;
  vlFloatRow t; /* distance along the ray, set for shapes other than triangles; it identifies
                   the crossing (world/accel/accel.h) */
} vlHits;

typedef struct vlSurface {
  vlVec3Row p;
  vlFloatRow t;
  vlVec3Row g, n; /* geometric and shading normal, unit */
  vlVec3Row dpdu, dpdv;
  vlFloatRow u, v;
  vlFloatRow offset; /* distance along the geometric normal by which a new ray's origin is moved
                        off the surface */
  vlFloatRow uv_scale; /* uv per world length */
  vlFloatRow width;    /* width of the footprint, world units */
  /* the footprint's axes in uv; only set if the world has image textures (footprint.hot.c) */
  vlFloatRow across_u, across_v;
  vlFloatRow along_u, along_v;
  /* mean curvature of the shading normals: positive where convex */
  vlFloatRow curvature;
  vlFloatRow dn[6]; /* dndu, dndv; for triangles only if the material has a bump map
                       (material.hot.c) */
  /* 1: light from all directions counts equally (in media); 0: light is weighted by the cosine
   * to the normal */
  vlFloatRow no_cosine;
  vlFloatRow side; /* 1 or -1: only light on the side of n or -n counts, the viewer's; 0: on
                      both sides */
} vlSurface;

/* Corners of the triangles that a batch hits, one triangle per lane. */
typedef struct vlCorners {
  vlFloatRow p[9]; /* x y z of corners 0, 1, 2; world space */
  vlFloatRow n[9]; /* vertex normals; zero if the mesh has none */
  vlFloatRow uv[6];
  vlFloatRow error; /* bound of the rounding error of the instance's transform */
  vlFloatRow flip;  /* -1: the shape's normals are reversed; else 1 */
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
  vlFloatRow rgb[4], at[4];
} vlTint;

typedef struct vlShade {
  /* of the frame; bitangent = n x tangent */
  vlVec3Row tangent, bitangent;
  vlFloatRow wo[3]; /* local */
  vlFloatRow reflectance[4], eta[4], k[4];
  vlTint *tint; /* only with vlWorld.by_channel; else null */
  vlFloatRow alpha_x, alpha_y, eta_s;
  const vlCoatTable *coat[VL_ROW_SIZE];
  vlFloatRow own[VL_BSDF_ROWS]; /* what depends on the kind (material/bsdf.hot.h) */
  vlUintRow seed;
  const vlMeasured *measured[VL_ROW_SIZE];
} vlShade;

/* gcc 12 does not vectorise loops that call it. */
static inline vlFrame vl_shading_frame(const vlSurface *f, const vlShade *shade, uint32_t i) {
  return (vlFrame){vl_row3(&shade->tangent, i), vl_row3(&shade->bitangent, i),
                   vl_row3(&f->n, i)};
}

/* The paths of a bounce that have hit surfaces, sorted by material. */
typedef struct vlVertices {
  vlPaths paths; /* the rays that have arrived */
  vlHits hits;
  vlSurface surface;
  vlShade shade;
} vlVertices;

/* The BSDFs for given directions; material/bsdf.hot.h says what value and pdf are. */
typedef struct vlBsdfValues {
  vlFloatRow wi[3]; /* local */
  vlFloatRow value[4], pdf;
} vlBsdfValues;

/* Directions that the BSDFs have sampled. */
typedef struct vlBsdfSamples {
  vlFloatRow wi[3]; /* local */
  vlFloatRow weight[4], pdf, eta_scale;
  vlUintRow flags;
} vlBsdfSamples;

/* Random numbers of a stage, by lane. */
typedef struct vlNumbers {
  vlFloatRow u0, u1, u2;
} vlNumbers;

typedef struct vlLightSamples {
  vlUintRow light; /* index of the chosen light; VL_INNER: not chosen yet */
  vlFloatRow pmf;
  vlVec3Row w;            /* towards the light, unit */
  vlVec3Row target;       /* point that must be visible */
  vlFloatRow radiance[4]; /* already divided by the pdf */
  vlFloatRow pdf;    /* per solid angle, times the probability of the light; 0: no sample */
  vlUintRow delta;   /* a delta light: a BSDF sample cannot hit it */
  vlUintRow distant; /* 1: the target is infinitely far, and target holds the direction */
} vlLightSamples;

typedef struct vlShadowRays {
  vlVec3Row o, d;
  vlFloatRow t_max;
  vlFloatRow radiance[4];
  vlUintRow lane;
  vlFloatRow time;   /* the world's time; only set if something moves */
  vlUintRow crossed; /* vlRays.crossed */
  uint8_t occluded[VL_ROW_SIZE];
} vlShadowRays;

/* Sets the way of shadow ray k, of path i. */
static inline void vl_shadow_way(const vlPaths *p, uint32_t i, vlVec3 o, vlVec3 d, float t_max,
                                 uint32_t k, vlShadowRays *q) {
  vl_set_row3(&q->o, k, o);
  vl_set_row3(&q->d, k, d);
  q->t_max[k] = t_max;
  q->time[k] = vl_path_time(p, i);
  q->lane[k] = p->lane[i];
}
/* Moves the way and the radiance of shadow ray i to index k. */
static inline void vl_shadow_move(vlShadowRays *q, uint32_t i, uint32_t k) {
  vl_set_row3(&q->o, k, vl_row3(&q->o, i));
  vl_set_row3(&q->d, k, vl_row3(&q->d, i));
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
  vlVec3 n = vl_mul(vl_vec3(f->n.x[i], f->n.y[i], f->n.z[i]), 1.0f - f->no_cosine[i]);
  return (vlReceiver){vl_vec3(f->p.x[i], f->p.y[i], f->p.z[i]), n, f->side[i]};
}
static inline vlReceiver vl_receiver_before(const vlPaths *p, uint32_t i) {
  vlReceiver r = {vl_row3(&p->o, i), vl_row3(&p->from_n, i), p->from_side[i]};
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
  p->from_n.x[k] = p->from_n.y[k] = p->from_n.z[k] = p->from_side[k] = 0.0f;
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
  vl_set_row3(&b->o, k, vl_row3(&a->o, i));
  vl_set_row3(&b->d, k, vl_row3(&a->d, i));
  vl_set_row3(&b->from_n, k, vl_row3(&a->from_n, i));
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
