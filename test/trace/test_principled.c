/* test_principled.c: the principled BSDF: white surfaces in a white furnace, reciprocity,
 * densities by chi-square, agreement of sampling and evaluation, the thin film against Fresnel
 * and against interference computed here; disabled layers change nothing. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "unit.h"

/* What a material says; least and most: bounds of what a white one sends back of a furnace. */
typedef struct Look {
  const char *name;
  float metallic, roughness, transmission, solid, beyond, coat, coat_roughness, sheen,
      sheen_roughness, film, film_nm, anisotropy, base, index;
  double min, max;
} Look;
static const Look looks[] = {
    {.name = "mirror-like dielectric", .base = 1, .min = 0.999, .max = 1.001},
    {.name = "dielectric", .base = 1, .roughness = 0.5f, .min = 0.998, .max = 1.001},
    {.name = "rough dielectric", .base = 1, .roughness = 1, .min = 0.999, .max = 1.001},
    {.name = "mirror", .base = 1, .metallic = 1, .min = 0.999, .max = 1.001},
    {.name = "metal", .base = 1, .metallic = 1, .roughness = 0.5f, .min = 0.997, .max = 1.003},
    {.name = "rough metal",
     .base = 1,
     .metallic = 1,
     .roughness = 1,
     .min = 0.996,
     .max = 1.004},
    {.name = "half metal",
     .base = 1,
     .metallic = 0.5f,
     .roughness = 0.4f,
     .min = 0.996,
     .max = 1.003},
    {.name = "sheet", .base = 1, .transmission = 1, .min = 0.999, .max = 1.001},
    {.name = "rough sheet",
     .base = 1,
     .roughness = 0.6f,
     .transmission = 1,
     .min = 0.997,
     .max = 1.003},
    {.name = "solid", .base = 1, .transmission = 1, .solid = 1, .min = 0.999, .max = 1.001},
    {.name = "frosted glass",
     .base = 1,
     .roughness = 0.3f,
     .transmission = 1,
     .solid = 1,
     .min = 0.997,
     .max = 1.003},
    {.name = "rough glass",
     .base = 1,
     .roughness = 0.6f,
     .transmission = 1,
     .solid = 1,
     .min = 0.997,
     .max = 1.003},
    {.name = "rough diamond",
     .base = 1,
     .roughness = 0.7f,
     .transmission = 1,
     .solid = 1,
     .index = 2.42f,
     .min = 0.997,
     .max = 1.003},
    {.name = "rough water",
     .base = 1,
     .roughness = 0.8f,
     .transmission = 1,
     .solid = 1,
     .index = 1.33f,
     .min = 0.997,
     .max = 1.003},
    {.name = "rough air",
     .base = 1,
     .roughness = 0.9f,
     .transmission = 1,
     .solid = 1,
     .index = 1.05f,
     .min = 0.997,
     .max = 1.003},
    {.name = "roughest glass",
     .base = 1,
     .roughness = 1,
     .transmission = 1,
     .solid = 1,
     .min = 0.997,
     .max = 1.003},
    {.name = "half frosted",
     .base = 1,
     .metallic = 0.3f,
     .roughness = 0.7f,
     .transmission = 0.5f,
     .solid = 1,
     .min = 0.99,
     .max = 1.01},
    {.name = "half passing",
     .base = 1,
     .roughness = 0.3f,
     .transmission = 0.5f,
     .min = 0.997,
     .max = 1.003},
    {.name = "leaf", .base = 1, .roughness = 0.5f, .beyond = 0.5f, .min = 0.998, .max = 1.001},
    {.name = "coat", .base = 1, .roughness = 0.5f, .coat = 1, .min = 0.993, .max = 1.004},
    {.name = "coated mirror", .base = 1, .metallic = 1, .coat = 1, .min = 0.996, .max = 1.001},
    {.name = "coated metal",
     .base = 1,
     .metallic = 1,
     .roughness = 0.3f,
     .coat = 1,
     .coat_roughness = 0.4f,
     .min = 0.975,
     .max = 1.001},
    {.name = "velvet",
     .base = 1,
     .roughness = 0.8f,
     .sheen = 1,
     .sheen_roughness = 0.3f,
     .min = 0.996,
     .max = 1.003},
    {.name = "cloth",
     .base = 1,
     .roughness = 0.5f,
     .sheen = 1,
     .sheen_roughness = 0.7f,
     .min = 0.996,
     .max = 1.003},
    {.name = "film",
     .base = 1,
     .roughness = 0.2f,
     .film = 1,
     .film_nm = 400,
     .min = 0.955,
     .max = 1.001},
    {.name = "film on metal",
     .base = 1,
     .metallic = 1,
     .roughness = 0.4f,
     .film = 1,
     .film_nm = 500,
     .min = 0.994,
     .max = 1.005},
    {.name = "brushed metal",
     .base = 1,
     .metallic = 1,
     .roughness = 0.55f,
     .anisotropy = 0.5f,
     .min = 0.99,
     .max = 1.01},
    {.name = "satin metal",
     .base = 1,
     .metallic = 1,
     .roughness = 0.2f,
     .anisotropy = 1,
     .min = 0.99,
     .max = 1.01},
    {.name = "brushed glass",
     .base = 1,
     .roughness = 0.3f,
     .transmission = 1,
     .solid = 1,
     .anisotropy = 0.9f,
     .min = 0.975,
     .max = 1.025},
    {.name = "brushed diamond",
     .base = 1,
     .roughness = 0.3f,
     .transmission = 1,
     .solid = 1,
     .index = 2.42f,
     .anisotropy = 0.9f,
     .min = 0.9,
     .max = 1.1},
    /* with all that is on at once, and not white */
    {.name = "everything",
     .base = 0.7f,
     .metallic = 0.3f,
     .roughness = 0.4f,
     .transmission = 0.4f,
     .beyond = 0.3f,
     .coat = 0.8f,
     .coat_roughness = 0.3f,
     .sheen = 0.3f,
     .sheen_roughness = 0.5f,
     .film = 0.5f,
     .film_nm = 350,
     .anisotropy = 0.4f,
     .min = 0.6,
     .max = 1.0},
    {.name = "frosted solid",
     .base = 0.9f,
     .roughness = 0.5f,
     .transmission = 0.8f,
     .solid = 1,
     .coat = 0.5f,
     .coat_roughness = 0.3f,
     .min = 0.6,
     .max = 1.0},
};
enum { LOOKS = sizeof looks / sizeof *looks };

