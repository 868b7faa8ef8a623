/* camera/verify_corners.c: finds chessboard corners in an image and refines each to a hundredth
 * of a pixel.
 *   1. Detection: maxima of -det of the Hessian of the smoothed image (saddle points).
 *   2. First refinement: the point orthogonal to all gradients around it (Foerstner and Guelch
 *      1987; OpenCV's cornerSubPix). The gradient is orthogonal to an edge, and both edges pass
 *      through the corner.
 *   3. Second refinement: lens distortion curves the edges, which biases step 2 by some
 *      hundredths of a pixel. The model m + a erf(f1/s) erf(f2/s) of two curved, blurred edges
 *      is fitted to the pixels by least squares. A window that the model does not fit is
 *      rejected. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera/verify.h"

enum { BLUR = 4, REACH = 9, UNKNOWNS = 9 };

/* ---- finding ----------------------------------------------------------------------------- */

static double at(const Image *p, int x, int y) {
  x = x < 0 ? 0 : x >= p->width ? p->width - 1 : x;
  y = y < 0 ? 0 : y >= p->height ? p->height - 1 : y;
  return (double)p->pixels[(size_t)y * (size_t)p->width + (size_t)x];
}

static void smooth(const Image *from, bool vertical, float *to) {
  double kernel[2 * BLUR + 1], sum = 0.0;
  for (int i = -BLUR; i <= BLUR; i++)
    sum += kernel[i + BLUR] = exp(-0.5 * i * i / (1.3 * 1.3));
  for (int y = 0; y < from->height; y++)
    for (int x = 0; x < from->width; x++) {
      double value = 0.0;
      for (int i = -BLUR; i <= BLUR; i++)
        value += kernel[i + BLUR] * (vertical ? at(from, x, y + i) : at(from, x + i, y));
      to[(size_t)y * (size_t)from->width + (size_t)x] = (float)(value / sum);
    }
}

/* -det of the Hessian of each pixel. */
static void saddles(const Image *p, float *to) {
  for (int y = 0; y < p->height; y++)
    for (int x = 0; x < p->width; x++) {
      double middle = at(p, x, y);
      double xx = at(p, x - 1, y) + at(p, x + 1, y) - 2.0 * middle;
      double yy = at(p, x, y - 1) + at(p, x, y + 1) - 2.0 * middle;
      double xy = 0.25 * (at(p, x - 1, y - 1) + at(p, x + 1, y + 1) - at(p, x + 1, y - 1) -
                          at(p, x - 1, y + 1));
      to[(size_t)y * (size_t)p->width + (size_t)x] = (float)(xy * xy - xx * yy);
    }
}

static bool is_peak(const Image *p, int x, int y, double min) {
  double here = at(p, x, y);
  if (here < min)
    return false;
  for (int j = -2; j <= 2; j++)
    for (int i = -2; i <= 2; i++)
      if ((i || j) && at(p, x + i, y + j) >= here)
        return false;
  return true;
}

int corners_find(const Image *image, Corner *corners, int room) {
  size_t n = (size_t)image->width * (size_t)image->height;
  float *a = malloc(n * sizeof *a), *b = malloc(n * sizeof *b);
  int count = a && b ? 0 : -1;
  if (count == 0) {
    float low = FLT_MAX, high = -FLT_MAX;
    for (size_t i = 0; i < n; i++) {
      low = fminf(low, image->pixels[i]);
      high = fmaxf(high, image->pixels[i]);
    }
    double contrast = (double)high - (double)low;
    Image half = {image->width, image->height, a}, whole = {image->width, image->height, b};
    smooth(image, false, a);
    smooth(&half, true, b);
    saddles(&whole, a);
    /* two orthogonal edges give about 0.03 contrast^2, edges at 20 degrees a tenth of that */
    double min = 0.002 * contrast * contrast;
    for (int y = 3; y < image->height - 3 && contrast > 0.0; y++)
      for (int x = 3; x < image->width - 3 && count < room; x++)
        if (is_peak(&half, x, y, min))
          corners[count++] = (Corner){x + 0.5, y + 0.5, at(&half, x, y)};
  }
  free(a);
  free(b);
  return count;
}

/* ---- refining, first --------------------------------------------------------------------- */

/* Gradients by Scharr's 3 x 3 differences at whole pixels. The weights are symmetric about the
 * current estimate of the corner. */
