/* import/pbrt/token.c: see token.h. */
#include "import/pbrt/token.h"

#include <math.h>
#include <string.h>

#include "import/pbrt/decimal.h"

void vl_tokenizer_start(vlTokenizer *t, char *data, size_t size) {
  if (size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0) {
    data += 3;
    size -= 3;
  }
  *t = (vlTokenizer){.at = data, .end = data + size, .line_start = data, .line = 1};
}

static bool is_space(char c) {
  return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static bool ends_word(char c) {
  return is_space(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

static void skip_blank(vlTokenizer *t) {
  while (t->at < t->end) {
    char c = *t->at;
    if (c == '\n') {
      t->at++;
      t->line++;
      t->line_start = t->at;
    } else if (is_space(c)) {
      t->at++;
    } else if (c == '#') {
      char *newline = memchr(t->at, '\n', (size_t)(t->end - t->at));
      t->at = newline ? newline : t->end;
    } else {
      return;
    }
  }
}

static char unescape(char c) {
  switch (c) {
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case 'n':
      return '\n';
    case 'r':
      return '\r';
    case 't':
      return '\t';
    case '\\':
    case '\'':
    case '"':
      return c;
    default:
      return 0;
  }
}

static vlToken read_string(vlTokenizer *t, vlToken token) {
  char *out = ++t->at;
  token.text = out;
  for (;;) {
    if (t->at >= t->end || *t->at == '\n') {
      token.kind = VL_TOKEN_BAD;
      token.message = t->at >= t->end ? "unclosed string: the file ends before the closing \""
                                      : "unclosed string: the line ends before the closing \"";
      return token;
    }
    char c = *t->at++;
    if (c == '"')
      break;
    if (c == 0) {
      token.kind = VL_TOKEN_BAD;
      token.message = "zero byte in a string: this is not a text file";
      return token;
    }
    if (c == '\\') {
      c = t->at < t->end ? unescape(*t->at) : 0;
      if (!c) {
        token.kind = VL_TOKEN_BAD;
        token.message = "unknown escape in a string (known: \\b \\f \\n \\r \\t \\\\ \\' \\\")";
        return token;
      }
      t->at++;
    }
    *out++ = c;
  }
  *out = 0; /* at the latest this overwrites the closing quote, which has been read */
  token.kind = VL_TOKEN_STRING;
  token.length = (size_t)(out - token.text);
  return token;
}

vlToken vl_token_next(vlTokenizer *t) {
  skip_blank(t);
  vlToken token = {.kind = VL_TOKEN_END,
                   .line = t->line,
                   .column = (uint32_t)(t->at - t->line_start) + 1,
                   .text = t->at};
  if (t->at >= t->end)
    return token;
  char c = *t->at;
  if (c == '"')
    return read_string(t, token);
  if (c == '[' || c == ']') {
    t->at++;
    token.kind = c == '[' ? VL_TOKEN_OPEN : VL_TOKEN_CLOSE;
    token.length = 1;
    return token;
  }
  while (t->at < t->end && !ends_word(*t->at))
    t->at++;
  token.kind = VL_TOKEN_WORD;
  token.length = (size_t)(t->at - token.text);
  return token;
}

/* ---- numbers ----------------------------------------------------------------------------- */

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

bool vl_number_scan(const char **text, const char *end, double *value) {
  const char *start = *text, *p = start;
  bool negative = p < end && *p == '-';
  if (p < end && (*p == '-' || *p == '+'))
    p++;
  if (end - p > 2 && p[0] == '0' && (p[1] == 'x' || p[1] == 'X'))
    return scan_hex(text, p + 2, end, negative, value);
  const char *digits_start = p;
  uint64_t mantissa = 0;
  int digits = 0, exponent = 0,
      written = 0; /* 10^exponent times the mantissa; the exponent that is written */
  bool exact = true, any = false;
  for (; p < end && is_digit(*p); p++) {
    any = true;
    if (digits < 18) {
      mantissa = mantissa * 10 + (uint64_t)(*p - '0');
      digits += mantissa != 0;
    } else {
      exact = exact && *p == '0';
      exponent += exponent < 100000;
    }
  }
  if (p < end && *p == '.') {
    for (p++; p < end && is_digit(*p); p++) {
      any = true;
      if (digits < 18) {
        mantissa = mantissa * 10 + (uint64_t)(*p - '0');
        digits += mantissa != 0;
        exponent -= exponent > -100000;
      } else {
        exact = exact && *p == '0';
      }
    }
  }
  if (!any)
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
  double v = exact ? vl_decimal(mantissa, exponent + written)
                   : vl_decimal_digits(digits_start, digits_end, written);
  *value = negative ? -v : v;
  return isfinite(v);
}

bool vl_token_number(vlTokenizer *t, double *value) {
  skip_blank(t);
  const char *p = t->at;
  if (p >= t->end || !vl_number_scan(&p, t->end, value) || (p < t->end && !ends_word(*p)))
    return false;
  t->at += p - t->at;
  return true;
}

bool vl_number_parse(const char *text, size_t length, double *value) {
  const char *p = text;
  return length > 0 && vl_number_scan(&p, text + length, value) && p == text + length;
}
