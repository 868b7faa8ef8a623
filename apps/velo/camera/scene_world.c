/* camera/scene_world.c: a scene's world and camera, made as `velo render` makes them. */
#include "camera/scene_world.h"

#include "cli/macros.h"
#include "cli/report.h"
#include "render/lens_options.h"
#include "render/needs.h"

static Needs needs_of(const SceneWorld *s, const Arguments *arguments) {
  return (Needs){.options = arguments->command->options,
                 .values = arguments->values,
                 .arguments = arguments,
                 .scene = s->scene,
                 .opening = &s->opening,
                 .job = &s->job};
}

int scene_world_build(SceneWorld *s, vlContext *context, const Arguments *arguments) {
  const char *path = arguments->operands[0];
  vlError error = {0};
  s->context = context;
  TRY(scene_open(context, path, arguments, &s->scene, &s->opening));
  TRY(job_make(&s->job, context, s->scene, path, arguments));
  const Needs needs = needs_of(s, arguments);
  TRY(needs_check_scene(&needs));
  vlBuildDef build = s->job.defs->build;
  build.previous = s->opening.metered;
  return report_error(&error, vl_world_build(s->scene, &build, &s->world, &error), path);
}

int scene_world_open(SceneWorld *s, vlContext *context, const Arguments *arguments) {
  TRY(scene_world_build(s, context, arguments));
  const Needs needs = needs_of(s, arguments);
  TRY(needs_check_tracer(&needs, s->world));
  return lens_autofocus(&s->job, s->scene, s->world);
}

void scene_world_close(SceneWorld *s) {
  scene_opening_close(&s->opening);
  vl_world_destroy(s->world);
  vl_scene_destroy(s->scene);
}
