/* render/receipt.c: see receipt.h. */
#include "render/receipt.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/header.h"
#include "image/image.h"
#include "render/added.h"
#include "render/lens_options.h"

extern const char velo_commit[]; /* written by cmake/commit.cmake */

bool receipt_option_counts(const Arguments *arguments, int option) {
  static const int others[] = {RENDER_OUTPUT,     RENDER_THREADS,     RENDER_TIME,
                               RENDER_DRY_RUN,    RENDER_QUIET,       RENDER_LOG_JSON,
                               RENDER_VERBOSE,    RENDER_ISA,         RENDER_MAX_MEMORY,
                               RENDER_SANDBOX,    RENDER_MAX_TEXTURE, RENDER_AGAIN,
                               RENDER_NO_RECEIPT, RENDER_FILM,        RENDER_CHECKPOINT,
                               RENDER_CONTINUE,   RENDER_SAMPLES,     RENDER_SHARD,
                               RENDER_SHARD_BY,   RENDER_TILES,       RENDER_SKIP_EXISTING,
                               RENDER_ANIMATE,    RENDER_FPS,         RENDER_TURNTABLE,
                               RENDER_SERVE,      RENDER_OVERWRITE,   RENDER_STRICT_OPTIONS,
                               RENDER_PLAIN};
  const OptionValue *bits = &arguments->values[RENDER_BITS];
  if (option == RENDER_ACCELERATOR)
    return bits->given && bits->integer == VL_BITS_FAST;
  if (option == RENDER_VIEW || option == RENDER_EXPOSURE)
    return arguments->values[RENDER_NOISE].given;
  return !option_is_in(option, others, LENGTH(others));
}

/* ---- the command ------------------------------------------------------------------------- */

/* Words of the command that makes an image: in one order whatever the order of the command
 * line, and always with the number of samples, so that the same image has the same command. */
typedef struct Words {
  const char *words[2 * MAX_OPTIONS + 4];
  uint32_t count;
  char names[MAX_OPTIONS][32], path[4100], spp[16], frame[16], light_paths[16];
  AddedOptions added;
} Words;

static void add_option(Words *w, const Option *option, const char *value) {
  snprintf(w->names[option->id], sizeof w->names[0], "--%s", option->name);
  w->words[w->count++] = w->names[option->id];
  if (option->kind != OPTION_FLAG)
    w->words[w->count++] = value;
}

/* The value of an option that a race replaces: the command names the result. Null: another
 * option. */
static const char *raced_value(Words *w, int option, const Job *job) {
  const vlRenderDef *render = &job->defs->render;
  if (!job->raced)
    return NULL;
  if (option == RENDER_TRACER)
    return kind_name("tracers", (int)render->tracer);
  if (option != RENDER_LIGHT_PATHS || render->light_paths == VL_AS_MANY_AS_PIXELS)
    return NULL;
  text_set(w->light_paths, "%u", render->light_paths);
  return w->light_paths;
}

static void find_words(Words *w, const ReceiptPlan *plan, const Job *job,
                       const ReceiptImage *which) {
  const Arguments *arguments = plan->arguments;
  added_options(plan->opening, arguments, plan->opening->camera_added, &w->added);
  text_set(w->path, "%s%s", job->path[0] == '-' ? "./" : "", job->path);
  text_set(w->spp, "%u", job->defs->render.spp);
  text_set(w->frame, "%u", which->frame);
  w->count = 0;
  w->words[w->count++] = "velo";
  w->words[w->count++] = "render";
  w->words[w->count++] = w->path;
  for (const Option *option = render_options; option->name; option++) {
    const OptionValue *value = &arguments->values[option->id];
    const char *raced = raced_value(w, option->id, job), *added = NULL;
    if (option->id == RENDER_SPP)
      add_option(w, option, w->spp);
    else if (raced)
      add_option(w, option, raced);
    else if (added_has(&w->added, option->id, &added))
      add_option(w, option, added);
    else if (added_replaces(option->id))
      continue;
    else if (option->id == RENDER_EYE && which->eye)
      add_option(w, option, which->eye);
    else if (option->id == RENDER_FRAMES && which->is_frame)
      add_option(w, option, w->frame);
    else if (value->given && receipt_option_counts(arguments, option->id))
      add_option(w, option, value->text);
  }
}

/* ---- the receipt ------------------------------------------------------------------------- */

