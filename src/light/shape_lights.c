/* light/shape_lights.c: compiles emissive shapes into lights, one per emitting face. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "light/compile.h"
#include "light/emissive_faces.h"
#include "light/light_kind.h"
#include "light/spread.h"
#include "math/elementary.h"
#include "scene/scene.h"
#include "shape/surface_point.h"
#include "texture/lookup.h"
#include "velo/light.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

static float mean_image_luminance(const vlWorld *world, const vlEmitted *e) {
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  vlTexel mean = vl_texel(mip, mip->level_count - 1, 0, 0);
  return vl_light_texel_luminance(mean, mip->channels, e->space);
}

/* The numbers of light/spread.h. From 180 degrees on there is no spread. */
static void set_spread(float spread, vlEmitted *e) {
  const double half = 0.5 * (double)spread, widest = 0.5 * M_PI - 1e-4;
  e->spread_cot = 0;
  e->spread_scale = e->spread_sin2 = 1;
  if (half >= widest)
    return;
  double s = vl_precise_sin(half), cot = vl_precise_cos(half) / s;
  e->spread_cot = (float)cot;
  e->spread_scale = (float)(1 / (1 - half * cot));
  e->spread_sin2 = (float)(s * s);
}

static vlResult add_emission(vlWorld *world, const vlScene *scene, const vlEmissionDef *def,
                             vlEmitted *e, vlError *error) {
  e->two_sided = def->two_sided;
  set_spread(def->spread, e);
  if (def->texture.index) {
    vlSpectrumInput input = vl_spectrum_input(vl_spectrum_constant(0.0f));
    input.texture = def->texture;
    int32_t node;
    VL_TRY(vl_world_spectrum_node(world, scene, input, VL_ROLE_ILLUMINANT, &node, error));
    e->node = node + 1;
    e->image = world->nodes.items[node].image;
    vl_light_image_color(world, world->nodes.items[node].space, def->scale, e);
    return VL_OK;
  }
  if (!def->image)
    return vl_light_color(world, &def->radiance, def->scale, e, error);
  e->image = vl_world_add_image(world, def->image, NULL, NULL, true, error);
  if (e->image < 0)
    return error->code;
  vl_light_image_color(world, vl_light_image_space(world, e->image, VL_SPACE_SRGB), def->scale,
                       e);
  const vlMipmap *mip = world->images.items[e->image].mipmap;
  for (uint32_t y = 0; y < mip->levels[0].height; y++)
    for (uint32_t x = 0; x < mip->levels[0].width; x++)
      if (!isfinite(vl_light_texel_luminance(vl_texel(mip, 0, (int32_t)x, (int32_t)y),
                                             mip->channels, e->space)))
        return vl_light_bad_pixel(def->image, x, y, error);
  return VL_OK;
}

/* Approximate mean luminance of an emission's texture over a triangle. Faces where the image is
 * black need no light. */
static float face_luminance(const vlWorld *world, const vlWorldShape *s, uint32_t prim,
                            const vlEmitted *e) {
  static const float inside[4][3] = {{1 / 3.0f, 1 / 3.0f, 1 / 3.0f},
                                     {0.7f, 0.15f, 0.15f},
                                     {0.15f, 0.7f, 0.15f},
                                     {0.15f, 0.15f, 0.7f}};
  const vlTextureNode *node = &world->nodes.items[e->node - 1];
  const float *uvs = s->emission_uvs ? s->emission_uvs : s->uvs;
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  const float *a = vl_corner_uv(uvs, f, 0), *b = vl_corner_uv(uvs, f, 1),
              *c = vl_corner_uv(uvs, f, 2);
  float area = fabsf((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])), sum = 0;
  vlTexturePoint at = {0, 0, vl_vec3(0, 0, 0), vl_vec3(0, 0, 1), 0, {0, 0, 0, 0}, {1, 1, 1, 1}};
  float side = sqrtf(0.5f * area), axes[4] = {side, 0, 0, side};
  vl_texture_axes_of_uv(node, axes, &at);
  for (int i = 0; i < 4; i++) {
    vlVec2 uv = vl_triangle_uv(uvs, f, inside[i]);
    at.u = uv.x;
    at.v = uv.y;
    vlTexel x = vl_texture_rgba(node, world->images.items[e->image].mipmap, at);
    sum += 0.25f * vl_light_texel_luminance(x, 4, e->space);
  }
  return e->image_scale * (isfinite(sum) ? sum : 0);
}

