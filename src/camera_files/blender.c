/* camera_files/blender.c: a Blender camera as JSON, with Blender's own property names:
 * bpy.types.Camera (type, lens, sensor_width, sensor_height, sensor_fit, shift_x, shift_y,
 * ortho_scale, clip_start, clip_end), the object's matrix_world, RenderSettings (resolution_x,
 * resolution_y, pixel_aspect_x, pixel_aspect_y). Axes x right, y up, z back. shift is in units
 * of the side that the sensor is fitted to: +0.1 moves the principal point left, and down. */
#include <math.h>

#include "base/text.h"
#include "camera_files/fields.h"

static vlResult read_blender(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double percentage = 100.0, lens = 50.0, sensor_width = 36.0, sensor_height = 24.0,
         shift_x = 0.0, shift_y = 0.0, ortho = 6.0;
  double aspect_x = 1.0, aspect_y = 1.0, m[16];
  const char *type = vl_camera_text(tree, "type"), *fit = vl_camera_text(tree, "sensor_fit");
  bool flat = vl_text_is(type, "ORTHO");
  if (type && !flat && !vl_text_is(type, "PERSP"))
    return vl_camera_unknown(file, tree, "type", type, "there are PERSP, ORTHO");
  if (fit && !vl_has_word("AUTO HORIZONTAL VERTICAL", fit))
    return vl_camera_unknown(file, tree, "sensor_fit", fit,
                             "there are AUTO, HORIZONTAL, VERTICAL");
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_SIDE("resolution_x", &d->width),
                        VL_FIELD_SIDE("resolution_y", &d->height)));
  VL_TRY(flat ? vl_camera_number(file, tree, "ortho_scale", &ortho)
              : vl_camera_number(file, tree, "lens", &lens));
  VL_TRY(VL_READ_FIELDS(
      file, tree, VL_FIELD_OPTIONAL("sensor_width", &sensor_width),
      VL_FIELD_OPTIONAL("sensor_height", &sensor_height),
      VL_FIELD_OPTIONAL("resolution_percentage", &percentage),
      VL_FIELD_OPTIONAL("shift_x", &shift_x), VL_FIELD_OPTIONAL("shift_y", &shift_y),
      VL_FIELD_OPTIONAL("pixel_aspect_x", &aspect_x),
      VL_FIELD_OPTIONAL("pixel_aspect_y", &aspect_y),
      VL_FIELD_OPTIONAL("clip_start", &d->near_plane),
      VL_FIELD_OPTIONAL("clip_end", &d->far_plane), VL_FIELD_LIST("matrix_world", m, 16)));
  if (!(lens > 0.0 && sensor_width > 0.0 && sensor_height > 0.0 && ortho > 0.0 &&
        aspect_x > 0.0 && aspect_y > 0.0))
    return vl_camera_wrong(file,
                           "blender: lens, sensor, scale and pixel aspect must be above zero");
  if (percentage != 100.0)
    return vl_camera_wrong_in(
        file, tree, "resolution_percentage",
        "blender: \"resolution_percentage\" must be 100; give the image's "
        "own resolution_x, resolution_y");
  double ratio = aspect_y / aspect_x, w = d->width, h = d->height;
  bool vertical = vl_text_is(fit, "VERTICAL");
  bool across = fit && !vl_text_is(fit, "AUTO") ? !vertical : w >= ratio * h;
  /* the side that the sensor is fitted to, in pixel widths */
  double side = across ? w : ratio * h;
  d->fx = flat ? side / ortho : lens / (vertical ? sensor_height : sensor_width) * side;
  d->fy = d->fx / ratio;
  d->cx = 0.5 * w - shift_x * side;
  d->cy = 0.5 * h + shift_y * side / ratio;
  d->projection = flat ? VL_PROJECTION_ORTHOGRAPHIC : VL_PROJECTION_PERSPECTIVE;
  vl_camera_set_flipped(d, m);
  vl_camera_name(record, vl_camera_text(tree, "name"));
  return VL_OK;
}

static vlResult write_blender(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCameraDef *d = &fit->record->camera;
  const vlCamera *c = &fit->camera;
  const bool flat = d->projection == VL_PROJECTION_ORTHOGRAPHIC;
  /* Blender requires that the smaller of the two aspects is 1 */
  const double ratio = c->fx / c->fy, w = c->width, h = c->height;
  const double side = w >= ratio * h ? w : ratio * h;
  const double sensor = d->sensor_width_mm > 0.0 ? d->sensor_width_mm : 36.0;
  const double lens = flat ? side / c->fx : c->fx * sensor / side;
  const double shift[2] = {(0.5 * w - c->cx) / side, (c->cy - 0.5 * h) * ratio / side};
  const double aspect[2] = {ratio < 1.0 ? 1.0 / ratio : 1.0, ratio < 1.0 ? 1.0 : ratio};
  return VL_PUT_FORM(text, fit,
                     "{\n"
                     "  \"name\": $name,\n"
                     "  \"type\": \"$type\",\n"
                     "  \"$kind\": $lens,\n"
                     "  \"sensor_fit\": \"AUTO\",\n"
                     "  \"sensor_width\": $sensor,\n"
                     "  \"shift_x\": $shift@0,\n"
                     "  \"shift_y\": $shift@1,\n"
                     "$start$end  \"resolution_x\": $width,\n"
                     "  \"resolution_y\": $height,\n"
                     "  \"pixel_aspect_x\": $pixel@0,\n"
                     "  \"pixel_aspect_y\": $pixel@1,\n"
                     "  \"matrix_world\": [$flipped:4]\n"
                     "}\n",
                     VL_WORD("type", flat ? "ORTHO" : "PERSP"),
                     VL_WORD("kind", flat ? "ortho_scale" : "lens"),
                     VL_VALUES("lens", &lens, 1), VL_VALUES("sensor", &sensor, 1),
                     VL_VALUES("shift", shift, 2), VL_VALUES("pixel", aspect, 2),
                     VL_PART("start", c->near_plane > 0.0, "  \"clip_start\": $near,\n"),
                     VL_PART("end", !isinf(c->far_plane), "  \"clip_end\": $far,\n"));
}

const vlCameraFormat vl_format_blender = {
    .name = "blender",
    .marks = "matrix_world sensor_fit lens",
    .one_mark = true,
    .known =
        "name type lens lens_unit sensor_fit sensor_width sensor_height shift_x shift_y ortho_scale "
        "clip_start clip_end matrix_world resolution_x resolution_y resolution_percentage "
        "pixel_aspect_x pixel_aspect_y",
    .geometry = "use_border use_crop_to_border",
    .read = read_blender,
    .holds = VL_HOLDS_POSE | VL_HOLDS_PLANES,
    .plain = true,
    .unnamed = "Camera",
    .write = write_blender};
