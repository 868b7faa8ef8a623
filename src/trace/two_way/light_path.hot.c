/* trace/two_way/light_path.hot.c: traces light paths. At every vertex that scatters, a light
 * path stores a photon and connects to the camera; two_way.h has the weights. BSDFs carry
 * radiance towards the camera, so light paths use their adjoint (Veach 1997, 5.3): no factor
 * 1/eta^2 at refraction, and a correction for shading normals. */
#include "math/warp.h"
#include "trace/two_way/stages.h"

void vl_stage_reverse(const vlTracing *t, uint32_t n, const vlVertices *at,
                      const float wi[3][VL_ROW_SIZE], vlBsdfValues *back) {
  const vlFloatRow *wo = at->shade.wo;
  /* wo in world space and back: as a light sample's direction is rounded */
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    vlFrame frame = vl_shading_frame(&at->surface, &at->shade, i);
    vlVec3 world = vl_from_local(frame, vl_lane3(wo[0], wo[1], wo[2], i));
    vl_set_lane3(back->wi[0], back->wi[1], back->wi[2], i, vl_to_local(frame, world));
  }
  vl_stage_bsdf(t, n, at, wi, back);
}

void vl_stage_there_and_back(const vlTracing *t, uint32_t n, const vlVertices *at,
                             const vlVec3Row *toward, vlBsdfValues *there, vlBsdfValues *back) {
  vl_stage_local(n, at, toward, there->wi);
  vl_stage_bsdf(t, n, at, at->shade.wo, there);
  vl_stage_reverse(t, n, at, (const float(*)[VL_ROW_SIZE])there->wi, back);
}

/* ---- start ------------------------------------------------------------------------------- */

/* Samples the wavelengths of the batch's paths. */
static void wavelengths(const vlTracing *t, const vlLightBatch *b, vlTwoWayLanes *to) {
  const vlTwoWay *way = t->def->two_way;
  vlFloatRow u;
  float *const lambda[4] = {to->lambda[0], to->lambda[1], to->lambda[2], to->lambda[3]};
  float *const inv_pdf[4] = {to->inv_pdf[0], to->inv_pdf[1], to->inv_pdf[2], to->inv_pdf[3]};
  t->sampler->get_1d(t->def->sampler, b->n, b->px, b->py, b->index, VL_DIM_WAVELENGTH, u);
  for (uint32_t i = 0; way->shared >= 0.0f && i < VL_PAD(b->n); i++)
    u[i] = way->shared;
  for (uint32_t i = 0; way->connect > 0.0f && i < VL_PAD(b->n); i++)
    u[i] = vl_group_wavelength(way, (b->first + i) % way->inner.groups);
  vl_color_kernels(t->def->isa)->visible_wavelengths(b->n, u, lambda, inv_pdf);
}

/* Sets the medium in which the path starts. Returns false for an infinite light in a medium,
 * through which no light arrives. */
static bool start_medium(const vlTracing *t, const vlEmission *e, uint32_t *medium) {
  const vlWorldLight *light = &t->world->lights.items[e->light];
  *medium = t->def->two_way->medium[e->light];
  if (light->shape != VL_NONE)
    *medium = vl_medium_beyond(&t->world->shapes.items[light->shape], e->n, e->d, *medium);
  return *medium == VL_NONE || !light->far;
}

