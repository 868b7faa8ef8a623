/* scene/verify.c: `velo scene verify`: whether the tracers agree about the light of a scene,
 * with themselves when the whole scene is shifted, turned and scaled, and with the reference
 * renderer. */
#include "scene/verify.h"

#include <math.h>
#include <stdlib.h>

#include "cli/commands.h"
#include "cli/confine.h"
#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/lens_options.h"
#include "render/needs.h"
#include "velo/edit.h"
#include "velo/shape.h"

/* Options of this command, behind those of `velo render`, of which it has some. */
enum { VERIFY_RAYS = RENDER_OPTIONS, VERIFY_JSON, VERIFY_REFERENCE, VERIFY_OPTIONS };
_Static_assert((int)VERIFY_OPTIONS <= (int)MAX_OPTIONS,
               "Arguments.values has no room for an option");

enum { LONGER_SIDE = 64 };
#define DEFAULT_RAYS 60 /* millions */

/* Messages of the library during the many renders are the same each time. */
static void logged(void *user, vlLogLevel level, const vlError *where, const char *message) {
  const Verify *v = user;
  if (!v->drowned)
    report_log(NULL, level, where, message);
}

static int open_scene(Verify *v, const Arguments *arguments) {
  vlContextDef def = context_def(arguments);
  def.log = logged;
  def.log_user = v;
  Confine confine = {.read_count = 0};
  confine_read(&confine, v->path);
  confine_read_folder(&confine, arguments->values[RENDER_CAMERA].text);
  confine_apply(&confine, arguments);
  TRY(context_open(&def, &v->context));
  TRY(scene_world_build(&v->in, v->context, arguments));
  const int status = lens_autofocus(&v->in.job, v->in.scene, v->in.world);
  vl_world_destroy(v->in.world);
  v->in.world = NULL;
  return status;
}

/* The camera at a small size, unless --resolution gives one. */
static vlResult make_camera(Verify *v, const Arguments *arguments) {
  const vlFilmDef *film = &v->in.job.defs->film;
  const double longer = fmax(film->width, film->height);
  const double k = arguments->values[RENDER_RESOLUTION].given || longer < LONGER_SIDE
                       ? 1
                       : LONGER_SIDE / longer;
  v->width = (uint32_t)fmax(1, k * film->width + 0.5);
  v->height = (uint32_t)fmax(1, k * film->height + 0.5);
  return vl_camera_resize(&v->in.job.camera, v->width, v->height, &v->camera);
}

/* Remembers which shapes emit light. */
static vlResult list_lights(Verify *v) {
  while (vl_scene_shape(v->in.scene, (vlShapeId){v->shapes + 1}))
    v->shapes++;
  while (vl_scene_light(v->in.scene, (vlLightId){v->light_count + 1}))
    v->light_count++;
  v->emissions = calloc((size_t)v->shapes + 1, sizeof *v->emissions);
  if (!v->emissions)
    return VL_ERROR_MEMORY;
  for (uint32_t i = 0; i < v->shapes; i++)
    v->emissions[i] = vl_scene_shape(v->in.scene, (vlShapeId){i + 1})->emission;
  return VL_OK;
}

static vlResult do_verify(Verify *v, const Arguments *arguments, vlError *error) {
  TRY_RESULT(make_camera(v, arguments));
  TRY_RESULT(list_lights(v));
  TRY_RESULT(verify_prepare(v, error));
  verify_plan(v);
  TRY_RESULT(verify_measure(v, error));
  TRY_RESULT(verify_render(v, 0, error));
  TRY_RESULT(verify_first(v));
  if (v->mark_count)
    TRY_RESULT(verify_render(v, 1, error));
  verify_second(v);
  return VL_OK;
}

static int verify(Verify *v, const Arguments *arguments) {
  vlError error = {0};
  signals_remember();
  const vlResult result = do_verify(v, arguments, &error);
  if (result == VL_CANCELLED && signals_pending())
    return report_failure(signals_status(), "interrupted");
  return report_error(&error, result, v->path);
}

