/* scene/family.h: one row for each family of objects of a scene (velo/edit.h): where its array
 * is, what its defs refer to, and what they own. What is the same for all families goes by the
 * row. An index is that of an id: the object lies at index - 1. */
#ifndef SCENE_FAMILY_H
#define SCENE_FAMILY_H

#include "scene/scene.h"

enum { VL_SCENE_FAMILIES = VL_SCENE_INSTANCES + 1 };

/* Offsets in bytes: of the members of vlScene, then of those of the def. 0: there is no such
 * member. */
typedef struct vlSceneRow {
  const char *thing; /* one of them, in messages */
  size_t items, count, capacity;
  size_t size;               /* of an element */
  size_t marks;              /* 0: an instance holds its own state */
  const vlKindFamily *kinds; /* null: its defs have no rows */
  size_t kind;               /* 0: it has one kind */
  size_t name, source, image;
  uint32_t cookie;
  uint32_t (*add)(vlScene *scene, const void *def); /* vl_scene_add_*; null: it has no def */
} vlSceneRow;

extern const vlSceneRow vl_scene_rows[VL_SCENE_FAMILIES];

/* The number of objects in the array, removed ones included. */
size_t *vl_scene_count_of(vlScene *scene, vlSceneFamily family);
/* The object, also a removed one. Null: no such index. */
void *vl_scene_at(vlScene *scene, vlSceneFamily family, uint32_t index);
/* The object, unless it was removed. */
const void *vl_scene_item(const vlScene *scene, vlSceneFamily family, uint32_t index);
/* The marks of a family; null: of instances. */
vlSceneMarks *vl_scene_marks(vlScene *scene, vlSceneFamily family);

/* The kind of a def; 0: the family has one kind. */
int vl_scene_def_kind(vlSceneFamily family, const void *def);
/* The row of a def's kind; null: unknown, or the family has no kinds. */
const vlKindRow *vl_scene_def_row(vlSceneFamily family, const void *def);
/* Where a def of a family with kinds comes from. */
vlSource vl_scene_def_source(vlSceneFamily family, const void *def);
/* The name of a def; null: it has none. */
const char *vl_scene_def_name(vlSceneFamily family, const void *def);

/* For functions that add an object (add.c). Whether one more can be added: the scene has no
 * error, the def is not null, and its cookie is right. Otherwise it reports the reason. */
bool vl_scene_may_add(vlScene *scene, vlSceneFamily family, const void *def);
/* The same for defs of kinds. Returns the kind's row; null: it cannot be added (reported). */
const vlKindRow *vl_scene_row_to_add(vlScene *scene, vlSceneFamily family, const void *def);
/* Adds a def, which the scene owns, at the end of its array. Returns its index; 0: memory is
 * exhausted (reported). */
uint32_t vl_scene_push(vlScene *scene, vlSceneFamily family, const void *def);

/* An object that another one refers to. */
typedef struct vlSceneUse {
  vlSceneFamily family;
  uint32_t index;
} vlSceneUse;
enum { VL_SCENE_MAX_USES = 72 };
/* What a def refers to. The group of a shape is not among it: it holds the shape. */
uint32_t vl_scene_uses(vlSceneFamily family, const void *def,
                       vlSceneUse uses[VL_SCENE_MAX_USES]);

/* Blocks that a def owns. */
typedef struct vlSceneOwned {
  const void *items[128]; /* what does not fit stays with the scene */
  int count;
} vlSceneOwned;
/* Adds a block unless it is null. */
void vl_scene_own_block(vlSceneOwned *owned, const void *block);
/* The blocks of a def; those that defs may share (images, encoded files) are not among them. */
void vl_scene_owned(vlSceneFamily family, const void *def, vlSceneOwned *owned);

#endif
