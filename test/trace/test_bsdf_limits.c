/* test_bsdf_limits.c: invariants of BSDFs: equal bits on all instruction sets, no NaN for
 * degenerate input, reciprocity, pbrt's special cases. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "measured_file.h"
#include "unit.h"

/* Measured materials, which build_all makes. */
static vlMeasured *measured[2];

static int build_all(void **state) {
  if (setup(state))
    return 1;
  State *s = *state;
  const float alphas[4][2] = {{0, 0}, {0.1f, 0.1f}, {0.0f, 0.6f}, {0.4f, 0.4f}};
  for (int i = 0; i < 4; i++)
    if (vl_coat_build(s->context, 1.5f, 0.01f, i == 3 ? 1000 : 10, alphas[i][0], alphas[i][1],
                      &s->coats[i]))
      return 1;
  if (vl_coat_conserve(s->context, s->coats[3]))
    return 1;
  const char *path = VELO_BINARY_DIR "/limits.bsdf";
  for (int i = 0; i < 2; i++) {
    mfSurface metal = mf_surface(0.3, i ? 0.1 : 0.3);
    metal.nodes = metal.samples = 16;
    metal.parts = i ? 4 : 1;
    mfFile file = mf_measure(&metal);
    if (!mf_write(path, &file) || vl_measured_read(s->context, path, false, &measured[i], NULL))
      return 1;
    free(file.bytes);
  }
  remove(path);
  return 0;
}
static int free_all(void **state) {
  State *s = *state;
  for (int i = 0; i < 2; i++)
    vl_measured_free(s->context, measured[i]);
  return teardown(state);
}

/* ---- reciprocity ---- */

static void reciprocity(void **state) {
  const State *s = *state;
  Batch *b = s->batch, *c = s->other;
  float through[VL_BSDF_ROWS] = {0};
  through[VL_T_TRANSMITTANCE + 2] = 0.7f;
  const Surface all[] = {
      {.kind = VL_BSDF_DIFFUSE, .reflectance = 0.7f},
      {.kind = VL_BSDF_DIFFUSE_TRANSMISSION, .reflectance = 0.2f, .own = through},
      {.kind = VL_BSDF_CONDUCTOR, .eta = 0.2f, .k = 3.9f, .alpha_x = 0.2f, .alpha_y = 0.5f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f, .alpha_x = 0.4f, .alpha_y = 0.3f},
      {.kind = VL_BSDF_COATED_DIFFUSE, .reflectance = 0.6f, .eta_s = 1.5f, .coat = s->coats[0]},
      {.kind = VL_BSDF_COATED_DIFFUSE,
       .reflectance = 0.6f,
       .eta_s = 1.5f,
       .alpha_x = 0.3f,
       .alpha_y = 0.1f,
       .coat = s->coats[2]}};
  statRng rng = stat_rng(9);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    double worst = 0;
    int seen = 0;
    for (uint32_t j = 0; j < BATCH; j++) {
      double o[3], w[3];
      stat_direction(&rng, o);
      stat_direction(&rng, w);
      batch_surface(b, j, &all[i]);
      b->ox[j] = (float)o[0];
      b->oy[j] = (float)o[1];
      b->oz[j] = (float)o[2];
      b->ix[j] = (float)w[0];
      b->iy[j] = (float)w[1];
      b->iz[j] = (float)w[2];
    }
    *c = *b;
    memcpy(c->ox, b->ix, sizeof b->ix);
    memcpy(c->oy, b->iy, sizeof b->iy);
    memcpy(c->oz, b->iz, sizeof b->iz);
    memcpy(c->ix, b->ox, sizeof b->ox);
    memcpy(c->iy, b->oy, sizeof b->oy);
    memcpy(c->iz, b->oz, sizeof b->oz);
    batch_eval(s->kernels, all[i].kind, BATCH, b);
    batch_eval(s->kernels, all[i].kind, BATCH, c);
    for (uint32_t j = 0; j < BATCH; j++) {
      if (fabsf(b->oz[j]) < 0.02f || fabsf(b->iz[j]) < 0.02f)
        continue;
      double f = (double)(b->value[2][j] / fabsf(b->iz[j])),
             g = (double)(c->value[2][j] / fabsf(b->oz[j]));
      /* radiance divided by the squared index of its medium is conserved: f(wo, wi) n_i^2 =
       * f(wi, wo) n_o^2 */
      double n = all[i].kind == VL_BSDF_DIELECTRIC ? (double)all[i].eta_s : 1;
      f *= b->iz[j] < 0 ? n * n : 1;
      g *= b->oz[j] < 0 ? n * n : 1;
      /* near the critical angle 1 - F is mostly rounding error */
      double off = fabs(f - g) / (fabs(f) + 1e-2);
      if (!(off < worst))
        worst = off;
      seen += f > 0;
    }
    if (!(worst < 3e-4))
      fail_msg("surface %zu: not reciprocal by %g", i, worst);
    assert_true(seen > 300);
  }
}

