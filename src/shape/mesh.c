/* shape/mesh.c: vertices and faces of meshes, transformed to group space. */
#include "shape/mesh.h"

#include <string.h>

#include "base/error.h"
#include "velo/shape_kinds.h"
#include "world/moving.h"

/* Fills the sets of rows between the two ends of a motion by interpolation. On entry the ends
 * are in the first and the last of `steps` sets. */
static void spread(const vlWorld *world, const vlShapeDef *def, float *rows, uint32_t steps) {
  size_t n = 3 * (size_t)def->vertices;
  double span = world->time_close - world->time_open,
         first = (def->times[0] - world->time_open) / span,
         last = (def->times[1] - world->time_open) / span;
  const double same = 1e-6; /* tolerance, relative to the motion, as in vl_world_time_steps */
  for (uint32_t k = 1; k + 1 < steps; k++) {
    double f = ((double)k / (steps - 1) - first) / (last - first);
    f = f > same ? (f < 1 - same ? f : 1) : 0;
    for (size_t i = 0; i < n; i++)
      rows[k * n + i] = (float)(rows[i] * (1 - f) + rows[(steps - 1) * n + i] * f);
  }
}

static vlResult add_vertex_motion(vlWorld *world, const vlShapeDef *def, const vlMat4 *m,
                                  const vlMat4 *inverse, vlWorldShape *s, vlError *error) {
  size_t n = 3 * (size_t)def->vertices;
  uint32_t steps = vl_world_time_steps(world, def->times[0], def->times[1]);
  if (steps == 0)
    return vl_fail_source(
        error, VL_ERROR_SCENE, def->source,
        "vertices move from %g to %g seconds, other things from %g to %g: no even "
        "steps lead through all",
        def->times[0], def->times[1], world->time_open, world->time_close);
  s->steps = steps + 1;
  float *positions = vl_world_block(world, s->steps * n + 4, sizeof(float)), *normals = NULL;
  if (!positions)
    return vl_fail_memory(error);
  if (s->normals && !(normals = vl_world_block(world, s->steps * n, sizeof(float))))
    return vl_fail_memory(error);
  memset(positions + s->steps * n, 0, 4 * sizeof(float));
  memcpy(positions, s->positions, n * sizeof(float));
  if (!vl_mat4_points(m, def->vertices, def->positions_close, positions + steps * n))
    return vl_fail_shape(def, error,
                         "a vertex leaves the range of floats under the shape's transform");
  spread(world, def, positions, s->steps);
  s->positions = positions;
  if (!normals)
    return VL_OK;
  memcpy(normals, s->normals, n * sizeof(float));
  vl_mat4_vertex_normals(m, inverse, def->reverse_orientation, def->vertices,
                         def->normals_close, normals + steps * n);
  spread(world, def, normals, s->steps);
  s->normals = normals;
  return VL_OK;
}

vlResult vl_mesh_compile(vlWorld *world, const vlShapeDef *def, const vlMat4 *m,
                         const vlMat4 *inverse, vlWorldShape *s, vlError *error) {
  size_t n = def->vertices, corners = def->kind == VL_SHAPE_BILINEAR ? 4 : 3;
  bool same = vl_mat4_is_identity(m->m);
  s->vertices = def->vertices;
  s->faces = def->faces;
  s->positions = vl_world_block(world, 3 * n + 4, sizeof(float));
  s->indices = vl_world_block(world, corners * def->faces + 4, sizeof(uint32_t));
  if (!s->positions || !s->indices)
    return vl_fail_memory(error);
  memset(s->positions + 3 * n, 0, 4 * sizeof(float));
  memcpy(s->indices, def->indices, corners * def->faces * sizeof(uint32_t));
  if (def->normals && !(s->normals = vl_world_block(world, 3 * n, sizeof(float))))
    return vl_fail_memory(error);
  if (def->tangents && !(s->tangents = vl_world_block(world, 3 * n, sizeof(float))))
    return vl_fail_memory(error);
  if (def->uvs) {
    if (!(s->uvs = vl_world_block(world, 2 * n, sizeof(float))))
      return vl_fail_memory(error);
    memcpy(s->uvs, def->uvs, 2 * n * sizeof(float));
  }
  s->one_sided = def->one_sided && def->kind == VL_SHAPE_TRIANGLES;
  if (def->kind == VL_SHAPE_TRIANGLES &&
      (!vl_world_copy_floats(world, def->tangent_signs, n, &s->tangent_signs) ||
       !vl_world_copy_floats(world, def->colors, 4 * n, &s->colors) ||
       !vl_world_copy_floats(world, def->more_uvs[0], 2 * n, &s->more_uvs[0]) ||
       !vl_world_copy_floats(world, def->more_uvs[1], 2 * n, &s->more_uvs[1]) ||
       !vl_world_copy_floats(world, def->more_uvs[2], 2 * n, &s->more_uvs[2])))
    return vl_fail_memory(error);
  /* if m mirrors, it reverses n x t relative to the mapped n and t */
  bool mirrored = vl_determinant3(m->m) < 0;
  for (size_t i = 0; mirrored && s->tangent_signs && i < n; i++)
    s->tangent_signs[i] = -s->tangent_signs[i];
  if (same)
    memcpy(s->positions, def->positions, 3 * n * sizeof(float));
  if (!same && !vl_mat4_points(m, n, def->positions, s->positions))
    return vl_fail_shape(def, error,
                         "a vertex leaves the range of floats under the shape's transform");
  if (def->normals)
    vl_mat4_vertex_normals(m, inverse, def->reverse_orientation, n, def->normals, s->normals);
  for (size_t i = 0; def->tangents && i < n; i++) {
    double p[3] = {def->tangents[3 * i], def->tangents[3 * i + 1], def->tangents[3 * i + 2]},
           q[3];
    vl_mat4_vector(m, p, q);
    for (int k = 0; k < 3; k++)
      s->tangents[3 * i + k] = (float)q[k];
  }
  return def->positions_close && def->kind == VL_SHAPE_TRIANGLES
             ? add_vertex_motion(world, def, m, inverse, s, error)
             : VL_OK;
}

void vl_mesh_bounds(const vlWorldShape *shape, uint32_t corners, uint32_t prim, double low[3],
                    double high[3]) {
  for (uint32_t k = 0; k < corners; k++)
    for (int i = 0; i < 3; i++) {
      double x = shape->positions[3 * (size_t)shape->indices[(size_t)corners * prim + k] + i];
      low[i] = x < low[i] ? x : low[i];
      high[i] = x > high[i] ? x : high[i];
    }
}

/* ---- triangles --------------------------------------------------------------------------- */
