/* light/lamp_table.c: the table of a luminaire's intensity over the whole sphere, made from the
 * angles of its file by their symmetry, and the distribution of its flux. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "light/lamp.h"
#include "light/lamp_text.h"
#include "math/approx_double.h"

#define RADIANS(degrees) ((degrees) * (M_PI / 180))

bool vl_lamp_data_allocate(vlContext *context, vlLampData *data, uint32_t planes,
                           uint32_t angles) {
  data->planes = planes;
  data->angles = angles;
  data->horizontal = vl_alloc_array(context, planes, sizeof *data->horizontal);
  data->vertical = vl_alloc_array(context, angles, sizeof *data->vertical);
  data->candela = vl_alloc_array(context, (size_t)planes * angles, sizeof *data->candela);
  return data->horizontal && data->vertical && data->candela;
}

void vl_lamp_data_free(vlContext *context, vlLampData *data) {
  VL_FREE(context, data->horizontal, data->vertical, data->candela);
}

/* ---- symmetry ---------------------------------------------------------------------------- */

static double last_of(const double *angles, uint32_t count) {
  return angles[count - 1];
}

/* Whether C angles from 0 to less than 360 go round: no step is longer than that to 360. */
static bool goes_round(const vlLampData *data) {
  double gap = 360 - last_of(data->horizontal, data->planes), longest = 0;
  for (uint32_t i = 1; i < data->planes; i++)
    longest = fmax(longest, data->horizontal[i] - data->horizontal[i - 1]);
  return last_of(data->horizontal, data->planes) > 180 && gap <= longest * 1.001;
}

bool vl_lamp_check_angles(const vlLampText *t, const vlLampData *data) {
  double first = data->horizontal[0], last = last_of(data->horizontal, data->planes);
  double low = data->vertical[0], high = last_of(data->vertical, data->angles);
  if (data->angles < 2)
    vl_lamp_fail(t, t->line, "lamp file: there must be 2 or more vertical angles");
  else if (data->type != 'C' && data->planes < 2)
    vl_lamp_fail(t, t->line, "lamp file: photometry of type %c has 2 or more horizontal angles",
                 data->type);
  else if (data->type != 'C')
    return true;
  else if (!((low == 0 || low == 90) && (high == 90 || high == 180)))
    vl_lamp_fail(
        t, t->line,
        "lamp file: the vertical angles go from %g to %g; those of type C from 0 to 90 "
        "or 180, or from 90 to 180",
        low, high);
  else if (data->planes == 1 ? first == 0
                             : (first == 90 && last == 270) ||
                                   (first == 0 && (last == 90 || last == 180 || last == 360 ||
                                                   goes_round(data))) ||
                                   (first == 270 && last == 450))
    return true;
  else
    vl_lamp_fail(t, t->line,
                 "lamp file: the horizontal angles go from %g to %g; those of type C are 0 "
                 "alone, from 0 to 90, 180 or 360, or from 90 to 270",
                 first, last);
  return false;
}

/* Angles about the whole circle or from pole to pole, and the number of the file's angle that
 * each is equal to. */
typedef struct Axis {
  double *angle; /* degrees */
  uint32_t *from;
  uint32_t count;
} Axis;

static bool axis_allocate(vlContext *context, Axis *axis, uint32_t count) {
  axis->angle = vl_alloc_array(context, 4 * (size_t)count + 1, sizeof *axis->angle);
  axis->from = vl_alloc_array(context, 4 * (size_t)count + 1, sizeof *axis->from);
  axis->count = 0;
  return axis->angle && axis->from;
}

static void axis_free(vlContext *context, Axis *axis) {
  VL_FREE(context, axis->angle, axis->from);
}

static void axis_push(Axis *axis, double angle, uint32_t from) {
  axis->angle[axis->count] = angle;
  axis->from[axis->count++] = from;
}

/* Adds the mirror image of all angles but the last, beyond the last. */
static void axis_mirror(Axis *axis) {
  double last = axis->angle[axis->count - 1];
  for (uint32_t i = axis->count - 1; i-- > 0;)
    axis_push(axis, 2 * last - axis->angle[i], axis->from[i]);
}

