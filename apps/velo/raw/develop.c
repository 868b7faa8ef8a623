/* raw/develop.c: `velo raw develop`: develops a raw file into an image, step by step. */
#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "raw/raw.h"
#include "render/output_names.h"
#include "render/outputs.h"

enum { DEVELOP_OUTPUT, DEVELOP_STOP_AT, DEVELOP_EXPOSURE };

static const Choice step_choices[] = {
    {"black", VL_RAW_STEP_BLACK},       {"white", VL_RAW_STEP_WHITE},
    {"demosaic", VL_RAW_STEP_DEMOSAIC}, {"color", VL_RAW_STEP_COLOR},
    {"tone", VL_RAW_STEP_TONE},         {0}};

static int write_outputs(const vlImage *image, const Arguments *arguments) {
  for (int i = 0; i < arguments->text_count; i++) {
    vlError error = {0};
    const char *path = output_opened(arguments->texts[i]);
    TRY(report_error(&error, vl_image_write(image, path, NULL, &error), path));
  }
  return STATUS_OK;
}

static int check_names(const Arguments *arguments, Outputs *outputs) {
  if (!arguments->text_count)
    return report_usage("raw develop: give the name of the image with -o");
  outputs_take_names(outputs, arguments);
  if (outputs_any(outputs, output_is_stdout))
    return report_usage("raw develop: the image is written to files only");
  TRY(outputs_check_names(outputs));
  return outputs_check_folders(outputs);
}

static int run_develop(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  Outputs outputs = {0};
  vlRaw *raw = NULL;
  vlImage *image = NULL;
  vlError error = {0};
  vlRawDevelopDef def = vl_default_raw_develop_def();
  def.stop_at = (vlRawStep)option_count(&v[DEVELOP_STOP_AT], def.stop_at);
  def.exposure = (float)v[DEVELOP_EXPOSURE].number;
  int status = check_names(arguments, &outputs);
  if (status < 0)
    status = raw_load(context, arguments->operands[0], &raw);
  if (status < 0)
    status = outputs_check_inputs(context, &outputs);
  if (status < 0) {
    vlResult result = vl_raw_develop(raw, &def, &image, &error);
    status = report_error(&error, result, arguments->operands[0]);
  }
  if (status < 0)
    status = write_outputs(image, arguments);
  vl_image_destroy(image);
  vl_raw_destroy(raw);
  return status;
}

static Option develop_options[] = {
    {DEVELOP_OUTPUT, "output",
     "image file to write; may be given several times. .exr has the step's numbers (after "
     "tone: linear light); .png has 16 bits after tone, else 8",
     OPTION_TEXTS, "FILE", .letter = 'o'},
    {DEVELOP_STOP_AT, "stop-at", "the last step that is done; default tone:", OPTION_CHOICE,
     "STEP", .choices = step_choices},
    {DEVELOP_EXPOSURE, "exposure", "exposure that the step tone adds to the file's own",
     OPTION_NUMBER, "EV", -100, 100},
    {0}};

const Command raw_develop_command = {
    .name = "raw develop",
    .usage = "FILE -o IMAGE [options]",
    .summary = "develop a raw file into an image",
    .text =
        "Develops a DNG file that velo wrote, in five steps:\n"
        "black     the black level is 0, the white level 1\n"
        "white     white balance: a white surface has 1 : 1 : 1; what is above 1 is cut\n"
        "demosaic  all colours of each pixel, by bilinear interpolation\n"
        "color     linear sRGB, by the colour matrices of the file\n"
        "tone      exposure, cut to [0, 1], sRGB's curve",
    .examples =
        "velo raw develop room.dng -o room.png\n"
        "velo raw develop room.dng -o mosaic.exr --stop-at black",
    .options = develop_options,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run_develop,
};
