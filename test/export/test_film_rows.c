/* test/export/test_film_rows.c: the pbrt exporter writes every parameter of the films' rows: a
 * value other than the default stands in the file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/export.h"
#include "velo/render.h"
#include "velo/schema.h"

static vlContext *context;
static char path[64];

static int setup(void **state) {
  (void)state;
  char folder[40] = "/tmp/velo_film_XXXXXX";
  if (!mkdtemp(folder))
    return 1;
  snprintf(path, sizeof path, "%s/a.pbrt", folder);
  return vl_context_create(NULL, &context) != VL_OK;
}

static int teardown(void **state) {
  (void)state;
  vl_context_destroy(context);
  remove(path);
  *strrchr(path, '/') = 0;
  return remove(path);
}

/* Parameters that set others, or that are ignored. Whoever adds one must decide how the
 * exporter writes it. */
static bool is_said_by_another(const char *name) {
  static const char *const names[] = {"cropwindow", "diagonal", "exposuretime", "imagingratio",
                                      "savefp16"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (strcmp(name, names[i]) == 0)
      return true;
  return false;
}

/* Parameters without a member of their own type. */
static bool set_by_rule(const char *name, vlSceneDefs *defs) {
  if (strcmp(name, "iso") == 0) {
    defs->develop.exposure = 2;
    return true;
  }
  if (strcmp(name, "coordinatesystem") == 0) {
    defs->gbuffer = VL_GBUFFER_WORLD;
    return true;
  }
  if (strcmp(name, "pixelbounds") == 0) {
    defs->film.crop[0] = 3;
    return true;
  }
  if (strcmp(name, "filename") == 0) {
    snprintf(defs->output, sizeof defs->output, "b.exr");
    return true;
  }
  return false;
}

static void set_other(const vlParameter *p, vlSceneDefs *defs) {
  char *at = (char *)defs + p->offset;
  const uint32_t count = 40;
  const float single = 3.5f;
  const double number = 400.5;
  const char *text = "nikon_d850";
  const int choice = p->value[0] != 1.0 ? 1 : 0;
  const bool flag = p->value[0] == 0.0;
  if (set_by_rule(p->name, defs))
    return;
  if (p->flags & VL_PARAMETER_SHORTHAND)
    fail_msg("%s: not known", p->name);
  else if (p->type == VL_PARAMETER_COUNT)
    memcpy(at, &count, sizeof count);
  else if (p->type == VL_PARAMETER_FLOAT)
    memcpy(at, &single, sizeof single);
  else if (p->type == VL_PARAMETER_DOUBLE)
    memcpy(at, &number, sizeof number);
  else if (p->type == VL_PARAMETER_STRING)
    memcpy(at, &text, sizeof text);
  else if (p->type == VL_PARAMETER_CHOICE)
    memcpy(at, &choice, sizeof choice);
  else if (p->type == VL_PARAMETER_BOOL)
    memcpy(at, &flag, sizeof flag);
  else
    fail_msg("%s: the exporter writes no parameter of this type", p->name);
}

static void check_parameter(vlFilmKind kind, const vlParameter *p) {
  vlScene *scene;
  vlError error;
  char text[20000], name[80];
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlSceneDefs *defs = vl_scene_defs(scene);
  if (kind == VL_FILM_GBUFFER)
    defs->gbuffer = VL_GBUFFER_CAMERA;
  if (kind == VL_FILM_SPECTRAL)
    defs->film.buckets = 8;
  set_other(p, defs);
  defs->camera.width = defs->film.width;
  defs->camera.height = defs->film.height;
  if (vl_scene_save(scene, path, NULL, &error) != VL_OK)
    fail_msg("%s: %s", p->name, error.message);
  vl_scene_destroy(scene);
  FILE *file = fopen(path, "r");
  assert_non_null(file);
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  fclose(file);
  snprintf(name, sizeof name, " %s\"", p->name);
  if (!strstr(text, name))
    fail_msg("film %d: %s is not in the file:\n%s", (int)kind, p->name, text);
}

static void test_all_parameters(void **state) {
  (void)state;
  const vlKindFamily *films = vl_kind_family_find("films");
  uint32_t checked = 0;
  for (uint32_t i = 0; i < films->kind_count; i++)
    for (uint32_t k = 0; k < films->rows[i]->parameter_count; k++) {
      const vlParameter *p = &films->rows[i]->parameters[k];
      if (is_said_by_another(p->name))
        continue;
      check_parameter((vlFilmKind)i, p);
      checked++;
    }
  assert_true(checked >= 28);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_parameters)};
  return cmocka_run_group_tests(tests, setup, teardown);
}
