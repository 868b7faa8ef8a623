/* camera/points.c: `velo camera project` and `velo camera unproject`: lines of points become
 * pixels, or pixels become rays, in batches. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "camera/camera.h"
#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"

enum { POINTS_CAMERA, POINTS_ORIGIN, POINTS_FRAME, POINTS_SIZE, POINTS_STRICT };
enum { BATCH = 4096 };

static const Choice origin_choices[] = {{"corner", 0}, {"center", 1}, {0}};

typedef struct Lines {
  FILE *file;
  const char *path;
  char *line;
  size_t room;
  unsigned long number;
  bool strict;
  unsigned long bad; /* lines that were reported */
} Lines;

/* Reads exactly count numbers separated by commas or blanks. *at is set to the start of the
 * first word that is not a number. */
static bool read_numbers(const char *text, double *values, int count, const char **at) {
  for (int i = 0; i < count; i++) {
    char *end;
    *at = text + strspn(text, " \t");
    values[i] = strtod(text, &end);
    if (end == text || !isfinite(values[i]))
      return false;
    text = end + strspn(end, " \t");
    if (i + 1 < count && *text == ',')
      text++;
  }
  *at = text + strspn(text, " \t\r\n");
  return **at == 0;
}

/* Reports a bad line; only the first ten are reported separately. Returns -1, or the exit code
 * if it ends the command. */
static int bad_line(Lines *lines, const char *at, int columns) {
  enum { REPORTED = 10 };
  long column = at - lines->line + 1;
  if (lines->strict)
    return report_failure(STATUS_SCENE, "%s:%lu:%ld: a line must hold %d finite numbers",
                          lines->path, lines->number, column, columns);
  if (lines->bad++ < REPORTED)
    report_warning("%s:%lu:%ld: a line must hold %d finite numbers; its result is not valid",
                   lines->path, lines->number, column, columns);
  return -1;
}

/* Reads up to BATCH rows; good[i] is 0 for a bad line. A first line of words is a header and is
 * skipped. Returns -1 or the exit code. */
static int read_batch(Lines *lines, int columns, double *values, uint8_t *good, size_t *count) {
  *count = 0;
  while (*count < BATCH && getline(&lines->line, &lines->room, lines->file) >= 0) {
    const char *text = lines->line + strspn(lines->line, " \t\r\n"), *at = text;
    double *row = values + (size_t)columns * *count;
    lines->number++;
    if (*text == 0 || *text == '#')
      continue;
    good[*count] = read_numbers(text, row, columns, &at);
    if (!good[*count]) {
      if (lines->number == 1 &&
          ((*text >= 'a' && *text <= 'z') || *text == '"' || (*text >= 'A' && *text <= 'Z')) &&
          strncasecmp(text, "nan", 3) != 0 && strncasecmp(text, "inf", 3) != 0)
        continue;
      TRY(bad_line(lines, at, columns));
      memset(row, 0, (size_t)columns * sizeof *row);
    }
    ++*count;
  }
  return ferror(lines->file) ? report_failure(STATUS_IO, "%s: %s", lines->path, strerror(errno))
                             : -1;
}

static int project_all(const vlCamera *camera, double shift, Lines *lines) {
  static double points[3 * BATCH], pixels[2 * BATCH], z[BATCH];
  static uint8_t valid[BATCH], good[BATCH];
  size_t count;
  printf("u,v,z,valid,inside\n");
  do {
    TRY(read_batch(lines, 3, points, good, &count));
    vl_camera_project_batch(camera, count, points, pixels, z, valid);
    for (size_t i = 0; i < count; i++) {
      double u = pixels[2 * i], v = pixels[2 * i + 1];
      bool seen = valid[i] && good[i];
      bool inside = seen && u >= 0.0 && u < camera->width && v >= 0.0 && v < camera->height;
      printf("%.17g,%.17g,%.17g,%d,%d\n", seen ? u - shift : 0.0, seen ? v - shift : 0.0,
             seen ? z[i] : 0.0, seen, inside);
    }
  } while (count == BATCH && !ferror(stdout));
  return STATUS_OK;
}

