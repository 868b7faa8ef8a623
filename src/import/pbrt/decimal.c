/* import/pbrt/decimal.c: see decimal.h. Three methods are tried in turn, until the result is
 * certain: one operation on two exact doubles (Clinger 1990); a pair of doubles with a bound of
 * its error (Ziv's test); integers of any size. */
#include "import/pbrt/decimal.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "math/elementary.h"

/* ---- doubles and pairs of them ----------------------------------------------------------- */

/* The rounding error of a * b (Dekker 1971). */
static double product_error(double a, double b, double product) {
  const double split = 134217729.0; /* 2^27 + 1 */
  double ta = split * a, tb = split * b, ah = ta - (ta - a), al = a - ah, bh = tb - (tb - b),
         bl = b - bh;
  return ((ah * bh - product) + ah * bl + al * bh) + al * bl;
}

/* Computes digits * 10^exponent with a pair of doubles. Returns false when the result is not
 * certain, that is, another double may be nearer. */
static bool by_pair(uint64_t mantissa, int exponent, double *value) {
  int size = exponent < 0 ? -exponent : exponent;
  if (size > 2 * VL_EXACT_POWER || mantissa >= UINT64_C(1) << 62)
    return false;
  double high = (double)mantissa, low = (double)((int64_t)mantissa - (int64_t)high);
  /* power + rest is exact */
  double power = vl_powers_of_ten[size > VL_EXACT_POWER ? VL_EXACT_POWER : size], rest = 0;
  if (size > VL_EXACT_POWER) {
    double a = power, b = vl_powers_of_ten[size - VL_EXACT_POWER];
    power = a * b;
    rest = product_error(a, b, power);
  }
  double v, left; /* the value is v + left, with a relative error of about 2^-102 */
  if (exponent < 0) {
    v = high / power;
    double back = v * power;
    left = (((high - back) - product_error(v, power, back)) + low - v * rest) / power;
  } else {
    v = high * power;
    left = product_error(high, power, v) + (high * rest + low * power);
  }
  double error = v * 0x1p-96;
  *value = v + left;
  return v + (left - error) == v + (left + error);
}

/* ---- whole numbers ----------------------------------------------------------------------- */

/* 767 digits decide on which side of the midpoint between two doubles a number lies. Of the
 * digits beyond MAX_DIGITS only one fact matters: whether any of them is not 0. */
enum { MAX_DIGITS = 800, LIMBS = 176 };

/* A non-negative integer in limbs of 32 bits, the lowest limb first; the highest limb is not 0.
 * 800 digits take 84 limbs, 5^1200 takes 88. */
typedef struct Whole {
  int count;
  uint32_t limb[LIMBS];
} Whole;

static void multiply_add(Whole *w, uint32_t factor, uint32_t more) {
  uint64_t carry = more;
  for (int i = 0; i < w->count; i++) {
    carry += (uint64_t)w->limb[i] * factor;
    w->limb[i] = (uint32_t)carry;
    carry >>= 32;
  }
  if (carry)
    w->limb[w->count++] = (uint32_t)carry;
}

static void multiply_power_of_five(Whole *w, int exponent) {
  for (; exponent >= 13; exponent -= 13)
    multiply_add(w, 1220703125u, 0);
  for (; exponent > 0; exponent--)
    multiply_add(w, 5, 0);
}

static int bit_length(const Whole *w) {
  if (w->count == 0)
    return 0;
  int bits = 32 * (w->count - 1);
  for (uint32_t top = w->limb[w->count - 1]; top; top >>= 1)
    bits++;
  return bits;
}

static void shift_left(Whole *w, int bits) {
  int limbs = bits / 32;
  memmove(w->limb + limbs, w->limb, (size_t)w->count * sizeof *w->limb);
  memset(w->limb, 0, (size_t)limbs * sizeof *w->limb);
  w->count += limbs;
  multiply_add(w, UINT32_C(1) << bits % 32, 0);
}

/* Subtracts b from a if a >= b. Otherwise returns false and leaves a unchanged. */
static bool subtract(Whole *a, const Whole *b) {
  if (a->count < b->count)
    return false;
  for (int i = a->count - 1; a->count == b->count && i >= 0; i--) {
    if (a->limb[i] > b->limb[i])
      break;
    if (a->limb[i] < b->limb[i])
      return false;
  }
  uint64_t borrow = 0;
  for (int i = 0; i < a->count; i++) {
    uint64_t take = (i < b->count ? b->limb[i] : 0) + borrow;
    borrow = a->limb[i] < take;
    a->limb[i] = (uint32_t)(a->limb[i] - take);
  }
  while (a->count && a->limb[a->count - 1] == 0)
    a->count--;
  return true;
}

/* q * 2^exponent, rounded. q has 55 or 56 bits; its lowest bit is also set if a lower bit would
 * be (sticky bit). */
static double round_to_double(uint64_t q, int exponent) {
  int bits = q >> 55 ? 56 : 55, drop = -1074 - exponent; /* doubles are multiples of 2^-1074 */
  if (drop > bits - 53) {
    if (drop > bits)
      return 0.0;
    uint64_t kept = q >> drop, rest = q & ((UINT64_C(1) << drop) - 1),
             half = UINT64_C(1) << (drop - 1);
    kept += rest > half || (rest == half && (kept & 1));
    return ldexp((double)kept, -1074);
  }
  return ldexp((double)q, exponent); /* the conversion rounds to 53 bits */
}

