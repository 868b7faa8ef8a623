/* view/engine_verify.c: runs the command that a page copied last, as a program of its own
 * without a shell, and compares the bytes of its image with those of the image that the page
 * showed. */
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/sha256.h"
#include "render/child.h"
#include "render/outputs.h"
#include "view/engine_copied.h"
#include "view/engine_status.h"

enum { KINDS = 2, MAX_WORDS = 2 * MAX_OPTIONS + 40 };
/* The command yields to the page, which goes on. */
static const int niceness = 5;
static const char *const kinds[KINDS] = {"png", "exr"};

/* A verification. folder: has the images of the page (shown) and of the command (made). */
typedef struct Verification {
  Engine *engine;
  Copied *copied;
  char folder[40], message[300];
  char shown[KINDS][64], made[KINDS][64], report[64];
  char sha256[KINDS][SHA256_TEXT];
} Verification;

static bool fail(Verification *v, const char *what, const char *why) {
  text_set(v->message, "%s%s%s", what, why ? ": " : "", why ? why : "");
  return false;
}

/* ---- files ------------------------------------------------------------------------------- */

static bool make_folder(Verification *v) {
  text_set(v->folder, "/tmp/velo-view-XXXXXX");
  if (!mkdtemp(v->folder)) {
    v->folder[0] = 0;
    return fail(v, "no folder for the command's image can be made in /tmp", strerror(errno));
  }
  for (int k = 0; k < KINDS; k++) {
    text_set(v->shown[k], "%s/shown.%s", v->folder, kinds[k]);
    text_set(v->made[k], "%s/made.%s", v->folder, kinds[k]);
  }
  text_set(v->report, "%s/report.txt", v->folder);
  return true;
}

static void remove_folder(const Verification *v) {
  char part[80];
  if (!v->folder[0])
    return;
  for (int k = 0; k < KINDS; k++) {
    unlink(v->shown[k]);
    unlink(v->made[k]);
    if (output_part_path(v->made[k], part, sizeof part))
      unlink(part);
  }
  unlink(v->report);
  rmdir(v->folder);
}

/* Writes the page's image as *Save image* does. */
static bool write_shown(Verification *v) {
  Outputs outputs = {.paths = {v->shown[0], v->shown[1]},
                     .count = KINDS,
                     .view = v->copied->view,
                     .exposure = (float)v->copied->exposure};
  return outputs_write(v->engine->def.context, &outputs, v->copied->image, v->copied->spp,
                       OUTPUT_FINISHED) == STATUS_OK ||
         fail(v, "the image of the page cannot be written in /tmp", NULL);
}

/* ---- the command ------------------------------------------------------------------------- */

/* The words of the copied command but for its -o IMAGE, and what makes no difference to the
 * image. */
static int find_words(Verification *v, char *words[MAX_WORDS]) {
  static char quiet[] = "--quiet", output[] = "-o", threads[] = "--threads";
  const OptionValue *given = &v->engine->def.arguments->values[RENDER_THREADS];
  int count = 0;
  for (char *word = v->copied->words; word < v->copied->words + v->copied->size;
       word += strlen(word) + 1)
    if (count < MAX_WORDS - 10)
      words[count++] = word;
  count -= 2;
  words[count++] = quiet;
  if (given->given) {
    words[count++] = threads;
    words[count++] = (char *)(uintptr_t)given->text;
  }
  for (int k = 0; k < KINDS; k++) {
    words[count++] = output;
    words[count++] = v->made[k];
  }
  words[count] = NULL;
  return count;
}

static bool start(Verification *v, pid_t *child) {
  char *words[MAX_WORDS];
  find_words(v, words);
  const int wrong = child_start_apart(child, "/proc/self/exe", words, v->report);
  if (wrong)
    return fail(v, "the command cannot be started", strerror(wrong));
  setpriority(PRIO_PROCESS, (id_t)*child, niceness);
  return true;
}

static bool is_ended(Engine *e) {
  engine_lock(e);
  bool ended = e->quit || e->verify.end;
  engine_unlock(e);
  return ended;
}