static int unproject_all(const vlCamera *camera, double shift, Lines *lines) {
  static double pixels[2 * BATCH], origins[3 * BATCH], directions[3 * BATCH];
  static uint8_t valid[BATCH], good[BATCH];
  size_t count;
  printf("ox,oy,oz,dx,dy,dz,valid\n");
  do {
    TRY(read_batch(lines, 2, pixels, good, &count));
    for (size_t i = 0; i < 2 * count; i++)
      pixels[i] += shift;
    vl_camera_unproject_batch(camera, count, pixels, origins, directions, valid);
    for (size_t i = 0; i < count; i++)
      if (valid[i] && good[i])
        printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,1\n", origins[3 * i], origins[3 * i + 1],
               origins[3 * i + 2], directions[3 * i], directions[3 * i + 1],
               directions[3 * i + 2]);
      else
        printf("0,0,0,0,0,0,0\n");
  } while (count == BATCH && !ferror(stdout));
  return STATUS_OK;
}

static int run_points(const Arguments *arguments, vlContext *context,
                      int (*all)(const vlCamera *, double, Lines *)) {
  const OptionValue *v = arguments->values;
  if (!v[POINTS_CAMERA].given)
    return report_usage("--camera FILE is needed");
  double shift = v[POINTS_ORIGIN].given && v[POINTS_ORIGIN].integer ? 0.5 : 0.0;
  vlCameraRecord record;
  vlCamera camera;
  int status = camera_load_made(context, v[POINTS_CAMERA].text, arguments, POINTS_FRAME,
                                POINTS_SIZE, &record, &camera);
  Lines lines = {.path = arguments->operands[0], .strict = v[POINTS_STRICT].given};
  bool from_stdin = strcmp(lines.path, "-") == 0;
  if (status < 0) {
    lines.file = from_stdin ? stdin : fopen(lines.path, "r");
    if (from_stdin)
      lines.path = "stdin";
    if (!lines.file)
      status = report_failure(errno == ENOENT ? STATUS_MISSING : STATUS_IO, "%s: %s",
                              lines.path, strerror(errno));
  }
  if (status < 0)
    status = all(&camera, shift, &lines);
  if (lines.bad > 1)
    report_warning("%s: %lu lines are not numbers", lines.path, lines.bad);
  if (lines.bad && status == STATUS_OK)
    status = STATUS_SCENE;
  if (lines.file && !from_stdin)
    fclose(lines.file);
  free(lines.line);
  return status;
}

static int run_project(const Arguments *arguments, vlContext *context) {
  return run_points(arguments, context, project_all);
}

static int run_unproject(const Arguments *arguments, vlContext *context) {
  return run_points(arguments, context, unproject_all);
}

static Option points_options[] = {
    CAMERA_FILE_OPTION(POINTS_CAMERA),
    {POINTS_ORIGIN, "pixel-origin",
     "position of (0, 0) in the image: its top left corner (default; the centre of the first "
     "pixel is (0.5, 0.5)), or the centre of the first pixel, as in OpenCV:",
     OPTION_CHOICE, "WHERE", .choices = origin_choices},
    CAMERA_FRAME_OPTION(POINTS_FRAME),
    CAMERA_SIZE_OPTION(POINTS_SIZE),
    {POINTS_STRICT, "strict",
     "end at a line that is not numbers. Default: the line is reported and its result marked "
     "as not valid, the other lines are read, and the exit code is 3"},
    {0}};

const Command camera_project_command = {
    .name = "camera project",
    .usage = "--camera FILE POINTS.csv [options]",
    .summary = "map world points to pixels",
    .text =
        "POINTS.csv (- is stdin) has one line x,y,z per world point. Prints "
        "u,v,z,valid,inside for each: column\n"
        "and row in the image plane; depth along the view axis; valid, 1 if the camera's "
        "equations map the point\n"
        "(then unproject returns its ray); inside, 1 if u,v is in the image.",
    .examples =
        "velo camera project --camera camera.yaml points.csv\n"
        "velo camera project --camera room.pbrt points.csv",
    .options = points_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_project,
};

const Command camera_unproject_command = {
    .name = "camera unproject",
    .usage = "--camera FILE PIXELS.csv [options]",
    .summary = "map pixels to rays in world space",
    .text =
        "PIXELS.csv (- is stdin) has one line u,v per point of the image. Prints "
        "ox,oy,oz,dx,dy,dz,valid for each:\n"
        "the ray's origin; its direction, of length 1; valid, 1 if the camera has a ray there.",
    .examples =
        "velo camera unproject --camera camera.yaml pixels.csv\n"
        "velo camera unproject --camera room.pbrt pixels.csv",
    .options = points_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_unproject,
};
