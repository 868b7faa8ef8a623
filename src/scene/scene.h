/* scene/scene.h: the scene description as stored: plain arrays of the public defs. Each def is
 * a deep copy, and the scene owns what its pointers point at. The object with id i is items[i -
 * 1] of its array. The room `import` fills the arrays through the vl_scene_add_* functions, and
 * the room `world` reads them. This room compiles nothing and reads no files. */
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/array.h"
#include "base/cancel.h"
#include "base/context.h"
#include "base/error.h"
#include "velo/check.h"
#include "velo/edit.h"
#include "velo/load.h"
#include "velo/render.h"
#include "velo/schema.h"

typedef struct vlSceneGroup {
  uint32_t shape_count; /* number of shapes in the group */
  const char *name;     /* never null, may be empty */
} vlSceneGroup;

typedef struct vlSceneInstance {
  vlGroupId group;
  double world_from_group[16]; /* pose at the first key */
  vlSource source;
  vlLabel label;
  uint32_t keys; /* number of keys of the motion; 0: no motion */
  const double *times, *poses;
  bool hidden, removed;
  uint64_t serial; /* of one with the id of a removed one: its number; else 0 */
} vlSceneInstance;

/* What vl_scene_set_* has allocated for an object; freed when the object is set again. */
typedef struct vlSceneEdit {
  vlSceneFamily family; /* of the object */
  uint32_t id;
  void *block; /* one of the two is null */
  vlImage *image;
} vlSceneEdit;

/* The state of an object besides its def. Objects that were never changed have no mark. */
typedef struct vlSceneMark {
  uint64_t generation; /* 0: as added; each vl_scene_set_* gives a new number */
  uint64_t serial;     /* of an object with the id of a removed one: its number; else 0 */
  bool hidden;
  bool removed; /* its def is the default: of a shape, that of a mesh without vertices */
} vlSceneMark;
/* Element i: object of id i + 1. May be shorter than the objects. */
typedef VL_ARRAY(vlSceneMark) vlSceneMarks;

typedef struct vlSceneChoice {
  vlChoiceKind kind;
  vlChoiceInfo info;
} vlSceneChoice;

/* What the file has and the scene does not hold; exporters count it as lost. */
typedef struct vlSceneUnread {
  const char *what; /* as in vl_export_lose */
  uint64_t count;
} vlSceneUnread;

struct vlScene {
  vlContext *context;
  vlError error;        /* the first error; code VL_OK: none */
  vlProblemFn *problem; /* receives problems while loading (vl_scene_diagnose); may be null */
  void *problem_user;
  vlTask *task; /* of the load that is running; else null */
  VL_ARRAY(vlTextureDef) textures;
  VL_ARRAY(vlMaterialDef) materials;
  VL_ARRAY(vlEmissionDef) emissions;
  VL_ARRAY(vlLightDef) lights;
  VL_ARRAY(vlMediumDef) media;
  VL_ARRAY(vlShapeDef) shapes;
  VL_ARRAY(vlSceneGroup) groups;
  VL_ARRAY(vlSceneInstance) instances;
  uint64_t number; /* of this scene in its context; from 1 */
  vlSceneMarks texture_marks, material_marks, medium_marks, emission_marks, light_marks,
      shape_marks, group_marks;
  VL_ARRAY(vlSceneEdit) edits;
  VL_ARRAY(uint32_t) removed_shapes; /* ids */
  VL_ARRAY(uint32_t) removed_instances;
  vlSceneDefs defs;
  vlCompleteDef completed; /* what vl_scene_complete has added; cookie 0: it was not called */
  double framed[2][3];     /* low and high of what the camera frames that it has added */
  bool camera_read;        /* defs.camera is that of the file that was read */
  bool camera_in_full; /* vl_scene_load has read a complete camera description from the extras
                          of a glTF file */
  VL_ARRAY(vlAperture *) apertures; /* aperture objects to which defs.camera may point */
  VL_ARRAY(vlOptics *) optics;
  /* Memory of everything that the stored defs point at (strings, spectra, meshes). It is freed
   * with the scene. */
  VL_ARRAY(void *) blocks;
  VL_ARRAY(vlImage *) images;
  /* File names of all vlSource, each stored once. The strings are among the blocks. */
  VL_ARRAY(const char *) files;
  VL_ARRAY(vlSceneChoice) choices; /* in the order of the file */
  /* World points (3 numbers each) that an automatic camera frames in place of the shapes: those
   * of a whole animation. */
  VL_ARRAY(double) frame_points;
  VL_ARRAY(vlSceneUnread) unread;
  const char *copyright; /* of the file, for those that are written from it; null: none */
  /* numbers of meshes that the importer deformed by a skin, by morph targets */
  uint32_t skinned, morphed;
  bool meshes_dropped; /* vl_scene_drop_meshes has freed the arrays of the shapes */
};

