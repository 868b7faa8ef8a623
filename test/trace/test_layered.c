/* test_layered.c: the random walks between layers: against an independent analogue walk through
 * the kernels of the interfaces, against the closed form for diffuse light, in white furnaces,
 * in both directions. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "trace/medium/phase.h"
#include "unit.h"

typedef struct {
  bool metal;
  float alpha, alpha_y /* of the coat, 0: alpha */, eta_s, base_x, base_y, thickness, albedo, g,
      eta, k, reflectance, depth;
} Stack;

static const Stack stacks[] = {
    {.metal = true,
     .eta_s = 1.5f,
     .base_x = 0.3f,
     .base_y = 0.3f,
     .eta = 0.2f,
     .k = 3,
     .depth = 10},
    {.metal = true,
     .eta_s = 1.5f,
     .alpha = 0.3f,
     .base_x = 0.1f,
     .base_y = 0.5f,
     .eta = 0.8f,
     .k = 4,
     .depth = 10},
    {.metal = true,
     .eta_s = 1.8f,
     .alpha = 0.2f,
     .eta = 0.2f,
     .k = 3,
     .thickness = 0.1f,
     .depth = 10},
    {.metal = true,
     .eta_s = 1.3f,
     .alpha = 0.5f,
     .base_x = 0.4f,
     .base_y = 0.4f,
     .eta = 0.2f,
     .k = 3,
     .thickness = 0.5f,
     .albedo = 0.8f,
     .g = 0.4f,
     .depth = 30},
    {.eta_s = 1.5f,
     .reflectance = 0.5f,
     .thickness = 0.5f,
     .albedo = 0.9f,
     .g = -0.3f,
     .depth = 30},
    {.eta_s = 1.5f,
     .alpha = 0.3f,
     .reflectance = 0.8f,
     .thickness = 0.05f,
     .albedo = 0.3f,
     .depth = 10},
    {.metal = true,
     .eta_s = 1.5f,
     .eta = 0.2f,
     .k = 3,
     .thickness = 0.2f,
     .albedo = 0.9f,
     .depth = 30},
    {.metal = true, .eta_s = 1.5f, .eta = 0.2f, .k = 3, .thickness = 0.2f, .depth = 10},
};
enum { STACKS = sizeof stacks / sizeof *stacks };

static void put(Batch *b, uint32_t i, const Stack *t, uint32_t seed) {
  float rows[VL_BSDF_ROWS] = {0};
  rows[VL_L_METAL] = t->metal ? 1.0f : 0.0f;
  rows[VL_L_BASE_X] = t->base_x;
  rows[VL_L_BASE_Y] = t->base_y;
  rows[VL_L_THICKNESS] = t->thickness;
  rows[VL_L_G] = t->g;
  for (int c = 0; c < 4; c++)
    rows[VL_L_ALBEDO + c] = t->albedo;
  rows[VL_L_DEPTH] = t->depth;
  rows[VL_L_WALKS] = 1;
  Surface s = {.reflectance = t->reflectance,
               .eta = t->eta,
               .k = t->k,
               .alpha_x = t->alpha,
               .alpha_y = t->alpha_y > 0 ? t->alpha_y : t->alpha,
               .eta_s = t->eta_s,
               .own = rows};
  batch_surface(b, i, &s);
  b->seed[i] = seed;
}

/* ---- against nature ---------------------------------------------------------------------- */

enum { CELLS = 13 }; /* 3 rings of 4 sectors, and the whole */
typedef struct {
  double sum[CELLS], square[CELLS], count;
} Tally;
static void tally(Tally *t, float x, float y, float z, float weight) {
  const int ring = (z >= 0.5f) + (z >= 0.85f);
  const int sector = (int)((atan2((double)y, (double)x) / (2 * PI) + 0.5) * 3.9999);
  const int cells[2] = {ring * 4 + sector, CELLS - 1};
  for (int k = 0; k < 2; k++) {
    t->sum[cells[k]] += (double)weight;
    t->square[cells[k]] += (double)(weight * weight);
  }
}

