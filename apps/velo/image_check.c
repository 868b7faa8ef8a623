/* image_check.c: `velo image check`: do the ground truth channels of a file agree with each other and with the camera
 * in its header? Everything is computed again in double from what the file holds. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "header.h"
#include "image.h"
#include "report.h"

enum { CHECK_THRESHOLD, CHECK_JSON };

/* What is checked; errors are relative. */
enum {
  RULE_POINT,
  RULE_DEPTH,
  RULE_PIXEL,
  RULE_RAY,
  RULE_UNIT_N,
  RULE_UNIT_NG,
  RULE_NOTHING,
  RULE_IDS,
  RULE_TYPES,
  RULES
};
typedef struct Rule {
  const char *name, *text;
  bool checked;
  double worst;
  uint32_t x, y; /* of the worst */
} Rule;

typedef struct Check {
  const vlImage *image;
  const float *pixel; /* the one that is looked at */
  vlCamera camera;
  uint32_t x0, y0, x, y; /* corner of the data window, and place in the whole picture */
  int z, distance, p, n, ng, ray, object, material, primitive, instance; /* channels; -1: not in the file */
  uint64_t hits, misses;
  double pixel_error; /* largest, in pixels */
  Rule rules[RULES];
} Check;

static void note(Check *c, int rule, double error) {
  Rule *r = &c->rules[rule];
  if (r->checked && error <= r->worst) return;
  r->checked = true;
  r->worst = error == error ? error : INFINITY; /* NaN never agrees */
  r->x = c->x, r->y = c->y;
}

/* X Y Z of a vector: three channels that stand together in the file's order; -1 unless all are there. */
static int find_vector(const vlImage *image, const char *name) {
  char part[40];
  int first = -1;
  for (int k = 0; k < 3; k++) {
    snprintf(part, sizeof part, "%s.%c", name, 'X' + k);
    int at = vl_image_find_channel(image, part);
    if (at < 0 || (k && at != first + k)) return -1;
    if (k == 0) first = at;
  }
  return first;
}

static void find_channels(Check *c) {
  c->z = vl_image_find_channel(c->image, "Z");
  c->distance = vl_image_find_channel(c->image, "distance.Y");
  c->object = vl_image_find_channel(c->image, "id.object");
  c->material = vl_image_find_channel(c->image, "id.material");
  c->primitive = vl_image_find_channel(c->image, "id.primitive");
  c->instance = vl_image_find_channel(c->image, "id.instance");
  c->p = find_vector(c->image, "P");
  c->n = find_vector(c->image, "N");
  c->ng = find_vector(c->image, "Ng");
  c->ray = find_vector(c->image, "ray");
}

static double length3(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
static void load3(const Check *c, int channel, double v[3]) {
  for (int k = 0; k < 3; k++) v[k] = c->pixel[channel + k];
}

/* Anything that tells whether the pixel met a surface; without such a channel it is taken to. */
static bool is_hit(const Check *c) {
  if (c->object >= 0) return c->pixel[c->object] != 0;
  if (c->distance >= 0) return c->pixel[c->distance] != INFINITY;
  if (c->z >= 0) return c->pixel[c->z] != INFINITY;
  if (c->material >= 0) return c->pixel[c->material] != 0;
  if (c->primitive >= 0) return c->pixel[c->primitive] != 0;
  double v[3];
  int vector = c->ng >= 0 ? c->ng : c->n;
  if (vector < 0) return true;
  load3(c, vector, v);
  return length3(v) != 0;
}

static void check_miss(Check *c, bool in_domain, const double direction[3]) {
  double wrong = 0, v[3];
  const int zeros[] = {c->object, c->material, c->primitive, c->instance}, vectors[] = {c->p, c->n, c->ng};
  for (size_t i = 0; i < sizeof zeros / sizeof *zeros; i++)
    if (zeros[i] >= 0 && c->pixel[zeros[i]] != 0) wrong = INFINITY;
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
    if (vectors[i] < 0) continue;
    load3(c, vectors[i], v);
    if (length3(v) != 0) wrong = INFINITY;
  }
  if (c->z >= 0 && c->pixel[c->z] != INFINITY) wrong = INFINITY;
  if (c->distance >= 0 && c->pixel[c->distance] != INFINITY) wrong = INFINITY;
  note(c, RULE_NOTHING, wrong);
  if (c->ray < 0) return;
  load3(c, c->ray, v);
  for (int k = 0; k < 3 && in_domain; k++) v[k] -= direction[k];
  note(c, RULE_RAY, length3(v));
}

