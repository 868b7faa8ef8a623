/* bench/error.c: finds which of two programs, or sets of options, has the smaller error for the
 * same time. Both render each scene several times, interleaved, with pairs of seeds. The time
 * is the child's user CPU time. The error is measured against a reference if there is one.
 * Otherwise it is measured within the pairs: half the squared difference of two seeds is the
 * variance. */
#include <errno.h>
#include <math.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "velo/velo.h"

enum { WORDS = 256, PAIRS = 64, SCENES = 64, MEASURES = 3 };
extern char **environ;

static const char usage[] =
    "usage: script/bench error A B SCENE... [--pairs N] [--both \"OPTIONS\"] [--reference "
    "FOLDER] [--json FILE]\n"
    "  A, B       \"PROGRAM OPTIONS\" or \"OPTIONS\" of this build's velo render; %o stands "
    "for the image that is\n"
    "             measured (default: -o %o), %n for the scene's name\n"
    "  SCENE      FILE or NAME=FILE[@WIDTHxHEIGHT]\n"
    "  --pairs    pairs of seeds for each scene, default 4\n"
    "  --both     options of both\n"
    "  --reference  a folder with NAME.exr: errors against these images; default: within "
    "the pairs of seeds\n"
    "  --json     default bench/results/error.json\n";

/* The error of one image or pair: relMSE without the worst 0.1 % of pixels, relMSE of all, mean
 * FLIP. */
typedef struct Error {
  double value[MEASURES];
} Error;
static const char *const measure_names[MEASURES] = {"relmse_trimmed", "relmse", "flip"};

typedef struct Side {
  const char *text;
  double seconds[PAIRS]; /* total of the two renders of a pair */
  Error errors[PAIRS];
} Side;

typedef struct Scene {
  char name[64], file[1024], size[32];
  /* ratio B / A, with its 95 % confidence interval */
  double efficiency[MEASURES], low[MEASURES], high[MEASURES];
  /* means, and half the widths of the 95 % intervals */
  double seconds[2], error[2][MEASURES], spread[2][MEASURES];
} Scene;

typedef struct Bench {
  Side sides[2];
  const char *both, *reference, *json;
  int pairs, count;
  Scene scenes[SCENES];
  vlContext *context;
  char folder[64];
} Bench;

static void fail(const char *what, const char *detail) {
  fprintf(stderr, "error: %s%s%s\n", what, *detail ? ": " : "", detail);
  exit(1);
}

/* ---- errors of images -------------------------------------------------------------------- */

static vlImage *load(const Bench *b, const char *path) {
  vlImage *image;
  vlError error = {0};
  if (vl_image_read(b->context, path, &image, &error) != VL_OK)
    fail(path, error.message);
  return image;
}

static int descending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? 1 : x > y ? -1 : 0;
}

/* Computes the relative squared error of each pixel as the mean over R, G, B. With `pair` the
 * error is half the squared difference of both images, divided by the square of their mean. */
static Error compare(const vlImage *a, const vlImage *reference, bool pair) {
  uint32_t width = vl_image_width(a), height = vl_image_height(a);
  size_t pixels = (size_t)width * height, left_out = (pixels + 999) / 1000;
  int from[3], to[3];
  static const char *const names[3] = {"R", "G", "B"};
  for (int c = 0; c < 3; c++) {
    from[c] = vl_image_find_channel(a, names[c]);
    to[c] = vl_image_find_channel(reference, names[c]);
    if (from[c] < 0 || to[c] < 0)
      fail("an image lacks R, G or B", "");
  }
  vlImageDiff diff;
  vlError error = {0};
  if (vl_image_compare(reference, a, &diff, NULL, &error) != VL_OK)
    fail("compare", error.message);
  double *worst = calloc(pixels, sizeof *worst), sum = 0, rest = 0;
  for (size_t i = 0; i < pixels && worst; i++)
    for (int c = 0; c < 3; c++) {
      uint32_t x = (uint32_t)(i % width), y = (uint32_t)(i / width);
      double p = vl_image_get(a, x, y, (uint32_t)from[c]),
             q = vl_image_get(reference, x, y, (uint32_t)to[c]);
      double base = pair ? 0.5 * (p + q) : q;
      if (isfinite(p) && isfinite(q))
        worst[i] += (p - q) * (p - q) / ((base * base + 0.01) * (pair ? 6 : 3));
    }
  qsort(worst, pixels, sizeof *worst, descending);
  for (size_t i = 0; i < pixels; i++) {
    sum += worst[i];
    rest += i >= left_out ? worst[i] : 0;
  }
  free(worst);
  return (Error){{rest / (double)(pixels - left_out), sum / (double)pixels, diff.flip}};
}