/* ---- light paths through the layers ------------------------------------------------------ */

typedef enum Where { OUTSIDE, INSIDE, MOVED } Where; /* MOVED: inside, done for this step */

typedef struct LightPaths {
  float x[BATCH], y[BATCH], z[BATCH]; /* direction of flight */
  float weight[BATCH], height[BATCH]; /* height: 0 at the base, the thickness at the coat */
  bool alive[BATCH];
  Where where[BATCH];
} LightPaths;

static void start(LightPaths *p, const Stack *t, double theta) {
  for (uint32_t i = 0; i < BATCH; i++) {
    p->x[i] = (float)-sin(theta);
    p->y[i] = 0;
    p->z[i] = (float)-cos(theta);
    p->weight[i] = 1;
    p->height[i] = t->thickness;
    p->alive[i] = true;
    p->where[i] = OUTSIDE;
  }
}

/* Flies through the medium between base and coat: to where it scatters, which is the path's
 * move of this step, or to the next surface. */
static void fly(LightPaths *p, uint32_t i, const Stack *t, statRng *rng) {
  const float far = t->thickness;
  const float distance = -logf(fmaxf(1.0f - stat_float(rng), 1e-20f)) * fabsf(p->z[i]);
  const float to = p->z[i] > 0 ? p->height[i] + distance : p->height[i] - distance;
  if (t->albedo > 0 && to > 0 && to < far) {
    vlVec3 d = vl_phase_sample(t->g, vl_vec3(p->x[i], p->y[i], p->z[i]), stat_float(rng),
                               stat_float(rng));
    p->x[i] = d.x;
    p->y[i] = d.y;
    p->z[i] = d.z;
    p->height[i] = to;
    p->weight[i] *= t->albedo;
    p->where[i] = MOVED;
    return;
  }
  if (!(t->albedo > 0))
    p->weight[i] *= expf(-far / fabsf(p->z[i]));
  p->height[i] = p->z[i] > 0 ? far : 0;
}

/* Takes the directions that the kernel sampled where `here`. Paths that leave are counted;
 * after the last step no path goes on. */
static void scatter(LightPaths *p, const Batch *b, const bool *here, bool at_coat, bool last,
                    Tally *result) {
  for (uint32_t i = 0; i < BATCH; i++) {
    if (!here[i])
      continue;
    p->weight[i] *= b->weight[0][i];
    p->x[i] = b->ix[i];
    p->y[i] = b->iy[i];
    p->z[i] = b->iz[i];
    p->alive[i] = p->alive[i] && p->weight[i] > 0;
    const bool leaves = at_coat && p->z[i] > 0;
    if (leaves && p->alive[i])
      tally(result, p->x[i], p->y[i], p->z[i], p->weight[i]);
    if (leaves || last)
      p->alive[i] = false;
    if (!leaves)
      p->where[i] = MOVED;
  }
}

/* Gives the batch the paths that meet the surface now: all at first, later those inside that
 * fly towards it. Says which in `here`. */
static void arrive(LightPaths *p, Batch *b, const Stack *t, bool at_coat, bool first,
                   statRng *rng, bool *here) {
  const Surface coat = {.eta_s = t->eta_s, .alpha_x = t->alpha, .alpha_y = t->alpha};
  const Surface base = {.reflectance = t->reflectance,
                        .eta = t->eta,
                        .k = t->k,
                        .alpha_x = t->base_x,
                        .alpha_y = t->base_y,
                        .eta_s = 1};
  batch_numbers(b, BATCH, rng);
  for (uint32_t i = 0; i < BATCH; i++) {
    batch_surface(b, i, at_coat ? &coat : &base);
    b->ox[i] = 0;
    b->oy[i] = 0;
    b->oz[i] = 1;
    here[i] = false;
    if (!p->alive[i] || (!first && p->where[i] == OUTSIDE))
      continue;
    if (!first && at_coat)
      fly(p, i, t, rng);
    if (p->where[i] == MOVED)
      continue;
    here[i] = first || (p->z[i] > 0) == at_coat;
    if (here[i]) {
      b->ox[i] = -p->x[i];
      b->oy[i] = -p->y[i];
      b->oz[i] = -p->z[i];
    }
  }
}

