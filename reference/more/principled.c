/* more/principled.c: the principled material: metal, dielectric with diffuse light under it, thin sheets, sheen, a
 * clear coat (docs/principled.md, which has the formulas and their sources). Its microfacets are those of microfacet.h;
 * light that meets several of them, or is shared between layers, is found by how much each of them reflects in all. */
#include "more.h"

#include "microfacet.h"

/* Sheen is made of fibres (Estevez and Kulla 2017): their fit of the logarithm of Lambda, from alpha 0 to 1. */
static double sheen_curve(double x, double alpha) {
  double s = square(1 - alpha), t = 1 - s;
  double a = 25.3245 * s + 21.5473 * t, b = 3.32435 * s + 3.82987 * t, c = 0.16801 * s + 0.19823 * t;
  double d = -1.27393 * s - 1.97760 * t, e = -4.85967 * s - 4.32054 * t;
  return a / (1 + b * pow(x, c)) + d * x + e;
}

static double sheen_lambda(double cosine, double alpha) {
  if (cosine < 0.5) return exp(sheen_curve(cosine, alpha));
  return exp(2 * sheen_curve(0.5, alpha) - sheen_curve(1 - cosine, alpha));
}

static double sheen_value(vector o, vector i, double alpha) {
  double sine2 = 1 - square(normalize(add(o, i)).z);
  double distribution = (2 + 1 / alpha) * pow(fmax(0, sine2), 0.5 / alpha) / (2 * PI);
  return distribution / (4 * o.z * (1 + sheen_lambda(o.z, alpha) + sheen_lambda(i.z, alpha)));
}

/* How much is reflected in all directions together. By microfacets: F0 a + F90 b. By white sheen: a, which is b, but at
 * most 1. */
typedef struct albedo {
  double a, b;
} albedo;
typedef enum albedo_kind { OF_MICROFACETS, OF_SHEEN } albedo_kind;

enum { ALPHAS = 32, COSINES = 64, STEPS = 48, MEANS = 32 };

/* The integral of D G F / (4 cos cos) over all directions, F = F0 + (F90 - F0) (1 - cosine)^5. The sum is over normals
 * that are spread as D cos is: tan^2 = alpha^2 u / (1 - u). */
static albedo integrate_microfacets(double alpha, vector wo) {
  bsdf mirrors = {.alpha_x = alpha, .alpha_y = alpha};
  albedo sum = {0, 0};
  for (int i = 0; i < STEPS * STEPS; i++) {
    double u = (i % STEPS + 0.5) / STEPS, phi = PI * (i / STEPS + 0.5) / STEPS, slope = alpha * sqrt(u / (1 - u));
    vector m = normalize(make_vector(slope * cos(phi), slope * sin(phi), 1)), wi = reflect(wo, m);
    double c = dot(wo, m), weight = pow(1 - c, 5);
    if (c <= 0 || wi.z <= 0) continue;
    double share = visible_from_both(&mirrors, wo, wi) * c / (wo.z * m.z) / (STEPS * STEPS);
    sum.a += share * (1 - weight);
    sum.b += share * weight;
  }
  return sum;
}

/* Directions are dense near the horizon, where sheen is bright: z = x^2. */
static albedo integrate_sheen(double alpha, vector wo) {
  double sum = 0;
  for (int i = 0; i < STEPS * STEPS; i++) {
    double x = (i % STEPS + 0.5) / STEPS, phi = PI * (i / STEPS + 0.5) / STEPS, sine = sqrt(1 - pow(x, 4));
    sum += sheen_value(wo, make_vector(sine * cos(phi), sine * sin(phi), x * x), alpha) * 4 * PI * x / (STEPS * STEPS);
  }
  return (albedo){fmin(sum, 1), sum};
}