/* ---- running ----------------------------------------------------------------------------- */

/* Appends the words of a text. %o is replaced by `image` and %n by `name`. */
static void add_words(char **words, int *count, const char *text, const char *image,
                      const char *name) {
  char *copy = strdup(text ? text : ""), *state = NULL;
  for (char *word = strtok_r(copy, " ", &state); word; word = strtok_r(NULL, " ", &state)) {
    char whole[2048] = "";
    size_t n = 0;
    for (const char *at = word; *at && n + 1100 < sizeof whole; at++) {
      const char *part = at[0] == '%' && at[1] == 'o'   ? image
                         : at[0] == '%' && at[1] == 'n' ? name
                                                        : NULL;
      if (part) {
        n += (size_t)snprintf(whole + n, sizeof whole - n, "%s", part);
        at++;
      } else {
        whole[n++] = *at;
        whole[n] = 0;
      }
    }
    if (*count < WORDS - 16)
      words[(*count)++] = strdup(whole);
  }
  free(copy);
}

/* Renders once. Returns the child's user CPU time in seconds. */
static double run(const Bench *b, const Side *side, const Scene *scene, uint32_t seed,
                  const char *image) {
  char *words[WORDS], text[32];
  const char *options = side->text, *program = getenv("VELO");
  int count = 0;
  if (*options && *options != '-') {
    char *first = NULL;
    if (sscanf(options, "%ms", &first) != 1)
      fail("no program in", options);
    options += strlen(first);
    words[count++] = first;
  } else {
    words[count++] = strdup(program ? program : "velo");
  }
  snprintf(text, sizeof text, "%u", seed);
  const char *const fixed[] = {"render", scene->file, "--quiet", "-t", "1", "--seed", text};
  for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
    words[count++] = strdup(fixed[i]);
  if (scene->size[0]) {
    words[count++] = strdup("--resolution");
    words[count++] = strdup(scene->size);
  }
  if (!strstr(side->text, "%o"))
    add_words(words, &count, "-o %o", image, scene->name);
  add_words(words, &count, b->both, image, scene->name);
  add_words(words, &count, options, image, scene->name);
  words[count] = NULL;
  pid_t child;
  int status = posix_spawnp(&child, words[0], NULL, NULL, words, environ);
  if (status != 0)
    fail(words[0], strerror(status));
  struct rusage used;
  while (wait4(child, &status, 0, &used) < 0)
    if (errno != EINTR)
      fail("wait", strerror(errno));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    fail("the program failed", side->text);
  for (int i = 0; i < count; i++)
    free(words[i]);
  return (double)used.ru_utime.tv_sec + 1e-6 * (double)used.ru_utime.tv_usec;
}

static void render_pairs(Bench *b, const Scene *scene) {
  char path[256], images[2][2][128];
  vlImage *reference = NULL;
  if (b->reference) {
    snprintf(path, sizeof path, "%s/%s.exr", b->reference, scene->name);
    reference = load(b, path);
  }
  for (int pair = 0; pair < b->pairs; pair++) {
    for (int s = 0; s < 2; s++)
      b->sides[s].seconds[pair] = 0;
    for (int k = 0; k < 4; k++) { /* the order is A B B A */
      int s = k == 1 || k == 2, half = k / 2;
      snprintf(images[s][half], sizeof images[s][half], "%s/%d_%d.exr", b->folder, s, half);
      b->sides[s].seconds[pair] +=
          run(b, &b->sides[s], scene, (uint32_t)(2 * pair + half), images[s][half]);
    }
    for (int s = 0; s < 2; s++) {
      vlImage *first = load(b, images[s][0]), *second = load(b, images[s][1]);
      Error e = compare(first, reference ? reference : second, !reference);
      if (reference) {
        Error other = compare(second, reference, false);
        for (int m = 0; m < MEASURES; m++)
          e.value[m] = 0.5 * (e.value[m] + other.value[m]);
      }
      b->sides[s].errors[pair] = e;
      vl_image_destroy(first);
      vl_image_destroy(second);
      for (int half = 0; half < 2; half++)
        unlink(images[s][half]);
    }
  }
  vl_image_destroy(reference);
}

/* ---- statistics -------------------------------------------------------------------------- */

