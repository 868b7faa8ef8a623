/* sensor/verify_edge.c: the modulation transfer function by a slanted edge (ISO 12233), of the
 * numbers before any demosaicing, against the closed form of pixel box and crosstalk. */
#include <math.h>
#include <stdlib.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "image/image.h"
#include "sensor/verify.h"

enum {
  EDGE_SIDE = 256,  /* pixels */
  EDGE_FRAMES = 16, /* which are averaged */
  BINS_PER_PIXEL = 4,
  WINDOW = 8, /* pixels on each side of the edge */
  BINS = 2 * WINDOW * BINS_PER_PIXEL,
  FREQUENCIES = 10 /* 0.05 to 0.5 cycles per pixel */
};

/* A line nx x + ny y = d; pixel centres are whole numbers. */
typedef struct Edge {
  double nx, ny, d;
} Edge;

static double half_square(double z) {
  return z > 0.0 ? 0.5 * z * z : 0.0;
}

/* Share of the square of that side around (x, y) beyond the edge: the exact area. */
static double coverage(const Edge *e, double side, double x, double y) {
  double a = 0.5 * side * e->nx;
  double b = 0.5 * side * e->ny;
  double z = e->nx * x + e->ny * y - e->d;
  double area = half_square(z + a + b) - half_square(z - a + b) - half_square(z + a - b) +
                half_square(z - a - b);
  return area / (4.0 * a * b);
}

/* The modulation that the sensor's numbers give at a frequency across the edge. */
static double expected(const vlSensorDef *def, const Edge *e, double frequency) {
  double side = sqrt(def->fill_factor);
  double real = 0.0;
  double imaginary = 0.0;
  for (int j = 0; j < 9; j++) {
    double phase = 2.0 * M_PI * frequency * (e->nx * (j % 3 - 1) + e->ny * (j / 3 - 1));
    real += def->crosstalk[j] * cos(phase);
    imaginary += def->crosstalk[j] * sin(phase);
  }
  double x = M_PI * frequency * side * e->nx;
  double y = M_PI * frequency * side * e->ny;
  return hypot(real, imaginary) * fabs(sin(x) / x * sin(y) / y);
}

/* An image of the edge: two equal buckets, 1 beyond it and a quarter on this side. */
static vlResult edge_image(vlContext *context, const Edge *e, double side, vlImage **image) {
  static const char *const names[2] = {"S0.500nm", "S0.600nm"};
  TRY_RESULT(image_make(context, EDGE_SIDE, EDGE_SIDE, 2, names, image));
  float *pixel = vl_image_pixels(*image);
  for (int y = 0; y < EDGE_SIDE; y++)
    for (int x = 0; x < EDGE_SIDE; x++, pixel += 2)
      pixel[0] = pixel[1] = (float)(0.25 + 0.75 * coverage(e, side, x, y));
  return VL_OK;
}

/* The sensor without its mosaic and its angles, since the edge is grey, and without fixed
 * patterns, which a correction by flat fields takes out before an edge is measured. */
static vlResult plain_sensor(const Verify *v, vlSensor **sensor) {
  vlSensorDef def = *vl_sensor_def(v->sensor);
  double at[2] = {300.0, 900.0};
  double one[2] = {1.0, 1.0};
  def.filter_count = 0;
  def.angle_count = 0;
  def.prnu = 0.0;
  def.dsnu = 0.0;
  def.dark_nonuniformity = 0.0;
  vl_sensor_set_pattern(&def, "mono", NULL);
  vl_sensor_set_efficiency(&def, 'W', 2, at, one, NULL);
  return vl_sensor_create(v->context, &def, sensor, NULL);
}

/* Exposes the edge so that its bright side is half of the saturation, and sums the frames. */
static vlResult sum_frames(Verify *v, const vlSensor *sensor, const vlImage *image,
                           double *sums) {
  static uint16_t numbers[EDGE_SIDE * EDGE_SIDE];
  double *means = malloc(sizeof *means * EDGE_SIDE * EDGE_SIDE);
  vlExposureDef exposure = v->exposure;
  vlSensorOutput out = {.numbers = numbers};
  vlResult result = means ? VL_OK : VL_ERROR_MEMORY;
  exposure.time = 0.01;
  exposure.focal_length = 0.0;
  exposure.radiance = 1.0;
  if (result == VL_OK)
    result = vl_sensor_collect(sensor, image, &exposure, means, &out, NULL);
  double brightest = 0.0;
  for (int i = 0; i < EDGE_SIDE * EDGE_SIDE && result == VL_OK; i++)
    brightest = fmax(brightest, means[i]);
  for (int i = 0; i < EDGE_SIDE * EDGE_SIDE && result == VL_OK; i++)
    means[i] *= 0.5 * v->saturation / brightest;
  for (int f = 0; f < EDGE_FRAMES && result == VL_OK; f++) {
    exposure.frame = v->frame++;
    result = vl_sensor_read_out(sensor, EDGE_SIDE, EDGE_SIDE, means, &exposure, &out, NULL);
    for (int i = 0; i < EDGE_SIDE * EDGE_SIDE; i++)
      sums[i] += numbers[i];
  }
  free(means);
  return result;
}

