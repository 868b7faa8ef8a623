/* conformance/saved_settings.h: the law of settings in written scenes: each setting of renders
 * and films is in the pbrt file, or the writer says that it is not. */
#ifndef TEST_CONFORMANCE_SAVED_SETTINGS_H
#define TEST_CONFORMANCE_SAVED_SETTINGS_H

#include "cameras.h"
#include "conformance.h"
#include "unit.h"
#include "velo/setting.h"

/* How an image is computed: files of scenes do not say it. */
static const char *const of_renders[] = {
    "render.sequence",    "render.first_sample",   "render.share_samples",
    "render.transparent", "render.time_limit",     "render.noise",
    "render.noise_view",  "render.noise_exposure", "render.noise_scale",
    "render.pass_rows",   "render.priority",       "film.errors",
    "build.color",        "build.imitate_pbrt",    "build.bits",
    "build.accelerator",
};

/* Settings that only some tracers and filters have. */
static const struct {
  const char *member;
  vlTracer tracer;
  vlPixelFilterKind filter;
} needed[] = {
    {"render.ao_distance", VL_TRACER_AMBIENT_OCCLUSION, VL_PIXEL_FILTER_GAUSSIAN},
    {"render.ao_cosine", VL_TRACER_AMBIENT_OCCLUSION, VL_PIXEL_FILTER_GAUSSIAN},
    {"render.merge_radius", VL_TRACER_SPPM, VL_PIXEL_FILTER_GAUSSIAN},
    {"render.light_paths", VL_TRACER_SPPM, VL_PIXEL_FILTER_GAUSSIAN},
    {"film.filter.b", VL_TRACER_VOLPATH, VL_PIXEL_FILTER_MITCHELL},
    {"film.filter.c", VL_TRACER_VOLPATH, VL_PIXEL_FILTER_MITCHELL},
    {"film.filter.tau", VL_TRACER_VOLPATH, VL_PIXEL_FILTER_LANCZOS},
};

static bool is_of_renders(const char *member) {
  for (size_t i = 0; i < sizeof of_renders / sizeof *of_renders; i++)
    if (strcmp(of_renders[i], member) == 0)
      return true;
  return false;
}

static void set_needs(vlSceneDefs *defs, const char *member) {
  for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
    if (strcmp(needed[i].member, member) == 0) {
      defs->render.tracer = needed[i].tracer;
      defs->film.filter = vl_default_pixel_filter(needed[i].filter);
    }
}

static double setting_in(const vlSceneDefs *defs, const vlParameter *p) {
  const char *at = (const char *)defs + p->offset;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      return *(const bool *)at;
    case VL_PARAMETER_FLOAT:
      return (double)*(const float *)(const void *)at;
    case VL_PARAMETER_DOUBLE:
      return *(const double *)(const void *)at;
    default: /* an enum is as large as a count */
      return *(const uint32_t *)(const void *)at;
  }
}

/* What a file keeps of the value that the setting has in these defs. False: the writer says
 * that it loses something. */
static bool saved_setting(const vlParameter *p, double value, double *set, double *read) {
  char path[100];
  char message[VL_GIVEN_MESSAGE];
  int losses = 0;
  vlError error = {0};
  vlScene *scene = need_scene(HEAD "WorldBegin Shape \"sphere\"");
  vlSceneDefs *defs = vl_scene_defs(scene);
  vlGiven given = {.kind = VL_GIVEN_NUMBER, .number = value};
  double checked;
  if (p->type == VL_PARAMETER_BOOL)
    given.kind = VL_GIVEN_FLAG;
  if (p->type == VL_PARAMETER_CHOICE)
    given = (vlGiven){.kind = VL_GIVEN_TEXT, .text = p->choices[(int)value]};
  set_needs(defs, p->member);
  if (strstr(p->member, "film.lambda")) {
    defs->film.buckets = 7;
    given.number = 550;
  }
  if (!vl_given_check(p, p->member, &given, &checked, message))
    fail_msg("%s", message);
  vl_given_put(p, checked, defs);
  if (strcmp(p->member, "film.filter.kind") == 0)
    defs->film.filter = vl_default_pixel_filter(defs->film.filter.kind);
  *set = setting_in(defs, p);
  snprintf(path, sizeof path, "%s/settings.pbrt", folder);
  vlSaveDef save = vl_default_save_def();
  save.lost = count_camera_loss;
  save.lost_user = &losses;
  vlResult result = vl_scene_save(scene, path, &save, &error);
  vl_scene_destroy(scene);
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  if (result == VL_OK)
    result = vl_scene_load(scene, path, NULL, &error);
  if (result != VL_OK)
    fail_msg("%s: %s", p->member, error.message);
  *read = setting_in(vl_scene_defs(scene), p);
  vl_scene_destroy(scene);
  return losses == 0;
}