/* Sets the corners and the emitting side of a light. The renderer flips the geometric normal to
 * the side of the interpolated shading normal: if the three vertex normals agree on the side,
 * so do all points of the triangle. */
static void triangle_light(const vlWorldShape *s, uint32_t prim, vlWorldLight *light) {
  const uint32_t *f = s->indices + 3 * (size_t)prim;
  vlVec3 p[3];
  for (int k = 0; k < 3; k++) {
    const float *x = s->positions + 3 * (size_t)f[k];
    p[k] = vl_load3(x);
    for (int i = 0; i < 3; i++)
      light->corners[3 * k + i] = x[i];
  }
  vlVec3 g = vl_normalize(vl_cross(vl_sub(p[1], p[0]), vl_sub(p[2], p[0])));
  int against = 0;
  for (int k = 0; s->normals && k < 3; k++) {
    const float *x = s->normals + 3 * (size_t)f[k];
    against += vl_dot(g, vl_load3(x)) < 0;
  }
  bool flip = s->normals ? against >= 2 : s->flip;
  light->one_sided_normals = against == 0 || against == 3;
  if (flip)
    g = vl_neg(g);
  vl_store3(light->direction, g);
}

/* Sets the numbers from which points are sampled, and the bound of the error of such a point: a
 * float's rounding of the centre, of the point and of the normal (some twenty roundings,
 * area.h), and the deviation of a map that is only nearly a similarity. */
static void sphere_light(const vlWorldShape *s, vlVec3 center, float radius,
                         vlWorldLight *light) {
  const float round = 0x1p-24f;
  double scale = (double)radius / (double)s->radius;
  float error = radius * (32 * round + 2 * (float)vl_similarity_error(s->from_shape, scale)) +
                4 * round * vl_length(center);
  const float q[6] = {center.x, center.y, center.z, radius, s->flip ? -1.0f : 1.0f, error};
  memcpy(light->corners, q, sizeof q);
}

/* Compiles the emission of a shape into world->emitted, unless an earlier shape has compiled
 * the same emission (*index is then set). */
static vlResult add_shape_emission(vlWorld *world, const vlScene *scene,
                                   const vlEmissionDef *def, uint32_t *index, vlError *error) {
  if (*index != VL_NONE)
    return VL_OK;
  vlEmitted *e = VL_PUSH(world->context, &world->emitted);
  if (!e)
    return vl_fail_memory(error);
  e->image = -1;
  vlResult r = add_emission(world, scene, def, e, error);
  if (r != VL_OK)
    return vl_world_locate_error(def->source, error, r);
  *index = (uint32_t)world->emitted.count - 1;
  return VL_OK;
}

/* Counts the emitting faces. Sets light_of if some faces are black: only the others are
 * numbered as lights. */
static vlResult choose_faces(vlWorld *world, vlWorldShape *shape, const vlEmitted *e,
                             uint32_t *faces, vlError *error) {
  vlEmissiveFaces emissive;
  if (!vl_emissive_faces_make(world, e, &emissive))
    return vl_fail_memory(error);
  uint32_t count = 0, first = (uint32_t)world->lights.count;
  for (uint32_t i = 0; i < shape->faces; i++)
    count += vl_face_emits(&emissive, shape, i);
  vlResult r = VL_OK;
  if (count > 0 && count < shape->faces) {
    shape->light_of = vl_world_block(world, shape->faces, sizeof *shape->light_of);
    if (!shape->light_of)
      r = vl_fail_memory(error);
    for (uint32_t i = 0, k = first; r == VL_OK && i < shape->faces; i++)
      shape->light_of[i] = vl_face_emits(&emissive, shape, i) ? k++ : VL_NONE;
  }
  vl_emissive_faces_free(world, &emissive);
  *faces = count;
  return r;
}

/* Scales the emission so that a face of this area sends the power, as in pbrt. */
static void scale_to_power(const vlWorld *world, float power, float area, vlEmitted *e) {
  float sent = (e->two_sided ? 2 : 1) * area * VL_PI;
  if (e->image >= 0)
    sent *= mean_image_luminance(world, e);
  e->spectrum.scale *= sent > 0 ? power / sent : 0;
}

/* Mean luminance of the emission's image over a face, as a factor on that of its spectrum. */
static float image_factor(const vlWorld *world, const vlWorldShape *shape, uint32_t prim,
                          const vlEmitted *e) {
  if (e->node && shape->triangles)
    return face_luminance(world, shape, prim, e);
  return e->image >= 0 ? e->image_scale * mean_image_luminance(world, e) : 1.0f;
}

