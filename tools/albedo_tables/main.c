/* tools/albedo_tables: computes the principled material's tables
 * (src/material/principled.h) by quadrature and writes them as C. Called by the build:
 * albedo_tables FILE.c */
#include <stdio.h>

#include "material/principled.h"

#include "math/ggx.h"

/* Numbers of quadrature points. CAPS is large because narrow lobes have long tails. */
enum { TURNS = 24, CAPS = 384, SHEEN_POINTS = 64, LOSS_TURNS = 16, LOSS_CAPS = 96 };

static float table_cos(uint32_t column) {
  float x = (float)column / (float)(VL_ALBEDO_COS - 1), c = x * x;
  return c > 1e-5f ? c : 1e-5f;
}

/* Directional albedo for F0 (a) and F90 (b). With visible-normal sampling the weight of a
 * sample is the smooth function G/G1 F, so the midpoint rule is accurate. */
static void specular_at(float cosine, float alpha, float *a, float *b) {
  vlVec3 o = vl_vec3(__builtin_sqrtf(1.0f - cosine * cosine), 0.0f, cosine);
  float lo = vl_ggx_length(o, alpha, alpha);
  double sum_a = 0, sum_b = 0;
  for (uint32_t k = 0; k < TURNS * CAPS; k++) {
    float u = ((float)(k % TURNS) + 0.5f) / TURNS, v = ((float)(k / TURNS) + 0.5f) / CAPS;
    vlVec3 h = vl_ggx_sample(o, alpha, alpha, u, v);
    float c = vl_dot(o, h), z = 2.0f * c * h.z - o.z;
    if (!(z > 0.0f))
      continue;
    vlVec3 w = vl_vec3(2.0f * c * h.x - o.x, 2.0f * c * h.y - o.y, z);
    float g = vl_ggx_shadowing(o.z, lo, z, vl_ggx_length(w, alpha, alpha)),
          s = vl_schlick_weight(c);
    sum_a += (double)(g * (1.0f - s));
    sum_b += (double)(g * s);
  }
  *a = (float)(sum_a / (TURNS * CAPS));
  *b = (float)(sum_b / (TURNS * CAPS));
}

/* Fraction of the light from o that single scattering loses at a rough glass boundary. forth:
 * index on the other side over that on this side; eta: index inside over that outside. */
static float loss_at(float cosine, float alpha, float eta, int inside) {
  vlVec3 o = vl_vec3(__builtin_sqrtf(1.0f - cosine * cosine), 0.0f, cosine);
  float lo = vl_ggx_length(o, alpha, alpha), forth = inside ? 1.0f / eta : eta,
        back = 1.0f / forth;
  float root = (eta - 1.0f) / (eta + 1.0f), f0 = root * root;
  double sum = 0;
  for (uint32_t k = 0; k < LOSS_TURNS * LOSS_CAPS; k++) {
    float u = 0.5f * ((float)(k % LOSS_TURNS) + 0.5f) / LOSS_TURNS,
          v = ((float)(k / LOSS_TURNS) + 0.5f) / LOSS_CAPS;
    vlVec3 h = vl_ggx_sample(o, alpha, alpha, u, v);
    float c = vl_dot(o, h), cos2 = 1.0f - (1.0f - c * c) * back * back,
          beyond = cos2 > 0.0f ? __builtin_sqrtf(cos2) : 0.0f;
    float f = cos2 > 0.0f ? f0 + (1.0f - f0) * vl_schlick_weight(inside ? beyond : c) : 1.0f;
    vlVec3 w = vl_vec3(2.0f * c * h.x - o.x, 2.0f * c * h.y - o.y, 2.0f * c * h.z - o.z);
    if (w.z > 0.0f)
      sum += (double)(f * vl_ggx_shadowing(o.z, lo, w.z, vl_ggx_length(w, alpha, alpha)));
    float a = c * back - beyond;
    w = vl_vec3(a * h.x - back * o.x, a * h.y - back * o.y, back * o.z - a * h.z);
    if (w.z > 0.0f)
      sum +=
          (double)((1.0f - f) * vl_ggx_shadowing(o.z, lo, w.z, vl_ggx_length(w, alpha, alpha)));
  }
  double loss = 1.0 - sum / (LOSS_TURNS * LOSS_CAPS);
  return loss > 0.0 ? (float)loss : 0.0f;
}

/* Albedo of the sheen, integrated over polar angle and azimuth. Points are denser towards the
 * horizon, where sheen is strong. */
static float sheen_at(float cosine, float alpha) {
  float sine = __builtin_sqrtf(1.0f - cosine * cosine);
  double sum = 0;
  for (uint32_t k = 0; k < SHEEN_POINTS * SHEEN_POINTS; k++) {
    float x = ((float)(k % SHEEN_POINTS) + 0.5f) / SHEEN_POINTS, z = x * x;
    float turn = 0.5f * ((float)(k / SHEEN_POINTS) + 0.5f) / SHEEN_POINTS;
    float r = __builtin_sqrtf(1.0f - z * z);
    vlSinCos phi = vl_sincos_turn(turn);
    vlVec3 h = vl_normalize(vl_vec3(sine + r * phi.cos, r * phi.sin, cosine + z));
    sum += (double)(vl_sheen(cosine, z, h.z, alpha) * 2.0f * x); /* dz = 2 x dx */
  }
  return (float)(sum * 2.0 * (double)VL_PI / (SHEEN_POINTS * SHEEN_POINTS));
}

