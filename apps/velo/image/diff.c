/* image/diff.c: `velo image diff`: differences between an image and a reference. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/image.h"
#include "render/output_names.h"

enum { DIFF_OUTPUT, DIFF_THRESHOLD, DIFF_JSON };

/* The metrics. The name of a metric is also the name of its threshold. */
typedef enum MetricKind { METRIC_UPPER_BOUND, METRIC_LOWER_BOUND, METRIC_FROM_ONE } MetricKind;
typedef struct Metric {
  const char *name;
  MetricKind kind; /* whether the threshold is an upper bound, a lower bound, or a largest
                      distance from 1 */
  double value;
} Metric;

enum { METRICS = 8 };

static void list_metrics(const vlImageDiff *d, Metric metrics[METRICS]) {
  const Metric list[METRICS] = {
      {"mse", METRIC_UPPER_BOUND, d->mse},
      {"relmse", METRIC_UPPER_BOUND, d->rel_mse},
      {"psnr", METRIC_LOWER_BOUND, d->psnr},
      {"flip", METRIC_UPPER_BOUND, d->flip},
      {"meanratio", METRIC_FROM_ONE, d->mean_ratio},
      {"maxabs", METRIC_UPPER_BOUND, d->max_abs},
      {"differing", METRIC_UPPER_BOUND, (double)d->differing},
      {"notfinite", METRIC_UPPER_BOUND, (double)d->not_finite},
  };
  memcpy(metrics, list, sizeof list);
}

/* Parses "flip=0.05" into index and limit. Returns -1 or the exit code. */
static int read_threshold(const char *text, const Metric metrics[METRICS], int *index,
                          double *limit) {
  const char *equals = strchr(text, '=');
  char name[40];
  const char *names[METRICS];
  for (int i = 0; i < METRICS; i++)
    names[i] = metrics[i].name;
  if (!equals || equals - text >= (long)sizeof name)
    return report_usage("--threshold \"%s\": must be NAME=VALUE, such as flip=0.05", text);
  text_set(name, "%.*s", (int)(equals - text), text);
  *index = -1;
  for (int i = 0; i < METRICS; i++)
    if (strcmp(names[i], name) == 0)
      *index = i;
  if (*index < 0) {
    const char *near = did_you_mean("", name, names, METRICS);
    return report_usage("--threshold: unknown measure \"%s\"%s", name,
                        *near ? near
                              : "; accepted are mse, relmse, psnr, flip, meanratio, maxabs, "
                                "differing, notfinite");
  }
  if (!parse_numbers(equals + 1, 1, limit))
    return report_usage("--threshold \"%s\": the value must be a number", text);
  return -1;
}

/* A metric that is NaN always fails. */
static bool accepted(const Metric *metric, double limit) {
  switch (metric->kind) {
    case METRIC_UPPER_BOUND:
      return metric->value <= limit;
    case METRIC_LOWER_BOUND:
      return metric->value >= limit;
    case METRIC_FROM_ONE:
      return fabs(metric->value - 1) <= limit;
  }
  return false;
}

static int check_thresholds(const Arguments *arguments, const Metric metrics[METRICS]) {
  int result = STATUS_OK;
  for (int i = 0; i < arguments->text_count; i++) {
    int index;
    double limit;
    TRY(read_threshold(arguments->texts[i], metrics, &index, &limit));
    if (accepted(&metrics[index], limit))
      continue;
    result = report_failure(STATUS_OTHER, "%s is %g, the threshold is %g", metrics[index].name,
                            metrics[index].value, limit);
  }
  return result;
}

static void print_metrics(const Arguments *arguments, const Metric metrics[METRICS]) {
  if (!arguments->values[DIFF_JSON].given) {
    for (int i = 0; i < METRICS; i++)
      printf("%-10s %.9g\n", metrics[i].name, metrics[i].value);
    return;
  }
  Json *json = json_open();
  json_put(json, "reference %s, image %s", arguments->operands[0], arguments->operands[1]);
  for (int i = 0; i < METRICS; i++)
    json_number(json, metrics[i].name, metrics[i].value);
  json_close(json);
}

static int write_heat(const vlImage *heat, const char *path) {
  vlError error = {0};
  return report_finish(&error, vl_image_write(heat, path, NULL, &error), path);
}

static int run_diff(const Arguments *arguments, vlContext *context) {
  Outputs heat_file = {.paths = {arguments->values[DIFF_OUTPUT].text},
                       .count = arguments->values[DIFF_OUTPUT].given};
  vlImageDiff diff = {0};
  Metric metrics[METRICS];
  list_metrics(&diff, metrics);
  /* Checks thresholds and outputs before any work. */
  int status = outputs_check_names(&heat_file);
  for (int i = 0, index; i < arguments->text_count && status < 0; i++) {
    double limit;
    status = read_threshold(arguments->texts[i], metrics, &index, &limit);
  }
  if (status < 0)
    status = outputs_check_folders(&heat_file);
  if (status >= 0)
    return status;

  vlImage *a = NULL, *b = NULL, *heat = NULL;
  status = image_load(context, arguments->operands[0], &a);
  if (status < 0)
    status = image_load(context, arguments->operands[1], &b);
  if (status < 0)
    status = outputs_check_inputs(context, &heat_file);
  if (status < 0) {
    vlError error = {0};
    vlResult result = vl_image_compare(a, b, &diff, heat_file.count ? &heat : NULL, &error);
    status = report_error(&error, result, arguments->operands[1]);
  }
  if (status < 0) {
    list_metrics(&diff, metrics);
    print_metrics(arguments, metrics);
    status = heat ? write_heat(heat, heat_file.paths[0]) : STATUS_OK;
    if (status == STATUS_OK)
      status = check_thresholds(arguments, metrics);
  }
  vl_image_destroy(heat);
  vl_image_destroy(b);
  vl_image_destroy(a);
  return status;
}

static Option diff_options[] = {
    {DIFF_OUTPUT, "output", "write an image of the FLIP differences in false colours",
     OPTION_TEXT, "FILE", .letter = 'o'},
    {DIFF_THRESHOLD, "threshold",
     "exit with code 1 if this measure is above VALUE (psnr: below VALUE; meanratio: farther "
     "than VALUE from 1); may be given several times",
     OPTION_TEXTS, "NAME=VALUE"},
    JSON_OPTION(DIFF_JSON),
    {0}};

const Command image_diff_command = {
    .name = "image diff",
    .usage = "REFERENCE IMAGE [options]",
    .summary = "measure the difference between an image and a reference",
    .text =
        "Prints differences between IMAGE and REFERENCE in linear R, G, B (or Y):\n"
        "  mse        mean squared error\n"
        "  relmse     mean of squared errors, each divided by reference^2 + 0.01\n"
        "  psnr       peak signal-to-noise ratio in dB, for a peak of 1\n"
        "  flip       mean FLIP error at 67 pixels per degree\n"
        "  meanratio  ratio of the mean luminances, IMAGE divided by REFERENCE\n"
        "  maxabs     largest absolute difference of a value\n"
        "  differing  number of pixels that are not equal\n"
        "  notfinite  number of pixels with inf or nan; the other measures omit them",
    .examples =
        "velo image diff reference.exr room.exr\n"
        "velo image diff reference.png room.png --threshold flip=0.01 -o heat.png",
    .options = diff_options,
    .operands = 2,
    .context = CONTEXT_ONE,
    .run = run_diff,
};
