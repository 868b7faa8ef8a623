/* camera/paths.c: `velo camera paths`: the samples of one pixel, traced again and printed
 * vertex by vertex. */
#include "camera/paths.h"

#include <stdlib.h>
#include <string.h>

#include "camera/scene_world.h"
#include "cli/commands.h"
#include "cli/report.h"
#include "render/lens_options.h"
#include "render/needs.h"
#include "velo/tracer.h"

/* Options of this command, behind those of `velo render`, of which it has some. */
enum {
  PATHS_PIXEL = RENDER_OPTIONS,
  PATHS_SAMPLES,
  PATHS_FIRST,
  PATHS_SHOW,
  PATHS_SORT,
  PATHS_JSON,
  PATHS_OPTIONS
};
_Static_assert((int)PATHS_OPTIONS <= (int)MAX_OPTIONS,
               "Arguments.values has no room for an option");

typedef struct State {
  SceneWorld in;
  TracedPaths traced;
} State;

/* Parses "x,y". */
static bool parse_pixel(const char *text, uint32_t pixel[2]) {
  for (int i = 0; i < 2; i++) {
    char *end;
    unsigned long n = strtoul(text, &end, 10);
    if (end == text || *text < '0' || *text > '9' || n > 65535 || *end != (i ? 0 : ','))
      return false;
    pixel[i] = (uint32_t)n;
    text = end + 1;
  }
  return true;
}

static int trace(State *s, const uint32_t pixel[2], const OptionValue *v) {
  vlSceneDefs *defs = s->in.job.defs;
  vlError error = {0};
  uint32_t first = option_count(&v[PATHS_FIRST], 0);
  uint32_t count = option_count(&v[PATHS_SAMPLES], 16);
  vlTracer tracer = defs->render.tracer;
  if (tracer != VL_TRACER_PATH && tracer != VL_TRACER_VOLPATH)
    return report_usage(
        "the scene's tracer is not recorded; give --tracer path or --tracer volpath");
  if (pixel[0] >= defs->film.width || pixel[1] >= defs->film.height)
    return report_usage("--pixel %u,%u: the image has only %u x %u pixels", pixel[0], pixel[1],
                        defs->film.width, defs->film.height);
  const PathsRequest request = {.world = s->in.world,
                                .camera = &s->in.job.camera,
                                .film = &defs->film,
                                .render = &defs->render,
                                .pixel = {pixel[0], pixel[1]},
                                .first = first,
                                .count = count,
                                .by_sample = v[PATHS_SORT].given && v[PATHS_SORT].integer == 1};
  return report_error(&error, paths_trace(&request, &s->traced, &error), s->in.job.path);
}

static int print(State *s, const OptionValue *v) {
  uint32_t count = s->traced.paths->count, max = option_count(&v[PATHS_SHOW], 16);
  const PathsReport report = {.file = s->in.job.path,
                              .world = s->in.world,
                              .traced = &s->traced,
                              .shown = count < max ? count : max};
  if (v[PATHS_JSON].given) {
    Json *json = json_open();
    paths_put_json(json, &report);
    json_close(json);
  } else {
    paths_print_text(&report);
  }
  return STATUS_OK;
}

static int run_paths(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  uint32_t pixel[2];
  if (!v[PATHS_PIXEL].given)
    return report_usage("--pixel x,y is needed");
  if (!parse_pixel(v[PATHS_PIXEL].text, pixel))
    return report_usage("--pixel \"%s\": a pixel is x,y, counted from 0,0 at the top left",
                        v[PATHS_PIXEL].text);
  State s;
  memset(&s, 0, sizeof s);
  int status = scene_world_open(&s.in, context, arguments);
  if (status < 0)
    status = trace(&s, pixel, v);
  if (status < 0)
    status = print(&s, v);
  paths_free(&s.traced);
  scene_world_close(&s.in);
  return status;
}

static const Choice tracers[] = {{"tracers", 0}, {0}};
static const Choice sort_choices[] = {{"contribution", 0}, {"sample", 1}, {0}};

static Option paths_options[] = {
    {PATHS_PIXEL, "pixel", "the pixel; 0,0 is at the top left", OPTION_TEXT, "x,y"},
    {PATHS_SAMPLES, "samples", "number of samples per pixel; default 16", OPTION_INTEGER, "N",
     1, 1 << 20},
    {PATHS_FIRST, "first", "index of the first sample; default 0", OPTION_INTEGER, "I", 0,
     1 << 24},
    {PATHS_SHOW, "show", "number of paths that are printed; default 16", OPTION_INTEGER, "N", 0,
     1 << 20},
    {PATHS_SORT, "sort",
     "order of the paths: the largest share of the pixel first, or by sample:", OPTION_CHOICE,
     "NAME", .choices = sort_choices},
    JSON_OPTION(PATHS_JSON),
    {RENDER_SPP, .help = "samples per pixel of the image"},
    {RENDER_RESOLUTION, .help = "image size in pixels"},
    {RENDER_CAMERA, .help = "scene or camera file that gives the camera"},
    {RENDER_FRAME},
    {RENDER_TRACER, "tracer", "tracer; path and volpath are recorded:", OPTION_KIND, "NAME",
     .choices = tracers},
    {RENDER_MAX_DEPTH},
    {RENDER_SAMPLER},
    {RENDER_SEED, .help = "seed of the random numbers"},
    {RENDER_SEQUENCE, .help = "length of the sample sequence"},
    {RENDER_FILTER, .help = "pixel filter:"},
    {RENDER_FILTER_SAMPLES,
     .help = "samples that count in a pixel, its own or all that its filter covers:"},
    {RENDER_LIGHT_SAMPLER},
    {RENDER_REGULARIZE, .help = "regularization of the materials:"},
    {RENDER_COLOR},
    {RENDER_SEARCH},
    STRICT_OPTIONS_OPTION,
    {0}};

static const Section paths_sections[] = {
    {PATHS_PIXEL, "what is printed"}, {RENDER_SPP, "the image, as in `velo render`"}, {0}};

const Command camera_paths_command = {
    .name = "camera paths",
    .usage = "SCENE --pixel x,y [options]",
    .summary = "print the paths of a pixel, vertex by vertex",
    .text =
        "Traces the samples that count in one pixel again (those of the pixels around, too, "
        "if pixels share\n"
        "samples), with the random numbers of `velo render`, and prints each path: what it "
        "met, the sampled\n"
        "lobes with their densities, the lights with their weights, and what each\n"
        "adds. The path with the largest share of the pixel comes first: so a firefly shows "
        "where it is from.\n"
        "The options of the image must be those of the render (docs/tracers.md).",
    .examples =
        "velo camera paths room.pbrt --pixel 320,200\n"
        "velo camera paths room.pbrt --pixel 320,200 --samples 4096 --show 1 --json",
    .options = paths_options,
    .sections = paths_sections,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run_paths,
};
