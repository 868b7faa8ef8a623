/* render/noise.c: see noise.h. */
#include "render/noise.h"

#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "render/shard.h"

enum { MAX_SAMPLES = 65536 };

double noise_threshold(const char *text) {
  char *end;
  double value = strtod(text, &end);
  if (end == text)
    return 0;
  if (strcmp(end, "%") == 0)
    value /= 100;
  else if (*end)
    return 0;
  return value >= 1e-5 && value <= 0.5 ? value : 0;
}

int noise_check(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  if (!v[RENDER_NOISE].given)
    return -1;
  if (!(noise_threshold(v[RENDER_NOISE].text) > 0))
    return report_usage(
        "--noise \"%s\": must be a part of white from 0.001%% to 50%%, such as 1%%",
        v[RENDER_NOISE].text);
  if (v[RENDER_SAMPLES].given ||
      (v[RENDER_SHARD].given && !shard_is_by_tiles(arguments) && !v[RENDER_TRAJECTORY].given))
    return report_usage(
        "--noise: the samples that a block needs follow from all those before; split the "
        "image with --shard-by tiles");
  return -1;
}

void noise_apply(const Arguments *arguments, const Outputs *outputs, vlSceneDefs *defs) {
  const OptionValue *v = arguments->values;
  if (!v[RENDER_NOISE].given)
    return;
  defs->film.errors = true;
  defs->render.noise = noise_threshold(v[RENDER_NOISE].text);
  defs->render.noise_view = outputs->view;
  defs->render.noise_exposure = outputs->exposure;
  defs->render.noise_scale = defs->develop.exposure;
  if (!v[RENDER_SPP].given)
    defs->render.spp = defs->render.sequence ? defs->render.sequence : MAX_SAMPLES;
}

int noise_expose(const Outputs *outputs, bool many, vlRenderDef *render, vlRenderDef *whole) {
  if (!(render->noise > 0))
    return -1;
  if (outputs->meter || (many && outputs->exposure != render->noise_exposure))
    return report_usage(
        "--noise is measured in display values: their exposure must be known before the "
        "render; give --exposure EV");
  render->noise_exposure = whole->noise_exposure = outputs->exposure;
  return -1;
}

void noise_report(const vlRenderDef *def, const vlRenderStats *stats) {
  if (!(def->noise > 0))
    return;
  if (stats->noisy_blocks)
    report_note("%.1f spp in the mean; %u of %u blocks are still above the noise of %g %%",
                stats->mean_spp, stats->noisy_blocks, stats->blocks, 100 * def->noise);
  else
    report_note("%.1f spp in the mean; all blocks are below the noise of %g %%",
                stats->mean_spp, 100 * def->noise);
}
