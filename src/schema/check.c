/* schema/check.c: checks the value of a parameter by its row: range, finite numbers, choices, missing text. */
#include <math.h>
#include <stdio.h>

#include "base/unset.h"
#include "schema/schema.h"

static bool has_range(const vlParameter *p) {
  return p->low != 0 || p->high != 0;
}

static bool in_range(const vlParameter *p, double x) {
  if (p->flags & VL_PARAMETER_ABOVE_LOW ? !(x > p->low) : !(x >= p->low)) return false;
  return p->flags & VL_PARAMETER_BELOW_HIGH ? x < p->high : x <= p->high;
}

/* Writes a range in words, such as "above 0 and at most 64". */
static void put_range(const vlParameter *p, char *text, size_t size) {
  const char *low = p->flags & VL_PARAMETER_ABOVE_LOW ? "above" : "at least";
  const char *high = p->flags & VL_PARAMETER_BELOW_HIGH ? "below" : "at most";
  double k = p->factor != 0 ? 1 / p->factor : 1;
  if (isinf(p->high))
    snprintf(text, size, "%s %g", low, k * p->low);
  else if (isinf(p->low))
    snprintf(text, size, "%s %g", high, k * p->high);
  else
    snprintf(text, size, "%s %g and %s %g", low, k * p->low, high, k * p->high);
}

static bool check_number(const vlParameter *p, double x, const char *what, char message[200]) {
  if ((p->flags & VL_PARAMETER_UNSET) && vl_is_unset(x)) return true;
  bool finite = isfinite(x) || ((p->flags & VL_PARAMETER_INFINITE) && isinf(x));
  if (!finite) {
    snprintf(message, 200, "%s: parameter \"%s\" is not finite", what, vl_parameter_label(p));
    return false;
  }
  if (!has_range(p) || (p->flags & VL_PARAMETER_CLAMPED) || in_range(p, x)) return true;
  char range[80];
  put_range(p, range, sizeof range);
  snprintf(message, 200, "%s: parameter \"%s\" must be %s, it is %g", what, vl_parameter_label(p), range,
           p->factor != 0 ? x / p->factor : x);
  return false;
}

static uint32_t count_of(const char *const *choices) {
  uint32_t n = 0;
  while (choices && choices[n]) n++;
  return n;
}

bool vl_parameter_check(const vlParameter *p, const void *def, const char *what, char message[200]) {
  const char *at = (const char *)def + p->offset;
  double x;
  if (p->type == VL_PARAMETER_FLOAT3) {
    for (int i = 0; i < 3; i++)
      if (!check_number(p, (double)((const float *)(const void *)at)[i], what, message)) return false;
    return true;
  }
  if (p->type == VL_PARAMETER_DOUBLE3) {
    for (int i = 0; i < 3; i++)
      if (!check_number(p, ((const double *)(const void *)at)[i], what, message)) return false;
    return true;
  }
  if (p->type == VL_PARAMETER_CHOICE) {
    int choice = *(const int *)(const void *)at;
    if (choice >= 0 && (uint32_t)choice < count_of(p->choices)) return true;
    snprintf(message, 200, "%s: parameter \"%s\" has no choice %d", what, vl_parameter_label(p), choice);
    return false;
  }
  if ((p->type == VL_PARAMETER_STRING || p->type == VL_PARAMETER_FILE) && (p->flags & VL_PARAMETER_REQUIRED)) {
    if (*(const char *const *)(const void *)at) return true;
    snprintf(message, 200, "%s: parameter \"%s\" is missing", what, vl_parameter_label(p));
    return false;
  }
  return !vl_parameter_number(p, def, &x) || check_number(p, x, what, message);
}
