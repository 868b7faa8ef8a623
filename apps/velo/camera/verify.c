/* camera/verify.c: `velo camera verify`: checks that rendered images agree with the camera's
 * equations, or that two camera files describe the same camera. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>

#include "camera/camera.h"
#include "camera/verify.h"
#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"

enum {
  VERIFY_CAMERA,
  VERIFY_SIZE,
  VERIFY_FRAME,
  VERIFY_AGAINST,
  VERIFY_AGAINST_FRAME,
  VERIFY_IGNORE_POSE,
  VERIFY_TARGET,
  VERIFY_POSE_COUNT,
  VERIFY_SPP,
  VERIFY_SEED,
  VERIFY_THRESHOLD,
  VERIFY_KEEP,
  VERIFY_JSON
};

enum {
  DEFAULT_POSES = 16,
  DEFAULT_SPP = 144,
  MIN_CORNERS = 12 /* fewer do not cover an image: nothing is verified */
};
static const double default_threshold = 0.05; /* pixels */
static const double min_found = 0.9;          /* share of the corners that should be found */

static const Choice target_choices[] = {{"chessboard", 0}, {"charuco", 1}, {0}};

/* Only projection is verified: lens, focus, motion, vignetting and clipping planes are removed.
 */
static void make_pinhole(vlCamera *c) {
  vlCamera moving = *c;
  vl_camera_at(&moving, moving.shutter_open, c);
  c->lens_radius = 0.0;
  c->lens.vignetting = false;
  c->near_plane = 0.0;
  c->far_plane = INFINITY;
}

/* The mean over the corners that both cameras see; NaN: there are none. */
static double mean_of(double sum, const Measure *m) {
  uint32_t n = m->found - m->unseen;
  return n ? sum / n : NAN;
}

/* Returns the reason why verification fails, in `text`, or null if it succeeds. threshold:
 * pixels. */
static const char *verdict(const Verification *v, double threshold, char *text, size_t size) {
  const Measure *m = &v->all;
  if (v->placed == 0)
    snprintf(text, size, "the camera sees nothing, or too little for a board anywhere");
  else if (m->found < MIN_CORNERS || m->found < min_found * m->expected)
    snprintf(text, size,
             "only %u of %u corners are in the images where the camera should show them",
             m->found, m->expected);
  else if (m->misread)
    snprintf(text, size, "%u of %u markers are not the ones that should be there", m->misread,
             m->markers);
  else if (m->unseen)
    snprintf(text, size, "%u of %u corners in the images cannot be seen by the other camera",
             m->unseen, m->found);
  else if (!(m->max <= threshold))
    snprintf(text, size, "%.4g pixels are more than %g", m->max, threshold);
  else
    return NULL;
  return text;
}

/* Counts the cells of the image's 8 x 8 grid with a ray at their centre, and those in which
 * corners were found. */
static uint32_t count_cells(const Verification *v, uint32_t *covered) {
  uint32_t seeing = 0;
  double o[3], d[3];
  *covered = 0;
  for (int j = 0; j < COVERAGE; j++)
    for (int i = 0; i < COVERAGE; i++) {
      *covered += v->covered[j][i];
      seeing += v->covered[j][i] ||
                vl_camera_unproject(&v->camera, (i + 0.5) * v->camera.width / COVERAGE,
                                    (j + 0.5) * v->camera.height / COVERAGE, o, d);
    }
  return seeing;
}

/* Recognises an offset of half a pixel in x, y or both, the most common mistake. Each is known
 * to within what a right camera may be off. */
static bool half_pixel(const Measure *m) {
  const double off = default_threshold;
  double x = fabs(mean_of(m->sum_x, m)), y = fabs(mean_of(m->sum_y, m));
  bool half_x = fabs(x - 0.5) < off, half_y = fabs(y - 0.5) < off;
  return (half_x && half_y) || (half_x && y < off) || (half_y && x < off);
}

