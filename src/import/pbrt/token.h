/* import/pbrt/token.h: text of the pbrt language to tokens, on a block of memory that it may write to (strings are
 * unescaped and terminated in place). Also numbers from text, independent of the locale; the PLY reader uses them too.
 */
#ifndef IMPORT_PBRT_TOKEN_H
#define IMPORT_PBRT_TOKEN_H

#include "velo/base.h"

typedef enum vlTokenKind {
  VL_TOKEN_END,
  VL_TOKEN_WORD, /* directive, number, true, false */
  VL_TOKEN_STRING,
  VL_TOKEN_OPEN, /* [ */
  VL_TOKEN_CLOSE,
  VL_TOKEN_BAD /* message says why */
} vlTokenKind;

typedef struct vlToken {
  vlTokenKind kind;
  uint32_t line, column; /* from 1; columns are bytes */
  const char *text;      /* word: not terminated; string: without quotes, terminated */
  size_t length;
  const char *message;
} vlToken;

typedef struct vlTokenizer {
  char *at, *end;
  const char *line_start;
  uint32_t line;
} vlTokenizer;

/* data[size] must be a zero byte. */
void vl_tokenizer_start(vlTokenizer *tokenizer, char *data, size_t size);
vlToken vl_token_next(vlTokenizer *tokenizer);
/* Takes the next token if it is a number; else leaves all as it is. The quick way through long lists. */
bool vl_token_number(vlTokenizer *tokenizer, double *value);

/* One number that fills [text, text + length): integers, decimals, exponents, hexadecimal. false otherwise, also for
 * infinities and what is too large for a double. */
bool vl_number_parse(const char *text, size_t length, double *value);
/* The leading number of [*text, end), moves *text past it. */
bool vl_number_scan(const char **text, const char *end, double *value);

#endif
