/* Included by script/analyse before each file of the library. clang-tidy analyses one file at a
 * time, so it does not know that the functions of base/error.h return the error code that they
 * receive. This header tells it. */
#include "base/error.h"
#define vl_fail(error, code, ...) (vl_fail(error, code, __VA_ARGS__), (code))
#define vl_fail_at(error, code, ...) (vl_fail_at(error, code, __VA_ARGS__), (code))
#define vl_fail_memory(error) (vl_fail_memory(error), VL_ERROR_MEMORY)