/* digits * 10^exponent */
static double by_whole_numbers(Whole *digits, int exponent) {
  Whole divisor = {1, {1}};
  multiply_power_of_five(exponent < 0 ? &divisor : digits, exponent < 0 ? -exponent : exponent);
  int shift = bit_length(&divisor) - bit_length(digits);
  shift_left(shift < 0 ? &divisor : digits, shift < 0 ? -shift : shift);
  uint64_t q = 0;
  for (int i = 0; i < 56; i++) { /* the ratio lies between 1/2 and 2 */
    q = 2 * q + subtract(digits, &divisor);
    shift_left(digits, 1);
  }
  return round_to_double(q | (digits->count > 0), exponent - shift - 55);
}

/* mantissa * 10^exponent; HUGE_VAL if that is too large for a double. */
static double nearest(uint64_t mantissa, int exponent) {
  double v;
  if (mantissa == 0 || exponent < -400)
    return 0.0;
  if (exponent > 400)
    return HUGE_VAL;
  if (mantissa <= UINT64_C(1) << 53 && exponent >= -VL_EXACT_POWER &&
      exponent <= VL_EXACT_POWER) {
    v = (double)mantissa;
    return exponent < 0 ? v / vl_powers_of_ten[-exponent] : v * vl_powers_of_ten[exponent];
  }
  if (by_pair(mantissa, exponent, &v))
    return v;
  Whole digits = {mantissa >> 32 ? 2 : 1, {(uint32_t)mantissa, (uint32_t)(mantissa >> 32)}};
  return by_whole_numbers(&digits, exponent);
}

/* Like nearest for any number of digits. The mantissa is the text from `text` to `end`, which
 * holds decimal digits and at most one decimal point. */
static double nearest_of_digits(const char *text, const char *end, int exponent) {
  Whole digits = {0, {0}};
  int count = 0;
  bool fraction = false, more = false;
  for (; text < end; text++) {
    if (*text == '.') {
      fraction = true;
      continue;
    }
    if (count < MAX_DIGITS) {
      multiply_add(&digits, 10, (uint32_t)(*text - '0'));
      count += digits.count > 0;
      exponent -= fraction && exponent > -1000000;
    } else {
      more = more || *text != '0';
      exponent += !fraction && exponent < 1000000;
    }
  }
  if (more) {
    multiply_add(&digits, 10, 1);
    count++;
    exponent--;
  }
  if (count == 0 || count + exponent < -400)
    return 0.0;
  if (count + exponent > 400)
    return HUGE_VAL;
  return by_whole_numbers(&digits, exponent);
}

/* ---- numbers in text --------------------------------------------------------------------- */

static bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

static bool scan_hex(const char **text, const char *p, const char *end, bool negative,
                     double *value) {
  double v = 0;
  const char *start = p;
  for (; p < end; p++) {
    int d = is_digit(*p)             ? *p - '0'
            : *p >= 'a' && *p <= 'f' ? *p - 'a' + 10
            : *p >= 'A' && *p <= 'F' ? *p - 'A' + 10
                                     : -1;
    if (d < 0)
      break;
    v = v * 16 + d;
  }
  *text = p;
  *value = negative ? -v : v;
  return p > start && isfinite(v);
}

/* Digits that were read: mantissa 10^exponent, if it is exact. */
typedef struct Digits {
  uint64_t mantissa;
  int count, exponent; /* count: without leading zeros, at most 18 */
  bool exact;
} Digits;

/* Reads digits before the decimal point, or of the fraction after it. Returns their end. */
static inline const char *scan_digits(const char *p, const char *end, bool fraction,
                                      Digits *d) {
  for (; p < end && is_digit(*p); p++) {
    if (d->count < 18) {
      d->mantissa = d->mantissa * 10 + (uint64_t)(*p - '0');
      d->count += d->mantissa != 0;
      d->exponent -= fraction && d->exponent > -100000;
    } else {
      d->exact = d->exact && *p == '0';
      d->exponent += !fraction && d->exponent < 100000;
    }
  }
  return p;
}

bool vl_number_scan(const char **text, const char *end, double *value) {
  const char *start = *text, *p = start;
  bool negative = p < end && *p == '-';
  if (p < end && (*p == '-' || *p == '+'))
    p++;
  if (end - p > 2 && p[0] == '0' && (p[1] == 'x' || p[1] == 'X'))
    return scan_hex(text, p + 2, end, negative, value);
  const char *digits_start = p;
  Digits digits = {.exact = true};
  int written = 0; /* the exponent */
  p = scan_digits(p, end, false, &digits);
  const char *point = p;
  if (p < end && *p == '.')
    p = scan_digits(p + 1, end, true, &digits);
  if (point == digits_start && p - point < 2) /* nothing, or the point only */
    return false;
  const char *digits_end = p;
  if (p < end && (*p == 'e' || *p == 'E')) {
    const char *q = p + 1;
    bool minus = q < end && *q == '-';
    if (q < end && (*q == '-' || *q == '+'))
      q++;
    if (q < end && is_digit(*q)) {
      int e = 0;
      for (; q < end && is_digit(*q); q++)
        if (e < 100000)
          e = e * 10 + (*q - '0');
      written = minus ? -e : e;
      p = q;
    }
  }
  *text = p;
  double v = digits.exact ? nearest(digits.mantissa, digits.exponent + written)
                          : nearest_of_digits(digits_start, digits_end, written);
  *value = negative ? -v : v;
  return isfinite(v);
}

bool vl_number_parse(const char *text, size_t length, double *value) {
  const char *p = text;
  return length > 0 && vl_number_scan(&p, text + length, value) && p == text + length;
}
