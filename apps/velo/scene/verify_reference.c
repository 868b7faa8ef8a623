/* scene/verify_reference.c: renders the scene by the reference renderer (reference/), which
 * shares only the description of the scene with velo. It is a program of its own, started once
 * for each replicate, without a shell. */
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/child.h"
#include "render/job.h"
#include "render/progress.h"
#include "scene/verify.h"

enum { MAX_CHILDREN = 64 };
/* The time of a ray of the reference renderer, relative to a ray of velo's. */
#define RAY_COST 4
/* Seconds of a look after which the reference renderer is stopped. */
static const double max_seconds[2] = {40, 100};

/* ---- finding the program ----------------------------------------------------------------- */

/* Options that change what is rendered, which the reference renderer does not have. */
static const char *other_scene(const Arguments *arguments) {
  const OptionValue *o = arguments->values;
  if (arguments->folder_count)
    return "--sandbox allows no other programs";
  if (o[RENDER_CAMERA].given || o[RENDER_FRAME].given)
    return "it does not know --camera and --frame";
  if (o[RENDER_SEARCH].given || o[RENDER_PERMISSIVE].given)
    return "it does not know --search-path and --permissive";
  return NULL;
}

static void find_beside(char *path, size_t size) {
  const char name[] = "velo-reference";
  const ssize_t n = readlink("/proc/self/exe", path, size - 1);
  path[n > 0 ? n : 0] = 0;
  char *slash = strrchr(path, '/');
  if (slash && (size_t)(slash + 1 - path) + sizeof name <= size)
    memcpy(slash + 1, name, sizeof name);
  else
    path[0] = 0;
}

int verify_reference_find(Verify *v, const Arguments *arguments, const OptionValue *given) {
  const char *named = given->given ? given->text : getenv("VELO_REFERENCE"),
             *why = other_scene(arguments);
  const size_t size = sizeof v->reference;
  if (why) {
    text_set(v->unreferenced, "%s", why);
  } else if (named && named[0]) {
    if (strlen(named) >= size || access(named, X_OK) != 0)
      return report_failure(errno == ENOENT ? STATUS_MISSING : STATUS_IO,
                            "%s: the reference renderer: %s", named,
                            strlen(named) >= size ? "the name is too long" : strerror(errno));
    snprintf(v->reference, size, "%s", named);
  } else {
    find_beside(v->reference, size);
    if (v->reference[0] && access(v->reference, X_OK) == 0)
      return -1;
    v->reference[0] = 0;
    text_set(v->unreferenced, "velo-reference is not beside velo (--reference names it)");
  }
  return -1;
}

/* ---- one look ---------------------------------------------------------------------------- */

typedef struct Replicate {
  pid_t pid;
  uint32_t replicate;
} Replicate;

typedef struct Look {
  Verify *v;
  VerifyRun *run;
  int look;
  uint32_t spp, count, next; /* replicates, and the next one to start */
  double *rows;              /* means of the replicates; null: nothing is kept */
  char folder[32];           /* of the images: N.exr, and of what the program says: N.txt */
  Replicate children[MAX_CHILDREN];
  uint32_t running;
  bool refused;
  vlError *error;
} Look;

static void name_file(const Look *l, uint32_t replicate, const char *end, char path[64]) {
  snprintf(path, 64, "%s/%u.%s", l->folder, replicate, end);
}

static vlResult fail(const Look *l, const char *what) {
  *l->error = (vlError){.code = VL_ERROR_IO};
  text_set(l->error->message, "the reference renderer %.80s: %s", l->v->reference, what);
  return VL_ERROR_IO;
}

static vlResult start(Look *l) {
  const Verify *v = l->v;
  char image[64], text[64], spp[16], seed[16], depth[16], size[32];
  name_file(l, l->next, "exr", image);
  name_file(l, l->next, "txt", text);
  text_set(spp, "%u", l->spp);
  text_set(seed, "%u", verify_seed(v, l->look, l->next));
  text_set(depth, "%u", v->in.job.defs->render.max_depth);
  text_set(size, "%ux%u", v->width, v->height);
  const char *color = v->in.job.defs->build.color == VL_COLOR_RGB ? "rgb" : "spectral";
  const char *const words[] = {
      v->reference, v->path,    "-o",           image,      "--spp", spp,           "--seed",
      seed,         "--tracer", "volpath",      "--filter", "box",   "--max-depth", depth,
      "--color",    color,      "--resolution", size,       NULL};
  char *arguments[LENGTH(words)];
  memcpy(arguments, words, sizeof words);
  Replicate *child = &l->children[l->running];
  *child = (Replicate){.replicate = l->next};
  const int wrong = child_start_apart(&child->pid, v->reference, arguments, text);
  if (wrong)
    return fail(l, strerror(wrong));
  l->running++;
  l->next++;
  return VL_OK;
}

/* The first line that the program has written; empty: none. */
static void read_text(const Look *l, uint32_t replicate, char *line, size_t size) {
  char path[64];
  name_file(l, replicate, "txt", path);
  child_first_line(path, line, size);
  for (char *c = line; *c; c++)
    if ((unsigned char)*c < 0x20 || *c == 0x7f)
      *c = '?';
}

