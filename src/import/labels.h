/* import/labels.h: unique names for the shapes, materials and instances of a file. */
#ifndef IMPORT_LABELS_H
#define IMPORT_LABELS_H

#include "import/names.h"
#include "scene/scene.h"

enum { VL_LABEL_PART = 120, VL_LABEL_SIZE = 1000 };

/* Appends a name to a path, after a / if the path is not empty. A long name is cut between
 * characters; a name that does not fit is omitted. A null or empty name changes nothing. */
void vl_label_append(char path[VL_LABEL_SIZE], const char *name);
/* *result receives the name if the table does not have it, else name#number, else
 * name#number.2, name#number.3, ... The scene owns the result, and the table has it afterwards.
 * False if memory is exhausted (reported). */
bool vl_label_make_unique(vlScene *scene, vlNameTable *table, const char *name, size_t number,
                          const char **result);
/* The name of a file without folder and suffix. */
void vl_label_of_file(const char *path, char name[VL_LABEL_SIZE]);

#endif
