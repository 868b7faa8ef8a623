/* scene/scene.h: the description as it is stored: plain arrays of the public defs, each a deep copy whose pointers
 * belong to the scene. The object with id index i is items[i - 1] of its array. `world` walks these arrays; `import`
 * fills them through the vl_scene_add_* functions. Data flows in only; nothing here is compiled or looked up in files.
 */
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include "base/array.h"
#include "base/context.h"
#include "base/error.h"
#include "velo/check.h"
#include "velo/render.h"
#include "velo/scene.h"

typedef struct vlSceneGroup {
  const char *name;     /* never null, may be empty */
  uint32_t shape_count; /* shapes whose group this is */
  uint32_t instance_count;
} vlSceneGroup;

typedef struct vlSceneInstance {
  vlGroupId group;
  double world_from_group[16]; /* at the first key */
  vlSource source;
  uint32_t keys; /* 0: at rest */
  const double *times, *poses;
} vlSceneInstance;

struct vlScene {
  vlContext *context;
  vlError error;        /* the first error; code VL_OK: none yet */
  vlProblemFn *problem; /* a doctor listens while loading, or null */
  void *problem_user;
  VL_ARRAY(vlTextureDef) textures;
  VL_ARRAY(vlMaterialDef) materials;
  VL_ARRAY(vlEmissionDef) emissions;
  VL_ARRAY(vlLightDef) lights;
  VL_ARRAY(vlMediumDef) media;
  VL_ARRAY(vlShapeDef) shapes;
  VL_ARRAY(vlSceneGroup) groups;
  VL_ARRAY(vlSceneInstance) instances;
  vlSceneDefs defs;
  bool camera_in_full;              /* a glTF file has a camera beyond glTF in its extras: vl_scene_load reads it */
  VL_ARRAY(vlAperture *) apertures; /* that defs.camera may have */
  VL_ARRAY(vlOptics *) optics;
  /* Everything the stored defs point at (strings, spectra, meshes), freed with the scene. */
  VL_ARRAY(void *) blocks;
  VL_ARRAY(vlImage *) images;
  /* File names of vlSource, each once; a subset of blocks. */
  VL_ARRAY(const char *) files;
  bool meshes_dropped; /* by vl_scene_drop_meshes: shapes have no arrays any more */
};

/* Has the coat of this material a closed form: over what is diffuse, a medium that does not scatter, one thickness? */
bool vl_coat_in_closed_form(const vlMaterialDef *def);

/* Remembers the error if it is the first; returns the code. */
vlResult vl_scene_fail(vlScene *scene, vlResult code, vlSource source, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The arrays of a mesh that may change hands instead of being copied: blocks of the scene's context (vl_alloc*), or
 * null. On success they belong to the scene, on failure they are freed. The pointers of def that equal them are the
 * ones taken. */
vlShapeId vl_scene_adopt_shape(vlScene *scene, const vlShapeDef *def);

/* Frees what meshes point at: a world has its own. Nothing happens when memory for a list is out. */
void vl_scene_drop_meshes(vlScene *scene);

/* As vl_scene_add_texture; its image (image, data) is the scene's already and is not copied. */
vlTextureId vl_scene_adopt_texture(vlScene *scene, const vlTextureDef *def);

/* Internal copying, in scene/copy.c. All return false after vl_scene_fail(MEMORY ...). */
bool vl_scene_own(vlScene *scene, void *block);
bool vl_scene_copy_block(vlScene *scene, const void *data, size_t count, size_t size, void *result_pointer);
bool vl_scene_copy_string(vlScene *scene, const char **text);
bool vl_scene_copy_source(vlScene *scene, vlSource *source);
bool vl_scene_copy_spectrum(vlScene *scene, vlSpectrum *spectrum, vlSource source, const char *what);
bool vl_scene_copy_image(vlScene *scene, const vlImage **image);

#endif
