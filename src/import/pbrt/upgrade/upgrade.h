/* import/pbrt/upgrade/upgrade.h: types and functions shared by the files that turn pbrt-v3 text
 * into pbrt-v4 text. Data flow: document.c cuts a file into statements that keep their offsets
 * in the text; tables.c and the rules (materials.c, textures.c, lights.c, shapes.c, settings.c)
 * say what changes; edit.c collects edits and applies them, so that all other text stays as it
 * is; files.c finds and names files; upgrade.c drives. */
#ifndef IMPORT_PBRT_UPGRADE_UPGRADE_H
#define IMPORT_PBRT_UPGRADE_UPGRADE_H

#include "base/file_set.h"
#include "import/find.h"
#include "velo/upgrade.h"

/* Part of a file's text: [start, end). */
typedef struct vlOldSpan {
  size_t start, end;
} vlOldSpan;

enum {
  VL_OLD_FIRST = 16, /* values of a parameter that are kept */
  VL_OLD_VALUE = 200 /* size of a new value */
};

typedef struct vlOldParam {
  const char *type, *name; /* as written */
  const char *new_type, *new_name;
  char new_value[VL_OLD_VALUE]; /* empty: as written */
  vlOldSpan decl, value;        /* value includes its brackets */
  size_t count;
  bool strings, dropped;
  vlOldSpan span[VL_OLD_FIRST];
  const char *text[VL_OLD_FIRST]; /* strings without quotes; null for other values */
  double number[VL_OLD_FIRST];
} vlOldParam;

typedef struct vlOldWord vlOldWord;

typedef struct vlOldStatement {
  struct vlUpgrade *u;
  struct vlOldFile *file; /* that has it */
  const vlOldWord *word;
  char directive[40];
  vlOldSpan keyword, whole;
  uint32_t line, column;
  size_t name_count;
  vlOldSpan names[3];
  const char *name[3];
  VL_ARRAY(vlOldParam) params;
  /* opening and closing bracket of a list of numbers; start == end: none */
  vlOldSpan numbers[2];
  char changes[400]; /* what the report says of the statement */
  uint32_t renamed;  /* bits of the names that vl_old_finish writes */
  bool finished;     /* vl_old_finish has run */
} vlOldStatement;

typedef struct vlOldEdit {
  vlOldSpan span;
  char *text; /* owned */
  uint32_t order;
} vlOldEdit;

/* A texture, as it was written to the new file. */
typedef struct vlOldTexture {
  char *name, *text, *copy; /* copy: name of its float copy; null: none yet */
  bool grey;                /* the copy says all */
} vlOldTexture;

/* A texture, material, medium or object of the old scene (names.c). */
typedef struct vlOldName {
  int family;
  uint32_t depth;   /* of the attribute block that made it */
  bool ended;       /* the block has ended */
  char *old, *name; /* name: in the new scene, where each is given once */
} vlOldName;

/* A file that was included. One that makes names, or refers to renamed ones, becomes several
 * files. */
typedef struct vlOldInclude {
  char *path, *name;  /* where it was found; what the new Include says */
  const char *text;   /* of the new file, which u->outputs owns; null: the old file is used */
  bool makes, refers; /* names */
} vlOldInclude;

/* An image of a light. */
typedef struct vlOldMap {
  char *from, *name; /* path of the old image; name of the new one, beside the new scene */
  double factor[3];
  void *data; /* bytes of the new file */
  size_t size;
} vlOldMap;

typedef struct vlUpgrade {
  vlContext *context;
  const vlUpgradeDef *def;
  const char *first, *to;                  /* the old scene's first file, and the new one */
  char from_folder[4096], to_folder[4096]; /* absolute */
  bool same_folder;
  vlResult result;
  vlError error;
  uint32_t lost, made;        /* made: number of names that were made up */
  bool see_through;           /* the material of that name was written */
  bool quiet;                 /* a file is read again: nothing is reported */
  uint32_t attributes;        /* depth of attribute blocks */
  uint32_t renamed, referred; /* number of second names; of references to names */
  VL_ARRAY(vlOldName) names;
  VL_ARRAY(vlOldTexture) textures;
  VL_ARRAY(vlOldInclude) includes;
  /* pairs: name, relative to the new scene's folder, and text of the files to write */
  VL_ARRAY(char *) outputs;
  vlFileSet files;  /* the new scene's */
  uint32_t missing; /* files that were not found */
  VL_ARRAY(vlOldMap) maps;
  uint32_t depth;
  bool is_old; /* the first file has statements that pbrt-v4 does not have */
  bool filter_given, has_world;
  /* the first file has subsurface materials; the integrator is path */
  bool subsurface, plain_path;
  double exposure; /* factor on the film's iso: 1 / the shutter's time */
  double iso;      /* of the film: 100 * its scale */
  struct vlOldFile *film_file;
  size_t film_end; /* where parameters of the film can be added */
} vlUpgrade;

