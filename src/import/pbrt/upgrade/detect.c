/* import/pbrt/upgrade/detect.c: recognises scenes of pbrt-v3 and pbrt-v2. */
#include "import/pbrt/upgrade/detect.h"

#include <stdio.h>

#include "base/file.h"
#include "base/text.h"
#include "import/pbrt/token.h"

/* Directives, and kinds of directives, that pbrt-v4 does not have. kinds null: any. */
static const struct {
  const char *directive, *kinds;
  int version;
} signs[] = {
    {"WorldEnd", NULL, 3},
    {"Film", "image", 3},
    {"SurfaceIntegrator", NULL, 2},
    {"VolumeIntegrator", NULL, 2},
    {"Renderer", NULL, 2},
    {"Camera", "environment", 3},
    {"Sampler", "lowdiscrepancy 02sequence zerotwosequence maxmindist random", 3},
    {"Integrator", "directlighting whitted ao", 3},
    {"Material",
     "matte plastic metal glass mirror uber substrate translucent kdsubsurface fourier "
     "disney",
     3}};

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
      bool kind = signs[i].kinds != NULL;
      const vlToken *word = kind ? &before : &t;
      if (!vl_token_is(word, signs[i].directive))
        continue;
      if (kind && (t.kind != VL_TOKEN_STRING || !vl_has_word(signs[i].kinds, t.text)))
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
