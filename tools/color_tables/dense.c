/* dense.c: spectra at every nanometre from 360 to 830 nm (standard observer, illuminants,
 * metals, glasses), and the matrices of the colour spaces. All sums are over whole nanometres
 * and use values rounded to float, as velo itself does. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cie.h"
#include "math/elementary.h"
#include "measured.h"
#include "tables.h"

enum { MAX_NAMED = 64 };
typedef struct named {
  char name[24];
  float values[LAMBDA_COUNT];
} named;
typedef struct state {
  float cie[3][LAMBDA_COUNT];
  named list[MAX_NAMED];
  int count;
} state;

/* Sprague's fifth-degree interpolation of values 5 nm apart, as the CIE recommends (CIE 167).
 * The values at the ends are repeated. */
static double sprague(const double *v, int count, int lambda) {
  int i = (lambda - LAMBDA_MIN) / 5;
  double x = (lambda - LAMBDA_MIN) % 5 / 5.0, p[6];
  for (int k = 0; k < 6; k++) {
    int j = i + k - 2;
    p[k] = v[j < 0 ? 0 : j > count - 1 ? count - 1 : j];
  }
  double a1 = 2 * p[0] - 16 * p[1] + 16 * p[3] - 2 * p[4];
  double a2 = -p[0] + 16 * p[1] - 30 * p[2] + 16 * p[3] - p[4];
  double a3 = -9 * p[0] + 39 * p[1] - 70 * p[2] + 66 * p[3] - 33 * p[4] + 7 * p[5];
  double a4 = 13 * p[0] - 64 * p[1] + 126 * p[2] - 124 * p[3] + 61 * p[4] - 12 * p[5];
  double a5 = -5 * p[0] + 25 * p[1] - 50 * p[2] + 50 * p[3] - 25 * p[4] + 5 * p[5];
  double value = p[2] + ((((a5 * x + a4) * x + a3) * x + a2) * x + a1) * x / 24;
  return value > 0 ? value : 0;
}

static double sum_y(const state *s, const float *spectrum) {
  double sum = 0;
  for (int i = 0; i < LAMBDA_COUNT; i++)
    sum += (double)s->cie[1][i] * (double)spectrum[i];
  return sum;
}
static double y_integral(const state *s) {
  double sum = 0;
  for (int i = 0; i < LAMBDA_COUNT; i++)
    sum += (double)s->cie[1][i];
  return sum;
}

static named *add(state *s, const char *prefix, const char *name, const char *suffix) {
  if (s->count == MAX_NAMED)
    abort();
  named *n = &s->list[s->count++];
  snprintf(n->name, sizeof n->name, "%s%s%s", prefix, name, suffix);
  return n;
}

/* Adds a spectrum that is linear between the points, and constant before the first and after
 * the last one. */
static void add_points(state *s, const char *name, const char *suffix,
                       const double (*points)[2], int count) {
  named *n = add(s, "metal-", name, suffix);
  for (int i = 0, j = 0; i < LAMBDA_COUNT; i++) {
    double l = LAMBDA_MIN + i;
    while (j < count - 2 && points[j + 1][0] <= l)
      j++;
    double t = (l - points[j][0]) / (points[j + 1][0] - points[j][0]);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    n->values[i] = (float)(points[j][1] + t * (points[j + 1][1] - points[j][1]));
  }
}
static void add_metal(state *s, const char *name, const char *suffix,
                      const double values[METAL_COUNT]) {
  double points[METAL_COUNT][2];
  for (int i = 0; i < METAL_COUNT; i++) {
    points[i][0] = 1239.84176 / (3.45 - 0.05 * i);
    points[i][1] = values[i];
  }
  add_points(s, name, suffix, points, METAL_COUNT);
}
static void add_brass(state *s, const char *suffix, const double values[BRASS_COUNT]) {
  double points[BRASS_COUNT][2];
  for (int i = 0; i < BRASS_COUNT; i++) {
    points[i][0] = LAMBDA_MIN + 10 * i;
    points[i][1] = values[i];
  }
  add_points(s, "CuZn", suffix, points, BRASS_COUNT);
}
static void add_glass(state *s, const char *name, const sellmeier *g) {
  named *n = add(s, "glass-", name, "");
  for (int i = 0; i < LAMBDA_COUNT; i++) {
    double l = (LAMBDA_MIN + i) * 1e-3, l2 = l * l, n2 = 1;
    for (int k = 0; k < 3; k++)
      n2 += g->b[k] * l2 / (l2 - g->c[k]);
    n->values[i] = (float)sqrt(n2);
  }
}

