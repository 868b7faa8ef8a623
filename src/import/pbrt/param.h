/* import/pbrt/param.h: the parsed parameters of a directive and typed access to them. A
 * parameter that nothing reads, or that has the wrong type or count, is an error at its source;
 * the message names the nearest accepted parameter. */
#ifndef IMPORT_PBRT_PARAM_H
#define IMPORT_PBRT_PARAM_H

#include "base/array.h"
#include "schema/schema.h"
#include "velo/scene_base.h"
#include "velo/spectrum.h"

typedef enum vlParamType {
  VL_PARAM_INTEGER,
  VL_PARAM_FLOAT,
  VL_PARAM_BOOL,
  VL_PARAM_STRING,
  VL_PARAM_POINT2,
  VL_PARAM_VECTOR2,
  VL_PARAM_POINT3,
  VL_PARAM_VECTOR3,
  VL_PARAM_NORMAL,
  VL_PARAM_SPECTRUM,
  VL_PARAM_RGB,
  VL_PARAM_BLACKBODY,
  VL_PARAM_TEXTURE,
  VL_PARAM_TYPES
} vlParamType;

/* Conversions between types and their names, such as "point3". The old spellings point, vector
 * and color mean point3, vector3 and rgb. */
const char *vl_param_type_name(vlParamType type);
bool vl_param_type_find(const char *text, size_t length, vlParamType *type);
/* The nearest type name for an error message, or null. */
const char *vl_param_type_nearest(const char *text);

enum { VL_PARAM_EXACT = 16 };
typedef struct vlParam {
  vlParamType type;
  char *name;
  vlSource source; /* location of the declaration; its file name is not owned */
  /* One of these is filled: integers for types integer and bool, floats for other numbers. */
  VL_ARRAY(float) floats;
  VL_ARRAY(int32_t) integers;
  VL_ARRAY(char *) strings;
  double exact[VL_PARAM_EXACT]; /* the first numbers in double precision */
  vlColorSpace space;
  bool used;
  uint32_t shared; /* number of lists that have it, beside the first */
  bool optional;   /* given by an Attribute directive: may stay unused or have another type */
} vlParam;

typedef struct vlParamList {
  VL_ARRAY(vlParam *) list;
} vlParamList;

/* Frees a parameter that no other list has. */
void vl_param_free(vlContext *context, vlParam *param);
void vl_param_list_free(vlContext *context, vlParamList *params);
size_t vl_param_count(const vlParam *param); /* number of values of any type */
/* One of the numbers of a type that fills floats, as exact as it was kept. */
static inline double vl_param_number(const vlParam *param, size_t i) {
  return i < VL_PARAM_EXACT ? param->exact[i] : (double)param->floats.items[i];
}

/* ---- questions --------------------------------------------------------------------------- */

typedef struct vlImport vlImport;

/* The parameters of one directive and the attributes that apply; the last one given counts. A
 * vlDict lives on the stack. Names passed to its functions are string literals. */
typedef struct vlDict {
  vlImport *import;
  char what[160];  /* 'Shape "sphere"', for errors */
  vlSource source; /* of the directive */
  vlColorSpace space;
  const vlParamList *own, *attributes; /* attributes may be null */
  const char *asked[64];
  uint32_t asked_count;
  int kind;             /* of the object that the directive makes; -1: unknown */
  const vlKindRow *row; /* of the kind; null: unknown */
  bool given[64];       /* per parameter of the row: whether the file gives it */
} vlDict;

enum {
  VL_BIT_INTEGER = 1 << VL_PARAM_INTEGER,
  VL_BIT_FLOAT = 1 << VL_PARAM_FLOAT,
  VL_BIT_BOOL = 1 << VL_PARAM_BOOL,
  VL_BIT_STRING = 1 << VL_PARAM_STRING,
  VL_BIT_POINT2 = 1 << VL_PARAM_POINT2,
  VL_BIT_POINT3 = 1 << VL_PARAM_POINT3,
  VL_BIT_VECTOR3 = 1 << VL_PARAM_VECTOR3,
  VL_BIT_NORMAL = 1 << VL_PARAM_NORMAL,
  VL_BIT_TEXTURE = 1 << VL_PARAM_TEXTURE,
  VL_BITS_SPECTRUM = 1 << VL_PARAM_RGB | 1 << VL_PARAM_SPECTRUM | 1 << VL_PARAM_BLACKBODY
};

/* The parameter `name` with one of the types of the bit mask. Null when it is not given. A
 * parameter of another type is an error. */
vlParam *vl_dict_find(vlDict *dict, const char *name, uint32_t type_bits);
/* The same; it must have `count` values. */
vlParam *vl_dict_find_counted(vlDict *dict, const char *name, uint32_t type_bits, size_t count);
/* These functions read a value. They return whether the parameter was given; otherwise *value
 * is unchanged. */
bool vl_dict_float(vlDict *dict, const char *name, float *value);
bool vl_dict_double(vlDict *dict, const char *name, double *value);
bool vl_dict_integer(vlDict *dict, const char *name, int32_t *value);
/* integer >= least */
bool vl_dict_count(vlDict *dict, const char *name, int32_t min, uint32_t *value);
bool vl_dict_bool(vlDict *dict, const char *name, bool *value);
bool vl_dict_string(vlDict *dict, const char *name, const char **value);
/* exactly count numbers, at most 16 */
bool vl_dict_floats(vlDict *dict, const char *name, size_t count, double *value);
/* *value becomes the index of the string among the names. */
bool vl_dict_choice(vlDict *dict, const char *name, const char *const *names, size_t count,
                    int *value);

/* Reports every parameter that was not read as an error. Returns false after an error. */
bool vl_dict_done(vlDict *dict);
/* Reports that a parameter, type and name, is missing, unless another one is misspelt or there
 * is an error. Returns false. */
bool vl_dict_missing(vlDict *dict, const char *what);
/* Marks all parameters of a skipped directive as read. */
void vl_dict_skip(vlDict *dict);

#endif
