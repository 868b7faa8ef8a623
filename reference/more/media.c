/* more/media.c: the media of more/, by kind. */
#include "more.h"

bool is_homogeneous(const vlMediumDef *m) {
  return m->kind == VL_MEDIUM_HOMOGENEOUS;
}

spectrum more_transmittance(const world *w, const vlMediumDef *m, ray r, double distance, sampler *s,
                            const wavelengths *lambda) {
  (void)w;
  (void)m;
  (void)r;
  (void)distance;
  (void)s;
  (void)lambda;
  return gray(0);
}

bool scatters_in_more(const world *w, const vlMediumDef *m, ray r, double *distance, sampler *s,
                      const wavelengths *lambda, spectrum *throughput, spectrum *emitted) {
  (void)w;
  (void)m;
  (void)r;
  (void)distance;
  (void)s;
  (void)lambda;
  (void)throughput;
  (void)emitted;
  return false;
}
