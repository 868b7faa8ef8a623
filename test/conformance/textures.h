/* conformance/textures.h: the laws of textures, seen as the reflectance of a square with
 * texture coordinates 0 to 1: known values, values between those of the inputs, and a pattern
 * that is one; and as that of a ball: textures of space vary along each axis, and each mapping
 * gives the coordinates that its formula says. */
#ifndef TEST_CONFORMANCE_TEXTURES_H
#define TEST_CONFORMANCE_TEXTURES_H

#include "../world/plain_noise.h"
#include "conformance.h"
#include "materials.h"
#include "parameter_cases.h"
#include "unit.h"

/* ---- asking ------------------------------------------------------------------------------ */

typedef struct TextureLaws {
  const char *kind;
  const TextureVariant *variant;
  const struct Mapping *mapping;
  vlTraceRays *rays;
  vlTraceHits *hits;
} TextureLaws;

/* What the formula of a kind says. */
typedef struct Formulas {
  uint32_t points, wrong;
  double value, expected; /* of one of the wrong ones */
} Formulas;

/* Compares the value at hit i with the formula at a point. */
static void compare_formula(const TextureLaws *t, uint32_t i, const TextureAt *at,
                            Formulas *f) {
  double rgb[3];
  t->variant->formula(at, rgb);
  bool wrong = false;
  for (int c = 0; c < 3; c++) {
    double known = fmin(fmax(rgb[c], 0), 1); /* a reflectance */
    double value = (double)t->hits->reflectance[c][i];
    if (fabs(value - known) <= 3e-3)
      continue;
    wrong = true;
    f->value = value;
    f->expected = known;
  }
  f->points++;
  f->wrong += wrong;
}
static void judge_formula(const TextureLaws *t, const char *what, const Formulas *f) {
  if (f->wrong > f->points / 50)
    broken("textures", t->kind, "%s: %s%u of %u values, such as %.4f, not %.4f",
           t->variant->parameters, what, f->wrong, f->points, f->value, f->expected);
}

static uint32_t known_values(const TextureVariant *v) {
  uint32_t n = 0;
  while (n < sizeof v->known / sizeof *v->known && (v->known[n].u != 0 || v->known[n].v != 0))
    n++;
  return n;
}

/* The square spans -1 to 1; its texture coordinates are 0 to 1. */
static void ask_texture(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  const TextureLaws *t = probe->user;
  const TextureVariant *v = t->variant;
  const double down[3] = {0, 0, -1};
  const uint32_t known = known_values(v);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double at[2] = {fmod(0.5 + i * 0.7548776662466927, 1.0),
                    fmod(0.5 + i * 0.5698402909980532, 1.0)};
    if (i < known) {
      at[0] = v->known[i].u;
      at[1] = v->known[i].v;
    }
    const double origin[3] = {2 * at[0] - 1, 2 * at[1] - 1, 1};
    set_ray(t->rays, i, origin, down);
  }
  vl_world_trace(trace, t->rays, t->hits);
  float low = INFINITY;
  float high = -INFINITY;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    for (int c = 0; c < 3; c++) {
      float value = t->hits->reflectance[c][i];
      low = fminf(low, value);
      high = fmaxf(high, value);
      if (!((double)value >= v->low - 1e-3 && (double)value <= v->high + 1e-3)) {
        broken("textures", t->kind, "%s: value %.4f, between %.4f and %.4f expected",
               v->parameters, (double)value, v->low, v->high);
        return;
      }
      if (i < known && fabs((double)value - v->known[i].rgb[c]) > 3e-3)
        broken("textures", t->kind, "%s: value %.4f at uv (%g, %g), not %.4f", v->parameters,
               (double)value, v->known[i].u, v->known[i].v, v->known[i].rgb[c]);
    }
  Formulas formulas = {0};
  for (uint32_t i = 0; v->formula && i < VL_OWN_BATCH; i++) {
    double x = (double)t->rays->origin[0][i];
    double y = (double)t->rays->origin[1][i];
    const TextureAt at = {0.5 * (x + 1), 0.5 * (y + 1), {x, y, 0}, 0, plain_noise};
    compare_formula(t, i, &at, &formulas);
  }
  judge_formula(t, "", &formulas);
  if (!v->even && !((double)(high - low) > 0.02))
    broken("textures", t->kind, "%s: no pattern", v->parameters);
}

#define HALVES                                     \
  "Texture \"halves\" \"float\" \"checkerboard\" " \
  "\"float uscale\" 2 \"float vscale\" 0 "         \
  "\"float tex1\" .1 \"float tex2\" .8\n"

