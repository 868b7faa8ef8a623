/* test_bsdf_furnace.c: BSDFs in a white furnace: lossless ones return everything, none returns
 * more, for any roughness, coat and angle. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "unit.h"

/* Energy that comes back from a unit of light, by channel 0; radiance scaling undone. */
static double furnace(const State *s, const Surface *surface, double theta) {
  Batch *b = s->batch;
  double sum = 0;
  enum { TURNS = 128 };
  statRng rng = stat_rng(3);
  for (int turn = 0; turn < TURNS; turn++) {
    for (uint32_t j = 0; j < BATCH; j++) {
      batch_surface(b, j, surface);
      batch_wo(b, j, theta, 0.3);
      /* strata by lobe, lattice in the square */
      b->lobe[j] = ((float)j + stat_float(&rng)) / BATCH;
      b->u[j] = ((float)turn + stat_float(&rng)) / TURNS;
      double v = (double)j * 0.6180339887498949 + (double)turn * 0.7548776662466927;
      b->v[j] = (float)(v - floor(v)) * 0.999999f;
    }
    batch_sample(s->kernels, surface->kind, BATCH, b);
    for (uint32_t j = 0; j < BATCH; j++)
      sum += (double)(b->weight[0][j] * b->scale[j]);
  }
  return sum / TURNS / BATCH;
}

static void white_furnace(void **state) {
  const State *s = *state;
  vlCoatTable *clear, *dense, *frosted;
  assert_int_equal(vl_coat_build(s->context, 1.5f, 0.0f, 1000, 0, 0, &clear), VL_OK);
  assert_int_equal(vl_coat_build(s->context, 2.4f, 0.0f, 1000, 0, 0, &dense), VL_OK);
  assert_int_equal(vl_coat_build(s->context, 1.5f, 0.01f, 1000, 0.4f, 0.4f, &frosted), VL_OK);
  float through[VL_BSDF_ROWS] = {0};
  for (int c = 0; c < 4; c++)
    through[VL_T_TRANSMITTANCE + c] = 0.7f;
  const Surface lossless[] = {
      {.kind = VL_BSDF_DIFFUSE_TRANSMISSION, .reflectance = 0.3f, .own = through},
      {.kind = VL_BSDF_DIFFUSE, .reflectance = 1},
      {.kind = VL_BSDF_CONDUCTOR, .eta = 1, .k = 1e7f},
      {.kind = VL_BSDF_CONDUCTOR, .eta = 0, .k = 2.0f}, /* real part 0: all of it comes back */
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.0f, .alpha_x = 0.3f, .alpha_y = 0.3f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 0.6f},
      {.kind = VL_BSDF_THIN_DIELECTRIC, .eta_s = 1.5f},
      {.kind = VL_BSDF_COATED_DIFFUSE, .reflectance = 1, .eta_s = 1.5f, .coat = clear},
      {.kind = VL_BSDF_COATED_DIFFUSE, .reflectance = 1, .eta_s = 2.4f, .coat = dense},
  };
  const double thetas[] = {0.0, 0.8, 1.4, 1.55, 2.0, 3.0};
  for (size_t i = 0; i < sizeof lossless / sizeof *lossless; i++)
    for (size_t t = 0; t < 6; t++) {
      double albedo = furnace(s, &lossless[i], thetas[t]);
      if (!(albedo > 0.999 && albedo < 1.001))
        fail_msg("surface %zu theta %g: albedo %g", i, thetas[t], albedo);
    }
  vl_coat_free(s->context, clear);
  vl_coat_free(s->context, dense);
  /* Rough ones lose what would scatter again, and never gain. */
  for (int a = 0; a < 12; a++) {
    float ax = (float[]){0.001f, 0.05f, 0.3f, 1.0f}[a % 4],
          ay = (float[]){0.001f, 0.4f, 0.3f}[a / 4];
    const Surface rough[] = {
        {.kind = VL_BSDF_CONDUCTOR, .eta = 0, .k = 2.0f, .alpha_x = ax, .alpha_y = ay},
        {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f, .alpha_x = ax, .alpha_y = ay},
        {.kind = VL_BSDF_COATED_DIFFUSE,
         .reflectance = 1,
         .eta_s = 1.5f,
         .alpha_x = 0.4f,
         .alpha_y = 0.4f,
         .coat = frosted}};
    for (int i = 0; i < 3; i++)
      for (size_t t = 0; t < 6; t++) {
        double albedo = furnace(s, &rough[i], thetas[t]);
        if (!(albedo > 0.1 && albedo < 1.001))
          fail_msg("rough %d alpha %g %g theta %g: %g", i, (double)ax, (double)ay, thetas[t],
                   albedo);
      }
  }
  vl_coat_free(s->context, frosted);
}

