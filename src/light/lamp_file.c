/* light/lamp_file.c: the public functions of luminaires: reading a file, its intensity in a
 * direction, its flux and angles. */
#include "light/lamp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "light/lamp_lookup.h"
#include "math/approx_double.h"
#include "math/double3.h"

/* ---- intensity --------------------------------------------------------------------------- */

/* As vl_lamp_candela, in double. */
static double bilinear(const vlLampTable *t, double azimuth, double polar) {
  const double edge = (double)VL_LAMP_EDGE;
  if (azimuth < (double)t->azimuth[0] - edge)
    azimuth += 2 * M_PI;
  if (!(polar >= (double)t->polar[0] - edge) ||
      !(polar <= (double)t->polar[t->polars - 1] + edge) ||
      !(azimuth <= (double)t->azimuth[t->azimuths - 1] + edge))
    return 0;
  uint32_t i = vl_find_interval(t->azimuth, t->azimuths - 1, (float)azimuth);
  uint32_t j = vl_find_interval(t->polar, t->polars - 1, (float)polar);
  const float *a = t->azimuth + i, *b = t->polar + j;
  double across = (azimuth - (double)a[0]) / ((double)a[1] - (double)a[0]);
  double down = (polar - (double)b[0]) / ((double)b[1] - (double)b[0]);
  across = fmin(fmax(across, 0), 1);
  down = fmin(fmax(down, 0), 1);
  const float *left = t->candela + (size_t)i * t->polars + j, *right = left + t->polars;
  double near = (1 - down) * (double)left[0] + down * (double)left[1];
  double far = (1 - down) * (double)right[0] + down * (double)right[1];
  return (1 - across) * near + across * far;
}

double vl_lamp_intensity(const vlLamp *lamp, const double direction[3]) {
  const float *m = lamp->table.frame;
  double length = vl_norm3(direction), d[3];
  if (!(length > 0) || !isfinite(length))
    return 0;
  for (int i = 0; i < 3; i++) {
    d[i] = 0;
    for (int k = 0; k < 3; k++)
      d[i] += (double)m[3 * i + k] * (direction[k] / length);
  }
  double polar = vl_atan2_double(sqrt(d[0] * d[0] + d[1] * d[1]), d[2]);
  return bilinear(&lamp->table, vl_atan2_double(d[1], d[0]), polar);
}

/* ---- what follows from it ---------------------------------------------------------------- */

static void find_maximum(vlLamp *lamp) {
  const vlLampTable *t = &lamp->table;
  for (uint32_t i = 0; i < t->azimuths; i++)
    for (uint32_t j = 0; j < t->polars; j++) {
      double candela = (double)t->candela[(size_t)i * t->polars + j];
      if (!(candela > lamp->info.max_intensity))
        continue;
      lamp->info.max_intensity = candela;
      vlSinCosDouble turn = vl_sincos_double((double)t->azimuth[i]);
      vlSinCosDouble down = vl_sincos_double((double)t->polar[j]);
      const double own[3] = {down.sin * turn.cos, down.sin * turn.sin, down.cos};
      for (int k = 0; k < 3; k++) {
        lamp->info.max_direction[k] = 0;
        for (int m = 0; m < 3; m++)
          lamp->info.max_direction[k] += own[m] * (double)t->frame[3 * m + k];
      }
    }
}

/* The plane through the luminaire's axis and the direction `across`; an angle counts from the
 * nadir, or from the zenith, towards `across`. */
typedef struct Section {
  const vlLamp *lamp;
  double across[3];
  double axis; /* -1: from the nadir, 1: from the zenith */
} Section;

static double section_intensity(const Section *s, double angle) {
  vlSinCosDouble a = vl_sincos_double(angle);
  const double d[3] = {a.sin * s->across[0], a.cos * s->axis, a.sin * s->across[2]};
  return vl_lamp_intensity(s->lamp, d);
}

enum { SECTION_STEPS = 1800 };

/* The outermost angle on one side (side 1 or -1) that has the intensity; counted from the axis.
 * It may be negative when that whole side is darker. */
static double outermost(const Section *s, int side, double intensity) {
  const double step = M_PI / SECTION_STEPS;
  for (int k = SECTION_STEPS; k >= -SECTION_STEPS; k--) {
    if (!(section_intensity(s, side * k * step) >= intensity))
      continue;
    double bright = k * step, dark = bright + step;
    for (int i = 0; k < SECTION_STEPS && i < 40; i++) {
      double middle = 0.5 * (bright + dark);
      if (section_intensity(s, side * middle) >= intensity)
        bright = middle;
      else
        dark = middle;
    }
    return bright;
  }
  return 0;
}

