/* import/pbrt/parse.h: the grammar of the pbrt language. It turns tokens into directives and
 * passes them to a target of callbacks; it does not depend on scenes. The parser itself reads
 * the files of Include, within limits of depth and size. It also reads the files of Import;
 * their directives stand between IMPORT_BEGIN and IMPORT_END. */
#ifndef IMPORT_PBRT_PARSE_H
#define IMPORT_PBRT_PARSE_H

#include "import/pbrt/param.h"

typedef enum vlDirective {
  /* directives without arguments */
  VL_DIR_ATTRIBUTE_BEGIN,
  VL_DIR_ATTRIBUTE_END,
  VL_DIR_TRANSFORM_BEGIN,
  VL_DIR_TRANSFORM_END,
  VL_DIR_IDENTITY,
  VL_DIR_REVERSE_ORIENTATION,
  VL_DIR_WORLD_BEGIN,
  VL_DIR_OBJECT_END,
  VL_DIR_ACTIVE_ALL, /* ActiveTransform All, StartTime, EndTime */
  VL_DIR_ACTIVE_START,
  VL_DIR_ACTIVE_END,
  VL_DIR_IMPORT_BEGIN, /* Import "file": its directives follow, then IMPORT_END */
  VL_DIR_IMPORT_END,
  /* directives followed by numbers */
  VL_DIR_TRANSLATE,
  VL_DIR_SCALE,
  VL_DIR_ROTATE,
  VL_DIR_LOOK_AT,
  VL_DIR_TRANSFORM,
  VL_DIR_CONCAT_TRANSFORM,
  VL_DIR_TRANSFORM_TIMES,
  /* directives followed by one or two names */
  VL_DIR_COORDINATE_SYSTEM,
  VL_DIR_COORD_SYS_TRANSFORM,
  VL_DIR_COLOR_SPACE,
  VL_DIR_NAMED_MATERIAL,
  VL_DIR_OBJECT_BEGIN,
  VL_DIR_OBJECT_INSTANCE,
  VL_DIR_MEDIUM_INTERFACE, /* inside, outside */
  VL_DIR_OPTION,           /* name, value as written */
  /* directives followed by a name and parameters */
  VL_DIR_ATTRIBUTE,
  VL_DIR_FILM,
  VL_DIR_SAMPLER,
  VL_DIR_INTEGRATOR,
  VL_DIR_PIXEL_FILTER,
  VL_DIR_ACCELERATOR,
  VL_DIR_CAMERA,
  VL_DIR_MAKE_NAMED_MEDIUM,
  VL_DIR_MATERIAL,
  VL_DIR_MAKE_NAMED_MATERIAL,
  VL_DIR_AREA_LIGHT_SOURCE,
  VL_DIR_LIGHT_SOURCE,
  VL_DIR_SHAPE,
  VL_DIR_TEXTURE /* names[0]: name, names[1]: type, names[2]: kind */
} vlDirective;

/* As files write it. */
const char *vl_directive_name(vlDirective directive);

typedef struct vlStatement {
  vlDirective directive;
  vlSource source;
  double numbers[16];
  const char *names[3]; /* valid during the call */
  vlParamList *params;  /* parameters of a directive that has them; the callee may take the
                           contents and zero the list, otherwise they are freed */
} vlStatement;

typedef struct vlParseTarget {
  void *user;
  /* Handles a statement. Returns false to stop the parser, after it has reported an error. */
  bool (*statement)(void *user, const vlStatement *statement);
  void (*error)(void *user, vlResult code, vlSource source, const char *message);
  /* Called after an error. Returns true to continue after the directive or file. May be
   * null. */
  bool (*recover)(void *user);
  /* Folders separated by ':' in which included files are looked for, too; null: none. */
  const char *search_path;
  /* Called for a file that is found in the current folder only. May be null. */
  void (*found_elsewhere)(void *user, vlSource source, const char *path);
  /* Called before each directive; fraction: the share of the first file that is read, 0 inside
   * included files. False: the parser stops; the callee has reported why. May be null. */
  bool (*go_on)(void *user, double fraction);
  /* Included files that are not read from the disk: pairs of the name in Include, and the text.
   * May be null. */
  const char *const *texts;
  size_t text_count;
  /* Called for a file beyond the limits. Returns true to leave the file out. May be null. */
  bool (*skip)(void *user, vlSource source);
} vlParseTarget;

/* Both functions return false after an error. vl_parse_memory parses a copy of data and uses
 * name as the file's name. */
bool vl_parse_file(vlContext *context, const char *path, const vlParseTarget *target);
bool vl_parse_memory(vlContext *context, const char *data, size_t size, const char *name,
                     const vlParseTarget *target);

#endif