static Surface surface_of(const Look *l, float rows[VL_BSDF_ROWS]) {
  memset(rows, 0, VL_BSDF_ROWS * sizeof *rows);
  rows[VL_P_METALLIC] = l->metallic;
  rows[VL_P_F90] = 1;
  rows[VL_P_TRANSMISSION] = l->transmission;
  rows[VL_P_THIN] = 1 - l->solid;
  rows[VL_P_DIFFUSE_TRANSMISSION] = l->beyond;
  rows[VL_P_COAT] = l->coat;
  rows[VL_P_COAT_ALPHA] = fmaxf(l->coat_roughness * l->coat_roughness, 1e-3f);
  rows[VL_P_COAT_Z] = 1;
  rows[VL_P_SHEEN_ALPHA] = fmaxf(l->sheen_roughness * l->sheen_roughness, 0.005f);
  rows[VL_P_FILM] = l->film;
  rows[VL_P_FILM_INDEX] = 1.3f;
  rows[VL_P_FILM_NM] = l->film_nm;
  float index = l->index > 0 ? l->index : 1.5f, root = (index - 1) / (index + 1);
  for (int c = 0; c < 4; c++) {
    rows[VL_P_F0 + c] = root * root;
    rows[VL_P_THROUGH + c] = 1;
    rows[VL_P_SHEEN + c] = l->sheen;
  }
  float alpha = fmaxf(l->roughness * l->roughness, 1e-3f);
  return (Surface){.kind = VL_BSDF_PRINCIPLED,
                   .reflectance = l->base,
                   .eta_s = index,
                   .alpha_x = alpha + (1 - alpha) * l->anisotropy * l->anisotropy,
                   .alpha_y = alpha,
                   .own = rows};
}

