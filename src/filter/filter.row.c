/* filter/filter.row.c: the family of pixel filters: the list of its rows, each from the file of
 * its kind. */
#include "filter/filter.row.h"

#include "filter/kinds.row.h"
#include "velo/filter_kinds.h"

VL_PIXEL_FILTER_FUNCTIONS(VL_DECLARE_ROW)
const vlKindFamily vl_pixel_filter_family =
    VL_KIND_FAMILY(VL_PIXEL_FILTER_FUNCTIONS(VL_LIST_ROW), VL_PIXEL_FILTER_KINDS, "filters",
                   "pixel filter", "PixelFilter");

vlPixelFilter vl_default_pixel_filter(vlPixelFilterKind kind) {
  vlPixelFilter filter = {.kind = kind};
  vl_kind_set_defaults(&vl_pixel_filter_family, (int)kind, &filter);
  return filter;
}
