/* more/bsdfs.h: the BSDFs of more/, for directions in the local frame. Sampling finds wi; the weight only if specular.
 */
#pragma once
#include "bsdf.h"

/* A diffuse surface or a metal under a coat. Values are found by random walks, which draw numbers. */
spectrum coated_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density);
bool sample_coated(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);

spectrum hair_value(const bsdf *b, vector wo, vector wi, double *density);
void sample_hair(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
spectrum absorption_of_hair_color(spectrum looks, double beta_n);

spectrum diffuse_transmission_value(const bsdf *b, vector wo, vector wi, double *density);
bool sample_diffuse_transmission(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
void sample_thin_glass(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
