/* more/principled.c: the principled material: metal, dielectric with diffuse light under it, thin sheets, a clear coat
 * (docs/principled.md, which has the formulas and their sources). Its microfacets are those of microfacet.h; light that
 * meets several of them, or is shared between layers, is found by how much each of them reflects in all. */
#include "more.h"

#include "microfacet.h"

/* ---- how much microfacets reflect in all directions together: E = F0 a + F90 b ----------------------------------- */

typedef struct albedo {
  double a, b;
} albedo;

enum { ALPHAS = 32, COSINES = 64, STEPS = 48 };

/* The integral of D G F / (4 cos cos) over all directions, F = F0 + (F90 - F0) (1 - cosine)^5. The sum is over normals
 * that are spread as D cos is: tan^2 = alpha^2 u / (1 - u). */
static albedo integrate(double alpha, double cosine) {
  bsdf mirrors = {.alpha_x = alpha, .alpha_y = alpha};
  vector wo = make_vector(sqrt(1 - square(cosine)), 0, cosine);
  albedo sum = {0, 0};
  for (int i = 0; i < STEPS * STEPS; i++) {
    double u = (i % STEPS + 0.5) / STEPS, phi = PI * (i / STEPS + 0.5) / STEPS, slope = alpha * sqrt(u / (1 - u));
    vector m = normalize(make_vector(slope * cos(phi), slope * sin(phi), 1)), wi = reflect(wo, m);
    double c = dot(wo, m), weight = pow(1 - c, 5);
    if (c <= 0 || wi.z <= 0) continue;
    double share = visible_from_both(&mirrors, wo, wi) * c / (cosine * m.z) / (STEPS * STEPS);
    sum.a += share * (1 - weight);
    sum.b += share * weight;
  }
  return sum;
}

/* From a table, in steps of the roots of alpha and of the cosine; it is made when it is first asked for. */
static albedo albedo_at(double alpha, double cosine) {
  static albedo table[ALPHAS][COSINES];
  for (int i = 0; table[0][0].a == 0 && i < ALPHAS * COSINES; i++) {
    int k = ALPHAS * COSINES - 1 - i, row = k / COSINES, column = k % COSINES; /* [0][0] comes last */
    double root_alpha = (double)row / (ALPHAS - 1), root_cosine = (double)column / (COSINES - 1);
    table[row][column] = integrate(fmax(square(root_alpha), 1e-4), fmax(square(root_cosine), 1e-4));
  }
  double y = sqrt(clamp(alpha, 0, 1)) * (ALPHAS - 1), x = sqrt(clamp(fabs(cosine), 0, 1)) * (COSINES - 1);
  int row = (int)fmin(y, ALPHAS - 2), column = (int)fmin(x, COSINES - 2);
  albedo sum = {0, 0};
  for (int k = 0; k < 4; k++) {
    int right = k & 1, down = k >> 1;
    double weight = (right ? x - column : column + 1 - x) * (down ? y - row : row + 1 - y);
    sum.a += weight * table[row + down][column + right].a;
    sum.b += weight * table[row + down][column + right].b;
  }
  return sum;
}

/* The mean over all directions, which count by their cosine: the integral of E(c) 2 c dc. */
static albedo mean_albedo(double alpha) {
  albedo sum = {0, 0};
  for (int i = 0; i < COSINES; i++) {
    double c = (i + 0.5) / COSINES;
    albedo e = albedo_at(alpha, c);
    sum.a += e.a * 2 * c / COSINES;
    sum.b += e.b * 2 * c / COSINES;
  }
  return sum;
}

static double reflected(albedo e, double f0, double f90) {
  return f0 * e.a + f90 * e.b;
}

/* What gets through a layer on the way in and on the way out, and comes back from a diffuse base any number of times.
 */
static double through_both_ways(double out, double in, double mean) {
  return (1 - out) * (1 - in) / (1 - mean);
}

/* ---- the material ------------------------------------------------------------------------------------------------ */

static double share_at(const world *w, vlFloatInput input, const shade_record *at) {
  return clamp(number_at(w, input, at), 0, 1);
}

void make_principled(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda,
                     bsdf *b) {
  const vlPrincipledDef *d = &m->principled;
  more_bsdf *p = &b->more;
  p->kind = MORE_PRINCIPLED;
  b->reflectance = reflectance_at(w, m, at, lambda);
  b->alpha_y = fmax(square(share_at(w, d->roughness, at)), 1e-3);
  b->alpha_x = b->alpha_y + (1 - b->alpha_y) * square(share_at(w, d->anisotropy, at));
  p->metallic = share_at(w, d->metallic, at);
  p->clear = share_at(w, d->transmission, at);
  p->passed_on = share_at(w, d->diffuse_transmission, at);
  p->transmittance = spectrum_at(w, &d->diffuse_transmission_color, VL_PARAMETER_ALBEDO, at, lambda);
  double eta = color_at(find_color(&m->eta.value, VL_PARAMETER_UNBOUNDED), lambda).c[0];
  p->f90 = share_at(w, d->specular, at);
  p->f0 = spectrum_at(w, &d->specular_color, VL_PARAMETER_UNBOUNDED, at, lambda);
  for (int i = 0; i < CHANNELS; i++)
    p->f0.c[i] = p->f90 * clamp(p->f0.c[i] * (eta > 0 ? square((eta - 1) / (eta + 1)) : 1), 0, 1);
  p->coat = share_at(w, d->clearcoat, at);
  p->coat_alpha_x = p->coat_alpha_y = fmax(square(share_at(w, d->clearcoat_roughness, at)), 1e-3);
}

