/* camera/draw.c: `velo camera draw`: a camera seen from outside, as drawings of perspective
 * show it. */
#include "camera/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "camera/poses.h"
#include "camera/scene_world.h"
#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/lens_options.h"
#include "render/needs.h"

/* Options of this command, behind those of `velo render`, of which it has some. */
enum {
  DRAW_OUT = RENDER_OPTIONS,
  DRAW_SIZE,
  DRAW_FROM,
  DRAW_ZOOM,
  DRAW_POINT,
  DRAW_PLANE,
  DRAW_REACH,
  DRAW_GRID,
  DRAW_NEAR,
  DRAW_FAR,
  DRAW_PARTS,
  DRAW_EMPTY,
  DRAW_BLANK,
  DRAW_OPTIONS
};
_Static_assert((int)DRAW_OPTIONS <= (int)MAX_OPTIONS,
               "Arguments.values has no room for an option");

enum { DEFAULT_POINTS = 2 };

typedef struct State {
  SceneWorld in;
  vlCamera *cameras;
  uint32_t count;
  Seen seen;
  double points[3 * MAX_TEXTS];
  vlDrawingDef def;
  vlDrawing *drawing;
  OutsideDef view;
  Outside outside;
} State;

static int parse_parts(const char *text, uint32_t *parts) {
#define NAME(part, name) #name,
  static const char *const names[] = {VL_DRAWING_PARTS(NAME)};
#undef NAME
  enum { PARTS = LENGTH(names) };
  *parts = 0;
  while (*text) {
    size_t length = strcspn(text, ",");
    int found = -1;
    for (int i = 0; i < PARTS; i++)
      if (strlen(names[i]) == length && strncmp(text, names[i], length) == 0)
        found = i;
    if (found < 0) {
      char word[32] = "";
      memcpy(word, text, length < sizeof word - 1 ? length : sizeof word - 1);
      return report_usage("--parts: \"%s\" is no part of the drawing%s", word,
                          did_you_mean("", word, names, PARTS));
    }
    *parts |= 1u << found;
    text += length + (text[length] == ',');
  }
  return -1;
}

/* ---- options ----------------------------------------------------------------------------- */

static int read_options(State *s, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  if (!v[DRAW_OUT].given)
    return report_usage("-o FILE is needed");
  TRY(output_check_drawing(v[DRAW_OUT].text));
  s->view = (OutsideDef){
      .azimuth = 130, .elevation = 20, .zoom = 1, .width = 960, .height = 640, .spp = 32};
  s->view.exposure = VL_UNSET;
  s->view.scene = !v[DRAW_EMPTY].given;
  s->view.own_image = s->view.scene && !v[DRAW_BLANK].given && !v[RENDER_TRAJECTORY].given;
  option_size(&v[DRAW_SIZE], &s->view.width, &s->view.height);
  double from[2];
  if (v[DRAW_FROM].given) {
    if (!parse_numbers(v[DRAW_FROM].text, 2, from) || fabs(from[0]) > 360 || fabs(from[1]) > 89)
      return report_usage(
          "--from \"%s\": azimuth and elevation in degrees, the elevation within 89",
          v[DRAW_FROM].text);
    s->view.azimuth = from[0];
    s->view.elevation = from[1];
  }
  if (v[DRAW_ZOOM].given)
    s->view.zoom = v[DRAW_ZOOM].number;
  s->view.spp = option_count(&v[RENDER_SPP], s->view.spp);
  if (v[RENDER_EXPOSURE].given && !parse_numbers(v[RENDER_EXPOSURE].text, 1, &s->view.exposure))
    return report_usage("--exposure \"%s\": must be a number", v[RENDER_EXPOSURE].text);
  s->def = vl_default_drawing_def();
  s->def.grid = option_count(&v[DRAW_GRID], s->def.grid);
  if (v[DRAW_PARTS].given)
    TRY(parse_parts(v[DRAW_PARTS].text, &s->def.parts));
  for (int i = 0; i < arguments->text_count; i++)
    if (!parse_numbers(arguments->texts[i], 3, s->points + 3 * i))
      return report_usage("--point \"%s\": a point is x,y,z", arguments->texts[i]);
  s->def.points = s->points;
  s->def.point_count = (uint32_t)arguments->text_count;
  if (v[DRAW_NEAR].given && v[DRAW_FAR].given && !(v[DRAW_NEAR].number < v[DRAW_FAR].number))
    return report_usage("--near %g is not before --far %g", v[DRAW_NEAR].number,
                        v[DRAW_FAR].number);
  return -1;
}

