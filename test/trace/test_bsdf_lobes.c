/* test_bsdf_lobes.c: microfacet lobes of any sharpness, also at grazing angles. Chi-square
 * tests and integrals are not over the sphere, where a lobe of alpha 0.001 is nearly a point,
 * but over the microfacets' slopes divided by the alphas, where all lobes have the same size. A
 * slope (x, y) of radius r maps to the point (r^2 / (1 + r^2), azimuth): the plane becomes a
 * rectangle on which the distribution of normals is constant. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "unit.h"

typedef struct Lobe {
  const State *s;
  Surface surface;
  double alpha_x, alpha_y; /* of the lobe under test */
  double eta;  /* refraction: index beyond over index on the side of o; 0: reflection */
  double o[3]; /* on the upper side */
  double side; /* -1: what the kernel is asked lies below */
} Lobe;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The microfacet that sends o to w, in the rectangle; false: none can. */
static bool place(const Lobe *l, const double w[3], double *x, double *y) {
  double h[3], n = l->eta > 0 ? l->eta : 1;
  for (int k = 0; k < 3; k++)
    h[k] = l->o[k] + n * w[k];
  double sign = h[2] < 0 ? -1 : 1;
  double p = h[0] / h[2] / l->alpha_x, q = h[1] / h[2] / l->alpha_y, r2 = p * p + q * q;
  for (int k = 0; k < 3; k++)
    h[k] *= sign;
  if (!(dot(h, l->o) > 0))
    return false;
  *x = r2 / (1 + r2);
  *y = atan2(q, p);
  return true;
}

/* Density over the rectangle. */
static double density(void *user, double x, double y) {
  Lobe *l = user;
  Batch *b = l->s->other;
  double r = sqrt(x / (1 - x)), p = r * cos(y) * l->alpha_x, q = r * sin(y) * l->alpha_y;
  double z = 1 / sqrt(1 + p * p + q * q), h[3] = {p * z, q * z, z}, c = dot(l->o, h), w[3],
         stretch;
  if (c <= 0)
    return 0;
  if (l->eta > 0) {
    double inside = l->eta * l->eta - 1 + c * c;
    if (inside <= 0)
      return 0;
    double cos_t = sqrt(inside) / l->eta;
    for (int k = 0; k < 3; k++)
      w[k] = -l->o[k] / l->eta + (c / l->eta - cos_t) * h[k];
    if (w[2] >= 0)
      return 0;
    double sum = c - l->eta * cos_t;
    stretch = sum * sum / (l->eta * l->eta * cos_t);
  } else {
    for (int k = 0; k < 3; k++)
      w[k] = 2 * c * h[k] - l->o[k];
    if (w[2] <= 0)
      return 0;
    stretch = 4 * c;
  }
  b->ix[0] = (float)w[0];
  b->iy[0] = (float)w[1];
  b->iz[0] = (float)(l->side * w[2]);
  batch_eval(l->s->kernels, l->surface.kind, 1, b);
  return (double)b->pdf[0] * stretch * z * z * z * l->alpha_x * l->alpha_y * 0.5 /
         ((1 - x) * (1 - x));
}

/* Adds the samples; returns the share that are in the lobe. grid null: strata of (u, v) instead
 * of random numbers. */