/* The C planes around the whole circle: one plane is all; planes over a quarter or half of the
 * circle are mirrored at the last one. */
static void axis_around(const vlLampData *data, Axis *axis) {
  double first = data->horizontal[0], last = last_of(data->horizontal, data->planes);
  double turn = first >= 180 ? -360 : 0;
  for (uint32_t i = 0; i < data->planes; i++)
    axis_push(axis, data->horizontal[i] + turn, i);
  if (data->planes == 1) {
    axis_push(axis, 360, 0);
    return;
  }
  if (last - first == 90)
    axis_mirror(axis);
  if (last - first == 90 || last - first == 180)
    axis_mirror(axis);
  if (last - first < 360 && last - first > 180)
    axis_push(axis, 360, 0);
}

/* Angles of types A and B: those that start at 0 are mirrored there. */
static void axis_both_sides(const double *angles, uint32_t count, Axis *axis) {
  for (uint32_t i = count - 1; angles[0] == 0 && i > 0; i--)
    axis_push(axis, -angles[i], i);
  for (uint32_t i = 0; i < count; i++)
    axis_push(axis, angles[i], i);
}

/* Angles above the equator become angles from the pole, ascending. */
static void axis_from_pole(Axis *axis) {
  for (uint32_t i = 0; i < axis->count; i++)
    axis->angle[i] = 90 - axis->angle[i];
  for (uint32_t i = 0, k = axis->count - 1; i < k; i++, k--) {
    double angle = axis->angle[i];
    uint32_t from = axis->from[i];
    axis->angle[i] = axis->angle[k];
    axis->from[i] = axis->from[k];
    axis->angle[k] = angle;
    axis->from[k] = from;
  }
}

/* The rows of vlLampTable.frame. */
static void set_frame(vlLampTable *table, char type) {
  static const float frames[3][9] = {
      {0, -1, 0, 0, 0, 1, 1, 0, 0}, /* A: pole up the vertical angles, azimuth: horizontal */
      {0, -1, 0, 1, 0, 0, 0, 0, 1}, /* B: pole along the horizontal angles, azimuth: vertical */
      {1, 0, 0, 0, 0, -1, 0, -1, 0}, /* C: pole at the nadir, azimuth: C */
  };
  memcpy(table->frame, frames[type - 'A'], sizeof table->frame);
}

/* ---- the distribution -------------------------------------------------------------------- */

/* Integrals of sin and of (angle - a) sin from a to b. */
static void polar_integrals(double a, double b, double *whole, double *rising) {
  vlSinCosDouble low = vl_sincos_double(a), high = vl_sincos_double(b);
  *whole = low.cos - high.cos;
  *rising = high.sin - low.sin - (b - a) * high.cos;
}

/* The flux through a cell: the integral of the bilinear intensity over its solid angle. */
static double cell_flux(const vlLampTable *t, uint32_t i, uint32_t j, double *solid_angle) {
  const float *left = t->candela + (size_t)i * t->polars + j, *right = left + t->polars;
  double low = 0.5 * ((double)left[0] + right[0]), high = 0.5 * ((double)left[1] + right[1]);
  double a = t->polar[j], b = t->polar[j + 1],
         width = (double)t->azimuth[i + 1] - t->azimuth[i];
  double whole, rising;
  polar_integrals(a, b, &whole, &rising);
  *solid_angle = width * whole;
  return width * (low * whole + (high - low) * rising / (b - a));
}

