/* light/emission_sample.hot.c: samples rays that leave lights, and computes their densities, of
 * all kinds and of emissive shapes (pbrt book 12; 3rd edition 16.1.2). The code is scalar
 * because each lane has its own light. */
#include "light/area.hot.h"
#include "light/coverage.hot.h"
#include "light/kinds.hot.h"
#include "light/kinds.row.h"
#include "light/light_kind.h"
#include "light/spread.h"
#include "math/warp.h"
#include "shape/surface_point.h"

#define DECLARE(kind, row, power, compile, sample, emit, density) \
  vlEmitLight emit;                                               \
  vlLightDensity density;
VL_LIGHT_FUNCTIONS(DECLARE)

static float choice_of(const vlTwoWay *way, uint32_t light) {
  return way->choice[light + 1] - way->choice[light];
}

/* Density of an area light's points, per area. */
static float point_density(const vlWorld *world, const vlWorldLight *light, vlVec3 p) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  if (s->triangles)
    return light->area > 0.0f ? 1.0f / light->area : 0.0f;
  vlSurfacePoint point;
  point.p[0] = p.x;
  point.p[1] = p.y;
  point.p[2] = p.z;
  return (float)vl_shape_pdf(s, light->prim, &point);
}

/* Whether the outside of a whole sphere emits. */
static bool emits_outwards(const vlWorld *world, const vlWorldLight *light) {
  return world->emitted.items[light->emitted].two_sided ||
         !world->shapes.items[light->shape].flip;
}

/* The share of an area light's paths that start on the side visible from direction w. */
static float side_share(const vlWorld *world, const vlWorldLight *light, vlVec3 p, vlVec3 w) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  if (!light->outer_side)
    return world->emitted.items[light->emitted].two_sided ? 0.5f : 1.0f;
  vlVec3 center =
      vl_vec3((float)s->from_shape[3], (float)s->from_shape[7], (float)s->from_shape[11]);
  return emits_outwards(world, light) && vl_dot(vl_sub(p, center), w) < 0.0f ? 1.0f : 0.0f;
}

static float face_density(const vlWorld *world, const vlWorldLight *light, float p, vlVec3 w,
                          VL_UNUSED float distance, const vlPoint *at) {
  /* also outside of a spread, from where no light comes */
  float sin2 = world->emitted.items[light->emitted].spread_sin2;
  return p * VL_INV_PI / sin2 * point_density(world, light, at->p) *
         side_share(world, light, at->p, w);
}

float vl_emission_density(const vlWorld *world, const vlTwoWay *way, uint32_t index, vlVec3 w,
                          float distance, const vlPoint *at) {
  const vlWorldLight *light = &world->lights.items[index];
  float p = choice_of(way, index);
  if (!(p > 0.0f))
    return 0.0f;
  switch (light->kind) {
#define DENSITY(kind, row, power, compile, sample, emit, density) \
  case kind:                                                      \
    return density(world, light, p, w, distance, at);
    VL_LIGHT_FUNCTIONS(DENSITY)
#undef DENSITY
    case VL_LIGHT_AREA:
      return face_density(world, light, p, w, distance, at);
    default:
      return 0.0f;
  }
}

float vl_emission_area_pdf(const vlWorld *world, const vlTwoWay *way, uint32_t light,
                           vlVec3 at) {
  return choice_of(way, light) * point_density(world, &world->lights.items[light], at);
}

/* ---- area lights ------------------------------------------------------------------------- */

static vlLightPoint random_point(const vlWorld *world, const vlWorldLight *light, float u,
                                 float v) {
  const vlWorldShape *s = &world->shapes.items[light->shape];
  if (!s->triangles)
    return vl_light_point_on(light, s, u, v);
  vlVec2 b = vl_warp_triangle(u, v);
  const float weights[3] = {b.x, b.y, 1.0f - b.x - b.y};
  return vl_light_point_at(world, light, weights);
}

/* A direction of the cosine hemisphere about z, drawn together into the spread. */
static vlVec3 narrow(const vlEmitted *e, vlVec3 local) {
  if (!vl_has_spread(e))
    return local;
  float by = __builtin_sqrtf(e->spread_sin2), x = by * local.x, y = by * local.y;
  return vl_vec3(x, y, vl_safe_sqrt(1.0f - x * x - y * y));
}

