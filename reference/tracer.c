/* tracer.c: path tracing. The rendering equation (Kajiya 1986) says that the radiance leaving a point is what the point
 * emits, plus what arrives there from all directions and is scattered on. A path estimates it: at each point it asks
 * one light, and follows one direction (pbrt book 13, 14). */
#include "more/more.h"

/* What a path is and has gathered so far. */
typedef struct path {
  const world *w;
  sampler *s;
  wavelengths *lambda;
  ray r;
  spectrum radiance;         /* found so far */
  spectrum throughput;       /* the share of light that reaches the eye from the path's end */
  const vlMediumDef *inside; /* the medium around the ray; null: vacuum */
  uint32_t depth, max_depth; /* bounces so far, and at most */
  /* how the last direction was chosen: needed where the ray meets a light that could also have been asked */
  vector chosen_at;
  double chosen_density;
  bool chosen_alone; /* no light could have been asked for this direction */
} path;

/* A computed point is off its surface by some 1e-15 of the largest coordinate. This is ten thousand times as much. */
double surface_distance(const world *w, vector p) {
  return 1e-11 * (w->radius + fabs(p.x) + fabs(p.y) + fabs(p.z));
}

/* A ray that leaves a point. A curve turns to face each ray: so that the new one does not meet it, it starts as far off
 * as the curve is thick. */
static ray ray_from(const path *p, const shade_record *at, vector direction) {
  double side = dot(direction, at->normal) < 0 ? -1 : 1;
  vector origin = add(at->point, scale(side * at->thickness, at->normal));
  return (ray){origin, direction, surface_distance(p->w, origin), (double)INFINITY, p->r.time};
}

/* A light can be found in two ways, by asking it and by meeting it. What one way finds is multiplied by the share of
 * its density in those of both, squared: the two shares add up to 1 (power heuristic, pbrt book 2.2.3). */
static double share_of(double own, double other) {
  return isfinite(own) ? square(own) / (square(own) + square(other)) : 1;
}

/* The lecture's shadow ray: the share of a light that reaches a point, 0 behind a surface, less than 1 in media. */
static spectrum visibility(const path *p, ray r, double distance, const vlMediumDef *inside) {
  spectrum share = gray(1);
  for (;;) {
    shade_record at;
    r.t_max = distance * (1 - 1e-10) - surface_distance(p->w, r.origin); /* not the light's own surface */
    bool found = find_hit(p->w, r, p->s, &at);
    if (found && material_at(p->w, &at, p->s)->kind != VL_MATERIAL_INTERFACE) return gray(0);
    double step = found ? at.t : distance;
    if (inside) share = times(share, transmittance(inside, r, step, p->s, p->lambda));
    if (!found || largest(share) == 0) return share;
    inside = medium_beyond(p->w, &at, r.direction, inside);
    distance -= step;
    r = ray_from(p, &at, r.direction);
  }
}

/* The lecture's direct light: asks one light how much of its light arrives, and is scattered back along the path. The
 * shadow ray starts at the surface's distance from the point, and is turned so that it ends at the same place. */
static void add_direct_light(path *p, const bsdf *b, const shade_record *at) {
  light_sample asked;
  double bsdf_density;
  if (!sample_light(p->w, at->point, p->s, p->lambda, &asked)) return;
  spectrum value = bsdf_value(b, negate(p->r.direction), asked.direction, p->s, &bsdf_density);
  spectrum scattered = times(asked.radiance, value);
  if (largest(scattered) == 0) return;
  const vlMediumDef *inside = medium_beyond(p->w, at, asked.direction, p->inside);
  ray shadow = ray_from(p, at, asked.direction);
  vector end = add(at->point, scale(asked.distance, asked.direction));
  if (isfinite(asked.distance)) aim_at(end, shadow.origin, &asked);
  shadow.direction = asked.direction;
  scattered = times(scattered, visibility(p, shadow, asked.distance, inside));
  double share = asked.single ? 1 : share_of(asked.density, bsdf_density);
  p->radiance = plus(p->radiance, scaled(share / asked.density, times(p->throughput, scattered)));
}

