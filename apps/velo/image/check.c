/* image/check.c: `velo image check`: checks that the ground truth channels of a file agree with
 * each other and with the camera in the header. Everything is recomputed in double from the
 * file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/vector.h"
#include "image/check.h"
#include "image/header.h"
#include "image/image.h"

enum { CHECK_THRESHOLD, CHECK_JSON, CHECK_FLOW, CHECK_FLOW_BEFORE };

void check_note(Check *c, int rule, double error) {
  Rule *r = &c->rules[rule];
  if (r->checked && error <= r->worst)
    return;
  r->checked = true;
  r->worst = error == error ? error : (double)INFINITY; /* NaN always fails */
  r->x = c->x;
  r->y = c->y;
}

void check_that(Check *c, int rule, bool good) {
  check_note(c, rule, good ? 0 : (double)INFINITY);
}

void check_load3(const Check *c, int channel, double v[3]) {
  for (int k = 0; k < 3; k++)
    v[k] = c->pixel[channel + k];
}

bool check_is_hit(const Check *c) {
  if (c->object >= 0)
    return c->pixel[c->object] != 0;
  if (c->distance >= 0)
    return c->pixel[c->distance] != INFINITY;
  if (c->z >= 0)
    return c->pixel[c->z] != INFINITY;
  if (c->material >= 0)
    return c->pixel[c->material] != 0;
  if (c->primitive >= 0)
    return c->pixel[c->primitive] != 0;
  double v[3];
  int vector = c->ng >= 0 ? c->ng : c->n;
  if (vector < 0)
    vector = c->p; /* the length of the world's position is then not included */
  if (vector < 0)
    return true;
  check_load3(c, vector, v);
  return vector_length(v) != 0;
}

/* ---- what there is ----------------------------------------------------------------------- */

/* Index of the first of the channels "N." + "XYZ" when all exist in consecutive order;
 * otherwise -1. */
static int find_parts(const vlImage *image, const char *name, const char *parts) {
  char part[40];
  int first = -1;
  for (int k = 0; parts[k]; k++) {
    text_set(part, "%s%c", name, parts[k]);
    int at = vl_image_find_channel(image, part);
    if (at < 0 || (k && at != first + k))
      return -1;
    if (k == 0)
      first = at;
  }
  return first;
}

/* Index of the channel for ids and counts: NAME.Y, or NAME in older files. */
static int find_whole(const vlImage *image, const char *name) {
  char visible[64];
  text_set(visible, "%s.Y", name);
  int at = vl_image_find_channel(image, visible);
  return at >= 0 ? at : vl_image_find_channel(image, name);
}

static void find_channels(Check *c) {
  const vlImage *image = c->image;
  c->z = vl_image_find_channel(image, "Z");
  c->distance = vl_image_find_channel(image, "distance.Y");
  c->object = find_whole(image, "id.object");
  c->material = find_whole(image, "id.material");
  c->primitive = find_whole(image, "id.primitive");
  c->instance = find_whole(image, "id.instance");
  c->samples = find_whole(image, "samples");
  c->alpha = vl_image_find_channel(image, "A");
  c->p = find_parts(image, "P.", "XYZ");
  c->n = find_parts(image, "N.", "XYZ");
  c->ng = find_parts(image, "Ng.", "XYZ");
  c->ray = find_parts(image, "ray.", "XYZ");
  c->uv = find_parts(image, "uv.", "UV");
  c->film = find_parts(image, "film.", "XY");
  c->flow[0] = find_parts(image, "forward.", "UV");
  c->flow[1] = find_parts(image, "backward.", "UV");
  c->hidden[0] = find_whole(image, "forward.hidden");
  c->hidden[1] = find_whole(image, "backward.hidden");
  /* in the order in which the reader sorts colours */
  c->albedo = find_parts(image, "albedo.", "RGB");
  c->error = find_parts(image, "error.", "RGB");
}

