/* import/repair.c: see repair.h. */
#include "import/repair.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/context.h"
#include "math/double3.h"
#include "velo/shape_kinds.h"

/* Also true for normals that are so short that their length is zero. */
static bool is_broken(const float n[3]) {
  float length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  return !(length > 0.0f) || !isfinite(length);
}

/* The normal of a face, as long as twice its area. */
static void face_normal(const vlShapeDef *d, const uint32_t *face, size_t per, double n[3]) {
  const float *p[4] = {NULL};
  double a[3], b[3];
  for (size_t k = 0; k < per; k++)
    p[k] = d->positions + 3 * (size_t)face[k];
  /* a patch p00 p10 p01 p11: its diagonals */
  const float *from[2] = {p[0], per == 3 ? p[0] : p[1]},
              *to[2] = {per == 3 ? p[1] : p[3], p[2]};
  for (int i = 0; i < 3; i++) {
    a[i] = (double)to[0][i] - (double)from[0][i];
    b[i] = (double)to[1][i] - (double)from[1][i];
  }
  vl_cross3(a, b, n);
}

/* 1 or -1: the side on which the sound normals of the face lie. */
static double side_of(const vlShapeDef *d, const uint32_t *face, size_t per,
                      const double n[3]) {
  double sum = 0;
  for (size_t k = 0; k < per; k++) {
    const float *v = d->normals + 3 * (size_t)face[k];
    if (!is_broken(v))
      sum += (double)v[0] * n[0] + (double)v[1] * n[1] + (double)v[2] * n[2];
  }
  return sum < 0 ? -1.0 : 1.0;
}

/* Adds the normals of the faces to the sums of their broken vertices. */
static void sum_normals(const vlShapeDef *d, size_t per, double *sums) {
  for (size_t f = 0; f < d->faces; f++) {
    const uint32_t *face = d->indices + per * f;
    bool broken = false, valid = true;
    for (size_t k = 0; k < per; k++)
      valid = valid && face[k] < d->vertices;
    for (size_t k = 0; k < per && valid; k++)
      broken = broken || is_broken(d->normals + 3 * (size_t)face[k]);
    if (!broken)
      continue;
    double n[3], side;
    face_normal(d, face, per, n);
    side = side_of(d, face, per, n);
    for (size_t k = 0; k < per; k++)
      for (size_t i = 0; i < 3 && is_broken(d->normals + 3 * (size_t)face[k]); i++)
        sums[3 * (size_t)face[k] + i] += side * n[i];
  }
}

static void set_normal(const double sum[3], float normal[3]) {
  double length = vl_norm3(sum);
  bool found = length > 0 && isfinite(length);
  for (int i = 0; i < 3; i++)
    normal[i] = found ? (float)(sum[i] / length) : i == 2 ? 1.0f : 0.0f;
}

static bool repair_normals(vlContext *context, const vlShapeDef *d, uint64_t *count) {
  float *normals;
  memcpy(&normals, &d->normals, sizeof normals); /* the def's own array */
  for (size_t v = 0; normals && v < d->vertices; v++)
    *count += is_broken(normals + 3 * v);
  if (!*count)
    return true;
  double *sums = vl_alloc_zero(context, d->vertices, 3 * sizeof *sums);
  if (!sums)
    return false;
  sum_normals(d, d->kind == VL_SHAPE_TRIANGLES ? 3 : 4, sums);
  for (size_t v = 0; v < d->vertices; v++)
    if (is_broken(normals + 3 * v))
      set_normal(sums + 3 * v, normals + 3 * v);
  vl_free(context, sums);
  return true;
}

static uint64_t repair_uvs(const vlShapeDef *d) {
  float *uvs;
  uint64_t count = 0;
  memcpy(&uvs, &d->uvs, sizeof uvs);
  for (size_t v = 0; uvs && v < d->vertices; v++) {
    if (isfinite(uvs[2 * v]) && isfinite(uvs[2 * v + 1]))
      continue;
    uvs[2 * v] = uvs[2 * v + 1] = 0.0f;
    count++;
  }
  return count;
}

bool vl_repair_mesh(vlContext *context, vlRepairs *repairs, const vlShapeDef *def) {
  uint64_t normals = 0, uvs = 0;
  if ((def->kind != VL_SHAPE_TRIANGLES && def->kind != VL_SHAPE_BILINEAR) || !def->positions ||
      !def->indices)
    return true;
  if (!repair_normals(context, def, &normals))
    return false;
  uvs = repair_uvs(def);
  if (!normals && !uvs)
    return true;
  repairs->normals += normals;
  repairs->uvs += uvs;
  if (!repairs->shapes++) {
    repairs->line = def->source.line;
    snprintf(repairs->file, sizeof repairs->file, "%s",
             def->source.file ? def->source.file : "");
  }
  return true;
}

/* ---- the report -------------------------------------------------------------------------- */

static const char *plural(uint64_t count) {
  return count == 1 ? "" : "s";
}

void vl_repairs_report(vlContext *context, const vlRepairs *r, const char *file) {
  vlError where = {0};
  snprintf(where.file, sizeof where.file, "%s", file);
  if (r->shapes) {
    vlError first = where;
    if (r->file[0]) {
      snprintf(first.file, sizeof first.file, "%s", r->file);
      first.line = r->line;
    }
    vl_log(context, VL_LOG_WARNING, &first,
           "repaired (zero or not finite): %llu normal%s, %llu uv%s in %llu shape%s, of "
           "which this is the first",
           (unsigned long long)r->normals, plural(r->normals), (unsigned long long)r->uvs,
           plural(r->uvs), (unsigned long long)r->shapes, plural(r->shapes));
  }
  if (r->images)
    vl_log(context, VL_LOG_WARNING, &where, "%u image%s missing: done without", r->images,
           r->images == 1 ? " is" : "s are");
  if (r->includes)
    vl_log(context, VL_LOG_WARNING, &where, "repaired: %u include%s beyond the limits left out",
           r->includes, plural(r->includes));
}