/* Light that the path meets by itself; light_density is that with which it would have been asked. */
static void add_met_light(path *p, spectrum emitted, double light_density) {
  if (largest(emitted) == 0) return;
  double share = p->chosen_alone ? 1 : share_of(p->chosen_density, light_density);
  p->radiance = plus(p->radiance, scaled(share, times(p->throughput, emitted)));
}

static void add_skies(path *p) {
  for (const light *l = p->w->lights; l < p->w->lights + p->w->light_count; l++) {
    if (!l->def || l->def->kind != VL_LIGHT_INFINITE) continue;
    add_met_light(p, sky_radiance(l, p->r.origin, p->r.direction, p->lambda), sky_density(p->w, l, p->r.direction));
  }
}

/* The path goes on in a direction that the BSDF chooses. False: it ends. */
static bool scatter(path *p, const bsdf *b, const shade_record *at) {
  bsdf_sample next;
  if (!sample_bsdf(b, negate(p->r.direction), p->s, &next)) return false;
  p->throughput = times(p->throughput, next.weight);
  cross_surface(b, negate(p->r.direction), next.wi, p->lambda);
  p->inside = medium_beyond(p->w, at, next.wi, p->inside);
  p->r = ray_from(p, at, next.wi);
  p->chosen_at = p->r.origin;
  p->chosen_density = next.density;
  p->chosen_alone = next.specular;
  return true;
}

/* From the fourth bounce on a path that carries little light ends by lot. The others then carry more, by the reciprocal
 * of their chance, so that the mean stays (Russian roulette, pbrt book 2.2.4). */
static bool survives(path *p) {
  double most = largest(p->throughput);
  if (p->depth < 4 || most >= 1) return most > 0;
  double chance = fmax(0.1, most);
  p->throughput = scaled(1 / chance, p->throughput);
  return most > 0 && next_number(p->s) < chance;
}

/* The medium on the way takes light away and adds its own. True if the path scatters there, before a distance. */
static bool scatters_in_medium(path *p, double distance, shade_record *at) {
  if (!p->inside) return false;
  spectrum emitted = gray(0);
  bool scatters = scatters_before(p->inside, p->r, &distance, p->s, p->lambda, &p->throughput, &emitted);
  if (p->depth < p->max_depth) p->radiance = plus(p->radiance, emitted);
  if (scatters) *at = (shade_record){.point = add(p->r.origin, scale(distance, p->r.direction))};
  return scatters;
}

spectrum trace_ray(const world *w, ray r, const vlMediumDef *inside, uint32_t max_depth, sampler *s,
                   wavelengths *lambda, bool *met) {
  path p = {w, s, lambda, .r = r, .throughput = gray(1), .inside = inside, .max_depth = max_depth};
  p.chosen_alone = true; /* no light could have been asked for what the eye sees */
  while (survives(&p)) {
    /* 1. where does the ray end? */
    shade_record at;
    const vlMaterialDef *material = NULL;
    bool found = find_hit(w, p.r, s, &at);
    bool in_medium = scatters_in_medium(&p, found ? at.t : (double)INFINITY, &at);
    if (!found && !in_medium) {
      add_skies(&p);
      break;
    }
    /* 2. what does the surface emit? That is all if it only separates two media */
    if (!in_medium) {
      *met = true;
      spectrum emitted = emitted_by_surface(w, &at, negate(p.r.direction), lambda);
      add_met_light(&p, emitted, density_of_surface(w, &at, p.chosen_at));
      material = material_at(w, &at, s);
      if (material->kind == VL_MATERIAL_INTERFACE) {
        p.inside = medium_beyond(w, &at, p.r.direction, p.inside);
        p.r = ray_from(&p, &at, p.r.direction);
        continue;
      }
    }
    /* 3. how is light scattered there? Ask one light, and go on */
    if (p.depth++ >= max_depth) break;
    bsdf b = material ? make_bsdf(w, material, &at, lambda) : phase_function(p.inside, negate(p.r.direction));
    add_direct_light(&p, &b, &at);
    if (!scatter(&p, &b, &at)) break;
  }
  return p.radiance;
}
