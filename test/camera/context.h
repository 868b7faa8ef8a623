/* test/camera/context.h: the context that all tests of a program share. */
#ifndef TEST_CAMERA_CONTEXT_H
#define TEST_CAMERA_CONTEXT_H

#include "camera/cameras.h"

static vlContext *context;

static inline int begin(void **state) {
  (void)state;
  return vl_context_create(NULL, &context) != VL_OK;
}
static inline int end(void **state) {
  (void)state;
  vl_context_destroy(context);
  return 0;
}

#endif
