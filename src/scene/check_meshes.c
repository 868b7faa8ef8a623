/* scene/check_meshes.c: scene check: faces without area, zero normals, textures that need
 * missing uvs, and transmissive solids that are open or whose normals point inwards. */
#include <math.h>
#include <stdlib.h>

#include "base/free.h"
#include "math/double3.h"
#include "scene/check.h"
#include "scene/mesh_solid.h"
#include "schema/schema.h"
#include "velo/light.h"
#include "velo/material.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

/* ---- degenerate -------------------------------------------------------------------------- */

static bool has_no_area(const float *p, const uint32_t *f) {
  if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0])
    return true;
  double n[3];
  vl_triangle_normal(p + 3 * (size_t)f[0], p + 3 * (size_t)f[1], p + 3 * (size_t)f[2], n);
  return fabs(n[0]) + fabs(n[1]) + fabs(n[2]) == 0;
}

/* Reports the number of wrong faces. Below one percent it is a note, otherwise a warning,
 * because nearly every exported mesh has a few degenerate faces. */
static void tell_share(vlCheck *c, const vlShapeDef *d, uint32_t wrong, uint32_t all,
                       const char *what) {
  if (!wrong)
    return;
  bool much = (double)wrong >= 0.01 * all;
  vl_check_add(c, VL_FINDING_DEGENERATE, much ? VL_SEVERITY_WARNING : VL_SEVERITY_NOTE,
               d->source, "%u of %u %s (%.2g %%)", wrong, all, what, 100.0 * wrong / all);
}

static void check_degenerate(vlCheck *c, const vlShapeDef *d) {
  uint32_t flat = 0, no_length = 0;
  if (d->kind == VL_SHAPE_TRIANGLES) {
    for (uint32_t i = 0; i < d->faces; i++)
      flat += has_no_area(d->positions, d->indices + 3 * (size_t)i);
    tell_share(c, d, flat, d->faces, "triangles have no area");
  } else if (d->kind == VL_SHAPE_BILINEAR) {
    for (uint32_t i = 0; i < d->faces; i++) {
      const uint32_t *f = d->indices + 4 * (size_t)i, other[3] = {f[3], f[2], f[1]};
      flat += has_no_area(d->positions, f) && has_no_area(d->positions, other);
    }
    tell_share(c, d, flat, d->faces, "patches have no area");
  }
  if (!d->normals || !vl_shape_is_mesh(d->kind))
    return;
  for (uint32_t i = 0; i < d->vertices; i++) {
    const float *n = d->normals + 3 * (size_t)i;
    no_length += n[0] == 0 && n[1] == 0 && n[2] == 0;
  }
  tell_share(c, d, no_length, d->vertices, "vertex normals have no length");
}

/* ---- uv ---------------------------------------------------------------------------------- */

/* Flags: what a texture and its inputs read from a mesh. */
enum { NEEDS_UV = 1, NEEDS_COLORS = 16 }; /* the flag of uv set k is NEEDS_UV << k */

/* Kinds with a mapping read the uvs, unless their cells are cubes in space. */
static uint8_t own_needs(const vlTextureDef *t) {
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)t->kind);
  bool solid = vl_row_find(row, "dimension") && t->dimension == 3;
  bool over_uv = vl_row_find(row, "mapping") && t->mapping == VL_MAPPING_UV && !solid;
  uint8_t needs = over_uv ? (uint8_t)(NEEDS_UV << (t->uv_set & 3)) : 0;
  if (t->colors || t->kind == VL_TEXTURE_VERTEX_COLOR)
    needs |= NEEDS_COLORS;
  return needs;
}

static uint8_t lacks(const vlShapeDef *d) {
  if (d->kind != VL_SHAPE_TRIANGLES)
    return 0; /* shapes of other kinds always have uvs */
  uint8_t none = d->uvs ? 0 : NEEDS_UV;
  for (int k = 0; k < 3; k++)
    if (!d->more_uvs[k])
      none |= (uint8_t)(NEEDS_UV << (k + 1));
  return d->colors ? none : none | NEEDS_COLORS;
}

typedef struct Needs {
  uint8_t *textures, *materials;
  uint32_t *culprit; /* per material: id of the texture that needs uvs or colours */
} Needs;

static void find_needs(vlCheck *c, Needs *n) {
  const vlScene *s = c->scene;
  vlTextureId inputs[VL_CHECK_INPUTS];
  for (size_t i = 0; i < s->textures.count; i++) {
    n->textures[i] = own_needs(&s->textures.items[i]);
    uint32_t count = vl_check_inputs(VL_SCENE_TEXTURES, &s->textures.items[i], inputs);
    for (uint32_t k = 0; k < count; k++)
      n->textures[i] |= n->textures[inputs[k].index - 1];
  }
  for (size_t i = 0; i < s->materials.count; i++) {
    const vlMaterialDef *m = &s->materials.items[i];
    uint32_t count = vl_check_inputs(VL_SCENE_MATERIALS, m, inputs);
    for (uint32_t k = 0; k < count; k++) {
      uint8_t needs = n->textures[inputs[k].index - 1];
      if (needs)
        n->culprit[i] = inputs[k].index;
      n->materials[i] |= needs;
    }
    if (m->normal_map)
      n->materials[i] |= NEEDS_UV;
    for (int k = 0; k < 2; k++) {
      uint32_t part = m->materials[k].index;
      if (!part)
        continue;
      n->materials[i] |= n->materials[part - 1];
      if (n->culprit[part - 1])
        n->culprit[i] = n->culprit[part - 1];
    }
  }
}