/* The integral of 2 E cos over cos, with the substitution cos = x^2. */
static float mean_of(const float *row, uint32_t count) {
  double sum = 0, weight = 0;
  for (uint32_t j = 0; j < count; j++) {
    double x = (double)j / (count - 1), w = 4 * x * x * x * (j == count - 1 ? 0.5 : 1.0);
    sum += w * (double)row[j];
    weight += w;
  }
  return (float)(sum / weight);
}

static void fill_row(vlPrincipledTables *t, uint32_t row) {
  float r = (float)row / (float)(VL_ALBEDO_ALPHA - 1), alpha = r * r;
  float rough = alpha > VL_GGX_SMOOTH ? alpha : VL_GGX_SMOOTH,
        fuzz = alpha > VL_SHEEN_ALPHA ? alpha : VL_SHEEN_ALPHA;
  for (uint32_t j = 0; j < VL_ALBEDO_COS; j++) {
    float c = table_cos(j);
    specular_at(c, rough, &t->a[row][j], &t->b[row][j]);
    t->sheen[row][j] = sheen_at(c, fuzz);
  }
  t->a_mean[row] = mean_of(t->a[row], VL_ALBEDO_COS);
  t->b_mean[row] = mean_of(t->b[row], VL_ALBEDO_COS);
  float capped[VL_ALBEDO_COS];
  for (uint32_t j = 0; j < VL_ALBEDO_COS; j++)
    capped[j] = t->sheen[row][j] < 1.0f ? t->sheen[row][j] : 1.0f;
  t->sheen_mean[row] = mean_of(capped, VL_ALBEDO_COS);
}

static void fill_losses(vlPrincipledTables *t, int side, uint32_t index) {
  float root = VL_LOSS_MAX_ROOT * (float)index / (float)(VL_LOSS_ETA - 1),
        eta = (1.0f + root) / (1.0f - root);
  for (uint32_t i = 0; i < VL_LOSS_ALPHA; i++) {
    float r = (float)i / (float)(VL_LOSS_ALPHA - 1),
          alpha = r * r > VL_GGX_SMOOTH ? r * r : VL_GGX_SMOOTH;
    float *row = t->loss[side][index][i];
    for (uint32_t j = 0; j < VL_LOSS_COS; j++) {
      float x = (float)j / (float)(VL_LOSS_COS - 1), c = x * x;
      row[j] = loss_at(c > 1e-5f ? c : 1e-5f, alpha, eta, side);
    }
    t->loss_mean[side][index][i] = mean_of(row, VL_LOSS_COS);
  }
}

static void write_row(FILE *file, const float *row, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    fprintf(file, "%s%a%s", i % 6 ? " " : "\n", (double)row[i], "f,");
}

static void write_table(FILE *file, const char *name, const float table[][VL_ALBEDO_COS]) {
  fprintf(file, "\n.%s = {", name);
  for (uint32_t i = 0; i < VL_ALBEDO_ALPHA; i++) {
    fprintf(file, "\n{");
    write_row(file, table[i], VL_ALBEDO_COS);
    fprintf(file, "},");
  }
  fprintf(file, "},");
}

static void write_means(FILE *file, const char *name, const float *mean) {
  fprintf(file, "\n.%s = {", name);
  write_row(file, mean, VL_ALBEDO_ALPHA);
  fprintf(file, "},");
}

static void write_losses(FILE *file, const vlPrincipledTables *t) {
  for (int side = 0; side < 2; side++)
    for (uint32_t i = 0; i < VL_LOSS_ETA; i++) {
      fprintf(file, "\n.loss[%d][%u] = {", side, i);
      for (uint32_t k = 0; k < VL_LOSS_ALPHA; k++) {
        fprintf(file, "\n{");
        write_row(file, t->loss[side][i][k], VL_LOSS_COS);
        fprintf(file, "},");
      }
      fprintf(file, "},\n.loss_mean[%d][%u] = {", side, i);
      write_row(file, t->loss_mean[side][i], VL_LOSS_ALPHA);
      fprintf(file, "},");
    }
}

int main(int argc, char **argv) {
  static vlPrincipledTables t;
  FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
  if (!file) {
    fprintf(stderr, "usage: albedo_tables FILE.c\n");
    return 2;
  }
  for (uint32_t i = 0; i < VL_ALBEDO_ALPHA; i++)
    fill_row(&t, i);
  for (int side = 0; side < 2; side++)
    for (uint32_t i = 0; i < VL_LOSS_ETA; i++)
      fill_losses(&t, side, i);
  fprintf(file,
          "/* Written by tools/albedo_tables. */\n#include \"material/principled.h\"\n\n");
  fprintf(file, "const vlPrincipledTables vl_principled_tables = {");
  write_table(file, "a", t.a);
  write_table(file, "b", t.b);
  write_table(file, "sheen", t.sheen);
  write_means(file, "a_mean", t.a_mean);
  write_means(file, "b_mean", t.b_mean);
  write_means(file, "sheen_mean", t.sheen_mean);
  write_losses(file, &t);
  fprintf(file, "};\n");
  return fclose(file) == 0 ? 0 : 5;
}
