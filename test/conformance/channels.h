/* conformance/channels.h: the law of channels: where colours are RGB, a material scatters each
 * channel by this channel of its colours alone, as with a grey of this brightness. A few
 * percent are allowed for layers that are walked through at random. */
#ifndef TEST_CONFORMANCE_CHANNELS_H
#define TEST_CONFORMANCE_CHANNELS_H

#include "conformance.h"
#include "schema/schema.h"
#include "shading.h"
#include "unit.h"
#include "velo/material.h"

static bool is_color(const vlParameter *p) {
  return p->type == VL_PARAMETER_SPECTRUM_INPUT && p->role == VL_PARAMETER_ALBEDO;
}

/* All other colours are black. */
static Scattering *scattering_with(const vlKindRow *row, vlMaterialKind kind,
                                   const vlParameter *p, const float rgb[3]) {
  vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\" " NAMED);
  vlMaterialDef def = vl_default_material_def(kind);
  const vlSpectrumInput black = {.value = vl_spectrum_rgb(0, 0, 0)};
  const vlSpectrumInput input = {.value = vl_spectrum_rgb(rgb[0], rgb[1], rgb[2])};
  for (uint32_t i = 0; i < row->parameter_count; i++)
    if (is_color(&row->parameters[i]))
      memcpy((char *)&def + row->parameters[i].offset, &black, sizeof black);
  memcpy((char *)&def + p->offset, &input, sizeof input);
  def.principled.sheen_roughness.value = 0.5f; /* for a sheen that is seen */
  return scattering_of_def(scene, &def);
}

static void check_channel(const vlKindRow *row, vlMaterialKind kind, const vlParameter *p,
                          int channel) {
  static const float color[3] = {0, 0.8f, 0.3f};
  const float grey[3] = {color[channel], color[channel], color[channel]};
  Scattering *colored = scattering_with(row, kind, p, color);
  Scattering *plain = scattering_with(row, kind, p, grey);
  double light[2] = {0, 0};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    light[0] += (double)colored->value[channel][i] / VL_OWN_BATCH;
    light[1] += (double)plain->value[channel][i] / VL_OWN_BATCH;
  }
  if (!(fabs(light[0] - light[1]) <= 0.05 * light[1] + 1e-3))
    broken("materials", row->name, "%s: light of channel %d: %.4f, of a grey %.4f", p->name,
           channel, light[0], light[1]);
  free_scattering(colored);
  free_scattering(plain);
}

static void channels_of_materials(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("materials");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    for (uint32_t i = 0; i < row->parameter_count; i++) {
      const vlParameter *p = &row->parameters[i];
      for (int channel = 0; is_color(p) && channel < 3; channel++)
        check_channel(row, (vlMaterialKind)k, p, channel);
    }
  }
  expect_no_failures();
}

#endif
