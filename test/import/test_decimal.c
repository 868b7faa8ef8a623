/* test/import/test_decimal.c: decimal numbers are converted to the nearest double, as by
 * strtod, in every notation. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "import/pbrt/decimal.h"
#include "statistics.h"
#include "unit.h"

static void same(const char *text) {
  double value = 0, expected = strtod(text, NULL);
  bool valid = vl_number_parse(text, strlen(text), &value);
  assert_int_equal(valid, isfinite(expected));
  if (valid && memcmp(&value, &expected, sizeof value) != 0)
    fail_msg("%s is %a, not %a", text, expected, value);
}

static void random_digits(void **state) {
  (void)state;
  statRng rng = stat_rng(5);
  for (int k = 0; k < 200000; k++) {
    char text[64];
    int digits = 1 + (int)(stat_bits(&rng) % 25), point = (int)(stat_bits(&rng) % 26), n = 0;
    for (int i = 0; i < digits; i++) {
      if (i == point)
        text[n++] = '.';
      text[n++] = (char)('0' + stat_bits(&rng) % 10);
    }
    int range = k % 2 ? 30 : 345,
        exponent = (int)(stat_bits(&rng) % (uint64_t)(2 * range)) - range;
    snprintf(text + n, sizeof text - (size_t)n, "e%d", exponent);
    same(text);
  }
}

/* Doubles as programs print them, and the midpoints between neighbouring doubles, which need
 * more than 17 digits. */
static void doubles_and_ties(void **state) {
  (void)state;
  statRng rng = stat_rng(6);
  for (int k = 0; k < 3000; k++) {
    uint64_t bits = stat_bits(&rng) >> 1;
    if (k % 10 == 0)
      bits >>= 12; /* denormal */
    double x;
    memcpy(&x, &bits, sizeof x);
    if (!isfinite(x))
      continue;
    static char text[1200];
    snprintf(text, sizeof text, "%.17g", x);
    same(text);
    double ulp = nextafter(x, INFINITY) - x;
    if (sizeof(long double) == sizeof x || isinf(ulp))
      continue;
    int n = snprintf(text, sizeof text, "%.1000Lg", (long double)x + (long double)ulp / 2);
    same(text);
    char *e = strchr(text, 'e');
    char tail[16] = "";
    if (e) {
      snprintf(tail, sizeof tail, "%s", e);
      n = (int)(e - text);
    }
    /* above */
    snprintf(text + n, sizeof text - (size_t)n, "%s1%s", strchr(text, '.') ? "" : ".", tail);
    same(text);
  }
}

/* At most 19 digits, just below, at and just above the midpoint between two doubles: what is
 * left after the quotient's bits decides. */
static void beside_midpoints(void **state) {
  (void)state;
  statRng rng = stat_rng(7);
  for (int k = 0; k < 3000; k++) {
    const uint64_t middle = (UINT64_C(1) << 53) + 1 + 2 * (stat_bits(&rng) % 450000000000000);
    char text[64];
    for (int beside = -1; beside <= 1; beside++) {
      const uint64_t off = (uint64_t)beside * (1 + stat_bits(&rng) % 999);
      snprintf(text, sizeof text, "%llue-3", (unsigned long long)(1000 * middle + off));
      same(text);
    }
  }
}

static void ends(void **state) {
  (void)state;
  const char *const texts[] = {"0",
                               "-0",
                               "0e999",
                               "0.000",
                               "1e-400",
                               "1e400",
                               "1e308",
                               "1.7976931348623157e308",
                               "1.7976931348623158e308",
                               "1.7976931348623159e308",
                               "4.9e-324",
                               "2.4703282292062327e-324",
                               "2.4703282292062328e-324",
                               "2.2250738585072011e-308",
                               "2.2250738585072014e-308",
                               "9007199254740993",
                               "9007199254740992.99999999999999999999999999",
                               "1e22",
                               "1e23",
                               "8.5e22",
                               "123456789012345678901234567890",
                               "0.1",
                               ".1e1",
                               "1.",
                               "100000000000000000000000",
                               "18446744073709551615",
                               "999999999999999999",
                               "1000000000000000000"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
    same(texts[i]);
  static char text[4000];
  memset(text, '0', sizeof text - 1);
  text[1] = '.';
  text[3000] = '7';
  strcpy(text + 3600, "e2999");
  same(text); /* 7 after 3000 zeros; the exponent makes it 0.7 */
  text[0] = '1';
  text[2500] = '.';
  text[1] = '0';
  strcpy(text + 3600, "e-2499");
  same(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_digits),
      cmocka_unit_test(doubles_and_ties),
      cmocka_unit_test(beside_midpoints),
      cmocka_unit_test(ends),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
