/* base/text.h: names and paths. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include "velo/base.h"

/* The accepted name nearest to `name` by edit distance (case ignored), or null when none is near enough (more than a
 * third of the letters wrong). */
const char *vl_nearest_name(const char *name, const char *const *names, size_t count);
/* Edit distance with transpositions; case ignored. */
uint32_t vl_edit_distance(const char *a, const char *b);
/* What a refusal ends with: `; the nearest is "NAME"`, or, where none is near, `; known are A, B, C`. */
void vl_tell_names(char *text, size_t size, const char *name, const char *const *names, size_t count);
/* Adds a name to a list that an error tells: ": first, second, third". One that does not fit is left out. */
void vl_list_name(char *list, size_t size, const char *name);
bool vl_ends_with(const char *text, const char *suffix); /* case ignored */
/* result = directory of `base` + name, unless name is absolute. false: did not fit. */
bool vl_path_join(const char *base_file, const char *name, char *result, size_t size);

#endif
