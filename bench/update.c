/* bench/update.c: times of changes to a scene (velo/edit.h): building the world anew, and with
 * the previous one. The scene has a million triangles outside of groups and 1000 instances of a
 * small mesh. Also the time from a request to cancel until a render returns, and from a new
 * render until its first coarse image while another one runs. Usage: bench_update [SCENE.pbrt].
 * Times are medians, in milliseconds; CPU times of the whole process in brackets. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "measure.h"
#include "velo/velo.h"

enum { SIDE = 707, SMALL = 20, INSTANCES = 1000, ROUNDS = 15 };

static double wall(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static double cpu(void) {
  struct rusage u;
  getrusage(RUSAGE_SELF, &u);
  return 1e3 * (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
         1e-3 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

static void check(vlResult result, const vlError *error) {
  if (result == VL_OK)
    return;
  fprintf(stderr, "bench_update: %s: %s\n", vl_result_name(result), error->message);
  exit(1);
}

static void add_sheet(vlScene *scene, vlGroupId group, uint32_t side, float size) {
  size_t vertices = (size_t)(side + 1) * (side + 1), faces = 2 * (size_t)side * side;
  float *p = malloc(3 * vertices * sizeof *p);
  uint32_t *f = malloc(3 * faces * sizeof *f), *to = f;
  if (!p || !f)
    exit(1);
  for (uint32_t i = 0; i <= side; i++)
    for (uint32_t j = 0; j <= side; j++) {
      uint32_t v = i * (side + 1) + j;
      float x = (float)j / (float)side - 0.5f, z = (float)i / (float)side - 0.5f;
      p[3 * v] = size * x;
      p[3 * v + 1] = 0.03f * size * sinf(40 * x) * cosf(33 * z);
      p[3 * v + 2] = size * z;
      if (i == side || j == side)
        continue;
      const uint32_t quad[6] = {v, v + 1, v + side + 1, v + 1, v + side + 2, v + side + 1};
      memcpy(to, quad, sizeof quad);
      to += 6;
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = (uint32_t)vertices;
  def.faces = (uint32_t)faces;
  def.positions = p;
  def.indices = f;
  def.group = group;
  def.material = (vlMaterialId){1};
  vl_scene_add_shape(scene, &def);
  free(p);
  free(f);
}

static void place(double m[16], int i, int turn) {
  const double at[16] = {1, 0, 0, (i % 32) * 0.3 - 4.8, 0, 1, 0, 0.5 + 0.001 * turn,
                         0, 0, 1, (i / 32) * 0.3 - 4.8, 0, 0, 0, 1};
  memcpy(m, at, sizeof at);
}

static vlInstanceId instances[INSTANCES];

static void make_scene(vlScene *scene) {
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
  vl_scene_add_material(scene, &material);
  add_sheet(scene, (vlGroupId){0}, SIDE, 10);
  vlGroupId group = vl_scene_add_group(scene, "small");
  add_sheet(scene, group, SMALL, 0.25f);
  for (int i = 0; i < INSTANCES; i++) {
    double m[16];
    place(m, i, 0);
    instances[i] = vl_scene_add_instance(scene, group, m, (vlSource){0});
  }
  vlLightDef sky = vl_default_light_def(VL_LIGHT_INFINITE);
  vl_scene_add_light(scene, &sky);
  vlCameraDef *camera = &vl_scene_defs(scene)->camera;
  const double eye[3] = {0, 4, 8}, lookat[3] = {0, 0, 0};
  memcpy(camera->eye, eye, sizeof eye);
  memcpy(camera->lookat, lookat, sizeof lookat);
}

/* Builds ROUNDS times, after the change `edit` each time. */
static vlWorld *time_edits(vlScene *scene, vlWorld *world, const char *name,
                           void (*edit)(vlScene *, int)) {
  double t[ROUNDS], c[ROUNDS];
  vlError error;
  for (int k = 0; k < ROUNDS; k++) {
    double start = wall(), used = cpu();
    edit(scene, k);
    vlBuildDef def = vl_scene_defs(scene)->build;
    def.previous = world;
    vlWorld *next = NULL;
    check(vl_world_build(scene, &def, &next, &error), &error);
    t[k] = wall() - start;
    c[k] = cpu() - used;
    vl_world_destroy(world);
    world = next;
  }
  printf("%-44s %8.2f ms  [%.2f]\n", name, median(t, ROUNDS), median(c, ROUNDS));
  return world;
}

