/* camera_files/dso.c: camera.txt of DSO, LSD-SLAM and the TUM monoVO dataset: a line with the
 * model's name (without one: FOV), fx fy cx cy and the lens, a line with the image's size, then
 * the rectification, which is ignored. There is no pose. The first pixel's centre is (0, 0). If
 * cx and cy are below 1, the four numbers are shares of the image's sides, which begins at
 * (-0.5, -0.5). */

#include "base/text.h"
#include "camera_files/fields.h"
#include "camera_files/lines.h"

/* The first is that of lines without a name. */
static const vlLensName models[] = {{"FOV", VL_LENS_FOV, 1, 1},
                                    {"Pinhole", VL_LENS_PINHOLE, 0, 1},
                                    {"RadTan", VL_LENS_OPENCV, 4, 4},
                                    {"EquiDistant", VL_LENS_FISHEYE, 4, 4},
                                    {"KannalaBrandt", VL_LENS_FISHEYE, 4, 4}};

/* Returns the model of the first line and where its numbers begin. */
static const vlLensName *model_of(const char *line, const char **numbers) {
  for (size_t i = 0; i < VL_LENGTH(models); i++) {
    size_t length = strlen(models[i].name);
    *numbers = line + length;
    if (strncmp(line, models[i].name, length) == 0 &&
        (line[length] == ' ' || line[length] == '\t'))
      return &models[i];
  }
  *numbers = line;
  return models;
}

static vlResult read_dso(const vlCameraFile *file, const char *text, size_t size,
                         vlCameraRecord *record) {
  vlCameraLines lines = {.at = text, .end = text + size};
  vlCameraDef *d = &record->camera;
  const char *numbers;
  double v[8] = {0.0}, sides[2] = {0.0};
  vl_camera_next_line(&lines);
  const vlLensName *model = model_of(lines.text, &numbers);
  VL_TRY(vl_camera_line_numbers(file, &lines, numbers, v, 4 + model->min, 4 + model->max));
  const double *k = v + 4;
  if (!vl_camera_next_line(&lines))
    return vl_camera_wrong(file, "dso: the image's size is missing");
  VL_TRY(vl_camera_line_numbers(file, &lines, lines.text, sides, 2, 2));
  if (!vl_camera_set_sides(d, sides))
    return vl_camera_wrong_line(file, &lines, lines.text,
                                "the image's size must be two whole numbers of pixels");
  bool shares = v[2] < 1.0 && v[3] < 1.0;
  if (shares) {
    d->fx = v[0] * sides[0];
    d->fy = v[1] * sides[1];
    d->cx = v[2] * sides[0];
    d->cy = v[3] * sides[1];
  } else {
    vl_camera_set_centred(d, v);
  }
  if (model->family != VL_LENS_FOV || k[0] != 0.0)
    vl_camera_set_lens(d, model->family, k, 4);
  vl_camera_set_origin(d);
  return VL_OK;
}

/* Counts the words of a line, and those that are numbers. */
static void count_words(const char *line, int *words, int *numbers) {
  for (*words = *numbers = 0; *line; line += strspn(line, " \t")) {
    char *end;
    vl_camera_parse(line, &end);
    size_t length = strcspn(line, " \t");
    *numbers += end == line + length;
    line += length;
    ++*words;
  }
}

/* A model's name, or a line of five words and one of two, which are numbers or precede a word
 * about rectification. */
static bool is_dso(const char *text, size_t size) {
  vlCameraLines lines = {.at = text, .end = text + size};
  const char *rest;
  int words[2], numbers[2];
  if (!vl_camera_next_line(&lines))
    return false;
  model_of(lines.text, &rest);
  if (rest != lines.text)
    return true;
  count_words(lines.text, &words[0], &numbers[0]);
  if (words[0] != 5 || !vl_camera_next_line(&lines))
    return false;
  count_words(lines.text, &words[1], &numbers[1]);
  if (words[1] != 2)
    return false;
  if (numbers[0] == 5 && numbers[1] == 2)
    return true;
  return vl_camera_next_line(&lines) && vl_has_word("crop full none", lines.text);
}

const vlCameraFormat vl_format_dso = {
    .name = "dso",
    .is_text = is_dso,
    .read_text = read_dso,
    .lenses = {VL_LENSES_COMMON | 1 << VL_LENS_FOV, 1, 4},
    .lens_words = {"Pinhole", "RadTan", "KannalaBrandt", "FOV"},
    .form = "$lens $fx $fy $cx0 $cy0 $k:s\n$width $height\nfull\n$width $height\n"};
