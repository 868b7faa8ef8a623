/* sky.c: light from infinitely far away: uniform, or an image of all directions (pbrt book 3.8.3, 12.5). */
#include "light.h"
#include "refuse.h"

/* The equal-area octahedral map (Clarberg 2008): the upper hemisphere fills the diamond |u| + |v| <= 1 in the middle of
 * the square -1 to 1, the lower one the four corners; equal solid angles fill equal areas. */
square_point square_of(vector d) {
  double r = sqrt(fmax(0, 1 - fabs(d.z)));
  double v = r * atan2(fabs(d.y), fabs(d.x)) * 2 / PI;
  double u = r - v;
  if (d.z < 0) return (square_point){(copysign(1 - v, d.x) + 1) / 2, (copysign(1 - u, d.y) + 1) / 2};
  return (square_point){(copysign(u, d.x) + 1) / 2, (copysign(v, d.y) + 1) / 2};
}

vector direction_of(square_point p) {
  double u = 2 * p.x - 1, v = 2 * p.y - 1;
  double side = 1 - (fabs(u) + fabs(v)); /* positive in the diamond */
  double r = 1 - fabs(side);
  double phi = r == 0 ? PI / 4 : ((fabs(v) - fabs(u)) / r + 1) * PI / 4;
  double z = copysign(1 - r * r, side);
  double around = r * sqrt(fmax(0, 2 - r * r));
  return make_vector(copysign(cos(phi), u) * around, copysign(sin(phi), v) * around, z);
}

static void sky_pixel(const sky *k, uint32_t index, double rgb[4]) {
  pixel_of(&k->map, index % k->map.width, index / k->map.width, VL_WRAP_CLAMP, VL_WRAP_CLAMP, rgb);
  for (int c = 0; c < 3; c++) rgb[c] = fmax(0, rgb[c]);
}

static double pixel_luminance(const sky *k, uint32_t index) {
  double rgb[4];
  sky_pixel(k, index, rgb);
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/* The table of sums: a number drawn from 0 to 1 lies between two of them, which is the pixel. A tenth of the samples is
 * spread evenly, so that no direction that shines is left out. Returns the illuminance of a surface that faces up,
 * light space +z. */
static double make_table(sky *k) {
  uint32_t n = k->map.width, count = n * n;
  double total = 0, upwards = 0;
  for (uint32_t i = 0; i < count; i++) {
    vector d = direction_of((square_point){(i % n + 0.5) / n, (i / n + 0.5) / n});
    total += pixel_luminance(k, i);
    upwards += pixel_luminance(k, i) * fmax(0, d.z);
  }
  double even = total > 0 ? 0.1 * total / count : 1;
  k->sums = resize(NULL, (size_t)count + 1, sizeof *k->sums);
  k->sums[0] = 0;
  for (uint32_t i = 0; i < count; i++) k->sums[i + 1] = k->sums[i] + pixel_luminance(k, i) + even;
  for (uint32_t i = 0; i < count; i++) k->sums[i] /= k->sums[count];
  k->sums[count] = 1;
  return upwards * 4 * PI / count;
}

bool read_sky(const world *w, light *l, vlError *error) {
  const vlLightDef *def = l->def;
  double illuminance = PI;
  vlImage *image = NULL;
  if (def->path && vl_image_read(w->context, def->path, &image, error) != VL_OK) return false;
  if (image || def->image) {
    l->sky.map = make_image_map(image ? image : def->image);
    if (l->sky.map.width != l->sky.map.height) return refuse(error, def->source, "a sky that is not square");
    l->sky.world_from_light = load_matrix(def->world_from_light);
    l->sky.light_from_world = invert(&l->sky.world_from_light);
    illuminance = make_table(&l->sky);
  }
  if (!isnan(def->illuminance)) l->factor *= def->illuminance / illuminance;
  return true;
}

/* The pixel of a direction. */
static uint32_t pixel_at(const sky *k, vector direction) {
  square_point p = square_of(normalize(transform_vector(&k->light_from_world, direction)));
  uint32_t n = k->map.width;
  return (uint32_t)clamp(floor(p.y * n), 0, n - 1) * n + (uint32_t)clamp(floor(p.x * n), 0, n - 1);
}

spectrum sky_radiance(const world *w, const light *l, vector direction, const wavelengths *lambda) {
  spectrum radiance = light_color(w, l, lambda);
  if (!l->sky.sums) return radiance;
  double rgb[4];
  sky_pixel(&l->sky, pixel_at(&l->sky, direction), rgb);
  return times(radiance, texel_spectrum(l->def->space, rgb, VL_PARAMETER_UNBOUNDED, lambda));
}

/* The pixel's share of all samples over its solid angle, 4 pi / n^2. */
double sky_density(const light *l, vector direction) {
  const sky *k = &l->sky;
  if (!k->sums) return 1 / (4 * PI);
  uint32_t i = pixel_at(k, direction);
  return (k->sums[i + 1] - k->sums[i]) * square(k->map.width) / (4 * PI);
}

/* Halves the table until one pixel is left. */
vector sample_sky(const light *l, sampler *s) {
  const sky *k = &l->sky;
  if (!k->sums) return sample_sphere(s);
  uint32_t n = k->map.width, low = 0, high = n * n;
  double u = next_number(s);
  while (high - low > 1) {
    uint32_t middle = (low + high) / 2;
    if (k->sums[middle] <= u)
      low = middle;
    else
      high = middle;
  }
  square_point in_pixel = sample_unit_square(s);
  vector d = direction_of((square_point){(low % n + in_pixel.x) / n, (low / n + in_pixel.y) / n});
  return normalize(transform_vector(&k->world_from_light, d));
}