static double sample(const Lobe *l, statGrid *grid, double edge, uint64_t seed, double *none) {
  Batch *b = l->s->batch;
  statRng rng = stat_rng(seed);
  double count = 0, in = 0;
  *none = 0;
  for (uint32_t j = 0; j < BATCH; j++) {
    batch_surface(b, j, &l->surface);
    b->ox[j] = (float)l->o[0];
    b->oy[j] = (float)l->o[1];
    b->oz[j] = (float)(l->side * l->o[2]);
    b->seed[j] = (uint32_t)stat_bits(&rng);
  }
  for (uint32_t turn = 0; turn < 64; turn++) {
    batch_numbers(b, BATCH, &rng);
    for (uint32_t j = 0; j < BATCH && !grid; j++) {
      uint32_t i = turn * BATCH + j;
      b->u[j] = ((float)(i % 256) + b->u[j]) / 256;
      b->v[j] = ((float)(i / 256) + b->v[j]) / 256;
      b->lobe[j] =
          (float)fmod((double)b->lobe[j] / 64 + (double)((j * 37 + turn * 11) % 64) / 64, 1.0);
    }
    batch_sample(l->s->kernels, l->surface.kind, BATCH, b);
    for (uint32_t j = 0; j < BATCH; j++) {
      double w[3] = {(double)b->ix[j], (double)b->iy[j], l->side * (double)b->iz[j]}, x = 2,
             y = 0;
      count++;
      *none += (b->flags[j] & VL_SAMPLED_NONE) != 0;
      bool ours = !(b->flags[j] & (VL_SAMPLED_NONE | VL_SAMPLED_SPECULAR)) &&
                  (w[2] < 0) == (l->eta > 0) && place(l, w, &x, &y) && x < edge;
      in += ours;
      if (grid && ours)
        stat_grid_add(grid, x, y);
      else if (grid)
        stat_grid_reject(grid);
    }
  }
  *none /= count;
  return in / count;
}

enum { TESTS = 400 }; /* more than the number of tests made */

static void look_at(Lobe *l, const char *name, double edge, uint64_t seed) {
  for (uint32_t j = 0; j < VL_LANES; j++) {
    batch_surface(l->s->other, j, &l->surface);
    l->s->other->ox[j] = (float)l->o[0];
    l->s->other->oy[j] = (float)l->o[1];
    l->s->other->oz[j] = (float)(l->side * l->o[2]);
  }
  double none, error = 6e-4; /* of the strata */
  statGrid *grid = stat_grid_new(16, 16, 0, edge, -PI, PI);
  sample(l, grid, edge, seed, &none);
  statResult r = stat_grid_test(grid, density, l, 6e-6);
  double share = sample(l, NULL, edge, seed, &none);
  if (!stat_accept(r, TESTS) || !(fabs(r.integral - share) < 1e-3 + error))
    fail_msg(
        "%s, alpha %g %g, cos %g%s: p %g, density integrates to %.5f, share of the samples "
        "%.5f (%.4f lost)",
        name, l->alpha_x, l->alpha_y, l->o[2], l->eta > 0 ? ", through" : "", r.p, r.integral,
        share, none);
}

static const double alphas[][2] = {{0.001, 0.001}, {0.01, 0.01}, {0.3, 0.3},
                                   {1, 1},         {0.01, 0.9},  {0.9, 0.01}};
static const double cosines[] = {0.999, 0.5, 0.1, 0.02};
enum { ALPHAS = 6, COSINES = 4 };

static Lobe lobe_of(const State *s, int a, int c) {
  double z = cosines[c], r = sqrt(1 - z * z);
  return (Lobe){.s = s,
                .alpha_x = alphas[a][0],
                .alpha_y = alphas[a][1],
                .o = {r * cos(0.7), r * sin(0.7), z},
                .side = (a + c) % 3 == 0 ? -1 : 1,
                .surface = {.alpha_x = (float)alphas[a][0], .alpha_y = (float)alphas[a][1]}};
}

static void conductor(void **state) {
  for (int a = 0; a < ALPHAS; a++)
    for (int c = 0; c < COSINES; c++) {
      Lobe l = lobe_of(*state, a, c);
      l.surface.kind = VL_BSDF_CONDUCTOR;
      l.surface.eta = 0.2f;
      l.surface.k = 3;
      look_at(&l, "conductor", 0.9999, (uint64_t)(a * COSINES + c));
    }
}

