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

static ray ray_from(const world *w, vector origin, vector direction) {
  return (ray){origin, direction, surface_distance(w, origin), INFINITY};
}

/* Both ways of finding a light, asking it and meeting it, have a density. Each result is multiplied by its share of the
 * squares, so that the sum counts once (power heuristic, Veach 1997). */
static double share_of(double own, double other) {
  if (!isfinite(own)) return 1;
  return square(own) / (square(own) + square(other));
}

/* ---- shadow rays ------------------------------------------------------------------------------------------------- */

/* The share of light that gets from a distance to a point: 0 behind a surface, less than 1 through media. */
static spectrum visibility(const world *w, vector from, const light_sample *asked, const medium *inside, sampler *s,
                           const wavelengths *lambda) {
  spectrum share = gray(1);
  ray r = ray_from(w, from, asked->direction);
  double left = asked->distance;
  for (;;) {
    shade_record at;
    r.t_max = left * (1 - 1e-10) - surface_distance(w, r.origin);
    bool found = find_hit(w, r, s, &at);
    if (found && !is_interface(material_at(w, &at, s))) return gray(0);
    double distance = found ? at.t : left;
    if (inside) share = times(share, transmittance(inside, distance, lambda));
    if (!found || is_black(share)) return share;
    inside = medium_beyond(w, &at, r.direction, inside);
    left -= distance;
    r = ray_from(w, at.point, r.direction);
  }
}

/* The lecture's direct light: asks one light. The BSDF, or else the medium's phase function, scatters it. */
static void add_direct_light(const world *w, path *p, vector point, vector wo, const bsdf *b, const shade_record *at,
                             sampler *s, const wavelengths *lambda) {
  light_sample asked;
  if (!sample_light(w, point, s, lambda, &asked) || is_black(asked.radiance)) return;
  double density;
  spectrum value;
  const medium *inside = p->inside;
  if (b) {
    value = bsdf_value(b, wo, asked.direction, s, &density);
    inside = medium_beyond(w, at, asked.direction, inside);
  } else {
    density = phase(p->inside, wo, asked.direction);
    value = gray(density);
  }
  if (is_black(value)) return;
  spectrum arriving = times(asked.radiance, visibility(w, point, &asked, inside, s, lambda));
  double share = asked.single ? 1 : share_of(asked.density, density);
  p->radiance = plus(p->radiance, scaled(share / asked.density, times(p->throughput, times(value, arriving))));
}

/* ---- light that the path meets ----------------------------------------------------------------------------------- */

static void add_met_light(path *p, spectrum emitted, double light_density) {
  double share = p->chosen_alone ? 1 : share_of(p->chosen_density, light_density);
  p->radiance = plus(p->radiance, scaled(share, times(p->throughput, emitted)));
}

/* ---- media ------------------------------------------------------------------------------------------------------- */

/* The channels that count: three in RGB, one where only the first wavelength is left. */
static uint32_t channels_of(const wavelengths *lambda) {
  if (lambda->rgb) return 3;
  return lambda->density[1] == 0 ? 1 : CHANNELS;
}

/* Draws where the path scatters, with the density sigma_s exp(-sigma_s x) of one channel; absorption is a factor. The
 * result is divided by the mean density over all channels, so that each may have been the one (single-sample balance
 * heuristic). False: not before `distance`. */
static bool scatters_before(const medium *m, double *distance, sampler *s, const wavelengths *lambda,
                            spectrum *throughput) {
  spectrum sigma_s = scattering(m, lambda);
  uint32_t channels = channels_of(lambda);
  double by = sigma_s.c[choose(s, channels)];
  double flight = by > 0 ? -log1p(-next_number(s)) / by : INFINITY;
  bool scatters = flight < *distance;
  if (scatters) *distance = flight;
  double density = 0;
  for (uint32_t i = 0; i < channels; i++) {
    double passes = sigma_s.c[i] > 0 ? exp(-sigma_s.c[i] * *distance) : 1;
    density += passes * (scatters ? sigma_s.c[i] : 1) / channels;
  }
  spectrum left = transmittance(m, *distance, lambda);
  *throughput = times(*throughput, scatters ? times(sigma_s, left) : left);
  *throughput = density > 0 ? scaled(1 / density, *throughput) : gray(0);
  return scatters;
}

