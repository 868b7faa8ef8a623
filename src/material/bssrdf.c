/* material/bssrdf.c: the tables of photon beam diffusion. Formulas: pbrt book, 3rd
 * edition, 15.5.2 to 15.5.5. Fresnel moments: the polynomials of d'Eon and Irving 2011, "A
 * Quantized-Diffusion Model for Rendering Translucent Materials", which pbrt uses too. */
#include "material/bssrdf.h"

#include <math.h>

#include "math/approx_double.h"
#include "math/elementary.h"

/* Fresnel moments: int Fr(c) c dc and int Fr(c) c^2 dc over cosines c from 0 to 1. eta: index
 * on the incident side over index on the other side, so 1.5 for light inside a solid of index
 * 1.5. */
static double moment1(double eta) {
  double e = eta;
  if (e < 1)
    return 0.45966 +
           e * (-1.73965 + e * (3.37668 + e * (-3.904945 + e * (2.49277 - 0.68441 * e))));
  return -4.61686 +
         e * (11.1136 + e * (-10.4646 + e * (5.11455 + e * (-1.27198 + 0.12746 * e))));
}
static double moment2(double eta) {
  double e = eta, q = 1 / eta;
  if (e < 1)
    return 0.27614 +
           e * (-0.87350 + e * (1.12077 + e * (-0.65095 + e * (0.07883 + 0.04860 * e))));
  return -547.033 + q * (458.843 + q * (-218.725 + 45.3087 * q)) +
         e * (404.557 + e * (-189.519 + e * (54.9327 + e * (-9.00603 + 0.63942 * e))));
}

/* Fresnel reflectance for light that leaves the solid at this cosine. */
static double reflected_inside(double cosine, double eta) {
  double sin2 = eta * eta * (1 - cosine * cosine);
  if (sin2 >= 1)
    return 1;
  double out = sqrt(1 - sin2);
  double a = (cosine - eta * out) / (cosine + eta * out),
         b = (eta * cosine - out) / (eta * cosine + out);
  return 0.5 * (a * a + b * b);
}

static double phase(double cosine, double g) {
  double d = 1 + g * g + 2 * g * cosine;
  return (1 - g * g) / (4 * M_PI * d * sqrt(d));
}

/* Optical depths of sample points along the beam, distributed by its attenuation. */
enum { POINTS = 100 };
typedef struct Beam {
  double depth[POINTS];
} Beam;

static Beam make_beam(void) {
  Beam b;
  for (int i = 0; i < POINTS; i++)
    b.depth[i] = -vl_precise_log(1 - (i + 0.5) / POINTS);
  return b;
}

/* Multiple scattering: one dipole per point of the beam. */
static double multiple(double albedo, double g, double eta, double r, const Beam *beam) {
  double sigma_a = 1 - albedo, sigma_s = albedo * (1 - g), sigma_t = sigma_a + sigma_s;
  if (!(sigma_s > 0))
    return 0;
  double reduced = sigma_s / sigma_t;
  /* Grosjean's diffusion coefficient */
  double diffusion = (2 * sigma_a + sigma_s) / (3 * sigma_t * sigma_t);
  double tr = sqrt(sigma_a / diffusion);
  double f1 = moment1(eta), f2 = moment2(eta);
  double extrapolated = -2 * diffusion * (1 + 3 * f2) / (1 - 2 * f1);
  double by_fluence = 0.25 * (1 - 2 * f1), by_flux = 0.5 * (1 - 3 * f2), sum = 0;
  for (int i = 0; i < POINTS; i++) {
    double z = beam->depth[i] / sigma_t, mirrored = 2 * extrapolated - z;
    double d = sqrt(r * r + z * z), m = sqrt(r * r + mirrored * mirrored),
           ed = vl_exp_double(-tr * d), em = vl_exp_double(-tr * m);
    double fluence = (ed / d - em / m) / (4 * M_PI * diffusion);
    double flux =
        (z * (1 + tr * d) * ed / (d * d * d) - mirrored * (1 + tr * m) * em / (m * m * m)) /
        (4 * M_PI);
    /* Habel's empirical correction close to the beam */
    double near = 1 - vl_exp_double(-2 * sigma_t * (d + z));
    sum += near * reduced * reduced * (fluence * by_fluence + flux * by_flux);
  }
  return sum / POINTS;
}

/* Single scattering. Only points from which light can leave at distance r contribute. */
static double single(double albedo, double g, double eta, double r, const Beam *beam) {
  double critical = r * sqrt(eta > 1 ? eta * eta - 1 : 0), sum = 0;
  for (int i = 0; i < POINTS; i++) {
    double z = critical + beam->depth[i], d = sqrt(r * r + z * z), cosine = z / d;
    sum += albedo * vl_exp_double(-(d + critical)) / (d * d) * phase(cosine, g) *
           (1 - reflected_inside(cosine, eta)) * cosine;
  }
  return sum / POINTS;
}

static void fill_row(void *user, uint32_t row, VL_UNUSED uint32_t worker) {
  vlBssrdfTable *t = user;
  Beam beam = make_beam();
  double albedo = (double)t->albedo[row], g = (double)t->g, eta = (double)t->eta;
  for (uint32_t k = 0; k < VL_BSSRDF_RADII; k++) {
    double r = (double)t->radius[k], ring = 0;
    if (r > 0)
      ring = 2 * M_PI * r *
             (single(albedo, g, eta, r, &beam) + multiple(albedo, g, eta, r, &beam));
    t->profile[row][k] = ring > 0 && ring < 1e30 ? (float)ring : 0.0f;
  }
  double sum = 0;
  for (uint32_t i = 0; i < VL_BSSRDF_RADII; i++) {
    t->cdf[row][i] = (float)sum;
    if (i + 1 == VL_BSSRDF_RADII)
      break;
    float f[4];
    for (uint32_t k = 0; k < 4; k++) {
      uint32_t j = i + k; /* index plus one, so that it is never negative */
      f[k] = t->profile[row][j < 1 ? 0 : j > VL_BSSRDF_RADII ? VL_BSSRDF_RADII - 1 : j - 1];
    }
    vlSplinePiece p = vl_spline_piece(t->radius, VL_BSSRDF_RADII, i, f);
    sum += (double)(t->radius[i + 1] - t->radius[i]) * (double)vl_spline_integral(p, 1);
  }
  t->effective[row] = (float)sum;
}

void vl_bssrdf_build(vlContext *context, float eta, float g, vlBssrdfTable *t) {
  t->eta = eta;
  t->g = g;
  t->leaves = (float)(1 - 2 * moment1(1 / (double)eta));
  t->radius[0] = 0.0f;
  for (uint32_t i = 1; i < VL_BSSRDF_RADII; i++)
    t->radius[i] = i > 1 ? t->radius[i - 1] * 1.2f : 2.5e-3f;
  /* nodes are closer together at high albedos */
  for (uint32_t i = 0; i < VL_BSSRDF_ALBEDOS; i++)
    t->albedo[i] = (float)((1 - vl_precise_exp(-8.0 * i / (VL_BSSRDF_ALBEDOS - 1))) /
                           (1 - vl_precise_exp(-8.0)));
  vl_parallel_for(context, VL_BSSRDF_ALBEDOS, fill_row, t);
}