/* X(array) for all arrays of vlScene. */
#define VL_SCENE_ARRAYS(X) \
  X(textures)              \
  X(materials)             \
  X(emissions)             \
  X(lights)                \
  X(media)                 \
  X(shapes)                \
  X(groups)                \
  X(instances)             \
  X(texture_marks)         \
  X(material_marks)        \
  X(emission_marks)        \
  X(group_marks)           \
  X(light_marks)           \
  X(medium_marks)          \
  X(shape_marks)           \
  X(edits)                 \
  X(removed_shapes)        \
  X(removed_instances)     \
  X(apertures)             \
  X(optics)                \
  X(blocks)                \
  X(images)                \
  X(files)                 \
  X(choices)               \
  X(frame_points)          \
  X(unread)

static inline vlSceneMark vl_scene_mark(const vlSceneMarks *marks, size_t index) {
  return index < marks->count ? marks->items[index] : (vlSceneMark){0};
}
/* Whether the light with this index was removed. */
static inline bool vl_scene_light_is_removed(const vlScene *scene, size_t index) {
  return vl_scene_mark(&scene->light_marks, index).removed;
}
/* The number of removed objects among those that have these marks. */
static inline uint32_t vl_scene_removed_count(const vlSceneMarks *marks) {
  uint32_t count = 0;
  for (size_t i = 0; i < marks->count; i++)
    count += marks->items[i].removed;
  return count;
}
/* Whether the shape with this index was removed. */
static inline bool vl_scene_shape_is_removed(const vlScene *scene, size_t index) {
  return vl_scene_mark(&scene->shape_marks, index).removed;
}

/* Whether the coat of this material has a closed form. It has one if the base is diffuse, the
 * layer does not scatter, and its thickness is constant. */
bool vl_coat_in_closed_form(const vlMaterialDef *def);
/* Whether it is a principled material that transmits light. */
bool vl_principled_transmits(const vlMaterialDef *def);

/* Stores the error in the scene if it is the first one. Returns false. */
bool vl_scene_fail(vlScene *scene, vlResult code, vlSource source, const char *format, ...)
    VL_PRINTF(4, 5);
/* The same for memory that is exhausted. */
bool vl_scene_fail_memory(vlScene *scene);

/* True: the load that is running must stop; the scene then has the error CANCELLED. fraction:
 * as in vlStep. */
bool vl_scene_stopped(vlScene *scene, double fraction);

/* Adds a shape without copying its mesh arrays. The arrays are memory blocks of the scene's
 * context (vl_alloc*), or null. On success the scene owns them; on failure they are freed. */
vlShapeId vl_scene_adopt_shape(vlScene *scene, const vlShapeDef *def);

/* The arrays of a shape: those that are null, too. */
enum { VL_SHAPE_ARRAYS = 15 };
void vl_shape_arrays(const vlShapeDef *def, const void *arrays[VL_SHAPE_ARRAYS]);
/* Sets all arrays of a mesh to null but its positions and normals. */
void vl_shape_drop_attributes(vlShapeDef *def);
/* Frees what the changes of an object have allocated (edit.c): the first `end` entries of
 * scene->edits, as far as they are those of this id in the family. */