/* Illuminants are scaled so that their Y, the sum over all nanometres, is equal to that of the
 * constant spectrum 1. */
static void add_illuminant(state *s, const char *prefix, const char *name,
                           const double values[LAMBDA_COUNT]) {
  named *n = add(s, prefix, name, "");
  double y = 0;
  for (int i = 0; i < LAMBDA_COUNT; i++)
    y += (double)s->cie[1][i] * values[i];
  for (int i = 0; i < LAMBDA_COUNT; i++)
    n->values[i] = (float)(values[i] * (y_integral(s) / y));
}
static void add_daylight(state *s, const char *prefix, const char *name, const double m[2]) {
  double v[LAMBDA_COUNT];
  for (int i = 0; i < LAMBDA_COUNT; i++) {
    int j = i / 10 < DAYLIGHT_COUNT - 2 ? i / 10 : DAYLIGHT_COUNT - 2;
    double t = (i - 10 * j) / 10.0, e[2];
    for (int k = 0; k < 2; k++)
      e[k] = daylight[0][j + k] + m[0] * daylight[1][j + k] + m[1] * daylight[2][j + k];
    v[i] = e[0] + t * (e[1] - e[0]);
  }
  add_illuminant(s, prefix, name, v);
}
static void add_fluorescent(state *s, const char *name, const double values[81]) {
  double v[LAMBDA_COUNT];
  for (int i = 0; i < LAMBDA_COUNT; i++) {
    double x = (i - 20) / 5.0;
    x = x < 0 ? 0 : x > 80 ? 80 : x;
    int j = (int)x < 79 ? (int)x : 79;
    v[i] = values[j] + (x - j) * (values[j + 1] - values[j]);
  }
  add_illuminant(s, "stdillum-", name, v);
}

static void add_all(state *s) {
  add_metal(s, "Ag", "-eta", Ag_eta);
  add_metal(s, "Ag", "-k", Ag_k);
  add_metal(s, "Al", "-eta", Al_eta);
  add_metal(s, "Al", "-k", Al_k);
  add_metal(s, "Au", "-eta", Au_eta);
  add_metal(s, "Au", "-k", Au_k);
  add_metal(s, "Cu", "-eta", Cu_eta);
  add_metal(s, "Cu", "-k", Cu_k);
  add_brass(s, "-eta", CuZn_eta);
  add_brass(s, "-k", CuZn_k);
#define POINTS(a) a, (int)(sizeof(a) / sizeof(a)[0])
  add_points(s, "MgO", "-eta", POINTS(MgO_eta));
  add_points(s, "MgO", "-k", POINTS(MgO_k));
  add_points(s, "TiO2", "-eta", POINTS(TiO2_eta));
  add_points(s, "TiO2", "-k", POINTS(TiO2_k));
#undef POINTS
  for (size_t i = 0; i < sizeof glasses / sizeof *glasses; i++) {
    add_glass(s, glasses[i].name, &glasses[i]);
    /* pbrt's names omit the S: F5 is SF5 */
    if (glasses[i].name[0] == 'S')
      add_glass(s, glasses[i].name + 1, &glasses[i]);
  }
  /* Illuminant A: Planck's law at 2848 K with the second radiation constant of that time (CIE
   * 15) */
  double a[LAMBDA_COUNT];
  for (int i = 0; i < LAMBDA_COUNT; i++) {
    double l = LAMBDA_MIN + i;
    a[i] = vl_precise_pow(560 / l, 5) * vl_precise_expm1(1.435e7 / (2848.0 * 560)) /
           vl_precise_expm1(1.435e7 / (2848.0 * l));
  }
  add_illuminant(s, "stdillum-", "A", a);
  add_daylight(s, "stdillum-", "D50", daylight_D50);
  add_daylight(s, "stdillum-", "D60", daylight_D60);
  add_daylight(s, "illum-", "acesD60", daylight_D60);
  add_daylight(s, "stdillum-", "D65", daylight_D65);
  const double *f[12] = {illuminant_F1_5nm,  illuminant_F2_5nm,  illuminant_F3_5nm,
                         illuminant_F4_5nm,  illuminant_F5_5nm,  illuminant_F6_5nm,
                         illuminant_F7_5nm,  illuminant_F8_5nm,  illuminant_F9_5nm,
                         illuminant_F10_5nm, illuminant_F11_5nm, illuminant_F12_5nm};
  for (int i = 0; i < 12; i++) {
    char name[8];
    snprintf(name, sizeof name, "F%d", i + 1);
    add_fluorescent(s, name, f[i]);
  }
}

