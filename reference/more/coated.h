/* more/coated.h: a diffuse surface under a clear coat. Values are found by random walks, which draw numbers. */
#pragma once
#include "bsdf.h"

spectrum coated_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density);
bool sample_coated(const bsdf *b, vector wo, sampler *s, bsdf_sample *result);
