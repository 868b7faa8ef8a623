/* light/area.hot.c: samples plain triangles and spheres (vlWorldLight.plain_triangle and
 * plain_sphere), the most frequent lights, for many lanes at once. It does the same operations
 * as sample_face of light.hot.c. */
#include "light/area.hot.h"

#include "light/kinds.hot.h"

enum { BLOCK = VL_AREA_BLOCK };

/* A block of lanes. The arrays are filled to a multiple of VL_LANES with copies of the last
 * lane. */
typedef struct Block {
  VL_ROW uint32_t lane[BLOCK];
  /* the point that receives light */
  VL_ROW float px[BLOCK], py[BLOCK], pz[BLOCK], u[BLOCK], v[BLOCK];
  /* of spheres only `corner` (vlWorldLight.corners) */
  VL_ROW float corner[9][BLOCK], n[3][BLOCK], area[BLOCK];
  VL_ROW float two_sided[BLOCK];
  VL_ROW float wx[BLOCK], wy[BLOCK], wz[BLOCK], tx[BLOCK], ty[BLOCK], tz[BLOCK];
  VL_ROW float pdf[BLOCK]; /* 0: no sample */
  VL_ROW float lambda[4][BLOCK], radiance[4][BLOCK];
} Block;

static uint32_t gather(const vlWorld *world, const vlPaths *paths, const vlSurface *f,
                       const uint32_t *lanes, uint32_t count, const float *u, const float *v,
                       const vlLightSamples *samples, Block *b) {
  uint32_t padded = VL_PAD(count);
  for (uint32_t k = 0; k < padded; k++) {
    uint32_t i = lanes[k < count ? k : count - 1];
    const vlWorldLight *light = &world->lights.items[samples->light[i]];
    b->lane[k] = i;
    vl_set_lane3(b->px, b->py, b->pz, k, vl_row3(&f->p, i));
    b->u[k] = u[i];
    b->v[k] = v[i];
    for (int c = 0; c < 9; c++)
      b->corner[c][k] = light->corners[c];
    for (int c = 0; c < 3; c++)
      b->n[c][k] = light->direction[c];
    b->area[k] = light->area;
    b->two_sided[k] = world->emitted.items[light->emitted].two_sided ? 1.0f : 0.0f;
    for (int c = 0; c < 4; c++)
      b->lambda[c][k] = paths->lambda[c][i];
  }
  return padded;
}

/* Sets lane k's sample: a point p of the light, its normal, its offset, and its density per
 * solid angle. */
VL_INLINE void arrive(Block *restrict b, uint32_t k, vlVec3 from, vlVec3 p, vlVec3 n,
                      float offset, float pdf) {
  vlVec3 w = vl_normalize(vl_sub(p, from));
  float facing = -vl_dot(w, n), side = facing < 0.0f ? -1.0f : 1.0f;
  int emits = (facing > 0.0f) | ((b->two_sided[k] > 0.0f) & (facing < 0.0f));
  vlVec3 target =
      vl_offset_end(p, vl_vec3(side * n.x, side * n.y, side * n.z), offset, w, from);
  b->pdf[k] = emits & (pdf > 0.0f) & (pdf < VL_INFINITY) ? pdf : 0.0f;
  vl_set_lane3(b->wx, b->wy, b->wz, k, w);
  vl_set_lane3(b->tx, b->ty, b->tz, k, target);
}

static void triangles(uint32_t padded, Block *restrict b) {
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < padded; k++) {
    vlVec3 from = vl_vec3(b->px[k], b->py[k], b->pz[k]),
           n = vl_vec3(b->n[0][k], b->n[1][k], b->n[2][k]);
    vlVec3 p0 = vl_vec3(b->corner[0][k], b->corner[1][k], b->corner[2][k]);
    vlVec3 p1 = vl_vec3(b->corner[3][k], b->corner[4][k], b->corner[5][k]);
    vlVec3 p2 = vl_vec3(b->corner[6][k], b->corner[7][k], b->corner[8][k]);
    float u = b->u[k], v = b->v[k], area = b->area[k];
    vlTriangleSeen seen = {vl_sub(p0, from), vl_sub(p1, from), vl_sub(p2, from)};
    vlSphericalTriangle cap = vl_triangle_cap(seen);
    int near = vl_triangle_maybe_near(seen, area) & vl_triangle_cap_near(cap.solid_angle);
    vlVec2 flat = vl_warp_triangle(u, v);
    vlVec3 round = vl_triangle_weights(seen, vl_warp_spherical_triangle(cap, u, v));
    float b0 = near ? round.x : flat.x, b1 = near ? round.y : flat.y,
          b2 = near ? round.z : 1.0f - flat.x - flat.y;
    vlVec3 p = vl_add(vl_add(vl_mul(p0, b0), vl_mul(p1, b1)), vl_mul(p2, b2));
    float by_area = area > 0.0f ? vl_solid_pdf(1.0f / area, from, p, n) : 0.0f;
    float offset = vl_triangle_offset(n, p, p0, p1, p2, b0, b1, b2, 0.0f);
    arrive(b, k, from, p, n, offset, near ? 1.0f / cap.solid_angle : by_area);
  }
}

