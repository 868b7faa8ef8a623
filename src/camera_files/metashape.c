/* camera_files/metashape.c: Metashape's (PhotoScan's) XML of cameras, <document> with <chunk>,
 * and of one calibration. x right, y down, z forward; <transform> is chunk from camera, and the
 * chunk's space is the world's: the chunk's own transform (to a coordinate system of the earth)
 * is not applied. The first pixel's centre is (0.5, 0.5); cx and cy count from the image's
 * middle. With x', y' the distorted point: u = w/2 + cx + x' (f + b1) + y' b2, v = h/2 + cy +
 * y' f. Metashape's p1 and p2 are OpenCV's p2 and p1; k4 is r^8. */

#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/distortion.h"
#include "velo/projection.h"

/* Reads the numbers of <calibration>. Files of version 1.1 and before have fx, fy, and cx, cy
 * from the image's corner. */
static vlResult read_numbers(const vlCameraFile *file, const json_t *calibration,
                             vlCameraDef *d) {
  /* the order of VL_DISTORTION_THIN_PRISM */
  static const char *const names[] = {"k1", "k2", "p2", "p1", "k3", "k4"};
  double f = 0.0, c[2] = {VL_UNSET, VL_UNSET}, b[2] = {0.0, 0.0}, k[8] = {0.0},
         more[2] = {0.0, 0.0};
  bool old = vl_camera_child(calibration, "fx") != NULL;
  VL_TRY(vl_camera_child_number(file, calibration, old ? "fy" : "f", true, &f));
  if (old)
    VL_TRY(vl_camera_child_number(file, calibration, "fx", true, &d->fx));
  VL_TRY(VL_READ_CHILDREN(file, calibration, VL_FIELD_OPTIONAL("cx", &c[0]),
                          VL_FIELD_OPTIONAL("cy", &c[1]), VL_FIELD_OPTIONAL("b1", &b[0]),
                          VL_FIELD_OPTIONAL(old ? "skew" : "b2", &b[1])));
  for (int i = 0; i < 6; i++)
    VL_TRY(vl_camera_child_number(file, calibration, names[i], false, &k[i]));
  VL_TRY(VL_READ_CHILDREN(file, calibration, VL_FIELD_OPTIONAL("p3", &more[0]),
                          VL_FIELD_OPTIONAL("p4", &more[1])));
  if (more[0] != 0.0 || more[1] != 0.0)
    return vl_camera_wrong_element(file, calibration,
                                   "p3 and p4 are no terms of velo's distortion");
  double offset = old ? 0.0 : 0.5;
  d->fy = f;
  if (!old)
    d->fx = f + b[0];
  d->skew = b[1];
  d->cx = vl_is_unset(c[0]) ? 0.5 * d->width : offset * d->width + c[0];
  d->cy = vl_is_unset(c[1]) ? 0.5 * d->height : offset * d->height + c[1];
  if (vl_camera_all_zero(k, 6))
    return VL_OK;
  if (k[5] == 0.0 && d->projection == VL_PROJECTION_PERSPECTIVE) {
    vl_camera_set_opencv(d, k, 5);
    return VL_OK;
  }
  d->distortion = VL_DISTORTION_THIN_PRISM;
  d->distortion_count = 8;
  memcpy(d->distortion_coefficients, k, sizeof k);
  return VL_OK;
}

static vlResult read_attribute(const vlCameraFile *file, const json_t *element,
                               const char *name, uint32_t *value) {
  const char *text = vl_camera_text(element, name);
  char *end;
  double number = text ? vl_camera_parse(text, &end) : 0.0;
  if (!vl_camera_is_side(number))
    return vl_camera_wrong_element(file, element, "\"%s\" must be a whole number of pixels",
                                   name);
  *value = (uint32_t)number;
  return VL_OK;
}

static vlResult set_type(const vlCameraFile *file, const json_t *element, const char *type,
                         vlCameraDef *d) {
  if (!type || vl_text_is(type, "frame"))
    return VL_OK;
  if (vl_has_word("fisheye equidistant_fisheye", type)) {
    d->projection = VL_PROJECTION_EQUIDISTANT;
  } else if (vl_text_is(type, "equisolid_fisheye")) {
    d->projection = VL_PROJECTION_EQUISOLID;
  } else if (vl_text_is(type, "spherical")) {
    d->projection = VL_PROJECTION_EQUIRECTANGULAR;
  } else {
    return vl_camera_wrong_element(
        file, element,
        "type \"%s\" is no model of velo; there are frame, fisheye, equisolid_fisheye, "
        "spherical",
        vl_short_text(type).text);
  }
  return VL_OK;
}

