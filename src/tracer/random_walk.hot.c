/* tracer/random_walk.hot.c: the random walk (pbrt book 1.3.6), the simplest estimator,
 * for comparison. Each bounce samples a uniform direction on the sphere; only lights that the
 * walk hits contribute. Specular lobes are never sampled, so that specular surfaces are
 * black. */
#include "math/warp.h"
#include "trace/two_way/stages.h"
#include "tracer/kinds.hot.h"

static bool arrive(vlTracing *t, uint32_t n, VL_UNUSED uint32_t depth) {
  /* all rays are marked specular, so that their weight is 1 */
  vl_stage_emission(t, n, &t->s->rays, &t->s->hits);
  return true;
}

static uint32_t on_surfaces(vlTracing *t, uint32_t n, uint32_t depth) {
  vlTraceScratch *s = t->s;
  const vlPaths *p = &s->at.paths;
  const vlSurface *f = &s->at.surface;
  const vlBsdfValues *bsdf = &s->values;
  vlPaths *next = &s->rays;
  vlNumbers u;
  vlVec3Row w;
  uint32_t count = 0;
  vl_draw_2d(t, n, p, vl_bounce_dimension(depth) + VL_DIM_BSDF_UV, u.u1, u.u2);
  for (uint32_t i = 0; i < VL_PAD(n); i++)
    vl_set_row3(&w, i, vl_warp_sphere(u.u1[i], u.u2[i]));
  vl_stage_local(n, &s->at, &w, s->values.wi);
  vl_stage_bsdf(t, n, &s->at, s->at.shade.wo, &s->values);
  for (uint32_t i = 0; i < n; i++) {
    float max = 0.0f;
    vl_passed_go_on(t, &s->at, i, bsdf->wi[2][i]);
    for (int c = 0; c < 4; c++)
      max = vl_max(max, p->beta[c][i] * (bsdf->value[c][i] * (4.0f * VL_PI)));
    s->order[count] = i;
    count += max > 0.0f;
  }
  vl_permute_paths(p, next, s->order, count);
  for (uint32_t k = 0; k < count; k++) {
    uint32_t i = s->order[k];
    vlVec3 d = vl_normalize(vl_row3(&w, i));
    vlVec3 o = vl_surface_origin(f, i, d);
    for (int c = 0; c < 4; c++)
      next->beta[c][k] *= bsdf->value[c][i] * (4.0f * VL_PI);
    vl_set_row3(&next->o, k, o);
    vl_set_row3(&next->d, k, d);
    next->cone[k] = f->width[i];
    next->spread[k] = t->def->pixel_spread;
  }
  return count;
}

void vl_trace_random_walk(vlTracing *t) {
  static const vlBounceSteps steps = {arrive, NULL, on_surfaces, vl_add_hit_light,
                                      vl_add_hit_light};
  vl_trace_bounces(t, t->batch->n, t->def->max_depth, &steps);
}
