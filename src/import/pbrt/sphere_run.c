/* import/pbrt/sphere_run.c: merges whole spheres into shapes of many spheres. Particle scenes
 * contain a million sphere Shapes; each would take 750 bytes in scene and world, but only 56 in
 * a run (run.c). */
#include <math.h>

#include "import/pbrt/builder.h"
#include "math/double3.h"
#include "velo/shape.h"

/* Moves the translation of the transform to `center` and its scale to the radius. Returns false
 * unless the scale is the same along all axes and the transform does not mirror. */
static bool take_slot(vlShapeDef *def, double center[3], float *radius) {
  double *m = def->group_from_shape, at[3] = {m[3], m[7], m[11]}, s = m[0];
  if (!vl_is_affine(m))
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

bool vl_import_gather_sphere(vlImport *import, const vlShapeDef *given, const vlShapeLink *link,
                             bool *taken) {
  *taken = false;
  vlShapeDef def = *given;
  double center[3];
  float radius;
  bool whole = def.z_min <= -def.radius && def.z_max >= def.radius &&
               def.phi_max >= 2.0f * 3.14159265358979f;
  if (!vl_import_may_gather(import, &def, link) || !whole || !take_slot(&def, center, &radius))
    return true;
  vlShapeRun *run = vl_import_run(import, VL_RUN_SPHERES, &def, link);
  if (!run)
    return false;
  vlContext *context = import->context;
  if (!VL_RESERVE(context, &run->centers, 3) || !VL_RESERVE(context, &run->radii, 1)) {
    run->open = run->faces > 0;
    return vl_import_fail_memory(import);
  }
  for (int k = 0; k < 3; k++)
    run->centers.items[run->centers.count++] = center[k];
  run->radii.items[run->radii.count++] = radius;
  run->faces++;
  return *taken = true;
}
