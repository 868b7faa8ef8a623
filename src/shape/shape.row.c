/* shape/shape.row.c: the family of shapes: the list of its rows, each from the file of its
 * kind; boxes. */
#include "shape/shape.row.h"

#include <math.h>

#include "base/cookie.h"
#include "shape/kinds.row.h"
#include "velo/shape_kinds.h"

#define DECLARE(kind, row, box, functions) \
  extern const vlKindRow row;              \
  vlShapeBox box;
VL_SHAPE_FUNCTIONS(DECLARE)

/* Each kind has a line in kinds.row.h: the compiler names the one that is not listed. */
#define LISTED(kind, row, box, functions) LISTED_##kind = kind,
enum { VL_SHAPE_FUNCTIONS(LISTED) };
#define IS_LISTED(kind, name) _Static_assert((int)LISTED_##kind == (int)kind, #name);
VL_SHAPE_KINDS(IS_LISTED)

const vlKindFamily vl_shape_family =
    VL_KIND_FAMILY(VL_SHAPE_FUNCTIONS(VL_LIST_ROW), VL_SHAPE_KINDS, "shapes", "shape", "Shape");

#define BOX(kind, row, box, functions) [kind] = box,
static vlShapeBox *const box_of[] = {VL_SHAPE_FUNCTIONS(BOX)};

void vl_shape_box_round(const vlShapeDef *def, double z0, double z1, double low[3],
                        double high[3]) {
  const double r = def->radius;
  low[0] = low[1] = -r;
  low[2] = z0;
  high[0] = high[1] = r;
  high[2] = z1;
}

void vl_shape_box_points(const vlShapeDef *def, double low[3], double high[3]) {
  for (int k = 0; k < 3; k++) {
    low[k] = (double)INFINITY;
    high[k] = -(double)INFINITY;
  }
  for (size_t i = 0; i < def->vertices; i++)
    for (int k = 0; k < 3; k++) {
      double x = def->positions[3 * i + (size_t)k];
      low[k] = x < low[k] ? x : low[k];
      high[k] = x > high[k] ? x : high[k];
    }
}

void vl_shape_own_box(const vlShapeDef *def, double low[3], double high[3]) {
  box_of[def->kind](def, low, high);
}

bool vl_shape_is_mesh(uint32_t kind) {
  const vlKindRow *row = vl_kind_row(&vl_shape_family, (int)kind);
  return row && (row->traits & VL_SHAPE_TRAIT_MESH) != 0;
}

vlShapeDef vl_default_shape_def(vlShapeKind kind) {
  vlShapeDef def = {.cookie = VL_COOKIE_SHAPE, .kind = kind, .times = {0.0, 1.0}};
  vl_family_set_defaults(&vl_shape_family, (int)kind, &def);
  for (int i = 0; i < 16; i += 5)
    def.group_from_shape[i] = 1.0;
  return def;
}
