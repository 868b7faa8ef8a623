/* import/parse.c: see parse.h. */
#include "import/parse.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/text.h"
#include "import/token.h"

enum { MAX_DEPTH = 64, MAX_INCLUDES = 20000, MAX_PATH = 4096 };

typedef struct Parser {
  vlContext *context;
  const vlParseTarget *target;
  const char *first; /* path of the first file */
  uint32_t includes;
} Parser;

typedef struct File {
  Parser *parser;
  const struct File *parent;
  const char *path;
  dev_t device;
  ino_t inode;
  uint32_t depth;
  vlTokenizer tokens;
  bool has_token;
  vlToken token;
} File;

/* ---- errors ----------------------------------------------------------------------------------------------------- */

static vlSource place_of(const File *file, const vlToken *token) {
  return (vlSource){file->path, token->line, token->column};
}

static bool fail(const File *file, vlSource place, const char *format, ...) __attribute__((format(printf, 3, 4)));
static bool fail(const File *file, vlSource place, const char *format, ...) {
  char text[512];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  const vlParseTarget *target = file->parser->target;
  target->error(target->user, VL_ERROR_SCENE, place, text);
  return false;
}

static bool fail_memory(const File *file) {
  const vlParseTarget *target = file->parser->target;
  target->error(target->user, VL_ERROR_MEMORY, (vlSource){0}, "out of memory");
  return false;
}

/* What stands there, short and printable. */
typedef struct Shown {
  char text[48];
} Shown;

static Shown show(const vlToken *token) {
  Shown s;
  size_t n = 0;
  if (token->kind == VL_TOKEN_END) {
    snprintf(s.text, sizeof s.text, "the end of the file");
    return s;
  }
  s.text[n++] = '"';
  for (size_t i = 0; i < token->length && n < sizeof s.text - 6; i++) {
    unsigned char c = (unsigned char)token->text[i];
    s.text[n++] = c < 32 || c == 127 ? '?' : (char)c;
    if (n == sizeof s.text - 6 && i + 1 < token->length) s.text[n++] = '.', s.text[n++] = '.', s.text[n++] = '.';
  }
  s.text[n++] = '"';
  s.text[n] = 0;
  return s;
}

/* ---- tokens ----------------------------------------------------------------------------------------------------- */

static vlToken peek(File *file) {
  if (!file->has_token) {
    file->token = vl_token_next(&file->tokens);
    file->has_token = true;
  }
  return file->token;
}

static vlToken take(File *file) {
  vlToken token = peek(file);
  if (token.kind != VL_TOKEN_END) file->has_token = false;
  return token;
}

static bool take_string(File *file, const char *directive, const char *what, const char **text) {
  vlToken token = take(file);
  if (token.kind == VL_TOKEN_STRING) {
    *text = token.text;
    return true;
  }
  if (token.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &token), "%s", token.message);
  return fail(file, place_of(file, &token), "%s: expected %s in quotes, found %s", directive, what, show(&token).text);
}

static bool take_number(File *file, const char *directive, double *value) {
  vlToken token = take(file);
  if (token.kind == VL_TOKEN_WORD && vl_number_parse(token.text, token.length, value)) return true;
  if (token.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &token), "%s", token.message);
  return fail(file, place_of(file, &token), "%s: expected a number, found %s", directive, show(&token).text);
}

/* ---- parameters ------------------------------------------------------------------------------------------------- */

static bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/* "type name": both parts of the declaration. */
static bool declare(File *file, const vlToken *token, vlParam *param) {
  const char *p = token->text, *end = p + token->length;
  while (p < end && is_blank(*p)) p++;
  const char *type = p;
  while (p < end && !is_blank(*p)) p++;
  size_t type_length = (size_t)(p - type);
  while (p < end && is_blank(*p)) p++;
  const char *name = p;
  while (p < end && !is_blank(*p)) p++;
  size_t name_length = (size_t)(p - name);
  while (p < end && is_blank(*p)) p++;
  if (type_length == 0 || name_length == 0 || p != end)
    return fail(file, param->place, "parameter %s is not of the form \"type name\"", show(token).text);
  if (!vl_param_type_find(type, type_length, &param->type)) {
    char text[64];
    snprintf(text, sizeof text, "%.*s", (int)(type_length < 60 ? type_length : 60), type);
    const char *near = vl_param_type_nearest(text);
    if (near) return fail(file, param->place, "unknown parameter type \"%s\" (did you mean \"%s\"?)", text, near);
    return fail(file, param->place, "unknown parameter type \"%s\"", text);
  }
  param->name = vl_alloc(file->parser->context, name_length + 1);
  if (!param->name) return fail_memory(file);
  memcpy(param->name, name, name_length);
  param->name[name_length] = 0;
  return true;
}

