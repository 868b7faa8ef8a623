/* view/view.c: `velo view`: its options. Also tells that a build without libwebsockets lacks
 * it. */
#include "view/view.h"

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/needs.h"
#include "render/race_rules.h"
#include "view/serve.h"

/* The options that go with --lecture: its scenes have all the rest. */
static bool goes_with_lecture(int option) {
  static const int all[] = {VIEW_PORT,          VIEW_LISTEN,       VIEW_NO_OPEN,   VIEW_LECTURE,
                            VIEW_LANGUAGE,      RENDER_SPP,        RENDER_THREADS, RENDER_BITS,
                            RENDER_ACCELERATOR, RENDER_MAX_MEMORY, RENDER_QUIET};
  return option_is_in(option, all, LENGTH(all));
}

/* Returns -1, or the exit code after reporting the error. */
static int check_usage(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  TRY(race_check_options(arguments));
  if (!v[VIEW_LECTURE].given) {
    if (v[VIEW_LANGUAGE].given)
      return report_usage("--language goes with --lecture");
    if (arguments->operand_count)
      return -1;
    return options_too_few(arguments->command);
  }
  if (arguments->operand_count)
    return report_usage("--lecture takes no FILE, but \"%s\" is given", arguments->operands[0]);
  for (const Option *o = view_options; o->name; o++)
    if (v[o->id].given && !goes_with_lecture(o->id))
      return report_usage("--%s does not go with --lecture", o->name);
  return -1;
}

static int run_view(const Arguments *arguments, UNUSED vlContext *unused) {
  TRY(check_usage(arguments));
#if defined VELO_HAS_VIEW || defined __EMSCRIPTEN__
  return view_run(arguments);
#else
  return report_failure(
      STATUS_OTHER,
      "velo view: this velo was built without libwebsockets, which the command needs");
#endif
}

#ifndef VELO_HAS_VIEW
int serve_start(UNUSED const Job *job, UNUSED vlView view, UNUSED float exposure,
                UNUSED Serve **serve) {
  return report_failure(
      STATUS_OTHER,
      "--serve: this velo was built without libwebsockets, which the option needs");
}
void serve_film(UNUSED Serve *serve, UNUSED const vlFilm *film,
                UNUSED const vlProgress *progress) {}
void serve_stop(UNUSED Serve *serve) {}
#endif

static const Choice languages[] = {
    {"en", LANGUAGE_ENGLISH}, {"it", LANGUAGE_ITALIAN}, {NULL, 0}};

