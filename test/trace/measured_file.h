/* measured_file.h: files in the format of the RGL material database for a surface of known
 * reflection: metal with GGX microfacets, measured as Dupuy and Jakob (2018) describe it.
 * Everything is in double precision and the warp is implemented independently, so that a wrong
 * convention in the library does not cancel out. */
#ifndef TEST_TRACE_MEASURED_FILE_H
#define TEST_TRACE_MEASURED_FILE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MF_PI 3.14159265358979323846

typedef struct mfSurface {
  double alpha_x, alpha_y, eta, k; /* k < 0: reflects everything */
  double color;                    /* relative growth of eta and k from 400 to 700 nm */
  uint32_t phis;  /* azimuths of the full circle without the repeated last one; 1: isotropic */
  uint32_t parts; /* 2, 4: only a half or a quarter of the circle is stored */
  uint32_t thetas, nodes, samples, lambdas;
  uint32_t rows; /* of all tables; 0: as many as columns */
  double theta_max;
  bool plain;  /* spectra hold f cos directly */
  double turn; /* of the axis of alpha_x from x, radians */
} mfSurface;

static inline mfSurface mf_surface(double alpha_x, double alpha_y) {
  bool round = alpha_x == alpha_y;
  return (mfSurface){.alpha_x = alpha_x,
                     .alpha_y = alpha_y,
                     .eta = 1.2,
                     .k = 3,
                     .color = 0.3,
                     .phis = round ? 1 : 16,
                     .parts = 1,
                     .thetas = 10,
                     .nodes = 64,
                     .samples = 32,
                     .lambdas = 5,
                     .theta_max = 1.5};
}

/* ---- the surface ---- */

/* Along the axes of alpha_x and alpha_y. */
static inline double mf_along(const mfSurface *s, const double w[3]) {
  return cos(s->turn) * w[0] + sin(s->turn) * w[1];
}
static inline double mf_across(const mfSurface *s, const double w[3]) {
  return cos(s->turn) * w[1] - sin(s->turn) * w[0];
}
static inline double mf_length(const mfSurface *s, const double w[3]) {
  double x = s->alpha_x * mf_along(s, w), y = s->alpha_y * mf_across(s, w);
  return sqrt(x * x + y * y + w[2] * w[2]);
}
static inline double mf_ndf(const mfSurface *s, const double m[3]) {
  double x = mf_along(s, m) / s->alpha_x, y = mf_across(s, m) / s->alpha_y;
  double e = x * x + y * y + m[2] * m[2];
  return 1 / (MF_PI * s->alpha_x * s->alpha_y * e * e);
}
static inline double mf_sigma(const mfSurface *s, const double o[3]) { /* cos / G1 */
  return 0.5 * (mf_length(s, o) + o[2]);
}
static inline double mf_fresnel(double c, double eta, double k) {
  if (k < 0)
    return 1;
  double s2 = 1 - c * c, t0 = eta * eta - k * k - s2,
         ab = sqrt(t0 * t0 + 4 * eta * eta * k * k);
  double a = sqrt(fmax(0, 0.5 * (ab + t0))),
         rs = (ab + c * c - 2 * a * c) / (ab + c * c + 2 * a * c);
  double rp =
      rs * (c * c * ab + s2 * s2 - 2 * a * c * s2) / (c * c * ab + s2 * s2 + 2 * a * c * s2);
  return 0.5 * (rs + rp);
}
static inline double mf_reflected(const mfSurface *s, double c, double lambda) {
  double grow = 1 + s->color * (lambda - 400) / 300;
  return mf_fresnel(c, s->eta * grow, s->k * grow);
}
/* F G / G1(o): f cos w times 4 sigma / D. */
static inline double mf_share(const mfSurface *s, const double o[3], const double w[3],
                              double oh, double lambda) {
  if (w[2] <= 0 || oh <= 0)
    return 0;
  double lo = mf_length(s, o), li = mf_length(s, w);
  return mf_reflected(s, oh, lambda) * w[2] * (lo + o[2]) / (lo * w[2] + li * o[2]);
}
/* f cos w. */
static inline double mf_value(const mfSurface *s, const double o[3], const double w[3],
                              double lambda) {
  double h[3] = {o[0] + w[0], o[1] + w[1], o[2] + w[2]},
         l = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
  for (int i = 0; i < 3; i++)
    h[i] /= l;
  double oh = o[0] * h[0] + o[1] * h[1] + o[2] * h[2];
  return mf_share(s, o, w, oh, lambda) * mf_ndf(s, h) / (4 * mf_sigma(s, o));
}

/* ---- its measurement ---- */