/* Errors are measured against the largest number that takes part: that is what floats can promise. */
static void check_point(Check *c, const double origin[3], const double direction[3]) {
  double p[3], ray[3], t = c->distance >= 0 ? c->pixel[c->distance] : 0;
  if (c->ray >= 0)
    load3(c, c->ray, ray);
  else
    memcpy(ray, direction, sizeof ray);
  if (c->p >= 0)
    load3(c, c->p, p);
  else
    for (int k = 0; k < 3; k++) p[k] = origin[k] + t * ray[k];
  if (c->p < 0 && c->distance < 0) return;
  double away[3] = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
  double size = fmax(fmax(length3(p), length3(origin)), length3(away));
  if (c->p >= 0 && c->distance >= 0) {
    double off[3];
    for (int k = 0; k < 3; k++) off[k] = p[k] - (origin[k] + t * ray[k]);
    note(c, RULE_POINT, length3(off) / size);
  }
  double pixel[2], z;
  bool seen = vl_camera_project(&c->camera, p, pixel, &z);
  if (c->z >= 0) {
    const double *m = c->camera.camera_from_world;
    double scale = length3((double[3]){m[8], m[9], m[10]});
    z = m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11];
    note(c, RULE_DEPTH, fabs(c->pixel[c->z] - z) / (scale * size));
  }
  double error = seen ? hypot(pixel[0] - (c->x + 0.5), pixel[1] - (c->y + 0.5)) : INFINITY;
  if (error > c->pixel_error) c->pixel_error = error;
  double larger = c->camera.width > c->camera.height ? c->camera.width : c->camera.height;
  note(c, RULE_PIXEL, error / larger * fmin(1, length3(away) / size));
}

static void check_pixel(Check *c) {
  double origin[3] = {0, 0, 0}, direction[3] = {0, 0, 0}, v[3];
  bool in_domain = vl_camera_unproject(&c->camera, c->x + 0.5, c->y + 0.5, origin, direction);
  if (!is_hit(c)) {
    c->misses++;
    check_miss(c, in_domain, direction);
    return;
  }
  c->hits++;
  if (c->ray >= 0) {
    load3(c, c->ray, v);
    for (int k = 0; k < 3; k++) v[k] -= direction[k];
    note(c, RULE_RAY, in_domain ? length3(v) : INFINITY);
  }
  check_point(c, origin, direction);
  if (c->n >= 0) {
    load3(c, c->n, v);
    note(c, RULE_UNIT_N, fabs(length3(v) - 1));
  }
  if (c->ng >= 0) {
    load3(c, c->ng, v);
    note(c, RULE_UNIT_NG, fabs(length3(v) - 1));
  }
  const int ids[] = {c->object, c->material, c->primitive};
  for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
    if (ids[i] >= 0)
      note(c, RULE_IDS, c->pixel[ids[i]] >= 1 && floorf(c->pixel[ids[i]]) == c->pixel[ids[i]] ? 0 : INFINITY);
  if (c->instance >= 0)
    note(c, RULE_IDS,
         c->pixel[c->instance] >= 0 && floorf(c->pixel[c->instance]) == c->pixel[c->instance] ? 0 : INFINITY);
}

/* Depths and positions as 32-bit floats, ids as integers. */
static void check_types(Check *c) {
  const int floats[] = {c->z, c->distance, c->p, c->n, c->ng, c->ray},
            ids[] = {c->object, c->material, c->primitive, c->instance};
  c->x = c->x0, c->y = c->y0;
  for (size_t i = 0; i < sizeof floats / sizeof *floats; i++)
    if (floats[i] >= 0)
      note(c, RULE_TYPES, vl_image_stored_type(c->image, (uint32_t)floats[i]) == VL_PIXEL_F32 ? 0 : INFINITY);
  for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
    if (ids[i] >= 0)
      note(c, RULE_TYPES, vl_image_stored_type(c->image, (uint32_t)ids[i]) == VL_PIXEL_U32 ? 0 : INFINITY);
}

static void check_all(Check *c) {
  check_types(c);
  uint32_t width = vl_image_width(c->image), height = vl_image_height(c->image);
  c->pixel = vl_image_const_pixels(c->image);
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++, c->pixel += vl_image_channels(c->image)) {
      c->x = c->x0 + x, c->y = c->y0 + y;
      check_pixel(c);
    }
}

/* ---- the command ------------------------------------------------------------------------------------------------- */

