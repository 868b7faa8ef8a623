/* schema/member.c: see member.h. */
#include "schema/member.h"

#include "velo/texture.h"

_Static_assert(sizeof(vlWrap) == sizeof(int), "choices are stored as int");

static double get_bool(const void *at, int i) {
  return ((const bool *)at)[i];
}
static void put_bool(void *at, int i, double number) {
  ((bool *)at)[i] = number != 0;
}
static double get_count(const void *at, int i) {
  return ((const uint32_t *)at)[i];
}
static void put_count(void *at, int i, double number) {
  ((uint32_t *)at)[i] = (uint32_t)number;
}
static double get_choice(const void *at, int i) {
  return ((const int *)at)[i];
}
static void put_choice(void *at, int i, double number) {
  ((int *)at)[i] = (int)number;
}
static double get_float(const void *at, int i) {
  return (double)((const float *)at)[i];
}
static void put_float(void *at, int i, double number) {
  ((float *)at)[i] = (float)number;
}
static double get_double(const void *at, int i) {
  return ((const double *)at)[i];
}
static void put_double(void *at, int i, double number) {
  ((double *)at)[i] = number;
}

#define NUMBERS(count, offset, get_function, put_function) \
  .numbers = (count), .number = (offset), .get = get_function, .put = put_function
const vlMemberType vl_member_types[] = {
    [VL_PARAMETER_BOOL] = {NUMBERS(1, 0, get_bool, put_bool), .rule = "true or false"},
    [VL_PARAMETER_COUNT] = {NUMBERS(1, 0, get_count, put_count)},
    [VL_PARAMETER_FLOAT] = {NUMBERS(1, 0, get_float, put_float)},
    [VL_PARAMETER_DOUBLE] = {NUMBERS(1, 0, get_double, put_double)},
    [VL_PARAMETER_FLOAT3] = {NUMBERS(3, 0, get_float, put_float)},
    [VL_PARAMETER_DOUBLE3] = {NUMBERS(3, 0, get_double, put_double)},
    [VL_PARAMETER_CHOICE] = {NUMBERS(1, 0, get_choice, put_choice)},
    [VL_PARAMETER_STRING] = {.text = true, .rule = "text"},
    [VL_PARAMETER_FILE] = {.text = true, .rule = "the path of a file"},
    [VL_PARAMETER_SPECTRUM] = {.spectral = true},
    [VL_PARAMETER_FLOAT_INPUT] = {NUMBERS(1, offsetof(vlFloatInput, value), get_float,
                                          put_float),
                                  .textured = true},
    [VL_PARAMETER_SPECTRUM_INPUT] = {.textured = true,
                                     .spectral = true,
                                     .spectrum = offsetof(vlSpectrumInput, value)},
    [VL_PARAMETER_EITHER_INPUT] = {NUMBERS(1, offsetof(vlFloatInput, value), get_float,
                                           put_float),
                                   .textured = true},
    [VL_PARAMETER_TEXTURE] = {.textured = true, .rule = "a texture"},
    [VL_PARAMETER_BLOCK] = {.rule = "what its file's format says"}};
