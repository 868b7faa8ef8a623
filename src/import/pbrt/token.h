/* import/pbrt/token.h: splits text of the pbrt language into tokens. The text is modified:
 * strings are unescaped and terminated in place. The functions are in parser.c. */
#ifndef IMPORT_PBRT_TOKEN_H
#define IMPORT_PBRT_TOKEN_H

#include "velo/base.h"

typedef enum vlTokenKind {
  VL_TOKEN_END,
  VL_TOKEN_WORD, /* directive, number, true, false */
  VL_TOKEN_STRING,
  VL_TOKEN_OPEN, /* [ */
  VL_TOKEN_CLOSE,
  VL_TOKEN_BAD /* invalid; message gives the reason */
} vlTokenKind;

typedef struct vlToken {
  vlTokenKind kind;
  uint32_t line, column; /* counted from 1; columns count bytes */
  const char *text;      /* words are not zero-terminated; strings are, and have no quotes */
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
/* Whether the token is this word. */
bool vl_token_is(const vlToken *token, const char *word);
/* The first character of the next token, which is not taken; 0: there is none. */
char vl_token_peek(const vlTokenizer *tokenizer);
/* Takes the next token if it is a number; otherwise changes nothing. This is the fast path for
 * long lists. */
bool vl_token_number(vlTokenizer *tokenizer, double *value);

#endif
