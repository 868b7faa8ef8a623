/* sensor/verify_frames.c: makes the frames of EMVA 1288 (release 3.1) and takes their
 * statistics: pairs of flat fields and dark frames at exposure times that grow in equal steps,
 * and stacks of both at half of the saturation. */
#include <stdlib.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "sensor/verify.h"

/* Exposes all pixels to a mean and keeps the numbers in frames[which]. */
static int expose_all(Verify *v, double electrons, double time, int which) {
  size_t count = (size_t)v->size * v->size;
  for (size_t i = 0; i < count; i++)
    v->means[i] = electrons;
  vlExposureDef exposure = v->exposure;
  exposure.time = time;
  exposure.frame = v->frame++;
  vlSensorOutput out = {.numbers = v->frames[which]};
  vlError error = {0};
  TRY(report_error(
      &error,
      vl_sensor_read_out(v->sensor, v->size, v->size, v->means, &exposure, &out, &error),
      NULL));
  return verify_folder_frame(v, which);
}

/* Mean and temporal variance of a pair: half of the mean squared difference, less that of the
 * means (EMVA 1288, equations of the temporal noise). Fixed patterns cancel. */
static void measure_pair(const Verify *v, double *mean, double *variance) {
  size_t count = (size_t)v->size * v->size;
  int64_t sum = 0;
  int64_t difference = 0;
  int64_t squares = 0;
  for (size_t i = 0; i < count; i++) {
    int64_t d = (int64_t)v->frames[0][i] - v->frames[1][i];
    sum += v->frames[0][i] + v->frames[1][i];
    difference += d;
    squares += d * d;
  }
  double n = (double)count;
  double mean_difference = (double)difference / n;
  *mean = (double)sum / (2.0 * n);
  *variance = 0.5 * ((double)squares / n - mean_difference * mean_difference);
}

static int make_pair(Verify *v, char kind, double electrons, double time, double *mean,
                     double *variance) {
  TRY(verify_folder_series(v, kind, time, electrons));
  for (int i = 0; i < 2; i++)
    TRY(expose_all(v, electrons, time, i));
  measure_pair(v, mean, variance);
  return -1;
}

/* A stack of frames: per pixel the sum and the sum of squares, as whole numbers. */
static int make_stack(Verify *v, char kind, double electrons, double time, VerifyStack *stack) {
  size_t count = (size_t)v->size * v->size;
  uint32_t *sums = calloc(count, sizeof *sums);
  uint64_t *squares = calloc(count, sizeof *squares);
  int status =
      sums && squares ? verify_folder_series(v, kind, time, electrons) : report_no_memory();
  for (uint32_t f = 0; f < v->stack && status < 0; f++) {
    status = expose_all(v, electrons, time, 0);
    for (size_t i = 0; i < count; i++) {
      uint32_t number = v->frames[0][i];
      sums[i] += number;
      squares[i] += (uint64_t)number * number;
    }
  }
  double mean = 0.0;
  double temporal = 0.0;
  double spatial = 0.0;
  double frames = v->stack;
  for (size_t i = 0; i < count && status < 0; i++) {
    double sum = sums[i];
    mean += sum / frames;
    temporal += ((double)squares[i] - sum * sum / frames) / (frames - 1.0);
  }
  mean /= (double)count;
  temporal /= (double)count;
  for (size_t i = 0; i < count && status < 0; i++)
    spatial += (sums[i] / frames - mean) * (sums[i] / frames - mean);
  spatial = spatial / ((double)count - 1.0) - temporal / frames;
  *stack = (VerifyStack){mean, spatial};
  free(sums);
  free(squares);
  return status;
}

int verify_frames(Verify *v) {
  TRY(verify_folder_open(v));
  for (int i = 0; i < VERIFY_STEPS; i++) {
    VerifyStep *step = &v->steps[i];
    double part = (i + 1.0) / VERIFY_STEPS;
    step->time = v->full_time * part;
    step->electrons = v->full_electrons * part;
    TRY(make_pair(v, 'b', step->electrons, step->time, &step->mean, &step->variance));
    TRY(make_pair(v, 'd', 0.0, step->time, &step->dark_mean, &step->dark_variance));
  }
  double half = 0.5 * v->saturation / v->full_electrons;
  double time = v->full_time * half;
  TRY(make_stack(v, 'b', v->full_electrons * half, time, &v->bright));
  TRY(make_stack(v, 'd', 0.0, time, &v->dark));
  return verify_folder_close(v);
}
