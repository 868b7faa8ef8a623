/* view/model.c: see model.h. */
#include "view/model.h"

#include <string.h>

#include "cli/report.h"
#include "render/exposure.h"
#include "render/lens_options.h"

static int choose_exposure(vlContext *context, const Arguments *arguments, Model *model) {
  bool meter;
  int status = exposure_parse(&arguments->values[RENDER_EXPOSURE], &model->exposure, &meter);
  bool wanted = meter || !arguments->values[RENDER_EXPOSURE].given;
  if (status >= 0 || !model->opening.model || !wanted) return status;
  return exposure_meter_model(context, model->world, &model->job.camera, model->job.defs,
                              meter || model->opening.lamps ? 0 : 1, &model->exposure);
}

int model_load(vlContext *context, const char *path, const Arguments *arguments, Model *model, FileList *files) {
  memset(model, 0, sizeof *model);
  vlError error = {0};
  vl_context_record_files(context, false);
  vl_context_record_files(context, true);
  model->job.records_files = true;
  int status = scene_open(context, path, arguments, &model->scene, &model->opening);
  if (status < 0) status = job_make(&model->job, context, model->scene, path, arguments);
  if (status < 0) {
    vlResult result = vl_world_build_last(model->scene, &model->job.defs->build, &model->world, &error);
    if (result != VL_OK) status = report_error(&error, result, path);
  }
  file_list_add(files, path);
  const vlFileRecord *file;
  for (uint32_t i = 0; (file = vl_context_file(context, i)); i++) file_list_add(files, file->path);
  vl_context_record_files(context, false);
  if (status < 0) status = lens_autofocus(&model->job, model->scene, model->world);
  if (status < 0) status = choose_exposure(context, arguments, model);
  if (status < 0)
    vl_world_info(model->world, &model->info);
  else
    model_free(model);
  return status;
}

void model_free(Model *model) {
  vl_world_destroy(model->world);
  vl_scene_destroy(model->scene);
  memset(model, 0, sizeof *model);
}