static void distribute(vlLampTable *t, double *flux) {
  double total = 0;
  for (uint32_t i = 0; i + 1 < t->azimuths; i++)
    for (uint32_t j = 0; j + 1 < t->polars; j++) {
      double solid_angle;
      total += cell_flux(t, i, j, &solid_angle);
    }
  double columns = 0;
  for (uint32_t i = 0; i + 1 < t->azimuths; i++) {
    float *below = t->below + (size_t)i * t->polars;
    double column = 0, sum = 0, solid_angle;
    for (uint32_t j = 0; j + 1 < t->polars; j++)
      column += cell_flux(t, i, j, &solid_angle);
    t->columns[i] = (float)(total > 0 ? columns / total : 0);
    columns += column;
    for (uint32_t j = 0; j + 1 < t->polars; j++) {
      double cell = cell_flux(t, i, j, &solid_angle);
      below[j] = (float)(column > 0 ? sum / column : 0);
      sum += cell;
      t->density[(size_t)i * (t->polars - 1) + j] =
          (float)(total > 0 ? cell / (total * solid_angle) : 0);
    }
    below[t->polars - 1] = 1;
  }
  t->columns[t->azimuths - 1] = 1;
  *flux = total;
}

/* ---- the table --------------------------------------------------------------------------- */

static bool table_allocate(vlContext *c, vlLampTable *t, uint32_t azimuths, uint32_t polars) {
  size_t cells = (size_t)(azimuths - 1) * (polars - 1);
  t->azimuths = azimuths;
  t->polars = polars;
  t->azimuth = vl_alloc_array(c, azimuths, sizeof(float));
  t->polar = vl_alloc_array(c, polars, sizeof(float));
  t->candela = vl_alloc_array(c, (size_t)azimuths * polars, sizeof(float));
  t->columns = vl_alloc_array(c, azimuths, sizeof(float));
  t->below = vl_alloc_array(c, (size_t)(azimuths - 1) * polars, sizeof(float));
  t->density = vl_alloc_array(c, cells, sizeof(float));
  return t->azimuth && t->polar && t->candela && t->columns && t->below && t->density;
}

void vl_lamp_table_free(vlLamp *lamp) {
  vlLampTable *t = &lamp->table;
  VL_FREE(lamp->context, t->azimuth, t->polar, t->candela, t->columns, t->below, t->density);
}

static void fill(vlLampTable *t, const vlLampData *data, const Axis *azimuth,
                 const Axis *polar) {
  for (uint32_t i = 0; i < azimuth->count; i++)
    t->azimuth[i] = (float)RADIANS(azimuth->angle[i]);
  for (uint32_t j = 0; j < polar->count; j++)
    t->polar[j] = (float)RADIANS(polar->angle[j]);
  for (uint32_t i = 0; i < azimuth->count; i++)
    for (uint32_t j = 0; j < polar->count; j++) {
      uint32_t plane = data->type == 'B' ? polar->from[j] : azimuth->from[i];
      uint32_t angle = data->type == 'B' ? azimuth->from[i] : polar->from[j];
      t->candela[(size_t)i * polar->count + j] =
          (float)data->candela[(size_t)plane * data->angles + angle];
    }
  set_frame(t, data->type);
}

vlResult vl_lamp_table_make(vlLamp *lamp, const vlLampData *data, vlError *error) {
  vlContext *c = lamp->context;
  uint32_t max = data->planes > data->angles ? data->planes : data->angles;
  Axis azimuth = {0}, polar = {0};
  bool whole = axis_allocate(c, &azimuth, max) && axis_allocate(c, &polar, max);
  if (whole && data->type == 'C') {
    axis_around(data, &azimuth);
    for (uint32_t j = 0; j < data->angles; j++)
      axis_push(&polar, data->vertical[j], j);
  } else if (whole) {
    bool b = data->type == 'B';
    axis_both_sides(data->horizontal, data->planes, b ? &polar : &azimuth);
    axis_both_sides(data->vertical, data->angles, b ? &azimuth : &polar);
    axis_from_pole(&polar);
  }
  whole = whole && table_allocate(c, &lamp->table, azimuth.count, polar.count);
  if (whole) {
    fill(&lamp->table, data, &azimuth, &polar);
    distribute(&lamp->table, &lamp->info.flux);
    lamp->table.flux = (float)lamp->info.flux;
  }
  axis_free(c, &azimuth);
  axis_free(c, &polar);
  return whole ? VL_OK : vl_fail_memory(error);
}