static void close_all(Verify *v) {
  for (int i = 0; i < v->run_count; i++)
    for (int look = 0; look < 2; look++)
      free(v->runs[i].values[look]);
  free(v->emissions);
  free(v->cells);
  free(v->block_of);
  free(v->material_of);
  free(v->marks);
  scene_world_close(&v->in);
  context_close(v->context);
}

static int run_verify(const Arguments *arguments, UNUSED vlContext *unused) {
  static Verify v;
  const OptionValue *o = arguments->values;
  v.path = arguments->operands[0];
  v.budget = 1e6 * (o[VERIFY_RAYS].given ? o[VERIFY_RAYS].number : DEFAULT_RAYS);
  v.seed = option_count(&o[RENDER_SEED], 0);
  int status = verify_reference_find(&v, arguments, &o[VERIFY_REFERENCE]);
  if (status < 0)
    status = open_scene(&v, arguments);
  if (status < 0)
    status = verify(&v, arguments);
  if (status < 0) {
    if (o[VERIFY_JSON].given)
      verify_print_json(&v);
    else
      verify_print(&v);
    status = verify_count(&v) ? STATUS_OTHER : STATUS_OK;
  }
  close_all(&v);
  return status;
}

static Option options[] = {
    {VERIFY_RAYS, "rays", "millions of rays of the first look; default 60", OPTION_NUMBER, "M",
     0.001, 1e6},
    {RENDER_SEED, "seed", "seed of the random numbers; default 0", OPTION_INTEGER, "N", 0,
     1048575},
    {VERIFY_REFERENCE, "reference",
     "the reference renderer; default: the environment variable VELO_REFERENCE, else "
     "velo-reference beside velo",
     OPTION_TEXT, "PROGRAM"},
    JSON_OPTION(VERIFY_JSON),
    {RENDER_THREADS, .help = "number of threads; default: one per processor core"},
    {RENDER_RESOLUTION, "resolution",
     "image size in pixels; default: that of the scene, reduced to 64 pixels on its longer "
     "side",
     OPTION_SIZE, "WxH", 1, 4096},
    {RENDER_CAMERA, .help = "scene or camera file that gives the camera"},
    {RENDER_FRAME},
    {RENDER_MAX_DEPTH},
    {RENDER_COLOR},
    {RENDER_PERMISSIVE,
     .help = "parts of the scene that velo does not understand are warnings, not errors"},
    {RENDER_SANDBOX,
     .help =
         "a file that the scene names must be in DIR or below it; the reference renderer is not "
         "started"},
    {RENDER_SEARCH},
    STRICT_OPTIONS_OPTION,
    {0}};

static const Section sections[] = {
    {VERIFY_RAYS, "the check"}, {RENDER_RESOLUTION, "the image, as in `velo render`"}, {0}};

const Command scene_verify_command = {
    .name = "scene verify",
    .usage = "FILE [options]",
    .summary = "check that the tracers agree about the light of a scene",
    .text =
        "Renders the scene at a small size with each unbiased tracer that claims its light, "
        "with the whole\n"
        "scene shifted, turned and scaled, and by the reference renderer, 32 times each, and "
        "compares the\n"
        "means of the image, of blocks of 8 x 8 pixels, of the pixels of each material, and "
        "of each kind of\n"
        "light. What differs is rendered again with other seeds and four times the samples; "
        "it counts only\n"
        "if it differs again. One run in a thousand or fewer reports a difference where there "
        "is none\n"
        "(docs/verify.md).\n"
        "\n"
        "exit codes: 0 all agree; 1 a difference beyond chance; 5 the reference renderer "
        "failed",
    .examples = "velo scene verify room.pbrt\nvelo scene verify room.pbrt --rays 5 --json",
    .options = options,
    .sections = sections,
    .operands = 1,
    .run = run_verify,
};
