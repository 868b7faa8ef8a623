/* view/engine_save.c: writes cameras and images into the folder in which the program was
 * started, and makes the command that renders the present image again. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "camera/camera.h"
#include "cli/kinds.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/added.h"
#include "render/attributes.h"
#include "render/outputs.h"
#include "view/engine_status.h"
#include "view/view.h"

enum { NAME_SIZE = 300 };

/* A page may name files of this folder only, and none that is hidden. */
static bool name_is_plain(const char *name) {
  return name[0] && name[0] != '.' && name[0] != '-' && !strchr(name, '/') &&
         strlen(name) < MESSAGE_NAME;
}

/* The name, or where a file has it already, the name with a number before its suffix. */
static bool free_name(const char *wanted, char name[NAME_SIZE]) {
  const char *dot = strrchr(wanted, '.');
  int stem = dot ? (int)(dot - wanted) : (int)strlen(wanted);
  snprintf(name, NAME_SIZE, "%s", wanted);
  for (int i = 2; i < 10000 && access(name, F_OK) == 0; i++)
    snprintf(name, NAME_SIZE, "%.*s-%d%s", stem, wanted, i, dot ? dot : "");
  return access(name, F_OK) != 0;
}

/* The scene's name without folder and suffix. */
static void scene_stem(const Engine *e, char stem[NAME_SIZE]) {
  const char *slash = strrchr(e->def.path, '/'), *name = slash ? slash + 1 : e->def.path,
             *dot = strchr(name, '.');
  snprintf(stem, NAME_SIZE, "%.*s", dot && dot > name ? (int)(dot - name) : (int)strlen(name),
           name);
}

static void post_saved(Engine *e, const Task *task, const char *name) {
  JsonText text;
  if (!json_text_begin(&text, "saved"))
    return;
  json_integer(&text.json, "id", task->message.id);
  json_text(&text.json, "file", name);
  json_text_post(&text, e->server, task->client);
}

static int choice_value(const Choice *choices, const char *name, int otherwise) {
  for (; choices->name; choices++)
    if (strcmp(choices->name, name) == 0)
      return choices->value;
  return otherwise;
}

/* ---- files ------------------------------------------------------------------------------- */

static void save_camera(Engine *e, const Task *task, const char *wanted, const char *dialect) {
  char name[NAME_SIZE];
  vlError error = {0};
  vlCameraFileDef def = vl_default_camera_file_def();
  vlCameraRecord record = {.camera = e->now.camera.def, .frames = 1};
  int found = choice_value(dialect_choices, dialect, -1);
  if (found < 0 || found == VL_CAMERA_DIALECT_EXR)
    return engine_refuse(e, task, "there is no such dialect");
  if (!free_name(wanted, name))
    return engine_refuse(e, task, "there are too many files of this name");
  def.dialect = (vlCameraDialect)found;
  vlResult result = vl_camera_write(e->def.context, name, &def, &record, &error);
  if (result == VL_OK)
    post_saved(e, task, name);
  else
    engine_refuse(e, task, error.message[0] ? error.message : vl_result_name(result));
}

vlSceneDefs engine_present_defs(const Engine *e) {
  vlSceneDefs defs = *e->model.job.defs;
  defs.camera = e->now.camera.def;
  memcpy(defs.film.crop, e->now.crop, sizeof e->now.crop);
  defs.render.spp = vl_film_spp(e->film);
  engine_set_tracer(&defs.render, e->shown);
  return defs;
}

/* The job as `velo render` would have it for the present image. */
static Job present_job(const Engine *e, vlSceneDefs *defs) {
  Job job = e->model.job;
  *defs = engine_present_defs(e);
  job.defs = defs;
  job.camera = e->now.camera.made;
  job.receipt = NULL;
  return job;
}

static void save_image(Engine *e, const Task *task, const char *wanted) {
  char name[NAME_SIZE];
  bool eight_bit;
  const ViewMessage *m = &task->message;
  if (!e->film || !vl_film_spp(e->film))
    return engine_refuse(e, task, "the image has no samples yet");
  if (!output_suffix(wanted, &eight_bit))
    return engine_refuse(e, task, "formats are .exr .png .jpg .hdr .pfm .tga");
  if (!free_name(wanted, name))
    return engine_refuse(e, task, "there are too many files of this name");
  Outputs outputs = {.paths = {name},
                     .count = 1,
                     .view = (vlView)choice_value(view_choices, m->view, VL_VIEW_STANDARD),
                     .exposure = (float)m->exposure};
  vlSceneDefs defs;
  const Job job = present_job(e, &defs);
  vlImage *image = NULL;
  vlResult result = vl_film_develop(e->film, &defs.develop, &image);
  if (result == VL_OK)
    result = attributes_set(image, &job, defs.render.spp);
  int status = STATUS_OTHER;
  if (result == VL_OK)
    status = outputs_write(e->def.context, &outputs, image, defs.render.spp, OUTPUT_FINISHED);
  vl_image_destroy(image);
  if (status == STATUS_OK)
    post_saved(e, task, name);
  else
    engine_refuse(e, task, "the image could not be written; the terminal has the reason");
}

void engine_save(Engine *e, const Task *task) {
  const ViewMessage *m = &task->message;
  if (!name_is_plain(m->name))
    return engine_refuse(e, task, "the name must be that of a file in this folder");
  if (strcmp(m->what, "camera") == 0)
    return save_camera(e, task, m->name, m->dialect);
  if (strcmp(m->what, "image") == 0)
    return save_image(e, task, m->name);
  engine_refuse(e, task, "only cameras and images can be saved");
}

/* ---- the command ------------------------------------------------------------------------- */

/* Options that the camera file and the following words of the command replace, or that do not
 * matter. */
