/* material/bump_inputs.hot.c: bump and normal maps over a run of lanes: both change the shading
 * normal; bump maps change dpdu, too. */
#include "material/inputs.hot.h"

/* Shifts of uv for bump maps. Those below MIN_STEP are a few roundings of a uv near 1 (6e-8):
 * the difference of heights would be noise. DEFAULT_STEP is pbrt's for surfaces without a
 * footprint. */
#define MIN_STEP 1e-6f
#define DEFAULT_STEP 0.0005f

/* n, or -n, on the side of `side`. */
static vlVec3 facing(vlVec3 n, vlVec3 side) {
  return vl_dot(n, side) < 0.0f ? vl_neg(n) : n;
}

/* Computes dndu and dndv of the interpolated normals of lane i's triangle: 0 without normals or
 * uv. */
static void triangle_normal_slopes(const vlCorners *c, vlSurface *f, uint32_t i) {
  vlVec2 b = vl_corner_weights(c, i, vl_row3(&f->p, i));
  vlVec3 n = vl_corner(c->n, 0, i), m1 = vl_sub(vl_corner(c->n, 1, i), n),
         m2 = vl_sub(vl_corner(c->n, 2, i), n);
  float length = vl_length(vl_add(n, vl_add(vl_mul(m1, b.x), vl_mul(m2, b.y))));
  float u1 = c->uv[2][i] - c->uv[0][i], v1 = c->uv[3][i] - c->uv[1][i];
  float u2 = c->uv[4][i] - c->uv[0][i], v2 = c->uv[5][i] - c->uv[1][i];
  float det = (u1 * v2 - v1 * u2) * length;
  float scale = f->uv_scale[i] > 0.0f && vl_abs(det) > 0.0f ? 1.0f / det : 0.0f;
  vlVec3 ns = vl_row3(&f->n, i);
  vlVec3 du = vl_mul(vl_sub(vl_mul(m1, v2), vl_mul(m2, v1)), scale);
  vlVec3 dv = vl_mul(vl_sub(vl_mul(m2, u1), vl_mul(m1, u2)), scale);
  du = vl_sub(du, vl_mul(ns, vl_dot(du, ns)));
  dv = vl_sub(dv, vl_mul(ns, vl_dot(dv, ns)));
  vl_set_lane3(f->dn[0], f->dn[1], f->dn[2], i, du);
  vl_set_lane3(f->dn[3], f->dn[4], f->dn[5], i, dv);
}

/* A tangent of a flat face, turned as its normal g is turned to n: a tangent of the smooth
 * surface that the vertex normals stand for. Without it, a bump map would show the faces. */
static vlVec3 turned(vlVec3 tangent, vlVec3 g, vlVec3 n) {
  float share = vl_dot(n, tangent) / (1.0f + vl_dot(g, n));
  return vl_sub(tangent, vl_mul(vl_add(g, n), share));
}

/* Bump mapping: the surface p + h n has the derivatives dpdu + h' n + h dndu, and likewise in
 * v; h' by finite differences (pbrt book 10.5.3). */
void vl_stage_bump(vlTextureRun *r, int32_t node) {
  vlSurface *f = &r->at->surface;
  float *h = vl_texture_row(r), *hu = vl_texture_row(r), *hv = vl_texture_row(r),
        *step = vl_texture_row(r);
  float *su = vl_texture_row(r), *sv = vl_texture_row(r), *x = vl_texture_row(r),
        *y = vl_texture_row(r), *z = vl_texture_row(r);
  vl_texture_float(r, node, h);
  for (uint32_t i = r->first; i < r->last; i++) {
    float w = 0.5f * f->width[i] * f->uv_scale[i];
    step[i] = w > MIN_STEP ? w : DEFAULT_STEP;
  }
  r->shift_u = su;
  r->shift_v = sv;
  r->shift_x = x;
  r->shift_y = y;
  r->shift_z = z;
  for (uint32_t i = r->first; i < r->last; i++) {
    su[i] = step[i];
    sv[i] = 0.0f;
    x[i] = step[i] * f->dpdu.x[i];
    y[i] = step[i] * f->dpdu.y[i];
    z[i] = step[i] * f->dpdu.z[i];
  }
  vl_texture_float(r, node, hu);
  for (uint32_t i = r->first; i < r->last; i++) {
    su[i] = 0.0f;
    sv[i] = step[i];
    x[i] = step[i] * f->dpdv.x[i];
    y[i] = step[i] * f->dpdv.y[i];
    z[i] = step[i] * f->dpdv.z[i];
  }
  vl_texture_float(r, node, hv);
  r->shift_u = NULL;
  for (uint32_t i = r->first; i < r->last; i++) {
    if (r->world->shapes.items[r->at->hits.shape[i]].triangles)
      triangle_normal_slopes(&r->s->corners, f, i);
    vlVec3 n = vl_row3(&f->n, i);
    vlVec3 g = facing(vl_row3(&f->g, i), n);
    vlVec3 du = turned(vl_row3(&f->dpdu, i), g, n);
    vlVec3 dv = turned(vl_row3(&f->dpdv, i), g, n);
    du = vl_add(du, vl_mul(n, (hu[i] - h[i]) / step[i]));
    dv = vl_add(dv, vl_mul(n, (hv[i] - h[i]) / step[i]));
    du = vl_add(du, vl_mul(vl_lane3(f->dn[0], f->dn[1], f->dn[2], i), h[i]));
    dv = vl_add(dv, vl_mul(vl_lane3(f->dn[3], f->dn[4], f->dn[5], i), h[i]));
    vlVec3 m = vl_cross(du, dv);
    if (!(vl_length2(m) > 0.0f))
      continue;
    m = facing(vl_normalize(m), n);
    vl_set_row3(&f->n, i, m);
    vl_set_row3(&f->dpdu, i, du);
  }
}

void vl_stage_normal_map(vlTextureRun *r, int32_t image) {
  vlSurface *f = &r->at->surface;
  const vlMipmap *mip = r->world->images.items[image].mipmap;
  if (mip->channels < 3)
    return;
  for (uint32_t i = r->first; i < r->last; i++) {
    vlTexel t = vl_bilinear(mip, f->u[i], 1.0f - f->v[i], VL_WRAP_REPEAT);
    vlVec3 local = vl_normalize(vl_vec3(2 * t.c[0] - 1, 2 * t.c[1] - 1, 2 * t.c[2] - 1));
    vlVec3 n = vl_row3(&f->n, i), u = vl_row3(&f->dpdu, i);
    vlVec3 x = vl_normalize(vl_sub(u, vl_mul(n, vl_dot(u, n))));
    vlFrame frame = {x, vl_cross(n, x), n};
    vlVec3 m = vl_normalize(vl_from_local(frame, local));
    if (!(vl_length2(m) > 0.0f))
      continue;
    vl_set_row3(&f->n, i, m);
  }
}
