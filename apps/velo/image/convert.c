/* image/convert.c: `velo image convert`: conversion between formats, with a view for display
 * values, and cropping. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/crop.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "image/image.h"
#include "render/job.h"
#include "render/output_names.h"

enum { MAX_CHANNELS = 1024 }; /* of any image: velo/image.h */

enum {
  CONVERT_CROP,
  CONVERT_VIEW,
  CONVERT_EXPOSURE,
  CONVERT_HALF,
  CONVERT_CHANNEL,
  CONVERT_SCALE
};

static bool is_float(const vlImage *image) {
  return vl_image_type(image) == VL_PIXEL_F16 || vl_image_type(image) == VL_PIXEL_F32;
}

static size_t pixel_bytes(const vlImage *image) {
  switch (vl_image_type(image)) {
    case VL_PIXEL_U8:
      return vl_image_channels(image);
    case VL_PIXEL_U16:
    case VL_PIXEL_F16:
      return 2 * (size_t)vl_image_channels(image);
    default:
      return 4 * (size_t)vl_image_channels(image);
  }
}

static void channel_names(const vlImage *image, const char *names[MAX_CHANNELS]) {
  for (uint32_t c = 0; c < vl_image_channels(image); c++)
    names[c] = vl_image_channel_name(image, c);
}

/* Copies the attributes. After a crop, those that place the pixels in a larger image are left
 * out. */
static vlResult copy_attributes(const vlImage *from, vlImage *to, bool cropped) {
  for (uint32_t i = 0; i < vl_image_attribute_count(from); i++) {
    vlAttribute a;
    TRY_RESULT(vl_image_attribute(from, i, &a));
    if (cropped && (strcmp(a.name, "dataWindow") == 0 || strcmp(a.name, "displayWindow") == 0))
      continue;
    TRY_RESULT(vl_image_set_attribute(to, &a));
  }
  return VL_OK;
}

/* Copies the window's pixels as linear floats. */
static void copy_floats(const vlImage *from, const uint32_t window[4], vlImage *to) {
  const uint32_t channels = vl_image_channels(from);
  float *pixel = vl_image_pixels(to);
  for (uint32_t y = window[1]; y < window[3]; y++)
    for (uint32_t x = window[0]; x < window[2]; x++)
      for (uint32_t c = 0; c < channels; c++)
        *pixel++ = vl_image_get(from, x, y, c);
}

/* Copies the window's pixels as they are; `to` has the size of the window and the same type. */
static void copy_rows(const vlImage *from, const uint32_t window[4], vlImage *to) {
  const size_t pixel = pixel_bytes(from);
  const size_t row = crop_width(window) * pixel;
  const char *source = vl_image_const_pixels(from);
  char *target = vl_image_pixels(to);
  for (uint32_t y = window[1]; y < window[3]; y++) {
    memcpy(target, source + ((size_t)y * vl_image_width(from) + window[0]) * pixel, row);
    target += row;
  }
}

/* The pixels in the window x0, y0, x1, y1 of the image. to_float: converted to linear 32-bit
 * floats; otherwise values are unchanged. */
static vlResult copy_window(vlContext *context, const vlImage *from, const uint32_t window[4],
                            bool to_float, vlImage **result) {
  const uint32_t width = crop_width(window);
  const uint32_t height = crop_height(window);
  const uint32_t channels = vl_image_channels(from);
  const char *names[MAX_CHANNELS];
  channel_names(from, names);
  vlImageDef def = vl_default_image_def(width, height, channels);
  def.names = names;
  def.type = to_float ? VL_PIXEL_F32 : vl_image_type(from);
  def.encoding = to_float ? VL_ENCODING_LINEAR : vl_image_encoding(from);
  TRY_RESULT(vl_image_create(context, &def, result));
  if (to_float)
    copy_floats(from, window, *result);
  else
    copy_rows(from, window, *result);
  bool cropped = width != vl_image_width(from) || height != vl_image_height(from);
  return copy_attributes(from, *result, cropped);
}