typedef struct Kept {
  double mean, error;
} Kept;

/* A direction to a surface. */
typedef struct Way {
  double cosine, azimuth;
} Way;

/* What a surface sends back of a furnace. Channel 0 of the base is white where base is 1
 * (batch_surface darkens the others). */
static Kept kept_by(const State *s, const Surface *surface, Way way, int turns, statRng *rng) {
  Batch *b = s->batch;
  double sum = 0, square = 0;
  for (uint32_t j = 0; j < BATCH; j++) {
    batch_surface(b, j, surface);
    batch_wo(b, j, acos(way.cosine), way.azimuth);
  }
  for (int turn = 0; turn < turns; turn++) {
    batch_numbers(b, BATCH, rng);
    batch_sample(s->kernels, VL_BSDF_PRINCIPLED, BATCH, b);
    for (uint32_t j = 0; j < BATCH; j++) {
      double w = b->flags[j] & VL_SAMPLED_NONE ? 0 : (double)(b->weight[0][j] * b->scale[j]);
      sum += w;
      square += w * w;
    }
  }
  double n = (double)turns * BATCH, mean = sum / n;
  return (Kept){mean, sqrt((square / n - mean * mean) / n)};
}

static void furnace(void **state) {
  State *s = *state;
  static const double cosines[] = {0.98, 0.7, 0.4, 0.15, -0.3, -0.85};
  for (int k = 0; k < LOOKS; k++) {
    float rows[VL_BSDF_ROWS];
    Surface surface = surface_of(&looks[k], rows);
    for (int t = 0; t < 6; t++) {
      statRng rng = stat_rng((uint64_t)(k * 6 + t));
      Kept kept = kept_by(s, &surface, (Way){cosines[t], 0.6}, 100, &rng);
      double mean = kept.mean, error = kept.error;
      if (!(mean > looks[k].min - 4 * error && mean < looks[k].max + 4 * error))
        fail_msg("%s at cos %g: %g +- %g", looks[k].name, cosines[t], mean, error);
    }
  }
}

/* Mixtures of a white base with what lies over it, at random: `lobes` says which take part.
 * Together they span what the table of docs/principled.md gives for such mixtures. */
enum {
  SHEEN = 1,
  COAT = 2,
  METAL = 4,
  FILM = 8,
  CLEAR = 16,
  BEYOND = 32,
  SOLID = 64,
  BRUSHED = 128
};
typedef struct Mixture {
  const char *name;
  int lobes;
  double min, max;
} Mixture;
static const Mixture mixtures[] = {
    {"dielectric and metal", METAL, 0.996, 1.004},
    {"sheen over dielectric", SHEEN, 0.95, 1.02},
    {"sheen over dielectric and metal", SHEEN | METAL, 0.94, 1.02},
    {"coat over dielectric and metal", COAT | METAL, 0.94, 1.02},
    {"coat and sheen", COAT | SHEEN | METAL, 0.84, 1.05},
    {"film", FILM, 0.3, 1.01},
    {"brushed metal", METAL | BRUSHED, 0.97, 1.03},
    {"brushed sheet", CLEAR | BRUSHED, 0.97, 1.03},
    {"brushed glass", CLEAR | SOLID | BRUSHED, 0.97, 1.03},
    {"all", COAT | SHEEN | METAL | FILM | CLEAR | BEYOND, 0.3, 1.05},
};

static float some(statRng *rng, bool on) {
  float u = 3 * stat_float(rng) - 1; /* a third each: 0, 1, between */
  return !on || u < 0 ? 0 : u > 1 ? 1 : u;
}

