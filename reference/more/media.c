/* more/media.c: what homogeneous media emit; media given on a grid, clouds (pbrt book 11.4). */
#include "more.h"

/* The integral of sigma_a L exp(-sigma_t x) over the distance. */
spectrum emission_along(const vlMediumDef *m, double distance, const wavelengths *lambda) {
  spectrum a = coefficient(m, &m->sigma_a, lambda), s = coefficient(m, &m->sigma_s, lambda);
  const color *emission = find_color(&m->emission, VL_PARAMETER_ILLUMINANT);
  spectrum result = scaled((double)m->emission_scale, times(a, color_at(emission, lambda)));
  for (int i = 0; i < CHANNELS; i++) {
    double sigma = a.c[i] + s.c[i];
    result.c[i] *= sigma > 0 ? -expm1(-sigma * distance) / sigma : 0;
  }
  return result;
}

/* A grid has values at the centres of the cells of a box; they are linear between them, and 0 outside. */
static bool cell_value(const vlMediumDef *m, const float *values, const long at[3], const wavelengths *lambda,
                       spectrum *value) {
  long nx = (long)m->nx, ny = (long)m->ny, nz = (long)m->nz, cell = (at[2] * ny + at[1]) * nx + at[0];
  if (at[0] < 0 || at[1] < 0 || at[2] < 0 || at[0] >= nx || at[1] >= ny || at[2] >= nz) return false;
  if (m->kind == VL_MEDIUM_GRID) *value = gray((double)values[cell]);
  double rgb[3];
  for (int c = 0; m->kind == VL_MEDIUM_RGB_GRID && c < 3; c++) rgb[c] = (double)values[3 * cell + c];
  if (m->kind == VL_MEDIUM_RGB_GRID) *value = texel_spectrum(m->space, rgb, VL_PARAMETER_UNBOUNDED, lambda);
  return true;
}

/* At a point of the box, whose corners are 0 and 1. */
static spectrum grid_value(const vlMediumDef *m, const float *values, vector p, const wavelengths *lambda) {
  if (!values) return gray(1);
  double x[3] = {p.x * m->nx - 0.5, p.y * m->ny - 0.5, p.z * m->nz - 0.5};
  spectrum sum = gray(0), value = gray(0);
  for (int corner = 0; corner < 8; corner++) {
    double weight = 1;
    long at[3];
    for (int i = 0; i < 3; i++) {
      int upper = corner >> i & 1;
      at[i] = (long)floor(x[i]) + upper;
      weight *= upper ? x[i] - floor(x[i]) : 1 - (x[i] - floor(x[i]));
    }
    if (cell_value(m, values, at, lambda, &value)) sum = plus(sum, scaled(weight, value));
  }
  return sum;
}

/* sigma_a, sigma_s and what is emitted at a point. */
static void local_medium(const vlMediumDef *m, vector p, const wavelengths *lambda, spectrum sigma[3]) {
  if (m->kind == VL_MEDIUM_RGB_GRID) {
    sigma[0] = scaled((double)m->scale, grid_value(m, m->rgb_a, p, lambda));
    sigma[1] = scaled((double)m->scale, grid_value(m, m->rgb_s, p, lambda));
    sigma[2] = gray(0);
    return;
  }
  spectrum density = grid_value(m, m->density, p, lambda);
  vector low = from_floats(m->low), size = subtract(from_floats(m->high), low);
  vector place = add(low, make_vector(p.x * size.x, p.y * size.y, p.z * size.z));
  if (m->kind == VL_MEDIUM_CLOUD)
    density = gray(cloud_density(place, (double)m->cloud_density, (double)m->wispiness, (double)m->frequency));
  sigma[0] = times(density, coefficient(m, &m->sigma_a, lambda));
  sigma[1] = times(density, coefficient(m, &m->sigma_s, lambda));
  spectrum emission = color_at(find_color(&m->emission, VL_PARAMETER_ILLUMINANT), lambda);
  sigma[2] = times(times(sigma[0], emission), grid_value(m, m->emission_scales, p, lambda));
  sigma[2] = scaled((double)m->emission_scale, sigma[2]);
}