/* Rough coats that conserve energy over white, of one roughness and of a textured one. */
static void conserving_coats_lose_nothing(void **state) {
  const State *s = *state;
  const float alphas[] = {0.001f, 0.1f, 0.2f, 0.4f, 0.8f, 1.0f}, etas[] = {1.2f, 1.5f, 2.4f};
  const double thetas[] = {0.0, 0.8, 1.4, 1.55};
  vlCoatTable *tables[3][7];
  for (int e = 0; e < 3; e++)
    for (int a = 0; a < 7; a++) {
      float low = a < 6 ? alphas[a] : 0, high = a < 6 ? alphas[a] : 1;
      assert_int_equal(vl_coat_build(s->context, etas[e], 0.0f, 10, low, high, &tables[e][a]),
                       VL_OK);
      assert_int_equal(vl_coat_conserve(s->context, tables[e][a]), VL_OK);
    }
  for (int e = 0; e < 3; e++)
    for (int a = 0; a < 6; a++)
      for (int t = 0; t < 8; t++) {
        Surface white = {.kind = VL_BSDF_COATED_DIFFUSE, .reflectance = 1, .eta_s = etas[e]};
        white.alpha_x = white.alpha_y = alphas[a];
        white.coat = tables[e][t < 4 ? a : 6];
        double kept = furnace(s, &white, thetas[t % 4]);
        if (!(kept > 0.995 && kept < 1.005))
          fail_msg("eta %g alpha %g theta %g%s: %g", (double)etas[e], (double)alphas[a],
                   thetas[t % 4], t < 4 ? "" : ", textured", kept);
      }
  for (int e = 0; e < 3; e++)
    for (int a = 0; a < 7; a++)
      vl_coat_free(s->context, tables[e][a]);
}

/* Coats over white, of any index, thickness and roughness: never more than came; through a
 * thick black medium nothing but what the coat itself sends back. */
static void coats_never_gain(void **state) {
  const State *s = *state;
  const float etas[] = {0.7f, 1.01f, 1.5f, 3}, taus[] = {0, 0.1f, 20},
              alphas[] = {0, 0.01f, 0.3f, 1};
  const double thetas[] = {0.1, 1.5};
  for (int i = 0; i < 2 * 4 * 3 * 4; i++) {
    float eta = etas[i % 4], tau = taus[i / 4 % 3], alpha = alphas[i / 12 % 4];
    vlCoatTable *table;
    assert_int_equal(vl_coat_build(s->context, eta, tau, 1000, alpha, alpha, &table), VL_OK);
    if (i >= 4 * 3 * 4)
      assert_int_equal(vl_coat_conserve(s->context, table), VL_OK);
    Surface white = {.kind = VL_BSDF_COATED_DIFFUSE,
                     .reflectance = 1,
                     .eta_s = eta,
                     .alpha_x = alpha,
                     .alpha_y = alpha};
    white.coat = table;
    Surface black = white;
    black.reflectance = 0;
    for (int t = 0; t < 2; t++) {
      double all = furnace(s, &white, thetas[t]),
             coat = tau < 20 ? 0 : furnace(s, &black, thetas[t]);
      if (!(all < 1.001 && coat <= all + 1e-3 && (tau < 20 || fabs(all - coat) < 1e-3)))
        fail_msg("eta %g tau %g alpha %g theta %g: %g, its coat %g", (double)eta, (double)tau,
                 (double)alpha, thetas[t], all, coat);
    }
    vl_coat_free(s->context, table);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(white_furnace),
                                     cmocka_unit_test(conserving_coats_lose_nothing),
                                     cmocka_unit_test(coats_never_gain)};
  return cmocka_run_group_tests(tests, setup, teardown);
}
