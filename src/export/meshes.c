/* export/meshes.c: shapes as triangles: meshes unchanged, patches as two triangles, quadrics
 * tessellated. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "export/export.h"

#include "math/elementary.h"
#include "schema/schema.h"
#include "velo/shape_kinds.h"

enum { ALONG = 64, ACROSS = 32 };

void vl_export_free_mesh(vlExport *x, vlExportMesh *mesh) {
  for (size_t i = 0; i < VL_LENGTH(mesh->own); i++)
    vl_free(x->context, mesh->own[i]);
  *mesh = (vlExportMesh){0};
}

static bool patches(vlExport *x, const vlShapeDef *d, vlExportMesh *mesh) {
  uint32_t *indices = vl_export_alloc(x, d->faces, 6 * sizeof *indices);
  if (!indices)
    return false;
  for (size_t i = 0; i < d->faces; i++) {
    const uint32_t *q = d->indices + 4 * i; /* p00 p10 p01 p11 */
    const uint32_t two[6] = {q[0], q[1], q[3], q[0], q[3], q[2]};
    memcpy(indices + 6 * i, two, sizeof two);
  }
  mesh->own[0] = indices;
  mesh->indices = indices;
  mesh->faces = 2 * d->faces;
  vl_export_lose(x, "bilinear patches: as two triangles each");
  return true;
}

/* Point, normal and uv of a quadric at (a, b) in [0, 1]^2: a around the axis, b from z_min (or
 * the outer radius). */
static void quadric(const vlShapeDef *d, double a, double b, float p[3], float n[3]) {
  double phi = a * d->phi_max, c = vl_precise_cos(phi), s = vl_precise_sin(phi), r = d->radius;
  if (d->kind == VL_SHAPE_DISK) {
    double at = r + b * (d->inner_radius - r);
    p[0] = (float)(at * c);
    p[1] = (float)(at * s);
    p[2] = d->height;
    n[0] = n[1] = 0;
    n[2] = 1;
    return;
  }
  if (d->kind == VL_SHAPE_CYLINDER) {
    p[0] = (float)(r * c);
    p[1] = (float)(r * s);
    p[2] = (float)(d->z_min + b * (d->z_max - d->z_min));
    n[0] = (float)c;
    n[1] = (float)s;
    n[2] = 0;
    return;
  }
  double low = vl_precise_acos(fmin(1, fmax(-1, d->z_min / r))),
         high = vl_precise_acos(fmin(1, fmax(-1, d->z_max / r)));
  double theta = low + b * (high - low);
  n[0] = (float)(vl_precise_sin(theta) * c);
  n[1] = (float)(vl_precise_sin(theta) * s);
  n[2] = (float)vl_precise_cos(theta);
  for (int i = 0; i < 3; i++)
    p[i] = (float)(r * (double)n[i]);
}

static bool facets(vlExport *x, const vlShapeDef *d, vlExportMesh *mesh) {
  const uint32_t across = d->kind == VL_SHAPE_SPHERE ? ACROSS : 1,
                 count = (ALONG + 1) * (across + 1);
  float *p = vl_alloc_array(x->context, count, 3 * sizeof *p),
        *n = vl_alloc_array(x->context, count, 3 * sizeof *n),
        *uv = vl_alloc_array(x->context, count, 2 * sizeof *uv);
  uint32_t *indices = vl_alloc_array(x->context, ALONG * across, 6 * sizeof *indices),
           *to = indices;
  mesh->own[0] = p;
  mesh->own[1] = n;
  mesh->own[2] = uv;
  mesh->own[3] = indices;
  if (!p || !n || !uv || !indices) {
    vl_export_free_mesh(x, mesh);
    return vl_export_no_memory(x);
  }
  bool cap = d->kind == VL_SHAPE_SPHERE && d->z_max >= d->radius,
       cup = d->kind == VL_SHAPE_SPHERE && d->z_min <= -d->radius;
  bool point = d->kind == VL_SHAPE_DISK && d->inner_radius <= 0;
  for (uint32_t j = 0; j <= across; j++)
    for (uint32_t i = 0; i <= ALONG; i++) {
      size_t k = (size_t)j * (ALONG + 1) + i;
      double a = (double)i / ALONG, b = (double)j / across;
      quadric(d, a, b, p + 3 * k, n + 3 * k);
      uv[2 * k] = (float)a;
      uv[2 * k + 1] = (float)b;
      if (i == ALONG || j == across)
        continue;
      uint32_t k00 = (uint32_t)k, k10 = k00 + 1, k01 = k00 + ALONG + 1, k11 = k01 + 1;
      if (!(cup && j == 0)) {
        *to++ = k00;
        *to++ = k10;
        *to++ = k11;
      }
      if (!((cap && j + 1 == across) || point)) {
        *to++ = k00;
        *to++ = k11;
        *to++ = k01;
      }
    }
  mesh->vertices = count;
  mesh->faces = (uint32_t)(to - indices) / 3;
  mesh->positions = p;
  mesh->normals = n;
  mesh->uvs[0] = uv;
  mesh->indices = indices;
  return true;
}