/* ---- the cameras ------------------------------------------------------------------------- */

static int load(State *s, vlContext *context, const Arguments *arguments) {
  const char *path = arguments->operands[0];
  const OptionValue *v = arguments->values;
  vlError error = {0};
  TRY(scene_world_open(&s->in, context, arguments));
  if (v[RENDER_TRAJECTORY].given)
    return report_error(&error,
                        poses_load(s->in.context, v[RENDER_TRAJECTORY].text, &s->in.job.camera,
                                   &s->cameras, &s->count, &error),
                        v[RENDER_TRAJECTORY].text);
  if (v[DRAW_NEAR].given)
    s->in.job.camera.near_plane = v[DRAW_NEAR].number;
  if (v[DRAW_FAR].given)
    s->in.job.camera.far_plane = v[DRAW_FAR].number;
  s->cameras = malloc(sizeof *s->cameras);
  if (!s->cameras)
    return report_reason(VL_ERROR_MEMORY, path, "cameras");
  s->cameras[s->count++] = s->in.job.camera;
  return -1;
}

/* ---- what is drawn ----------------------------------------------------------------------- */

/* Two of the seen points, above and below the middle of the image, and none far behind the
 * others. */
static void choose_points(State *s) {
  static const double targets[DEFAULT_POINTS][2] = {{0.4, 0.36}, {0.62, 0.6}};
  const Seen *seen = &s->seen;
  for (int k = 0; k < DEFAULT_POINTS; k++) {
    uint32_t best = 0;
    double min = INFINITY;
    for (uint32_t i = 0; i < seen->count; i++) {
      double d =
          hypot(seen->pixels[2 * i] - targets[k][0], seen->pixels[2 * i + 1] - targets[k][1]);
      d += 2 * fmax(0, seen->depths[i] / seen->middle - 1);
      if (d < min) {
        min = d;
        best = i;
      }
    }
    if (!(min < INFINITY))
      return;
    memcpy(s->points + 3 * k, seen->points + 3 * (size_t)best, 3 * sizeof(double));
    s->def.point_count = (uint32_t)k + 1;
  }
}

/* Distances in the drawing: the lecture's d where the view plane then stands before what the
 * camera sees; else less than half of the way. */
static void choose_distances(State *s, const OptionValue *v) {
  const Seen *seen = &s->seen;
  const vlCamera *c = &s->cameras[0];
  double nearest = seen->count ? seen->near : 1, d = s->in.job.defs->camera.view_distance;
  double far = c->far_plane < 1e30 ? c->far_plane : INFINITY;
  bool flat =
      c->projection == VL_PROJECTION_PERSPECTIVE || c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  s->def.plane = d > 0 && d < 0.8 * nearest
                     ? d
                     : 0.45 * fmin(flat || !seen->count ? nearest : seen->middle, far);
  s->def.reach = seen->count ? fmin(1.02 * seen->far, 1.3 * seen->middle) : 2 * s->def.plane;
  double small = s->count > 1 ? poses_plane(s->cameras, s->count) : 0;
  if (small > 0)
    s->def.plane = small;
  if (v[DRAW_PLANE].given)
    s->def.plane = v[DRAW_PLANE].number;
  if (v[DRAW_REACH].given)
    s->def.reach = v[DRAW_REACH].number;
}

static int draw(State *s, const OptionValue *v) {
  vlError error = {0};
  TRY(report_error(&error, draw_look(s->in.world, &s->cameras[0], &s->seen, &error),
                   s->in.job.path));
  choose_distances(s, v);
  if (s->def.point_count == 0 && s->count == 1)
    choose_points(s);
  vlResult result =
      vl_camera_outline(s->in.context, s->cameras, s->count, &s->def, &s->drawing, &error);
  if (result == VL_OK)
    result =
        draw_choose_view(&s->cameras[0], s->drawing, &s->seen, &s->view, &s->outside, &error);
  if (result == VL_OK)
    result = draw_render(s->in.context, s->in.world, s->in.job.defs, &s->view, &s->cameras[0],
                         s->drawing, &s->outside, &error);
  TRY(report_error(&error, result, s->in.job.path));
  Overlay overlay = {0};
  result = VL_ERROR_MEMORY;
  if (overlay_begin(&overlay, s->outside.image)) {
    draw_paint(&overlay, &s->outside, s->drawing);
    result = overlay_write(&overlay, s->in.context, v[DRAW_OUT].text, &error);
  }
  overlay_end(&overlay);
  return report_finish(&error, result, v[DRAW_OUT].text);
}

