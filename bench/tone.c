/* bench/tone.c: the last step of developing a raw image: sRGB's curve of each value, and the
 * table of raw/tone.h with the time to make it. CPU time of one thread; medians of rounds. */
#include <stdio.h>
#include <stdlib.h>

#include "image/pixel.h"
#include "math/hash.h"
#include "measure.h"
#include "raw/tone.h"

enum { ROUNDS = 5 };

static double curve_seconds(const float *values, size_t count, uint16_t *codes) {
  double start = processor_seconds();
  for (size_t i = 0; i < count; i++)
    codes[i] = (uint16_t)(vl_linear_to_srgb((double)values[i]) * 65535.0 + 0.5);
  return processor_seconds() - start;
}

static double table_seconds(vlContext *context, vlTone *tone, const float *values, size_t count,
                            uint16_t *codes) {
  double start = processor_seconds();
  vl_tone_make(context, tone);
  vl_tone_apply(tone, 1.0, values, count, codes);
  return processor_seconds() - start;
}

int main(int argc, char **argv) {
  const double megapixels = argc > 1 ? atof(argv[1]) : 24.0;
  if (!(megapixels > 0.0 && megapixels <= 1000.0)) {
    fprintf(stderr, "usage: bench_tone [MEGAPIXELS]\n");
    return 2;
  }
  vlContextDef def = vl_default_context_def();
  vlContext *context = NULL;
  size_t count = (size_t)(3e6 * megapixels);
  float *values = malloc(count * sizeof *values);
  uint16_t *codes = malloc(count * sizeof *codes);
  vlTone *tone = malloc(sizeof *tone);
  def.threads = 1;
  if (!values || !codes || !tone || vl_context_create(&def, &context) != VL_OK)
    return 1;
  for (size_t i = 0; i < count; i++) {
    float u = vl_unit_float(vl_hash3((uint32_t)i, (uint32_t)(i >> 32), 1));
    values[i] = u * u; /* as in images: more dark values than bright ones */
  }
  double curve[ROUNDS], table[ROUNDS], ratio[ROUNDS];
  for (int i = 0; i < ROUNDS; i++) {
    curve[i] = curve_seconds(values, count, codes);
    table[i] = table_seconds(context, tone, values, count, codes);
    ratio[i] = curve[i] / table[i];
  }
  printf("%g megapixels: curve %.3f s, table %.3f s, ratio %.1f\n", megapixels,
         median(curve, ROUNDS), median(table, ROUNDS), median(ratio, ROUNDS));
  vl_context_destroy(context);
  free(tone);
  free(codes);
  free(values);
  return 0;
}