/* ---- on a ball --------------------------------------------------------------------------- */

/* The colours of the unit sphere at some points, for rays of a width. */
static void look_at_ball(vlTrace *trace, TextureLaws *t, const double (*points)[3],
                         double width) {
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double *p = points[i];
    const double origin[3] = {2 * p[0], 2 * p[1], 2 * p[2]};
    const double inwards[3] = {-p[0], -p[1], -p[2]};
    set_ray(t->rays, i, origin, inwards);
    t->rays->width[i] = (float)width;
  }
  vl_world_trace(trace, t->rays, t->hits);
}

/* Compares those of a kind of texture space, where it has a formula. points, width: there. */
static void check_ball_formula(const TextureLaws *t, const double (*points)[3], double width) {
  Formulas formulas = {0};
  for (uint32_t i = 0; t->variant->formula && i < VL_OWN_BATCH; i++) {
    TextureAt at = {.width = width, .noise = plain_noise};
    memcpy(at.p, points[i], sizeof at.p);
    compare_formula(t, i, &at, &formulas);
  }
  judge_formula(t, width > 0 ? "wide rays, " : "", &formulas);
}

/* The second half of the points mirrors the first. */
static void ask_along_axes(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  enum { HALF = VL_OWN_BATCH / 2 };
  static double points[VL_OWN_BATCH][3];
  TextureLaws *t = probe->user;
  (void)paths;
  for (int axis = 0; axis < 3; axis++) {
    int differ = 0;
    for (uint32_t i = 0; i < HALF; i++) {
      even_direction(i, HALF, 0.3, points[i]);
      memcpy(points[HALF + i], points[i], sizeof points[i]);
      points[HALF + i][axis] *= -1;
    }
    look_at_ball(trace, t, points, 0);
    for (uint32_t i = 0; i < HALF; i++)
      differ += fabsf(t->hits->reflectance[1][i] - t->hits->reflectance[1][HALF + i]) > 0.005f;
    check_ball_formula(t, points, 0);
    if (differ < HALF / 10)
      broken("textures", t->kind, "%s: does not vary along %c", t->variant->parameters,
             "xyz"[axis]);
  }
}

/* Texture space is the world, stretched by 5 along z, and turned. */
static void stretched(const double p[3], double q[3]) {
  const double turn = PI / 6;
  const double z = 5 * p[2];
  q[0] = p[0];
  q[1] = cos(turn) * p[1] + sin(turn) * z;
  q[2] = cos(turn) * z - sin(turn) * p[1];
}

/* Compares what rays of a width see with the formula. The width in texture space is that by the
 * largest stretch. */
static void ask_width(vlTrace *trace, TextureLaws *t, double width) {
  static double points[VL_OWN_BATCH][3];
  static double at[VL_OWN_BATCH][3];
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    even_direction(i, VL_OWN_BATCH, 0.3, points[i]);
    stretched(points[i], at[i]);
  }
  look_at_ball(trace, t, points, width);
  check_ball_formula(t, at, 5 * width);
}

/* Rays so wide that of an octave of noise they see a half, of two the finer, and of many those
 * that are not too fine. */
static void ask_wide_rays(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  static const double octaves[] = {0.5, 1.55, 2.4, 4.5};
  (void)paths;
  for (size_t i = 0; i < sizeof octaves / sizeof *octaves; i++)
    ask_width(trace, probe->user, exp2(-1 - octaves[i]) / 5);
}

/* Asks a world, by rays and hits that live as long as that. */
static void ask_textured_scene(vlScene *scene, const char *text, TextureLaws *t,
                               void (*ask)(Probe *, vlTrace *, const vlOwnPaths *)) {
  Probe probe = {.ask = ask, .user = t};
  t->rays = new_rays();
  t->hits = calloc(1, sizeof *t->hits);
  assert_non_null(t->hits);
  probe_scene(scene, text, &probe, 1);
  free(t->rays);
  free(t->hits);
}
static void ask_textured(const char *text, TextureLaws *t,
                         void (*ask)(Probe *, vlTrace *, const vlOwnPaths *)) {
  ask_textured_scene(need_scene(text), text, t, ask);
}

/* A mapping with its formula. q: a point of texture space. */
typedef struct Mapping {
  const char *name, *parameters;
  void (*st)(const double q[3], double st[2]);
} Mapping;