static inline void mf_direction(double theta, double phi, double w[3]) {
  w[0] = sin(theta) * cos(phi);
  w[1] = sin(theta) * sin(phi);
  w[2] = cos(theta);
}
/* The direction of point (x, y) of the square. */
static inline void mf_unwarp(double x, double y, double w[3]) {
  mf_direction(x * x * MF_PI / 2, (2 * y - 1) * MF_PI, w);
}
static inline double mf_between(double a, double b, double t) {
  return a + (b - a) * t;
}
/* The point in [0, 1] up to which the integral of a + (b - a) t is `part` of the whole, by
 * bisection. */
static inline double mf_solve(double a, double b, double part) {
  double low = 0, high = 1, whole = 0.5 * (a + b);
  for (int i = 0; i < 40; i++) {
    double t = 0.5 * (low + high);
    if (t * (a + 0.5 * (b - a) * t) < part * whole)
      low = t;
    else
      high = t;
  }
  return 0.5 * (low + high);
}
/* Integrals of the rows of a bilinear function on n x height nodes. */
static inline void mf_rows(const double *f, uint32_t n, uint32_t height, double *rows) {
  for (uint32_t j = 0; j < height; j++) {
    rows[j] = 0;
    for (uint32_t i = 0; i + 1 < n; i++)
      rows[j] += 0.5 * (f[j * n + i] + f[j * n + i + 1]);
  }
}
/* Samples that function as a density: (u, v) to (x, y); v selects the row, u the position in
 * it. */
static inline void mf_sample(const double *f, const double *rows, uint32_t n, uint32_t height,
                             double u, double v, double *x, double *y) {
  double all = 0, sum = 0;
  for (uint32_t j = 0; j + 1 < height; j++)
    all += 0.5 * (rows[j] + rows[j + 1]);
  uint32_t j = 0;
  for (; j + 2 < height && sum + 0.5 * (rows[j] + rows[j + 1]) < v * all; j++)
    sum += 0.5 * (rows[j] + rows[j + 1]);
  double t = mf_solve(rows[j], rows[j + 1], (v * all - sum) / (0.5 * (rows[j] + rows[j + 1])));
  *y = (j + t) / (height - 1);
  const double *a = f + (size_t)j * n, *b = a + n;
  all = mf_between(rows[j], rows[j + 1], t);
  sum = 0;
  uint32_t i = 0;
  for (;; i++) {
    double part = 0.5 * (mf_between(a[i], b[i], t) + mf_between(a[i + 1], b[i + 1], t));
    if (i + 2 >= n || sum + part >= u * all)
      break;
    sum += part;
  }
  double low = mf_between(a[i], b[i], t), high = mf_between(a[i + 1], b[i + 1], t);
  *x = (i + mf_solve(low, high, (u * all - sum) / fmax(0.5 * (low + high), 1e-300))) / (n - 1);
}

/* ---- the file ---- */

typedef struct mfFile {
  unsigned char *bytes;
  size_t size, room;
} mfFile;
static inline void mf_put(mfFile *f, const void *data, size_t size) {
  if (f->size + size > f->room)
    f->bytes = realloc(f->bytes, f->room = 2 * (f->size + size));
  memcpy(f->bytes + f->size, data, size);
  f->size += size;
}
/* little-endian, like the machine */
static inline void mf_put_number(mfFile *f, uint64_t value, size_t bytes) {
  mf_put(f, &value, bytes);
}

typedef struct mfField {
  const char *name;
  uint32_t type, rank;
  uint64_t shape[5];
  void *values;
  size_t size;
} mfField;

static inline mfField mf_floats(const char *name, uint32_t rank, uint64_t a, uint64_t b,
                                uint64_t c, uint64_t d, uint64_t e) {
  mfField f = {name, 10, rank, {a, b, c, d, e}, NULL, 4};
  for (uint32_t i = 0; i < rank; i++)
    f.size *= f.shape[i];
  f.values = calloc(1, f.size);
  return f;
}