/* Sets the light of a face. luminance: of the emission's spectrum. */
static void set_face_light(const vlWorld *world, uint32_t shape_index, uint32_t prim,
                           uint32_t emitted, float luminance, vlWorldLight *light) {
  const vlWorldShape *shape = &world->shapes.items[shape_index];
  const vlEmitted *e = &world->emitted.items[emitted];
  vlVec3 center;
  float radius;
  const bool sphere = vl_whole_sphere(shape, &center, &radius);
  const bool plain = shape->alpha < 0 && e->image < 0 && !vl_has_spread(e);
  memset(light, 0, sizeof *light);
  light->kind = VL_LIGHT_AREA;
  light->emitted = emitted;
  light->shape = shape_index;
  light->prim = prim;
  light->environment = VL_NONE;
  light->area = vl_world_prim_area(shape, prim);
  light->power = VL_PI * light->area * (image_factor(world, shape, prim, e) * luminance) *
                 (e->two_sided ? 2 : 1);
  light->invisible = shape->alpha >= 0 &&
                     world->nodes.items[shape->alpha].kind == VL_TEXTURE_CONSTANT &&
                     world->nodes.items[shape->alpha].value == 0;
  light->outer_side = light->invisible && sphere;
  light->far_side_seen = sphere && shape->pass_shadow && (e->two_sided || shape->flip);
  light->plain_sphere = plain && sphere && !light->far_side_seen;
  if (shape->triangles) {
    triangle_light(shape, prim, light);
    light->plain_triangle = plain && light->one_sided_normals;
  }
  if (sphere)
    sphere_light(shape, center, radius, light);
  if (shape->kind == VL_SHAPE_DISK) {
    vlSurfacePoint point;
    double pdf;
    vl_shape_sample(shape, 0, 0.5f, 0.5f, &point, &pdf);
    for (int j = 0; j < 3; j++)
      light->direction[j] = (float)point.n[j];
  }
}

/* Tells that an emissive shape gives no light where it moves or is part of an object. */
static void warn_of_dark(const vlWorld *world, const vlShapeDef *def) {
  vl_world_warn(
      world, def->source, "%s",
      def->group.index
          ? "an emissive shape inside an object that is instanced or moves does not emit"
          : "an emissive shape that moves does not emit");
}

vlResult vl_world_add_shape_lights(vlWorld *world, const vlScene *scene, uint32_t shape_index,
                                   uint32_t *compiled, vlError *error) {
  const vlShapeDef *def = &scene->shapes.items[shape_index];
  vlWorldShape *shape = &world->shapes.items[shape_index];
  const vlEmissionDef *emission = &scene->emissions.items[def->emission.index - 1];
  if (def->group.index || shape->steps > 1) {
    warn_of_dark(world, def);
    return VL_OK;
  }
  bool meshed = shape->triangles || shape->kind == VL_SHAPE_BILINEAR;
  uint32_t faces = meshed ? shape->faces : 1;
  bool has_power = emission->power > 0; /* per primitive, as in pbrt; not NaN */
  uint32_t own_emission = VL_NONE,
           *shared = has_power ? &own_emission : &compiled[def->emission.index - 1];
  VL_TRY(add_shape_emission(world, scene, emission, shared, error));
  const vlEmitted *first = &world->emitted.items[*shared];
  uint32_t set = first->node ? world->nodes.items[first->node - 1].uv_set : 0;
  if (set)
    shape->emission_uvs = shape->more_uvs[set - 1];
  if (meshed)
    VL_TRY(choose_faces(world, shape, first, &faces, error));
  if (!VL_RESERVE(world->context, &world->lights, faces))
    return vl_fail_memory(error);
  shape->first_light = faces ? (uint32_t)world->lights.count : VL_NONE;
  float luminance = 0; /* of the spectrum of the emission */
  for (uint32_t i = 0, k = 0; k < faces; i++) {
    if (vl_shape_light(shape, i) == VL_NONE)
      continue;
    if (has_power) {
      if (k > 0)
        *shared = VL_NONE;
      VL_TRY(add_shape_emission(world, scene, emission, shared, error));
      scale_to_power(world, (float)emission->power, vl_world_prim_area(shape, i),
                     &world->emitted.items[*shared]);
    }
    if (k++ == 0 || has_power)
      luminance = vl_light_luminance(&world->emitted.items[*shared].spectrum);
    set_face_light(world, shape_index, i, *shared, luminance,
                   &world->lights.items[world->lights.count++]);
  }
  return VL_OK;
}
