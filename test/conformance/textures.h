/* conformance/textures.h: the laws of textures, seen as the reflectance of a square with
 * texture coordinates 0 to 1: known values, values between those of the inputs, and a pattern
 * that is one; and as that of a ball: textures of space vary along each axis, and each mapping
 * gives the coordinates that its formula says. */
#ifndef TEST_CONFORMANCE_TEXTURES_H
#define TEST_CONFORMANCE_TEXTURES_H

#include "../world/plain_noise.h"
#include "conformance.h"
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
  double is, not ; /* of one of the wrong values */
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
    f->is = value;
    f->not = known;
  }
  f->points++;
  f->wrong += wrong;
}
static void judge_formula(const TextureLaws *t, const Formulas *f) {
  if (f->wrong > f->points / 50)
    broken("textures", t->kind, "%s: %u of %u values, such as %.4f, not %.4f",
           t->variant->parameters, f->wrong, f->points, f->is, f->not );
}

/* The square spans -1 to 1; its texture coordinates are 0 to 1. */
static void ask_texture(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  const TextureLaws *t = probe->user;
  const TextureVariant *v = t->variant;
  const double down[3] = {0, 0, -1};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double at[2] = {fmod(0.5 + i * 0.7548776662466927, 1.0),
                    fmod(0.5 + i * 0.5698402909980532, 1.0)};
    if (i < v->known_count) {
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
      if (i < v->known_count && fabs((double)value - v->known[i].rgb[c]) > 3e-3)
        broken("textures", t->kind, "%s: value %.4f at uv (%g, %g), not %.4f", v->parameters,
               (double)value, v->known[i].u, v->known[i].v, v->known[i].rgb[c]);
    }
  Formulas formulas = {0};
  for (uint32_t i = 0; v->formula && i < VL_OWN_BATCH; i++) {
    double x = (double)t->rays->origin[0][i];
    double y = (double)t->rays->origin[1][i];
    const TextureAt at = {0.5 * (x + 1), 0.5 * (y + 1), {x, y, 0}, plain_noise};
    compare_formula(t, i, &at, &formulas);
  }
  judge_formula(t, &formulas);
  if (!v->even && !((double)(high - low) > 0.02))
    broken("textures", t->kind, "%s: no pattern", v->parameters);
}

#define HALVES                                                                           \
  "Texture \"halves\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 0 " \
  "\"float "                                                                             \
  "tex1\" .1 "                                                                           \
  "\"float tex2\" .8\n"

/* ---- on a ball --------------------------------------------------------------------------- */

/* The colours of the unit sphere at `count` points. */
static void look_at_ball(vlTrace *trace, TextureLaws *t, const double (*points)[3],
                         uint32_t count) {
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double *p = points[i % count];
    const double origin[3] = {2 * p[0], 2 * p[1], 2 * p[2]};
    const double inwards[3] = {-p[0], -p[1], -p[2]};
    set_ray(t->rays, i, origin, inwards);
  }
  vl_world_trace(trace, t->rays, t->hits);
}

/* Compares those of a kind of texture space, where it has a formula. */
static void check_ball_formula(const TextureLaws *t, const double (*points)[3]) {
  Formulas formulas = {0};
  for (uint32_t i = 0; t->variant->formula && i < VL_OWN_BATCH; i++) {
    TextureAt at = {.noise = plain_noise};
    memcpy(at.p, points[i], sizeof at.p);
    compare_formula(t, i, &at, &formulas);
  }
  judge_formula(t, &formulas);
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
    look_at_ball(trace, t, points, VL_OWN_BATCH);
    for (uint32_t i = 0; i < HALF; i++)
      differ += fabsf(t->hits->reflectance[1][i] - t->hits->reflectance[1][HALF + i]) > 0.005f;
    check_ball_formula(t, points);
    if (differ < HALF / 10)
      broken("textures", t->kind, "%s: does not vary along %c", t->variant->parameters,
             "xyz"[axis]);
  }
}

/* Looks at the ball of a scene. */
static void ask_textured_ball(const char *text, TextureLaws *t,
                              void (*ask)(Probe *, vlTrace *, const vlOwnPaths *)) {
  Probe probe = {.ask = ask, .user = t};
  t->rays = new_rays();
  t->hits = calloc(1, sizeof *t->hits);
  assert_non_null(t->hits);
  probe_world(text, &probe, 1);
  free(t->rays);
  free(t->hits);
}

/* What a ray sees that resolves one and a half of eight octaves, each .4 of the one before. */
static double seen_by_wide(const char *kind, const double q[3]) {
  const double first = plain_noise(q[0], q[1], q[2]);
  const double second = plain_noise(1.99 * q[0], 1.99 * q[1], 1.99 * q[2]);
  if (strcmp(kind, "fbm") == 0)
    return first + 0.5 * 0.4 * second;
  double sum = fabs(first) + 0.4 * (0.5 * 0.2 + 0.5 * fabs(second));
  for (int octave = 1; octave < 8; octave++)
    sum += 0.2 * pow(0.4, octave);
  return sum;
}

