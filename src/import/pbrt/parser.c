/* import/pbrt/parser.c: splits text into tokens (token.h); reads directives and their
 * parameters (parse.h). */
#include "import/pbrt/parser.h"

#include "base/context.h"
#include "base/text.h"
#include "import/names.h"
#include "import/pbrt/decimal.h"

/* ---- tokens ------------------------------------------------------------------------------ */

void vl_tokenizer_start(vlTokenizer *t, char *data, size_t size) {
  if (size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0) {
    data += 3;
    size -= 3;
  }
  *t = (vlTokenizer){.at = data, .end = data + size, .line_start = data, .line = 1};
}

static bool ends_word(char c) {
  return vl_is_blank(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

static inline void skip_blank(vlTokenizer *t) {
  while (t->at < t->end) {
    char c = *t->at;
    if (c == '\n') {
      t->at++;
      t->line++;
      t->line_start = t->at;
    } else if (vl_is_blank(c)) {
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

static vlToken bad_string(vlToken token, const char *message) {
  token.kind = VL_TOKEN_BAD;
  token.message = message;
  return token;
}

static vlToken read_string(vlTokenizer *t, vlToken token) {
  char *out = ++t->at;
  token.text = out;
  for (;;) {
    if (t->at >= t->end)
      return bad_string(token, "unclosed string: the file ends before the closing \"");
    if (*t->at == '\n')
      return bad_string(token, "unclosed string: the line ends before the closing \"");
    char c = *t->at++;
    if (c == '"')
      break;
    if (c == 0)
      return bad_string(token, "zero byte in a string: this is not a text file");
    if (c == '\\') {
      c = t->at < t->end ? unescape(*t->at) : 0;
      if (!c)
        return bad_string(
            token, "unknown escape in a string (known: \\b \\f \\n \\r \\t \\\\ \\' \\\")");
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

char vl_token_peek(const vlTokenizer *t) {
  vlTokenizer copy = *t;
  skip_blank(&copy);
  return copy.at < copy.end ? *copy.at : 0;
}

bool vl_token_is(const vlToken *token, const char *word) {
  return token->kind == VL_TOKEN_WORD && token->length == strlen(word) &&
         memcmp(token->text, word, token->length) == 0;
}

bool vl_token_number(vlTokenizer *t, double *value) {
  skip_blank(t);
  const char *p = t->at;
  if (p >= t->end || !vl_number_scan(&p, t->end, value) || (p < t->end && !ends_word(*p)))
    return false;
  t->at += p - t->at;
  return true;
}

/* ---- errors ------------------------------------------------------------------------------ */

vlSource vl_parse_source(const vlParserFile *file, const vlToken *token) {
  return (vlSource){file->path, token->line, token->column};
}

/* Reports an error at a token. Returns false. */
static bool fail_at(const vlParserFile *file, const vlToken *token, const char *format, ...)
    VL_PRINTF(3, 4);
static bool fail_at(const vlParserFile *file, const vlToken *token, const char *format, ...) {
  char text[512];
  VL_FORMAT(text, format);
  return vl_parse_fail(file, vl_parse_source(file, token), "%s", text);
}

/* Reports a token of kind VL_TOKEN_BAD. Returns false. */
static bool fail_bad(const vlParserFile *file, const vlToken *token) {
  return fail_at(file, token, "%s", token->message);
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

/* Text of a token for messages: short, printable, in quotes. */
typedef struct ShownToken {
  char text[sizeof(vlShortText) + 2];
} ShownToken;

static ShownToken shown(const vlToken *token) {
  ShownToken s;
  if (token->kind == VL_TOKEN_END)
    snprintf(s.text, sizeof s.text, "the end of the file");
  else
    snprintf(s.text, sizeof s.text, "\"%s\"",
             vl_short_text_of(token->text, token->length).text);
  return s;
}

/* ---- the next token ---------------------------------------------------------------------- */

static vlToken peek_token(vlParserFile *file) {
  if (!file->has_token) {
    file->token = vl_token_next(&file->tokens);
    file->has_token = true;
  }
  return file->token;
}

/* Does not move past the end of the file. */
static vlToken take_token(vlParserFile *file) {
  vlToken token = peek_token(file);
  if (token.kind != VL_TOKEN_END)
    file->has_token = false;
  return token;
}

/* ---- parameters -------------------------------------------------------------------------- */

/* Splits "type name". */
static bool declare(vlParserFile *file, const vlToken *token, vlParam *param) {
  const char *end = token->text + token->length;
  const char *type = token->text + strspn(token->text, " \t");
  const size_t type_length = strcspn(type, " \t");
  const char *name = type + type_length + strspn(type + type_length, " \t");
  const size_t name_length = strcspn(name, " \t");
  const char *p = name + name_length + strspn(name + name_length, " \t");
  if (type_length == 0 || name_length == 0 || p != end)
    return vl_parse_fail(file, param->source, "parameter %s is not of the form \"type name\"",
                         shown(token).text);
  if (!vl_param_type_find(type, type_length, &param->type)) {
    const vlShortText text = vl_short_text_of(type, type_length);
    return vl_parse_fail(file, param->source, "unknown parameter type \"%s\"%s", text.text,
                         vl_hint(vl_param_type_nearest(text.text)).text);
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

/* Reports a value of the parameter. what: "expected a number, found". */
static bool fail_value(const vlParserFile *file, const vlToken *token, const vlParam *param,
                       const char *what) {
  return fail_at(file, token, "\"%s %s\": %s %s", vl_param_type_name(param->type),
                 vl_short_text(param->name).text, what, shown(token).text);
}

static bool add_integer(vlParserFile *file, vlParam *param, int32_t value) {
  int32_t *slot = VL_PUSH(file->parser->context, &param->integers);
  if (!slot)
    return vl_parse_fail_memory(file);
  *slot = value;
  return true;
}

static bool add_number(vlParserFile *file, const vlToken *token, vlParam *param) {
  double value;
  if (!vl_number_parse(token->text, token->length, &value))
    return fail_value(file, token, param, "expected a number, found");
  if (param->type == VL_PARAM_INTEGER) {
    if (value < -2147483648.0 || value > 2147483647.0 || value != (double)(int64_t)value)
      return fail_at(file, token, "\"integer %s\": %s is not a 32-bit integer", param->name,
                     shown(token).text);
    return add_integer(file, param, (int32_t)value);
  }
  size_t n = param->floats.count;
  if (n < VL_PARAM_EXACT)
    param->exact[n] = value;
  float *slot = VL_PUSH(file->parser->context, &param->floats);
  if (!slot)
    return vl_parse_fail_memory(file);
  *slot = (float)value;
  return true;
}

/* Files written for older versions put booleans in quotes. */
static bool add_bool(vlParserFile *file, const vlToken *token, vlParam *param) {
  const bool quoted = token->kind == VL_TOKEN_STRING;
  if (quoted ? vl_text_is(token->text, "true") : vl_token_is(token, "true"))
    return add_integer(file, param, 1);
  if (quoted ? vl_text_is(token->text, "false") : vl_token_is(token, "false"))
    return add_integer(file, param, 0);
  return fail_value(file, token, param, "expected true or false, found");
}

static bool fail_mixed(const vlParserFile *file, const vlToken *token, const vlParam *param) {
  return fail_at(file, token, "\"%s %s\": numbers and strings do not mix",
                 vl_param_type_name(param->type), vl_short_text(param->name).text);
}

static bool add_value(vlParserFile *file, const vlToken *token, vlParam *param) {
  const bool numbers = takes_numbers(param->type);
  if (param->type == VL_PARAM_BOOL)
    return add_bool(file, token, param);
  if (token->kind != VL_TOKEN_STRING) {
    if (!numbers)
      return fail_value(file, token, param, "expected a string in quotes, found");
    return param->strings.count ? fail_mixed(file, token, param)
                                : add_number(file, token, param);
  }
  if (numbers && param->type != VL_PARAM_SPECTRUM)
    return fail_value(file, token, param, "expected a number, found the string");
  if (param->floats.count)
    return fail_mixed(file, token, param);
  char **slot = VL_PUSH(file->parser->context, &param->strings);
  return (slot && (*slot = vl_strdup(file->parser->context, token->text))) ||
         vl_parse_fail_memory(file);
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
        if (n < VL_PARAM_EXACT)
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
  vlToken token = take_token(file);
  if (token.kind == VL_TOKEN_BAD)
    return fail_bad(file, &token);
  if (token.kind != VL_TOKEN_OPEN) {
    if (token.kind == VL_TOKEN_END || token.kind == VL_TOKEN_CLOSE)
      return fail_value(file, &token, param, "expected a value, found");
    return add_value(file, &token, param);
  }
  vlToken open = token;
  bool numbers = takes_numbers(param->type);
  for (;;) {
    if (numbers && param->strings.count == 0 && !read_run(file, param))
      return false;
    token = take_token(file);
    if (token.kind == VL_TOKEN_CLOSE)
      return true;
    if (token.kind == VL_TOKEN_BAD)
      return fail_bad(file, &token);
    if (token.kind == VL_TOKEN_OPEN)
      return fail_at(file, &token, "[ inside of [ ]");
    if (token.kind == VL_TOKEN_END)
      return fail_at(file, &open, "unclosed [ in \"%s %s\": the file ends before the ]",
                     vl_param_type_name(param->type), param->name);
    if (!add_value(file, &token, param))
      return false;
  }
}

/* Reads all parameters that follow a directive. At the end of an included file the list
 * continues after its Include. */
static bool read_params(vlParserFile *file, vlParamList *params) {
  vlContext *context = file->parser->context;
  for (;;) {
    vlToken token = peek_token(file);
    if (token.kind == VL_TOKEN_BAD)
      return fail_bad(file, &token);
    if (token.kind == VL_TOKEN_END && file->included &&
        peek_token(file->parent).kind == VL_TOKEN_STRING) {
      file = file->parent;
      continue;
    }
    if (token.kind != VL_TOKEN_STRING)
      return true;
    take_token(file);
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

static bool take_string(vlParserFile *file, const char *directive, const char *what,
                        const char **text) {
  vlToken token = take_token(file);
  if (token.kind == VL_TOKEN_STRING) {
    *text = token.text;
    return true;
  }
  if (token.kind == VL_TOKEN_BAD)
    return fail_bad(file, &token);
  return fail_at(file, &token, "%s: expected %s in quotes, found %s", directive, what,
                 shown(&token).text);
}

static bool take_number(vlParserFile *file, const char *directive, double *value) {
  vlToken token = take_token(file);
  if (token.kind == VL_TOKEN_WORD && vl_number_parse(token.text, token.length, value))
    return true;
  if (token.kind == VL_TOKEN_BAD)
    return fail_bad(file, &token);
  return fail_at(file, &token, "%s: expected a number, found %s", directive,
                 shown(&token).text);
}

/* ---- directives -------------------------------------------------------------------------- */

typedef enum Form {
  ALONE,
  NUMBERS,
  MATRIX,
  ONE_NAME,
  MEDIA,
  OPTION,
  PARAMS,
  TEXTURE,
  ACTIVE,
  INCLUDE,
  IMPORT
} Form;
typedef struct Keyword {
  const char *name;
  Form form;
  vlDirective directive;
  uint32_t count; /* numbers */
} Keyword;

static const Keyword keywords[] = {
    {"AttributeBegin", ALONE, VL_DIR_ATTRIBUTE_BEGIN, 0},
    {"AttributeEnd", ALONE, VL_DIR_ATTRIBUTE_END, 0},
    {"TransformBegin", ALONE, VL_DIR_TRANSFORM_BEGIN, 0},
    {"TransformEnd", ALONE, VL_DIR_TRANSFORM_END, 0},
    {"Identity", ALONE, VL_DIR_IDENTITY, 0},
    {"ReverseOrientation", ALONE, VL_DIR_REVERSE_ORIENTATION, 0},
    {"WorldBegin", ALONE, VL_DIR_WORLD_BEGIN, 0},
    {"ObjectEnd", ALONE, VL_DIR_OBJECT_END, 0},
    {"ActiveTransform", ACTIVE, VL_DIR_ACTIVE_ALL, 0},
    {"Include", INCLUDE, VL_DIR_IMPORT_BEGIN, 0},
    {"Import", IMPORT, VL_DIR_IMPORT_BEGIN, 0},
    {"Translate", NUMBERS, VL_DIR_TRANSLATE, 3},
    {"Scale", NUMBERS, VL_DIR_SCALE, 3},
    {"Rotate", NUMBERS, VL_DIR_ROTATE, 4},
    {"LookAt", NUMBERS, VL_DIR_LOOK_AT, 9},
    {"TransformTimes", NUMBERS, VL_DIR_TRANSFORM_TIMES, 2},
    {"Transform", MATRIX, VL_DIR_TRANSFORM, 16},
    {"ConcatTransform", MATRIX, VL_DIR_CONCAT_TRANSFORM, 16},
    {"CoordinateSystem", ONE_NAME, VL_DIR_COORDINATE_SYSTEM, 0},
    {"CoordSysTransform", ONE_NAME, VL_DIR_COORD_SYS_TRANSFORM, 0},
    {"ColorSpace", ONE_NAME, VL_DIR_COLOR_SPACE, 0},
    {"NamedMaterial", ONE_NAME, VL_DIR_NAMED_MATERIAL, 0},
    {"ObjectBegin", ONE_NAME, VL_DIR_OBJECT_BEGIN, 0},
    {"ObjectInstance", ONE_NAME, VL_DIR_OBJECT_INSTANCE, 0},
    {"MediumInterface", MEDIA, VL_DIR_MEDIUM_INTERFACE, 0},
    {"Option", OPTION, VL_DIR_OPTION, 0},
    {"Attribute", PARAMS, VL_DIR_ATTRIBUTE, 0},
    {"Film", PARAMS, VL_DIR_FILM, 0},
    {"Sampler", PARAMS, VL_DIR_SAMPLER, 0},
    {"Integrator", PARAMS, VL_DIR_INTEGRATOR, 0},
    {"PixelFilter", PARAMS, VL_DIR_PIXEL_FILTER, 0},
    {"Accelerator", PARAMS, VL_DIR_ACCELERATOR, 0},
    {"Camera", PARAMS, VL_DIR_CAMERA, 0},
    {"MakeNamedMedium", PARAMS, VL_DIR_MAKE_NAMED_MEDIUM, 0},
    {"Material", PARAMS, VL_DIR_MATERIAL, 0},
    {"MakeNamedMaterial", PARAMS, VL_DIR_MAKE_NAMED_MATERIAL, 0},
    {"AreaLightSource", PARAMS, VL_DIR_AREA_LIGHT_SOURCE, 0},
    {"LightSource", PARAMS, VL_DIR_LIGHT_SOURCE, 0},
    {"Shape", PARAMS, VL_DIR_SHAPE, 0},
    {"Texture", TEXTURE, VL_DIR_TEXTURE, 0},
};
enum { KEYWORDS = VL_LENGTH(keywords) };

static const Keyword *find_keyword(const vlToken *token) {
  for (size_t i = 0; i < KEYWORDS; i++)
    if (vl_token_is(token, keywords[i].name))
      return &keywords[i];
  return NULL;
}

const char *vl_directive_name(vlDirective directive) {
  size_t i = KEYWORDS;
  while (i > 0 && keywords[--i].directive != directive) {
  }
  return keywords[i].name;
}

static bool unknown_directive(vlParserFile *file, const vlToken *token) {
  char text[64];
  size_t n = token->length < sizeof text ? token->length : sizeof text - 1;
  memcpy(text, token->text, n);
  text[n] = 0;
  const char *names[KEYWORDS];
  for (size_t i = 0; i < KEYWORDS; i++)
    names[i] = keywords[i].name;
  const char *near = vl_nearest_name(text, names, KEYWORDS);
  double number;
  if (vl_number_parse(token->text, token->length, &number))
    return fail_at(file, token, "expected a directive, found the number %s", shown(token).text);
  if (near)
    return fail_at(file, token, "unknown directive %s (did you mean %s?)", shown(token).text,
                   near);
  return fail_at(file, token, "unknown directive %s", shown(token).text);
}

static bool send(vlParserFile *file, const vlStatement *statement) {
  return file->parser->target->statement(file->parser->target->user, statement);
}

static bool fail_unclosed(const vlParserFile *file, const Keyword *k, const vlToken *open) {
  return fail_at(file, open, "unclosed [ of %s: the file ends before the ]", k->name);
}

static bool read_matrix(vlParserFile *file, const Keyword *k, vlStatement *s) {
  vlToken open = take_token(file);
  if (open.kind == VL_TOKEN_BAD)
    return fail_bad(file, &open);
  if (open.kind != VL_TOKEN_OPEN)
    return fail_at(file, &open, "%s: expected [ and 16 numbers, found %s", k->name,
                   shown(&open).text);
  for (uint32_t i = 0; i < 16; i++) {
    vlToken token = peek_token(file);
    if (token.kind == VL_TOKEN_CLOSE)
      return fail_at(file, &token, "%s: 16 numbers needed, found %u", k->name, i);
    if (token.kind == VL_TOKEN_END)
      return fail_unclosed(file, k, &open);
    if (!take_number(file, k->name, &s->numbers[i]))
      return false;
  }
  vlToken close = take_token(file);
  if (close.kind == VL_TOKEN_CLOSE)
    return true;
  if (close.kind == VL_TOKEN_END)
    return fail_unclosed(file, k, &open);
  return fail_at(file, &close, "%s: expected ] after 16 numbers, found %s", k->name,
                 shown(&close).text);
}

static bool read_active(vlParserFile *file, vlStatement *s) {
  vlToken token = take_token(file);
  if (vl_token_is(&token, "All"))
    s->directive = VL_DIR_ACTIVE_ALL;
  else if (vl_token_is(&token, "StartTime"))
    s->directive = VL_DIR_ACTIVE_START;
  else if (vl_token_is(&token, "EndTime"))
    s->directive = VL_DIR_ACTIVE_END;
  else
    return fail_at(file, &token,
                   "ActiveTransform: expected StartTime, EndTime or All, found %s",
                   shown(&token).text);
  return true;
}

/* The value may be a word or a string. A word is not terminated, so it is copied. */
static bool read_option(vlParserFile *file, vlStatement *s) {
  if (!take_string(file, "Option", "a name", &s->names[0]))
    return false;
  /* the type is optional: "bool name" or "name" */
  const char *space = strrchr(s->names[0], ' ');
  if (space)
    s->names[0] = space + 1;
  vlToken token = take_token(file);
  bool bracket = token.kind == VL_TOKEN_OPEN;
  if (bracket)
    token = take_token(file);
  if (token.kind == VL_TOKEN_BAD)
    return fail_bad(file, &token);
  if (token.kind != VL_TOKEN_WORD && token.kind != VL_TOKEN_STRING)
    return fail_at(file, &token, "Option: expected a value, found %s", shown(&token).text);
  char value[1024];
  size_t n = token.length < sizeof value ? token.length : sizeof value - 1;
  memcpy(value, token.text, n);
  value[n] = 0;
  s->names[1] = value;
  if (bracket) {
    vlToken close = take_token(file);
    if (close.kind != VL_TOKEN_CLOSE)
      return fail_at(file, &close, "Option: expected ], found %s", shown(&close).text);
  }
  return send(file, s);
}

static bool read_media(vlParserFile *file, vlStatement *s) {
  if (!take_string(file, "MediumInterface", "the name of a medium", &s->names[0]))
    return false;
  s->names[1] = s->names[0];
  return peek_token(file).kind != VL_TOKEN_STRING ||
         take_string(file, "MediumInterface", "the name of a medium", &s->names[1]);
}

static bool read_import(vlParserFile *file, const Keyword *k, vlStatement *s) {
  vlToken where = peek_token(file);
  const char *name = NULL;
  if (!take_string(file, k->name, "a file name", &name))
    return false;
  if (k->form == INCLUDE)
    return vl_parse_follow(file, &where, name, true);
  if (!send(file, s) || !vl_parse_follow(file, &where, name, false))
    return false;
  s->directive = VL_DIR_IMPORT_END;
  return send(file, s);
}

static bool read_directive(vlParserFile *file, const vlToken *token) {
  const Keyword *k = find_keyword(token);
  if (!k)
    return unknown_directive(file, token);
  vlParamList params = {0};
  vlStatement s = {
      .directive = k->directive, .source = vl_parse_source(file, token), .params = &params};
  bool fine = true;
  switch (k->form) {
    case ALONE:
      break;
    case ACTIVE:
      fine = read_active(file, &s);
      break;
    case NUMBERS:
      for (uint32_t i = 0; i < k->count && fine; i++)
        fine = take_number(file, k->name, &s.numbers[i]);
      break;
    case MATRIX:
      fine = read_matrix(file, k, &s);
      break;
    case ONE_NAME:
      fine = take_string(file, k->name, "a name", &s.names[0]);
      break;
    case MEDIA:
      fine = read_media(file, &s);
      break;
    case OPTION:
      return read_option(file, &s);
    case INCLUDE:
    case IMPORT:
      return read_import(file, k, &s);
    case PARAMS:
      fine = take_string(file, k->name,
                         k->directive == VL_DIR_MAKE_NAMED_MATERIAL ? "a name" : "a type name",
                         &s.names[0]) &&
             read_params(file, &params);
      break;
    case TEXTURE:
      fine =
          take_string(file, k->name, "the texture's name", &s.names[0]) &&
          take_string(file, k->name, "the texture's type (float or spectrum)", &s.names[1]) &&
          take_string(file, k->name, "the kind of texture", &s.names[2]) &&
          read_params(file, &params);
      break;
  }
  fine = fine && send(file, &s);
  vl_param_list_free(file->parser->context, &params);
  return fine;
}

/* ---- a block ----------------------------------------------------------------------------- */

/* After an error: skips to the next directive when the target wants to continue. Invalid tokens
 * are not skipped. */
static bool go_on(vlParserFile *file) {
  const vlParseTarget *target = file->parser->target;
  if (!target->recover)
    return false;
  for (;;) {
    vlToken token = peek_token(file);
    if (token.kind == VL_TOKEN_BAD)
      return false;
    if (token.kind == VL_TOKEN_END)
      break;
    if (find_keyword(&token))
      break;
    take_token(file);
  }
  return target->recover(target->user);
}

/* Offers the target to stop. Inside included files the fraction is unknown and given as 0. */
static bool poll(const vlParserFile *file, size_t size) {
  const vlParseTarget *target = file->parser->target;
  if (!target->go_on)
    return true;
  double left = (double)(file->tokens.end - file->tokens.at);
  return target->go_on(target->user, file->parent || !size ? 0 : 1 - left / (double)size);
}

bool vl_parse_block(vlParserFile *file, char *data, size_t size) {
  const unsigned char *b = (const unsigned char *)data;
  vlToken start = {.line = 1, .column = 1};
  if (size >= 2 && ((b[0] == 0xfe && b[1] == 0xff) || (b[0] == 0xff && b[1] == 0xfe)))
    return fail_at(file, &start, "the file is encoded as UTF-16; only UTF-8 is understood");
  vl_tokenizer_start(&file->tokens, data, size);
  for (;;) {
    vlToken token = take_token(file);
    if (token.kind == VL_TOKEN_END)
      return true;
    if (token.kind == VL_TOKEN_BAD)
      return fail_bad(file, &token);
    if (token.kind != VL_TOKEN_WORD)
      return fail_at(file, &token, "expected a directive, found %s", shown(&token).text);
    if (!poll(file, size))
      return false;
    if (!read_directive(file, &token) && !go_on(file))
      return false;
  }
}
