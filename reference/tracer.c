/* tracer.c: path tracing. The rendering equation (Kajiya 1986) says that the radiance leaving a point is what the point
 * emits, plus what arrives there from all directions and is scattered on. A path estimates it: at each point it asks
 * one light, and follows one direction (pbrt book 13, 14). */
#include "tracer.h"

#include "light.h"
#include "material.h"

/* What a path is and has gathered so far. */
typedef struct path {
  ray r;
  spectrum radiance;   /* found so far */
  spectrum throughput; /* the share of light that reaches the eye from the path's end */
  const medium *inside;
  uint32_t depth;
  /* how the last direction was chosen: needed where the ray meets a light that could also have been asked */
  vector chosen_at;
  double chosen_density;
  bool chosen_alone; /* no light could have been asked for this direction */
} path;

static ray ray_from(const world *w, vector origin, vector direction, double time) {
  return (ray){origin, direction, surface_distance(w, origin), INFINITY, time};
}

/* Where a ray leaves a surface. A curve turns to face each ray: so that the new one does not meet it, it starts as far
 * off as the curve is thick. */
static vector start_from(const shade_record *at, vector direction) {
  double side = dot(direction, at->normal) < 0 ? -1 : 1;
  return add(at->point, scale(side * 5 * at->thickness, at->normal));
}

/* Both ways of finding a light, asking it and meeting it, have a density. Each result is multiplied by its share of the
 * squares, so that the sum counts once (power heuristic, Veach 1997). */
static double share_of(double own, double other) {
  return isfinite(own) ? square(own) / (square(own) + square(other)) : 1;
}

/* ---- the lecture's direct light ---------------------------------------------------------------------------------- */

/* The shadow ray: the share of light that gets from a light to a point, 0 behind a surface, less than 1 through media.
 */
static spectrum visibility(const world *w, ray r, double distance, const medium *inside, sampler *s,
                           const wavelengths *lambda) {
  spectrum share = gray(1);
  for (;;) {
    shade_record at;
    r.t_max = distance * (1 - 1e-10) - surface_distance(w, r.origin);
    bool found = find_hit(w, r, s, &at);
    if (found && !is_interface(material_at(w, &at, s))) return gray(0);
    double step = found ? at.t : distance;
    if (inside) share = times(share, transmittance(inside, r, step, s, lambda));
    if (!found || largest(share) == 0) return share;
    inside = medium_beyond(w, &at, r.direction, inside);
    distance -= step;
    r = ray_from(w, at.point, r.direction, r.time);
  }
}

/* Asks one light. The surface's BSDF at `at`, or else (null) the medium's phase function, scatters its light. */
static void add_direct_light(const world *w, path *p, vector point, vector wo, const bsdf *b, const shade_record *at,
                             sampler *s, const wavelengths *lambda) {
  light_sample asked;
  if (!sample_light(w, point, s, lambda, &asked)) return;
  double density = b ? 0 : phase(p->inside, wo, asked.direction);
  spectrum value = b ? bsdf_value(b, wo, asked.direction, s, &density) : gray(density);
  value = times(value, asked.radiance);
  if (largest(value) == 0) return;
  const medium *inside = b ? medium_beyond(w, at, asked.direction, p->inside) : p->inside;
  ray shadow = ray_from(w, b ? start_from(at, asked.direction) : point, asked.direction, p->r.time);
  spectrum arriving = times(value, visibility(w, shadow, asked.distance, inside, s, lambda));
  double share = asked.single ? 1 : share_of(asked.density, density);
  p->radiance = plus(p->radiance, scaled(share / asked.density, times(p->throughput, arriving)));
}

/* Light that the path meets by itself. */
static void add_met_light(path *p, spectrum emitted, double light_density) {
  if (largest(emitted) == 0) return;
  double share = p->chosen_alone ? 1 : share_of(p->chosen_density, light_density);
  p->radiance = plus(p->radiance, scaled(share, times(p->throughput, emitted)));
}

static void add_skies(const world *w, path *p, const wavelengths *lambda) {
  for (uint32_t i = 0; i < w->light_count; i++) {
    double density;
    spectrum emitted;
    if (emitted_by_sky(w, &w->lights[i], p->r.direction, lambda, &emitted, &density))
      add_met_light(p, emitted, density);
  }
}

/* ---- the next ray ------------------------------------------------------------------------------------------------ */

static void go_on(const world *w, path *p, vector point, vector direction, double density, bool alone) {
  p->r = ray_from(w, point, direction, p->r.time);
  p->chosen_at = point;
  p->chosen_density = density;
  p->chosen_alone = alone;
}

/* The path scatters in the medium. */
static void scatter_in_medium(const world *w, path *p, double distance, sampler *s, const wavelengths *lambda) {
  vector point = add(p->r.origin, scale(distance, p->r.direction));
  vector wo = negate(p->r.direction);
  add_direct_light(w, p, point, wo, NULL, NULL, s, lambda);
  vector wi = sample_phase(p->inside, wo, s);
  go_on(w, p, point, wi, phase(p->inside, wo, wi), false);
}

/* The path is reflected or goes on through the surface. False: it ends. */
static bool scatter_at_surface(const world *w, path *p, const material *m, const shade_record *at, sampler *s,
                               wavelengths *lambda) {
  vector wo = negate(p->r.direction);
  bsdf b = make_bsdf(w, m, at, lambda);
  add_direct_light(w, p, at->point, wo, &b, at, s, lambda);
  bsdf_sample next;
  if (!sample_bsdf(&b, wo, s, &next)) return false;
  p->throughput = times(p->throughput, next.weight);
  p->inside = medium_beyond(w, at, next.wi, p->inside);
  go_on(w, p, start_from(at, next.wi), next.wi, next.density, next.specular);
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

spectrum trace_ray(const world *w, ray r, const medium *inside, uint32_t max_depth, sampler *s, wavelengths *lambda,
                   bool *met) {
  path p = {.r = r, .throughput = gray(1), .inside = inside, .chosen_at = r.origin, .chosen_alone = true};
  *met = false;
  while (survives(&p, s)) {
    shade_record at;
    bool found = find_hit(w, p.r, s, &at);
    double distance = found ? at.t : (double)INFINITY;
    spectrum emission = gray(0);
    bool in_medium = p.inside && scatters_before(p.inside, p.r, &distance, s, lambda, &p.throughput, &emission);
    if (p.depth < max_depth) p.radiance = plus(p.radiance, emission);
    if (in_medium) {
      if (p.depth++ >= max_depth) break;
      scatter_in_medium(w, &p, distance, s, lambda);
      continue;
    }
    if (!found) {
      add_skies(w, &p, lambda);
      break;
    }
    *met = true;
    add_met_light(&p, emitted_by_surface(w, &at, negate(p.r.direction), lambda),
                  density_of_surface(w, &at, p.chosen_at));
    const material *m = material_at(w, &at, s);
    if (is_interface(m)) {
      p.inside = medium_beyond(w, &at, p.r.direction, p.inside);
      p.r = ray_from(w, at.point, p.r.direction, p.r.time);
      continue;
    }
    if (p.depth++ >= max_depth || !scatter_at_surface(w, &p, m, &at, s, lambda)) break;
  }
  return p.radiance;
}
