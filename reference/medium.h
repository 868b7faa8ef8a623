/* medium.h: fog, milk, coloured glass: media that absorb and scatter light (pbrt book 11). */
#pragma once
#include "bsdf.h"
#include "world.h"

/* The medium with an id; null: vacuum. */
const vlMediumDef *medium_of(const world *w, vlMediumId id);
/* The medium that a ray enters when it goes on from a point in a direction; `now` where no surface separates media. */
const vlMediumDef *medium_beyond(const world *w, const shade_record *at, vector direction, const vlMediumDef *now);

/* The share of light that is left after a distance along the ray. */
spectrum transmittance(const world *w, const vlMediumDef *m, ray r, double distance, sampler *s,
                       const wavelengths *lambda);
/* Draws where a path along the ray scatters, before a distance; the throughput becomes what is left there, over the
 * density of the draw. False: not before `distance`. Adds what the medium emits on the way. */
bool scatters_before(const world *w, const vlMediumDef *m, ray r, double *distance, sampler *s,
                     const wavelengths *lambda, spectrum *throughput, spectrum *emitted);
/* How the medium scatters light that goes on towards wo. */
bsdf phase_function(const vlMediumDef *m, vector wo);
