/* import/pbrt/run.c: runs: shapes of equal graphics state that become one shape. Curves are
 * gathered as long as they follow each other (curve.c). Small meshes (mesh_run.c) and whole
 * spheres (sphere_run.c) are gathered from the VL_RUN_FROM-th shape of a file on, but not while
 * diagnosing; several of their runs are open at a time, since exporters alternate between
 * materials. */
#include <string.h>

#include "base/free.h"
#include "base/text.h"
#include "import/pbrt/builder.h"
#include "velo/shape_kinds.h"

enum { MAX_OF_A_RUN = 1 << 20 };

static bool same_text(const char *a, const char *b) {
  return a == b || vl_text_is(a ? a : "", b ? b : "");
}

static bool same_link(const vlShapeLink *a, const vlShapeLink *b) {
  return a->material == b->material && same_text(a->material_name, b->material_name) &&
         same_text(a->alpha, b->alpha);
}

static bool fits(const vlShapeRun *run, const vlShapeDef *def, const vlShapeLink *link,
                 const vlGraphicsState *state) {
  const vlShapeDef *d = &run->def;
  return run->open && d->curve == def->curve && d->split_depth == def->split_depth &&
         d->group.index == def->group.index &&
         d->reverse_orientation == def->reverse_orientation &&
         d->alpha.value == def->alpha.value && !d->normals == !def->normals &&
         !d->uvs == !def->uvs &&
         memcmp(d->group_from_shape, def->group_from_shape, sizeof d->group_from_shape) == 0 &&
         same_link(&run->link, link) && same_text(run->inside, state->inside) &&
         same_text(run->outside, state->outside) &&
         (d->kind == VL_SHAPE_CURVES || run->faces + def->faces < MAX_OF_A_RUN);
}

bool vl_import_may_gather(const vlImport *import, const vlShapeDef *def,
                          const vlShapeLink *link) {
  return import->scene->shapes.count >= VL_RUN_FROM && !import->scene->problem &&
         !def->emission.index && !link->displacement;
}

/* The numbers of an array, which leave the run; null if there are none. */
static float *take(vlImport *import, vlRunFloats *from) {
  float *items = from->items;
  if (!from->count) {
    vl_free(import->context, items);
    items = NULL;
  }
  *from = (vlRunFloats){0};
  return items;
}

/* Shrinks the arrays of spheres to their size. */
static bool shrink_spheres(vlImport *import, vlShapeRun *run) {
  size_t n = run->radii.count;
  double *centers =
      vl_realloc_array(import->context, run->centers.items, 3 * n, sizeof *centers);
  if (centers)
    run->centers.items = centers;
  float *radii = vl_realloc_array(import->context, run->radii.items, n, sizeof *radii);
  if (radii)
    run->radii.items = radii;
  return (centers && radii) || vl_import_fail_memory(import);
}

static bool flush(vlImport *import, vlShapeRun *run) {
  if (!run->open)
    return true;
  run->open = false;
  if (run->radii.count && !shrink_spheres(import, run))
    return false;
  vlShapeDef *d = &run->def;
  d->faces = run->faces;
  d->vertices =
      d->kind == VL_SHAPE_CURVES ? 4 * d->faces : (uint32_t)(run->positions.count / 3);
  d->positions = take(import, &run->positions);
  d->normals = take(import, &run->normals);
  d->uvs = take(import, &run->uvs);
  d->widths = take(import, &run->widths);
  d->radii = take(import, &run->radii);
  d->centers = run->centers.items;
  d->indices = run->indices.items;
  memset(&run->centers, 0, sizeof run->centers);
  memset(&run->indices, 0, sizeof run->indices);
  return vl_import_add_shape_between(import, d, &run->link, run->inside, run->outside);
}

bool vl_import_flush_curves(vlImport *import) {
  return flush(import, &import->runs[VL_RUN_CURVES].items[0]);
}

bool vl_import_flush_runs(vlImport *import) {
  for (int k = 0; k < VL_RUN_KINDS; k++)
    for (int i = 0; i < VL_RUNS; i++)
      if (!flush(import, &import->runs[k].items[i]))
        return false;
  return true;
}

void vl_import_free_runs(vlImport *import) {
  for (int k = 0; k < VL_RUN_KINDS; k++)
    for (int i = 0; i < VL_RUNS; i++) {
      const vlShapeRun *run = &import->runs[k].items[i];
      VL_FREE(import->context, run->positions.items, run->normals.items, run->uvs.items,
              run->widths.items, run->radii.items, run->centers.items, run->indices.items);
    }
}

vlShapeRun *vl_import_run(vlImport *import, vlRunKind kind, const vlShapeDef *def,
                          const vlShapeLink *link) {
  vlRuns *runs = &import->runs[kind];
  const uint32_t count = kind == VL_RUN_CURVES ? 1 : VL_RUNS;
  for (uint32_t i = 0; i < count; i++)
    if (fits(&runs->items[i], def, link, &import->state))
      return &runs->items[i];
  vlShapeRun *run = &runs->items[runs->next++ % count];
  if (!flush(import, run))
    return NULL;
  run->def = *def;
  run->link = *link;
  run->faces = 0;
  run->inside = import->state.inside;
  run->outside = import->state.outside;
  run->open = vl_scene_copy_source(import->scene, &run->def.source);
  return run->open ? run : NULL;
}