static bool takes_numbers(vlParamType type) {
  return type != VL_PARAM_BOOL && type != VL_PARAM_STRING && type != VL_PARAM_TEXTURE;
}

static bool add_number(File *file, const vlToken *token, vlParam *param) {
  vlContext *context = file->parser->context;
  double value;
  if (!vl_number_parse(token->text, token->length, &value))
    return fail(file, place_of(file, token), "\"%s %s\": expected a number, found %s", vl_param_type_name(param->type),
                param->name, show(token).text);
  if (param->type == VL_PARAM_INTEGER) {
    if (value < -2147483648.0 || value > 2147483647.0 || value != (double)(int64_t)value)
      return fail(file, place_of(file, token), "\"integer %s\": %s is not a 32-bit integer", param->name,
                  show(token).text);
    int32_t *slot = VL_PUSH(context, &param->integers);
    if (!slot) return fail_memory(file);
    *slot = (int32_t)value;
    return true;
  }
  size_t n = param->floats.count;
  if (n < 16) param->exact[n] = value;
  float *slot = VL_PUSH(context, &param->floats);
  if (!slot) return fail_memory(file);
  *slot = (float)value;
  return true;
}

static bool is_word(const vlToken *token, const char *word) {
  return token->kind == VL_TOKEN_WORD && token->length == strlen(word) && memcmp(token->text, word, token->length) == 0;
}

static bool add_value(File *file, const vlToken *token, vlParam *param) {
  vlContext *context = file->parser->context;
  const char *type = vl_param_type_name(param->type);
  bool truth = is_word(token, "true"), falsehood = is_word(token, "false");
  /* Files written for older versions put the truth values in quotes. */
  if (param->type == VL_PARAM_BOOL && token->kind == VL_TOKEN_STRING) {
    truth = strcmp(token->text, "true") == 0;
    falsehood = strcmp(token->text, "false") == 0;
  }
  if (param->type == VL_PARAM_BOOL) {
    if (!truth && !falsehood)
      return fail(file, place_of(file, token), "\"%s %s\": expected true or false, found %s", type, param->name,
                  show(token).text);
    uint8_t *slot = VL_PUSH(context, &param->bools);
    if (!slot) return fail_memory(file);
    *slot = truth;
    return true;
  }
  if (token->kind == VL_TOKEN_STRING) {
    if (takes_numbers(param->type) && param->type != VL_PARAM_SPECTRUM)
      return fail(file, place_of(file, token), "\"%s %s\": expected a number, found the string %s", type, param->name,
                  show(token).text);
    if (param->floats.count)
      return fail(file, place_of(file, token), "\"%s %s\": numbers and strings do not mix", type, param->name);
    char **slot = VL_PUSH(context, &param->strings);
    if (!slot || !(*slot = vl_strdup(context, token->text))) return fail_memory(file);
    return true;
  }
  if (!takes_numbers(param->type))
    return fail(file, place_of(file, token), "\"%s %s\": expected a string in quotes, found %s", type, param->name,
                show(token).text);
  if (param->strings.count)
    return fail(file, place_of(file, token), "\"%s %s\": numbers and strings do not mix", type, param->name);
  return add_number(file, token, param);
}

/* Numbers one after the other as far as they go, without a token for each; what is not a number, or not fitting, is
 * left to the careful way. */
static bool read_run(File *file, vlParam *param) {
  vlContext *context = file->parser->context;
  bool integers = param->type == VL_PARAM_INTEGER;
  for (size_t chunk = 4;; chunk = 1024) { /* most lists are short, and there may be many */
    if (integers ? !VL_RESERVE(context, &param->integers, chunk) : !VL_RESERVE(context, &param->floats, chunk))
      return fail_memory(file);
    for (size_t i = 0; i < chunk; i++) {
      vlTokenizer before = file->tokens;
      double value;
      if (!vl_token_number(&file->tokens, &value)) return true;
      if (!integers) {
        size_t n = param->floats.count++;
        param->floats.items[n] = (float)value;
        if (n < 16) param->exact[n] = value;
      } else if (value >= -2147483648.0 && value <= 2147483647.0 && value == (double)(int32_t)value) {
        param->integers.items[param->integers.count++] = (int32_t)value;
      } else {
        file->tokens = before;
        return true;
      }
    }
  }
}

