/* more/lights.c: the lights of more/, by kind. */
#include "more.h"
#include "refuse.h"

bool read_more_light(const world *w, const vlLightDef *def, light *l, vlError *error) {
  (void)w;
  (void)l;
  return refuse_kind(error, def->source, "lights", (uint32_t)def->kind);
}

bool sample_more_light(const world *w, const light *l, vector point, sampler *s, const wavelengths *lambda,
                       light_sample *result) {
  (void)w;
  (void)l;
  (void)point;
  (void)s;
  (void)lambda;
  (void)result;
  return false;
}