/* Traces a batch of light paths through the layers (channel 0). Each surface is sampled by its
 * own kernel, which chooses reflection or transmission. A path may leave through the coat at
 * any step. Each step handles the paths at the coat, then those at the base; before the first
 * all paths meet the coat from outside. */
static void nature(const State *s, const Stack *t, double theta, statRng *rng, Tally *result) {
  static LightPaths paths;
  bool here[BATCH];
  start(&paths, t, theta);
  for (int step = -1; step <= (int)t->depth; step++) {
    const bool first = step == -1, last = step == (int)t->depth;
    for (int surface = 0; surface < (first ? 1 : 2); surface++) {
      const bool at_coat = surface == 0;
      const vlBsdfKind base = t->metal ? VL_BSDF_CONDUCTOR : VL_BSDF_DIFFUSE;
      arrive(&paths, s->interface, t, at_coat, first, rng, here);
      batch_sample(s->kernels, at_coat ? VL_BSDF_DIELECTRIC : base, BATCH, s->interface);
      scatter(&paths, s->interface, here, at_coat, last, result);
    }
    for (uint32_t i = 0; i < BATCH; i++)
      if (paths.where[i] == MOVED)
        paths.where[i] = INSIDE;
  }
  result->count += BATCH;
}

static void ours(const State *s, const Stack *t, double theta, statRng *rng, Tally *result) {
  Batch *b = s->batch;
  batch_numbers(b, BATCH, rng);
  for (uint32_t i = 0; i < BATCH; i++) {
    put(b, i, t, (uint32_t)stat_bits(rng));
    batch_wo(b, i, theta, 0);
  }
  batch_sample(s->kernels, VL_BSDF_LAYERED, BATCH, b);
  for (uint32_t i = 0; i < BATCH; i++)
    if (!(b->flags[i] & VL_SAMPLED_NONE))
      tally(result, b->ix[i], b->iy[i], b->iz[i], b->weight[0][i]);
  result->count += BATCH;
}

static void walks_are_natures(void **state) {
  const State *s = *state;
  const double thetas[] = {0.3, 1.1};
  for (int i = 0; i < STACKS; i++)
    for (int k = 0; k < 2; k++) {
      Tally a = {0}, b = {0};
      statRng rng = stat_rng((uint64_t)(2 * i + k));
      for (int turn = 0; turn < 100; turn++)
        nature(s, &stacks[i], thetas[k], &rng, &a);
      for (int turn = 0; turn < 100; turn++)
        ours(s, &stacks[i], thetas[k], &rng, &b);
      for (int c = 0; c < CELLS; c++) {
        double x = a.sum[c] / a.count, y = b.sum[c] / b.count;
        double error = sqrt((a.square[c] / a.count - x * x) / a.count +
                            (b.square[c] / b.count - y * y) / b.count);
        if (!(fabs(x - y) < 4.5 * error + 1e-5))
          fail_msg("stack %d theta %g cell %d: nature %g, walks %g, error %g", i, thetas[k], c,
                   x, y, error);
      }
      double error = sqrt(b.square[CELLS - 1] / b.count) / sqrt(b.count);
      if (!(error < 8e-3))
        fail_msg("stack %d: samples too uneven, error %g", i, error);
    }
}

/* ---- against the closed form ------------------------------------------------------------- */