static int run_draw(const Arguments *arguments, vlContext *context) {
  State s;
  memset(&s, 0, sizeof s);
  int status = read_options(&s, arguments);
  if (status < 0)
    status = load(&s, context, arguments);
  if (status < 0)
    status = output_check(s.in.context, arguments->values[DRAW_OUT].text, VL_OUTPUT_PLAIN);
  if (status < 0)
    status = draw(&s, arguments->values);
  draw_close(&s.outside);
  draw_forget(&s.seen);
  vl_drawing_destroy(s.drawing);
  free(s.cameras);
  scene_world_close(&s.in);
  return status;
}

static Option draw_options[] = {
    {DRAW_OUT, "output", "image file to write: .png .jpg .tga", OPTION_TEXT, "FILE",
     .letter = 'o'},
    {DRAW_SIZE, "size", "size of the drawing in pixels; default 960x640", OPTION_SIZE, "WxH",
     16, 16384},
    {DRAW_FROM, "from",
     "where the drawing is seen from, in degrees: to the right of the camera's view "
     "direction, above the horizon; default 130,20",
     OPTION_TEXT, "AZIMUTH,ELEVATION"},
    {DRAW_ZOOM, "zoom", "factor on the size of what is drawn; 1: it fills the image",
     OPTION_NUMBER, "X", 1e-3, 1e3},
    {DRAW_PARTS, "parts",
     "parts that are drawn, separated by commas: eye, window, grid, volume, near, far, axes, "
     "distance, focus, projector, film (behind the eye), path; default: all but film",
     OPTION_TEXT, "LIST"},
    {DRAW_POINT, "point",
     "point whose projector is drawn; may be given several times. Default: two visible points",
     OPTION_TEXTS, "x,y,z"},
    {DRAW_PLANE, "plane",
     "distance of the view plane (of fisheyes and panoramas: of a sphere) from the eye; "
     "default: the camera's d, if the plane is then before what the camera sees",
     OPTION_NUMBER, "D", 1e-30, 1e30},
    {DRAW_REACH, "reach",
     "distance at which the view volume ends; default: behind what is seen", OPTION_NUMBER, "D",
     1e-30, 1e30},
    {DRAW_GRID, "grid",
     "largest number of lines between pixels in each direction; 0: none; default 16",
     OPTION_INTEGER, "N", 0, 65536},
    {DRAW_NEAR, "near", "near clipping plane; default: the camera's", OPTION_NUMBER, "D", 1e-30,
     1e30},
    {DRAW_FAR, "far", "far clipping plane; default: the camera's", OPTION_NUMBER, "D", 1e-30,
     1e30},
    {DRAW_EMPTY, "no-scene", "draw on a white sheet, without the scene"},
    {DRAW_BLANK, "no-image", "leave view plane and film empty, without the camera's image"},
    {RENDER_SPP, "spp", "samples per pixel of the scene, which is then denoised; default 32",
     OPTION_INTEGER, "N", 2, 1 << 24},
    {RENDER_EXPOSURE, .help = "exposure of the scene in stops; default: metered"},
    {RENDER_CAMERA, .help = "scene or camera file that gives the camera"},
    {RENDER_FRAME},
    {RENDER_RESOLUTION, "resolution", "image size of the camera in pixels", OPTION_SIZE, "WxH",
     1, 65536},
    {RENDER_TRAJECTORY,
     .help =
         "draw the cameras of this trajectory or rig instead, with the line through their eyes; at "
         "most 200 of them"},
    {RENDER_SEARCH},
    STRICT_OPTIONS_OPTION,
    {0}};

static const Section draw_sections[] = {{DRAW_OUT, "the drawing"},
                                        {DRAW_PARTS, "what is drawn"},
                                        {RENDER_SPP, "scene and camera"},
                                        {0}};

const Command camera_draw_command = {
    .name = "camera draw",
    .usage = "SCENE -o FILE [options]",
    .summary = "draw a camera from outside: eye, view plane, pyramid",
    .text =
        "Renders the scene small, from outside, and draws the scene's camera over it: the "
        "eye, the view plane\n"
        "with its grid of pixels, the view volume with near and far planes, the axes u v w, "
        "projectors from\n"
        "points to their images, the plane in focus. Fisheyes and distorted lenses show their "
        "true rays. Lines\n"
        "behind the scene are faint and dashed (docs/draw.md).",
    .examples =
        "velo camera draw room.pbrt -o outside.png\n"
        "velo camera draw room.pbrt --near 1 --far 6 --from 90,10 -o frustum.png",
    .options = draw_options,
    .sections = draw_sections,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run_draw,
};