static void spheres(uint32_t padded, Block *restrict b) {
  /* must vectorise */
  VL_SIMD
  for (uint32_t k = 0; k < padded; k++) {
    vlVec3 from = vl_vec3(b->px[k], b->py[k], b->pz[k]);
    vlVec3 center = vl_vec3(b->corner[0][k], b->corner[1][k], b->corner[2][k]);
    vlSphereSample s =
        vl_sample_sphere(center, b->corner[3][k], b->corner[4][k], from, b->u[k], b->v[k]);
    arrive(b, k, from, s.p, s.n, b->corner[5][k], s.pdf);
  }
}

/* ---- radiance ---------------------------------------------------------------------------- */

/* Computes the radiance of lanes [first, last) from the same spectrum. */
static void radiance_of(const vlSpectral *s, uint32_t first, uint32_t last, Block *restrict b) {
  for (int c = 0; c < 4; c++) {
    const float *lambda = b->lambda[c];
    float *out = b->radiance[c];
    if (s->kind == VL_SPECTRAL_DENSE) {
      /* must vectorise */
      VL_SIMD
      for (uint32_t k = first; k < last; k++)
        out[k] = s->scale * vl_dense_at(s->dense, lambda[k]);
    } else {
      for (uint32_t k = first; k < last; k++)
        out[k] = vl_spectral_at(s, c, lambda[k]);
    }
  }
}

static const vlEmitted *emitted_of(const vlWorld *world, const vlLightSamples *samples,
                                   uint32_t lane) {
  return &world->emitted.items[world->lights.items[samples->light[lane]].emitted];
}

static void radiance(const vlWorld *world, const vlLightSamples *samples, uint32_t padded,
                     Block *b) {
  for (uint32_t first = 0, last; first < padded; first = last) {
    const vlEmitted *e = emitted_of(world, samples, b->lane[first]);
    for (last = first + 1; last < padded && emitted_of(world, samples, b->lane[last]) == e;)
      last++;
    radiance_of(&e->spectrum, first, last, b);
  }
}

static void store(const Block *b, uint32_t count, vlLightSamples *out) {
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = b->lane[k];
    out->delta[i] = out->distant[i] = false;
    if (!(b->pdf[k] > 0.0f))
      continue;
    float total = b->pdf[k] * out->pmf[i], inv = 1.0f / total;
    out->pdf[i] = total;
    vl_set_row3(&out->w, i, vl_lane3(b->wx, b->wy, b->wz, k));
    vl_set_row3(&out->target, i, vl_lane3(b->tx, b->ty, b->tz, k));
    for (int c = 0; c < 4; c++)
      out->radiance[c][i] = b->radiance[c][k] * inv;
  }
}

typedef void Directions(uint32_t padded, Block *b);

/* Inlined with `directions`, the kernel of triangles or of spheres. */
VL_INLINE void sample_block(Directions *directions, const vlWorld *world, const vlPaths *paths,
                            const vlSurface *f, const uint32_t *lanes, uint32_t count,
                            const float *u, const float *v, vlLightSamples *out) {
  Block b;
  uint32_t padded = gather(world, paths, f, lanes, count, u, v, out, &b);
  directions(padded, &b);
  radiance(world, out, padded, &b);
  store(&b, count, out);
}

void vl_sample_triangles(const vlWorld *world, const vlPaths *paths, const vlSurface *f,
                         const uint32_t *lanes, uint32_t count, const float *u, const float *v,
                         vlLightSamples *out) {
  sample_block(triangles, world, paths, f, lanes, count, u, v, out);
}

void vl_sample_spheres(const vlWorld *world, const vlPaths *paths, const vlSurface *f,
                       const uint32_t *lanes, uint32_t count, const float *u, const float *v,
                       vlLightSamples *out) {
  sample_block(spheres, world, paths, f, lanes, count, u, v, out);
}