static void diffuse_base_is_the_closed_form(void **state) {
  const State *s = *state;
  const float alphas[4][2] = {{0, 0}, {0.3f, 0.3f}, {0.1f, 0.5f}, {0.6f, 0.05f}};
  for (int rough = 0; rough < 4; rough++) {
    float x_alpha = alphas[rough][0], y_alpha = alphas[rough][1];
    Stack t = {.eta_s = 1.5f,
               .alpha = x_alpha,
               .alpha_y = y_alpha,
               .reflectance = 0.8f,
               .thickness = 0.1f,
               .depth = 10};
    vlCoatTable *table;
    assert_int_equal(
        vl_coat_build_anisotropic(s->context, 1.5f, 0.1f, 10, x_alpha, y_alpha, &table), VL_OK);
    Surface exact = {.reflectance = 0.8f,
                     .eta_s = 1.5f,
                     .alpha_x = x_alpha,
                     .alpha_y = y_alpha,
                     .coat = table};
    const double angles[4][3] = {{0.2, 0.5, 1}, {1.0, 0.3, 2}, {0.7, 1.2, 3}, {1.3, 1.3, 0.5}};
    for (int k = 0; k < 4; k++) {
      double sum = 0, square = 0, count = 0;
      for (int turn = 0; turn < 100; turn++) {
        for (uint32_t i = 0; i < BATCH; i++) {
          put(s->batch, i, &t, (uint32_t)turn * BATCH + i);
          batch_wo(s->batch, i, angles[k][0], 0);
          s->batch->ix[i] = (float)(sin(angles[k][1]) * cos(angles[k][2]));
          s->batch->iy[i] = (float)(sin(angles[k][1]) * sin(angles[k][2]));
          s->batch->iz[i] = (float)cos(angles[k][1]);
        }
        batch_eval(s->kernels, VL_BSDF_LAYERED, BATCH, s->batch);
        for (uint32_t i = 0; i < BATCH; i++) {
          double x = (double)s->batch->value[0][i];
          sum += x;
          square += x * x;
          count++;
        }
      }
      for (uint32_t i = 0; i < VL_LANES; i++) {
        batch_surface(s->other, i, &exact);
        s->other->ox[i] = s->batch->ox[0];
        s->other->oy[i] = s->batch->oy[0];
        s->other->oz[i] = s->batch->oz[0];
        s->other->ix[i] = s->batch->ix[0];
        s->other->iy[i] = s->batch->iy[0];
        s->other->iz[i] = s->batch->iz[0];
      }
      batch_eval(s->kernels, VL_BSDF_COATED_DIFFUSE, 1, s->other);
      double x = sum / count, y = (double)s->other->value[0][0],
             error = sqrt((square / count - x * x) / count);
      if (!(fabs(x - y) < 4.5 * error + 5e-4 * y))
        fail_msg("coat %d angles %d: walks %g, exact %g", rough, k, x, y);
    }
    vl_coat_free(s->context, table);
  }
}

/* ---- furnace, reciprocity, agreement ----------------------------------------------------- */

static void white_furnace(void **state) {
  const State *s = *state;
  const Stack lossless[] = {
      {.metal = true, .eta_s = 1.5f, .eta = 0, .k = 2, .depth = 1000},
      {.metal = true, .eta_s = 2.4f, .eta = 0, .k = 2, .depth = 1000},
      {.eta_s = 1.5f, .reflectance = 1, .depth = 1000},
      {.eta_s = 1.5f,
       .reflectance = 1,
       .thickness = 0.5f,
       .albedo = 1,
       .g = 0.5f,
       .depth = 1000},
      {.eta_s = 1.5f, .reflectance = 1, .thickness = 3, .albedo = 1, .g = 0.9f, .depth = 1000},
      {.eta_s = 1.2f, .reflectance = 1, .thickness = 3, .albedo = 1, .g = -0.9f, .depth = 1000},
      {.metal = true,
       .eta_s = 1.5f,
       .eta = 0,
       .k = 2,
       .thickness = 1,
       .albedo = 1,
       .g = 0.7f,
       .depth = 1000},
  };
  for (int i = 0; i < 7; i++)
    for (double theta = 0.1; theta < 1.5; theta += 0.6) {
      Tally t = {0};
      statRng rng = stat_rng((uint64_t)i);
      for (int turn = 0; turn < 100; turn++)
        ours(s, &lossless[i], theta, &rng, &t);
      double albedo = t.sum[CELLS - 1] / t.count;
      double error = sqrt(fmax(t.square[CELLS - 1] / t.count - albedo * albedo, 0) / t.count);
      if (!(fabs(albedo - 1) < 4 * error + 1e-4) || !(error < 8e-3))
        fail_msg("furnace %d theta %g: %g, error %g", i, theta, albedo, error);
    }
}

