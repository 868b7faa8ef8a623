/* material/material.row.c: the family of materials: the list of its rows, each from the file of
 * its kind. */
#include "material/material.row.h"

#define ROW(NAME, name) [VL_MATERIAL_##NAME] = &vl_material_row_##name,
VL_KIND_FAMILY(vl_material_family, VL_MATERIAL_KINDS, ROW, "materials", "material", "Material")
