/* rgb.c: RGB to spectrum (Jakob and Hanika 2019, with the changes described in
 * color/rgb_table.h). For every node of the table it computes the coefficients whose sigmoid
 * has the node's colour under the space's illuminant. If no such spectrum exists (the colour is
 * outside the gamut of real surfaces), it computes the nearest one in XYZ, slightly
 * regularised.
 *
 * The method is Levenberg-Marquardt with three unknowns in double precision. It uses only + - *
 * / sqrt, so the table has the same bits on every machine. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "color/rgb_table.h"
#include "tables.h"

enum { BLOCK = 8, PADDED = (LAMBDA_COUNT + BLOCK - 1) / BLOCK * BLOCK };

/* A polynomial in u = 2 t - 1, which lies in [-1, 1]: p0 + p1 u + p2 (u^2 - 1/3). */
typedef struct poly {
  double p[3];
} poly;

/* The problem for one space: colour = sum of weight * sigmoid(poly), in XYZ relative to the
 * white's XYZ. */
typedef struct problem {
  double weight[3][PADDED];
  double u[PADDED], v[PADDED];
  double xyz_from_rgb[9]; /* the white is (1, 1, 1) in both RGB and XYZ */
} problem;

static void setup(problem *q, const space *s) {
  memset(q, 0, sizeof *q);
  for (int i = 0; i < LAMBDA_COUNT; i++) {
    q->u[i] = i * (2.0 / (LAMBDA_COUNT - 1)) - 1.0;
    q->v[i] = q->u[i] * q->u[i] - 1.0 / 3.0;
  }
  for (int k = 0; k < 3; k++) {
    const double *row = s->xyz_from_rgb + 3 * k;
    double white = row[0] + row[1] + row[2];
    for (int j = 0; j < 3; j++)
      q->xyz_from_rgb[3 * k + j] = row[j] / white;
    for (int i = 0; i < LAMBDA_COUNT; i++)
      for (int j = 0; j < 3; j++)
        q->weight[k][i] += row[j] / white * s->weight[j][i];
  }
}

/* Computes the colour and its derivatives (row k: component, column: unknown). Sums have 8
 * lanes, so that compilers vectorise the loop without reassociation. */
static void evaluate(const problem *q, const poly *c, double value[3], double jacobian[9]) {
  double sum[12][BLOCK] = {{0}};
  for (int start = 0; start < PADDED; start += BLOCK) {
    for (int l = 0; l < BLOCK; l++) {
      int i = start + l;
      double x = c->p[0] + c->p[1] * q->u[i] + c->p[2] * q->v[i];
      double square = 1.0 + x * x, root = sqrt(square);
      double s = 0.5 + 0.5 * (x / root), d = 0.5 / (root * square);
      for (int k = 0; k < 3; k++) {
        double w = q->weight[k][i], wd = w * d;
        sum[4 * k][l] += w * s;
        sum[4 * k + 1][l] += wd;
        sum[4 * k + 2][l] += wd * q->u[i];
        sum[4 * k + 3][l] += wd * q->v[i];
      }
    }
  }
  for (int k = 0; k < 3; k++) {
    double t[4] = {0};
    for (int j = 0; j < 4; j++)
      for (int l = 0; l < BLOCK; l++)
        t[j] += sum[4 * k + j][l];
    value[k] = t[0];
    for (int j = 0; j < 3; j++)
      jacobian[3 * k + j] = t[1 + j];
  }
}

/* Solves a x = b for a symmetric positive definite a. b becomes x. */
static bool solve3(double a[9], double b[3]) {
  for (int k = 0; k < 3; k++) {
    if (!(a[4 * k] > 0))
      return false;
    for (int i = k + 1; i < 3; i++) {
      double f = a[3 * i + k] / a[4 * k];
      for (int j = k; j < 3; j++)
        a[3 * i + j] -= f * a[3 * k + j];
      b[i] -= f * b[k];
    }
  }
  for (int k = 2; k >= 0; k--) {
    for (int j = k + 1; j < 3; j++)
      b[k] -= a[3 * k + j] * b[j];
    b[k] /= a[4 * k];
  }
  return true;
}

/* The objective: the squared distance from the target, plus a small multiple of |p|^2 and of
 * |p|^4. These two terms hardly affect colours that can be reached (scaled |p| below 30). For
 * other colours they keep the spectrum from becoming steeper without limit. */
typedef struct pull {
  double square, fourth;
} pull;
static double square_of(const poly *c) {
  return c->p[0] * c->p[0] + c->p[1] * c->p[1] + c->p[2] * c->p[2];
}
static double cost_of(const double value[3], const double target[3], const poly *c, pull w) {
  double cost = 0, square = square_of(c);
  for (int k = 0; k < 3; k++)
    cost += (value[k] - target[k]) * (value[k] - target[k]);
  return cost + w.square * square + w.fourth * square * square;
}

/* Fits the coefficients, starting from *c. z: the colour's largest component, the unit of
 * errors. scale: the coefficients times scale stay of one magnitude towards black. */
