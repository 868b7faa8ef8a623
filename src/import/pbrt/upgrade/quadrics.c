/* import/pbrt/upgrade/quadrics.c: shapes that pbrt-v4 does not have, as triangles. */
#include <math.h>
#include <stdio.h>

#include "base/context.h"
#include "base/text.h"
#include "import/pbrt/upgrade/upgrade.h"
#include "math/elementary.h"

enum { AROUND = 96, ALONG = 24, MAX_HEIGHTS = 4000000 };

typedef VL_ARRAY(char) Text;

static bool put(vlContext *context, Text *text, const char *format, double a, double b,
                double c) {
  char part[120];
  int n = snprintf(part, sizeof part, format, a, b, c);
  if (n < 0 || !VL_RESERVE(context, text, (size_t)n + 1))
    return false;
  memcpy(text->items + text->count, part, (size_t)n + 1);
  text->count += (size_t)n;
  return true;
}

/* In the order of their names in vl_old_mesh_of_shape. */
typedef enum Kind { CONE, PARABOLOID, HYPERBOLOID, HEIGHTFIELD } Kind;

/* A grid of points: u around or along x, v from 0 to 1. */
typedef struct Grid {
  uint32_t nu, nv;
  double radius, z[2], phi, p1[3], p2[3];
  Kind kind;
  double *z_values;
} Grid;

static void point(const Grid *g, uint32_t i, uint32_t j, double p[3]) {
  double u = (double)i / (g->nu - 1), v = (double)j / (g->nv - 1), angle = u * g->phi;
  if (g->kind == HEIGHTFIELD) {
    p[0] = u;
    p[1] = v;
    p[2] = g->z_values[(size_t)j * g->nu + i];
    return;
  }
  double c = vl_precise_cos(angle), s = vl_precise_sin(angle), x = 0, y = 0;
  p[2] = g->z[0] + v * (g->z[1] - g->z[0]);
  if (g->kind == CONE)
    x = g->radius * (1 - v);
  if (g->kind == PARABOLOID)
    x = g->radius * sqrt(p[2] / g->z[1]);
  if (g->kind == HYPERBOLOID) {
    x = g->p1[0] + v * (g->p2[0] - g->p1[0]);
    y = g->p1[1] + v * (g->p2[1] - g->p1[1]);
    p[2] = g->p1[2] + v * (g->p2[2] - g->p1[2]);
  }
  p[0] = x * c - y * s;
  p[1] = x * s + y * c;
}

static bool write_grid(vlContext *context, const Grid *g, Text *text) {
  bool fine = put(context, text, "\"point3 P\" [", 0, 0, 0);
  for (uint32_t j = 0; fine && j < g->nv; j++)
    for (uint32_t i = 0; fine && i < g->nu; i++) {
      double p[3];
      point(g, i, j, p);
      fine = put(context, text, i % 8 ? "  %.7g %.7g %.7g" : "\n    %.7g %.7g %.7g", p[0], p[1],
                 p[2]);
    }
  fine = fine && put(context, text, " ]\n  \"point2 uv\" [", 0, 0, 0);
  for (uint32_t j = 0; fine && j < g->nv; j++)
    for (uint32_t i = 0; fine && i < g->nu; i++)
      fine = put(context, text, i % 8 ? "  %.7g %.7g" : "\n    %.7g %.7g",
                 (double)i / (g->nu - 1), (double)j / (g->nv - 1), 0);
  fine = fine && put(context, text, " ]\n  \"integer indices\" [", 0, 0, 0);
  for (uint32_t j = 0; fine && j + 1 < g->nv; j++)
    for (uint32_t i = 0; fine && i + 1 < g->nu; i++) {
      double a = (double)j * g->nu + i, b = a + g->nu;
      fine = put(context, text, i % 8 ? "  %.0f %.0f %.0f" : "\n    %.0f %.0f %.0f", a, a + 1,
                 b + 1) &&
             put(context, text, "  %.0f %.0f %.0f", a, b + 1, b);
    }
  return fine && put(context, text, " ]", 0, 0, 0);
}

static bool read_heights(vlOldStatement *s, Grid *g) {
  const vlOldParam *p = vl_old_find(s, "Pz");
  double nu = vl_old_number(s, "nu", 0), nv = vl_old_number(s, "nv", 0);
  if (!p || !(nu >= 2) || !(nv >= 2) || nu * nv != (double)p->count || p->count > MAX_HEIGHTS)
    return vl_old_wrong(s, "heightfield: \"Pz\" must hold nu * nv numbers");
  g->nu = (uint32_t)nu;
  g->nv = (uint32_t)nv;
  size_t found;
  g->z_values = vl_old_all_numbers(s, p, &found);
  if (!g->z_values)
    return false;
  return found == p->count || vl_old_wrong(s, "heightfield: \"Pz\" holds no number");
}

/* As in pbrt-v3, the two heights may be in either order. z / zmax is negative on one side of
 * the apex, where a paraboloid has no points. */
static bool read_paraboloid(vlOldStatement *s, Grid *g) {
  const double a = vl_old_number(s, "zmin", 0), b = vl_old_number(s, "zmax", 1);
  g->z[0] = fmin(a, b);
  g->z[1] = fmax(a, b);
  if (g->z[1] > 0)
    g->z[0] = fmax(g->z[0], 0);
  return g->z[1] != 0 ||
         vl_old_wrong(s, "paraboloid: the larger of zmin and zmax must not be 0");
}

static void read_point(vlOldStatement *s, const char *name, double p[3]) {
  const vlOldParam *given = vl_old_find(s, name);
  if (given && given->count == 3)
    memcpy(p, given->number, 3 * sizeof *p);
}

bool vl_old_mesh_of_shape(vlOldStatement *s) {
  static const char *const names[] = {"cone", "paraboloid", "hyperboloid", "heightfield"};
  vlContext *context = s->u->context;
  Grid g = {.nu = AROUND + 1,
            .nv = ALONG + 1,
            .radius = vl_old_number(s, "radius", 1),
            .p2 = {1, 1, 1}};
  g.kind = (Kind)vl_name_index(s->name[0], names, VL_LENGTH(names));
  g.phi = fmin(fmax(vl_old_number(s, "phimax", 360), 0), 360) * M_PI / 180;
  g.z[1] = vl_old_number(s, "height", 1);
  read_point(s, "p1", g.p1);
  read_point(s, "p2", g.p2);
  if (g.kind == PARABOLOID && !read_paraboloid(s, &g))
    return false;
  if (g.kind == HEIGHTFIELD && !read_heights(s, &g)) {
    vl_free(context, g.z_values);
    return false;
  }
  Text text = {0};
  bool fine = write_grid(context, &g, &text) || vl_old_fail_memory(s->u);
  vl_free(context, g.z_values);
  if (fine && g.kind != HEIGHTFIELD)
    vl_old_lose(s, "shape \"%s\" has no counterpart: %u triangles are written", s->name[0],
                2 * (g.nu - 1) * (g.nv - 1));
  VL_EACH_ITEM(vlOldParam, p, &s->params) {
    p->dropped = !vl_text_is(p->name, "alpha");
  }
  fine = fine && vl_old_edit(s, (vlOldSpan){s->whole.end, s->whole.end}, "\n  %s", text.items);
  VL_ARRAY_FREE(context, &text);
  return fine;
}