/* ---- colour spaces ----------------------------------------------------------------------- */

static void invert(const double m[9], double r[9]) {
  double c[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      int a = (i + 1) % 3, b = (i + 2) % 3, p = (j + 1) % 3, q = (j + 2) % 3;
      c[3 * j + i] = m[3 * a + p] * m[3 * b + q] - m[3 * a + q] * m[3 * b + p];
    }
  double det = m[0] * c[0] + m[1] * c[3] + m[2] * c[6];
  for (int i = 0; i < 9; i++)
    r[i] = c[i] / det;
}

static int find(const state *s, const char *name) {
  for (int i = 0; i < s->count; i++)
    if (strcmp(s->list[i].name, name) == 0)
      return i;
  abort();
}

/* The primaries are the published ones. The white is the illuminant's own colour, so it is
 * exactly (1, 1, 1). */
static void make_space(const state *s, space *p, const double primaries[6],
                       const char *illuminant_name) {
  p->illuminant = find(s, illuminant_name);
  const float *illuminant = s->list[p->illuminant].values;
  double white[3] = {0}, m[9], inverse[9];
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < LAMBDA_COUNT; i++)
      white[k] += (double)s->cie[k][i] * (double)illuminant[i];
    white[k] /= y_integral(s);
  }
  memcpy(p->xy, primaries, 6 * sizeof(double));
  p->xy[6] = white[0] / (white[0] + white[1] + white[2]);
  p->xy[7] = white[1] / (white[0] + white[1] + white[2]);
  for (int j = 0; j < 3; j++) {
    double x = primaries[2 * j], y = primaries[2 * j + 1];
    m[j] = x;
    m[3 + j] = y;
    m[6 + j] = 1 - x - y;
  }
  invert(m, inverse);
  for (int j = 0; j < 3; j++) {
    double scale = inverse[3 * j] * white[0] + inverse[3 * j + 1] * white[1] +
                   inverse[3 * j + 2] * white[2];
    for (int i = 0; i < 3; i++)
      p->xyz_from_rgb[3 * i + j] = m[3 * i + j] * scale;
  }
  invert(p->xyz_from_rgb, p->rgb_from_xyz);
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < LAMBDA_COUNT; i++) {
      double w = 0;
      for (int k = 0; k < 3; k++)
        w += p->rgb_from_xyz[3 * j + k] * (double)s->cie[k][i];
      p->weight[j][i] = w * (double)illuminant[i] / y_integral(s);
    }
}
static void make_spaces(const state *s, space spaces[SPACE_COUNT]) {
  static const double srgb[6] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06}; /* ITU-R BT.709 */
  static const double p3[6] = {0.68, 0.32, 0.265, 0.69, 0.15, 0.06};  /* SMPTE EG 432-1, D65 */
  /* ITU-R BT.2020 */
  static const double rec2020[6] = {0.708, 0.292, 0.17, 0.797, 0.131, 0.046};
  /* SMPTE ST 2065-1 */
  static const double aces[6] = {0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077};
  make_space(s, &spaces[0], srgb, "stdillum-D65");
  make_space(s, &spaces[1], p3, "stdillum-D65");
  make_space(s, &spaces[2], rec2020, "stdillum-D65");
  make_space(s, &spaces[3], aces, "illum-acesD60");
}