static void tell_lack(vlCheck *c, const vlShapeDef *d, uint8_t lack, const char *who,
                      const char *texture) {
  if (lack & NEEDS_COLORS)
    vl_check_add(c, VL_FINDING_NO_UV, VL_SEVERITY_WARNING, d->source,
                 "the mesh has no vertex colours, but %s%s%s reads them", texture,
                 texture[0] ? " of " : "", who);
  if (lack & ~NEEDS_COLORS)
    vl_check_add(
        c, VL_FINDING_NO_UV, VL_SEVERITY_WARNING, d->source,
        "the mesh has no uv%s, but %s%s%s needs them: each triangle shows the same piece",
        lack & NEEDS_UV ? "" : " of that set", texture, texture[0] ? " of " : "", who);
}

static void check_uv(vlCheck *c, const vlShapeDef *d, const Needs *n) {
  const vlScene *s = c->scene;
  uint8_t none = lacks(d);
  if (!none)
    return;
  if (d->material.index) {
    uint32_t m = d->material.index - 1, t = n->culprit[m];
    uint8_t lack = none & n->materials[m];
    if (lack)
      tell_lack(c, d, lack, vl_check_material_name(&s->materials.items[m]).text,
                t ? vl_check_texture_name(&s->textures.items[t - 1]).text : "the normal map");
  }
  if (d->alpha.texture.index && (none & n->textures[d->alpha.texture.index - 1]))
    tell_lack(c, d, none & n->textures[d->alpha.texture.index - 1],
              vl_check_texture_name(&s->textures.items[d->alpha.texture.index - 1]).text,
              "its alpha,");
  if (!d->emission.index)
    return;
  const vlEmissionDef *e = &s->emissions.items[d->emission.index - 1];
  if ((e->image && (none & NEEDS_UV)) ||
      (e->texture.index && (none & n->textures[e->texture.index - 1] & ~NEEDS_COLORS)))
    tell_lack(c, d, NEEDS_UV, "its area light", "the image");
}

/* ---- solids ------------------------------------------------------------------------------ */

static bool is_solid(const vlCheck *c, const vlShapeDef *d) {
  const vlMaterialDef *m = vl_scene_material(c->scene, d->material);
  return m &&
         ((vl_kind_row(&vl_material_family, (int)m->kind)->traits & VL_MATERIAL_REFRACTS) ||
          (vl_principled_transmits(m) && !m->principled.thin_walled));
}

typedef struct Key {
  uint32_t group, material, shape;
} Key;

static int by_key(const void *a, const void *b) {
  const Key *x = a, *y = b;
  if (x->group != y->group)
    return x->group < y->group ? -1 : 1;
  if (x->material != y->material)
    return x->material < y->material ? -1 : 1;
  return x->shape < y->shape ? -1 : x->shape > y->shape;
}

/* Whether the box of another part contains this part. Then this part may be a cavity. */
static bool lies_in_another(const vlMeshSolid *b, uint32_t part) {
  for (uint32_t i = 0; i < b->part_count; i++)
    if (i != part && vl_extent_holds(&b->parts[i].box, &b->parts[part].box))
      return true;
  return false;
}

/* Sets the number of open edges of each part to 0 if other transmissive materials of its group
 * close it: a glass of water has a surface of each of its three interfaces, and only together
 * they are closed. group: all meshes of such materials in the group. */
static void close_by_others(vlCheck *c, const uint32_t *group, size_t count,
                            vlMeshSolid *solid) {
  vlMeshSolid all;
  if (!vl_mesh_solid_make(c->scene, group, count, &all))
    c->no_memory = true;
  for (uint32_t i = 0; i < solid->part_count && !c->no_memory; i++) {
    bool open = false;
    for (uint32_t j = 0; j < all.part_count && !open; j++)
      open =
          all.parts[j].open_edges && vl_extent_holds(&all.parts[j].box, &solid->parts[i].box);
    if (!open)
      solid->parts[i].open_edges = 0;
  }
  vl_mesh_solid_free(c->scene, &all);
}

/* Checks one solid. After welding it is unknown from which shape a part comes, so findings name
 * the solid's first shape. This is exact for solids of one shape. group: see close_by_others.
 */
