/* light/goniometric.c: point lights whose intensity is given by a file: goniometric (by
 * direction: an image in an equal-area octahedral square, or a lamp file) and projection.
 * Conventions are pbrt-v4's (book 12.2): the axis of a goniometric diagram is the light's y; a
 * projection light's image is projected along its z with y up. The power parameter is the power
 * of all emitted light, as in pbrt. */
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "light/compile.h"
#include "light/lamp.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "math/octahedral.h"
#include "math/stretch.h"
#include "math/transform.h"
#include "texture/lookup.h"
#include "velo/light.h"

vlCompileLight vl_compile_light_goniometric, vl_compile_light_projection;

static float mean_of(vlTexel t, uint32_t channels) {
  return channels < 3 ? t.c[0] : (t.c[0] + t.c[1] + t.c[2]) / 3;
}

/* The factor on the intensity. flux: of the light without it; a given power replaces it. */
static double scale_of(const vlLightDef *def, double flux) {
  if (isnan(def->power))
    return def->scale;
  return flux > 0 ? def->scale * (def->power / flux) : 0;
}

/* ---- goniometric lights with an image ---------------------------------------------------- */

/* Directions for the mean over all: at least so many along each side of the octahedral square,
 * where the frame is skewed. */
enum { SQUARE = 256 };

/* The direction, in the light's frame, of a point of the octahedral square. */
static void square_direction(double s, double t, double direction[3]) {
  const vlVec3 d = vl_octahedral_decode((float)s, (float)t);
  direction[0] = (double)d.x;
  direction[1] = (double)d.z;
  direction[2] = (double)d.y;
}

/* The mean of stretch over texel (x, y) of n x n. */
static double texel_stretch(const vlStretch *stretch, uint32_t n, uint32_t x, uint32_t y) {
  if (!stretch->is_skewed)
    return 1;
  const uint32_t parts = n < SQUARE ? SQUARE / n : 1;
  double sum = 0;
  for (uint32_t i = 0; i < parts * parts; i++) {
    double direction[3];
    square_direction((x + (i % parts + 0.5) / parts) / n, (y + (i / parts + 0.5) / parts) / n,
                     direction);
    sum += vl_stretch_at(stretch, direction);
  }
  return sum / (parts * parts);
}

static vlResult add_goniometric(vlWorld *world, const vlLightDef *def, const vlMipmap *mip,
                                vlWorldLight *light, vlEmitted *e, vlError *error) {
  static const int order[3] = {0, 2, 1};
  static const float sign[3] = {1, 1, 1};
  uint32_t n = mip->levels[0].width;
  if (n != mip->levels[0].height)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: %u x %u: a goniometric light's image must be square (equal-area "
                   "octahedral map)",
                   def->path ? def->path : "the image", n, mip->levels[0].height);
  VL_TRY(vl_light_set_frame(def, order, sign, light, error));
  const vlStretch stretch = vl_stretch(def->world_from_light);
  double sum = 0;
  for (uint32_t y = 0; y < n; y++)
    for (uint32_t x = 0; x < n; x++) {
      float value = mean_of(vl_texel(mip, 0, (int32_t)x, (int32_t)y), mip->channels);
      if (!isfinite(value))
        return vl_light_bad_pixel(def->path, x, y, error);
      sum += value > 0 ? value * texel_stretch(&stretch, n, x, y) : 0;
    }
  const double flux = 4 * M_PI * (sum / ((double)n * n));
  vlResult r = vl_light_color(world, &def->color, (float)scale_of(def, flux), e, error);
  light->power = (float)flux * vl_light_luminance(&e->spectrum);
  return r;
}

/* ---- projection lights ------------------------------------------------------------------- */

/* The direction, not normalized, of a point of the plane z = 1. The image's y points down. */
static void image_direction(const vlStretch *stretch, double x, double y, double direction[3]) {
  const double at[3] = {x, -y, 1};
  vl_mat4_vector(&stretch->map, at, direction);
}

/* An area of the plane z = 1 around a point, over its solid angle. */
static double image_area(const vlStretch *stretch, double x, double y) {
  const double length2 = 1 + x * x + y * y, length = sqrt(length2);
  const double direction[3] = {x / length, -y / length, 1 / length};
  return length2 * length / vl_stretch_at(stretch, direction);
}

/* Cosine of the widest angle between the axis (unit) and what the image covers; -1 where a
 * corner is at more than a right angle. */
static double image_cone(const vlStretch *stretch, const float axis[3], const float half[2]) {
  if (!stretch->is_skewed)
    return 1 / sqrt(1 + half[0] * half[0] + half[1] * half[1]);
  double min = 1;
  for (int i = 0; i < 4; i++) {
    double to[3], along = 0;
    image_direction(stretch, i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1], to);
    for (int k = 0; k < 3; k++)
      along += to[k] * axis[k];
    min = fmin(min, along / vl_norm3(to));
  }
  return min > 0 ? min : -1;
}

