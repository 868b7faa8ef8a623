/* api/defs.c: what a scene says about its picture, as the defs of render and film. */
#include <string.h>

#include "scene/scene.h"
#include "velo/render.h"

vlRenderDef vl_scene_render_def(const vlScene *scene) {
  const vlSceneSettings *s = &scene->settings;
  vlRenderDef def = vl_default_render_def();
  def.tracer = s->tracer;
  def.sampler = s->sampler;
  def.spp = s->spp;
  def.seed = s->sampler_seed;
  def.max_depth = s->max_depth;
  def.ao_distance = s->ao_distance;
  def.ao_cosine = s->ao_cosine;
  def.centred = s->centred;
  def.same_wavelengths = s->same_wavelengths;
  def.sharp_textures = s->sharp_textures;
  def.merge_radius = s->merge_radius;
  def.light_paths = s->light_paths;
  return def;
}

vlFilmDef vl_scene_film_def(const vlScene *scene) {
  const vlSceneSettings *s = &scene->settings;
  vlFilmDef def = vl_default_film_def(s->width, s->height);
  memcpy(def.crop, s->crop, sizeof def.crop);
  def.filter = s->filter;
  def.space = s->space;
  def.sensor = s->sensor;
  def.white_balance = s->white_balance;
  def.buckets = s->buckets;
  def.lambda_min = s->lambda_min;
  def.lambda_max = s->lambda_max;
  def.max_component = s->exposure > 0.0f ? s->max_component / s->exposure : s->max_component;
  return def;
}
