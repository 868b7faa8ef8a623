/* light/light.hot.c: takes one light sample for each lane; samples area lights, and computes
 * their densities for multiple importance sampling (pbrt book 12). The code is scalar because
 * the kinds of light diverge. */
#include "light/area.hot.h"
#include "light/coverage.hot.h"
#include "light/kinds.hot.h"
#include "light/kinds.row.h"
#include "light/light_kind.h"
#include "light/spread.h"
#include "math/warp.h"
#include "shape/surface_point.h"
#include "texture/lookup.h"

#define DECLARE(kind, row, power, compile, sample, emit, density) vlSampleLight sample;
VL_LIGHT_FUNCTIONS(DECLARE)

void vl_emitted_at(const vlWorld *world, const vlEmitted *e, const float lambda[4], float s,
                   float t, bool sky, float out[4]) {
  if (e->image < 0) {
    for (int c = 0; c < 4; c++)
      out[c] = vl_spectral_at(&e->spectrum, c, lambda[c]);
    return;
  }
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  vlTexel x;
  if (e->node > 0) {
    vlTexturePoint at = {s, 1.0f - t,     vl_vec3(0, 0, 0), vl_vec3(0, 0, 1),
                         0, {0, 0, 0, 0}, {1, 1, 1, 1}};
    x = vl_texture_rgba(&world->nodes.items[e->node - 1], mip, at);
  } else {
    x = sky ? vl_octahedral_texel(mip, s, t) : vl_bilinear(mip, s, t, VL_WRAP_CLAMP);
  }
  float rgb[3];
  for (int k = 0; k < 3; k++) {
    float y = e->image_scale * x.c[mip->channels < 3 && e->node == 0 ? 0 : k];
    rgb[k] = y > 0.0f ? y : 0.0f;
  }
  if (world->def.color == VL_COLOR_RGB) {
    vl_store3(rgb, vl_to_srgb(&e->to_srgb, vl_load3(rgb)));
    for (int c = 0; c < 4; c++)
      out[c] = c < 3 ? rgb[c] * e->spectrum.scale : 0.0f;
    return;
  }
  vl_upsample(vl_rgb_table(e->space), false, rgb, lambda, out);
  for (int c = 0; c < 4; c++)
    out[c] *= vl_spectral_at(&e->spectrum, c, lambda[c]);
}

/* ---- area lights ------------------------------------------------------------------------- */

vlLightPoint vl_light_point_at(const vlWorld *world, const vlWorldLight *light,
                               const float b[3]) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  const float *q = light->corners;
  const uint32_t *f = s->indices + 3 * (size_t)light->prim;
  vlVec3 p0 = vl_load3(q), p1 = vl_load3(q + 3), p2 = vl_load3(q + 6), ns = {0, 0, 0};
  vlLightPoint r = {.n = vl_load3(light->direction),
                    .pdf = light->area > 0.0f ? 1.0f / light->area : 0.0f,
                    .weights = {b[0], b[1], b[2]}};
  r.p = vl_add(vl_add(vl_mul(p0, b[0]), vl_mul(p1, b[1])), vl_mul(p2, b[2]));
  r.offset = vl_triangle_offset(r.n, r.p, p0, p1, p2, b[0], b[1], b[2], 0.0f);
  for (int k = 0; !light->one_sided_normals && k < 3; k++)
    ns = vl_add(ns, vl_mul(vl_load3(s->normals + 3 * (size_t)f[k]), b[k]));
  if (vl_dot(r.n, ns) < 0.0f)
    r.n = vl_neg(r.n);
  if (world->emitted.items[light->emitted].image >= 0) {
    vlVec2 uv = vl_triangle_uv(s->emission_uvs ? s->emission_uvs : s->uvs, f, b);
    r.u = uv.x;
    r.v = uv.y;
  }
  return r;
}

