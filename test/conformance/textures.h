/* conformance/textures.h: the laws of textures, seen as the reflectance of a square with
 * texture coordinates 0 to 1: known values, values between those of the inputs, and a pattern
 * that is one. */
#ifndef TEST_CONFORMANCE_TEXTURES_H
#define TEST_CONFORMANCE_TEXTURES_H

#include "conformance.h"
#include "parameter_cases.h"
#include "unit.h"

/* ---- asking ------------------------------------------------------------------------------ */

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
  if (!v->even && !((double)(high - low) > 0.02))
    broken("textures", t->kind, "%s: no pattern", v->parameters);
}

#define HALVES                                                                           \
  "Texture \"halves\" \"float\" \"checkerboard\" \"float uscale\" 2 \"float vscale\" 0 " \
  "\"float "                                                                             \
  "tex1\" .1 "                                                                           \
  "\"float tex2\" .8\n"

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
