/* filter/filter.row.c: the family of pixel filters: the list of its rows, each from the file of
 * its kind. */
#include "filter/filter.row.h"

#include "filter/kinds.row.h"
#include "velo/filter_kinds.h"

#define DECLARE(kind, row, value) extern const vlKindRow row;
VL_PIXEL_FILTER_FUNCTIONS(DECLARE)

#define ROW(kind, row, value) [kind] = &row,
static const vlKindRow *const rows[] = {VL_PIXEL_FILTER_FUNCTIONS(ROW)};
const vlKindFamily vl_pixel_filter_family =
    VL_KIND_FAMILY(rows, VL_PIXEL_FILTER_KINDS, "filters", "pixel filter", "PixelFilter");

vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind) {
  vlPixelFilter filter = {.kind = kind};
  const vlKindRow *row = vl_kind_row(&vl_pixel_filter_family, (int)kind);
  if (row)
    vl_row_set_defaults(row, &filter);
  return filter;
}
