/* export/pbrt/shape.c: shapes as pbrt's. Large meshes are written to PLY files. */
#include <math.h>
#include <stdio.h>

#include "export/image.h"
#include "export/pbrt/pbrt.h"
#include "scene/solid.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"

enum { INLINE_FACES = 64 };

static void put_floats(vlExport *x, const char *type, const char *name, const float *v,
                       size_t count) {
  if (!v)
    return;
  PUT("\n    \"%s %s\" ", type, name);
  vl_pbrt_floats(x, v, count);
}

static void put_inline(vlExport *x, const vlShapeDef *d) {
  size_t per = d->kind == VL_SHAPE_TRIANGLES ? 3 : 4;
  PUT("  Shape \"%s\"", per == 3 ? "trianglemesh" : "bilinearmesh");
  put_floats(x, "point3", "P", d->positions, 3 * (size_t)d->vertices);
  put_floats(x, "normal", "N", d->normals, 3 * (size_t)d->vertices);
  if (per == 3 && !d->tangent_signs)
    put_floats(x, "vector3", "S", d->tangents, 3 * (size_t)d->vertices);
  put_floats(x, "point2", "uv", d->uvs, 2 * (size_t)d->vertices);
  PUT("\n    \"integer indices\" [");
  for (size_t i = 0; i < per * d->faces; i++)
    PUT("%s%u", i ? " " : "", d->indices[i]);
  PUT("]");
}

/* Writes binary little-endian PLY. Patches become faces of four corners in cyclic order, which
 * pbrt reads as patches. */
static bool put_ply(vlExport *x, const vlShapeDef *d, size_t index) {
  vlBytes b = {0};
  size_t per = d->kind == VL_SHAPE_TRIANGLES ? 3 : 4;
  vl_bytes_print(x->context, &b,
                 "ply\nformat binary_little_endian 1.0\nelement vertex %u\n"
                 "property float x\nproperty float y\nproperty float z\n%s%s"
                 "element face %u\nproperty list uchar int vertex_indices\nend_header\n",
                 d->vertices,
                 d->normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
                 d->uvs ? "property float u\nproperty float v\n" : "", d->faces);
  for (size_t i = 0; i < d->vertices; i++) {
    vl_bytes_put(x->context, &b, d->positions + 3 * i, 3 * sizeof(float));
    if (d->normals)
      vl_bytes_put(x->context, &b, d->normals + 3 * i, 3 * sizeof(float));
    if (d->uvs)
      vl_bytes_put(x->context, &b, d->uvs + 2 * i, 2 * sizeof(float));
  }
  for (size_t i = 0; i < d->faces; i++) {
    const uint32_t *v = d->indices + per * i,
                   round[4] = {v[0], v[1], per == 4 ? v[3] : v[2], v[2]};
    const uint8_t count = (uint8_t)per;
    vl_bytes_put(x->context, &b, &count, 1);
    vl_bytes_put(x->context, &b, round, per * sizeof *round);
  }
  char name[300];
  snprintf(name, sizeof name, "%.200s-mesh%zu.ply", x->stem, index + 1);
  bool fine =
      b.full ? vl_export_no_memory(x) : vl_export_data(x, name, b.data.items, b.data.count);
  VL_ARRAY_FREE(x->context, &b.data);
  PUT("  Shape \"plymesh\" \"string filename\" \"%s\"", name);
  return fine;
}

/* A directive for each Bezier segment. The importer joins such curves again. */
static void put_curves(vlExport *x, const vlShapeDef *d, const vlPbrtInput *alpha) {
  static const char *const kinds[] = {
      [VL_CURVE_FLAT] = "flat", [VL_CURVE_CYLINDER] = "cylinder", [VL_CURVE_RIBBON] = "ribbon"};
  for (size_t i = 0; i < d->faces; i++) {
    PUT("%s  Shape \"curve\" \"string type\" \"%s\"", i ? "\n" : "", kinds[d->curve]);
    put_floats(x, "point3", "P", d->positions + 12 * i, 12);
    if (d->normals)
      put_floats(x, "normal", "N", d->normals + 6 * i, 6);
    PUT(" \"float width0\" [%.9g] \"float width1\" [%.9g]", (double)d->widths[2 * i],
        (double)d->widths[2 * i + 1]);
    if (d->split_depth != 3)
      PUT(" \"integer splitdepth\" [%u]", d->split_depth);
    if (alpha->texture[0] || alpha->number != 1)
      vl_pbrt_put_number(x, "alpha", alpha);
  }
}

static bool put_kind(vlExport *x, const vlShapeDef *d, size_t index) {
  const vlKindRow *row = vl_kind_row(&vl_shape_family, (int)d->kind);
  if (row->traits & VL_SHAPE_TRAIT_MESH) {
    if (d->faces > INLINE_FACES && (!d->tangents || d->tangent_signs))
      return put_ply(x, d, index);
    put_inline(x, d);
    return true;
  }
  PUT("  Shape \"%s\"", row->name);
  vl_pbrt_row(x, row, d, true, NULL);
  return true;
}

/* pbrt's emissive images do not repeat. When all uvs lie in one cell other than the unit
 * square, this function shifts them there, provided that all image textures of the scene repeat
 * and use the plain uv mapping. *moved receives the new uvs, or null. */
