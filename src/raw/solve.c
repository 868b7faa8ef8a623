/* raw/solve.c: small systems of linear equations. */
#include <math.h>
#include <string.h>

#include "raw/raw.h"

enum { MAX_UNKNOWNS = 4 };

/* Swaps row `at` with the row below whose number in column `at` is the greatest, which is
 * returned. */
static double choose_pivot(uint32_t n, uint32_t at, double a[MAX_UNKNOWNS][2 * MAX_UNKNOWNS]) {
  uint32_t best = at;
  double row[2 * MAX_UNKNOWNS];
  for (uint32_t i = at + 1; i < n; i++)
    if (fabs(a[i][at]) > fabs(a[best][at]))
      best = i;
  memcpy(row, a[at], sizeof row);
  memcpy(a[at], a[best], sizeof row);
  memcpy(a[best], row, sizeof row);
  return fabs(a[at][at]);
}

/* Gaussian elimination with row pivots (Golub and Van Loan, Matrix Computations, 3.4). */
bool vl_raw_solve(uint32_t n, const double *a, uint32_t columns, const double *b, double *x) {
  double work[MAX_UNKNOWNS][2 * MAX_UNKNOWNS] = {{0}}, greatest = 0.0;
  for (uint32_t i = 0; i < n; i++) {
    for (uint32_t k = 0; k < n; k++) {
      work[i][k] = a[i * n + k];
      greatest = fmax(greatest, fabs(work[i][k]));
    }
    for (uint32_t k = 0; k < columns; k++)
      work[i][n + k] = b[i * columns + k];
  }
  for (uint32_t at = 0; at < n; at++) {
    if (!(choose_pivot(n, at, work) > 1e-12 * greatest))
      return false;
    for (uint32_t i = 0; i < n; i++) {
      double factor = work[i][at] / work[at][at];
      for (uint32_t k = at; i != at && k < n + columns; k++)
        work[i][k] -= factor * work[at][k];
    }
  }
  for (uint32_t i = 0; i < n; i++)
    for (uint32_t k = 0; k < columns; k++)
      x[i * columns + k] = work[i][n + k] / work[i][i];
  return true;
}
