/* test/import/test_token.c: tokens with their places; numbers correct to the last bit. */
#include "import/load.h"
#include "import/pbrt/decimal.h"
#include "import/pbrt/token.h"

static vlTokenizer tokens;
static char text[1024];

static void begin(const char *source) {
  snprintf(text, sizeof text, "%s", source);
  vl_tokenizer_start(&tokens, text, strlen(text));
}

static void expect(vlTokenKind kind, const char *content, uint32_t line, uint32_t column) {
  vlToken t = vl_token_next(&tokens);
  assert_int_equal(t.kind, kind);
  assert_int_equal(t.line, line);
  assert_int_equal(t.column, column);
  if (content) {
    assert_int_equal(t.length, strlen(content));
    assert_memory_equal(t.text, content, t.length);
  }
}

static void words_and_places(void **state) {
  (void)state;
  begin("Shape \"sphere\" # comment [ \"\n\t\"float radius\"[1.5]\r\n\"a\\\"b\\\\c\\n\"]x#y\n");
  expect(VL_TOKEN_WORD, "Shape", 1, 1);
  expect(VL_TOKEN_STRING, "sphere", 1, 7);
  expect(VL_TOKEN_STRING, "float radius", 2, 2);
  expect(VL_TOKEN_OPEN, NULL, 2, 16);
  expect(VL_TOKEN_WORD, "1.5", 2, 17);
  expect(VL_TOKEN_CLOSE, NULL, 2, 20);
  expect(VL_TOKEN_STRING, "a\"b\\c\n", 3, 1);
  expect(VL_TOKEN_CLOSE, NULL, 3, 12);
  expect(VL_TOKEN_WORD, "x", 3, 13);
  expect(VL_TOKEN_END, NULL, 4, 1);
  expect(VL_TOKEN_END, NULL, 4, 1);
}

static void byte_order_mark_and_empty(void **state) {
  (void)state;
  begin("\xef\xbb\xbfWorldBegin");
  expect(VL_TOKEN_WORD, "WorldBegin", 1, 1);
  begin("");
  expect(VL_TOKEN_END, NULL, 1, 1);
  begin("# only a comment");
  expect(VL_TOKEN_END, NULL, 1, 17);
}

static void bad_strings(void **state) {
  (void)state;
  const char *bad[] = {"\"abc", "\"abc\n\"", "\"a\\q\"", "\"a\\", "\"abc\\\"", NULL};
  for (int i = 0; bad[i]; i++) {
    begin(bad[i]);
    vlToken t = vl_token_next(&tokens);
    assert_int_equal(t.kind, VL_TOKEN_BAD);
    assert_int_equal(t.column, 1);
    assert_non_null(t.message);
  }
}

static void numbers(void **state) {
  (void)state;
  const struct {
    const char *text;
    double value;
  } good[] = {{"0", 0},
              {"-0", -0.0},
              {"7", 7},
              {"+3", 3},
              {"-12", -12},
              {".5", 0.5},
              {"5.", 5},
              {"-.25", -.25},
              {"1e3", 1e3},
              {"1E+3", 1e3},
              {"2.5e-3", 2.5e-3},
              {"0x1F", 31},
              {"-0xff", -255},
              {"00012", 12},
              {"0.1", 0.1},
              {"3.14159265358979", 3.14159265358979},
              {"1e22", 1e22},
              {"123456789012345678901234567890", 123456789012345678901234567890.0},
              {"0.000000000000000000000000000001", 1e-30},
              {"1e-300", 1e-300},
              {"1.7976931348623157e308", 1.7976931348623157e308},
              {"4.9e-324", 4.9e-324},
              {"1e-500", 0},
              {"9007199254740993", 9007199254740992.0}};
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    double v = -1;
    assert_true(vl_number_parse(good[i].text, strlen(good[i].text), &v));
    assert_true(v == good[i].value && signbit(v) == signbit(good[i].value));
  }
  const char *bad[] = {"",      "-",   "+",   ".",    "e5",    "1e",
                       "1e+",   "nan", "inf", "-inf", "1e309", "1e999999999999",
                       "1.2.3", "1,5", "0x",  "0xg",  "1f",    "--1",
                       "1e5.0"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double v;
    if (vl_number_parse(bad[i], strlen(bad[i]), &v))
      print_message("accepted \"%s\"\n", bad[i]);
    assert_false(vl_number_parse(bad[i], strlen(bad[i]), &v));
  }
}

/* What printf writes comes back: floats exactly, doubles to the last bit but one. */
static void round_trips(void **state) {
  (void)state;
  uint64_t random = 88172645463325252ull;
  for (int i = 0; i < 200000; i++) {
    random ^= random << 13;
    random ^= random >> 7;
    random ^= random << 17;
    uint32_t bits = (uint32_t)(random >> 16);
    float f;
    memcpy(&f, &bits, 4);
    if (!isfinite(f))
      continue;
    char s[64];
    double v;
    int n = snprintf(s, sizeof s, "%.9g", (double)f);
    assert_true(vl_number_parse(s, (size_t)n, &v));
    assert_true((float)v == f);
    double d = (double)(int64_t)random * 1e-9;
    n = snprintf(s, sizeof s, "%.17g", d);
    assert_true(vl_number_parse(s, (size_t)n, &v));
    assert_true(fabs(v - d) <= 2.3e-16 * fabs(d));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(words_and_places), cmocka_unit_test(byte_order_mark_and_empty),
      cmocka_unit_test(bad_strings),      cmocka_unit_test(numbers),
      cmocka_unit_test(round_trips),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