static void check_solid(vlCheck *c, const uint32_t *shapes, size_t count, const uint32_t *group,
                        size_t group_count) {
  const vlScene *s = c->scene;
  const vlShapeDef *first = &s->shapes.items[shapes[0]];
  vlMeshSolid solid;
  if (!vl_mesh_solid_make(s, shapes, count, &solid))
    c->no_memory = true;
  uint32_t open = 0, inverted = 0;
  uint64_t edges = 0;
  for (uint32_t i = 0; i < solid.part_count && !c->no_memory; i++) {
    const vlMeshSolidPart *p = &solid.parts[i];
    open += p->open_edges > 0;
    inverted += !p->open_edges && p->volume < 0 && !lies_in_another(&solid, i);
  }
  if (open && group_count > count)
    close_by_others(c, group, group_count, &solid);
  open = 0;
  for (uint32_t i = 0; i < solid.part_count && !c->no_memory; i++) {
    edges += solid.parts[i].open_edges;
    open += solid.parts[i].open_edges > 0;
  }
  vlCheckName name = vl_check_material_name(vl_scene_material(c->scene, first->material));
  if (open)
    vl_check_add(
        c, VL_FINDING_OPEN_DIELECTRIC, VL_SEVERITY_WARNING, first->source,
        "the solid of %s is not closed: %llu edges have one face only, in %u of its %u parts",
        name.text, (unsigned long long)edges, open, solid.part_count);
  if (inverted)
    vl_check_add(
        c, VL_FINDING_INVERTED_DIELECTRIC, VL_SEVERITY_WARNING, first->source,
        "normals point into the solid of %s (%u of its %u parts): light is bent the wrong way",
        name.text, inverted, solid.part_count);
  vl_mesh_solid_free(s, &solid);
}

static void check_sphere(vlCheck *c, const vlShapeDef *d) {
  const double whole = 2 * 3.14159265358979 - 1e-5;
  vlCheckName name = vl_check_material_name(vl_scene_material(c->scene, d->material));
  if (!d->centers &&
      ((double)d->phi_max < whole || d->z_min > -d->radius || d->z_max < d->radius))
    vl_check_add(c, VL_FINDING_OPEN_DIELECTRIC, VL_SEVERITY_WARNING, d->source,
                 "the solid of %s is not closed: the sphere is a part of one", name.text);
  else if (d->reverse_orientation != (vl_determinant3(d->group_from_shape) < 0))
    vl_check_add(c, VL_FINDING_INVERTED_DIELECTRIC, VL_SEVERITY_WARNING, d->source,
                 "normals point into the sphere of %s: light is bent the wrong way", name.text);
}

static void check_solids(vlCheck *c) {
  const vlScene *s = c->scene;
  Key *keys = vl_alloc_array(c->context, s->shapes.count + 1, sizeof *keys);
  uint32_t *shapes = vl_alloc_array(c->context, s->shapes.count + 1, sizeof *shapes);
  size_t n = 0;
  if (!keys || !shapes)
    c->no_memory = true;
  for (uint32_t i = 0; i < s->shapes.count && !c->no_memory; i++) {
    const vlShapeDef *d = &s->shapes.items[i];
    if (!is_solid(c, d))
      continue;
    if (d->kind == VL_SHAPE_SPHERE)
      check_sphere(c, d);
    else
      keys[n++] = (Key){d->group.index, d->material.index, i};
  }
  if (n)
    qsort(keys, n, sizeof *keys, by_key);
  for (size_t i = 0; i < n; i++)
    shapes[i] = keys[i].shape;
  size_t group = 0, group_end = 0; /* the meshes of the group of solid i */
  for (size_t i = 0, j; i < n && !c->no_memory; i = j) {
    if (i == group_end) {
      group = i;
      while (group_end < n && keys[group_end].group == keys[i].group)
        group_end++;
    }
    /* the solid has disks or cylinders, which may close it; this is not checked */
    bool round = false;
    for (j = i; j < group_end && keys[j].material == keys[i].material; j++)
      round |= !vl_shape_is_mesh(s->shapes.items[keys[j].shape].kind);
    if (!round)
      check_solid(c, shapes + i, j - i, shapes + group, group_end - group);
  }
  VL_FREE(c->context, keys, shapes);
}

void vl_check_meshes(vlCheck *c) {
  const vlScene *s = c->scene;
  Needs n = {vl_alloc_zero(c->context, s->textures.count + 1, 1),
             vl_alloc_zero(c->context, s->materials.count + 1, 1),
             vl_alloc_zero(c->context, s->materials.count + 1, sizeof *n.culprit)};
  if (!n.textures || !n.materials || !n.culprit)
    c->no_memory = true;
  if (!c->no_memory)
    find_needs(c, &n);
  for (size_t i = 0; i < s->shapes.count && !c->no_memory; i++) {
    check_degenerate(c, &s->shapes.items[i]);
    check_uv(c, &s->shapes.items[i], &n);
  }
  VL_FREE(c->context, n.textures, n.materials, n.culprit);
  if (!c->no_memory)
    check_solids(c);
}