/* Each direction may come from one of five lobes: the microfacets, the diffuse light above, the coat, the sheet, the
 * diffuse light below. Each gets a fixed share of the samples: simple, and wasteful where it is not there. */
enum { MIRRORS, MATT, COAT, SHEET, MATT_BELOW, LOBES };
static const double share[LOBES] = {0.4, 0.3, 0.1, 0.1, 0.1};

/* D G / (4 cos_o) and the density of mirrored directions, for a half vector m. */
static double mirrored(const bsdf *b, vector wo, vector wi, vector m, double *density) {
  *density = visible_density(b, wo, m) / (4 * dot(wo, m));
  return mirror_distribution(b, m) * visible_from_both(b, wo, wi) / (4 * wo.z);
}

/* What is above looks the same from below; a sheet sends light on as its mirror image. */
spectrum principled_value(const bsdf *b, vector wo, vector wi, double *density) {
  const more_bsdf *p = &b->more;
  bool above = wo.z * wi.z > 0;
  vector o = make_vector(wo.x, wo.y, fabs(wo.z)), i = make_vector(wi.x, wi.y, fabs(wi.z));
  if (o.z == 0 || i.z == 0) return gray(0);
  vector m = normalize(add(o, i));
  double base_density, coat_density, cosine = i.z / PI, weight = pow(1 - dot(o, m), 5);
  bsdf coat = coat_of(b);
  double mirror = mirrored(b, o, i, m, &base_density), glossy = mirrored(&coat, o, i, m, &coat_density);
  *density = share[SHEET] * base_density + share[MATT_BELOW] * cosine;
  if (above) *density = share[MIRRORS] * base_density + share[MATT] * cosine + share[COAT] * coat_density;

  double alpha = 0.6 * fmax(b->alpha_x, b->alpha_y) + 0.4 * fmin(b->alpha_x, b->alpha_y);
  albedo eo = albedo_at(alpha, o.z), ei = albedo_at(alpha, i.z), mean = mean_albedo(alpha);
  double coat_o = p->coat * reflected(albedo_at(coat.alpha_x, o.z), 0.04, 1);
  double coat_i = p->coat * reflected(albedo_at(coat.alpha_x, i.z), 0.04, 1);
  double over_matt = through_both_ways(coat_o, coat_i, p->coat * reflected(mean_albedo(coat.alpha_x), 0.04, 1));
  double over_mirrors = 1 - fmax(coat_o, coat_i), over_sheet = 1 - (wo.z > 0 ? coat_o : coat_i);
  double dielectric = 1 - p->metallic, one = reflected(mean, 1, 1);
  double again = cosine * through_both_ways(reflected(eo, 1, 1), reflected(ei, 1, 1), one);
  spectrum value;
  for (int k = 0; k < CHANNELS; k++) {
    double base = b->reflectance.c[k], f0 = p->f0.c[k], f90 = p->f90;
    double matt = dielectric * (1 - p->clear) * cosine *
                  through_both_ways(reflected(eo, f0, f90), reflected(ei, f0, f90), reflected(mean, f0, f90));
    double metal = base + (1 - base) / 21, sheet = f0 + (f90 - f0) / 21; /* mean Fresnel terms */
    double metal_again = again * p->metallic * square(metal) * one / (1 - metal * (1 - one));
    double sheet_again = again * dielectric * p->clear;
    double glass = f0 + (f90 - f0) * weight, foil = base + (1 - base) * weight;
    double up = over_mirrors * mirror * (dielectric * glass + p->metallic * foil) +
                p->coat * glossy * (0.04 + 0.96 * weight) +
                over_matt * (matt * (1 - p->passed_on) * base + metal_again + sheet_again * sheet);
    double down = dielectric * p->clear * base * (1 - glass) * mirror + matt * p->passed_on * p->transmittance.c[k] +
                  sheet_again * (1 - sheet) * base;
    value.c[k] = above ? up : over_sheet * down;
  }
  return value;
}

bool sample_principled(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  double u = next_number(s);
  vector o = make_vector(wo.x, wo.y, fabs(wo.z)), wi = sample_cosine_hemisphere(s);
  bsdf coat = coat_of(b);
  int k = 0;
  while (k + 1 < LOBES && u >= share[k]) u -= share[k++];
  if (k == MIRRORS || k == SHEET) wi = reflect(o, sample_visible_normal(b, o, s));
  if (k == COAT) wi = reflect(o, sample_visible_normal(&coat, o, s));
  bool below = k == SHEET || k == MATT_BELOW;
  result->wi = make_vector(wi.x, wi.y, below == (wo.z > 0) ? -wi.z : wi.z);
  return wi.z > 0;
}
