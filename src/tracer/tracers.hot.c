/* tracer/tracers.hot.c: calls the tracer, and defines the bounces of all tracers, and the
 * tracers that end at the first hit: raycast and ambient occlusion. The path tracer is in
 * path.hot.c. */
#include "math/warp.h"
#include "trace/two_way/stages.h"
#include "tracer/kinds.hot.h"
#include "tracer/own.h"
#include "velo/tracer.h"

static void start_paths(vlTracing *t) {
  vlTraceBatch *b = t->batch;
  vlPaths *p = &t->s->rays;
  const vlTwoWay *way = t->def->two_way;
  vlFloatRow u;
  bool connects = way && way->connect > 0.0f;
  uint32_t padded = VL_PAD(b->n);
  t->s->rays.time = t->s->at.paths.time = b->rays.time;
  if (b->lambda[0]) {
    t->sampler->get_1d(t->def->sampler, b->n, b->px, b->py, b->index, VL_DIM_WAVELENGTH, u);
    float shared = way ? way->shared : -1.0f;
    if (t->def->same_wavelengths && shared < 0.0f)
      shared = 0.5f;
    for (uint32_t i = 0; shared >= 0.0f && i < padded; i++)
      u[i] = shared;
    if (connects)
      vl_stage_groups(t, padded, u);
    const vlColorKernels *color = vl_color_kernels(t->def->isa);
    if (t->def->lambda_span > 0.0f)
      color->uniform_wavelengths(t->def->lambda_low, t->def->lambda_span, b->n, u, b->lambda,
                                 b->inv_pdf);
    else
      color->visible_wavelengths(b->n, u, b->lambda, b->inv_pdf);
  } else if (connects && way->inner.groups > 1) {
    t->sampler->get_1d(t->def->sampler, b->n, b->px, b->py, b->index, VL_DIM_WAVELENGTH, u);
    vl_stage_groups(t, padded, u);
  }
  for (uint32_t i = 0; i < padded; i++) {
    vl_path_start(p, i, b->px[i], b->py[i], b->index[i], i);
    vl_set_row3(&p->o, i, vl_ray_origin(&b->rays, i));
    vl_set_row3(&p->d, i, vl_ray_direction(&b->rays, i));
    p->cone[i] = t->def->pixel_width;
    p->spread[i] = t->def->pixel_spread;
    t->scattered[i] = 0;
  }
  vl_passed_start(t, padded);
  if (t->def->limited)
    vl_limits_start(t, padded);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < padded; i++) {
      p->beta[c][i] = 1.0f;
      p->lambda[c][i] = b->lambda[c] ? b->lambda[c][i] : 0.0f;
      b->radiance[c][i] = 0.0f;
    }
}

/* Raycast: the emission at the camera ray's first hit, else reflectance times the cosine to the
 * ray. */
void vl_trace_raycast(vlTracing *t) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  uint32_t n = t->batch->n;
  vl_stage_hits(t, n, true, vl_add_hit_light, &s->rays, &s->hits);
  vl_stage_alpha(t, &s->hits);
  vl_stage_emission(t, n, &s->rays, &s->hits);
  n = vl_stage_sort(t->world, n, &s->rays, &s->hits, s->order, &s->at);
  vl_stage_shade(t, n, &s->at);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = s->at.paths.lane[i];
    const vlWorldMaterial *m = &world->materials.items[s->at.hits.material[i]];
    if (vl_shape_light(&world->shapes.items[s->at.hits.shape[i]], s->at.hits.prim[i]) !=
        VL_NONE)
      continue;
    float lambda[4];
    vl_path_lambda(&s->at.paths, i, lambda);
    for (int c = 0; c < 4; c++) {
      float reflectance = m->reflectance >= 0 ? s->at.shade.reflectance[c][i] : 0.8f;
      float cosine = vl_abs(s->at.shade.wo[2][i]);
      t->batch->radiance[c][lane] +=
          reflectance * cosine * vl_spectral_at(&world->white, c, lambda[c]);
    }
  }
}

/* Ambient occlusion as in pbrt: one ray per sample from the first hit. The sample is white if
 * the ray is not occluded. */
