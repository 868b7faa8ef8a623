/* import/ply/ply_reader.h: types and functions shared by the files that read PLY: the header as
 * a table of elements and properties, and the position in the file. ply_header.c fills the
 * table, ply_rows.c reads vertices and faces, ply_file.c the whole file. */
#ifndef IMPORT_PLY_PLY_READER_H
#define IMPORT_PLY_PLY_READER_H

#include "base/array.h"
#include "base/error.h"
#include "import/ply/ply.h"

enum { VL_PLY_MAX_ELEMENTS = 32, VL_PLY_MAX_PROPERTIES = 256 };

typedef enum vlPlyType {
  VL_PLY_I8,
  VL_PLY_U8,
  VL_PLY_I16,
  VL_PLY_U16,
  VL_PLY_I32,
  VL_PLY_U32,
  VL_PLY_F32,
  VL_PLY_F64,
  VL_PLY_TYPES
} vlPlyType;

typedef enum vlPlyFormat { VL_PLY_ASCII, VL_PLY_LITTLE, VL_PLY_BIG } vlPlyFormat;

/* The meaning of a property. */
typedef enum vlPlyRole {
  VL_PLY_NOTHING,
  VL_PLY_X,
  VL_PLY_Y,
  VL_PLY_Z,
  VL_PLY_NX,
  VL_PLY_NY,
  VL_PLY_NZ,
  VL_PLY_U,
  VL_PLY_V,
  VL_PLY_RED,
  VL_PLY_GREEN,
  VL_PLY_BLUE,
  VL_PLY_ALPHA,
  VL_PLY_INDICES,
  VL_PLY_ROLES
} vlPlyRole;

typedef struct vlPlyProperty {
  vlPlyType type, count_type;
  bool is_list;
  vlPlyRole role;
} vlPlyProperty;

typedef enum vlPlyElementKind {
  VL_PLY_OTHER,
  VL_PLY_VERTEX,
  VL_PLY_FACE,
  VL_PLY_STRIPS
} vlPlyElementKind;

typedef struct vlPlyElement {
  vlPlyElementKind kind;
  char name[32];
  uint64_t count;
  vlPlyProperty properties[VL_PLY_MAX_PROPERTIES];
  uint32_t property_count;
  bool has_list;
  uint64_t row_size; /* bytes of a row: exact for a binary file without lists, otherwise a lower
                        bound */
} vlPlyElement;

typedef struct vlPlyReader {
  vlContext *context;
  const vlPlyOptions *options;
  const char *name;
  const char *at, *end;
  uint32_t line; /* line number in a text file or header; 0 in binary data */
  vlPlyFormat format;
  vlPlyElement *elements;
  uint32_t element_count;
  vlMesh *mesh;
  bool has_vertices, face_colors; /* face_colors: faces have colours */
  bool faces_first;               /* faces came before the vertices: their indices are not
                                     checked yet */
  VL_ARRAY(uint32_t) face;
  vlError *error;
} vlPlyReader;

/* Bytes of a value. */
static inline uint32_t vl_ply_type_size(vlPlyType type) {
  return type <= VL_PLY_U8 ? 1 : type <= VL_PLY_U16 ? 2 : type <= VL_PLY_F32 ? 4 : 8;
}

bool vl_ply_fail(vlPlyReader *r, const char *format, ...) VL_PRINTF(2, 3);
bool vl_ply_fail_memory(vlPlyReader *r);
/* A number of a vertex is not finite. */
bool vl_ply_fail_number(vlPlyReader *r, uint64_t vertex, vlPlyRole role, double value);
/* False, with the error CANCELLED: the load must stop. row: number of the row that is read
 * next. */
bool vl_ply_goes_on(vlPlyReader *r, uint64_t row);
bool vl_ply_read_header(vlPlyReader *r); /* stops at the first byte of the data */
/* Reads the next value of that type from text or binary data. */
bool vl_ply_read_value(vlPlyReader *r, vlPlyType type, double *value);
/* Reads the length of a list and checks that the file has enough bytes for its items. */
bool vl_ply_read_length(vlPlyReader *r, const vlPlyProperty *p, uint64_t *length);
/* Reads a value, or a list with its length, of which *value receives the last one; it is
 * unchanged if there is none. */
bool vl_ply_read_property(vlPlyReader *r, const vlPlyProperty *p, double *value);
bool vl_ply_read_vertices(vlPlyReader *r, const vlPlyElement *e);
bool vl_ply_read_faces(vlPlyReader *r, const vlPlyElement *e);
bool vl_ply_read_strips(vlPlyReader *r, const vlPlyElement *e);

#endif
