/* view/engine_save.c: writes cameras and images into the folder in which the program was
 * started, and makes the command that renders the present image again. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "camera/camera.h"
#include "cli/crop.h"
#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/added.h"
#include "render/attributes.h"
#include "render/outputs.h"
#include "view/engine_copied.h"
#include "view/engine_status.h"
#include "view/view.h"

enum { NAME_SIZE = 300 };

static const char too_many[] = "there are too many files of this name";

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
  const char *name = text_file_name(e->def.path);
  const char *dot = strchr(name, '.');
  snprintf(stem, NAME_SIZE, "%.*s", dot && dot > name ? (int)(dot - name) : (int)strlen(name),
           name);
}

/* Answers that a file is written, or why not: null: it is. */
static void answer(Engine *e, const ViewMessage *m, const char *name, const char *why_not) {
  if (why_not)
    engine_refuse(e, m, why_not);
  else
    engine_post(e, m->client, "saved", "id %u, file %s", m->id, name);
}

/* As free_name; where no name is free, that is posted. */
static bool take_name(Engine *e, const ViewMessage *m, const char *wanted,
                      char name[NAME_SIZE]) {
  const bool there = free_name(wanted, name);
  if (!there)
    engine_refuse(e, m, too_many);
  return there;
}

static int choice_value(const Choice *choices, const char *name, int otherwise) {
  for (; choices->name; choices++)
    if (strcmp(choices->name, name) == 0)
      return choices->value;
  return otherwise;
}

/* ---- files ------------------------------------------------------------------------------- */

vlResult engine_write_camera(const Engine *e, const char *path, vlCameraDialect dialect,
                             vlError *error) {
  vlCameraFileDef def = vl_default_camera_file_def();
  const vlCameraRecord record = {.camera = e->now.camera.def, .frames = 1};
  def.dialect = dialect;
  return vl_camera_write(e->def.context, path, &def, &record, error);
}

/* False after posting why not. */
static bool write_camera(Engine *e, const ViewMessage *m, const char *path,
                         vlCameraDialect dialect) {
  vlError error = {0};
  vlResult result = engine_write_camera(e, path, dialect, &error);
  if (result != VL_OK)
    engine_refuse(e, m, error_text(&error, result));
  return result == VL_OK;
}