/* ---- bits and NaN ---- */

static float pick(statRng *rng, const float *values, size_t count) {
  return values[stat_bits(rng) % count];
}
/* Random lanes, one in eight of them degenerate somehow. Directions are finite and at most unit
 * length. */
static void fill(const State *s, Batch *b, statRng *rng, vlBsdfKind kind) {
  const float alphas[] = {0, 1e-5f, 9.99e-4f, 1e-3f, 0.01f, 0.1f, 0.5f, 1};
  const float etas[] = {1.5f, 1 / 1.5f, 1, 1.0001f, 2.4f, 4, 0.3f},
              ks[] = {0, 0.1f, 3.9f, 9, 1e7f, 1e20f};
  const float small[] = {0, -0.0f, 1e-42f, -1e-42f, 1e-30f, 1e-7f, -1e-7f, 1, -1, 0.7f},
              edges[] = {0, 0.5f, 0x1.fffffep-1f};
  for (uint32_t j = 0; j < BATCH; j++) {
    for (int c = 0; c < 4; c++) {
      b->reflectance[c][j] =
          stat_bits(rng) & 7 ? stat_float(rng) : pick(rng, (float[]){0, 1}, 2);
      b->eta[c][j] = stat_bits(rng) & 7 ? 0.1f + 3 * stat_float(rng) : pick(rng, ks, 6);
      b->k[c][j] = stat_bits(rng) & 7 ? 5 * stat_float(rng) : pick(rng, ks, 6);
    }
    b->alpha_x[j] = stat_bits(rng) & 1 ? stat_float(rng) : pick(rng, alphas, 8);
    b->alpha_y[j] = stat_bits(rng) & 1 ? b->alpha_x[j] : pick(rng, alphas, 8);
    b->eta_s[j] = pick(rng, etas, 7);
    for (int k = 0; k < VL_BSDF_ROWS; k++)
      b->own[k][j] = stat_bits(rng) & 3 ? stat_float(rng) : (float)(stat_bits(rng) & 1);
    for (int c = 0; c < 4; c++)
      b->lambda[c][j] = 360 + 470 * stat_float(rng);
    b->own[VL_P_THIN][j] = (float)(stat_bits(rng) & 1);
    b->own[VL_P_FILM_INDEX][j] = 1 + stat_float(rng);
    b->own[VL_P_FILM_NM][j] = stat_bits(rng) & 3 ? 1000 * stat_float(rng) : 0;
    double n[3];
    stat_direction(rng, n);
    b->own[VL_P_COAT_X][j] = (float)n[0];
    b->own[VL_P_COAT_Y][j] = (float)n[1];
    b->own[VL_P_COAT_Z][j] = (float)fabs(n[2]);
    if (kind == VL_BSDF_LAYERED) {
      b->own[VL_L_BASE_X][j] = pick(rng, alphas, 8);
      b->own[VL_L_BASE_Y][j] = pick(rng, alphas, 8);
      b->own[VL_L_DEPTH][j] = 10;
      b->own[VL_L_WALKS][j] = 1;
    }
    b->seed[j] = (uint32_t)stat_bits(rng);
    b->coat[j] = s->coats[stat_bits(rng) % 4];
    b->measured[j] = measured[stat_bits(rng) % 2];
    double o[3], w[3];
    stat_direction(rng, o);
    stat_direction(rng, w);
    b->ox[j] = (float)o[0];
    b->oy[j] = (float)o[1];
    b->oz[j] = (float)o[2];
    b->ix[j] = (float)w[0];
    b->iy[j] = (float)w[1];
    b->iz[j] = (float)w[2];
    if (!(stat_bits(rng) & 7)) {
      b->ox[j] = pick(rng, small, 10);
      b->oy[j] = pick(rng, small, 7);
      b->oz[j] = pick(rng, small, 9);
    }
    if (!(stat_bits(rng) & 7)) {
      b->ix[j] = pick(rng, small, 10);
      b->iy[j] = pick(rng, small, 7);
      b->iz[j] = pick(rng, small, 9);
    }
    if (!(stat_bits(rng) & 7)) { /* no half vector */
      b->ix[j] = -b->ox[j];
      b->iy[j] = -b->oy[j];
      b->iz[j] = -b->oz[j];
    }
    if (!(stat_bits(rng) & 15)) { /* mirror */
      b->ix[j] = -b->ox[j];
      b->iy[j] = -b->oy[j];
      b->iz[j] = b->oz[j];
    }
  }
  batch_numbers(b, BATCH, rng);
  for (uint32_t j = 0; j < BATCH; j += 9) {
    b->lobe[j] = pick(rng, edges, 3);
    b->u[j] = pick(rng, edges, 3);
    b->v[j] = pick(rng, edges, 3);
  }
}

