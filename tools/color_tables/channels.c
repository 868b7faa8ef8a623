/* channels.c: three spectra that divide the light among the channels of linear sRGB (Mallett
 * and Yuksel 2019, Spectral Primary Decomposition). Each is within [0, 1], their sum is 1 at
 * every wavelength, and their colours under the space's illuminant are exactly (1,0,0), (0,1,0)
 * and (0,0,1). Of all such spectra these are the smoothest: they have the smallest sum of
 * squared differences between neighbouring knots.
 *
 * This is a quadratic programme, solved by an active-set method. It uses only + - * /, so the
 * bits are the same on every machine. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "tables.h"

/* Unknowns are the shares of red and green at each knot. The share of blue is 1 minus their
 * sum. Shares are linear between knots. */
enum { STEP = 5, KNOTS = (LAMBDA_COUNT - 1) / STEP + 1, UNKNOWNS = 2 * KNOTS, COLORS = 6 };
enum { CONSTRAINTS = COLORS + 3 * KNOTS, SIZE = UNKNOWNS + CONSTRAINTS, ROUNDS = 200 };
_Static_assert((KNOTS - 1) * STEP + 1 == LAMBDA_COUNT, "the last knot is the last wavelength");

typedef struct programme {
  double color[COLORS][UNKNOWNS], target[COLORS];
  bool active[3 * KNOTS]; /* active[3 j + k]: share k at knot j is held at 0 */
  double a[SIZE][SIZE + 1], x[SIZE];
} programme;

/* Share of channel k (0 to 2) at a knot. */
static double share_at(const double *x, int knot, int k) {
  return k < 2 ? x[k * KNOTS + knot] : 1.0 - x[knot] - x[KNOTS + knot];
}

static void set_colors(programme *p, const space *s) {
  for (int k = 0; k < 2; k++)
    for (int c = 0; c < 3; c++) {
      double *row = p->color[3 * k + c];
      p->target[3 * k + c] = k == c;
      for (int i = 0; i < LAMBDA_COUNT; i++) {
        int j = i / STEP;
        double t = (double)(i % STEP) / STEP;
        row[k * KNOTS + j] += (1.0 - t) * s->weight[c][i];
        if (t > 0)
          row[k * KNOTS + j + 1] += t * s->weight[c][i];
      }
    }
}

/* Gaussian elimination with pivoting of the first n rows. Column n of a is the right-hand
 * side. */
static bool solve(programme *p, int n) {
  for (int k = 0; k < n; k++) {
    int best = k;
    for (int i = k + 1; i < n; i++)
      if (fabs(p->a[i][k]) > fabs(p->a[best][k]))
        best = i;
    if (!(fabs(p->a[best][k]) > 1e-14))
      return false;
    for (int j = k; best != k && j <= n; j++) {
      double swap = p->a[k][j];
      p->a[k][j] = p->a[best][j];
      p->a[best][j] = swap;
    }
    for (int i = k + 1; i < n; i++) {
      double f = p->a[i][k] / p->a[k][k];
      for (int j = k; f != 0 && j <= n; j++)
        p->a[i][j] -= f * p->a[k][j];
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    double sum = p->a[k][n];
    for (int j = k + 1; j < n; j++)
      sum -= p->a[k][j] * p->x[j];
    p->x[k] = sum / p->a[k][k];
  }
  return true;
}

/* Computes the smoothest shares, with the active constraints as equations. x: the unknowns,
 * then the Lagrange multipliers. */
static bool solve_active(programme *p) {
  int n = UNKNOWNS + COLORS;
  for (int i = 0; i < 3 * KNOTS; i++)
    n += p->active[i];
  for (int i = 0; i < n; i++)
    memset(p->a[i], 0, sizeof p->a[i]);
  /* adds the squared differences of red, of green and of their sum */
  for (int j = 0; j + 1 < KNOTS; j++)
    for (int u = 0; u < 2; u++)
      for (int v = 0; v < 2; v++) {
        double w = u == v ? 2.0 : 1.0;
        double *low = p->a[u * KNOTS + j] + v * KNOTS + j,
               *high = p->a[u * KNOTS + j + 1] + v * KNOTS + j;
        low[0] += w;
        low[1] -= w;
        high[0] -= w;
        high[1] += w;
      }
  int row = UNKNOWNS;
  for (int c = 0; c < COLORS; c++, row++) {
    for (int i = 0; i < UNKNOWNS; i++)
      p->a[row][i] = p->a[i][row] = p->color[c][i];
    p->a[row][n] = p->target[c];
  }
  for (int i = 0; i < 3 * KNOTS; i++) {
    if (!p->active[i])
      continue;
    int knot = i / 3, k = i % 3;
    for (int u = 0; u < 2; u++)
      if (k == u || k == 2)
        p->a[row][u * KNOTS + knot] = p->a[u * KNOTS + knot][row] = k == 2 ? -1.0 : 1.0;
    p->a[row++][n] = k == 2 ? -1.0 : 0.0;
  }
  return solve(p, n);
}

/* Activates violated constraints and releases active ones whose multiplier shows that they are
 * no longer needed. Returns true if nothing changed. */
static bool change_active(programme *p) {
  bool same = true;
  int row = UNKNOWNS + COLORS;
  for (int i = 0; i < 3 * KNOTS; i++) {
    if (p->active[i]) {
      bool useless = p->x[row++] > 1e-12;
      p->active[i] = !useless;
      same = same && !useless;
    } else if (share_at(p->x, i / 3, i % 3) < -1e-12) {
      p->active[i] = true;
      same = false;
    }
  }
  return same;
}

bool make_channels(const space *s, float shares[LAMBDA_COUNT][3]) {
  programme *p = calloc(1, sizeof *p);
  bool good = false;
  if (!p)
    return false;
  set_colors(p, s);
  for (int round = 0; round < ROUNDS && !good; round++) {
    if (!solve_active(p))
      break;
    good = change_active(p);
  }
  for (int i = 0; good && i < LAMBDA_COUNT; i++) {
    int j = i / STEP;
    double t = (double)(i % STEP) / STEP;
    for (int k = 0; k < 3; k++) {
      double low = share_at(p->x, j, k), high = j + 1 < KNOTS ? share_at(p->x, j + 1, k) : low;
      double v = low + t * (high - low);
      shares[i][k] = (float)(v > 0 ? v < 1 ? v : 1 : 0);
    }
  }
  free(p);
  return good;
}