vlLightPoint vl_light_point_on(const vlWorldLight *light, const vlWorldShape *s, float u,
                               float v) {
  vlSurfacePoint at;
  double pdf;
  vl_shape_sample(s, light->prim, u, v, &at, &pdf);
  return (vlLightPoint){.p = vl_vec3((float)at.p[0], (float)at.p[1], (float)at.p[2]),
                        .n = vl_vec3((float)at.n[0], (float)at.n[1], (float)at.n[2]),
                        .offset = vl_point_offset(&at),
                        .pdf = (float)pdf,
                        .u = at.uv[0],
                        .v = at.uv[1]};
}

/* Whether a light is a whole sphere whose far side sends no light through the near one: it is
 * opaque, only its light is visible, or it is an interface and emits outwards only. As in
 * pbrt-v4, the near side of such a sphere emits towards points outside, and all of it towards
 * points inside. A sphere with alpha holes does not count, because its far side is visible
 * through them. */
static bool round_light(const vlWorldShape *s, const vlWorldLight *light, vlVec3 *center,
                        float *radius) {
  return (s->alpha < 0 || light->invisible) && !light->far_side_seen &&
         vl_whole_sphere(s, center, radius);
}

typedef struct Near {
  vlSphericalTriangle cap;
  bool near;
} Near;

static Near near_triangle(const vlWorldLight *light, vlVec3 from) {
  Near r;
  r.near = false;
  vlTriangleSeen seen = vl_triangle_from(light->corners, from);
  if (!vl_triangle_maybe_near(seen, light->area))
    return r;
  r.cap = vl_triangle_cap(seen);
  r.near = vl_triangle_cap_near(r.cap.solid_angle);
  return r;
}

static vlLightPoint sample_triangle(const vlWorld *world, const vlWorldLight *light,
                                    vlVec3 from, float u, float v) {
  vlVec2 b01 = vl_warp_triangle(u, v);
  float b[3] = {b01.x, b01.y, 1.0f - b01.x - b01.y};
  Near near = near_triangle(light, from);
  if (near.near)
    vl_store3(b, vl_triangle_weights(vl_triangle_from(light->corners, from),
                                     vl_warp_spherical_triangle(near.cap, u, v)));
  vlLightPoint r = vl_light_point_at(world, light, b);
  r.pdf = near.near ? 1.0f / near.cap.solid_angle : vl_solid_pdf(r.pdf, from, r.p, r.n);
  return r;
}

vlVec2 vl_emission_uv(const vlWorld *world, const vlWorldLight *light, const vlPoint *at) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  vlVec2 uv = {at->u, at->v};
  if (!s->emission_uvs)
    return uv;
  const float *q = light->corners;
  vlVec3 a = vl_load3(q), e1 = vl_sub(vl_load3(q + 3), a), e2 = vl_sub(vl_load3(q + 6), a);
  vlVec3 g = vl_cross(e1, e2), way = vl_sub(at->p, a);
  float total = vl_length2(g), inv = total > 0.0f ? 1.0f / total : 0.0f;
  float b1 = vl_dot(vl_cross(way, e2), g) * inv, b2 = vl_dot(vl_cross(e1, way), g) * inv;
  const float b[3] = {1.0f - b1 - b2, b1, b2};
  return vl_triangle_uv(s->emission_uvs, s->indices + 3 * (size_t)light->prim, b);
}

/* Samples a point of a light by the solid angle at `from`, which its pdf is per. */
static vlLightPoint sample_area(const vlWorld *world, const vlWorldLight *light, vlVec3 from,
                                float u, float v) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  if (s->triangles)
    return sample_triangle(world, light, from, u, v);
  vlVec3 center;
  float radius;
  if (round_light(s, light, &center, &radius) &&
      vl_outside_sphere(vl_sub(center, from), radius)) {
    vlSphereSample at = vl_sample_sphere(center, radius, s->flip ? -1.0f : 1.0f, from, u, v);
    vlLightPoint r = {.p = at.p, .n = at.n, .offset = light->corners[5], .pdf = at.pdf};
    if (world->emitted.items[light->emitted].image >= 0) { /* the shape computes uv */
      vlShapeHit hit = {.t = 0};
      vlSurfacePoint point;
      for (int i = 0; i < 3; i++)
        hit.p[i] = s->to_shape[4 * i] * r.p.x + s->to_shape[4 * i + 1] * r.p.y +
                   s->to_shape[4 * i + 2] * r.p.z + s->to_shape[4 * i + 3];
      vl_shape_point(s, light->prim, &hit, &point);
      r.u = point.uv[0];
      r.v = point.uv[1];
    }
    return r;
  }
  vlLightPoint r = vl_light_point_on(light, s, u, v);
  r.pdf = vl_solid_pdf(r.pdf, from, r.p, r.n);
  return r;
}