/* Takes the means of a replicate's image. */
static vlResult take_image(Look *l, uint32_t replicate) {
  static const char *const names[VERIFY_CHANNELS] = {"R", "G", "B"};
  const Verify *v = l->v;
  char path[64];
  vlImage *image = NULL;
  name_file(l, replicate, "exr", path);
  vlResult result =
      vl_image_read_channels(v->context, path, names, VERIFY_CHANNELS, &image, l->error);
  if (result == VL_ERROR_MEMORY)
    return result;
  if (result != VL_OK || vl_image_width(image) != v->width ||
      vl_image_height(image) != v->height) {
    vl_image_destroy(image);
    return fail(l, "its image cannot be read, or has another size");
  }
  if (l->rows) {
    const uint32_t values = v->cell_count * VERIFY_CHANNELS;
    double *row = l->rows + (size_t)replicate * values;
    verify_take_means(v, image, row);
    for (uint32_t i = 0; i < values; i++)
      row[i] /= (double)v->in.job.defs->develop.exposure;
    for (uint32_t i = 0; i < values && result == VL_OK; i++)
      if (!isfinite(row[i]))
        result = fail(l, "its image has values that are not finite");
  }
  vl_image_destroy(image);
  return result;
}

/* A child has ended. */
static vlResult finish(Look *l, uint32_t replicate, int status) {
  char line[400];
  unsigned long long lost;
  read_text(l, replicate, line, sizeof line);
  if (WIFEXITED(status) && WEXITSTATUS(status) == STATUS_OK) {
    if (sscanf(line, "velo-reference: %llu samples", &lost) == 1)
      l->run->dropped += lost;
    return take_image(l, replicate);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == STATUS_SCENE) {
    if (!l->refused)
      text_set(l->v->unreferenced, "%s", line);
    l->refused = true;
    return VL_OK;
  }
  if (WIFSIGNALED(status) || !line[0])
    child_end_text(status, line, sizeof line);
  return fail(l, line);
}

/* Takes what has ended. */
static vlResult collect(Look *l) {
  vlResult result = VL_OK;
  for (uint32_t i = 0; i < l->running && result == VL_OK;) {
    const Replicate child = l->children[i];
    int status;
    if (waitpid(child.pid, &status, WNOHANG) == 0) {
      i++;
      continue;
    }
    l->children[i] = l->children[--l->running];
    result = finish(l, child.replicate, status);
  }
  return result;
}

static void stop(Look *l) {
  for (uint32_t i = 0; i < l->running; i++)
    kill(l->children[i].pid, SIGKILL);
  for (uint32_t i = 0; i < l->running; i++)
    waitpid(l->children[i].pid, NULL, 0);
  l->running = 0;
}

static void remove_files(const Look *l) {
  char path[64];
  for (uint32_t i = 0; i < l->next; i++) {
    name_file(l, i, "exr", path);
    unlink(path);
    name_file(l, i, "txt", path);
    unlink(path);
  }
  rmdir(l->folder);
}

/* Renders all replicates, as many at once as the context has threads, until `end`. */
static vlResult render_all(Look *l, double limit) {
  const uint32_t threads = vl_context_threads(l->v->context);
  const uint32_t max = threads < MAX_CHILDREN ? threads : MAX_CHILDREN;
  const double end = monotonic_seconds() + limit;
  vlResult result = VL_OK;
  while (result == VL_OK && !l->refused && (l->running || l->next < l->count)) {
    while (result == VL_OK && l->running < max && l->next < l->count)
      result = start(l);
    if (result == VL_OK)
      result = collect(l);
    if (result == VL_OK && signals_pending())
      result = VL_CANCELLED;
    if (result == VL_OK && monotonic_seconds() > end) {
      text_set(l->v->unreferenced, "it takes longer than %.0f s", limit);
      l->refused = true;
    }
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
  }
  return result;
}

static vlResult run_look(Look *l, double limit) {
  text_set(l->folder, "/tmp/velo-verify-XXXXXX");
  if (!mkdtemp(l->folder))
    return fail(l, "no folder for its images can be made in /tmp");
  const vlResult result = render_all(l, limit);
  stop(l);
  remove_files(l);
  if (l->refused)
    l->run->left_out = true;
  return result;
}

vlResult verify_reference_try(Verify *v, VerifyRun *run, vlError *error) {
  Look l = {.v = v, .run = run, .look = VERIFY_TRIAL, .spp = 1, .count = 1, .error = error};
  run->rays = RAY_COST * v->runs[run->against].rays;
  return run_look(&l, max_seconds[0]);
}

vlResult verify_reference(Verify *v, VerifyRun *run, int look, vlError *error) {
  Look l = {.v = v,
            .run = run,
            .look = look,
            .spp = run->spp[look],
            .count = VERIFY_REPLICATES,
            .error = error};
  l.rows = run->values[look];
  return run_look(&l, max_seconds[look]);
}
