/* light/goniometric.hot.c: goniometric lights: point lights whose intensity is multiplied
 * by an image over directions (pbrt book 12.2.3), in the equal-area octahedral map (3.8.3). */
#include "light/kinds.hot.h"
#include "math/octahedral.h"
#include "texture/lookup.h"

vlSampleLight vl_light_sample_goniometric;
vlEmitLight vl_light_emit_goniometric;
vlLightDensity vl_light_emit_pdf_goniometric;

/* The image's factor for light that leaves along d (world space). */
static float image_factor(const vlWorld *world, const vlWorldLight *light, vlVec3 d) {
  vlVec3 local = vl_normalize(vl_light_local(light, d));
  const vlMipmap *mip = world->images.items[light->image].mipmap;
  vlVec2 at = vl_octahedral_encode(local);
  vlTexel x = vl_nearest(mip, 0, at.x, at.y, VL_WRAP_OCTAHEDRAL);
  return vl_max(0.0f, mip->channels < 3 ? x.c[0] : (x.c[0] + x.c[1] + x.c[2]) / 3.0f);
}

void vl_light_sample_goniometric(const vlLightQuery *q, vlLightSample *out) {
  float factor = vl_light_towards_point(q, out);
  factor *= image_factor(q->world, q->light, vl_neg(out->w));
  vl_emitted_at(q->world, q->emitted, q->lambda, 0, 0, false, out->radiance);
  for (int c = 0; c < 4; c++)
    out->radiance[c] *= factor;
}

void vl_light_emit_goniometric(const vlEmissionQuery *q, vlEmission *out) {
  const float span = 2.0f;
  vl_light_emit_from_point(q, span, out);
  float factor = 2.0f * VL_PI * span * image_factor(q->world, q->light, out->d);
  vl_emitted_at(q->world, q->emitted, q->lambda, 0, 0, false, out->flux);
  for (int c = 0; c < 4; c++)
    out->flux[c] *= factor;
}

float vl_light_emit_pdf_goniometric(const vlWorld *world, const vlWorldLight *light, float p,
                                    vlVec3 w, float distance, const vlPoint *at) {
  (void)world;
  (void)at;
  return vl_light_emit_pdf_from_point(light, 2.0f, p, w, distance);
}
