/* more/lights.c: the lights of more/, by kind. */
#include "more.h"

bool read_more_light(const world *w, light *l, vlError *error) {
  (void)w;
  (void)l;
  (void)error;
  return true;
}

bool sample_more_light(const world *w, const light *l, vector point, sampler *s, const wavelengths *lambda,
                       light_sample *result) {
  (void)w;
  (void)l;
  (void)point;
  (void)s;
  (void)lambda;
  (void)result;
  return false;
}