/* The reflectance is at most 1 for every roughness, medium and angle. Over a thick black medium
 * only the coat itself reflects. */
static void never_gains(void **state) {
  const State *s = *state;
  const float alphas[3] = {0, 0.05f, 1}, thicknesses[3] = {0, 0.3f, 20},
              gs[3] = {-0.95f, 0, 0.95f};
  const double thetas[3] = {0.05, 0.9, 1.54};
  for (int i = 0; i < 3 * 3 * 3 * 2; i++) {
    bool metal = i % 2;
    float alpha = alphas[i / 2 % 3], thick = thicknesses[i / 6 % 3], g = gs[i / 18];
    Stack t = {.metal = metal,
               .eta_s = 1.5f,
               .alpha = alpha,
               .base_x = alpha,
               .base_y = 0.5f,
               .eta = 0,
               .k = 2};
    t.thickness = thick;
    t.g = g;
    t.albedo = 1;
    t.reflectance = 1;
    t.depth = 200;
    for (int k = 0; k < 3; k++) {
      Tally sum = {0}, black = {0}, bare = {0};
      statRng rng = stat_rng((uint64_t)(900 + 3 * i + k));
      for (int turn = 0; turn < 4; turn++)
        ours(s, &t, thetas[k], &rng, &sum);
      double albedo = sum.sum[CELLS - 1] / sum.count;
      double error =
          sqrt(fmax(sum.square[CELLS - 1] / sum.count - albedo * albedo, 0) / sum.count);
      if (!(albedo < 1.0005 + 4.5 * error))
        fail_msg("metal %d alpha %g thickness %g g %g theta %g: %g +- %g", metal, (double)alpha,
                 (double)thick, (double)g, thetas[k], albedo, error);
      if (thick < 20)
        continue;
      Stack dark = t, coat = t;
      dark.albedo = 0;
      coat.reflectance = 0;
      coat.metal = false;
      coat.albedo = 0;
      for (int turn = 0; turn < 8; turn++) {
        ours(s, &dark, thetas[k], &rng, &black);
        ours(s, &coat, thetas[k], &rng, &bare);
      }
      double x = black.sum[CELLS - 1] / black.count, y = bare.sum[CELLS - 1] / bare.count;
      error =
          sqrt((black.square[CELLS - 1] + bare.square[CELLS - 1]) / black.count / black.count);
      if (!(fabs(x - y) < 4.5 * error + 1e-4))
        fail_msg("black medium: %g comes back, of the coat %g", x, y);
    }
  }
}

