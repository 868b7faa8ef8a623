/* sky.c: light from infinitely far away: uniform, or an image of all directions (pbrt book 3.8.3, 12.5). */
#include <stdlib.h>

#include "light.h"
#include "refuse.h"

/* ---- the equal-area octahedral map (Clarberg 2008) --------------------------------------------------------------- */

/* A direction becomes a point of the square -1 to 1: the upper hemisphere fills the diamond |x| + |y| <= 1 in its
 * middle, the lower one the four corners; equal solid angles fill equal areas. */
static square_point square_of(vector d) {
  double r = sqrt(fmax(0, 1 - fabs(d.z)));
  double phi = d.x == 0 && d.y == 0 ? 0 : atan2(fabs(d.y), fabs(d.x)) * 2 / PI;
  double y = phi * r;
  double x = r - y;
  if (d.z < 0) {
    double swap = x;
    x = 1 - y;
    y = 1 - swap;
  }
  return (square_point){(copysign(x, d.x) + 1) / 2, (copysign(y, d.y) + 1) / 2};
}

static vector direction_of(square_point p) {
  double u = 2 * p.x - 1, v = 2 * p.y - 1;
  double side = 1 - (fabs(u) + fabs(v)); /* positive in the diamond */
  double r = 1 - fabs(side);
  double phi = r == 0 ? PI / 4 : ((fabs(v) - fabs(u)) / r + 1) * PI / 4;
  double z = copysign(1 - r * r, side);
  double around = r * sqrt(fmax(0, 2 - r * r));
  return make_vector(copysign(cos(phi), u) * around, copysign(sin(phi), v) * around, z);
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static double pixel_luminance(const image_map *image, uint32_t x, uint32_t y) {
  double v[4];
  pixel_of(image, (long)x, (long)y, VL_WRAP_CLAMP, VL_WRAP_CLAMP, v);
  return fmax(0, 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]);
}

/* Tables of running sums: a number drawn from 0 to 1 lies between two of them, which is the pixel. A tenth of the
 * samples is spread evenly, so that no direction that shines is left out. */
static bool make_tables(sky *k) {
  uint32_t n = k->image.width;
  k->rows = calloc((size_t)n + 1, sizeof *k->rows);
  k->columns = calloc((size_t)n * (n + 1), sizeof *k->columns);
  if (!k->rows || !k->columns) return false;
  double total = 0;
  for (uint32_t y = 0; y < n; y++) {
    for (uint32_t x = 0; x < n; x++) total += pixel_luminance(&k->image, x, y);
  }
  double even = total > 0 ? 0.1 * total / ((double)n * n) : 1;
  for (uint32_t y = 0; y < n; y++) {
    double *row = k->columns + (size_t)y * (n + 1);
    for (uint32_t x = 0; x < n; x++) row[x + 1] = row[x] + pixel_luminance(&k->image, x, y) + even;
    k->rows[y + 1] = k->rows[y] + row[n];
    for (uint32_t x = 1; x <= n; x++) row[x] /= row[n] > 0 && x < n ? row[n] : 1;
    row[n] = 1;
  }
  double sum = k->rows[n];
  for (uint32_t y = 1; y <= n; y++) k->rows[y] /= sum;
  return true;
}

/* The illuminance of a surface that faces up, light space +z, by the image with factor 1. */
static double illuminance_of(const sky *k) {
  uint32_t n = k->image.width;
  double sum = 0;
  for (uint32_t y = 0; y < n; y++) {
    for (uint32_t x = 0; x < n; x++) {
      vector d = direction_of((square_point){(x + 0.5) / n, (y + 0.5) / n});
      if (d.z > 0) sum += pixel_luminance(&k->image, x, y) * d.z;
    }
  }
  return sum * 4 * PI / ((double)n * n);
}

