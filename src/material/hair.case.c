/* material/hair.case.c: what tests know of the material hair. */
#include "material/material.case.h"
#include "material/microfacets.case.h"

#define PI 3.14159265358979

/* The modified Bessel function I0, by its series. */
static double bessel(double x) {
  double term = 1;
  double sum = 1;
  for (int k = 1; k < 400; k++) {
    term *= x * x / (4.0 * k * k);
    sum += term;
  }
  return sum;
}

/* pbrt book, equation 9.49. */
static double longitudinal(double sin_in, double sin_out, double variance) {
  const double cos_in = sqrt(1 - sin_in * sin_in);
  const double cos_out = sqrt(1 - sin_out * sin_out);
  return exp(-sin_in * sin_out / variance) * bessel(cos_in * cos_out / variance) /
         (2 * variance * sinh(1 / variance));
}

/* The trimmed logistic distribution around `middle`. */
static double azimuthal(double phi, double middle, double s) {
  const double x = remainder(phi - middle, 2 * PI);
  const double e = exp(-fabs(x) / s);
  const double whole = 1 / (1 + exp(-PI / s)) - 1 / (1 + exp(PI / s));
  return e / (s * (1 + e) * (1 + e) * whole);
}

/* The first three lobes of pbrt book 9.9, and the rest of the light in one: beta_m .4, beta_n
 * .6, scales of 3 degrees, index 1.55. */
static double lobes(const MaterialAt *at, double absorbed) {
  const double eta = 1.55;
  const double m = .4;
  const double n = .6;
  const double variance = pow(.726 * m + .812 * m * m + 3.7 * pow(m, 20), 2);
  const double variances[3] = {variance, variance / 4, 4 * variance};
  const double tilts[3] = {-2, 1, 4};
  const double s = sqrt(PI / 8) * (.265 * n + 1.194 * n * n + 5.372 * pow(n, 22));
  const double sin_out = at->out[0];
  const double cos_out = sqrt(1 - sin_out * sin_out);
  const double phi = atan2(at->in[2], at->in[1]) - atan2(at->out[2], at->out[1]);
  const double across = sqrt(eta * eta - sin_out * sin_out) / cos_out;
  const double outside = asin(at->across);
  const double inside = asin(at->across / across);
  const double way = 2 * cos(inside) / sqrt(1 - pow(sin_out / eta, 2));
  const double passed = exp(-absorbed * way);
  const double f = plain_fresnel(cos_out * cos(outside), eta);
  double part = f;
  double sum = 0;
  for (int p = 0; p < 3; p++) {
    const double tilted = sin(asin(sin_out) + tilts[p] * 3 * PI / 180);
    sum += part * longitudinal(at->in[0], tilted, variances[p]) *
           azimuthal(phi, 2 * p * inside - 2 * outside + p * PI, s);
    part = p == 0 ? (1 - f) * (1 - f) * passed : part * passed * f;
  }
  part /= 1 - passed * f;
  return sum + part * longitudinal(at->in[0], sin_out, variances[2]) / (2 * PI);
}

static void brown(const MaterialAt *at, double value[3]) {
  static const double absorbed[3] = {.2, .6, 1.4};
  for (int c = 0; c < 3; c++)
    value[c] = lobes(at, absorbed[c]);
}

/* Hair that absorbs all light that enters it reflects by its scales: the eye is 8.74 degrees
 * from the normal along the hair, the scales are tilted by 10, so the light goes to where a
 * mirror turned by these would send it: to 20 - 8.74 degrees, of whose sine 1 - v is left, v =
 * .0316 the variance of beta_m = .2 (pbrt book 9.9.3, 9.9.6). */
const MaterialCase hair_material = {{
    {.parameters = "", .one_way = true},
    {.parameters = "\"rgb reflectance\" [.8 .5 .3] \"float beta_m\" .6 \"float beta_n\" .7",
     .one_way = true},
    {.parameters =
         "\"rgb sigma_a\" [500 500 500] \"float beta_m\" .2 \"float beta_n\" .6 \"float alpha\" 10",
     .along = .189097,
     .one_way = true},
    {.parameters = "\"rgb sigma_a\" [.2 .6 1.4] \"float beta_m\" .4 \"float beta_n\" .6 "
                   "\"float alpha\" 3",
     .one_way = true,
     .formula = brown},
}};
