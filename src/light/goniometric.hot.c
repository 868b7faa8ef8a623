/* light/goniometric.hot.c: goniometric lights: point lights whose intensity is multiplied
 * by an image over directions (pbrt book 12.2.3), in the equal-area octahedral map (3.8.3), or
 * by the table of a lamp file. */
#include "light/kinds.hot.h"
#include "light/lamp_lookup.h"
#include "math/octahedral.h"
#include "texture/lookup.h"

vlSampleLight vl_light_sample_goniometric;
vlEmitLight vl_light_emit_goniometric;
vlLightDensity vl_light_emit_pdf_goniometric;

/* The table of the light's lamp file; null: it has none. */
static const vlLampTable *lamp_table(const vlWorld *world, const vlWorldLight *light) {
  return light->lamp == VL_NONE ? NULL : &world->lamps.items[light->lamp]->table;
}

/* The image's factor, or the lamp's candela, for light that leaves along d (world space). */
static float intensity_factor(const vlWorld *world, const vlWorldLight *light, vlVec3 d) {
  vlVec3 local = vl_normalize(vl_light_local(light, d));
  const vlLampTable *lamp = lamp_table(world, light);
  if (lamp)
    return vl_lamp_candela(lamp, local);
  const vlMipmap *mip = world->images.items[light->image].mipmap;
  vlVec2 at = vl_octahedral_encode(local);
  vlTexel x = vl_octahedral_texel(mip, at.x, at.y);
  return vl_max(0.0f, mip->channels < 3 ? x.c[0] : (x.c[0] + x.c[1] + x.c[2]) / 3.0f);
}

void vl_light_sample_goniometric(const vlLightQuery *q, vlLightSample *out) {
  float factor = vl_light_towards_point(q, out);
  factor *= intensity_factor(q->world, q->light, vl_neg(out->w));
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, factor, out->radiance);
}

/* A ray of the lamp: its direction has the density of the flux of the table's cells. */
static void emit_lamp(const vlEmissionQuery *q, const vlLampTable *table, vlEmission *out) {
  if (!(table->flux > 0.0f))
    return;
  float density;
  vlVec3 local = vl_lamp_sample(table, q->s, q->t, &density);
  vlVec3 d = vl_light_from_local(q->light, local);
  density *= vl_light_stretch(q->light, vl_light_local(q->light, d));
  vl_light_emit_along(q, d, density, out);
  out->valid = density > 0.0f;
  float factor = out->valid ? vl_lamp_candela(table, local) / density : 0.0f;
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, factor, out->flux);
}

void vl_light_emit_goniometric(const vlEmissionQuery *q, vlEmission *out) {
  const vlLampTable *lamp = lamp_table(q->world, q->light);
  if (lamp) {
    emit_lamp(q, lamp, out);
    return;
  }
  const float span = 2.0f;
  vl_light_emit_from_point(q, span, out);
  float factor = 2.0f * VL_PI * span * intensity_factor(q->world, q->light, out->d);
  vl_light_emission(q->world, q->emitted, q->lambda, (vlVec2){0, 0}, factor, out->flux);
}

float vl_light_emit_pdf_goniometric(const vlWorld *world, const vlWorldLight *light, float p,
                                    vlVec3 w, float distance, VL_UNUSED const vlPoint *at) {
  const vlLampTable *lamp = lamp_table(world, light);
  if (!lamp)
    return vl_light_emit_pdf_from_point(light, 2.0f, p, w, distance);
  vlVec3 local = vl_light_local(light, vl_neg(w));
  float density = vl_lamp_density(lamp, vl_normalize(local));
  return p * density * vl_light_stretch(light, local) / (distance * distance);
}
