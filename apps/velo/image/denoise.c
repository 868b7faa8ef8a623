/* image/denoise.c: `velo image denoise`: writes a denoised copy of a rendered image. */

#include "image/denoise.h"
#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "image/image.h"
#include "render/job.h"
#include "render/output_names.h"
#include "render/progress.h"

enum {
  DENOISE_OUTPUT,
  DENOISE_DENOISER,
  DENOISE_LIBRARY,
  DENOISE_VIEW,
  DENOISE_EXPOSURE,
  DENOISE_HALF,
  DENOISE_THREADS,
  DENOISE_VERBOSE
};

const Choice denoiser_choices[] = {{"velo", VL_DENOISER_VELO}, {"oidn", VL_DENOISER_OIDN}, {0}};

static int run_denoise(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  const char *path = arguments->operands[0];
  report_setup(false, v[DENOISE_VERBOSE].given ? REPORT_VERBOSE : REPORT_NORMAL);
  if (!arguments->text_count)
    return report_usage("where to? -o FILE");
  Outputs outputs = {.to_stdout = true,
                     .half = v[DENOISE_HALF].given,
                     .view = (vlView)option_count(&v[DENOISE_VIEW], VL_VIEW_STANDARD),
                     .exposure = (float)v[DENOISE_EXPOSURE].number};
  outputs_take_names(&outputs, arguments);
  TRY(outputs_check_names(&outputs));
  TRY(outputs_check_folders(&outputs));
  vlImage *image = NULL, *clean = NULL;
  vlError error = {0};
  int status = image_load(context, path, &image);
  if (status < 0)
    status = outputs_check_inputs(context, &outputs);
  vlDenoiseDef how = vl_default_denoise_def();
  vlDenoiseStats stats;
  how.denoiser = (vlDenoiser)option_count(&v[DENOISE_DENOISER], how.denoiser);
  how.library = v[DENOISE_LIBRARY].text;
  if (status < 0) {
    vlResult result = vl_denoise(image, &how, &clean, &stats, &error);
    if (result == VL_OK)
      result = denoise_name(clean, how.denoiser);
    status = report_error(&error, result, path);
  }
  if (status < 0)
    denoise_report(&stats);
  if (status < 0)
    status = outputs_write(context, &outputs, clean, 0, OUTPUT_FINISHED);
  vl_image_destroy(clean);
  vl_image_destroy(image);
  return status;
}

void denoise_report(const vlDenoiseStats *stats) {
  if (stats->not_finite)
    report_warning(
        "%llu pixels are not finite; the denoised image has their neighbours' light there",
        (unsigned long long)stats->not_finite);
  if (!stats->features)
    report_note("the image has no channels of features (--channels features): edges may blur");
  if (report_is_verbose())
    report_note("denoised in %s", format_seconds(stats->seconds).text);
}

vlResult denoise_name(vlImage *clean, vlDenoiser denoiser) {
  return image_set_text(clean, "velo.denoiser", choice_name(denoiser_choices, (int)denoiser));
}

static Option denoise_options[] = {
    {DENOISE_OUTPUT, "output",
     "denoised image to write: .exr .hdr .pfm (linear), .png .jpg .tga (display)", OPTION_TEXTS,
     "FILE", .letter = 'o'},
    {DENOISE_DENOISER, "denoiser",
     "velo: the built-in denoiser; oidn: Intel Open Image Denoise, if it is installed:",
     OPTION_CHOICE, "NAME", .choices = denoiser_choices},
    {DENOISE_LIBRARY, "denoiser-library",
     "path of the library of Open Image Denoise; default: the system's", OPTION_TEXT, "FILE"},
    OUTPUT_VIEW_OPTION(DENOISE_VIEW),
    OUTPUT_EXPOSURE_OPTION(DENOISE_EXPOSURE),
    OUTPUT_HALF_OPTION(DENOISE_HALF),
    THREADS_OPTION(DENOISE_THREADS, "image"),
    {DENOISE_VERBOSE, "verbose", "print the time that denoising took", .letter = 'v'},
    {0}};

const Command image_denoise_command = {
    .name = "image denoise",
    .usage = "FILE -o RESULT [options]",
    .summary = "write a denoised copy of a rendered image",
    .text =
        "Removes most of the noise of the image FILE and writes the result. FILE is an .exr "
        "that was rendered\n"
        "with velo render --channels error,features. The denoised image is biased; FILE is "
        "not changed.",
    .examples =
        "velo render room.pbrt --spp 16 --channels error,features -o room.exr\n"
        "velo image denoise room.exr -o clean.png",
    .options = denoise_options,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run_denoise,
};
