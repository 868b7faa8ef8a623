/* conformance/footprints.h: a texture that reads the width of a ray gives about the mean of
 * what sharp rays see in the ray's footprint: of its own values, so that the law holds for any
 * kind. The square is seen at an angle, from all sides, so that footprints are four times as
 * long as wide. */
#ifndef TEST_CONFORMANCE_FOOTPRINTS_H
#define TEST_CONFORMANCE_FOOTPRINTS_H

#include "textures.h"

enum { PARTS = 61 }; /* of a footprint */

/* The middles of the footprints and the directions in which they are long, one per lane. */
typedef struct Footprints {
  double at[VL_OWN_BATCH][2], along[VL_OWN_BATCH][2];
  double mean[VL_OWN_BATCH], sharp[VL_OWN_BATCH];
} Footprints;

static const double long_by_wide = 4;

/* The footprints of a width stay within the square. */
static void place_footprints(double width, Footprints *f) {
  const double inner = 1 - long_by_wide * width / 2;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double azimuth = 2 * PI * fmod(i * 0.6180339887498949, 1.0);
    f->at[i][0] = inner * (2 * fmod(0.5 + i * 0.7548776662466927, 1.0) - 1);
    f->at[i][1] = inner * (2 * fmod(0.5 + i * 0.5698402909980532, 1.0) - 1);
    f->along[i][0] = cos(azimuth);
    f->along[i][1] = sin(azimuth);
  }
}

/* What sharp rays see at a part of each footprint; the parts are even in the ellipse. */
static void look_at_part(vlTrace *trace, TextureLaws *t, const Footprints *f, double width,
                         uint32_t part) {
  static const double down[3] = {0, 0, -1};
  const double radius = width / 2 * sqrt((part + 0.5) / PARTS);
  const double x = long_by_wide * radius * cos(2 * PI * part * 0.6180339887498949);
  const double y = radius * sin(2 * PI * part * 0.6180339887498949);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double *a = f->along[i];
    const double origin[3] = {f->at[i][0] + x * a[0] - y * a[1],
                              f->at[i][1] + x * a[1] + y * a[0], 1};
    set_ray(t->rays, i, origin, down);
  }
  vl_world_trace(trace, t->rays, t->hits);
}

static void look_by_wide_rays(vlTrace *trace, TextureLaws *t, const Footprints *f,
                              double width) {
  const double down = 1 / long_by_wide;
  const double side = sqrt(1 - down * down);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double *p = f->at[i];
    const double d[3] = {side * f->along[i][0], side * f->along[i][1], -down};
    const double origin[3] = {p[0] - d[0], p[1] - d[1], -d[2]};
    set_ray(t->rays, i, origin, d);
    t->rays->width[i] = (float)width;
  }
  vl_world_trace(trace, t->rays, t->hits);
}

static double green(const TextureLaws *t, uint32_t i) {
  return (double)t->hits->reflectance[1][i];
}

/* The mean of what sharp rays see over each footprint, and what one sees at its middle. */
static void find_means(vlTrace *trace, TextureLaws *t, double width, Footprints *f) {
  memset(f->mean, 0, sizeof f->mean);
  for (uint32_t part = 0; part < PARTS; part++) {
    look_at_part(trace, t, f, width, part);
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
      f->mean[i] += green(t, i) / PARTS;
  }
  look_at_part(trace, t, f, 0, 0);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    f->sharp[i] = green(t, i);
}

/* What wide rays see is nearer to the means than what sharp rays see, and than one value for
 * all is, that is: it is neither sharper nor more blurred than the footprint. */
static void check_width(vlTrace *trace, TextureLaws *t, double width) {
  static Footprints f;
  Mean means = {0};
  double off = 0;
  double sharp_off = 0;
  place_footprints(width, &f);
  find_means(trace, t, width, &f);
  look_by_wide_rays(trace, t, &f, width);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    off += pow(green(t, i) - f.mean[i], 2) / VL_OWN_BATCH;
    sharp_off += pow(f.sharp[i] - f.mean[i], 2) / VL_OWN_BATCH;
    mean_add(&means, f.mean[i]);
  }
  const double of_sharp = sqrt(off / sharp_off);
  const double of_blurred = sqrt(off / (variance_of_mean(&means) * (means.count - 1)));
  if (!(of_sharp < 0.35 && of_blurred < 0.35))
    broken("textures", t->kind,
           "%s: rays of the width %g are off the mean of their footprint by %.2f of what sharp "
           "rays are, by %.2f of what one value would be",
           t->variant->parameters, width, of_sharp, of_blurred);
}

static void ask_footprints(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  for (double width = 0.02; width < 0.06; width += 0.012)
    check_width(trace, probe->user, width);
}

/* glTF's turn of texture coordinates, and a stretch. */
static void turn_texture(vlTextureDef *def) {
  static const float map[6] = {1.7f, -0.5f, 0.2f, 0.9f, 0.8f, -0.3f};
  def->st_from_uv_given = true;
  memcpy(def->st_from_uv, map, sizeof map);
}

/* By the shape's second set of texture coordinates. The square of the text, out of the way,
 * only uses the texture. */
static void check_second_set(const vlKindRow *row, const TextureVariant *variant) {
  static char text[TEXT];
  TextureLaws t = {.kind = row->name, .variant = variant};
  textured_text(text, row, variant, "", "Translate 0 0 9 " SQUARE_UP);
  vlScene *scene = need_scene(text);
  const vlTextureId id = {2};
  vlError error = {0};
  vlTextureDef texture = *vl_scene_texture(scene, id);
  texture.uv_set = 1;
  assert_int_equal(vl_scene_set_texture(scene, id, &texture, &error), VL_OK);
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  material.reflectance.texture = id;
  add_square(scene, &material);
  ask_textured_scene(scene, text, &t, ask_footprints);
}

static void check_footprints(const vlKindRow *row, const TextureVariant *variant) {
  static char text[TEXT];
  TextureLaws t = {.kind = row->name, .variant = variant};
  if (!variant->filtered)
    return;
  textured_text(text, row, variant, "", SQUARE_UP);
  ask_textured(text, &t, ask_footprints);
  check_second_set(row, variant);
  change_texture = strcmp(row->name, "imagemap") == 0 ? turn_texture : NULL;
  if (change_texture)
    ask_textured(text, &t, ask_footprints);
  change_texture = NULL;
}

static void laws_of_means(void **state) {
  (void)state;
  each_texture(check_footprints);
}

#endif
