/* import/pbrt/upgrade/detect.c: recognises scenes of pbrt-v3 and pbrt-v2. */
#include "import/pbrt/upgrade/detect.h"

#include <stdio.h>

#include "base/file.h"
#include "base/text.h"
#include "import/pbrt/token.h"

/* Directives, and kinds of directives, that pbrt-v4 does not have. kind null: any. */
static const struct {
  const char *directive, *kind;
  int version;
} signs[] = {{"WorldEnd", NULL, 3},
             {"Film", "image", 3},
             {"SurfaceIntegrator", NULL, 2},
             {"VolumeIntegrator", NULL, 2},
             {"Renderer", NULL, 2},
             {"Camera", "environment", 3},
             {"Sampler", "lowdiscrepancy", 3},
             {"Sampler", "02sequence", 3},
             {"Sampler", "zerotwosequence", 3},
             {"Sampler", "maxmindist", 3},
             {"Sampler", "random", 3},
             {"Integrator", "directlighting", 3},
             {"Integrator", "whitted", 3},
             {"Integrator", "ao", 3},
             {"Material", "matte", 3},
             {"Material", "plastic", 3},
             {"Material", "metal", 3},
             {"Material", "glass", 3},
             {"Material", "mirror", 3},
             {"Material", "uber", 3},
             {"Material", "substrate", 3},
             {"Material", "translucent", 3},
             {"Material", "kdsubsurface", 3},
             {"Material", "fourier", 3},
             {"Material", "disney", 3}};

static bool is_word(const vlToken *t, const char *word) {
  return t->kind == VL_TOKEN_WORD && strlen(word) == t->length &&
         memcmp(word, t->text, t->length) == 0;
}

/* The first sign of the highest rank: signs of pbrt-v2 count more. */
static void look(vlOldScene *found, char *data, size_t size) {
  vlTokenizer tokens;
  vlToken before = {.kind = VL_TOKEN_END};
  vl_tokenizer_start(&tokens, data, size);
  for (;;) {
    vlToken t = vl_token_next(&tokens);
    if (t.kind == VL_TOKEN_END || t.kind == VL_TOKEN_BAD)
      return;
    for (size_t i = 0; i < VL_LENGTH(signs); i++) {
      bool kind = signs[i].kind != NULL;
      const vlToken *word = kind ? &before : &t;
      if (!is_word(word, signs[i].directive))
        continue;
      if (kind && (t.kind != VL_TOKEN_STRING || !vl_text_is(t.text, signs[i].kind)))
        continue;
      if (found->version && found->version <= signs[i].version)
        continue;
      *found =
          (vlOldScene){.version = signs[i].version, .line = word->line, .column = word->column};
      snprintf(found->sign, sizeof found->sign, kind ? "%s \"%s\"" : "%s", signs[i].directive,
               kind ? t.text : "");
    }
    before = t;
  }
}

vlOldScene vl_old_scene_text(char *text, size_t size) {
  vlOldScene found = {0};
  look(&found, text, size);
  return found;
}

vlOldScene vl_old_scene(vlContext *context, const char *path) {
  char *data;
  size_t size;
  if (vl_file_read_given(context, path, true, &data, &size, NULL) != VL_OK)
    return (vlOldScene){0};
  const vlOldScene found = vl_old_scene_text(data, size);
  vl_free(context, data);
  return found;
}