static void print_text(const Verification *v, const char *path, const char *against,
                       double threshold, const char *failure) {
  const Measure *m = &v->all;
  printf("camera    %s: %s, %u x %u\n", path, vl_projection_name(v->camera.projection),
         v->camera.width, v->camera.height);
  if (against)
    printf("against   %s: %s\n", against, vl_projection_name(v->model.camera.projection));
  printf("target    %s, %d x %d corners, squares of %.0f pixels, %u poses, %u spp, seed %llu\n",
         v->target.charuco ? "charuco" : "chessboard", v->target.corners, v->target.corners,
         v->side, v->placed, v->spp, (unsigned long long)v->seed);
  if (v->placed)
    printf("\npose  corners    mean px     max px  at\n");
  for (uint32_t i = 0; i < v->placed; i++) {
    const Measure *p = &v->each[i];
    printf("%4u  %3u/%-3u  %10.5f %10.5f  %.1f, %.1f\n", i, p->found, p->expected,
           mean_of(p->sum, p), p->max, p->at_x, p->at_y);
  }
  if (m->found > m->unseen) {
    uint32_t covered, seeing = count_cells(v, &covered);
    printf(
        "\n"
        "all   %u of %u corners: mean %.5f, root mean square %.5f, maximum %.5f pixels (pose "
        "%u, at %.1f, %.1f)\n",
        m->found, m->expected, mean_of(m->sum, m), sqrt(mean_of(m->sum2, m)), m->max, m->pose,
        m->at_x, m->at_y);
    printf("shift found - projected, mean: %+.5f, %+.5f pixels%s\n", mean_of(m->sum_x, m),
           mean_of(m->sum_y, m),
           half_pixel(m) ? "; half a pixel: are the pixel origins confused?" : "");
    if (v->target.charuco)
      printf("read  %u markers, %u wrong\n", m->markers, m->misread);
    printf("cover %u of the %u parts (of 8 x 8) of the image that see anything\n", covered,
           seeing);
  }
  if (failure)
    printf("FAILED: %s\n", failure);
  else
    printf("passed: no corner is off by more than %g pixels\n", threshold);
}

static void print_measure(Json *json, const Measure *m) {
  json_put(json, "expected %u, found %u, unseen %u, mean %g, rms %g", m->expected, m->found,
           m->unseen, mean_of(m->sum, m), sqrt(mean_of(m->sum2, m)));
  json_put(json, "max %g, max_x %g, max_y %g, shift_x %g, shift_y %g", m->max, m->at_x, m->at_y,
           mean_of(m->sum_x, m), mean_of(m->sum_y, m));
}

static void print_json(const Verification *v, const char *path, const char *against,
                       double threshold, const char *failure) {
  Json *json = json_open();
  uint32_t covered, seeing = count_cells(v, &covered);
  json_put(json, "camera %s, against %s", path, against);
  json_put(json, "projection %s, target %s, spp %u, seed %lld, threshold %g, passed %i",
           vl_projection_name(v->camera.projection),
           v->target.charuco ? "charuco" : "chessboard", v->spp, (long long)v->seed, threshold,
           !failure);
  json_text(json, "failure", failure);
  print_measure(json, &v->all);
  json_put(json, "markers %u, markers_wrong %u, parts_covered %u, parts_seeing %u",
           v->all.markers, v->all.misread, covered, seeing);
  json_begin(json, "poses", '[');
  for (uint32_t i = 0; i < v->placed; i++) {
    json_begin(json, NULL, '{');
    print_measure(json, &v->each[i]);
    json_end(json, '}');
  }
  json_end(json, ']');
  json_close(json);
}

/* Makes the camera with which the images are compared. It is the same camera, or that of
 * another file. Returns an exit status, or -1: go on. */
static int load_model(vlContext *context, const Arguments *arguments, const vlCameraRecord *own,
                      Verification *v) {
  const OptionValue *o = arguments->values;
  v->model = (VerifyModel){own->camera, v->camera};
  const char *path = o[VERIFY_CAMERA].text;
  if (o[VERIFY_AGAINST].given) {
    vlCameraRecord record;
    path = o[VERIFY_AGAINST].text;
    TRY(camera_load_made(context, path, arguments, VERIFY_AGAINST_FRAME, VERIFY_SIZE, &record,
                         &v->model.camera));
    v->model.def = record.camera;
    make_pinhole(&v->model.camera);
    if (o[VERIFY_IGNORE_POSE].given)
      memcpy(v->model.camera.world_from_camera, v->camera.world_from_camera,
             sizeof v->camera.world_from_camera);
    if (v->model.camera.width != v->camera.width || v->model.camera.height != v->camera.height)
      report_warning("%s is %u x %u pixels, %s %u x %u", o[VERIFY_CAMERA].text, v->camera.width,
                     v->camera.height, path, v->model.camera.width, v->model.camera.height);
  }
  if (!verify_knows(&v->model))
    return report_failure(STATUS_SCENE,
                          "%s: there is no second formula for a %s camera to compare with",
                          path, vl_projection_name(v->model.camera.projection));
  return -1;
}

