/* light.h: where light comes from: points, distant directions, surfaces and the sky (pbrt book 12). */
#pragma once
#include "more/kinds.h"
#include "world.h"

/* The sky's image and the table from which directions are drawn in proportion to it. */
typedef struct sky {
  image_map map;
  matrix world_from_light, light_from_world;
  double *sums; /* of all pixels before each one, row by row, over the sum of all: width^2 + 1 numbers; null: even */
} sky;

struct light {
  const vlLightDef *def; /* null: a surface */
  const vlEmissionDef *emission;
  const primitive *what;
  double factor;    /* on the colour */
  vlSpectrum white; /* of what an image shows */
  sky sky;
  more_light more;
};

/* Light that arrives at a point from a sample of a light. */
typedef struct light_sample {
  vector direction; /* from the point to the light */
  double distance;  /* infinite for the sky */
  spectrum radiance;
  double density; /* per solid angle; 1 for light from one point or direction */
  bool single;    /* from one point or direction: no ray can meet it by chance */
} light_sample;

bool read_lights(world *w, vlError *error);
/* One sample of one light, both drawn; the density includes the choice. */
bool sample_light(const world *w, vector point, sampler *s, const wavelengths *lambda, light_sample *result);
/* The sample's direction and distance, if it comes from this place. */
bool aim_at(vector place, vector point, light_sample *result);
/* A light's colour times its factor. */
spectrum light_color(const world *w, const light *l, const wavelengths *lambda);
/* What a surface emits towards a direction, and the density with which sample_light finds it from a point. */
spectrum emitted_by_surface(const world *w, const shade_record *at, vector towards, const wavelengths *lambda);
double density_of_surface(const world *w, const shade_record *at, vector point);

/* sky.c: a light of the sky, which a ray finds when it leaves the world. */
bool read_sky(const world *w, light *l, vlError *error);
spectrum sky_radiance(const world *w, const light *l, vector direction, const wavelengths *lambda);
vector sample_sky(const light *l, sampler *s);
double sky_density(const light *l, vector direction);
/* The equal-area octahedral map: from a direction to a point of the unit square, and back. */
square_point square_of(vector direction);
vector direction_of(square_point p);
