/* scene/check.h: declarations shared by the parts of the scene check (check*.c). Each part
 * reads the scene description once and adds findings; it does not change the scene. Findings
 * are in the order of the scene's objects, whatever the number of threads. */
#ifndef SCENE_CHECK_H
#define SCENE_CHECK_H

#include "scene/family.h"
#include "velo/check.h"

struct vlCheck {
  vlContext *context;
  const vlScene *scene;
  vlCheckDef def;
  VL_ARRAY(vlFinding) findings; /* each message has a memory block of its own */
  bool no_memory;
  /* One flag per object, at index id - 1: whether shapes, lights or instances use it. */
  uint8_t *used[VL_SCENE_FAMILIES];
};

void vl_check_add(vlCheck *check, vlFindingKind kind, vlSeverity severity, vlSource source,
                  const char *format, ...) VL_PRINTF(5, 6);

/* The parts of the check. */
typedef void vlCheckPart(vlCheck *check);
/* Implements vl_scene_check. The extra part examines the materials as the world will compile
 * them (api/check_coats.c). */
vlResult vl_check_make(const vlScene *scene, const vlCheckDef *def, vlCheckPart *more,
                       vlCheck **check, vlError *error);
/* finds unused and replaced names; fills the arrays `used` */
void vl_check_names(vlCheck *check);
void vl_check_images(vlCheck *check); /* checks image files, albedos and the power of lights */
/* finds degenerate faces, missing uvs, open and inverted solids */
void vl_check_meshes(vlCheck *check);
void vl_check_inside(vlCheck *check); /* finds cameras inside solids, wrong media of nested
                                         solids, reversed portals */

/* ---- helpers ----------------------------------------------------------------------------- */

/* Gives the textures that a material or a texture reads directly. Returns their number. */
enum { VL_CHECK_INPUTS = 48 };
uint32_t vl_check_inputs(vlSceneFamily family, const void *def,
                         vlTextureId inputs[VL_CHECK_INPUTS]);
/* Name for a message: "material \"glass\"", "the default material", "the material of line
 * 3". */
typedef struct vlCheckName {
  char text[120];
} vlCheckName;
vlCheckName vl_check_material_name(const vlMaterialDef *m);
vlCheckName vl_check_texture_name(const vlTextureDef *t);

#endif