static bool move_uvs(vlExport *x, const vlShapeDef *d, float **moved) {
  const vlEmissionDef *e = &x->scene->emissions.items[d->emission.index - 1];
  *moved = NULL;
  if (!d->uvs || !e->texture.index)
    return true;
  float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (size_t i = 0; i < 2 * (size_t)d->vertices; i++) {
    low[i % 2] = fminf(low[i % 2], d->uvs[i]);
    high[i % 2] = fmaxf(high[i % 2], d->uvs[i]);
  }
  float by[2] = {floorf(low[0]), floorf(low[1])};
  if (low[0] >= 0 && low[1] >= 0 && high[0] <= 1 && high[1] <= 1)
    return true;
  bool can = high[0] - by[0] <= 1 && high[1] - by[1] <= 1;
  for (size_t i = 0; can && i < x->scene->textures.count; i++) {
    const vlTextureDef *t = &x->scene->textures.items[i];
    bool plain = t->wrap == VL_WRAP_REPEAT && vl_export_wrap_t(t) == VL_WRAP_REPEAT &&
                 !t->st_from_uv_given && t->su == 1 && t->sv == 1;
    can = t->kind != VL_TEXTURE_IMAGE || plain;
  }
  if (!can) {
    vl_export_lose(x, "images that emit light again and again: at the first place only");
    return true;
  }
  float *uvs = vl_export_alloc(x, d->vertices, 2 * sizeof *uvs);
  if (!uvs)
    return false;
  for (size_t i = 0; i < 2 * (size_t)d->vertices; i++)
    uvs[i] = d->uvs[i] - by[i % 2];
  *moved = uvs;
  return true;
}

static bool put_emission(vlExport *x, const vlEmissionDef *e) {
  const vlTextureDef *t = vl_export_texture(x, e->texture);
  vlTextureDef image = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  char name[300] = "";
  image.path = e->image;
  if ((t || e->image) && !vl_pbrt_emitted_image(x, t ? t : &image, name))
    return false;
  const vlKindRow *row = vl_kind_row(&vl_emission_family, 0);
  PUT("  AreaLightSource \"%s\"", row->name);
  vl_pbrt_row(x, row, e, false, name[0] ? "L" : NULL);
  if (name[0])
    PUT(" \"string filename\" \"%s\"", name);
  PUT("\n");
  return true;
}

static bool put_shape(vlExport *x, const vlShapeDef *d, size_t index) {
  if (d->positions && (!d->faces || !d->vertices))
    return true;
  if (d->positions_close)
    vl_export_lose(x, "meshes that change in time: as they are at first");
  if (d->hidden_from_camera)
    vl_export_lose(x, "shapes that are hidden from the camera: seen");
  if (d->one_sided)
    vl_export_lose(x, "surfaces that are seen from one side only: from both");
  if (d->tangents && d->tangent_signs)
    vl_export_lose(x, "tangents of normal maps: those of the uvs");
  if (d->colors)
    vl_export_lose(x, "colours of vertices: left out");
  if (d->displacement.texture.index)
    vl_export_lose(x, "displacement of meshes: left out");
  vlPbrtInput alpha;
  if (!vl_pbrt_prepare_number(x, &d->alpha, false, &alpha))
    return false;
  PUT("AttributeBegin\n");
  vl_pbrt_matrix(x, d->group_from_shape);
  if (d->material.index)
    PUT("  NamedMaterial \"material%u\"\n", d->material.index);
  const bool dark = d->emission.index && vl_export_parts_media(x, d);
  if (dark)
    vl_export_lose(x, "light of surfaces that only part media (material interface): left out");
  if (d->emission.index && !dark &&
      !put_emission(x, &x->scene->emissions.items[d->emission.index - 1]))
    return false;
  if (d->inside.index != d->outside.index) {
    char in[32] = "", out[32] = "";
    if (d->inside.index)
      snprintf(in, sizeof in, "medium%u", d->inside.index);
    if (d->outside.index)
      snprintf(out, sizeof out, "medium%u", d->outside.index);
    PUT("  MediumInterface \"%s\" \"%s\"\n", in, out);
  }
  if (d->reverse_orientation)
    PUT("  ReverseOrientation\n");
  float *moved = NULL;
  if (d->emission.index && !move_uvs(x, d, &moved))
    return false;
  vlShapeDef here = *d;
  here.uvs = moved ? moved : d->uvs;
  const bool curves = d->kind == VL_SHAPE_CURVES;
  if (curves)
    put_curves(x, d, &alpha);
  bool put = curves || put_kind(x, &here, index);
  vl_free(x->context, moved);
  if (!put)
    return false;
  if (!curves && (alpha.texture[0] || alpha.number != 1))
    vl_pbrt_put_number(x, "alpha", &alpha);
  PUT("\nAttributeEnd\n");
  return true;
}

bool vl_pbrt_shape(vlExport *x, size_t index) {
  const vlShapeDef *d = &x->scene->shapes.items[index];
  if (vl_scene_shape_is_removed(x->scene, index))
    return true;
  if (!d->centers)
    return put_shape(x, d, index);
  for (uint32_t i = 0; i < d->faces; i++) {
    vlShapeDef one = vl_shape_one_sphere(d, i);
    if (!put_shape(x, &one, index))
      return false;
  }
  return true;
}