void vl_trace_ambient_occlusion(vlTracing *t) {
  const vlWorld *world = t->world;
  vlTraceScratch *s = t->s;
  vlNumbers u;
  uint32_t n = t->batch->n;
  vl_stage_hits(t, n, true, NULL, &s->rays, &s->hits);
  vl_stage_alpha(t, &s->hits);
  n = vl_stage_sort(t->world, n, &s->rays, &s->hits, s->order, &s->at);
  vl_stage_shade(t, n, &s->at);
  vl_draw_2d(t, n, &s->at.paths, VL_DIM_BOUNCE + VL_DIM_BSDF_UV, u.u1, u.u2);
  vlShadowRays *q = &s->shadow;
  for (uint32_t i = 0; i < n; i++) {
    /* geometric normal, as in pbrt */
    vlVec3 nn = vl_row3(&s->at.surface.g, i);
    vlVec3 d = vl_row3(&s->at.paths.d, i);
    if (vl_dot(nn, d) > 0.0f)
      nn = vl_neg(nn);
    bool cosine = t->def->ao_cosine;
    vlVec3 local = cosine ? vl_warp_cosine_hemisphere(u.u1[i], u.u2[i])
                          : vl_warp_hemisphere(u.u1[i], u.u2[i]);
    vlVec3 w = vl_from_local(vl_frame_from_z(nn), local);
    float lambda[4];
    vl_path_lambda(&s->at.paths, i, lambda);
    vl_shadow_way(&s->at.paths, i, vl_surface_origin(&s->at.surface, i, w), w,
                  t->def->ao_distance, i, q);
    /* Uniform sampling: cos / pi over the density 1 / (2 pi). */
    for (int c = 0; c < 4; c++)
      q->radiance[c][i] =
          (cosine ? 1.0f : 2.0f * local.z) * vl_spectral_at(&world->white, c, lambda[c]);
  }
  vl_stage_occluded(t, n, &s->at.paths, q);
  t->batch->shadow_rays += n;
  for (uint32_t i = 0; i < n; i++)
    if (!q->occluded[i])
      for (int c = 0; c < 4; c++)
        t->batch->radiance[c][s->at.paths.lane[i]] += q->radiance[c][i];
}

/* ---- bounces ----------------------------------------------------------------------------- */

/* For irradiance: drops the light that the camera rays met, and counts every surface. */
static void forget_light(const vlTracing *t, uint32_t n, const vlHits *hits) {
  vlTraceBatch *b = t->batch;
  for (uint32_t i = 0; i < n; i++) {
    for (int c = 0; c < 4; c++)
      b->radiance[c][i] = 0.0f;
    b->alpha[i] = hits->shape[i] == VL_NONE ? 0.0f : 1.0f;
  }
}

/* For irradiance: makes n shaded vertices white and diffuse on both sides. Material 0 of each
 * world is diffuse (material/compile.c). Normals and frames stay. */
static void whiten(uint32_t n, vlVertices *at) {
  for (uint32_t i = 0; i < n; i++) {
    at->hits.material[i] = 0;
    at->surface.no_cosine[i] = 0.0f;
    at->surface.side[i] = at->shade.wo[2][i] < 0.0f ? -1.0f : 1.0f;
    for (int c = 0; c < 4; c++)
      at->shade.reflectance[c][i] = 1.0f;
  }
}

void vl_trace_bounces(vlTracing *t, uint32_t n, uint32_t max, const vlBounceSteps *steps) {
  vlTraceScratch *s = t->s;
  vlVolumeScratch *media = steps->in_media ? s->volume : NULL;
  for (uint32_t depth = 0; n > 0 && !vl_is_cancelled(t->def->cancel); depth++) {
    bool camera = depth == 0 && !t->light, irradiance = camera && t->def->irradiance;
    vlAddLight *pass = depth == 0 ? steps->pass_first : steps->pass_later;
    if (media) {
      vl_volume_travel(t, n, depth, depth < max && !t->light, pass, &s->rays, &media->rays,
                       &s->hits, &media->ends);
    } else {
      vl_stage_hits(t, n, camera, pass, &s->rays, &s->hits);
      if (camera)
        vl_stage_alpha(t, &s->hits);
    }
    if (steps->arrive && !steps->arrive(t, n, depth))
      break;
    if (irradiance)
      forget_light(t, n, &s->hits);
    if (depth >= max)
      break;
    if (t->def->limited)
      vl_limits_end(t, n, &s->rays, &s->hits, media ? &media->ends : NULL);
    uint32_t inside = media ? steps->in_media(t, n, depth) : 0;
    n = vl_stage_sort(t->world, n, &s->rays, &s->hits, s->order, &s->at);
    if (n) {
      if (media)
        vl_volume_permute(&media->rays, &media->at, s->order, n);
      vl_stage_shade(t, n, &s->at);
      if (irradiance)
        whiten(n, &s->at);
      n = steps->on_surfaces(t, n, depth);
    }
    if (media)
      n = vl_volume_append(&media->scattered, media->kept, inside, n, &s->rays, &media->rays);
  }
}

/* ---- the others -------------------------------------------------------------------------- */

void vl_trace_volpath(vlTracing *t) {
  if (t->world->media.count > 0 || t->world->has_subsurface)
    vl_volume_tracer(t);
  else
    vl_path_tracer(t);
}

/* Of all tracers that may use light paths. */
void vl_trace_path(vlTracing *t) {
  if (t->def->two_way)
    vl_bidirectional_tracer(t);
  else
    vl_path_tracer(t);
}

static void trace(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch,
                  vlTraceBatch *batch) {
  vlTracing t = vl_tracing_of(world, def, scratch, batch);
  t.lanes = batch->two_way ? &batch->two_way->lanes : NULL;
  start_paths(&t);
  if (def->own) {
    vl_own_tracer(&t);
    return;
  }
  switch ((vlTracer)def->tracer) {
#define CASE(kind, row, trace) \
  case kind:                   \
    trace(&t);                 \
    break;
    VL_TRACER_FUNCTIONS(CASE)
#undef CASE
  }
}

const vlTraceKernels vl_trace_kernel_table = {trace, vl_light_tracer, vl_light_media};