static Look random_look(int lobes, statRng *rng) {
  return (Look){.base = 1,
                .roughness = some(rng, true),
                .metallic = some(rng, lobes & METAL),
                .transmission = some(rng, lobes & CLEAR),
                .beyond = some(rng, lobes & BEYOND),
                .coat = some(rng, lobes & COAT),
                .coat_roughness = some(rng, true),
                .sheen = some(rng, lobes & SHEEN),
                .sheen_roughness = some(rng, true),
                .film = some(rng, lobes & FILM),
                .film_nm = 100 + 700 * stat_float(rng),
                .solid = lobes & SOLID ? 1 : 0,
                .anisotropy = lobes & BRUSHED ? stat_float(rng) : 0};
}

static void mixtures_keep_what_is_told(void **state) {
  State *s = *state;
  enum { LOOKS_EACH = 200, SOME_TURNS = 6 };
  for (size_t m = 0; m < sizeof mixtures / sizeof *mixtures; m++) {
    statRng rng = stat_rng(4000 + m);
    double low = 9, high = 0;
    for (int k = 0; k < LOOKS_EACH; k++) {
      Look look = random_look(mixtures[m].lobes, &rng);
      float rows[VL_BSDF_ROWS];
      Surface surface = surface_of(&look, rows);
      Way way = {pow(stat_double(&rng), 2) * 0.97 + 0.03, 2 * PI * stat_double(&rng)};
      Kept kept = kept_by(s, &surface, way, SOME_TURNS, &rng);
      low = fmin(low, kept.mean + 4 * kept.error);
      high = fmax(high, kept.mean - 4 * kept.error);
    }
    if (!(low > mixtures[m].min && high < mixtures[m].max))
      fail_msg("%s: %g to %g", mixtures[m].name, low, high);
  }
}

/* ---- light between the microfacets of a metal ------------------------------------------- */

/* Smith's length of the slopes that hide a direction, for a roughness of 1. */
static double slopes(double cosine) {
  return 0.5 * (1 / cosine - 1);
}

/* What microfacets of a roughness of 1, whose reflectance is `base` plus the rest by Schlick,
 * send back at once of light at a cosine: the integral of D G F / (4 cos), with D = 1 / pi. */
static double sent_at_once(double base, double cosine, int parts) {
  const double o[3] = {sqrt(1 - cosine * cosine), 0, cosine};
  double sum = 0;
  for (int j = 0; j < parts; j++)
    for (int k = 0; k < parts; k++) {
      const double z = (j + 0.5) / parts, r = sqrt(1 - z * z),
                   phi = 2 * M_PI * (k + 0.5) / parts;
      const double h[3] = {o[0] + r * cos(phi), r * sin(phi), o[2] + z};
      const double oh = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]) / 2;
      const double fresnel = base + (1 - base) * pow(1 - oh, 5);
      sum += fresnel / (1 + slopes(cosine) + slopes(z)) / (4 * M_PI * cosine);
    }
  return sum * 2 * M_PI / (parts * parts);
}

/* Kulla and Conty 2017: light that is not sent at once, and is reflected by the mean of
 * Schlick's reflectance, base + (1 - base) / 21, at each further microfacet. */
static void metals_reflect_again(void **state) {
  State *s = *state;
  const double cosine = 0.7;
  double mean_sent = 0;
  for (int k = 0; k < 40; k++) {
    const double c = (k + 0.5) / 40;
    mean_sent += 2 * c * sent_at_once(1, c, 60) / 40;
  }
  for (int k = 1; k < 5; k++) {
    const double base = 0.2 * k, mean = base + (1 - base) / 21;
    const double again = mean * mean * mean_sent / (1 - mean * (1 - mean_sent));
    const double known =
        sent_at_once(base, cosine, 300) + (1 - sent_at_once(1, cosine, 300)) * again;
    const Look metal = {.metallic = 1, .roughness = 1, .base = (float)base};
    float rows[VL_BSDF_ROWS];
    Surface surface = surface_of(&metal, rows);
    statRng rng = stat_rng(7100 + (uint64_t)k);
    Kept kept = kept_by(s, &surface, (Way){cosine, 0.6}, 100, &rng);
    if (!(fabs(kept.mean - known) < 0.005 + 4 * kept.error))
      fail_msg("a metal of %.1f sends back %.4f +- %.4f, not %.4f", base, kept.mean, kept.error,
               known);
  }
}

