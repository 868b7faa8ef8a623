/* material/measured_compile.c: reads a file of the RGL material database into tables for
 * lookup and sampling. */
#include "material/measured_tables.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "color/color.h"
#include "material/measured_lookup.h"
#include "material/tensor.h"
#include "math/elementary.h"

/* ---- the file's fields ------------------------------------------------------------------- */

enum { PHI, THETA, NDF, SIGMA, VNDF, LUMINANCE, SPECTRA, LAMBDA, JACOBIAN, FIELDS };
static const struct {
  const char *name;
  uint32_t type, rank;
} wanted[FIELDS] = {{"phi_i", VL_TENSOR_F32, 1},   {"theta_i", VL_TENSOR_F32, 1},
                    {"ndf", VL_TENSOR_F32, 2},     {"sigma", VL_TENSOR_F32, 2},
                    {"vndf", VL_TENSOR_F32, 4},    {"luminance", VL_TENSOR_F32, 4},
                    {"spectra", VL_TENSOR_F32, 5}, {"wavelengths", VL_TENSOR_F32, 1},
                    {"jacobian", VL_TENSOR_U8, 1}};

typedef struct Source {
  const char *path;
  vlTensor tensor;
  const vlTensorField *fields[FIELDS];
} Source;

static float value_of(const vlTensorField *f, uint64_t i) {
  float v;
  memcpy(&v, f->values + 4 * i, sizeof v);
  return v;
}

static vlResult find_field(Source *s, int which, vlError *error) {
  const char *name = wanted[which].name;
  const vlTensorField *f = s->fields[which] = vl_tensor_find(&s->tensor, name);
  if (!f && which == SPECTRA && vl_tensor_find(&s->tensor, "rgb"))
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: the measured material is kept as RGB; its file with spectra "
                   "(..._spec.bsdf) is needed",
                   s->path);
  if (!f)
    return vl_fail(error, VL_ERROR_SCENE, "%s: the measured material has no \"%s\"", s->path,
                   name);
  if (f->type != wanted[which].type || f->rank != wanted[which].rank || f->count == 0)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: \"%s\" of the measured material should be %s of %u dimension%s",
                   s->path, name,
                   wanted[which].type == VL_TENSOR_U8 ? "bytes" : "32-bit floats",
                   wanted[which].rank, wanted[which].rank == 1 ? "" : "s");
  /* guards against overflow; after this all values lie within the file */
  for (uint32_t i = 0; i < f->rank; i++)
    if (f->shape[i] > INT32_MAX)
      return vl_fail(error, VL_ERROR_SCENE, "%s: \"%s\" is too large", s->path, name);
  for (uint64_t i = 0; f->type == VL_TENSOR_F32 && i < f->count; i++)
    if (!isfinite(value_of(f, i)))
      return vl_fail(error, VL_ERROR_SCENE,
                     "%s: \"%s\" of the measured material holds a value that is not finite",
                     s->path, name);
  return VL_OK;
}

static vlResult check_knots(const Source *s, int which, double low, double high,
                            vlError *error) {
  const vlTensorField *f = s->fields[which];
  for (uint64_t i = 0; i < f->count; i++) {
    double v = (double)value_of(f, i);
    if (!(v >= low && v <= high) || (i > 0 && !(v > (double)value_of(f, i - 1))))
      return vl_fail(error, VL_ERROR_SCENE, "%s: \"%s\" of the measured material %s", s->path,
                     wanted[which].name,
                     v >= low && v <= high ? "is not ascending" : "is out of range");
  }
  return VL_OK;
}

/* Checks that the first dimensions match the knots of the given fields, and that the last two
 * have at least 2 x 2 nodes. */