/* Reads the adjusted calibration of a sensor, or else its first one. The image's size is that
 * of the sensor. */
static vlResult read_sensor(const vlCameraFile *file, const json_t *sensor,
                            vlCameraRecord *record) {
  const json_t *child, *calibration = NULL, *size = vl_camera_child(sensor, "resolution");
  vlCameraDef *d = &record->camera;
  VL_EACH_CHILD(child, sensor) {
    if (!vl_camera_has_tag(child, "calibration"))
      continue;
    const char *class = vl_camera_text(child, "class");
    if (!calibration || vl_text_is(class, "adjusted"))
      calibration = child;
  }
  if (calibration && vl_camera_child(calibration, "resolution"))
    size = vl_camera_child(calibration, "resolution");
  const char *type = vl_camera_text(calibration, "type");
  if (!size)
    return vl_camera_wrong_element(file, sensor, "the sensor has no <resolution>");
  VL_TRY(read_attribute(file, size, "width", &d->width));
  VL_TRY(read_attribute(file, size, "height", &d->height));
  VL_TRY(set_type(file, sensor, type ? type : vl_camera_text(sensor, "type"), d));
  if (d->projection == VL_PROJECTION_EQUIRECTANGULAR)
    return VL_OK;
  if (!calibration)
    return vl_camera_wrong_element(file, sensor, "the sensor has no <calibration>");
  return read_numbers(file, calibration, d);
}

static vlResult read_camera(const vlCameraFile *file, const json_t *chunk, const json_t *camera,
                            vlCameraRecord *record) {
  const char *id = vl_camera_text(camera, "sensor_id");
  const json_t *sensor;
  double m[16];
  VL_TRY(vl_camera_element_numbers(file, vl_camera_child(camera, "transform"), m, 16));
  if (!vl_camera_set_matrix(&record->camera, m, false))
    return vl_camera_wrong_element(file, camera, "no pose");
  VL_EACH_CHILD(sensor, vl_camera_child(chunk, "sensors")) {
    const char *own = vl_camera_text(sensor, "id");
    if (id && own && vl_text_is(id, own))
      return read_sensor(file, sensor, record);
  }
  return vl_camera_wrong_element(file, camera, "there is no sensor \"%s\"",
                                 vl_short_text(id).text);
}

/* Cameras may be in groups. A camera without <transform> was not aligned and is skipped. */
static void search(const vlCameraFile *file, const json_t *list, int depth,
                   vlCameraRecord *record, const json_t **chosen) {
  const json_t *camera;
  VL_EACH_CHILD(camera, list) {
    const char *tag = vl_camera_text(camera, "<");
    if (vl_text_is(tag, "group") && depth > 0)
      search(file, camera, depth - 1, record, chosen);
    if (vl_text_is(tag, "camera") && vl_camera_child(camera, "transform"))
      vl_camera_offer(file, camera, vl_camera_text(camera, "label"), record, chosen);
  }
}

static vlResult read_calibration(const vlCameraFile *file, const json_t *root,
                                 vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double size[2] = {0.0, 0.0};
  const char *text = vl_camera_text(vl_camera_child(root, "projection"), "$");
  VL_TRY(
      VL_READ_CHILDREN(file, root, VL_FIELD("width", &size[0]), VL_FIELD("height", &size[1])));
  VL_TRY(set_type(file, root, text, d));
  if (!vl_camera_set_sides(d, size))
    return vl_camera_wrong_element(file, root, "the image is %g x %g; it must be whole pixels",
                                   size[0], size[1]);
  vl_camera_set_origin(d);
  return read_numbers(file, root, d);
}

static vlResult read_document(const vlCameraFile *file, const json_t *root,
                              vlCameraRecord *record) {
  const json_t *chunk = vl_camera_child(root, "chunk"), *chosen = NULL;
  if (!chunk)
    return vl_camera_wrong_element(file, root, "the document has no <chunk>");
  record->frames = 0;
  search(file, vl_camera_child(chunk, "cameras"), 8, record, &chosen);
  if (chosen)
    return read_camera(file, chunk, chosen, record);
  return vl_camera_wrong_element(file, chunk, "there is no aligned camera \"%s\" among the %u",
                                 vl_camera_asked(file, "0").text, record->frames);
}

