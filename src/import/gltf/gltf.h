/* import/gltf/gltf.h: types and functions shared by the files of the glTF 2.0 importer.
 * Data flow: file.c (JSON, chunks, buffers) -> accessor.c (arrays) -> node.c (poses, with
 * animation.c) -> mesh.c (with deform.c, topology.c, tangent.c, material.c, texture.c) ->
 * scene. Every index, offset and size of the file is checked before it is used. An error names
 * its location in the JSON, for example meshes[3].primitives[0].attributes.POSITION. Source:
 * the glTF 2.0 specification (Khronos) and the specifications of its extensions. */
#ifndef IMPORT_GLTF_GLTF_H
#define IMPORT_GLTF_GLTF_H

#include <jansson.h>

#include "import/mesh.h"
#include "import/names.h"
#include "import/repair.h"
#include "math/extent.h"
#include "math/transform.h"
#include "scene/scene.h"

/* The index of nothing. */
#define VL_GLTF_NONE SIZE_MAX

/* A location in the JSON: a key, and an index for an element of an array. Locations are linked
 * on the caller's stack, up to that of the whole file (vlGltf.top). */
typedef struct vlGltfLocation {
  const struct vlGltfLocation *up; /* null: the whole file, which g reads */
  const char *key;
  size_t index; /* VL_GLTF_NONE: none */
  struct vlGltf *g;
} vlGltfLocation;
#define VL_GLTF_KEY(up, key) (&(vlGltfLocation){(up), (key), VL_GLTF_NONE, NULL})
#define VL_GLTF_ITEM(up, key, index) (&(vlGltfLocation){(up), (key), (index), NULL})
/* An element of one of the root's arrays. */
#define VL_GLTF_ROOT(g, key, index) VL_GLTF_ITEM(&(g)->top, key, index)

typedef struct vlGltfBuffer {
  const uint8_t *data;
  size_t size;
} vlGltfBuffer;

typedef struct vlGltfView {
  const uint8_t *data;
  size_t size, stride; /* bytes; stride 0: packed */
} vlGltfView;

enum {
  VL_GLTF_BYTE = 5120,
  VL_GLTF_UBYTE = 5121,
  VL_GLTF_SHORT = 5122,
  VL_GLTF_USHORT = 5123,
  VL_GLTF_UINT = 5125,
  VL_GLTF_FLOAT = 5126
};

/* Element i lies at data + i * stride. data null: all elements are zero. Sparse elements
 * replace the elements at their indices. */
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
  double matrix[16]; /* the node's matrix, row-major, when has_matrix */
  double translation[3], rotation[4], scale[3];
  vlMat4 world;   /* world_from_node, when has_pose */
  vlMat4 *keys;   /* world_from_node at each of the VL_GLTF_KEYS key times; null: no motion */
  float *weights; /* animated weights of the morph targets; null: the weights of the node or the
                     mesh apply */
  uint32_t weight_count;
  float *weights_close; /* weights at shutter close */
  uint32_t weight_close_count;
} vlGltfNode;

/* The scene objects made from a material, and the properties of it that meshes need. */
typedef struct vlGltfMaterial {
  bool made;
  vlMaterialId material;
  vlFloatInput alpha;
  vlEmissionId emission;
  bool double_sided, needs_tangents;
  vlMediumId inside;
  uint32_t tangent_set; /* uv set from which the tangents are computed */
} vlGltfMaterial;

/* An encoded image: bytes in memory (of the file, or if kept of the scene) or the path of a
 * file. */
typedef struct vlGltfImage {
  bool read, missing, kept;
  const uint8_t *data;
  size_t size;
  const char *path;
} vlGltfImage;

/* Number of poses from shutter open to shutter close, evenly spaced. */
enum { VL_GLTF_KEYS = 9 };

typedef struct vlGltfMesh {
  uint32_t uses; /* number of nodes and instances that place the mesh undeformed */
  bool emissive; /* a primitive emits light: the mesh cannot be instanced */
  bool grouped;  /* the mesh's group has been made */
  vlGroupId group;
} vlGltfMesh;

