/* scene/drop.c: frees the mesh arrays of a scene after a world has copied what it needs. */
#include <stdlib.h>
#include <string.h>

#include "base/machine.h"
#include "scene/scene.h"
#include "velo/shape.h"

static int by_address(const void *a, const void *b) {
  uintptr_t x = (uintptr_t) * (void *const *)a, y = (uintptr_t) * (void *const *)b;
  return (x > y) - (x < y);
}

void vl_shape_arrays(const vlShapeDef *d, const void *arrays[VL_SHAPE_ARRAYS]) {
  const void *all[VL_SHAPE_ARRAYS] = {
      d->positions,       d->normals,       d->tangents,      d->uvs,     d->indices,
      d->positions_close, d->normals_close, d->tangent_signs, d->colors,  d->more_uvs[0],
      d->more_uvs[1],     d->more_uvs[2],   d->widths,        d->centers, d->radii};
  memcpy(arrays, all, sizeof all);
}

static void forget(vlShapeDef *d) {
  vl_shape_drop_attributes(d);
  d->positions = d->normals = d->widths = d->radii = NULL;
  d->centers = NULL;
}

void vl_scene_drop_meshes(vlScene *scene) {
  size_t n = 0, kept = 0;
  const void *arrays[VL_SHAPE_ARRAYS];
  size_t room = VL_SHAPE_ARRAYS * scene->shapes.count + 1;
  const void **all = vl_alloc_array(scene->context, room, sizeof *all);
  if (!all)
    return;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    vl_shape_arrays(&scene->shapes.items[i], arrays);
    for (int k = 0; k < VL_SHAPE_ARRAYS; k++)
      if (arrays[k])
        all[n++] = arrays[k];
    forget(&scene->shapes.items[i]);
  }
  if (n)
    qsort(all, n, sizeof *all, by_address);
  for (size_t i = 0; i < scene->blocks.count; i++) {
    void *block = scene->blocks.items[i];
    if (n && bsearch(&block, all, n, sizeof *all, by_address))
      vl_free(scene->context, block);
    else
      scene->blocks.items[kept++] = block;
  }
  scene->blocks.count = kept;
  scene->meshes_dropped = true;
  vl_free(scene->context, all);
  vl_machine_return_memory(); /* free() alone does not return small arrays to the system */
}
