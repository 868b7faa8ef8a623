/* import/pbrt/sphere_run.c: merges whole spheres into shapes of many spheres. Particle scenes
 * contain a million sphere Shapes; each would take 750 bytes in scene and world, but only 56 in
 * a run. From the VL_MESH_RUN_FROM-th shape of a file on, spheres that differ only in position
 * and radius are merged. Before that, and while diagnosing, nothing is merged. Several runs are
 * open at a time, since files alternate between materials. */
#include <math.h>
#include <string.h>

#include "import/pbrt/builder.h"
#include "velo/shape.h"

enum { MAX_OF_A_RUN = 1 << 20 };

static bool fits(const vlSphereRun *run, const vlShapeDef *def, const vlShapeLink *link,
                 const vlGraphicsState *state) {
  const vlShapeDef *d = &run->def;
  return run->open && d->group.index == def->group.index &&
         d->reverse_orientation == def->reverse_orientation &&
         d->alpha.value == def->alpha.value &&
         memcmp(d->group_from_shape, def->group_from_shape, sizeof d->group_from_shape) == 0 &&
         vl_import_same_link(&run->link, link) &&
         vl_import_same_text(run->inside, state->inside) &&
         vl_import_same_text(run->outside, state->outside) && run->radii.count < MAX_OF_A_RUN;
}

static void free_rows(vlImport *import, vlSphereRun *run) {
  VL_ARRAY_FREE(import->context, &run->centers);
  VL_ARRAY_FREE(import->context, &run->radii);
}

static bool flush(vlImport *import, vlSphereRun *run) {
  if (!run->open)
    return true;
  run->open = false;
  vlShapeDef *d = &run->def;
  size_t n = run->radii.count;
  double *centers =
      vl_realloc_array(import->context, run->centers.items, 3 * n, sizeof *centers);
  if (centers)
    run->centers.items = centers;
  float *radii = vl_realloc_array(import->context, run->radii.items, n, sizeof *radii);
  if (radii)
    run->radii.items = radii;
  if (!centers || !radii)
    return vl_import_fail_memory(import);
  d->faces = (uint32_t)n;
  d->centers = centers;
  d->radii = radii;
  memset(&run->centers, 0, sizeof run->centers);
  memset(&run->radii, 0, sizeof run->radii);
  return vl_import_add_shape_between(import, d, &run->link, run->inside, run->outside);
}

bool vl_import_flush_spheres(vlImport *import) {
  for (int i = 0; i < VL_MESH_RUNS; i++)
    if (!flush(import, &import->sphere_runs[i]))
      return false;
  return true;
}

void vl_import_free_spheres(vlImport *import) {
  for (int i = 0; i < VL_MESH_RUNS; i++)
    free_rows(import, &import->sphere_runs[i]);
}

/* Moves the translation of the transform to `center` and its scale to the radius. Returns false
 * unless the scale is the same along all axes and the transform does not mirror. */
static bool take_slot(vlShapeDef *def, double center[3], float *radius) {
  double *m = def->group_from_shape, at[3] = {m[3], m[7], m[11]}, s = m[0];
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    return false;
  *radius = def->radius;
  bool even = s > 0 && m[5] == s && m[10] == s && m[1] == 0 && m[2] == 0 && m[4] == 0 &&
              m[6] == 0 && m[8] == 0 && m[9] == 0;
  if (even) {
    m[0] = m[5] = m[10] = 1;
    *radius = (float)(s * (double)def->radius);
  }
  m[3] = m[7] = m[11] = 0;
  for (int i = 0; i < 16; i++)
    m[i] += 0.0; /* no negative zeros: states are compared by bits */
  vlMat4 inverse;
  if (!vl_mat4_inverse(vl_mat4_load(m), &inverse))
    return false;
  vl_mat4_vector(&inverse, at, center);
  return isfinite(center[0] + center[1] + center[2]) && isfinite(*radius) && *radius > 0.0f;
}

static bool open_run(vlImport *import, vlSphereRun *run, const vlShapeDef *def,
                     const vlShapeLink *link) {
  if (!flush(import, run))
    return false;
  run->def = *def;
  run->link = *link;
  run->inside = import->state.inside;
  run->outside = import->state.outside;
  run->open = vl_scene_copy_source(import->scene, &run->def.source);
  return run->open;
}

bool vl_import_gather_sphere(vlImport *import, const vlShapeDef *given, const vlShapeLink *link,
                             bool *taken) {
  *taken = false;
  vlShapeDef def = *given;
  double center[3];
  float radius;
  bool whole = def.z_min <= -def.radius && def.z_max >= def.radius &&
               def.phi_max >= 2.0f * 3.14159265358979f;
  if (import->scene->shapes.count < VL_MESH_RUN_FROM || import->scene->problem || !whole ||
      def.emission.index || link->displacement || !take_slot(&def, center, &radius))
    return true;
  vlSphereRun *run = NULL;
  for (int i = 0; i < VL_MESH_RUNS && !run; i++)
    if (fits(&import->sphere_runs[i], &def, link, &import->state))
      run = &import->sphere_runs[i];
  if (!run) {
    run = &import->sphere_runs[import->next_sphere_run++ % VL_MESH_RUNS];
    if (!open_run(import, run, &def, link))
      return false;
  }
  vlContext *context = import->context;
  if (!VL_RESERVE(context, &run->centers, 3) || !VL_RESERVE(context, &run->radii, 1)) {
    run->open = run->radii.count > 0;
    return vl_import_fail_memory(import);
  }
  for (int k = 0; k < 3; k++)
    run->centers.items[run->centers.count++] = center[k];
  run->radii.items[run->radii.count++] = radius;
  return *taken = true;
}
