/* statistics.h: statistical tests of sampling routines: random numbers with fixed seeds,
 * chi-square tests with the regularised incomplete gamma function, histograms over the unit
 * square and over the sphere against a numerically integrated pdf.
 *
 *   statSphere hist = stat_sphere_new(32, 64);
 *   for (each try) sample(...) ? stat_sphere_add(hist, x, y, z) : stat_sphere_reject(hist);
 *   statResult r = stat_sphere_test(hist, my_pdf, &my_data, 0.0);   // also frees hist
 *   assert_true(stat_accept(r, tests));   // tests: number of such tests in the program
 *
 * The pdf is per solid angle. A sampler may reject when its pdf integrates to the accepted
 * share: rejected tries are a cell of their own. Everything is static inline. */
#ifndef TEST_STATISTICS_H
#define TEST_STATISTICS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- random numbers: splitmix64 (Steele et al. 2014) ------------------------------------- */

typedef struct statRng {
  uint64_t state;
} statRng;
static inline uint64_t stat_bits(statRng *rng) {
  uint64_t z = (rng->state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
/* The state advances by a constant, so seeds are hashed: otherwise adjacent seeds would give
 * the same stream, shifted by one. */
static inline statRng stat_rng(uint64_t seed) {
  statRng hash = {seed ^ 0x632be59bd9b4e019u};
  stat_bits(&hash);
  return (statRng){stat_bits(&hash)};
}
/* 24 bits, [0, 1). */
static inline float stat_float(statRng *rng) {
  return (float)(stat_bits(rng) >> 40) * 0x1p-24f;
}
/* 53 bits, [0, 1). */
static inline double stat_double(statRng *rng) {
  return (double)(stat_bits(rng) >> 11) * 0x1p-53;
}
/* Uniform on the sphere. */
static inline void stat_direction(statRng *rng, double d[3]) {
  double z = 1.0 - 2.0 * stat_double(rng), phi = 6.283185307179586 * stat_double(rng),
         r = sqrt(fmax(0.0, 1.0 - z * z));
  d[0] = r * cos(phi);
  d[1] = r * sin(phi);
  d[2] = z;
}

/* ---- the chi-square distribution --------------------------------------------------------- */

/* Q(a, x) = Gamma(a, x) / Gamma(a): series below x = a + 1, Lentz's continued fraction above
 * (DLMF 8.7.1, 8.9.2). */
static inline double stat_gamma_q(double a, double x) {
  if (x <= 0.0)
    return 1.0;
  double log_front = a * log(x) - x - lgamma(a);
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int k = 1; k < 10000 && term > sum * 1e-16; k++)
      sum += term *= x / (a + k);
    double p = exp(log_front) * sum;
    return p > 1.0 ? 0.0 : 1.0 - p;
  }
  double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
  for (int k = 1; k < 10000; k++) {
    double an = -k * (k - a);
    b += 2.0;
    d = an * d + b;
    d = 1.0 / (fabs(d) < 1e-300 ? 1e-300 : d);
    c = b + an / c;
    if (fabs(c) < 1e-300)
      c = 1e-300;
    double delta = c * d;
    h *= delta;
    if (fabs(delta - 1.0) < 1e-15)
      break;
  }
  return exp(log_front) * h;
}
/* Probability that chi-square with this many degrees of freedom is at least as large. */
static inline double stat_chi2_q(double statistic, double freedom) {
  return freedom <= 0.0 ? 1.0 : stat_gamma_q(0.5 * freedom, 0.5 * statistic);
}

typedef struct statResult {
  double p; /* probability of a deviation at least as large if observed and expected agree */
  double statistic; /* chi-square */
  double freedom;   /* degrees of freedom after pooling */
  double integral;  /* of the pdf over the domain (histogram tests); otherwise 1 */
} statResult;

/* The probability that any of `tests` independent tests rejects a correct sampler is 1 %
 * (Sidak). */
static inline bool stat_accept(statResult r, unsigned tests) {
  double level = 1.0 - pow(0.99, 1.0 / (tests ? tests : 1));
  bool ok = r.p > level;
  if (!ok)
    fprintf(stderr,
            "chi2: p = %g (needs > %g), statistic %g, %g degrees of freedom, pdf integrates to "
            "%g\n",
            r.p, level, r.statistic, r.freedom, r.integral);
  return ok;
}

typedef struct statCell {
  double observed, expected;
} statCell;
static inline int stat_cell_order(const void *a, const void *b) {
  double x = ((const statCell *)a)->expected, y = ((const statCell *)b)->expected;
  return x < y ? -1 : x > y;
}
/* Chi-square test. Cells are sorted (in place); those that expect fewer than 5 are pooled. A
 * rest that expects fewer than 5 is left out, unless its count is far too large: then p = 0.
 * `constraints` is subtracted from the number of cells: 1 when both columns have the same sum
 * by construction. */
