/* more/media.c: the media of more/, by kind. */
#include "more.h"
#include "refuse.h"

bool read_more_medium(const world *w, const vlMediumDef *def, medium *m, vlError *error) {
  (void)w;
  (void)m;
  if (def->rgb_absorption) return refuse(error, def->source, "absorption by RGB channel");
  return refuse_kind(error, def->source, "media", (uint32_t)def->kind);
}

spectrum more_transmittance(const medium *m, ray r, double distance, sampler *s, const wavelengths *lambda) {
  (void)m;
  (void)r;
  (void)distance;
  (void)s;
  (void)lambda;
  return gray(0);
}

bool scatters_in_more(const medium *m, ray r, double *distance, sampler *s, const wavelengths *lambda,
                      spectrum *throughput, spectrum *emitted) {
  (void)m;
  (void)r;
  (void)distance;
  (void)s;
  (void)lambda;
  (void)throughput;
  (void)emitted;
  return false;
}
