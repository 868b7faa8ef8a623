/* conformance/stand_ins.h: the law of what stands in for what a format has not: the image stays
 * much the same, although the writer says that it loses something. Quadrics as triangles in
 * glTF fill the same parts of the image; a partly metallic material in pbrt is a mixture of
 * the same shares. */
#ifndef TEST_CONFORMANCE_STAND_INS_H
#define TEST_CONFORMANCE_STAND_INS_H

#include "conformance.h"
#include "unit.h"

enum { STAND_IN_SPP = 64, STAND_IN_PART = WIDTH / 4 };

static vlImage *image_of_stand_in(vlScene *scene, const char *text) {
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->film = vl_default_film_def(WIDTH, WIDTH);
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->build.color = VL_COLOR_RGB;
  defs->render.tracer = VL_TRACER_PATH;
  defs->render.spp = STAND_IN_SPP;
  return need_image(scene, text);
}

/* The largest difference of parts of the image, over the mean of the brightest part. */
static double worst_part(const vlImage *image, const vlImage *other) {
  double worst = 0;
  double max = 1e-9;
  for (uint32_t y = 0; y < WIDTH; y += STAND_IN_PART)
    for (uint32_t x = 0; x < WIDTH; x += STAND_IN_PART)
      for (uint32_t c = 0; c < 3; c++) {
        double sum[2] = {0, 0};
        for (uint32_t i = 0; i < STAND_IN_PART * STAND_IN_PART; i++) {
          const uint32_t px = x + i % STAND_IN_PART;
          const uint32_t py = y + i / STAND_IN_PART;
          sum[0] += (double)vl_image_get(image, px, py, c);
          sum[1] += (double)vl_image_get(other, px, py, c);
        }
        worst = fmax(worst, fabs(sum[1] - sum[0]));
        max = fmax(max, sum[0]);
      }
  return worst / max;
}

/* form: with one `%s`; most: the largest difference of a part that a stand-in may have. */
static void compare_stand_in(const char *family, const char *kind, const char *form,
                             const char *parameters, const char *file, double max) {
  static char text[TEXT];
  scene_text(text, form, kind, parameters);
  vlScene *scene = need_scene(text);
  vlImage *again = image_of_stand_in(read_again(scene, file), text);
  vlImage *image = image_of_stand_in(scene, text);
  const double off = worst_part(image, again);
  if (!(off <= max))
    broken(family, kind, "%s: what stands in for it in %s is off by %.3f", parameters, file,
           off);
  vl_image_destroy(again);
  vl_image_destroy(image);
}

static const struct {
  const char *kind, *parameters;
} quadrics[] = {
    {"sphere", "\"float radius\" .8"},
    {"sphere", "\"float radius\" .8 \"float zmin\" -.3 \"float zmax\" .5 \"float phimax\" 200"},
    {"disk", "\"float radius\" .9"},
    {"disk", "\"float radius\" .9 \"float innerradius\" .5 \"float phimax\" 250"},
    {"cylinder", "\"float radius\" .4 \"float zmin\" -.5 \"float zmax\" .9"},
    {"cylinder", "\"float radius\" .6 \"float phimax\" 200"},
};

static void stand_ins_of_files(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof quadrics / sizeof *quadrics; i++)
    compare_stand_in("shapes", quadrics[i].kind,
                     HEAD "WorldBegin " LIGHTS
                          "Translate .1 .4 0 Rotate 30 1 .3 .2 Material \"diffuse\" Shape %s",
                     quadrics[i].parameters, "stand_in.glb", 0.04);
  static const char *const metallic[] = {".1", ".3", ".7", ".9"};
  for (size_t i = 0; i < sizeof metallic / sizeof *metallic; i++) {
    char parameters[200];
    snprintf(parameters, sizeof parameters,
             "\"rgb basecolor\" [.9 .5 .2] \"float roughness\" .4 \"float metallic\" %s",
             metallic[i]);
    compare_stand_in("materials", "principled",
                     HEAD
                     "WorldBegin LightSource \"distant\" \"point3 from\" [2 3 1.5] "
                     "\"rgb L\" [2 1.9 1.7]\nTranslate .1 .4 0 Material %s " BALL,
                     parameters, "stand_in.pbrt", 0.1);
  }
  expect_no_failures();
}

#endif
