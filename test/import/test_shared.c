/* test/import/test_shared.c: published scenes from ../shared/scenes/pbrt: each loads or names
 * what is not supported; with permissive, all load. Skipped without that folder. */
#include <dirent.h>

#include "base/text.h"
#include "import/load.h"
#include "import/ply/ply.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"

#define SCENES VELO_SOURCE_DIR "/../shared/scenes/pbrt"

typedef struct Expected {
  const char *file, *error; /* error null: loads */
  uint64_t shapes, triangles, materials, lights, emissive;
} Expected;

static const Expected scenes[] = {
    {"coffee/coffee.pbrt", NULL, 23, 235271, 8, 0, 3},
    {"cornell-box/cornell-box.pbrt", NULL, 8, 36, 8, 0, 1},
    {"dining-room/dining-room.pbrt", NULL, 53, 269538, 15, 2, 0},
    {"material-testball/material-testball.pbrt", NULL, 2, 67456, 4, 1, 0},
    {"pbrt-cornell-box/cornell-box.pbrt", NULL, 8, 32, 3, 0, 1},
    {"pbrt-cornell-box/cornell-box-silver.pbrt", NULL, 8, 32, 4, 0, 1},
    {"pbrt-cornell-box/cornell-box-specular.pbrt", NULL, 8, 22, 5, 0, 1},
    {"pbrt-cornell-box/cornell-box-specular-volume.pbrt", NULL, 8, 22, 5, 0, 1},
    {"pbrt-cornell-box/cornell-box-volume.pbrt", NULL, 8, 32, 3, 0, 1},
    {"pbrt-cornell-box/volumetric-caustic.pbrt", NULL, 7, 12, 4, 0, 1},
    {"pbrt-cornell-box/smallpt.pbrt", NULL, 8, 10, 5, 0, 1},
    {"pbrt-cornell-box/cornell-box-environment-map.pbrt", NULL, 3, 2, 6, 1, 0},
    {"pbrt-killeroos/killeroo-gold.pbrt", NULL, 5, 532230, 4, 1, 1},
    {"pbrt-killeroos/killeroo-simple.pbrt", NULL, 5, 66532, 4, 0, 1},
    {"pbrt-killeroos/killeroo-coated-gold.pbrt", NULL, 5, 532230, 4, 1, 1},
    {"pbrt-killeroos/killeroo-moving.pbrt", NULL, 5, 66532, 4, 0, 1},
    {"staircase2/staircase2.pbrt", NULL, 32, 30927, 21, 0, 13},
    {"teapot/teapot.pbrt", NULL, 3, 126050, 2, 1, 0},
    {"veach-ajar/veach-ajar.pbrt", NULL, 22, 382690, 13, 0, 1},
    {"veach-mis/veach-mis.pbrt", NULL, 9, 52, 6, 0, 3},
    {"volumetric-caustic/volumetric-caustic.pbrt", NULL, 8, 14, 8, 0, 1},
    {"water-caustic/water-caustic.pbrt", NULL, 10, 103487, 9, 0, 1},
};

static bool absent(void) {
  if (access(SCENES, R_OK) == 0)
    return false;
  print_message("skipped: %s is not there\n", SCENES);
  return true;
}

static void load(Loaded *l, const char *file, bool permissive) {
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", SCENES, file);
  start_load(l);
  vlLoadDef def = vl_default_load_def();
  def.permissive = permissive;
  l->result = vl_scene_load(l->scene, path, &def, &l->error);
}

static void as_they_are(void **state) {
  (void)state;
  if (absent())
    skip();
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    Loaded l;
    char said[800];
    load(&l, scenes[i].file, false);
    snprintf(said, sizeof said, "%u:%u: %s", l.error.line, l.error.column, l.error.message);
    if ((l.result != VL_OK) != (scenes[i].error != NULL))
      print_message("%s: %s\n", scenes[i].file, said);
    assert_int_equal(l.result, scenes[i].error ? VL_ERROR_SCENE : VL_OK);
    if (scenes[i].error)
      assert_string_equal(said, scenes[i].error);
    end_load(&l);
  }
}

