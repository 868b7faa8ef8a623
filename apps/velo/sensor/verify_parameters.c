/* sensor/verify_parameters.c: the parameters of EMVA 1288 (release 3.1) from the statistics of
 * the frames, and what the sensor's own numbers let one expect. */
#include <math.h>

#include "cli/macros.h"
#include "sensor/verify.h"

#define ROUNDING (1.0 / 12.0) /* variance of rounding, DN^2 */

void verify_add(Verify *v, VerifyRow row) {
  if (v->count < VERIFY_ROWS)
    v->rows[v->count++] = row;
}

bool verify_passes(const VerifyRow *row) {
  if (row->skip)
    return true;
  if (isnan(row->expected))
    return row->measured <= row->allowed;
  return fabs(row->measured - row->expected) <= row->allowed * fabs(row->expected);
}

/* ---- what is expected -------------------------------------------------------------------- */

static double dark_electrons(const Verify *v, double time) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double warmer = v->exposure.temperature - def->dark_temperature;
  return def->dark_current * time * exp2(warmer / def->doubling);
}

/* Variance of what is read out beside the well's electrons, DN^2, without rounding. */
static double readout_variance(const Verify *v) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double electrons = def->read_noise * def->read_noise + def->row_noise * def->row_noise +
                     def->column_noise * def->column_noise;
  return electrons * v->gain * v->gain + def->adc_noise * def->adc_noise;
}

/* Mean and variance of the smaller of a limit and a normal number. */
static void clip(double *mean, double *variance, double limit) {
  double deviation = sqrt(*variance);
  if (!(deviation > 0.0)) {
    *mean = fmin(*mean, limit);
    return;
  }
  double z = (limit - *mean) / deviation;
  double below = 0.5 * erfc(-z / sqrt(2.0));
  double density = exp(-0.5 * z * z) / sqrt(2.0 * M_PI);
  double first = z * (1.0 - below) - density; /* of standard numbers */
  double second = below - z * density + z * z * (1.0 - below);
  *variance *= fmax(second - first * first, 0.0);
  *mean += deviation * first;
}

double verify_expected_variance(const Verify *v, const VerifyStep *step) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double largest = exp2(def->bits) - 1.0 - def->black_level;
  double sum = 0.0;
  double weights = 0.0;
  for (int i = -40; i <= 40; i++) { /* pixels of responses up to 4 deviations from the mean */
    double weight = exp(-0.5 * i * i / 100.0);
    double mean = step->electrons * fmax(1.0 + def->prnu * i / 10.0, 0.0);
    mean += dark_electrons(v, step->time);
    double variance = mean;
    clip(&mean, &variance, def->full_well);
    mean *= v->gain;
    variance = variance * v->gain * v->gain + readout_variance(v);
    clip(&mean, &variance, largest);
    sum += weight * variance;
    weights += weight;
  }
  return sum / weights + ROUNDING;
}

/* The photoelectrons of the step with the largest variance: the standard's saturation. */
static double peak(const Verify *v, bool expected) {
  double largest = 0.0;
  double electrons = 0.0;
  for (int i = 0; i < VERIFY_STEPS; i++) {
    const VerifyStep *step = &v->steps[i];
    double variance = expected ? verify_expected_variance(v, step) : step->variance;
    if (variance > largest) {
      largest = variance;
      electrons = step->electrons;
    }
  }
  return electrons;
}

/* ---- what is measured -------------------------------------------------------------------- */

/* One number of a step. */
typedef double StepValue(const Verify *v, const VerifyStep *step);

static double light_mean(UNUSED const Verify *v, const VerifyStep *step) {
  return step->mean - step->dark_mean;
}
static double light_variance(UNUSED const Verify *v, const VerifyStep *step) {
  return step->variance - step->dark_variance;
}
static double photons(const Verify *v, const VerifyStep *step) {
  return step->electrons / v->efficiency;
}

/* Slope through the origin of y over x, up to 70 % of the saturation. */
static double slope(const Verify *v, StepValue *x, StepValue *y, double saturation) {
  double products = 0.0;
  double squares = 0.0;
  for (int i = 0; i < VERIFY_STEPS; i++) {
    const VerifyStep *step = &v->steps[i];
    if (step->electrons > 0.7 * saturation)
      continue;
    products += x(v, step) * y(v, step);
    squares += x(v, step) * x(v, step);
  }
  return products / squares;
}

