/* camera/camera.c: see camera.h. Also `velo camera convert`. */
#include "camera/camera.h"

#include <math.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "cli/vector.h"
#include "image/header.h"
#include "image/image.h"
#include "render/output_names.h"
#include "render/scene_options.h"
#include "velo/load.h"
#include "velo/render.h"

const Choice dialects[] = {{"dialects", 0}, {0}};

bool camera_is_scene(const char *path) {
  return text_ends_with(path, ".pbrt") || text_ends_with(path, ".pbrt.gz");
}

static int load_scene_camera(vlContext *context, const char *path, vlCameraRecord *record) {
  vlScene *scene = NULL;
  vlError error = {0};
  vlLoadDef load = vl_default_load_def();
  vlResult result = scene_read(context, path, &load, &scene, &error);
  if (result == VL_OK) {
    const vlSceneDefs *from = vl_scene_defs(scene);
    *record = (vlCameraRecord){
        .camera = from->camera, .dialect = VL_CAMERA_DIALECT_PBRT, .frames = 1};
  }
  int status = report_error(&error, result, path);
  /* the camera points to objects of its scene, which are freed with the scene */
  if (status < 0 && record->camera.lens.optics)
    status = report_failure(STATUS_SCENE,
                            "%s: a lens of many elements is a camera of its scene alone", path);
  if (status < 0 && record->camera.lens.aperture) {
    report_note("%s: the image of the lens's opening is left out", path);
    record->camera.lens.aperture = NULL;
  }
  vl_scene_destroy(scene);
  return status;
}

/* Reads the camera from the header of an image that velo rendered. */
static int load_image_camera(vlContext *context, const char *path, vlCameraRecord *record) {
  vlImage *image = NULL;
  *record = (vlCameraRecord){.dialect = VL_CAMERA_DIALECT_EXR, .frames = 1};
  int status = image_load(context, path, &image);
  if (status < 0)
    status = header_camera_def(image, path, &record->camera);
  vl_image_destroy(image);
  return status;
}

static int has_size(const char *path) {
  return report_usage("%s has an image size of its own; --size is for files that have none",
                      path);
}

void camera_note_unread(const char *path, const vlCameraRecord *record) {
  char line[16] = "", more[32] = "";
  if (!record || record->unread == 0)
    return;
  if (record->unread_line)
    text_set(line, ":%u", record->unread_line);
  if (record->unread > VL_UNREAD_NAMES)
    text_set(more, " and %u more", record->unread - VL_UNREAD_NAMES);
  report_note("%s%s: not understood and without effect: %s%s", path, line, record->unread_names,
              more);
}

int camera_load(vlContext *context, const char *path, int dialect, const char *frame,
                const OptionValue *size, const OptionValue *fallback, vlCameraRecord *record) {
  bool sized = size && size->given;
  if (dialect == VL_CAMERA_DIALECT_EXR || (!dialect && text_ends_with(path, ".exr")))
    return sized ? has_size(path) : load_image_camera(context, path, record);
  if (dialect == VL_CAMERA_DIALECT_PBRT || (!dialect && camera_is_scene(path)))
    return sized ? has_size(path) : load_scene_camera(context, path, record);
  vlError error = {0};
  vlCameraFileDef def = vl_default_camera_file_def();
  def.dialect = (vlCameraDialect)dialect;
  def.frame = frame;
  if (fallback)
    option_size(fallback, &def.width, &def.height);
  if (size)
    option_size(size, &def.width, &def.height);
  TRY(report_error(&error, vl_camera_read(context, path, &def, record, &error), path));
  if (sized && (record->camera.width != def.width || record->camera.height != def.height))
    return report_usage(
        "%s says %u x %u pixels, --size %u x %u; --size is for files that have none", path,
        record->camera.width, record->camera.height, def.width, def.height);
  if (record->size_assumed)
    report_note("%s: names no image size; %u x %u is taken", path, record->camera.width,
                record->camera.height);
  camera_note_unread(path, record);
  if (record->frames > 1 && !frame)
    report_note("%s: the first of %u cameras is taken (%s)", path, record->frames,
                record->name[0] ? record->name : "no name");
  return -1;
}