/* The window of the image that is rendered. */
static void saved_window(void) {
  static const uint32_t window[4] = {2, 3, 9, 11};
  vlScene *scene = need_scene(HEAD "WorldBegin Shape \"sphere\"");
  memcpy(vl_scene_defs(scene)->film.crop, window, sizeof window);
  vlScene *read = read_again(scene, "window.pbrt");
  const uint32_t *crop = vl_scene_defs(read)->film.crop;
  if (memcmp(crop, window, sizeof window) != 0)
    broken("settings", "film.crop", "2 3 9 11 is read again as %u %u %u %u", crop[0], crop[1],
           crop[2], crop[3]);
  vl_scene_destroy(read);
  vl_scene_destroy(scene);
}

/* The factor on the image, which a file may hold as the film's, the camera's, and by the
 * shutter's time. */
static void saved_exposure(void) {
  vlScene *scene = need_scene(HEAD "WorldBegin Shape \"sphere\"");
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->camera.shutter_close = 0.25;
  defs->camera.exposure_time = 2;
  defs->develop.exposure = 3;
  vlScene *read = read_again(scene, "exposure.pbrt");
  const vlSceneDefs *again = vl_scene_defs(read);
  const double exposure = (double)again->develop.exposure * again->camera.exposure_time;
  if (!same_number(exposure, 6) || !same_number(again->camera.shutter_close, 0.25))
    broken("settings", "develop.exposure", "6 of .25 s is read again as %g of %g s", exposure,
           again->camera.shutter_close);
  vl_scene_destroy(read);
  vl_scene_destroy(scene);
}

static void settings_of_scenes(void **state) {
  (void)state;
  int kept = 0;
  const vlKindRow *rows = vl_settings(VL_SETTING_RENDER);
  for (uint32_t i = 0; i < rows->parameter_count; i++) {
    const vlParameter *p = &rows->parameters[i];
    const bool number = p->type == VL_PARAMETER_COUNT || p->type == VL_PARAMETER_FLOAT ||
                        p->type == VL_PARAMETER_DOUBLE;
    const bool choice = p->type == VL_PARAMETER_CHOICE;
    if ((!number && !choice && p->type != VL_PARAMETER_BOOL) || is_of_renders(p->member))
      continue;
    int values = 0;
    while (choice && p->choices[values])
      values++;
    values = choice ? values : number ? 1 : 2;
    for (int k = 0; k < values; k++) {
      double set;
      double read;
      double value = choice || !number ? k : p->unit && strcmp(p->unit, "K") == 0 ? 5000 : 25;
      if (number && p->high != 0 && value > p->high)
        value = 0.5 * (p->low + p->high);
      if (!saved_setting(p, value, &set, &read))
        continue;
      kept++;
      if (!same_number(set, read))
        broken("settings", p->member, "%g is read again as %g, and nothing is said to be lost",
               set, read);
    }
  }
  saved_window();
  saved_exposure();
  print_message("settings of renders that files of scenes keep: %d\n", kept);
  assert_true(kept > 20);
  expect_no_failures();
}

#endif