static void fit(const problem *q, const double rgb[3], double z, double scale, poly *c) {
  double target[3], value[3], jacobian[9], damping = 1e-10, zs = z * z * scale * scale;
  pull regular = {1e-11 * zs, 1e-13 * zs * scale * scale};
  for (int k = 0; k < 3; k++) {
    const double *row = q->xyz_from_rgb + 3 * k;
    target[k] = row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2];
  }
  evaluate(q, c, value, jacobian);
  double cost = cost_of(value, target, c, regular);
  for (int round = 0; round < 100; round++) {
    double a[9] = {0}, step[3], slope = regular.square + 2 * regular.fourth * square_of(c);
    for (int i = 0; i < 3; i++) {
      step[i] = -slope * c->p[i];
      for (int k = 0; k < 3; k++) {
        step[i] -= jacobian[3 * k + i] * (value[k] - target[k]);
        for (int j = 0; j < 3; j++)
          a[3 * i + j] += jacobian[3 * k + i] * jacobian[3 * k + j];
      }
    }
    double trace = a[0] + a[4] + a[8];
    for (int i = 0; i < 3; i++)
      a[4 * i] += slope + damping * (a[4 * i] + 1e-6 * trace);
    if (!solve3(a, step)) {
      damping = damping * 100 + 1e-12;
      continue;
    }
    /* Limits the step: a spectrum that is 0 or 1 everywhere has no derivative that leads
     * back. */
    double length = sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]),
           size = sqrt(square_of(c));
    double factor = length > 0.5 * size + 0.5 ? (0.5 * size + 0.5) / length : 1.0;
    poly next = *c;
    for (int i = 0; i < 3; i++)
      next.p[i] += factor * step[i];
    double next_value[3], next_jacobian[9];
    evaluate(q, &next, next_value, next_jacobian);
    double next_cost = cost_of(next_value, target, &next, regular);
    if (next_cost < cost) {
      bool done = factor == 1.0 && damping < 1e-3 && (cost - next_cost) < 1e-3 * cost;
      *c = next;
      cost = next_cost;
      memcpy(value, next_value, sizeof value);
      memcpy(jacobian, next_jacobian, sizeof jacobian);
      damping = damping > 1e-9 ? damping * 0.1 : damping;
      double worst = 0;
      for (int k = 0; k < 3; k++)
        worst = fmax(worst, fabs(value[k] - target[k]));
      if (done || worst < 1e-7 * z)
        return;
    } else {
      if (damping > 1e6)
        return;
      damping = damping < 1e-4 ? 1e-3 : damping * 10;
    }
  }
}

/* ---- the walk over the nodes ------------------------------------------------------------- */

enum { NX = VL_RGB_TABLE_XY, NZ = VL_RGB_TABLE_Z };

static double node_of(int i, int size) {
  return (double)vl_rgb_axis_value((float)i * (1.0f / (float)(size - 1)));
}
/* The factor that makes coefficients a smooth function of the colour towards black. */
static double scale_of(const double rgb[3]) {
  double m = (rgb[0] + rgb[1] + rgb[2]) / 3;
  return sqrt(m * (1 - m));
}

/* Scaled coefficients of the nodes of one face, indexed [z][y][x]. */
typedef struct face {
  poly node[NZ][NX][NX];
} face;

static void store(const poly *c, float *out) {
  /* u = 2 t - 1 */
  out[0] = (float)(4 * c->p[2]);
  out[1] = (float)(2 * c->p[1] - 4 * c->p[2]);
  out[2] = (float)(c->p[0] - c->p[1] + c->p[2] * (2.0 / 3.0));
}

/* Whether a node can be used. The table is read only for colours with z + smallest component <=
 * 1. A node that belongs to no cell of such a colour is not solved and takes a neighbour's
 * value. */
static bool is_used(double z_below, double x_below, double y_below) {
  return z_below * (1 + fmin(x_below, y_below)) <= 1;
}

void solve_space(const space *s, float *coefficients) {
  static problem q;
  static face f;
  setup(&q, s);
  for (int big = 0; big < 3; big++) {
    for (int k = 0; k < NZ; k++) {
      double z = node_of(k, NZ);
      /* At black and at 1 the scaled coefficients have limits, which are computed slightly
       * above 0 and slightly below 1. */
      z = fmin(fmax(z, 1e-6), 1 - 1e-6);
      for (int j = NX - 1; j >= 0; j--) {
        for (int i = NX - 1; i >= 0; i--) {
          poly *n = &f.node[k][j][i], guess;
          double x = node_of(i, NX), y = node_of(j, NX), rgb[3];
          rgb[big] = z;
          rgb[(big + 1) % 3] = x * z;
          rgb[(big + 2) % 3] = y * z;
          double scale = scale_of(rgb);
          bool grey = i == NX - 1 && j == NX - 1;
          if (grey) {
            *n = (poly){{node_of(k, NZ) - 0.5, 0, 0}};
          } else {
            /* the first guess is extrapolated along z from the last two nodes; at the start it
             * is the neighbour nearer to grey */
            if (k == 0)
              guess = i < NX - 1 ? f.node[k][j][i + 1] : f.node[k][j + 1][i];
            else
              guess = f.node[k - 1][j][i];
            if (k > 1) {
              double t = (z - node_of(k - 1, NZ)) / (node_of(k - 1, NZ) - node_of(k - 2, NZ));
              for (int c = 0; c < 3; c++)
                guess.p[c] += t * (guess.p[c] - f.node[k - 2][j][i].p[c]);
            }
            if (is_used(k ? node_of(k - 1, NZ) : 0, i ? node_of(i - 1, NX) : 0,
                        j ? node_of(j - 1, NX) : 0)) {
              for (int c = 0; c < 3; c++)
                guess.p[c] /= scale;
              fit(&q, rgb, z, scale, &guess);

              for (int c = 0; c < 3; c++)
                guess.p[c] *= scale;
            } else {
              guess = f.node[k - 1][j][i];
            }
            *n = guess;
          }
          store(n, coefficients + 3 * (((big * NZ + k) * NX + j) * NX + i));
        }
      }
    }
  }
}
