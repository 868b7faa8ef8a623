/* import/pbrt/directives.c: reads directives (parse.h). */
#include "import/pbrt/parse.h"

#include "base/text.h"
#include "import/pbrt/parser.h"

static bool take_string(vlParserFile *file, const char *directive, const char *what,
                        const char **text) {
  vlToken token = vl_parse_take(file);
  if (token.kind == VL_TOKEN_STRING) {
    *text = token.text;
    return true;
  }
  if (token.kind == VL_TOKEN_BAD)
    return vl_parse_fail_bad(file, &token);
  return vl_parse_fail(file, vl_parse_source(file, &token),
                       "%s: expected %s in quotes, found %s", directive, what,
                       vl_parse_show(&token).text);
}

static bool take_number(vlParserFile *file, const char *directive, double *value) {
  vlToken token = vl_parse_take(file);
  if (token.kind == VL_TOKEN_WORD && vl_number_parse(token.text, token.length, value))
    return true;
  if (token.kind == VL_TOKEN_BAD)
    return vl_parse_fail_bad(file, &token);
  return vl_parse_fail(file, vl_parse_source(file, &token), "%s: expected a number, found %s",
                       directive, vl_parse_show(&token).text);
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
    return vl_parse_fail(file, vl_parse_source(file, token),
                         "expected a directive, found the number %s",
                         vl_parse_show(token).text);
  if (near)
    return vl_parse_fail(file, vl_parse_source(file, token),
                         "unknown directive %s (did you mean %s?)", vl_parse_show(token).text,
                         near);
  return vl_parse_fail(file, vl_parse_source(file, token), "unknown directive %s",
                       vl_parse_show(token).text);
}

static bool send(vlParserFile *file, const vlStatement *statement) {
  return file->parser->target->statement(file->parser->target->user, statement);
}

static bool read_matrix(vlParserFile *file, const Keyword *k, vlStatement *s) {
  vlToken open = vl_parse_take(file);
  if (open.kind == VL_TOKEN_BAD)
    return vl_parse_fail_bad(file, &open);
  if (open.kind != VL_TOKEN_OPEN)
    return vl_parse_fail(file, vl_parse_source(file, &open),
                         "%s: expected [ and 16 numbers, found %s", k->name,
                         vl_parse_show(&open).text);
  for (uint32_t i = 0; i < 16; i++) {
    vlToken token = vl_parse_peek(file);
    if (token.kind == VL_TOKEN_CLOSE)
      return vl_parse_fail(file, vl_parse_source(file, &token),
                           "%s: 16 numbers needed, found %u", k->name, i);
    if (token.kind == VL_TOKEN_END)
      return vl_parse_fail(file, vl_parse_source(file, &open),
                           "unclosed [ of %s: the file ends before the ]", k->name);
    if (!take_number(file, k->name, &s->numbers[i]))
      return false;
  }
  vlToken close = vl_parse_take(file);
  if (close.kind == VL_TOKEN_CLOSE)
    return true;
  if (close.kind == VL_TOKEN_END)
    return vl_parse_fail(file, vl_parse_source(file, &open),
                         "unclosed [ of %s: the file ends before the ]", k->name);
  return vl_parse_fail(file, vl_parse_source(file, &close),
                       "%s: expected ] after 16 numbers, found %s", k->name,
                       vl_parse_show(&close).text);
}

static bool read_active(vlParserFile *file, vlStatement *s) {
  vlToken token = vl_parse_take(file);
  if (vl_parse_is_word(&token, "All"))
    s->directive = VL_DIR_ACTIVE_ALL;
  else if (vl_parse_is_word(&token, "StartTime"))
    s->directive = VL_DIR_ACTIVE_START;
  else if (vl_parse_is_word(&token, "EndTime"))
    s->directive = VL_DIR_ACTIVE_END;
  else
    return vl_parse_fail(file, vl_parse_source(file, &token),
                         "ActiveTransform: expected StartTime, EndTime or All, found %s",
                         vl_parse_show(&token).text);
  return true;
}