void vl_scene_free_edits(vlScene *scene, vlSceneFamily family, uint32_t id, size_t end);
/* The mark of the object with this id; null: out of memory. */
vlSceneMark *vl_scene_mark_of(vlScene *scene, vlSceneMarks *marks, uint32_t id);
/* Gives an object a new generation; a removed one is there again. */
void vl_scene_note_change(vlScene *scene, vlSceneMark *mark);
/* Frees the blocks, images and lenses that the scene owns beyond these numbers of them. */
typedef struct vlSceneCounts {
  size_t blocks, images, apertures, optics;
} vlSceneCounts;
void vl_scene_free_beyond(const vlScene *scene, vlSceneCounts counts);
/* Frees those of the scene's blocks that are in a list. */
void vl_scene_free_blocks(vlScene *scene, const void *const *own, int count);
/* Takes an id out of the list of removed shapes. */
void vl_scene_forget_removed_shape(vlScene *scene, uint32_t id);
/* Whether a texture or a light has this image. */
bool vl_scene_image_is_used(const vlScene *scene, const vlImage *image);

/* Whether a shape can be an area light. */
bool vl_shape_may_emit(const vlShapeDef *def);

/* Adds a choice of the file; the name is copied and may be null. False if memory is exhausted
 * (reported). */
bool vl_scene_add_choice(vlScene *scene, vlChoiceKind kind, const char *name, double seconds);

/* Gives the instance that was added last a label. */
void vl_scene_label_instance(vlScene *scene, const vlLabel *label);

/* Frees the arrays of meshes after a world has copied them. Does nothing if memory for its list
 * is exhausted. */
void vl_scene_drop_meshes(vlScene *scene);

/* Like vl_scene_add_texture, but the scene already owns the image (def->image, def->data), so
 * it is not copied. */
vlTextureId vl_scene_adopt_texture(vlScene *scene, const vlTextureDef *def);

/* Reports the error "what: why". Returns false. */
bool vl_scene_reject(vlScene *scene, vlSource source, const char *what, const char *why);

/* Checks the members that the row describes: ranges, finite numbers, choices, existence and
 * type of textures. Then replaces what they point at with copies owned by the scene, except for
 * parameters of type BLOCK, which the caller copies. spectrum: whether a parameter of type
 * EITHER_INPUT is read as a spectrum or as a number. On an error it calls vl_scene_fail with a
 * message that names `what`, the parameter, its value and range, and returns false. */
bool vl_row_take(vlScene *scene, const vlKindRow *row, void *def, bool spectrum,
                 vlSource source, const char *what);

/* Deep copies (scene/copy.c). If memory is exhausted, they report VL_ERROR_MEMORY by
 * vl_scene_fail and return false. */
bool vl_scene_own(vlScene *scene, void *block);
bool vl_scene_copy_block(vlScene *scene, const void *data, size_t count, size_t size,
                         void *result_pointer);
/* pointer: address of the pointer to the array, which becomes that of the copy. */
bool vl_scene_copy_array(vlScene *scene, void *pointer, size_t count, size_t size);
bool vl_scene_copy_string(vlScene *scene, const char **text);
bool vl_scene_copy_label(vlScene *scene, vlLabel *label);
bool vl_scene_copy_source(vlScene *scene, vlSource *source);
bool vl_scene_copy_image(vlScene *scene, const vlImage **image);

/* The number of lights from points of the scene, whose unit is the candela, and of emissions of
 * a given power. */
size_t vl_scene_lamps(const vlScene *scene);
/* A unit of the scene is `metres` long: candela and lumens of the lights and emissions from
 * first_light and first_emission on give the light that they give in metres. What is far away,
 * and what is given as luminance or illuminance, does not change. */
void vl_scene_state_unit(vlScene *scene, size_t first_light, size_t first_emission,
                         double metres);

#endif
