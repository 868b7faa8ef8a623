/* projection/rows.row.c: the table of the projections' rows, each from the file of its
 * kind. */
#include "projection/rows.row.h"
#include "base/text.h"

/* Perspective cameras see 90 degrees along the smaller side; orthographic cameras see -1 to 1.
 * In both cases the focal length is half of that side in pixels. */
void vl_projection_half_side(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  (void)camera;
  focal[0] = focal[1] = 0.5 * (d->width < d->height ? d->width : d->height);
}

/* The plane's unit is a pixel. */
static void one_pixel(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  (void)d;
  (void)camera;
  focal[0] = focal[1] = 1.0;
}

static const vlProjectionRow own_row = {
    .name = "own",
    .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_FOV | VL_PROJECTION_NO_DISTORTION,
    .standard_focal = one_pixel,
};

#define ROW(kind, name, row) [kind] = &row,
static const vlProjectionRow *const rows[] = {[VL_PROJECTION_OWN] = &own_row,
                                              VL_PROJECTION_KINDS(ROW)};

const vlProjectionRow *vl_projection_row(vlProjection kind) {
  return (uint32_t)kind < VL_LENGTH(rows) ? rows[kind] : NULL;
}

const char *vl_projection_name(vlProjection projection) {
  const vlProjectionRow *row = vl_projection_row(projection);
  return row ? row->name : "unknown";
}