static bool has_any(const Check *c) {
  const int all[] = {c->z,    c->distance, c->p,        c->n,         c->ng,
                     c->ray,  c->object,   c->material, c->primitive, c->uv,
                     c->film, c->error,    c->albedo,   c->flow[0],   c->flow[1]};
  for (size_t i = 0; i < LENGTH(all); i++)
    if (all[i] >= 0)
      return true;
  return c->mattes[0].ranks || c->mattes[1].ranks || c->mattes[2].ranks;
}

/* Reads the camera and the settings from the header. */
static void read_header(Check *c) {
  vlAttribute a;
  const char *channels = header_text(c->image, "velo.channels"),
             *filter = header_text(c->image, "velo.filter");
  bool centre = !channels || strcmp(channels, "centre") == 0;
  if (!centre && vl_image_find_attribute(c->image, "velo.filterRadius", &a) == VL_OK)
    for (int k = 0; k < 2; k++)
      c->reach[k] = a.numbers[k] * (1 + 1e-6);
  if (vl_image_find_attribute(c->image, "samplesPerPixel", &a) == VL_OK)
    c->spp = a.numbers[0];
  c->adaptive = vl_image_find_attribute(c->image, "velo.noise", &a) == VL_OK;
  static const char *const positive[] = {"box", "triangle", "gaussian", "blackmanharris"};
  bool pinhole =
      vl_image_find_attribute(c->image, "velo.lensRadius", &a) == VL_OK && a.numbers[0] == 0;
  if (!filter || !pinhole || c->alpha < 0 ||
      vl_image_stored_type(c->image, (uint32_t)c->alpha) != VL_PIXEL_F32)
    return;
  for (size_t i = 0; i < LENGTH(positive); i++)
    c->matte_is_alpha = c->matte_is_alpha || strcmp(filter, positive[i]) == 0;
}

/* Integers are stored as 32-bit floats below 2^24, otherwise as integers. */
static void check_whole_type(Check *c, int channel) {
  if (channel < 0)
    return;
  vlPixelType type = vl_image_stored_type(c->image, (uint32_t)channel);
  check_that(c, RULE_TYPES, type == VL_PIXEL_F32 || type == VL_PIXEL_U32);
}

static void check_type(Check *c, int channel, int parts) {
  for (int k = 0; k < parts && channel >= 0; k++)
    check_that(c, RULE_TYPES,
               vl_image_stored_type(c->image, (uint32_t)(channel + k)) == VL_PIXEL_F32);
}

/* Depths and positions must be 32-bit floats; ids may be floats or integers. */
static void check_types(Check *c) {
  const int ones[] = {c->z, c->distance}, twos[] = {c->uv, c->film, c->flow[0], c->flow[1]},
            threes[] = {c->p, c->n, c->ng, c->ray, c->albedo, c->error},
            ids[] = {c->object,  c->material,  c->primitive, c->instance,
                     c->samples, c->hidden[0], c->hidden[1]};
  c->x = c->x0;
  c->y = c->y0;
  for (size_t i = 0; i < LENGTH(ones); i++)
    check_type(c, ones[i], 1);
  for (size_t i = 0; i < LENGTH(twos); i++)
    check_type(c, twos[i], 2);
  for (size_t i = 0; i < LENGTH(threes); i++)
    check_type(c, threes[i], 3);
  for (size_t i = 0; i < LENGTH(ids); i++)
    check_whole_type(c, ids[i]);
  for (int k = 0; k < 3; k++)
    for (uint32_t r = 0; r < c->mattes[k].ranks; r++) {
      check_type(c, c->mattes[k].id[r], 1);
      check_type(c, c->mattes[k].coverage[r], 1);
    }
}

static void check_all(Check *c) {
  check_types(c);
  uint32_t width = vl_image_width(c->image), height = vl_image_height(c->image);
  c->pixel = vl_image_const_pixels(c->image);
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++, c->pixel += vl_image_channels(c->image)) {
      c->x = c->x0 + x;
      c->y = c->y0 + y;
      check_pixel(c);
    }
  check_finish_flow(c);
}

