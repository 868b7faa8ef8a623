/* trace/trace.c: `velo trace`: the rays of a file meet a scene. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "camera/scene_world.h"
#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/lens_options.h"
#include "render/needs.h"
#include "trace/hits_file.h"
#include "trace/rays_file.h"
#include "velo/pending.h"

/* Options of this command, behind those of `velo render`, of which it has some. */
enum { TRACE_OUTPUT = RENDER_OPTIONS, TRACE_HITS, TRACE_OCCLUDED, TRACE_OPTIONS };
_Static_assert((int)TRACE_OPTIONS <= (int)MAX_OPTIONS,
               "Arguments.values has no room for an option");

typedef struct State {
  SceneWorld in;
  RaysFile rays;
  void *memory; /* of the results */
  HitsFile results;
  const char *output; /* null: stdout */
} State;

static bool ends_with(const State *s, const char *suffix) {
  return s->output && text_ends_with(s->output, suffix);
}

/* ---- tracing ----------------------------------------------------------------------------- */

/* Each array begins at a multiple of 8 bytes. */
static int make_room(State *s, bool occluded) {
  HitsFile *h = &s->results;
  uint64_t rows = s->rays.count * (occluded ? 1 : h->hits);
  if (rows > SIZE_MAX / 2 / HITS_ROW)
    return report_failure(STATUS_OTHER, "out of memory: %llu hits", (unsigned long long)rows);
  size_t bytes = (size_t)rows * (occluded ? 1 : HITS_ROW) + 128;
  char *at = s->memory = malloc(bytes);
  if (!at)
    return report_failure(STATUS_OTHER, "out of memory: %llu hits need %.1f GB",
                          (unsigned long long)rows, 1e-9 * (double)bytes);
  h->count = s->rays.count;
  h->occluded = occluded ? s->memory : NULL;
  if (ends_with(s, ".npz") && !hits_fit_npz(h))
    return report_failure(
        STATUS_OTHER, "%s: %llu hits are more than an archive of 4 GB holds; .npy holds them",
        s->output, (unsigned long long)rows);
  if (occluded)
    return -1;
  for (const HitsField *f = hits_fields; f < hits_fields + HITS_FIELDS; f++) {
    memcpy((char *)&h->rows + f->offset, &at, sizeof at);
    at += (rows * hits_field_size(f) + 7) / 8 * 8;
  }
  return -1;
}

/* Says how many rays were not traced. */
static void report_stats(const char *path, const vlCastStats *stats) {
  const char *name = strcmp(path, "-") == 0 ? "stdin" : path;
  if (stats->not_finite + stats->zero_directions + stats->too_far)
    report_warning(
        "%s: of %llu rays, %llu have a number that is not finite, %llu the direction "
        "0 0 0, and %llu start beyond 1.8e18: they hit nothing",
        name, (unsigned long long)stats->rays, (unsigned long long)stats->not_finite,
        (unsigned long long)stats->zero_directions, (unsigned long long)stats->too_far);
}

