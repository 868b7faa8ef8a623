/* light.c: all lights of the world, and one sample of one of them. */
#include "more/more.h"

static light *add_light(world *w, vlColorSpace space) {
  w->lights = resize(w->lights, w->light_count + 1, sizeof *w->lights);
  light *l = &w->lights[w->light_count++];
  *l = (light){.white = vl_spectrum_rgb(1, 1, 1)};
  l->white.space = space;
  return l;
}

/* The scene's lights, then each primitive of a shape that emits. As in pbrt-v4, instances emit nothing. */
bool read_lights(world *w, vlError *error) {
  const vlLightDef *def;
  for (uint32_t i = 1; (def = vl_scene_light(w->scene, (vlLightId){i})); i++) {
    light *l = add_light(w, def->space);
    l->def = def;
    l->world_from_light = load_matrix(def->world_from_light);
    l->light_from_world = invert(&l->world_from_light);
    if (!read_light_image(w, l, error)) return false;
    if (l->map.image && def->kind == VL_LIGHT_INFINITE) make_sky(l);
    read_more_light(l);
  }
  for (uint32_t i = 0; i < w->primitive_count; i++) {
    primitive *p = &w->primitives[i];
    const vlShapeDef *shape = w->placements[p->placement].def;
    const vlEmissionDef *emission = vl_scene_emission(w->scene, shape->emission);
    if (!emission || shape->group.index) continue;
    const vlTextureDef *texture = vl_scene_texture(w->scene, emission->texture);
    p->light = (int32_t)w->light_count;
    light *l = add_light(w, texture ? texture->space : VL_SPACE_SRGB);
    l->emission = emission;
    l->what = p;
    if (!read_light_image(w, l, error)) return false;
    l->factor = emission_factor(w, l);
  }
  return true;
}

/* A light that shows an image in colours has the white of the image's colour space, which the image multiplies. */
spectrum light_color(const light *l, const wavelengths *lambda) {
  const vlSpectrum *own = l->def ? &l->def->color : &l->emission->radiance;
  bool colored = l->emission ? l->emission->texture.index > 0 : l->map.image && l->def->kind != VL_LIGHT_GONIOMETRIC;
  return scaled(l->factor, color_at(find_color(colored ? &l->white : own, VL_PARAMETER_ILLUMINANT), lambda));
}

spectrum emitted_by_surface(const world *w, const shade_record *at, vector towards, const wavelengths *lambda) {
  if (at->what->light < 0) return gray(0);
  const light *l = &w->lights[at->what->light];
  if (!l->emission->two_sided && dot(towards, at->normal) <= 0) return gray(0);
  spectrum radiance = scaled(share_of_spread(l->emission, fabs(dot(towards, at->normal))), light_color(l, lambda));
  if (l->map.image) return times(radiance, shown_on_surface(l, at, lambda));
  vlSpectrumInput image = {.texture = l->emission->texture};
  if (!image.texture.index) return radiance;
  return times(radiance, spectrum_at(w, &image, VL_PARAMETER_UNBOUNDED, at, lambda));
}

/* Seen from the point, an area fills a solid angle of area cosine / distance^2: density per solid angle = density per
 * area times distance^2 / cosine (pbrt book 4.2.3). Each light is asked with the probability 1 / light_count. */
double density_of_surface(const world *w, const shade_record *at, vector point) {
  vector to_light = subtract(at->point, point);
  double distance2 = dot(to_light, to_light);
  double cosine = fabs(dot(at->normal, to_light)) / sqrt(distance2);
  return cosine > 0 ? at->area_density * distance2 / cosine / w->light_count : 0;
}

bool aim_at(vector place, vector point, light_sample *result) {
  vector to_light = subtract(place, point);
  result->distance = length(to_light);
  result->direction = normalize(to_light);
  return result->distance > 0;
}

/* A surface with alpha 0 everywhere shines, as in pbrt-v4, though no ray meets it. */
static bool sample_surface(const world *w, const light *l, vector point, sampler *s, const wavelengths *lambda,
                           light_sample *result) {
  shade_record at = {0};
  sample_shape(w, l->what, s, &at);
  if (!aim_at(at.point, point, result)) return false;
  vlFloatInput alpha = at.where->def->alpha;
  result->single = !alpha.texture.index && alpha.value == 0;
  result->radiance = emitted_by_surface(w, &at, negate(result->direction), lambda);
  if (!result->single) result->radiance = scaled(fmin(number_at(w, alpha, &at), 1), result->radiance);
  result->density = density_of_surface(w, &at, point);
  return result->density > 0;
}

/* From 0 at the outer cone of a spot to 1 at the inner one: pbrt's smooth step (book 12.2.1), or glTF's square. */
static double spot_share(const vlLightDef *def, double cosine) {
  double outer = cos((double)def->cone_angle), inner = cos((double)def->cone_angle - (double)def->cone_delta);
  if (inner == outer) return cosine >= outer ? 1 : 0;
  double t = clamp((cosine - outer) / (inner - outer), 0, 1);
  return def->cone_squared ? t * t : t * t * (3 - 2 * t);
}

/* Light from one direction, or from one place: its intensity becomes radiance by the square of the distance. */
static bool sample_lamp(const light *l, vector point, const wavelengths *lambda, light_sample *result) {
  vector axis = subtract(from_floats(l->def->to), from_floats(l->def->from)); /* in the light's own space */
  vector from = transform_point(&l->world_from_light, from_floats(l->def->from));
  result->direction = normalize(transform_vector(&l->world_from_light, negate(axis)));
  result->radiance = light_color(l, lambda);
  if (l->def->kind == VL_LIGHT_DISTANT) return true;
  if (!aim_at(from, point, result)) return false;
  spectrum share = gray(1);
  vector away = normalize(transform_vector(&l->light_from_world, negate(result->direction)));
  if (l->def->kind == VL_LIGHT_SPOT) share = gray(spot_share(l->def, dot(away, normalize(axis))));
  if (l->map.image) share = shown_by_lamp(l, negate(result->direction), lambda);
  result->radiance = scaled(1 / square(result->distance), times(share, result->radiance));
  return true;
}

/* All lights are drawn with the same probability: simple, and wasteful where some are far. */
bool sample_light(const world *w, vector point, sampler *s, const wavelengths *lambda, light_sample *result) {
  if (w->light_count == 0) return false;
  const light *l = &w->lights[choose(s, w->light_count)];
  *result = (light_sample){.distance = (double)INFINITY, .single = true, .density = 1.0 / w->light_count};
  if (!l->def) return sample_surface(w, l, point, s, lambda, result);
  if (l->def->kind != VL_LIGHT_INFINITE) return sample_lamp(l, point, lambda, result);
  result->direction = sample_sky(l, s);
  result->single = false;
  result->radiance = sky_radiance(l, point, result->direction, lambda);
  result->density = sky_density(w, l, result->direction);
  return true;
}
