/* light.c: all lights of the world, and one sample of one of them. Scales follow pbrt-v4: a spectrum is divided by its
 * luminance, `scale` multiplies it; `power` and `illuminance` set the brightness instead. */
#include "light.h"

#include <stdlib.h>

#include "refuse.h"
#include "texture.h"

static bool is_set(double value) {
  return value == value;
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static bool read_light(const world *w, const vlLightDef *def, light *l, vlError *error) {
  matrix m = load_matrix(def->world_from_light);
  vector from = transform_point(&m, from_floats(def->from));
  vector to = transform_point(&m, from_floats(def->to));
  l->position = from;
  l->direction = normalize(subtract(to, from));
  l->factor = (double)def->scale;
  l->space = def->space;
  if (!read_color(&def->color, VL_PARAMETER_ILLUMINANT, &l->emitted, error)) return false;
  switch (def->kind) {
    case VL_LIGHT_POINT:
      l->kind = LIGHT_POINT;
      if (is_set(def->power)) l->factor *= def->power / (4 * PI);
      return true;
    case VL_LIGHT_SPOT: {
      l->kind = LIGHT_SPOT;
      l->cos_outer = cos((double)def->cone_angle);
      l->cos_inner = cos((double)def->cone_angle - (double)def->cone_delta);
      l->cone_squared = def->cone_squared;
      double cone = 2 * PI * ((1 - l->cos_inner) + (l->cos_inner - l->cos_outer) / 2);
      if (is_set(def->power)) l->factor *= def->power / cone;
      return true;
    }
    case VL_LIGHT_DISTANT:
      l->kind = LIGHT_DISTANT;
      l->direction = negate(l->direction);
      if (is_set(def->illuminance)) l->factor *= def->illuminance;
      return true;
    case VL_LIGHT_INFINITE: l->kind = LIGHT_SKY; return read_sky(w, def, l, error);
    default: return refuse_kind(error, def->source, "lights", (uint32_t)def->kind);
  }
}

/* A primitive of an emissive shape. `power` is that of each primitive: radiance times area times pi, on each side. */
static bool read_surface_light(const world *w, const primitive *p, light *l, vlError *error) {
  const vlShapeDef *shape = w->placements[p->placement].def;
  const vlEmissionDef *def = vl_scene_emission(w->scene, shape->emission);
  l->kind = LIGHT_SURFACE;
  l->what = p;
  l->emission = def;
  l->factor = (double)def->scale;
  l->space = VL_SPACE_SRGB;
  l->invisible = !shape->alpha.texture.index && shape->alpha.value == 0;
  if (def->image) return refuse(error, def->source, "an emission image", NULL);
  if (def->texture.index) {
    l->space = vl_scene_texture(w->scene, def->texture)->space;
    white_light(l->space, &l->emitted);
  } else if (!read_color(&def->radiance, VL_PARAMETER_ILLUMINANT, &l->emitted, error)) {
    return false;
  }
  if (!is_set(def->power) || !(def->power > 0)) return true;
  if (shape->kind != VL_SHAPE_TRIANGLES || def->texture.index)
    return refuse(error, def->source, "this emission by power", NULL);
  shade_record center;
  shape_surface(w, p, 0, 0, &center);
  l->factor *= def->power * center.area_density / (PI * (def->two_sided ? 2 : 1));
  return true;
}

static bool emits(const world *w, const primitive *p) {
  const vlShapeDef *def = w->placements[p->placement].def;
  return def->emission.index && !def->group.index && !def->positions_close;
}

bool read_lights(world *w, vlError *error) {
  uint32_t count = 0;
  while (vl_scene_light(w->scene, (vlLightId){count + 1})) count++;
  uint32_t most = count;
  for (uint32_t i = 0; i < w->primitive_count; i++) most += emits(w, &w->primitives[i]);
  w->lights = calloc(most + 1, sizeof *w->lights);
  if (!w->lights) return refuse_memory(error);
  for (uint32_t i = 0; i < count; i++) {
    if (!read_light(w, vl_scene_light(w->scene, (vlLightId){i + 1}), &w->lights[w->light_count++], error)) return false;
  }
  for (uint32_t i = 0; i < w->primitive_count; i++) {
    primitive *p = &w->primitives[i];
    p->light = -1;
    if (!emits(w, p)) continue;
    p->light = (int32_t)w->light_count;
    if (!read_surface_light(w, p, &w->lights[w->light_count++], error)) return false;
  }
  return true;
}

void free_lights(world *w) {
  for (uint32_t i = 0; i < w->light_count; i++) {
    free_image_map(&w->lights[i].sky.image);
    free(w->lights[i].sky.rows);
    free(w->lights[i].sky.columns);
  }
  free(w->lights);
}

/* ---- surfaces ---------------------------------------------------------------------------------------------------- */

static spectrum radiance_of(const world *w, const light *l, const shade_record *at, vector towards,
                            const wavelengths *lambda) {
  if (!l->emission->two_sided && dot(towards, at->normal) <= 0) return gray(0);
  spectrum radiance = scaled(l->factor, color_at(&l->emitted, lambda));
  if (!l->emission->texture.index) return radiance;
  double rgb[3];
  texel_at(w, l->emission->texture, at, rgb);
  return times(radiance, unbounded_of(l->space, rgb, lambda));
}

spectrum emitted_by_surface(const world *w, const shade_record *at, vector towards, const wavelengths *lambda) {
  if (at->what->light < 0) return gray(0);
  return radiance_of(w, &w->lights[at->what->light], at, towards, lambda);
}

/* An area looks smaller by its cosine and by the square of the distance: density per solid angle = density per area
 * times distance^2 / cosine. */
static double solid_angle_density(const shade_record *at, vector point) {
  vector to_light = subtract(at->point, point);
  double distance2 = dot(to_light, to_light);
  double cosine = fabs(dot(at->normal, to_light)) / sqrt(distance2);
  return cosine > 0 ? at->area_density * distance2 / cosine : 0;
}

double density_of_surface(const world *w, const shade_record *at, vector point) {
  return solid_angle_density(at, point) / w->light_count;
}

static bool sample_surface(const world *w, const light *l, vector point, sampler *s, const wavelengths *lambda,
                           light_sample *result) {
  shade_record at;
  sample_shape(w, l->what, s, &at);
  vector to_light = subtract(at.point, point);
  result->distance = length(to_light);
  if (result->distance == 0) return false;
  result->direction = scale(1 / result->distance, to_light);
  result->density = solid_angle_density(&at, point);
  if (!(result->density > 0)) return false;
  result->radiance = radiance_of(w, l, &at, negate(result->direction), lambda);
  double alpha = number_at(w, at.where->def->alpha, &at);
  if (!l->invisible && alpha < 1) result->radiance = scaled(alpha, result->radiance);
  result->single = l->invisible;
  return true;
}

/* ---- one light for a point --------------------------------------------------------------------------------------- */

/* pbrt's smooth step between the cone's two cosines; glTF's is a square. */
static double spot_share(const light *l, double cosine) {
  if (l->cos_inner == l->cos_outer) return cosine >= l->cos_outer ? 1 : 0;
  double t = clamp((cosine - l->cos_outer) / (l->cos_inner - l->cos_outer), 0, 1);
  return l->cone_squared ? t * t : t * t * (3 - 2 * t);
}

static bool sample_this_light(const world *w, const light *l, vector point, sampler *s, const wavelengths *lambda,
                              light_sample *result) {
  result->single = true;
  result->density = 1;
  result->radiance = scaled(l->factor, color_at(&l->emitted, lambda));
  switch (l->kind) {
    case LIGHT_POINT:
    case LIGHT_SPOT: {
      vector to_light = subtract(l->position, point);
      result->distance = length(to_light);
      if (result->distance == 0) return false;
      result->direction = scale(1 / result->distance, to_light);
      double share = l->kind == LIGHT_SPOT ? spot_share(l, -dot(result->direction, l->direction)) : 1;
      result->radiance = scaled(share / square(result->distance), result->radiance);
      return true;
    }
    case LIGHT_DISTANT:
      result->direction = l->direction;
      result->distance = INFINITY;
      return true;
    case LIGHT_SKY:
      result->direction = sample_sky(l, s, &result->density);
      result->distance = INFINITY;
      result->radiance = sky_radiance(l, result->direction, lambda);
      result->single = false;
      return result->density > 0;
    case LIGHT_SURFACE: return sample_surface(w, l, point, s, lambda, result);
  }
  return false;
}

/* All lights are drawn with the same probability: simple, and wasteful where some are far. */
bool sample_light(const world *w, vector point, sampler *s, const wavelengths *lambda, light_sample *result) {
  if (w->light_count == 0) return false;
  const light *l = &w->lights[choose(s, w->light_count)];
  if (!sample_this_light(w, l, point, s, lambda, result)) return false;
  result->density /= w->light_count;
  return true;
}

bool emitted_by_sky(const world *w, uint32_t index, vector direction, const wavelengths *lambda, spectrum *radiance,
                    double *density) {
  const light *l = &w->lights[index];
  if (l->kind != LIGHT_SKY) return false;
  *radiance = sky_radiance(l, direction, lambda);
  *density = sky_density(l, direction) / w->light_count;
  return true;
}
