/* test_tone.c: sRGB's curve by the table is the curve itself, rounded, for values of all sizes;
 * numbers outside of [0, 1]. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/pixel.h"
#include "raw/tone.h"
#include "unit.h"

enum { COUNT = 1 << 20 };

static uint16_t by_curve(double linear) {
  return (uint16_t)(vl_linear_to_srgb(fmin(fmax(linear, 0.0), 1.0)) * 65535.0 + 0.5);
}

static void compare(const vlTone *tone, double scale, const float *values, uint16_t *codes) {
  vl_tone_apply(tone, scale, values, COUNT, codes);
  for (uint32_t i = 0; i < COUNT; i++)
    if (codes[i] != by_curve(scale * (double)values[i]))
      fail_msg("%.9g * %g: %u, not %u", (double)values[i], scale, codes[i],
               by_curve(scale * (double)values[i]));
}

static void test_curve(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  vlContext *context = NULL;
  def.threads = 3;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlTone *tone = malloc(sizeof *tone), *alone = malloc(sizeof *alone);
  float *values = malloc(COUNT * sizeof *values);
  uint16_t *codes = malloc(COUNT * sizeof *codes);
  vl_tone_make(context, tone);
  for (uint32_t i = 0; i < COUNT; i++) /* evenly, and by powers of two down to 2^-30 */
    values[i] = i % 2 ? ((float)i + 0.3f) / COUNT : exp2f(-30.0f * (float)i / COUNT);
  compare(tone, 1.0, values, codes);
  compare(tone, 1.75, values, codes);
  compare(tone, 0x1p-9, values, codes);
  for (uint32_t i = 0; i < COUNT; i++) /* the neighbours of where codes begin */
    values[i] = nextafterf((float)vl_srgb_to_linear((i / 16 - 0.5) / 65535.0), (float)(i % 2));
  compare(tone, 1.0, values, codes);
  vl_context_destroy(context);
  def.threads = 1;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vl_tone_make(context, alone);
  assert_memory_equal(alone, tone, sizeof *tone);
  const float odd[10] = {NAN,  -NAN, -INFINITY, -1.0f,        -0.0f,
                         0.0f, 1.0f, INFINITY,  1.000000119f, 3e38f};
  const uint16_t expected[10] = {0, 0, 0, 0, 0, 0, 65535, 65535, 65535, 65535};
  vl_tone_apply(tone, 1.0, odd, 10, codes);
  assert_memory_equal(codes, expected, sizeof expected);
  free(tone);
  free(alone);
  free(values);
  free(codes);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_curve)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
