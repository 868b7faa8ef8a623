/* trace/tracer/random_walk.hot.c: the random walk (pbrt book 1.3.6), the simplest estimator, for comparison. Each
 * bounce samples a uniform direction on the sphere; only lights that the walk hits contribute. Specular lobes are never
 * sampled, so that specular surfaces are black. */
#include "math/warp.h"
#include "trace/tracer/kinds.h"
#include "trace/two_way/stages.h"

void vl_trace_random_walk(vlTracing *t) {
  vlTraceScratch *s = t->s;
  vlShade *sh = &s->shade;
  vlPaths *p = &s->b;
  const vlSurface *f = &s->surface;
  uint32_t n = t->batch->n;
  for (uint32_t depth = 0; n > 0 && !vl_is_cancelled(t->def->cancel); depth++) {
    vl_stage_hits(t, n, depth == 0);
    if (depth == 0) vl_stage_alpha(t);
    vl_stage_emission(t, n); /* all rays are marked specular, so that their weight is 1 */
    if (depth >= t->def->max_depth) break;
    n = vl_stage_sort(t, n);
    if (n == 0) break;
    vl_stage_shade(t, n);
    uint32_t dimension = VL_DIM_BOUNCE + depth * VL_DIM_STRIDE, count = 0;
    t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension + VL_DIM_BSDF_UV, sh->u1, sh->u2);
    for (uint32_t i = 0; i < VL_PAD(n); i++) {
      vlVec3 w = vl_warp_sphere(sh->u1[i], sh->u2[i]);
      vl_set_lane3(s->light.wx, s->light.wy, s->light.wz, i, w);
    }
    vl_stage_light_bsdf(t, n);
    for (uint32_t i = 0; i < n; i++) {
      float most = 0.0f;
      vl_passed_go_on(t, i);
      for (int c = 0; c < 4; c++) {
        p->beta[c][i] *= sh->value[c][i] * (4.0f * VL_PI);
        most = vl_max(most, p->beta[c][i]);
      }
      vlVec3 w = vl_normalize(vl_lane3(s->light.wx, s->light.wy, s->light.wz, i));
      vlVec3 o = vl_offset_origin(vl_lane3(f->px, f->py, f->pz, i), vl_lane3(f->gx, f->gy, f->gz, i), f->offset[i], w);
      vl_set_lane3(p->ox, p->oy, p->oz, i, o);
      vl_set_lane3(p->dx, p->dy, p->dz, i, w);
      p->cone[i] = f->width[i];
      p->spread[i] = t->def->pixel_spread;
      s->order[count] = i;
      count += most > 0.0f;
    }
    vl_permute_paths(p, &s->a, s->order, count);
    n = count;
  }
}