static bool option_is_replaced(int id) {
  static const int replaced[] = {
      VIEW_PORT,       VIEW_LISTEN,           VIEW_NO_OPEN,         RENDER_SPP,
      RENDER_FILM,     RENDER_RESOLUTION,     RENDER_CROP,          RENDER_CAMERA,
      RENDER_FRAME,    RENDER_SIZE,           RENDER_SEQUENCE,      RENDER_VIEW,
      RENDER_EXPOSURE, RENDER_FOCUS_PIXEL,    RENDER_LENS_RADIUS,   RENDER_F_NUMBER,
      RENDER_THREADS,  RENDER_FOCUS_DISTANCE, RENDER_QUIET,         RENDER_MAX_MEMORY,
      RENDER_ISO,      RENDER_SECONDS,        RENDER_TURN,          RENDER_TRAJECTORY,
      RENDER_TRACER,   RENDER_LIGHT_PATHS,    RENDER_STRICT_OPTIONS};
  return option_is_in(id, replaced, sizeof replaced / sizeof *replaced);
}

/* Options that were given, and those that say what velo chose. */
static void put_options(FILE *out, const Engine *e) {
  const Arguments *arguments = e->def.arguments;
  AddedOptions added;
  added_options(&e->model.opening, arguments, false, &added);
  for (const Option *o = view_options; o->name; o++) {
    const OptionValue *value = &arguments->values[o->id];
    const char *text = value->text;
    const bool replaced = added_replaces(o->id) || option_is_replaced(o->id);
    if (!added_has(&added, o->id, &text) && (!value->given || replaced))
      continue;
    if (o->kind == OPTION_FOLDERS) {
      for (int i = 0; i < arguments->folder_count; i++) {
        fprintf(out, " --%s", o->name);
        text_shell_word(out, arguments->folders[i]);
      }
      continue;
    }
    fprintf(out, " --%s", o->name);
    if (o->kind != OPTION_FLAG)
      text_shell_word(out, text);
  }
}

/* Names of the camera's file and of the image: STEM.json and STEM.png, with a number after the
 * stem where a file has one of them already. */
static bool free_pair(const char *stem, char camera[NAME_SIZE], char image[NAME_SIZE]) {
  char number[16] = "";
  for (int i = 2; i < 10000; i++) {
    snprintf(camera, NAME_SIZE, "%s%s.json", stem, number);
    snprintf(image, NAME_SIZE, "%s%s.png", stem, number);
    if (access(camera, F_OK) != 0 && access(image, F_OK) != 0)
      return true;
    snprintf(number, sizeof number, "-%d", i);
  }
  return false;
}

/* Writes the camera and returns the command's text, which the caller frees; null after posting
 * why not. */
static char *make_command(Engine *e, const Task *task, char camera[NAME_SIZE]) {
  char stem[NAME_SIZE - 40], whole[NAME_SIZE], image[NAME_SIZE], *text = NULL;
  size_t size;
  vlError error = {0};
  const ViewMessage *m = &task->message;
  vlCameraFileDef def = vl_default_camera_file_def();
  const vlCameraRecord record = {.camera = e->now.camera.def, .frames = 1};
  const vlCamera *made = &e->now.camera.made;
  scene_stem(e, whole);
  snprintf(stem, sizeof stem, "%.200s-view", whole);
  if (!free_pair(stem, camera, image)) {
    engine_refuse(e, task, "there are too many files of this name");
    return NULL;
  }
  def.dialect = VL_CAMERA_DIALECT_VELO;
  vlResult result = vl_camera_write(e->def.context, camera, &def, &record, &error);
  if (result != VL_OK) {
    engine_refuse(e, task, error.message[0] ? error.message : vl_result_name(result));
    return NULL;
  }
  FILE *out = open_memstream(&text, &size);
  if (!out) {
    engine_refuse(e, task, "out of memory");
    return NULL;
  }
  const vlRenderDef *render = &e->model.job.defs->render;
  char number[40];
  fputs("velo render", out);
  text_shell_word(out, e->def.path);
  fputs(" --camera", out);
  text_shell_word(out, camera);
  if (record.camera.width != made->width || record.camera.height != made->height)
    fprintf(out, " --resolution %ux%u", made->width, made->height);
  const uint32_t *c = e->now.crop;
  if (c[0] || c[1] || c[2] < made->width || c[3] < made->height)
    fprintf(out, " --crop %u,%u,%u,%u", c[0], c[1], c[2], c[3]);
  put_options(out, e);
  /* the tracer of the image, so that there is no race */
  fprintf(out, " --tracer %s", kind_name("tracers", (int)e->shown.tracer));
  if (e->shown.light_paths != VL_AS_MANY_AS_PIXELS)
    fprintf(out, " --light-paths %u", e->shown.light_paths);
  format_number(number, sizeof number, m->exposure);
  fprintf(out, " --spp %u --sequence %u --view %s --exposure %s --no-receipt -o",
          vl_film_spp(e->film), render->sequence ? render->sequence : 65536,
          choice_name(view_choices, choice_value(view_choices, m->view, 0)), number);
  text_shell_word(out, image);
  return fclose(out) == 0 ? text : NULL;
}

void engine_command(Engine *e, const Task *task) {
  char camera[NAME_SIZE];
  if (!e->film || !vl_film_spp(e->film))
    return engine_refuse(e, task, "the image has no samples yet");
  char *command = make_command(e, task, camera);
  JsonText text;
  if (command && json_text_begin(&text, "command")) {
    json_integer(&text.json, "id", task->message.id);
    json_text(&text.json, "command", command);
    json_text(&text.json, "file", camera);
    json_integer(&text.json, "spp", vl_film_spp(e->film));
    json_text_post(&text, e->server, task->client);
  }
  free(command);
}
