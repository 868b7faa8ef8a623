/* cli/kinds.c: see kinds.h. */
#include "cli/kinds.h"

#include <string.h>

enum { MAX_FAMILIES = 16, MAX_CHOICES = 64 };

static void fill(const vlKindFamily *family, Choice *choices) {
  int n = 0;
  for (uint32_t i = 0; i < family->kind_count && n + 2 < MAX_CHOICES; i++) {
    if (family->rows[i]->name) choices[n++] = (Choice){family->rows[i]->name, (int)i};
    if (family->rows[i]->alias) choices[n++] = (Choice){family->rows[i]->alias, (int)i};
  }
}

const Choice *kind_choices(const char *name) {
  static Choice choices[MAX_FAMILIES][MAX_CHOICES]; /* zero-initialised, so each list ends with zeros */
  const vlKindFamily *family;
  for (uint32_t i = 0; i < MAX_FAMILIES && (family = vl_kind_family(i)); i++) {
    if (strcmp(family->name, name) != 0) continue;
    if (!choices[i][0].name) fill(family, choices[i]);
    return choices[i];
  }
  return choices[MAX_FAMILIES - 1];
}

const char *kind_name(const char *name, int kind) {
  const vlKindFamily *family = vl_kind_family_find(name);
  const char *found = family && kind >= 0 && (uint32_t)kind < family->kind_count ? family->rows[kind]->name : NULL;
  return found ? found : "?";
}