static int run_verify(const Arguments *arguments, vlContext *context) {
  static Verification v;
  const OptionValue *o = arguments->values;
  const char *path = o[VERIFY_CAMERA].text, *against = o[VERIFY_AGAINST].text;
  if (!o[VERIFY_CAMERA].given)
    return report_usage("which camera? --camera FILE");
  if (!against && (o[VERIFY_AGAINST_FRAME].given || o[VERIFY_IGNORE_POSE].given))
    return report_usage("--%s goes with --against FILE",
                        o[VERIFY_IGNORE_POSE].given ? "ignore-pose" : "against-frame");
  vlCameraRecord record;
  double threshold = o[VERIFY_THRESHOLD].given ? o[VERIFY_THRESHOLD].number : default_threshold;
  v.target.charuco = o[VERIFY_TARGET].given && o[VERIFY_TARGET].integer == 1;
  v.poses = option_count(&o[VERIFY_POSE_COUNT], DEFAULT_POSES);
  v.spp = option_count(&o[VERIFY_SPP], DEFAULT_SPP);
  v.seed = option_count(&o[VERIFY_SEED], 1);
  v.keep = o[VERIFY_KEEP].text;
  TRY(camera_load_made(context, path, arguments, VERIFY_FRAME, VERIFY_SIZE, &record,
                       &v.camera));
  make_pinhole(&v.camera);
  TRY(load_model(context, arguments, &record, &v));
  if (v.keep && mkdir(v.keep, 0777) != 0 && errno != EEXIST)
    return report_failure(STATUS_IO, "%s: %s", v.keep, strerror(errno));
  TRY(verify_run(&v, context));
  char text[200];
  const char *failure = verdict(&v, threshold, text, sizeof text);
  (o[VERIFY_JSON].given ? print_json : print_text)(&v, path, against, threshold, failure);
  return failure ? STATUS_OTHER : STATUS_OK;
}

static Option verify_options[] = {
    CAMERA_FILE_OPTION(VERIFY_CAMERA),
    CAMERA_FRAME_OPTION(VERIFY_FRAME),
    CAMERA_SIZE_OPTION(VERIFY_SIZE),
    {VERIFY_AGAINST, "against",
     "compare the images with the equations of the camera in this file, to find out whether "
     "both files describe the same camera",
     OPTION_TEXT, "OTHER"},
    {VERIFY_AGAINST_FRAME, "against-frame",
     "camera of OTHER to use, by name or number from 0, if it has several", OPTION_TEXT,
     "NAME"},
    {VERIFY_IGNORE_POSE, "ignore-pose",
     "give OTHER's camera the pose of FILE's camera (for files without a pose)"},
    {VERIFY_TARGET, "target",
     "pattern on the board; charuco: a chessboard with markers, which are decoded; default "
     "chessboard:",
     OPTION_CHOICE, "KIND", .choices = target_choices},
    {VERIFY_POSE_COUNT, "poses",
     "number of poses of the board, spread over the image; default 16", OPTION_INTEGER, "N", 1,
     VERIFY_POSES},
    {VERIFY_SPP, "spp", "samples per pixel; default 144", OPTION_INTEGER, "N", 1, 65536},
    {VERIFY_SEED, "seed",
     "seed of the random numbers; another seed gives other poses and samples; default 1",
     OPTION_INTEGER, "N", 0, 4294967295.0},
    {VERIFY_THRESHOLD, "threshold", "largest error that is accepted, in pixels; default 0.05",
     OPTION_NUMBER, "PX", 0, 1e9},
    {VERIFY_KEEP, "keep", "write the images and corners.csv to this folder", OPTION_TEXT,
     "FOLDER"},
    JSON_OPTION(VERIFY_JSON),
    {0}};

const Command camera_verify_command = {
    .name = "camera verify",
    .usage = "--camera FILE [options]",
    .summary = "render a chessboard through a camera and measure its corners",
    .text =
        "Renders a board in many poses through the camera, finds the corners in the images to "
        "a hundredth of a\n"
        "pixel, and compares them with an independent implementation of the camera's "
        "equations. Exit code 1 if\n"
        "the error of a corner is above the threshold, or corners are missing.",
    .examples =
        "velo camera verify --camera camera.yaml\nvelo camera verify --camera room.pbrt",
    .options = verify_options,
    .context = CONTEXT_ALL,
    .run = run_verify,
};