/* ---- the command ------------------------------------------------------------------------- */

static void print_result(const Check *c, const Arguments *arguments, double threshold) {
  if (!arguments->values[CHECK_JSON].given) {
    printf("pixels     %llu with a surface, %llu without\n", (unsigned long long)c->hits,
           (unsigned long long)c->misses);
    for (int i = 0; i < RULES; i++) {
      const Rule *r = &c->rules[i];
      if (!r->checked)
        continue;
      printf("%-10s %-8.3g %s", r->name, r->worst, r->text);
      if (r->worst > fmax(threshold, r->limit))
        printf(": worst at pixel %u, %u", r->x, r->y);
      putchar('\n');
    }
    if (c->rules[RULE_PIXEL].checked)
      printf("largest distance of project(P) from its pixel's centre: %.3g pixels\n",
             c->pixel_error);
    return;
  }
  Json *json = json_open();
  json_put(json, "file %s, hits %lld, misses %lld", arguments->operands[0], (long long)c->hits,
           (long long)c->misses);
  json_begin(json, "errors", '{');
  for (int i = 0; i < RULES; i++)
    if (c->rules[i].checked)
      json_number(json, c->rules[i].name, c->rules[i].worst);
  json_end(json, '}');
  if (c->rules[RULE_PIXEL].checked)
    json_number(json, "pixels", c->pixel_error);
  json_close(json);
}

static int judge(const Check *c, const char *path, double threshold) {
  int status = STATUS_OK;
  for (int i = 0; i < RULES; i++) {
    const Rule *r = &c->rules[i];
    double limit = fmax(threshold, r->limit);
    if (!r->checked || r->worst <= limit)
      continue;
    status = report_failure(STATUS_OTHER,
                            "%s: %s: %s: %g, the threshold is %g; worst at pixel %u, %u", path,
                            r->name, r->text, r->worst, limit, r->x, r->y);
  }
  return status;
}

/* Reads the image that flow refers to: its camera, and its distances when present. */
static int load_other(Check *c, vlContext *context, const Arguments *arguments,
                      vlImage **image) {
  static const int options[2] = {CHECK_FLOW, CHECK_FLOW_BEFORE};
  const OptionValue *v = arguments->values;
  TRY(options_exclude(arguments, CHECK_FLOW, CHECK_FLOW_BEFORE));
  for (int i = 0; i < 2; i++) {
    const char *path = v[options[i]].text;
    if (!v[options[i]].given)
      continue;
    if (c->flow[i] < 0 || c->hidden[i] < 0)
      return report_failure(STATUS_SCENE, "%s: has no channels %s.U, .V, .hidden", c->path,
                            i ? "backward" : "forward");
    c->which = i;
    TRY(image_load(context, path, image));
    if (vl_image_type(*image) != VL_PIXEL_F32)
      return report_failure(STATUS_SCENE, "%s: its channels are not 32-bit floats", path);
    TRY(header_camera(context, *image, path, &c->other_camera, &c->other_optics, &c->other_x0,
                      &c->other_y0));
    vlCamera rolling;
    if (header_rows(*image, &c->other_camera, &rolling) == ROWS_EACH)
      c->other_camera = rolling;
    c->other_distance = vl_image_find_channel(*image, "distance.Y");
    c->other_object = find_whole(*image, "id.object");
    c->other_instance = find_whole(*image, "id.instance");
    c->other = *image;
  }
  return -1;
}