static void dielectric(void **state) {
  for (int a = 0; a < ALPHAS; a++)
    for (int c = 0; c < COSINES; c++)
      for (int way = 0; way < 4; way++) { /* both sides of the surface, both of the lobe */
        Lobe l = lobe_of(*state, a, c);
        double eta = a % 2 ? 1.5 : 1.8;
        l.surface.kind = VL_BSDF_DIELECTRIC;
        l.surface.eta_s = (float)eta;
        l.side = way & 1 ? -1 : 1;
        l.eta = way & 2 ? (l.side < 0 ? 1 / eta : eta) : 0;
        look_at(&l, "dielectric", way & 2 ? 0.99 : 0.9999,
                (uint64_t)(100 + (a * COSINES + c) * 4 + way));
      }
}

/* Coats: only the lobe of the coat itself; light from below it is ignored. */
static void coats(void **state) {
  const State *s = *state;
  for (int a = 0; a < ALPHAS; a++) {
    float mean = (float)sqrt(alphas[a][0] * alphas[a][1]);
    vlCoatTable *table;
    assert_int_equal(vl_coat_build(s->context, 1.5f, 0.1f, 10, mean, mean, &table), VL_OK);
    for (int c = 0; c < COSINES; c++) {
      Lobe l = lobe_of(s, a, c);
      l.surface.kind = VL_BSDF_COATED_DIFFUSE;
      l.surface.eta_s = 1.5f;
      l.surface.reflectance = 0.5f;
      l.surface.coat = table;
      look_at(&l, "coated diffuse", 0.9, (uint64_t)(300 + a * COSINES + c));
      float rows[VL_BSDF_ROWS] = {
          [VL_L_BASE_X] = 0.3f, [VL_L_BASE_Y] = 0.3f, [VL_L_THICKNESS] = 0.2f};
      rows[VL_L_DEPTH] = 10;
      rows[VL_L_WALKS] = 1;
      for (int metal = 0; metal < 2; metal++) {
        rows[VL_L_METAL] = (float)metal;
        l.surface.kind = VL_BSDF_LAYERED;
        l.surface.eta = 0.2f;
        l.surface.k = 3;
        l.surface.own = rows;
        look_at(&l, metal ? "coated conductor" : "walked coat", 0.9,
                (uint64_t)(400 + a * COSINES + c));
      }
    }
    vl_coat_free(s->context, table);
  }
}

/* The principled material's metal lobe, with a little of each other lobe. */
static void principled(void **state) {
  for (int a = 0; a < ALPHAS; a++)
    for (int c = 0; c < COSINES; c++) {
      Lobe l = lobe_of(*state, a, c);
      float rows[VL_BSDF_ROWS] = {
          [VL_P_METALLIC] = 0.8f, [VL_P_F90] = 1, [VL_P_THIN] = 1, [VL_P_COAT_Z] = 1};
      for (int k = 0; k < 4; k++)
        rows[VL_P_F0 + k] = 0.04f;
      rows[VL_P_COAT] = 0.3f;
      rows[VL_P_COAT_ALPHA] = 0.4f;
      rows[VL_P_SHEEN_ALPHA] = 0.3f;
      rows[VL_P_FILM_INDEX] = 1.3f;
      l.surface.kind = VL_BSDF_PRINCIPLED;
      l.surface.eta_s = 1.5f;
      l.surface.reflectance = 0.8f;
      l.surface.own = rows;
      look_at(&l, "principled", 0.9, (uint64_t)(500 + a * COSINES + c));
    }
}

