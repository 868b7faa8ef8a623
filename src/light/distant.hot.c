/* light/distant.hot.c: lights at an infinite distance in one direction (pbrt book
 * 12.3). */
#include "light/kinds.hot.h"

vlSampleLight vl_light_sample_distant;
vlEmitLight vl_light_emit_distant;
vlLightDensity vl_light_emit_pdf_distant;

void vl_light_sample_distant(const vlLightQuery *q, vlLightSample *out) {
  out->w = out->target = vl_light_axis(q->light);
  out->pdf = 1.0f;
  out->delta = out->distant = true;
  vl_emitted_at(q->world, q->emitted, q->lambda, 0, 0, false, out->radiance);
}

void vl_light_emit_distant(const vlEmissionQuery *q, vlEmission *out) {
  vl_light_emit_from_afar(q->world, vl_light_axis(q->light), q->u, q->v, out);
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, vl_light_disk(q->world),
                    out->flux);
  out->density = 1.0f / vl_light_disk(q->world);
  out->delta = true;
}

float vl_light_emit_pdf_distant(const vlWorld *world, VL_UNUSED const vlWorldLight *light,
                                float p, VL_UNUSED vlVec3 w, VL_UNUSED float distance,
                                VL_UNUSED const vlPoint *at) {
  return p / vl_light_disk(world);
}
