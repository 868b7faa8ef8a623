/* import/gltf/gltf.h: what the files of this folder that turn glTF 2.0 into a scene share. The way of the data:
 * file.c (JSON, chunks, buffers) -> accessor.c (arrays) -> node.c (poses, animation.c) -> mesh.c (deform.c, topology.c,
 * tangent.c) with material.c, texture.c -> scene. Every index, offset and size of the file is checked before it is
 * used; an error names the place in the JSON, as in meshes[3].primitives[0].attributes.POSITION.
 *
 * Source of everything here: the glTF 2.0 specification (Khronos) and the texts of its extensions. */
#ifndef IMPORT_GLTF_GLTF_H
#define IMPORT_GLTF_GLTF_H

#include <jansson.h>

#include "math/transform.h"
#include "scene/scene.h"

/* A place in the JSON: key, with an index where it is an element of an array. Lives on the stack of who looks there. */
typedef struct vlGltfPlace {
  const struct vlGltfPlace *up;
  const char *key;
  size_t index; /* SIZE_MAX: none */
} vlGltfPlace;
#define VL_GLTF_KEY(up, key) (&(vlGltfPlace){(up), (key), SIZE_MAX})
#define VL_GLTF_ITEM(up, key, index) (&(vlGltfPlace){(up), (key), (index)})

typedef struct vlGltfBuffer {
  const uint8_t *data;
  size_t size;
} vlGltfBuffer;

typedef struct vlGltfView {
  const uint8_t *data;
  size_t size, stride; /* stride 0: packed */
} vlGltfView;

enum {
  VL_GLTF_BYTE = 5120,
  VL_GLTF_UBYTE = 5121,
  VL_GLTF_SHORT = 5122,
  VL_GLTF_USHORT = 5123,
  VL_GLTF_UINT = 5125,
  VL_GLTF_FLOAT = 5126
};

/* Elements lie at data + i * stride; data null: zeros. Sparse ones replace elements by index. */
typedef struct vlGltfAccessor {
  enum { VL_GLTF_UNREAD, VL_GLTF_GOOD } state;
  const uint8_t *data;
  size_t count, stride;
  uint32_t components, type;
  bool normalized, matrix;
  size_t sparse_count;
  const uint8_t *sparse_indices, *sparse_values;
  uint32_t sparse_type;
} vlGltfAccessor;

typedef struct vlGltfNode {
  const json_t *json;
  uint32_t parent; /* UINT32_MAX: none */
  bool has_matrix, has_pose, reached;
  double matrix[16]; /* row-major */
  double translation[3], rotation[4], scale[3];
  vlMat4 world;   /* world_from_node, when has_pose */
  vlMat4 *keys;   /* world at each of the key times; null: no time passes */
  float *weights; /* of morph targets, animated; null: the mesh's or the node's own */
  uint32_t weight_count;
  float *weights_close; /* when the shutter closes */
  uint32_t weight_close_count;
} vlGltfNode;

/* What meshes must know of a material, and the scene's objects made from it. */
typedef struct vlGltfMaterial {
  bool made;
  vlMaterialId material;
  vlFloatInput alpha;
  vlEmissionId emission;
  bool double_sided, needs_tangents, needs_uvs;
  vlMediumId inside;
  uint32_t tangent_set; /* which uv set the tangents follow */
} vlGltfMaterial;

/* An encoded image: bytes in memory (owned by the scene) or a file. */
typedef struct vlGltfImage {
  bool read;
  const uint8_t *data;
  size_t size;
  const char *path;
} vlGltfImage;

enum { VL_GLTF_KEYS = 9 }; /* poses between the shutter's opening and closing, even */

typedef struct vlGltfMesh {
  uint32_t uses; /* by nodes of the scene, without deformation; instances count each */
  bool emissive; /* a primitive gives out light: cannot be instanced */
  bool grouped;  /* group is made */
  vlGroupId group;
} vlGltfMesh;

typedef struct vlGltf {
  vlContext *context;
  vlScene *scene;
  const vlLoadDef *def;
  const char *path; /* of the file */
  json_t *root;
  uint8_t *file;
  size_t file_size;
  const uint8_t *chunk; /* binary chunk of a .glb */
  size_t chunk_size;
  vlGltfBuffer *buffers;
  vlGltfView *views;
  vlGltfAccessor *accessors;
  vlGltfNode *nodes;
  vlGltfMaterial *materials; /* one more than the file has, with and without vertex colours: 2 * (count + 1) */
  vlGltfImage *images;
  vlGltfMesh *meshes;
  size_t buffer_count, view_count, accessor_count, node_count, material_count, image_count, texture_count, mesh_count,
      skin_count, camera_count, light_count, sampler_count, animation_count, scene_count;
  const json_t *lights; /* of KHR_lights_punctual */
  uint64_t total;       /* bytes of all buffers */
  uint64_t spent;       /* bytes of geometry made, against total */
  int64_t variant;      /* index, -1: none */
  double time;          /* that nodes are posed at */
  double open, close;   /* the shutter's times */
  bool moves;           /* close is later than open, and there are animations */
  bool closing;         /* deformation is that of the closing shutter */
  vlMat4 *keys;         /* of all nodes */
  uint32_t told;        /* bits of things warned of once */
  size_t shapes_made, lights_made, cameras_seen;
  double bounds_min[3], bounds_max[3];
} vlGltf;

