/* material/material.row.c: the family of materials: the list of its rows, each from the file of
 * its kind. */
#include "material/material.row.h"

#include "base/cookie.h"

#define DECLARE(kind, name, row, compile) extern const vlKindRow row;
VL_MATERIAL_KINDS(DECLARE)
#define ROW(kind, name, row, compile) [kind] = &row,
const vlKindFamily vl_material_family = VL_KIND_FAMILY(
    VL_MATERIAL_KINDS(ROW), VL_MATERIAL_KINDS, "materials", "material", "Material");

vlMaterialDef vl_default_material_def(vlMaterialKind kind) {
  vlMaterialDef def = {.cookie = VL_COOKIE_MATERIAL, .kind = kind};
  vl_kind_set_defaults(&vl_material_family, (int)kind, &def);
  return def;
}