/* 97.5 % quantile of Student's t distribution. */
static double student(int freedom) {
  static const double table[] = {0,    12.71, 4.30, 3.18, 2.78, 2.57, 2.45,
                                 2.36, 2.31,  2.26, 2.23, 2.20, 2.18, 2.16,
                                 2.14, 2.13,  2.12, 2.11, 2.10, 2.09, 2.09};
  return freedom < 1 ? INFINITY : freedom <= 20 ? table[freedom] : 1.96 + 2.5 / freedom;
}

/* Computes the mean of n values, and in *half half the width of its 95 % interval. */
static double mean_of(const double *x, int n, double *half) {
  double sum = 0, squares = 0;
  for (int i = 0; i < n; i++)
    sum += x[i];
  for (int i = 0; i < n; i++)
    squares += (x[i] - sum / n) * (x[i] - sum / n);
  *half = n > 1 ? student(n - 1) * sqrt(squares / (n - 1) / n) : (double)INFINITY;
  return sum / n;
}

/* The efficiency is 1 / (error x time). FLIP is proportional to the square root of the
 * variance, so its square is used. */
static void judge(const Bench *b, Scene *scene) {
  double x[PAIRS], half;
  for (int s = 0; s < 2; s++) {
    scene->seconds[s] = 0.5 * mean_of(b->sides[s].seconds, b->pairs, &half);
    for (int m = 0; m < MEASURES; m++) {
      for (int i = 0; i < b->pairs; i++)
        x[i] = b->sides[s].errors[i].value[m];
      scene->error[s][m] = mean_of(x, b->pairs, &scene->spread[s][m]);
    }
  }
  for (int m = 0; m < MEASURES; m++) {
    for (int i = 0; i < b->pairs; i++) {
      double e = b->sides[0].errors[i].value[m] / b->sides[1].errors[i].value[m];
      x[i] = log((m == 2 ? e * e : e) * b->sides[0].seconds[i] / b->sides[1].seconds[i]);
    }
    double mean = mean_of(x, b->pairs, &half);
    scene->efficiency[m] = exp(mean);
    scene->low[m] = exp(mean - half);
    scene->high[m] = exp(mean + half);
  }
}

/* ---- results ----------------------------------------------------------------------------- */

static void print_text(FILE *out, const char *text) {
  fputc('"', out);
  for (; *text; text++)
    fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
  fputc('"', out);
}

static void number(FILE *out, const char *name, double value, const char *end) {
  if (isfinite(value))
    fprintf(out, "\"%s\": %.6g%s", name, value, end);
  else
    fprintf(out, "\"%s\": null%s", name, end);
}

/* Returns the geometric mean of the efficiencies over the scenes, and in *worst the smallest of
 * them. */
static double summary(const Bench *b, int m, double *worst) {
  double sum = 0;
  *worst = INFINITY;
  for (int i = 0; i < b->count; i++) {
    sum += log(b->scenes[i].efficiency[m]);
    if (b->scenes[i].efficiency[m] < *worst)
      *worst = b->scenes[i].efficiency[m];
  }
  return exp(sum / b->count);
}

static void write_json(const Bench *b) {
  FILE *out = fopen(b->json, "w");
  if (!out)
    fail(b->json, strerror(errno));
  fprintf(out, "{\"bench\": \"error\",\n \"a\": ");
  print_text(out, b->sides[0].text);
  fprintf(out, ", \"b\": ");
  print_text(out, b->sides[1].text);
  fprintf(out, ", \"both\": ");
  print_text(out, b->both ? b->both : "");
  fprintf(out, ",\n \"pairs\": %d, \"against\": \"%s\",\n \"scenes\": [", b->pairs,
          b->reference ? "reference" : "seed pairs");
  for (int i = 0; i < b->count; i++) {
    const Scene *scene = &b->scenes[i];
    fprintf(out, "%s\n  {\"name\": ", i ? "," : "");
    print_text(out, scene->name);
    fprintf(out, ", \"size\": \"%s\"", scene->size);
    for (int s = 0; s < 2; s++) {
      fprintf(out, ",\n   \"%c\": {", 'a' + s);
      number(out, "user_seconds", scene->seconds[s], "");
      for (int m = 0; m < MEASURES; m++) {
        fprintf(out, ", \"%s\": {", measure_names[m]);
        number(out, "mean", scene->error[s][m], ", ");
        number(out, "ci95", scene->spread[s][m], "}");
      }
      fputc('}', out);
    }
    for (int m = 0; m < MEASURES; m++) {
      fprintf(out, ",\n   \"efficiency_%s\": {", measure_names[m]);
      number(out, "mean", scene->efficiency[m], ", ");
      number(out, "low", scene->low[m], ", ");
      number(out, "high", scene->high[m], "}");
    }
    fputc('}', out);
  }
  fprintf(out, "],\n \"geometric_mean\": {");
  for (int m = 0; m < MEASURES; m++) {
    double worst;
    number(out, measure_names[m], summary(b, m, &worst), m + 1 < MEASURES ? ", " : "");
  }
  fprintf(out, "}}\n");
  if (fclose(out) != 0)
    fail(b->json, strerror(errno));
}

