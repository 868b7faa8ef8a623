/* trace/two_way/light_path.hot.c: traces light paths. At every vertex that scatters, a light
 * path stores a photon and connects to the camera; two_way.h has the weights. BSDFs carry
 * radiance towards the camera, so light paths use their adjoint (Veach 1997, 5.3): no factor
 * 1/eta^2 at refraction, and a correction for shading normals. */
#include "math/warp.h"
#include "trace/two_way/stages.h"

void vl_stage_reverse(const vlTracing *t, uint32_t n, const vlVertices *at,
                      const float wi[3][VL_ROW_SIZE], vlBsdfValues *back) {
  const vlShade *sh = &at->shade;
  const vlSurface *f = &at->surface;
  for (uint32_t i = 0; i < VL_PAD(n);
       i++) { /* wo in world space and back: as a light sample's direction is rounded */
    float a = sh->wo[0][i], b = sh->wo[1][i], c = sh->wo[2][i];
    float x = a * sh->tx[i] + b * sh->bx[i] + c * f->nx[i];
    float y = a * sh->ty[i] + b * sh->by[i] + c * f->ny[i];
    float z = a * sh->tz[i] + b * sh->bz[i] + c * f->nz[i];
    back->wi[0][i] = x * sh->tx[i] + y * sh->ty[i] + z * sh->tz[i];
    back->wi[1][i] = x * sh->bx[i] + y * sh->by[i] + z * sh->bz[i];
    back->wi[2][i] = x * f->nx[i] + y * f->ny[i] + z * f->nz[i];
  }
  vl_stage_bsdf(t, n, at, wi, back);
}

void vl_stage_there_and_back(const vlTracing *t, uint32_t n, const vlVertices *at,
                             const float (*toward)[VL_ROW_SIZE], vlBsdfValues *there,
                             vlBsdfValues *back) {
  vl_stage_local(n, at, toward[0], toward[1], toward[2], there->wi);
  vl_stage_bsdf(t, n, at, at->shade.wo, there);
  vl_stage_reverse(t, n, at, (const float(*)[VL_ROW_SIZE])there->wi, back);
}

/* ---- start
 * -------------------------------------------------------------------------------------------------------
 */

/* Writes the wavelengths of the batch's paths to rows 4..7, 1 / densities to rows 8..11. */
static void wavelengths(vlTracing *t, vlTwoWayRows *r, const vlLightBatch *b) {
  const vlTwoWay *way = t->def->two_way;
  float *u = t->s->numbers.u0;
  float *const lambda[4] = {r->rows[4], r->rows[5], r->rows[6], r->rows[7]};
  float *const inv_pdf[4] = {r->rows[8], r->rows[9], r->rows[10], r->rows[11]};
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

static uint32_t set_out(vlTracing *t, vlTwoWayRows *r, const vlLightBatch *b) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  vlPaths *p = &s->rays;
  uint32_t n = b->n, count = 0;
  bool rgb = world->def.color == VL_COLOR_RGB;
  if (!rgb)
    wavelengths(t, r, b);
  float *u = s->numbers.u0, *u1 = s->numbers.u1, *v1 = s->numbers.u2, *u2 = r->lens[0],
        *v2 = r->lens[1];
  t->sampler->get_1d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_TIME, u);
  t->sampler->get_2d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_FILM, u1, v1);
  t->sampler->get_2d(t->def->sampler, n, b->px, b->py, b->index, VL_DIM_LENS, u2, v2);
  p->time = s->at.paths.time = b->time;
  if (s->volume)
    s->volume->scattered.time = b->time;
  for (uint32_t i = 0; i < n; i++) {
    float lambda[4];
    for (int c = 0; c < 4; c++)
      lambda[c] = rgb ? 0.0f : r->rows[4 + c][i];
    vlEmission e =
        vl_emission_sample(world, t->def->two_way, lambda, u[i], u1[i], v1[i], u2[i], v2[i]);
    float most = vl_max(vl_max(e.flux[0], e.flux[1]), vl_max(e.flux[2], e.flux[3]));
    if (!e.valid || !(most > 0.0f) || !(most < VL_INFINITY))
      continue;
    if (vl_has_media(t) && !start_medium(t, &e, &s->volume->shadow_medium[i]))
      continue;
    uint32_t k = count++;
    vl_set_lane3(p->ox, p->oy, p->oz, k, e.o);
    vl_set_lane3(p->dx, p->dy, p->dz, k, e.d);
    p->pdf[k] = 1.0f;
    p->from_nx[k] = p->from_ny[k] = p->from_nz[k] = p->from_side[k] = 0.0f;
    p->eta_scale[k] = 1.0f;
    p->cone[k] = p->spread[k] = 0.0f;
    p->specular[k] = 1;
    p->px[k] = b->px[i];
    p->py[k] = b->py[i];
    p->index[k] = b->index[i];
    p->lane[k] = i;
    for (int c = 0; c < 4; c++) {
      p->beta[c][k] = 1.0f;
      p->lambda[c][k] = lambda[c];
      r->flux[c][i] = e.flux[c];
    }
    r->light[i] = e.light;
    r->density[i] = e.density;
    r->carry[i] =
        e.delta ? 0.0f : 1.0f; /* without 1 / (density cosine), which arrive() applies */
    vl_set_lane3(r->lx, r->ly, r->lz, i, e.at);
    vl_set_lane3(r->lnx, r->lny, r->lnz, i, e.n);
    r->a[k] = e.area_pdf; /* these three until the first vertex, for vl_show_lights */
    r->b[k] = e.offset;
    r->cosine[k] = e.side;
  }
  return count;
}