static void emit_from_face(const vlEmissionQuery *q, vlEmission *out) {
  const vlWorld *world = q->world;
  const vlWorldLight *light = q->light;
  const vlEmitted *e = q->emitted;
  float s = q->s, t = q->t;
  const vlWorldShape *shape = &world->shapes.items[light->shape];
  vlLightPoint at = random_point(world, light, q->u, q->v);
  if (!(at.pdf > 0.0f) || (light->outer_side && !emits_outwards(world, light)))
    return;
  float sides = 1.0f;
  vlVec3 side = light->outer_side && shape->flip ? vl_neg(at.n) : at.n;
  if (e->two_sided && !light->outer_side) {
    sides = 2.0f;
    bool back = s >= 0.5f;
    s = vl_min(2.0f * (back ? s - 0.5f : s), VL_ONE_MINUS_EPSILON);
    if (back)
      side = vl_neg(side);
  }
  vlVec3 local = narrow(e, vl_warp_cosine_hemisphere(s, t));
  out->share = vl_spread_at(e, local.z);
  if (!(local.z > 0.0f && out->share > 0.0f))
    return;
  out->d = vl_normalize(vl_from_local(vl_frame_from_z(side), local));
  out->o = vl_offset_origin(at.p, side, at.offset, out->d);
  out->at = at.p;
  out->n = at.n;
  vl_emitted_at(world, e, q->lambda, at.u, 1.0f - at.v, false, out->flux);
  float scale = VL_PI * sides / at.pdf;
  if (shape->alpha >= 0 && !light->invisible)
    scale *= vl_light_coverage(world, light, at.p, at.n, at.u, at.v, at.weights);
  scale *= out->share * e->spread_sin2;
  for (int c = 0; c < 4; c++)
    out->flux[c] *= scale;
  out->density = VL_INV_PI / e->spread_sin2 * at.pdf / sides;
  out->delta = light->invisible;
  out->area_pdf = light->invisible ? 0.0f : at.pdf;
  out->offset = at.offset;
  out->side = sides > 1.0f ? 0.0f : vl_dot(side, at.n) < 0.0f ? -1.0f : 1.0f;
  out->valid = true;
}

/* ---- all lights -------------------------------------------------------------------------- */

void vl_light_emit_from_afar(const vlWorld *world, vlVec3 w, float u, float v,
                             vlEmission *out) {
  vlDiskPoint disk = vl_warp_disk(u, v);
  vlFrame frame = vl_frame_from_z(w);
  float r = world->radius;
  vlVec3 at = vl_add(vl_mul(frame.x, r * disk.x), vl_mul(frame.y, r * disk.y));
  at = vl_add(at, vl_mul(w, r));
  out->o = vl_add(vl_load3(world->center), at);
  out->d = vl_neg(w);
  out->at = w;
  out->valid = true;
}

vlEmission vl_emission_sample(const vlWorld *world, const vlTwoWay *way, const float lambda[4],
                              float u_choice, float u, float v, float s, float t) {
  vlEmission r;
  __builtin_memset(&r, 0, sizeof r);
  float within;
  r.light = vl_find_cell(way->choice, (uint32_t)world->lights.count, u_choice, &within);
  float p = choice_of(way, r.light);
  if (!(p > 0.0f))
    return r;
  const vlWorldLight *light = &world->lights.items[r.light];
  vlEmissionQuery q = {world, light, &world->emitted.items[light->emitted], lambda, u, v, s, t};
  switch (light->kind) {
#define EMIT(kind, row, power, compile, sample, emit, density) \
  case kind:                                                   \
    emit(&q, &r);                                              \
    break;
    VL_LIGHT_FUNCTIONS(EMIT)
#undef EMIT
    case VL_LIGHT_AREA:
      emit_from_face(&q, &r);
      break;
    default:
      break;
  }
  for (int c = 0; c < 4; c++)
    r.flux[c] /= p;
  r.density *= p;
  r.area_pdf *= p;
  return r;
}
