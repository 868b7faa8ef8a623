/* render/channels_form.c: ids and counts in a form that other programs display
 * (docs/ground-truth.md, "In other programs"). */
#include "cli/report.h"
#include "render/channels.h"
#include "velo/header.h"

vlResult channels_make_visible(vlImage **ids) {
  if (!*ids)
    return VL_OK;
  vlImage *shown = NULL;
  vlResult result = vl_image_show_ids(*ids, &shown);
  if (result != VL_OK)
    return result;
  if (vl_image_type(shown) == VL_PIXEL_U32)
    report_note("ids of 2^24 and more are written as integers, which not every program shows");
  vl_image_destroy(*ids);
  *ids = shown;
  return VL_OK;
}
