/* camera/info.c: `velo camera info`: the equivalent descriptions of one camera. */
#include <math.h>
#include <stdio.h>

#include "camera/camera.h"
#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"

enum { INFO_JSON, INFO_FRAME, INFO_SIZE };

static const double degrees = 180.0 / M_PI;

/* Angle between two opposite edges of the image. It is the sum of the angles between each edge
 * and the principal point, so it can exceed 180 degrees. NaN: an edge has no ray. */
static double field(const vlCamera *c, double x0, double y0, double x1, double y1) {
  return camera_angle(c, x0, y0, c->cx, c->cy) + camera_angle(c, c->cx, c->cy, x1, y1);
}

typedef struct Info {
  double horizontal, vertical, diagonal; /* radians */
  double solid_angle, footprint;
} Info;

static Info measure(const vlCamera *c) {
  double w = c->width, h = c->height;
  Info info = {.horizontal = field(c, 0, c->cy, w, c->cy),
               .vertical = field(c, c->cx, 0, c->cx, h),
               .diagonal = camera_angle(c, 0, 0, w, h),
               .solid_angle = camera_image_angle(c)};
  if (c->projection != VL_PROJECTION_PERSPECTIVE)
    info.diagonal = field(c, 0, 0, w, h);
  info.footprint = sqrt(vl_camera_solid_angle(c, c->cx, c->cy));
  if (c->projection == VL_PROJECTION_ORTHOGRAPHIC)
    info.footprint = 1.0 / sqrt(c->fx * c->fy);
  return info;
}

static void print_json(const char *path, const vlCameraRecord *record, const vlCamera *c,
                       const Info *info) {
  Json *json = json_open();
  bool flat = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  double sensor = record->camera.sensor_width_mm > 0 ? record->camera.sensor_width_mm : 36.0;
  json_put(json, "file %s, dialect %s", path, vl_camera_dialect_name(record->dialect));
  if (record->name[0])
    json_text(json, "name", record->name);
  json_put(json, "projection %s, pixel_origin %s, axes %s, width %u, height %u",
           vl_projection_name(c->projection), "corner", "x right, y down, z forward", c->width,
           c->height);
  json_put(json, "fx %g, fy %g, skew %g, cx %g, cy %g", c->fx, c->fy, c->skew, c->cx, c->cy);
  if (!flat) {
    json_put(
        json,
        "fov_horizontal %g, fov_vertical %g, fov_diagonal %g, view_distance %g, pixel_size %g",
        info->horizontal * degrees, info->vertical * degrees, info->diagonal * degrees, c->fx,
        1.0);
    json_put(json, "zoom %g, focal_mm %g, sensor_width_mm %g, solid_angle %g", 1.0,
             c->fx * sensor / c->width, sensor, info->solid_angle);
  }
  json_put(json, "pixel_footprint %g, outside %g", info->footprint, c->outside);
  json_numbers(json, "world_from_camera", c->world_from_camera, 16);
  json_close(json);
}

static void print_fov(const char *name, double radians) {
  if (radians == radians)
    printf("  %-12s %.10g degrees\n", name, radians * degrees);
  else
    printf("  %-12s its edges see nothing\n", name);
}

static void print_text(const char *path, const vlCameraRecord *record, const vlCamera *c,
                       const Info *info) {
  bool flat = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  double sensor = record->camera.sensor_width_mm > 0 ? record->camera.sensor_width_mm : 36.0;
  const double *m = c->world_from_camera;
  printf("file          %s (%s)\nprojection    %s\nsize          %u x %u\n", path,
         vl_camera_dialect_name(record->dialect), vl_projection_name(c->projection), c->width,
         c->height);
  printf("f in pixels   %.10g, %.10g; skew %.10g\n", c->fx, c->fy, c->skew);
  printf(
      "axis at       %.10g, %.10g from the image's corner; %.10g, %.10g from the first pixel's "
      "centre\n",
      c->cx, c->cy, c->cx - 0.5, c->cy - 0.5);
  if (!flat) {
    printf("field of view\n");
    print_fov("horizontal", info->horizontal);
    print_fov("vertical", info->vertical);
    print_fov("diagonal", info->diagonal);
    printf("lecture       d %.10g, zoom 1, pixel size s 1\n", c->fx);
    printf("in mm         f %.10g on a sensor %.10g wide\n", c->fx * sensor / c->width, sensor);
    printf("solid angle   %.8g steradians\n", info->solid_angle);
    printf("pixel         %.8g radians at the axis: so much at distance 1\n", info->footprint);
  } else {
    printf("pixel         %.10g scene units\n", info->footprint);
  }
  if (c->outside > 0.0)
    printf("outside       %.4g%% of the image sees nothing\n", 100.0 * c->outside);
  printf("eye           %.10g %.10g %.10g\n", m[3], m[7], m[11]);
  printf("looks along   %.10g %.10g %.10g\nup            %.10g %.10g %.10g\n", m[2], m[6],
         m[10], 0.0 - m[1], 0.0 - m[5], 0.0 - m[9]);
}

static int run_info(const Arguments *arguments, vlContext *context) {
  vlCameraRecord record;
  vlCamera camera;
  const char *path = arguments->operands[0];
  TRY(camera_load_made(context, path, arguments, INFO_FRAME, INFO_SIZE, &record, &camera));
  const Info info = measure(&camera);
  const bool json = arguments->values[INFO_JSON].given;
  (json ? print_json : print_text)(path, &record, &camera, &info);
  return STATUS_OK;
}

static Option info_options[] = {JSON_OPTION(INFO_JSON),
                                CAMERA_FRAME_OPTION(INFO_FRAME),
                                CAMERA_SIZE_OPTION(INFO_SIZE),
                                {0}};

const Command camera_info_command = {
    .name = "camera info",
    .usage = "FILE [options]",
    .summary = "print all equivalent parameters of a camera",
    .text =
        "FILE is a camera file in any dialect of `velo camera convert`, or a scene. If it "
        "gives no sensor width,\n"
        "a width of 36 mm is assumed.",
    .examples = "velo camera info camera.yaml\nvelo camera info --json room.pbrt",
    .options = info_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_info,
};
