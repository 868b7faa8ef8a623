/* medium.c: homogeneous media: the same everywhere. */
#include "more/more.h"

const vlMediumDef *medium_of(const world *w, vlMediumId id) {
  return w->media_are_absent ? NULL : vl_scene_medium(w->scene, id);
}

const vlMediumDef *medium_beyond(const world *w, const shade_record *at, vector direction, const vlMediumDef *now) {
  const vlShapeDef *def = at->where ? at->where->def : NULL;
  if (!def || def->inside.index == def->outside.index) return now;
  return medium_of(w, dot(direction, at->normal) > 0 ? def->outside : def->inside);
}

spectrum coefficient(const vlMediumDef *m, const vlSpectrum *sigma, const wavelengths *lambda) {
  return scaled((double)m->scale, color_at(find_color(sigma, VL_PARAMETER_UNBOUNDED), lambda));
}

/* Beer's law: exp(-sigma_t distance), sigma_t = sigma_a + sigma_s. */
spectrum transmittance(const vlMediumDef *m, ray r, double distance, sampler *s, const wavelengths *lambda) {
  if (m->kind != VL_MEDIUM_HOMOGENEOUS) return more_transmittance(m, r, distance, s, lambda);
  spectrum t = plus(coefficient(m, &m->sigma_a, lambda), coefficient(m, &m->sigma_s, lambda));
  for (int i = 0; i < CHANNELS; i++) t.c[i] = t.c[i] > 0 ? exp(-t.c[i] * distance) : 1;
  return t;
}

/* The distance x to where the path scatters is drawn with the density sigma_s exp(-sigma_s x) of one channel (pbrt book
 * A.4.2); absorption is only a factor. As each channel may have been the one, what is left of the light is divided by
 * the mean of their densities: that of x, or the probability exp(-sigma_s distance) of passing (balance heuristic). */
bool scatters_before(const vlMediumDef *m, ray r, double *distance, sampler *s, const wavelengths *lambda,
                     spectrum *throughput, spectrum *emitted) {
  if (m->kind != VL_MEDIUM_HOMOGENEOUS) return scatters_in_more(m, r, distance, s, lambda, throughput, emitted);
  *emitted = plus(*emitted, times(*throughput, emission_along(m, *distance, lambda)));
  spectrum sigma_s = coefficient(m, &m->sigma_s, lambda);
  uint32_t channels = channels_of(lambda);
  double chosen = sigma_s.c[choose(s, channels)];
  double flight = chosen > 0 ? -log1p(-next_number(s)) / chosen : (double)INFINITY;
  bool scatters = flight < *distance;
  if (scatters) *distance = flight;
  double density = 0;
  for (uint32_t i = 0; i < channels; i++) {
    double passes = sigma_s.c[i] > 0 ? exp(-sigma_s.c[i] * *distance) : 1;
    density += passes * (scatters ? sigma_s.c[i] : 1) / channels;
  }
  if (scatters) *throughput = times(*throughput, sigma_s);
  *throughput = times(*throughput, transmittance(m, r, *distance, s, lambda));
  *throughput = density > 0 ? scaled(1 / density, *throughput) : gray(0);
  return scatters;
}

bsdf phase_function(const vlMediumDef *m, vector wo) {
  return (bsdf){.kind = BSDF_PHASE, .g = (double)m->g, .frame = make_frame(wo, make_vector(0.3, 0.5, 0.8))};
}

/* Henyey and Greenstein: (1 - g^2) / (4 pi (1 + g^2 + 2 g cos)^1.5), with the cosine between wo and wi, which both
 * point away (pbrt book 11.3.1). The cosine is drawn by the inverse of the formula's integral; g = 0 is uniform. */
double phase(double g, vector wo, vector wi) {
  double d = 1 + g * g + 2 * g * dot(wo, wi);
  return (1 - g * g) / (4 * PI * d * sqrt(fmax(1e-300, d)));
}

vector sample_phase(double g, sampler *s) {
  square_point u = sample_unit_square(s);
  double cosine = 1 - 2 * u.x;
  if (fabs(g) >= 1e-3) cosine = -1 / (2 * g) * (1 + g * g - square((1 - g * g) / (1 + g - 2 * g * u.x)));
  double sine = sqrt(fmax(0, 1 - square(cosine)));
  return make_vector(sine * cos(2 * PI * u.y), sine * sin(2 * PI * u.y), cosine);
}