static double most_of(const float *values, size_t count) {
  double most = values ? 0 : 1;
  for (size_t i = 0; values && i < count; i++) most = fmax(most, (double)values[i]);
  return most;
}

/* A bound of sigma_a + sigma_s. The spectrum of a colour is nowhere more than twice its largest component. */
static double majorant(const vlMediumDef *m, const wavelengths *lambda) {
  size_t cells = (size_t)m->nx * m->ny * m->nz;
  if (m->kind == VL_MEDIUM_RGB_GRID)
    return 2 * (double)m->scale * (most_of(m->rgb_a, 3 * cells) + most_of(m->rgb_s, 3 * cells));
  spectrum sigma_t = plus(coefficient(m, &m->sigma_a, lambda), coefficient(m, &m->sigma_s, lambda));
  return most_of(m->density, cells) * largest(sigma_t);
}

/* The ray in the box's own coordinates, and the part of it that is inside. */
static ray in_box(const vlMediumDef *m, ray r, double distance) {
  vector size = subtract(from_floats(m->high), from_floats(m->low));
  matrix medium_from_box = {{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}, from_floats(m->low)};
  matrix world_from_box = multiply(load_matrix(m->world_from_medium), medium_from_box);
  matrix box_from_world = invert(&world_from_box);
  ray q = {transform_point(&box_from_world, r.origin), transform_vector(&box_from_world, r.direction), 0, distance, 0};
  double from[3] = {q.origin.x, q.origin.y, q.origin.z}, way[3] = {q.direction.x, q.direction.y, q.direction.z};
  for (int i = 0; i < 3; i++) {
    q.t_min = fmax(q.t_min, fmin(-from[i] / way[i], (1 - from[i]) / way[i]));
    q.t_max = fmin(q.t_max, fmax(-from[i] / way[i], (1 - from[i]) / way[i]));
  }
  return q;
}

/* Delta tracking (Woodcock 1965): the medium is filled up to the majorant with particles that do nothing. At each
 * particle that a way meets, the share of those that let the light through is left. */
spectrum more_transmittance(const vlMediumDef *m, ray r, double distance, sampler *s, const wavelengths *lambda) {
  ray q = in_box(m, r, distance);
  double most = majorant(m, lambda);
  spectrum left = gray(1), sigma[3];
  for (double t = q.t_min; most > 0;) {
    t -= log1p(-next_number(s)) / most;
    if (t >= q.t_max) break;
    local_medium(m, add(q.origin, scale(t, q.direction)), lambda, sigma);
    left = times(left, plus(gray(1), scaled(-1 / most, plus(sigma[0], sigma[1]))));
  }
  return left;
}

/* A particle scatters with a probability, else the path goes on; both keep what absorption leaves. */
bool scatters_in_more(const vlMediumDef *m, ray r, double *distance, sampler *s, const wavelengths *lambda,
                      spectrum *throughput, spectrum *emitted) {
  ray q = in_box(m, r, *distance);
  double most = majorant(m, lambda);
  spectrum sigma[3];
  for (double t = q.t_min; most > 0;) {
    t -= log1p(-next_number(s)) / most;
    if (t >= q.t_max) break;
    local_medium(m, add(q.origin, scale(t, q.direction)), lambda, sigma);
    *emitted = plus(*emitted, scaled(1 / most, times(*throughput, sigma[2])));
    double chance = (sigma[1].c[0] + sigma[1].c[1] + sigma[1].c[2] + sigma[1].c[3]) / (CHANNELS * most);
    bool scatters = next_number(s) < chance;
    spectrum passes = plus(gray(1), scaled(-1 / most, plus(sigma[0], sigma[1])));
    spectrum share = scatters ? scaled(1 / (most * chance), sigma[1]) : scaled(1 / (1 - chance), passes);
    *throughput = times(*throughput, share);
    if (scatters) *distance = t;
    if (scatters || largest(*throughput) == 0) return scatters;
  }
  return false;
}
