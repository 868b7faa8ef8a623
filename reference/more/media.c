/* more/media.c: the media of more/, by kind. */
#include "more.h"

bool is_homogeneous(const vlMediumDef *m) {
  return m->kind == VL_MEDIUM_HOMOGENEOUS;
}

/* The integral of sigma_a L exp(-sigma_t x) over the distance. */
spectrum emission_along(const world *w, const vlMediumDef *m, double distance, const wavelengths *lambda) {
  (void)w;
  spectrum a = coefficient(m, &m->sigma_a, lambda), s = coefficient(m, &m->sigma_s, lambda);
  const color *emission = find_color(&m->emission, VL_PARAMETER_ILLUMINANT);
  spectrum result = scaled((double)m->emission_scale, times(a, color_at(emission, lambda)));
  for (int i = 0; i < CHANNELS; i++) {
    double sigma = a.c[i] + s.c[i];
    result.c[i] *= sigma > 0 ? -expm1(-sigma * distance) / sigma : 0;
  }
  return result;
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