/* f(o, i) / eta_i^2 is the same both ways; eta is the index on the side of the direction. */
static void reciprocity(void **state) {
  State *s = *state;
  Batch *a = s->batch, *b = s->other;
  for (int k = 0; k < LOOKS; k++) {
    float rows[VL_BSDF_ROWS];
    Surface surface = surface_of(&looks[k], rows);
    if (looks[k].roughness == 0)
      continue; /* values of sharp peaks are rounded more */
    statRng rng = stat_rng((uint64_t)(1000 + k));
    for (uint32_t j = 0; j < BATCH; j++) {
      double o[3], w[3];
      do
        stat_direction(&rng, o);
      while (fabs(o[2]) < 0.05);
      do
        stat_direction(&rng, w);
      while (fabs(w[2]) < 0.05);
      batch_surface(a, j, &surface);
      batch_surface(b, j, &surface);
      a->ox[j] = b->ix[j] = (float)o[0];
      a->oy[j] = b->iy[j] = (float)o[1];
      a->oz[j] = b->iz[j] = (float)o[2];
      a->ix[j] = b->ox[j] = (float)w[0];
      a->iy[j] = b->oy[j] = (float)w[1];
      a->iz[j] = b->oz[j] = (float)w[2];
    }
    batch_eval(s->kernels, VL_BSDF_PRINCIPLED, BATCH, a);
    batch_eval(s->kernels, VL_BSDF_PRINCIPLED, BATCH, b);
    uint32_t lit = 0;
    for (uint32_t j = 0; j < BATCH; j++)
      for (int c = 0; c < 4; c++) {
        double forth = (double)a->value[c][j] / fabs((double)a->iz[j]),
               back = (double)b->value[c][j] / fabs((double)b->iz[j]);
        /* radiance over the squared index of where it travels */
        if (looks[k].solid > 0 && a->oz[j] * a->iz[j] < 0) {
          double index = (double)surface.eta_s;
          forth /= a->oz[j] > 0 ? 1 : index * index;
          back /= b->oz[j] > 0 ? 1 : index * index;
        }
        lit += forth > 0;
        if (!(fabs(forth - back) <= 1e-4 * (fabs(forth) + 1e-4)))
          fail_msg("%s: %g one way, %g the other (o.z %g, i.z %g)", looks[k].name, forth, back,
                   (double)a->oz[j], (double)a->iz[j]);
      }
    assert_true(lit > BATCH / 2);
  }
}

typedef struct Direction {
  const State *s;
} Direction;
static double density(void *user, const double w[3]) {
  const Direction *d = user;
  Batch *b = d->s->other;
  b->ix[0] = (float)w[0];
  b->iy[0] = (float)w[1];
  b->iz[0] = (float)w[2];
  batch_eval(d->s->kernels, VL_BSDF_PRINCIPLED, 1, b);
  return (double)b->pdf[0];
}