/* The settings with the camera of this image: the pose of its frame, its eye. */
static vlSceneDefs defs_of(const Job *job, const ReceiptImage *which) {
  vlSceneDefs defs = *job->defs;
  vlCameraDef *camera = &defs.camera;
  if (which->eye)
    camera->stereo_eye = strcmp(which->eye, "right") == 0 ? VL_EYE_RIGHT : VL_EYE_LEFT;
  if (!which->is_frame || (camera->stereo.mode != VL_STEREO_NONE && !which->eye))
    return defs;
  camera->stereo.mode = VL_STEREO_NONE; /* the pose is the eye's own */
  camera->has_matrix = true;
  memcpy(camera->world_from_camera, job->camera.world_from_camera,
         sizeof camera->world_from_camera);
  camera->roll = 0.0; /* the matrix has it */
  camera->roll_close = VL_UNSET;
  camera->has_matrix_close = false;
  for (int i = 0; i < 3; i++)
    camera->eye_close[i] = camera->lookat_close[i] = camera->up_close[i] = VL_UNSET;
  camera->shutter_open = job->camera.shutter_open;
  camera->shutter_close = job->camera.shutter_close;
  return defs;
}

/* Returns whether autofocus found the focus distance. A lens of many elements stores its own
 * focus distance. */
static bool is_autofocused(const Job *job, const Arguments *arguments) {
  const double *pixel = job->defs->camera.lens.focus_pixel;
  bool wanted = arguments->values[RENDER_FOCUS_PIXEL].given || !isnan(pixel[0]);
  return wanted && !job->camera.lens.optics && isnan(job->camera.lens.focus_pixel[0]);
}

vlResult receipt_make(const ReceiptPlan *plan, const Job *job, const ReceiptImage *which,
                      vlReceipt **receipt) {
  Words words;
  find_words(&words, plan, job, which);
  vlSceneDefs defs = defs_of(job, which);
  vlReceiptDef def = vl_default_receipt_def();
  def.commit = velo_commit;
  def.scene = job->path;
  def.command = words.words;
  def.command_count = words.count;
  def.defs = &defs;
  def.load = &plan->opening->load;
  def.complete = &plan->opening->complete;
  def.samples = which->samples;
  def.outputs = which->outputs;
  def.output_count = which->output_count;
  if (is_autofocused(job, plan->arguments))
    def.focus_distance = job->camera.focus_distance;
  return vl_receipt_make(job->context, &def, receipt, NULL);
}

vlResult receipt_set(const Job *job, const ReceiptImage *which, vlImage *image) {
  const ReceiptPlan *plan = job->receipt;
  if (!plan)
    return VL_OK;
  vlReceipt *made = NULL;
  uint32_t planned = 0;
  const vlReceipt *receipt = plan->again;
  /* the receipt does not describe a part of the image or an image of another version */
  bool same =
      receipt && plan->again_is_ours && vl_receipt_samples(receipt, &planned) == which->samples;
  vlResult result = same ? VL_OK : receipt_make(plan, job, which, &made);
  if (result == VL_OK)
    result = image_set_text(image, RECEIPT_ATTRIBUTE, vl_receipt_text(same ? receipt : made));
  vl_receipt_destroy(made);
  return result;
}

int receipt_of_image(vlContext *context, const vlImage *image, const char *path,
                     vlReceipt **receipt) {
  const char *text = header_text(image, RECEIPT_ATTRIBUTE);
  vlError error = {0};
  if (!text)
    return report_failure(STATUS_SCENE,
                          "%s: there is no receipt in its header (docs/receipts.md)", path);
  vlResult result = vl_receipt_parse(context, text, strlen(text), receipt, &error);
  if (result == VL_OK)
    return -1;
  text_set(error.file, "%s", path);
  return report_error(&error, result, path);
}

void receipt_print_version(const vlReceipt *receipt) {
  const char *commit, *version = vl_receipt_version(receipt, &commit);
  text_print_plain(version);
  if (*commit)
    printf(", commit ");
  text_print_plain(commit);
}

int receipt_take_scene(Arguments *arguments, const Arguments *given, const char *path,
                       const char *what, const char *owner, const char *option) {
  struct stat info;
  arguments->operands[0] = given->operand_count ? given->operands[0] : path;
  if (given->operand_count)
    return -1;
  if (strlen(path) >= RECEIPT_MAX_WORD)
    return report_failure(STATUS_SCENE, "%s: the path of the scene in its receipt is too long",
                          owner);
  if (stat(path, &info) != 0)
    return report_failure(STATUS_MISSING,
                          "no such file: %s (of %s %s); give the scene's file before %s", path,
                          what, owner, option);
  if (S_ISREG(info.st_mode))
    return -1;
  return report_failure(STATUS_IO,
                        "%s (of %s %s) is not a regular file; give the scene's file before %s",
                        path, what, owner, option);
}