static vlResult check_shape(const Source *s, int which, uint32_t knots, const int *of,
                            vlError *error) {
  const vlTensorField *f = s->fields[which];
  for (uint32_t i = 0; i < knots; i++)
    if (f->shape[i] != s->fields[of[i]]->count)
      return vl_fail(
          error, VL_ERROR_SCENE,
          "%s: \"%s\" of the measured material does not fit \"%s\": %u values for %u", s->path,
          wanted[which].name, wanted[of[i]].name, (unsigned)f->shape[i],
          (unsigned)s->fields[of[i]]->count);
  if (f->shape[f->rank - 2] < 2 || f->shape[f->rank - 1] < 2)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: \"%s\" of the measured material has less than 2 x 2 values", s->path,
                   wanted[which].name);
  return VL_OK;
}

static vlResult check(Source *s, vlError *error) {
  static const int angles[3] = {PHI, THETA, LAMBDA};
  static const uint32_t knots[FIELDS] = {[VNDF] = 2, [LUMINANCE] = 2, [SPECTRA] = 3};
  vlResult r = VL_OK;
  for (int i = 0; r == VL_OK && i < JACOBIAN; i++)
    r = find_field(s, i, error);
  if (r == VL_OK && vl_tensor_find(&s->tensor, wanted[JACOBIAN].name))
    r = find_field(s, JACOBIAN, error);
  if (r == VL_OK)
    r = check_knots(s, PHI, -6.3, 6.3, error);
  if (r == VL_OK)
    r = check_knots(s, THETA, 0, 1.58, error);
  if (r == VL_OK)
    r = check_knots(s, LAMBDA, 1, 1e5, error);
  for (int i = NDF; r == VL_OK && i <= SPECTRA; i++)
    r = check_shape(s, i, knots[i], angles, error);
  return r;
}

/* ---- tables ------------------------------------------------------------------------------ */

static float *copy_values(const vlTensorField *f, float **room) {
  float *to = *room;
  memcpy(to, f->values, (size_t)f->count * sizeof(float));
  *room += f->count;
  return to;
}

static vlMeasuredTable table_of(const vlTensorField *f, const float *values) {
  return (vlMeasuredTable){(uint32_t)f->shape[f->rank - 1], (uint32_t)f->shape[f->rank - 2],
                           values, NULL, NULL};
}

/* Normalises one slice to integral 1 and computes its running integrals. A slice of zeros
 * becomes uniform. */
static void make_density(float *values, float *columns, float *rows, uint32_t w, uint32_t h) {
  double total = 0, dx = 1.0 / (w - 1), dy = 1.0 / (h - 1);
  for (uint32_t y = 0; y < h; y++)
    for (uint32_t x = 0; x < w; x++) {
      float *v = &values[(size_t)y * w + x];
      *v = *v > 0.0f ? *v : 0.0f;
      total += (double)*v * (x == 0 || x == w - 1 ? 0.5 : 1) *
               (y == 0 || y == h - 1 ? 0.5 : 1) * dx * dy;
    }
  double scale = total > 1e-30 ? 1 / total : 0, sum = 0, before = 0;
  for (uint32_t y = 0; y < h; y++) {
    float *row = values + (size_t)y * w, *column = columns + (size_t)y * w;
    double along = 0;
    for (uint32_t x = 0; x < w; x++) {
      row[x] = scale > 0 ? (float)((double)row[x] * scale) : 1.0f;
      if (x > 0)
        along += 0.5 * dx * ((double)row[x - 1] + (double)row[x]);
      column[x] = (float)along;
    }
    if (y > 0)
      sum += 0.5 * dy * (before + along);
    before = along;
    rows[y] = (float)sum;
  }
}

static vlMeasuredTable density_of(const vlTensorField *f, float **room) {
  float *values = copy_values(f, room), *columns = *room, *rows = columns + f->count;
  vlMeasuredTable t = table_of(f, values);
  size_t size = (size_t)t.width * t.height, slices = (size_t)f->count / size;
  *room = rows + slices * t.height;
  for (size_t i = 0; i < slices; i++)
    make_density(values + i * size, columns + i * size, rows + i * t.height, t.width, t.height);
  t.columns = columns;
  t.rows = rows;
  return t;
}