int camera_load_made(vlContext *context, const char *path, const Arguments *arguments,
                     int frame_option, int size_option, vlCameraRecord *record,
                     vlCamera *camera) {
  const OptionValue *frame = &arguments->values[frame_option];
  TRY(camera_load(context, path, 0, frame->given ? frame->text : NULL,
                  &arguments->values[size_option], NULL, record));
  const char *warning = NULL;
  vlError error = {0};
  vlResult result = vl_camera_make(&record->camera, camera, &warning, &error);
  if (result != VL_OK)
    return report_failure(STATUS_SCENE, "%s: %s", path, error.message);
  if (warning && camera->outside > 0.0)
    report_warning("%s: %s (%.3g%% of the image)", path, warning, 100.0 * camera->outside);
  else if (warning)
    report_warning("%s: %s", path, warning);
  return -1;
}

enum { CONVERT_FROM, CONVERT_TO, CONVERT_FRAME, CONVERT_DROP, CONVERT_SIZE };

double camera_angle(const vlCamera *c, double x0, double y0, double x1, double y1) {
  double o[3], a[3], b[3];
  if (!vl_camera_unproject(c, x0, y0, o, a) || !vl_camera_unproject(c, x1, y1, o, b))
    return NAN;
  return vector_angle(a, b);
}

static int run_convert(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  const char *in = arguments->operands[0], *out = arguments->operands[1];
  vlCameraRecord record;
  TRY(camera_load(context, in, (int)v[CONVERT_FROM].integer, v[CONVERT_FRAME].text,
                  &v[CONVERT_SIZE], NULL, &record));
  vlCameraFileDef def = vl_default_camera_file_def();
  def.dialect = (vlCameraDialect)option_count(&v[CONVERT_TO], VL_CAMERA_DIALECT_AUTO);
  /* each file of a folder is checked when it is written */
  if (!vl_camera_writes_folder(out, def.dialect))
    TRY(output_check(context, out, VL_OUTPUT_PLAIN));
  def.drop = arguments->texts;
  def.drop_count = (uint32_t)arguments->text_count;
  vlError error = {0};
  vlResult result = vl_camera_write(context, out, &def, &record, &error);
  if (result != VL_ERROR_ARGUMENT)
    return report_finish(&error, result, out);
  if (strncmp(error.message, "camera: ", 8) == 0)
    return report_failure(STATUS_SCENE, "%s: %s", in, error.message);
  const bool guessed =
      def.dialect == VL_CAMERA_DIALECT_AUTO && !strstr(error.message, ": drop: ");
  return report_usage("%s%s", error.message, guessed ? "; give --to DIALECT" : "");
}

static Option convert_options[] = {
    {CONVERT_FROM, "from", "dialect of IN; default: recognised by its content:", OPTION_KIND,
     "DIALECT", .choices = dialects},
    {CONVERT_TO, "to",
     "dialect of OUT; default: .json velo, .yaml opencv, .gltf gltf, .xml mitsuba, .usda usd, "
     ".pbrt pbrt, transforms.json nerf, cameras.txt colmap:",
     OPTION_KIND, "DIALECT", .choices = dialects},
    {CONVERT_FRAME, "frame", "camera of IN to use, by name or number from 0, if it has several",
     OPTION_TEXT, "NAME"},
    CAMERA_SIZE_OPTION(CONVERT_SIZE),
    {CONVERT_DROP, "drop",
     "leave out a field that OUT's dialect cannot hold, or all of them; may be given several times",
     OPTION_TEXTS, "FIELD"},
    {0}};

const Command camera_convert_command = {
    .name = "camera convert",
    .usage = "IN OUT [options]",
    .summary = "convert a camera file to another tool's format",
    .text =
        "Reads the camera IN and writes it as OUT. Pixel origin and axes are converted. A "
        "field that OUT's\n"
        "dialect cannot hold is an error that names it (--drop leaves it out).",
    .examples =
        "velo camera convert camera.yaml camera.json\n"
        "velo camera convert room.pbrt camera.yaml",
    .options = convert_options,
    .operands = 2,
    .context = CONTEXT_ONE,
    .run = run_convert,
};
