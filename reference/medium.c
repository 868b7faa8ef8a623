/* medium.c: homogeneous media. */
#include "medium.h"

#include "more/more.h"
#include "refuse.h"

static bool read_medium(const world *w, const vlMediumDef *def, medium *m, vlError *error) {
  *m = (medium){.scale = (double)def->scale, .emission_scale = (double)def->emission_scale, .g = (double)def->g};
  if (w->media_are_absent) return true;
  if (!read_color(&def->sigma_a, VL_PARAMETER_UNBOUNDED, &m->absorbs, error)) return false;
  if (!read_color(&def->sigma_s, VL_PARAMETER_UNBOUNDED, &m->scatters, error)) return false;
  if (!read_color(&def->emission, VL_PARAMETER_ILLUMINANT, &m->emission, error)) return false;
  m->homogeneous = def->kind == VL_MEDIUM_HOMOGENEOUS && !def->rgb_absorption;
  return m->homogeneous || read_more_medium(w, def, m, error);
}

bool read_media(world *w, vlError *error) {
  const vlMediumDef *def;
  for (; (def = vl_scene_medium(w->scene, (vlMediumId){w->medium_count + 1})); w->medium_count++) {
    w->media = resize(w->media, w->medium_count + 1, sizeof *w->media);
    if (!read_medium(w, def, &w->media[w->medium_count], error)) return false;
  }
  return true;
}

const medium *medium_of(const world *w, vlMediumId id) {
  return id.index && !w->media_are_absent ? &w->media[id.index - 1] : NULL;
}

const medium *medium_beyond(const world *w, const shade_record *at, vector direction, const medium *now) {
  const vlShapeDef *def = at->where->def;
  if (def->inside.index == def->outside.index) return now;
  return medium_of(w, dot(direction, at->normal) > 0 ? def->outside : def->inside);
}

/* Beer's law: exp(-sigma_t distance), sigma_t = sigma_a + sigma_s. */
spectrum transmittance(const medium *m, ray r, double distance, sampler *s, const wavelengths *lambda) {
  if (!m->homogeneous) return more_transmittance(m, r, distance, s, lambda);
  spectrum t = scaled(m->scale, plus(color_at(&m->absorbs, lambda), color_at(&m->scatters, lambda)));
  for (int i = 0; i < CHANNELS; i++) t.c[i] = t.c[i] > 0 ? exp(-t.c[i] * distance) : 1;
  return t;
}

/* The integral of sigma_a L exp(-sigma_t x) over the distance. */
static spectrum emission_along(const medium *m, double distance, const wavelengths *lambda) {
  spectrum a = scaled(m->scale, color_at(&m->absorbs, lambda));
  spectrum s = scaled(m->scale, color_at(&m->scatters, lambda));
  spectrum result = scaled(m->emission_scale, color_at(&m->emission, lambda));
  for (int i = 0; i < CHANNELS; i++) {
    double sigma = a.c[i] + s.c[i];
    if (result.c[i] > 0) result.c[i] *= sigma > 0 ? a.c[i] * -expm1(-sigma * distance) / sigma : 0;
  }
  return result;
}

/* The distance is drawn with the density sigma_s exp(-sigma_s x) of one channel; absorption is a factor. The result is
 * divided by the mean density over all channels, so that each may have been the one (single-sample balance heuristic).
 */
bool scatters_before(const medium *m, ray r, double *distance, sampler *s, const wavelengths *lambda,
                     spectrum *throughput, spectrum *emitted) {
  if (!m->homogeneous) return scatters_in_more(m, r, distance, s, lambda, throughput, emitted);
  *emitted = plus(*emitted, times(*throughput, emission_along(m, *distance, lambda)));
  spectrum sigma_s = scaled(m->scale, color_at(&m->scatters, lambda));
  uint32_t channels = channels_of(lambda);
  double by = sigma_s.c[choose(s, channels)];
  double flight = by > 0 ? -log1p(-next_number(s)) / by : (double)INFINITY;
  bool scatters = flight < *distance;
  if (scatters) *distance = flight;
  double density = 0;
  for (uint32_t i = 0; i < channels; i++) {
    double passes = sigma_s.c[i] > 0 ? exp(-sigma_s.c[i] * *distance) : 1;
    density += passes * (scatters ? sigma_s.c[i] : 1) / channels;
  }
  spectrum left = transmittance(m, r, *distance, s, lambda);
  *throughput = times(*throughput, scatters ? times(sigma_s, left) : left);
  *throughput = density > 0 ? scaled(1 / density, *throughput) : gray(0);
  return scatters;
}

/* pbrt book 11.3.1, with the cosine between wo and wi; both point away. */
double phase(const medium *m, vector wo, vector wi) {
  double g = m->g;
  double d = 1 + g * g + 2 * g * dot(wo, wi);
  return (1 - g * g) / (4 * PI * d * sqrt(fmax(1e-300, d)));
}

vector sample_phase(const medium *m, vector wo, sampler *s) {
  square_point u = sample_unit_square(s);
  double g = m->g;
  double cosine = 1 - 2 * u.x;
  if (fabs(g) >= 1e-3) cosine = -1 / (2 * g) * (1 + g * g - square((1 - g * g) / (1 + g - 2 * g * u.x)));
  double sine = sqrt(fmax(0, 1 - square(cosine)));
  frame f = make_frame(wo, make_vector(0.3, 0.5, 0.8));
  return from_local(f, make_vector(sine * cos(2 * PI * u.y), sine * sin(2 * PI * u.y), cosine));
}
