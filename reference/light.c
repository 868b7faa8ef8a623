/* light.c: all lights of the world, and one sample of one of them. Scales follow pbrt-v4: a spectrum is divided by its
 * luminance, `scale` multiplies it; `power` and `illuminance` set the brightness instead. */
#include "light.h"

#include <stdlib.h>

#include "more/more.h"
#include "refuse.h"
#include "texture.h"

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static bool read_light(const world *w, const vlLightDef *def, light *l, vlError *error) {
  matrix m = load_matrix(def->world_from_light);
  vector to = transform_point(&m, from_floats(def->to));
  *l = (light){.factor = (double)def->scale, .space = def->space};
  l->position = transform_point(&m, from_floats(def->from));
  l->direction = normalize(subtract(to, l->position));
  l->cos_outer = cos((double)def->cone_angle);
  l->cos_inner = cos((double)def->cone_angle - (double)def->cone_delta);
  l->cone_squared = def->cone_squared;
  double solid_angle = 4 * PI; /* that an even light of the same power fills */
  if (!read_color(&def->color, VL_PARAMETER_ILLUMINANT, &l->emitted, error)) return false;
  switch (def->kind) {
    case VL_LIGHT_POINT: l->kind = LIGHT_POINT; break;
    case VL_LIGHT_SPOT:
      l->kind = LIGHT_SPOT;
      solid_angle = 2 * PI * ((1 - l->cos_inner) + (l->cos_inner - l->cos_outer) / 2);
      break;
    case VL_LIGHT_DISTANT:
      l->kind = LIGHT_DISTANT;
      l->direction = negate(l->direction);
      if (!isnan(def->illuminance)) l->factor *= def->illuminance;
      return true;
    case VL_LIGHT_INFINITE: l->kind = LIGHT_SKY; return read_sky(w, def, l, error);
    default: l->kind = LIGHT_MORE; return read_more_light(w, def, l, error);
  }
  if (!isnan(def->power)) l->factor *= def->power / solid_angle;
  return true;
}

/* A primitive of an emissive shape. `power` is that of each primitive: radiance times area times pi, on each side. */
static bool read_surface_light(const world *w, const primitive *p, light *l, vlError *error) {
  const vlShapeDef *shape = w->placements[p->placement].def;
  const vlEmissionDef *def = vl_scene_emission(w->scene, shape->emission);
  *l = (light){.kind = LIGHT_SURFACE, .what = p, .emission = def, .factor = (double)def->scale};
  l->invisible = !shape->alpha.texture.index && shape->alpha.value == 0;
  if (def->image) return refuse(error, def->source, "an emission image");
  vlSpectrum radiance = def->radiance;
  if (def->texture.index) {
    l->space = vl_scene_texture(w->scene, def->texture)->space;
    radiance = vl_spectrum_rgb(1, 1, 1);
    radiance.space = l->space;
  }
  if (!(def->power > 0)) return read_color(&radiance, VL_PARAMETER_ILLUMINANT, &l->emitted, error);
  if (shape->kind != VL_SHAPE_TRIANGLES || def->texture.index)
    return refuse(error, def->source, "this emission by power");
  shade_record corner = {0};
  shape_surface(w, p, 0, 0, &corner);
  l->factor *= def->power * corner.area_density / (PI * (def->two_sided ? 2 : 1));
  return read_color(&radiance, VL_PARAMETER_ILLUMINANT, &l->emitted, error);
}

bool read_lights(world *w, vlError *error) {
  const vlLightDef *def;
  for (; (def = vl_scene_light(w->scene, (vlLightId){w->light_count + 1})); w->light_count++) {
    w->lights = resize(w->lights, w->light_count + 1, sizeof *w->lights);
    if (!read_light(w, def, &w->lights[w->light_count], error)) return false;
  }
  for (uint32_t i = 0; i < w->primitive_count; i++) {
    const vlShapeDef *shape = w->placements[w->primitives[i].placement].def;
    if (!shape->emission.index || shape->group.index || shape->positions_close) continue;
    w->lights = resize(w->lights, w->light_count + 1, sizeof *w->lights);
    w->primitives[i].light = (int32_t)w->light_count;
    if (!read_surface_light(w, &w->primitives[i], &w->lights[w->light_count++], error)) return false;
  }
  return true;
}

