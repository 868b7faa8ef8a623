/* export/pbrt/medium.c: participating media as pbrt's. */
#include <stdio.h>

#include "base/text.h"
#include "export/pbrt/pbrt.h"
#include "velo/medium.h"

/* `per` numbers per cell. */
static void put_cells(vlExport *x, const char *parameter, const vlMediumDef *m, const float *v,
                      size_t per) {
  size_t count = per * m->nx * m->ny * m->nz;
  if (!v)
    return;
  PUT("\n  \"%s\" ", parameter);
  vl_pbrt_floats(x, v, count);
}

/* The arrays of the row: numbers or colours per cell. */
static void put_arrays(vlExport *x, const vlKindRow *row, const vlMediumDef *m) {
  VL_EACH_PARAMETER(p, row) {
    if (p->type != VL_PARAMETER_BLOCK || !p->name)
      continue;
    bool rgb = vl_text_is(p->text, "rgb array");
    char name[64];
    snprintf(name, sizeof name, "%s %s", rgb ? "rgb" : "float", p->name);
    put_cells(x, name, m, *(const float *const *)(const void *)((const char *)m + p->offset),
              rgb ? 3 : 1);
  }
}

/* Rules that the rows do not express, by kind; null: none. */
typedef bool PutMedium(vlExport *x, const vlMediumDef *m);

static bool put_grid(vlExport *x, const vlMediumDef *m) {
  put_cells(x, "float Lescale", m, m->emission_scales, 1);
  return true;
}

static bool put_rgb_grid(vlExport *x, const vlMediumDef *m) {
  if (m->space != x->scene->defs.film.space)
    vl_export_lose(x, "colour spaces of RGB grids: the scene's");
  return true;
}

/* Copies the NanoVDB file beside the scene. */
static bool put_nanovdb(vlExport *x, const vlMediumDef *m) {
  char name[300], *data = NULL;
  size_t size = 0, index = (size_t)(m - x->scene->media.items) + 1;
  snprintf(name, sizeof name, "%.200s-medium%zu.nvdb", x->stem, index);
  bool fine = vl_export_read(x, m->path, &data, &size) && vl_export_data(x, name, data, size);
  vl_free(x->context, data);
  PUT(" \"string filename\" \"%s\"", name);
  return fine;
}

static PutMedium *const rules[0 VL_MEDIUM_KINDS(VL_COUNT_KIND)] = {
    [VL_MEDIUM_GRID] = put_grid,
    [VL_MEDIUM_RGB_GRID] = put_rgb_grid,
    [VL_MEDIUM_NANOVDB] = put_nanovdb,
};

/* pbrt's cloud has no scale; its coefficients are multiplied instead. */
static const vlMediumDef *without_scale(const vlMediumDef *m, vlMediumDef *copy) {
  if (m->kind != VL_MEDIUM_CLOUD || m->scale == 1)
    return m;
  *copy = *m;
  copy->sigma_a.scale *= m->scale;
  copy->sigma_s.scale *= m->scale;
  copy->scale = 1;
  return copy;
}

bool vl_pbrt_medium(vlExport *x, size_t i) {
  vlMediumDef copy;
  const vlMediumDef *m = without_scale(&x->scene->media.items[i], &copy);
  const vlKindRow *row = vl_kind_row(&vl_medium_family, (int)m->kind);
  size_t before = x->text.data.count;
  vl_pbrt_matrix(x, m->world_from_medium);
  bool placed = x->text.data.count > before;
  if (m->rgb_absorption)
    vl_export_lose(x, "absorption by RGB channel: by the spectrum of that colour");
  PUT("MakeNamedMedium \"medium%zu\" \"string type\" \"%s\"", i + 1, row->name);
  vl_pbrt_row(x, row, m, false, m->emission_scales ? "Lescale" : NULL);
  put_arrays(x, row, m);
  if (rules[m->kind] && !rules[m->kind](x, m))
    return false;
  PUT(placed ? "\nIdentity\n" : "\n");
  return true;
}
