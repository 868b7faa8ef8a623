/* import/mesh.h: the mesh that readers of files fill: triangles and bilinear patches over
 * vertices with attributes, until it becomes a shape of the scene. */
#ifndef IMPORT_MESH_H
#define IMPORT_MESH_H

#include "base/context.h"
#include "velo/shape.h"

/* The attributes of vertices, as bits of a set. That of uv set k is VL_MESH_UVS << k. */
enum {
  VL_MESH_POSITIONS = 1,
  VL_MESH_NORMALS = 2,
  VL_MESH_TANGENTS = 4,
  VL_MESH_COLORS = 8,
  VL_MESH_POSITIONS_CLOSE = 16,
  VL_MESH_NORMALS_CLOSE = 32,
  VL_MESH_UVS = 64,
  VL_MESH_ATTRIBUTES = 10 /* their number */
};

/* All arrays are blocks of the context; those that a file does not give are null. A zeroed mesh
 * is empty. */
typedef struct vlMesh {
  size_t vertices, triangles, quads;
  union {
    struct {
      float *positions;       /* 3 per vertex, about `origin` */
      float *normals;         /* 3 */
      float *tangents;        /* 4: a direction, and the sign of the bitangent */
      float *colors;          /* 4, linear */
      float *positions_close; /* 3; when the shutter closes */
      float *normals_close;   /* 3 */
      float *uvs[4];          /* 2; v points upwards */
    };
    float *rows[VL_MESH_ATTRIBUTES]; /* the same, in the order of the bits */
  };
  float *face_colors;     /* 3 per triangle, linear; `colors` go before */
  uint32_t *indices;      /* 3 per triangle */
  uint32_t *quad_indices; /* 4 per patch: p00 p10 p01 p11 */
  double origin[3];       /* of the positions (far.h) */
  size_t index_capacity, quad_capacity, color_capacity; /* in numbers */
} vlMesh;

/* Whether all numbers of an array, which may be null, are finite. */
bool vl_all_finite(const float *v, size_t count);

void vl_mesh_free(vlContext *context, vlMesh *mesh);
/* Frees the attributes of a set. */
void vl_mesh_drop(vlContext *context, vlMesh *mesh, uint32_t attributes);

/* The functions below return false when memory is exhausted. */

/* Makes the attributes of a set for mesh->vertices. Their numbers are not set. */
bool vl_mesh_add_attributes(vlContext *context, vlMesh *mesh, uint32_t attributes);
/* Vertex i becomes a copy of vertex order[i]; the faces' indices are left to the caller. After
 * a failure the mesh is as before. */
bool vl_mesh_reorder(vlContext *context, vlMesh *mesh, const uint32_t *order, size_t count);
bool vl_mesh_add_triangle(vlContext *context, vlMesh *mesh, uint32_t a, uint32_t b, uint32_t c);
/* Adds a patch. Its corners are given around the face. */
bool vl_mesh_add_quad(vlContext *context, vlMesh *mesh, const uint32_t corners[4]);
/* Gives the triangles from `first` on a colour. */
bool vl_mesh_color_triangles(vlContext *context, vlMesh *mesh, size_t first,
                             const float color[3]);
/* Appends each patch to the triangles, as two of them. False also if there are too many; the
 * mesh is then as before. */
bool vl_mesh_split_quads(vlContext *context, vlMesh *mesh);
/* Gives each triangle vertices of its own: `indices` become 0, 1, 2, ... The same. */
bool vl_mesh_separate(vlContext *context, vlMesh *mesh);
/* Shrinks the arrays of faces to their size; empty ones become null. */
bool vl_mesh_fit(vlContext *context, vlMesh *mesh);

/* Sets the def's arrays and counts to those of the triangles, but for tangents and origin. */
void vl_mesh_to_shape(const vlMesh *mesh, vlShapeDef *def);

#endif