static void reciprocity(void **state) {
  const State *s = *state;
  for (int i = 0; i < STACKS; i++) {
    double mean[2], error[2];
    for (int way = 0; way < 2; way++) {
      double sum = 0, square = 0, count = 0, a = way ? 0.9 : 0.4, b = way ? 0.4 : 0.9,
             turned = way ? -2.6 : 2.6;
      for (int turn = 0; turn < 100; turn++) {
        for (uint32_t j = 0; j < BATCH; j++) {
          put(s->batch, j, &stacks[i], (uint32_t)turn * BATCH + j);
          batch_wo(s->batch, j, a, way ? 2.6 : 0);
          double phi = (way ? 2.6 : 0) + turned;
          s->batch->ix[j] = (float)(sin(b) * cos(phi));
          s->batch->iy[j] = (float)(sin(b) * sin(phi));
          s->batch->iz[j] = (float)cos(b);
        }
        batch_eval(s->kernels, VL_BSDF_LAYERED, BATCH, s->batch);
        for (uint32_t j = 0; j < BATCH; j++) {
          double x = (double)s->batch->value[1][j] / cos(b);
          sum += x;
          square += x * x;
          count++;
        }
      }
      mean[way] = sum / count;
      error[way] = sqrt(fmax(square / count - mean[way] * mean[way], 0) / count);
    }
    if (!(fabs(mean[0] - mean[1]) < 4.5 * hypot(error[0], error[1]) + 1e-4 * mean[0] + 1e-9))
      fail_msg("stack %d: %g one way, %g the other, errors %g %g", i, mean[0], mean[1],
               error[0], error[1]);
  }
}

/* Samples follow the density that evaluation returns, and both use the same walk; from below
 * and from above. */
static double density(void *user, const double w[3]) {
  const State *s = user;
  Batch *b = s->other;
  b->ix[0] = (float)w[0];
  b->iy[0] = (float)w[1];
  b->iz[0] = (float)w[2];
  batch_eval(s->kernels, VL_BSDF_LAYERED, 1, b);
  return (double)b->pdf[0];
}
static void sampling_agrees_with_evaluation(void **state) {
  State *s = *state;
  const double thetas[] = {0.3, 1.2, PI - 0.8};
  for (int i = 0; i < STACKS; i++)
    for (int k = 0; k < 3; k++) {
      statRng rng = stat_rng((uint64_t)(3 * i + k));
      statSphere hist = stat_sphere_new(24, 32);
      for (int turn = 0; turn < 48; turn++) {
        Batch *b = s->batch;
        batch_numbers(b, BATCH, &rng);
        for (uint32_t j = 0; j < BATCH; j++) {
          put(b, j, &stacks[i], (uint32_t)stat_bits(&rng));
          batch_wo(b, j, thetas[k], 0.7);
        }
        batch_sample(s->kernels, VL_BSDF_LAYERED, BATCH, b);
        *s->other = *b;
        batch_eval(s->kernels, VL_BSDF_LAYERED, BATCH, s->other);
        for (uint32_t j = 0; j < BATCH; j++) {
          if (b->flags[j] & (VL_SAMPLED_NONE | VL_SAMPLED_SPECULAR)) {
            stat_sphere_reject(hist);
            continue;
          }
          stat_sphere_add(hist, (double)b->ix[j], (double)b->iy[j], (double)b->iz[j]);
          assert_true(b->iz[j] * b->oz[j] > 0);
          assert_true(b->pdf[j] == s->other->pdf[j]);
          for (int c = 0; c < 4; c++) {
            double v = (double)s->other->value[c][j], w = (double)(b->weight[c][j] * b->pdf[j]);
            if (!(fabs(v - w) <= 1e-5 * v + 1e-9))
              fail_msg("stack %d: value %g, weight %g", i, v, w);
          }
        }
      }
      for (uint32_t j = 0; j < VL_LANES; j++) {
        put(s->other, j, &stacks[i], 0);
        batch_wo(s->other, j, thetas[k], 0.7);
      }
      statResult r = stat_sphere_test(hist, density, s, 2e-5);
      if (!stat_accept(r, STACKS * 3))
        fail_msg("stack %d theta %g: p %g, integral %g", i, thetas[k], r.p, r.integral);
      assert_true(r.integral < 1.0005);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(walks_are_natures), cmocka_unit_test(diffuse_base_is_the_closed_form),
      cmocka_unit_test(white_furnace),     cmocka_unit_test(never_gains),
      cmocka_unit_test(reciprocity),       cmocka_unit_test(sampling_agrees_with_evaluation),
  };
  return cmocka_run_group_tests(tests, setup, teardown);
}