/* Starts the batch's light paths. Returns their number: those that carry light. */
static uint32_t set_out(const vlTracing *t, const vlLightBatch *b, vlTwoWayLanes *lanes,
                        vlPaths *p, vlLightStarts *starts) {
  const vlWorld *world = t->world;
  uint32_t n = b->n, count = 0;
  bool rgb = world->def.color == VL_COLOR_RGB;
  vlNumbers first;
  vlFloatRow u2, v2;
  if (!rgb)
    wavelengths(t, b, lanes);
  const float *u = first.u0, *u1 = first.u1, *v1 = first.u2;
  t->sampler->get_1d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_TIME, first.u0);
  t->sampler->get_2d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_FILM, first.u1,
                     first.u2);
  t->sampler->get_2d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_LENS, u2, v2);
  p->time = b->time;
  for (uint32_t i = 0; i < n; i++) {
    float lambda[4];
    for (int c = 0; c < 4; c++)
      lambda[c] = rgb ? 0.0f : lanes->lambda[c][i];
    vlEmission e =
        vl_emission_sample(world, t->def->two_way, lambda, u[i], u1[i], v1[i], u2[i], v2[i]);
    float max = vl_largest_of4(e.flux);
    if (!e.valid || !(max > 0.0f) || !(max < VL_INFINITY))
      continue;
    if (vl_has_media(t) && !start_medium(t, &e, &starts->medium[i]))
      continue;
    uint32_t k = count++;
    vl_set_row3(&p->o, k, e.o);
    vl_set_row3(&p->d, k, e.d);
    vl_path_start(p, k, b->px[i], b->py[i], b->index[i], i);
    p->cone[k] = p->spread[k] = 0.0f;
    for (int c = 0; c < 4; c++) {
      p->beta[c][k] = 1.0f;
      p->lambda[c][k] = lambda[c];
      lanes->flux[c][i] = e.flux[c];
    }
    lanes->light[i] = e.light;
    lanes->density[i] = e.density;
    /* without 1 / (density cosine), which arrive() applies */
    lanes->carry[i] = e.delta ? 0.0f : 1.0f;
    vl_set_row3(&lanes->l, i, e.at);
    vl_set_row3(&lanes->ln, i, e.n);
    starts->area_pdf[k] = e.area_pdf;
    starts->offset[k] = e.offset;
    starts->side[k] = e.side;
    starts->share[k] = e.share;
  }
  return count;
}

/* Density with which next-event estimation would have sampled the light that this lane's path
 * came from. */
static float light_sample_pdf(const vlTracing *t, uint32_t lane, vlReceiver to, vlVec3 w) {
  const vlWorld *world = t->world;
  const vlTwoWayLanes *x = t->lanes;
  vlVec3 p = to.p;
  const vlWorldLight *light = &world->lights.items[x->light[lane]];
  float pmf = vl_light_pmf(&world->tree, to, x->light[lane]);
  if (light->delta)
    return pmf;
  if (light->far)
    return pmf * vl_infinite_pdf(world, light, p, w);
  vlPoint at;
  __builtin_memset(&at, 0, sizeof at);
  at.p = vl_row3(&x->l, lane);
  at.g = at.n = vl_row3(&x->ln, lane);
  return pmf * vl_area_pdf(world, light, p, &at);
}

/* vl_emission_density of a light path's first ray, after `distance`. */
static float light_density(const vlTracing *t, uint32_t lane, float distance) {
  const vlTwoWayLanes *x = t->lanes;
  return t->world->lights.items[x->light[lane]].at_point
             ? x->density[lane] / (distance * distance)
             : x->density[lane];
}

/* Takes away the light of a path whose first vertex, p, lies outside of its light's portal: a
 * path through a portal starts beyond all shapes, but no point out there sees the light. */
static void shade_outside_portal(const vlTracing *t, uint32_t lane, vlVec3 p) {
  if (!vl_is_outside_portal(t->world, &t->world->lights.items[t->lanes->light[lane]], p))
    return;
  for (int c = 0; c < 4; c++)
    t->lanes->flux[c][lane] = 0.0f;
}

void vl_arrive_from_light(const vlTracing *t, uint32_t depth, const vlPaths *p, uint32_t i,
                          vlReceiver at, float cosine, float distance, const vlFlightEnds *ends,
                          vlWays *to) {
  uint32_t lane = p->lane[i];
  float inv = cosine > 0.0f ? 1.0f / cosine : 0.0f;
  to->cosine[i] = cosine;
  if (depth > 0) {
    to->b[i] = vl_linked(t, ends, lane, distance, inv);
  } else {
    float density = light_density(t, lane, distance);
    inv = density > 0.0f ? inv / density : 0.0f;
    shade_outside_portal(t, lane, at.p);
    to->b[i] = inv / vl_last_odds(ends, lane) *
               light_sample_pdf(t, lane, at, vl_neg(vl_row3(&p->d, i)));
  }
  to->a[i] = t->lanes->carry[lane] * inv;
}

