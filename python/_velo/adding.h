/* _velo/adding.h: a def under construction from keywords: of an object that is added
 * (scene_add.c) or changed (scene_edit.c). */
#ifndef VELO_PYTHON_ADDING_H
#define VELO_PYTHON_ADDING_H

#include "module.h"

typedef enum Family {
  TEXTURES,
  MATERIALS,
  MEDIA,
  EMISSION,
  LIGHTS,
  SHAPES,
  GROUPS,
  INSTANCES
} Family;
extern const char *const family_names[]; /* ends with null */

typedef union Def {
  vlTextureDef texture;
  vlMaterialDef material;
  vlMediumDef medium;
  vlEmissionDef emission;
  vlLightDef light;
  vlShapeDef shape;
} Def;

enum { MAX_ARRAYS = 24, SHAPE_ARRAYS = 14 };

/* An array of a shape that is given by a keyword. */
typedef struct ShapeArray {
  const char *name;
  char type;
  size_t offset; /* of its pointer in vlShapeDef */
  size_t per;    /* numbers per element */
} ShapeArray;
extern const ShapeArray shape_arrays[SHAPE_ARRAYS];
/* The number of elements that an array of shape_arrays must have. */
size_t shape_elements(const vlShapeDef *def, int array);
/* The array itself; null: the shape has none. */
const void *shape_array(const vlShapeDef *def, int array);

typedef struct Adding {
  Scene *scene;
  PyObject *keep;
  Numbers arrays[MAX_ARRAYS];
  int array_count;
  size_t given[SHAPE_ARRAYS]; /* elements of the arrays that a shape is given; 0: none */
  const vlShapeDef *old;      /* a shape that is changed: its other arrays stay; else null */
} Adding;

/* The default def of a kind. spectrum: of a texture. */
void default_def(Family family, int kind, bool spectrum, Def *def);
/* Sets the keywords in the def. False: an exception is set. */
bool set_all(Adding *a, Family family, const vlKindRow *row, const char *thing,
             PyObject *keywords, bool spectrum, Def *def);
/* The index of a handle of this family; false with an exception. None is index 0. */
bool read_handle(const Scene *scene, PyObject *value, const char *family, const char *what,
                 uint32_t *index);
/* The family of a handle of this scene, and its index; -1 with an exception. */
int handle_family_of(const Scene *scene, PyObject *object, uint32_t *index);
/* The def of an object and its kind; false: there is none. */
bool get_def(const vlScene *scene, Family family, uint32_t index, Def *def, int *kind);
PyObject *new_handle(Scene *scene, Family family, uint32_t index);
/* The library's word for a family. */
vlSceneFamily scene_family(Family family);
/* Sets a def in the place of an object, or of a removed one. */
vlResult put_def(vlScene *scene, Family family, uint32_t index, const Def *def, vlError *error);

#endif