static void permissive(void **state) {
  (void)state;
  if (absent())
    skip();
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    Loaded l;
    vlSceneInfo info;
    load(&l, scenes[i].file, true);
    if (l.result != VL_OK)
      print_message("%s: %s\n", scenes[i].file, l.error.message);
    assert_int_equal(l.result, VL_OK);
    vl_scene_info(l.scene, &info);
    assert_int_equal(info.shapes, scenes[i].shapes);
    assert_int_equal(info.triangles, scenes[i].triangles);
    assert_int_equal(info.materials, scenes[i].materials);
    assert_int_equal(info.lights, scenes[i].lights);
    assert_int_equal(info.emissive_shapes, scenes[i].emissive);
    if (scenes[i].error)
      assert_non_null(strstr(l.log, "warning"));
    end_load(&l);
  }
}

/* Every mesh that is there, also those that no scene names. */
static void all_meshes(void **state) {
  (void)state;
  if (absent())
    skip();
  vlContext *context;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  size_t meshes = 0;
  DIR *top = opendir(SCENES);
  assert_non_null(top);
  for (struct dirent *scene; (scene = readdir(top));) {
    char folder[1024];
    snprintf(folder, sizeof folder, "%s/%s/models", SCENES, scene->d_name);
    DIR *models = opendir(folder);
    if (!models)
      continue;
    for (struct dirent *model; (model = readdir(models));) {
      char path[1400];
      vlMesh mesh;
      vlError error;
      if (!vl_ends_with(model->d_name, ".ply"))
        continue;
      snprintf(path, sizeof path, "%s/%s", folder, model->d_name);
      vlResult result = vl_ply_read(context, path, &(vlPlyOptions){0}, &mesh, &error);
      if (result != VL_OK)
        print_message("%s: %s\n", path, error.message);
      assert_int_equal(result, VL_OK);
      assert_true(mesh.vertices > 0 && mesh.triangles + mesh.quads > 0);
      vl_mesh_free(context, &mesh);
      meshes++;
    }
    closedir(models);
  }
  closedir(top);
  assert_true(meshes >= 100);
  vl_context_destroy(context);
}

/* The contents of cornell-box.pbrt. */
static void cornell_box(void **state) {
  (void)state;
  if (absent())
    skip();
  Loaded l;
  load(&l, "cornell-box/cornell-box.pbrt", false);
  const vlSceneDefs *s = vl_scene_defs(l.scene);
  assert_int_equal(s->render.sampler, VL_SAMPLER_SOBOL);
  assert_int_equal(s->film.filter.kind, VL_PIXEL_FILTER_GAUSSIAN);
  vlCamera camera;
  vlError error;
  assert_int_equal(vl_camera_make(&s->camera, &camera, NULL, &error), VL_OK);
  /* by the file's Transform the camera is at (0, 1, 6.8) and looks along -z */
  assert_near(camera.world_from_camera[3], 0, 1e-6);
  assert_near(camera.world_from_camera[7], 1, 1e-6);
  assert_near(camera.world_from_camera[11], 6.8, 1e-6);
  double pixel[2], z;
  assert_true(vl_camera_project(&camera, (double[]){0, 1, 0}, pixel, &z));
  assert_near(z, 6.8, 1e-6);
  assert_near(pixel[0], s->film.width / 2.0, 1e-4);
  /* seen from there the red wall is at x = -1: on the left */
  assert_true(vl_camera_project(&camera, (double[]){-1, 1, 0}, pixel, &z));
  assert_true(pixel[0] < s->film.width / 2.0);
  end_load(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(as_they_are),
                                     cmocka_unit_test(permissive), cmocka_unit_test(all_meshes),
                                     cmocka_unit_test(cornell_box)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