static void move_all(vlScene *scene, int turn) {
  for (int i = 0; i < INSTANCES; i++) {
    double m[16];
    place(m, i, turn + 1);
    vl_scene_set_instance(scene, instances[i], m, NULL);
  }
}

static void change_material(vlScene *scene, int turn) {
  vlMaterialDef def = *vl_scene_material(scene, (vlMaterialId){1});
  def.reflectance = vl_spectrum_input(vl_spectrum_rgb(0.5f, 0.02f * (float)turn, 0.2f));
  vl_scene_set_material(scene, (vlMaterialId){1}, &def, NULL);
}

static void change_nothing(vlScene *scene, int turn) {
  (void)scene;
  (void)turn;
}

typedef struct Render {
  const vlWorld *world;
  vlCamera camera;
  vlFilm *film;
  vlRenderDef def;
} Render;

static void *run(void *user) {
  Render *r = user;
  vl_render(r->world, &r->camera, r->film, &r->def, NULL, NULL);
  return NULL;
}

static void time_renders(vlContext *context, vlScene *scene, const vlWorld *world) {
  vlError error;
  vlSceneDefs *defs = vl_scene_defs(scene);
  Render r = {.world = world};
  vlCancel *cancel = NULL;
  check(vl_camera_make(&defs->camera, &r.camera, NULL, &error), &error);
  check(vl_film_create(context, &defs->film, &r.film), &error);
  check(vl_cancel_create(context, &cancel), &error);
  vlFilmDef coarse_def = vl_coarse_film_def(&defs->film, 8);
  Render c = {.world = world};
  check(vl_camera_coarse(&r.camera, 8, &c.camera), &error);
  check(vl_film_create(context, &coarse_def, &c.film), &error);
  r.def = c.def = defs->render;
  r.def.spp = 1 << 20;
  r.def.cancel = cancel;
  c.def.spp = 1;
  c.def.priority = 1;
  double stop[ROUNDS], first[ROUNDS];
  for (int k = 0; k < ROUNDS; k++) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, run, &r) != 0)
      exit(1);
    nanosleep(&(struct timespec){0, 100000000 + 7000000 * k}, NULL);
    double start = wall();
    vl_film_clear(c.film);
    run(&c);
    first[k] = wall() - start;
    start = wall();
    vl_cancel_request(cancel);
    pthread_join(thread, NULL);
    stop[k] = wall() - start;
    vl_cancel_clear(cancel);
    vl_film_clear(r.film);
  }
  double usual = median(stop, ROUNDS); /* sorts */
  printf("%-44s %8.2f ms  (slowest %.2f)\n", "from the request to cancel to the return", usual,
         stop[ROUNDS - 1]);
  usual = median(first, ROUNDS);
  printf("%-44s %8.2f ms  (slowest %.2f)\n", "an image of 1/8 while another render runs", usual,
         first[ROUNDS - 1]);
  vl_cancel_destroy(cancel);
  vl_film_destroy(r.film);
  vl_film_destroy(c.film);
}

int main(int argc, char **argv) {
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlError error = {0};
  check(vl_context_create(NULL, &context), &error);
  check(vl_scene_create(context, &scene), &error);
  if (argc > 1)
    check(vl_scene_load(scene, argv[1], NULL, &error), &error);
  else
    make_scene(scene);
  check(vl_scene_result(scene, &error), &error);
  double start = wall(), used = cpu();
  check(vl_world_build(scene, &vl_scene_defs(scene)->build, &world, &error), &error);
  printf("%-44s %8.2f ms  [%.2f]\n", "first build", wall() - start, cpu() - used);
  world = time_edits(scene, world, "nothing has changed", change_nothing);
  world = time_edits(scene, world, "a material", change_material);
  if (argc < 2)
    world = time_edits(scene, world, "1000 instances moved", move_all);
  time_renders(context, scene, world);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  vl_context_destroy(context);
  return 0;
}