/* Slope of the dark frames' means over time, DN/s. */
static double dark_slope(const Verify *v) {
  double time = 0.0;
  double mean = 0.0;
  double products = 0.0;
  double squares = 0.0;
  for (int i = 0; i < VERIFY_STEPS; i++) {
    time += v->steps[i].time / VERIFY_STEPS;
    mean += v->steps[i].dark_mean / VERIFY_STEPS;
  }
  for (int i = 0; i < VERIFY_STEPS; i++) {
    double t = v->steps[i].time - time;
    products += t * (v->steps[i].dark_mean - mean);
    squares += t * t;
  }
  return products / squares;
}

/* Mean relative deviation from the line that fits best relative to itself, from 5 to 95 % of
 * the saturation (EMVA 1288 release 4, linearity). */
static double linearity_error(const Verify *v, double saturation) {
  double s0 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;
  double t0 = 0.0;
  double t1 = 0.0;
  for (int i = 0; i < VERIFY_STEPS; i++) {
    const VerifyStep *step = &v->steps[i];
    double y = light_mean(v, step);
    double x = step->electrons;
    double weight = 1.0 / (y * y);
    if (x < 0.05 * saturation || x > 0.95 * saturation || !(y > 0.0))
      continue;
    s0 += weight;
    s1 += weight * x;
    s2 += weight * x * x;
    t0 += weight * y;
    t1 += weight * x * y;
  }
  double b = (s0 * t1 - s1 * t0) / (s0 * s2 - s1 * s1);
  double a = (t0 - b * s1) / s0;
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < VERIFY_STEPS; i++) {
    const VerifyStep *step = &v->steps[i];
    double x = step->electrons;
    if (x < 0.05 * saturation || x > 0.95 * saturation)
      continue;
    sum += fabs(light_mean(v, step) / (a + b * x) - 1.0);
    count++;
  }
  return sum / count;
}

/* ---- rows -------------------------------------------------------------------------------- */

/* Why dark frames cannot be measured; null: they can. */
static const char *dark_problem(const Verify *v) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double deviation = sqrt(readout_variance(v));
  double offsets = def->dsnu * v->gain;
  if (deviation < 0.4)
    return "the noise of dark frames is below the converter's steps";
  if (def->black_level < 4.5 * hypot(deviation, offsets))
    return "black_level is so low that dark frames are clipped";
  return NULL;
}

static void add_dark(Verify *v, double gain) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  const VerifyStep *first = &v->steps[0];
  const char *problem = dark_problem(v);
  double dark = dark_electrons(v, first->time);
  double half = v->full_time * 0.5 * v->saturation / v->full_electrons;
  double pattern = dark_electrons(v, half) * def->dark_nonuniformity;
  verify_add(
      v, (VerifyRow){"dark noise", "e-", sqrt(readout_variance(v) / (v->gain * v->gain) + dark),
                     sqrt(fmax(first->dark_variance - ROUNDING, 0.0)) / gain, .allowed = 0.01,
                     .skip = problem});
  verify_add(v, (VerifyRow){"dark current", "e-/s", dark_electrons(v, 1.0),
                            dark_slope(v) / gain, .allowed = 0.01,
                            .skip = def->dark_current > 0.0 ? problem : "there is none"});
  verify_add(v, (VerifyRow){"DSNU", "e-", hypot(def->dsnu, pattern),
                            sqrt(fmax(v->dark.spatial, 0.0)) / gain, .allowed = 0.01,
                            .skip = def->dsnu > 0.0 ? problem : "there is none"});
}

void verify_parameters(Verify *v) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double saturation = peak(v, false);
  double gain = slope(v, light_mean, light_variance, saturation);
  double responsivity = slope(v, photons, light_mean, saturation);
  double signal = v->bright.mean - v->dark.mean;
  double pattern = sqrt(fmax(v->bright.spatial - v->dark.spatial, 0.0));
  verify_add(v, (VerifyRow){"gain", "DN/e-", v->gain, gain, .allowed = 0.01});
  verify_add(v, (VerifyRow){"efficiency", "e-/photon", v->efficiency, responsivity / gain,
                            .allowed = 0.01});
  verify_add(v, (VerifyRow){"saturation", "e-", peak(v, true), saturation, .allowed = 0.01});
  add_dark(v, gain);
  verify_add(v, (VerifyRow){"PRNU", "%", 100.0 * def->prnu, 100.0 * pattern / signal,
                            .allowed = 0.01, .skip = def->prnu > 0.0 ? NULL : "there is none"});
  verify_add(v, (VerifyRow){"linearity error", "%", (double)NAN,
                            100.0 * linearity_error(v, saturation), .allowed = 0.1});
}