typedef struct vlGltf {
  vlContext *context;
  vlScene *scene;
  const vlLoadDef *def;
  const char *path;   /* of the file */
  vlGltfLocation top; /* the whole file */
  json_t *root;
  uint8_t *file;
  size_t file_size;
  VL_ARRAY(void *) blocks; /* freed when the file is read: its bytes and all arrays below */
  const uint8_t *chunk;    /* the binary chunk of a .glb */
  size_t chunk_size;
  vlGltfBuffer *buffers;
  vlGltfView *views;
  vlGltfAccessor *accessors;
  vlGltfNode *nodes;
  vlGltfMaterial *materials; /* 2 * (count + 1): each material of the file and the default one,
                                without and with vertex colours */
  vlGltfImage *images;
  vlGltfMesh *meshes;
  size_t buffer_count, view_count, accessor_count, node_count, material_count, image_count,
      texture_count, mesh_count, skin_count, camera_count, light_count, lamp_count,
      sampler_count, animation_count, scene_count;
  const json_t *lights;         /* array of KHR_lights_punctual */
  const json_t *lamps;          /* array of EXT_lights_ies */
  uint64_t total;               /* size of all buffers in bytes */
  double point_radius;          /* of points and lines, in the world; 0: not known */
  double scale;                 /* of the node that is drawn */
  uint64_t spent;               /* bytes of geometry made so far; see vl_gltf_spend */
  size_t variant;               /* index of the material variant; VL_GLTF_NONE: none */
  double time;                  /* time in seconds at which nodes are posed */
  double open, close;           /* shutter times, seconds */
  bool moves;                   /* close is later than open, and there are animations */
  bool closing;                 /* meshes are currently deformed as at shutter close */
  vlMat4 *keys;                 /* world matrices of all nodes at the key times */
  const char **node_labels;     /* of the nodes with a mesh; owned by the scene */
  const char **material_labels; /* one per material */
  vlNameTable shape_names, instance_names, material_names;
  vlRepairs repairs;
  size_t copy; /* which of EXT_mesh_gpu_instancing's poses is placed; VL_GLTF_NONE: none */
  uint32_t reported; /* bit mask of warnings (VL_GLTF_REPORTED_*) that were given */
  size_t shapes_made, cameras_seen;
} vlGltf;

enum {
  VL_GLTF_REPORTED_RANGE = 1,
  VL_GLTF_REPORTED_POINTS = 2,
  VL_GLTF_REPORTED_SETS = 4,
  VL_GLTF_REPORTED_FLAT = 8,
  VL_GLTF_REPORTED_SKIN = 16,
  VL_GLTF_REPORTED_MOTION = 32
};

/* ---- errors and JSON (json.c) ------------------------------------------------------------ */

/* A function of the importer that returns bool has reported the error when it returns false,
 * unless its comment says otherwise. */

/* Reports the error "path: location: message". Always returns false. */
bool vl_gltf_fail(const vlGltfLocation *location, const char *format, ...) VL_PRINTF(2, 3);
/* The same of a member of the object at the location. */
bool vl_gltf_fail_key(const vlGltfLocation *at, const char *key, const char *format, ...)
    VL_PRINTF(3, 4);
bool vl_gltf_fail_code(vlResult code, const vlGltfLocation *location, const char *format, ...)
    VL_PRINTF(3, 4);
static inline bool vl_gltf_fail_memory(vlGltf *g) {
  return vl_scene_fail_memory(g->scene);
}
/* The import that reads the file. */
vlGltf *vl_gltf_of(const vlGltfLocation *location);
/* Writes the location from its outermost part inwards, cut to the size; nothing for the file.
 * Returns the length. */
size_t vl_gltf_write_location(const vlGltfLocation *location, char *text, size_t size);
void vl_gltf_warn(vlLogLevel level, const vlGltfLocation *location, const char *format, ...)
    VL_PRINTF(3, 4);
/* Warns of a missing file that is done without. */
void vl_gltf_warn_missing(const vlGltfLocation *location, const char *format, ...)
    VL_PRINTF(2, 3);
/* Returns true on the first call for this bit. */
bool vl_gltf_once(vlGltf *g, uint32_t bit);

/* The value at a location; null if there is none. */
const json_t *vl_gltf_json(const vlGltfLocation *at);
/* Typed members of the JSON object at a location. An absent member leaves the value as it is
 * and returns true. A member of the wrong type is an error. Where there is no object, every
 * member is absent. */
bool vl_gltf_number(const vlGltfLocation *at, const char *key, double *value);
bool vl_gltf_float(const vlGltfLocation *at, const char *key, float *value);
bool vl_gltf_numbers(const vlGltfLocation *at, const char *key, size_t count, double *values);
bool vl_gltf_bool(const vlGltfLocation *at, const char *key, bool *value);
bool vl_gltf_text(const vlGltfLocation *at, const char *key, const char **value);
/* *value receives the index of the member's string among the names. */
bool vl_gltf_choice(const vlGltfLocation *at, const char *key, const char *const *names,
                    int count, int *value);