/* From a table, in steps of the roots of alpha and of the cosine; it is made when it is first asked for. */
static albedo albedo_at(albedo_kind kind, double alpha, double cosine) {
  static albedo tables[2][ALPHAS][COSINES];
  albedo(*table)[COSINES] = tables[kind];
  for (int k = ALPHAS * COSINES - 1; table[0][0].b == 0 && k >= 0; k--) { /* [0][0] comes last */
    int row = k / COSINES, column = k % COSINES;
    double c = fmax(square((double)column / (COSINES - 1)), 1e-4), rough = square((double)row / (ALPHAS - 1));
    vector wo = make_vector(sqrt(1 - square(c)), 0, c);
    if (kind == OF_MICROFACETS) table[row][column] = integrate_microfacets(fmax(rough, 1e-4), wo);
    if (kind == OF_SHEEN) table[row][column] = integrate_sheen(fmax(rough, 5e-3), wo);
  }
  double y = sqrt(clamp(alpha, 0, 1)) * (ALPHAS - 1), x = sqrt(clamp(cosine, 0, 1)) * (COSINES - 1);
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

/* Of one layer: seen along both directions, and the mean over all directions, which count by their cosine: the integral
 * of E 2 cos d cos, which is that of E d cos^2. */
typedef struct layer {
  albedo out, in, mean;
} layer;

static layer make_layer(albedo_kind kind, double alpha, double out, double in) {
  layer l = {albedo_at(kind, alpha, out), albedo_at(kind, alpha, in), {0, 0}};
  for (int i = 0; i < MEANS; i++) {
    albedo e = albedo_at(kind, alpha, sqrt((i + 0.5) / MEANS));
    l.mean.a += e.a / MEANS;
    l.mean.b += e.b / MEANS;
  }
  return l;
}

static double reflected(albedo e, double f0, double f90) {
  return f0 * e.a + f90 * e.b;
}

/* What gets through a layer on the way in and out, and comes back from a diffuse base any number of times. */
static double through_both_ways(const layer *l, double f0, double f90) {
  return (1 - reflected(l->out, f0, f90)) * (1 - reflected(l->in, f0, f90)) / (1 - reflected(l->mean, f0, f90));
}

/* What light has left at a wavelength of which surfaces leave these shares of red, green and blue. */
static double left_at(const double rgb[3], double nm) {
  static float shares[3 * VL_SPECTRUM_VALUES];
  if (shares[2] == 0) vl_channels_tabulate(shares);
  return rgb[0] * table_at(shares, 3, nm) + rgb[1] * table_at(shares + 1, 3, nm) + rgb[2] * table_at(shares + 2, 3, nm);
}

/* White light leaves all surfaces that the path has crossed with the product of their colours, per channel of RGB: the
 * tint of this surface at a wavelength is the ratio of what is left after and before it (docs/media.md). Where light
 * also goes through diffusely, it is the colour's spectrum. */
static void make_tint(const world *w, const vlMaterialDef *m, const shade_record *at, const wavelengths *lambda,
                      bsdf *b) {
  wavelengths rgb = {.rgb = true};
  bool diffuse = m->principled.diffuse_transmission.texture.index || m->principled.diffuse_transmission.value > 0;
  double after[3];
  b->more.tint = b->reflectance;
  b->more.tint_rgb = diffuse ? gray(1) : reflectance_at(w, m, at, &rgb);
  for (int k = 0; k < 3; k++) after[k] = lambda->crossed[k] * b->more.tint_rgb.c[k];
  for (int i = 0; i < CHANNELS && !lambda->rgb && !diffuse; i++) {
    double before = left_at(lambda->crossed, lambda->nm[i]);
    b->more.tint.c[i] = before > 0 ? left_at(after, lambda->nm[i]) / before : 0;
  }
}

void cross_surface(const bsdf *b, vector wo, vector wi, wavelengths *lambda) {
  if (b->kind != BSDF_MORE || b->more.kind != MORE_PRINCIPLED) return;
  if (dot(wo, b->frame.z) * dot(wi, b->frame.z) >= 0) return;
  for (int k = 0; k < 3; k++) lambda->crossed[k] *= b->more.tint_rgb.c[k];
}

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
  make_tint(w, m, at, lambda, b);
  p->sheen = spectrum_at(w, &d->sheen_color, VL_PARAMETER_ALBEDO, at, lambda);
  for (int i = 0; i < CHANNELS; i++) p->sheen.c[i] = clamp(p->sheen.c[i], 0, 1);
  p->sheen_alpha = fmax(square(share_at(w, d->sheen_roughness, at)), 5e-3);
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
  layer base_layer = make_layer(OF_MICROFACETS, alpha, o.z, i.z);
  layer coat_layer = make_layer(OF_MICROFACETS, coat.alpha_x, o.z, i.z);
  layer sheen_layer = make_layer(OF_SHEEN, p->sheen_alpha, o.z, i.z);
  double fuzz = largest(p->sheen);
  double sheen_o = reflected(sheen_layer.out, fuzz, 0), sheen_i = reflected(sheen_layer.in, fuzz, 0);
  double coat_o = reflected(coat_layer.out, 0.04 * p->coat, p->coat);
  double coat_i = reflected(coat_layer.in, 0.04 * p->coat, p->coat);
  double over_sheen = through_both_ways(&coat_layer, 0.04 * p->coat, p->coat);
  double over_matt = over_sheen * through_both_ways(&sheen_layer, fuzz, 0);
  double over_mirrors = (1 - fmax(coat_o, coat_i)) * (1 - fmax(sheen_o, sheen_i));
  double over_sheet = wo.z > 0 ? (1 - coat_o) * (1 - sheen_o) : (1 - coat_i) * (1 - sheen_i);
  double fibres = over_sheen * sheen_value(o, i, p->sheen_alpha) / fmax(1, fmax(sheen_layer.out.b, sheen_layer.in.b));
  double dielectric = 1 - p->metallic, one = reflected(base_layer.mean, 1, 1);
  double again = cosine * through_both_ways(&base_layer, 1, 1);
  spectrum value;
  for (int k = 0; k < CHANNELS; k++) {
    double base = b->reflectance.c[k], tint = p->tint.c[k], f0 = p->f0.c[k], f90 = p->f90;
    double matt = dielectric * (1 - p->clear) * cosine * through_both_ways(&base_layer, f0, f90);
    double metal = base + (1 - base) / 21, sheet = f0 + (f90 - f0) / 21; /* mean Fresnel terms */
    double metal_again = again * p->metallic * square(metal) * one / (1 - metal * (1 - one));
    double sheet_again = again * dielectric * p->clear;
    double glass = f0 + (f90 - f0) * weight, foil = base + (1 - base) * weight;
    double up = over_mirrors * mirror * (dielectric * glass + p->metallic * foil) +
                p->coat * glossy * (0.04 + 0.96 * weight) + p->sheen.c[k] * fibres +
                over_matt * (matt * (1 - p->passed_on) * base + metal_again + sheet_again * sheet);
    double down = dielectric * p->clear * tint * (1 - glass) * mirror + matt * p->passed_on * p->transmittance.c[k] +
                  sheet_again * (1 - sheet) * tint;
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
