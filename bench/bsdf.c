/* bench/bsdf.c: nanoseconds per evaluation and per sample of each BSDF, by instruction set.
 * Batches are compared with the same code run one lane at a time (compiled without vectors);
 * each line ends in the ratio. Usage: bench_bsdf [lanes] (default 512). Each number is the best
 * of several rounds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/context.h"
#include "material/bsdf.hot.h"
#include "material/kinds.row.h"

/* The same kernels for one lane, without padding and vectors (VL_SCALAR, CMakeLists.txt). */
extern const vlBsdfKernels vl_bsdf_kernel_table_scalar;

enum { MAX_HITS = 4096, ROUNDS = 7 };

typedef struct {
  /* longer than a power of two, so that rows do not share the same cache sets */
  float in[24][MAX_HITS + 80], out[14][MAX_HITS + 80], own[VL_BSDF_ROWS][MAX_HITS + 80];
  const vlCoatTable *coat[MAX_HITS];
  uint32_t flags[MAX_HITS];
} Arrays;

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static uint32_t state = 1;
static float number(void) {
  state = state * 1664525u + 1013904223u;
  return (float)(state >> 8) * 0x1p-24f;
}
static void direction(Arrays *a, int first, uint32_t i) {
  float z = 2 * number() - 1, phi = 6.2831853f * number(), r = sqrtf(1 - z * z);
  a->in[first][i] = r * cosf(phi);
  a->in[first + 1][i] = r * sinf(phi);
  a->in[first + 2][i] = z;
}

/* One pass of lanes [first, first + n). what: 1 evaluation, 2 sample */
static void pass(const vlBsdfKernels *k, vlBsdfKind kind, int what, Arrays *a, uint32_t first,
                 uint32_t n) {
#define IN(j) (a->in[j] + first)
#define OUT(j) (a->out[j] + first)
  vlBsdfParams p = {.reflectance = {IN(0), IN(1), IN(2), IN(3)},
                    .eta = {IN(4), IN(5), IN(6), IN(7)},
                    .k = {IN(8), IN(9), IN(10), IN(11)},
                    .alpha_x = IN(12),
                    .alpha_y = IN(13),
                    .eta_s = IN(14),
                    .coat = a->coat + first,
                    .seed = a->flags + first};
  for (int j = 0; j < VL_BSDF_ROWS; j++)
    p.own[j] = a->own[j] + first;
  vlBsdfDirections wo = {IN(15), IN(16), IN(17)}, wi = {IN(18), IN(19), IN(20)},
                   out = {OUT(0), OUT(1), OUT(2)};
  float *value[4] = {OUT(3), OUT(4), OUT(5), OUT(6)};
  vlBsdfRandom random = {IN(21), IN(22), IN(23)};
  vlBsdfSampled sampled = {
      out, {OUT(8), OUT(9), OUT(10), OUT(11)}, OUT(12), a->flags + first, OUT(13)};
  if (what & 1)
    k->eval[kind](n, &p, wo, wi, value, OUT(7));
  if (what & 2)
    k->sample[kind](n, &p, wo, random, sampled);
}

/* Nanoseconds per lane, best of several rounds. */
static double cost(const vlBsdfKernels *k, vlBsdfKind kind, int what, Arrays *a, uint32_t n,
                   uint32_t step) {
  double best = 1e30;
  for (int round = 0; round < ROUNDS; round++) {
    uint32_t turns = (step == 1 ? 40000u : 400000u) / n;
    double start = seconds();
    for (uint32_t t = 0; t < turns; t++)
      for (uint32_t i = 0; i < n; i += step)
        pass(k, kind, what, a, i, step);
    double time = (seconds() - start) * 1e9 / ((double)turns * n);
    best = time < best ? time : best;
  }
  return best;
}

int main(int argc, char **argv) {
  uint32_t n = argc > 1 ? (uint32_t)atoi(argv[1]) : 512;
  n = n < 16 ? 16 : n > MAX_HITS ? MAX_HITS : (n + 15u) & ~15u;
  Arrays *a = calloc(1, sizeof *a);
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  vlCoatTable *coat, *rough;
  if (!a || vl_context_create(&def, &context))
    return 1;
  if (vl_coat_build(context, 1.5f, 0.01f, 10, 0.1f, 0.1f, &coat) ||
      vl_coat_build(context, 1.5f, 0.01f, 10, 0, 0.5f, &rough))
    return 1;
  for (uint32_t i = 0; i < n; i++) {
    for (int j = 0; j < 24; j++)
      a->in[j][i] = number();
    for (int c = 0; c < 4; c++) {
      a->in[4 + c][i] += 0.2f;
      a->in[8 + c][i] *= 5;
    }
    a->in[12][i] = a->in[13][i] = 0.1f;
    a->in[14][i] = 1.5f;
    a->coat[i] = coat;
    a->own[VL_P_F90][i] = a->own[VL_P_THIN][i] = a->own[VL_P_COAT_Z][i] = 1.0f;
    for (int c = 0; c < 4; c++)
      a->own[VL_P_F0 + c][i] = 0.04f;
    a->own[VL_P_METALLIC][i] = a->in[8][i] / 5;
    direction(a, 15, i);
    direction(a, 18, i);
  }
  const struct {
    const char *name;
    vlBsdfKind kind;
    const vlCoatTable *coat;
  } rows[] = {{"diffuse", VL_BSDF_DIFFUSE, coat},
              {"conductor", VL_BSDF_CONDUCTOR, coat},
              {"dielectric", VL_BSDF_DIELECTRIC, coat},
              {"thin dielectric", VL_BSDF_THIN_DIELECTRIC, coat},
              {"coated diffuse", VL_BSDF_COATED_DIFFUSE, coat},
              {"coated, textured", VL_BSDF_COATED_DIFFUSE, rough},
              {"principled", VL_BSDF_PRINCIPLED, coat},
              {"diffuse transmission", VL_BSDF_DIFFUSE_TRANSMISSION, coat},
              {"layered", VL_BSDF_LAYERED, coat},
              {"hair", VL_BSDF_HAIR, coat}};
  static const char *const sets[] = {
      [VL_ISA_BASE] = "base", [VL_ISA_V2] = "v2", [VL_ISA_V3] = "v3", [VL_ISA_V4] = "v4"};
  printf(
      "ns a lane, batches of %u; alpha 0.1; \"one\": one lane at a time, lowest set without "
      "vectors\n",
      n);
  printf("%-18s %-8s %8s", "", "", "one");
  vlIsa lowest = VL_ISA_AUTO, best = vl_isa_best();
  if (vl_isa_choose(VL_ISA_BASE, &lowest) != VL_OK)
    return 1;
  for (int isa = (int)lowest; isa <= (int)best; isa++)
    printf("%9s", sets[isa]);
  printf("%10s\n", "ratio");
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    for (uint32_t i = 0; i < n; i++)
      a->coat[i] = rows[r].coat;
    for (int what = 1; what <= 3; what++) {
      const char *names[] = {"eval", "sample", "both"};
      double one = cost(&vl_bsdf_kernel_table_scalar, rows[r].kind, what, a, n, 1), last = one;
      printf("%-18s %-8s %8.1f", what == 1 ? rows[r].name : "", names[what - 1], one);
      for (int isa = (int)lowest; isa <= (int)best; isa++) {
        last = cost(vl_bsdf_kernels((vlIsa)isa), rows[r].kind, what, a, n, n);
        printf("%9.2f", last);
      }
      printf("%9.1fx\n", one / last);
    }
  }
  vl_coat_free(context, coat);
  vl_coat_free(context, rough);
  vl_context_destroy(context);
  free(a);
  return 0;
}