static void save_camera(Engine *e, const ViewMessage *m, const char *wanted,
                        const char *dialect) {
  char name[NAME_SIZE];
  int found = choice_value(kind_choices(dialects), dialect, -1);
  if (found < 0 || found == VL_CAMERA_DIALECT_EXR)
    return engine_refuse(e, m, "there is no such dialect");
  if (!take_name(e, m, wanted, name))
    return;
  if (write_camera(e, m, name, (vlCameraDialect)found))
    answer(e, m, name, NULL);
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

/* The present image, with the header that saved images have. */
static vlResult present_image(Engine *e, vlImage **image) {
  vlSceneDefs defs;
  const Job job = present_job(e, &defs);
  TRY_RESULT(vl_film_develop(e->film, &defs.develop, image));
  return attributes_set(*image, &job, defs.render.spp);
}

/* The raw image of the mode "camera", or what is developed of it. */
static void save_exposure(Engine *e, const ViewMessage *m, const char *wanted) {
  char name[NAME_SIZE];
  vlError error = {0};
  vlImage *image = NULL;
  const bool raw = text_ends_with(wanted, ".dng");
  if (e->now.channel != CHANNEL_CAMERA || !e->shot.raw || e->shot.scale != 1)
    return engine_refuse(e, m,
                         "a raw file (.dng) needs an exposure: show the image as the "
                         "camera sees it");
  if (!raw && !text_ends_with(wanted, ".png") && !text_ends_with(wanted, ".jpg") &&
      !text_ends_with(wanted, ".exr"))
    return engine_refuse(e, m, "formats of an exposure are .dng .png .jpg .exr");
  if (!take_name(e, m, wanted, name))
    return;
  vlResult result = raw ? vl_raw_write(e->shot.raw, name, &error)
                        : vl_raw_develop(e->shot.raw, NULL, &image, &error);
  if (result == VL_OK && !raw)
    result = vl_image_write(image, name, NULL, &error);
  vl_image_destroy(image);
  answer(e, m, name, result == VL_OK ? NULL : error_text(&error, result));
}

static void save_image(Engine *e, const ViewMessage *m, const char *wanted) {
  char name[NAME_SIZE];
  if (!engine_spp(e))
    return engine_refuse(e, m, "the image has no samples yet");
  if (e->now.channel == CHANNEL_CAMERA || text_ends_with(wanted, ".dng"))
    return save_exposure(e, m, wanted);
  if (!output_is_known(wanted))
    return engine_refuse(e, m, "formats are .exr .png .jpg .hdr .pfm .tga");
  if (!take_name(e, m, wanted, name))
    return;
  Outputs outputs = {.paths = {name},
                     .count = 1,
                     .view = (vlView)choice_value(view_choices, m->view, VL_VIEW_STANDARD),
                     .exposure = (float)m->exposure};
  vlImage *image = NULL;
  int status = STATUS_OTHER;
  if (present_image(e, &image) == VL_OK)
    status = outputs_write(e->def.context, &outputs, image, engine_spp(e), OUTPUT_FINISHED);
  vl_image_destroy(image);
  answer(e, m, name,
         status == STATUS_OK ? NULL
                             : "the image could not be written; the terminal has the reason");
}

void engine_save(Engine *e, const ViewMessage *m) {
  if (!name_is_plain(m->name))
    return engine_refuse(e, m, "the name must be that of a file in this folder");
  if (strcmp(m->what, "camera") == 0)
    return save_camera(e, m, m->name, m->dialect);
  if (strcmp(m->what, "image") == 0)
    return save_image(e, m, m->name);
  engine_refuse(e, m, "only cameras and images can be saved");
}

/* ---- the command ------------------------------------------------------------------------- */

/* Writes a word of the command with its zero. */
static void put_word(FILE *out, const char *word) {
  fwrite(word, 1, strlen(word) + 1, out);
}

/* Writes an option and its value. */
static void put_option(FILE *out, const char *option, const char *format, ...) PRINTF(3, 4);
static void put_option(FILE *out, const char *option, const char *format, ...) {
  va_list list;
  put_word(out, option);
  va_start(list, format);
  vfprintf(out, format, list);
  va_end(list);
  fputc(0, out);
}

/* Options that the camera file and the following words of the command replace, or that do not
 * matter. */
static bool option_is_replaced(int id) {
  static const int replaced[] = {
      VIEW_PORT,         VIEW_LISTEN,     VIEW_NO_OPEN,          VIEW_EXPOSE,
      RENDER_SPP,        RENDER_FILM,     RENDER_RESOLUTION,     RENDER_CROP,
      RENDER_CAMERA,     RENDER_FRAME,    RENDER_SIZE,           RENDER_SEQUENCE,
      RENDER_VIEW,       RENDER_EXPOSURE, RENDER_FOCUS_PIXEL,    RENDER_LENS_RADIUS,
      RENDER_F_NUMBER,   RENDER_THREADS,  RENDER_FOCUS_DISTANCE, RENDER_QUIET,
      RENDER_MAX_MEMORY, RENDER_ISO,      RENDER_SECONDS,        RENDER_TURN,
      RENDER_TRAJECTORY, RENDER_TRACER,   RENDER_LIGHT_PATHS,    RENDER_STRICT_OPTIONS,
      RENDER_AT,         RENDER_SHUTTER};
  return option_is_in(id, replaced, LENGTH(replaced));
}

/* Options that were given, and those that say what velo chose. */
static void put_options(FILE *out, const Engine *e) {
  const Arguments *arguments = e->def.arguments;
  AddedOptions added;
  added_options(&e->model.opening, arguments, false, &added);
  for (const Option *o = view_options; o->name; o++) {
    const OptionValue *value = &arguments->values[o->id];
    const char *text = value->text;
    const bool of_sensor = o->id == RENDER_FILTER && e->now.channel == CHANNEL_CAMERA;
    const bool replaced = added_replaces(o->id) || option_is_replaced(o->id) || of_sensor;
    if (!added_has(&added, o->id, &text) && (!value->given || replaced))
      continue;
    const bool folders = o->kind == OPTION_FOLDERS;
    const int times = folders ? arguments->folder_count : 1;
    for (int i = 0; i < times; i++) {
      fputs("--", out);
      put_word(out, o->name);
      if (o->kind != OPTION_FLAG)
        put_word(out, folders ? arguments->folders[i] : text);
    }
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
    text_set(number, "-%d", i);
  }
  return false;
}

/* The time at which the model is shown, and how long the shutter is open. */
static void put_time(FILE *out, const vlLoadDef *load) {
  char at[MODEL_TIME_TEXT];
  if (isnan(load->time))
    return;
  model_time_text(load->time, load->time_close, at);
  put_option(out, "--at", "%s", at);
}

/* The part of the command that makes the samples. */
static void put_render(FILE *out, const Engine *e, const char *camera, uint32_t spp) {
  const vlRenderDef *render = &e->model.job.defs->render;
  const vlCamera *made = &e->now.camera.made;
  const uint32_t *c = e->now.crop;
  put_word(out, "velo");
  put_word(out, "render");
  put_word(out, e->def.path);
  put_option(out, "--camera", "%s", camera);
  if (e->now.camera.def.width != made->width || e->now.camera.def.height != made->height)
    put_option(out, "--resolution", "%ux%u", made->width, made->height);
  if (!crop_is_whole(c, made->width, made->height))
    put_option(out, "--crop", "%u,%u,%u,%u", c[0], c[1], c[2], c[3]);
  put_options(out, e);
  put_time(out, &e->model.opening.load);
  /* the tracer of the image, so that there is no race */
  put_option(out, "--tracer", "%s", kind_name("tracers", (int)e->shown.tracer));
  if (e->shown.light_paths != VL_AS_MANY_AS_PIXELS)
    put_option(out, "--light-paths", "%u", e->shown.light_paths);
  put_option(out, "--spp", "%u", spp);
  put_option(out, "--sequence", "%u", render->sequence ? render->sequence : 65536);
}

static void put_number(FILE *out, const char *option, double value) {
  char number[40];
  format_number(number, sizeof number, value);
  put_option(out, option, "%s", number);
}

static void put_command(FILE *out, const Engine *e, const Copied *copied, const char *camera) {
  put_render(out, e, camera, copied->spp);
  put_option(out, "--view", "%s", choice_name(view_choices, (int)copied->view));
  put_number(out, "--exposure", copied->exposure);
  put_word(out, "--no-receipt");
  put_option(out, "-o", "%s", copied->file);
}

/* Null after posting why not. */
static Copied *make_command(Engine *e, const ViewMessage *m, char camera[NAME_SIZE]) {
  char stem[NAME_SIZE - 40], whole[NAME_SIZE];
  scene_stem(e, whole);
  text_set(stem, "%.200s-view", whole);
  Copied *copied = calloc(1, sizeof *copied);
  FILE *out = copied ? open_memstream(&copied->words, &copied->size) : NULL;
  if (!out) {
    copied_free(copied);
    engine_refuse(e, m, "out of memory");
    return NULL;
  }
  copied->exposure = m->exposure;
  copied->view = (vlView)choice_value(view_choices, m->view, VL_VIEW_STANDARD);
  copied->spp = engine_spp(e);
  bool ok = free_pair(stem, camera, copied->file);
  if (!ok)
    engine_refuse(e, m, too_many);
  ok = ok && write_camera(e, m, camera, VL_CAMERA_DIALECT_VELO);
  if (ok)
    put_command(out, e, copied, camera);
  bool whole_text = fclose(out) == 0;
  if (ok && (!whole_text || present_image(e, &copied->image) != VL_OK)) {
    engine_refuse(e, m, "out of memory");
    ok = false;
  }
  if (ok)
    return copied;
  copied_free(copied);
  return NULL;
}

void copied_free(Copied *copied) {
  if (!copied)
    return;
  vl_image_destroy(copied->image);
  free(copied->words);
  free(copied);
}

/* Words, each with its zero, as a shell reads them. */
static void put_text(FILE *out, const char *word, size_t size) {
  const char *end = word + size;
  fputs(word, out);
  for (word += strlen(word) + 1; word < end; word += strlen(word) + 1)
    text_shell_word(out, word);
}

/* The command as a shell reads it; null: memory is exhausted. The caller frees it. */
static char *command_text(const Copied *copied) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out)
    return NULL;
  put_text(out, copied->words, copied->size);
  return fclose(out) == 0 ? text : NULL;
}