/* The whole file; the caller frees its bytes. */
static inline mfFile mf_measure(const mfSurface *s) {
  uint32_t n = s->nodes, q = s->samples, phis = s->phis == 1 ? 1 : s->phis / s->parts + 1;
  uint32_t n_rows = s->rows ? s->rows : n, q_rows = s->rows ? s->rows : q;
  mfField phi = mf_floats("phi_i", 1, phis, 0, 0, 0, 0),
          theta = mf_floats("theta_i", 1, s->thetas, 0, 0, 0, 0);
  mfField ndf = mf_floats("ndf", 2, n_rows, n, 0, 0, 0),
          sigma = mf_floats("sigma", 2, n_rows, n, 0, 0, 0);
  mfField vndf = mf_floats("vndf", 4, phis, s->thetas, n_rows, n, 0);
  mfField luminance = mf_floats("luminance", 4, phis, s->thetas, q_rows, q, 0);
  mfField spectra = mf_floats("spectra", 5, phis, s->thetas, s->lambdas, q_rows, q);
  mfField lambda = mf_floats("wavelengths", 1, s->lambdas, 0, 0, 0, 0);
  unsigned char scaled = !s->plain;
  char text[] = "metal of GGX microfacets";
  mfField jacobian = {"jacobian", 1, 1, {1}, &scaled, 1},
          description = {"description", 1, 1, {24}, text, 24};
  double *density = calloc((size_t)n_rows * (n + 1), sizeof *density),
         *rows = density + (size_t)n * n_rows;
  float *nm = lambda.values;
  for (uint32_t k = 0; k < s->lambdas; k++)
    nm[k] = 360.0f + (float)k * 470.0f / (float)(s->lambdas - 1);
  for (uint32_t j = 0; j < n_rows; j++)
    for (uint32_t i = 0; i < n; i++) {
      double m[3];
      mf_unwarp((double)i / (n - 1), (double)j / (n_rows - 1), m);
      ((float *)ndf.values)[j * n + i] = (float)mf_ndf(s, m);
      ((float *)sigma.values)[j * n + i] = (float)mf_sigma(s, m);
    }
  for (uint32_t a = 0; a < phis; a++)
    for (uint32_t b = 0; b < s->thetas; b++) {
      double around = phis == 1 ? 0 : -MF_PI + 2 * MF_PI * a / s->phis, o[3];
      double up = s->theta_max * b / (s->thetas - 1);
      ((float *)phi.values)[a] = (float)around;
      ((float *)theta.values)[b] = (float)up;
      mf_direction(up, around, o);
      size_t slice = (size_t)a * s->thetas + b;
      /* azimuths of an isotropic surface's normals are relative to that of o */
      for (uint32_t j = 0; j < n_rows; j++)
        for (uint32_t i = 0; i < n; i++) {
          double x = (double)i / (n - 1), m[3];
          mf_unwarp(x, (double)j / (n_rows - 1), m);
          double oh = o[0] * m[0] + o[1] * m[1] + o[2] * m[2];
          double visible = mf_ndf(s, m) * fmax(0, oh) / mf_sigma(s, o);
          density[j * n + i] = visible * 2 * MF_PI * MF_PI * x * sin(x * x * MF_PI / 2);
          ((float *)vndf.values)[(slice * n_rows + j) * n + i] = (float)density[j * n + i];
        }
      mf_rows(density, n, n_rows, rows);
      for (uint32_t j = 0; j < q_rows; j++)
        for (uint32_t i = 0; i < q; i++) {
          double x, y, m[3], w[3], sum = 0;
          mf_sample(density, rows, n, n_rows, (double)i / (q - 1), (double)j / (q_rows - 1), &x,
                    &y);
          mf_unwarp(x, y, m);
          double oh = o[0] * m[0] + o[1] * m[1] + o[2] * m[2];
          for (int d = 0; d < 3; d++)
            w[d] = 2 * oh * m[d] - o[d];
          for (uint32_t k = 0; k < s->lambdas; k++) {
            double share = mf_share(s, o, w, oh, (double)nm[k]);
            if (s->plain)
              share *= mf_ndf(s, m) / (4 * mf_sigma(s, o));
            ((float *)spectra.values)[((slice * s->lambdas + k) * q_rows + j) * q + i] =
                (float)share;
            sum += mf_share(s, o, w, oh, (double)nm[k]);
          }
          ((float *)luminance.values)[(slice * q_rows + j) * q + i] = (float)(sum / s->lambdas);
        }
    }
  free(density);
  mfField *fields[10] = {&description, &phi,       &theta,   &ndf,    &sigma,
                         &vndf,        &luminance, &spectra, &lambda, &jacobian};
  mfFile file = {0};
  mf_put(&file, "tensor_file", 12);
  mf_put(&file, "\1", 2);
  mf_put_number(&file, 10, 4);
  size_t at = 18;
  for (int i = 0; i < 10; i++)
    at += 2 + strlen(fields[i]->name) + 2 + 1 + 8 + 8 * fields[i]->rank;
  for (int i = 0; i < 10; i++) {
    const mfField *f = fields[i];
    mf_put_number(&file, strlen(f->name), 2);
    mf_put(&file, f->name, strlen(f->name));
    mf_put_number(&file, f->rank, 2);
    mf_put_number(&file, f->type, 1);
    mf_put_number(&file, at, 8);
    for (uint32_t k = 0; k < f->rank; k++)
      mf_put_number(&file, f->shape[k], 8);
    at += f->size;
  }
  for (int i = 0; i < 10; i++) {
    mf_put(&file, fields[i]->values, fields[i]->size);
    if (fields[i]->type == 10)
      free(fields[i]->values);
  }
  return file;
}

static inline bool mf_write(const char *path, const mfFile *file) {
  FILE *f = fopen(path, "wb");
  bool done = f && fwrite(file->bytes, 1, file->size, f) == file->size;
  if (f && fclose(f) != 0)
    done = false;
  return done;
}

#endif
