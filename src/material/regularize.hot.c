/* material/regularize.hot.c: regularisation as in pbrt-v4, which vlBuildDef enables. It makes
 * lobes rougher for paths that have already been scattered, so that light samples can find
 * light that otherwise only a nearly specular lobe would reach. Kinds without alpha do not
 * change. */
#include "math/ggx.h"
#include "trace/stages.h"
#include "velo/schema.h"

void vl_stage_regularize(const vlTracing *t, uint32_t n, vlVertices *at) {
  if (!t->world->def.regularize)
    return;
  vlShade *sh = &at->shade;
  for (uint32_t i = 0; i < n; i++) {
    if (!t->scattered[at->paths.lane[i]])
      continue;
    const vlWorldMaterial *m = &t->world->materials.items[at->hits.material[i]];
    if (!(m->traits & VL_MATERIAL_ROUGH))
      continue;
    sh->alpha_x[i] = vl_ggx_widened(sh->alpha_x[i]);
    sh->alpha_y[i] = vl_ggx_widened(sh->alpha_y[i]);
    if (m->widened)
      sh->coat[i] = m->widened;
    if (m->layers && m->layers->metal) {
      sh->own[VL_L_BASE_X][i] = vl_ggx_widened(sh->own[VL_L_BASE_X][i]);
      sh->own[VL_L_BASE_Y][i] = vl_ggx_widened(sh->own[VL_L_BASE_Y][i]);
    }
    if (m->principled)
      sh->own[VL_P_COAT_ALPHA][i] = vl_ggx_widened(sh->own[VL_P_COAT_ALPHA][i]);
  }
}
