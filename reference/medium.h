/* medium.h: fog, milk, coloured glass: media that absorb and scatter light, the same everywhere (pbrt book 11). */
#ifndef REFERENCE_MEDIUM_H
#define REFERENCE_MEDIUM_H

#include "more/kinds.h"
#include "world.h"

struct medium {
  bool homogeneous;        /* else a medium of more/ */
  color absorbs, scatters; /* sigma_a and sigma_s, per unit of length */
  color emission;          /* emitted radiance per unit of length, over sigma_a */
  double scale, emission_scale;
  double g; /* mean cosine of the phase function */
  more_medium more;
};

bool read_media(world *w, vlError *error);
/* The medium with an id; null: vacuum. */
const medium *medium_of(const world *w, vlMediumId id);
/* The medium that a ray enters when it leaves the surface at `at` in a direction; `now` where the surface does not
 * separate media. */
const medium *medium_beyond(const world *w, const shade_record *at, vector direction, const medium *now);

/* The share of light that is left after a distance along the ray. */
spectrum transmittance(const medium *m, ray r, double distance, sampler *s, const wavelengths *lambda);
/* Draws where a path along the ray scatters, before a distance; the throughput becomes what is left there, over the
 * density of the draw. False: not before `distance`. Adds what the medium emits on the way. */
bool scatters_before(const medium *m, ray r, double *distance, sampler *s, const wavelengths *lambda,
                     spectrum *throughput, spectrum *emitted);

/* The phase function of Henyey and Greenstein: the density of the direction wi, for light that came from -wo. */
double phase(const medium *m, vector wo, vector wi);
vector sample_phase(const medium *m, vector wo, sampler *s);

#endif
