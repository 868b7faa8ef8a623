/* import/obj/obj_mesh.c: corners become meshes: smoothing groups get normals, equal corners
 * become one vertex, and each part becomes one shape. */
#include <math.h>
#include <string.h>

#include "base/free.h"
#include "import/far.h"
#include "import/mesh.h"
#include "import/obj/obj.h"
#include "math/approx_double.h"
#include "math/double3.h"
#include "math/hash.h"
#include "velo/shape_kinds.h"

/* Whether the load must stop after so many corners or triangles; looks at it now and then. */
static bool stopped(vlObj *obj, size_t done) {
  return done % 65536 == 0 && vl_scene_stopped(obj->scene, 1);
}

/* ---- normals ----------------------------------------------------------------------------- */

/* Normal of a face, not normalised: its length is twice the area. */
static void face_normal(const vlObj *obj, const vlObjCorner *c, double n[3]) {
  const float *a = vl_obj_position(obj, c[0].v), *b = vl_obj_position(obj, c[1].v),
              *d = vl_obj_position(obj, c[2].v);
  vl_triangle_normal(a, b, d, n);
}

static double angle_at(const vlObj *obj, const vlObjCorner *c, int i) {
  const float *a = vl_obj_position(obj, c[i].v), *b = vl_obj_position(obj, c[(i + 1) % 3].v),
              *d = vl_obj_position(obj, c[(i + 2) % 3].v);
  double ee = 0, ff = 0, ef = 0;
  for (int k = 0; k < 3; k++) {
    double e = (double)b[k] - a[k], f = (double)d[k] - a[k];
    ee += e * e;
    ff += f * f;
    ef += e * f;
  }
  double x = ef / sqrt(ee * ff);
  return x < 1 ? x > -1 ? vl_acos_double(x) : M_PI : 0;
}

static bool push_normal(vlObj *obj, const double n[3], uint32_t *number) {
  if (!vl_obj_push(obj, &obj->normals, 3, n, "normals"))
    return false;
  *number = (uint32_t)(obj->normals.count / 3);
  return true;
}

static void unit(double n[3]) {
  double l = vl_normalize3(n);
  if (!(l > 0 && isfinite(l))) {
    n[0] = n[1] = 0;
    n[2] = 1;
  }
}

typedef struct Smooth {
  uint32_t v, group, normal;
} Smooth;

/* Gives normals to corners without one. In a smoothing group it is the sum of the normals of
 * the group's faces at the vertex, weighted by their angles. Otherwise, where other faces of
 * the part have normals, it is the face normal. */
static bool make_normals(vlObj *obj) {
  size_t triangles = obj->triangle_part.count, wanted = 0;
  for (size_t t = 0; t < triangles; t++)
    for (size_t k = 0; k < 3; k++)
      wanted += obj->triangle_smooth.items[t] && !obj->corners.items[3 * t + k].vn;
  size_t size = vl_table_size(wanted), first = obj->normals.count;
  Smooth *table = vl_alloc_zero(obj->context, size, sizeof *table);
  if (!table)
    return vl_obj_fail_memory(obj);
  bool fine = true;
  for (size_t t = 0; fine && t < triangles; t++) {
    vlObjCorner *c = obj->corners.items + 3 * t;
    uint32_t group = obj->triangle_smooth.items[t], flat = 0;
    double n[3];
    fine = !stopped(obj, t);
    if (!fine || (c[0].vn && c[1].vn && c[2].vn))
      continue;
    if (!group && !obj->parts.items[obj->triangle_part.items[t]].normals)
      continue;
    face_normal(obj, c, n);
    unit(n);
    for (int k = 0; fine && k < 3; k++) {
      if (c[k].vn)
        continue;
      if (!group) {
        fine = flat || push_normal(obj, n, &flat);
        c[k].vn = flat;
        continue;
      }
      size_t slot = vl_hash2(c[k].v, group) & (size - 1);
      while (table[slot].normal && (table[slot].v != c[k].v || table[slot].group != group))
        slot = (slot + 1) & (size - 1);
      const double zero[3] = {0, 0, 0};
      if (!table[slot].normal) {
        table[slot].v = c[k].v;
        table[slot].group = group;
        fine = push_normal(obj, zero, &table[slot].normal);
        if (!fine)
          break;
      }
      c[k].vn = table[slot].normal;
      double weight = angle_at(obj, c, k);
      float *sum = obj->normals.items + 3 * (size_t)(c[k].vn - 1);
      for (int i = 0; i < 3; i++)
        sum[i] += (float)(weight * n[i]);
    }
  }
  vl_free(obj->context, table);
  for (size_t i = first; fine && i < obj->normals.count; i += 3) {
    double n[3] = {obj->normals.items[i], obj->normals.items[i + 1], obj->normals.items[i + 2]};
    unit(n);
    for (size_t k = 0; k < 3; k++)
      obj->normals.items[i + k] = (float)n[k];
  }
  return fine;
}

/* ---- parts ------------------------------------------------------------------------------- */

