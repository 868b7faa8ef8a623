/* trace/surface/hits.hot.c: finds closest hits of rays, with passage through interfaces and the
 * choice of mixed materials; and adds the radiance of lights that rays hit, with MIS weights
 * against light sampling (pbrt book 13.4). */
#include "math/hash.h"
#include "trace/stages.h"
#include "velo/schema.h"
#include "world/accel/local_ray.h"

/* The largest number of surfaces that a ray passes; no scene has so many along a ray. */
enum { MAX_PASSED = 1024 };

/* ---- lights that rays hit ---------------------------------------------------------------- */

void vl_add_hit_light(vlTracing *t, const vlPaths *p, VL_UNUSED const vlVolumeRows *rows,
                      VL_UNUSED const vlFlightEnds *ends, uint32_t i, const vlHitLight *met,
                      VL_UNUSED bool sky) {
  float weight = p->specular[i] ? 1.0f : vl_power_heuristic(p->pdf[i], met->pdf);
  vl_add_radiance(t, p, i, met->radiance, weight);
}

vlPoint vl_hit_point(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i) {
  vlVec3 o = vl_row3(&p->o, i), d = vl_row3(&p->d, i);
  return vl_point_at_time(world, vl_path_time(p, i), o, d, h->shape[i], h->prim[i],
                          h->instance[i], h->t[i]);
}

void vl_stage_emission(vlTracing *t, uint32_t n, const vlPaths *rays, const vlHits *hits) {
  vl_stage_lights_hit(t, n, rays, hits, NULL, NULL, vl_add_hit_light);
}

/* ---- hits -------------------------------------------------------------------------------- */

/* The triangle that a path's ray hits, and the weights of its corners there, for vertex
 * attributes (uv sets, colours). Other shapes have none: their weights are not used. */
static vlTextureCorner hit_corner(const vlWorld *world, const vlPaths *p, const vlHits *h,
                                  uint32_t i) {
  vlTextureCorner corner = {&world->shapes.items[h->shape[i]], h->prim[i], {1, 0, 0}};
  if (!corner.shape->triangles)
    return corner;
  float time = vl_path_time(p, i);
  vlRays rays = vl_rays_of(&p->o, &p->d, i, NULL, NULL, &time);
  vlLocalRay ray = vl_local_ray(world, &rays, 0, h->instance[i]);
  vlTextureQuery at;
  vl_local_triangle(corner.shape, corner.prim, &ray, &at, corner.weights);
  return corner;
}

/* The share of a material that is not interface. */
static float presence_of(const vlWorld *world, uint32_t material, const vlTextureQuery *at) {
  const vlWorldMaterial *m = &world->materials.items[material];
  return m->nothing         ? 0.0f
         : m->presence >= 0 ? vl_texture_float_at(world, m->presence, at)
                            : 1.0f;
}

/* A hash of the ray chooses one of a mixed material's materials, so that the choice needs no
 * sampler dimension. */
uint32_t vl_hit_material(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i) {
  uint32_t material = world->shapes.items[h->shape[i]].material;
  /* the materials of a mix have smaller indices than the mix, so the loop ends */
  while (world->materials.items[material].mixed) {
    const vlWorldMaterial *m = &world->materials.items[material];
    vlVec3 d = vl_row3(&p->d, i);
    vlPoint at = vl_hit_point(world, p, h, i);
    vlTextureCorner corner = hit_corner(world, p, h, i);
    vlTextureQuery query = {at.u, at.v, at.p, at.g, &corner};
    float amount = vl_texture_float_at(world, m->amount, &query);
    if (m->presence >= 0) { /* the ray has hit what is not interface */
      float first = (1.0f - amount) * presence_of(world, m->mix[0], &query);
      float second = amount * presence_of(world, m->mix[1], &query);
      if (first + second > 0.0f)
        amount = second / (first + second);
    }
    uint32_t hash = vl_hash3(vl_float_bits(d.x), vl_float_bits(d.y), vl_float_bits(d.z));
    hash = vl_hash3(hash, vl_float_bits(at.p.x), vl_float_bits(at.p.y));
    hash = vl_hash3(hash, vl_float_bits(at.p.z), material);
    material = m->mix[vl_unit_float(hash) < amount ? 1 : 0];
  }
  return material;
}