/* A non-negative integer. */
bool vl_gltf_size(const vlGltfLocation *at, const char *key, size_t *value);
/* An index below limit; VL_GLTF_NONE when absent, which vl_gltf_need_index reports. */
bool vl_gltf_index(const vlGltfLocation *at, const char *key, size_t limit, size_t *index);
bool vl_gltf_need_index(const vlGltfLocation *at, const char *key, size_t limit, size_t *index);
/* The same of an object that is not at the location, which messages name. */
bool vl_gltf_size_in(const vlGltfLocation *at, const json_t *object, const char *key,
                     size_t *value);
bool vl_gltf_index_in(const vlGltfLocation *at, const json_t *object, const char *key,
                      size_t limit, size_t *index);
/* The index that an element of an array holds; what: of what, for the message. */
bool vl_gltf_element(const vlGltfLocation *at, const json_t *value, size_t limit,
                     const char *what, size_t *index);
bool vl_gltf_object(const vlGltfLocation *at, const char *key, const json_t **value);
bool vl_gltf_array(const vlGltfLocation *at, const char *key, const json_t **value,
                   size_t *count);
/* object.extensions.name, or null. */
const json_t *vl_gltf_extension(const json_t *object, const char *name);
/* object.name, or null. */
static inline const char *vl_gltf_name(const json_t *object) {
  return json_string_value(json_object_get(object, "name"));
}
/* The index below limit that a member holds; VL_GLTF_NONE: none. Reports nothing. */
size_t vl_gltf_peek(const json_t *object, const char *key, size_t limit);
/* The accessor of positions of a primitive, the same way. */
const json_t *vl_gltf_peek_positions(const vlGltf *g, const json_t *primitive);
/* Element i of an array at the root, for example nodes[3]. The caller must have checked i. */
const json_t *vl_gltf_item(const vlGltf *g, const char *array, size_t index);

/* ---- files (file.c) ---------------------------------------------------------------------- */

bool vl_gltf_open(vlGltf *g);
/* A zeroed block that vl_gltf_close frees. Null: out of memory (reported). */
void *vl_gltf_make(vlGltf *g, size_t count, size_t size);
bool vl_gltf_read_buffers(vlGltf *g); /* buffers and buffer views */
void vl_gltf_close(vlGltf *g);
/* Bytes of a buffer, as a buffer view or a compressed one names them. */
typedef struct vlGltfRange {
  size_t buffer; /* index */
  size_t offset, length, stride;
} vlGltfRange;
/* Reads a range. Its bytes may be more than the buffer has. */
bool vl_gltf_range(const vlGltfLocation *at, vlGltfRange *range);
/* Whether the buffer has the bytes; otherwise that is reported. */
bool vl_gltf_check_range(const vlGltfLocation *at, const vlGltfRange *range);
/* meshopt.c: decodes a buffer view by its EXT_meshopt_compression object. */
bool vl_gltf_unpack_view(vlGltf *g, const vlGltfLocation *at, vlGltfView *view);
/* Decodes a compressed primitive (KHR_draco_mesh_compression) into its accessors; true if it is
 * not compressed. */
bool vl_gltf_unpack_primitive(vlGltf *g, const vlGltfLocation *at);
/* Resolves a uri. A data: uri is decoded into a block owned by the scene. Otherwise *path is
 * the file's path: in the folder of the glTF file, else on the search path. */
bool vl_gltf_uri(vlGltf *g, const vlGltfLocation *at, const char *uri, const uint8_t **data,
                 size_t *size, const char **path);

/* ---- extensions (extension.c) ------------------------------------------------------------ */

bool vl_gltf_check_extensions(vlGltf *g);
bool vl_gltf_reads_extension(const char *name);
/* Whether the extension changes no image, so that it is ignored without a warning. */
bool vl_gltf_passes_extension(const char *name);
/* The name for messages: in full if it is registered, else shortened. */
vlShortText vl_gltf_extension_text(const char *name);
/* names.c: warns of members that the format does not have, one line for each name. */
void vl_gltf_check_names(vlGltf *g);

/* ---- arrays (accessor.c) ----------------------------------------------------------------- */