/* The value may be a word or a string. A word is not terminated, so it is copied. */
static bool read_option(vlParserFile *file, vlStatement *s) {
  if (!take_string(file, "Option", "a name", &s->names[0]))
    return false;
  const char *space =
      strrchr(s->names[0], ' '); /* the type is optional: "bool name" or "name" */
  if (space)
    s->names[0] = space + 1;
  vlToken token = vl_parse_take(file);
  bool bracket = token.kind == VL_TOKEN_OPEN;
  if (bracket)
    token = vl_parse_take(file);
  if (token.kind == VL_TOKEN_BAD)
    return vl_parse_fail_bad(file, &token);
  if (token.kind != VL_TOKEN_WORD && token.kind != VL_TOKEN_STRING)
    return vl_parse_fail(file, vl_parse_source(file, &token),
                         "Option: expected a value, found %s", vl_parse_show(&token).text);
  char value[1024];
  size_t n = token.length < sizeof value ? token.length : sizeof value - 1;
  memcpy(value, token.text, n);
  value[n] = 0;
  s->names[1] = value;
  if (bracket) {
    vlToken close = vl_parse_take(file);
    if (close.kind != VL_TOKEN_CLOSE)
      return vl_parse_fail(file, vl_parse_source(file, &close), "Option: expected ], found %s",
                           vl_parse_show(&close).text);
  }
  return send(file, s);
}

static bool read_media(vlParserFile *file, vlStatement *s) {
  if (!take_string(file, "MediumInterface", "the name of a medium", &s->names[0]))
    return false;
  s->names[1] = s->names[0];
  return vl_parse_peek(file).kind != VL_TOKEN_STRING ||
         take_string(file, "MediumInterface", "the name of a medium", &s->names[1]);
}

static bool read_import(vlParserFile *file, const Keyword *k, const vlToken *at,
                        vlStatement *s) {
  vlToken where = vl_parse_peek(file);
  const char *name = NULL;
  if (!take_string(file, k->name, "a file name", &name))
    return false;
  if (k->form == INCLUDE)
    return vl_parse_follow(file, &where, name, true);
  (void)at;
  if (!send(file, s) || !vl_parse_follow(file, &where, name, false))
    return false;
  s->directive = VL_DIR_IMPORT_END;
  return send(file, s);
}

static bool read_directive(vlParserFile *file, const vlToken *token) {
  const Keyword *k = NULL;
  for (size_t i = 0; i < KEYWORDS && !k; i++)
    if (vl_parse_is_word(token, keywords[i].name))
      k = &keywords[i];
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
      return read_import(file, k, token, &s);
    case PARAMS:
      fine = take_string(file, k->name,
                         k->directive == VL_DIR_MAKE_NAMED_MATERIAL ? "a name" : "a type name",
                         &s.names[0]) &&
             vl_parse_params(file, &params);
      break;
    case TEXTURE:
      fine =
          take_string(file, k->name, "the texture's name", &s.names[0]) &&
          take_string(file, k->name, "the texture's type (float or spectrum)", &s.names[1]) &&
          take_string(file, k->name, "the kind of texture", &s.names[2]) &&
          vl_parse_params(file, &params);
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
    vlToken token = vl_parse_peek(file);
    if (token.kind == VL_TOKEN_BAD)
      return false;
    if (token.kind == VL_TOKEN_END)
      break;
    bool next = false;
    for (size_t i = 0; i < KEYWORDS && !next; i++)
      next = vl_parse_is_word(&token, keywords[i].name);
    if (next)
      break;
    vl_parse_take(file);
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
    return vl_parse_fail(file, vl_parse_source(file, &start),
                         "the file is encoded as UTF-16; only UTF-8 is understood");
  vl_tokenizer_start(&file->tokens, data, size);
  for (;;) {
    vlToken token = vl_parse_take(file);
    if (token.kind == VL_TOKEN_END)
      return true;
    if (token.kind == VL_TOKEN_BAD)
      return vl_parse_fail_bad(file, &token);
    if (token.kind != VL_TOKEN_WORD)
      return vl_parse_fail(file, vl_parse_source(file, &token),
                           "expected a directive, found %s", vl_parse_show(&token).text);
    if (!poll(file, size))
      return false;
    if (!read_directive(file, &token) && !go_on(file))
      return false;
  }
}