static void find_symmetry(vlMeasured *m) {
  m->isotropic = m->phis <= 2;
  if (m->isotropic)
    return;
  double first = (double)m->phi[0], last = (double)m->phi[m->phis - 1];
  long parts = lrint(2 * M_PI / (last - first));
  m->quarters = parts >= 4;
  m->halves = parts >= 2 && !m->quarters;
  m->side_x = vl_precise_cos((first + last) / 2) < 0 ? -1.0f : 1.0f;
  m->side_y = vl_precise_sin((first + last) / 2) < 0 ? -1.0f : 1.0f;
}

/* ---- spectra ----------------------------------------------------------------------------- */

/* Contribution of each measured wavelength to the channels of sRGB under daylight, 3 numbers
 * each. The spectrum is interpolated linearly between the measured wavelengths. A white surface
 * gets exactly 1 in each channel. */
static void hat_rgb(const float *lambda, uint32_t n, double *weights) {
  const float *observer[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()},
              *light = vl_space_illuminant(VL_SPACE_SRGB);
  float matrix[9];
  double total[3] = {0};
  vl_rgb_from_xyz(VL_SPACE_SRGB, matrix);
  memset(weights, 0, (size_t)n * 3 * sizeof *weights);
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    vlMeasuredKnot knot = vl_measured_knot(lambda, n, (float)(VL_LAMBDA_MIN + i));
    for (int c = 0; c < 3; c++) {
      double x = 0;
      for (int k = 0; k < 3; k++)
        x += (double)matrix[3 * c + k] * (double)observer[k][i] * (double)light[i];
      total[c] += x;
      weights[3 * (size_t)knot.i + (size_t)c] += (1 - (double)knot.t) * x;
      if (n > 1)
        weights[3 * ((size_t)knot.i + 1) + (size_t)c] += (double)knot.t * x;
    }
  }
  for (size_t i = 0; i < (size_t)n * 3; i++)
    weights[i] /= total[i % 3];
}

static bool spectra_to_rgb(vlContext *context, vlMeasured *m, const vlTensorField *f,
                           uint32_t n, const float *lambda, float *to) {
  double *weights = vl_alloc_array(context, (size_t)n * 3, sizeof *weights);
  if (!weights)
    return false;
  hat_rgb(lambda, n, weights);
  size_t size = (size_t)m->spectra.width * m->spectra.height,
         slices = (size_t)m->phis * m->thetas;
  for (size_t s = 0; s < slices; s++)
    for (size_t i = 0; i < size; i++)
      for (size_t c = 0; c < 3; c++) {
        double sum = 0;
        for (size_t k = 0; k < n; k++)
          sum += weights[3 * k + c] * (double)value_of(f, (s * n + k) * size + i);
        to[(s * 3 + c) * size + i] = (float)sum;
      }
  vl_free(context, weights);
  return true;
}

/* Moves the spectra to the start of the file's memory block, shrinks the block, and keeps
 * it. */
static void keep_spectra(vlContext *context, vlMeasured *m, Source *s) {
  const vlTensorField *f = s->fields[SPECTRA];
  size_t size = (size_t)f->count * sizeof(float);
  memmove(s->tensor.data, f->values, size);
  char *less = vl_realloc_array(context, s->tensor.data, size, 1);
  m->file = less ? less : s->tensor.data;
  s->tensor.data = NULL;
  m->spectra.values = (const float *)(const void *)m->file;
}

/* Albedo at normal incidence: mean of the sample weights of the first slice over the square of
 * random numbers. */