static bool read_values(File *file, vlParam *param) {
  vlToken token = take(file);
  if (token.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &token), "%s", token.message);
  if (token.kind != VL_TOKEN_OPEN) {
    if (token.kind == VL_TOKEN_END || token.kind == VL_TOKEN_CLOSE)
      return fail(file, place_of(file, &token), "\"%s %s\": expected a value, found %s",
                  vl_param_type_name(param->type), param->name, show(&token).text);
    return add_value(file, &token, param);
  }
  vlToken open = token;
  bool numbers = takes_numbers(param->type);
  for (;;) {
    if (numbers && param->strings.count == 0 && !read_run(file, param)) return false;
    token = take(file);
    if (token.kind == VL_TOKEN_CLOSE) return true;
    if (token.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &token), "%s", token.message);
    if (token.kind == VL_TOKEN_OPEN) return fail(file, place_of(file, &token), "[ inside of [ ]");
    if (token.kind == VL_TOKEN_END)
      return fail(file, place_of(file, &open), "unclosed [ in \"%s %s\": the file ends before the ]",
                  vl_param_type_name(param->type), param->name);
    if (!add_value(file, &token, param)) return false;
  }
}

static bool read_params(File *file, vlParamList *params) {
  vlContext *context = file->parser->context;
  for (;;) {
    vlToken token = peek(file);
    if (token.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &token), "%s", token.message);
    if (token.kind != VL_TOKEN_STRING) return true;
    take(file);
    vlParam *param = vl_alloc_zero(context, 1, sizeof *param);
    vlParam **slot = param ? VL_PUSH(context, &params->list) : NULL;
    if (!slot) {
      vl_free(context, param);
      return fail_memory(file);
    }
    *slot = param;
    param->place = place_of(file, &token);
    if (!declare(file, &token, param) || !read_values(file, param)) return false;
  }
}

/* ---- directives ------------------------------------------------------------------------------------------------- */

typedef enum Form { ALONE, NUMBERS, MATRIX, ONE_NAME, MEDIA, OPTION, PARAMS, TEXTURE, ACTIVE, INCLUDE, IMPORT } Form;
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
enum { KEYWORDS = sizeof keywords / sizeof *keywords };

static bool unknown_directive(File *file, const vlToken *token) {
  char text[64];
  size_t n = token->length < sizeof text ? token->length : sizeof text - 1;
  memcpy(text, token->text, n);
  text[n] = 0;
  const char *names[KEYWORDS];
  for (size_t i = 0; i < KEYWORDS; i++) names[i] = keywords[i].name;
  const char *near = vl_nearest_name(text, names, KEYWORDS);
  double number;
  if (vl_number_parse(token->text, token->length, &number))
    return fail(file, place_of(file, token), "expected a directive, found the number %s", show(token).text);
  if (near) return fail(file, place_of(file, token), "unknown directive %s (did you mean %s?)", show(token).text, near);
  return fail(file, place_of(file, token), "unknown directive %s", show(token).text);
}

static bool follow(File *file, const vlToken *at, const char *name);

static bool send(File *file, const vlStatement *statement) {
  return file->parser->target->statement(file->parser->target->user, statement);
}

static bool read_matrix(File *file, const Keyword *k, vlStatement *s) {
  vlToken open = take(file);
  if (open.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &open), "%s", open.message);
  if (open.kind != VL_TOKEN_OPEN)
    return fail(file, place_of(file, &open), "%s: expected [ and 16 numbers, found %s", k->name, show(&open).text);
  for (uint32_t i = 0; i < 16; i++) {
    vlToken token = peek(file);
    if (token.kind == VL_TOKEN_CLOSE)
      return fail(file, place_of(file, &token), "%s: 16 numbers needed, found %u", k->name, i);
    if (token.kind == VL_TOKEN_END)
      return fail(file, place_of(file, &open), "unclosed [ of %s: the file ends before the ]", k->name);
    if (!take_number(file, k->name, &s->numbers[i])) return false;
  }
  vlToken close = take(file);
  if (close.kind == VL_TOKEN_CLOSE) return true;
  if (close.kind == VL_TOKEN_END)
    return fail(file, place_of(file, &open), "unclosed [ of %s: the file ends before the ]", k->name);
  return fail(file, place_of(file, &close), "%s: expected ] after 16 numbers, found %s", k->name, show(&close).text);
}

