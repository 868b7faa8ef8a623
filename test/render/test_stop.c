/* test/render/test_stop.c: what ends the tasks of a pass: the deadline, the caller's callback,
 * a request to cancel; each for all tasks that come after. */
#include "render/stop.h"
#include "unit.h"

static bool ask_and_count(void *user) {
  int *asked = user;
  return ++*asked == 2;
}

static void deadline_in_the_past(void **state) {
  (void)state;
  vlStop stop;
  vl_stop_init(&stop, NULL, NULL, NULL);
  assert_false(vl_stop_check(&stop));
  stop.deadline = vl_seconds() + 1000;
  assert_false(vl_stop_check(&stop));
  stop.deadline = vl_seconds() - 1;
  assert_true(vl_stop_check(&stop));
  assert_true(stop.late);
  stop.deadline = 0;
  assert_true(vl_stop_check(&stop));
}

static void callback(void **state) {
  (void)state;
  int asked = 0;
  vlStop stop;
  vl_stop_init(&stop, NULL, ask_and_count, &asked);
  stop.last = vl_seconds() - 1;
  assert_false(vl_stop_check(&stop));
  assert_int_equal(asked, 1);
  stop.last = vl_seconds() - 1;
  assert_true(vl_stop_check(&stop));
  assert_true(vl_stop_check(&stop));
  assert_int_equal(asked, 2);
  assert_false(stop.late);
}

static void cancelled(void **state) {
  (void)state;
  vlContext *context;
  vlCancel *cancel;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  assert_int_equal(vl_cancel_create(context, &cancel), VL_OK);
  vlStop stop;
  vl_stop_init(&stop, cancel, NULL, NULL);
  assert_false(vl_stop_check(&stop));
  vl_cancel_request(cancel);
  assert_true(vl_stop_check(&stop));
  assert_true(stop.stopped);
  vl_cancel_destroy(cancel);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(deadline_in_the_past),
                                     cmocka_unit_test(callback), cmocka_unit_test(cancelled)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
