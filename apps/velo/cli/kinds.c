/* cli/kinds.c: see kinds.h. */
#include "cli/kinds.h"

#include <string.h>

#include "cli/macros.h"
#include "velo/camera_file.h"
#include "velo/render.h"

enum { MAX_FAMILIES = 16, MAX_CHOICES = 64 };

static const char *dialect_name(uint32_t index) {
  return vl_camera_dialect_name((vlCameraDialect)index);
}

/* Lists that are no families: each has a function from its numbers to its names. */
static const struct {
  const char *name;
  const char *(*of)(uint32_t index); /* null: there are no more */
  uint32_t first;
} name_lists[] = {{"sensors", vl_sensor_name, 0},
                  {"dialects", dialect_name, VL_CAMERA_DIALECT_AUTO + 1}};
enum { NAME_LISTS = LENGTH(name_lists) };

/* Null: it is a family. */
static const Choice *listed_names(const char *list) {
  static Choice choices[NAME_LISTS][MAX_CHOICES];
  const char *name;
  for (int k = 0; k < NAME_LISTS; k++) {
    const uint32_t first = name_lists[k].first;
    if (strcmp(name_lists[k].name, list) != 0)
      continue;
    for (uint32_t i = 0; i + 1 < MAX_CHOICES && (name = name_lists[k].of(first + i)); i++)
      choices[k][i] = (Choice){name, (int)(first + i)};
    return choices[k];
  }
  return NULL;
}

static void fill(const vlKindFamily *family, const Choice *more, Choice *choices) {
  int n = 0;
  for (uint32_t i = 0; i < family->kind_count && n + 2 < MAX_CHOICES; i++) {
    if (family->rows[i]->name)
      choices[n++] = (Choice){family->rows[i]->name, (int)i};
    if (family->rows[i]->alias)
      choices[n++] = (Choice){family->rows[i]->alias, (int)i};
  }
  for (; more->name && n + 1 < MAX_CHOICES; more++)
    choices[n++] = *more;
}

const Choice *kind_choices(const Choice *list) {
  /* Zero-initialised, so that each list ends with zeros. By family: first without, then with
   * further names; the last list stays empty, for unknown families. */
  static Choice choices[2 * MAX_FAMILIES + 1][MAX_CHOICES];
  const vlKindFamily *family;
  const Choice *names = listed_names(list->name);
  if (names)
    return names;
  for (uint32_t i = 0; i < MAX_FAMILIES && (family = vl_kind_family(i)); i++) {
    if (strcmp(family->name, list->name) != 0)
      continue;
    Choice *own = choices[list[1].name ? MAX_FAMILIES + i : i];
    if (!own[0].name)
      fill(family, list + 1, own);
    return own;
  }
  return choices[2 * MAX_FAMILIES];
}

const char *kind_name(const char *name, int kind) {
  const vlKindFamily *family = vl_kind_family_find(name);
  const char *found = family && kind >= 0 && (uint32_t)kind < family->kind_count
                          ? family->rows[kind]->name
                          : NULL;
  return found ? found : "?";
}
