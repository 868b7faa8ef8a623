/* tools/albedo_tables: computes the principled material's tables
 * (src/material/principled.h) by quadrature and writes them as C. Called by the build:
 * albedo_tables FILE.c */
#include <stdio.h>

#include "material/principled.h"

#include "math/ggx.h"

/* Points of the quadrature over microfacets: turns about the normal, caps of normals around it.
 * turn: 0.5 where both halves of the turn are alike. tails: denser among the steep normals,
 * which are what a narrow lobe loses. */
typedef struct Points {
  uint32_t turns, caps;
  float turn;
  bool tails;
} Points;
static const Points albedo_points = {24, 384, 1.0f, false}, loss_points = {16, 96, 0.5f, false},
                    stretched_points = {16, 96, 1.0f, true};
enum { SHEEN_POINTS = 64 };

typedef struct Point {
  float u, v, weight;
} Point;

static Point point_at(Points p, uint32_t k) {
  float u = p.turn * ((float)(k % p.turns) + 0.5f) / (float)p.turns;
  float v = ((float)(k / p.turns) + 0.5f) / (float)p.caps, rest = 1.0f - v;
  return p.tails ? (Point){u, 1.0f - rest * rest, 2.0f * rest} : (Point){u, v, 1.0f};
}

/* Index of refraction of the glass in the tables `stretched`. */
#define STRETCHED_ETA 1.5f

typedef struct Layer {
  float alpha_x, alpha_y, eta; /* eta: index inside over that outside */
} Layer;

/* Direction of incidence. azimuth: the cosine of its azimuth. */
static vlVec3 incident(float cosine, float azimuth) {
  float sine = __builtin_sqrtf(1.0f - cosine * cosine);
  return vl_vec3(sine * azimuth, sine * __builtin_sqrtf(1.0f - azimuth * azimuth), cosine);
}

static float table_cos(uint32_t column) {
  float x = (float)column / (float)(VL_ALBEDO_COS - 1), c = x * x;
  return c > 1e-5f ? c : 1e-5f;
}

/* Directional albedo for F0 (a) and F90 (b). With visible-normal sampling the weight of a
 * sample is the smooth function G/G1 F, so the midpoint rule is accurate. */
static void specular_at(vlVec3 o, Layer layer, Points points, float *a, float *b) {
  float ax = layer.alpha_x, ay = layer.alpha_y, lo = vl_ggx_length(o, ax, ay);
  const uint32_t count = points.turns * points.caps;
  double sum_a = 0, sum_b = 0;
  for (uint32_t k = 0; k < count; k++) {
    Point p = point_at(points, k);
    vlVec3 h = vl_ggx_sample(o, ax, ay, p.u, p.v);
    float c = vl_dot(o, h), z = 2.0f * c * h.z - o.z;
    if (!(z > 0.0f))
      continue;
    vlVec3 w = vl_vec3(2.0f * c * h.x - o.x, 2.0f * c * h.y - o.y, z);
    float g = p.weight * vl_ggx_shadowing(o.z, lo, z, vl_ggx_length(w, ax, ay)),
          s = vl_schlick_weight(c);
    sum_a += (double)(g * (1.0f - s));
    sum_b += (double)(g * s);
  }
  *a = (float)(sum_a / count);
  *b = (float)(sum_b / count);
}

/* Fraction of the light from o that single scattering loses at a rough glass boundary. */
static float loss_at(vlVec3 o, Layer layer, int inside, Points points) {
  float ax = layer.alpha_x, ay = layer.alpha_y, eta = layer.eta;
  float lo = vl_ggx_length(o, ax, ay), forth = inside ? 1.0f / eta : eta, back = 1.0f / forth;
  float root = (eta - 1.0f) / (eta + 1.0f), f0 = root * root;
  const uint32_t count = points.turns * points.caps;
  double sum = 0;
  for (uint32_t k = 0; k < count; k++) {
    Point p = point_at(points, k);
    vlVec3 h = vl_ggx_sample(o, ax, ay, p.u, p.v);
    float c = vl_dot(o, h), cos2 = 1.0f - (1.0f - c * c) * back * back,
          beyond = cos2 > 0.0f ? __builtin_sqrtf(cos2) : 0.0f;
    float f = cos2 > 0.0f ? f0 + (1.0f - f0) * vl_schlick_weight(inside ? beyond : c) : 1.0f;
    vlVec3 w = vl_vec3(2.0f * c * h.x - o.x, 2.0f * c * h.y - o.y, 2.0f * c * h.z - o.z);
    if (w.z > 0.0f)
      sum += (double)(p.weight * f * vl_ggx_shadowing(o.z, lo, w.z, vl_ggx_length(w, ax, ay)));
    float a = c * back - beyond;
    w = vl_vec3(a * h.x - back * o.x, a * h.y - back * o.y, back * o.z - a * h.z);
    if (w.z > 0.0f)
      sum += (double)(p.weight * (1.0f - f) *
                      vl_ggx_shadowing(o.z, lo, w.z, vl_ggx_length(w, ax, ay)));
  }
  double loss = 1.0 - sum / count;
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
    specular_at(incident(c, 1.0f), (Layer){rough, rough, 0.0f}, albedo_points, &t->a[row][j],
                &t->b[row][j]);
    t->sheen[row][j] = sheen_at(c, fuzz);
  }
  t->a_mean[row] = mean_of(t->a[row], VL_ALBEDO_COS);
  t->b_mean[row] = mean_of(t->b[row], VL_ALBEDO_COS);
  float capped[VL_ALBEDO_COS];
  for (uint32_t j = 0; j < VL_ALBEDO_COS; j++)
    capped[j] = t->sheen[row][j] < 1.0f ? t->sheen[row][j] : 1.0f;
  t->sheen_mean[row] = mean_of(capped, VL_ALBEDO_COS);
}