static void planar_st(const double q[3], double st[2]) {
  st[0] = 0.5 + 0.4 * q[0] + 0.1 * q[2];
  st[1] = 0.4 + 0.1 * q[0] + 0.3 * q[1] - 0.2 * q[2];
}
static void cylindrical_st(const double q[3], double st[2]) {
  st[0] = (PI + atan2(q[1], q[0])) / (2 * PI);
  st[1] = q[2];
}
static void spherical_st(const double q[3], double st[2]) {
  double azimuth = atan2(q[1], q[0]);
  st[0] = acos(q[2] / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2])) / PI;
  st[1] = (azimuth < 0 ? azimuth + 2 * PI : azimuth) / (2 * PI);
}

static const Mapping mappings[] = {
    {"planar",
     "\"vector3 v1\" [.4 0 .1] \"vector3 v2\" [.1 .3 -.2] \"float udelta\" .5 \"float vdelta\" .4",
     planar_st},
    {"cylindrical", "", cylindrical_st},
    {"spherical", "", spherical_st},
};

/* The texture is red = s and green = t; texture space is the world divided by (2, 1, .5). */
static void ask_mapping(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  static double points[VL_OWN_BATCH][3];
  TextureLaws *t = probe->user;
  int compared = 0;
  double worst = 0;
  (void)paths;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    even_direction(i, VL_OWN_BATCH, 0.1, points[i]);
  look_at_ball(trace, t, points, 0);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double q[3] = {points[i][0] / 2, points[i][1], points[i][2] * 2};
    double st[2];
    t->mapping->st(q, st);
    if (!(fmin(st[0], st[1]) > 0.01 && fmax(st[0], st[1]) < 0.99))
      continue;
    compared++;
    for (int c = 0; c < 2; c++)
      worst = fmax(worst, fabs((double)t->hits->reflectance[c][i] - st[c]));
  }
  if (compared < VL_OWN_BATCH / 8 || !(worst < 2e-3))
    broken("textures", t->mapping->name, "coordinates of %d points are off by %.4f", compared,
           worst);
}

static void laws_of_mappings(void **state) {
  (void)state;
  char text[TEXT];
  for (size_t i = 0; i < sizeof mappings / sizeof *mappings; i++) {
    TextureLaws t = {.mapping = &mappings[i]};
    snprintf(text, sizeof text,
             HEAD
             "WorldBegin LightSource \"infinite\" AttributeBegin Scale 2 1 .5\n"
             "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [0 0 .5] \"rgb v10\" [1 0 .5] "
             "\"rgb v01\" [0 1 .5] \"rgb v11\" [1 1 .5] \"string mapping\" \"%s\" %s\n"
             "AttributeEnd Material \"diffuse\" \"texture reflectance\" \"t\" "
             "Shape \"sphere\"",
             mappings[i].name, mappings[i].parameters);
    ask_textured(text, &t, ask_mapping);
  }
  expect_no_failures();
}

/* ---- all --------------------------------------------------------------------------------- */

typedef void TextureLaw(const vlKindRow *row, const TextureVariant *variant);

static void each_texture(TextureLaw *law) {
  const vlKindFamily *family = vl_kind_family_find("textures");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    const TextureVariant *variants = texture_cases[k]->variants;
    assert_true(!row->name || variants[0].parameters);
    for (int i = 0; i < TEXTURE_VARIANTS && row->name && variants[i].parameters; i++)
      law(row, &variants[i]);
  }
  expect_no_failures();
}

/* A scene of one shape whose reflectance is the texture. space: its transform. */
static void textured_text(char text[TEXT], const vlKindRow *row, const TextureVariant *variant,
                          const char *space, const char *shape) {
  static const char head[] = HEAD "WorldBegin LightSource \"infinite\" " HALVES;
  static const char number[] =
      "Texture \"f\" \"float\" %s Texture \"t\" \"spectrum\" "
      "\"scale\" \"rgb tex\" [1 1 1] \"texture scale\" \"f\"\n";
  static const char color[] = "Texture \"t\" \"spectrum\" %s\n";
  char form[TEXT];
  snprintf(form, sizeof form,
           "%sAttributeBegin %s %sAttributeEnd Material \"diffuse\" "
           "\"texture reflectance\" \"t\" %s",
           head, space, row->traits & VL_TEXTURE_FLOAT_ONLY ? number : color, shape);
  scene_text(text, form, row->name, variant->parameters);
}

static void check_values(const vlKindRow *row, const TextureVariant *variant) {
  static char text[TEXT];
  TextureLaws t = {.kind = row->name, .variant = variant};
  textured_text(text, row, variant, "", SQUARE_UP);
  ask_textured(text, &t, ask_texture);
  textured_text(text, row, variant, "", "Shape \"sphere\"");
  if (variant->of_space)
    ask_textured(text, &t, ask_along_axes);
}

