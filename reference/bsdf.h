/* bsdf.h: how a surface, or a medium, scatters light at one point (pbrt book 9). Directions point away from the point:
 * wo to where the path comes from, wi to where it goes on. A value is that of f(wo, wi) times the cosine |wi . n|. */
#pragma once
#include "more/kinds.h"

typedef enum bsdf_kind { BSDF_DIFFUSE, BSDF_CONDUCTOR, BSDF_DIELECTRIC, BSDF_PHASE, BSDF_MORE } bsdf_kind;

typedef struct bsdf {
  bsdf_kind kind;
  frame frame;             /* z is the shading normal, x the tangent */
  spectrum reflectance;    /* diffuse */
  spectrum eta, k;         /* conductor: complex index of refraction */
  double ior;              /* dielectric: index inside over index outside */
  double alpha_x, alpha_y; /* roughness along the tangent and across it */
  double g;                /* phase function of a medium: mean cosine */
  more_bsdf more;          /* the kinds of more/ */
} bsdf;

typedef struct bsdf_sample {
  vector wi;
  spectrum weight; /* f cos / density */
  double density;  /* per solid angle; not used if specular */
  bool specular;   /* the only direction there is: no other sampling can find it */
} bsdf_sample;

/* Value and density for two directions in the world. A specular BSDF has the value 0: no two given directions fit. The
 * sampler is for coats, whose value is estimated by a random walk. */
spectrum bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density);
bool sample_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);

/* The kinds, for directions in the local frame (z is the normal). Sampling finds wi; the weight only if specular. */
spectrum conductor_value(const bsdf *b, vector wo, vector wi, double *density);
void sample_conductor(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
spectrum dielectric_value(const bsdf *b, vector wo, vector wi, double *density);
bool sample_dielectric(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
/* medium.c: the phase function of Henyey and Greenstein; in sampling, wo is the z axis. */
double phase(double g, vector wo, vector wi);
vector sample_phase(double g, sampler *s);

/* dielectric.c: Fresnel's and Snell's laws. */
double reflected_by_glass(double cosine, double eta);
bool refract(vector wo, vector m, double ior, double *eta, vector *wi);
