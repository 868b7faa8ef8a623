/* export/pbrt/medium.c: participating media as pbrt's. */
#include <stdio.h>
#include <string.h>

#include "export/pbrt/pbrt.h"

/* `per` numbers per cell. */
static void put_cells(vlExport *x, const char *parameter, const vlMediumDef *m, const float *v, size_t per) {
  size_t count = per * m->nx * m->ny * m->nz;
  if (!v) return;
  PUT("\n  \"%s\" [", parameter);
  for (size_t i = 0; i < count; i++) PUT("%s%.9g", i ? " " : "", (double)v[i]);
  PUT("]");
}

/* Rules that the rows do not express, one function per kind. */
typedef bool PutMedium(vlExport *x, const vlMediumDef *m);

static bool put_homogeneous(vlExport *x, const vlMediumDef *m) {
  (void)x, (void)m;
  return true;
}

static bool put_grid(vlExport *x, const vlMediumDef *m) {
  put_cells(x, "float density", m, m->density, 1);
  put_cells(x, "float temperature", m, m->temperature, 1);
  put_cells(x, "float Lescale", m, m->emission_scales, 1);
  return true;
}

static bool put_rgb_grid(vlExport *x, const vlMediumDef *m) {
  if (m->space != x->scene->defs.film.space) vl_export_lose(x, "colour spaces of RGB grids: the scene's");
  put_cells(x, "rgb sigma_a", m, m->rgb_a, 3);
  put_cells(x, "rgb sigma_s", m, m->rgb_s, 3);
  put_cells(x, "rgb Le", m, m->rgb_emission, 3);
  return true;
}

static bool put_cloud(vlExport *x, const vlMediumDef *m) {
  (void)x, (void)m;
  return true;
}

/* Copies the NanoVDB file beside the scene. */
static bool put_nanovdb(vlExport *x, const vlMediumDef *m) {
  char name[300], *data = NULL;
  size_t size = 0, index = (size_t)(m - x->scene->media.items) + 1;
  vlError error;
  vl_error_clear(&error);
  snprintf(name, sizeof name, "%.200s-medium%zu.nvdb", x->stem, index);
  vlResult r = vl_file_read(x->context, m->path, false, &data, &size, &error);
  bool fine = r == VL_OK ? vl_export_file(x, name, data, size) : vl_export_fail(x, r, "%s", error.message);
  vl_free(x->context, data);
  PUT(" \"string filename\" \"%s\"", name);
  return fine;
}

#define PUT_KIND(NAME, name) [VL_MEDIUM_##NAME] = put_##name,
static PutMedium *const put_kind[] = {VL_MEDIUM_KINDS(PUT_KIND)};
#undef PUT_KIND

bool vl_pbrt_medium(vlExport *x, size_t i) {
  const vlMediumDef *m = &x->scene->media.items[i];
  const vlKindRow *row = vl_kind_row(&vl_medium_family, (int)m->kind);
  size_t before = x->text.data.count;
  vl_pbrt_matrix(x, m->world_from_medium);
  bool placed = x->text.data.count > before;
  PUT("MakeNamedMedium \"medium%zu\" \"string type\" \"%s\"", i + 1, row->name);
  vl_pbrt_row(x, row, m, false, m->emission_scales ? "Lescale" : NULL);
  if (!put_kind[m->kind](x, m)) return false;
  PUT(placed ? "\nIdentity\n" : "\n");
  return true;
}