static inline statResult stat_chi2(statCell *cells, size_t count, unsigned constraints) {
  statResult r = {.p = 1.0, .integral = 1.0};
  qsort(cells, count, sizeof *cells, stat_cell_order);
  statCell pool = {0, 0};
  size_t used = 0;
  bool impossible = false;
  double mean = 0; /* of the cells with a positive expectation */
  size_t some = 0;
  for (size_t i = 0; i < count; i++)
    if (cells[i].expected > 1e-6) {
      mean += cells[i].expected;
      some++;
    }
  mean = some ? mean / (double)some : 0;
  for (size_t i = 0; i < count; i++) {
    if (!(cells[i].expected >= 0.0) || cells[i].expected > 1e300)
      return (statResult){.p = 0.0, .integral = NAN};
    pool.observed += cells[i].observed;
    pool.expected += cells[i].expected;
    /* samples where the pdf is zero; a few are tolerated, since the integration may miss a thin
     * region */
    bool empty = cells[i].expected <= 1e-6 && cells[i].observed > 3.0 + 0.02 * mean;
    impossible = impossible || empty;
    if (pool.expected >= 5.0) {
      double d = pool.observed - pool.expected;
      r.statistic += d * d / pool.expected;
      used++;
      pool = (statCell){0, 0};
    }
  }
  if (pool.observed > pool.expected + 6.0 * sqrt(pool.expected) + 6.0)
    impossible = true;
  r.freedom = (double)used - constraints;
  r.p = impossible ? 0.0 : stat_chi2_q(r.statistic, r.freedom);
  return r;
}
/* Tests counts that should all be equal. */
static inline statResult stat_chi2_uniform(const uint32_t *counts, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++)
    sum += counts[i];
  statCell *cells = malloc(count * sizeof *cells);
  for (size_t i = 0; i < count; i++)
    cells[i] = (statCell){counts[i], sum / (double)count};
  statResult r = stat_chi2(cells, count, 1);
  free(cells);
  return r;
}
/* Pearson's correlation of two columns. */
static inline double stat_correlation(const float *a, const float *b, size_t n) {
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (size_t i = 0; i < n; i++) {
    sa += a[i];
    sb += b[i];
  }
  sa /= (double)n;
  sb /= (double)n;
  for (size_t i = 0; i < n; i++) {
    double x = a[i] - sa, y = b[i] - sb;
    saa += x * x;
    sbb += y * y;
    sab += x * y;
  }
  return saa > 0 && sbb > 0 ? sab / sqrt(saa * sbb) : 0.0;
}

/* ---- densities over a rectangle ---------------------------------------------------------- */

typedef double statDensity(void *user, double x, double y);

static inline double stat_gauss_cell(statDensity *f, void *user, double x0, double x1,
                                     double y0, double y1) {
  static const double node[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                 0.8611363115940526};
  static const double weight[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                   0.3478548451374538};
  double cx = 0.5 * (x0 + x1), cy = 0.5 * (y0 + y1), hx = 0.5 * (x1 - x0), hy = 0.5 * (y1 - y0),
         sum = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      sum += weight[i] * weight[j] * f(user, cx + hx * node[i], cy + hy * node[j]);
  return sum * hx * hy;
}
/* Integral over the rectangle; subdivided into four while that changes it by more than
 * `tolerance`. */
static inline double stat_integrate(statDensity *f, void *user, double x0, double x1, double y0,
                                    double y1, double whole, double tolerance, int depth) {
  double mx = 0.5 * (x0 + x1), my = 0.5 * (y0 + y1);
  double a = stat_gauss_cell(f, user, x0, mx, y0, my),
         b = stat_gauss_cell(f, user, mx, x1, y0, my);
  double c = stat_gauss_cell(f, user, x0, mx, my, y1),
         d = stat_gauss_cell(f, user, mx, x1, my, y1);
  if (depth <= 0 || fabs(a + b + c + d - whole) <= tolerance)
    return a + b + c + d;
  return stat_integrate(f, user, x0, mx, y0, my, a, 0.5 * tolerance, depth - 1) +
         stat_integrate(f, user, mx, x1, y0, my, b, 0.5 * tolerance, depth - 1) +
         stat_integrate(f, user, x0, mx, my, y1, c, 0.5 * tolerance, depth - 1) +
         stat_integrate(f, user, mx, x1, my, y1, d, 0.5 * tolerance, depth - 1);
}

