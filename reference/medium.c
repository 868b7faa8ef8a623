/* medium.c: homogeneous media. */
#include "medium.h"

#include <stdlib.h>

#include "refuse.h"

static bool read_medium(const vlMediumDef *def, medium *m, vlError *error) {
  if (def->kind != VL_MEDIUM_HOMOGENEOUS) return refuse_kind(error, def->source, "media", (uint32_t)def->kind);
  if (def->rgb_absorption) return refuse(error, def->source, "absorption by RGB channel", NULL);
  if (!read_color(&def->sigma_a, VL_PARAMETER_UNBOUNDED, &m->absorbs, error)) return false;
  if (!read_color(&def->sigma_s, VL_PARAMETER_UNBOUNDED, &m->scatters, error)) return false;
  if (!read_color(&def->emission, VL_PARAMETER_ILLUMINANT, &m->emission, error)) return false;
  m->scale = (double)def->scale;
  m->emission_scale = (double)def->emission_scale;
  m->g = (double)def->g;
  return true;
}

bool read_media(world *w, vlError *error) {
  while (vl_scene_medium(w->scene, (vlMediumId){w->medium_count + 1})) w->medium_count++;
  w->media = calloc(w->medium_count + 1, sizeof *w->media);
  if (!w->media) return refuse_memory(error);
  for (uint32_t i = 0; i < w->medium_count && !w->media_are_absent; i++) {
    if (!read_medium(vl_scene_medium(w->scene, (vlMediumId){i + 1}), &w->media[i], error)) return false;
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

spectrum absorption(const medium *m, const wavelengths *lambda) {
  return scaled(m->scale, color_at(&m->absorbs, lambda));
}
spectrum scattering(const medium *m, const wavelengths *lambda) {
  return scaled(m->scale, color_at(&m->scatters, lambda));
}

spectrum transmittance(const medium *m, double distance, const wavelengths *lambda) {
  spectrum t = plus(absorption(m, lambda), scattering(m, lambda));
  for (int i = 0; i < CHANNELS; i++) t.c[i] = t.c[i] > 0 ? exp(-t.c[i] * distance) : 1;
  return t;
}

/* The integral of sigma_a L exp(-sigma_t x) over the distance. */
spectrum medium_emission(const medium *m, double distance, const wavelengths *lambda) {
  spectrum a = absorption(m, lambda), s = scattering(m, lambda);
  spectrum result = scaled(m->emission_scale, color_at(&m->emission, lambda));
  for (int i = 0; i < CHANNELS; i++) {
    double sigma = a.c[i] + s.c[i];
    if (result.c[i] == 0) continue;
    result.c[i] *= sigma > 0 ? a.c[i] * -expm1(-sigma * distance) / sigma : 0;
  }
  return result;
}

/* pbrt book 11.3.1, with the cosine between wo and wi; both point away. */
double phase(const medium *m, vector wo, vector wi) {
  double g = m->g;
  double d = 1 + g * g + 2 * g * dot(wo, wi);
  return (1 - g * g) / (4 * PI * d * sqrt(fmax(1e-300, d)));
}

vector sample_phase(const medium *m, vector wo, sampler *s) {
  square_point u = sample_unit_square(s);
  double g = m->g, cosine;
  if (fabs(g) < 1e-3)
    cosine = 1 - 2 * u.x;
  else
    cosine = -1 / (2 * g) * (1 + g * g - square((1 - g * g) / (1 + g - 2 * g * u.x)));
  double sine = sqrt(fmax(0, 1 - square(cosine)));
  frame f = make_frame(wo, make_vector(0.3, 0.5, 0.8));
  return from_local(f, make_vector(sine * cos(2 * PI * u.y), sine * sin(2 * PI * u.y), cosine));
}