float vl_light_sample_pdf(const vlWorld *world, const vlTwoWayRows *r, uint32_t lane,
                          vlReceiver to, vlVec3 w) {
  vlVec3 p = to.p;
  const vlWorldLight *light = &world->lights.items[r->light[lane]];
  float pmf = vl_light_pmf(&world->tree, to, r->light[lane]);
  if (light->delta)
    return pmf;
  if (light->far)
    return pmf * vl_infinite_pdf(world, light, p, w);
  vlPoint at;
  __builtin_memset(&at, 0, sizeof at);
  at.p = vl_vec3(r->lx[lane], r->ly[lane], r->lz[lane]);
  at.g = at.n = vl_vec3(r->lnx[lane], r->lny[lane], r->lnz[lane]);
  return pmf * vl_area_pdf(world, light, p, &at);
}

/* Sets a and b of the n shaded lanes: the strategies that begin on the light's side
 * (two_way.h). */
static void arrive(vlTracing *t, vlTwoWayRows *r, uint32_t n, uint32_t depth) {
  const vlSurface *f = &t->s->at.surface;
  const vlPaths *p = &t->s->at.paths;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i];
    vlVec3 w = vl_neg(vl_lane3(p->dx, p->dy, p->dz, i));
    float cosine = vl_abs(vl_dot(w, vl_lane3(f->gx, f->gy, f->gz, i)));
    float inv = cosine > 0.0f ? 1.0f / cosine : 0.0f;
    r->cosine[i] = cosine;
    r->b[i] = depth > 0 ? vl_linked(t, r, lane, f->t[i], inv) : 0.0f;
    if (depth == 0) {
      float density = vl_light_density(t, r, lane, f->t[i]);
      inv = density > 0.0f ? inv / density : 0.0f;
      r->b[i] = inv / vl_last_odds(t, lane) *
                vl_light_sample_pdf(t->world, r, lane, vl_receiver(f, i), w);
    }
    r->a[i] = r->carry[lane] * inv;
  }
}

/* ---- photons
 * -----------------------------------------------------------------------------------------------------
 */

static void leave_photons(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n,
                          uint32_t depth) {
  const vlPaths *p = &t->s->at.paths;
  const vlSurface *f = &t->s->at.surface;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (vl_all_specular(t->world, &t->s->at, i) || !(r->cosine[i] > 0.0f))
      continue;
    vlPhoton *x = &r->photons[count];
    uint32_t lane = p->lane[i];
    x->p[0] = f->px[i];
    x->p[1] = f->py[i];
    x->p[2] = f->pz[i];
    x->w[0] = -p->dx[i];
    x->w[1] = -p->dy[i];
    x->w[2] = -p->dz[i];
    float inv = 1.0f / r->cosine[i], sum = 0.0f;
    for (int c = 0; c < 4; c++)
      sum += x->power[c] = p->beta[c][i] * r->flux[c][lane] * inv;
    x->a = r->a[i];
    x->b = r->b[i];
    x->bounce = depth + 1;
    x->id = b->first + lane;
    x->alone = vl_hero_only(p, i);
    x->passed = t->world->by_channel ? vl_pack_passed(t->s, lane) : 0;
    x->medium = 0;
    count += sum > 0.0f && sum < VL_INFINITY;
  }
  if (count)
    b->store(b->user, count, r->photons);
}

/* ---- vertices that camera paths connect to
 * ----------------------------------------------------------------------- */

