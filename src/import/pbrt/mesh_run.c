/* import/pbrt/mesh_run.c: merges small meshes. Some exporters write every quad as its own
 * Shape, and each Shape would take two kilobytes in scene, world and accelerator (run.c). */

#include <string.h>

#include "import/mesh.h"
#include "import/pbrt/builder.h"
#include "velo/shape_kinds.h"

enum { MAX_FACES = 256 };

/* Whether the mesh is small and sound. */
static bool is_small(const vlShapeDef *def, vlMat4 m) {
  const size_t n = def->vertices;
  return def->faces > 0 && n > 0 && def->faces <= MAX_FACES && n <= 3 * MAX_FACES &&
         !def->tangents && vl_all_finite(def->positions, 3 * n) &&
         vl_all_finite(def->normals, 3 * n) && vl_all_finite(def->uvs, 2 * n) &&
         vl_mat4_is_finite(m);
}

bool vl_import_gather_mesh(vlImport *import, const vlShapeDef *given, const vlShapeLink *link,
                           bool *taken) {
  *taken = false;
  vlShapeDef def = *given;
  size_t n = def.vertices;
  vlMat4 m = vl_mat4_load(def.group_from_shape), inverse;
  const vlMat4 unit = vl_mat4_identity();
  if (!vl_import_may_gather(import, &def, link) || !is_small(&def, m) ||
      !vl_mat4_inverse(m, &inverse))
    return true;
  bool mirrored = vl_determinant3(m.m) < 0;
  def.reverse_orientation = def.reverse_orientation != mirrored;
  memcpy(def.group_from_shape, unit.m, sizeof def.group_from_shape);
  vlShapeRun *run = vl_import_run(import, VL_RUN_MESHES, &def, link);
  if (!run)
    return false;
  vlContext *context = import->context;
  uint32_t first = (uint32_t)(run->positions.count / 3);
  if (!VL_RESERVE(context, &run->positions, 3 * n) ||
      (def.normals && !VL_RESERVE(context, &run->normals, 3 * n)) ||
      (def.uvs && !VL_RESERVE(context, &run->uvs, 2 * n)) ||
      !VL_RESERVE(context, &run->indices, 3 * (size_t)def.faces))
    return vl_import_fail_memory(import);
  if (!vl_mat4_points(&m, n, def.positions, run->positions.items + run->positions.count)) {
    run->open = run->faces > 0;
    return true; /* kept as its own shape; the world reports the error */
  }
  run->positions.count += 3 * n;
  if (def.normals) {
    /* a transform that mirrors moves the mirroring to reverse_orientation, which also flips
     * normals */
    vl_mat4_vertex_normals(&m, &inverse, mirrored, n, def.normals,
                           run->normals.items + run->normals.count);
    run->normals.count += 3 * n;
  }
  if (def.uvs) {
    memcpy(run->uvs.items + run->uvs.count, def.uvs, 2 * n * sizeof(float));
    run->uvs.count += 2 * n;
  }
  for (size_t i = 0; i < 3 * (size_t)def.faces; i++)
    run->indices.items[run->indices.count++] = first + def.indices[i];
  run->faces += def.faces;
  return *taken = true;
}