static bool read_active(File *file, vlStatement *s) {
  vlToken token = take(file);
  if (is_word(&token, "All"))
    s->directive = VL_DIR_ACTIVE_ALL;
  else if (is_word(&token, "StartTime"))
    s->directive = VL_DIR_ACTIVE_START;
  else if (is_word(&token, "EndTime"))
    s->directive = VL_DIR_ACTIVE_END;
  else
    return fail(file, place_of(file, &token), "ActiveTransform: expected StartTime, EndTime or All, found %s",
                show(&token).text);
  return true;
}

/* The value may be a word or a string; a word is not terminated in the file, so it is copied. */
static bool read_option(File *file, vlStatement *s) {
  if (!take_string(file, "Option", "a name", &s->names[0])) return false;
  const char *space = strrchr(s->names[0], ' '); /* "bool name": the type is optional */
  if (space) s->names[0] = space + 1;
  vlToken token = take(file);
  bool bracket = token.kind == VL_TOKEN_OPEN;
  if (bracket) token = take(file);
  if (token.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &token), "%s", token.message);
  if (token.kind != VL_TOKEN_WORD && token.kind != VL_TOKEN_STRING)
    return fail(file, place_of(file, &token), "Option: expected a value, found %s", show(&token).text);
  char value[1024];
  size_t n = token.length < sizeof value ? token.length : sizeof value - 1;
  memcpy(value, token.text, n);
  value[n] = 0;
  s->names[1] = value;
  if (bracket) {
    vlToken close = take(file);
    if (close.kind != VL_TOKEN_CLOSE)
      return fail(file, place_of(file, &close), "Option: expected ], found %s", show(&close).text);
  }
  return send(file, s);
}

static bool read_media(File *file, vlStatement *s) {
  if (!take_string(file, "MediumInterface", "the name of a medium", &s->names[0])) return false;
  s->names[1] = s->names[0];
  return peek(file).kind != VL_TOKEN_STRING ||
         take_string(file, "MediumInterface", "the name of a medium", &s->names[1]);
}

static bool read_import(File *file, const Keyword *k, const vlToken *at, vlStatement *s) {
  vlToken where = peek(file);
  const char *name;
  if (!take_string(file, k->name, "a file name", &name)) return false;
  if (k->form == INCLUDE) return follow(file, &where, name);
  (void)at;
  if (!send(file, s) || !follow(file, &where, name)) return false;
  s->directive = VL_DIR_IMPORT_END;
  return send(file, s);
}

static bool read_directive(File *file, const vlToken *token) {
  const Keyword *k = NULL;
  for (size_t i = 0; i < KEYWORDS && !k; i++)
    if (is_word(token, keywords[i].name)) k = &keywords[i];
  if (!k) return unknown_directive(file, token);
  vlParamList params = {0};
  vlStatement s = {.directive = k->directive, .place = place_of(file, token), .params = &params};
  bool fine = true;
  switch (k->form) {
    case ALONE: break;
    case ACTIVE: fine = read_active(file, &s); break;
    case NUMBERS:
      for (uint32_t i = 0; i < k->count && fine; i++) fine = take_number(file, k->name, &s.numbers[i]);
      break;
    case MATRIX: fine = read_matrix(file, k, &s); break;
    case ONE_NAME: fine = take_string(file, k->name, "a name", &s.names[0]); break;
    case MEDIA: fine = read_media(file, &s); break;
    case OPTION: return read_option(file, &s);
    case INCLUDE:
    case IMPORT: return read_import(file, k, token, &s);
    case PARAMS:
      fine = take_string(file, k->name, k->directive == VL_DIR_MAKE_NAMED_MATERIAL ? "a name" : "a type name",
                         &s.names[0]) &&
             read_params(file, &params);
      break;
    case TEXTURE:
      fine = take_string(file, k->name, "the texture's name", &s.names[0]) &&
             take_string(file, k->name, "the texture's type (float or spectrum)", &s.names[1]) &&
             take_string(file, k->name, "the kind of texture", &s.names[2]) && read_params(file, &params);
      break;
  }
  fine = fine && send(file, &s);
  vl_param_list_free(file->parser->context, &params);
  return fine;
}

