/* schema/check.c: checks the value of a parameter in a def by its row: range, finite numbers,
 * choices, missing text. */
#include <stdio.h>

#include "schema/given.h"
#include "schema/schema.h"

static bool check_number(const vlParameter *p, double x, const char *name,
                         char message[VL_GIVEN_MESSAGE]) {
  if (vl_in_range(p, x))
    return true;
  double factor = p->factor != 0 ? p->factor : 1;
  const vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = x / factor, .factor = factor};
  vl_put_wrong(p, name, &given, message, VL_GIVEN_MESSAGE);
  return false;
}

static uint32_t count_of(const char *const *choices) {
  uint32_t n = 0;
  while (choices && choices[n])
    n++;
  return n;
}

bool vl_parameter_check(const vlParameter *p, const void *def, const char *name,
                        char message[VL_GIVEN_MESSAGE]) {
  const char *at = (const char *)def + p->offset;
  double x;
  if (p->type == VL_PARAMETER_FLOAT3) {
    for (int i = 0; i < 3; i++)
      if (!check_number(p, (double)((const float *)(const void *)at)[i], name, message))
        return false;
    return true;
  }
  if (p->type == VL_PARAMETER_DOUBLE3) {
    for (int i = 0; i < 3; i++)
      if (!check_number(p, ((const double *)(const void *)at)[i], name, message))
        return false;
    return true;
  }
  if (p->type == VL_PARAMETER_CHOICE) {
    int choice = *(const int *)(const void *)at;
    if (choice >= 0 && (uint32_t)choice < count_of(p->choices))
      return true;
    const vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = choice};
    vl_put_wrong(p, name, &given, message, VL_GIVEN_MESSAGE);
    return false;
  }
  if ((p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE) &&
      (p->flags & VL_PARAMETER_REQUIRED)) {
    if (*(const char *const *)(const void *)at)
      return true;
    snprintf(message, VL_GIVEN_MESSAGE, "%s is missing", name);
    return false;
  }
  if (p->type == VL_PARAMETER_BOOL)
    return true;
  return !vl_parameter_number(p, def, &x) || check_number(p, x, name, message);
}