/* Replaces *image by the pixels of --crop, as floats when the target or the view needs linear
 * light. */
static int prepare_pixels(vlContext *context, const Arguments *arguments, bool want_float,
                          vlImage **image) {
  const OptionValue *crop = &arguments->values[CONVERT_CROP];
  uint32_t window[4] = {0, 0, vl_image_width(*image), vl_image_height(*image)};
  TRY(option_crop(crop, window));
  bool to_float = want_float && !is_float(*image);
  if (!crop->given && !to_float)
    return -1;
  vlImage *copy = NULL;
  vlResult result = copy_window(context, *image, window, to_float, &copy);
  if (result != VL_OK) {
    vl_image_destroy(copy);
    return report_reason(result, arguments->operands[0],
                         "this part of the image cannot be copied");
  }
  vl_image_destroy(*image);
  *image = copy;
  return -1;
}

/* One channel times a factor as 16-bit integers: the depth format of RGB-D data sets. Values
 * that are not finite, negative or above 65535 become 0 ("unknown"), since clamped depths would
 * be wrong. too_large: the number of finite values above 65535. */
static vlResult scale_channel(vlContext *context, const vlImage *from, uint32_t channel,
                              double scale, vlImage **result, uint64_t *too_large) {
  vlImageDef def = vl_default_image_def(vl_image_width(from), vl_image_height(from), 1);
  def.type = VL_PIXEL_U16;
  TRY_RESULT(vl_image_create(context, &def, result));
  uint16_t *pixel = vl_image_pixels(*result);
  *too_large = 0;
  for (uint32_t y = 0; y < def.height; y++)
    for (uint32_t x = 0; x < def.width; x++) {
      const double value = floor(vl_image_get(from, x, y, channel) * scale + 0.5);
      const bool large = value > UINT16_MAX && isfinite(value);
      *too_large += large;
      *pixel++ = value >= 0 && value <= UINT16_MAX ? (uint16_t)value : 0;
    }
  return VL_OK;
}

/* One channel with its name and the image's attributes. */
static vlResult copy_channel(vlContext *context, const vlImage *from, uint32_t channel,
                             vlImage **result) {
  const char *name = vl_image_channel_name(from, channel);
  TRY_RESULT(image_make_like(context, from, 1, &name, result));
  float *pixel = vl_image_pixels(*result);
  for (uint32_t y = 0; y < vl_image_height(from); y++)
    for (uint32_t x = 0; x < vl_image_width(from); x++)
      *pixel++ = vl_image_get(from, x, y, channel);
  return vl_image_add_attributes(*result, from);
}

/* Reports that the image has no channel of this name. Returns the exit code. */
static int report_no_channel(const vlImage *image, const char *path, const char *name) {
  const char *names[MAX_CHANNELS];
  channel_names(image, names);
  const int count = (int)vl_image_channels(image);
  const char *near = did_you_mean("", name, names, count);
  char list[600] = "";
  enum { PER_NAME = 80 };
  size_t used = 0;
  for (int c = 0; c < count && !*near && used + PER_NAME < sizeof list; c++)
    used +=
        (size_t)snprintf(list + used, PER_NAME, "%s%.60s", c ? ", " : "; it has ", names[c]);
  return report_failure(STATUS_USAGE, "%s has no channel \"%.200s\"%s%s", path, name, near,
                        list);
}

/* Replaces *image by one of its channels: unchanged, or as 16-bit integers when a scale is
 * given. */
static int take_channel(vlContext *context, const Arguments *arguments, vlImage **image) {
  const char *name = arguments->values[CONVERT_CHANNEL].text;
  const OptionValue *scale = &arguments->values[CONVERT_SCALE];
  const char *path = arguments->operands[0];
  const int channel = vl_image_find_channel(*image, name);
  if (channel < 0)
    return report_no_channel(*image, path, name);
  vlImage *one = NULL;
  uint64_t too_large = 0;
  vlResult result;
  if (scale->given)
    result = scale_channel(context, *image, (uint32_t)channel, scale->number, &one, &too_large);
  else
    result = copy_channel(context, *image, (uint32_t)channel, &one);
  if (result != VL_OK) {
    vl_image_destroy(one);
    return report_reason(result, path, "the channel cannot be copied");
  }
  if (too_large)
    report_warning("%llu pixels are above 65535 when multiplied by %g; they are written as 0",
                   (unsigned long long)too_large, scale->number);
  vl_image_destroy(*image);
  *image = one;
  return -1;
}

