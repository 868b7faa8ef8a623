/* render/lens_options.c: see lens_options.h. */
#include "render/lens_options.h"

#include <math.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "velo/focus.h"

/* Parses "X,Y", decimal numbers. */
static bool read_point(const char *text, double point[2]) {
  return strspn(text, "0123456789+-.eE,") == strlen(text) && parse_numbers(text, 2, point);
}

static int refocus(vlScene *scene, const vlSceneDefs *defs, double distance) {
  vlError error = {0};
  vlResult result = vl_scene_refocus(scene, distance, &error);
  if (result == VL_OK)
    return -1;
  const vlSource *source = &defs->camera_source;
  if (source->file) {
    text_set(error.file, "%s", source->file);
    error.line = source->line;
    error.column = source->column;
  }
  return report_error(&error, result == VL_ERROR_ARGUMENT ? VL_ERROR_SCENE : result, NULL);
}

int lens_override(vlScene *scene, vlSceneDefs *defs, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  vlCameraDef *def = &defs->camera;
  double point[2];
  TRY(options_exclude(arguments, RENDER_FOCUS_PIXEL, RENDER_FOCUS_DISTANCE));
  if (v[RENDER_FOCUS_PIXEL].given && !read_point(v[RENDER_FOCUS_PIXEL].text, point))
    return report_usage("--focus-pixel \"%s\": not two numbers X,Y",
                        v[RENDER_FOCUS_PIXEL].text);
  if (v[RENDER_FOCUS_PIXEL].given || v[RENDER_FOCUS_DISTANCE].given) {
    for (int i = 0; i < 2; i++)
      def->lens.focus_pixel[i] = VL_UNSET;
    for (int i = 0; i < 3; i++)
      def->lens.focus_point[i] = VL_UNSET;
    def->focus_distance = VL_UNSET;
  }
  if (v[RENDER_FOCUS_DISTANCE].given) {
    if (def->lens.optics)
      return refocus(scene, defs, v[RENDER_FOCUS_DISTANCE].number);
    def->focus_distance = v[RENDER_FOCUS_DISTANCE].number;
  }
  if (v[RENDER_LENS_RADIUS].given) {
    def->lens_radius = v[RENDER_LENS_RADIUS].number;
    def->lens.f_number = VL_UNSET;
  }
  if (v[RENDER_F_NUMBER].given) {
    def->lens.f_number = v[RENDER_F_NUMBER].number;
    if (!v[RENDER_LENS_RADIUS].given)
      def->lens_radius = 0;
  }
  if (v[RENDER_ISO].given || v[RENDER_SECONDS].given)
    def->exposure_time = 1;
  if (v[RENDER_ISO].given)
    def->lens.iso = v[RENDER_ISO].number;
  if (v[RENDER_SECONDS].given)
    def->lens.seconds = v[RENDER_SECONDS].number;
  return -1;
}

int lens_focus_on(vlCamera *camera, const Arguments *arguments) {
  const OptionValue *v = &arguments->values[RENDER_FOCUS_PIXEL];
  double point[2];
  if (!v->given || !read_point(v->text, point))
    return -1;
  if (!(point[0] >= 0 && point[1] >= 0 && point[0] <= camera->width &&
        point[1] <= camera->height))
    return report_usage("--focus-pixel \"%s\": the image has only %u x %u pixels", v->text,
                        camera->width, camera->height);
  camera->lens.focus_pixel[0] = point[0];
  camera->lens.focus_pixel[1] = point[1];
  return -1;
}

int lens_autofocus(Job *job, vlScene *scene, const vlWorld *world) {
  vlCamera *camera = &job->camera;
  double *pixel = camera->lens.focus_pixel, distance;
  if (isnan(pixel[0]) || isnan(pixel[1]))
    return -1;
  vlError error = {0};
  vlResult result = vl_autofocus(world, camera, pixel[0], pixel[1], &distance, &error);
  if (result != VL_OK) {
    text_set(job->camera_location.message, "%s", error.message);
    return report_error(&job->camera_location,
                        result == VL_ERROR_ARGUMENT ? VL_ERROR_SCENE : result, NULL);
  }
  pixel[0] = pixel[1] = VL_UNSET;
  if (camera->lens.optics && !scene)
    return report_usage(
        "--focus-pixel: along a trajectory a lens of many elements keeps its focus");
  if (!camera->lens.optics) {
    camera->focus_distance = distance;
    return -1;
  }
  TRY(refocus(scene, job->defs, distance));
  vlCameraDef def = job->defs->camera;
  vlCamera made;
  def.width = camera->width;
  def.height = camera->height;
  TRY(report_error(&error, vl_camera_make(&def, &made, NULL, &error), job->path));
  camera->fx = made.fx;
  camera->fy = made.fy;
  camera->focus_distance = made.focus_distance;
  camera->lens_radius = made.lens_radius;
  camera->lens = made.lens;
  return -1;
}
