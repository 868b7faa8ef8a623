/* import/pbrt/upgrade/document.c: cuts pbrt text into statements that keep their offsets in the
 * text. */
#include <string.h>

#include "base/text.h"
#include "import/pbrt/decimal.h"
#include "import/pbrt/token.h"
#include "import/pbrt/upgrade/upgrade.h"

static size_t offset(const vlOldFile *file, const char *at) {
  return (size_t)(at - file->words);
}

/* The token's span, with its quotes. */
static vlOldSpan span_of(const vlOldFile *file, const vlTokenizer *tokens,
                         const vlToken *token) {
  size_t start = offset(file, token->text) - (token->kind == VL_TOKEN_STRING);
  return (vlOldSpan){start, offset(file, tokens->at)};
}

static bool bad_token(vlOldFile *file, const vlToken *token, const char *wanted) {
  if (token->kind == VL_TOKEN_BAD)
    return vl_old_fail(file, VL_ERROR_SCENE, token->line, token->column, "%s", token->message);
  return vl_old_fail(
      file, VL_ERROR_SCENE, token->line, token->column, "expected %s, found %s", wanted,
      token->kind == VL_TOKEN_END ? "the end of the file"
                                  : vl_short_text_of(token->text, token->length).text);
}

static bool add_value(vlOldFile *file, const vlTokenizer *tokens, const vlToken *token,
                      vlOldParam *p) {
  size_t i = p->count++;
  if (token->kind == VL_TOKEN_STRING)
    p->strings = true;
  if (i >= VL_OLD_FIRST)
    return true;
  p->span[i] = span_of(file, tokens, token);
  p->text[i] = token->kind == VL_TOKEN_STRING ? token->text : NULL;
  if (token->kind == VL_TOKEN_WORD)
    vl_number_parse(token->text, token->length, &p->number[i]);
  return true;
}

static bool read_values(vlOldFile *file, vlTokenizer *tokens, vlOldParam *p) {
  vlToken token = vl_token_next(tokens);
  if (token.kind == VL_TOKEN_STRING || token.kind == VL_TOKEN_WORD) {
    p->value = span_of(file, tokens, &token);
    return add_value(file, tokens, &token, p);
  }
  if (token.kind != VL_TOKEN_OPEN)
    return bad_token(file, &token, "a value");
  p->value.start = offset(file, token.text);
  for (;;) {
    token = vl_token_next(tokens);
    if (token.kind == VL_TOKEN_CLOSE)
      break;
    if (token.kind != VL_TOKEN_STRING && token.kind != VL_TOKEN_WORD)
      return bad_token(file, &token, "a value or ]");
    add_value(file, tokens, &token, p);
  }
  p->value.end = offset(file, tokens->at);
  return true;
}

static bool read_param(vlOldFile *file, vlTokenizer *tokens, vlOldStatement *s) {
  vlOldParam *p = VL_PUSH(file->u->context, &s->params);
  vlToken token = vl_token_next(tokens);
  if (!p)
    return vl_old_fail_memory(file->u);
  memset(p, 0, sizeof *p);
  if (token.kind != VL_TOKEN_STRING)
    return bad_token(file, &token, "a parameter");
  p->decl = span_of(file, tokens, &token);
  char *text = file->words + offset(file, token.text); /* type and name */
  text += strspn(text, " \t");
  size_t type = strcspn(text, " \t");
  char *name = text + type + strspn(text + type, " \t");
  if (!type || !*name)
    return vl_old_fail(file, VL_ERROR_SCENE, token.line, token.column,
                       "parameter \"%s\" is not of the form \"type name\"",
                       vl_short_text(text).text);
  name[strcspn(name, " \t")] = 0;
  text[type] = 0;
  p->type = p->new_type = text;
  p->name = p->new_name = name;
  return read_values(file, tokens, p);
}

static bool read_names(vlOldFile *file, vlTokenizer *tokens, vlOldStatement *s) {
  while (s->name_count < s->word->strings && vl_token_peek(tokens) == '"') {
    vlToken token = vl_token_next(tokens);
    if (token.kind != VL_TOKEN_STRING)
      return bad_token(file, &token, "a name in quotes");
    s->names[s->name_count] = span_of(file, tokens, &token);
    s->name[s->name_count++] = token.text;
  }
  bool optional = s->word->form == VL_OLD_PLAIN && s->name_count + 1 == s->word->strings &&
                  s->name_count > 0;
  if (s->name_count == s->word->strings || optional)
    return true;
  vlToken token = vl_token_next(tokens);
  return bad_token(file, &token, "a name in quotes");
}

static bool read_numbers(vlOldFile *file, vlTokenizer *tokens, vlOldStatement *s) {
  for (;;) {
    const char next = vl_token_peek(tokens);
    double value;
    if (next == '[' || next == ']') {
      vlToken token = vl_token_next(tokens);
      s->numbers[token.kind == VL_TOKEN_CLOSE] = span_of(file, tokens, &token);
    } else {
      vlTokenizer before = *tokens;
      if (vl_token_number(tokens, &value))
        continue;
      *tokens = before; /* without the blanks that follow */
      return true;
    }
  }
}

static const vlOldWord *find_word(const vlToken *token) {
  for (const vlOldWord *w = vl_old_words; w->names; w++)
    if (vl_has_word_of(w->names, token->text, token->length))
      return w;
  return NULL;
}

bool vl_old_read(vlOldFile *file, vlTokenizer *tokens, vlOldStatement *s, bool *end) {
  vlToken token = vl_token_next(tokens);
  *s = (vlOldStatement){.u = file->u, .file = file, .line = token.line, .column = token.column};
  *end = token.kind == VL_TOKEN_END;
  if (*end)
    return true;
  if (token.kind != VL_TOKEN_WORD)
    return bad_token(file, &token, "a directive");
  s->keyword = span_of(file, tokens, &token);
  s->word = find_word(&token);
  if (!s->word)
    return vl_old_fail(file, VL_ERROR_SCENE, token.line, token.column,
                       "unknown directive \"%s\"",
                       vl_short_text_of(token.text, token.length).text);
  snprintf(s->directive, sizeof s->directive, "%.*s", (int)token.length, token.text);
  bool fine = read_names(file, tokens, s);
  switch (s->word->form) {
    case VL_OLD_PLAIN:
      break;
    case VL_OLD_WORD:
      vl_token_next(tokens);
      break;
    case VL_OLD_NUMBERS:
    case VL_OLD_MATRIX:
      fine = fine && read_numbers(file, tokens, s);
      break;
    case VL_OLD_PARAMS:
      while (fine && vl_token_peek(tokens) == '"')
        fine = read_param(file, tokens, s);
      break;
  }
  s->whole = (vlOldSpan){s->keyword.start, offset(file, tokens->at)};
  return fine;
}

void vl_old_free(vlOldStatement *s) {
  VL_ARRAY_FREE(s->u->context, &s->params);
}