static void never_nan(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  statRng rng = stat_rng(21);
  for (int turn = 0; turn < 1000; turn++) {
    vlBsdfKind kind = (vlBsdfKind)(turn % VL_BSDF_KIND_COUNT);
    fill(s, b, &rng, kind);
    batch_eval(s->kernels, kind, BATCH, b);
    for (uint32_t j = 0; j < BATCH; j++)
      for (int c = 0; c < 5; c++) {
        float x = c < 4 ? b->value[c][j] : b->pdf[j];
        if (!(x >= 0 && x < INFINITY))
          fail_msg("kind %d eval %g: wo %g %g %g wi %g %g %g alpha %g %g eta %g", kind,
                   (double)x, (double)b->ox[j], (double)b->oy[j], (double)b->oz[j],
                   (double)b->ix[j], (double)b->iy[j], (double)b->iz[j], (double)b->alpha_x[j],
                   (double)b->alpha_y[j], (double)b->eta_s[j]);
      }
    batch_sample(s->kernels, kind, BATCH, b);
    for (uint32_t j = 0; j < BATCH; j++) {
      bool none = b->flags[j] & VL_SAMPLED_NONE;
      for (int c = 0; c < 6; c++) {
        float x = c < 4 ? b->weight[c][j] : c == 4 ? b->pdf[j] : b->scale[j];
        if (!(x >= 0 && x < INFINITY) || (none && c < 5 && x != 0))
          fail_msg("kind %d sample %d: %g: wo %g %g %g u %g %g %g alpha %g %g eta %g", kind, c,
                   (double)x, (double)b->ox[j], (double)b->oy[j], (double)b->oz[j],
                   (double)b->lobe[j], (double)b->u[j], (double)b->v[j], (double)b->alpha_x[j],
                   (double)b->alpha_y[j], (double)b->eta_s[j]);
      }
      assert_true(none || (b->pdf[j] > 0 && isfinite(b->ix[j] + b->iy[j] + b->iz[j])));
      assert_true(b->flags[j] < 2 * VL_SAMPLED_DIFFUSE && (b->oz[j] != 0 || none));
    }
  }
}

