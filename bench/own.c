/* bench_own [SCENE]: the cost of a camera and a sampler of one's own (velo/own.h) that compute
 * what velo's do: the CPU time of renders with and without them, taken in turns on one thread.
 * The ratio is that of the least times. */
#include <stdio.h>
#include <time.h>

#include "velo/velo.h"

enum { WIDTH = 240, HEIGHT = 160, SPP = 8, TURNS = 9, WAYS = 3 };

static void pinhole(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  const double focal = *(const double *)user, half_width = 0.5 * points->width,
               half_height = 0.5 * points->height;
  for (uint32_t i = 0; i < points->count; i++) {
    rays->dx[i] = points->x[i] - half_width;
    rays->dy[i] = points->y[i] - half_height;
    rays->dz[i] = focal;
  }
}

static uint32_t mix(uint32_t h) {
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  return h ^ h >> 16;
}

static float number(const vlOwnSamples *s, uint32_t i, uint32_t dimension) {
  uint32_t pixel = mix((uint32_t)s->x[i] ^ (uint32_t)s->y[i] << 16);
  return (float)(mix(pixel ^ mix(s->index[i] ^ mix(dimension ^ s->seed))) >> 8) * 0x1p-24f;
}

static void independent(void *user, const vlOwnSamples *s) {
  (void)user;
  for (uint32_t i = 0; i < s->count; i++)
    s->u[i] = number(s, i, s->dimension);
  for (uint32_t i = 0; s->v && i < s->count; i++)
    s->v[i] = number(s, i, s->dimension + 1);
}

static int fail(const char *what, const vlError *error) {
  fprintf(stderr, "bench_own: %s: %s\n", what, error->message);
  return 1;
}

int main(int count, char **arguments) {
  static const char *const names[WAYS] = {"velo's", "own camera", "own sampler"};
  const char *path = count > 1 ? arguments[1] : "scenes/denoising/room.pbrt";
  double focal = 250, min[WAYS] = {1e9, 1e9, 1e9};
  const vlOwnCamera camera = {.name = "pinhole", .rays = pinhole, .user = &focal};
  const vlOwnSampler sampler = {.name = "independent", .numbers = independent};
  vlContext *context;
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  vlError error = {0};
  vlContextDef context_def = vl_default_context_def();
  context_def.threads = 1;
  if (vl_context_create(&context_def, &context) != VL_OK ||
      vl_scene_create(context, &scene) != VL_OK)
    return 1;
  if (vl_scene_load(scene, path, NULL, &error) != VL_OK)
    return fail(path, &error);
  vlSceneDefs *defs = vl_scene_defs(scene);
  if (vl_world_build(scene, &defs->build, &world, &error) != VL_OK)
    return fail("build", &error);
  vlFilmDef film_def = vl_default_film_def(WIDTH, HEIGHT);
  if (vl_film_create(context, &film_def, &film) != VL_OK)
    return 1;
  for (int turn = 0; turn < TURNS * WAYS; turn++) {
    int way = turn % WAYS;
    vlCameraDef def = vl_default_camera_def(WIDTH, HEIGHT);
    for (int i = 0; i < 3; i++) {
      def.eye[i] = defs->camera.eye[i];
      def.lookat[i] = defs->camera.lookat[i];
      def.up[i] = defs->camera.up[i];
    }
    def.has_matrix = defs->camera.has_matrix;
    for (int i = 0; i < 16; i++)
      def.world_from_camera[i] = defs->camera.world_from_camera[i];
    def.fx = def.fy = focal;
    def.own = way == 1 ? &camera : NULL;
    vlRenderDef render = defs->render;
    render.spp = SPP;
    render.sampler = VL_SAMPLER_INDEPENDENT;
    render.own_sampler = way == 2 ? &sampler : NULL;
    vlCamera compiled;
    if (vl_camera_make(&def, &compiled, NULL, &error) != VL_OK)
      return fail("camera", &error);
    vl_film_clear(film);
    clock_t start = clock();
    if (vl_render(world, &compiled, film, &render, NULL, &error) != VL_OK)
      return fail("render", &error);
    double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    if (seconds < min[way])
      min[way] = seconds;
  }
  for (int way = 0; way < WAYS; way++)
    printf("%-12s %.3f s, speed %.3f\n", names[way], min[way], min[0] / min[way]);
  vl_film_destroy(film);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