static bool right_angles(const Image *p, double reach, Corner *corner) {
  for (int step = 0; step < 20; step++) {
    double a = 0.0, b = 0.0, c = 0.0, u = 0.0, v = 0.0;
    int x0 = (int)floor(corner->x - reach), y0 = (int)floor(corner->y - reach);
    for (int y = y0; y <= y0 + 2 * (int)reach + 1; y++)
      for (int x = x0; x <= x0 + 2 * (int)reach + 1; x++) {
        double px = x + 0.5, py = y + 0.5, dx = px - corner->x, dy = py - corner->y,
               d2 = dx * dx + dy * dy;
        if (d2 > reach * reach)
          continue;
        double weight = exp(-2.0 * d2 / (reach * reach));
        double gx = 3.0 * (at(p, x + 1, y - 1) - at(p, x - 1, y - 1) + at(p, x + 1, y + 1) -
                           at(p, x - 1, y + 1)) +
                    10.0 * (at(p, x + 1, y) - at(p, x - 1, y));
        double gy = 3.0 * (at(p, x - 1, y + 1) - at(p, x - 1, y - 1) + at(p, x + 1, y + 1) -
                           at(p, x + 1, y - 1)) +
                    10.0 * (at(p, x, y + 1) - at(p, x, y - 1));
        double xx = weight * gx * gx, xy = weight * gx * gy, yy = weight * gy * gy;
        a += xx;
        b += xy;
        c += yy;
        u += xx * dx + xy * dy;
        v += xy * dx + yy * dy;
      }
    double det = a * c - b * b;
    if (!(det > 1e-6 * (a + c) * (a + c)))
      return false;
    double dx = (c * u - b * v) / det, dy = (a * v - b * u) / det;
    if (!(dx * dx + dy * dy < reach * reach))
      return false;
    corner->x += dx;
    corner->y += dy;
    if (dx * dx + dy * dy < 1e-8)
      return true;
  }
  return true;
}

/* ---- refining, then: nine unknowns ------------------------------------------------------- */

enum { MEAN, CONTRAST, SHARPNESS, X, Y, TURN1, TURN2, BEND1, BEND2 };

/* The model at (px, py) and its derivatives by the unknowns. Edge i is where f = n.d +
 * curvature/2 (t.d)^2 = 0. */
static double model(const double *q, double px, double py, double *by) {
  double dx = px - q[X], dy = py - q[Y], k = 1.0 / q[SHARPNESS], g[2], slope[2], f[2], nx[2],
         ny[2], n[2], t[2];
  for (int i = 0; i < 2; i++) {
    nx[i] = cos(q[TURN1 + i]);
    ny[i] = sin(q[TURN1 + i]);
    n[i] = nx[i] * dx + ny[i] * dy;
    t[i] = nx[i] * dy - ny[i] * dx;
    f[i] = n[i] + 0.5 * q[BEND1 + i] * t[i] * t[i];
    g[i] = erf(f[i] * k);
    slope[i] = 1.12837916709551257390 * k * exp(-f[i] * f[i] * k * k);
  }
  by[MEAN] = 1.0;
  by[CONTRAST] = g[0] * g[1];
  by[SHARPNESS] = by[X] = by[Y] = 0.0;
  for (int i = 0; i < 2; i++) {
    double outer = q[CONTRAST] * g[1 - i] * slope[i], bend = q[BEND1 + i] * t[i];
    by[SHARPNESS] -= outer * f[i] * k;
    by[X] -= outer * (nx[i] - bend * ny[i]);
    by[Y] -= outer * (ny[i] + bend * nx[i]);
    by[TURN1 + i] = outer * (t[i] - bend * n[i]);
    by[BEND1 + i] = outer * 0.5 * t[i] * t[i];
  }
  return q[MEAN] + q[CONTRAST] * g[0] * g[1];
}

/* Solves m x = r for a positive definite m, in place, by Cholesky decomposition. */
static bool solve(double m[UNKNOWNS][UNKNOWNS], double r[UNKNOWNS]) {
  for (int i = 0; i < UNKNOWNS; i++)
    for (int j = 0; j <= i; j++) {
      double sum = m[i][j];
      for (int k = 0; k < j; k++)
        sum -= m[i][k] * m[j][k];
      if (i == j && !(sum > 0.0))
        return false;
      m[i][j] = i == j ? sqrt(sum) : sum / m[j][j];
    }
  for (int i = 0; i < UNKNOWNS; i++) {
    for (int k = 0; k < i; k++)
      r[i] -= m[i][k] * r[k];
    r[i] /= m[i][i];
  }
  for (int i = UNKNOWNS - 1; i >= 0; i--) {
    for (int k = i + 1; k < UNKNOWNS; k++)
      r[i] -= m[k][i] * r[k];
    r[i] /= m[i][i];
  }
  return true;
}

typedef struct Window {
  int count;
  double x[4 * REACH * REACH + 16], y[4 * REACH * REACH + 16], value[4 * REACH * REACH + 16],
      weight[4 * REACH * REACH + 16];
} Window;

static void cut_window(const Image *p, double reach, const Corner *corner, Window *w) {
  w->count = 0;
  int x0 = (int)floor(corner->x - reach), y0 = (int)floor(corner->y - reach);
  for (int y = y0; y <= y0 + 2 * (int)reach + 1; y++)
    for (int x = x0; x <= x0 + 2 * (int)reach + 1; x++) {
      double px = x + 0.5, py = y + 0.5,
             d2 = pow(px - corner->x, 2.0) + pow(py - corner->y, 2.0);
      if (d2 > reach * reach)
        continue;
      int i = w->count++;
      w->x[i] = px;
      w->y[i] = py;
      w->value[i] = at(p, x, y);
      w->weight[i] = exp(-0.5 * d2 / (reach * reach));
    }
}

