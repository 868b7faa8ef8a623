/* camera_files/opencv.c: OpenCV's camera files, of one camera or of a stereo pair. x right, y
 * down, z forward; camera from world; the first pixel's centre is (0, 0): velo's cx and cy are
 * larger by 0.5. */

#include "camera_files/opencv.h"
#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/distortion.h"
#include "velo/projection.h"

/* The names of lens models in both dialects; without a name the number of coefficients
 * decides. */
vlResult vl_opencv_read_lens(const vlCameraFile *file, const json_t *tree,
                             const char *coefficients, vlCameraDef *d) {
  static const char *const names[] = {
      "opencv",  "pinhole",     "plumb_bob", "rational_polynomial", "thin_prism", "tilted",
      "fisheye", "equidistant", "none"};
  const char *model = vl_camera_text(tree, "distortion_model");
  if (json_object_get(tree, "distortion_model") && !model)
    return vl_camera_wrong_in(file, tree, "distortion_model",
                              "%s: \"distortion_model\" must be a word", file->dialect);
  bool fisheye = json_number_value(json_object_get(tree, "fisheye_model")) != 0.0;
  if (model && model[0] && !VL_IS_AMONG(model, names)) {
    char known[300];
    vl_tell_names(known, sizeof known, model, names, VL_LENGTH(names));
    return vl_camera_wrong_in(file, tree, "distortion_model",
                              "%s: unknown distortion_model \"%s\"%s", file->dialect,
                              vl_short_text(model).text, known);
  }
  fisheye = fisheye || (model && vl_has_word("fisheye equidistant", model));
  double *k = d->distortion_coefficients;
  uint32_t n = 0;
  VL_TRY(vl_camera_numbers(file, tree, coefficients, k, 0, 14, &n));
  if (fisheye) {
    if (n != 4 && n != 0)
      return vl_camera_wrong_in(file, tree, coefficients,
                                "%s: \"%s\" holds %u numbers; a fisheye has 4", file->dialect,
                                coefficients, n);
    d->projection = VL_PROJECTION_EQUIDISTANT;
    d->distortion = n ? VL_DISTORTION_RADIAL : VL_DISTORTION_NONE;
  } else {
    if (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14)
      return vl_camera_wrong_in(file, tree, coefficients,
                                "%s: \"%s\" holds %u numbers; there are 0, 4, 5, 8, 12 or 14",
                                file->dialect, coefficients, n);
    if (vl_text_is(model, "none") && !vl_camera_all_zero(k, n))
      return vl_camera_wrong_in(file, tree, coefficients,
                                "%s: distortion_model is \"none\", but \"%s\" is not zero",
                                file->dialect, coefficients);
    d->distortion = n ? VL_DISTORTION_OPENCV : VL_DISTORTION_NONE;
  }
  d->distortion_count = n;
  return VL_OK;
}

vlResult vl_opencv_read_matrix(const vlCameraFile *file, const json_t *tree, const char *key,
                               vlCameraDef *d) {
  double k[9];
  VL_TRY(vl_camera_list(file, tree, key, k, 9));
  if (!vl_camera_set_intrinsics(d, k, true))
    return vl_camera_wrong_in(file, tree, key, "%s: \"%s\" must be [fx 0 cx; 0 fy cy; 0 0 1]",
                              file->dialect, key);
  if (k[1] != 0.0)
    return vl_camera_wrong_in(file, tree, key,
                              "%s: \"%s\" has a skew of %g, which OpenCV's projection takes no "
                              "notice of; set it to 0",
                              file->dialect, key, k[1]);
  return VL_OK;
}

vlResult vl_opencv_refuse_part(const vlCameraFile *file, const json_t *tree,
                               const vlCameraDef *d) {
  const json_t *roi = json_object_get(tree, "roi");
  double binning[2] = {0, 0}, x = 0, y = 0, width = 0, height = 0;
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_OPTIONAL("binning_x", &binning[0]),
                        VL_FIELD_OPTIONAL("binning_y", &binning[1])));
  if (binning[0] > 1.0 || binning[1] > 1.0)
    return vl_camera_wrong_in(
        file, tree, "binning_x",
        "%s: binning of %g x %g pixels is not taken; give the full image's camera",
        file->dialect, binning[0], binning[1]);
  if (!json_is_object(roi))
    return VL_OK;
  VL_TRY(VL_READ_FIELDS(file, roi, VL_FIELD_OPTIONAL("x_offset", &x),
                        VL_FIELD_OPTIONAL("y_offset", &y), VL_FIELD_OPTIONAL("width", &width),
                        VL_FIELD_OPTIONAL("height", &height)));
  bool whole = width == 0.0 && height == 0.0; /* as ROS defines it */
  whole = whole || (x == 0.0 && y == 0.0 && width == d->width && height == d->height);
  if (whole)
    return VL_OK;
  return vl_camera_wrong_in(
      file, tree, "roi",
      "%s: a region of interest, %g x %g pixels at %g,%g, is not taken; give the full image's "
      "camera and render with --crop",
      file->dialect, width, height, x, y);
}