static void same_bits(void **state) {
  const State *s = *state;
#ifdef VL_LOWEST_SET_ONLY
  skip(); /* the build has one set */
#endif
  const vlBsdfKernels *base = vl_bsdf_kernels(VL_ISA_BASE);
  int compared = 0;
  for (int isa = VL_ISA_V3; isa <= VL_ISA_V4; isa++) {
    if ((int)vl_isa_best() < isa)
      continue;
    const vlBsdfKernels *wide = vl_bsdf_kernels((vlIsa)isa);
    assert_ptr_not_equal(base, wide);
    statRng rng = stat_rng(31);
    for (int turn = 0; turn < 100; turn++) {
      vlBsdfKind kind = (vlBsdfKind)(turn % VL_BSDF_KIND_COUNT);
      uint32_t n = turn < 50 ? BATCH : 1 + (uint32_t)(stat_bits(&rng) % BATCH);
      fill(s, s->batch, &rng, kind);
      memcpy(s->other, s->batch, sizeof *s->batch);
      batch_eval(base, kind, n, s->batch);
      batch_eval(wide, kind, n, s->other);
      assert_memory_equal(s->batch->value[0], s->other->value[0], n * 4);
      assert_memory_equal(s->batch->value[3], s->other->value[3], n * 4);
      assert_memory_equal(s->batch->pdf, s->other->pdf, n * 4);
      batch_sample(base, kind, n, s->batch);
      batch_sample(wide, kind, n, s->other);
      assert_memory_equal(s->batch->ix, s->other->ix, n * 4);
      assert_memory_equal(s->batch->iz, s->other->iz, n * 4);
      assert_memory_equal(s->batch->weight[0], s->other->weight[0], n * 4);
      assert_memory_equal(s->batch->weight[3], s->other->weight[3], n * 4);
      assert_memory_equal(s->batch->pdf, s->other->pdf, n * 4);
      assert_memory_equal(s->batch->flags, s->other->flags, n * 4);
      assert_memory_equal(s->batch->scale, s->other->scale, n * 4);
    }
    compared++;
  }
  if (!compared)
    print_message("only one instruction set here: nothing to compare\n");
}

/* The bits of a lane depend only on that lane, not on its position, its neighbours or the
 * length of the batch. */
static void lanes_alone(void **state) {
  const State *s = *state;
  Batch *b = s->batch, *c = s->other;
  statRng rng = stat_rng(41);
  for (int k = 0; k < VL_BSDF_KIND_COUNT; k++) {
    vlBsdfKind kind = (vlBsdfKind)k;
    fill(s, b, &rng, kind);
    *c = *b;
    for (uint32_t j = 0; j < 600; j++) { /* reversed, and a shorter batch */
      uint32_t i = 599 - j;
      for (int d = 0; d < 4; d++) {
        c->reflectance[d][j] = b->reflectance[d][i];
        c->eta[d][j] = b->eta[d][i];
        c->k[d][j] = b->k[d][i];
      }
      for (int d = 0; d < 4; d++)
        c->lambda[d][j] = b->lambda[d][i];
      for (int r = 0; r < VL_BSDF_ROWS; r++)
        c->own[r][j] = b->own[r][i];
      c->alpha_x[j] = b->alpha_x[i];
      c->alpha_y[j] = b->alpha_y[i];
      c->eta_s[j] = b->eta_s[i];
      c->coat[j] = b->coat[i];
      c->ox[j] = b->ox[i];
      c->oy[j] = b->oy[i];
      c->oz[j] = b->oz[i];
      c->measured[j] = b->measured[i];
      c->lobe[j] = b->lobe[i];
      c->u[j] = b->u[i];
      c->v[j] = b->v[i];
      c->seed[j] = b->seed[i];
    }
    for (uint32_t j = 600; j < BATCH; j++) { /* garbage behind the batch */
      c->coat[j] = NULL;
      c->measured[j] = NULL;
      c->ox[j] = NAN;
      c->alpha_x[j] = NAN;
    }
    batch_sample(s->kernels, kind, BATCH, b);
    batch_sample(s->kernels, kind, 600, c);
    for (uint32_t j = 0; j < 600; j++) {
      assert_true(memcmp(&b->weight[1][599 - j], &c->weight[1][j], 4) == 0);
      assert_true(memcmp(&b->iy[599 - j], &c->iy[j], 4) == 0 &&
                  b->flags[599 - j] == c->flags[j]);
    }
  }
}

/* ---- special cases ---- */

enum { LANES = 16 };

/* The surface, seen from the angle theta from its normal, in all lanes. */
static void fill_lanes(Batch *b, const Surface *surface, double theta) {
  for (uint32_t j = 0; j < LANES; j++) {
    batch_surface(b, j, surface);
    batch_wo(b, j, theta, 0);
  }
}