static int check_channel(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  if (!v[CONVERT_SCALE].given)
    return -1;
  if (!v[CONVERT_CHANNEL].given)
    return report_usage("--scale goes with --channel");
  if (!output_has_suffix(arguments->operands[1], ".png"))
    return report_usage("--scale makes 16-bit whole numbers; the result must be a .png");
  if (v[CONVERT_VIEW].given || v[CONVERT_EXPOSURE].given)
    return report_usage("--scale keeps numbers; it does not go with --view and --exposure");
  return -1;
}

static int run_convert(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  Outputs outputs = {.paths = {arguments->operands[1]},
                     .count = 1,
                     .to_stdout = true,
                     .half = v[CONVERT_HALF].given,
                     .view = (vlView)option_count(&v[CONVERT_VIEW], VL_VIEW_STANDARD),
                     .exposure = (float)v[CONVERT_EXPOSURE].number};
  TRY(outputs_check_names(&outputs));
  TRY(check_channel(arguments));
  TRY(outputs_check_folders(&outputs));
  vlImage *image = NULL;
  const bool eight_bit = output_is_display(outputs.paths[0]);
  const bool viewed = v[CONVERT_VIEW].given || v[CONVERT_EXPOSURE].given;
  int status = image_load(context, arguments->operands[0], &image);
  if (status < 0)
    status = outputs_check_inputs(context, &outputs);
  if (status < 0)
    status = prepare_pixels(context, arguments, !eight_bit || viewed, &image);
  if (status < 0 && v[CONVERT_CHANNEL].given)
    status = take_channel(context, arguments, &image);
  const bool unchanged = eight_bit && !viewed && status < 0 && !is_float(image);
  if (unchanged) { /* display values are written as they were read */
    vlError error = {0};
    const vlImage *one = image;
    vlResult result =
        output_write_layers(&one, 1, outputs.paths[0], vl_default_write_def(), &error);
    status = report_finish(&error, result, outputs.paths[0]);
  }
  if (status < 0)
    status = outputs_write(context, &outputs, image, 0, OUTPUT_FINISHED);
  vl_image_destroy(image);
  return status;
}

static Option convert_options[] = {
    {CONVERT_CROP, "crop", "write only these pixels; x1 and y1 are exclusive", OPTION_CROP,
     "x0,y0,x1,y1"},
    OUTPUT_VIEW_OPTION(CONVERT_VIEW),
    OUTPUT_EXPOSURE_OPTION(CONVERT_EXPOSURE),
    OUTPUT_HALF_OPTION(CONVERT_HALF),
    {CONVERT_CHANNEL, "channel", "write one channel only, such as Z", OPTION_TEXT, "NAME"},
    {CONVERT_SCALE, "scale",
     "with --channel and .png: multiply by FACTOR and round to 16-bit integers; depth in "
     "RGB-D data sets has 5000 or 1000 per metre",
     OPTION_NUMBER, "FACTOR", 1e-9, 1e9},
    {0}};

const Command image_convert_command = {
    .name = "image convert",
    .usage = "FILE RESULT [options]",
    .summary = "write an image in another format",
    .text =
        "Writes FILE as RESULT; the suffix of RESULT chooses the format: .exr .hdr .pfm "
        "(linear),\n"
        ".png .jpg .tga (display).",
    .examples =
        "velo image convert room.exr room.png --view agx --exposure 1\n"
        "velo image convert room.exr depth.png --channel Z --scale 1000",
    .options = convert_options,
    .operands = 2,
    .context = CONTEXT_ONE,
    .run = run_convert,
};