enum { VL_OLD_ATTRIBUTES = 3 };
/* AttributeBegin or TransformBegin, with the statements in it that set attributes. */
typedef struct vlOldBlock {
  bool transform;
  vlOldSpan set[VL_OLD_ATTRIBUTES]; /* start == end: none */
  uint32_t line[VL_OLD_ATTRIBUTES];
} vlOldBlock;

typedef struct vlOldFile {
  vlUpgrade *u;
  const char *path;
  char *text;
  size_t size;
  char *words; /* a copy of the text that the tokenizer changes */
  VL_ARRAY(vlOldEdit) edits;
  VL_ARRAY(vlOldBlock) blocks;
} vlOldFile;

/* ---- statements (document.c) ------------------------------------------------------------- */

typedef enum vlOldForm {
  VL_OLD_PLAIN,   /* names, then no more */
  VL_OLD_NUMBERS, /* numbers, with or without brackets */
  VL_OLD_MATRIX,  /* sixteen numbers in brackets */
  VL_OLD_WORD,    /* one word */
  VL_OLD_PARAMS   /* names and parameters */
} vlOldForm;

typedef bool vlOldRule(vlOldStatement *s);

struct vlOldWord {
  const char *names; /* directives, separated by blanks */
  vlOldForm form;
  uint32_t strings; /* most strings before the parameters; MediumInterface may have one fewer */
  vlOldRule *rule;
};
extern const vlOldWord vl_old_words[]; /* ends with a null name (upgrade.c) */

typedef struct vlTokenizer vlTokenizer;
/* Reads the next statement. *end: there is none. False after an error. */
bool vl_old_read(vlOldFile *file, vlTokenizer *tokens, vlOldStatement *s, bool *end);
void vl_old_free(vlOldStatement *s);

/* ---- edits and reports (edit.c) ---------------------------------------------------------- */

bool vl_old_fail(vlOldFile *file, vlResult code, uint32_t line, uint32_t column,
                 const char *format, ...) VL_PRINTF(5, 6);
/* The same at the statement: the scene is wrong. */
bool vl_old_wrong(const vlOldStatement *s, const char *format, ...) VL_PRINTF(2, 3);
bool vl_old_fail_memory(vlUpgrade *u);
/* Reports what has no counterpart. */
void vl_old_lose(const vlOldStatement *s, const char *format, ...) VL_PRINTF(2, 3);
/* Adds to what the report says of the statement's change. */
void vl_old_note(vlOldStatement *s, const char *format, ...) VL_PRINTF(2, 3);
/* Replaces part of the text. Insertions have an empty span; those at the same offset keep their
 * order. */
bool vl_old_edit(const vlOldStatement *s, vlOldSpan span, const char *format, ...)
    VL_PRINTF(3, 4);
/* Removes a whole statement, with its line where it stands alone. */
bool vl_old_remove(vlOldStatement *s);
/* Adds a statement before or after s, on a line of its own with the same indentation. */
typedef enum vlOldSide { VL_OLD_BEFORE, VL_OLD_AFTER } vlOldSide;
bool vl_old_insert(const vlOldStatement *s, vlOldSide side, const char *format, ...)
    VL_PRINTF(3, 4);
/* Adds a parameter at the end of the statement. */
bool vl_old_add(const vlOldStatement *s, const char *format, ...) VL_PRINTF(2, 3);
/* Replaces name i of the statement (by null: it stays), and notes the change. */
bool vl_old_rename(vlOldStatement *s, size_t i, const char *name);
/* Makes the edits of the statement's parameters and reports the change. */
bool vl_old_finish(vlOldStatement *s);
/* The new text of a span; the caller frees it. Null: out of memory. */
char *vl_old_render(vlOldFile *file, vlOldSpan span);
/* The line of the old text that the offset in the new text of the whole file comes from. */
uint32_t vl_old_line(const vlOldFile *file, size_t offset);

/* ---- parameters (params.c) --------------------------------------------------------------- */

/* the last one that is not dropped; null: none */
vlOldParam *vl_old_find(vlOldStatement *s, const char *name);
/* Leaves the parameter out. */
void vl_old_drop(vlOldStatement *s, vlOldParam *p);
void vl_old_drop_all(vlOldStatement *s, const char *const *names, size_t count);
/* Leaves the parameter out. Whether that loses something: it was there, and not grey of the
 * value that changes nothing. */
bool vl_old_drop_loses(vlOldStatement *s, const char *name, double neutral);
/* Converts type names and values to those of pbrt-v4. */
bool vl_old_types(vlOldStatement *s);
/* Whether the parameter is a number, or a colour of three equal numbers. */
bool vl_old_is_grey(const vlOldParam *p, double *value);
/* Whether the parameter is a colour; a number counts. */
bool vl_old_is_color(const vlOldParam *p, double rgb[3]);
/* Whether the statement has a parameter of this name that is black, or 0. */
bool vl_old_is_black(vlOldStatement *s, const char *name);
bool vl_old_is_texture(const vlOldParam *p);
/* The number of a parameter, or `otherwise`. */
double vl_old_number(vlOldStatement *s, const char *name, double otherwise);
/* All numbers of a parameter in a new block, which the caller frees. *found: how many there
 * are, at most p->count. Null: out of memory (reported). */
