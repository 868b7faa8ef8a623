/* conformance/textures.h: the laws of textures, seen as the reflectance of a square with texture coordinates 0 to 1:
 * known values, values between those of the inputs, and a pattern that is one. */
#ifndef TEST_CONFORMANCE_TEXTURES_H
#define TEST_CONFORMANCE_TEXTURES_H

#include "conformance.h"

typedef struct TextureKnown {
  double u, v;
  double rgb[3];
} TextureKnown;

typedef struct TextureVariant {
  const char *parameters; /* null ends the list */
  double low, high;       /* of all values */
  bool even;              /* the same value everywhere */
  TextureKnown known[5];
  uint32_t known_count;
} TextureVariant;

enum { TEXTURE_VARIANTS = 3 };
typedef struct TextureCase {
  TextureVariant variants[TEXTURE_VARIANTS];
} TextureCase;

static const TextureCase constant_texture = {{
    {.parameters = "\"rgb value\" [.7 .4 .2]",
     .low = .2,
     .high = .7,
     .even = true,
     .known = {{.3, .4, {.7, .4, .2}}},
     .known_count = 1},
}};
static const TextureCase scale_texture = {{
    {.parameters = "\"rgb tex\" [.8 .4 .2] \"float scale\" .5",
     .low = .1,
     .high = .4,
     .even = true,
     .known = {{.3, .4, {.4, .2, .1}}},
     .known_count = 1},
    {.parameters = "\"rgb tex\" [.8 .8 .8] \"texture scale\" \"halves\"",
     .low = .08,
     .high = .64,
     .known = {{.25, .4, {.08, .08, .08}}, {.75, .4, {.64, .64, .64}}},
     .known_count = 2},
}};
static const TextureCase mix_texture = {{
    {.parameters = "\"rgb tex1\" [.8 .4 .2] \"rgb tex2\" [.1 .2 .3] \"float amount\" .25",
     .low = .1,
     .high = .8,
     .even = true,
     .known = {{.3, .4, {.75 * .8 + .25 * .1, .75 * .4 + .25 * .2, .75 * .2 + .25 * .3}}},
     .known_count = 1},
    {.parameters = "\"rgb tex1\" [.5 .5 .5] \"rgb tex2\" [1 1 1] \"texture amount\" \"halves\"",
     .low = .5,
     .high = 1,
     .known = {{.25, .4, {.55, .55, .55}}, {.75, .4, {.9, .9, .9}}},
     .known_count = 2},
}};
static const TextureCase checkerboard_texture = {{
    {.parameters = "\"float uscale\" 2 \"float vscale\" 2 \"rgb tex1\" [.8 .7 .6] \"rgb tex2\" [.1 .2 .3]",
     .low = .1,
     .high = .8,
     .known = {{.25, .25, {.8, .7, .6}}, {.75, .25, {.1, .2, .3}}, {.25, .75, {.1, .2, .3}}, {.75, .75, {.8, .7, .6}}},
     .known_count = 4},
    {.parameters = "\"float uscale\" 1 \"float udelta\" .5 \"rgb tex1\" [.8 .8 .8] \"rgb tex2\" [.1 .1 .1]",
     .low = .1,
     .high = .8,
     .known = {{.25, .25, {.8, .8, .8}}, {.75, .25, {.1, .1, .1}}},
     .known_count = 2},
    /* the square lies at z = 0 from -1 to 1 */
    {.parameters = "\"integer dimension\" 3 \"rgb tex1\" [.8 .8 .8] \"rgb tex2\" [.1 .1 .1]",
     .low = .1,
     .high = .8,
     .known = {{.75, .75, {.8, .8, .8}}, {.25, .75, {.1, .1, .1}}, {.25, .25, {.8, .8, .8}}},
     .known_count = 3},
}};
static const TextureCase image_texture = {{
    {.parameters = "\"string filename\" \"quarters.pfm\"",
     .low = .2,
     .high = .8,
     .known = {{.25, .25, {.6, .6, .6}}, {.75, .25, {.8, .8, .8}}, {.25, .75, {.2, .2, .2}}, {.75, .75, {.4, .4, .4}}},
     .known_count = 4},
    {.parameters =
         "\"string filename\" \"quarters.pfm\" \"bool invert\" true \"float scale\" .5 \"string filter\" \"point\"",
     .low = .6,
     .high = .9,
     .known = {{.25, .25, {.7, .7, .7}}, {.75, .75, {.8, .8, .8}}},
     .known_count = 2},
}};
/* The square's normal is +z. */
static const TextureCase direction_mix_texture = {{
    {.parameters = "\"rgb tex1\" [.8 .4 .2] \"rgb tex2\" [.1 .2 .3] \"vector3 dir\" [0 0 1]",
     .low = .1,
     .high = .8,
     .even = true,
     .known = {{.3, .4, {.8, .4, .2}}},
     .known_count = 1},
    {.parameters = "\"rgb tex1\" [.8 .4 .2] \"rgb tex2\" [.1 .2 .3] \"vector3 dir\" [0 .8 -.6]",
     .low = .1,
     .high = .8,
     .even = true,
     .known = {{.3, .4, {.6 * .8 + .4 * .1, .6 * .4 + .4 * .2, .6 * .2 + .4 * .3}}},
     .known_count = 1},
}};
static const TextureCase bilerp_texture = {{
    {.parameters = "\"rgb v00\" [.1 .1 .1] \"rgb v01\" [.3 .3 .3] \"rgb v10\" [.5 .5 .5] \"rgb v11\" [.9 .9 .9]",
     .low = .1,
     .high = .9,
     .known = {{.001, .001, {.1, .1, .1}},
               {.001, .999, {.3, .3, .3}},
               {.999, .001, {.5, .5, .5}},
               {.5, .5, {.45, .45, .45}}},
     .known_count = 4},
}};
/* The noise is 0 at points of the lattice: here at uv = (.5, .5), which is the origin. */
static const TextureCase fbm_texture = {{
    {.parameters = "\"integer octaves\" 3", .low = 0, .high = 1, .known = {{.5, .5, {0, 0, 0}}}, .known_count = 1},
}};
static const TextureCase wrinkled_texture = {{
    {.parameters = "\"integer octaves\" 3 \"float roughness\" .3", .low = 0, .high = 1},
}};
static const TextureCase windy_texture = {{
    {.parameters = "", .low = 0, .high = 1, .known = {{.5, .5, {0, 0, 0}}}, .known_count = 1},
}};
static const TextureCase marble_texture = {{
    {.parameters = "\"float scale\" 3 \"float variation\" .4", .low = 0, .high = 1},
}};
static const TextureCase dots_texture = {{
    {.parameters = "\"float uscale\" 9 \"float vscale\" 9 \"rgb inside\" [.8 .7 .6] \"rgb outside\" [.1 .2 .3]",
     .low = .1,
     .high = .8},
}};
/* Files cannot name it: vertex colours come with meshes of glTF, PLY and OBJ. */
static const TextureCase vertex_color_texture = {{{.parameters = NULL}}};

