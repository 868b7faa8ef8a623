/* render/again.c: see again.h. */
#include "render/again.h"

#include <string.h>

#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/receipt_repeat.h"

extern const char velo_commit[];

/* Only options that do not change the image may be given together with --again. */
static int take_options(Again *again, const Arguments *given) {
  for (const Option *option = render_options; option->name; option++) {
    if (!given->values[option->id].given)
      continue;
    if (receipt_option_counts(given, option->id) || option->id == RENDER_TIME)
      return report_usage("--again %s makes the same image: --%s would make another",
                          again->path, option->name);
    again->arguments.values[option->id] = given->values[option->id];
  }
  receipt_take_names(&again->arguments, given);
  return -1;
}

static int take_scene(Again *again, const Arguments *given) {
  const char *path = vl_receipt_scene(again->receipt);
  if (!path && !given->operand_count)
    return report_failure(STATUS_SCENE, "%s: its receipt names no scene; give the scene's file",
                          again->path);
  return receipt_take_scene(&again->arguments, given, path, "the receipt of", again->path,
                            "--again");
}

/* If the image's camera came from a file of its own, takes it from the receipt, so the file is
 * not needed. If the receipt does not hold the camera's lens, takes the lens from the file. */
static int take_camera(Again *again) {
  OptionValue *v = again->arguments.values;
  if (!v[RENDER_CAMERA].given || v[RENDER_TRAJECTORY].given)
    return -1;
  if (scene_camera_is_own(again->arguments.operands[0], &again->arguments))
    return -1;
  vlError error = {0};
  ReceiptCamera *camera = &again->camera;
  vlResult result =
      vl_receipt_camera(again->receipt, &camera->def, camera->size, camera->crop, &error);
  if (result == VL_ERROR_UNSUPPORTED)
    return -1;
  TRY(report_error(&error, result, again->path));
  camera->given = true;
  /* the receipt's film and camera include these settings */
  v[RENDER_RESOLUTION].given = v[RENDER_CROP].given = v[RENDER_CROPWINDOW].given = false;
  return -1;
}

static int check_samples(const Again *again) {
  uint32_t planned, samples = vl_receipt_samples(again->receipt, &planned);
  if (samples == planned && samples > 0)
    return -1;
  return report_failure(
      STATUS_SCENE,
      "%s holds %u of %u samples per pixel: an image that ended early cannot be made again",
      again->path, samples, planned);
}

/* An image that a program's own code has made is made again by that program. */
static int check_own(const Again *again) {
  static const char *const words[VL_OWN_KINDS] = {"camera", "sampler", "tracer"};
  for (int i = 0; i < VL_OWN_KINDS; i++) {
    const char *name = vl_receipt_own(again->receipt, (vlOwnKind)i);
    if (!name)
      continue;
    return report_failure(
        STATUS_SCENE,
        "%s was made with the own %s \"%s\" of another program: only it has that code",
        again->path, words[i], vl_short_text(name).text);
  }
  return -1;
}

static void tell_version(Again *again) {
  const char *commit, *version = vl_receipt_version(again->receipt, &commit);
  again->is_ours = strcmp(version, vl_version()->text) == 0 && strcmp(commit, velo_commit) == 0;
  if (!again->is_ours)
    report_warning(
        "%s was made by velo %s%s%s, this is %s%s%s: the header of the new image says so, its "
        "pixels may differ",
        again->path, version, *commit ? ", commit " : "", commit, vl_version()->text,
        *velo_commit ? ", commit " : "", velo_commit);
}

int again_open(Again *again, const Arguments **arguments) {
  const Arguments *given = *arguments;
  if (!given->values[RENDER_AGAIN].given)
    return -1;
  if (!given->text_count && !given->values[RENDER_DRY_RUN].given)
    return report_usage("--again: give the name of the new image with -o");
  vlImage *image = NULL;
  vlError error = {0};
  again->path = given->values[RENDER_AGAIN].text;
  TRY(context_open_one(&again->context));
  TRY(report_error(&error, vl_image_read_header(again->context, again->path, &image, &error),
                   again->path));
  const int status = receipt_of_image(again->context, image, again->path, &again->receipt);
  vl_image_destroy(image);
  TRY(status);
  TRY(check_own(again));
  TRY(receipt_parse_command(again->receipt, again->path, &again->arguments));
  TRY(check_samples(again));
  TRY(take_options(again, given));
  TRY(take_scene(again, given));
  TRY(take_camera(again));
  tell_version(again);
  *arguments = &again->arguments;
  return -1;
}

int again_check(const Again *again, const ReceiptPlan *plan, const Job *job,
                const ReceiptImage *which, bool with_camera) {
  if (!again->path)
    return -1;
  vlReceipt *now = NULL;
  TRY(report_reason(receipt_make(plan, job, which, &now), again->path,
                    "its receipt cannot be compared"));
  uint32_t parts = VL_RECEIPT_SEQUENCE | VL_RECEIPT_FILES | VL_RECEIPT_SETTINGS |
                   VL_RECEIPT_SAMPLES | VL_RECEIPT_DEVELOP;
  if (with_camera)
    parts |= VL_RECEIPT_CAMERA;
  int status = receipt_report_differences(again->receipt, now, parts, again->path);
  vl_receipt_destroy(now);
  return status;
}

void again_close(Again *again) {
  vl_receipt_destroy(again->receipt);
  context_close(again->context);
}
