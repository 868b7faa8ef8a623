/* material/material.row.c: the family of materials: the list of its rows, each from the file of
 * its kind. */
#include "material/material.row.h"

#include "base/cookie.h"
#include "material/kinds.row.h"

VL_MATERIAL_FUNCTIONS(VL_DECLARE_ROW)
static const vlKindRow *const rows[] = {VL_MATERIAL_FUNCTIONS(VL_LIST_ROW)};
const vlKindFamily vl_material_family =
    VL_KIND_FAMILY(rows, VL_MATERIAL_KINDS, "materials", "material", "Material");

vlMaterialDef vl_default_material_def(vlMaterialKind kind) {
  vlMaterialDef def = {.cookie = VL_COOKIE_MATERIAL, .kind = kind};
  vl_kind_set_defaults(&vl_material_family, (int)kind, &def);
  return def;
}
