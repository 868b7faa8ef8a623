/* material/material.row.c: the family of materials: the list of its rows, each from the file of
 * its kind. */
#include "material/material.row.h"

#include "base/cookie.h"
#include "material/kinds.row.h"

#define DECLARE(kind, row, compile) extern const vlKindRow row;
VL_MATERIAL_FUNCTIONS(DECLARE)

#define ROW(kind, row, compile) [kind] = &row,
static const vlKindRow *const rows[] = {VL_MATERIAL_FUNCTIONS(ROW)};
const vlKindFamily vl_material_family =
    VL_KIND_FAMILY(rows, VL_MATERIAL_KINDS, "materials", "material", "Material");

vlMaterialDef vl_default_material_def(vlMaterialKind kind) {
  vlMaterialDef def = {.cookie = VL_COOKIE_MATERIAL, .kind = kind};
  const vlKindRow *row = vl_kind_row(&vl_material_family, (int)kind);
  if (row)
    vl_row_set_defaults(row, &def);
  return def;
}
