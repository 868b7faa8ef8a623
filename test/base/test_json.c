/* test/base/test_json.c: JSON is parsed once; refused allocations are found, whichever they
 * are; messages are those about the text alone. */
#include <stdlib.h>
#include <string.h>

#include "base/json.h"
#include "unit.h"

/* jansson's allocations: how many there were, and which is refused; 0: none. */
static size_t made, refused;
static bool lasts; /* all later ones are refused, too */

static void *count_malloc(size_t size) {
  made++;
  return made == refused || (lasts && refused && made > refused) ? NULL : malloc(size);
}

static json_t *parse(const char *text, json_error_t *error) {
  made = 0;
  return vl_json_parse(text, strlen(text), JSON_REJECT_DUPLICATES, error);
}

/* A list of `count` members with strings and numbers of many lengths. */
static char *make_text(int count) {
  char *text = malloc((size_t)count * 200 + 10), *at = text;
  assert_non_null(text);
  at += sprintf(at, "[");
  for (int i = 0; i < count; i++)
    at += sprintf(at, "%s{\"name \\\" %0*d\":0.30000000000000004,\n \"b\":[%d,\"%.*s\"]}",
                  i ? "," : "", 1 + i % 40, i, i, i % 90,
                  "a string that is longer than any number, with an end that is easily lost: "
                  "0123456789");
  sprintf(at, "]");
  return text;
}

static void right_text_is_parsed_once(void **state) {
  (void)state;
  char *text = make_text(500);
  json_error_t error;
  made = 0;
  json_t *plain = json_loads(text, 0, &error);
  size_t once = made;
  json_t *tree = parse(text, &error);
  assert_non_null(tree);
  assert_true(json_equal(tree, plain));
  assert_true(made < once + 40);
  json_decref(tree);
  json_decref(plain);
  free(text);
}

static void every_refused_allocation_is_found(void **state) {
  (void)state;
  char *text = make_text(12);
  json_error_t error;
  json_t *right = parse(text, &error);
  size_t all = made;
  assert_non_null(right);
  for (size_t i = 2; i <= 2 * all + 1; i++) {
    refused = i / 2;
    lasts = i % 2;
    json_t *tree = parse(text, &error);
    refused = 0;
    assert_true(!tree || !lasts);
    if (tree)
      assert_true(json_equal(tree, right));
    else
      assert_true(vl_json_lacks_memory(&error));
    json_decref(tree);
  }
  json_decref(right);
  free(text);
}

/* What is right or wrong inside of an array only. */
static void messages_are_about_the_text(void **state) {
  (void)state;
  static const char *const texts[] = {
      "",           "1",     "1, 2",           "{} {}", "{},",   "{}], [{}",           "\"a",
      "{\"a\":1,}", "[1] ]", "\xef\xbb\xbf{}", "\\",    "[\"\\", "{\"a\":1,\n\"a\":2}"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    json_error_t error, plain;
    assert_null(json_loads(texts[i], JSON_REJECT_DUPLICATES, &plain));
    assert_null(parse(texts[i], &error));
    assert_false(vl_json_lacks_memory(&error));
    assert_string_equal(error.text, plain.text);
    assert_int_equal(error.line, plain.line);
    assert_int_equal(error.column, plain.column);
  }
}

/* As deep as jansson allows, and one deeper. */
static void deep_text(void **state) {
  (void)state;
  for (int depth = 2047; depth <= 2049; depth++) {
    char text[2 * 2049 + 1] = "";
    memset(text, '[', (size_t)depth);
    memset(text + depth, ']', (size_t)depth);
    json_error_t error;
    json_t *tree = parse(text, &error);
    assert_int_equal(tree != NULL, depth <= 2048);
    assert_true(tree || json_error_code(&error) == json_error_stack_overflow);
    json_decref(tree);
  }
}

static int set_up(void **state) {
  (void)state;
  json_set_alloc_funcs(count_malloc, free);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(right_text_is_parsed_once),
                                     cmocka_unit_test(every_refused_allocation_is_found),
                                     cmocka_unit_test(messages_are_about_the_text),
                                     cmocka_unit_test(deep_text)};
  return cmocka_run_group_tests(tests, set_up, NULL);
}