/* Directions fall as the density says; it integrates to at most 1. */
static void chi_square(void **state) {
  State *s = *state;
  Batch *b = s->batch;
  static const double thetas[] = {0.3, 1.3, PI - 0.7};
  const char *names[] = {"dielectric",   "rough metal",   "rough sheet",   "leaf",
                         "coated metal", "velvet",        "film",          "brushed metal",
                         "everything",   "frosted solid", "roughest glass"};
  for (int q = 0; q < 11; q++)
    for (int t = 0; t < 3; t++) {
      int k = 0;
      while (strcmp(looks[k].name, names[q]) != 0)
        k++;
      float rows[VL_BSDF_ROWS];
      Surface surface = surface_of(&looks[k], rows);
      statRng rng = stat_rng((uint64_t)(q * 3 + t + 31));
      statSphere hist = stat_sphere_new(24, 32);
      for (uint32_t j = 0; j < BATCH; j++) {
        batch_surface(b, j, &surface);
        batch_wo(b, j, thetas[t], 0.7);
      }
      for (int turn = 0; turn < 64; turn++) {
        batch_numbers(b, BATCH, &rng);
        batch_sample(s->kernels, VL_BSDF_PRINCIPLED, BATCH, b);
        for (uint32_t j = 0; j < BATCH; j++)
          if (b->flags[j] & VL_SAMPLED_NONE)
            stat_sphere_reject(hist);
          else
            stat_sphere_add(hist, (double)b->ix[j], (double)b->iy[j], (double)b->iz[j]);
      }
      for (uint32_t j = 0; j < VL_LANES; j++) {
        batch_surface(s->other, j, &surface);
        batch_wo(s->other, j, thetas[t], 0.7);
      }
      Direction d = {s};
      statResult r = stat_sphere_test(hist, density, &d, 2e-5);
      if (!stat_accept(r, 30))
        fail_msg("%s, theta %g: p %g, integral %g", names[q], thetas[t], r.p, r.integral);
      assert_true(r.integral < 1.0005);
    }
}

static void sampled_is_evaluated(void **state) {
  State *s = *state;
  Batch *a = s->batch, *b = s->other;
  for (int k = 0; k < LOOKS; k++) {
    if (looks[k].roughness == 0)
      continue;
    float rows[VL_BSDF_ROWS];
    Surface surface = surface_of(&looks[k], rows);
    statRng rng = stat_rng((uint64_t)(500 + k));
    for (uint32_t j = 0; j < BATCH; j++) {
      double d[3];
      stat_direction(&rng, d);
      batch_surface(a, j, &surface);
      a->ox[j] = (float)d[0];
      a->oy[j] = (float)d[1];
      a->oz[j] = (float)d[2];
    }
    batch_numbers(a, BATCH, &rng);
    batch_sample(s->kernels, VL_BSDF_PRINCIPLED, BATCH, a);
    *b = *a;
    batch_eval(s->kernels, VL_BSDF_PRINCIPLED, BATCH, b);
    for (uint32_t j = 0; j < BATCH; j++) {
      if (a->flags[j] & VL_SAMPLED_NONE)
        continue;
      bool crosses = a->oz[j] * a->iz[j] < 0;
      assert_true(((a->flags[j] & VL_SAMPLED_TRANSMISSION) != 0) == crosses);
      for (int c = 0; c < 4; c++) {
        double v = (double)b->value[c][j], w = (double)a->weight[c][j] * (double)a->pdf[j];
        if (!(fabs(v - w) <= 1e-4 * (v + 1e-5)))
          fail_msg("%s: eval %g, sample %g", looks[k].name, v, w);
      }
    }
  }
}

/* Reflection of a smooth film on black, by what the specular lobe sends back at one angle. */
static double film_reflection(State *s, float nm, float index, double cosine,
                              uint32_t channel) {
  Look look = {.metallic = 1, .roughness = 0, .film = 1, .film_nm = nm, .base = 0.04f};
  float rows[VL_BSDF_ROWS];
  Surface surface = surface_of(&look, rows);
  rows[VL_P_FILM_INDEX] = index;
  Batch *b = s->batch;
  statRng rng = stat_rng(3);
  double sum = 0;
  for (uint32_t j = 0; j < BATCH; j++) {
    batch_surface(b, j, &surface);
    for (int c = 0; c < 4; c++)
      b->reflectance[c][j] = 0.04f; /* an index of 1.5 */
    batch_wo(b, j, acos(cosine), 0);
  }
  batch_numbers(b, BATCH, &rng);
  batch_sample(s->kernels, VL_BSDF_PRINCIPLED, BATCH, b);
  for (uint32_t j = 0; j < BATCH; j++)
    sum += b->flags[j] & VL_SAMPLED_NONE ? 0 : (double)b->weight[channel][j];
  return sum / BATCH;
}

