/* image/info.c: `velo image info`: the content of an image file. Also functions shared by the
 * image commands. */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/header.h"
#include "image/image.h"
#include "render/receipt.h"

int image_load(vlContext *context, const char *path, vlImage **image) {
  vlError error = {0};
  return report_error(&error, vl_image_read(context, path, image, &error), path);
}

vlResult image_make(vlContext *context, uint32_t width, uint32_t height, uint32_t channels,
                    const char *const *names, vlImage **image) {
  vlImageDef def = vl_default_image_def(width, height, channels);
  def.names = names;
  return vl_image_create(context, &def, image);
}

vlResult image_make_like(vlContext *context, const vlImage *like, uint32_t channels,
                         const char *const *names, vlImage **image) {
  return image_make(context, vl_image_width(like), vl_image_height(like), channels, names,
                    image);
}

vlResult image_render(vlContext *context, const vlWorld *world, const vlCamera *camera,
                      const vlFilmDef *film, const vlRenderDef *render,
                      const vlDevelopDef *develop, vlImage **image, vlError *error) {
  vlFilm *made = NULL;
  TRY_RESULT(vl_film_create(context, film, &made));
  vlResult result = vl_render(world, camera, made, render, NULL, error);
  if (result == VL_OK)
    result = vl_film_develop(made, develop, image);
  vl_film_destroy(made);
  return result;
}

vlResult image_set_text(vlImage *image, const char *name, const char *text) {
  const vlAttribute attribute = {.name = name, .type = VL_ATTRIBUTE_STRING, .string = text};
  return vl_image_set_attribute(image, &attribute);
}

size_t image_pixel_count(const vlImage *image) {
  return (size_t)vl_image_width(image) * vl_image_height(image);
}

bool image_find_rgb(const vlImage *image, const char *prefix, int rgb[3]) {
  char name[32];
  for (int c = 0; c < 3; c++) {
    text_set(name, "%s%c", prefix, "RGB"[c]);
    rgb[c] = vl_image_find_channel(image, name);
  }
  return rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0;
}

/* The first bytes of formats. */
static const struct {
  const char *bytes, *name;
} formats[] = {{"\x76\x2f\x31\x01", "OpenEXR"},
               {"\x89PNG\r\n\x1a\n", "PNG"},
               {"\xff\xd8\xff", "JPEG"},
               {"#?RADI", "Radiance HDR"},
               {"#?RGBE", "Radiance HDR"},
               {"GIF8", "GIF"},
               {"qoif", "QOI"},
               {"BM", "BMP"},
               {"PF", "PFM"},
               {"Pf", "PFM"}};

/* The format by the first bytes, as the library chooses its reader. */
static const char *format_of(const char *path) {
  char b[13] = {0};
  FILE *file = fopen(path, "rb");
  size_t n = file ? fread(b, 1, sizeof b - 1, file) : 0;
  if (file)
    fclose(file);
  for (size_t i = 0; i < LENGTH(formats); i++)
    if (strncmp(b, formats[i].bytes, strlen(formats[i].bytes)) == 0)
      return formats[i].name;
  if (n >= 12 && memcmp(b, "RIFF", 4) == 0 && memcmp(b + 8, "WEBP", 4) == 0)
    return "WebP";
  return n >= 2 && b[0] == 'P' && b[1] >= '1' && b[1] <= '6' ? "PNM" : "TGA";
}

static const char *type_name(vlPixelType type) {
  static const char *const names[] = {[VL_PIXEL_U8] = "8-bit integer",
                                      [VL_PIXEL_U16] = "16-bit integer",
                                      [VL_PIXEL_F16] = "16-bit float",
                                      [VL_PIXEL_F32] = "32-bit float",
                                      [VL_PIXEL_U32] = "32-bit integer"};
  return names[type];
}

/* Whether the file's channels have different types. */
static bool is_mixed(const vlImage *image) {
  for (uint32_t i = 1; i < vl_image_channels(image); i++)
    if (vl_image_stored_type(image, i) != vl_image_stored_type(image, 0))
      return true;
  return false;
}

static const char *encoding_name(vlEncoding encoding) {
  return encoding == VL_ENCODING_SRGB    ? "sRGB"
         : encoding == VL_ENCODING_GAMMA ? "gamma"
                                         : "linear";
}

static int number_count(vlAttributeType type) {
  switch (type) {
    case VL_ATTRIBUTE_FLOAT:
    case VL_ATTRIBUTE_INT:
    case VL_ATTRIBUTE_DOUBLE:
      return 1;
    case VL_ATTRIBUTE_V2F:
      return 2;
    case VL_ATTRIBUTE_V3F:
      return 3;
    case VL_ATTRIBUTE_BOX2I:
      return 4;
    case VL_ATTRIBUTE_CHROMATICITIES:
      return 8;
    case VL_ATTRIBUTE_M33F:
      return 9;
    case VL_ATTRIBUTE_M44F:
    case VL_ATTRIBUTE_M44D:
      return 16;
    case VL_ATTRIBUTE_STRING:
    case VL_ATTRIBUTE_STRINGS:
      return 0;
  }
  return 0;
}

/* Numbers that the file holds in single precision have as few digits as read back to the same
 * float. */
static double shown(const vlAttribute *a, int i) {
  const bool exact = a->type == VL_ATTRIBUTE_DOUBLE || a->type == VL_ATTRIBUTE_M44D ||
                     a->type == VL_ATTRIBUTE_INT;
  return exact ? a->numbers[i] : shortest_float((float)a->numbers[i]);
}