float vl_area_pdf(const vlWorld *world, const vlWorldLight *light, vlVec3 from,
                  const vlPoint *at) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  if (s->triangles) {
    Near near = near_triangle(light, from);
    if (near.near)
      return 1.0f / near.cap.solid_angle;
    return light->area > 0.0f ? vl_solid_pdf(1.0f / light->area, from, at->p, at->g) : 0.0f;
  }
  vlVec3 center;
  float radius;
  if (round_light(s, light, &center, &radius)) {
    vlVec3 to = vl_sub(center, from);
    float d2 = vl_length2(to);
    if (vl_outside_sphere(to, radius))
      return 1.0f / (2.0f * VL_PI * vl_sphere_cone(radius * radius / d2));
  }
  vlSurfacePoint point;
  point.p[0] = at->p.x;
  point.p[1] = at->p.y;
  point.p[2] = at->p.z;
  return vl_solid_pdf((float)vl_shape_pdf(s, light->prim, &point), from, at->p, at->g);
}

/* ---- one sample per lane ----------------------------------------------------------------- */

static void sample_face(const vlLightQuery *q, vlLightSample *out) {
  const vlWorldLight *light = q->light;
  vlLightPoint at = sample_area(q->world, light, q->p, q->u, q->v);
  vlVec3 w = vl_normalize(vl_sub(at.p, q->p));
  float facing = -vl_dot(w, at.n);
  if (!(facing > 0.0f) && !(q->emitted->two_sided && facing < 0.0f))
    return;
  if (!(at.pdf > 0.0f))
    return;
  vl_emitted_at(q->world, q->emitted, q->lambda, at.u, 1.0f - at.v, false, out->radiance);
  vl_spread_radiance(q->emitted, vl_abs(facing), out->radiance);
  const vlWorldShape *shape = &q->world->shapes.items[light->shape];
  if (light->invisible) {
    out->delta = true;
  } else if (shape->alpha >= 0) {
    float cover = vl_light_coverage(q->world, light, at.p, at.n, at.u, at.v, at.weights);
    for (int c = 0; c < 4; c++)
      out->radiance[c] *= cover;
  }
  out->target = vl_offset_end(at.p, facing < 0.0f ? vl_neg(at.n) : at.n, at.offset, w, q->p);
  out->w = w;
  out->pdf = at.pdf;
}

static inline void sample_kind(const vlLightQuery *q, vlLightSample *out) {
  switch (q->light->kind) {
#define SAMPLE(kind, row, power, compile, sample, emit, density) \
  case kind:                                                     \
    sample(q, out);                                              \
    break;
    VL_LIGHT_FUNCTIONS(SAMPLE)
#undef SAMPLE
    case VL_LIGHT_AREA:
      sample_face(q, out);
      break;
    default:
      break;
  }
}

