/* render/first_image.c: see first_image.h. */
#include "render/first_image.h"

#include "cli/macros.h"
#include "render/added.h"
#include "render/frames.h"

/* Options with which a first image is denoised, beside those that complete a model
 * (added_replaces): they choose what is seen, how it is shown, or where and how velo works.
 * With any other option the image is rendered as it always was. */
static const int harmless[] = {
    RENDER_OUTPUT,      RENDER_THREADS,    RENDER_RESOLUTION,  RENDER_CAMERA,
    RENDER_FRAME,       RENDER_SIZE,       RENDER_SCENE,       RENDER_AT,
    RENDER_SHUTTER,     RENDER_ANIMATION,  RENDER_TURN,        RENDER_VARIANT,
    RENDER_SCENE_UNIT,  RENDER_VIEW,       RENDER_EXPOSURE,    RENDER_ISA,
    RENDER_ACCELERATOR, RENDER_MAX_MEMORY, RENDER_MAX_TEXTURE, RENDER_SANDBOX,
    RENDER_SEARCH,      RENDER_PERMISSIVE, RENDER_STRICT,      RENDER_STRICT_OPTIONS,
    RENDER_DRY_RUN,     RENDER_QUIET,      RENDER_VERBOSE,     RENDER_LOG_JSON};

static bool is_harmless(int option) {
  return added_replaces(option) || option_is_in(option, harmless, LENGTH(harmless));
}

/* Whether the rule holds: the file is a model, velo adds its camera or its light, every output
 * is a .png, .jpg or .tga, and every option is one that asks for no other quality than the
 * default. Call when the outputs are chosen. */
static bool is_wanted(const Render *render, const Arguments *arguments) {
  const SceneOpening *opening = &render->opening;
  const Outputs *outputs = &render->outputs;
  if (!opening->model ||
      !(opening->camera_added || opening->environment != VL_ENVIRONMENT_NONE))
    return false;
  if (render->again.path || render->resumed.path || render->shared || !outputs->count)
    return false;
  for (int i = 0; i < outputs->count; i++)
    if (!output_is_display(outputs->paths[i]))
      return false;
  for (const Option *option = render_options; option->name; option++)
    if (arguments->values[option->id].given && !is_harmless(option->id))
      return false;
  return !frames_wanted(arguments, &render->job);
}

void first_image_plan(Render *render, const Arguments *arguments) {
  if (!is_wanted(render, arguments))
    return;
  Denoised *denoised = &render->denoised;
  render->job.defs->render.spp = FIRST_IMAGE_SPP;
  text_set(denoised->comment,
           "%d samples per pixel, denoised by velo; --plain renders without denoising",
           FIRST_IMAGE_SPP);
  render->outputs.comment = denoised->comment;
  denoised_replace(denoised, &render->outputs);
}
