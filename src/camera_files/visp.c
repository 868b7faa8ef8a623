/* camera_files/visp.c: ViSP's camera XML: <root> with cameras, each with an image size and
 * models. Camera axes: x right, y down, z forward. There is no pose. The first pixel's centre
 * is (0, 0). The distortion kud maps the ideal point to the distorted one and equals OpenCV's
 * k1. kdu, the inverse, is not used. k1 to k4 of Kannala-Brandt are those of OpenCV's fisheye
 * model; ViSP writes a k5 and does not use it. */

#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/distortion.h"

static const char with_distortion[] = "perspectiveProjWithDistortion";
static const char without_distortion[] = "perspectiveProjWithoutDistortion";
static const char kannala_brandt[] = "ProjWithKannalaBrandtDistortion";

/* Copies the text of a child without the blanks around it; "" if there is no such child. */
static void child_text(const json_t *element, const char *tag, char text[64]) {
  const char *from = vl_camera_text(vl_camera_child(element, tag), "$");
  text[0] = 0;
  if (!from)
    return;
  from += strspn(from, " \t\r\n\"");
  size_t length = strcspn(from, " \t\r\n\"");
  if (length > 63)
    length = 63;
  memcpy(text, from, length);
  text[length] = 0;
}

static vlResult read_model(const vlCameraFile *file, const json_t *model, vlCameraDef *d) {
  static const char *const names[] = {"px", "py", "u0", "v0"}, *const radial[] = {"k1", "k2",
                                                                                  "k3", "k4"};
  double f[4], k[4];
  char type[64];
  child_text(model, "type", type);
  for (int i = 0; i < 4; i++)
    VL_TRY(vl_camera_child_number(file, model, names[i], true, &f[i]));
  if (vl_text_is(type, with_distortion)) {
    VL_TRY(vl_camera_child_number(file, model, "kud", true, &k[0]));
    if (k[0] != 0.0) {
      d->distortion = VL_DISTORTION_RADIAL;
      d->distortion_count = 1;
      d->distortion_coefficients[0] = k[0];
    }
  } else if (vl_text_is(type, kannala_brandt)) {
    for (int i = 0; i < 4; i++)
      VL_TRY(vl_camera_child_number(file, model, radial[i], true, &k[i]));
    vl_camera_set_fisheye(d, k);
  } else if (!vl_text_is(type, without_distortion)) {
    return vl_camera_wrong_element(file, model, "unknown model \"%s\"; there are %s, %s, %s",
                                   vl_short_text(type).text, without_distortion,
                                   with_distortion, kannala_brandt);
  }
  vl_camera_set_centred(d, f);
  return VL_OK;
}

static vlResult read_camera(const vlCameraFile *file, const json_t *camera, const json_t *model,
                            vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double size[2] = {0.0, 0.0};
  char name[64];
  VL_TRY(VL_READ_CHILDREN(file, camera, VL_FIELD_OPTIONAL("image_width", &size[0]),
                          VL_FIELD_OPTIONAL("image_height", &size[1])));
  VL_TRY(read_model(file, model, d));
  vl_camera_set_origin(d);
  child_text(camera, "name", name);
  vl_camera_name(record, name);
  if (size[0] == 0.0 && size[1] == 0.0)
    return vl_camera_size_beside(file, NULL, record);
  if (vl_camera_set_sides(d, size))
    return VL_OK;
  return vl_camera_wrong_element(file, camera, "the image is %g x %g; it must be whole pixels",
                                 size[0], size[1]);
}

/* Each model of each camera counts as one camera, which is chosen by the camera's name or its
 * number. */
static vlResult read_visp(const vlCameraFile *file, const json_t *root,
                          vlCameraRecord *record) {
  const json_t *camera, *model, *chosen = NULL, *of = NULL;
  size_t i;
  record->frames = 0;
  json_array_foreach(json_object_get(root, "/"), i, camera) {
    char name[64];
    if (!vl_camera_has_tag(camera, "camera"))
      continue;
    child_text(camera, "name", name);
    VL_EACH_CHILD(model, camera) {
      if (!vl_camera_has_tag(model, "model"))
        continue;
      if (vl_camera_count(file, chosen, name, record)) {
        chosen = model;
        of = camera;
      }
    }
  }
  if (chosen)
    return read_camera(file, of, chosen, record);
  return vl_camera_wrong_element(file, root, "there is no camera \"%s\" among the %u",
                                 vl_camera_asked(file, "0").text, record->frames);
}

static bool is_visp(const json_t *tree) {
  const char *tag = vl_camera_text(tree, "<");
  const json_t *model = vl_camera_child(vl_camera_child(tree, "camera"), "model");
  return vl_text_is(tag, "root") && vl_camera_child(model, "px");
}

static vlResult write_visp(const vlFittedCamera *fit, vlCameraText *text) {
  const double *k = fit->k;
  const bool fisheye = fit->family == VL_LENS_FISHEYE;
  bool bent = !fisheye && k[0] != 0.0;
  const char *name = vl_camera_name_without(fit, "<>&", "Camera");
  static const char *const kannala[] = {"k1", "k2", "k3", "k4", "k5"};
  const double inverse = -k[0];
  return VL_PUT_FORM(
      text, fit,
      "<?xml version=\"1.0\"?>\n"
      "<root>\n"
      "  <camera>\n"
      "    <name>$own</name>\n"
      "    <image_width>$width</image_width>\n"
      "    <image_height>$height</image_height>\n"
      "    <model>\n"
      "      <type>$type</type>\n"
      "      <px>$fx</px>\n"
      "      <py>$fy</py>\n"
      "      <u0>$cx0</u0>\n"
      "      <v0>$cy0</v0>\n"
      "$bent$lens"
      "    </model>\n"
      "  </camera>\n"
      "</root>\n",
      VL_WORD("own", name),
      VL_WORD("type", fisheye ? kannala_brandt
                      : bent  ? with_distortion
                              : without_distortion),
      VL_PART("bent", bent, "      <kud>$k@0</kud>\n      <kdu>$inverse</kdu>\n"),
      VL_VALUES("k", k, 1), VL_VALUES("inverse", &inverse, 1),
      VL_NAMED("lens", kannala, k, fisheye ? 5 : 0, "      <$item>$value</$item>\n"));
}

const vlCameraFormat vl_format_visp = {
    .name = "visp",
    .known =
        "root camera name image_width image_height model type px py u0 v0 kud kdu k1 k2 k3 k4 "
        "k5 subsampling_width subsampling_height sampling_width sampling_height full_width "
        "full_height additional_information!",
    .is_tree = is_visp,
    .read = read_visp,
    .lenses = {VL_LENSES_COMMON, 0, 14, 1},
    .write = write_visp};
