/* tracer.c: path tracing. The rendering equation (Kajiya 1986) says that the radiance leaving a point is what the point
 * emits, plus what arrives there from all directions and is scattered on. A path estimates it: at each point it asks
 * one light, and follows one direction (pbrt book 13, 14). */
#include "tracer.h"

#include "light.h"
#include "material.h"

/* What a path is and has gathered so far. */
typedef struct path {
  ray r;
  spectrum radiance;         /* found so far */
  spectrum throughput;       /* the share of light that reaches the eye from the path's end */
  const vlMediumDef *inside; /* the medium around the ray; null: vacuum */
  uint32_t depth;
  /* how the last direction was chosen: needed where the ray meets a light that could also have been asked */
  vector chosen_at;
  double chosen_density;
  bool chosen_alone; /* no light could have been asked for this direction */
} path;

/* A ray that leaves a point. A curve turns to face each ray: so that the new one does not meet it, it starts as far off
 * as the curve is thick. */
static ray ray_from(const world *w, const shade_record *at, vector direction, double time) {
  double side = dot(direction, at->normal) < 0 ? -1 : 1;
  vector origin = add(at->point, scale(side * at->thickness, at->normal));
  return (ray){origin, direction, surface_distance(w, origin), (double)INFINITY, time};
}

/* Both ways of finding a light, asking it and meeting it, have a density. Each result is multiplied by its share of the
 * squares, so that the sum counts once (power heuristic, Veach 1997). */
static double share_of(double own, double other) {
  return isfinite(own) ? square(own) / (square(own) + square(other)) : 1;
}

static bool is_interface(const world *w, const shade_record *at, sampler *s) {
  return material_at(w, at, s)->kind == VL_MATERIAL_INTERFACE;
}

/* The lecture's shadow ray: the share of light that gets from a light to a point, 0 behind a surface, less than 1
 * through media. */
static spectrum visibility(const world *w, ray r, double distance, const vlMediumDef *inside, sampler *s,
                           const wavelengths *lambda) {
  spectrum share = gray(1);
  for (;;) {
    shade_record at;
    r.t_max = distance * (1 - 1e-10) - surface_distance(w, r.origin);
    bool found = find_hit(w, r, s, &at);
    if (found && !is_interface(w, &at, s)) return gray(0);
    double step = found ? at.t : distance;
    if (inside) share = times(share, transmittance(w, inside, r, step, s, lambda));
    if (!found || largest(share) == 0) return share;
    inside = medium_beyond(w, &at, r.direction, inside);
    distance -= step;
    r = ray_from(w, &at, r.direction, r.time);
  }
}

/* The lecture's direct light: asks one light, whose light is scattered towards wo. */
static void add_direct_light(const world *w, path *p, const bsdf *b, const shade_record *at, sampler *s,
                             const wavelengths *lambda) {
  light_sample asked;
  double density;
  if (!sample_light(w, at->point, s, lambda, &asked)) return;
  spectrum value = times(asked.radiance, bsdf_value(b, negate(p->r.direction), asked.direction, s, &density));
  if (largest(value) == 0) return;
  ray shadow = ray_from(w, at, asked.direction, p->r.time);
  if (at->thickness > 0 && isfinite(asked.distance)) { /* to the same place of the light, from where the ray starts */
    aim_at(add(at->point, scale(asked.distance, asked.direction)), shadow.origin, &asked);
    shadow.direction = asked.direction;
  }
  const vlMediumDef *inside = medium_beyond(w, at, asked.direction, p->inside);
  value = times(value, visibility(w, shadow, asked.distance, inside, s, lambda));
  double share = asked.single ? 1 : share_of(asked.density, density);
  p->radiance = plus(p->radiance, scaled(share / asked.density, times(p->throughput, value)));
}

/* Light that the path meets by itself: on a surface, or in the sky. */
static void add_met_light(path *p, spectrum emitted, double light_density) {
  if (largest(emitted) == 0) return;
  double share = p->chosen_alone ? 1 : share_of(p->chosen_density, light_density);
  p->radiance = plus(p->radiance, scaled(share, times(p->throughput, emitted)));
}

static void add_skies(const world *w, path *p, const wavelengths *lambda) {
  for (uint32_t i = 0; i < w->light_count; i++) {
    const light *l = &w->lights[i];
    if (!l->def || l->def->kind != VL_LIGHT_INFINITE) continue;
    double density = sky_density(l, p->r.direction) / w->light_count;
    add_met_light(p, sky_radiance(w, l, p->r.direction, lambda), density);
  }
}

/* The path goes on in a direction that the BSDF chooses. False: it ends. */
static bool scatter(const world *w, path *p, const bsdf *b, const shade_record *at, sampler *s) {
  bsdf_sample next;
  if (!sample_bsdf(b, negate(p->r.direction), s, &next)) return false;
  p->throughput = times(p->throughput, next.weight);
  p->inside = medium_beyond(w, at, next.wi, p->inside);
  p->r = ray_from(w, at, next.wi, p->r.time);
  p->chosen_at = p->r.origin;
  p->chosen_density = next.density;
  p->chosen_alone = next.specular;
  return true;
}

/* Paths that carry little light end by chance; those that go on carry more, so that the mean stays (Russian roulette).
 */
static bool survives(path *p, sampler *s) {
  double most = largest(p->throughput);
  if (p->depth < 4 || most >= 1) return most > 0;
  double chance = fmax(0.1, most);
  p->throughput = scaled(1 / chance, p->throughput);
  return most > 0 && next_number(s) < chance;
}

spectrum trace_ray(const world *w, ray r, const vlMediumDef *inside, uint32_t max_depth, sampler *s,
                   wavelengths *lambda, bool *met) {
  path p = {.r = r, .throughput = gray(1), .inside = inside, .chosen_at = r.origin, .chosen_alone = true};
  while (survives(&p, s)) {
    shade_record at;
    bool found = find_hit(w, p.r, s, &at);
    double distance = found ? at.t : (double)INFINITY;
    spectrum emission = gray(0);
    bsdf b;
    bool in_medium = p.inside && scatters_before(w, p.inside, p.r, &distance, s, lambda, &p.throughput, &emission);
    if (p.depth < max_depth) p.radiance = plus(p.radiance, emission);
    if (!in_medium && !found) add_skies(w, &p, lambda);
    if (!in_medium && !found) break;
    if (in_medium) {
      at = (shade_record){.point = add(p.r.origin, scale(distance, p.r.direction))};
      b = phase_function(p.inside, negate(p.r.direction));
    } else {
      *met = true;
      add_met_light(&p, emitted_by_surface(w, &at, negate(p.r.direction), lambda),
                    density_of_surface(w, &at, p.chosen_at));
      const vlMaterialDef *m = material_at(w, &at, s);
      if (m->kind == VL_MATERIAL_INTERFACE) {
        p.inside = medium_beyond(w, &at, p.r.direction, p.inside);
        p.r = ray_from(w, &at, p.r.direction, p.r.time);
        continue;
      }
      if (p.depth < max_depth) b = make_bsdf(w, m, &at, lambda);
    }
    if (p.depth++ >= max_depth) break;
    add_direct_light(w, &p, &b, &at, s, lambda);
    if (!scatter(w, &p, &b, &at, s)) break;
  }
  return p.radiance;
}