/* Glass reflects 4 %; a pane of it 2R / (1 + R); light that leaves glass is spread again. Lanes
 * 0 and 1 transmit, 2 and 3 reflect; odd lanes are inside. */
static void glass_at_normal_incidence(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  const Surface glass = {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f},
                pane = {.kind = VL_BSDF_THIN_DIELECTRIC, .eta_s = 1.5f};
  for (uint32_t j = 0; j < LANES; j++) {
    batch_surface(b, j, &glass);
    batch_wo(b, j, j & 1 ? 3.14159265358979 : 0.0, 0);
    b->lobe[j] = j & 2 ? 0.03f : 0.05f;
    b->u[j] = b->v[j] = 0.4f;
  }
  batch_sample(s->kernels, VL_BSDF_DIELECTRIC, LANES, b);
  assert_true(fabsf(b->pdf[2] - 0.04f) < 1e-6f && b->flags[2] == VL_SAMPLED_SPECULAR &&
              b->weight[0][2] == 1 && b->iz[2] == 1);
  assert_true(fabsf(b->pdf[0] - 0.96f) < 1e-6f && b->iz[0] == -1 &&
              fabsf(b->weight[0][0] * 2.25f - 1) < 1e-6f);
  assert_true(b->flags[0] == (VL_SAMPLED_SPECULAR | VL_SAMPLED_TRANSMISSION) &&
              fabsf(b->scale[0] - 2.25f) < 1e-6f);
  assert_true(b->iz[1] == 1 && fabsf(b->weight[0][1] - 2.25f) < 1e-5f &&
              fabsf(b->scale[1] * 2.25f - 1) < 1e-6f);
  for (uint32_t j = 0; j < LANES; j++)
    batch_surface(b, j, &pane);
  batch_sample(s->kernels, VL_BSDF_THIN_DIELECTRIC, LANES, b);
  assert_true(fabsf(b->pdf[2] - 0.08f / 1.04f) < 1e-6f && b->weight[0][2] == 1 &&
              b->scale[0] == 1);
}

static void total_reflection_transmits_nothing(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  const Surface glass = {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f};
  fill_lanes(b, &glass, 3.14159265358979 - 0.75);
  for (uint32_t j = 0; j < LANES; j++)
    b->lobe[j] = 0.9999f;
  batch_sample(s->kernels, VL_BSDF_DIELECTRIC, LANES, b);
  assert_true(b->flags[0] == VL_SAMPLED_SPECULAR && b->pdf[0] == 1 && b->iz[0] < 0);
}

/* By the textbook's formula; a mirror, and just rough enough to be none. */
static void gold_at_normal_incidence(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  const float alphas[2] = {9.9e-4f, 1e-3f};
  const double n = 0.2, k = 3.9;
  const double r = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
  for (int rough = 0; rough < 2; rough++) {
    const Surface gold = {.kind = VL_BSDF_CONDUCTOR,
                          .eta = (float)n,
                          .k = (float)k,
                          .alpha_x = alphas[rough],
                          .alpha_y = alphas[rough]};
    fill_lanes(b, &gold, 0);
    for (uint32_t j = 0; j < LANES; j++)
      b->v[j] = 0;
    batch_sample(s->kernels, VL_BSDF_CONDUCTOR, LANES, b);
    assert_true(fabs((double)b->weight[0][0] - r) < 1e-5);
    assert_int_equal(b->flags[0], rough ? 0 : VL_SAMPLED_SPECULAR);
  }
}

/* ---- coats ---- */

static Surface coat_on(float reflectance, const vlCoatTable *table) {
  return (Surface){.kind = VL_BSDF_COATED_DIFFUSE,
                   .reflectance = reflectance,
                   .eta_s = 1.5f,
                   .alpha_x = 0.1f,
                   .alpha_y = 0.1f,
                   .coat = table};
}