static void measure_section(vlLamp *lamp, int which) {
  Section s = {lamp, {which == 0, 0, -(which == 1)}, -1};
  double halves[2] = {0, 0}; /* the greatest intensity around the nadir, and the zenith */
  for (int k = -SECTION_STEPS; k <= SECTION_STEPS; k++) {
    bool upper = 2 * abs(k) > SECTION_STEPS;
    halves[upper] = fmax(halves[upper], section_intensity(&s, k * M_PI / SECTION_STEPS));
  }
  s.axis = halves[1] > halves[0] * (1 + 1e-9) ? 1 : -1;
  double greatest = fmax(halves[0], halves[1]);
  if (!(greatest > 0))
    return;
  static const double shares[2] = {0.5, 0.1};
  double *const angles[2] = {&lamp->info.beam[which], &lamp->info.field[which]};
  for (int k = 0; k < 2; k++) {
    double level = shares[k] * greatest;
    double angle = outermost(&s, 1, level) + outermost(&s, -1, level);
    *angles[k] = fmin(fmax(angle, 0), 2 * M_PI);
  }
}

/* The info's members that follow from the intensities. */
static void measure(vlLamp *lamp) {
  find_maximum(lamp);
  measure_section(lamp, 0);
  measure_section(lamp, 1);
}

/* ---- reading ----------------------------------------------------------------------------- */

/* EULUMDAT has no mark of its own: a file without a line that starts with TILT= is one. */
static bool is_ies(const char *text, size_t size) {
  for (const char *at = text, *end = text + size; at + 5 <= end; at++)
    if (memcmp(at, "TILT=", 5) == 0)
      return true;
  return size >= 3 && memcmp(text, "IES", 3) == 0;
}

static vlResult read_text(vlLamp *lamp, const char *name, const char *text, size_t size,
                          vlError *error) {
  vlLampData data = {0};
  vlResult r = is_ies(text, size) ? vl_lamp_read_ies(lamp, name, text, size, &data, error)
                                  : vl_lamp_read_eulumdat(lamp, name, text, size, &data, error);
  lamp->info.type = data.type;
  lamp->info.planes = data.planes;
  lamp->info.angles = data.angles;
  if (r == VL_OK)
    r = vl_lamp_table_make(lamp, &data, error);
  if (r == VL_OK)
    measure(lamp);
  vl_lamp_data_free(lamp->context, &data);
  return r;
}

vlResult vl_lamp_read(vlContext *context, const char *name, const void *data, size_t size,
                      vlLamp **result, vlError *error) {
  vl_error_clear(error);
  if (!context || !result || (!data && size))
    return vl_fail_argument(error, "an argument is null");
  *result = NULL;
  vlLamp *lamp = vl_alloc_zero(context, 1, sizeof *lamp);
  if (!lamp)
    return vl_fail_memory(error);
  lamp->context = context;
  lamp->info.lamps_flux = lamp->info.watts = VL_UNSET;
  vlResult r = read_text(lamp, name ? name : "lamp", data, size, error);
  if (r == VL_OK)
    *result = lamp;
  else
    vl_lamp_destroy(lamp);
  return r;
}

vlResult vl_lamp_open(vlContext *context, const char *path, bool given, vlLamp **result,
                      vlError *error) {
  char *data = NULL;
  size_t size = 0;
  vlResult r = given ? vl_file_read_given(context, path, true, &data, &size, error)
                     : vl_file_read(context, path, true, &data, &size, error);
  if (r == VL_OK)
    r = vl_lamp_read(context, path, data, size, result, error);
  vl_free(context, data);
  return r;
}

vlResult vl_lamp_load(vlContext *context, const char *path, vlLamp **result, vlError *error) {
  vl_error_clear(error);
  if (!context || !path || !result)
    return vl_fail_argument(error, "an argument is null");
  *result = NULL;
  return vl_lamp_open(context, path, true, result, error);
}

void vl_lamp_destroy(vlLamp *lamp) {
  if (!lamp)
    return;
  vl_lamp_table_free(lamp);
  vl_free(lamp->context, lamp);
}

void vl_lamp_info(const vlLamp *lamp, vlLampInfo *info) {
  *info = lamp->info;
}