static double misfit(const Window *w, const double *q) {
  double by[UNKNOWNS], sum = 0.0;
  for (int i = 0; i < w->count; i++)
    sum += w->weight[i] * pow(model(q, w->x[i], w->y[i], by) - w->value[i], 2.0);
  return sum;
}

/* Initial values: the edges lie along the saddle's two directions of zero curvature, found by a
 * quadratic fit to the pixels. */
static bool begin(const Window *w, const Corner *corner, double *q) {
  double xx = 0.0, xy = 0.0, yy = 0.0, sxx = 0.0, sxy = 0.0, mean = 0.0, mean2 = 0.0,
         total = 0.0;
  for (int i = 0; i < w->count; i++) {
    double dx = w->x[i] - corner->x, dy = w->y[i] - corner->y;
    mean += w->weight[i] * w->value[i];
    mean2 += w->weight[i] * w->value[i] * w->value[i];
    total += w->weight[i];
    sxx += w->weight[i] * (dx * dx - dy * dy) * (dx * dx - dy * dy);
    sxy += w->weight[i] * dx * dx * dy * dy;
  }
  mean /= total;
  for (int i = 0; i < w->count; i++) {
    double dx = w->x[i] - corner->x, dy = w->y[i] - corner->y,
           v = w->weight[i] * (w->value[i] - mean);
    xx += v * (dx * dx - dy * dy);
    xy += v * dx * dy;
    yy += v * (dx * dx + dy * dy);
  }
  /* value - mean = A (x^2 - y^2) + B x y */
  double a = xx / sxx, b = xy / sxy, turn = 0.5 * atan2(b, 2.0 * a);
  if (!(a * a + b * b > 0.0))
    return false;
  q[MEAN] = mean;
  q[CONTRAST] = sqrt(fmax(mean2 / total - mean * mean, 0.0));
  q[SHARPNESS] = 1.2;
  q[X] = corner->x;
  q[Y] = corner->y;
  /* `turn` is the direction of largest increase; both edge functions have the same sign
   * there */
  q[TURN1] = turn - 0.25 * M_PI;
  q[TURN2] = turn + 0.25 * M_PI;
  q[BEND1] = q[BEND2] = 0.0;
  return true;
}

/* Levenberg-Marquardt iterations. */
static double fit(const Window *w, double *q) {
  double lambda = 1e-3, error = misfit(w, q);
  for (int step = 0; step < 40; step++) {
    double m[UNKNOWNS][UNKNOWNS] = {{0}}, r[UNKNOWNS] = {0}, by[UNKNOWNS], trial[UNKNOWNS];
    for (int i = 0; i < w->count; i++) {
      double d = w->value[i] - model(q, w->x[i], w->y[i], by);
      for (int j = 0; j < UNKNOWNS; j++) {
        r[j] += w->weight[i] * by[j] * d;
        for (int k = 0; k <= j; k++)
          m[j][k] += w->weight[i] * by[j] * by[k];
      }
    }
    for (int j = 0; j < UNKNOWNS; j++)
      m[j][j] = m[j][j] * (1.0 + lambda) + 1e-12;
    m[BEND1][BEND1] += 1e-2;
    m[BEND2][BEND2] += 1e-2; /* prior: edges are nearly straight */
    r[BEND1] -= 1e-2 * q[BEND1];
    r[BEND2] -= 1e-2 * q[BEND2];
    if (!solve(m, r))
      return INFINITY;
    for (int j = 0; j < UNKNOWNS; j++)
      trial[j] = q[j] + r[j];
    trial[SHARPNESS] = fmin(fmax(trial[SHARPNESS], 0.3), 5.0);
    double after = misfit(w, trial);
    if (!(after < error)) {
      lambda *= 8.0;
      if (lambda > 1e6)
        break;
      continue;
    }
    double moved = fabs(trial[X] - q[X]) + fabs(trial[Y] - q[Y]), gain = error - after;
    memcpy(q, trial, sizeof trial);
    error = after;
    lambda *= 0.2;
    if (moved < 1e-6 && gain < 1e-6 * error + 1e-15)
      break;
  }
  return error;
}

bool corner_refine(const Image *image, double reach, Corner *corner) {
  Corner found = *corner;
  Window window;
  double q[UNKNOWNS];
  reach = fmin(reach, REACH - 1.0);
  if (!right_angles(image, reach, &found))
    return false;
  if (hypot(found.x - corner->x, found.y - corner->y) > 2.5)
    return false;
  cut_window(image, reach, &found, &window);
  if (!begin(&window, &found, q))
    return false;
  double error = fit(&window, q), weight = 0.0;
  for (int i = 0; i < window.count; i++)
    weight += window.weight[i];
  if (!(sqrt(error / weight) < 0.06 * fabs(q[CONTRAST])))
    return false;
  if (fabs(sin(q[TURN1] - q[TURN2])) < 0.25 || hypot(q[X] - found.x, q[Y] - found.y) > 1.0)
    return false;
  corner->x = q[X];
  corner->y = q[Y];
  return true;
}