/* ---- writing ----------------------------------------------------------------------------- */

void write_floats(FILE *file, const float *v, int count, int stride) {
  for (int i = 0; i < count; i++) {
    fprintf(file, "%s%.9g%s,", i % 10 ? " " : "\n    ", (double)v[i * stride],
            v[i * stride] == floorf(v[i * stride]) ? ".0f" : "f");
  }
}
static void write_doubles(FILE *file, const double *v, int count) {
  fprintf(file, "{");
  for (int i = 0; i < count; i++)
    fprintf(file, "%s%.17g", i ? ", " : "", v[i]);
  fprintf(file, "}, ");
}

static int by_name(const void *a, const void *b) {
  return strcmp(((const named *)a)->name, ((const named *)b)->name);
}

static state all;

void make_spectra(space spaces[SPACE_COUNT]) {
  const double *cmf[3] = {cie_x_5nm, cie_y_5nm, cie_z_5nm};
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < LAMBDA_COUNT; i++)
      all.cie[k][i] = (float)sprague(cmf[k], 95, LAMBDA_MIN + i);
  add_all(&all);
  qsort(all.list, (size_t)all.count, sizeof *all.list, by_name);
  make_spaces(&all, spaces);
}

bool write_spectra(FILE *file, const space spaces[SPACE_COUNT]) {
  static float shares[LAMBDA_COUNT][3];
  if (!make_channels(&spaces[0], shares))
    return false;
  fprintf(
      file,
      "/* Written by tools/color_tables. */\n#include \"color/sensor.h\"\n#include \"color/tables.h\"\n\n");
  fprintf(file, "const double vl_table_y_integral = %.17g;\n", y_integral(&all));
  fprintf(file, "const double vl_table_daylight[3][VL_DAYLIGHT_COUNT] = {");
  for (int k = 0; k < 3; k++)
    write_doubles(file, daylight[k], DAYLIGHT_COUNT);
  fprintf(file, "};\n");
  fprintf(file, "const float vl_table_cie[3][VL_LAMBDA_COUNT] = {");
  for (int k = 0; k < 3; k++) {
    fprintf(file, "\n  {");
    write_floats(file, all.cie[k], LAMBDA_COUNT, 1);
    fprintf(file, "},");
  }
  fprintf(
      file,
      "\n};\n__attribute__((aligned(64))) const float vl_cie_xyz0[VL_LAMBDA_COUNT * 4] = {");
  for (int i = 0; i < LAMBDA_COUNT; i++) {
    float v[4] = {all.cie[0][i], all.cie[1][i], all.cie[2][i], 0};
    write_floats(file, v, 4, 1);
  }
  fprintf(file,
          "\n};\n__attribute__((aligned(64))) const float vl_channel_shares[VL_LAMBDA_COUNT * "
          "4] = {");
  for (int i = 0; i < LAMBDA_COUNT; i++) {
    float v[4] = {shares[i][0], shares[i][1], shares[i][2], 0};
    write_floats(file, v, 4, 1);
  }
  fprintf(file,
          "\n};\nconst uint32_t vl_table_named_count = %d;\nconst vlNamedTable "
          "vl_table_named[] = {",
          all.count);
  for (int i = 0; i < all.count; i++) {
    fprintf(file, "\n  {\"%s\", %.9g, {", all.list[i].name, sum_y(&all, all.list[i].values));
    write_floats(file, all.list[i].values, LAMBDA_COUNT, 1);
    fprintf(file, "}},");
  }
  fprintf(file, "\n};\nconst vlSpaceTable vl_table_spaces[4] = {");
  for (int i = 0; i < SPACE_COUNT; i++) {
    fprintf(file, "\n  {");
    write_doubles(file, spaces[i].xy, 8);
    write_doubles(file, spaces[i].xyz_from_rgb, 9);
    write_doubles(file, spaces[i].rgb_from_xyz, 9);
    fprintf(file, "%d},", spaces[i].illuminant);
  }
  fprintf(file, "\n};\n");
  write_curves(file);
  return true;
}