static void go_on(path *p, const world *w, vector point, vector direction, double density, bool alone) {
  p->r = ray_from(w, point, direction);
  p->chosen_at = point;
  p->chosen_density = density;
  p->chosen_alone = alone;
}

/* The path scatters in the medium at a point. */
static void scatter_in_medium(const world *w, path *p, double distance, sampler *s, const wavelengths *lambda) {
  vector point = add(p->r.origin, scale(distance, p->r.direction));
  vector wo = negate(p->r.direction);
  add_direct_light(w, p, point, wo, NULL, NULL, s, lambda);
  vector wi = sample_phase(p->inside, wo, s);
  go_on(p, w, point, wi, phase(p->inside, wo, wi), false);
}

/* ---- surfaces ---------------------------------------------------------------------------------------------------- */

/* The path is reflected or goes on through the surface. False: it ends. */
static bool scatter_at_surface(const world *w, path *p, const material *m, const shade_record *at, sampler *s,
                               wavelengths *lambda) {
  vector wo = negate(p->r.direction);
  bsdf b = make_bsdf(w, m, at, lambda);
  add_direct_light(w, p, at->point, wo, &b, at, s, lambda);
  bsdf_sample next;
  if (!sample_bsdf(&b, wo, s, &next)) return false;
  p->throughput = times(p->throughput, next.weight);
  go_on(p, w, at->point, next.wi, next.density, next.specular);
  p->inside = medium_beyond(w, at, next.wi, p->inside);
  return true;
}

/* Paths that carry little light end by chance; those that go on carry more, so that the mean stays (Russian roulette).
 */
static bool survives(path *p, sampler *s) {
  double most = largest(p->throughput);
  if (most == 0) return false;
  if (p->depth < 4 || most >= 1) return true;
  double chance = fmax(0.1, most);
  if (next_number(s) >= chance) return false;
  p->throughput = scaled(1 / chance, p->throughput);
  return true;
}

spectrum trace_ray(const world *w, ray r, const medium *inside, uint32_t max_depth, sampler *s, wavelengths *lambda,
                   bool *met) {
  path p = {.r = r, .throughput = gray(1), .inside = inside, .chosen_at = r.origin, .chosen_alone = true};
  *met = false;
  while (survives(&p, s)) {
    shade_record at;
    bool found = find_hit(w, p.r, s, &at);
    double distance = found ? at.t : INFINITY;
    if (p.inside) {
      spectrum before = p.throughput;
      if (p.depth < max_depth)
        p.radiance = plus(p.radiance, times(before, medium_emission(p.inside, distance, lambda)));
      if (scatters_before(p.inside, &distance, s, lambda, &p.throughput)) {
        if (p.depth++ >= max_depth) break;
        scatter_in_medium(w, &p, distance, s, lambda);
        continue;
      }
    }
    if (!found) {
      for (uint32_t i = 0; i < w->light_count; i++) {
        double density;
        spectrum emitted;
        if (emitted_by_sky(w, i, p.r.direction, lambda, &emitted, &density)) add_met_light(&p, emitted, density);
      }
      break;
    }
    *met = true;
    spectrum emitted = emitted_by_surface(w, &at, negate(p.r.direction), lambda);
    if (!is_black(emitted)) add_met_light(&p, emitted, density_of_surface(w, &at, p.chosen_at));
    const material *m = material_at(w, &at, s);
    if (is_interface(m)) {
      p.inside = medium_beyond(w, &at, p.r.direction, p.inside);
      p.r = ray_from(w, at.point, p.r.direction);
      continue;
    }
    if (p.depth++ >= max_depth) break;
    if (!scatter_at_surface(w, &p, m, &at, s, lambda)) break;
  }
  return p.radiance;
}