static void arrive(const vlTracing *t, uint32_t n, uint32_t depth, const vlVertices *at,
                   const vlFlightEnds *ends, vlWays *to) {
  const vlSurface *f = &at->surface;
  const vlPaths *p = &at->paths;
  for (uint32_t i = 0; i < n; i++) {
    float cosine = vl_abs(vl_dot(vl_row3(&p->d, i), vl_row3(&f->g, i)));
    vl_arrive_from_light(t, depth, p, i, vl_receiver(f, i), cosine, f->t[i], ends, to);
  }
}

/* ---- photons ----------------------------------------------------------------------------- */

static void leave_photons(const vlTracing *t, uint32_t n, uint32_t depth,
                          const vlTwoWayVertices *v, vlPhoton *photons) {
  const vlLightBatch *b = t->light;
  const vlPaths *p = v->paths;
  const vlSurface *f = &v->at->surface;
  const vlWays *ways = v->ways;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (vl_all_specular(t->world, v->at, i) || !(ways->cosine[i] > 0.0f))
      continue;
    vlPhoton *x = &photons[count];
    vl_leave_photon(t, depth, v, i, vl_row3(&f->p, i), 0, x);
    float inv = 1.0f / ways->cosine[i];
    for (int c = 0; c < 4; c++)
      x->power[c] = p->beta[c][i] * t->lanes->flux[c][p->lane[i]] * inv;
    count += vl_carries_power(x->power);
  }
  if (count)
    b->store(b->user, count, photons);
}

/* ---- vertices that camera paths connect to ----------------------------------------------- */

/* passed: memory for vlPhoton.passed of the vertices. */
static void leave_vertices(const vlTracing *t, uint32_t n, uint32_t depth,
                           const vlTwoWayVertices *v, vlLightVertex *vertices,
                           uint32_t *passed) {
  const vlTwoWay *way = t->def->two_way;
  const vlLightBatch *b = t->light;
  const vlPaths *p = v->paths;
  const vlSurface *f = &v->at->surface;
  const vlShade *sh = &v->at->shade;
  const vlWays *ways = v->ways;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    if (b->first + lane >= way->inner.paths || !vl_is_inner_end(t->world, v->at, i) ||
        !(ways->cosine[i] > 0.0f))
      continue;
    vlLightVertex *x = &vertices[count];
    float z = sh->wo[2][i], side = z < 0.0f ? -1.0f : 1.0f, rev = vl_abs(z) * VL_INV_PI;
    vl_leave_path(t, depth, v, i, vl_row3(&f->p, i), x, &passed[count]);
    vl_store3(x->g, vl_row3(&f->g, i));
    vl_store3(x->n, vl_mul(vl_row3(&f->n, i), side));
    for (int c = 0; c < 4; c++)
      x->power[c] = p->beta[c][i] * t->lanes->flux[c][lane] * sh->reflectance[c][i] * rev /
                    ways->cosine[i];
    x->back = ways->a[i] * rev + ways->b[i] + way->merged;
    x->offset = f->offset[i];
    x->inside = 0;
    count += vl_carries_power(x->power);
  }
  if (count)
    b->leave(b->user, count, vertices, passed);
}

/* ---- the next vertex --------------------------------------------------------------------- */

/* Updates what the paths carry after scattering on surfaces, and makes the weights those of the
 * adjoint BSDFs: the `count` rays leave the vertices in `order`. */