/* A negative fy (as in ICL-NUIM's RGB-D sequences): a camera with y up, in a left-handed world.
 * Converted to fy > 0 and a pose that mirrors y, which gives the same pixels. */
static vlResult turn_y(const vlCameraFile *file, vlCameraDef *d) {
  if (!(d->fy < 0.0))
    return VL_OK;
  if (!vl_camera_all_zero(d->distortion_coefficients, d->distortion_count))
    return vl_camera_wrong(file, "%s: fy is %g; below zero it goes without distortion only",
                           file->dialect, d->fy);
  d->fy = -d->fy;
  for (int row = 0; row < 3; row++)
    d->world_from_camera[4 * row + 1] = 0.0 - d->world_from_camera[4 * row + 1];
  return VL_OK;
}

/* rvec, tvec: camera from world; both or neither. */
static vlResult read_pose(const vlCameraFile *file, const json_t *tree, vlCameraDef *d) {
  double v[3] = {0, 0, 0}, t[3] = {0, 0, 0}, r[9];
  bool any = json_object_get(tree, "rvec") || json_object_get(tree, "tvec");
  vlResult result = VL_OK;
  if (any)
    result = vl_camera_list(file, tree, "rvec", v, 3);
  if (any && result == VL_OK)
    result = vl_camera_list(file, tree, "tvec", t, 3);
  vl_rotation_from_vector(v, r);
  vl_camera_set_pose(d, r, t);
  return result;
}

/* Names: of the calibration program (today and in version 2), and those that scripts use. */

static const char *const matrix_names[] = {"camera_matrix", "cameraMatrix",     "Camera_Matrix",
                                           "CameraMatrix",  "intrinsic_matrix", "K",
                                           "mtx",           "intrinsics_matrix"};
static const char *const lens_names[] = {"distortion_coefficients",
                                         "Distortion_Coefficients",
                                         "distortionCoefficients",
                                         "distCoeffs",
                                         "dist_coeffs",
                                         "dist_coeff",
                                         "dist_coefs",
                                         "distortion",
                                         "dist",
                                         "D"};
static const char *const width_names[] = {"image_width", "image_Width", "Image_Width",
                                          "imageWidth", "width"};
static const char *const height_names[] = {"image_height", "image_Height", "Image_Height",
                                           "imageHeight", "height"};
static const char *const size_names[] = {"image_size", "imageSize", "img_size", "resolution",
                                         "size"};
/* Matrix and distortion of the first and the second camera of a pair. */
static const char *const stereo_names[][4] = {
    {"M1", "D1", "M2", "D2"},
    {"K1", "D1", "K2", "D2"},
    {"cameraMatrix1", "distCoeffs1", "cameraMatrix2", "distCoeffs2"},
    {"camera_matrix_1", "dist_coeffs_1", "camera_matrix_2", "dist_coeffs_2"},
    {"mtx1", "dist1", "mtx2", "dist2"},
    {"mtxL", "distL", "mtxR", "distR"},
    {"K_left", "D_left", "K_right", "D_right"},
    {"left_camera_matrix", "left_distortion_coefficients", "right_camera_matrix",
     "right_distortion_coefficients"},
    {"camera_matrix_left", "distortion_coefficients_left", "camera_matrix_right",
     "distortion_coefficients_right"}};
enum { STEREO_NAMES = VL_LENGTH(stereo_names) };
#define NAME_IN(tree, names) name_in(tree, names, VL_LENGTH(names))

/* Returns the first name that is a key of the tree, or the first name if none is. */
static const char *name_in(const json_t *tree, const char *const *names, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (vl_camera_has(tree, names[i]))
      return names[i];
  return names[0];
}