static void print_result(const Check *c, const Arguments *arguments, double threshold) {
  if (!arguments->values[CHECK_JSON].given) {
    printf("pixels     %llu with a surface, %llu without\n", (unsigned long long)c->hits,
           (unsigned long long)c->misses);
    for (int i = 0; i < RULES; i++) {
      const Rule *r = &c->rules[i];
      if (!r->checked) continue;
      printf("%-10s %-8.3g %s", r->name, r->worst, r->text);
      if (r->worst > threshold) printf(": worst at pixel %u, %u", r->x, r->y);
      putchar('\n');
    }
    if (c->rules[RULE_PIXEL].checked)
      printf("largest distance of project(P) from its pixel's centre: %.3g pixels\n", c->pixel_error);
    return;
  }
  Json json = {.out = stdout};
  json_begin(&json, NULL, '{');
  json_text(&json, "file", arguments->operands[0]);
  json_integer(&json, "hits", (int64_t)c->hits);
  json_integer(&json, "misses", (int64_t)c->misses);
  json_begin(&json, "errors", '{');
  for (int i = 0; i < RULES; i++)
    if (c->rules[i].checked) json_number(&json, c->rules[i].name, c->rules[i].worst);
  json_end(&json, '}');
  if (c->rules[RULE_PIXEL].checked) json_number(&json, "pixels", c->pixel_error);
  json_end(&json, '}');
  putchar('\n');
}

static int judge(const Check *c, const char *path, double threshold) {
  int status = STATUS_OK;
  for (int i = 0; i < RULES; i++) {
    const Rule *r = &c->rules[i];
    if (!r->checked || r->worst <= threshold) continue;
    status = report_failure(STATUS_OTHER, "%s: %s: %s: %g, the threshold is %g; worst at pixel %u, %u", path, r->name,
                            r->text, r->worst, threshold, r->x, r->y);
  }
  return status;
}

static int run_check(const Command *command, const Arguments *arguments) {
  (void)command;
  const char *path = arguments->operands[0];
  const OptionValue *limit = &arguments->values[CHECK_THRESHOLD];
  double threshold = limit->given ? limit->number : 1e-6;
  static const Rule rules[RULES] = {{"point", "P = origin + distance * ray", false, 0, 0, 0},
                                    {"depth", "Z = depth of P in the camera", false, 0, 0, 0},
                                    {"pixel", "project(P) = centre of the pixel", false, 0, 0, 0},
                                    {"ray", "ray = direction of the camera's ray", false, 0, 0, 0},
                                    {"N", "|N| = 1", false, 0, 0, 0},
                                    {"Ng", "|Ng| = 1", false, 0, 0, 0},
                                    {"nothing", "pixels without a surface hold nothing", false, 0, 0, 0},
                                    {"ids", "ids are whole numbers from 1", false, 0, 0, 0},
                                    {"types", "numbers are 32-bit floats, ids 32-bit integers", false, 0, 0, 0}};
  Check check = {.hits = 0}, *c = &check;
  memcpy(c->rules, rules, sizeof rules);
  vlContext *context = NULL;
  vlImage *image = NULL;
  int status = image_context(&context);
  if (status < 0) status = image_load(context, path, &image);
  if (status < 0) {
    c->image = image;
    find_channels(c);
    if (c->z < 0 && c->distance < 0 && c->p < 0 && c->n < 0 && c->ng < 0 && c->ray < 0 && c->object < 0 &&
        c->material < 0 && c->primitive < 0)
      status = report_failure(STATUS_SCENE, "%s: has no channel that could be checked (velo render --channels)", path);
    else if (vl_image_type(image) != VL_PIXEL_F32)
      status = report_failure(STATUS_SCENE, "%s: its channels are not 32-bit floats", path);
  }
  if (status < 0) status = header_camera(image, path, &c->camera, &c->x0, &c->y0);
  if (status < 0) {
    check_all(c);
    print_result(c, arguments, threshold);
    status = image_finish_output(judge(c, path, threshold));
  }
  vl_image_destroy(image);
  vl_context_destroy(context);
  return status;
}

static const Option check_options[] = {
    {CHECK_THRESHOLD, 0, "threshold", OPTION_NUMBER, "ERROR", "largest relative error that is accepted; default 1e-6",
     0, 1, NULL},
    {CHECK_JSON, 0, "json", OPTION_FLAG, NULL, "one JSON object on stdout", 0, 0, NULL},
    {0, 0, NULL, OPTION_FLAG, NULL, NULL, 0, 0, NULL}};

const Command image_check_command = {
    .name = "image check",
    .usage = "FILE.exr [options]",
    .summary = "do ground truth channels agree with the camera in the header?",
    .text =
        "Computes depths, positions, rays and pixels of FILE's ground truth channels from each other and from\n"
        "the camera in its header, in double precision, and prints the largest relative errors. Positions and\n"
        "depths are measured against the largest of |P|, |origin| and distance, pixels against the larger side\n"
        "of the picture. Exit code 1 when an error is above the threshold.",
    .options = check_options,
    .min_operands = 1,
    .max_operands = 1,
    .run = run_check,
};
