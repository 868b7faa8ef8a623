/* more/lights.c: the brightness of lights, and the lights of more/. */
#include "more.h"
#include "octahedral.h"

/* The illuminance of a surface that faces up, light space +z, by the sky with factor 1; by even light it is pi. */
static double sky_illuminance(const light *l) {
  uint32_t n = l->map.width;
  double sum = 0;
  if (n == 0) return PI;
  for (uint32_t i = 0; i < n * n; i++) {
    double v[4];
    vector d = direction_of((square_point){(i % n + 0.5) / n, (i / n + 0.5) / n});
    pixel_of(&l->map, i % n, i / n, VL_WRAP_CLAMP, VL_WRAP_CLAMP, v);
    sum += fmax(0, 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]) * fmax(0, d.z);
  }
  return sum * 4 * PI / ((double)n * n);
}

/* The power of a point is spread over the sphere, that of a spot over its cone, the soft edge counted half. */
void read_more_light(light *l) {
  const vlLightDef *def = l->def;
  double inner = cos((double)def->cone_angle - (double)def->cone_delta), outer = cos((double)def->cone_angle);
  l->factor = (double)def->scale;
  if (def->kind == VL_LIGHT_INFINITE && !isnan(def->illuminance)) l->factor *= def->illuminance / sky_illuminance(l);
  if (def->kind == VL_LIGHT_DISTANT && !isnan(def->illuminance)) l->factor *= def->illuminance;
  if (def->kind == VL_LIGHT_POINT && !isnan(def->power)) l->factor *= def->power / (4 * PI);
  if (def->kind == VL_LIGHT_SPOT && !isnan(def->power)) l->factor *= def->power / (2 * PI * (1 - (inner + outer) / 2));
}

/* `power` is that of each primitive: radiance times area times pi, on each side. */
double emission_factor(const world *w, const light *l) {
  const vlEmissionDef *def = l->emission;
  if (!(def->power > 0)) return (double)def->scale;
  shade_record corner = {0};
  shape_surface(w, l->what, 0, 0, &corner);
  return (double)def->scale * def->power * corner.area_density / (PI * (def->two_sided ? 2 : 1));
}
