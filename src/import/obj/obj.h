/* import/obj/obj.h: what the files that read Wavefront OBJ share. The way of the data: obj.c (statements to plain
 * arrays of corners, polygons cut by obj_polygon.c) with mtl.c (material libraries) -> obj_mesh.c (one shape for each
 * part) with mtl_material.c. Sources: "Object Files (.obj)" and "Material Library File (.mtl)", Alias/Wavefront; the
 * PBR words of MTL as Clara.io published them. */
#ifndef IMPORT_OBJ_OBJ_H
#define IMPORT_OBJ_OBJ_H

#include "scene/scene.h"

/* Numbers of a corner's position, uv and normal, from 1; 0: none. */
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
  int channel; /* -1: by the image */
  bool clamp;
} vlMtlMap;

/* Numbers of a material; NAN: not said. */
typedef struct vlMtl {
  float kd[3], ks[3], ke[3], tf[3];
  float ns, ni, d, pr, pm, ps, pc, pcr, aniso, anisor;
  int illum; /* -1: not said */
  vlMtlMap maps[VL_MTL_MAPS];
} vlMtl;

typedef struct vlObjMaterial {
  const char *name; /* owned by the scene */
  uint32_t next;    /* of the same hash, from 1 */
  uint32_t line;    /* that uses it first */
  bool defined, made;
  uint32_t part; /* where its faces go when there are too many parts, from 1 */
  vlMtl mtl;
  vlMaterialId material;
  vlEmissionId emission;
  vlFloatInput alpha;
} vlObjMaterial;

/* Faces that become one shape. */
typedef struct vlObjPart {
  uint32_t material; /* index */
  uint32_t triangles, first;
  bool normals, uvs; /* some corner has them */
} vlObjPart;

enum { VL_OBJ_HEADS = 4096, VL_OBJ_LIBRARIES = 64 };

typedef struct vlObj {
  vlContext *context;
  vlScene *scene;
  const char *path;
  uint32_t line, more_lines;     /* the statement begins on; lines it goes on for */
  char nothing[1];               /* what an empty statement points at */
  char *line_start, *at, *end;   /* of the statement */
  VL_ARRAY(float) positions;     /* 3 a vertex */
  VL_ARRAY(float) colors;        /* 3 a vertex, linear; empty where no vertex has one */
  VL_ARRAY(float) uvs;           /* 2 */
  VL_ARRAY(float) normals;       /* 3 */
  VL_ARRAY(vlObjCorner) corners; /* 3 a triangle */
  VL_ARRAY(uint32_t) triangle_part;
  VL_ARRAY(uint32_t) triangle_smooth; /* smoothing group, 0: none */
  VL_ARRAY(vlObjPart) parts;
  VL_ARRAY(vlObjMaterial) materials; /* the first is the default one */
  VL_ARRAY(vlObjCorner) polygon;
  VL_ARRAY(uint32_t) ears; /* scratch of the polygon */
  VL_ARRAY(const char *) libraries;
  uint32_t heads[VL_OBJ_HEADS]; /* of materials by hash, from 1 */
  uint32_t material, smooth, part;
  bool part_open;
  uint32_t told; /* bits of things warned of once */
  double low[3], high[3];
} vlObj;

/* Errors and warnings at the statement's place; false. */
bool vl_obj_fail(vlObj *obj, const char *format, ...) __attribute__((format(printf, 2, 3)));
void vl_obj_warn(vlObj *obj, vlLogLevel level, const char *format, ...) __attribute__((format(printf, 3, 4)));
bool vl_obj_fail_memory(vlObj *obj);
/* The next statement of [*from, end) with its continued lines; false at the end. Sets line, at, end. */
bool vl_obj_statement(vlObj *obj, char **from, char *end);
/* Its next word; length 0 at its end. Not terminated. */
size_t vl_obj_word(vlObj *obj, const char **word);
/* Up to `most` numbers; *count of them. False: something else stands there. */
bool vl_obj_numbers(vlObj *obj, uint32_t most, double *values, uint32_t *count);
/* The rest of the statement without blanks around it, terminated. */
char *vl_obj_rest(vlObj *obj);
/* Index of a material by name, made where there is none; UINT32_MAX after an error. */
uint32_t vl_obj_material(vlObj *obj, const char *name);

/* Cuts obj->polygon into triangles: indices into it, 3 each, in obj->ears. */
bool vl_obj_triangulate(vlObj *obj, uint32_t *triangles);
/* The libraries that a statement names. */
bool vl_obj_read_libraries(vlObj *obj);
vlMtl vl_mtl_default(void);
/* Objects of the scene for the material; false after an error. */
bool vl_obj_make_material(vlObj *obj, vlObjMaterial *material);
bool vl_obj_add_shapes(vlObj *obj);

#endif