Option view_options[] = {
    {VIEW_PORT, "port", "port to listen on; default: a free one", OPTION_INTEGER, "N", 1,
     65535},
    {VIEW_LISTEN, "listen",
     "address of this machine to listen on, 0.0.0.0 for all; default 127.0.0.1, which no "
     "other machine can reach",
     OPTION_TEXT, "ADDRESS"},
    {VIEW_NO_OPEN, "no-open", "do not open a browser"},
    {VIEW_LECTURE, "lecture", "show the lecture with live scenes, in place of FILE"},
    {VIEW_LANGUAGE, "language", "language of the lecture; default: that of LANG, else en:",
     OPTION_CHOICE, "NAME", .choices = languages},
    {RENDER_SPP, .help = "samples per pixel at which the image is done"},
    {RENDER_FILM, .help = "write the film of the last image to this file at the end"},
    {RENDER_OVERWRITE, .help = "replace a film that is there already"},
    {RENDER_RESOLUTION},
    {RENDER_CROP, .help = "render only these pixels at first"},
    {RENDER_CAMERA, .help = "scene or camera file that gives the camera and the image size"},
    {RENDER_FRAME, .help = "camera to use, if the file of --camera has several"},
    {RENDER_TRAJECTORY,
     .help =
         "show the cameras of this trajectory or rig in the view from outside; at most 200 of "
         "them"},
    {RENDER_SIZE, .help = "image size for a file of --camera that does not give one"},
    {RENDER_SCENE, .help = "glTF: scene, by name or number from 0"},
    {RENDER_AT, .help = "glTF: time of the animation, in seconds"},
    {RENDER_SHUTTER, .help = "time for which the shutter is open, from --at on"},
    {RENDER_ANIMATION, .help = "glTF: animation to play"},
    {RENDER_TURN, .help = "rotate the scene's camera about the vertical axis"},
    {RENDER_VARIANT, .help = "glTF: material variant"},
    {RENDER_SCENE_UNIT,
     .help =
         "length of the scene's unit, for candela and lumens: m, cm, mm, km, in, ft, or metres"},
    {RENDER_ENVIRONMENT,
     .help =
         "environment that lights the scene: studio, window, evening, sky, white, none, lamps, or an "
         "image file"},
    {RENDER_ENVIRONMENT_ROTATION,
     .help = "rotation of the environment map about the vertical axis, in degrees"},
    {RENDER_ENVIRONMENT_STRENGTH},
    {RENDER_GROUND},
    {RENDER_NO_GROUND, .help = "add no ground below a model"},
    {RENDER_GROUND_MIDDLE, .help = "middle of the ground; default: under the model"},
    {RENDER_GROUND_RADIUS, .help = "radius of the ground"},
    {RENDER_FRAMING,
     .help =
         "viewpoint of the camera that a model without one gets, or its angles in degrees from "
         "the front to the right and above the horizon:"},
    {RENDER_WALLS,
     .help =
         "closed models: hide the walls before the camera (or before a point), or keep them:"},
    {RENDER_UP, .help = "axis of the model that points up:"},
    {RENDER_TRACER,
     .help =
         "light transport algorithm; auto: chosen by a short race when the image has 32 samples, "
         "the default where the scene names none:"},
    {RENDER_MAX_DEPTH},
    {RENDER_MERGE_RADIUS, .help = "merging, sppm: radius of the first pass"},
    {RENDER_LIGHT_PATHS, .help = "number of light paths per pass"},
    {RENDER_SAMPLER},
    {RENDER_SEED, .help = "seed of the random numbers"},
    {RENDER_SEQUENCE,
     .help = "number of samples per pixel for which the sampler arranges its points"},
    {RENDER_FILTER, .help = "pixel filter:"},
    {RENDER_LIGHT_SAMPLER, .help = "method that chooses a light:"},
    {RENDER_REGULARIZE, .help = "regularization:"},
    {RENDER_COLOR},
    {RENDER_SENSOR, .help = "camera whose spectral response the sensor has:"},
    {RENDER_VIEW, .help = "view transform of the first view:"},
    {RENDER_EXPOSURE, .help = "exposure of the first view: a number, or auto for models"},
    {RENDER_ISO, .help = "sensitivity for a physical exposure"},
    {RENDER_SECONDS, .help = "exposure time for --iso, in seconds"},
    {VIEW_EXPOSE, "expose",
     "begin as the camera sees it, with this sensor: a name of velo sensor expose, or a "
     "sensor file (.yaml). --iso and --seconds are those of its exposure",
     OPTION_TEXT, "NAME|FILE"},
    {RENDER_FOCUS_PIXEL, .help = "focus on the surface that is seen at this point"},
    {RENDER_FOCUS_DISTANCE},
    {RENDER_LENS_RADIUS, .help = "radius of the thin lens, in scene units"},
    {RENDER_F_NUMBER, .help = "f-number"},
    {RENDER_THREADS, .help = "worker threads; default: one for each processor"},
    {RENDER_BITS, .help = "the same image on every machine, or less time:"},
    {RENDER_ACCELERATOR, .help = "what finds the surfaces that rays meet:"},
    {RENDER_MAX_MEMORY, .help = "limit of the memory, such as 2G"},
    {RENDER_SANDBOX, "sandbox",
     "files that the scene names must be in this folder, and the system confines velo where "
     "it can",
     OPTION_FOLDERS, "FOLDER"},
    {RENDER_PERMISSIVE, .help = "warn of unsupported features instead of refusing them"},
    {RENDER_STRICT, .help = "glTF, OBJ: a missing image is an error"},
    STRICT_OPTIONS_OPTION,
    {RENDER_SEARCH, .help = "further folder in which files of the scene are looked for"},
    {RENDER_IMITATE_PBRT, .help = "reproduce a known error of pbrt-v4"},
    {RENDER_QUIET, "quiet", "print only the address, warnings and errors", .letter = 'q'},
    {0}};

static const Section view_sections[] = {
    {VIEW_PORT, "the page"},
    {RENDER_SPP, "the image"},
    {RENDER_CAMERA, "camera and scene, as for velo render"},
    {RENDER_TRACER, "light transport and sampling, as for velo render"},
    {RENDER_COLOR, "colour, focus, exposure, as for velo render"},
    {RENDER_THREADS, "processor, memory, reading the scene"},
    {0, NULL}};

const Command view_command = {
    .name = "view",
    .usage = "FILE | --lecture [options]",
    .summary = "see and steer a scene in the browser while it renders",
    .text =
        "Prints the address of a page and opens it in a browser. The page shows the scene "
        "while it renders,\n"
        "moves the camera, edits it in every spelling, shows ground truth, and saves cameras "
        "and images\n"
        "(docs/view.md). The address has a random token; only this machine can reach it. "
        "Through ssh, the\n"
        "printed ssh -L line brings the page to your own machine. Ctrl-C ends it.\n"
        "\n"
        "With --lecture the page is the lecture on perspective (docs/lecture.md), whose "
        "images are live: a slider\n"
        "moves d, e, zoom, s or roll, and image, formulas and the view from outside follow.",
    .examples =
        "velo view scenes/lecture/pinhole.pbrt\n"
        "velo view model.glb --resolution 1280x720 --port 8800 --no-open\n"
        "velo view --lecture --language it",
    .options = view_options,
    .sections = view_sections,
    .optional_operands = 1,
    .run = run_view,
};