void free_lights(world *w) {
  for (uint32_t i = 0; i < w->light_count; i++) {
    free_image_map(&w->lights[i].sky.map);
    free(w->lights[i].sky.sums);
  }
  free(w->lights);
}

/* ---- surfaces ---------------------------------------------------------------------------------------------------- */

spectrum emitted_by_surface(const world *w, const shade_record *at, vector towards, const wavelengths *lambda) {
  if (at->what->light < 0) return gray(0);
  const light *l = &w->lights[at->what->light];
  if (!l->emission->two_sided && dot(towards, at->normal) <= 0) return gray(0);
  spectrum radiance = scaled(l->factor, color_at(&l->emitted, lambda));
  if (!l->emission->texture.index) return radiance;
  vlSpectrumInput texture = {.texture = l->emission->texture};
  return times(radiance, spectrum_at(w, texture, NULL, VL_PARAMETER_UNBOUNDED, at, lambda));
}

/* An area looks smaller by its cosine and by the square of the distance: density per solid angle = density per area
 * times distance^2 / cosine. */
double density_of_surface(const world *w, const shade_record *at, vector point) {
  vector to_light = subtract(at->point, point);
  double distance2 = dot(to_light, to_light);
  double cosine = fabs(dot(at->normal, to_light)) / sqrt(distance2);
  return cosine > 0 ? at->area_density * distance2 / cosine / w->light_count : 0;
}

static bool sample_surface(const world *w, const light *l, vector point, sampler *s, const wavelengths *lambda,
                           light_sample *result) {
  shade_record at = {0};
  sample_shape(w, l->what, s, &at);
  if (!aim_at(at.point, point, result)) return false;
  double alpha = l->invisible ? 1 : number_at(w, at.where->def->alpha, &at);
  spectrum radiance = emitted_by_surface(w, &at, negate(result->direction), lambda);
  result->radiance = scaled(fmin(alpha, 1), radiance);
  result->density = density_of_surface(w, &at, point);
  result->single = l->invisible;
  return true;
}

/* ---- one light for a point --------------------------------------------------------------------------------------- */

bool aim_at(vector place, vector point, light_sample *result) {
  vector to_light = subtract(place, point);
  result->distance = length(to_light);
  result->direction = normalize(to_light);
  return result->distance > 0;
}

/* pbrt's smooth step between the cone's two cosines; glTF's is a square. */
static double spot_share(const light *l, double cosine) {
  if (l->cos_inner == l->cos_outer) return cosine >= l->cos_outer ? 1 : 0;
  double t = clamp((cosine - l->cos_outer) / (l->cos_inner - l->cos_outer), 0, 1);
  return l->cone_squared ? t * t : t * t * (3 - 2 * t);
}

/* All lights are drawn with the same probability: simple, and wasteful where some are far. The intensity of a point
 * becomes radiance by the square of the distance. */
bool sample_light(const world *w, vector point, sampler *s, const wavelengths *lambda, light_sample *result) {
  if (w->light_count == 0) return false;
  const light *l = &w->lights[choose(s, w->light_count)];
  *result = (light_sample){.distance = INFINITY, .single = true, .density = 1.0 / w->light_count};
  result->radiance = scaled(l->factor, color_at(&l->emitted, lambda));
  switch (l->kind) {
    case LIGHT_DISTANT: result->direction = l->direction; return true;
    case LIGHT_SKY:
      result->direction = sample_sky(l, s);
      result->single = false;
      return emitted_by_sky(w, l, result->direction, lambda, &result->radiance, &result->density);
    case LIGHT_SURFACE: return sample_surface(w, l, point, s, lambda, result) && result->density > 0;
    case LIGHT_MORE: return sample_more_light(w, l, point, s, lambda, result);
    default: break;
  }
  if (!aim_at(l->position, point, result)) return false;
  double share = l->kind == LIGHT_SPOT ? spot_share(l, -dot(result->direction, l->direction)) : 1;
  result->radiance = scaled(share / square(result->distance), result->radiance);
  return true;
}

bool emitted_by_sky(const world *w, const light *l, vector direction, const wavelengths *lambda, spectrum *radiance,
                    double *density) {
  if (l->kind != LIGHT_SKY) return false;
  *radiance = sky_radiance(l, direction, lambda);
  *density = sky_density(l, direction) / w->light_count;
  return true;
}