static const char *const *stereo_of(const json_t *tree) {
  for (int i = 0; i < STEREO_NAMES; i++)
    if (vl_camera_has(tree, stereo_names[i][0]) && vl_camera_has(tree, stereo_names[i][2]))
      return stereo_names[i];
  return NULL;
}

/* Whether it is the name of a matrix (of: 0) or a distortion (1) of either camera of a pair. */
static bool is_stereo_name(const char *name, int of) {
  for (int i = 0; i < STEREO_NAMES; i++)
    if (vl_text_is(name, stereo_names[i][of]) || vl_text_is(name, stereo_names[i][2 + of]))
      return true;
  return false;
}

bool vl_opencv_is_lens(const char *name) {
  return VL_IS_AMONG(name, lens_names) || is_stereo_name(name, 1);
}

bool vl_opencv_is_field(const char *name) {
  return VL_IS_AMONG(name, matrix_names) || is_stereo_name(name, 0) ||
         vl_opencv_is_lens(name) || VL_IS_AMONG(name, width_names) ||
         VL_IS_AMONG(name, height_names) || VL_IS_AMONG(name, size_names) ||
         vl_has_word("R T rvec tvec xi", name);
}

static vlResult read_size(const vlCameraFile *file, const json_t *tree,
                          vlCameraRecord *record) {
  const char *pair = NAME_IN(tree, size_names);
  const char *width = NAME_IN(tree, width_names), *height = NAME_IN(tree, height_names);
  bool paired = !vl_camera_has(tree, width) && vl_camera_has(tree, pair);
  return paired ? vl_camera_side_pair(file, tree, pair, record)
                : vl_camera_sides(file, tree, width, height, record);
}

/* Two cameras, and x2 = R x1 + T. The world's space is the first camera's. Without R and T,
 * which the calibration program writes into a file of their own, the second has no pose
 * here. */
static vlResult read_stereo(const vlCameraFile *file, const json_t *tree,
                            const char *const *names, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double r[9], t[3];
  bool second = vl_camera_is_frame(file, 1, "right"),
       first = vl_camera_is_frame(file, 0, "left");
  record->frames = 2;
  if (!first && !second)
    return vl_camera_wrong(
        file, "opencv: there is no camera \"%s\": there are left (0) and right (1)",
        vl_camera_asked(file, "").text);
  second = second && !first;
  const char *matrix = names[second ? 2 : 0], *lens = names[second ? 3 : 1];
  VL_TRY(vl_opencv_read_matrix(file, tree, matrix, d));
  if (vl_camera_has(tree, lens))
    VL_TRY(vl_opencv_read_lens(file, tree, lens, d));
  vl_camera_set_origin(d);
  if (second) {
    VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_LIST("R", r, 9), VL_FIELD_LIST("T", t, 3)));
    vl_camera_set_pose(d, r, t);
  }
  vl_camera_name(record, second ? "right" : "left");
  return read_size(file, tree, record);
}

vlResult vl_camera_read_opencv(const vlCameraFile *file, const json_t *tree,
                               vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  const char *const *stereo = stereo_of(tree);
  if (stereo)
    return read_stereo(file, tree, stereo, record);
  VL_TRY(read_size(file, tree, record));
  VL_TRY(vl_opencv_read_matrix(file, tree, NAME_IN(tree, matrix_names), d));
  VL_TRY(vl_opencv_read_lens(file, tree, NAME_IN(tree, lens_names), d));
  VL_TRY(vl_opencv_refuse_part(file, tree, d));
  if (vl_camera_has(tree, "xi")) { /* xi marks the omnidirectional model */
    double xi = 0.0;
    bool list = !json_is_number(json_object_get(tree, "xi"));
    VL_TRY(list ? vl_camera_list(file, tree, "xi", &xi, 1)
                : vl_camera_number(file, tree, "xi", &xi));
    d->projection = VL_PROJECTION_UNIFIED;
    d->shape[0] = xi;
  }
  VL_TRY(read_pose(file, tree, d));
  VL_TRY(turn_y(file, d));
  vl_camera_name(record, vl_camera_text(tree, "camera_name"));
  return VL_OK;
}

static bool is_opencv(const json_t *tree) {
  return vl_camera_has(tree, NAME_IN(tree, matrix_names)) || stereo_of(tree) ||
         vl_camera_has(tree, "image_width");
}

/* ---- writing ----------------------------------------------------------------------------- */