#define TEXTURE_CASE(NAME, name) &name##_texture,
static const TextureCase *const texture_cases[] = {VL_TEXTURE_KINDS(TEXTURE_CASE)};

/* ---- asking ------------------------------------------------------------------------------------------------------ */

typedef struct TextureLaws {
  const char *kind;
  const TextureVariant *variant;
  vlTraceRays *rays;
  vlTraceHits *hits;
} TextureLaws;

/* The square spans -1 to 1; its texture coordinates are 0 to 1. */
static void ask_texture(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  const TextureLaws *t = probe->user;
  const TextureVariant *v = t->variant;
  const double down[3] = {0, 0, -1};
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double at[2] = {fmod(0.5 + i * 0.7548776662466927, 1.0), fmod(0.5 + i * 0.5698402909980532, 1.0)};
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
        broken("textures", t->kind, "%s: value %.4f, between %.4f and %.4f expected", v->parameters, (double)value,
               v->low, v->high);
        return;
      }
      if (i < v->known_count && fabs((double)value - v->known[i].rgb[c]) > 3e-3)
        broken("textures", t->kind, "%s: value %.4f at uv (%g, %g), not %.4f", v->parameters, (double)value,
               v->known[i].u, v->known[i].v, v->known[i].rgb[c]);
    }
  if (!v->even && !((double)(high - low) > 0.02)) broken("textures", t->kind, "%s: no pattern", v->parameters);
}

#define HALVES                                                                                             \
  "Texture \"halves\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 0 \"float tex1\" .1 " \
  "\"float tex2\" .8\n"

static void laws_of_textures(void **state) {
  (void)state;
  static char text[TEXT];
  const vlKindFamily *family = vl_kind_family_find("textures");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    const TextureCase *c = texture_cases[k];
    assert_true(!row->name || c->variants[0].parameters);
    const char *form = row->traits & VL_TEXTURE_FLOAT_ONLY ? HEAD
                           "WorldBegin LightSource \"infinite\" Texture \"f\" \"float\" %s Texture \"t\" "
                           "\"spectrum\" \"scale\" \"rgb tex\" [1 1 1] \"texture scale\" \"f\" "
                           "Material \"diffuse\" \"texture reflectance\" \"t\" " SQUARE_UP
                                                           : HEAD
                           "WorldBegin LightSource \"infinite\" " HALVES
                           "Texture \"t\" \"spectrum\" %s "
                           "Material \"diffuse\" \"texture reflectance\" \"t\" " SQUARE_UP;
    for (int i = 0; i < TEXTURE_VARIANTS && row->name && c->variants[i].parameters; i++) {
      TextureLaws t = {.kind = row->name, .variant = &c->variants[i], .rays = new_rays()};
      t.hits = calloc(1, sizeof *t.hits);
      Probe probe = {.ask = ask_texture, .user = &t};
      scene_text(text, form, row->name, c->variants[i].parameters);
      probe_world(text, &probe, 1);
      free(t.rays);
      free(t.hits);
    }
  }
  expect_no_failures();
}

#endif
