/* Included by script/analyse before each file of the library: clang-tidy sees one file at a time, and so does not know
 * that the functions of base/error.h return the code that they are given, which is an error. */
#include "base/error.h"
#define vl_fail(error, code, ...) (vl_fail(error, code, __VA_ARGS__), (code))
#define vl_fail_at(error, code, ...) (vl_fail_at(error, code, __VA_ARGS__), (code))
#define vl_fail_memory(error) (vl_fail_memory(error), VL_ERROR_MEMORY)
