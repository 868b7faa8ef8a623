/* scene/scene.h: the scene description as stored: plain arrays of the public defs. Each is a deep copy whose pointers
 * belong to the scene. The object with id index i is items[i - 1] of its array. `import` fills the arrays through the
 * vl_scene_add_* functions; `world` reads them. Nothing is compiled or read from files here. */
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
  uint32_t shape_count; /* number of shapes in the group */
  uint32_t instance_count;
} vlSceneGroup;

typedef struct vlSceneInstance {
  vlGroupId group;
  double world_from_group[16]; /* at the first key */
  vlSource source;
  uint32_t keys; /* 0: no motion */
  const double *times, *poses;
} vlSceneInstance;

struct vlScene {
  vlContext *context;
  vlError error;        /* the first error; code VL_OK: none */
  vlProblemFn *problem; /* receives problems while loading (vl_scene_diagnose); may be null */
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
  bool camera_in_full; /* a glTF file has velo's camera description in its extras, which vl_scene_load reads */
  VL_ARRAY(vlAperture *) apertures; /* apertures that defs.camera may use */
  VL_ARRAY(vlOptics *) optics;
  /* Everything that the stored defs point at (strings, spectra, meshes); freed with the scene. */
  VL_ARRAY(void *) blocks;
  VL_ARRAY(vlImage *) images;
  /* File names of vlSource, each stored once; a subset of blocks. */
  VL_ARRAY(const char *) files;
  bool meshes_dropped; /* by vl_scene_drop_meshes: shapes no longer have arrays */
};

/* Has the coat of this material a closed form: over what is diffuse, a medium that does not scatter, one thickness? */
bool vl_coat_in_closed_form(const vlMaterialDef *def);

/* Remembers the error if it is the first; returns the code. */
vlResult vl_scene_fail(vlScene *scene, vlResult code, vlSource source, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The mesh arrays that move to the scene instead of being copied: blocks of the scene's context (vl_alloc*), or null.
 * The scene owns them on success; on failure they are freed. The pointers of def that equal them are the ones that
 * move. */
vlShapeId vl_scene_adopt_shape(vlScene *scene, const vlShapeDef *def);

/* Frees the arrays of meshes once a world has its own. Does nothing when a list cannot be allocated. */
void vl_scene_drop_meshes(vlScene *scene);

/* As vl_scene_add_texture, but its image (image, data) is already owned by the scene and is not copied. */
vlTextureId vl_scene_adopt_texture(vlScene *scene, const vlTextureDef *def);

/* Deep copies (scene/copy.c). All return false after vl_scene_fail(MEMORY ...). */
bool vl_scene_own(vlScene *scene, void *block);
bool vl_scene_copy_block(vlScene *scene, const void *data, size_t count, size_t size, void *result_pointer);
bool vl_scene_copy_string(vlScene *scene, const char **text);
bool vl_scene_copy_source(vlScene *scene, vlSource *source);
bool vl_scene_copy_spectrum(vlScene *scene, vlSpectrum *spectrum, vlSource source, const char *what);
bool vl_scene_copy_image(vlScene *scene, const vlImage **image);

#endif