/* The accessor, checked; null after an error. */
const vlGltfAccessor *vl_gltf_accessor(vlGltf *g, size_t index);
/* The bytes of a view; null after an error. */
const vlGltfView *vl_gltf_view(vlGltf *g, const vlGltfLocation *at, size_t index);
void vl_gltf_read_uints(const vlGltfAccessor *accessor, uint32_t components, uint32_t *out);
/* A new block of floats from an accessor of `count` elements (0: of any number), `components`
 * for each; of those that the accessor lacks, the fourth is 1 and the others are 0. *read
 * receives the number of elements; read may be null. Null after an error. */
float *vl_gltf_load_floats(const vlGltfLocation *at, size_t index, uint32_t components,
                           size_t count, size_t *read);
/* Adds to the bytes of geometry made so far. Reports an error when the sum is out of proportion
 * to the file's size. */
bool vl_gltf_spend(const vlGltfLocation *at, uint64_t bytes);

/* ---- the tree (node.c, animation.c) ------------------------------------------------------ */

bool vl_gltf_read_nodes(vlGltf *g);
/* Applies animation `index` at g->time. */
bool vl_gltf_apply_animation(vlGltf *g, size_t index);
/* Visits the animations that the def chooses, in order. False after an error, also that there
 * is no such animation. */
bool vl_gltf_each_animation(vlGltf *g, bool (*visit)(vlGltf *g, size_t index));
bool vl_gltf_pose_nodes(vlGltf *g); /* world matrices of all nodes */
/* Applies the animations at a time, NaN: none, and poses all nodes. */
bool vl_gltf_pose_at(vlGltf *g, double time);
/* Poses all nodes at def->time and, for motion blur, at the key times up to def->time_close. */
bool vl_gltf_pose(vlGltf *g);
/* frame.c: gives the scene the points of the whole animation, if there is one, for an automatic
 * camera. The nodes have other poses afterwards. */
bool vl_gltf_frame_animation(vlGltf *g);
/* Whether the node's world matrix changes between shutter open and shutter close. */
bool vl_gltf_node_moves(const vlGltf *g, const vlGltfNode *node);
/* Adds the chosen scene's meshes, lights and camera. */
bool vl_gltf_draw(vlGltf *g);
/* Whether the matrix cannot be the transform of a shape: it is singular. */
bool vl_gltf_is_flat(const vlMat4 *m);
vlMat4 vl_gltf_matrix_from_trs(const double t[3], const double r[4], const double s[3]);

/* validate.c: reads what the scene does not use, and reports what is wrong there by the log.
 * Call last. */
void vl_gltf_validate(vlGltf *g);

/* unread.c: counts in the scene what the file has and velo does not read (vlScene.unread). */
bool vl_gltf_count_unread(vlGltf *g);

/* choices.c: lists the file's scenes, cameras, animations and variants. Call after
 * vl_gltf_draw. */
bool vl_gltf_list_choices(vlGltf *g);
/* The index of the element of the root's array with this name, else of this number;
 * VL_GLTF_NONE: none. */
size_t vl_gltf_find(const vlGltf *g, const char *array, const char *name);
/* Reports that there is none, with the names that are there, of `size` bytes at most, 300. */
bool vl_gltf_fail_choice(vlGltf *g, const char *what, const json_t *items, const char *name,
                         size_t size);
double vl_gltf_animation_end(const vlGltf *g, size_t animation);

/* ---- names (label.c) --------------------------------------------------------------------- */

/* Where the file describes a shape. node is VL_GLTF_NONE for a shape of a group, material for
 * the default one. */
typedef struct vlGltfShapeIndices {
  size_t node, mesh, primitive;
  size_t material;
} vlGltfShapeIndices;
/* Makes the labels of nodes and materials. */
bool vl_gltf_make_labels(vlGltf *g);
/* The scene owns the strings of the label. */
bool vl_gltf_label_shape(vlGltf *g, const vlGltfShapeIndices *at, vlLabel *label);
/* Labels the instance that was added last. */
void vl_gltf_label_instance(vlGltf *g, size_t node);

/* ---- meshes ------------------------------------------------------------------------------ */

/* The radius of points and lines: one pixel of an image of 720 rows, at the centre of the box
 * around the meshes of these nodes. Without a camera in the file, 0.15 % of the box's diagonal,
 * which is about a pixel of an image that shows the whole box. 0: no accessor has bounds. The
 * camera must be chosen. */
double vl_gltf_point_radius(const vlGltf *g, const uint32_t *order, size_t count);

/* Adds mesh `index` for a node. A null node, with node_index VL_GLTF_NONE, adds the mesh to a
 * group, in the mesh's own space. */
bool vl_gltf_add_mesh(vlGltf *g, size_t index, const vlGltfNode *node, size_t node_index,
                      vlGroupId group, vlMat4 pose);
