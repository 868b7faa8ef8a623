/* example.h: what the short examples share: load a scene, render it with its settings, write the image, free
 * everything. Each step that fails prints one line and ends the program with exit code 1. */
#ifndef EXAMPLE_H
#define EXAMPLE_H

#include <stdio.h>
#include <stdlib.h>
#include <velo/velo.h>

typedef struct Example {
  vlContext *context;
  vlScene *scene;
  vlSceneDefs *defs; /* the settings of the scene's file; may be changed before example_render */
  vlWorld *world;
  vlFilm *film;
  vlCamera camera;
  vlError error; /* for calls of the library */
} Example;

static inline void example_must(Example *e, vlResult result, const char *what) {
  if (result == VL_OK) return;
  fprintf(stderr, "%s: %s: %s\n", what, vl_result_name(result), e->error.message);
  exit(1);
}

/* Loads the scene arguments[1]; there must be a name of an image, too. */
static inline Example example_open(int count, char **arguments, const vlContextDef *def) {
  Example e = {0};
  vlContextDef standard = vl_default_context_def();
  if (count != 3) {
    fprintf(stderr, "usage: %s SCENE IMAGE\n", arguments[0]);
    exit(2);
  }
  example_must(&e, vl_context_create(def ? def : &standard, &e.context), "context");
  example_must(&e, vl_scene_create(e.context, &e.scene), "scene");
  example_must(&e, vl_scene_load(e.scene, arguments[1], NULL, &e.error), arguments[1]);
  example_must(&e, vl_scene_complete(e.scene, NULL, &e.error), arguments[1]);
  e.defs = vl_scene_defs(e.scene);
  return e;
}

/* Builds the world, which shares with the one before what has not changed; makes the camera, and a film without
 * samples. */
static inline void example_build(Example *e) {
  vlBuildDef build = e->defs->build;
  vlWorld *before = e->world;
  build.previous = before;
  example_must(e, vl_world_build(e->scene, &build, &e->world, &e->error), "build");
  vl_world_destroy(before);
  example_must(e, vl_camera_make(&e->defs->camera, &e->camera, NULL, &e->error), "camera");
  vl_film_destroy(e->film);
  example_must(e, vl_film_create(e->context, &e->defs->film, &e->film), "film");
}

static inline void example_render(Example *e) {
  example_build(e);
  example_must(e, vl_render(e->world, &e->camera, e->film, &e->defs->render, NULL, &e->error), "render");
}

/* Develops the film; the caller destroys the image. */
static inline vlImage *example_develop(Example *e) {
  vlImage *image;
  example_must(e, vl_film_develop(e->film, &e->defs->develop, &image), "develop");
  return image;
}

static inline void example_write(Example *e, const char *path) {
  vlImage *image = example_develop(e);
  example_must(e, vl_image_write(image, path, NULL, &e->error), path);
  vl_image_destroy(image);
}

static inline int example_close(Example *e) {
  vl_film_destroy(e->film);
  vl_world_destroy(e->world);
  vl_scene_destroy(e->scene);
  vl_context_destroy(e->context);
  return 0;
}

/* The left and the right image side by side; the caller destroys the result. */
static inline vlImage *example_join(Example *e, const vlImage *left, const vlImage *right) {
  uint32_t width = vl_image_width(left), height = vl_image_height(left);
  vlImageDef def = vl_default_image_def(2 * width, height, 3);
  vlImage *both;
  example_must(e, vl_image_create(e->context, &def, &both), "image");
  float *to = vl_image_pixels(both);
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < 2 * width; x++)
      for (uint32_t c = 0; c < 3; c++) *to++ = vl_image_get(x < width ? left : right, x % width, y, c);
  return both;
}

#endif
