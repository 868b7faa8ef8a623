/* more/hair.c: hair by Chiang, Bitterli, Tappan and Burley 2016 (pbrt book 9.9). The hair runs along x. A direction has
 * the angle theta to the plane across the hair and phi around it. Light is reflected (p = 0), goes through (p = 1), is
 * reflected once inside (p = 2) or more often (p = 3); each way is a lobe Mp(theta) Ap Np(phi). */
#include "more.h"

enum { LAST = 3 };

typedef struct angles {
  double sine, cosine; /* of theta */
  double phi;
} angles;

static angles angles_of(vector w) {
  return (angles){w.x, sqrt(fmax(0, 1 - square(w.x))), atan2(w.z, w.y)};
}

/* What the lobes depend on besides wi. */
typedef struct lobes {
  angles o;
  double variance[LAST + 1]; /* of Mp */
  double width;              /* of Np: the logistic distribution's scale */
  double gamma_o, gamma_t;   /* where the ray meets the round section, outside and inside */
  spectrum a[LAST + 1];      /* Ap: the share of light that goes each way */
} lobes;

/* The spectra by path lengths inside the hair: the section's chord 2 cos gamma_t, longer along the hair. */
static void attenuate(const bsdf *b, lobes *l) {
  double h = b->more.offset;
  double reflected = reflected_by_glass(l->o.cosine * sqrt(fmax(0, 1 - h * h)), b->ior);
  double cosine_t = sqrt(fmax(0, 1 - square(l->o.sine / b->ior)));
  for (int i = 0; i < CHANNELS; i++) {
    double through = exp(-b->more.absorption.c[i] * 2 * cos(l->gamma_t) / cosine_t);
    l->a[0].c[i] = reflected;
    l->a[1].c[i] = square(1 - reflected) * through;
    l->a[2].c[i] = l->a[1].c[i] * through * reflected;
    l->a[3].c[i] = l->a[2].c[i] * through * reflected / (1 - through * reflected);
  }
}

static lobes make_lobes(const bsdf *b, vector wo) {
  lobes l = {.o = angles_of(wo)};
  double m = b->more.beta_m, n = b->more.beta_n;
  double v = square(0.726 * m + 0.812 * m * m + 3.7 * pow(m, 20));
  l.variance[0] = v;
  l.variance[1] = v / 4;
  l.variance[2] = l.variance[3] = 4 * v;
  l.width = sqrt(PI / 8) * (0.265 * n + 1.194 * n * n + 5.372 * pow(n, 22));
  /* the index that the section has for a slanted ray (Bravais) */
  double bravais = sqrt(square(b->ior) - square(l.o.sine)) / l.o.cosine;
  l.gamma_o = asin(clamp(b->more.offset, -1, 1));
  l.gamma_t = asin(clamp(b->more.offset / bravais, -1, 1));
  attenuate(b, &l);
  return l;
}

/* The scales of the hair tilt the lobes by 2, -1 and -4 times their angle. */
static angles tilted(const lobes *l, const bsdf *b, int p) {
  static const double times[LAST + 1] = {2, -1, -4, 0};
  double t = times[p] * b->more.tilt;
  angles o = l->o;
  return (angles){o.sine * cos(t) - o.cosine * sin(t), fabs(o.cosine * cos(t) + o.sine * sin(t)), o.phi};
}

/* ln I0, the modified Bessel function: its series, or its expansion for large arguments. */
static double log_bessel(double x) {
  if (x > 12) return x + 0.5 * log(1 / (2 * PI * x)) + log1p(1 / (8 * x) + 9 / (128 * x * x));
  double term = 1, sum = 1;
  for (int i = 1; i < 40; i++) {
    term *= square(x / (2 * i));
    sum += term;
  }
  return log(sum);
}

/* Mp (d'Eon et al. 2011): exp(-sin sin / v) I0(cos cos / v) / (2 v sinh(1 / v)); its integral over cos theta d theta is
 * 1. */
static double along_hair(angles i, angles o, double v) {
  double log_sinh = 1 / v + log((1 - exp(-2 / v)) / 2);
  return exp(log_bessel(i.cosine * o.cosine / v) - i.sine * o.sine / v - log_sinh) / (2 * v);
}

static double logistic_below(double x, double s) {
  return 1 / (1 + exp(-x / s));
}

/* Where a ray leaves the round section after p - 1 reflections inside, from where it came (geometric optics). */
static double exit_angle(const lobes *l, int p) {
  return 2 * p * l->gamma_t - 2 * l->gamma_o + p * PI;
}

/* Np: a logistic distribution around that angle, cut off at half a turn. */
static double around_hair(const lobes *l, int p, double phi) {
  if (p == LAST) return 1 / (2 * PI);
  double s = l->width;
  double x = fabs(remainder(phi - exit_angle(l, p), 2 * PI));
  double e = exp(-x / s);
  double inside = logistic_below(PI, s) - logistic_below(-PI, s);
  return e / (s * square(1 + e)) / inside;
}

static double mean_of(spectrum a) {
  return (a.c[0] + a.c[1] + a.c[2] + a.c[3]) / CHANNELS;
}

/* Lobes are drawn by how much light goes their way. */
static void chances(const lobes *l, double chance[LAST + 1]) {
  double sum = 0;
  for (int p = 0; p <= LAST; p++) sum += mean_of(l->a[p]);
  for (int p = 0; p <= LAST; p++) chance[p] = mean_of(l->a[p]) / sum;
}

/* The lobes are densities per solid angle: the model has no cosine with a normal. */
spectrum hair_value(const bsdf *b, vector wo, vector wi, double *density) {
  lobes l = make_lobes(b, wo);
  angles i = angles_of(wi);
  double chance[LAST + 1];
  spectrum sum = gray(0);
  chances(&l, chance);
  *density = 0;
  for (int p = 0; p <= LAST; p++) {
    double shape = along_hair(i, tilted(&l, b, p), l.variance[p]) * around_hair(&l, p, i.phi - l.o.phi);
    sum = plus(sum, scaled(shape, l.a[p]));
    *density += chance[p] * shape;
  }
  return sum;
}

void sample_hair(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  lobes l = make_lobes(b, wo);
  double chance[LAST + 1], u = next_number(s);
  int p = 0;
  chances(&l, chance);
  while (p < LAST && u >= chance[p]) u -= chance[p++];
  /* Mp is inverted as d'Eon et al. 2013 do: an angle around the mirror direction, and one around that */
  angles o = tilted(&l, b, p);
  double v = l.variance[p], x = next_number(s);
  double cosine = 1 + v * log(fmax(1e-300, x + (1 - x) * exp(-2 / v)));
  double sine = sqrt(fmax(0, 1 - square(cosine)));
  double sine_i = clamp(-cosine * o.sine + sine * cos(2 * PI * next_number(s)) * o.cosine, -1, 1);
  double cosine_i = sqrt(1 - square(sine_i));
  double low = logistic_below(-PI, l.width), high = logistic_below(PI, l.width);
  double y = low + next_number(s) * (high - low);
  double phi = p == LAST ? 2 * PI * y : exit_angle(&l, p) - l.width * log(1 / y - 1);
  phi += l.o.phi;
  result->wi = make_vector(sine_i, cosine_i * cos(phi), cosine_i * sin(phi));
}