/* The command is the one to verify from now on. */
static void keep_command(Engine *e, Copied *copied) {
  engine_lock(e);
  Copied *before = e->verify.copied;
  e->verify.copied = copied;
  engine_unlock(e);
  copied_free(before);
}

/* Posts a command, the camera's file, the image and its samples; frees the command. Null:
 * memory is exhausted. */
static void post_command(Engine *e, const ViewMessage *m, char *command, const char *camera,
                         const char *image, uint32_t spp) {
  if (command)
    engine_post(e, m->client, "command", "id %u, command %s, file %s, image %s, spp %u", m->id,
                command, camera, image, spp);
  free(command);
}

/* ---- the commands of an exposure --------------------------------------------------------- */

/* The film of the mode "camera". */
static void put_light(FILE *out, const Engine *e, const char *camera, const char *image) {
  put_render(out, e, camera, e->shot.spp);
  if (e->model.job.defs->film.buckets != e->shot.buckets)
    put_option(out, "--spectrum", "%u", e->shot.buckets);
  put_option(out, "--filter", "box");
  put_option(out, "--channels", "error");
  put_word(out, "--no-receipt");
  put_option(out, "-o", "%s", image);
}

static void put_sensor(FILE *out, const Engine *e, const char *image, const char *raw) {
  const vlExposureDef *exposure = &e->shot.exposure;
  const bool own = strcmp(e->shot.preset, e->sensors.own) == 0;
  put_word(out, "velo");
  put_word(out, "sensor");
  put_word(out, "expose");
  put_word(out, image);
  put_option(out, "--sensor", "%s",
             own ? e->def.arguments->values[VIEW_EXPOSE].text : e->shot.preset);
  put_number(out, "--exposure-time", exposure->time);
  put_number(out, "--f-number", exposure->f_number);
  put_number(out, "--iso", exposure->iso);
  put_number(out, "--gain", exposure->gain);
  put_number(out, "--temperature", exposure->temperature);
  put_number(out, "--seed", exposure->seed);
  put_number(out, "--frame", exposure->frame);
  if (e->now.sensor.white == VIEW_WHITE_A)
    put_option(out, "--white", "stdillum-A");
  put_option(out, "-o", "%s", raw);
}

