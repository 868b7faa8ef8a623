/* distortion/distortion.row.c: the table of the distortions' rows, each from the file of its
 * kind. */
#include "distortion/distortion.row.h"

#include "base/text.h"
#include "distortion/kinds.row.h"
#include "velo/distortion.h"

#define DECLARE(kind, row, compile) extern const vlDistortionRow row;
VL_DISTORTION_FUNCTIONS(DECLARE)

#define ROW(kind, row, compile) [kind] = &row,
static const vlDistortionRow *const rows[] = {VL_DISTORTION_FUNCTIONS(ROW)};
enum { KINDS = VL_LENGTH(rows) };

const vlDistortionRow *vl_distortion_row(vlDistortion kind) {
  return kind < KINDS ? rows[kind] : NULL;
}

const char *vl_distortion_name(vlDistortion distortion) {
  const vlDistortionRow *row = vl_distortion_row(distortion);
  if (!row)
    return "unknown";
  return row->header_name ? row->header_name : row->name;
}

#define NAME(kind, name) #name,
const char *const vl_distortion_names[] = {VL_DISTORTION_KINDS(NAME) NULL};
