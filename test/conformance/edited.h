/* conformance/edited.h: the law of worlds that are built from previous ones: a scene whose
 * parameter has changed gives the image that it gives without a previous world, whether it was
 * loaded again or its objects were given other defs, and also when the previous world is gone
 * before anything is rendered. */
#ifndef TEST_CONFORMANCE_EDITED_H
#define TEST_CONFORMANCE_EDITED_H

#include "conformance.h"

/* Gives the object of an id the def of another scene. False: one of them has no such object. */
typedef bool SetFrom(vlScene *scene, const vlScene *other, uint32_t id);

static bool set_texture_from(vlScene *scene, const vlScene *other, uint32_t index) {
  const vlTextureId id = {index};
  const vlTextureDef *def = vl_scene_texture(other, id);
  return def && vl_scene_texture(scene, id) &&
         vl_scene_set_texture(scene, id, def, NULL) == VL_OK;
}
static bool set_material_from(vlScene *scene, const vlScene *other, uint32_t index) {
  const vlMaterialId id = {index};
  const vlMaterialDef *def = vl_scene_material(other, id);
  return def && vl_scene_material(scene, id) &&
         vl_scene_set_material(scene, id, def, NULL) == VL_OK;
}
static bool set_emission_from(vlScene *scene, const vlScene *other, uint32_t index) {
  const vlEmissionId id = {index};
  const vlEmissionDef *def = vl_scene_emission(other, id);
  return def && vl_scene_emission(scene, id) &&
         vl_scene_set_emission(scene, id, def, NULL) == VL_OK;
}
static bool set_light_from(vlScene *scene, const vlScene *other, uint32_t index) {
  const vlLightId id = {index};
  const vlLightDef *def = vl_scene_light(other, id);
  return def && vl_scene_light(scene, id) && vl_scene_set_light(scene, id, def, NULL) == VL_OK;
}
static bool set_medium_from(vlScene *scene, const vlScene *other, uint32_t index) {
  const vlMediumId id = {index};
  const vlMediumDef *def = vl_scene_medium(other, id);
  return def && vl_scene_medium(scene, id) &&
         vl_scene_set_medium(scene, id, def, NULL) == VL_OK;
}
static bool set_shape_from(vlScene *scene, const vlScene *other, uint32_t index) {
  const vlShapeId id = {index};
  const vlShapeDef *def = vl_scene_shape(other, id);
  return def && vl_scene_shape(scene, id) && vl_scene_set_shape(scene, id, def, NULL) == VL_OK;
}

static const struct {
  const char *family;
  SetFrom *set;
} editable[] = {{"textures", set_texture_from},  {"materials", set_material_from},
                {"emission", set_emission_from}, {"lights", set_light_from},
                {"media", set_medium_from},      {"shapes", set_shape_from}};

/* Renders the scene from the previous world and destroys it. last: the previous world, too, and
 * as soon as it has been built from. */
static void check_from_previous(const char *family, const char *kind, const char *what,
                                vlScene *scene, vlWorld *previous, bool last,
                                const float pixels[PIXELS]) {
  vlError error = {0};
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.previous = previous;
  defs->render.spp = SAMPLES;
  vlImage *image = render_after(context, scene, last ? previous : NULL, &error);
  if (!image)
    broken(family, kind, "%s: with a previous world: %s", what, error.message);
  else if (memcmp(vl_image_const_pixels(image), pixels, PIXELS * sizeof *pixels) != 0)
    broken(family, kind, "%s: with a previous world it has another image", what);
  vl_image_destroy(image);
}

/* text: the scene with a changed parameter, of these pixels; before: without the change. */
static void check_edited(const char *family, const char *kind, const char *name,
                         const char *before, const char *text, const float pixels[PIXELS]) {
  vlError error = {0};
  vlWorld *world = NULL;
  char what[200];
  vlScene *scene = need_scene(before);
  vlScene *changed = need_scene(text);
  if (vl_world_build(scene, &vl_scene_defs(scene)->build, &world, &error) != VL_OK) {
    vl_scene_destroy(scene); /* it cannot do without the parameter */
    vl_scene_destroy(changed);
    return;
  }
  uint32_t edited = 0;
  for (size_t i = 0; i < sizeof editable / sizeof *editable; i++)
    if (strcmp(editable[i].family, family) == 0)
      while (editable[i].set(scene, changed, edited + 1))
        edited++;
  snprintf(what, sizeof what, "\"%.100s\" changed, loaded again", name);
  check_from_previous(family, kind, what, changed, world, !edited, pixels);
  snprintf(what, sizeof what, "\"%.100s\" changed, by other defs", name);
  if (edited)
    check_from_previous(family, kind, what, scene, world, true, pixels);
  else
    vl_scene_destroy(scene);
}

/* ---- one image, used in different ways --------------------------------------------------- */

#define BALL_OF_IMAGE \
  "LightSource \"infinite\" Material \"diffuse\" \"texture reflectance\" \"t\" " BALL
#define IMAGE_USE(parameters)                                              \
  "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tga\" " \
  "\"float uscale\" 9 \"float vscale\" 9 " parameters "\n" BALL_OF_IMAGE

static const char *const image_uses[] = {
    IMAGE_USE("\"string encoding\" \"sRGB\" \"string filter\" \"bilinear\""),
    IMAGE_USE("\"string encoding\" \"linear\" \"string filter\" \"bilinear\""),
    IMAGE_USE("\"string encoding\" \"gamma 1.5\" \"string filter\" \"bilinear\""),
    IMAGE_USE("\"string encoding\" \"gamma 3\" \"string filter\" \"bilinear\""),
    IMAGE_USE("\"string encoding\" \"gamma 3\" \"string filter\" \"trilinear\""),
    IMAGE_USE("\"string filter\" \"trilinear\""),
    /* needs no blurred levels */
    "LightSource \"infinite\" \"string filename\" \"a.tga\" Material \"diffuse\" " BALL,
};
enum { IMAGE_USES = sizeof image_uses / sizeof *image_uses };

/* A previous world has the image, but not as it is used now. */
static void uses_of_images(void **state) {
  (void)state;
  static char texts[IMAGE_USES][TEXT];
  static float pixels[IMAGE_USES][PIXELS];
  char what[100];
  vlError error = {0};
  for (int i = 0; i < IMAGE_USES; i++) {
    snprintf(texts[i], TEXT, HEAD "WorldBegin %s", image_uses[i]);
    assert_true(render_text(texts[i], pixels[i], &error));
    for (int k = 0; k < i; k++)
      if (memcmp(pixels[i], pixels[k], sizeof pixels[i]) == 0)
        broken("textures", "imagemap", "use %d of an image looks as use %d", i, k);
  }
  for (int i = 0; i < IMAGE_USES; i++)
    for (int k = 0; k < IMAGE_USES; k++) {
      snprintf(what, sizeof what, "use %d of an image after use %d", k, i);
      if (i != k)
        check_edited("textures", "imagemap", what, texts[i], texts[k], pixels[k]);
    }
  expect_no_failures();
}

#endif