/* ---- files ------------------------------------------------------------------------------------------------------ */

static bool parse_block(File *file, char *data, size_t size) {
  const unsigned char *b = (const unsigned char *)data;
  vlToken start = {.line = 1, .column = 1};
  if (size >= 2 && ((b[0] == 0xfe && b[1] == 0xff) || (b[0] == 0xff && b[1] == 0xfe)))
    return fail(file, place_of(file, &start), "the file is encoded as UTF-16; only UTF-8 is understood");
  vl_tokenizer_start(&file->tokens, data, size);
  for (;;) {
    vlToken token = take(file);
    if (token.kind == VL_TOKEN_END) return true;
    if (token.kind == VL_TOKEN_BAD) return fail(file, place_of(file, &token), "%s", token.message);
    if (token.kind != VL_TOKEN_WORD)
      return fail(file, place_of(file, &token), "expected a directive, found %s", show(&token).text);
    if (!read_directive(file, &token)) return false;
  }
}

static bool exists(const char *path) {
  struct stat info;
  return stat(path, &info) == 0;
}

bool vl_parse_find_file(const char *including, const char *first, const char *name, char *path, size_t size) {
  if (!vl_path_join(including, name, path, size)) return false;
  if (exists(path)) return true;
  char other[MAX_PATH];
  if (first && vl_path_join(first, name, other, sizeof other) && exists(other)) {
    size_t length = strlen(other);
    if (length < size) memcpy(path, other, length + 1);
  }
  return true;
}

/* Reads and parses one file; `at` is the token that names it, in `parent`, or null for the first. */
static bool parse_path(Parser *parser, const File *parent, vlSource at, const char *path) {
  struct stat info;
  File file = {.parser = parser, .parent = parent, .path = path, .depth = parent ? parent->depth + 1 : 0};
  const vlParseTarget *target = parser->target;
  if (stat(path, &info) == 0) {
    file.device = info.st_dev;
    file.inode = info.st_ino;
    if (parent && !S_ISREG(info.st_mode)) return fail(parent, at, "%s is not a regular file", path);
    for (const File *f = parent; f; f = f->parent) {
      if (f->inode != file.inode || f->device != file.device || !f->inode) continue;
      if (f == parent) return fail(parent, at, "the file includes itself: %s", path);
      return fail(parent, at, "the file includes itself in a circle: %s is being read already", path);
    }
  }
  if (parent && file.depth > MAX_DEPTH)
    return fail(parent, at, "files include each other more than %d deep", MAX_DEPTH);
  if (++parser->includes > MAX_INCLUDES) return fail(parent, at, "more than %d files are included", MAX_INCLUDES);
  char *data;
  size_t size;
  vlError error = {0};
  vlResult result = vl_file_read(parser->context, path, true, &data, &size, &error);
  if (result != VL_OK) {
    target->error(target->user, result, at, error.message);
    return parent && target->recover && target->recover(target->user);
  }
  bool fine = parse_block(&file, data, size);
  vl_free(parser->context, data);
  return fine;
}

static bool follow(File *file, const vlToken *at, const char *name) {
  vlSource place = place_of(file, at);
  char path[MAX_PATH];
  if (!vl_parse_find_file(file->path, file->parser->first, name, path, sizeof path))
    return fail(file, place, "file name too long");
  return parse_path(file->parser, file, place, path);
}

bool vl_parse_file(vlContext *context, const char *path, const vlParseTarget *target) {
  Parser parser = {.context = context, .target = target, .first = path};
  return parse_path(&parser, NULL, (vlSource){0}, path);
}

bool vl_parse_memory(vlContext *context, const char *data, size_t size, const char *name, const vlParseTarget *target) {
  Parser parser = {.context = context, .target = target, .first = name};
  File file = {.parser = &parser, .path = name};
  char *copy = vl_alloc(context, size + 1);
  if (!copy) return fail_memory(&file);
  memcpy(copy, data, size);
  copy[size] = 0;
  bool fine = parse_block(&file, copy, size);
  vl_free(context, copy);
  return fine;
}
