/* medium.h: fog, milk, coloured glass: media that absorb and scatter light, the same everywhere (pbrt book 11). */
#ifndef REFERENCE_MEDIUM_H
#define REFERENCE_MEDIUM_H

#include "world.h"

struct medium {
  color absorbs, scatters; /* sigma_a and sigma_s, per unit of length */
  color emission;          /* emitted radiance per unit of length, over sigma_a */
  double scale, emission_scale;
  double g; /* mean cosine of the phase function */
};

bool read_media(world *w, vlError *error);
/* The medium with an id; null: vacuum. */
const medium *medium_of(const world *w, vlMediumId id);
/* The medium that a ray enters when it leaves the surface at `at` in a direction; `now` where the surface does not
 * separate media. */
const medium *medium_beyond(const world *w, const shade_record *at, vector direction, const medium *now);

spectrum absorption(const medium *m, const wavelengths *lambda);
spectrum scattering(const medium *m, const wavelengths *lambda);
/* Beer's law: the share of light that is left after a distance. */
spectrum transmittance(const medium *m, double distance, const wavelengths *lambda);
/* What the medium itself adds along a distance. */
spectrum medium_emission(const medium *m, double distance, const wavelengths *lambda);

/* The phase function of Henyey and Greenstein: the density of the direction wi, for light that came from -wo. */
double phase(const medium *m, vector wo, vector wi);
vector sample_phase(const medium *m, vector wo, sampler *s);

#endif
