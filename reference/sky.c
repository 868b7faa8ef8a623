/* sky.c: light from infinitely far away: uniform, or an image of all directions (pbrt book 3.8.3, 12.5). */
#include "more/more.h"
#include "more/octahedral.h"

static void sky_pixel(const light *l, uint32_t index, double rgb[4]) {
  pixel_of(&l->map, index % l->map.width, index / l->map.width, VL_WRAP_CLAMP, VL_WRAP_CLAMP, rgb);
  for (int c = 0; c < 3; c++) rgb[c] = fmax(0, rgb[c]);
}

/* sums[i] is the luminance of the first i pixels, as a share of all: of the numbers 0 to 1 pixel i has those from
 * sums[i] to sums[i + 1]. A tenth is spread evenly over all pixels, so that none that shines is left out. */
void make_sky(light *l) {
  uint32_t count = l->map.width * l->map.width;
  l->sums = resize(NULL, (size_t)count + 1, sizeof *l->sums);
  l->sums[0] = 0;
  for (uint32_t i = 0; i < count; i++) {
    double rgb[4];
    sky_pixel(l, i, rgb);
    l->sums[i + 1] = l->sums[i] + 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  }
  double total = l->sums[count], even = total > 0 ? 0.1 : 1;
  for (uint32_t i = 1; i <= count; i++)
    l->sums[i] = even * i / count + (total > 0 ? (1 - even) * l->sums[i] / total : 0);
}

/* The pixel of a direction. */
static uint32_t pixel_at(const light *l, vector direction) {
  square_point p = square_of(normalize(transform_vector(&l->light_from_world, direction)));
  uint32_t n = l->map.width;
  return (uint32_t)clamp(floor(p.y * n), 0, n - 1) * n + (uint32_t)clamp(floor(p.x * n), 0, n - 1);
}

spectrum sky_radiance(const light *l, vector from, vector direction, const wavelengths *lambda) {
  double rgb[4];
  if (!is_through_portal(l, from, direction)) return gray(0);
  if (!l->sums) return light_color(l, lambda);
  sky_pixel(l, pixel_at(l, direction), rgb);
  return times(light_color(l, lambda), texel_spectrum(l->def->space, rgb, VL_PARAMETER_UNBOUNDED, lambda));
}

/* The pixel's share of all samples, over its solid angle: all pixels have the same, 4 pi / n^2. */
double sky_density(const world *w, const light *l, vector direction) {
  uint32_t i = l->sums ? pixel_at(l, direction) : 0;
  return (l->sums ? (l->sums[i + 1] - l->sums[i]) * square(l->map.width) : 1) / (4 * PI) / w->light_count;
}

/* The pixel that has the number u: the table is halved until one is left. In it, any point. */
vector sample_sky(const light *l, sampler *s) {
  if (!l->sums) return direction_of(sample_unit_square(s));
  uint32_t n = l->map.width, low = 0, high = n * n;
  double u = next_number(s);
  while (high - low > 1) {
    uint32_t middle = (low + high) / 2;
    if (l->sums[middle] <= u)
      low = middle;
    else
      high = middle;
  }
  square_point in_pixel = sample_unit_square(s);
  vector d = direction_of((square_point){(low % n + in_pixel.x) / n, (low / n + in_pixel.y) / n});
  return normalize(transform_vector(&l->world_from_light, d));
}