/* Prints what made the image. receipt may be null. */
static void print_receipt(const vlReceipt *receipt) {
  if (!receipt)
    return;
  const char *word;
  uint32_t planned, samples = vl_receipt_samples(receipt, &planned), files = 0;
  vlFileRecord record;
  printf("receipt\n  velo        ");
  receipt_print_version(receipt);
  printf("\n  command    ");
  for (uint32_t i = 0; (word = vl_receipt_command(receipt, i)); i++)
    text_shell_word(stdout, word);
  printf("\n  samples     %u per pixel", samples);
  if (samples != planned)
    printf(", of %u planned", planned);
  while (vl_receipt_file(receipt, files, &record))
    files++;
  printf("\n  files       %u\n", files);
  for (uint32_t i = 0; vl_receipt_file(receipt, i, &record); i++) {
    printf("    ");
    for (int k = 0; k < 16; k++)
      printf("%02x", record.digest[k]);
    printf(" %12llu  ", (unsigned long long)record.size);
    text_print_plain(record.path);
    putchar('\n');
  }
}

static void print_text(const char *path, const vlImage *image, const vlReceipt *receipt) {
  printf("file        %s\nformat      %s\n", path, format_of(path));
  printf("size        %u x %u\n", vl_image_width(image), vl_image_height(image));
  printf("channels    %u:", vl_image_channels(image));
  for (uint32_t i = 0; i < vl_image_channels(image); i++) {
    putchar(' ');
    text_print_plain(vl_image_channel_name(image, i));
  }
  if (!is_mixed(image))
    printf("\ntype        %s, %s\n", type_name(vl_image_type(image)),
           encoding_name(vl_image_encoding(image)));
  for (int type = VL_PIXEL_U8; type <= VL_PIXEL_U32 && is_mixed(image); type++) {
    bool any = false;
    for (uint32_t i = 0; i < vl_image_channels(image); i++) {
      if ((int)vl_image_stored_type(image, i) != type)
        continue;
      if (!any)
        printf("\ntype        %s:", type_name((vlPixelType)type));
      any = true;
      putchar(' ');
      text_print_plain(vl_image_channel_name(image, i));
    }
  }
  if (is_mixed(image))
    putchar('\n');
  uint32_t count = vl_image_attribute_count(image);
  if (count)
    printf("attributes  %u\n", count);
  for (uint32_t i = 0; i < count; i++) {
    vlAttribute a;
    if (vl_image_attribute(image, i, &a) != VL_OK)
      continue;
    printf("  ");
    text_print_plain(a.name);
    printf("%*s", (int)(strlen(a.name) < 26 ? 26 - strlen(a.name) : 1), "");
    if (strcmp(a.name, RECEIPT_ATTRIBUTE) == 0 && receipt) {
      puts("(below)");
      continue;
    }
    if (a.type == VL_ATTRIBUTE_STRING || a.type == VL_ATTRIBUTE_STRINGS)
      text_print_plain(a.string ? a.string : "");
    for (int k = 0; k < number_count(a.type); k++) {
      char text[40];
      format_number(text, sizeof text, shown(&a, k));
      printf("%s%s", k ? " " : "", text);
    }
    putchar('\n');
  }
  print_receipt(receipt);
}

static void print_json(const char *path, const vlImage *image) {
  Json *json = json_open();
  json_put(json, "file %s, format %s, width %u, height %u", path, format_of(path),
           vl_image_width(image), vl_image_height(image));
  json_begin(json, "channels", '[');
  for (uint32_t i = 0; i < vl_image_channels(image); i++)
    json_text(json, NULL, vl_image_channel_name(image, i));
  json_end(json, ']');
  json_text(json, "type", type_name(vl_image_type(image)));
  if (is_mixed(image)) {
    json_begin(json, "types", '[');
    for (uint32_t i = 0; i < vl_image_channels(image); i++)
      json_text(json, NULL, type_name(vl_image_stored_type(image, i)));
    json_end(json, ']');
  }
  json_text(json, "encoding", encoding_name(vl_image_encoding(image)));
  json_begin(json, "attributes", '{');
  for (uint32_t i = 0; i < vl_image_attribute_count(image); i++) {
    vlAttribute a;
    if (vl_image_attribute(image, i, &a) != VL_OK)
      continue;
    int n = number_count(a.type);
    if (n == 0)
      json_text(json, a.name, a.string ? a.string : "");
    if (n == 1)
      json_number(json, a.name, shown(&a, 0));
    if (n < 2)
      continue;
    json_begin(json, a.name, '[');
    for (int k = 0; k < n; k++)
      json_number(json, NULL, shown(&a, k));
    json_end(json, ']');
  }
  json_end(json, '}');
  json_close(json);
}

enum { INFO_JSON };

static int run_info(const Arguments *arguments, vlContext *context) {
  vlImage *image = NULL;
  vlError error = {0};
  TRY(report_error(&error,
                   vl_image_read_header(context, arguments->operands[0], &image, &error),
                   arguments->operands[0]));
  vlReceipt *receipt = NULL;
  const char *text = header_text(image, RECEIPT_ATTRIBUTE);
  if (text) /* without a valid receipt the attribute is printed unchanged */
    vl_receipt_parse(context, text, strlen(text), &receipt, NULL);
  if (arguments->values[INFO_JSON].given)
    print_json(arguments->operands[0], image);
  else
    print_text(arguments->operands[0], image, receipt);
  vl_receipt_destroy(receipt);
  vl_image_destroy(image);
  return STATUS_OK;
}

static Option info_options[] = {JSON_OPTION(INFO_JSON), {0}};

const Command image_info_command = {
    .name = "image info",
    .usage = "FILE [options]",
    .summary = "print format, size, channels and attributes of an image",
    .text =
        "Prints the format, size, channels and header attributes of FILE. Matrices are in "
        "OpenEXR's order (row vectors).",
    .examples = "velo image info room.exr\nvelo image info --json room.exr",
    .options = info_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_info,
};