static int cast(State *s, const char *path) {
  const vlCastDef def = {.cookie = vl_default_cast_def().cookie, .hits = s->results.hits};
  double *first = s->rays.count ? s->rays.rows[0] : NULL;
  const int64_t step = sizeof *s->rays.rows;
  vlCastRays rays = {.count = s->rays.count};
  if (first) {
    rays.origins = (vlRayArray){first + RAY_ORIGIN, step, true};
    rays.directions = (vlRayArray){first + RAY_DIRECTION, step, true};
    rays.t_max = (vlRayArray){first + RAY_T_MAX, step, true};
    rays.times = (vlRayArray){first + RAY_TIME, step, true};
    rays.t_min = (vlRayArray){first + RAY_T_MIN, step, true};
  }
  vlCastStats stats;
  vlError error = {0};
  vlResult result =
      s->results.occluded
          ? vl_world_cast_occluded(s->in.world, &rays, &def, s->memory, &stats, &error)
          : vl_world_cast(s->in.world, &rays, &def, &s->results.rows, &stats, &error);
  TRY(report_error(&error, result, path));
  report_stats(path, &stats);
  return -1;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void put(const State *s, FILE *out) {
  if (ends_with(s, ".npy"))
    hits_write_npy(&s->results, out);
  else if (ends_with(s, ".npz"))
    hits_write_npz(&s->results, out);
  else
    hits_write_csv(&s->results, out);
}

static int write_file(const State *s) {
  vlPendingFile *pending;
  vlError error = {0};
  TRY(report_error(&error, vl_pending_file_create(s->in.context, s->output, &pending, &error),
                   s->output));
  FILE *out = fopen(vl_pending_file_path(pending), "wb");
  bool written = out != NULL;
  if (out) {
    put(s, out);
    written = !ferror(out);
    written = fclose(out) == 0 && written;
  }
  const int status =
      written ? report_finish(&error, vl_pending_file_commit(pending, &error), s->output)
              : report_failure(STATUS_IO, "%s: %s", s->output, strerror(errno));
  vl_pending_file_destroy(pending);
  return status;
}

static int write_results(const State *s) {
  if (s->output)
    return write_file(s);
  put(s, stdout);
  return STATUS_OK;
}

/* ---- the command ------------------------------------------------------------------------- */

static int run_trace(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  const char *path = arguments->operands[1];
  State s;
  memset(&s, 0, sizeof s);
  s.output = v[TRACE_OUTPUT].given && strcmp(v[TRACE_OUTPUT].text, "-") != 0
                 ? v[TRACE_OUTPUT].text
                 : NULL;
  s.results.hits = option_count(&v[TRACE_HITS], 1);
  if (s.output && !ends_with(&s, ".npy") && !ends_with(&s, ".npz") && !ends_with(&s, ".csv"))
    return report_usage("-o %s: hits are written as .csv, .npy or .npz", s.output);
  TRY(options_exclude(arguments, TRACE_HITS, TRACE_OCCLUDED));
  int status = rays_file_read(path, &s.rays);
  if (status < 0)
    status = scene_world_open(&s.in, context, arguments);
  if (status < 0 && strcmp(path, "-") != 0)
    vl_note_input(s.in.context, path, VL_OUTPUT_PLAIN);
  if (status < 0)
    status = make_room(&s, v[TRACE_OCCLUDED].given);
  if (status < 0)
    status = cast(&s, path);
  if (status < 0)
    status = write_results(&s);
  free(s.memory);
  rays_file_free(&s.rays);
  scene_world_close(&s.in);
  return status;
}

static Option trace_options[] = {
    {TRACE_OUTPUT, "output", "file of the hits, .csv, .npy or .npz; default: .csv on stdout",
     OPTION_TEXT, "FILE", .letter = 'o'},
    {TRACE_HITS, "hits", "up to K hits along each ray; default 1", OPTION_INTEGER, "K", 1,
     VL_MAX_CAST_HITS},
    {TRACE_OCCLUDED, "occluded", "say only whether something is on each ray"},
    {RENDER_SEARCH},
    STRICT_OPTIONS_OPTION,
    {0}};

const Command trace_command = {
    .name = "trace",
    .usage = "SCENE RAYS.csv|RAYS.npy [options]",
    .summary = "print what rays of your own hit",
    .text =
        "RAYS.csv (- is stdin) has a line ox,oy,oz,dx,dy,dz for each ray: origin and "
        "direction (of any length)\n"
        "in world space; then, where given, t_max, time, t_min. t counts lengths of the "
        "direction, time seconds.\n"
        "A header may name the columns in any order. RAYS.npy is an array of such rows. "
        "Prints for each hit its\n"
        "ray (from 0), t, distance, position, normals, uv, velocity and ids; rays without a "
        "hit have valid 0\n"
        "(docs/rays.md).",
    .examples =
        "velo trace room.pbrt rays.csv -o hits.csv\n"
        "velo camera unproject --camera room.pbrt pixels.csv | velo trace room.pbrt - --hits 4\n"
        "velo trace room.pbrt rays.npy --occluded -o blocked.npy",
    .options = trace_options,
    .operands = 2,
    .context = CONTEXT_ALL,
    .run = run_trace,
};