/* A histogram over [x0, x1] x [y0, y1]. Points outside count as rejected tries. */
typedef struct statGrid {
  uint32_t nx, ny;
  double x0, x1, y0, y1;
  double tries, rejected;
  double counts[]; /* nx * ny, x fastest */
} statGrid;
static inline statGrid *stat_grid_new(uint32_t nx, uint32_t ny, double x0, double x1, double y0,
                                      double y1) {
  statGrid *g = calloc(1, sizeof *g + sizeof(double) * nx * ny);
  g->nx = nx;
  g->ny = ny;
  g->x0 = x0;
  g->x1 = x1;
  g->y0 = y0;
  g->y1 = y1;
  return g;
}
static inline void stat_grid_reject(statGrid *g) {
  g->tries++;
  g->rejected++;
}
static inline void stat_grid_add(statGrid *g, double x, double y) {
  if (!(x >= g->x0 && x <= g->x1 && y >= g->y0 && y <= g->y1)) {
    stat_grid_reject(g);
    return;
  }
  uint32_t i = (uint32_t)((x - g->x0) / (g->x1 - g->x0) * g->nx),
           j = (uint32_t)((y - g->y0) / (g->y1 - g->y0) * g->ny);
  i = i < g->nx ? i : g->nx - 1;
  j = j < g->ny ? j : g->ny - 1;
  g->tries++;
  g->counts[(size_t)j * g->nx + i]++;
}
/* Tests and frees the grid. tolerance: of the integral over one cell; 0: 1e-7 (deep subdivision
 * for sharp densities). */
static inline statResult stat_grid_test(statGrid *g, statDensity *density, void *user,
                                        double tolerance) {
  size_t n = (size_t)g->nx * g->ny;
  statCell *cells = malloc((n + 1) * sizeof *cells);
  double sx = (g->x1 - g->x0) / g->nx, sy = (g->y1 - g->y0) / g->ny, integral = 0;
  tolerance = tolerance > 0 ? tolerance : 1e-7;
  for (size_t k = 0; k < n; k++) {
    double x = g->x0 + sx * (double)(k % g->nx), y = g->y0 + sy * (double)(k / g->nx);
    double whole = stat_gauss_cell(density, user, x, x + sx, y, y + sy);
    double mass = stat_integrate(density, user, x, x + sx, y, y + sy, whole, tolerance, 9);
    integral += mass;
    cells[k] = (statCell){g->counts[k], mass * g->tries};
  }
  /* expected number of rejected tries; not negative except for rounding */
  double rest = (1.0 - integral) * g->tries;
  cells[n] = (statCell){g->rejected, rest > 0 || !(rest > -1e-3 * g->tries) ? rest : 0.0};
  statResult r = stat_chi2(cells, n + 1, 1);
  r.integral = integral;
  free(cells);
  free(g);
  return r;
}

/* ---- densities over the sphere ----------------------------------------------------------- */

/* pdf per solid angle at unit direction d. */
typedef double statSpherePdf(void *user, const double d[3]);

typedef struct statSphere {
  statGrid *grid; /* x: phi in [0, 2 pi], y: theta in [0, pi], theta from +z */
} statSphere;
static inline statSphere stat_sphere_new(uint32_t n_theta, uint32_t n_phi) {
  return (statSphere){
      stat_grid_new(n_phi, n_theta, 0.0, 6.283185307179586477, 0.0, 3.141592653589793238)};
}
static inline void stat_sphere_reject(statSphere s) {
  stat_grid_reject(s.grid);
}
static inline void stat_sphere_add(statSphere s, double x, double y, double z) {
  double phi = atan2(y, x), theta = atan2(sqrt(x * x + y * y), z);
  stat_grid_add(s.grid, phi < 0 ? fmin(phi + 6.283185307179586477, 6.283185307179586) : phi,
                fmin(theta, 3.14159265358979));
}
typedef struct statSphereUser {
  statSpherePdf *pdf;
  void *user;
} statSphereUser;
static inline double stat_sphere_density(void *user, double phi, double theta) {
  const statSphereUser *u = user;
  double s = sin(theta), d[3] = {s * cos(phi), s * sin(phi), cos(theta)};
  return u->pdf(u->user, d) * s;
}
/* Tests and frees the histogram. tolerance as above. result.integral is the pdf's integral over
 * the sphere. */
static inline statResult stat_sphere_test(statSphere s, statSpherePdf *pdf, void *user,
                                          double tolerance) {
  statSphereUser u = {pdf, user};
  return stat_grid_test(s.grid, stat_sphere_density, &u, tolerance);
}

#endif