static void leave_vertices(vlTracing *t, vlTwoWayRows *r, vlLightBatch *b, uint32_t n,
                           uint32_t depth) {
  const vlTwoWay *way = t->def->two_way;
  const vlPaths *p = &t->s->at.paths;
  const vlSurface *f = &t->s->at.surface;
  const vlShade *sh = &t->s->at.shade;
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = p->lane[i], path = b->first + lane;
    if (path >= way->inner.paths || !vl_is_inner_end(t, i) || !(r->cosine[i] > 0.0f))
      continue;
    vlLightVertex *x = &r->vertices[count];
    float z = sh->wo[2][i], side = z < 0.0f ? -1.0f : 1.0f, rev = vl_abs(z) * VL_INV_PI,
          sum = 0.0f;
    x->p[0] = f->px[i];
    x->p[1] = f->py[i];
    x->p[2] = f->pz[i];
    x->g[0] = f->gx[i];
    x->g[1] = f->gy[i];
    x->g[2] = f->gz[i];
    x->n[0] = side * f->nx[i];
    x->n[1] = side * f->ny[i];
    x->n[2] = side * f->nz[i];
    for (int c = 0; c < 4; c++)
      sum += x->power[c] =
          p->beta[c][i] * r->flux[c][lane] * sh->reflectance[c][i] * rev / r->cosine[i];
    x->back = r->a[i] * rev + r->b[i] + way->merged;
    x->offset = f->offset[i];
    x->path = path & 0x3ffffu;
    x->bounce = (depth + 1) & 255u;
    x->alone = vl_hero_only(p, i);
    x->inside = 0;
    x->air = vl_has_media(t) ? vl_air(t->world, t->s->volume->b.medium[i]) & 15u : 0;
    r->first[count] = t->world->by_channel ? vl_pack_passed(t->s, lane) : 0;
    count += sum > 0.0f && sum < VL_INFINITY;
  }
  if (count)
    b->leave(b->user, count, r->vertices, r->first);
}

/* ---- the next vertex
 * ---------------------------------------------------------------------------------------------
 */

static uint32_t scatter(vlTracing *t, vlTwoWayRows *r, uint32_t n, uint32_t depth,
                        uint32_t dimension) {
  vlTraceScratch *s = t->s;
  const vlSurface *f = &s->at.surface;
  const vlPaths *p = &s->rays;
  const vlBsdfSamples *samples = &s->samples;
  uint32_t count =
      vl_stage_scatter(t, n, depth + 1, dimension, &s->at, &s->samples, s->order, &s->rays);
  if (vl_has_media(t))
    vl_volume_go_on(t, count);
  vl_stage_reverse(t, n, &s->at, samples->wi, &r->back);
  float merged = t->def->two_way->merged, connect = t->def->two_way->connect;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = s->order[k], lane = p->lane[k];
    float cosine =
        vl_abs(vl_dot(vl_lane3(p->dx, p->dy, p->dz, k), vl_lane3(f->gx, f->gy, f->gz, i)));
    float pdf = samples->pdf[i];
    bool specular = samples->flags[i] & VL_SAMPLED_SPECULAR;
    r->carry[lane] = vl_carried(r, i, specular, pdf, merged, cosine);
    r->link[lane] = !specular && vl_is_inner_end(t, i) && pdf > 0.0f ? connect / pdf : 0.0f;
    float z = vl_abs(samples->wi[2][i]),
          bent = z > 0.0f ? vl_abs(s->at.shade.wo[2][i]) / z : 0.0f;
    float turn =
        r->cosine[i] > 0.0f ? bent * cosine / r->cosine[i] * samples->eta_scale[i] : 0.0f;
    for (int c = 0; c < 4; c++)
      s->rays.beta[c][k] *= turn;
    s->rays.eta_scale[k] = 1.0f;
  }
  return count;
}

static uint32_t on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTwoWayRows *r = t->batch->two_way;
  vlLightBatch *b = t->light;
  uint32_t dimension = vl_bounce_dimension(depth);
  bool last = depth + 1 == vl_light_bounces(t->def);
  if (vl_has_media(t))
    vl_volume_normalise_all(t, &t->s->at.paths, &t->s->volume->b, n);
  arrive(t, r, n, depth);
  if (t->def->two_way->merge)
    leave_photons(t, r, b, n, depth);
  if (t->def->two_way->inner.paths && !last)
    leave_vertices(t, r, b, n, depth);
  vl_connect_to_camera(t, r, b, n, depth, dimension);
  return last ? 0 : scatter(t, r, n, depth, dimension);
}

void vl_light_tracer(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch,
                     vlTwoWayRows *r, vlLightBatch *batch) {
  vlTraceDef own = *def;
  own.sampler = &def->two_way->sampler;
  own.pixel_spread = own.pixel_width = 0.0f; /* textures at full resolution */
  vlTraceBatch
      rest; /* only for the stages: receives their counts, and radiance that is not used */
  __builtin_memset(&rest, 0, sizeof rest);
  rest.n = batch->n;
  rest.eyes = batch->eyes;
  rest.two_way = r;
  for (int c = 0; c < 4; c++)
    rest.radiance[c] = r->rows[c];
  vlTracing t = {
      world, &own, scratch, &rest, vl_sampler_kernels(def->isa), vl_bsdf_kernels(def->isa),
      batch};
  vl_passed_start(&t, batch->n);
  uint32_t n = set_out(&t, r, batch);
  const vlBounceSteps steps = {NULL, vl_has_media(&t) ? vl_light_in_media : NULL, on_surfaces};
  if (vl_has_media(&t))
    vl_volume_start(&t, n, scratch->volume->shadow_medium);
  vl_show_lights(&t, r, batch, n);
  if (def->max_depth)
    vl_trace_bounces(&t, n, vl_light_bounces(def), &steps);
  batch->bounce_rays += rest.bounce_rays;
  batch->shadow_rays += rest.shadow_rays;
}
