/* light.c: all lights of the world, and one sample of one of them. Scales follow pbrt-v4: a spectrum is divided by its
 * luminance, `scale` multiplies it; `power` and `illuminance` set the brightness instead. */
#include "light.h"

#include "more/more.h"
#include "refuse.h"
#include "texture.h"

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static light *add_light(world *w, double factor) {
  w->lights = resize(w->lights, w->light_count + 1, sizeof *w->lights);
  light *l = &w->lights[w->light_count++];
  *l = (light){.factor = factor, .white = vl_spectrum_rgb(1, 1, 1)};
  return l;
}

/* The power of a point light is spread over the sphere, that of a spot over its cone, the soft edge counted half. */
static bool read_light(world *w, const vlLightDef *def, vlError *error) {
  light *l = add_light(w, (double)def->scale);
  double inner = cos((double)def->cone_angle - (double)def->cone_delta), outer = cos((double)def->cone_angle);
  l->def = def;
  l->white.space = def->space;
  if (def->kind == VL_LIGHT_INFINITE) return read_sky(w, l, error);
  if (def->kind == VL_LIGHT_DISTANT && !isnan(def->illuminance)) l->factor *= def->illuminance;
  if (def->kind == VL_LIGHT_POINT && !isnan(def->power)) l->factor *= def->power / (4 * PI);
  if (def->kind == VL_LIGHT_SPOT && !isnan(def->power)) l->factor *= def->power / (2 * PI * (1 - (inner + outer) / 2));
  return read_more_light(w, l, error);
}

/* A primitive of an emissive shape. `power` is that of each primitive: radiance times area times pi, on each side. */
static void read_surface_light(world *w, primitive *p, const vlEmissionDef *def) {
  p->light = (int32_t)w->light_count;
  light *l = add_light(w, (double)def->scale);
  l->what = p;
  l->emission = def;
  if (def->texture.index) l->white.space = vl_scene_texture(w->scene, def->texture)->space;
  if (!(def->power > 0)) return;
  shade_record corner = {0};
  shape_surface(w, p, 0, 0, &corner);
  l->factor *= def->power * corner.area_density / (PI * (def->two_sided ? 2 : 1));
}

bool read_lights(world *w, vlError *error) {
  const vlLightDef *def;
  for (uint32_t i = 1; (def = vl_scene_light(w->scene, (vlLightId){i})); i++) {
    if (!read_light(w, def, error)) return false;
  }
  for (uint32_t i = 0; i < w->primitive_count; i++) {
    const vlShapeDef *shape = w->placements[w->primitives[i].placement].def;
    const vlEmissionDef *emission = vl_scene_emission(w->scene, shape->emission);
    bool emits = emission && !shape->group.index && !shape->positions_close;
    if (emits) read_surface_light(w, &w->primitives[i], emission);
  }
  return true;
}

spectrum light_color(const world *w, const light *l, const wavelengths *lambda) {
  const vlSpectrum *own = l->def ? &l->def->color : &l->emission->radiance;
  bool image = l->sky.sums || (l->emission && l->emission->texture.index);
  return scaled(l->factor, color_at(find_color(w->colors, image ? &l->white : own, VL_PARAMETER_ILLUMINANT), lambda));
}

/* ---- surfaces ---------------------------------------------------------------------------------------------------- */

spectrum emitted_by_surface(const world *w, const shade_record *at, vector towards, const wavelengths *lambda) {
  if (at->what->light < 0) return gray(0);
  const light *l = &w->lights[at->what->light];
  if (!l->emission->two_sided && dot(towards, at->normal) <= 0) return gray(0);
  spectrum radiance = light_color(w, l, lambda);
  if (!l->emission->texture.index) return radiance;
  vlSpectrumInput texture = {.texture = l->emission->texture};
  return times(radiance, spectrum_at(w, &texture, VL_PARAMETER_UNBOUNDED, at, lambda));
}

/* An area looks smaller by its cosine and by the square of the distance: density per solid angle = density per area
 * times distance^2 / cosine. */
double density_of_surface(const world *w, const shade_record *at, vector point) {
  vector to_light = subtract(at->point, point);
  double distance2 = dot(to_light, to_light);
  double cosine = fabs(dot(at->normal, to_light)) / sqrt(distance2);
  return cosine > 0 ? at->area_density * distance2 / cosine / w->light_count : 0;
}

/* A surface with alpha 0 everywhere is invisible: rays pass, light samples do not notice. */
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

/* ---- one light for a point --------------------------------------------------------------------------------------- */

bool aim_at(vector place, vector point, light_sample *result) {
  vector to_light = subtract(place, point);
  result->distance = length(to_light);
  result->direction = normalize(to_light);
  return result->distance > 0;
}

/* pbrt's smooth step between the cone's two cosines; glTF's is a square. */
static double spot_share(const vlLightDef *def, double cosine) {
  double outer = cos((double)def->cone_angle), inner = cos((double)def->cone_angle - (double)def->cone_delta);
  if (inner == outer) return cosine >= outer ? 1 : 0;
  double t = clamp((cosine - outer) / (inner - outer), 0, 1);
  return def->cone_squared ? t * t : t * t * (3 - 2 * t);
}

/* All lights are drawn with the same probability: simple, and wasteful where some are far. The intensity of a point
 * becomes radiance by the square of the distance. */
bool sample_light(const world *w, vector point, sampler *s, const wavelengths *lambda, light_sample *result) {
  if (w->light_count == 0) return false;
  const light *l = &w->lights[choose(s, w->light_count)];
  *result = (light_sample){.distance = (double)INFINITY, .single = true, .density = 1.0 / w->light_count};
  if (!l->def) return sample_surface(w, l, point, s, lambda, result);
  matrix m = load_matrix(l->def->world_from_light);
  vector from = transform_point(&m, from_floats(l->def->from)), to = transform_point(&m, from_floats(l->def->to));
  vector axis = normalize(subtract(to, from));
  result->radiance = light_color(w, l, lambda);
  switch (l->def->kind) {
    case VL_LIGHT_DISTANT: result->direction = negate(axis); return true;
    case VL_LIGHT_INFINITE:
      result->direction = sample_sky(l, s);
      result->single = false;
      result->radiance = sky_radiance(w, l, result->direction, lambda);
      result->density = sky_density(l, result->direction) / w->light_count;
      return true;
    case VL_LIGHT_POINT:
    case VL_LIGHT_SPOT: break;
    default: return sample_more_light(w, l, point, s, lambda, result);
  }
  if (!aim_at(from, point, result)) return false;
  double share = l->def->kind == VL_LIGHT_SPOT ? spot_share(l->def, -dot(result->direction, axis)) : 1;
  result->radiance = scaled(share / square(result->distance), result->radiance);
  return true;
}
