/* image/check_pixel.c: checks of one pixel's ground truth with itself and with the camera. */
#include <math.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/vector.h"
#include "image/check.h"

/* Where a pixel shows nothing, ids and vectors are 0, distances infinite, and the ray is the
 * camera's. */
static void check_miss(Check *c, bool in_domain, const double direction[3]) {
  double wrong = 0, v[3];
  const int ids[] = {c->object, c->material, c->primitive, c->instance};
  const int vectors[] = {c->p, c->n, c->ng};
  for (size_t i = 0; i < LENGTH(ids); i++)
    if (ids[i] >= 0 && c->pixel[ids[i]] != 0)
      wrong = INFINITY;
  for (size_t i = 0; i < LENGTH(vectors); i++) {
    if (vectors[i] < 0)
      continue;
    check_load3(c, vectors[i], v);
    if (vector_length(v) != 0)
      wrong = INFINITY;
  }
  if (c->z >= 0 && c->pixel[c->z] != INFINITY)
    wrong = INFINITY;
  if (c->distance >= 0 && c->pixel[c->distance] != INFINITY)
    wrong = INFINITY;
  check_note(c, RULE_NOTHING, wrong);
  if (c->ray < 0)
    return;
  check_load3(c, c->ray, v);
  if (in_domain)
    vector_subtract(v, direction, v);
  check_note(c, RULE_RAY, vector_length(v));
}

/* How far the point is from where the pixel's row sees it; relative to the image's size. */
static void check_row(Check *c, const double p[3]) {
  vlCamera row;
  double pixel[2], z, error = INFINITY;
  header_row_camera(&c->rolling, c->x, c->y, &row);
  if (vl_camera_project(&row, p, pixel, &z))
    error = hypot(pixel[0] - c->point[0], pixel[1] - c->point[1]);
  check_note(c, RULE_ROWS, error / fmax(row.width, row.height));
}

/* Checks the point that the pixel shows: P against the distance along the ray, depth against
 * the camera, the projection against the film point. Errors are relative to the largest number
 * involved, which bounds the rounding of floats. */
static void check_point(Check *c, const double origin[3], const double direction[3]) {
  double p[3], ray[3];
  const double t = c->distance >= 0 ? c->pixel[c->distance] : 0;
  if (c->ray >= 0)
    check_load3(c, c->ray, ray);
  else
    memcpy(ray, direction, sizeof ray);
  if (c->p >= 0)
    check_load3(c, c->p, p);
  else
    vector_along(origin, t, ray, p);
  if (c->p < 0 && c->distance < 0)
    return;
  double away[3];
  vector_subtract(p, origin, away);
  double size = fmax(fmax(vector_length(p), vector_length(origin)), vector_length(away));
  if (c->p >= 0 && c->distance >= 0) {
    double off[3];
    vector_along(origin, t, ray, off);
    vector_subtract(p, off, off);
    check_note(c, RULE_POINT, vector_length(off) / size);
  }
  double pixel[2], z;
  bool seen = vl_camera_project(&c->camera, p, pixel, &z);
  if (c->z >= 0) {
    const double *row = c->camera.camera_from_world + 8;
    double scale = vector_length(row);
    z = vector_dot(row, p) + row[3];
    check_note(c, RULE_DEPTH, fabs(c->pixel[c->z] - z) / (scale * size));
  }
  if (c->rows == ROWS_UNKNOWN)
    check_row(c, p);
  double error = seen ? hypot(pixel[0] - c->point[0], pixel[1] - c->point[1]) : INFINITY;
  if (error > c->pixel_error)
    c->pixel_error = error;
  double larger = c->camera.width > c->camera.height ? c->camera.width : c->camera.height;
  check_note(c, RULE_PIXEL, error / larger * fmin(1, vector_length(away) / size));
}

/* Checks channels that only have to be finite, and reads the film point. */
static void check_plain(Check *c) {
  const int channels[] = {c->uv, c->albedo}, counts[] = {2, 3};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < counts[i] && channels[i] >= 0; k++)
      check_that(c, RULE_FINITE, isfinite(c->pixel[channels[i] + k]));
  for (int k = 0; k < 3 && c->error >= 0; k++) /* infinity: too few samples */
    check_that(c, RULE_FINITE, c->pixel[c->error + k] >= 0);
  if (c->samples >= 0 && c->spp > 0) {
    double more = (double)c->pixel[c->samples] - c->spp;
    check_note(c, RULE_SAMPLES, (c->adaptive ? fmax(more, 0) : fabs(more)) / c->spp);
  }
  if (c->film < 0)
    return;
  for (int k = 0; k < 2; k++) {
    double over = fabs((double)c->pixel[c->film + k] - 0.5) - c->reach[k];
    check_note(c, RULE_FILM, isnan(over) ? INFINITY : fmax(over, 0));
  }
}

/* All pixels of a shape must have the same material. */
static void check_material_of(Check *c) {
  if (c->object < 0 || c->material < 0 || !c->material_of)
    return;
  float object = c->pixel[c->object], material = c->pixel[c->material];
  if (!(object >= 1 && object < CHECK_OBJECTS))
    return;
  uint32_t *known = &c->material_of[(uint32_t)object];
  if (!*known)
    *known = (uint32_t)material;
  check_that(c, RULE_IDS, (double)*known == (double)material);
}

static void check_id(Check *c, float id, float min) {
  check_that(c, RULE_IDS, id >= min && floorf(id) == id);
}

void check_pixel(Check *c) {
  if (c->rows == ROWS_EACH)
    header_row_camera(&c->rolling, c->x, c->y, &c->camera);
  c->point[0] = c->x + (c->film >= 0 ? (double)c->pixel[c->film] : 0.5);
  c->point[1] = c->y + (c->film >= 0 ? (double)c->pixel[c->film + 1] : 0.5);
  check_plain(c);
  check_mattes(c);
  if (c->other)
    check_flow(c);
  double origin[3] = {0, 0, 0}, direction[3] = {0, 0, 0}, v[3];
  bool in_domain = vl_camera_unproject(&c->camera, c->point[0], c->point[1], origin, direction);
  if (!check_is_hit(c)) {
    c->misses++;
    check_miss(c, in_domain, direction);
    return;
  }
  c->hits++;
  if (c->ray >= 0) {
    check_load3(c, c->ray, v);
    vector_subtract(v, direction, v);
    check_note(c, RULE_RAY, in_domain ? vector_length(v) : INFINITY);
  }
  check_material_of(c);
  check_point(c, origin, direction);
  if (c->n >= 0) {
    check_load3(c, c->n, v);
    check_note(c, RULE_UNIT_N, fabs(vector_length(v) - 1));
  }
  if (c->ng >= 0) {
    check_load3(c, c->ng, v);
    check_note(c, RULE_UNIT_NG, fabs(vector_length(v) - 1));
  }
  const int ids[] = {c->object, c->material, c->primitive, c->instance};
  for (size_t i = 0; i < LENGTH(ids); i++)
    if (ids[i] >= 0)
      check_id(c, c->pixel[ids[i]], ids[i] == c->instance ? 0 : 1);
}