static vlResult read_metashape(const vlCameraFile *file, const json_t *root,
                               vlCameraRecord *record) {
  bool calibration = vl_camera_has_tag(root, "calibration");
  return calibration ? read_calibration(file, root, record) : read_document(file, root, record);
}

static bool is_metashape(const json_t *tree) {
  const char *tag = vl_camera_text(tree, "<");
  return tag && (vl_text_is(tag, "calibration") ||
                 (vl_text_is(tag, "document") && vl_camera_child(tree, "chunk")));
}

static vlResult write_metashape(const vlFittedCamera *fit, vlCameraText *text) {
  static const char *const names[] = {"k1", "k2", "p2", "p1", "k3", "k4"};
  const vlCameraDef *d = &fit->record->camera;
  const vlCamera *c = &fit->camera;
  double k[14];
  memcpy(k, fit->k, sizeof k);
  bool prism = d->distortion == VL_DISTORTION_THIN_PRISM &&
               d->distortion_coefficients[6] == 0.0 && d->distortion_coefficients[7] == 0.0;
  bool fisheye = d->projection == VL_PROJECTION_EQUIDISTANT;
  if (prism && (fisheye || d->projection == VL_PROJECTION_PERSPECTIVE)) {
    memcpy(k, d->distortion_coefficients, 6 * sizeof *k);
  } else if (fit->family == VL_LENS_FISHEYE) {
    const double radial[6] = {k[0], k[1], 0.0, 0.0, k[2], k[3]};
    memcpy(k, radial, sizeof radial);
  } else if ((fit->family != VL_LENS_PINHOLE && fit->family != VL_LENS_OPENCV) ||
             fit->count > 5) {
    return vl_camera_no_model(fit->file, d);
  }
  const char *name = vl_camera_name_without(fit, "<>&\"", "camera");
  const double plane[4] = {c->cx - 0.5 * c->width, c->cy - 0.5 * c->height, c->fx - c->fy,
                           c->skew};
  return VL_PUT_FORM(
      text, fit,
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<document version=\"2.0.0\">\n"
      "  <chunk label=\"Chunk\" enabled=\"true\">\n"
      "    <sensors next_id=\"1\">\n"
      "      <sensor id=\"0\" label=\"sensor\" type=\"$type\">\n"
      "        <resolution width=\"$width\" height=\"$height\"/>\n"
      "        <calibration type=\"$type\" class=\"adjusted\">\n"
      "          <resolution width=\"$width\" height=\"$height\"/>\n"
      "          <f>$fy</f>\n"
      "          <cx>$plane@0</cx>\n"
      "          <cy>$plane@1</cy>\n"
      "          <b1>$plane@2</b1>\n"
      "          <b2>$plane@3</b2>\n"
      "$lens"
      "        </calibration>\n"
      "      </sensor>\n"
      "    </sensors>\n"
      "    <cameras next_id=\"1\">\n"
      "      <camera id=\"0\" sensor_id=\"0\" label=\"$own\">\n"
      "        <transform>$pose:s</transform>\n"
      "      </camera>\n"
      "    </cameras>\n"
      "  </chunk>\n"
      "</document>\n",
      VL_WORD("type", fisheye ? "fisheye" : "frame"), VL_VALUES("plane", plane, 4),
      VL_NAMED("lens", names, k, 6, "          <$item>$value</$item>\n"), VL_WORD("own", name));
}

const vlCameraFormat vl_format_metashape = {
    .name = "metashape",
    .known =
        "document version chunk chunks sensors sensor cameras camera group calibration "
        "adjusted class type resolution width height f fx fy cx cy b1 b2 skew k1 k2 k3 k4 p1 "
        "p2 p3 p4 projection transform rotation translation scale id label enabled sensor_id "
        "component_id master_id layer_index active next_id next_group_id property name value bands band "
        "data_type black_level! sensitivity! vignetting! covariance! params! coeffs! date "
        "orientation meta! reference! rotation_covariance! location_covariance! frames! "
        "markers! scalebars! settings! region! components! component partition! images! fixed "
        "coordinate_system! pixel_height pixel_width focal_length locked camera_ids "
        "marker_ids accuracy! color_profile! depth_maps! dense_cloud! point_cloud! model! "
        "shapes! save_accuracy!",
    .geometry = "film_camera rolling_shutter",
    .is_tree = is_metashape,
    .read = read_metashape,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SKEW,
    .write = write_metashape};