static const char json_form[] =
    "{\n"
    "  \"image_width\": $width,\n"
    "  \"image_height\": $height,\n"
    "  \"camera_matrix\": [$K:3]$model,\n"
    "  \"distortion_coefficients\": [$k],\n"
    "  \"rvec\": [$V],\n"
    "  \"tvec\": [$t]\n"
    "}\n";

static const char xml_form[] =
    "<?xml version=\"1.0\"?>\n"
    "<opencv_storage>\n"
    "<image_width>$width</image_width>\n"
    "<image_height>$height</image_height>\n"
    "<camera_matrix type_id=\"opencv-matrix\">\n"
    "  <rows>3</rows>\n"
    "  <cols>3</cols>\n"
    "  <dt>d</dt>\n"
    "  <data>$K:s</data></camera_matrix>\n"
    "$model"
    "<distortion_coefficients type_id=\"opencv-matrix\">\n"
    "  <rows>$count</rows>\n"
    "  <cols>1</cols>\n"
    "  <dt>d</dt>\n"
    "  <data>$k:s</data></distortion_coefficients>\n"
    "<rvec type_id=\"opencv-matrix\">\n"
    "  <rows>3</rows>\n"
    "  <cols>1</cols>\n"
    "  <dt>d</dt>\n"
    "  <data>$V:s</data></rvec>\n"
    "<tvec type_id=\"opencv-matrix\">\n"
    "  <rows>3</rows>\n"
    "  <cols>1</cols>\n"
    "  <dt>d</dt>\n"
    "  <data>$t:s</data></tvec>\n"
    "</opencv_storage>\n";

static const char yaml_form[] =
    "%YAML:1.0\n"
    "---\n"
    "image_width: $width\n"
    "image_height: $height\n"
    "camera_matrix: !!opencv-matrix\n"
    "  rows: 3\n"
    "  cols: 3\n"
    "  dt: d\n"
    "  data: [$K]$model\n"
    "distortion_coefficients: !!opencv-matrix\n"
    "  rows: $count\n"
    "  cols: 1\n"
    "  dt: d\n"
    "  data: [$k]\n"
    "rvec: !!opencv-matrix\n"
    "  rows: 3\n"
    "  cols: 1\n"
    "  dt: d\n"
    "  data: [$V]\n"
    "tvec: !!opencv-matrix\n"
    "  rows: 3\n"
    "  cols: 1\n"
    "  dt: d\n"
    "  data: [$t]\n";

static vlResult write_opencv(const vlFittedCamera *fit, vlCameraText *text) {
  const bool json = vl_ends_with(fit->file->path, ".json");
  const bool xml = vl_ends_with(fit->file->path, ".xml");
  const char *fisheye = json  ? ",\n  \"distortion_model\": \"fisheye\""
                        : xml ? "<fisheye_model>1</fisheye_model>\n"
                              : "\ndistortion_model: fisheye";
  /* FileStorage has no empty matrix; four zeros are equivalent */
  const uint32_t n = fit->count || json ? fit->count : 4;
  const double count = n;
  return VL_PUT_FORM(text, fit,
                     json  ? json_form
                     : xml ? xml_form
                           : yaml_form,
                     VL_WORD("model", fit->family == VL_LENS_FISHEYE ? fisheye : ""),
                     VL_VALUES("count", &count, 1), VL_VALUES("k", fit->k, n));
}

const vlCameraFormat vl_format_opencv = {
    .name = "opencv",
    .is_tree = is_opencv,
    .is_text = vl_npz_is,
    .read_text = vl_npz_read,
    .known =
        "camera_name distortion_model fisheye_model binning_x binning_y roi x_offset y_offset width "
        "height rows cols data dt type_id layout opencv_storage R1 R2 P1 P2 Q E F roi1 roi2 "
        /* of the calibration */
        "calibration_time calibration_Time nframes nr_of_frames nrOfFrames board_* square_size "
        "square_Size marker_size flags flagValue fix_aspect_ratio aspectRatio avg_reprojection_error "
        "Avg_Reprojection_Error per_view_reprojection_errors Per_View_Reprojection_Errors "
        "Per_Image_Reprojection_Errors extrinsic_parameters Extrinsic_Parameters image_points "
        "Image_points grid_points calibrate_* reprojection_error rms rms_error",
    .knows = vl_opencv_is_field,
    .read = vl_camera_read_opencv,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_COMMON, 0, 14},
    .write = write_opencv};