double *vl_old_all_numbers(const vlOldStatement *s, const vlOldParam *p, size_t *found);
/* The number as text: the shortest that gives the same float. */
const char *vl_old_text(double value, char text[32]);
/* The colour as text: [ r g b ]. */
const char *vl_old_rgb_text(const double rgb[3], char text[VL_OLD_VALUE]);
/* Sets the new value. */
void vl_old_value(vlOldParam *p, const char *format, ...) VL_PRINTF(2, 3);
/* Makes the parameter a colour. */
void vl_old_set_color(vlOldParam *p, const double rgb[3]);
/* Lowers what is above 1 to 1, and reports that. Returns whether there was any. */
bool vl_old_clip(const vlOldStatement *s, const char *name, double rgb[3]);
/* Of several numbers the first is kept, as it is written. */
void vl_old_keep_first(const vlOldStatement *s, vlOldParam *p);

typedef enum vlOldAction {
  VL_OLD_KEEP, /* of a row that gives names only, separated by blanks */
  VL_OLD_RENAME,
  VL_OLD_DROP,   /* has no meaning in pbrt-v4 */
  VL_OLD_LOSE,   /* has one that pbrt-v4 does not have */
  VL_OLD_DEFAULT /* `to` is added where it is not given: the default has changed */
} vlOldAction;
typedef struct vlOldRow {
  const char *name;
  vlOldAction action;
  const char *to;
} vlOldRow;
/* Applies rows, which end with a null name, to the parameters that are not yet renamed or
 * dropped. Parameters that no row names are lost. */
bool vl_old_rows(vlOldStatement *s, const vlOldRow *rows);

/* Kinds of one directive. A row of a table ends with its last member that is not null. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
typedef struct vlOldKind {
  const char *from; /* names, separated by blanks */
  const char *to;   /* null: the name stays */
  const vlOldRow *rows;
  vlOldRule *rule;  /* runs before the rows; may be null */
  const char *lost; /* reported; may be null */
} vlOldKind;
/* The row of a kind; null for unknown kinds. The table ends with a null name. */
const vlOldKind *vl_old_kind(const vlOldKind *kinds, const char *name);
/* Reports what is lost, applies rule and rows, and writes the kind's new name in place of the
 * statement's first. */
bool vl_old_become(vlOldStatement *s, const vlOldKind *kind);

/* ---- rules ------------------------------------------------------------------------------- */

vlOldRule vl_old_material, vl_old_named_material;                         /* materials.c */
vlOldRule vl_old_disney, vl_old_uber, vl_old_translucent, vl_old_mix;     /* materials_more.c */
vlOldRule vl_old_texture;                                                 /* textures.c */
vlOldRule vl_old_light, vl_old_area_light;                                /* lights.c */
vlOldRule vl_old_shape;                                                   /* shapes.c */
vlOldRule vl_old_camera, vl_old_film, vl_old_sampler, vl_old_integrator;  /* settings.c */
vlOldRule vl_old_filter, vl_old_accelerator, vl_old_medium, vl_old_world; /* settings.c */
/* A float texture with the values of the spectrum texture, written before the statement. Null:
 * there is none. */
const char *vl_old_float_copy(vlOldStatement *s, const char *texture);
/* Gives names that are made a second time new ones, also where the statement refers to them
 * (names.c). Runs before the rule of the statement. */
bool vl_old_names(vlOldStatement *s);
vlOldRule vl_old_block; /* blocks.c */
/* Remembers a statement that sets an attribute. */
void vl_old_block_sets(const vlOldStatement *s);
/* Shapes that pbrt-v4 does not have, as triangles (quadrics.c). */
vlOldRule vl_old_mesh_of_shape;

/* ---- files (files.c, environment.c) ------------------------------------------------------ */

/* Finds a file that the statement names. what: "file", and what becomes of its name where
 * there is none, which is counted and reported. */
vlFound vl_old_find_file(const vlOldStatement *s, const char *name, const char *what,
                         const char *otherwise, char path[4096]);
/* What the new scene says for a file that the old one names. False after an error. */
bool vl_old_file_name(const vlOldStatement *s, const char *name, char *result, size_t size);
/* The same for the file that a parameter names (null: none), and says so. */
bool vl_old_write_file_name(vlOldStatement *s, const vlOldParam *p);
/* Replaces a file's name by another one, and notes that: `note`, then the name. */
bool vl_old_put_name(vlOldStatement *s, const vlOldParam *p, const char *name,
                     const char *note);
/* Includes: upgrades the file and names the new one. */
vlOldRule vl_old_include;
/* Upgrades the file, of which u and path are set; what it holds is freed by vl_old_free_file,
 * also after an error. Its text differs if there are edits. *text is the new one, freed by the
 * caller. */
bool vl_old_upgrade_file(vlOldFile *file, char **text);
void vl_old_free_file(vlOldFile *file);
/* The name of the equal-area image that an image over longitude and latitude becomes, times the
 * factor. The image is made, and written at the end. */
bool vl_old_environment(const vlOldStatement *s, const char *name, const double factor[3],
                        char *result, size_t size);

#endif