void vl_pass_hidden(const vlTracing *t, uint32_t n, const vlRays *rays, uint32_t *shape,
                    uint32_t *prim, uint32_t *instance, float *hit) {
  const vlWorld *world = t->world;
  for (uint32_t i = 0; i < n; i++) {
    vlVec3 o = vl_ray_origin(rays, i), d = vl_ray_direction(rays, i);
    float t_min = rays->t_min ? rays->t_min[i] : 0.0f, time = rays->time ? rays->time[i] : 0.0f;
    vlRays ray = vl_one_ray(&o, &d, &t_min, rays->t_max ? rays->t_max + i : NULL, &time);
    for (uint32_t step = 0; shape[i] != VL_NONE && world->shapes.items[shape[i]].hidden;
         step++) {
      vlPoint at = vl_point_at_time(world, time, o, d, shape[i], prim[i], instance[i], hit[i]);
      t_min = vl_past_surface(&at, d, t_min);
      vl_accel_closest(world, 1, &ray, false, shape + i, prim + i, instance + i, hit + i);
      t->batch->bounce_rays++;
      if (step == MAX_PASSED)
        shape[i] = VL_NONE;
    }
  }
}

void vl_closest_hits(const vlTracing *t, uint32_t n, bool camera, const vlPaths *p, vlHits *h) {
  const float *t_min = camera ? t->batch->rays.t_min : NULL,
              *t_max = camera ? t->batch->rays.t_max : NULL;
  vlFloatRow time;
  vlRays rays = vl_rays_of(&p->o, &p->d, 0, t_min, t_max, vl_path_times(p, n, time));
  vl_accel_closest(t->world, n, &rays, camera, h->shape, h->prim, h->instance, h->t);
  if (camera && t->world->has_hidden)
    vl_pass_hidden(t, n, &rays, h->shape, h->prim, h->instance, h->t);
}

/* Traces lane i's ray again from t_min on, and writes the hit to h. camera: it is a camera ray.
 * t_max: the batch's row, or null for no limit. The ray is counted. */
static void closest_beyond(vlTracing *t, const vlPaths *p, vlHits *h, uint32_t i, bool camera,
                           float t_min, const float *t_max) {
  float time = vl_path_time(p, i);
  vlRays ray =
      vl_rays_of(&p->o, &p->d, i, &t_min, t_max ? t_max + i : NULL, p->time ? &time : NULL);
  vl_accel_closest(t->world, 1, &ray, false, h->shape + i, h->prim + i, h->instance + i,
                   h->t + i);
  t->batch->bounce_rays++;
  if (camera && t->world->has_hidden)
    vl_pass_hidden(t, 1, &ray, h->shape + i, h->prim + i, h->instance + i, h->t + i);
}

/* Passes interface surfaces, which do not change the ray's direction. The ray keeps its origin,
 * which multiple importance sampling needs, and its end. */
static void pass_interfaces(vlTracing *t, vlAddLight *pass_light, const vlPaths *p, vlHits *h,
                            uint32_t i, bool camera, const float *t_max) {
  const vlWorld *world = t->world;
  float t_min = 0;
  for (int step = 0; h->shape[i] != VL_NONE; step++) {
    if (!(world->materials.items[world->shapes.items[h->shape[i]].material].traits &
          VL_MATERIAL_ABSENT))
      return;
    if (step == MAX_PASSED) {
      h->shape[i] = VL_NONE;
      return;
    }
    vlHitLight met;
    if (pass_light && world->shapes.items[h->shape[i]].first_light != VL_NONE &&
        vl_hit_emission(world, p, h, i, &met))
      pass_light(t, p, NULL, NULL, i, &met, false);
    vlVec3 d = vl_row3(&p->d, i);
    vlPoint at = vl_hit_point(world, p, h, i);
    t_min = vl_past_surface(&at, d, t_min);
    closest_beyond(t, p, h, i, camera, t_min, t_max);
  }
}

void vl_stage_hits(vlTracing *t, uint32_t n, bool camera, vlAddLight *pass_light,
                   const vlPaths *p, vlHits *h) {
  vl_closest_hits(t, n, camera, p, h);
  if (!camera)
    t->batch->bounce_rays += n;
  const vlWorldShape *shapes = t->world->shapes.items;
  if (!t->world->has_interfaces && !t->world->has_mixtures) {
    for (uint32_t i = 0; i < n; i++)
      h->material[i] = h->shape[i] == VL_NONE ? 0 : shapes[h->shape[i]].material;
    return;
  }
  for (uint32_t i = 0; i < n; i++) {
    if (h->shape[i] == VL_NONE)
      continue;
    if (t->world->has_interfaces)
      pass_interfaces(t, pass_light, p, h, i, camera, camera ? t->batch->rays.t_max : NULL);
    if (h->shape[i] != VL_NONE)
      h->material[i] = vl_hit_material(t->world, p, h, i);
  }
}

/* Alpha is 1 where the camera ray hits a surface that is no backdrop. */
void vl_stage_alpha(const vlTracing *t, const vlHits *hits) {
  for (uint32_t i = 0; i < t->batch->n; i++) {
    uint32_t shape = hits->shape[i];
    t->batch->alpha[i] =
        shape == VL_NONE || t->world->shapes.items[shape].backdrop ? 0.0f : 1.0f;
  }
}
