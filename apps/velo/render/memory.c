/* render/memory.c: see memory.h. */
#include "render/memory.h"

#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "cli/crop.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/progress.h"
#include "velo/tracer.h"

/* ---- the process ------------------------------------------------------------------------- */

/* Bytes of resident memory of the process. */
static uint64_t process_resident(void) {
  unsigned long long pages[2] = {0, 0};
  FILE *file = fopen("/proc/self/statm", "r");
  if (file && fscanf(file, "%llu %llu", &pages[0], &pages[1]) != 2)
    pages[0] = pages[1] = 0;
  if (file)
    fclose(file);
  return pages[1] * (uint64_t)sysconf(_SC_PAGESIZE);
}

/* ---- who needs how much ------------------------------------------------------------------ */

void memory_add(MemoryPlan *plan, const char *what, uint64_t bytes) {
  if (!bytes)
    return;
  plan->needs[plan->count].what = what;
  plan->needs[plan->count++].bytes = bytes;
  plan->total += bytes;
}

/* OpenEXR files are compressed in chunks of 16 rows, two per worker, with three copies of
 * each. */
static uint64_t writing(vlContext *context, const Outputs *outputs, uint64_t width,
                        uint64_t height, uint64_t values) {
  uint64_t max = 0, rows = 32 * (uint64_t)vl_context_threads(context);
  if (rows > height)
    rows = height;
  for (int i = 0; i < outputs->count; i++) {
    uint64_t bytes =
        12 * width * (output_holds_layers(outputs->paths[i]) ? rows * (4 + values) : 16);
    if (bytes > max)
      max = bytes;
  }
  return max;
}

static uint64_t film_bytes(const Job *job, const Frames *frames) {
  if (!frames)
    return vl_film_memory(&job->defs->film);
  uint64_t sum = 0;
  for (uint32_t i = 0; i < frames->camera_count; i++)
    if (frames->cameras[i].owns_film)
      sum += vl_film_memory(&frames->cameras[i].job.defs->film);
  return sum;
}

/* The second render of --channels illuminance: its film, its workers, two images. */
static uint64_t illuminance_bytes(const Job *job) {
  const vlFilmDef *film = &job->defs->film;
  vlFilmDef own = vl_default_film_def(film->width, film->height);
  memcpy(own.crop, film->crop, sizeof own.crop);
  vlRenderDef render = job->defs->render;
  render.tracer = VL_TRACER_VOLPATH;
  uint64_t pixels = crop_pixels(own.crop);
  return vl_film_memory(&own) + vl_render_memory(job->world, &own, &render) +
         pixels * 5 * sizeof(float);
}

void memory_plan(MemoryPlan *plan, const Job *job, const Outputs *outputs,
                 const Channels *channels, const Frames *frames) {
  /* Images of a trajectory that are rendered, queued or written at the same time. */
  enum { WAITING = 6 };
  memset(plan, 0, sizeof *plan);
  const uint32_t *crop = job->defs->film.crop;
  uint64_t width = crop_width(crop), height = crop_height(crop), pixels = width * height,
           copies = 1;
  for (uint32_t i = 0; frames && i < frames->camera_count; i++) {
    const uint32_t *c = frames->cameras[i].job.defs->film.crop;
    uint64_t other = crop_pixels(c);
    if (other > pixels) {
      pixels = other;
      width = crop_width(c);
      height = crop_height(c);
    }
  }
  if (frames)
    copies = (frames_count(frames) < WAITING ? frames_count(frames) : WAITING) *
             (uint64_t)frames->views;
  const bool eight_bit = outputs_any(outputs, output_is_display),
             layers = outputs_any(outputs, output_holds_layers);
  uint64_t values = layers ? channels_values(channels, job->defs->film.buckets) : 0;
  uint64_t held = vl_context_memory(job->context, NULL), resident = process_resident();
  memory_add(plan, "program", resident > held ? resident - held : 0);
  memory_add(plan, "scene", held);
  memory_add(plan, "film", film_bytes(job, frames));
  memory_add(plan, "rendering",
             vl_render_memory(job->world, &job->defs->film, &job->defs->render));
  memory_add(plan, "image", copies * pixels * (eight_bit ? 20 : 16));
  uint64_t ground_truth = copies * pixels * values * 4;
  if (layers && (channels->bits & VL_CHANNEL_ILLUMINANCE))
    ground_truth += illuminance_bytes(job);
  memory_add(plan, "ground truth", ground_truth);
  memory_add(plan, "writing", writing(job->context, outputs, width, height, values));
}

/* ---- does it fit ------------------------------------------------------------------------- */

void memory_list(const MemoryPlan *plan, char *text, size_t size) {
  text[0] = 0;
  for (int i = 0; i < plan->count; i++)
    text_add(text, size, "%s%s %sB", i ? ", " : "", plan->needs[i].what,
             format_count((double)plan->needs[i].bytes).text);
}

static int too_much(const MemoryPlan *plan, uint64_t limit, const char *who) {
  char list[400];
  memory_list(plan, list, sizeof list);
  return report_failure(STATUS_OTHER, "out of memory: this needs %sB, and %s %sB: %s",
                        format_count((double)plan->total).text, who,
                        format_count((double)limit).text, list);
}

int memory_check(const MemoryPlan *plan, uint64_t limit) {
  if (limit && plan->total > limit)
    return too_much(plan, limit, "--max-memory allows");
  const char *who;
  uint64_t max = vl_memory_limit(&who);
  return plan->total > max ? too_much(plan, max, who) : -1;
}

void memory_report_json(const MemoryPlan *plan, uint64_t limit) {
  Json *json = report_json_begin("memory");
  for (int i = 0; i < plan->count; i++)
    json_integer(json, plan->needs[i].what, (int64_t)plan->needs[i].bytes);
  json_integer(json, "total", (int64_t)plan->total);
  if (limit)
    json_integer(json, "limit", (int64_t)limit);
  report_json_end(json);
}

uint64_t memory_peak(void) {
  struct rusage usage;
  return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}
