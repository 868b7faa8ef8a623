/* import/pbrt/curve.c: Shape "curve". Every basis and degree becomes cubic Bezier segments.
 * Successive curves that differ only in their points become one shape (run.c), since hair is
 * described by millions of directives. */

#include <string.h>

#include "import/mesh.h"
#include "import/pbrt/builder.h"
#include "velo/shape_kinds.h"

/* Writes the Bezier control points of segment k of the curve with control points p. B-splines
 * are converted by knot insertion; degree 2 is raised to 3. */
static void bezier_points(const float *p, size_t k, bool spline, uint32_t degree,
                          float out[12]) {
  for (int i = 0; i < 3; i++) {
    const float *a = p + 3 * (spline ? k : k * degree) + i;
    double c[4] = {a[0], a[3], a[6], degree == 3 ? a[9] : 0}, q[4];
    memcpy(q, c, sizeof q);
    if (spline && degree == 3) {
      q[0] = (c[0] + 4 * c[1] + c[2]) / 6;
      q[1] = (2 * c[1] + c[2]) / 3;
      q[2] = (c[1] + 2 * c[2]) / 3;
      q[3] = (c[1] + 4 * c[2] + c[3]) / 6;
    } else if (degree == 2) {
      if (spline) {
        c[0] = 0.5 * (c[0] + c[1]);
        c[2] = 0.5 * (c[1] + c[2]);
      }
      q[0] = c[0];
      q[1] = (c[0] + 2 * c[1]) / 3;
      q[2] = (2 * c[1] + c[2]) / 3;
      q[3] = c[2];
    }
    for (int j = 0; j < 4; j++)
      out[3 * j + i] = (float)q[j];
  }
}

typedef struct Curve {
  const vlParam *points, *normals;
  size_t segments;
  bool spline;
  uint32_t degree;
  float width[2];
} Curve;

static bool append(vlImport *import, vlShapeRun *run, const Curve *c) {
  size_t n = c->segments;
  if (run->faces + n > 0x1fffffff)
    return vl_import_wrong(import, c->points->source, "too many segments of curves");
  if (!VL_RESERVE(import->context, &run->positions, 12 * n) ||
      !VL_RESERVE(import->context, &run->widths, 2 * n) ||
      (c->normals && !VL_RESERVE(import->context, &run->normals, 6 * n)))
    return vl_import_fail_memory(import);
  for (size_t k = 0; k < n; k++) {
    bezier_points(c->points->floats.items, k, c->spline, c->degree,
                  run->positions.items + run->positions.count);
    run->positions.count += 12;
    for (size_t e = 0; e < 2; e++) {
      double at = (double)(k + e) / (double)n;
      run->widths.items[run->widths.count++] =
          (float)((1 - at) * c->width[0] + at * c->width[1]);
    }
    if (!c->normals)
      continue;
    memcpy(run->normals.items + run->normals.count, c->normals->floats.items + 3 * k,
           6 * sizeof(float));
    run->normals.count += 6;
  }
  run->faces += (uint32_t)n;
  return true;
}

static bool is_finite(const vlParam *p) {
  return vl_all_finite(p->floats.items, p->floats.count);
}

static bool read_points(vlDict *dict, Curve *c) {
  if (!(c->points = vl_dict_find(dict, "P", VL_BIT_POINT3)))
    return vl_dict_missing(dict, "\"point3 P\"");
  size_t numbers = c->points->floats.count, n = numbers / 3;
  if (numbers % 3)
    return vl_dict_fail_at(dict, c->points->source,
                           "\"P\" holds %zu numbers, not a multiple of 3", numbers);
  if (n < c->degree + 1 || (!c->spline && (n - 1) % c->degree))
    return vl_dict_fail_at(
        dict, c->points->source,
        c->spline
            ? "%zu points, but a B-spline of degree %u needs at least %u"
            : "%zu points, but Bezier curves of degree %u need %u, or that and a multiple "
              "of the degree",
        n, c->degree, c->degree + 1);
  c->segments = c->spline ? n - c->degree : (n - 1) / c->degree;
  if (!is_finite(c->points))
    return vl_dict_fail_at(dict, c->points->source, "a point is not finite");
  return true;
}

static bool read_normals(vlDict *dict, vlCurveKind kind, Curve *c) {
  vlImport *import = dict->import;
  c->normals = vl_dict_find(dict, "N", VL_BIT_NORMAL);
  if (!vl_import_fine(import))
    return false;
  if (kind != VL_CURVE_RIBBON) {
    if (c->normals)
      vl_import_warn(import, VL_LOG_WARNING, c->normals->source,
                     "%s: only ribbons have normals: they are ignored", dict->what);
    c->normals = NULL;
    return true;
  }
  if (!c->normals)
    return vl_dict_fail(dict, "ribbons need \"normal N\"");
  if (c->normals->floats.count == 3 * (c->segments + 1) && is_finite(c->normals))
    return true;
  return vl_dict_fail_at(dict, c->normals->source,
                         "\"N\" holds %zu numbers; %zu segments need %zu finite ones, 3 for "
                         "each of their ends",
                         c->normals->floats.count, c->segments, 3 * (c->segments + 1));
}

bool vl_import_curve(vlDict *dict, vlShapeDef *def, const vlShapeLink *link) {
  static const char *const bases[] = {"bezier", "bspline"};
  vlImport *import = dict->import;
  Curve c = {.degree = 3};
  int basis = 0;
  float width = 1.0f;
  if (!vl_import_parameters(dict, def, false))
    return false;
  vl_dict_choice(dict, "basis", bases, 2, &basis);
  vl_dict_count(dict, "degree", 2, &c.degree);
  vl_dict_float(dict, "width", &width);
  c.width[0] = c.width[1] = width;
  vl_dict_float(dict, "width0", &c.width[0]);
  vl_dict_float(dict, "width1", &c.width[1]);
  vlParam *split = vl_dict_find(dict, "splitdepth", VL_BIT_INTEGER | VL_BIT_FLOAT);
  if (!vl_import_fine(import))
    return false;
  if (split && vl_param_count(split) == 1) {
    double depth =
        split->type == VL_PARAM_INTEGER ? split->integers.items[0] : split->floats.items[0];
    def->split_depth = depth > 0 ? (uint32_t)(depth < 10 ? depth : 10) : 0;
  }
  c.spline = basis == 1;
  if (c.degree > 3)
    return vl_dict_fail(dict, "the degree must be 2 or 3, not %u", c.degree);
  if (!(c.width[0] >= 0.0f) || !(c.width[1] >= 0.0f) || c.width[0] > 1e30f ||
      c.width[1] > 1e30f)
    return vl_dict_fail(dict, "a width must not be negative");
  if (!read_points(dict, &c) || !read_normals(dict, def->curve, &c) || !vl_dict_done(dict))
    return false;
  if (def->emission.index) {
    vl_import_warn(import, VL_LOG_WARNING, dict->source,
                   "curves cannot be area lights (nor can pbrt's): it gives none");
    def->emission.index = 0;
  }
  vlShapeRun *run = vl_import_run(import, VL_RUN_CURVES, def, link);
  return run && append(import, run, &c);
}