bool vl_export_mesh(vlExport *x, const vlShapeDef *d, vlExportMesh *mesh) {
  *mesh = (vlExportMesh){.vertices = d->vertices,
                         .faces = d->faces,
                         .positions = d->positions,
                         .normals = d->normals,
                         .tangents = d->tangents,
                         .colors = d->colors,
                         .signs = d->tangent_signs,
                         .indices = d->indices};
  mesh->uvs[0] = d->uvs;
  for (int k = 0; k < 3; k++)
    mesh->uvs[k + 1] = d->more_uvs[k];
  const vlKindRow *row = vl_kind_row(&vl_shape_family, (int)d->kind);
  if (row->traits & VL_SHAPE_TRAIT_MESH)
    return d->kind != VL_SHAPE_BILINEAR || patches(x, d, mesh);
  if (!(row->traits & VL_SHAPE_TRAIT_QUADRIC)) {
    vl_export_lose(x, "shapes of the kind %s: left out", row->name);
    return false;
  }
  vl_export_lose(x, "spheres, disks, cylinders: as triangles");
  vlShapeDef unit = vl_default_shape_def(VL_SHAPE_SPHERE);
  return facets(x, d->centers ? &unit : d, mesh);
}

/* Copies one array of `per` floats per vertex to three vertices per face; null stays null. */
static bool unweld(vlExport *x, const vlExportMesh *m, size_t per, const float **values,
                   void **own) {
  if (!*values)
    return true;
  float *to = vl_export_alloc(x, 3 * (size_t)m->faces, per * sizeof *to);
  if (!to)
    return false;
  for (size_t i = 0; i < 3 * (size_t)m->faces; i++)
    memcpy(to + per * i, *values + per * m->indices[i], per * sizeof *to);
  *own = to;
  *values = to;
  return true;
}

/* The uv of the corners of a face: as pbrt's triangles and patches have them. */
static bool own_uvs(vlExport *x, const vlShapeDef *d, vlExportMesh *m) {
  static const float triangle[6] = {0, 0, 1, 0, 1, 1},
                     patch[2][6] = {{0, 0, 1, 0, 1, 1}, {0, 0, 1, 1, 0, 1}};
  const size_t count = 3 * (size_t)m->faces;
  if (!unweld(x, m, 3, &m->positions, &m->own[4]) ||
      !unweld(x, m, 3, &m->normals, &m->own[5]) || !unweld(x, m, 3, &m->tangents, &m->own[6]) ||
      !unweld(x, m, 4, &m->colors, &m->own[7]) || !unweld(x, m, 1, &m->signs, &m->own[8]))
    return false;
  m->uvs[1] = m->uvs[2] = m->uvs[3] = NULL;
  uint32_t *indices = vl_alloc_array(x->context, count, sizeof *indices);
  float *uvs = vl_alloc_array(x->context, count, 2 * sizeof *uvs);
  m->own[9] = indices;
  m->own[10] = uvs;
  if (!indices || !uvs)
    return vl_export_no_memory(x);
  for (size_t i = 0; i < count; i++)
    indices[i] = (uint32_t)i;
  for (size_t i = 0; i < m->faces; i++)
    memcpy(uvs + 6 * i, d->kind == VL_SHAPE_BILINEAR ? patch[i % 2] : triangle,
           sizeof triangle);
  m->indices = indices;
  m->uvs[0] = uvs;
  m->vertices = (uint32_t)count;
  return true;
}

bool vl_export_make_uvs(vlExport *x, const vlShapeDef *d, uint32_t last, vlExportMesh *m) {
  if (!m->uvs[0] && !own_uvs(x, d, m))
    return false;
  for (uint32_t k = 1; k <= last && k < 4; k++)
    if (!m->uvs[k])
      m->uvs[k] = m->uvs[0];
  return true;
}