enum {
  VL_GLTF_TOLD_RANGE = 1,
  VL_GLTF_TOLD_POINTS = 2,
  VL_GLTF_TOLD_MODE = 4,
  VL_GLTF_TOLD_SETS = 8,
  VL_GLTF_TOLD_FLAT = 16,
  VL_GLTF_TOLD_SKIN = 32,
  VL_GLTF_TOLD_MOTION = 64
};

/* ---- errors and JSON (json.c): functions that return bool have said what is wrong when they return false ----------
 */

/* "path: place: message"; always false. */
bool vl_gltf_fail(vlGltf *g, const vlGltfPlace *place, const char *format, ...) __attribute__((format(printf, 3, 4)));
bool vl_gltf_fail_code(vlGltf *g, vlResult code, const vlGltfPlace *place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
bool vl_gltf_fail_memory(vlGltf *g);
void vl_gltf_warn(vlGltf *g, vlLogLevel level, const vlGltfPlace *place, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* True the first time. */
bool vl_gltf_once(vlGltf *g, uint32_t bit);

/* Members. Absent: the value stays and true; of the wrong kind: an error. object may be null (nothing is there). */
bool vl_gltf_number(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, double *value);
bool vl_gltf_float(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, float *value);
bool vl_gltf_numbers(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, size_t count,
                     double *values);
bool vl_gltf_bool(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, bool *value);
bool vl_gltf_text(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, const char **value);
/* One of these names: its number. */
bool vl_gltf_choice(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, const char *const *names,
                    int count, int *value);
/* A whole number from 0. */
bool vl_gltf_size(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, size_t *value);
/* An index below limit; -1 where absent. */
bool vl_gltf_index(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, size_t limit,
                   int64_t *index);
bool vl_gltf_object(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, const json_t **value);
bool vl_gltf_array(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key, const json_t **value,
                   size_t *count);
/* object.extensions.name, or null. */
const json_t *vl_gltf_extension(const json_t *object, const char *name);
/* Element i of an array of objects at the root, as in nodes[3]; its count was checked. */
const json_t *vl_gltf_item(const vlGltf *g, const char *array, size_t index);

/* ---- files (file.c) ---------------------------------------------------------------------------------------------- */

bool vl_gltf_open(vlGltf *g);
bool vl_gltf_read_buffers(vlGltf *g); /* buffers and views */
void vl_gltf_close(vlGltf *g);
/* meshopt.c: a view by its EXT_meshopt_compression object. */
bool vl_gltf_unpack_view(vlGltf *g, const vlGltfPlace *at, const json_t *json, vlGltfView *view);
/* What a uri holds: a data: uri is unpacked into a block of the scene; else *path is the file's, with the folder of
 * the glTF file before it. */
bool vl_gltf_uri(vlGltf *g, const vlGltfPlace *at, const char *uri, const uint8_t **data, size_t *size,
                 const char **path);

/* ---- extensions (extension.c) ------------------------------------------------------------------------------------ */

bool vl_gltf_check_extensions(vlGltf *g);
bool vl_gltf_reads_extension(const char *name);
/* names.c: warns of members whose name is nearly one that the format has. */
void vl_gltf_check_names(vlGltf *g);

/* ---- arrays (accessor.c) ----------------------------------------------------------------------------------------- */

/* Checked; null after an error. */
const vlGltfAccessor *vl_gltf_accessor(vlGltf *g, const vlGltfPlace *at, size_t index);
/* All elements as floats, `components` each: missing ones are left as they are in out; normalised integers become -1 to
 * 1 or 0 to 1, others their value. */
void vl_gltf_read_floats(const vlGltfAccessor *accessor, uint32_t components, float *out);
void vl_gltf_read_uints(const vlGltfAccessor *accessor, uint32_t components, uint32_t *out);
/* New block of count * components floats by an accessor that must have one of the given numbers of components and count
 * elements (0: any; *read is told). Null after an error. */
float *vl_gltf_load_floats(vlGltf *g, const vlGltfPlace *at, size_t index, uint32_t components, size_t count,
                           size_t *read);
/* Says that so many bytes of geometry are about to be made; an error when that is out of proportion to the file. */
bool vl_gltf_spend(vlGltf *g, const vlGltfPlace *at, uint64_t bytes);

/* ---- the tree (node.c, animation.c) ------------------------------------------------------------------------------ */

bool vl_gltf_read_nodes(vlGltf *g);
bool vl_gltf_animate(vlGltf *g);    /* at g->time */
bool vl_gltf_pose_nodes(vlGltf *g); /* world matrices of all */
/* Poses at def->time; and, where that is asked for, on the way to def->time_close. */
bool vl_gltf_pose(vlGltf *g);
/* Does the node go another way than the world between the shutter's opening and closing? */
bool vl_gltf_node_moves(const vlGltf *g, const vlGltfNode *node);
/* Draws the chosen scene. */
bool vl_gltf_draw(vlGltf *g);
vlMat4 vl_gltf_matrix_from_trs(const double t[3], const double r[4], const double s[3]);

/* ---- meshes ------------------------------------------------------------------------------------------------------ */

/* A primitive as plain arrays (blocks of the context); triangles only. */
typedef struct vlGltfPrimitive {
  size_t vertices, faces;
  float *positions, *normals, *tangents;  /* 3, 3, 4 a vertex; all but the first may be null */
  float *colors;                          /* 4 a vertex, linear */
  float *uvs[4];                          /* 2 a vertex, v upwards */
  float *positions_close, *normals_close; /* when the shutter closes; null: at rest */
  uint32_t *indices;
} vlGltfPrimitive;
void vl_gltf_free_primitive(vlContext *context, vlGltfPrimitive *p);

/* Adds mesh `index` as node's (null: as a group's, in its own space). */
bool vl_gltf_add_mesh(vlGltf *g, size_t index, const vlGltfNode *node, size_t node_index, vlGroupId group, vlMat4 pose);
/* Whether the node moves vertices: skin or morph targets. */
bool vl_gltf_deforms(const vlGltf *g, const vlGltfNode *node);
/* topology.c: the primitive's indices (or 0, 1, 2, ...) by its mode as triangles; points and lines become small bodies,
 * which makes new vertices. */
bool vl_gltf_triangles(vlGltf *g, const vlGltfPlace *at, uint32_t mode, uint32_t *indices, size_t count,
                       vlGltfPrimitive *p);
/* Only vertices that faces use remain. */
bool vl_gltf_compact(vlGltf *g, vlGltfPrimitive *p);
/* deform.c */
bool vl_gltf_morph(vlGltf *g, const vlGltfPlace *at, const json_t *mesh, const json_t *primitive,
                   const vlGltfNode *node, vlGltfPrimitive *p);
/* Positions go to the world. */
bool vl_gltf_skin(vlGltf *g, const vlGltfPlace *at, const json_t *primitive, const vlGltfNode *node,
                  vlGltfPrimitive *p);
/* tangent.c: tangents as MikkTSpace makes them, from uv set `set`; flat normals where there are none. Vertices are
 * split where tangents differ. */
bool vl_gltf_make_tangents(vlGltf *g, uint32_t set, vlGltfPrimitive *p);

/* ---- materials --------------------------------------------------------------------------------------------------- */

/* Material index (-1: the default one) for a primitive with or without vertex colours; null after an error. */
const vlGltfMaterial *vl_gltf_material(vlGltf *g, int64_t index, bool colors);
/* A textureInfo as texture of the scene; tint: factors on its channels. channel -1: colour. Absent textures: *id 0. */
typedef struct vlGltfTextureUse {
  bool spectrum;
  int channel; /* float textures: 0 to 3 */
  bool srgb;   /* colour channels are in sRGB */
  float tint[4];
  bool colors; /* also times the vertex colour */
  float scale; /* float textures: value = bias + scale * channel */
  float bias;
  float cutoff; /* not NaN: 1 from here on, 0 below */
} vlGltfTextureUse;
vlGltfTextureUse vl_gltf_use_color(void);
vlGltfTextureUse vl_gltf_use_channel(int channel, float factor);
bool vl_gltf_texture(vlGltf *g, const vlGltfPlace *at, const json_t *object, const char *key,
                     const vlGltfTextureUse *use, vlTextureId *id);
/* The bytes or the file of images[index]. */
bool vl_gltf_read_image(vlGltf *g, size_t index);
/* The uv set that a textureInfo names (KHR_texture_transform's wins). */
bool vl_gltf_texture_set(vlGltf *g, const vlGltfPlace *at, const json_t *info, uint32_t *set);

/* volume.c: KHR_materials_volume of a body; a texture of directions into one of angles, plus rotation. */
bool vl_gltf_volume(vlGltf *g, const vlGltfPlace *at, const json_t *json, vlGltfMaterial *result);
bool vl_gltf_angle_texture(vlGltf *g, vlTextureId from, float rotation, vlFloatInput *input);

/* ---- lights, cameras --------------------------------------------------------------------------------------------- */

bool vl_gltf_add_light(vlGltf *g, size_t node, int64_t light);
bool vl_gltf_image_light(vlGltf *g, const json_t *scene, const vlGltfPlace *at);
bool vl_gltf_choose_camera(vlGltf *g);
bool vl_gltf_choose_variant(vlGltf *g);

#endif