static void thin_film(void **state) {
  State *s = *state;
  /* No thickness: the bare base, (1.5 - 1)^2 / (1.5 + 1)^2 at normal incidence. */
  assert_true(fabs(film_reflection(s, 0, 1.3f, 0.99999, 0) - 0.04) < 2e-4);
  /* A quarter wave of index sqrt(1.5) makes it vanish; half a wave does nothing. Channel 1 is
   * 500 nm. */
  float root = sqrtf(1.5f);
  assert_true(film_reflection(s, 500 / (4 * root), root, 0.99999, 1) < 2e-4);
  assert_true(fabs(film_reflection(s, 500 / (2 * root), root, 0.99999, 1) - 0.04) < 3e-4);
  /* A quarter wave of a denser film: ((n0 ns - n^2) / (n0 ns + n^2))^2. */
  double n = 2.2, expected = pow((1.5 - n * n) / (1.5 + n * n), 2);
  assert_true(
      fabs(film_reflection(s, (float)(500 / (4 * n)), (float)n, 0.99999, 1) - expected) < 2e-3);
}

/* A layer of weight 0 gives the same bits, whatever its other parameters. */
static void off_is_off(void **state) {
  State *s = *state;
  Batch *a = s->batch, *b = s->other;
  Look look = {.roughness = 0.4f, .metallic = 0.2f, .base = 0.8f};
  float plain[VL_BSDF_ROWS], other[VL_BSDF_ROWS];
  Surface surface = surface_of(&look, plain), same = surface_of(&look, other);
  other[VL_P_COAT_ALPHA] = 0.3f;
  other[VL_P_COAT_X] = 0.6f;
  other[VL_P_COAT_Z] = 0.8f;
  other[VL_P_SHEEN_ALPHA] = 0.2f;
  other[VL_P_FILM_NM] = 700;
  other[VL_P_FILM_INDEX] = 2;
  statRng rng = stat_rng(9);
  for (uint32_t j = 0; j < BATCH; j++) {
    double d[3];
    stat_direction(&rng, d);
    batch_surface(a, j, &surface);
    batch_surface(b, j, &same);
    a->ox[j] = b->ox[j] = (float)d[0];
    a->oy[j] = b->oy[j] = (float)d[1];
    a->oz[j] = b->oz[j] = (float)d[2];
  }
  batch_numbers(a, BATCH, &rng);
  memcpy(b->lobe, a->lobe, sizeof a->lobe);
  memcpy(b->u, a->u, sizeof a->u);
  memcpy(b->v, a->v, sizeof a->v);
  batch_sample(s->kernels, VL_BSDF_PRINCIPLED, BATCH, a);
  batch_sample(s->kernels, VL_BSDF_PRINCIPLED, BATCH, b);
  assert_memory_equal(a->weight, b->weight, sizeof a->weight);
  assert_memory_equal(a->pdf, b->pdf, sizeof a->pdf);
  assert_memory_equal(a->ix, b->ix, sizeof a->ix);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(furnace),
                                     cmocka_unit_test(metals_reflect_again),
                                     cmocka_unit_test(mixtures_keep_what_is_told),
                                     cmocka_unit_test(reciprocity),
                                     cmocka_unit_test(chi_square),
                                     cmocka_unit_test(sampled_is_evaluated),
                                     cmocka_unit_test(thin_film),
                                     cmocka_unit_test(off_is_off)};
  return cmocka_run_group_tests(tests, setup, teardown);
}
