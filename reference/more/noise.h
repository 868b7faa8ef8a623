/* more/noise.h: noise and what is made of it. */
#pragma once
#include <stdbool.h>

#include "sampler.h"

double noise(vector p);
double fbm(vector p, double omega, uint32_t octaves);
double turbulence(vector p, double omega, uint32_t octaves);
double windy_waves(vector p);
bool is_in_dot(square_point st);
void marble(vector p, double omega, uint32_t octaves, double variation, double rgb[3]);