/* Checks the preconditions of the pixel tests. */
static int prepare(Check *c, vlContext *context, const Arguments *arguments, vlImage **image,
                   vlImage **other) {
  TRY(image_load(context, c->path, image));
  c->image = *image;
  find_channels(c);
  TRY(check_find_mattes(c));
  if (!has_any(c))
    return report_failure(STATUS_SCENE,
                          "%s: has no channel that could be checked (velo render --channels)",
                          c->path);
  if (vl_image_type(*image) != VL_PIXEL_F32)
    return report_failure(STATUS_SCENE, "%s: its channels are not 32-bit floats", c->path);
  TRY(header_camera(context, *image, c->path, &c->camera, &c->optics, &c->x0, &c->y0));
  read_header(c);
  c->rows = header_rows(*image, &c->camera, &c->rolling);
  if (c->rows == ROWS_ONE)
    report_note(
        "%s: its ground truth is of one time, as --channels-time asks; the rows of the "
        "image were exposed at others",
        c->path);
  c->material_of = calloc(CHECK_OBJECTS, sizeof *c->material_of);
  return load_other(c, context, arguments, other);
}

static int run_check(const Arguments *arguments, vlContext *context) {
  const OptionValue *limit = &arguments->values[CHECK_THRESHOLD];
  double threshold = limit->given ? limit->number : 1e-6;
  static const Rule rules[RULES] = {
      {"point", "P = origin + distance * ray"},
      {"depth", "Z = depth of P in the camera"},
      {"pixel", "project(P) = the pixel's point of the film"},
      {"ray", "ray = direction of the camera's ray"},
      {"N", "|N| = 1"},
      {"Ng", "|Ng| = 1"},
      {"nothing", "pixels without a surface hold nothing"},
      {"ids", "ids are whole numbers from 1, a shape has one material"},
      {"types", "numbers are 32-bit floats, ids 32-bit integers"},
      {"finite", "uv, albedo and errors are numbers"},
      {"film", "the point of the film is the centre, or inside the pixel filter"},
      {"samples", "samples are the header's, of adaptive renders at most"},
      {"matte", "Cryptomatte's ids are the manifest's, the larger coverage first"},
      {"coverage", "coverages add up to alpha"},
      {"flow", "flow leads to project(P) in the other camera"},
      {"hidden", "flow leads outside where it says so"},
      {"seen", "share of pixels whose flow leads to other depths than it says", 0.01},
      {"rows", "the camera sees P there when it exposes the pixel's row"}};
  Check check = {.path = arguments->operands[0]}, *c = &check;
  memcpy(c->rules, rules, sizeof rules);
  vlImage *image = NULL, *other = NULL;
  int status = prepare(c, context, arguments, &image, &other);
  if (status < 0) {
    check_all(c);
    print_result(c, arguments, threshold);
    status = judge(c, c->path, threshold);
    check_explain_flow(c, threshold);
  }
  free(c->material_of);
  check_free_mattes(c);
  vl_image_destroy(image);
  vl_image_destroy(other);
  vl_optics_destroy(c->optics);
  vl_optics_destroy(c->other_optics);
  return status;
}

static Option check_options[] = {
    {CHECK_THRESHOLD, "threshold", "largest relative error that is accepted; default 1e-6",
     OPTION_NUMBER, "ERROR", 0, 1},
    {CHECK_FLOW, "flow",
     "the next image: check that forward.U and forward.V lead to the matching pixels of it",
     OPTION_TEXT, "FILE"},
    {CHECK_FLOW_BEFORE, "flow-before",
     "the previous image: check that backward.U and backward.V lead to the matching pixels of "
     "it",
     OPTION_TEXT, "FILE"},
    JSON_OPTION(CHECK_JSON),
    {0}};

const Command image_check_command = {
    .name = "image check",
    .usage = "FILE.exr [options]",
    .summary = "check ground truth channels against the camera in the header",
    .text =
        "Computes depths, positions, rays and pixels of FILE's ground truth channels from "
        "each other and from\n"
        "the camera in its header, in double precision, and prints the largest relative "
        "errors. Errors of\n"
        "positions and depths are relative to the largest of |P|, |origin| and distance, "
        "those of pixels to the\n"
        "larger side of the image. Cryptomatte ids are compared with the manifest, and "
        "coverages with alpha.\n"
        "Exit code 1 if an error is above the threshold.",
    .examples = "velo image check channels.exr\nvelo image check --json channels.exr",
    .options = check_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_check,
};
