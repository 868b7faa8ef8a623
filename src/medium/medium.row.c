/* medium/medium.row.c: the family of media: the list of its rows, each from the file of its
 * kind. */
#include "medium/medium.row.h"

#include "base/cookie.h"
#include "medium/kinds.row.h"

VL_MEDIUM_FUNCTIONS(VL_DECLARE_ROW)
const vlKindFamily vl_medium_family =
    VL_KIND_FAMILY(VL_MEDIUM_FUNCTIONS(VL_LIST_ROW), VL_MEDIUM_KINDS, "media", "medium type",
                   "MakeNamedMedium");

vlMediumDef vl_default_medium_def(vlMediumKind kind) {
  vlMediumDef def = {.cookie = VL_COOKIE_MEDIUM, .kind = kind};
  vl_family_set_defaults(&vl_medium_family, (int)kind, &def);
  for (int i = 0; i < 16; i += 5)
    def.world_from_medium[i] = 1.0;
  return def;
}