static void carry_on(const vlTracing *t, uint32_t count, const vlVertices *at,
                     const uint32_t *order, const vlBsdfSamples *samples,
                     const vlBsdfValues *back, const vlWays *ways, vlPaths *rays) {
  const vlSurface *f = &at->surface;
  const vlPaths *p = rays;
  vlTwoWayLanes *lanes = t->lanes;
  float merged = t->def->two_way->merged, connect = t->def->two_way->connect;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = order[k], lane = p->lane[k];
    float cosine = vl_abs(vl_dot(vl_row3(&p->d, k), vl_row3(&f->g, i)));
    float pdf = samples->pdf[i];
    bool specular = samples->flags[i] & VL_SAMPLED_SPECULAR;
    lanes->carry[lane] = vl_carried(ways, i, back->pdf[i], specular, pdf, merged, cosine);
    lanes->link[lane] =
        !specular && vl_is_inner_end(t->world, at, i) && pdf > 0.0f ? connect / pdf : 0.0f;
    float z = vl_abs(samples->wi[2][i]),
          bent = z > 0.0f ? vl_abs(at->shade.wo[2][i]) / z : 0.0f;
    float turn =
        ways->cosine[i] > 0.0f ? bent * cosine / ways->cosine[i] * samples->eta_scale[i] : 0.0f;
    for (int c = 0; c < 4; c++)
      rays->beta[c][k] *= turn;
    rays->eta_scale[k] = 1.0f;
  }
}

static uint32_t on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  vlTwoWayRows *r = t->batch->two_way;
  const vlTwoWay *way = t->def->two_way;
  const vlTwoWayVertices x = vl_two_way_at(t);
  const vlTwoWayShadows q = vl_two_way_shadows_of(t);
  uint32_t dimension = vl_bounce_dimension(depth);
  bool last = depth + 1 == vl_light_bounces(t->def);
  if (vl_has_media(t))
    vl_volume_normalise_all(t, &s->at.paths, &s->volume->at, n);
  arrive(t, n, depth, &s->at, vl_flight_ends(t), &r->ways);
  if (way->merge)
    leave_photons(t, n, depth, &x, r->photons);
  if (way->inner.paths && !last)
    leave_vertices(t, n, depth, &x, r->vertices, r->passed);
  vl_connect_to_camera(t, n, depth, dimension, &x, &r->back, r->views, &r->splats, &q);
  if (last)
    return 0;
  uint32_t count = vl_two_way_scatter(t, n, depth, dimension);
  carry_on(t, count, &s->at, s->order, &s->samples, &r->back, &r->ways, &s->rays);
  return count;
}

void vl_light_tracer(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *s,
                     vlTwoWayRows *r, vlLightBatch *batch) {
  vlTraceDef own = *def;
  own.sampler = &def->two_way->sampler;
  own.pixel_spread = own.pixel_width = 0.0f; /* textures at full resolution */
  /* only for the stages: receives their counts, and radiance that is not used */
  vlTraceBatch rest;
  __builtin_memset(&rest, 0, sizeof rest);
  rest.n = batch->n;
  rest.eyes = batch->eyes;
  rest.two_way = r;
  for (int c = 0; c < 4; c++)
    rest.radiance[c] = r->unused[c];
  vlTracing t = vl_tracing_of(world, &own, s, &rest);
  t.lanes = &r->lanes;
  t.light = batch;
  vl_passed_start(&t, batch->n);
  s->at.paths.time = batch->time;
  uint32_t n = set_out(&t, batch, &r->lanes, &s->rays, &r->starts);
  const vlBounceSteps steps = {NULL, vl_has_media(&t) ? vl_light_in_media : NULL, on_surfaces,
                               NULL, NULL};
  const vlTwoWayShadows q = vl_two_way_shadows_of(&t);
  if (vl_has_media(&t))
    vl_volume_start(&t, n, r->starts.medium, &s->rays, &s->volume->rays);
  vl_show_lights(&t, n, &s->rays, &r->starts, r->views, &r->splats, &q);
  if (def->max_depth)
    vl_trace_bounces(&t, n, vl_light_bounces(def), &steps);
  batch->bounce_rays += rest.bounce_rays;
  batch->shadow_rays += rest.shadow_rays;
}