static void print_scene(const Scene *s) {
  printf("%-26s %7.2f %7.2f  %9.3g %9.3g  %9.3g %9.3g  %6.4f %6.4f  %6.2f (%.2f to %.2f)\n",
         s->name, s->seconds[0], s->seconds[1], s->error[0][0], s->error[1][0], s->error[0][1],
         s->error[1][1], s->error[0][2], s->error[1][2], s->efficiency[0], s->low[0],
         s->high[0]);
  fflush(stdout);
}

/* ---- the command line -------------------------------------------------------------------- */

static void add_scene(Bench *b, const char *text) {
  if (b->count == SCENES)
    fail("too many scenes", "");
  Scene *s = &b->scenes[b->count++];
  const char *equals = strchr(text, '='), *file = equals ? equals + 1 : text,
             *at = strrchr(file, '@');
  size_t length = at ? (size_t)(at - file) : strlen(file);
  snprintf(s->file, sizeof s->file, "%.*s", (int)length, file);
  if (at)
    snprintf(s->size, sizeof s->size, "%s", at + 1);
  const char *slash = strrchr(s->file, '/'), *base = slash ? slash + 1 : s->file,
             *dot = strrchr(base, '.');
  if (equals)
    snprintf(s->name, sizeof s->name, "%.*s", (int)(equals - text), text);
  else
    snprintf(s->name, sizeof s->name, "%.*s", dot ? (int)(dot - base) : (int)strlen(base),
             base);
  if (access(s->file, R_OK) != 0)
    fail(s->file, strerror(errno));
}

int main(int argc, char **argv) {
  static Bench bench;
  Bench *b = &bench;
  static char json[1024];
  const char *root = getenv("VELO_SOURCE_DIR");
  snprintf(json, sizeof json, "%s/bench/results/error.json", root ? root : ".");
  b->json = json;
  b->pairs = 4;
  int sides = 0;
  for (int i = 1; i < argc; i++) {
    const char **text = strcmp(argv[i], "--both") == 0        ? &b->both
                        : strcmp(argv[i], "--reference") == 0 ? &b->reference
                        : strcmp(argv[i], "--json") == 0      ? &b->json
                                                              : NULL;
    bool pairs = strcmp(argv[i], "--pairs") == 0;
    if ((text || pairs) && i + 1 == argc)
      fail(argv[i], "a value is missing");
    if (text)
      *text = argv[++i];
    else if (pairs)
      b->pairs = atoi(argv[++i]);
    else if (sides < 2)
      b->sides[sides++].text = argv[i];
    else
      add_scene(b, argv[i]);
  }
  if (sides < 2 || b->count == 0 || b->pairs < 1 || b->pairs > PAIRS) {
    fputs(usage, stderr);
    return 2;
  }
  snprintf(b->folder, sizeof b->folder, "/tmp/velo_error_XXXXXX");
  if (!mkdtemp(b->folder) || vl_context_create(NULL, &b->context) != VL_OK)
    fail("no folder or context", "");
  printf("%-26s %15s  %19s  %19s  %13s  %s\n%-26s %7s %7s  %9s %9s  %9s %9s  %6s %6s  %s\n", "",
         "user seconds", "trimmed relMSE", "relMSE", "FLIP", "efficiency of B over A, trimmed",
         "", "A", "B", "A", "B", "A", "B", "A", "B", "(95 % confidence)");
  int scenes = b->count;
  for (int i = 0; i < scenes; i++) {
    render_pairs(b, &b->scenes[i]);
    judge(b, &b->scenes[i]);
    print_scene(&b->scenes[i]);
    b->count = i + 1; /* results are written after each scene, in case the run is stopped */
    write_json(b);
  }
  for (int m = 0; m < MEASURES; m++) {
    double worst, mean = summary(b, m, &worst);
    printf("efficiency by %-15s geometric mean %.3f, worst %.3f\n", measure_names[m], mean,
           worst);
  }
  rmdir(b->folder);
  vl_context_destroy(b->context);
  return 0;
}