/* Samples the light that lane i has chosen. */
static void sample_one(const vlWorld *world, uint32_t i, const vlPaths *paths, vlVec3 p,
                       float u, float v, vlLightSamples *out) {
  const vlWorldLight *light = &world->lights.items[out->light[i]];
  float lambda[4];
  vl_path_lambda(paths, i, lambda);
  vlLightQuery q = {world, light, &world->emitted.items[light->emitted], lambda, p, u, v};
  vlLightSample sample;
  sample.pdf = 0.0f;
  sample.delta = sample.distant = false;
  sample_kind(&q, &sample);
  out->delta[i] = sample.delta;
  out->distant[i] = sample.distant;
  if (!(sample.pdf > 0.0f) || !(sample.pdf < VL_INFINITY))
    return;
  float total = sample.pdf * out->pmf[i], inv = 1.0f / total;
  out->pdf[i] = total;
  vl_set_row3(&out->w, i, sample.w);
  vl_set_row3(&out->target, i, sample.target);
  for (int c = 0; c < 4; c++)
    out->radiance[c][i] = sample.radiance[c] * inv;
}

/* ---- many lanes -------------------------------------------------------------------------- */

/* Lanes that wait until there are enough of them to be sampled together. */
typedef struct Group {
  uint32_t count, lanes[VL_AREA_BLOCK];
} Group;
typedef void SampleGroup(const vlWorld *world, const vlPaths *paths, const vlSurface *f,
                         const uint32_t *lanes, uint32_t count, const float *u, const float *v,
                         vlLightSamples *out);

/* Samples environment maps for the lanes of a list, which have chosen such lights. Lanes with
 * the same light are sampled together. */
static void sample_environments(const vlWorld *world, const vlPaths *paths, uint32_t *lanes,
                                uint32_t count, const float *u, const float *v,
                                vlLightSamples *out) {
  while (count > 0) {
    uint32_t same[VL_SKY_BLOCK], light = out->light[lanes[0]], taken = 0, rest = 0;
    for (uint32_t k = 0; k < count; k++) {
      if (taken < VL_SKY_BLOCK && out->light[lanes[k]] == light)
        same[taken++] = lanes[k];
      else
        lanes[rest++] = lanes[k];
    }
    vl_sample_environment(world, &world->lights.items[light], paths, same, taken, u, v, out);
    count = rest;
  }
}

void vl_stage_lights(const vlWorld *world, uint32_t n, const vlPaths *paths, const vlSurface *f,
                     const float *u_choice, const float *v, const float *spare,
                     vlLightSamples *out) {
  static SampleGroup *const sample_group[] = {vl_sample_triangles, vl_sample_spheres};
  const float min_pmf = 1.0f / 256.0f; /* leaves 16 of the 24 bits */
  float u[VL_ROW_SIZE];
  vlLanesByLight chosen;
  vl_stage_light_choice(&world->tree, n, f, u_choice, out, u, &chosen);
  for (uint32_t i = 0; i < n; i++)
    u[i] = out->pmf[i] < min_pmf ? spare[i] : u[i];
  uint32_t skies[VL_ROW_SIZE], sky_count = 0;
  Group groups[2] = {{.count = 0}, {.count = 0}}; /* triangles, spheres */
  for (uint32_t i = 0; i < n; i++) {
    out->pdf[i] = 0.0f;
    out->w.x[i] = out->w.y[i] = out->w.z[i] = 0.0f;
  }
  for (uint32_t k = 0; k < chosen.count; k++) {
    uint32_t i = chosen.lane[k];
    const vlWorldLight *light = &world->lights.items[out->light[i]];
    vlVec3 p = vl_row3(&f->p, i);
    if (vl_light_is_environment(world, light)) {
      skies[sky_count++] = i;
    } else if (light->plain_triangle ||
               (light->plain_sphere && vl_outside_plain_sphere(light, p))) {
      Group *g = &groups[light->plain_sphere];
      g->lanes[g->count++] = i;
      if (g->count < VL_AREA_BLOCK)
        continue;
      sample_group[light->plain_sphere](world, paths, f, g->lanes, g->count, u, v, out);
      g->count = 0;
    } else {
      sample_one(world, i, paths, p, u[i], v[i], out);
    }
  }
  for (int k = 0; k < 2; k++)
    if (groups[k].count)
      sample_group[k](world, paths, f, groups[k].lanes, groups[k].count, u, v, out);
  sample_environments(world, paths, skies, sky_count, u, v, out);
}
