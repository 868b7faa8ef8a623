/* import/obj/obj.h: types and functions shared by the files of the OBJ importer. Data flow:
 * obj.c (statements to arrays of corners, polygons cut by obj_polygon.c) with mtl.c (material
 * libraries) -> obj_mesh.c (one shape per part) with mtl_material.c. Sources: "Object Files
 * (.obj)" and "Material Library File (.mtl)", Alias/Wavefront; the PBR statements of MTL as
 * published by Clara.io. */
#ifndef IMPORT_OBJ_OBJ_H
#define IMPORT_OBJ_OBJ_H

#include "import/labels.h"
#include "import/repair.h"
#include "math/extent.h"
#include "scene/scene.h"

/* Indices of a corner's position, uv and normal, counted from 1; 0: none. */
typedef struct vlObjCorner {
  uint32_t v, vt, vn;
} vlObjCorner;

typedef enum vlMtlMapKind {
  VL_MTL_KD,
  VL_MTL_KE,
  VL_MTL_KS,
  VL_MTL_D,
  VL_MTL_BUMP,
  VL_MTL_NORMAL,
  VL_MTL_PR,
  VL_MTL_PM,
  VL_MTL_PS,
  VL_MTL_MAPS
} vlMtlMapKind;

typedef struct vlMtlMap {
  const char *path; /* null: none; owned by the scene */
  float offset[2], scale[2], base, gain, bump;
  int channel; /* -1: decided by the image */
  bool clamp;
} vlMtlMap;

/* A material's parameters. NaN: not given. */
typedef struct vlMtl {
  float kd[3], ks[3], ke[3], tf[3];
  float ns, ni, d, pr, pm, ps, pc, pcr, aniso, anisor;
  int illum; /* -1: not given */
  vlMtlMap maps[VL_MTL_MAPS];
} vlMtl;

typedef struct vlObjMaterial {
  const char *name; /* owned by the scene */
  uint32_t line;    /* first line that uses the material */
  bool defined, made;
  uint32_t part; /* part for all faces of the material when there are too many parts, counted
                    from 1 */
  vlMtl mtl;
  vlMaterialId material;
  vlEmissionId emission;
  vlFloatInput alpha;
} vlObjMaterial;

/* The names that statements o and g gave; owned by the scene, null: none. */
typedef struct vlObjObject {
  const char *object, *group;
} vlObjObject;

/* A run of faces that becomes one shape. */
typedef struct vlObjPart {
  uint32_t material; /* index */
  uint32_t object;   /* index of the names of its object and group; 0: none, or more than one */
  uint32_t line;     /* of its first face */
  uint32_t triangles, first;
  bool normals, uvs; /* whether any corner has normals, uvs */
} vlObjPart;

enum { VL_OBJ_LIBRARIES = 64 };

/* A point, or a line between two vertices. */
typedef struct vlObjMark {
  uint32_t v, from; /* vertices, from 1; from = 0: a point */
  uint32_t material, line;
} vlObjMark;

/* Numbers of rows of equal size, one after the other. */
typedef VL_ARRAY(float) vlObjRows;

typedef struct vlObj {
  vlContext *context;
  vlScene *scene;
  const char *path;
  bool permissive, strict;
  const char *search_path; /* further folders, separated by ':'; may be null */
  vlRepairs repairs;
  uint32_t line, more_lines; /* first line of the statement, and number of continued lines */
  char nothing[1];           /* target of the pointers of an empty statement */
  const char *data_end;      /* of the file */
  /* start of the line, reading position and end of the current statement */
  char *line_start, *at, *end;
  vlObjRows positions;           /* 3 per vertex, about `origin` */
  double origin[3];              /* 0, or the middle of vertices far away (far.h) */
  VL_ARRAY(float) colors;        /* 3 per vertex, linear; empty when no vertex has a colour */
  vlObjRows uvs;                 /* 2 each */
  vlObjRows normals;             /* 3 each */
  VL_ARRAY(vlObjCorner) corners; /* 3 per triangle */
  VL_ARRAY(uint32_t) triangle_part;
  VL_ARRAY(uint32_t) triangle_smooth; /* smoothing group; 0: none */
  VL_ARRAY(vlObjPart) parts;
  VL_ARRAY(vlObjObject) objects;     /* index 0: no name */
  VL_ARRAY(vlObjMaterial) materials; /* index 0 is the default material */
  VL_ARRAY(vlObjMark) marks;
  VL_ARRAY(vlObjCorner) polygon;
  VL_ARRAY(uint32_t) ears; /* scratch of vl_obj_triangulate */
  VL_ARRAY(const char *) libraries;
  vlNameTable material_names; /* to indices of materials */
  uint32_t material, smooth, part;
  bool part_open;
  uint32_t reported; /* bit mask of warnings that are given only once and were given */
  vlExtent box;      /* of the vertices */
} vlObj;

/* Finds `origin` from all vertices. Call at the first one. */
void vl_obj_find_origin(vlObj *obj);
/* The position of the vertex of this number, counted from 1. */
static inline const float *vl_obj_position(const vlObj *obj, uint32_t v) {
  return obj->positions.items + 3 * (size_t)(v - 1);
}
/* Appends a row of `size` numbers. what: the rows' name in messages. Returns false after an
 * error. */
bool vl_obj_push(vlObj *obj, vlObjRows *rows, uint32_t size, const double *row,
                 const char *what);
/* Report an error or a warning at the current statement. vl_obj_fail always returns false. */
bool vl_obj_fail(vlObj *obj, const char *format, ...) VL_PRINTF(2, 3);
void vl_obj_warn(vlObj *obj, vlLogLevel level, const char *format, ...) VL_PRINTF(3, 4);
/* Warns of a missing file that is done without. */
void vl_obj_warn_missing(vlObj *obj, const char *format, ...) VL_PRINTF(2, 3);
bool vl_obj_fail_memory(vlObj *obj);
/* Reads the next statement of [*from, end) with its continued lines and sets line, at and end.
 * Returns false at the end of the text. */
bool vl_obj_statement(vlObj *obj, char **from, char *end);
/* Finds the statement's next word, which is not zero-terminated, and returns its length; 0 at
 * the end of the statement. */
size_t vl_obj_word(vlObj *obj, const char **word);
/* The same without reading past it. */
size_t vl_obj_next_word(vlObj *obj, const char **word);
/* Reads up to `max` numbers; *count receives how many. False when a word is not a number. */
bool vl_obj_numbers(vlObj *obj, uint32_t max, double *values, uint32_t *count);
/* The rest of the statement without surrounding blanks, zero-terminated. */
char *vl_obj_rest(vlObj *obj);
/* Index of the material of that name. A new name adds a material. UINT32_MAX after an error. */
uint32_t vl_obj_material(vlObj *obj, const char *name);

/* Triangulates obj->polygon. obj->ears receives indices into it, 3 per triangle. */
bool vl_obj_triangulate(vlObj *obj, uint32_t *triangles);
/* Reads the material libraries that a statement names. */
bool vl_obj_read_libraries(vlObj *obj);
vlMtl vl_mtl_default(void);
/* Adds the material to the scene. False after an error. */
bool vl_obj_make_material(vlObj *obj, vlObjMaterial *material);
bool vl_obj_add_shapes(vlObj *obj);
/* obj_line.c: reads a statement p or l; adds balls and tubes for all of them. */
bool vl_obj_read_marks(vlObj *obj, bool lines);
bool vl_obj_add_marks(vlObj *obj);
/* The label of a part's shape. The scene owns its strings. */
bool vl_obj_label(vlObj *obj, vlNameTable *names, size_t part, vlLabel *label);

#endif
