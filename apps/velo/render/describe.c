/* render/describe.c: describes what a job would render, as text or JSON (--dry-run). See
 * job.h. */
#include <math.h>

#include "cli/context.h"
#include "cli/crop.h"
#include "cli/kinds.h"
#include "cli/report.h"
#include "render/job.h"
#include "render/progress.h"

typedef struct Facts {
  const char *projection, *sampler, *tracer, *filter, *light_sampler, *color;
  double fov_x, fov_y, eye[3], forward[3];
  vlSceneInfo scene;
  vlWorldInfo world;
} Facts;

static Facts gather(const Job *job, const vlScene *scene) {
  const double degrees = 57.295779513082320877;
  const vlCamera *c = &job->camera;
  const vlSceneDefs *defs = job->defs;
  Facts f = {
      .projection = c->projection == VL_PROJECTION_PERSPECTIVE && c->lens_radius > 0
                        ? "thin lens"
                        : vl_projection_name(c->projection),
      .sampler = kind_name("samplers", (int)defs->render.sampler),
      .tracer =
          job->race == RACE_TRACERS ? "auto" : kind_name("tracers", (int)defs->render.tracer),
      .filter = kind_name("filters", (int)defs->film.filter.kind),
      .light_sampler = choice_name(light_sampler_choices, (int)defs->build.light_sampler),
      .color = choice_name(color_choices, (int)defs->build.color),
  };
  f.fov_x = degrees * (atan(c->cx / c->fx) + atan((c->width - c->cx) / c->fx));
  f.fov_y = degrees * (atan(c->cy / c->fy) + atan((c->height - c->cy) / c->fy));
  double length = 0;
  for (int i = 0; i < 3; i++) {
    f.eye[i] = c->world_from_camera[4 * i + 3];
    f.forward[i] = c->world_from_camera[4 * i + 2];
    length += f.forward[i] * f.forward[i];
  }
  for (int i = 0; i < 3; i++)
    f.forward[i] = f.forward[i] / sqrt(length) + 0.0;
  vl_scene_info(scene, &f.scene);
  vl_world_info(job->world, &f.world);
  return f;
}

static void describe_json(const Job *job, const Facts *f, bool denoised,
                          const char *const *outputs, int output_count) {
  const vlCamera *c = &job->camera;
  const vlRenderDef *render = &job->defs->render;
  Json *json = report_json_begin("plan");
  json_put(json, "scene %s, width %u, height %u", job->path, c->width, c->height);
  json_integers(json, "crop", job->defs->film.crop, 4);
  json_put(json, "spp %u, denoised %i, time_limit %g, seed %u, max_depth %u, tracer %s",
           render->spp, denoised, render->time_limit, render->seed, render->max_depth,
           f->tracer);
  json_put(json, "sampler %s, filter %s, light_sampler %s, color %s, projection %s", f->sampler,
           f->filter, f->light_sampler, f->color, f->projection);
  json_numbers(json, "focal", (const double[]){c->fx, c->fy}, 2);
  json_numbers(json, "principal", (const double[]){c->cx, c->cy}, 2);
  json_numbers(json, "world_from_camera", c->world_from_camera, 16);
  json_put(
      json,
      "triangles %lld, primitives %lld, instances %lld, lights %lld, bytes %lld, build_seconds %g",
      (long long)f->world.triangles, (long long)f->world.primitives,
      (long long)f->world.instances, (long long)f->world.lights, (long long)f->world.bytes,
      f->world.build_seconds);
  json_begin(json, "outputs", '[');
  for (int i = 0; i < output_count; i++)
    json_text(json, NULL, outputs[i]);
  json_end(json, ']');
  report_json_end(json);
}

void job_describe(const Job *job, const vlScene *scene, bool denoised,
                  const char *const *outputs, int output_count) {
  Facts f = gather(job, scene);
  if (report_is_json()) {
    describe_json(job, &f, denoised, outputs, output_count);
    return;
  }
  const vlCamera *c = &job->camera;
  const vlRenderDef *render = &job->defs->render;
  const uint32_t *crop = job->defs->film.crop;
  printf("scene     %s: %llu shapes, %llu materials, %llu textures, %llu instances\n",
         job->path, (unsigned long long)f.scene.shapes, (unsigned long long)f.scene.materials,
         (unsigned long long)f.scene.textures, (unsigned long long)f.scene.instances);
  printf("world     %s triangles, other primitives %llu, lights %llu, %sB; built in %s\n",
         format_count((double)f.world.triangles).text,
         (unsigned long long)(f.world.primitives > f.world.triangles
                                  ? f.world.primitives - f.world.triangles
                                  : 0),
         (unsigned long long)f.world.lights, format_count((double)f.world.bytes).text,
         format_seconds(f.world.build_seconds).text);
  printf("camera    %s", f.projection);
  if (c->projection == VL_PROJECTION_PERSPECTIVE)
    printf(", field of view %.4g x %.4g degrees", f.fov_x, f.fov_y);
  printf(", eye (%g, %g, %g), looking along (%.4g, %.4g, %.4g)\n", f.eye[0], f.eye[1], f.eye[2],
         f.forward[0], f.forward[1], f.forward[2]);
  printf("image     %u x %u pixels", c->width, c->height);
  if (!crop_is_whole(crop, c->width, c->height))
    printf(", of these x %u to %u, y %u to %u", crop[0], crop[2], crop[1], crop[3]);
  printf(", filter %s%s, colour %s\n", f.filter, render->share_samples ? "" : " of own samples",
         f.color);
  printf("sampling  %u spp%s, sampler %s, seed %u", render->spp, denoised ? ", denoised" : "",
         f.sampler, render->seed);
  if (render->time_limit > 0)
    printf(", at most %g s", render->time_limit);
  printf("\ntracer    %s, max depth %u, lights by %s%s\n", f.tracer, render->max_depth,
         f.light_sampler, job->defs->build.regularize ? ", regularised" : "");
  printf("machine   %u threads, %s\n", vl_context_threads(job->context),
         context_isa_name(job->context));
  for (int i = 0; i < output_count; i++)
    printf("%s %s\n", i ? "         " : "output   ", outputs[i]);
}
