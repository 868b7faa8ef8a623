/* conformance/unseen.h: the law of shapes that are hidden from the camera: whatever their kind,
 * and wherever a camera's rays begin, the image shows what is behind them, also in a medium. */
#ifndef TEST_CONFORMANCE_UNSEEN_H
#define TEST_CONFORMANCE_UNSEEN_H

#include "conformance.h"
#include "shape/shape.case.h"
#include "shapes.h"
#include "unit.h"

/* A wall that shines by a texture; light meets nothing else before it is seen. */
#define SHINING_WALL                                                                 \
  "AttributeBegin AreaLightSource \"diffuse\" \"string filename\" \"quarters.pfm\" " \
  "Shape \"trianglemesh\" \"point3 P\" [-4 -4 -2 4 -4 -2 4 4 -2 -4 4 -2] "           \
  "\"point2 uv\" [0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3] AttributeEnd\n"

/* A dark one that moves before a bright sky. */
#define MOVING_WALL                                                                           \
  "LightSource \"infinite\" AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] " \
  "ActiveTransform EndTime Translate 1.5 .9 0 ActiveTransform All Shape \"trianglemesh\" "    \
  "\"point3 P\" [-1 -1 -2 1 -1 -2 1 1 -2 -1 1 -2] \"integer indices\" [0 1 2 0 2 3] AttributeEnd\n"

static const char *const walls[] = {SHINING_WALL, MOVING_WALL};

/* The middle of their images looks at what may hide. */
static const char *const hiding_cameras[] = {
    "\"perspective\" \"float fov\" 40",
    "\"perspective\" \"float fov\" 40 \"float lensradius\" .4 \"float focaldistance\" 5",
    "\"orthographic\" \"float screenwindow\" [-1.5 1.5 -1.5 1.5]",
};

/* Hides what stands in the scene after the wall, its first shape. */
static void hide_shapes(vlScene *scene) {
  vlError error = {0};
  for (vlShapeId id = {2}; vl_scene_shape(scene, id); id.index++) {
    vlShapeDef def = *vl_scene_shape(scene, id);
    def.hidden_from_camera = true;
    assert_int_equal(vl_scene_set_shape(scene, id, &def, &error), VL_OK);
  }
}

static vlImage *image_before_wall(const char *wall, const char *camera, bool foggy,
                                  const char *shape, bool hidden) {
  static char text[TEXT];
  snprintf(text, sizeof text,
           "LookAt 0 0 4 0 0 0 0 1 0\n%s Camera %s\n"
           "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12 "
           "\"string filename\" \"x.pfm\"\n"
           "Sampler \"independent\" Integrator \"volpath\" \"integer maxdepth\" 0\n"
           "WorldBegin %s%s %s",
           foggy
               ? "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" "
                 "\"rgb sigma_a\" [.1 .2 .3] \"rgb sigma_s\" [0 0 0] MediumInterface \"\" \"m\""
               : "",
           camera, wall, foggy ? "MediumInterface \"m\" \"m\"" : "", shape);
  vlScene *scene = need_scene(text);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->render.spp = SAMPLES;
  if (hidden)
    hide_shapes(scene);
  return need_image(scene, text);
}

/* The number of pixels in which two images differ; destroys the second one. */
static uint32_t pixels_apart(const vlImage *a, vlImage *b) {
  const float *x = vl_image_const_pixels(a);
  const float *y = vl_image_const_pixels(b);
  uint32_t apart = 0;
  for (uint32_t i = 0; i < WIDTH * WIDTH; i++)
    apart += memcmp(x + 3 * i, y + 3 * i, 3 * sizeof *x) != 0;
  vl_image_destroy(b);
  return apart;
}

static void check_unseen(const vlKindRow *row, const char *parameters, const char *wall,
                         const char *camera, bool foggy) {
  char shape[2000];
  snprintf(shape, sizeof shape, "Rotate 40 1 2 3 Shape \"%s\" %s", row->name, parameters);
  vlImage *alone = image_before_wall(wall, camera, foggy, "", false);
  const uint32_t seen =
      pixels_apart(alone, image_before_wall(wall, camera, foggy, shape, false));
  const uint32_t shown =
      pixels_apart(alone, image_before_wall(wall, camera, foggy, shape, true));
  vl_image_destroy(alone);
  if (seen < 2 || shown)
    broken("shapes", row->name, "%s: hidden from the camera %s%s: %u pixels of %u show it",
           parameters, camera, foggy ? " in fog" : "", shown, seen);
}

static void unseen_shapes(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("shapes");
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (size_t i = 0; i < 3 * sizeof hiding_cameras / sizeof *hiding_cameras; i++)
      check_unseen(family->rows[k], shape_cases[k]->variants[0].parameters, walls[i % 3 == 2],
                   hiding_cameras[i / 3], i % 3 == 1); /* no light of the sky passes the fog */
  expect_no_failures();
}

#endif