/* Triangle numbers sorted by part. */
static bool sort_by_part(vlObj *obj, uint32_t **order) {
  size_t triangles = obj->triangle_part.count;
  *order = vl_alloc_array(obj->context, triangles + 1, sizeof **order);
  if (!*order)
    return vl_obj_fail_memory(obj);
  uint32_t first = 0;
  for (size_t i = 0; i < obj->parts.count; i++) {
    obj->parts.items[i].first = first;
    first += obj->parts.items[i].triangles;
    obj->parts.items[i].triangles = 0;
  }
  for (size_t t = 0; t < triangles; t++) {
    vlObjPart *part = &obj->parts.items[obj->triangle_part.items[t]];
    (*order)[part->first + part->triangles++] = (uint32_t)t;
  }
  return true;
}

/* Makes the indices of the mesh. kept: the corners that remain as vertices, a new block. */
static bool weld(vlObj *obj, const vlObjPart *part, const uint32_t *order, vlMesh *m,
                 vlObjCorner **kept) {
  size_t count = 3 * (size_t)part->triangles, size = vl_table_size(count), n = 0;
  m->indices = vl_alloc_array(obj->context, count, sizeof *m->indices);
  *kept = vl_alloc_array(obj->context, count, sizeof **kept);
  uint32_t *table = vl_alloc_zero(obj->context, size, sizeof *table);
  if (!m->indices || !*kept || !table) {
    vl_free(obj->context, table);
    return vl_obj_fail_memory(obj);
  }
  bool fine = true;
  for (size_t i = 0; i < count && fine; i++) {
    vlObjCorner c = obj->corners.items[3 * (size_t)order[part->first + i / 3] + i % 3];
    size_t slot = vl_hash3(c.v, c.vt, c.vn) & (size - 1);
    for (;; slot = (slot + 1) & (size - 1)) {
      if (!table[slot]) {
        (*kept)[n] = c;
        table[slot] = (uint32_t)++n;
        break;
      }
      const vlObjCorner *k = &(*kept)[table[slot] - 1];
      if (k->v == c.v && k->vt == c.vt && k->vn == c.vn)
        break;
    }
    m->indices[i] = table[slot] - 1;
    fine = !stopped(obj, i);
  }
  vl_free(obj->context, table);
  m->vertices = n;
  return fine;
}

/* The vertices of the corners. */
static bool fill_mesh(vlObj *obj, const vlObjPart *part, const vlObjCorner *corners,
                      vlMesh *m) {
  const uint32_t attributes = VL_MESH_POSITIONS | (part->normals ? VL_MESH_NORMALS : 0) |
                              (part->uvs ? VL_MESH_UVS : 0) |
                              (obj->colors.count ? VL_MESH_COLORS : 0);
  if (!vl_mesh_add_attributes(obj->context, m, attributes))
    return vl_obj_fail_memory(obj);
  for (size_t i = 0; i < m->vertices; i++) {
    vlObjCorner c = corners[i];
    memcpy(m->positions + 3 * i, vl_obj_position(obj, c.v), 3 * sizeof(float));
    if (m->normals)
      memcpy(m->normals + 3 * i, obj->normals.items + 3 * (size_t)(c.vn - 1),
             3 * sizeof(float));
    for (size_t k = 0; m->uvs[0] && k < 2; k++)
      m->uvs[0][2 * i + k] = c.vt ? obj->uvs.items[2 * (size_t)(c.vt - 1) + k] : 0;
    for (size_t k = 0; m->colors && k < 4; k++) {
      size_t at = 3 * (size_t)(c.v - 1) + k;
      m->colors[4 * i + k] = k < 3 && at < obj->colors.count ? obj->colors.items[at] : 1.0f;
    }
  }
  return true;
}

static bool add_part(vlObj *obj, const vlObjPart *part, const uint32_t *order,
                     const vlLabel *label) {
  vlObjMaterial *m = &obj->materials.items[part->material];
  if (!vl_obj_make_material(obj, m))
    return false;
  vlMesh mesh = {.triangles = part->triangles};
  vlObjCorner *kept = NULL;
  bool fine = weld(obj, part, order, &mesh, &kept) && fill_mesh(obj, part, kept, &mesh);
  vl_free(obj->context, kept);
  if (!fine) {
    vl_mesh_free(obj->context, &mesh);
    return false;
  }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.source = (vlSource){obj->path, part->line, 1};
  def.label = *label;
  def.material = m->material;
  def.emission = m->emission;
  def.alpha = m->alpha;
  vl_mesh_to_shape(&mesh, &def);
  vl_far_place(obj->origin, &def);
  if (obj->permissive)
    vl_repair_mesh(obj->context, &obj->repairs, &def); /* out of memory: the scene checks it */
  return vl_scene_adopt_shape(obj->scene, &def).index != 0;
}

bool vl_obj_add_shapes(vlObj *obj) {
  uint32_t *order = NULL;
  vlNameTable names = {0};
  vlLabel label;
  bool fine = make_normals(obj) && sort_by_part(obj, &order);
  for (size_t i = 0; fine && i < obj->parts.count; i++)
    fine = vl_obj_label(obj, &names, i, &label) &&
           add_part(obj, &obj->parts.items[i], order, &label);
  VL_FREE(obj->context, names.slots, order);
  return fine;
}