static vlResult add_projection(vlWorld *world, const vlLightDef *def, const vlMipmap *mip,
                               vlWorldLight *light, vlEmitted *e, vlError *error) {
  static const int order[3] = {0, 1, 2};
  static const float sign[3] = {1, -1, 1};
  uint32_t w = mip->levels[0].width, h = mip->levels[0].height;
  VL_TRY(vl_light_set_frame(def, order, sign, light, error));
  double aspect = (double)w / h, tangent = vl_precise_tan(0.5 * def->fov);
  light->own[0] = (float)(tangent * (aspect > 1 ? aspect : 1));
  light->own[1] = (float)(tangent * (aspect > 1 ? 1 : 1 / aspect));
  const vlStretch stretch = vl_stretch(def->world_from_light);
  const vlColorSpace space = vl_light_image_space(world, (int32_t)light->image, def->space);
  double sum = 0;
  for (uint32_t y = 0; y < h; y++)
    for (uint32_t x = 0; x < w; x++) {
      double a = light->own[0] * (2 * (x + 0.5) / w - 1),
             b = light->own[1] * (2 * (y + 0.5) / h - 1);
      float value = vl_light_texel_luminance(vl_texel(mip, 0, (int32_t)x, (int32_t)y),
                                             mip->channels, space);
      if (!isfinite(value))
        return vl_light_bad_pixel(def->path, x, y, error);
      sum += value > 0 ? value / image_area(&stretch, a, b) : 0;
    }
  const double flux = sum / ((double)w * h) * 4 * light->own[0] * light->own[1];
  const double factor = scale_of(def, flux);
  e->image = (int32_t)light->image;
  vl_light_image_color(world, space, (float)factor, e);
  double axis[3];
  image_direction(&stretch, 0, 0, axis);
  double l = vl_norm3(axis);
  for (int i = 0; i < 3; i++)
    light->direction[i] = (float)(axis[i] / l);
  light->cos_end = light->cos_start = (float)image_cone(&stretch, light->direction, light->own);
  /* as for a spot light */
  light->power = (float)(flux * factor / (2 * M_PI * (1 - light->cos_end)) * 4 * M_PI);
  return VL_OK;
}

/* Adds the image of a light. Null on error. */
static const vlMipmap *add_image(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                                 vlError *error) {
  int32_t image = vl_world_add_image(world, def->path, def->image, NULL, false, error);
  light->image = (uint32_t)image;
  return image < 0 ? NULL : world->images.items[image].mipmap;
}

static void free_lamp(VL_UNUSED vlContext *context, void *lamp) {
  vl_lamp_destroy(lamp);
}

/* Reads the lamp file. Null on error. */
static const vlLamp *add_lamp(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                              vlError *error) {
  vlLamp *lamp = NULL;
  vlResult r = def->lamp_data ? vl_lamp_read(world->context, "lamp file in memory",
                                             def->lamp_data, def->lamp_size, &lamp, error)
                              : vl_lamp_open(world->context, def->path, false, &lamp, error);
  if (r != VL_OK)
    return NULL;
  vlPart *part = vl_part_add(world);
  if (part) {
    part->destroy = free_lamp;
    part->object = lamp;
  }
  const vlLamp **slot = part ? VL_PUSH(world->context, &world->lamps) : NULL;
  if (!part)
    vl_lamp_destroy(lamp);
  if (!slot) {
    vl_fail_memory(error);
    return NULL;
  }
  *slot = lamp;
  light->lamp = (uint32_t)world->lamps.count - 1;
  return lamp;
}

/* The rotation from world to the directions of the lamp's table. */
static bool set_lamp_frame(const vlLightDef *def, const vlLamp *lamp, vlWorldLight *light) {
  vlMat4 inverse;
  if (!vl_mat4_inverse(vl_mat4_load(def->world_from_light), &inverse))
    return false;
  const float *frame = lamp->table.frame;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double sum = 0;
      for (int k = 0; k < 3; k++)
        sum += (double)frame[3 * i + k] * inverse.m[4 * k + j];
      light->corners[3 * i + j] = (float)sum;
    }
  return true;
}

/* The flux of a lamp in its frame, lumens. */
static double lamp_flux(const vlLamp *lamp, const vlLightDef *def) {
  const vlStretch stretch = vl_stretch(def->world_from_light);
  if (!stretch.is_skewed)
    return lamp->info.flux;
  double straight = 0, skewed = 0;
  for (int i = 0; i < SQUARE * SQUARE; i++) {
    double direction[3];
    square_direction((i % SQUARE + 0.5) / SQUARE, (i / SQUARE + 0.5) / SQUARE, direction);
    const double candela = vl_lamp_intensity(lamp, direction);
    straight += candela;
    skewed += candela * vl_stretch_at(&stretch, direction);
  }
  return straight > 0 ? lamp->info.flux * skewed / straight : 0;
}

/* The intensity is that of the lamp file in candela, times the colour's, whose luminance is
 * 1. */
static vlResult compile_lamp(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                             vlEmitted *e, vlError *error) {
  const vlLamp *lamp = add_lamp(world, def, light, error);
  if (!lamp)
    return error->code;
  if (!set_lamp_frame(def, lamp, light))
    return vl_fail(error, VL_ERROR_SCENE, "the light's transform is singular");
  const double flux = lamp_flux(lamp, def);
  vlResult r = vl_light_color(world, &def->color, (float)scale_of(def, flux), e, error);
  light->power = (float)flux * vl_light_luminance(&e->spectrum);
  return r;
}

vlResult vl_compile_light_goniometric(vlWorld *world, const vlLightDef *def,
                                      vlWorldLight *light, vlEmitted *e, vlError *error) {
  if (def->lamp_data || (!def->image && vl_names_lamp(def->path)))
    return compile_lamp(world, def, light, e, error);
  const vlMipmap *mip = add_image(world, def, light, error);
  if (!mip)
    return error->code;
  return add_goniometric(world, def, mip, light, e, error);
}

vlResult vl_compile_light_projection(vlWorld *world, const vlLightDef *def, vlWorldLight *light,
                                     vlEmitted *e, vlError *error) {
  const vlMipmap *mip = add_image(world, def, light, error);
  if (!mip)
    return error->code;
  light->has_cone = true;
  return add_projection(world, def, mip, light, e, error);
}