/* The edge from the numbers: the centre of each row's differences, and the line through them
 * that fits best. */
static Edge find_edge(const double *sums, double guess) {
  double sy = 0.0;
  double syy = 0.0;
  double sx = 0.0;
  double sxy = 0.0;
  for (int y = 0; y < EDGE_SIDE; y++) {
    double weights = 0.0;
    double moment = 0.0;
    double middle = guess - (y - 0.5 * EDGE_SIDE) * tan(5.0 * M_PI / 180.0);
    for (int i = -WINDOW; i < WINDOW; i++) {
      int x = (int)floor(middle) + i;
      double step = sums[y * EDGE_SIDE + x + 1] - sums[y * EDGE_SIDE + x];
      weights += step;
      moment += step * (x + 0.5);
    }
    double centre = moment / weights;
    sy += y;
    syy += (double)y * y;
    sx += centre;
    sxy += centre * y;
  }
  double n = EDGE_SIDE;
  double tilt = (n * sxy - sx * sy) / (n * syy - sy * sy); /* x = offset + tilt y */
  double offset = (sx - tilt * sy) / n;
  double length = hypot(1.0, tilt);
  return (Edge){1.0 / length, -tilt / length, offset / length};
}

/* Means of the numbers by their distance from the edge, in quarters of a pixel. */
static void spread_function(const double *sums, const Edge *e, double values[BINS]) {
  double counts[BINS] = {0};
  for (int i = 0; i < BINS; i++)
    values[i] = 0.0;
  for (int y = 0; y < EDGE_SIDE; y++)
    for (int x = 0; x < EDGE_SIDE; x++) {
      double distance = e->nx * x + e->ny * y - e->d;
      double bin = floor((distance + WINDOW) * BINS_PER_PIXEL);
      if (!(bin >= 0.0 && bin < BINS)) /* NaN, too: there is no edge */
        continue;
      values[(int)bin] += sums[y * EDGE_SIDE + x];
      counts[(int)bin] += 1.0;
    }
  for (int i = 0; i < BINS; i++)
    values[i] /= counts[i];
}

/* The modulation of the differences, with what bins and differences take put back. */
static double modulation(const double values[BINS], double frequency) {
  double real = 0.0;
  double imaginary = 0.0;
  for (int i = 0; i + 1 < BINS; i++) {
    double phase = 2.0 * M_PI * frequency * i / BINS_PER_PIXEL;
    real += (values[i + 1] - values[i]) * cos(phase);
    imaginary += (values[i + 1] - values[i]) * sin(phase);
  }
  double x = M_PI * frequency / BINS_PER_PIXEL;
  double lost = sin(x) / x;
  return hypot(real, imaginary) / (values[BINS - 1] - values[0]) / (lost * lost);
}

int verify_edge(Verify *v) {
  const vlSensorDef *def = vl_sensor_def(v->sensor);
  double angle = 5.0 * M_PI / 180.0;
  double middle = 0.5 * EDGE_SIDE + 0.3;
  Edge real = {cos(angle), sin(angle), 0.0};
  real.d = real.nx * middle + real.ny * 0.5 * EDGE_SIDE;
  vlImage *image = NULL;
  vlSensor *sensor = NULL;
  double *sums = calloc(EDGE_SIDE * EDGE_SIDE, sizeof *sums);
  vlResult result =
      sums ? edge_image(v->context, &real, sqrt(def->fill_factor), &image) : VL_ERROR_MEMORY;
  if (result == VL_OK)
    result = plain_sensor(v, &sensor);
  if (result == VL_OK)
    result = sum_frames(v, sensor, image, sums);
  double worst = 0.0;
  if (result == VL_OK) {
    double values[BINS];
    Edge found = find_edge(sums, middle);
    spread_function(sums, &found, values);
    for (int i = 1; i <= FREQUENCIES; i++) {
      double frequency = 0.5 * i / FREQUENCIES;
      double ratio = modulation(values, frequency) / expected(def, &real, frequency);
      double error = fabs(ratio - 1.0);
      worst = error <= worst ? worst : error; /* NaN stays */
    }
    verify_add(v, (VerifyRow){"MTF error to 0.5/pixel", "%", (double)NAN, 100.0 * worst,
                              .allowed = 2.0});
  }
  vl_image_destroy(image);
  vl_sensor_destroy(sensor);
  free(sums);
  return report_reason(result, "sensor verify", "the edge");
}