/* Both directions of all lanes above a coated surface. */
static void fill_coat(Batch *b, const Surface *coat) {
  fill_lanes(b, coat, 0.5);
  for (uint32_t j = 0; j < LANES; j++) {
    b->ix[j] = 0.6f;
    b->iy[j] = 0;
    b->iz[j] = 0.8f;
  }
}

/* Odd lanes are seen from below; of every second pair the directions are on opposite sides. */
static void coats_have_two_sides(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  const Surface coat = coat_on(0.5f, s->coats[1]);
  fill_coat(b, &coat);
  for (uint32_t j = 0; j < LANES; j++) {
    if (j & 1)
      b->oz[j] = -b->oz[j];
    if ((j & 1) != (j >> 1 & 1))
      b->iz[j] = -b->iz[j];
  }
  batch_eval(s->kernels, VL_BSDF_COATED_DIFFUSE, LANES, b);
  assert_true(b->value[0][0] > 0 && b->value[0][0] == b->value[0][1] && b->value[0][2] == 0 &&
              b->pdf[3] == 0);
}

static double transmittance_of(const vlCoatTable *table, float cosine) {
  const vlCoatCell cell = vl_coat_cell(cosine);
  const float *q = table->transmittance[0] + cell.first;
  return (double)vl_coat_cubic(q[0], q[1], q[2], q[3], cell.t);
}

/* The base seen through the coat is what a black base lacks: T(o) T(i) R / (pi eta^2) times the
 * series of reflections between base and coat. */
static void coats_have_their_closed_form(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  const vlCoatTable *table = s->coats[1];
  const Surface coat = coat_on(0.5f, table), black = coat_on(0, table);
  fill_coat(b, &coat);
  batch_eval(s->kernels, VL_BSDF_COATED_DIFFUSE, LANES, b);
  const double with = (double)b->value[0][0];
  fill_coat(b, &black);
  batch_eval(s->kernels, VL_BSDF_COATED_DIFFUSE, LANES, b);
  const double base = with - (double)b->value[0][0], x = 0.5 * (double)table->back[0];
  const double series = 1 + x + x * x + x * x * x + x * x * x * x;
  const double want = transmittance_of(table, b->oz[0]) * transmittance_of(table, 0.8f) * 0.5 /
                      3.14159265358979 / 2.25 * series * 0.8;
  assert_true(fabs(base / want - 1) < 1e-5);
}

/* imitate_pbrt: values are larger, samples are unchanged. */
static void imitating_coats_are_brighter(void **state) {
  const State *s = *state;
  Batch *b = s->batch, *c = s->other;
  vlCoatTable as_pbrt = *s->coats[1];
  as_pbrt.imitate = true;
  const Surface coat = coat_on(0.5f, s->coats[1]), imitator = coat_on(0.5f, &as_pbrt);
  fill_coat(b, &coat);
  *c = *b;
  for (uint32_t j = 0; j < LANES; j++)
    batch_surface(c, j, &imitator);
  batch_eval(s->kernels, VL_BSDF_COATED_DIFFUSE, LANES, b);
  batch_eval(s->kernels, VL_BSDF_COATED_DIFFUSE, LANES, c);
  const double own = (double)b->value[0][0], imitated = (double)c->value[0][0];
  assert_true(imitated > own * 1.005 && imitated < own * 1.05 && c->pdf[0] == b->pdf[0]);
  batch_sample(s->kernels, VL_BSDF_COATED_DIFFUSE, LANES, b);
  batch_sample(s->kernels, VL_BSDF_COATED_DIFFUSE, LANES, c);
  assert_true(b->weight[0][0] > 0 && b->weight[0][0] == c->weight[0][0]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(reciprocity),
                                     cmocka_unit_test(never_nan),
                                     cmocka_unit_test(same_bits),
                                     cmocka_unit_test(lanes_alone),
                                     cmocka_unit_test(glass_at_normal_incidence),
                                     cmocka_unit_test(total_reflection_transmits_nothing),
                                     cmocka_unit_test(gold_at_normal_incidence),
                                     cmocka_unit_test(coats_have_two_sides),
                                     cmocka_unit_test(coats_have_their_closed_form),
                                     cmocka_unit_test(imitating_coats_are_brighter)};
  return cmocka_run_group_tests(tests, build_all, free_all);
}
