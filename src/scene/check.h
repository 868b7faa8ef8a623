/* scene/check.h: declarations shared by the parts of the scene check (check*.c). Each part reads the description once
 * and adds findings; the scene is not changed. Findings are in the order of the scene's objects, independent of
 * threads. */
#ifndef SCENE_CHECK_H
#define SCENE_CHECK_H

#include "scene/scene.h"
#include "velo/check.h"

struct vlCheck {
  vlContext *context;
  const vlScene *scene;
  vlCheckDef def;
  VL_ARRAY(vlFinding) findings; /* each message is its own block */
  bool no_memory;
  /* Whether shapes, lights and instances use the object; index id - 1. */
  uint8_t *texture_used, *material_used, *medium_used, *group_used, *emission_used;
};

void vl_check_add(vlCheck *check, vlFindingKind kind, vlSeverity severity, vlSource source, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* The parts. */
typedef void vlCheckPart(vlCheck *check);
/* vl_scene_check, with one part more that looks at what the scene will become (api/check_coats.c). */
vlResult vl_check_make(const vlScene *scene, const vlCheckDef *def, vlCheckPart *more, vlCheck **check, vlError *error);
void vl_check_names(vlCheck *check);  /* unused and replaced names; fills the used arrays */
void vl_check_images(vlCheck *check); /* files, albedo, lights without power */
void vl_check_meshes(vlCheck *check); /* degenerate faces, missing uvs, open and inverted solids */
void vl_check_inside(vlCheck *check); /* the camera inside solids, nesting of media */

/* ---- helpers ------------------------------------------------------------------------------------------------------
 */

/* The material of a shape; null: the default diffuse. */
static inline const vlMaterialDef *vl_check_material(const vlCheck *check, vlMaterialId id) {
  return id.index ? &check->scene->materials.items[id.index - 1] : NULL;
}
/* The textures that a material reads directly, at most VL_CHECK_INPUTS (0: none). */
enum { VL_CHECK_INPUTS = 48 };
uint32_t vl_check_material_inputs(const vlMaterialDef *m, vlTextureId inputs[VL_CHECK_INPUTS]);
/* The textures that a texture reads directly. */
uint32_t vl_check_texture_inputs(const vlTextureDef *t, vlTextureId inputs[VL_CHECK_INPUTS]);
/* Name for a message: "material \"glass\"", "the default material", "the material of line 3". */
typedef struct vlCheckName {
  char text[120];
} vlCheckName;
vlCheckName vl_check_material_name(const vlMaterialDef *m);
vlCheckName vl_check_texture_name(const vlTextureDef *t);

#endif