/* f is symmetric to 1e-4: the precision of a sharp lobe's half vector in floats. */
static void reciprocity(void **state) {
  const State *s = *state;
  Batch *b = s->batch, *c = s->other;
  const vlBsdfKind kinds[] = {VL_BSDF_CONDUCTOR, VL_BSDF_DIELECTRIC, VL_BSDF_COATED_DIFFUSE,
                              VL_BSDF_PRINCIPLED};
  float rows[VL_BSDF_ROWS] = {
      [VL_P_METALLIC] = 0.8f, [VL_P_F90] = 1, [VL_P_THIN] = 1, [VL_P_COAT_Z] = 1};
  for (int k = 0; k < 4; k++)
    rows[VL_P_F0 + k] = 0.04f;
  rows[VL_P_COAT_ALPHA] = 0.4f;
  rows[VL_P_SHEEN_ALPHA] = 0.3f;
  rows[VL_P_FILM_INDEX] = 1.3f;
  statRng rng = stat_rng(77);
  for (int a = 1; a < ALPHAS; a++) {
    vlCoatTable *table;
    float mean = (float)sqrt(alphas[a][0] * alphas[a][1]);
    assert_int_equal(vl_coat_build(s->context, 1.5f, 0.1f, 10, mean, mean, &table), VL_OK);
    for (int k = 0; k < 4; k++) {
      Surface surface = {.kind = kinds[k],
                         .eta = 0.2f,
                         .k = 3,
                         .reflectance = 0.6f,
                         .eta_s = 1.5f,
                         .coat = table};
      if (kinds[k] == VL_BSDF_PRINCIPLED)
        surface.own = rows;
      surface.alpha_x = (float)alphas[a][0];
      surface.alpha_y = (float)alphas[a][1];
      /* pairs of directions where the lobe is not 0: sampled ones */
      for (uint32_t j = 0; j < BATCH; j++) {
        double o[3];
        stat_direction(&rng, o);
        batch_surface(b, j, &surface);
        b->ox[j] = (float)o[0];
        b->oy[j] = (float)o[1];
        b->oz[j] = (float)o[2];
      }
      batch_numbers(b, BATCH, &rng);
      batch_sample(s->kernels, kinds[k], BATCH, b);
      *c = *b;
      memcpy(c->ox, b->ix, sizeof b->ix);
      memcpy(c->oy, b->iy, sizeof b->iy);
      memcpy(c->oz, b->iz, sizeof b->iz);
      memcpy(c->ix, b->ox, sizeof b->ox);
      memcpy(c->iy, b->oy, sizeof b->oy);
      memcpy(c->iz, b->oz, sizeof b->oz);
      uint32_t flags[BATCH];
      memcpy(flags, b->flags, sizeof flags);
      batch_eval(s->kernels, kinds[k], BATCH, b);
      batch_eval(s->kernels, kinds[k], BATCH, c);
      double worst = 0;
      int seen = 0;
      for (uint32_t j = 0; j < BATCH; j++) {
        if (flags[j] & (VL_SAMPLED_NONE | VL_SAMPLED_SPECULAR) || fabsf(b->oz[j]) < 0.05f ||
            fabsf(b->iz[j]) < 0.05f)
          continue;
        double f = (double)(b->value[2][j] / fabsf(b->iz[j])),
               g = (double)(c->value[2][j] / fabsf(b->oz[j]));
        double n = kinds[k] == VL_BSDF_DIELECTRIC ? 1.5 : 1;
        f *= b->iz[j] < 0 ? n * n : 1;
        g *= b->oz[j] < 0 ? n * n : 1;
        /* near the critical angle F is steep without bound: half of the cosine's digits are
         * lost */
        bool through = b->oz[j] * b->iz[j] < 0,
             inside = kinds[k] == VL_BSDF_DIELECTRIC && b->oz[j] < 0 && !through;
        double cos2 =
            0.5 *
            (1 + (double)(b->ox[j] * b->ix[j] + b->oy[j] * b->iy[j] + b->oz[j] * b->iz[j]));
        if (inside && fabs(1 / (n * n) - 1 + cos2) < 0.01)
          continue;
        worst = fmax(worst, fabs(f - g) / (f + (through ? 1e-2 : 1e-3)));
        seen += f > 0;
      }
      if (!(worst < 1e-4))
        fail_msg("kind %d, alphas %d: not reciprocal by %g", k, a, worst);
      if (seen < 300)
        fail_msg("kind %d, alphas %d: only %d seen", k, a, seen);
    }
    vl_coat_free(s->context, table);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(conductor), cmocka_unit_test(dielectric),
                                     cmocka_unit_test(coats), cmocka_unit_test(principled),
                                     cmocka_unit_test(reciprocity)};
  return cmocka_run_group_tests(tests, setup, teardown);
}
