/* view/model.c: see model.h. */
#include "view/model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera/poses.h"
#include "cli/crop.h"
#include "cli/json.h"
#include "cli/report.h"
#include "render/exposure.h"
#include "velo/channels.h"
#include "velo/check.h"
#include "view/lecture.h"
#include "view/view.h"

static int choose_exposure(vlContext *context, const Arguments *arguments, Model *model) {
  bool meter;
  int status = exposure_parse(&arguments->values[RENDER_EXPOSURE], &model->exposure, &meter);
  bool wanted = meter || !arguments->values[RENDER_EXPOSURE].given;
  if (status >= 0 || !model->opening.model || !wanted)
    return status;
  return exposure_meter_model(context, model->scene, model->world, &model->job.camera,
                              model->job.defs, meter || model->opening.lamps ? 0 : 1,
                              &model->exposure);
}

/* The depth of what the middle of the image shows; where it shows nothing, of the middle of the
 * scene. */
static double find_lookat(const Model *model) {
  const vlCamera *c = &model->job.camera;
  vlChannelsDef def = vl_default_channels_def(c->width, c->height);
  crop_set_pixel(def.crop, c->width / 2, c->height / 2);
  def.channels = VL_CHANNEL_DISTANCE;
  vlImage *image = NULL;
  double distance = INFINITY, middle = 0;
  if (vl_render_channels(model->world, c, &def, &image, NULL, NULL) == VL_OK)
    distance = (double)vl_image_get(image, 0, 0, 0);
  vl_image_destroy(image);
  if (distance > 0 && isfinite(distance))
    return distance;
  const double *m = c->world_from_camera;
  for (int i = 0; i < 3; i++)
    middle += m[4 * i + 2] *
              (0.5 * ((double)model->info.bounds_min[i] + (double)model->info.bounds_max[i]) -
               m[4 * i + 3]);
  return middle > 0 && isfinite(middle) ? middle : 1;
}

/* The cameras of --trajectory, if it is given. */
static int load_poses(vlContext *context, const Arguments *arguments, Model *model,
                      FileList *files) {
  const OptionValue *value = &arguments->values[RENDER_TRAJECTORY];
  vlError error = {0};
  if (!value->given)
    return -1;
  file_list_add(files, value->text);
  vlResult result = poses_load(context, value->text, &model->job.camera, &model->cameras,
                               &model->camera_count, &error);
  return report_error(&error, result, value->text);
}

void model_time_text(double open, double close, char text[MODEL_TIME_TEXT]) {
  char from[32], to[32];
  format_number(from, sizeof from, open);
  format_number(to, sizeof to, close);
  snprintf(text, MODEL_TIME_TEXT, isnan(close) ? "%s" : "%s:%s", from, to);
}

/* Gives the arguments the time. text: of --at; it must live as long as the arguments. */
static void set_time(Arguments *arguments, const ModelTime *time, char text[MODEL_TIME_TEXT]) {
  model_time_text(time->at, time->shutter > 0 ? time->at + time->shutter : NAN, text);
  arguments->values[RENDER_AT] = (OptionValue){.given = true, .text = text};
  arguments->values[RENDER_SHUTTER].given = false;
}

/* The duration of the animation that is chosen; 0: there is none. */
static double find_seconds(const Model *model) {
  const char *wanted = model->opening.load.animation;
  const uint32_t count = vl_scene_choice_count(model->scene, VL_CHOICE_ANIMATION);
  uint32_t index = wanted ? (uint32_t)strtoul(wanted, NULL, 10) : 0;
  vlChoiceInfo info = {.seconds = 0};
  for (uint32_t i = 0; i < count; i++)
    if (wanted && vl_scene_choice_info(model->scene, VL_CHOICE_ANIMATION, i, &info) == VL_OK &&
        info.name && strcmp(info.name, wanted) == 0)
      index = i;
  if (index >= count ||
      vl_scene_choice_info(model->scene, VL_CHOICE_ANIMATION, index, &info) != VL_OK)
    return 0;
  return info.seconds;
}

int model_load(vlContext *context, const char *path, const Arguments *arguments,
               const ModelTime *time, const vlWorld *previous, const vlCancel *cancel,
               Model *model, FileList *files) {
  Arguments timed;
  char at[MODEL_TIME_TEXT];
  if (time) {
    timed = *arguments;
    set_time(&timed, time, at);
    arguments = &timed;
  }
  memset(model, 0, sizeof *model);
  model->opening.cancel = cancel;
  char *text = NULL;
  if (arguments->values[VIEW_LECTURE].given) {
    model->opening.text = text = lecture_text(path);
    if (!text)
      return report_no_memory();
  }
  vlError error = {0};
  vl_context_record_files(context, false);
  vl_context_record_files(context, true);
  model->job.records_files = true;
  int status = scene_open(context, path, arguments, &model->scene, &model->opening);
  free(text);
  model->opening.text = NULL;
  if (status < 0)
    status = job_make(&model->job, context, model->scene, path, arguments);
  if (status < 0) {
    vlBuildDef build = model->job.defs->build;
    build.previous = previous ? previous : model->opening.metered;
    build.cancel = cancel;
    vlResult result = vl_world_build_last(model->scene, &build, &model->world, &error);
    status = report_error(&error, result, path);
  }
  scene_opening_close(&model->opening);
  file_list_add(files, path);
  const vlFileRecord *file;
  for (uint32_t i = 0; (file = vl_context_file(context, i)); i++)
    file_list_add(files, file->path);
  vl_context_record_files(context, false);
  if (status < 0)
    status = lens_autofocus(&model->job, model->scene, model->world);
  if (status < 0)
    status = load_poses(context, arguments, model, files);
  if (status < 0 && time)
    model->exposure = time->exposure;
  else if (status < 0)
    status = choose_exposure(context, arguments, model);
  if (status >= 0) {
    model_free(model);
    return status;
  }
  vl_world_info(model->world, &model->info);
  model->lookat = find_lookat(model);
  model->seconds = find_seconds(model);
  model->timed = time != NULL;
  return status;
}

void model_destroy(Model *model) {
  if (model)
    model_free(model);
  free(model);
}

void model_free(Model *model) {
  vl_world_destroy(model->world);
  vl_scene_destroy(model->scene);
  free(model->cameras);
  memset(model, 0, sizeof *model);
}

/* ---- the list of its files --------------------------------------------------------------- */

void file_list_add(FileList *list, const char *path) {
  for (uint32_t i = 0; i < list->count; i++)
    if (strcmp(list->paths[i], path) == 0)
      return;
  char **larger = realloc(list->paths, (list->count + 1) * sizeof *larger);
  if (!larger)
    return;
  list->paths = larger;
  larger[list->count] = strdup(path);
  if (larger[list->count])
    list->count++;
}

void file_list_free(FileList *list) {
  for (uint32_t i = 0; i < list->count; i++)
    free(list->paths[i]);
  free(list->paths);
  *list = (FileList){.count = 0};
}