static void find_albedo(vlMeasured *m, float *albedo) {
  const vlMeasuredTable *t = &m->spectra;
  const vlMeasuredSlices straight = {1, {0}, {1}};
  size_t size = (size_t)t->width * t->height;
  for (uint32_t k = 0; k < m->lambdas; k++) {
    double sum = 0, all = 0;
    for (uint32_t y = 0; y < t->height; y++)
      for (uint32_t x = 0; x < t->width; x++) {
        double part =
            (x == 0 || x == t->width - 1 ? 0.5 : 1) * (y == 0 || y == t->height - 1 ? 0.5 : 1);
        double value = (double)t->values[k * size + (size_t)y * t->width + x];
        if (!m->scaled) { /* the table holds f cos w itself */
          float u = (float)x / (float)(t->width - 1), v = (float)y / (float)(t->height - 1);
          vlMeasuredPoint n = vl_measured_sample(&m->vndf, straight, u, v);
          float d = vl_measured_in(&m->ndf, m->ndf.values, vl_measured_cell(&m->ndf, n.x, n.y));
          value *= 4 * (double)m->sigma.values[0] / fmax((double)d, 1e-30);
        }
        sum += part * fmax(value, 0);
        all += part;
      }
    albedo[k] = (float)fmin(sum / all, 1);
  }
  m->albedo = albedo;
}

static vlResult build(vlContext *context, Source *s, bool rgb, vlMeasured *m, vlError *error) {
  const vlTensorField *const *f = s->fields;
  m->phis = (uint32_t)f[PHI]->count;
  m->thetas = (uint32_t)f[THETA]->count;
  m->lambdas = rgb ? 3 : (uint32_t)f[LAMBDA]->count;
  size_t slices = (size_t)m->phis * m->thetas,
         nodes = (size_t)(f[SPECTRA]->shape[3] * f[SPECTRA]->shape[4]);
  size_t count = (size_t)(f[PHI]->count + f[THETA]->count + f[LAMBDA]->count + f[NDF]->count +
                          f[SIGMA]->count);
  count += 2 * (size_t)(f[VNDF]->count + f[LUMINANCE]->count);
  count += slices * (size_t)(f[VNDF]->shape[2] + f[LUMINANCE]->shape[2]);
  count += rgb ? 3 * slices * nodes + 3 : (size_t)f[LAMBDA]->count;
  float *room = m->numbers = vl_alloc_array(context, count, sizeof(float));
  if (!room)
    return vl_fail_memory(error);
  m->phi = copy_values(f[PHI], &room);
  m->theta = copy_values(f[THETA], &room);
  m->lambda = copy_values(f[LAMBDA], &room);
  m->ndf = table_of(f[NDF], copy_values(f[NDF], &room));
  m->sigma = table_of(f[SIGMA], copy_values(f[SIGMA], &room));
  m->vndf = density_of(f[VNDF], &room);
  m->luminance = density_of(f[LUMINANCE], &room);
  float *albedo = room;
  room += m->lambdas;
  m->spectra = table_of(f[SPECTRA], room);
  m->scaled = !f[JACOBIAN] || f[JACOBIAN]->values[0] != 0;
  find_symmetry(m);
  if (!rgb) {
    keep_spectra(context, m, s);
    find_albedo(m, albedo);
    return VL_OK;
  }
  bool done =
      spectra_to_rgb(context, m, f[SPECTRA], (uint32_t)f[LAMBDA]->count, m->lambda, room);
  m->lambda = NULL;
  if (done)
    find_albedo(m, albedo);
  return done ? VL_OK : vl_fail_memory(error);
}

vlResult vl_measured_read(vlContext *context, const char *path, bool rgb, vlMeasured **result,
                          vlError *error) {
  *result = NULL;
  Source s = {.path = path};
  VL_TRY(vl_tensor_read(context, path, &s.tensor, error));
  vlResult r = check(&s, error);
  vlMeasured *m = r == VL_OK ? vl_alloc_zero(context, 1, sizeof *m) : NULL;
  if (r == VL_OK)
    r = m && (m->path = vl_strdup(context, path)) ? build(context, &s, rgb, m, error)
                                                  : vl_fail_memory(error);
  vl_tensor_free(context, &s.tensor);
  if (r == VL_OK)
    *result = m;
  else
    vl_measured_free(context, m);
  return r;
}

void vl_measured_free(vlContext *context, vlMeasured *m) {
  if (!m)
    return;
  VL_FREE(context, m->numbers, m->file, m->path, m);
}