/* Waits for the child, or ends it where a page or the end of the program asks for that. */
static bool wait_for(Verification *v, pid_t child) {
  const struct timespec pause = {.tv_nsec = 10000000};
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (is_ended(v->engine)) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return fail(v, "ended", NULL);
    }
    nanosleep(&pause, NULL);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == STATUS_OK)
    return true;
  char line[200];
  child_first_line(v->report, line, sizeof line);
  return fail(v, "the command made no image", line[0] ? line : NULL);
}

/* ---- the comparison ---------------------------------------------------------------------- */

/* Says in which pixels the images differ, and by how much. */
static void describe_difference(Verification *v) {
  static const char *const names[3] = {"R", "G", "B"};
  const vlImage *shown = v->copied->image;
  const uint32_t width = vl_image_width(shown), height = vl_image_height(shown);
  vlImage *made = NULL;
  uint64_t count = 0;
  double max = 0;
  if (vl_image_read(v->engine->def.context, v->made[1], &made, NULL) != VL_OK ||
      vl_image_width(made) != width || vl_image_height(made) != height) {
    fail(v, "the command's image has another size", NULL);
    vl_image_destroy(made);
    return;
  }
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++) {
      double d = 0;
      for (int c = 0; c < 3; c++)
        d = fmax(d, fabs((double)vl_image_get(
                             shown, x, y, (uint32_t)vl_image_find_channel(shown, names[c])) -
                         (double)vl_image_get(
                             made, x, y, (uint32_t)vl_image_find_channel(made, names[c]))));
      count += d > 0;
      max = fmax(max, d);
    }
  vl_image_destroy(made);
  if (count)
    text_set(v->message, "%llu of %llu pixels differ, by up to %.3g", (unsigned long long)count,
             (unsigned long long)width * height, max);
  else
    fail(v, "the pixels are the same, the headers differ", NULL);
}

static bool compare(Verification *v) {
  bool same = true;
  for (int k = 0; k < KINDS; k++) {
    char shown[SHA256_TEXT];
    if (!sha256_file(v->made[k], v->sha256[k]))
      return fail(v, "the command made no image", strerror(errno));
    same &= sha256_file(v->shown[k], shown) && strcmp(shown, v->sha256[k]) == 0;
  }
  if (!same)
    describe_difference(v);
  return same;
}

/* ---- the thread -------------------------------------------------------------------------- */

static void post_verified(const Verification *v, const ViewMessage *m, bool same) {
  Json *json = engine_reply_begin(m, "verified");
  if (!json)
    return;
  json_put(json, "same %i, file %s", same, v->copied->file);
  if (same) {
    json_put(json, "sha256 %s, sha256_exr %s", v->sha256[0], v->sha256[1]);
  } else {
    json_text(json, "message", v->message);
  }
  json_text_post(json, v->engine->server, m->client);
}

static bool verify(Verification *v) {
  pid_t child = 0;
  const bool same =
      make_folder(v) && write_shown(v) && start(v, &child) && wait_for(v, child) && compare(v);
  remove_folder(v);
  return same;
}

void *engine_verify_commands(void *user) {
  Engine *e = user;
  static ViewMessage asked; /* this thread alone uses it */
  for (;;) {
    engine_lock(e);
    while (!e->quit && !e->verify.runs)
      pthread_cond_wait(&e->wake, &e->lock);
    const bool quit = e->quit;
    Copied *copied = e->verify.next;
    e->verify.next = NULL;
    asked = e->verify.asked;
    engine_unlock(e);
    Verification v = {.engine = e, .copied = copied};
    const bool same = !quit && verify(&v);
    engine_lock(e);
    if (!quit)
      post_verified(&v, &asked, same);
    e->verify.runs = false;
    if (!e->verify.copied) { /* it may be verified again */
      e->verify.copied = copied;
      copied = NULL;
    }
    engine_unlock(e);
    copied_free(copied);
    if (quit)
      return NULL;
  }
}