static void check_wide_rays(const vlKindRow *row, const TextureVariant *variant) {
  static char text[TEXT];
  TextureLaws t = {.kind = row->name, .variant = variant};
  if (!variant->of_space)
    return;
  textured_text(text, row, variant, "Scale 1 1 .2 Rotate 30 1 0 0", "Shape \"sphere\"");
  ask_textured(text, &t, ask_wide_rays);
}

/* What stands in for a computed texture in glTF lies between the texture's values. */
static void check_stand_in(const vlKindRow *row, const TextureVariant *variant) {
  static char text[TEXT];
  if (row->traits & VL_TEXTURE_FLOAT_ONLY)
    return;
  textured_text(text, row, variant, "", SQUARE_UP);
  vlScene *written = need_scene(text);
  vlScene *scene = read_again(written, "stand_in.gltf");
  vl_scene_destroy(written);
  const vlMaterialDef *material = vl_scene_material(scene, (vlMaterialId){1});
  const vlSpectrumInput *color = &material->reflectance;
  assert_true(color->texture.index || color->value.kind == VL_SPECTRUM_RGB);
  for (int c = 0; c < 3 && !color->texture.index; c++) {
    const double value = (double)color->value.rgb[c] * (double)color->value.scale;
    if (!(value >= variant->low - 1e-3 && value <= variant->high + 1e-3))
      broken("textures", row->name, "%s: as gltf %.4f stands in, not between %.4f and %.4f",
             variant->parameters, value, variant->low, variant->high);
  }
  vl_scene_destroy(scene);
}

/* Textures of a kind, each the input of the next by this parameter; the result of the build of
 * a world that uses them. */
static vlResult nest_textures(vlTextureKind kind, const vlParameter *p, bool spectrum,
                              int deep) {
  vlScene *scene = need_scene(HEAD "WorldBegin " LIGHTS);
  vlTextureId inner = {0};
  for (int i = 0; i < deep; i++) {
    vlTextureDef def = vl_default_texture_def(kind, spectrum);
    const bool colors = p->type == VL_PARAMETER_EITHER_INPUT && spectrum;
    char *at = (char *)&def + (colors ? p->second : p->offset);
    if (colors)
      ((vlSpectrumInput *)(void *)at)->texture = inner;
    else
      ((vlFloatInput *)(void *)at)->texture = inner;
    inner = vl_scene_add_texture(scene, &def);
  }
  vlMaterialDef material =
      vl_default_material_def(spectrum ? VL_MATERIAL_DIFFUSE : VL_MATERIAL_CONDUCTOR);
  if (spectrum)
    material.reflectance.texture = inner;
  else
    material.u_roughness.texture = inner;
  add_square(scene, &material);
  vlWorld *world = NULL;
  vlError error = {0};
  vlResult result = vl_world_build(scene, NULL, &world, &error);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return result;
}

/* Textures can be inputs of others by each of a kind's parameters, but not without end. */
static void check_nesting(const vlKindRow *row, vlTextureKind kind) {
  enum { FEW_LEVELS = 3, TOO_MANY = 200 };
  for (uint32_t i = 0; i < row->parameter_count; i++)
    for (int spectrum = 0; spectrum < 2; spectrum++) {
      const vlParameter *p = &row->parameters[i];
      const bool either = p->type == VL_PARAMETER_EITHER_INPUT;
      const bool no_colors = row->traits & VL_TEXTURE_FLOAT_ONLY;
      const bool no_numbers = row->traits & VL_TEXTURE_COLOR_ONLY;
      /* chains of numbers are chains of float textures */
      if (!(either || (p->type == VL_PARAMETER_FLOAT_INPUT && !spectrum)) ||
          (spectrum ? no_colors : no_numbers))
        continue;
      if (nest_textures(kind, p, spectrum, FEW_LEVELS) != VL_OK)
        broken("textures", row->name, "\"%s\": %s of %d levels are refused", p->name,
               spectrum ? "colours" : "numbers", FEW_LEVELS);
      if (nest_textures(kind, p, spectrum, TOO_MANY) != VL_ERROR_SCENE)
        broken("textures", row->name, "\"%s\": %s of %d levels are not refused", p->name,
               spectrum ? "colours" : "numbers", TOO_MANY);
    }
}

static void laws_of_textures(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("textures");
  for (uint32_t k = 0; k < family->kind_count; k++)
    check_nesting(family->rows[k], (vlTextureKind)k);
  each_texture(check_values);
  each_texture(check_stand_in);
}

static void laws_of_footprints(void **state) {
  (void)state;
  each_texture(check_wide_rays);
}

#endif