static float loss_cos(uint32_t column) {
  float x = (float)column / (float)(VL_LOSS_COS - 1), c = x * x;
  return c > 1e-5f ? c : 1e-5f;
}

static void fill_losses(vlPrincipledTables *t, int side, uint32_t index) {
  float root = VL_LOSS_MAX_ROOT * (float)index / (float)(VL_LOSS_ETA - 1),
        eta = (1.0f + root) / (1.0f - root);
  for (uint32_t i = 0; i < VL_LOSS_ALPHA; i++) {
    float r = (float)i / (float)(VL_LOSS_ALPHA - 1),
          alpha = r * r > VL_GGX_SMOOTH ? r * r : VL_GGX_SMOOTH;
    const Layer layer = {alpha, alpha, eta};
    float *row = t->loss[side][index][i];
    for (uint32_t j = 0; j < VL_LOSS_COS; j++)
      row[j] = loss_at(incident(loss_cos(j), 1.0f), layer, side, loss_points);
    t->loss_mean[side][index][i] = mean_of(row, VL_LOSS_COS);
  }
}

/* The mean over the azimuth of values at equal steps of its cosine. */
static float mean_azimuth(const float values[VL_STRETCH_AZIMUTH]) {
  enum { STEPS = 64 };
  double sum = 0;
  for (uint32_t k = 0; k < STEPS; k++) {
    float c = vl_sincos_turn(0.25f * ((float)k + 0.5f) / STEPS).cos;
    sum += (double)vl_albedo_mean(values, vl_albedo_cell(c * c, VL_STRETCH_AZIMUTH));
  }
  return (float)(sum / STEPS);
}

/* What the tables `stretched` compare, for one azimuth. */
static void compute(vlStretched kind, Layer layer, float azimuth, float row[VL_LOSS_COS]) {
  for (uint32_t j = 0; j < VL_LOSS_COS; j++) {
    vlVec3 o = incident(loss_cos(j), azimuth);
    float a, b;
    if (kind >= VL_STRETCHED_OUTSIDE) {
      row[j] = loss_at(o, layer, kind == VL_STRETCHED_INSIDE, stretched_points);
      continue;
    }
    specular_at(o, layer, stretched_points, &a, &b);
    row[j] = kind == VL_STRETCHED_B ? b : vl_max(1.0f - a - b, 0.0f);
  }
}

static float divide(float value, float isotropic) {
  return isotropic > 1e-6f ? value / isotropic : 1.0f;
}

static void fill_stretched(vlPrincipledTables *t, vlStretched kind, uint32_t ratio,
                           uint32_t row) {
  float r = (float)row / (float)(VL_STRETCH_ALPHA - 1), larger = vl_max(r * r, VL_GGX_SMOOTH);
  float q = (float)ratio / (float)(VL_STRETCH_RATIO - 1), smaller = q * q * larger;
  const Layer layer = {larger, vl_max(smaller, VL_GGX_SMOOTH), STRETCHED_ETA};
  float base = vl_base_alpha(layer.alpha_x, layer.alpha_y);
  float isotropic[VL_LOSS_COS], means[VL_STRETCH_AZIMUTH];
  compute(kind, (Layer){base, base, layer.eta}, 1.0f, isotropic);
  for (uint32_t k = 0; k < VL_STRETCH_AZIMUTH; k++) {
    float *values = t->stretched[kind][ratio][k][row];
    compute(kind, layer, (float)k / (float)(VL_STRETCH_AZIMUTH - 1), values);
    means[k] = mean_of(values, VL_LOSS_COS);
    for (uint32_t j = 0; j < VL_LOSS_COS; j++)
      values[j] = divide(values[j], isotropic[j]);
  }
  t->stretched_mean[kind][ratio][row] =
      divide(mean_azimuth(means), mean_of(isotropic, VL_LOSS_COS));
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

static void write_stretched(FILE *file, const vlPrincipledTables *t, vlStretched kind) {
  for (uint32_t i = 0; i < VL_STRETCH_RATIO; i++) {
    for (uint32_t k = 0; k < VL_STRETCH_AZIMUTH; k++)
      for (uint32_t row = 0; row < VL_STRETCH_ALPHA; row++) {
        fprintf(file, "\n.stretched[%d][%u][%u][%u] = {", (int)kind, i, k, row);
        write_row(file, t->stretched[kind][i][k][row], VL_LOSS_COS);
        fprintf(file, "},");
      }
    fprintf(file, "\n.stretched_mean[%d][%u] = {", (int)kind, i);
    write_row(file, t->stretched_mean[kind][i], VL_STRETCH_ALPHA);
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
  for (int kind = 0; kind < VL_STRETCHED_COUNT; kind++)
    for (uint32_t i = 0; i < VL_STRETCH_RATIO * VL_STRETCH_ALPHA; i++)
      fill_stretched(&t, (vlStretched)kind, i / VL_STRETCH_ALPHA, i % VL_STRETCH_ALPHA);
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
  for (int kind = 0; kind < VL_STRETCHED_COUNT; kind++)
    write_stretched(file, &t, (vlStretched)kind);
  fprintf(file, "};\n");
  return fclose(file) == 0 ? 0 : 5;
}