/* Both commands as a shell reads them; null: memory is exhausted. The caller frees it. */
static char *exposure_text(const Engine *e, const char *camera, const char *image,
                           const char *raw) {
  char *words[2] = {NULL}, *text = NULL;
  size_t sizes[2] = {0}, size = 0;
  bool made = true;
  for (int i = 0; i < 2 && made; i++) {
    FILE *out = open_memstream(&words[i], &sizes[i]);
    if (out && i == 0)
      put_light(out, e, camera, image);
    else if (out)
      put_sensor(out, e, image, raw);
    made = out && fclose(out) == 0;
  }
  FILE *out = made ? open_memstream(&text, &size) : NULL;
  if (out) {
    put_text(out, words[0], sizes[0]);
    fputs(" && ", out);
    put_text(out, words[1], sizes[1]);
    made = fclose(out) == 0;
  }
  free(words[0]);
  free(words[1]);
  return made ? text : NULL;
}

/* Posts the commands that render the light of the present exposure and expose the sensor. */
static void exposure_command(Engine *e, const ViewMessage *m) {
  char stem[NAME_SIZE - 60], whole[NAME_SIZE], camera[NAME_SIZE], image[NAME_SIZE],
      raw[NAME_SIZE];
  if (!e->shot.raw || e->shot.scale != 1)
    return engine_refuse(e, m, "the image has no samples yet");
  if (e->now.sensor.white == VIEW_WHITE_AUTO)
    return engine_refuse(e, m, "the white auto is this image's; a command has D65 or A");
  scene_stem(e, whole);
  text_set(stem, "%.190s-sensor", whole);
  if (!free_pair(stem, camera, image))
    return engine_refuse(e, m, too_many);
  text_set(raw, "%.*s.dng", (int)strlen(image) - 4, image);
  strcpy(image + strlen(image) - 4, ".exr");
  if (!write_camera(e, m, camera, VL_CAMERA_DIALECT_VELO))
    return;
  keep_command(e, NULL); /* what is verified is one command */
  post_command(e, m, exposure_text(e, camera, image, raw), camera, raw, e->shot.spp);
}

void engine_command(Engine *e, const ViewMessage *m) {
  char camera[NAME_SIZE];
  if (!engine_spp(e))
    return engine_refuse(e, m, "the image has no samples yet");
  if (e->now.channel == CHANNEL_CAMERA)
    return exposure_command(e, m);
  Copied *copied = make_command(e, m, camera);
  if (!copied)
    return;
  keep_command(e, copied);
  post_command(e, m, command_text(copied), camera, copied->file, copied->spp);
}
