/* camera/vanishing.c: `velo camera vanishing`: the principal vanishing points and the horizon
 * of a camera, optionally drawn over an image; and the inverse: a camera from vanishing
 * points. */
#include <math.h>
#include <stdio.h>

#include "camera/camera.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "cli/vector.h"
#include "image/image.h"
#include "image/overlay.h"
#include "render/output_names.h"
#include "velo/vanishing.h"

enum {
  V_JSON,
  V_FRAME,
  V_UP,
  V_OVERLAY,
  V_OUT,
  V_LINES,
  V_GRID,
  V_FROM,
  V_PRINCIPAL,
  V_SIZE,
  V_AXES,
  V_TO
};

static const char *const axis_names[3] = {"x", "y", "z"};

/* ---- output ------------------------------------------------------------------------------ */

static const char *kind_of(const vlCamera *c, const vlVanishingPoints *v) {
  static const char *const kinds[] = {"parallel projection", "one-point perspective",
                                      "two-point perspective", "three-point perspective"};
  if (c->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return kinds[0];
  return c->projection == VL_PROJECTION_PERSPECTIVE ? kinds[v->finite]
                                                    : "curvilinear perspective";
}

static void say_json(const char *path, const vlCamera *c, const vlVanishingPoints *v) {
  Json *json = json_open();
  json_put(json, "file %s, projection %s, pixel_origin %s, width %u", path,
           vl_projection_name(c->projection), "corner", c->width);
  json_put(json, "height %u, kind %s, finite %u", c->height, kind_of(c, v), v->finite);
  json_begin(json, "vanishing_points", '{');
  for (int i = 0; i < 3; i++) {
    const vlVanishingPoint *p = &v->axes[i];
    json_begin(json, axis_names[i], '{');
    json_text(json, "kind",
              p->kind == VL_VANISHING_FINITE     ? "finite"
              : p->kind == VL_VANISHING_INFINITE ? "infinite"
                                                 : "none");
    if (p->kind != VL_VANISHING_NONE) {
      bool finite = p->kind == VL_VANISHING_FINITE;
      const double *xy = finite ? p->pixel : p->direction;
      json_numbers(json, finite ? "pixel" : "direction", xy, 2);
      if (finite)
        json_text(json, "end", p->behind ? "negative" : "positive");
    }
    json_end(json, '}');
  }
  json_end(json, '}');
  if (v->has_horizon)
    json_numbers(json, "horizon", v->horizon, 3);
  json_close(json);
}

static void say_text(const vlCamera *c, const vlVanishingPoints *v) {
  printf("kind          %s\n", kind_of(c, v));
  for (int i = 0; i < 3; i++) {
    const vlVanishingPoint *p = &v->axes[i];
    printf("%s             ", axis_names[i]);
    if (p->kind == VL_VANISHING_FINITE)
      printf("%.17g %.17g%s\n", p->pixel[0], p->pixel[1],
             p->behind ? " (of its negative end)" : "");
    else if (p->kind == VL_VANISHING_INFINITE)
      printf("infinite, along %.17g %.17g\n", p->direction[0], p->direction[1]);
    else
      printf("none\n");
  }
  if (v->has_horizon)
    printf("horizon       %.17g x + %.17g y + %.17g = 0\n", v->horizon[0], v->horizon[1],
           v->horizon[2]);
  else
    printf("horizon       %s\n",
           c->projection == VL_PROJECTION_ORTHOGRAPHIC ? "none" : "no line in the image");
}

/* ---- what is drawn ----------------------------------------------------------------------- */

/* Draws lines parallel to d. Each lies in a plane through the camera centre that contains d;
 * `count` such planes are evenly spaced. */
static void draw_family(Overlay *o, const vlCamera *c, const double d[3], int count,
                        double width) {
  double a[3], b[3], n[3];
  vector_across(d, a, b);
  for (int i = 0; i < 2 * count; i++) {
    double t = M_PI * i / count;
    for (int k = 0; k < 3; k++)
      n[k] = cos(t) * a[k] + sin(t) * b[k];
    overlay_arc(o, c, d, n, -0.5 * M_PI, 0.5 * M_PI, width);
  }
}

/* Draws the line point + s d of the world, s from s0 to s1, as an arc of directions from the
 * camera centre. */
static void draw_world_line(Overlay *o, const vlCamera *c, const double point[3],
                            const double d[3], double s0, double s1, double width) {
  double n[3], p[2], q[2], ends[2][3];
  const double eye[3] = {c->world_from_camera[3], c->world_from_camera[7],
                         c->world_from_camera[11]};
  /* projects to a straight line, whatever its depth */
  if (c->projection == VL_PROJECTION_ORTHOGRAPHIC) {
    vector_along(point, s0, d, ends[0]);
    vector_along(point, s1, d, ends[1]);
    if (vl_camera_project(c, ends[0], p, NULL) && vl_camera_project(c, ends[1], q, NULL))
      overlay_line(o, p[0], p[1], q[0], q[1], width);
    return;
  }
  vector_subtract(point, eye, n);
  double along = vector_dot(n, d);
  vector_along(n, -along, d, n);
  double height = vector_length(n);
  if (!vector_normalize(n))
    return; /* the line passes through the camera centre and projects to a point */
  overlay_arc(o, c, d, n, atan2(s0 + along, height), atan2(s1 + along, height), width);
}

/* Draws a ground grid around the camera: 41 lines each way, `spacing` apart. */
static void draw_grid(Overlay *o, const vlCamera *c, const double up[3], double spacing,
                      double level, double width) {
  enum { REACH = 20 };
  double a[3], b[3], p[3];
  const double eye[3] = {c->world_from_camera[3], c->world_from_camera[7],
                         c->world_from_camera[11]};
  vector_across(up, a, b);
  const double *const sides[2][2] = {{a, b}, {b, a}};
  for (int k = 0; k < 2; k++) {
    const double *d = sides[k][0], *e = sides[k][1];
    double middle_d = floor(vector_dot(eye, d) / spacing + 0.5) * spacing;
    double middle_e = floor(vector_dot(eye, e) / spacing + 0.5) * spacing;
    for (int i = -REACH; i <= REACH; i++) {
      for (int j = 0; j < 3; j++)
        p[j] = (middle_e + i * spacing) * e[j] + level * up[j];
      draw_world_line(o, c, p, d, middle_d - REACH * spacing, middle_d + REACH * spacing,
                      width);
    }
  }
}

typedef struct Drawing {
  const double *up;
  int lines;
  double spacing, level; /* ground grid; spacing 0: none */
} Drawing;

static void draw(Overlay *o, const vlCamera *c, const Drawing *drawing) {
  static const uint8_t colors[3][3] = {{235, 60, 50}, {40, 170, 70}, {50, 110, 245}},
                       white[3] = {255, 255, 255}, yellow[3] = {255, 205, 40};
  double a[3], b[3], width = fmax(1.0, 0.0022 * (o->width + o->height));
  if (drawing->spacing > 0.0) {
    draw_grid(o, c, drawing->up, drawing->spacing, drawing->level, 0.8 * width);
    overlay_paint(o, white, 0.6);
  }
  bool flat = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  for (int i = 0; i < 3; i++) {
    const double d[3] = {i == 0, i == 1, i == 2};
    if (!flat && drawing->lines)
      draw_family(o, c, d, drawing->lines, 0.8 * width);
    overlay_paint(o, colors[i], 0.55);
    for (int end = 0; end < 2; end++) { /* curved projections may show both ends */
      const double e[3] = {end ? -d[0] : d[0], end ? -d[1] : d[1], end ? -d[2] : d[2]};
      vlVanishingPoint p;
      if (vl_camera_vanishing_point(c, e, &p) && p.kind == VL_VANISHING_FINITE)
        overlay_ring(o, p.pixel[0], p.pixel[1], 5.0 * width, 1.5 * width);
    }
    overlay_paint(o, colors[i], 1.0);
  }
  if (flat)
    return;
  vector_across(drawing->up, a, b);
  overlay_arc(o, c, b, a, 0.0, 2.0 * M_PI, 1.5 * width);
  overlay_paint(o, yellow, 0.9);
}

/* Resizes the camera to the image's size when both have the same aspect ratio. */
static int fit_camera(const vlImage *image, const char *path, vlCamera *camera) {
  uint32_t w = vl_image_width(image), h = vl_image_height(image);
  if (w == camera->width && h == camera->height)
    return -1;
  if (fabs((double)w * camera->height - (double)h * camera->width) > fmax(w, h))
    return report_failure(STATUS_SCENE,
                          "%s: the image has %u x %u pixels, the camera %u x %u: another shape",
                          path, w, h, camera->width, camera->height);
  vlCamera resized;
  const vlResult result = vl_camera_resize(camera, w, h, &resized);
  if (result != VL_OK)
    return report_reason(result, path, "the camera cannot have the size of the image");
  *camera = resized;
  return -1;
}

static int draw_overlay(vlContext *context, const Arguments *arguments, const vlCamera *of,
                        const Drawing *drawing) {
  const OptionValue *v = arguments->values;
  vlImage *image = NULL;
  vlCamera camera = *of;
  vlError error = {0};
  int status = output_check_drawing(v[V_OUT].text);
  if (status < 0)
    status = image_load(context, v[V_OVERLAY].text, &image);
  if (status < 0)
    status = output_check(context, v[V_OUT].text, VL_OUTPUT_PLAIN);
  if (status < 0)
    status = fit_camera(image, v[V_OVERLAY].text, &camera);
  if (status < 0) {
    Overlay overlay = {0};
    vlResult result = VL_ERROR_MEMORY;
    if (overlay_begin(&overlay, image)) {
      draw(&overlay, &camera, drawing);
      result = overlay_write(&overlay, context, v[V_OUT].text, &error);
    }
    overlay_end(&overlay);
    status = report_error(&error, result, v[V_OUT].text);
  }
  vl_image_destroy(image);
  return status;
}

/* ---- the inverse ------------------------------------------------------------------------- */

/* Parses "xz" or "-xyz": the axis of each point; a minus means the negative direction. */
static bool parse_axes(const char *text, vlVanishingDef *def) {
  for (uint32_t i = 0; i < def->count; i++) {
    def->away[i] = *text != '-';
    if (*text == '-' || *text == '+')
      text++;
    if (*text < 'x' || *text > 'z')
      return false;
    def->axes[i] = (uint32_t)(*text++ - 'x');
  }
  return *text == 0;
}

static void say_camera(const vlCameraDef *d, bool as_json) {
  if (as_json) {
    Json *json = json_open();
    json_put(json, "pixel_origin %s, axes %s, width %u, height %u", "corner",
             "x right, y down, z forward", d->width, d->height);
    json_put(json, "focal %g, cx %g, cy %g", d->fx, d->cx, d->cy);
    json_numbers(json, "world_from_camera", d->world_from_camera, 16);
    json_close(json);
    return;
  }
  const double *m = d->world_from_camera;
  printf("focal length  %.17g pixels\nprincipal     %.17g %.17g\n", d->fx, d->cx, d->cy);
  printf("right         %.17g %.17g %.17g\n", m[0], m[4], m[8]);
  printf("down          %.17g %.17g %.17g\n", m[1], m[5], m[9]);
  printf("forward       %.17g %.17g %.17g\n", m[2], m[6], m[10]);
}

static int run_inverse(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  if (!v[V_SIZE].given)
    return report_usage("--from needs --size WxH, the image's");
  vlVanishingDef def = vl_default_vanishing_def((uint32_t)v[V_SIZE].integers[0],
                                                (uint32_t)v[V_SIZE].integers[1]);
  def.count = 1 + (uint32_t)arguments->operand_count;
  if (def.count < 2 || def.count > 3)
    return report_usage("--from takes 2 or 3 points: --from x1,y1 x2,y2 [x3,y3]");
  for (uint32_t i = 0; i < def.count; i++) {
    const char *text = i ? arguments->operands[i - 1] : v[V_FROM].text;
    if (!parse_numbers(text, 2, def.points[i]))
      return report_usage("\"%s\": a point is x,y in pixels", text);
  }
  if (!parse_axes(v[V_AXES].given ? v[V_AXES].text : def.count == 2 ? "xz" : "xyz", &def))
    return report_usage(
        "--axes \"%s\": %u of x, y, z, each with - before it where its negative end is meant",
        v[V_AXES].text, def.count);
  if (v[V_PRINCIPAL].given) {
    double p[2];
    if (!parse_numbers(v[V_PRINCIPAL].text, 2, p))
      return report_usage("--principal takes cx,cy in pixels");
    def.cx = p[0];
    def.cy = p[1];
  }
  vlError error = {0};
  vlCameraRecord record = {.frames = 1};
  vlResult result = vl_camera_from_vanishing_points(&def, &record.camera, &error);
  if (result != VL_OK)
    return report_failure(STATUS_SCENE, "%s", error.message);
  if (v[V_OUT].given) {
    vlCameraFileDef file = vl_default_camera_file_def();
    file.dialect = (vlCameraDialect)option_count(&v[V_TO], VL_CAMERA_DIALECT_AUTO);
    TRY(report_error(&error, vl_camera_write(context, v[V_OUT].text, &file, &record, &error),
                     v[V_OUT].text));
  }
  say_camera(&record.camera, v[V_JSON].given);
  return STATUS_OK;
}

/* ---- the command ------------------------------------------------------------------------- */

static int run_vanishing(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  double up[3] = {0, 1, 0}, grid[2] = {0, 0};
  if (v[V_FROM].given)
    return run_inverse(arguments, context);
  if (arguments->operand_count != 1)
    return report_usage("camera vanishing takes one FILE, or --from and points");
  if (v[V_UP].given && (!parse_numbers(v[V_UP].text, 3, up) || !(vector_dot(up, up) > 0.0)))
    return report_usage("--up \"%s\": a direction is x,y,z", v[V_UP].text);
  if (v[V_OVERLAY].given != v[V_OUT].given)
    return report_usage("--overlay IMAGE and -o RESULT go together");
  if (v[V_GRID].given && !parse_numbers(v[V_GRID].text, 2, grid) &&
      !parse_numbers(v[V_GRID].text, 1, grid))
    return report_usage("--grid takes SPACING or SPACING,HEIGHT");
  if (v[V_GRID].given && !(grid[0] > 0.0))
    return report_usage("--grid: the spacing must be above zero");
  vector_normalize(up);
  vlCameraRecord record;
  vlCamera camera;
  const char *path = arguments->operands[0];
  TRY(camera_load_made(context, path, arguments, V_FRAME, V_SIZE, &record, &camera));
  if (v[V_OVERLAY].given) {
    Drawing drawing = {up, (int)option_count(&v[V_LINES], 24), grid[0], grid[1]};
    TRY(draw_overlay(context, arguments, &camera, &drawing));
  }
  vlVanishingPoints points;
  vl_camera_vanishing_points(&camera, up, &points);
  if (v[V_JSON].given)
    say_json(path, &camera, &points);
  else
    say_text(&camera, &points);
  return STATUS_OK;
}

static Option vanishing_options[] = {
    JSON_OPTION(V_JSON),
    CAMERA_FRAME_OPTION(V_FRAME),
    {V_UP, "up",
     "up direction: the horizon is that of the planes perpendicular to it; default 0,1,0",
     OPTION_TEXT, "x,y,z"},
    {V_OVERLAY, "overlay", "draw vanishing points, lines and horizon over this image; needs -o",
     OPTION_TEXT, "IMAGE"},
    {V_OUT, "output", "file to write: the drawing (.png .jpg .tga); with --from: a camera file",
     OPTION_TEXT, "RESULT", .letter = 'o'},
    {V_LINES, "lines",
     "number of planes with lines to each vanishing point, 0 to 360; default 24",
     OPTION_INTEGER, "N", 0, 360},
    {V_GRID, "grid",
     "also draw a grid on the ground plane, with this spacing, at this height along the up "
     "direction",
     OPTION_TEXT, "SPACING[,HEIGHT]"},
    {V_FROM, "from", "compute the camera that has these vanishing points, in pixels",
     OPTION_TEXT, "x1,y1 x2,y2 [x3,y3]"},
    {V_PRINCIPAL, "principal",
     "with --from: the camera's principal point; default with two points: the centre of the "
     "image",
     OPTION_TEXT, "cx,cy"},
    {V_SIZE, "size", "image size for --from, or for a FILE without one", OPTION_SIZE, "WxH", 1,
     1 << 24},
    {V_AXES, "axes",
     "with --from: the axes to which the points belong, with - before an axis for its "
     "negative end: xz (default of two points), xyz (of three), -zx, ...",
     OPTION_TEXT, "AXES"},
    {V_TO, "to", "with --from: dialect of RESULT; default: by its name:", OPTION_KIND,
     "DIALECT", .choices = dialects},
    {0}};

const Command camera_vanishing_command = {
    .name = "camera vanishing",
    .usage = "FILE | --from x1,y1 x2,y2 [x3,y3] --size WxH [options]",
    .summary = "compute vanishing points, or a camera from them",
    .text =
        "Prints the vanishing points of the world's axes in the image of FILE's camera (a "
        "camera file of any\n"
        "dialect, or a scene), in pixels from the image's corner, and the horizon. --overlay "
        "draws them: lines\n"
        "along x red, y green, z blue, the horizon yellow. With --from, computes focal "
        "length, principal point\n"
        "and rotation from two vanishing points and a known principal point, or from three "
        "vanishing points.",
    .examples =
        "velo camera vanishing room.pbrt\n"
        "velo camera vanishing --from 10,200 900,210 --size 640x480",
    .options = vanishing_options,
    .optional_operands = 2,
    .context = CONTEXT_ONE,
    .run = run_vanishing,
};