bool read_sky(const world *w, const vlLightDef *def, light *l, vlError *error) {
  sky *k = &l->sky;
  bool lux = def->illuminance == def->illuminance;
  if (def->has_portal) return refuse(error, def->source, "a portal", NULL);
  if (!def->path && !def->image) {
    if (lux) l->factor *= def->illuminance / PI;
    return true;
  }
  vlImage *image = NULL;
  if (def->path && vl_image_read(w->context, def->path, &image, error) != VL_OK) return false;
  bool ok = make_image_map(image ? image : def->image, NULL, 1, &k->image);
  vl_image_destroy(image);
  if (!ok || k->image.width != k->image.height) return refuse(error, def->source, "a sky that is not square", NULL);
  k->world_from_light = load_matrix(def->world_from_light);
  k->light_from_world = invert(&k->world_from_light);
  white_light(l->space, &l->emitted);
  if (!make_tables(k)) return refuse_memory(error);
  if (lux) l->factor *= def->illuminance / illuminance_of(k);
  return true;
}

/* ---- radiance, samples, density ---------------------------------------------------------------------------------- */

static bool is_uniform(const light *l) {
  return !l->sky.image.values;
}

/* The pixel of a direction. */
static void pixel_at(const sky *k, vector direction, uint32_t *x, uint32_t *y) {
  square_point p = square_of(normalize(transform_vector(&k->light_from_world, direction)));
  uint32_t n = k->image.width;
  *x = (uint32_t)clamp(floor(p.x * n), 0, n - 1);
  *y = (uint32_t)clamp(floor(p.y * n), 0, n - 1);
}

spectrum sky_radiance(const light *l, vector direction, const wavelengths *lambda) {
  spectrum radiance = scaled(l->factor, color_at(&l->emitted, lambda));
  if (is_uniform(l)) return radiance;
  uint32_t x, y;
  double v[4];
  pixel_at(&l->sky, direction, &x, &y);
  pixel_of(&l->sky.image, (long)x, (long)y, VL_WRAP_CLAMP, VL_WRAP_CLAMP, v);
  for (int c = 0; c < 3; c++) v[c] = fmax(0, v[c]);
  return times(radiance, unbounded_of(l->space, v, lambda));
}

/* The pixel's share of all samples over its solid angle, 4 pi / n^2. */
static double density_of_pixel(const sky *k, uint32_t x, uint32_t y) {
  uint32_t n = k->image.width;
  const double *row = k->columns + (size_t)y * (n + 1);
  double share = (k->rows[y + 1] - k->rows[y]) * (row[x + 1] - row[x]);
  return share * n * n / (4 * PI);
}

double sky_density(const light *l, vector direction) {
  uint32_t x, y;
  if (is_uniform(l)) return 1 / (4 * PI);
  pixel_at(&l->sky, direction, &x, &y);
  return density_of_pixel(&l->sky, x, y);
}

/* The interval of a table that u falls into, by halving. *rest: where in it, 0 to 1. */
static uint32_t find_interval(const double *table, uint32_t count, double u, double *rest) {
  uint32_t low = 0, high = count;
  while (high - low > 1) {
    uint32_t middle = (low + high) / 2;
    if (table[middle] <= u)
      low = middle;
    else
      high = middle;
  }
  *rest = (u - table[low]) / (table[low + 1] - table[low]);
  return low;
}

vector sample_sky(const light *l, sampler *s, double *density) {
  if (is_uniform(l)) {
    *density = 1 / (4 * PI);
    return sample_sphere(s);
  }
  const sky *k = &l->sky;
  uint32_t n = k->image.width;
  square_point u = sample_unit_square(s), at;
  uint32_t y = find_interval(k->rows, n, u.y, &at.y);
  uint32_t x = find_interval(k->columns + (size_t)y * (n + 1), n, u.x, &at.x);
  *density = density_of_pixel(k, x, y);
  vector d = direction_of((square_point){(x + at.x) / n, (y + at.y) / n});
  return normalize(transform_vector(&k->world_from_light, d));
}