/* Grows the box by the primitives of the mesh as the node poses it. */
bool vl_gltf_mesh_box(vlGltf *g, size_t mesh, const vlGltfNode *node, vlExtent *box);
/* The node's mesh; VL_GLTF_NONE: it has none. */
size_t vl_gltf_mesh_of(const vlGltf *g, const vlGltfNode *node);
/* Whether the node deforms its mesh by a skin or morph targets. */
bool vl_gltf_deforms(const vlGltf *g, const vlGltfNode *node);
/* topology.c: turns the primitive's indices (0, 1, 2, ... if it has none) into triangles,
 * according to its mode. Points and lines become small solids with new vertices. */
bool vl_gltf_triangles(vlGltf *g, const vlGltfLocation *at, uint32_t mode, uint32_t *indices,
                       size_t count, vlMesh *p);
/* Removes the vertices that no face uses. */
bool vl_gltf_compact(vlGltf *g, vlMesh *p);
/* deform.c: applies morph targets and skins. */
bool vl_gltf_morph(vlGltf *g, const vlGltfLocation *at, const json_t *mesh,
                   const vlGltfNode *node, vlMesh *p);
/* Transforms the positions to world space. */
bool vl_gltf_skin(vlGltf *g, const vlGltfLocation *at, const vlGltfNode *node, vlMesh *p);
/* tangent.c: MikkTSpace tangents for uv set `set`, and flat normals where the primitive has
 * none. Vertices are split where tangents differ. */
bool vl_gltf_make_tangents(vlGltf *g, uint32_t set, vlMesh *p);

/* ---- materials --------------------------------------------------------------------------- */

/* The material `index` (VL_GLTF_NONE: the default material) for a primitive with or without
 * vertex colours. Null after an error. */
const vlGltfMaterial *vl_gltf_material(vlGltf *g, size_t index, bool colors);
/* How a material uses a texture. */
typedef struct vlGltfTextureUse {
  bool spectrum;
  int channel;   /* 0 to 3 for a float texture; -1: a colour */
  bool srgb;     /* the image's colour channels are sRGB */
  float tint[4]; /* factors of the channels */
  bool colors;   /* multiplied by the vertex colour */
  float bias;    /* float textures only: value = bias + tint * channel */
  double cutoff; /* unless unset: the value becomes 1 from the cutoff on and 0 below it */
} vlGltfTextureUse;
vlGltfTextureUse vl_gltf_use_color(void);
vlGltfTextureUse vl_gltf_use_channel(int channel, float factor);
/* Adds the texture of the textureInfo object `key`. Without one id->index is 0. */
bool vl_gltf_texture(const vlGltfLocation *at, const char *key, const vlGltfTextureUse *use,
                     vlTextureId *id);
/* Decodes an image of bytes in memory or of a file. False after an error, at the location. */
bool vl_gltf_decode_image(vlGltf *g, const vlGltfLocation *at, const char *name,
                          const void *data, size_t size, const char *path, vlImage **image);
/* The bytes or the path of images[index]. */
bool vl_gltf_read_image(vlGltf *g, size_t index);
/* The uv set of a textureInfo; the one of KHR_texture_transform takes precedence. */
bool vl_gltf_texture_set(vlGltf *g, const vlGltfLocation *at, uint32_t *set);

/* volume.c: vl_gltf_volume reads KHR_materials_volume of a solid. vl_gltf_angle_texture
 * converts a texture of directions to a texture of angles in radians and adds rotation. */
bool vl_gltf_volume(vlGltf *g, const vlGltfLocation *at, vlGltfMaterial *result);
bool vl_gltf_angle_texture(vlGltf *g, vlTextureId from, float rotation, vlFloatInput *input);

/* ---- lights, cameras --------------------------------------------------------------------- */

/* Adds the node's light of KHR_lights_punctual and its lamp of EXT_lights_ies, if it has
 * them. */
bool vl_gltf_add_lights(vlGltf *g, size_t node);
bool vl_gltf_image_light(vlGltf *g, const json_t *scene, const vlGltfLocation *at);
bool vl_gltf_choose_camera(vlGltf *g);
/* Moves *node to the next node from it on that the scene reaches and that has a camera, which
 * *camera receives; to the number of nodes after the last one. */
bool vl_gltf_next_camera(vlGltf *g, size_t *node, size_t *camera);
/* Reads a camera that no node has. The scene's own camera is replaced. */
bool vl_gltf_check_camera(vlGltf *g, size_t index);

#endif