/* Of a noise of many octaves a wide ray sees those that it resolves (pbrt, 3rd edition, 10.6):
 * n = -1 - log2 of its width in texture space, and of the next as much as a smooth step from .3
 * to .7 gives of the rest. What turbulence does not resolve counts with a fifth. Texture space
 * is the world, stretched by 5 along z, and turned. The width is such that n is 1.5. */
static void ask_wide_rays(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  TextureLaws *t = probe->user;
  uint32_t wrong = 0;
  double is = 0;
  double known = 0;
  (void)paths;
  const double turn = PI / 6;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double p[3];
    even_direction(i, VL_OWN_BATCH, 0.3, p);
    const double origin[3] = {2 * p[0], 2 * p[1], 2 * p[2]};
    const double inwards[3] = {-p[0], -p[1], -p[2]};
    set_ray(t->rays, i, origin, inwards);
    t->rays->width[i] = (float)(exp2(-2.5) / 5);
  }
  vl_world_trace(trace, t->rays, t->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double p[3];
    even_direction(i, VL_OWN_BATCH, 0.3, p);
    const double z = 5 * p[2];
    const double q[3] = {p[0], cos(turn) * p[1] + sin(turn) * z,
                         cos(turn) * z - sin(turn) * p[1]};
    const double value = seen_by_wide(t->kind, q);
    const double seen = (double)t->hits->reflectance[1][i];
    if (fabs(seen - fmin(fmax(value, 0), 1)) <= 3e-3)
      continue;
    wrong++;
    is = seen;
    known = value;
  }
  if (wrong > VL_OWN_BATCH / 50)
    broken("textures", t->kind, "wide rays: %u of %u values, such as %.4f, not %.4f", wrong,
           VL_OWN_BATCH, is, known);
}

static void laws_of_footprints(void **state) {
  (void)state;
  static const char *const kinds[] = {"fbm", "wrinkled"};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
    char text[TEXT];
    TextureLaws t = {.kind = kinds[i]};
    snprintf(text, sizeof text,
             HEAD
             "WorldBegin LightSource \"infinite\" AttributeBegin Scale 1 1 .2 Rotate 30 1 0 0\n"
             "Texture \"f\" \"float\" \"%s\" \"float roughness\" .4 Texture \"t\" \"spectrum\" "
             "\"scale\" \"rgb tex\" [1 1 1] \"texture scale\" \"f\"\n"
             "AttributeEnd Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"",
             kinds[i]);
    ask_textured_ball(text, &t, ask_wide_rays);
  }
  expect_no_failures();
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
  look_at_ball(trace, t, points, VL_OWN_BATCH);
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
    ask_textured_ball(text, &t, ask_mapping);
  }
  expect_no_failures();
}

/* ---- all --------------------------------------------------------------------------------- */

static void laws_of_textures(void **state) {
  (void)state;
  static char text[TEXT];
  const vlKindFamily *family = vl_kind_family_find("textures");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    const TextureCase *c = texture_cases[k];
    assert_true(!row->name || c->variants[0].parameters);
    const char *form =
        row->traits & VL_TEXTURE_FLOAT_ONLY ? HEAD
            "WorldBegin LightSource \"infinite\" Texture \"f\" \"float\" %s Texture \"t\" "
            "\"spectrum\" \"scale\" \"rgb tex\" [1 1 1] \"texture scale\" \"f\" "
            "Material \"diffuse\" \"texture reflectance\" \"t\" "
                                            : HEAD
            "WorldBegin LightSource \"infinite\" " HALVES
            "Texture \"t\" \"spectrum\" %s "
            "Material \"diffuse\" \"texture reflectance\" \"t\" ";
    for (int i = 0; i < TEXTURE_VARIANTS && row->name && c->variants[i].parameters; i++) {
      TextureLaws t = {.kind = row->name, .variant = &c->variants[i], .rays = new_rays()};
      t.hits = calloc(1, sizeof *t.hits);
      Probe probe = {.ask = ask_texture, .user = &t};
      scene_text(text, form, row->name, c->variants[i].parameters);
      size_t length = strlen(text);
      strcat(text, SQUARE_UP);
      probe_world(text, &probe, 1);
      free(t.rays);
      free(t.hits);
      strcpy(text + length, "Shape \"sphere\"");
      if (c->variants[i].of_space)
        ask_textured_ball(text, &t, ask_along_axes);
    }
  }
  expect_no_failures();
}

#endif
