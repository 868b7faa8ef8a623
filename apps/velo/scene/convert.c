/* scene/convert.c: `velo scene convert`: converts a scene to another format and reports
 * losses. */

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/output_names.h"
#include "render/scene_options.h"
#include "scene/scene.h"
#include "velo/check.h"
#include "velo/export.h"
#include "velo/render.h"

enum {
  CONVERT_STRICT,
  CONVERT_PERMISSIVE,
  CONVERT_CAMERA,
  CONVERT_VARIANT,
  CONVERT_AT,
  CONVERT_ANIMATION,
  CONVERT_COMPLETE,
  CONVERT_PROVE,
  CONVERT_SANDBOX,
  CONVERT_SEARCH
};

static Option convert_options[] = {
    {CONVERT_STRICT, "strict",
     "anything that B's format cannot hold is an error, and nothing is written"},
    {CONVERT_COMPLETE, "complete",
     "add the camera and light that A lacks, as velo render does; always done if B is a .pbrt "
     "file"},
    {CONVERT_PROVE, "prove",
     "render A and B, 256 pixels wide, and print for each material the ratio of its "
     "brightness, B divided by A, in red, green and blue"},
    {CONVERT_CAMERA, "camera", "glTF: camera to write, by name or number from 0", OPTION_TEXT,
     "NAME"},
    {CONVERT_AT, "at",
     "glTF: time of the animation in seconds; T1: time at which the shutter closes, for what "
     "moves in a .pbrt file. Default: the model without animation",
     OPTION_TEXT, "T[:T1]"},
    {CONVERT_ANIMATION, "animation",
     "glTF: animation to play, by name or number from 0; several separated by commas, or all",
     OPTION_TEXT, "NAME"},
    {CONVERT_VARIANT, "variant", "glTF: material variant to use, by name", OPTION_TEXT, "NAME"},
    {CONVERT_PERMISSIVE, "permissive",
     "parts of the scene that velo does not understand are warnings, not errors"},
    SCENE_SEARCH_OPTION(CONVERT_SEARCH),
    SCENE_SANDBOX_OPTION(CONVERT_SANDBOX),
    {0}};

static void tell(UNUSED void *user, const char *what, uint64_t count) {
  report_note("not held: %s (%llu)", what, (unsigned long long)count);
}

/* Tells of options that the scene gives nothing to choose from, as velo render does. */
static void tell_unused(const OptionValue *v, const char *from, const vlScene *scene) {
  const bool gltf = scene_is_gltf(from);
  const bool animated = vl_scene_choice_count(scene, VL_CHOICE_ANIMATION) > 0;
  for (const Option *o = convert_options; o->name; o++) {
    const bool plays = o->id == CONVERT_AT || o->id == CONVERT_ANIMATION;
    const bool chooses = plays || o->id == CONVERT_CAMERA || o->id == CONVERT_VARIANT;
    if (!chooses || !v[o->id].given)
      continue;
    if (!gltf)
      report_note("--%s has no effect: %s is not a glTF file", o->name, from);
    else if (plays && !animated)
      report_note("--%s has no effect: %s has no animations", o->name, from);
  }
}

static int run_convert(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  const char *from = arguments->operands[0], *to = arguments->operands[1];
  vlScene *scene = NULL;
  vlError error = {0};
  bool pbrt = text_ends_with(to, ".pbrt");
  if (!pbrt && !text_ends_with(to, ".gltf") && !text_ends_with(to, ".glb"))
    return report_usage("%s: unknown kind of file to write (known: .gltf, .glb, .pbrt)", to);
  int status = -1;
  vlLoadDef load = vl_default_load_def();
  options_put(arguments->command->options, v, VL_SETTING_LOAD, &load);
  load.strict = false; /* --strict is of what is written */
  TRY(scene_read_times(&v[CONVERT_AT], &load));
  vlSaveDef save = vl_default_save_def();
  save.strict = v[CONVERT_STRICT].given;
  save.lost = tell;
  vlResult result = scene_read(context, from, &load, &scene, &error);
  if (result == VL_OK)
    tell_unused(v, from, scene);
  const vlSceneDefs *defs = scene ? vl_scene_defs(scene) : NULL;
  if (result == VL_OK && (pbrt || v[CONVERT_COMPLETE].given) &&
      (defs->camera_missing || defs->light_missing)) {
    result = vl_scene_complete(scene, NULL, &error);
    if (result == VL_OK)
      report_note("%s lacks a camera or light: those that velo render would make are written",
                  from);
  }
  status = report_error(&error, result, from);
  if (status < 0)
    status = output_check(context, to, VL_OUTPUT_PLAIN);
  if (status < 0) {
    result = vl_scene_save(scene, to, &save, &error);
    status = report_finish(&error, result, to);
  }
  vl_scene_destroy(scene);
  if (status == STATUS_OK && v[CONVERT_PROVE].given)
    status = convert_prove(context, &load, from, to);
  return status;
}

const Command scene_convert_command = {
    .name = "scene convert",
    .usage = "A B [options]",
    .summary = "write a scene in another format: .gltf, .glb, .pbrt",
    .text =
        "Reads A (.pbrt .gltf .glb .obj .ply .stl .off) and writes it as B, in the format of "
        "B's suffix. What that\n"
        "format cannot hold exactly is reported: one line per kind, with the number of "
        "occurrences.",
    .examples =
        "velo scene convert room.pbrt room.glb\nvelo scene convert model.gltf model.pbrt",
    .options = convert_options,
    .operands = 2,
    .context = CONTEXT_ALL,
    .run = run_convert,
};
