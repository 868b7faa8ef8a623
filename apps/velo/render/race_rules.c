/* render/race_rules.c: see race_rules.h. */
#include "render/race_rules.h"

#include <math.h>
#include <stdio.h>

#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "velo/tracer.h"

/* The race is planned for at most MAX_SAMPLES, so that all longer renders of an image have the
 * same race: a film of 64 samples that is continued to 256 is that of 256. With --time,
 * PATHS_PER_SECOND count as one second. */
enum { MAX_SAMPLES = 64, PATHS_PER_SECOND = 200000 };

bool race_is_asked(const Arguments *arguments) {
  const OptionValue *tracer = &arguments->values[RENDER_TRACER];
  return tracer->given && tracer->integer == TRACER_AUTO;
}

int race_check_options(const Arguments *arguments) {
  if (!race_is_asked(arguments) || !arguments->values[RENDER_LIGHT_PATHS].given)
    return -1;
  return report_usage(
      "--light-paths: --tracer auto chooses their number; give the name of a tracer");
}

uint32_t race_samples(const vlSceneDefs *defs) {
  const vlRenderDef *render = &defs->render;
  double pixels = (double)defs->film.width * defs->film.height;
  double max = fmin(render->spp, MAX_SAMPLES);
  if (render->time_limit > 0)
    max = fmin(max, render->time_limit * PATHS_PER_SECOND / pixels);
  return (uint32_t)max;
}

/* Whether there is a race that was not asked for: the tracer, or the number of a bidirectional
 * tracer's light paths, is left open. */
static bool is_default(const vlSceneDefs *defs, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  if (v[RENDER_LIGHT_PATHS].given || v[RENDER_MERGE_RADIUS].given || defs->build.imitate_pbrt)
    return false;
  if (race_samples(defs) < RACE_LEAST_SAMPLES)
    return false;
  bool free_paths = defs->render.light_paths == VL_AS_MANY_AS_PIXELS;
  if (defs->render.tracer == VL_TRACER_BIDIRECTIONAL)
    return free_paths;
  return defs->tracer_missing && !v[RENDER_TRACER].given;
}

RaceKind race_kind(const vlSceneDefs *defs, const Arguments *arguments) {
  if (!race_is_asked(arguments) && !is_default(defs, arguments))
    return RACE_NONE;
  return defs->render.tracer == VL_TRACER_BIDIRECTIONAL ? RACE_LIGHT_PATHS : RACE_TRACERS;
}

void race_take(vlRenderDef *def, RaceKind kind, const vlTracerChoice *choice) {
  def->light_paths = choice->light_paths;
  if (kind == RACE_TRACERS)
    def->tracer = choice->tracer;
  else if (choice->tracer == VL_TRACER_VOLPATH)
    def->light_paths = 0;
}

/* ---- the report's line ------------------------------------------------------------------- */

static void trial_name(const vlTracerTrial *trial, char *text, size_t size) {
  bool camera = trial->tracer == VL_TRACER_VOLPATH;
  snprintf(text, size, "%s%s", kind_name("tracers", (int)trial->tracer),
           trial->light_paths == VL_AS_MANY_AS_PIXELS || camera
               ? ""
               : " with a quarter of the light paths");
}

void race_line(RaceKind kind, const vlTracerChoice *choice, char *text, size_t size) {
  char name[80], trials[400] = "", chosen[80] = "";
  if (!choice->count) {
    snprintf(text, size, "auto: %s (no race: docs/tracers.md says when)",
             kind_name("tracers", (int)choice->tracer));
    return;
  }
  for (uint32_t i = 0; i < choice->count; i++) {
    const vlTracerTrial *trial = &choice->trials[i];
    trial_name(trial, name, sizeof name);
    if (trial->tracer == choice->tracer && trial->light_paths == choice->light_paths)
      text_set(chosen, "%s", name);
    text_add(trials, sizeof trials, "%s%s %.2g", i ? ", " : "", name, trial->work);
  }
  if (kind == RACE_LIGHT_PATHS && choice->tracer == VL_TRACER_VOLPATH)
    text_set(chosen, "no light paths");
  snprintf(text, size, "%s: %s (error x rays: %s)",
           kind == RACE_TRACERS ? "auto" : "bidirectional", chosen, trials);
}
