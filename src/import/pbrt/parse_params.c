/* import/pbrt/parse_params.c: tokens, errors and the parameters of a directive. */

#include "base/context.h"
#include "base/text.h"
#include "import/pbrt/parser.h"

/* ---- errors ------------------------------------------------------------------------------ */

vlSource vl_parse_source(const vlParserFile *file, const vlToken *token) {
  return (vlSource){file->path, token->line, token->column};
}

bool vl_parse_fail_bad(vlParserFile *file, const vlToken *token) {
  return vl_parse_fail(file, vl_parse_source(file, token), "%s", token->message);
}

bool vl_parse_fail(const vlParserFile *file, vlSource source, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  const vlParseTarget *target = file->parser->target;
  target->error(target->user, VL_ERROR_SCENE, source, text);
  return false;
}

bool vl_parse_fail_memory(const vlParserFile *file) {
  const vlParseTarget *target = file->parser->target;
  target->error(target->user, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
  return false;
}

vlShownToken vl_parse_show(const vlToken *token) {
  vlShownToken s;
  if (token->kind == VL_TOKEN_END)
    snprintf(s.text, sizeof s.text, "the end of the file");
  else
    snprintf(s.text, sizeof s.text, "\"%s\"",
             vl_short_text_of(token->text, token->length).text);
  return s;
}

/* ---- tokens ------------------------------------------------------------------------------ */

vlToken vl_parse_peek(vlParserFile *file) {
  if (!file->has_token) {
    file->token = vl_token_next(&file->tokens);
    file->has_token = true;
  }
  return file->token;
}

vlToken vl_parse_take(vlParserFile *file) {
  vlToken token = vl_parse_peek(file);
  if (token.kind != VL_TOKEN_END)
    file->has_token = false;
  return token;
}

bool vl_parse_is_word(const vlToken *token, const char *word) {
  return token->kind == VL_TOKEN_WORD && token->length == strlen(word) &&
         memcmp(token->text, word, token->length) == 0;
}

/* ---- parameters -------------------------------------------------------------------------- */

static bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/* Splits "type name". */
static bool declare(vlParserFile *file, const vlToken *token, vlParam *param) {
  const char *p = token->text, *end = p + token->length;
  while (p < end && is_blank(*p))
    p++;
  const char *type = p;
  while (p < end && !is_blank(*p))
    p++;
  size_t type_length = (size_t)(p - type);
  while (p < end && is_blank(*p))
    p++;
  const char *name = p;
  while (p < end && !is_blank(*p))
    p++;
  size_t name_length = (size_t)(p - name);
  while (p < end && is_blank(*p))
    p++;
  if (type_length == 0 || name_length == 0 || p != end)
    return vl_parse_fail(file, param->source, "parameter %s is not of the form \"type name\"",
                         vl_parse_show(token).text);
  if (!vl_param_type_find(type, type_length, &param->type)) {
    const vlShortText text = vl_short_text_of(type, type_length);
    const char *near = vl_param_type_nearest(text.text);
    if (near)
      return vl_parse_fail(file, param->source,
                           "unknown parameter type \"%s\" (did you mean \"%s\"?)", text.text,
                           near);
    return vl_parse_fail(file, param->source, "unknown parameter type \"%s\"", text.text);
  }
  param->name = vl_alloc(file->parser->context, name_length + 1);
  if (!param->name)
    return vl_parse_fail_memory(file);
  memcpy(param->name, name, name_length);
  param->name[name_length] = 0;
  return true;
}

static bool takes_numbers(vlParamType type) {
  return type != VL_PARAM_BOOL && type != VL_PARAM_STRING && type != VL_PARAM_TEXTURE;
}

static bool add_number(vlParserFile *file, const vlToken *token, vlParam *param) {
  vlContext *context = file->parser->context;
  double value;
  if (!vl_number_parse(token->text, token->length, &value))
    return vl_parse_fail(file, vl_parse_source(file, token),
                         "\"%s %s\": expected a number, found %s",
                         vl_param_type_name(param->type), vl_short_text(param->name).text,
                         vl_parse_show(token).text);
  if (param->type == VL_PARAM_INTEGER) {
    if (value < -2147483648.0 || value > 2147483647.0 || value != (double)(int64_t)value)
      return vl_parse_fail(file, vl_parse_source(file, token),
                           "\"integer %s\": %s is not a 32-bit integer", param->name,
                           vl_parse_show(token).text);
    int32_t *slot = VL_PUSH(context, &param->integers);
    if (!slot)
      return vl_parse_fail_memory(file);
    *slot = (int32_t)value;
    return true;
  }
  size_t n = param->floats.count;
  if (n < 16)
    param->exact[n] = value;
  float *slot = VL_PUSH(context, &param->floats);
  if (!slot)
    return vl_parse_fail_memory(file);
  *slot = (float)value;
  return true;
}

static bool add_value(vlParserFile *file, const vlToken *token, vlParam *param) {
  vlContext *context = file->parser->context;
  const char *type = vl_param_type_name(param->type);
  bool is_true = vl_parse_is_word(token, "true"), is_false = vl_parse_is_word(token, "false");
  /* Files written for older versions put booleans in quotes. */
  if (param->type == VL_PARAM_BOOL && token->kind == VL_TOKEN_STRING) {
    is_true = vl_text_is(token->text, "true");
    is_false = vl_text_is(token->text, "false");
  }
  if (param->type == VL_PARAM_BOOL) {
    if (!is_true && !is_false)
      return vl_parse_fail(file, vl_parse_source(file, token),
                           "\"%s %s\": expected true or false, found %s", type,
                           vl_short_text(param->name).text, vl_parse_show(token).text);
    uint8_t *slot = VL_PUSH(context, &param->bools);
    if (!slot)
      return vl_parse_fail_memory(file);
    *slot = is_true;
    return true;
  }
  if (token->kind == VL_TOKEN_STRING) {
    if (takes_numbers(param->type) && param->type != VL_PARAM_SPECTRUM)
      return vl_parse_fail(file, vl_parse_source(file, token),
                           "\"%s %s\": expected a number, found the string %s", type,
                           vl_short_text(param->name).text, vl_parse_show(token).text);
    if (param->floats.count)
      return vl_parse_fail(file, vl_parse_source(file, token),
                           "\"%s %s\": numbers and strings do not mix", type, param->name);
    char **slot = VL_PUSH(context, &param->strings);
    if (!slot || !(*slot = vl_strdup(context, token->text)))
      return vl_parse_fail_memory(file);
    return true;
  }
  if (!takes_numbers(param->type))
    return vl_parse_fail(file, vl_parse_source(file, token),
                         "\"%s %s\": expected a string in quotes, found %s", type,
                         vl_short_text(param->name).text, vl_parse_show(token).text);
  if (param->strings.count)
    return vl_parse_fail(file, vl_parse_source(file, token),
                         "\"%s %s\": numbers and strings do not mix", type,
                         vl_short_text(param->name).text);
  return add_number(file, token, param);
}

/* Fast path: reads successive numbers without a token for each. Anything else is left to the
 * general path. */
static bool read_run(vlParserFile *file, vlParam *param) {
  vlContext *context = file->parser->context;
  bool integers = param->type == VL_PARAM_INTEGER;
  for (size_t chunk = 4;; chunk = 1024) { /* most lists are short and there may be many */
    if (integers ? !VL_RESERVE(context, &param->integers, chunk)
                 : !VL_RESERVE(context, &param->floats, chunk))
      return vl_parse_fail_memory(file);
    for (size_t i = 0; i < chunk; i++) {
      vlTokenizer before = file->tokens;
      double value;
      if (!vl_token_number(&file->tokens, &value))
        return true;
      if (!integers) {
        size_t n = param->floats.count++;
        param->floats.items[n] = (float)value;
        if (n < 16)
          param->exact[n] = value;
      } else if (value >= -2147483648.0 && value <= 2147483647.0 &&
                 value == (double)(int32_t)value) {
        param->integers.items[param->integers.count++] = (int32_t)value;
      } else {
        file->tokens = before;
        return true;
      }
    }
  }
}

static bool read_values(vlParserFile *file, vlParam *param) {
  vlToken token = vl_parse_take(file);
  if (token.kind == VL_TOKEN_BAD)
    return vl_parse_fail_bad(file, &token);
  if (token.kind != VL_TOKEN_OPEN) {
    if (token.kind == VL_TOKEN_END || token.kind == VL_TOKEN_CLOSE)
      return vl_parse_fail(file, vl_parse_source(file, &token),
                           "\"%s %s\": expected a value, found %s",
                           vl_param_type_name(param->type), vl_short_text(param->name).text,
                           vl_parse_show(&token).text);
    return add_value(file, &token, param);
  }
  vlToken open = token;
  bool numbers = takes_numbers(param->type);
  for (;;) {
    if (numbers && param->strings.count == 0 && !read_run(file, param))
      return false;
    token = vl_parse_take(file);
    if (token.kind == VL_TOKEN_CLOSE)
      return true;
    if (token.kind == VL_TOKEN_BAD)
      return vl_parse_fail_bad(file, &token);
    if (token.kind == VL_TOKEN_OPEN)
      return vl_parse_fail(file, vl_parse_source(file, &token), "[ inside of [ ]");
    if (token.kind == VL_TOKEN_END)
      return vl_parse_fail(file, vl_parse_source(file, &open),
                           "unclosed [ in \"%s %s\": the file ends before the ]",
                           vl_param_type_name(param->type), param->name);
    if (!add_value(file, &token, param))
      return false;
  }
}

bool vl_parse_params(vlParserFile *file, vlParamList *params) {
  vlContext *context = file->parser->context;
  for (;;) {
    vlToken token = vl_parse_peek(file);
    if (token.kind == VL_TOKEN_BAD)
      return vl_parse_fail_bad(file, &token);
    if (token.kind == VL_TOKEN_END && file->included &&
        vl_parse_peek(file->parent).kind == VL_TOKEN_STRING) {
      file = file->parent;
      continue;
    }
    if (token.kind != VL_TOKEN_STRING)
      return true;
    vl_parse_take(file);
    vlParam *param = vl_alloc_zero(context, 1, sizeof *param);
    vlParam **slot = param ? VL_PUSH(context, &params->list) : NULL;
    if (!slot) {
      vl_free(context, param);
      return vl_parse_fail_memory(file);
    }
    *slot = param;
    param->source = vl_parse_source(file, &token);
    if (!declare(file, &token, param) || !read_values(file, param))
      return false;
  }
}
