/* render/exposure.c: see exposure.h. The target value 0.18 is from Reinhard et al., "Photographic tone
 * reproduction", 2002. */
#include "render/exposure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/report.h"

int exposure_parse(const OptionValue *value, float *ev, bool *meter) {
  *ev = 0;
  *meter = false;
  if (!value->given) return -1;
  if (strcmp(value->text, "auto") == 0) {
    *meter = true;
    return -1;
  }
  char *end;
  double number = strtod(value->text, &end);
  if (end == value->text || *end || !(number >= -64 && number <= 64))
    return report_usage("--exposure \"%s\": must be auto or a number from -64 to 64", value->text);
  *ev = (float)number;
  return -1;
}

static double luminance(const vlImage *image, const int rgb[3], uint32_t x, uint32_t y) {
  static const double weights[3] = {0.2126, 0.7152, 0.0722};
  double sum = 0;
  for (int c = 0; c < 3; c++) sum += weights[c] * (double)vl_image_get(image, x, y, (uint32_t)rgb[c]);
  return sum > 0 && isfinite(sum) ? sum : 0;
}

float exposure_meter(const vlImage *image) {
  const int rgb[3] = {vl_image_find_channel(image, "R"), vl_image_find_channel(image, "G"),
                      vl_image_find_channel(image, "B")};
  int alpha = vl_image_find_channel(image, "A");
  if (rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0) return 0;
  uint32_t width = vl_image_width(image), height = vl_image_height(image);
  double total = 0, logs = 0, weights = 0;
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++) total += luminance(image, rgb, x, y);
  double least = 1e-3 * total / ((double)width * height);
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++) {
      double v = luminance(image, rgb, x, y);
      double w = alpha < 0 ? 1 : (double)vl_image_get(image, x, y, (uint32_t)alpha);
      if (v > 0 && v >= least && w > 0) logs += w * log2(v), weights += w;
    }
  if (!(weights > 0)) return 0;
  double ev = round(10 * (log2(0.18) - logs / weights)) / 10;
  return (float)(ev < -64 ? -64 : ev > 64 ? 64 : ev);
}

void exposure_tell(float ev) {
  report_note("exposed by %+.1f EV, as metered (--exposure 0 leaves the light as it is)", (double)ev);
}
