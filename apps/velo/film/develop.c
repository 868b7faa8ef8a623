/* film/develop.c: `velo film develop`: makes the images of a film file, without the scene. */
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "image/image.h"
#include "render/attributes.h"
#include "render/exposure.h"
#include "render/output_names.h"
#include "render/outputs.h"
#include "render/receipt.h"
#include "velo/film.h"

enum { DEVELOP_OUTPUT, DEVELOP_VIEW, DEVELOP_EXPOSURE, DEVELOP_HALF };

typedef struct Develop {
  vlContext *context;
  vlFilmFile *file;
  vlFilm *film;
  vlImage *image, *errors, *spectrum;
  bool uneven; /* blocks have different samples */
  Outputs outputs;
} Develop;

/* The attributes of the render's own image. Where the film has a part of the pixels, the data
 * window is its own. */
static vlResult take_attributes(Develop *d, vlError *error) {
  vlAttribute window;
  bool is_part = vl_image_find_attribute(d->image, "dataWindow", &window) == VL_OK;
  TRY_RESULT(vl_film_file_attributes(d->file, d->image, error));
  return is_part ? vl_image_set_attribute(d->image, &window) : VL_OK;
}

static vlResult set_header(Develop *d, const vlReceipt *receipt, vlError *error) {
  uint32_t spp = vl_film_spp(d->film);
  const vlAttribute samples = {
      .name = "samplesPerPixel", .type = VL_ATTRIBUTE_INT, .numbers = {spp}};
  TRY_RESULT(take_attributes(d, error));
  TRY_RESULT(vl_image_set_attribute(d->image, &samples));
  TRY_RESULT(attributes_add_layer(d->image, d->errors));
  TRY_RESULT(attributes_add_layer(d->image, d->spectrum));
  if (!receipt || !spp)
    return VL_OK;
  if (d->uneven && !(vl_receipt_noise(receipt) > 0))
    return VL_OK; /* no command makes this image */
  vlReceipt *own = NULL;
  vlResult result = vl_receipt_of_image(receipt, spp, &own, NULL);
  if (result == VL_OK)
    result = image_set_text(d->image, RECEIPT_ATTRIBUTE, vl_receipt_text(own));
  vl_receipt_destroy(own);
  return result;
}

/* Finds out whether blocks with samples have different ones. */
static vlResult compare_blocks(Develop *d, vlError *error) {
  vlFilmBlock block;
  vlSampleRange first = {0, 0};
  for (;;) {
    vlResult result = vl_film_file_next(d->file, false, &block, error);
    if (result != VL_OK || block.x1 == 0)
      return result;
    if (!block.range_count)
      continue;
    if (!first.end)
      first = block.ranges[0];
    d->uneven |= block.range_count > 1 || block.ranges[0].first != first.first ||
                 block.ranges[0].end != first.end;
  }
}

static int develop(Develop *d, const char *path) {
  vlError error = {0};
  vlDevelopDef def = vl_default_develop_def();
  TRY(report_error(&error, vl_film_file_open(d->context, path, &d->file, &error), NULL));
  TRY(report_error(&error, compare_blocks(d, &error), NULL));
  TRY(report_error(&error, vl_film_read(d->context, path, true, &d->film, &error), NULL));
  const vlReceipt *receipt = vl_film_file_receipt(d->file);
  const vlFilmDef *film = vl_film_file_def(d->file);
  if (receipt)
    def.exposure = vl_receipt_exposure(receipt);
  vlResult result = vl_film_develop(d->film, &def, &d->image);
  if (result == VL_OK && film->errors)
    result = vl_film_errors(d->film, &def, &d->errors);
  if (result == VL_OK && film->buckets)
    result = vl_film_spectrum(d->film, &d->spectrum);
  if (result == VL_OK)
    result = set_header(d, receipt, &error);
  if (result != VL_OK && error.message[0])
    return report_error(&error, result, path);
  d->outputs.layers[0] = d->errors;
  d->outputs.layers[1] = d->spectrum;
  return report_reason(result, path, "the film cannot be developed");
}

static int run_develop(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  Develop d;
  memset(&d, 0, sizeof d);
  d.context = context;
  Outputs *outputs = &d.outputs;
  outputs_take_names(outputs, arguments);
  outputs->half = v[DEVELOP_HALF].given;
  outputs->to_stdout = true;
  outputs->view = (vlView)option_count(&v[DEVELOP_VIEW], VL_VIEW_STANDARD);
  if (!outputs->count)
    return report_usage("film develop: give the name of the image with -o");
  int status = exposure_parse(&v[DEVELOP_EXPOSURE], &outputs->exposure, &outputs->meter);
  if (status < 0)
    status = outputs_check_names(outputs);
  if (status < 0)
    status = outputs_check_folders(outputs);
  if (status < 0)
    status = develop(&d, arguments->operands[0]);
  if (status < 0)
    status = outputs_check_inputs(d.context, outputs);
  if (status < 0)
    status = outputs_write(d.context, outputs, d.image, vl_film_spp(d.film), OUTPUT_FINISHED);
  vl_image_destroy(d.image);
  vl_image_destroy(d.errors);
  vl_image_destroy(d.spectrum);
  vl_film_destroy(d.film);
  vl_film_file_close(d.file);
  return status;
}

static Option develop_options[] = {
    {DEVELOP_OUTPUT, "output",
     "image file to write; may be given several times. The suffix chooses the format, as for "
     "velo render",
     OPTION_TEXTS, "FILE", .letter = 'o'},
    OUTPUT_VIEW_OPTION(DEVELOP_VIEW),
    {DEVELOP_EXPOSURE, "exposure",
     "exposure of .png .jpg .tga: a number multiplies the image by 2^EV; auto chooses it so "
     "that the geometric mean of the luminance becomes 18 % grey",
     OPTION_TEXT, "EV"},
    OUTPUT_HALF_OPTION(DEVELOP_HALF),
    {0}};

const Command film_develop_command = {
    .name = "film develop",
    .usage = "FILE -o IMAGE [options]",
    .summary = "write the images of a film file",
    .text =
        "Writes the image of a film file, which may be incomplete. An .exr also has the "
        "standard errors and\n"
        "the spectrum, if the film has their sums. Ground truth requires the scene:\n"
        "velo render --continue FILE -o IMAGE.exr --channels LIST.",
    .examples =
        "velo film develop room.film -o room.exr\n"
        "velo film develop room.film -o room.png --view agx",
    .options = develop_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_develop,
};
